#![allow(clippy::unwrap_used)]

mod any_input;
mod creepage;
mod half_space;
mod irregularity;
mod materials;
mod reference;
mod refusals;
mod schema;

use std::fs;
use std::path::Path;

use miette::Diagnostic;

use crate::case::hertz::hertz;
use crate::case::schema::{ContactLayers, Crown, DriveMode, Grading, Meshing, Stiffness};
use crate::case::{Case, CaseError};

const SHORT: &str = "load.normal = 100e3\ndrive.speed = 38.89\ndrive.creepage = 2.4e-3\n\
                     friction.static = 0.5\n";

fn read(text: &str) -> Result<Case, CaseError> {
    Case::from_text(text, Path::new("short.toml"), &[])
}

fn set(sets: &[&str]) -> Result<Case, CaseError> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_string()).collect();
    Case::from_text(SHORT, Path::new("short.toml"), &sets)
}

/// Message and remedy of a refusal.
fn refusal(result: Result<Case, CaseError>) -> String {
    let error = result.expect_err("the case must be refused");
    let help = error.help().map(|help| help.to_string()).unwrap_or_default();
    format!("{error} | {help}")
}

#[track_caller]
fn refused(result: Result<Case, CaseError>, words: &[&str]) {
    let text = refusal(result);
    for word in words {
        assert!(text.contains(word), "{word:?} is not in {text:?}");
    }
}

#[test]
fn four_keys_make_the_reference_case() {
    let case = read(SHORT).unwrap();
    assert_eq!(case.name, "short");
    assert_eq!(case.rolled(), 0.060);
    assert_eq!(case.evaluate.last, Some(0.020));
    assert_eq!(case.output.fields_interval, Some(0.060 / 38.89 / 40.0));
    assert_eq!(case.bar.crown_radius, Crown::Radius(0.30));
    assert!(case.warnings().is_empty(), "{:?}", case.warnings());
}

#[test]
fn meshes_grow_in_three_directions_but_for_slices_and_meshes_that_are_read() {
    assert_eq!(set(&[]).unwrap().mesh.grading, Some(Grading::TwoToOne));
    assert_eq!(set(&["mesh.grading=tensor"]).unwrap().mesh.grading, Some(Grading::Tensor));
    let slice = set(&[
        "mesh={plane_strain=true,zone={width=0.02}}",
        "disk={width=0.02,crown_radius='flat'}",
        "bar={width=0.02,crown_radius='flat'}",
    ]);
    assert_eq!(slice.unwrap().mesh.grading, Some(Grading::Tensor));
    let read = Meshing { file: Some("disk-on-bar.vtu".into()), ..Meshing::default() };
    assert_eq!((read.grading, read.grading()), (None, Grading::Tensor));
}

#[test]
fn a_window_of_transits_is_as_many_patch_lengths_of_rolling() {
    let mut case = read(SHORT).unwrap();
    let half = crate::case::hertz::hertz(&case).a;
    case.evaluate = crate::case::schema::Evaluate { last: None, transits: Some(3.0) };
    assert!((case.evaluate_last() / (6.0 * half) - 1.0).abs() < 1e-15);
    let [from, to] = case.evaluation_window();
    assert!(((to - from) * case.drive.speed / (6.0 * half) - 1.0).abs() < 1e-12);
}

#[test]
fn the_resolved_case_loads_to_itself() {
    for sets in [
        vec![],
        vec!["evaluate.transits=1.5"],
        vec!["friction.law=exponential", "name=other", "disk.material.young=200e9"],
        vec!["time.duration=1e-3", "contact.penalty.normal={ stiffness = 3.5e13 }"],
        vec!["drive.torque=1e4", "bar.crown_radius=0.2", "disk.radius=0.123456789012345678"],
        vec!["output.window=[{from=0.0,to=1e-5}]", "output.probes.bar=[[0.01,0]]"],
    ] {
        let case = set(&sets).unwrap();
        let again = Case::from_text(&case.to_toml(), Path::new("x.toml"), &[]).unwrap();
        assert_eq!(case, again);
        assert_eq!(case.hash(), again.hash());
        assert_eq!(case.hash().len(), 64);
    }
}

#[test]
fn the_resolved_case_has_the_unit_of_every_number_behind_it_and_loads_to_itself() {
    let source = "def law(s):\n    # [load]\n    return 0.3 + 0.1 * s\n";
    let source = format!("friction.source={}", toml::Value::from(source));
    for sets in [
        &["output.window=[{from=0.0,to=1e-5}]", "contact.penalty.normal={ stiffness = 3.5e13 }"][..],
        &["friction.law=python", &source],
    ] {
        let case = set(sets).unwrap();
        let text = case.to_toml_with_units();
        let again = Case::from_text(&text, Path::new("x.toml"), &[]).unwrap();
        assert_eq!((&again, again.hash()), (&case, case.hash()));
        let line = |key: &str| text.lines().find(|line| line.starts_with(key)).unwrap();
        assert_eq!(line("speed = "), "speed = 38.89  # m/s");
        assert_eq!(line("normal = 100"), "normal = 100000.0  # N");
        assert_eq!(line("creepage = "), "creepage = 0.0024");
        assert_eq!(line("crown_radius = \"flat"), "crown_radius = \"flat\"");
        assert_eq!(line("density = "), "density = 7800.0  # kg/m^3");
    }
    let case = set(&[
        "output.window=[{from=0.0,to=1e-5}]",
        "contact.penalty.normal={ stiffness = 3.5e13 }",
    ]);
    let text = case.unwrap().to_toml_with_units();
    for line in ["from = 0.0  # s", "stiffness = 35000000000000.0  # N/m^3"] {
        assert!(text.lines().any(|found| found == line), "{line:?} is not a line of\n{text}");
    }
}

#[test]
fn a_speed_in_km_h_and_a_ratio_in_per_cent_are_told_with_what_was_likely_meant() {
    let warned = |sets: &[&str]| set(sets).unwrap().warnings().join("\n");
    let fast = warned(&["drive.speed=140"]);
    assert!(
        fast.contains("drive.speed = 140 m/s is unusual: did you mean 38.89 (140 km/h)?"),
        "{fast}"
    );
    let steep = warned(&["drive.creepage=0.24"]);
    for words in ["drive.creepage = 0.24 is unusual", "0.0024 (0.24 per cent)"] {
        assert!(steep.contains(words), "{steep}");
    }
    refused(
        set(&["drive.creepage=2.4"]),
        &["did you mean 0.024 (2.4 per cent) or 0.0024 (2.4 per mille)?"],
    );
    refused(set(&["drive.lateral_creepage=-4"]), &["did you mean -0.04 (-4 per cent)"]);
    refused(set(&["contact.penalty.damping=10"]), &["did you mean 0.1 (10 per cent)"]);
    for plausible in ["drive.speed=83.3", "drive.creepage=-0.02", "drive.creepage=0.1"] {
        assert!(!warned(&[plausible]).contains("did you mean"), "{plausible}");
    }
    for (written, meant) in [
        ("drive.speed=140km/h", "did you mean 38.88888889?"),
        ("friction.static=50%", "did you mean 0.5?"),
        ("mesh.zone.size=2 mm", "did you mean 0.002?"),
        ("disk.material.density=\"7.8 g/cm^3\"", "did you mean 7800?"),
    ] {
        refused(set(&[written]), &[meant]);
    }
    assert!(!refusal(set(&["friction.static=\"600%\""])).contains("did you mean"));
    // nothing in km/h either
    refused(set(&["drive.speed=1e6"]), &["at most 500"]);
}

#[test]
fn a_whole_number_may_be_written_with_an_exponent_or_a_point() {
    let plain = set(&["output.history_interval=100", "output.window=[{from=0,to=1e-5,every=2}]"]);
    let float = set(&["output.history_interval=1e2", "output.window=[{from=0,to=1e-5,every=2.0}]"]);
    let (plain, float) = (plain.unwrap(), float.unwrap());
    assert!(float.to_toml().contains("history_interval = 100\n"), "{}", float.to_toml());
    assert_eq!((&float, float.hash()), (&plain, plain.hash()));
    let text = format!("{SHORT}[output]\nhistory_interval = 1e2\n");
    assert_eq!(read(&text).unwrap().output.history_interval, 100);
    assert_eq!(
        set(&["preload.disturbance=1e-9", "preload.seed=-0.0"]).unwrap().preload.seed,
        Some(0)
    );
}

#[test]
fn the_hash_tells_cases_apart() {
    assert_ne!(set(&[]).unwrap().hash(), set(&["load.normal=100001"]).unwrap().hash());
}

#[test]
fn every_case_of_the_project_loads() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for name in [
        "quick.toml",
        "smoke.toml",
        "gmsh.toml",
        "zhao-li/a-coulomb.toml",
        "zhao-li/b-falling.toml",
        "zhao-li/b-as-published.toml",
        "zhao-li/c-memory.toml",
        "zhao-li/d-coulomb-low.toml",
        "zhao-li/control-weak.toml",
    ] {
        let case = Case::load(&cases.join(name), &[]).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(case.warnings().is_empty(), "{name}: {:?}", case.warnings());
    }
    let weak = Case::load(&cases.join("zhao-li/control-weak.toml"), &[]).unwrap();
    assert_eq!(weak.friction.number("decay"), Some(0.05));
    assert_eq!(weak.friction.number("dynamic"), Some(0.32));
}

#[test]
fn all_reference_cases_but_the_published_one_have_two_fully_integrated_layers() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for name in [
        "quick",
        "zhao-li/a-coulomb",
        "zhao-li/b-falling",
        "zhao-li/c-memory",
        "zhao-li/d-coulomb-low",
    ] {
        let case = Case::load(&cases.join(name).with_extension("toml"), &[]).unwrap();
        assert_eq!(case.element.contact_layers, ContactLayers::Full, "{name}");
        assert_eq!(case.element.layers, Some(2), "{name}");
    }
    let published = Case::load(&cases.join("zhao-li/b-as-published.toml"), &[]).unwrap();
    assert_eq!(published.element.contact_layers, ContactLayers::OnePoint);
    assert_eq!(published.contact.penalty.tangential, Stiffness::Factor(0.1));
}

#[test]
fn hertz_of_the_reference_case_matches_contact() {
    let patch = hertz(&read(SHORT).unwrap());
    assert!((patch.a - 7.162e-3).abs() < 1e-6, "{patch:?}");
    assert!((patch.b - 5.387e-3).abs() < 1e-6, "{patch:?}");
    assert!((patch.p0 - 1237.6e6).abs() < 1e5, "{patch:?}");
    assert!((patch.approach - 104.1e-6).abs() < 1e-7, "{patch:?}");
}

#[test]
fn hertz_of_a_line_contact_matches_the_formula() {
    // 1e7 N/m on R = 0.46 m: a 7.125 mm, p0 0.8936 GPa.
    let case = set(&["bar.crown_radius=flat", "load.normal=6e5", "mesh.zone.width=0.06"]).unwrap();
    let patch = hertz(&case);
    assert!((patch.a - 7.125e-3).abs() < 1e-6, "{patch:?}");
    assert!((patch.p0 - 0.8936e9).abs() < 1e5, "{patch:?}");
}

#[test]
fn the_three_forms_of_a_stiffness_are_read() {
    for (text, form) in [
        ("1", Stiffness::Factor(1.0)),
        ("{ stiffness = 3.5e13 }", Stiffness::Areal(3.5e13)),
        ("{ stability = 0.5 }", Stiffness::Stability(0.5)),
    ] {
        let case = set(&[&format!("contact.penalty.tangential={text}")]).unwrap();
        assert_eq!(case.contact.penalty.tangential, form);
    }
    for wrong in ["{}", "{ stability = 0.5, stiffness = 1 }", "{ soft = 1 }", "-1", "\"much\""] {
        refused(
            set(&[&format!("contact.penalty.normal={wrong}")]),
            &["contact.penalty.normal", "stability"],
        );
    }
}

#[test]
fn an_upper_layer_takes_back_the_other_choice() {
    let case = set(&["drive.torque=1e4"]).unwrap();
    assert_eq!(case.drive.mode, DriveMode::Torque);
    assert_eq!(case.drive.creepage, None);
    let case = set(&["time.roll=0.05", "time.duration=1e-3"]).unwrap();
    assert_eq!((case.time.roll, case.time.duration), (None, Some(1e-3)));
    let case = set(&["friction.law=exponential", "friction.decay=3", "friction.law=coulomb"]);
    assert_eq!(case.unwrap().friction.number("decay"), None);
    // A stiffness is one value, not a section to merge into.
    let case = set(&[
        "contact.penalty.normal={ stiffness = 1e13 }",
        "contact.penalty.normal={ stability = 0.5 }",
    ]);
    assert_eq!(case.unwrap().contact.penalty.normal, Stiffness::Stability(0.5));
}

#[test]
fn extends_merges_key_by_key_and_this_file_wins() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("base.toml"), format!("{SHORT}disk.width = 0.05\n")).unwrap();
    let top = dir.path().join("top.toml");
    fs::write(&top, "extends = \"base.toml\"\n[disk]\nradius = 0.5\n[load]\nnormal = 9e4\n")
        .unwrap();
    let case = Case::load(&top, &[]).unwrap();
    assert_eq!((case.disk.radius, case.disk.width, case.load.normal), (0.5, 0.05, 9e4));
    assert_eq!((case.name.as_str(), case.extends), ("top", None));
}

#[test]
fn an_error_in_an_extended_file_names_that_file_and_line() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("base.toml"), format!("{SHORT}[disk]\nradius = -1\n")).unwrap();
    let top = dir.path().join("top.toml");
    fs::write(&top, "extends = \"base.toml\"\n").unwrap();
    refused(Case::load(&top, &[]), &["base.toml:6:", "disk.radius = -1", "at least 1e-8"]);
}

#[test]
fn a_cycle_of_extends_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let (a, b) = (dir.path().join("a.toml"), dir.path().join("b.toml"));
    fs::write(&a, "extends = \"b.toml\"\n").unwrap();
    fs::write(&b, "extends = \"a.toml\"\n").unwrap();
    refused(Case::load(&a, &[]), &["b.toml:1:", "leads back"]);
    fs::write(&a, "extends = \"a.toml\"\n").unwrap();
    refused(Case::load(&a, &[]), &["a.toml:1:", "leads back"]);
    fs::write(&a, "\nextends = \"none.toml\"\n").unwrap();
    refused(Case::load(&a, &[]), &["a.toml:2:", "none.toml", "no such file"]);
    fs::write(&a, "extends = 3\n").unwrap();
    refused(Case::load(&a, &[]), &["a.toml:1:", "text in quotes"]);
}

#[test]
fn an_unstable_step_is_accepted_with_a_warning() {
    let case = set(&["time.factor=1.6"]).unwrap();
    assert!(case.warnings().iter().any(|w| w.contains("UNSTABLE")), "{:?}", case.warnings());
}

#[test]
fn computed_sizes_in_warnings_have_four_digits_and_are_never_zero() {
    // Hertz's patch of 100 kN, 7.162 mm by 5.387 mm, shrinks by the cube root of the load
    let warnings = set(&["load.normal=0.1", "mesh.zone.size=1.000003e-4"]).unwrap().warnings();
    let coarse =
        "mesh.zone.size = 0.1 mm is coarse for a patch of half axes 0.07162 and 0.05387 mm";
    assert!(warnings.iter().any(|warning| warning == coarse), "{warnings:?}");
}

#[test]
fn a_law_needs_and_gets_only_its_own_keys() {
    // what the layer beneath chose is taken back
    let case = set(&["friction.law=rate_state", "friction.distance=1e-5"]).unwrap();
    assert_eq!(case.friction.number("static"), None);
    assert_eq!(
        (case.friction.number("reference"), case.friction.number("reference_speed")),
        (Some(0.6), Some(1e-6))
    );
    assert_eq!(case.friction.number("age"), Some(1e-5 / 1e-6));
    let sets =
        ["friction.law=exponential", "friction.memory.distance=1e-5", "friction.law=coulomb"];
    let case = set(&[&sets[..], &["friction.static=0.4"]].concat()).unwrap();
    assert_eq!((case.friction.memory, case.friction.number("decay")), (None, None));
    let law = ["friction.law=rate_state", "friction.distance=1"];
    let [case, half_spaces] = ["contact.enforcement=exact", "model=half-space"]
        .map(|contact| set(&[&[contact][..], &law].concat()).unwrap());
    // with the slip velocity of the step before nothing would hold: the coefficient at rest is zero
    assert_eq!(case.friction.mode, Some(friction::Mode::Exact));
    assert_eq!(half_spaces.friction.mode, Some(friction::Mode::Exact));
    assert_eq!(case.contact.rows, Some(crate::case::schema::Rows::NodeToFace));
}

#[test]
fn a_case_with_any_friction_law_loads_to_itself() {
    for sets in [
        &["friction.law=slip_weakening", "friction.distance=1e-5"][..],
        &["friction.law=rate_state", "friction.distance=1e-5", "friction.state=slip"],
        &["friction.law=prakash_clifton", "friction.distance=1e-5"],
        &["friction.law=polach", "friction.ratio=0.4", "friction.decay=0.6"],
        &["friction.law=table", "friction.table=[[0, 0.5], [0.1, 0.30000000000000004]]"],
        &["friction.law=expression", "friction.expression=\"0.3 + 0.1*exp(-s)*max(p, 1e3)/1e12\""],
        &[
            "friction.law=expression",
            "friction.expression=\"0.3\"",
            "friction.memory.distance=1e-6",
        ],
    ] {
        let case = set(sets).unwrap();
        let again = Case::from_text(&case.to_toml(), Path::new("other.toml"), &[]).unwrap();
        assert_eq!(again, case);
        assert_eq!(again.to_toml(), case.to_toml());
    }
}

#[test]
fn a_table_is_read_beside_the_file_that_names_it_and_kept_in_the_case() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("base")).unwrap();
    fs::write(dir.path().join("base/mu.csv"), "slip velocity,mu\n0,0.5\n1,0.32\n").unwrap();
    let rest = SHORT.replace("friction.static = 0.5\n", "");
    let base = format!("{rest}[friction]\nlaw = \"table\"\ntable = \"mu.csv\"\n");
    fs::write(dir.path().join("base/base.toml"), base).unwrap();
    fs::write(dir.path().join("top.toml"), "extends = \"base/base.toml\"\n").unwrap();
    let load = || Case::load(&dir.path().join("top.toml"), &[]);
    assert_eq!(load().unwrap().friction.table, Some(vec![[0.0, 0.5], [1.0, 0.32]]));
    let mm = "slip (mm/s),mu (%)\n0,50\n1000,32\n";
    fs::write(dir.path().join("base/mu.csv"), mm).unwrap();
    assert_eq!(load().unwrap().friction.table, Some(vec![[0.0, 0.5], [1.0, 0.32]]));
    fs::write(dir.path().join("base/mu.csv"), mm.replace("mm/s", "mm")).unwrap();
    refused(load(), &["mu.csv:1:", "'mm' is no known unit of a slip velocity", "mm/s"]);
}

#[test]
fn an_error_found_later_shows_the_line_that_was_read() {
    let dir = tempfile::tempdir().unwrap();
    let [base, top] = ["base.toml", "top.toml"].map(|name| dir.path().join(name));
    fs::write(&base, SHORT).unwrap();
    fs::write(&top, "extends = \"base.toml\"\n[bar]\nlength = 0.3\n").unwrap();
    let case = Case::load(&top, &["disk.radius=0.5".into()]).unwrap();
    assert_eq!(case.inputs(), [top.clone(), base.clone()]);
    [&base, &top].into_iter().for_each(|file| fs::remove_file(file).unwrap());
    for (key, place) in [
        ("load.normal", format!("{}:1: no", base.display())),
        ("bar.length", format!("{}:3: no", top.display())),
        ("disk.radius", "--set: no".into()),
        ("mesh.growth", format!("{}: no", top.display())),
    ] {
        assert_eq!(case.error_at(key, "no", "").to_string(), place, "{key}");
    }
}
