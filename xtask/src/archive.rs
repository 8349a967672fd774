//! `cargo xtask archive`: the program for any Linux of this processor, linked statically, with its completions, manual
//! pages and licences.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step::{cargo, done, target};

/// Completions: the shell, and the name under which it looks for them.
const COMPLETIONS: [(&str, &str); 4] = [
    ("bash", "creepage.bash"),
    ("zsh", "_creepage"),
    ("fish", "creepage.fish"),
    ("powershell", "_creepage.ps1"),
];

/// Texts of the project that go with the program.
const TEXTS: [&str; 5] =
    ["README.md", "CHANGELOG.md", "CITATION.cff", "LICENSE-APACHE", "LICENSE-MIT"];

/// Builds the archive.
pub fn archive(root: &Path) -> Result<PathBuf, String> {
    let machine = format!("{}-unknown-linux-musl", std::env::consts::ARCH);
    let build = ["build", "--release", "--package", "creepage", "--target", &machine];
    cargo(root, &build, &[])
        .map_err(|problem| format!("{problem}: `rustup target add {machine}`?"))?;
    let name = format!("creepage-{}-{machine}", env!("CARGO_PKG_VERSION"));
    let parent = target(root).join("archive");
    let folder = parent.join(&name);
    let program = folder.join("creepage");
    let tell = |error: std::io::Error| format!("{}: {error}", folder.display());
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(tell)?;
    }
    fs::create_dir_all(folder.join("completions")).map_err(tell)?;
    fs::copy(target(root).join(&machine).join("release/creepage"), &program).map_err(tell)?;
    for text in TEXTS {
        fs::copy(root.join(text), folder.join(text)).map_err(tell)?;
    }
    for (shell, file) in COMPLETIONS {
        let file = File::create(folder.join("completions").join(file)).map_err(tell)?;
        done(Command::new(&program).args(["completions", shell]).stdout(file))?;
    }
    done(Command::new(&program).args(["man", "--out"]).arg(folder.join("man")))?;
    let archive = parent.join(format!("{name}.tar.gz"));
    done(Command::new("tar").arg("-czf").arg(&archive).arg("-C").arg(&parent).arg(&name))?;
    Ok(archive)
}

#[cfg(test)]
mod tests {
    use crate::step::root;

    #[test]
    fn the_citation_names_the_version_of_the_program() {
        let citation = std::fs::read_to_string(root().join("CITATION.cff")).expect("CITATION.cff");
        let version = citation.lines().find_map(|line| line.strip_prefix("version: "));
        assert_eq!(version, Some(env!("CARGO_PKG_VERSION")));
    }
}
