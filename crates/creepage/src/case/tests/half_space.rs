//! A case with half-spaces: keys that have no meaning for them, what drives them, the resolved case.

use std::fs;
use std::path::Path;

use super::{SHORT, read, refusal, refused, set};
use crate::case::hertz::hertz;
use crate::case::keys::KEYS;
use crate::case::schema::{BodyModel, Step};
use crate::case::{Case, CaseError};

const HALF_SPACE: &str = "model=half-space";

fn half_space(sets: &[&str]) -> Result<Case, CaseError> {
    set(&[&[HALF_SPACE], sets].concat())
}

/// All that a refusal says of several keys.
fn every_refusal(result: Result<Case, CaseError>) -> Vec<String> {
    match result {
        Err(CaseError::Key(error)) => [error.message.clone()]
            .into_iter()
            .chain(error.others.into_iter().map(|e| e.message))
            .collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_case_without_the_key_is_of_finite_elements_and_does_not_say_so() {
    let case = set(&[]).unwrap();
    assert_eq!(case.model, BodyModel::FiniteElements);
    let table = case.table();
    for key in ["model", "half_space", "written"] {
        assert!(!table.contains_key(key), "{key}");
    }
    assert!(!case.to_toml().contains("lateral_creepage") && !case.to_toml().contains("spin"));
    assert_eq!(set(&["model=finite-elements"]).unwrap().hash(), case.hash());
}

#[test]
fn keys_without_meaning_beside_the_model_are_refused_by_name_all_at_once() {
    let text = format!(
        "model = \"half-space\"\n{SHORT}[contact.penalty]\nnormal = {{ stability = 0.5 }}\n[bar]\nheight = 0.05\n\
         [output]\nstress = false\nprobes.bar = [[0.01, 0.0]]\n"
    );
    let said = every_refusal(read(&text));
    let keys = ["bar.height", "contact.penalty.normal", "output.stress", "output.probes.bar"];
    assert_eq!(said.len(), keys.len(), "{said:?}");
    for key in keys {
        let line = said.iter().find(|line| line.contains(key)).unwrap();
        assert!(line.contains("has no meaning for model = \"half-space\""), "{line}");
        assert!(line.starts_with("short.toml:"), "{line}");
    }
    refused(read(&text), &["leave it out"]);
    refused(half_space(&["element.hourglass=0.1"]), &["--set", "element.hourglass"]);
    refused(set(&["half_space.inertia=false"]), &["half_space.inertia", "\"finite-elements\""]);
}

#[test]
fn keys_of_an_earlier_layer_without_meaning_are_left_out_with_one_warning() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = dir.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let base =
        format!("{SHORT}contact.penalty.normal = 0.2\nguards.parted = 1e-3\nmesh.growth = 1.2\n");
    let base = write("base.toml", &base);
    let extends = "extends = \"base.toml\"\nmodel = \"half-space\"\n";
    let top = Case::load(&write("top.toml", extends), &[]).unwrap();
    let by_option = Case::load(&base, &[HALF_SPACE.to_owned()]).unwrap();
    for case in [&top, &by_option] {
        let warning = "without meaning for model = \"half-space\" and left out: mesh.growth, contact.penalty.normal, \
                       guards.parted";
        assert_eq!(case.warnings(), [warning]);
        assert!(KEYS.iter().all(|key| key.has_meaning_for(case.model)
            || crate::case::value::get(&case.table(), key.path).is_none()));
        assert!(!case.table().contains_key("contact"));
    }
    assert_eq!(Case { name: "top".into(), ..by_option }, top);
    // the middle of three files chooses the model, the last gives a key again
    let last = write("last.toml", "extends = \"top.toml\"\nmesh.growth = 1.3\n");
    refused(Case::load(&last, &[]), &["last.toml:2:", "mesh.growth"]);
    // and back again
    let back = write("back.toml", "extends = \"top.toml\"\nmodel = \"finite-elements\"\n");
    let back = Case::load(&back, &[]).unwrap();
    assert_eq!((back.mesh.growth, back.written.left_out.len()), (1.2, 0));
}

#[test]
fn a_mesh_file_of_an_earlier_layer_is_not_read() {
    let text = format!("{SHORT}mesh.file = \"none.msh\"\n");
    let case = Case::from_text(&text, Path::new("short.toml"), &[HALF_SPACE.to_owned()]).unwrap();
    assert_eq!(case.mesh.file, None);
    assert!(case.warnings()[0].contains("mesh.file"), "{:?}", case.warnings());
}

#[test]
fn the_resolved_case_loads_to_itself() {
    let slice = ["mesh.plane_strain=true", "bar.crown_radius=flat", "load.normal=1e5"];
    for sets in [
        &[][..],
        &[
            "disk.profile=S1002",
            "bar.profile=60E1",
            "bar.cant=0.025",
            "disk.yaw=5e-3",
            "mesh.zone.width=0.05",
        ],
        &["half_space.inertia=false", "drive.lateral_creepage=1e-3", "drive.spin=-0.2"],
        &["mesh.window=0.05", "friction.law=exponential", "friction.mode=exact"],
        &["friction.law=exponential", "friction.memory.distance=1e-5", "time.step=1e-8"],
        &["disk.material.young=200e9", "bar.material.young=200e9"],
        &["preload.disturbance=1e-6", "preload.seed=3"],
        &slice,
    ] {
        let case = half_space(sets).unwrap();
        let text = case.to_toml();
        assert!(text.contains("model = \"half-space\"") && text.contains("inertia = "), "{text}");
        let again = Case::from_text(&text, Path::new("x.toml"), &[]).unwrap();
        assert_eq!(case, again);
        assert_eq!((case.hash(), case.to_toml()), (again.hash(), again.to_toml()));
        assert!(again.warnings().is_empty(), "{:?}", again.warnings());
    }
}

#[test]
fn a_step_is_by_default_half_the_time_of_waves_from_point_to_point() {
    let case = half_space(&[]).unwrap();
    assert_eq!(case.step(), Step::Fraction(0.5));
    let (e, nu, rho): (f64, f64, f64) = (210e9, 0.3, 7800.0);
    let speed = (e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu) * rho)).sqrt();
    assert!((case.wave_time() * speed / 1e-3 - 1.0).abs() < 1e-12);
    assert!(case.has_inertia());
}

#[test]
fn both_models_move_sideways() {
    for key in ["drive.lateral_creepage", "drive.spin"] {
        set(&[&format!("{key}=1e-3")]).unwrap();
        assert_eq!(set(&[&format!("{key}=0")]).unwrap().hash(), set(&[]).unwrap().hash());
        half_space(&[&format!("{key}=1e-3")]).unwrap();
    }
    refused(half_space(&["drive.spin=101"]), &["drive.spin = 101", "rad/m"]);
}

#[test]
fn finite_elements_move_sideways_only_as_a_whole_and_within_the_fine_zone() {
    for key in ["drive.lateral_creepage", "drive.spin"] {
        let with = |sets: &[&str]| set(&[&[format!("{key}=1e-3").as_str()], sets].concat());
        refused(with(&["mesh.symmetry=half"]), &[key, "no plane of symmetry", "whole"]);
        refused(with(&["mesh.window=0.04"]), &[key, "mesh.window", "mesh.zone.length"]);
        refused(with(&["bar.crown_radius=flat"]), &[key, "both \"flat\"", "crown_radius"]);
        let slice = ["mesh.plane_strain=true", "bar.crown_radius=flat", "disk.width=0.02"];
        let slice = [&slice[..], &["bar.width=0.02", "mesh.zone.width=0.02"]].concat();
        refused(with(&slice), &[key, "a slice stays in its plane"]);
    }
    refused(set(&["drive.spin=-5"]), &["drifts by up to 9 mm", "mesh.zone.width", "time.roll"]);
    refused(
        set(&["drive.lateral_creepage=0.2"]),
        &["drive.lateral_creepage", "drifts by up to 12 mm"],
    );
}

#[test]
fn friction_may_be_exact_or_lagged_and_exact_friction_remembers_nothing() {
    assert_eq!(half_space(&["friction.law=exponential"]).unwrap().friction.mode, None);
    half_space(&["friction.law=exponential", "friction.mode=exact"]).unwrap();
    let sets = ["friction.law=exponential", "friction.mode=exact", "friction.memory.distance=1e-5"];
    refused(half_space(&sets), &["friction.mode", "friction.memory"]);
}

#[test]
fn half_spaces_have_one_material_and_a_patch_and_no_spin_about_a_line() {
    refused(half_space(&["disk.material.young=200e9"]), &["disk.material and bar.material differ"]);
    refused(half_space(&["bar.crown_radius=flat"]), &["along a line", "mesh.plane_strain"]);
    refused(half_space(&["mesh.plane_strain=true"]), &["crown_radius = \"flat\""]);
    refused(half_space(&["mesh.zone.size=1e-7"]), &["mesh.zone.size", "points"]);
    let line = [
        "mesh.plane_strain=true",
        "bar.crown_radius=flat",
        "load.normal=1e4",
        "mesh.zone.width=1e-3",
    ];
    refused(half_space(&[&line[..], &["drive.spin=1"]].concat()), &["drive.spin", "line"]);
    let slice = half_space(&line);
    // 1e7 N/m on R = 0.46 m: a 7.125 mm
    assert!((hertz(&slice.unwrap()).a - 7.125e-3).abs() < 1e-6);
}

#[test]
fn the_path_stays_in_the_zone_and_no_bar_limits_it() {
    refused(half_space(&["mesh.zone.start=0"]), &["mesh.zone.start", "at most"]);
    refused(half_space(&["time.roll=0.09"]), &["the fine zone ends"]);
    half_space(&["time.roll=0.09", "mesh.zone.length=0.5"]).unwrap();
    half_space(&["time.roll=0.9", "mesh.window=0.04"]).unwrap();
    let unknown = refusal(half_space(&["model=quarter-space"]));
    assert!(unknown.contains("\"half-space\""), "{unknown}");
}

#[test]
fn profiles_take_the_place_of_crowns_and_the_patch_is_that_of_their_contact() {
    let wide = "mesh.zone.width=0.05";
    let case =
        half_space(&["disk.profile=S1002", "bar.profile=60E1", "bar.cant=0.025", wide]).unwrap();
    let table = case.table();
    assert!(crate::case::value::get(&table, "disk.crown_radius").is_none());
    let point = case.wheel_on_rail().unwrap().unwrap().first_contact().unwrap();
    let [along, across] = point.curvature;
    // the ratio of the axes is nearly that of the curvatures to the power of 2/3
    let patch = hertz(&case);
    let ratio = libm::pow(across / along, 2.0 / 3.0);
    assert!((patch.a / patch.b / ratio - 1.0).abs() < 0.05, "{patch:?} {ratio}");
    // a crown as a profile is the crown
    let crowned = half_space(&[]).unwrap();
    let half = 0.03;
    let arc = |i: i32| {
        let y = half * f64::from(i) / 100.0;
        format!("[{y:?}, {:?}]", 0.3 - (0.09 - y * y).sqrt())
    };
    let arc: Vec<String> = (-100..=100).map(arc).collect();
    let arced = half_space(&[&format!("bar.profile=[{}]", arc.join(", "))]).unwrap();
    let (patch, same) = (hertz(&crowned), hertz(&arced));
    assert!((same.a / patch.a - 1.0).abs() < 2e-3 && (same.b / patch.b - 1.0).abs() < 2e-3);
}

#[test]
fn bad_profiles_and_positions_are_refused_with_the_reason() {
    for (sets, words) in [
        (&["disk.profile=60E1"][..], "are wheel and rail swapped?"),
        (&["disk.lateral=1e-3"], "need a profile"),
        (&["bar.profile=60E1", "disk.lateral=0.5"], "there is no contact at this position"),
        (&["bar.profile=none.prr"], "none.prr"),
        (&["bar.profile=[[0.0, 0.0], [0.01, 0.0]]"], "too short: 2 points"),
        (&["bar.profile=60E1", "mesh.plane_strain=true"], "without profiles"),
    ] {
        refused(half_space(sets), &[words]);
    }
    // a mesh follows those of a whole wheel that rolls straight
    for (other, words) in [
        ("disk.yaw=1e-3", "has no meaning for model = \"finite-elements\""),
        ("mesh.symmetry=half", "y = 0 is no plane of symmetry"),
        ("drive.spin=0.1", "the wheel would leave its place on the rail"),
        ("drive.lateral_creepage=1e-3", "the wheel would leave its place on the rail"),
        (
            "mesh.file=../../meshes/disk-on-bar-2mm.vtu",
            "only a mesh that is generated follows them",
        ),
        ("disk.lateral=0.5", "there is no contact at this position"),
    ] {
        refused(set(&["bar.profile=60E1", other]), &[words]);
    }
    let flange = ["disk.profile=S1002", "bar.profile=60E1", "bar.cant=0.025", "disk.lateral=5e-3"];
    refused(set(&flange), &["wheel and rail touch at 70 degrees, on the flange"]);
    let case = set(&["bar.profile=60E1", "disk.lateral=1e-3"]).unwrap();
    let again = Case::from_text(&case.to_toml(), Path::new("case.toml"), &[]).unwrap();
    assert_eq!(again.hash(), case.hash());
    let both =
        format!("model = \"half-space\"\n{SHORT}[bar]\nprofile = \"60E1\"\ncrown_radius = 0.3\n");
    refused(read(&both), &["bar.crown_radius and bar.profile are both given"]);
}
