//! What the program takes for an input, and what it does not write over.

use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SHORT: &str = "load.normal = 100e3\ndrive.speed = 38.89\ndrive.creepage = 2.4e-3\n\
                     friction.static = 0.5\n";
const AXIS: &str = "[[axis]]\nkey = \"friction.static\"\nvalues = [0.3]\n";

/// A folder, and commands in it.
struct Place {
    dir: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let place = Self { dir: tempfile::tempdir().unwrap() };
        place.write("case.toml", SHORT);
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), text).unwrap();
    }

    fn pipe(&self, name: &str) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        assert!(Command::new("mkfifo").arg(self.path(name)).status().unwrap().success());
    }

    /// Runs the program; one that waits for a pipe is ended, with another code than its own.
    fn run(&self, args: &[&str]) -> Output {
        let program = env!("CARGO_BIN_EXE_creepage");
        let mut command = Command::new("timeout");
        command.args(["60", program]).args(args).current_dir(self.dir.path());
        command.output().unwrap()
    }

    #[track_caller]
    fn refused(&self, args: &[&str], words: &[&str]) -> String {
        let output = self.run(args);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
        for word in words {
            assert!(said.contains(word), "{args:?}: {word:?} is not in:\n{said}");
        }
        said
    }

    #[track_caller]
    fn done(&self, args: &[&str]) {
        let output = self.run(args);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{args:?}: {said}");
    }

    /// The same refusal, after which the file holds what it held.
    #[track_caller]
    fn spared(&self, name: &str, args: &[&str], words: &[&str]) {
        let before = fs::read(self.path(name)).unwrap();
        self.refused(args, words);
        assert!(fs::read(self.path(name)).unwrap() == before, "{name} was written over");
    }
}

#[test]
fn pipes_and_devices_are_no_inputs_and_are_not_waited_for() {
    let place = Place::new();
    for name in ["p.toml", "p.csv", "p.msh", "p.k", "run/summary.json", "sweep/sweep.json"] {
        place.pipe(name);
    }
    place.pipe("raw/contact.vtkhdf");
    place.write("run/contact.vtkhdf", "");
    place.write("base.toml", "extends = \"p.toml\"\n");
    place.write(
        "table.toml",
        format!("{SHORT}friction.law = \"table\"\nfriction.table = \"p.csv\"\n"),
    );
    place.write("mesh.toml", format!("{SHORT}mesh.file = \"p.msh\"\n"));
    place.write("axis.toml", format!("base = \"base.toml\"\n{AXIS}"));
    for args in [
        &["run", "p.toml"][..],
        &["run", "base.toml"],
        &["mesh", "table.toml"],
        &["mesh", "mesh.toml"],
        &["mesh", "case.toml", "--set", "mesh.file=p.msh"],
        &["sweep", "p.toml"],
        &["sweep", "axis.toml"],
        &["check", "run"],
        &["report", "sweep"],
        &["plot", "sweep"],
        &["import-k", "p.k", "--unit", "mm-ton-s"],
        &["import-contact", "--nodes", "p.csv", "--faces", "p.csv", "--values", "p.csv"],
        &["slider", "--config", "p.toml"],
        &["slider", "--table", "p.csv"],
    ] {
        place.refused(args, &["is a pipe"]);
    }
    place.refused(&["check", "raw"], &["holds no contact.vtkhdf"]);
    place.refused(&["view", "run/contact.vtkhdf"], &["is a file: give the folder of the run"]);
    place.write("swept/sweep.json", r#"{ "parameters": [], "runs": [] }"#);
    place.refused(&["plot", "swept", "--with", "gone"], &["--with gone: there is no such"]);
    for words in [&["check"][..], &["plot"], &["report"], &["view"], &["compare", "raw"]] {
        for gone in ["rums/quick", "run/contact.vtkhfd", "gone/contact.vtkhdf"] {
            let wanted = format!("{gone}: there is no such file or folder");
            let order = [&words[..1], &[gone], &words[1..]].concat();
            place.refused(&order, &[&wanted]);
        }
    }
    for args in [
        &["run", "/dev/zero"][..],
        &["sweep", "/dev/zero"],
        &["import-k", "/dev/zero", "--unit", "mm-ton-s"],
        &["slider", "--config", "/dev/zero"],
        &["slider", "--table", "/dev/zero"],
    ] {
        place.refused(args, &["is a device"]);
    }
}

#[test]
fn pipes_and_devices_are_no_outputs() {
    let place = Place::new();
    for name in ["p.vtu", "p.vtkhdf", "p.csv", "p.sh", "p.html"] {
        place.pipe(name);
    }
    place.write("axis.toml", format!("base = \"case.toml\"\n{AXIS}"));
    place.write("sweep/sweep.json", SWEEP);
    for args in [
        &["mesh", "case.toml", "--out", "p.vtu"][..],
        &["mesh", "case.toml", "--out", "p.vtkhdf"],
        &["slider", "--t-end", "0.1", "--csv", "p.csv"],
        &["sweep", "axis.toml", "--plan", "p.sh"],
        &["report", "sweep", "--out", "p.html"],
    ] {
        place.refused(args, &["is a pipe"]);
    }
    place.refused(&["slider", "--t-end", "0.1", "--csv", "/dev/full"], &["is a device"]);
}

#[test]
fn an_input_without_end_is_refused_with_the_most_that_it_may_have() {
    let place = Place::new();
    for (name, gib) in [("large.toml", 1), ("large.msh", 5), ("large.k", 5), ("large.csv", 1)] {
        let file = fs::File::create(place.path(name)).unwrap();
        // no blocks of the disk are taken
        file.set_len(gib << 30).unwrap();
    }
    place.refused(&["run", "large.toml"], &["larger than 4 MiB"]);
    place.refused(&["mesh", "case.toml", "--set", "mesh.file=large.msh"], &["larger than 4 GiB"]);
    place.refused(&["import-k", "large.k", "--unit", "mm-ton-s"], &["larger than 4 GiB"]);
    place.refused(&["slider", "--table", "large.csv"], &["larger than 512 KiB"]);
}

/// A sweep of one run that failed.
const SWEEP: &str = r#"{ "parameters": ["load.normal"], "runs": [{ "name": "000", "run": "runs/000",
    "parameters": { "load.normal": 1e5 }, "status": "failed", "reason": "planted" }] }"#;

#[test]
fn a_page_replaces_a_page_of_this_program_and_nothing_else() {
    let place = Place::new();
    place.write("sweep/sweep.json", SWEEP);
    place.write("notes.html", "<!DOCTYPE html>\n<p>mine</p>");
    let report = |out| ["report", "sweep", "--out", out];
    place.spared("case.toml", &report("case.toml"), &["must end in .html"]);
    place.spared("sweep/sweep.json", &report("sweep/sweep.json"), &["must end in .html"]);
    place.spared("notes.html", &report("notes.html"), &["not a page that this program wrote"]);
    place.done(&report("new.html"));
    place.done(&report("new.html"));
    place.write("sweep/report.html", "mine");
    place.spared("sweep/report.html", &["report", "sweep"], &["--out"]);
}

#[test]
fn tables_plans_and_meshes_replace_their_like_and_no_input() {
    let place = Place::new();
    place.write("s.toml", "t_end = 0.1\n");
    let csv = |out| ["slider", "--config", "s.toml", "--csv", out];
    place.spared("s.toml", &csv("s.toml"), &["is what is read"]);
    place.spared("case.toml", &csv("case.toml"), &["is there already"]);
    place.done(&csv("steps.csv"));
    place.done(&csv("steps.csv"));

    place.write("axis.toml", format!("base = \"case.toml\"\n{AXIS}"));
    let plan = |out| ["sweep", "axis.toml", "--out", "kt", "--plan", out];
    place.spared("axis.toml", &plan("axis.toml"), &["is what is read"]);
    place.spared("case.toml", &plan("case.toml"), &["is what is read"]);
    place.spared("s.toml", &plan("s.toml"), &["is there already"]);
    place.done(&plan("runs.sh"));
    place.done(&plan("runs.sh"));

    for mesh in ["m.vtu", "m.vtkhdf"] {
        let args = ["mesh", "case.toml", "--out", mesh];
        place.write(mesh, "mine");
        place.spared(mesh, &args, &["is there already"]);
        fs::remove_file(place.path(mesh)).unwrap();
        place.done(&args);
        place.done(&args);
    }
    place.write("again.toml", format!("{SHORT}mesh.file = \"m.vtu\"\n"));
    place.spared("m.vtu", &["mesh", "again.toml", "--out", "m.vtu"], &["is what is read"]);
    // a file of a run has the mark, but is the run's alone
    fs::create_dir(place.path("run")).unwrap();
    fs::copy(place.path("m.vtkhdf"), place.path("run/fields.vtkhdf")).unwrap();
    place.write("run/run.lock", "");
    let into = ["mesh", "case.toml", "--out", "run/fields.vtkhdf"];
    place.spared("run/fields.vtkhdf", &into, &["a file of the run itself"]);
}

#[test]
fn a_case_that_somebody_wrote_is_replaced_by_no_run() {
    let place = Place::new();
    place.write("own/case.toml", SHORT);
    place.write("other.toml", SHORT);
    place.write("derived.toml", "extends = \"own/case.toml\"\n");
    for case in ["own/case.toml", "other.toml", "derived.toml"] {
        for more in [&["--force"][..], &["--resume"], &["--resume", "--force"]] {
            let args = [&["run", case, "--out", "own"], more].concat();
            place.spared("own/case.toml", &args, &["own"]);
        }
    }
    let left: Vec<_> = fs::read_dir(place.path("own")).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn a_name_leads_out_of_no_folder_and_a_plan_has_one_command_a_line() {
    let place = Place::new();
    for name in ["..", ".", "a/b", "a\\nb"] {
        place.write("axis.toml", format!("name = \"{name}\"\nbase = \"case.toml\"\n{AXIS}"));
        place.refused(&["sweep", "axis.toml", "--plan", "plan.sh"], &["cannot name a folder"]);
    }
    place.write("axis.toml", format!("base = \"case.toml\"\n{AXIS}"));
    let plan = |out| ["sweep", "axis.toml", "--out", out, "--plan", "plan.sh"];
    for out in ["a\nb", "a\rb", "a\x1bb"] {
        let said = place.refused(&plan(out), &["cannot stand in a line"]);
        assert!(!said.contains(out), "{said:?}");
    }
    assert_eq!(fs::read_dir(place.dir.path()).unwrap().count(), 2, "nothing was written");
    place.done(&plan("it's one"));
    let lines = fs::read_to_string(place.path("plan.sh")).unwrap();
    assert_eq!(lines.lines().count(), 1, "{lines}");
}

#[test]
fn a_message_shows_no_line_of_a_file_of_another_kind() {
    let place = Place::new();
    let secret = "root:x:0:0\nkey = \"hidden\"\nhidden, 3\n\x1b[31mhidden\n";
    place.write("secret", secret);
    place.write("base.toml", "extends = \"secret\"\n");
    place.write(
        "table.toml",
        format!("{SHORT}friction.law = \"table\"\nfriction.table = \"secret\"\n"),
    );
    place.write("axis.toml", format!("base = \"secret\"\n{AXIS}"));
    place.write("slider.toml", "law = \"table\"\ntable = \"secret\"\n");
    for args in [
        &["run", "base.toml"][..],
        &["run", "secret"],
        &["mesh", "table.toml"],
        &["sweep", "axis.toml"],
        &["slider", "--config", "secret"],
        &["slider", "--config", "slider.toml"],
    ] {
        let said = place.refused(args, &["secret:", "help:"]);
        assert!(!said.contains("root") && !said.contains("hidden"), "{args:?}: {said}");
    }
}

#[test]
fn an_excerpt_is_one_line_and_nothing_in_it_moves_a_terminal() {
    let place = Place::new();
    let bytes = "a = 1 # \x1b]0;title\x07 \u{202e}";
    // a comment may hold no control characters but these; a table may
    place.write("t.csv", "0,0.5\n# before\n1,\x1b[2Jmany\x07\n# after\n");
    place.write(
        "table.toml",
        format!("{SHORT}friction.law = \"table\"\nfriction.table = \"t.csv\"\n"),
    );
    place.write("key.toml", format!("# before\n\"\\u001b[31m\" = 1 # \u{202e}\n# after\n{SHORT}"));
    place.write("bytes.toml", bytes);
    let raw = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
    for (args, line) in [
        (&["mesh", "table.toml"][..], Some("1,\\u{1b}[2Jmany\\u{7}")),
        (&["mesh", "key.toml"], Some("= 1 # \\u{202e}")),
        (&["mesh", "bytes.toml"], None),
        (&["slider", "--table", "t.csv"], None),
    ] {
        let said = place.refused(args, line.as_slice());
        assert!(!said.contains(raw), "{args:?}: {said:?}");
        assert!(!said.contains("before") && !said.contains("after"), "{args:?}: {said}");
    }
}

#[test]
fn a_path_that_is_no_text_is_told() {
    let place = Place::new();
    let name = Path::new(std::ffi::OsStr::from_bytes(b"no\xff\x1b.toml"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    let output = command.arg("run").arg(name).current_dir(place.dir.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(!output.stderr.contains(&0x1b), "{:?}", String::from_utf8_lossy(&output.stderr));
}
