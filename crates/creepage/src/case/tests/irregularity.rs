//! Heights of the running surfaces: how they are written, and what is refused.

use std::fs;
use std::path::Path;

use super::{SHORT, refused, set};
use crate::case::Case;
use crate::case::irregularity::{Coordinate, SurfaceHeights};

#[test]
fn heights_in_a_file_are_read_in_the_units_of_its_heading_and_kept_in_the_case() {
    let dir = tempfile::tempdir().unwrap();
    let [case, rail, wheel] = ["case.toml", "rail.csv", "wheel.csv"].map(|f| dir.path().join(f));
    fs::write(&rail, "x (mm),z (um)\n-100,0\n0,10\n200,-10\n").unwrap();
    fs::write(&wheel, "angle (deg),dr (mm)\n-180,0\n0,0.25\n").unwrap();
    let keys = "[bar]\nsurface = { file = \"rail.csv\" }\n[disk]\nout_of_round = { file = \"wheel.csv\" }\n";
    fs::write(&case, format!("{SHORT}{keys}")).unwrap();
    let found = Case::load(&case, &[]).unwrap();
    let points = vec![[-0.1, 0.0], [0.0, 1e-5], [0.2, -1e-5]];
    assert_eq!(found.bar.surface, Some(SurfaceHeights::Points(points)));
    assert_eq!(found.inputs(), [case.clone(), rail.clone(), wheel]);
    let around = found.disk.out_of_round.as_ref().unwrap().heights(Coordinate::Angle).unwrap();
    for angle in [-1.5, 1.5, 4.5] {
        let height = 0.25e-3
            * (1.0
                - libm::fabs(libm::remainder(angle, std::f64::consts::TAU)) / std::f64::consts::PI);
        assert!((around.at(angle, 0.0) - height).abs() < 1e-12, "{angle}");
    }
    let again = Case::from_text(&found.to_toml(), Path::new("case.toml"), &[]).unwrap();
    assert_eq!(again, found);
    assert_ne!(found.hash(), set(&[]).unwrap().hash());
    let load = || Case::load(&case, &[]);
    for (text, words) in [
        ("-0.1,0\n0,10\n0.2,0\n", &["rail.csv:2:", "mm or um?"][..]),
        ("-0.1,0\n0.2,0\n0.1,0\n", &["rail.csv:3:", "above that of the point before"]),
        ("-0.1,0\n", &["rail.csv:1:", "two points"]),
        ("x,z\n-0.1;0\n", &["rail.csv:2:", "semicolons"]),
        ("x (s),z (m)\n-0.1,0\n", &["rail.csv:1:", "'s' is no known unit of a place x"]),
        ("-0.1,0\n0.01,0\n", &["bar.surface", "the patch needs them"]),
    ] {
        fs::write(&rail, text).unwrap();
        refused(load(), words);
    }
    fs::write(&rail, "x (mm),y (mm),z (um)\n-100,-20,0\n-100,20,10\n200,-20,20\n200,20,30\n")
        .unwrap();
    let found = load().unwrap();
    let grid = [[-0.1, -0.02, 0.0], [-0.1, 0.02, 1e-5], [0.2, -0.02, 2e-5], [0.2, 0.02, 3e-5]];
    assert_eq!(found.bar.surface, Some(SurfaceHeights::Grid(grid.to_vec())));
    let again = Case::from_text(&found.to_toml(), Path::new("case.toml"), &[]).unwrap();
    assert_eq!(again, found);
    for (text, words) in [
        ("-0.1,-1,0\n-0.1,1,0\n0.2,-1,0\n0.2,1,1\n", &["rail.csv:4:", "mm or um?"][..]),
        ("-0.1,-1,0\n-0.1,1,0\n0.2,-1,0\n", &["rail.csv:1:", "3 points have 2 different x"]),
        ("x,y,z\n-0.1,-1,0\n-0.1,1\n", &["rail.csv:3:", "is not a place x and a place y"]),
    ] {
        fs::write(&rail, text).unwrap();
        refused(load(), words);
    }
    fs::remove_file(&rail).unwrap();
    refused(load(), &["bar.surface.file", "rail.csv"]);
}

#[test]
fn a_formula_has_the_names_of_its_coordinate_and_repeats_after_a_turn() {
    let case = set(&[
        "bar.surface={ formula = \"1e-5*cos(2*pi*x/0.04)\" }",
        "disk.out_of_round={ formula = \"-max(0, 1e-4 - abs(angle))\" }",
    ]);
    let case = case.unwrap();
    let along = case.bar.surface.unwrap().heights(Coordinate::X).unwrap();
    assert!(
        (along.at(0.02, 0.0) + 1e-5).abs() < 1e-19 && (along.at(0.08, 1.0) - 1e-5).abs() < 1e-19
    );
    let around = case.disk.out_of_round.unwrap().heights(Coordinate::Angle).unwrap();
    for turn in [0.0, 1.0, -3.0] {
        let at = |angle: f64| around.at(angle + turn * std::f64::consts::TAU, 0.0);
        assert!((at(0.0) + 1e-4).abs() < 1e-14 && at(3.0) == 0.0 && at(-3.0) == 0.0);
    }
}

#[test]
fn heights_that_a_half_model_or_a_slice_cannot_have_are_refused() {
    let slice = [
        "mesh.plane_strain=true",
        "bar.crown_radius=flat",
        "mesh.zone.width=1e-3",
        "disk.width=1e-3",
        "bar.width=1e-3",
        "load.normal=1e3",
    ];
    let models = [&["mesh.symmetry=half"][..], &slice];
    for (place, fits) in [("x", [true, true]), ("y", [true, false]), ("(y - 5e-4)", [false, false])]
    {
        let dent = format!("bar.surface={{ formula = \"-1e-5*exp(-({place}/1e-3)^2)\" }}");
        assert!(set(&[&dent]).is_ok(), "{place}");
        for (model, fits) in models.into_iter().zip(fits) {
            let found = set(&[&[dent.as_str()], model].concat());
            if fits {
                found.unwrap();
            } else {
                refused(found, &["bar.surface gives", "takes for the same"]);
            }
        }
    }
}

#[test]
fn heights_that_are_none_are_refused_by_their_key() {
    for (given, words) in [
        ("bar.surface={ formula = \"1e-5*cos(z)\" }", &["unknown name 'z'", "x, the place"][..]),
        ("bar.surface={ formula = \"cos(\" }", &["cannot read the formula"]),
        ("bar.surface={ formula = \"0.01\" }", &["0.01 m at x", "1e-5 for 10 um"]),
        ("bar.surface={ formula = \"1e-5*ln(x)\" }", &["NaN m at x", "finite"]),
        ("bar.surface={ formula = \"1e-7/abs(x)\" }", &["must be finite and at most 0.005 m"]),
        ("disk.out_of_round={ formula = \"1e-5*x\" }", &["unknown name 'x'", "angle, the angle"]),
        ("disk.out_of_round={ formula = \"1e-4*angle\" }", &["the same place of the disk"]),
        ("bar.surface={ points = [[-1, 0], [1, 0.3]] }", &["point 2, at 1", "mm or um?"]),
        ("bar.surface={ points = [[-1, 0], [-1, 0]] }", &["point 2", "above"]),
        ("bar.surface={ points = [[0, 0]] }", &["two points"]),
        ("bar.surface={ points = [] }", &["two points"]),
        ("bar.surface={ points = [[-1, 0], [0.05, 0]] }", &["the patch needs them from"]),
        ("disk.out_of_round={ points = [[0, 0], [360, 0]] }", &["degrees"]),
        ("bar.surface={ points = [[0, 0, 0]] }", &["must be", "formula"]),
        ("bar.surface={ formula = \"200*y^2\" }", &["heights must be finite and at most"]),
        (
            "bar.surface={ grid = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }",
            &["2 different x and 2 different y"],
        ),
        (
            "bar.surface={ grid = [[-1, 0, 0], [1, 0, 0], [-1, 1, 0], [1, 1, 0]] }",
            &["y = 0 to 1 m", "the patch needs them"],
        ),
        (
            "bar.surface={ grid = [[0, -1, 0], [1, -1, 0], [0, 1, 0], [1, 1, 0]] }",
            &["the patch needs them"],
        ),
        ("bar.surface={ grid = [[0, 0]] }", &["must be", "grid"]),
        ("disk.out_of_round={ grid = [[0, 0, 0]] }", &["the angle alone"]),
        ("bar.surface={ formula = 3 }", &["must be", "formula"]),
        ("bar.surface={ points = [[-1, 0], [1, 0]], formula = \"0\" }", &["must be", "formula"]),
        ("bar.surface={}", &["must be", "formula"]),
        ("bar.surface=1e-5", &["must be", "formula"]),
        ("bar.surface=\"rail.csv\"", &["must be", "file"]),
    ] {
        let key = given.split('=').next().unwrap();
        refused(set(&[given]), &[&[key], words].concat());
        refused(
            set(&["model=half-space", given]),
            &[key, "has no meaning for model = \"half-space\""],
        );
    }
    let long = format!("bar.surface={{ formula = \"{}0\" }}", "0+".repeat(2000));
    refused(set(&[&long]), &["4001 characters"]);
}
