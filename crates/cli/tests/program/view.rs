//! `creepage view` and `creepage render`: a run in three dimensions.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

fn creepage(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    command.args(words);
    command
}

/// A run of some records in `folder`.
fn run(folder: &Path, more: &[&str]) -> PathBuf {
    let out = folder.join("run");
    let sets = ["mesh.zone.size=1.6e-3", "time.roll=0.1e-3", "output.fields_interval=5e-6"];
    let mut command = creepage(&["run", CASE, "--quiet", "--threads", "1", "--out"]);
    command.arg(&out).args(sets.iter().flat_map(|set| ["--set", *set])).args(more);
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    out
}

fn view(run: &Path, more: &[&str]) -> Output {
    creepage(&["view", "--json", "--no-open"]).arg(run).args(more).output().unwrap()
}

#[track_caller]
fn refused(output: &Output, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr);
    // the terminal's lines break words apart
    let line = said.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    words.iter().for_each(|word| assert!(line.contains(word), "{word:?} is not in:\n{said}"));
}

/// The data of the scene in the page of a run.
fn scene(run: &Path) -> Value {
    let output = view(run, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let page = run.join("scene.html");
    assert_eq!(document["page"], page.to_str().unwrap());
    let text = fs::read_to_string(page).unwrap();
    assert!(text.contains("class=\"still\"") && !text.contains("src=\"http"));
    let data = text.split("class=\"scene-data\">").nth(1).unwrap();
    serde_json::from_str(data.split("</script>").next().unwrap()).unwrap()
}

/// Numbers packed in base64, four bytes each.
fn unpacked(packed: &Value) -> Vec<[u8; 4]> {
    let digit = |c: u8| {
        let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        digits.iter().position(|d| *d == c).unwrap() as u32
    };
    let text = packed.as_str().unwrap().trim_end_matches('=').as_bytes();
    let bytes = text.chunks(4).flat_map(|four| {
        let bits = four.iter().enumerate().map(|(i, c)| digit(*c) << (26 - 6 * i)).sum::<u32>();
        bits.to_be_bytes().into_iter().take(four.len() * 6 / 8).collect::<Vec<_>>()
    });
    bytes.collect::<Vec<_>>().as_chunks().0.to_vec()
}

fn floats(packed: &Value) -> Vec<f64> {
    unpacked(packed).into_iter().map(|bytes| f64::from(f32::from_le_bytes(bytes))).collect()
}

/// Positions of the nodes of a mesh in a frame (m).
fn placed(mesh: &Value, state: &Value) -> Vec<[f64; 3]> {
    let rigid: Vec<f64> =
        state["rigid"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let (points, deformation) = (floats(&mesh["points"]), floats(&state["deformation"]));
    let nodes = points.as_chunks::<3>().0.iter().zip(deformation.as_chunks::<3>().0);
    let place = |([x, y, z], d): (&[f64; 3], &[f64; 3])| {
        [0, 1, 2].map(|k| {
            let row = &rigid[4 * k..][..4];
            row[0] * x + row[1] * y + row[2] * z + row[3] + d[k]
        })
    };
    nodes.map(place).collect()
}

#[test]
fn the_scene_of_a_run_places_both_bodies_and_their_contact_surfaces() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path(), &[]);
    let scene = scene(&run);
    let names: Vec<&str> =
        scene["fields"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    let wanted = ["von_mises", "velocity", "deformation", "pressure", "shear", "slip_velocity"];
    assert_eq!(names, wanted);
    let meshes = scene["meshes"].as_array().unwrap();
    let of: Vec<(&str, &str)> = meshes
        .iter()
        .map(|mesh| (mesh["name"].as_str().unwrap(), mesh["group"].as_str().unwrap()))
        .collect();
    let both = [("disk", "bodies"), ("bar", "bodies"), ("disk", "contact"), ("bar", "contact")];
    assert_eq!(of, both);

    let last = scene["frames"].as_array().unwrap().last().unwrap();
    let states = last["meshes"].as_array().unwrap();
    let lowest = |k: usize, start: f64, take: fn(f64, f64) -> f64| {
        placed(&meshes[k], &states[k]).iter().fold(start, |found, p| take(found, p[2]))
    };
    // the disk stands on the bar: below the bar's surface by the approach, which is far less than an element
    let disk = lowest(0, f64::INFINITY, f64::min);
    let bar = lowest(1, f64::NEG_INFINITY, f64::max);
    assert!((disk - bar).abs() < 2e-4, "{disk} {bar}");
    // the surfaces lie on their bodies
    for k in [2, 3] {
        let body = placed(&meshes[k - 2], &states[k - 2]);
        let off = placed(&meshes[k], &states[k]).into_iter().map(|p| {
            let far = |q: &[f64; 3]| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt();
            body.iter().map(far).fold(f64::INFINITY, f64::min)
        });
        assert!(off.fold(0.0, f64::max) < 2e-5, "surface {k}");
    }
    // the pressure is that of the run, in MPa
    let summary: Value =
        serde_json::from_slice(&fs::read(run.join("summary.json")).unwrap()).unwrap();
    let peak = floats(&states[3]["values"]["pressure"]).into_iter().fold(0.0, f64::max);
    let mean = summary["contact"]["peak_pressure"].as_f64().unwrap() / 1e6;
    assert!((peak / mean - 1.0).abs() < 0.3, "{peak} {mean}");
    let (vector, size) = (floats(&states[3]["shear_vector"]), &states[3]["values"]["shear"]);
    for (vector, size) in vector.as_chunks::<3>().0.iter().zip(floats(size)) {
        let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length - size).abs() < 1e-3 * peak, "{vector:?} {size}");
    }
}

#[test]
fn what_is_not_there_is_said_with_the_remedy_and_files_of_others_stay() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path(), &["--set", "output.stress=false"]);
    let fields = scene(&run)["fields"].clone();
    assert_eq!(fields[0]["name"], "velocity");

    let mine = folder.path().join("mine.html");
    fs::write(&mine, "of somebody").unwrap();
    refused(&view(&run, &["--out", mine.to_str().unwrap()]), &["is there already"]);
    assert_eq!(fs::read(&mine).unwrap(), b"of somebody");
    refused(&view(&run, &["--out", run.join("no/a.html").to_str().unwrap()]), &["no folder"]);

    // the surfaces alone
    fs::remove_file(run.join("summary.json")).unwrap();
    fs::remove_file(run.join("run.log")).unwrap();
    fs::remove_file(run.join("fields.vtkhdf")).unwrap();
    assert_eq!(scene(&run)["meshes"].as_array().unwrap().len(), 2);
    fs::remove_file(run.join("contact.vtkhdf")).unwrap();
    refused(&view(&run, &[]), &["holds no fields.vtkhdf", "output.fields_interval"]);
}

#[test]
fn a_damaged_file_is_refused_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path(), &[]);
    for name in ["fields.vtkhdf", "contact.vtkhdf"] {
        let path = run.join(name);
        let bytes = fs::read(&path).unwrap();
        let mut flipped = bytes.clone();
        flipped[bytes.len() / 2] ^= 4;
        fs::write(&path, &flipped).unwrap();
        refused(&view(&run, &[]), &[name, "crc32", "copy it again"]);
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        refused(&view(&run, &[]), &[name]);
        fs::write(&path, &bytes).unwrap();
    }
    // without checksums the reader has to see it
    fs::remove_file(run.join("summary.json")).unwrap();
    fs::remove_file(run.join("run.log")).unwrap();
    for name in ["fields.vtkhdf", "contact.vtkhdf"] {
        let path = run.join(name);
        let bytes = fs::read(&path).unwrap();
        for share in [0.0, 0.02, 0.5, 0.9] {
            fs::write(&path, &bytes[..(share * bytes.len() as f64) as usize]).unwrap();
            refused(&view(&run, &[]), &[name]);
        }
        for at in (0..bytes.len()).step_by(bytes.len() / 23 + 1) {
            let mut flipped = bytes.clone();
            flipped[at] ^= 0x40;
            fs::write(&path, flipped).unwrap();
            let output = view(&run, &[]);
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(matches!(output.status.code(), Some(0 | 2)), "{name} at {at}: {said}");
            assert!(!said.contains("panicked"), "{name} at {at}: {said}");
        }
        fs::write(&path, &bytes).unwrap();
    }
}

#[test]
fn render_without_the_python_package_says_how_to_get_it() {
    let mut bare = creepage(&["render", "somewhere"]);
    refused(&bare.env("PATH", "").output().unwrap(), &["pip install 'creepage[render]'"]);
}
