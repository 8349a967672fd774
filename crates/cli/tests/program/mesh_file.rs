//! Mesh files from the command line: what a case says of them, and what is refused.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The case of `meshes/small.*`.
const SMALL: &str = "\
[disk]\nradius = 0.1\nhub_radius = 0.05\nwidth = 0.02\n\
[bar]\nlength = 0.1\nwidth = 0.02\nheight = 0.02\nstart = -0.05\n\
[load]\nnormal = 2000\n[drive]\nspeed = 16\ncreepage = 2e-3\nramp = 1e-4\n[friction]\nstatic = 0.5\n\
[contact.penalty]\nnormal = 1.0\ntangential = 1.0\n[time]\nroll = 4e-4\n\
[mesh.zone]\nsize = 2e-3\nlength = 0.024\nwidth = 0.008\ndepth = 0.004\nstart = -0.012\n\
[mesh]\n";

fn meshes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes")
}

fn creepage(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

/// A folder with the case and a mesh beside it.
fn folder(mesh: &str, text: &[u8], keys: &str) -> (tempfile::TempDir, String) {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join(mesh), text).unwrap();
    let path = dir.path().join("case.toml");
    fs::write(&path, format!("{SMALL}file = {mesh:?}\n{keys}\n")).unwrap();
    (dir, path.display().to_string())
}

#[track_caller]
fn refused(mesh: &str, text: &[u8], keys: &str, words: &[&str]) {
    let (_dir, path) = folder(mesh, text, keys);
    for command in ["mesh", "run"] {
        let output = creepage(&[command, &path]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(!said.contains("panicked"), "{said}");
        for word in words {
            assert!(said.contains(word), "{word:?} is not in:\n{said}");
        }
    }
}

#[test]
fn the_mesh_command_tells_of_a_file_what_it_tells_of_a_generated_mesh() {
    let (_dir, path) = folder("m.msh", &fs::read(meshes().join("small.msh")).unwrap(), "");
    let output = creepage(&["mesh", &path, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let [disk, bar] = [&found["bodies"][0], &found["bodies"][1]];
    assert_eq!((&disk["name"], &bar["name"]), (&"disk".into(), &"bar".into()));
    let sum = disk["elements"].as_u64().unwrap() + bar["elements"].as_u64().unwrap();
    assert_eq!(Some(sum), found["elements"].as_u64());
    for (body, set) in
        [(disk, "hub"), (disk, "tread"), (bar, "top"), (bar, "bottom"), (bar, "ends")]
    {
        assert!(body["sets"][set].as_u64().unwrap() > 10, "{set}");
    }
    assert_eq!(found["notes"], Value::Array(Vec::new()));
}

#[test]
fn a_run_keeps_where_its_mesh_lies_and_what_it_is() {
    let (dir, path) = folder("m.vtu", &fs::read(meshes().join("small.vtu")).unwrap(), "");
    let run = dir.path().join("run");
    let args = ["run", &path, "--quiet", "--out", run.to_str().unwrap()];
    let output = creepage(&args);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let case: toml::Table =
        toml::from_str(&fs::read_to_string(run.join("case.toml")).unwrap()).unwrap();
    let mesh = &case["mesh"];
    assert!(Path::new(mesh["file"].as_str().unwrap()).is_absolute());
    assert_eq!(mesh["sha256"].as_str().unwrap().len(), 64);
    assert_eq!(mesh["sets"]["tread"].as_str(), Some("tread"));
    // another mesh of the same name is no longer that of the run
    fs::copy(meshes().join("disk-on-bar-2mm.vtu"), dir.path().join("m.vtu")).unwrap();
    let kept = run.join("case.toml").display().to_string();
    let output = creepage(&["mesh", &kept]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("mesh.sha256") && said.contains("has changed"), "{said}");
}

#[test]
fn a_bad_mesh_ends_with_code_2_file_line_element_or_set_and_remedy() {
    let small = fs::read_to_string(meshes().join("small.inp")).unwrap();
    let msh = fs::read_to_string(meshes().join("small-2.2.msh")).unwrap();
    let hex = 1 + small.lines().position(|l| l.starts_with("*ELEMENT, TYPE=C3D8RH")).unwrap();
    let id = small.lines().nth(hex).unwrap().split(',').next().unwrap().to_owned();
    let tets = small.replacen("TYPE=C3D8RH", "TYPE=C3D4", 1);
    let (line, element) = (format!("m.inp:{}", hex + 1), format!("element {id}"));
    refused("m.inp", tets.as_bytes(), "", &[&line, &element, "C3D4", "help:"]);
    refused(
        "m.msh",
        msh.replace("\"hub\"", "\"axle\"").as_bytes(),
        "",
        &["m.msh", "no set `hub`", "mesh.sets.hub", "`axle`"],
    );
    let renamed = msh.replace("\"hub\"", "\"axle\"");
    let (_dir, path) = folder("m.msh", renamed.as_bytes(), "sets.hub = \"axle\"");
    assert_eq!(creepage(&["mesh", &path]).status.code(), Some(0));
    refused(
        "m.msh",
        msh.as_bytes(),
        "unit = \"mm\"",
        &["coordinates are in m", "not 0.1 m", "set mesh.unit = \"m\""],
    );
    // a disk of 100 km fits no unit, and is not to be put into the case
    let large = small_scaled(&msh, 1e6);
    refused("m.msh", large.as_bytes(), "", &["radius of the disk", "as mesh.unit"]);
    let binary = fs::read(meshes().join("formats/gmsh-4.1.msh")).unwrap();
    refused("m.msh", &binary[..3000], "", &["m.msh, byte 3000", "the file ends where"]);
    let no_sets = fs::read(meshes().join("formats/no-sets.msh")).unwrap();
    refused("m.msh", &no_sets, "", &["the file has no sets", "meshio keeps cell_sets"]);
    refused("m.stl", b"solid", "", &["case.toml", "mesh.file", ".msh, .inp", "meshio", ".med"]);
}

#[test]
fn a_mesh_of_meshio_without_the_python_package_says_how_to_get_it() {
    let (_dir, path) = folder("m.MED", b"", "");
    let mut bare = Command::new(env!("CARGO_BIN_EXE_creepage"));
    let output = bare.args(["mesh", &path]).env("PATH", "").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    for word in ["m.MED", "meshio", "pip install 'creepage[mesh]'"] {
        assert!(said.contains(word), "{word:?} is not in:\n{said}");
    }
}

#[test]
#[cfg(unix)]
fn what_the_python_package_says_of_a_mesh_is_shown_and_what_it_writes_is_read() {
    use std::os::unix::fs::PermissionsExt;
    let (dir, path) = folder("m.med", b"", "");
    let python = dir.path().join("python3");
    let said_by = |script: &str| {
        // it has the package
        fs::write(&python, format!("#!/bin/sh\n[ \"$1\" = -c ] && exit 0\n{script}")).unwrap();
        fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).unwrap();
        let path_of_programs = format!("{}:/bin:/usr/bin", dir.path().display());
        let mut program = Command::new(env!("CARGO_BIN_EXE_creepage"));
        program.args(["mesh", &path, "--json"]).env("PATH", path_of_programs).output().unwrap()
    };
    for (script, code, words) in [
        ("echo cut short >&2; echo >&2; exit 2", 2, ["m.med: cut short", "write the file anew"]),
        ("echo No module named it >&2; exit 1", 2, ["says: No module named it", "pip install"]),
        ("kill -9 $$", 2, ["says: nothing (signal: 9", "pip install"]),
        ("exit 130", 130, ["interrupted while", "no results yet"]),
        ("echo no grid", 2, ["m.med: the file is no", "write the file anew"]),
    ] {
        let output = said_by(script);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(code), "{said}");
        words.iter().for_each(|word| assert!(said.contains(word), "{word:?} is not in:\n{said}"));
    }
    let output = said_by(&format!("cat '{}'", meshes().join("small.vtu").display()));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&found["elements"], &found["nodes"]), (&2830.into(), &3707.into()));
}

/// A mesh of Gmsh 2.2 whose coordinates are multiplied by a factor.
fn small_scaled(msh: &str, factor: f64) -> String {
    let (before, rest) = msh.split_once("$Nodes\n").unwrap();
    let (nodes, after) = rest.split_once("$EndNodes").unwrap();
    let mut lines = nodes.lines();
    let mut scaled = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let mut words = line.split(' ');
        scaled += words.next().unwrap();
        for x in words {
            scaled += &format!(" {}", factor * x.parse::<f64>().unwrap());
        }
        scaled += "\n";
    }
    format!("{before}$Nodes\n{scaled}$EndNodes{after}")
}

#[test]
fn a_clamp_whose_keyword_goes_on_in_the_next_line_holds_every_node_of_it() {
    let small = fs::read_to_string(meshes().join("small.inp")).unwrap();
    let (before, clamp) = small.split_once("*ELSET, ELSET=clamp\n").unwrap();
    let clamped = |mesh: &str| {
        let (_dir, path) = folder("m.inp", mesh.as_bytes(), "");
        let output = creepage(&["mesh", &path, "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        (found["bodies"][1]["sets"]["bottom"].as_u64().unwrap(), found["notes"].clone())
    };
    let continued = format!("{before}*ELSET,\nELSET=clamp, UNSORTED,\nINTERNAL\n{clamp}");
    assert_eq!(clamped(&continued), (69, Value::Array(Vec::new())));
    let gone = format!("{before}*ELSET, ELSET=clamp\n9999999, {clamp}");
    let line = format!("m.inp:{}", before.lines().count() + 2);
    refused("m.inp", gone.as_bytes(), "", &[&line, "set `clamp` names element 9999999"]);
    let latin_1 = [b"** ge\xe4ndert\n", small.as_bytes()].concat();
    let (_dir, path) = folder("m.inp", &latin_1, "");
    assert_eq!(creepage(&["mesh", &path, "--quiet"]).status.code(), Some(0));
    let wide: Vec<u8> = small.encode_utf16().flat_map(u16::to_le_bytes).collect();
    refused("m.inp", &wide, "", &["a text in UTF-16 is not read", "save the file as UTF-8"]);
}

#[test]
fn what_has_no_meaning_beside_a_mesh_file_is_not_judged() {
    let mesh = fs::read(meshes().join("small.msh")).unwrap();
    let (dir, path) = folder("m.msh", &mesh, "coarsest = 1e-4");
    let text = fs::read_to_string(&path).unwrap().replace("depth = 0.004", "depth = 0.5");
    fs::write(dir.path().join("case.toml"), text).unwrap();
    let output = creepage(&["mesh", &path]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn keys_of_a_mesh_file_without_one_and_files_that_are_not_there_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("case.toml");
    for (keys, words) in [
        ("unit = \"mm\"", ["mesh.unit", "without mesh.file"]),
        ("sets.hub = \"axle\"", ["mesh.sets.hub", "without mesh.file"]),
        ("file = \"none.msh\"", ["mesh.file", "no such file"]),
        ("file = 3", ["mesh.file = 3", "text in quotes"]),
        ("file = \"m.msh\"\nunit = \"km\"", ["mesh.unit = \"km\"", "\"mm\""]),
    ] {
        fs::write(dir.path().join("m.msh"), "").unwrap();
        fs::write(&path, format!("{SMALL}{keys}\n")).unwrap();
        let output = creepage(&["mesh", &path.display().to_string()]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        words.iter().for_each(|word| assert!(said.contains(word), "{word:?} is not in:\n{said}"));
    }
}

#[test]
fn a_mesh_nested_without_end_ends_with_code_2() {
    let deep = format!("{}{}", "<a>".repeat(100_000), "</a>".repeat(100_000));
    refused("m.vtu", deep.as_bytes(), "", &["m.vtu:1", "deep in one another"]);
}

#[test]
fn the_hint_for_a_path_says_what_the_path_is_relative_to() {
    let (dir, path) = folder("m.msh", b"", "");
    let said = |args: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
            .args(args)
            .current_dir(dir.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    for set in ["mesh.file=none.msh", "friction.table=none.csv"] {
        let by_option = said(&["mesh", &path, "--set", "friction.law=table", "--set", set]);
        assert!(by_option.contains("relative to the working directory"), "{by_option}");
    }
    let text = fs::read_to_string(&path).unwrap().replace("m.msh", "none.msh");
    fs::write(&path, text).unwrap();
    let in_file = said(&["mesh", &path]);
    assert!(in_file.contains("relative to this file"), "{in_file}");
}

#[test]
fn a_keyword_file_becomes_a_case_that_loads_and_is_not_written_over() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("small").display().to_string();
    let deck = meshes().join("small.k").display().to_string();
    let args = ["import-k", &deck, "--unit", "mm-ton-s", "--out", &out];
    let output = creepage(&args);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let case = dir.path().join("small/case.toml").display().to_string();
    assert_eq!(creepage(&["mesh", &case, "--quiet"]).status.code(), Some(0));
    let again = creepage(&args);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("there already"));
    // metres for millimetres: a disk of 100 m is no disk that the table of keys allows
    let output = creepage(&["import-k", &deck, "--unit", "m-kg-s", "--out", &format!("{out}-2")]);
    assert_eq!(output.status.code(), Some(2));
    let wrong = creepage(&["import-k", &deck, "--unit", "ft-lb-s"]);
    assert_eq!(wrong.status.code(), Some(2));
}

#[test]
fn a_refused_deck_is_told_by_file_line_and_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("decks");
    fs::create_dir(&folder).unwrap();
    let deck = folder.join("main.k");
    let out = dir.path().join("out").display().to_string();
    for (main, included, words) in [
        ("loads.k", "*INCLUDE\nmain.k\n", "loads.k:2"),
        ("../loads.k", "*TITLE\n", "--include-outside"),
        ("loads.k", "*CONTROL_TERMINATION\n&tend\n", "*PARAMETER"),
        ("loads.k", "*CONTROL_TERMINATION\n&tend\n", "loads.k:2"),
        ("loads.k", "*MAT_ELASTIC_PLASTIC_HYDRO\n", "*MAT_ELASTIC:"),
    ] {
        fs::write(&deck, format!("*KEYWORD\n*INCLUDE\n{main}\n*END\n")).unwrap();
        fs::write(folder.join(main), included).unwrap();
        let path = deck.display().to_string();
        let output = creepage(&["import-k", &path, "--unit", "mm-ton-s", "--out", &out]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        // the report breaks long lines
        let said = said.replace(['\n', ' ', '│'], "");
        assert!(said.contains(words), "{words}: {said}");
    }
}

#[test]
fn a_mesh_that_the_program_wrote_reads_back_with_all_its_sets() {
    let dir = tempfile::tempdir().unwrap();
    let case = dir.path().join("case.toml");
    fs::write(&case, SMALL).unwrap();
    for symmetry in ["whole", "half"] {
        reads_back(&dir, &case, &format!("mesh.symmetry={symmetry}"));
    }
}

/// Writes the mesh of a case in every format and reads it.
fn reads_back(dir: &tempfile::TempDir, case: &Path, symmetry: &str) {
    let mesh = |more: &[String]| -> Value {
        let mut args = vec!["mesh", case.to_str().unwrap(), "--json", "--set", symmetry];
        args.extend(more.iter().map(String::as_str));
        let output = creepage(&args);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let generated = mesh(&[]);
    let counts = |found: &Value| {
        let sets = |body: usize, set: &str| found["bodies"][body]["sets"][set].clone();
        let sets = [sets(0, "hub"), sets(0, "tread"), sets(1, "top"), sets(1, "bottom")];
        let bodies = [0, 1].map(|body| found["bodies"][body]["elements"].clone());
        (bodies, sets, found["nodes"].clone(), found["quality"]["min_scaled_jacobian"].clone())
    };
    for ending in ["msh", "vtu", "vtkhdf"] {
        let file = dir.path().join(format!("own.{ending}")).display().to_string();
        mesh(&["--out".into(), file.clone()]);
        let read = mesh(&["--set".into(), format!("mesh.file={file:?}")]);
        assert_eq!(counts(&read), counts(&generated), "{symmetry} {ending}");
        // what the program wrote it may write over
        mesh(&["--out".into(), file]);
    }
}

#[test]
fn half_a_mesh_where_the_whole_is_wanted_is_refused_with_the_key_to_set() {
    let dir = tempfile::tempdir().unwrap();
    let case = dir.path().join("case.toml");
    fs::write(&case, SMALL).unwrap();
    let case = case.to_str().unwrap();
    let half = dir.path().join("half.vtu").display().to_string();
    let written = ["mesh", case, "--set", "mesh.symmetry=half", "--out", &half];
    assert_eq!(creepage(&written).status.code(), Some(0));
    let file = format!("mesh.file={half:?}");
    let output = creepage(&["mesh", case, "--set", "mesh.symmetry=whole", "--set", &file]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("half a model") && said.contains("mesh.symmetry = \"half\""), "{said}");
}

#[test]
fn a_grid_that_is_no_mesh_of_the_program_is_refused() {
    let bytes = fs::read(meshes().join("small.vtu")).unwrap();
    refused("m.vtkhdf", &bytes, "", &["m.vtkhdf", "creepage mesh CASE --out FILE.vtkhdf"]);
}
