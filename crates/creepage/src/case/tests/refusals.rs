//! What is refused, and that the message names place, key, value, range and remedy.

use std::fs;

use super::{SHORT, read, refusal, refused, set};
use crate::case::{Case, CaseError};

#[test]
fn unreadable_files_are_refused_with_their_reason() {
    let dir = tempfile::tempdir().unwrap();
    refused(Case::load(dir.path(), &[]), &["is a folder"]);
    refused(Case::load(&dir.path().join("none.toml"), &[]), &["none.toml", "no such file"]);
    let binary = dir.path().join("binary.toml");
    fs::write(&binary, b"name = \"a\"\n\xff\xfe").unwrap();
    refused(Case::load(&binary, &[]), &["not UTF-8", "line 2"]);
    fs::write(&binary, vec![b'#'; 5 << 20]).unwrap();
    refused(Case::load(&binary, &[]), &["4 MiB"]);
}

#[test]
fn a_malformed_file_is_refused_at_its_line() {
    refused(read("name = \"a\"\n[load\n"), &["short.toml:2:", "TOML"]);
    refused(read(&format!("{SHORT}load.normal = 3\n")), &["short.toml:5:", "duplicate key"]);
}

#[test]
fn numbers_too_large_for_their_type_are_refused_at_their_line() {
    refused(
        read(&format!("{SHORT}[disk]\nradius = 1e400\n")),
        &["short.toml:6:", "1e400 is too large"],
    );
    let text = format!("{SHORT}[output]\nhistory_interval = 99999999999999999999\n");
    refused(read(&text), &["short.toml:6:", "99999999999999999999 is too large"]);
}

#[test]
fn endless_mistakes_lines_and_nesting_are_refused_in_a_short_message() {
    let mut many: String = (0..100_000).map(|i| format!("k{i} = 1\n")).collect();
    many.push_str(SHORT);
    let error = read(&many).unwrap_err();
    let CaseError::Key(error) = error else { panic!("{error}") };
    assert!(error.others.len() <= 21, "{} mistakes told", error.others.len());

    let long = format!("{SHORT}{} = 1\n", "x".repeat(1_000_000));
    let deep = format!("{SHORT}a = {}{}\n", "[".repeat(100_000), "]".repeat(100_000));
    for text in [long, deep] {
        let error = read(&text).unwrap_err();
        let CaseError::Key(error) = error else { panic!("{error}") };
        assert!(error.message.len() < 2000 && error.message.starts_with("short.toml:5:"));
        assert!(error.source_code.is_none(), "an endless line would be shown");
    }
}

#[test]
fn a_file_may_begin_with_a_byte_order_mark_and_end_its_lines_as_windows_does() {
    let text = format!("\u{feff}{}", SHORT.replace('\n', "\r\n"));
    assert_eq!(read(&text).unwrap(), read(SHORT).unwrap());
    refused(read(&format!("{text}disk.radius = -1\r\n")), &["short.toml:5:", "disk.radius"]);
}

#[test]
fn a_long_chain_of_extends_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    for i in 0..100 {
        let text = format!("extends = \"{}.toml\"\n", i + 1);
        fs::write(dir.path().join(format!("{i}.toml")), text).unwrap();
    }
    fs::write(dir.path().join("100.toml"), SHORT).unwrap();
    refused(Case::load(&dir.path().join("0.toml"), &[]), &["extends", "chain"]);
    assert!(Case::load(&dir.path().join("90.toml"), &[]).is_ok());
}

#[test]
fn unknown_keys_are_refused_with_a_suggestion() {
    refused(read(&format!("{SHORT}disk.radios = 1\n")), &[":5:", "disk.radios = 1", "`radius`"]);
    refused(read(&format!("{SHORT}radius = 1\n")), &["short.toml:5:", "`disk.radius`"]);
    refused(read(&format!("{SHORT}young = 1\n")), &["short.toml:5:", "`material.young`"]);
    refused(read(&format!("{SHORT}frobnicate = 1\n")), &["frobnicate", "top level"]);
    refused(read(&format!("{SHORT}\"disk.radius\" = 1\n")), &["unknown key"]);
    refused(set(&["mesh.zone.sise=1"]), &["--set", "mesh.zone.sise", "`size`"]);
}

#[test]
fn missing_keys_are_named_with_their_section() {
    for (key, section) in
        [("load.normal", "load"), ("drive.speed", "drive"), ("friction.static", "friction")]
    {
        let text: String =
            SHORT.lines().filter(|line| !line.starts_with(key)).map(|l| format!("{l}\n")).collect();
        refused(read(&text), &[key, "missing", &format!("[{section}]")]);
    }
    refused(read(""), &["load.normal is missing"]);
    refused(set(&["drive.mode=torque"]), &["drive.torque is missing"]);
    refused(
        read("load.normal = 1e5\ndrive.speed = 38.89\nfriction.static = 0.5\n"),
        &["drive.creepage is missing"],
    );
    refused(set(&["output.window=[{from=0}]"]), &["output.window[0].to is missing"]);
}

#[test]
fn wrong_values_are_refused_with_key_value_and_range() {
    for (set_, words) in [
        ("load.normal=-1e5", vec!["load.normal = -100000", "at least 1e-12", "upwards"]),
        ("load.normal=0", vec!["load.normal = 0", "upwards"]),
        ("load.normal=nan", vec!["load.normal = NaN", "at least 1e-12"]),
        ("load.normal=inf", vec!["load.normal = inf"]),
        ("load.normal=\"much\"", vec!["load.normal = \"much\"", "a number"]),
        ("load.normal=much", vec!["load.normal = \"much\"", "a number"]),
        ("load=5", vec!["load = 5", "section"]),
        ("disk.radius=-0.46", vec!["disk.radius = -0.46", "at least 1e-8", " m"]),
        ("disk.radius=true", vec!["disk.radius = true"]),
        ("material.poisson=0.5", vec!["material.poisson = 0.5", "at most 0.49999"]),
        ("bar.material.poisson=0.6", vec!["bar.material.poisson"]),
        ("time.factor=3", vec!["time.factor = 3", "at most 2"]),
        ("time.factor=0", vec!["time.factor = 0", "at least 1e-4"]),
        ("mesh.zone.size=0", vec!["mesh.zone.size = 0"]),
        ("mesh.zone.size=1e-6", vec!["mesh.zone.size", "elements"]),
        ("mesh.zone.size=0.03", vec!["mesh.zone.size", "mesh.zone.width"]),
        ("mesh.zone.length=0.3", vec!["mesh.zone.length = 0.3", "bar.length = 0.24"]),
        ("mesh.zone.width=0.07", vec!["mesh.zone.width = 0.07", "bar.width = 0.06"]),
        ("mesh.zone.depth=0.08", vec!["mesh.zone.depth = 0.08", "bar.height = 0.07"]),
        ("mesh.zone.start=-0.1", vec!["fine zone", "inside the bar"]),
        ("mesh.zone.start=-0.005", vec!["mesh.zone.start", "patch"]),
        ("mesh.zone.width=0.008", vec!["mesh.zone.width = 0.008", "patch"]),
        ("disk.hub_radius=0.5", vec!["disk.hub_radius = 0.5", "disk.radius = 0.46"]),
        ("drive.speed=1e-6", vec!["60000 s", "time steps", "1e9", "days", "drive.speed"]),
        ("drive.speed=0", vec!["drive.speed = 0", "at least 1e-9"]),
        ("drive.speed=-3", vec!["drive.speed = -3", "at least 1e-9"]),
        ("drive.creepage=5", vec!["drive.creepage = 5", "at most 0.5", "per cent"]),
        ("load.normal=1e400", vec!["load.normal", "1e400", "at most 1e8"]),
        ("output.history_interval=99999999999999999999", vec!["whole number from 1 to 1000000"]),
        ("output.history_interval=0", vec!["output.history_interval = 0", "from 1"]),
        ("mesh.zone.size=1e-9", vec!["mesh.zone.size = 1e-9", "2.6e22 elements"]),
        ("load.normal=5e-324", vec!["load.normal = 5e-324", "at least 1e-12 and at most 1e8 N"]),
        (
            "load.normal=1",
            vec![
                "mesh.zone.size = 1 mm is more than twice the shorter axis of the patch of load.normal = 1 N",
                "0.3086 by 0.2321 mm",
                "mesh.zone.size = 5.803e-5 or less",
            ],
        ),
        ("disk.hub_radius=1e-6", vec!["disk.hub_radius = 1e-6 m", "disk.radius", "needles"]),
        (
            "element.hourglass=1e-9",
            vec!["hourglass = 1e-9", "must be 0, or a number at least 1e-6"],
        ),
        (
            "checkpoint.wall_minutes=5e-324",
            vec!["wall_minutes = 5e-324", "must be 0, or a number at least 1e-5"],
        ),
        ("time.duration=1e-14", vec!["time.duration makes a run of 1e-14 s", "the time step"]),
        ("evaluate.last=1e-9", vec!["evaluate.last makes an evaluation window", "the time step"]),
        ("evaluate.transits=1e-9", vec!["evaluate.transits = 1e-9", "at least 0.001"]),
        (
            "friction.table=[[0, 0.5], [1, 1e3]]",
            vec!["point 2", "coefficient 1000", "at least 0 and at most 100"],
        ),
        ("bar.length=0.05", vec!["mesh.zone.length = 0.08", "bar.length = 0.05"]),
        ("material.young=1e3", vec!["--set", "patch"]),
        ("time.roll=0.1", vec!["time.roll", "0.1", "fine zone ends at 0.07"]),
        ("disk.lift=1e-3", vec!["disk.lift", "does not touch"]),
        ("disk.lift=-1e-3", vec!["disk.lift = -0.001", "at least 0"]),
        ("disk.crown_radius=round", vec!["disk.crown_radius = \"round\"", "\"flat\""]),
        ("bar.crown_radius=0.01", vec!["bar.crown_radius = 0.01", "at least the width"]),
        ("bar.ends=open", vec!["bar.ends = \"open\"", "\"quiet\" or \"free\""]),
        ("friction.decay=6", vec!["friction.decay", "not used", "coulomb"]),
        ("friction.law=magic", vec!["friction.law = \"magic\"", "\"exponential\""]),
        ("output.history_interval=1.5", vec!["output.history_interval = 1.5", "whole number"]),
        ("output.history_interval=-1", vec!["output.history_interval = -1"]),
        ("output.history_interval=-0.0", vec!["output.history_interval = -0", "from 1 to"]),
        ("output.history_interval=1e300", vec!["output.history_interval = 1e300", "whole number"]),
        ("output.stress=1", vec!["output.stress = 1", "true or false"]),
        ("output.stress=von_mises", vec!["output.stress = \"von_mises\"", "[\"von_mises\""]),
        (
            "output.stress=[\"von_misses\"]",
            vec!["von_misses", "did you mean \"von_mises\"?", "\"principal\""],
        ),
        ("output.probes.bar=[[1, 0]]", vec!["output.probes.bar = [1, 0]", "fine zone", "0.07"]),
        ("output.probes.disk=[[0.02, 0], [0.02, 0.02]]", vec!["output.probes.disk = [0.02, 0.02]"]),
        ("output.probes.bar=[[1, 0, 0]]", vec!["output.probes.bar", "pairs"]),
        ("output.window=[{from=2e-4,to=1e-4}]", vec!["output.window[0].to", "greater"]),
        ("output.window=3", vec!["output.window = 3", "list"]),
        ("evaluate.last=0.07", vec!["evaluate.last = 0.07", "0.06"]),
        ("evaluate.transits=9", vec!["evaluate.transits = 9 transits", "0.06"]),
        (
            "evaluate={last=0.01,transits=1}",
            vec!["evaluate.transits", "evaluate.last", "both given"],
        ),
        ("name=\"../up\"", vec!["name", "cannot name a folder"]),
        ("name=\"..\"", vec!["name", "cannot name a folder"]),
        ("drive.mode=torque", vec!["drive.torque is missing"]),
    ] {
        let text = refusal(set(&[set_]));
        for word in words {
            assert!(text.contains(word), "{set_}: {word:?} is not in {text:?}");
        }
    }
    const FALLING: &str = "friction.law=exponential";
    const EXACT: &str = "contact.enforcement=exact";
    for (sets, words) in [
        (
            vec![FALLING, "friction.memory.distance=-1e-5"],
            vec!["memory.distance = -1e-5", "at least"],
        ),
        (
            vec![FALLING, "friction.memory.distance=0"],
            vec!["friction.memory.distance = 0", "at least"],
        ),
        (vec![FALLING, "friction.memory.floor=0"], vec!["friction.memory.floor = 0", "m/s"]),
        (vec!["friction.memory.distance=1e-5"], vec!["friction.memory", "coulomb"]),
        (vec!["friction.mode=exact"], vec!["friction.mode", "coulomb"]),
        (
            vec![FALLING, "friction.mode=implicit"],
            vec!["friction.mode = \"implicit\"", "\"lagged\""],
        ),
        (
            vec![FALLING, EXACT, "friction.mode=exact", "friction.memory.distance=1e-5"],
            vec!["friction.mode", "friction.memory", "both given"],
        ),
        (vec!["contact.enforcement=mortar"], vec!["contact.enforcement = \"mortar\"", "\"exact\""]),
        (vec!["contact.rows=mortar"], vec!["contact.rows", "contact.enforcement", "\"penalty\""]),
        (vec![EXACT, "contact.rows=dual"], vec!["contact.rows = \"dual\"", "\"node_to_face\""]),
        (vec![EXACT, "preload.method=relaxation"], vec!["preload.method", "exact"]),
        (
            vec![
                "mesh={plane_strain=true,zone={width=0.02}}",
                "disk={width=0.02,crown_radius='flat'}",
                "bar={width=0.02,crown_radius='flat'}",
                "preload.method=relaxation",
            ],
            vec!["preload.method = \"relaxation\"", "mesh.plane_strain = true"],
        ),
        (
            vec![
                "mesh={plane_strain=true,symmetry='half',zone={width=0.02}}",
                "disk={width=0.02,crown_radius='flat'}",
                "bar={width=0.02,crown_radius='flat'}",
            ],
            vec!["mesh.symmetry = \"half\"", "mesh.plane_strain = true"],
        ),
        (
            vec![
                "mesh={plane_strain=true,grading='two_to_one',zone={width=0.02}}",
                "disk={width=0.02,crown_radius='flat'}",
                "bar={width=0.02,crown_radius='flat'}",
            ],
            vec!["mesh.grading = \"two_to_one\"", "mesh.plane_strain"],
        ),
        (
            vec![
                "mesh={plane_strain=true,window=0.03,zone={width=0.02}}",
                "disk={width=0.02,crown_radius='flat'}",
                "bar={width=0.02,crown_radius='flat'}",
            ],
            vec!["mesh.window", "mesh.plane_strain = true"],
        ),
        (vec!["mesh.window=0.012"], vec!["mesh.window = 0.012 m", "at least", "lengthen"]),
        (vec!["mesh.window=0.3"], vec!["mesh.window = 0.3 m", "bar.length"]),
        (
            vec!["mesh.symmetry=half", "preload.method=relaxation"],
            vec!["mesh.symmetry = \"half\"", "preload.method = \"relaxation\""],
        ),
    ] {
        let text = refusal(set(&sets));
        for word in words {
            assert!(text.contains(word), "{sets:?}: {word:?} is not in {text:?}");
        }
    }
    refused(set(&["load.mode=height", "preload.method=none"]), &["load.mode", "preload"]);
    refused(
        set(&["friction.law=exponential", "friction.dynamic=0.6"]),
        &["friction.dynamic = 0.6", "at most friction.static = 0.5"],
    );
    refused(read(&format!("{SHORT}drive.torque = 3.0\n")), &["drive.torque", "creepage"]);
    refused(
        read(&format!("{SHORT}[time]\nroll = 0.06\nduration = 1e-3\n")),
        &["short.toml:7:", "both given"],
    );
}

#[test]
fn bad_set_options_are_refused() {
    for bad in
        ["", "load.normal", "=3", "load..normal=3", "load.normal=", "a b=3", "x=[1", "x=\"\n"]
    {
        refused(set(&[bad]), &["--set", "KEY=VALUE"]);
    }
    refused(set(&["extends=x.toml"]), &["extends", "file"]);
    refused(set(&["name=1\nload.normal=3"]), &["--set"]);
}

#[test]
fn all_mistakes_are_told_at_once() {
    let error = read("load.normal = -1\ndrive.speed = 38.89\ndisk.radios = 3\n").unwrap_err();
    let CaseError::Key(error) = error else { panic!("{error}") };
    let keys: Vec<_> = std::iter::once(error.key.as_str())
        .chain(error.others.iter().map(|e| e.key.as_str()))
        .collect();
    for key in ["load.normal", "disk.radios", "friction.static"] {
        assert!(keys.contains(&key), "{key} is not in {keys:?}");
    }
}

/// A case with this `[friction]`.
fn rubbing(friction: &str) -> Result<Case, CaseError> {
    let rest = SHORT.replace("friction.static = 0.5\n", "");
    read(&format!("{rest}[friction]\n{friction}\n"))
}

#[test]
fn wrong_friction_is_refused_with_its_key_and_line() {
    for (friction, words) in [
        ("law = \"magic\"", vec!["short.toml:5:", "friction.law = \"magic\"", "\"rate_state\""]),
        (
            "law = \"rate_state\"\nstatic = 0.5\ndistance = 1e-5",
            vec!["friction.static", "not used"],
        ),
        (
            "law = \"slip_weakening\"\nstatic = 0.5",
            vec!["short.toml:5:", "friction.distance is missing", "slip_weakening"],
        ),
        (
            "law = \"slip_weakening\"\nstatic = 0.5\ndistance = -1e-5",
            vec!["short.toml:7:", "friction.distance = -1e-5", "at least 1e-12"],
        ),
        (
            "law = \"slip_weakening\"\nstatic = 0.5\ndistance = 1e-5\ndynamic = 0.6",
            vec!["short.toml:8:", "friction.dynamic = 0.6", "at most friction.static = 0.5"],
        ),
        (
            "law = \"exponential\"\nstatic = 0.5\nmemory.distance = -1e-5",
            vec!["friction.memory.distance = -1e-5", "at least 1e-12"],
        ),
        (
            "law = \"prakash_clifton\"\nstatic = 0.5\ndistance = 1e-5\ndecay = 6",
            vec!["short.toml:8:", "friction.decay", "not used", "\"exponential\""],
        ),
        (
            "law = \"polach\"\nstatic = 0.55\nratio = 0.4",
            vec!["short.toml:5:", "friction.decay is missing", "polach", "s/m"],
        ),
        (
            "law = \"polach\"\nstatic = 0.55\nratio = 40\ndecay = 0.6",
            vec!["short.toml:7:", "friction.ratio = 40", "at most 1", "give the ratio"],
        ),
        (
            "law = \"polach\"\nstatic = 0.55\nratio = 0.4\ndecay = 0.6\ndynamic = 0.2",
            vec!["short.toml:9:", "friction.dynamic", "not used", "\"slip_weakening\""],
        ),
        ("law = \"rate_state\"\ndistance = 1e-5\nstate = \"old\"", vec!["\"ageing\" or \"slip\""]),
        ("law = \"rate_state\"\ndistance = 1e-5\ndirect = 0", vec!["friction.direct = 0"]),
        (
            "law = \"rate_state\"\ndistance = 1e-5\nmode = \"exact\"",
            vec!["friction.mode", "exact enforcement"],
        ),
        ("law = \"table\"", vec!["friction.table is missing"]),
        (
            "law = \"table\"\ntable = \"nowhere.csv\"",
            vec!["short.toml:6:", "nowhere.csv", "no such"],
        ),
        (
            "law = \"table\"\ntable = [[0, 0.5], [0, 0.4]]",
            vec!["short.toml:6:", "point 2", "above"],
        ),
        ("law = \"table\"\ntable = [[0, 0.5], [1]]", vec!["friction.table", "list of pairs"]),
        ("static = 0.5\ntable = [[0, 0.5]]", vec!["friction.table", "not used", "\"table\""]),
        ("law = \"expression\"", vec!["friction.expression is missing"]),
        (
            "law = \"expression\"\nexpression = \"0.3 + speed\"",
            vec!["short.toml:6:", "'speed' at position 7", "x, the position"],
        ),
        (
            "law = \"expression\"\nexpression = \"0.3/s\"",
            vec!["short.toml:6:", "mu = inf", "slip speed 0 m/s", "max(p, 1e3)"],
        ),
        (
            "law = \"expression\"\nexpression = \"0.3 - t*1e3\"",
            vec!["short.toml:6:", "mu = -0", "t = "],
        ),
        ("law = \"expression\"\nexpression = \"0.3 +\"", vec!["cannot read the formula"]),
        (
            "law = \"expression\"\nexpression = 0.3",
            vec!["friction.expression = 0.3", "text in quotes"],
        ),
    ] {
        let text = refusal(rubbing(friction));
        for word in words {
            assert!(text.contains(word), "{friction}: {word:?} is not in {text:?}");
        }
    }
}

#[test]
fn a_wrong_friction_table_is_refused_at_its_own_line() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("mu.csv"), "s,mu\n0,0.5\n1,0.4\n0.5,0.3\n").unwrap();
    let rest = SHORT.replace("friction.static = 0.5\n", "");
    let case = dir.path().join("case.toml");
    fs::write(&case, format!("{rest}[friction]\nlaw = \"table\"\ntable = \"mu.csv\"\n")).unwrap();
    refused(Case::load(&case, &[]), &["mu.csv:4:", "0.5 m/s", "above", "rising from 0"]);
}

#[test]
fn intervals_and_counts_that_no_run_could_serve_are_refused() {
    let probes = |n: usize| format!("output.probes.bar=[{}]", "[0, 0],".repeat(n));
    let windows = |n: usize| format!("output.window=[{}]", "{from=0,to=1e-4},".repeat(n));
    let formula = |n: usize| format!("friction.expression=\"0.3{}\"", " + 0*s".repeat(n));
    let expression = |text: String| vec!["friction.law=expression".to_owned(), text];
    let far_below = |key: &str| vec![format!("{key}=1e-14")];
    for (sets, words) in [
        (far_below("output.fields_interval"), ["output.fields_interval = 1e-14 s", "time step"]),
        (far_below("output.contact_interval"), ["output.contact_interval = 1e-14 s", "time step"]),
        (far_below("checkpoint.time"), ["checkpoint.time = 1e-14 s", "time step"]),
        (
            vec!["time.step=2e-12".into(), "output.contact_interval=2e-12".into()],
            ["output.contact_interval makes about", "no disk holds them"],
        ),
        (
            vec!["time.step=2e-12".into(), "output.history_interval=1".into()],
            ["rows of the history", "no disk holds them"],
        ),
        (
            vec!["time.step=2e-12".into(), probes(1000)],
            ["output.probes.bar makes about", "no disk holds them"],
        ),
        (vec![probes(1001)], ["output.probes.bar has 1001 points", "[[output.window]]"]),
        (vec![windows(1001)], ["output.window has 1001 entries", "more than 1000"]),
        (expression(formula(1000)), ["6003 characters, more than 4000", "friction.table"]),
    ] {
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        refused(set(&sets), &words);
    }
    set(&[&probes(1000), &windows(1000)]).unwrap();
}

#[test]
fn implicit_steps_need_exact_contact_and_a_length() {
    let implicit = format!("{SHORT}[time]\nintegrator = \"implicit\"\n");
    refused(read(&implicit), &["short.toml:6:", "contact.enforcement = \"penalty\""]);
    let exact = format!("{implicit}[contact]\nenforcement = \"exact\"\n");
    refused(read(&exact), &["short.toml:6:", "needs time.step"]);
    let theta = format!("{SHORT}[time]\ntheta = 0.5\n");
    refused(read(&theta), &["time.theta", "time.integrator"]);
    let stepped = exact.replace("implicit\"\n", "implicit\"\nstep = 2.5e-6\ntheta = 0.4\n");
    refused(read(&stepped), &["time.theta", "0.5"]);
    assert!(read(&stepped.replace("0.4", "0.5")).is_ok());
    let half_space = format!("{implicit}step = 1e-6\n").replace("[time]", "[time]");
    let half_space = format!("model = \"half-space\"\n{half_space}");
    refused(read(&half_space), &["time.integrator", "half-space"]);
}

#[test]
fn a_sweep_file_in_the_place_of_a_case_is_told_by_its_name() {
    let text = "title = \"t\"\nbase = \"base.toml\"\n[[axis]]\nkey = \"drive.creepage\"\nvalues = [1e-3]\n";
    refused(read(text), &["short.toml:2:", "is a sweep file", "creepage sweep"]);
    refused(read(&text.replace("base = \"base.toml\"\n", "")), &["short.toml:2:", "sweep file"]);
}

#[test]
fn a_misspelt_word_is_refused_with_the_nearest_one() {
    refused(set(&["friction.law=exponentail"]), &["did you mean \"exponential\"?", "\"coulomb\""]);
    refused(set(&["contact.enforcement=exat"]), &["did you mean \"exact\"?"]);
}
