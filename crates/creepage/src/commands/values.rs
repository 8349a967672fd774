//! What the values of options must be, and how they are read from the words of a command line.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::rule::{Rule, all_cores};
use crate::run::Level;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

use crate::{Error, Listener};

/// Threads of a measurement.
pub const ONE_PER_CORE: Rule<usize> =
    Rule { holds: |n| *n <= all_cores(), wanted: "one thread per core at most is needed" };
/// Edge of a block, in elements.
pub const EDGE: Rule<usize> =
    Rule { holds: |n| (1..=400).contains(n), wanted: "a whole number from 1 to 400 is needed" };
/// Instruction set of the element kernels.
pub const KERNELS: Rule<Level> = Rule {
    holds: |level| level.available(),
    wanted: "this machine does not have these instructions",
};
/// Contact transits.
pub const TRANSITS: Rule<f64> =
    Rule { holds: |n| n.is_finite() && *n > 0.0, wanted: "a number greater than 0 is needed" };
/// Memory (MB).
pub const MEGABYTES: Rule<f64> =
    Rule { holds: TRANSITS.holds, wanted: "a positive number of megabytes is needed" };
/// Width of a figure (mm).
pub const PAPER_WIDTH: Rule<f64> = Rule {
    holds: |mm| (30.0..=1000.0).contains(mm),
    wanted: "a number of millimetres from 30 to 1000 is needed",
};
/// Size of letters (points of 1/72 inch).
pub const FONT_SIZE: Rule<f64> = Rule {
    holds: |pt| (4.0..=24.0).contains(pt),
    wanted: "a number of points from 4 to 24 is needed",
};
/// A window of time (s).
pub const WINDOW: Rule<[f64; 2]> =
    Rule { holds: |[from, to]| from <= to, wanted: "the window ends before it begins" };
/// The file of a mesh.
pub const MESH: Rule<PathBuf> = Rule {
    holds: |path| ends(path, &["vtu", "vtkhdf", "msh"]),
    wanted: "the file's name must end in .vtu, .vtkhdf or .msh",
};
/// The file of a map of violations.
pub const MAP: Rule<PathBuf> =
    Rule { holds: |path| ends(path, &["vtkhdf"]), wanted: "the file's name must end in .vtkhdf" };
/// The file of a figure.
pub const FIGURE: Rule<PathBuf> = Rule {
    holds: |path| ends(path, &["svg", "pdf", "png"]),
    wanted: "the file's name must end in .svg, .pdf or .png",
};

fn ends(path: &Path, endings: &[&str]) -> bool {
    path.extension().and_then(|ending| ending.to_str()).is_some_and(|it| endings.contains(&it))
}

/// Refuses options that exclude one another, by which of them are given.
pub fn exclude(option: (&str, bool), others: &[(&str, bool)]) -> Result<(), Error> {
    match others.iter().find(|(_, given)| option.1 && *given) {
        None => Ok(()),
        Some((other, _)) => Err(Error::plain(format!("{} cannot be used with {other}", option.0))),
    }
}

/// The number of threads of a run: as many as `asked` for, else one per core. More than one per core would only wait for
/// one another, and with hundreds the waiting takes minutes: they are left out, which the listener hears.
pub fn threads(asked: Option<usize>, listener: &mut dyn Listener) -> usize {
    let cores = all_cores();
    if let Some(asked) = asked.filter(|asked| *asked > cores) {
        let (s, are) = if cores == 1 { ("", "is") } else { ("s", "are") };
        listener.remark(&format!(
            "--threads {asked}: this process has {cores} core{s}, and {cores} thread{s} {are} used"
        ));
    }
    asked.map_or(cores, |asked| asked.min(cores))
}

/// Reads a value from its text.
pub fn parsed<'de, D, T>(deserializer: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: FromStr<Err = &'static str>,
{
    String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
}

/// Reads a value that may be left out from its text.
pub fn maybe_parsed<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: FromStr<Err = &'static str>,
{
    parsed(deserializer).map(Some)
}

/// Reads values from their texts.
pub fn all_parsed<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: FromStr<Err = &'static str>,
{
    let texts = Vec::<String>::deserialize(deserializer)?;
    texts.iter().map(|text| text.parse().map_err(D::Error::custom)).collect()
}

/// Values from the words of a command line.
#[cfg(feature = "clap")]
pub mod words {
    use crate::run::Level;

    use super::{KERNELS, WINDOW};

    /// A window of time (s), either end of which may be left out.
    pub fn window(text: &str) -> Result<[f64; 2], &'static str> {
        let wanted = "two times in seconds with a colon between, such as 1.0e-3:1.5e-3, are needed";
        let (from, to) = text.split_once(':').ok_or(wanted)?;
        let end = |text: &str, open: f64| match text.trim() {
            "" => Ok(open),
            text => text.parse::<f64>().ok().filter(|t| t.is_finite()).ok_or(wanted),
        };
        let window = [end(from, f64::NEG_INFINITY)?, end(to, f64::INFINITY)?];
        Some(window).filter(WINDOW.holds).ok_or(WINDOW.wanted)
    }

    /// A number by its name.
    pub fn named(text: &str) -> Result<(String, f64), &'static str> {
        let wanted = "a name and a number, such as law_error=0.02, are needed";
        let (name, value) = text.split_once('=').ok_or(wanted)?;
        Ok((name.trim().to_owned(), value.trim().parse().map_err(|_| wanted)?))
    }

    /// An instruction set of this machine.
    pub fn kernels(text: &str) -> Result<Level, &'static str> {
        let level: Level = text.parse()?;
        Some(level).filter(KERNELS.holds).ok_or(KERNELS.wanted)
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use crate::run::Level;

    use crate::{
        BenchOptions, BlockElement, CheckOptions, Error, ExportKOptions, ImportContactOptions,
        ImportKOptions, MeshOptions, PairingReport, RenderOptions, RunOptions, SliderOptions,
        SweepOptions, VerifyOptions,
    };

    fn refused<T>(found: Result<T, Error>, said: &str) {
        let error = found.map(drop).unwrap_err();
        assert!(error.to_string().contains(said) && error.exit_code() == 2, "{error}");
    }

    #[test]
    fn values_out_of_their_range_are_refused_by_the_name_of_their_option() {
        let run = RunOptions { threads: Some(0), ..RunOptions::default() };
        refused(crate::run(&run, &mut ()), "--threads: a whole number from 1 to 1024");
        let mesh = MeshOptions { out: Some("mesh.stl".into()), ..MeshOptions::default() };
        refused(crate::mesh(&mesh, &mut ()), "--out: the file's name must end in .vtu");
        for level in Level::ALL.into_iter().filter(|level| !level.available()) {
            let bench = BenchOptions { kernels: Some(level), ..BenchOptions::default() };
            refused(
                crate::bench(&bench),
                "--kernels: this machine does not have these instructions",
            );
        }
        let mut check = CheckOptions::default();
        check.span.window = Some([2.0, 1.0]);
        refused(crate::check(&check), "--window: the window ends before it begins");
        check.span.window = Some([f64::NAN, 1.0]);
        refused(crate::check(&check), "--window");
    }

    #[test]
    fn a_run_takes_no_more_threads_than_there_are_cores_and_says_so() {
        struct Heard(Vec<String>);
        impl crate::Listener for Heard {
            fn remark(&mut self, line: &str) {
                self.0.push(line.to_owned());
            }
        }
        let (cores, mut heard) = (super::all_cores(), Heard(Vec::new()));
        assert_eq!([None, Some(cores)].map(|n| super::threads(n, &mut heard)), [cores; 2]);
        assert_eq!(super::threads(Some(1), &mut heard), 1);
        assert!(heard.0.is_empty(), "{:?}", heard.0);
        assert_eq!(super::threads(Some(1024), &mut heard), cores);
        assert!(heard.0[0].starts_with("--threads 1024: this process has"), "{:?}", heard.0);
        // a measurement with another number of threads than was asked for would mislead
        let bench = BenchOptions { threads: Some(1024), ..BenchOptions::default() };
        refused(crate::bench(&bench), "--threads: one thread per core at most is needed");
    }

    #[test]
    fn options_that_exclude_one_another_are_refused() {
        let sweep = SweepOptions { resume: true, force: true, ..SweepOptions::default() };
        refused(crate::sweep(&sweep, &mut ()), "--resume cannot be used with --force");
        let slider = SliderOptions { tables: true, ..SliderOptions::default() };
        let plot = SliderOptions { plot: Some("figures".into()), ..slider.clone() };
        refused(crate::slider(&plot, &mut ()), "--tables cannot be used with --plot");
        let mut mass = slider;
        mass.settings.mass = Some(0.1);
        refused(crate::slider(&mass, &mut ()), "--tables cannot be used with a parameter");
    }

    #[test]
    fn options_are_read_from_toml_and_unknown_ones_refused() {
        let text = "run = 'runs/a'\npairing = 'before'\nspan.window = [-inf, 1e-3]\n\
                    limits = [['law_error', 0.02]]";
        let read: CheckOptions = toml::from_str(text).unwrap();
        assert_eq!(read.run, PathBuf::from("runs/a"));
        assert_eq!(read.pairing, Some(PairingReport::Only(crate::Pairing::Before)));
        assert_eq!(read.span.window, Some([f64::NEG_INFINITY, 1e-3]));
        assert_eq!(read.limits, [("law_error".to_owned(), 0.02)]);
        let wrong = toml::from_str::<CheckOptions>("pairing = 'both'").unwrap_err();
        assert_eq!(wrong.message(), "one of stricter, before, after is needed");
        assert!(toml::from_str::<CheckOptions>("windows = 1").is_err());
    }

    #[test]
    fn options_of_measurements_decks_and_tables_are_read_from_toml() {
        let text = "kernels = 'portable'\nblock = 20\nelement = 'full'";
        let bench: BenchOptions = toml::from_str(text).unwrap();
        assert_eq!((bench.kernels, bench.block), (Some(Level::Portable), Some(20)));
        assert_eq!(bench.element, BlockElement::Full);
        let wrong = toml::from_str::<BenchOptions>("element = 'half'").unwrap_err();
        assert_eq!(wrong.message(), "one of one-point, full is needed");

        let export: ExportKOptions = toml::from_str("case.path = 'a.toml'").unwrap();
        assert_eq!(export.unit.name(), "mm-ton-s");
        let import: ImportKOptions = toml::from_str("file = 'a.k'\nunit = 'm-kg-s'").unwrap();
        assert_eq!((import.unit.name().as_str(), import.include_outside), ("m-kg-s", false));
        assert!(toml::from_str::<ImportKOptions>("file = 'a.k'").is_err(), "units are needed");

        let text = "nodes = 'n.csv'\nfaces = 'f.csv'\nvalues = 'v.csv'";
        let import: ImportContactOptions = toml::from_str(text).unwrap();
        assert_eq!(import.out, PathBuf::from("contact.vtkhdf"));
        assert!(toml::from_str::<ImportContactOptions>("nodes = 'n.csv'").is_err());
    }

    #[test]
    fn options_that_another_program_takes_become_its_words() {
        let verify: VerifyOptions = toml::from_str("names = ['hertz']\nquick = true").unwrap();
        assert_eq!(verify.words(), ["--quick", "--", "hertz"]);
        let render: RenderOptions = toml::from_str("run = '-r'\ntime = '-1'").unwrap();
        assert_eq!(render.words(), ["--time=-1", "--", "-r"]);
        let all = "run = 'r'\ntime = '1'\nfield = 'f'\nwhat = 'c'\nview = 'w'\nout = 'o'\nmagnify = '2'\nspan = '3'\n\
                   width = '4'\nframes = '5'";
        let words = toml::from_str::<RenderOptions>(all).unwrap().words();
        for word in [
            "--field=f",
            "--what=c",
            "--view=w",
            "--out=o",
            "--magnify=2",
            "--span=3",
            "--width=4",
            "--frames=5",
        ] {
            assert!(words.iter().any(|there| there == word), "{word}: {words:?}");
        }
    }
}
