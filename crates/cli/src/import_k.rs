//! `creepage import-k`: LS-DYNA keyword files of a disk on a bar.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use case::Case;
use files::input;
use ls_dyna::{Units, translate};
use miette::miette;
use serde_json::json;

use crate::args::Args;
use crate::failure::{BAD_INPUT, Failure};

/// Options of `import-k`.
#[derive(Debug, clap::Args)]
pub struct ImportKArgs {
    /// The keyword file
    #[arg(value_name = "FILE.k")]
    file: PathBuf,
    /// Units of the file: length (m, cm, mm, in), mass (kg, ton, g), time (s, ms, us)
    #[arg(long, value_name = "mm-ton-s", value_parser = units)]
    unit: Units,
    /// Folder for case.toml and mesh.inp [default: the file's name without its ending]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

fn units(text: &str) -> Result<Units, String> {
    Units::parse(text).ok_or_else(|| {
        "a length (m, cm, mm, in), a mass (kg, ton, g) and a time (s, ms, us) are needed, as mm-ton-s"
            .into()
    })
}

/// Runs the command.
pub fn command(args: &Args, options: &ImportKArgs) -> Result<u8, Failure> {
    let file = options.file.display();
    let bytes = input::bytes(&options.file, input::MESH).map_err(|error| Failure {
        report: miette!(help = "name an LS-DYNA keyword file", "{error}"),
        code: BAD_INPUT,
    })?;
    let name = options.file.file_name().unwrap_or_default().to_string_lossy();
    let made = translate(&bytes, options.unit, &name, "mesh.inp").map_err(|error| {
        let place = error.line.map_or(String::new(), |line| format!(":{line}"));
        let help = scenario::Remedy::remedy(&error.fault);
        Failure { report: miette!(help = help, "{file}{place}: {}", error.fault), code: BAD_INPUT }
    })?;
    let folder = options.out.clone().unwrap_or_else(|| options.file.with_extension(""));
    let [case, mesh] = ["case.toml", "mesh.inp"].map(|name| folder.join(name));
    if let Some(there) = [&case, &mesh].into_iter().find(|path| path.exists()) {
        let help = "choose another folder with --out DIR";
        let report = miette!(help = help, "{} is there already", there.display());
        return Err(Failure { report, code: BAD_INPUT });
    }
    write(&folder, &mesh, &made.mesh)?;
    write(&folder, &case, &made.case)?;
    // the case is judged as any other, so that what is wrong is told now
    let loaded = Case::load(&case, &[])?;
    let found = ::run::mesh_report(&loaded, None)?;
    let elements = found["elements"].as_u64().unwrap_or_default();
    if args.json {
        args.print_json(&json!({
            "case": case.display().to_string(),
            "mesh": mesh.display().to_string(),
            "elements": elements,
            "notes": made.notes,
        }));
    } else if !args.quiet {
        let mut out = std::io::stdout();
        for note in &made.notes {
            let _ = writeln!(out, "  {note}");
        }
        let _ = writeln!(out, "{}: {elements} elements; creepage run {0}", case.display());
    }
    Ok(0)
}

fn write(folder: &Path, path: &Path, text: &str) -> Result<(), Failure> {
    fs::create_dir_all(folder).and_then(|()| fs::write(path, text)).map_err(|cause| Failure {
        report: miette!(
            help = "choose another folder with --out DIR",
            "{}: {cause}",
            path.display()
        ),
        code: BAD_INPUT,
    })
}
