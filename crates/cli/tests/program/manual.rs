//! Completions for shells, and manual pages.

use std::process::{Command, Output};

const COMMANDS: [&str; 6] = ["run", "mesh", "check", "report", "sweep", "verify"];

fn creepage(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

fn printed(args: &[&str]) -> String {
    let output = creepage(args);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_shell_completes_commands_and_options() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = printed(&["completions", shell]);
        for word in COMMANDS.into_iter().chain(["resume", "threads"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
}

#[test]
fn every_command_has_a_manual_page_with_its_options() {
    let program = printed(&["man"]);
    for command in COMMANDS {
        assert!(program.contains(&format!("creepage\\-{command}(1)")), "{command}");
        let page = printed(&["man", command]);
        let title = page.lines().find(|line| line.starts_with(".TH")).unwrap();
        assert!(title.contains(&format!("creepage-{command}")), "{title}");
        assert!(page.contains("\\-\\-json"), "{command}");
    }
    assert!(printed(&["man", "run"]).contains("\\-\\-resume"));
}

#[test]
fn the_manual_of_an_unknown_command_is_refused_with_those_that_there_are() {
    let output = creepage(&["man", "walk"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("walk") && said.contains("run, cases, mesh"), "{said}");
}

#[test]
fn all_manual_pages_are_written_into_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let man = folder.path().join("share/man1");
    printed(&["man", "--out", man.to_str().unwrap()]);
    assert_eq!(
        std::fs::read_to_string(man.join("creepage.1")).unwrap().lines().next(),
        Some(".ie \\n(.g .ds Aq \\(aq")
    );
    for command in COMMANDS {
        let page = std::fs::read_to_string(man.join(format!("creepage-{command}.1"))).unwrap();
        assert!(page.contains("\\-\\-json"), "{command}");
    }
    let output = creepage(&["man", "--out", man.join("creepage.1").to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
}
