//! What a run is measured against: its friction law and the scales of its measures.

use crate::check::PostError;
use crate::check::frames::open_history;
use crate::check::law::Law;
use crate::check::recorded_law::{RecordedLaw, recorded_law};
use contact::patch::PatchShape;
use friction::{Parameters, all_parameters};
use output::files::input::{self, Kind};
use output::layout::{HISTORY, file};
use output::read_summary;
use output::summary::{Position, Summary};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A scale and its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Its value (SI).
    pub value: f64,
    /// Its origin, as documents state it.
    pub from: String,
}

/// The scale of slip.
const SLIP_SCALE: &str =
    "s_c = V sqrt(creepage^2 + lateral creepage^2 + (spin a)^2), at least 1e-5 V";

/// Names of the scales, with their unit and meaning; `[scales]` of a case file and
/// `creepage check --scale NAME=VALUE` set them.
pub const SCALES: [(&str, &str, &str); 11] = [
    ("peak_pressure", "Pa", "p0, Hertz's peak pressure"),
    ("approach", "m", "delta, Hertz's approach"),
    ("half_length", "m", "a, half axis of the patch along x"),
    ("half_width", "m", "b, half axis of the patch along y"),
    ("speed", "m/s", "V, rolling speed"),
    ("creepage", "1", "longitudinal creepage"),
    ("slip_speed", "m/s", SLIP_SCALE),
    ("slip_threshold", "m/s", "eps_s = 1e-3 s_c, above which a node slips"),
    ("dt", "s", "time step"),
    ("size", "m", "h, edge of a surface element"),
    ("shear_wave", "m/s", "c_s, speed of shear waves"),
];

/// Which coefficient of friction `mu` bounds the shear, |p_tau| <= mu p_n.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// mu(|s|) of the law at the same instant: Eq. (8).
    Law,
    /// The law's coefficient recomputed from the records; where that is not known to round-off, the one that the
    /// algorithm used (field `mu`). For laws with a state.
    Used,
}

/// The friction law and the scales of a run.
#[derive(Clone, Debug)]
pub struct Basis {
    /// Name of the case.
    pub name: String,
    /// The law mu(|s|), where it is Coulomb's or Eq. (8).
    pub law: Option<Law>,
    /// The law of a contact node with its state, by which the coefficient is recomputed from the records; or the
    /// reason why there is none, empty where there is no case.
    pub friction: Result<RecordedLaw, String>,
    /// The bound of friction.
    pub bound: Bound,
    /// `contact.enforcement` of the case; `exact` for half-spaces.
    pub enforcement: Option<String>,
    /// The evaluation window, from and to (s); `None` where no summary states it.
    pub window: Option<[f64; 2]>,
    /// Shape of the patch; an ellipse where nothing is known.
    pub shape: PatchShape,
    /// Scales by their names in [`SCALES`].
    pub scales: BTreeMap<&'static str, Scale>,
    /// `summary.json`, where there is one.
    pub summary: Option<Summary>,
    /// `case.toml`, where there is one.
    pub case: Option<toml::Table>,
}

/// Paths of a run's files.
#[derive(Clone, Debug)]
pub struct RunPaths {
    /// Its folder.
    pub folder: PathBuf,
    /// Its contact history.
    pub contact: PathBuf,
    /// Its case.
    pub case: PathBuf,
}

/// Refuses what can be no run: a path where nothing is, or a file in TOML.
///
/// # Errors
/// [`PostError::NoSuchRun`], [`PostError::NotYetRun`].
pub(crate) fn may_be_run(run: &Path) -> Result<(), PostError> {
    if !run.exists() {
        return Err(PostError::NoSuchRun { path: run.into() });
    }
    if run.is_file() && run.extension().is_some_and(|extension| extension == "toml") {
        return Err(PostError::NotYetRun { path: run.into() });
    }
    Ok(())
}

impl RunPaths {
    /// The files of the run at `run`, its folder or its contact history.
    ///
    /// # Errors
    /// [`PostError::NoSuchRun`] where there is nothing, [`PostError::NotYetRun`] for a file in TOML,
    /// [`PostError::NoContactFile`] for any other path that is neither.
    pub fn of(run: &Path) -> Result<Self, PostError> {
        may_be_run(run)?;
        let none = || PostError::NoContactFile { path: run.into() };
        let folder = if run.is_dir() { run } else { run.parent().ok_or_else(none)? };
        // that of a file in the working directory is empty
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let contact = if run.is_dir() { run.join(file::CONTACT) } else { run.into() };
        if !contact.is_file() {
            return Err(none());
        }
        Ok(Self { folder: folder.into(), contact, case: folder.join(file::CASE) })
    }

    /// The name of the folder, also where its path ends in none, as `.` and `..`.
    pub fn name(&self) -> String {
        let folder = self.folder.canonicalize().unwrap_or_else(|_| self.folder.clone());
        folder.file_name().map_or_else(|| "run".into(), |name| name.to_string_lossy().into_owned())
    }
}

impl Basis {
    /// Reads `case.toml`, `summary.json` and `history.h5` of a run, each where it exists: a run in progress
    /// has no summary yet, data of other codes may have none of the three.
    ///
    /// Unknown keys of the case are ignored: other codes and other versions write other keys.
    ///
    /// # Errors
    /// A case that is not TOML, a summary that is not what was written, a history that cannot be read.
    pub fn read(paths: &RunPaths) -> Result<Self, PostError> {
        let case = read_toml(&paths.case)?;
        let summary = read_summary(&paths.folder)?;
        let mut basis = Self {
            name: paths.name(),
            law: None,
            friction: Err(String::new()),
            bound: Bound::Used,
            enforcement: None,
            window: None,
            shape: PatchShape::default(),
            scales: BTreeMap::new(),
            summary,
            case,
        };
        basis.read_case();
        basis.read_summary();
        basis.read_history(&paths.folder.join(file::HISTORY))?;
        Ok(basis)
    }

    /// The first `[[output.window]]` of the case, from and to (s).
    pub(crate) fn recorded_window(&self) -> Option<[f64; 2]> {
        let window = self.case.as_ref()?.get("output")?.get("window")?.get(0)?;
        let end = |key: &str| number_at(window.as_table()?, key);
        Some([end("from")?, end("to")?])
    }

    /// The value (SI) of the scale `name` of [`SCALES`], where it is known.
    pub fn scale(&self, name: &str) -> Option<f64> {
        self.scales.get(name).map(|scale| scale.value)
    }

    /// The scale `name` by Hertz (SI), where it is known apart from the records.
    pub(crate) fn hertz(&self, name: &str) -> Option<f64> {
        let scale = self.scales.get(name).filter(|scale| !scale.from.contains("last record"));
        scale.map(|scale| scale.value)
    }

    /// Sets a scale (SI) that is not known yet; `from` is its origin. Ignores names that are not in [`SCALES`], zero
    /// and values that are not finite.
    pub fn offer(&mut self, name: &str, value: f64, from: &str) {
        let known = SCALES.iter().find(|(known, ..)| *known == name);
        if let (Some((name, ..)), true) = (known, value.is_finite() && value != 0.0) {
            self.scales.entry(name).or_insert_with(|| Scale { value, from: from.into() });
        }
    }

    /// Sets a scale (SI) for the user, whatever was known.
    ///
    /// # Errors
    /// A name that is not in [`SCALES`], or a value that is not positive (creepage may have either sign).
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), PostError> {
        let Some((known, ..)) = SCALES.iter().find(|(known, ..)| *known == name) else {
            let names: Vec<_> = SCALES.iter().map(|(name, ..)| *name).collect();
            return Err(PostError::Asked(format!(
                "there is no scale '{name}'; the scales are {}",
                names.join(", ")
            )));
        };
        if !(value.is_finite() && (value > 0.0 || name == "creepage")) {
            return Err(PostError::Asked(format!(
                "the scale {name} = {value} must be a number greater than 0"
            )));
        }
        self.scales.insert(known, Scale { value, from: "asked for".into() });
        Ok(())
    }

    /// Derives `slip_speed` from speed and creepage and `slip_threshold` from `slip_speed`, where they are not
    /// known.
    pub fn complete(&mut self) {
        // what the position of a wheel adds along x is part of a run's mean creepage
        let position = self.summary.as_ref().and_then(|summary| summary.position);
        let driven = |key, more: fn(Position) -> f64| {
            let parts = [self.number(key), position.map(more)];
            parts.iter().flatten().copied().filter(|x| x.is_finite()).reduce(|sum, part| sum + part)
        };
        let spin = driven("drive.spin", |at| at.spin).zip(self.scale("half_length"));
        let parts = [
            self.scale("creepage"),
            driven("drive.lateral_creepage", |at| at.lateral),
            spin.map(|(spin, a)| spin * a),
        ];
        let slips = parts.iter().flatten().any(|part| *part != 0.0);
        if let Some(speed) = self.scale("speed").filter(|_| slips) {
            let rigid = parts.iter().flatten().fold(0.0, |sum, part| libm::hypot(sum, *part));
            self.offer("slip_speed", rigid.max(1e-5) * speed.abs(), SLIP_SCALE);
        }
        if let Some(slip) = self.scale("slip_speed") {
            self.offer("slip_threshold", 1e-3 * slip, "1e-3 s_c");
        }
    }

    /// `[friction]` of the case, without keys that this version does not know.
    pub(super) fn parameters(&self) -> Option<Parameters> {
        let mut table = self.case.as_ref()?.get("friction")?.as_table()?.clone();
        table.retain(|key, _| key == "law" || all_parameters().any(|known| known == key));
        table.try_into().ok()
    }

    fn number(&self, path: &str) -> Option<f64> {
        number_at(self.case.as_ref()?, path)
    }

    fn word(&self, path: &str) -> Option<String> {
        Some(value_at(self.case.as_ref()?, path)?.as_str()?.to_owned())
    }

    fn read_case(&mut self) {
        if let Some(name) = self.word("name") {
            self.name = name;
        }
        // half-spaces have no penalty
        let half_space = self.word("model").is_some_and(|model| model == "half-space");
        let exact = half_space.then(|| "exact".to_owned());
        self.enforcement = exact.or_else(|| self.word("contact.enforcement"));
        self.law = self.parameters().and_then(|parameters| Law::of(&parameters));
        let remembers = self.case.as_ref().and_then(|case| value_at(case, "friction.memory"));
        if self.law.is_some() && remembers.is_none() {
            self.bound = Bound::Law;
        }
        if let Some(case) = &self.case {
            let sampled = self.summary.as_ref().and_then(|summary| summary.friction_law.as_deref());
            self.friction = recorded_law(case, sampled);
        }
        let given: Vec<_> = SCALES
            .iter()
            .filter_map(|(name, ..)| Some((*name, self.number(&format!("scales.{name}"))?)))
            .collect();
        for (name, value) in given {
            self.offer(name, value, "case, [scales]");
        }
        for (name, key) in [("speed", "drive.speed"), ("size", "mesh.zone.size")] {
            if let Some(value) = self.number(key) {
                self.offer(name, value, &format!("case, {key}"));
            }
        }
        let steel = |key, default| match self.number(&format!("material.{key}")) {
            // the defaults of a case file, for cases that were not resolved
            None => self.case.as_ref().filter(|case| case.contains_key("load")).map(|_| default),
            known => known,
        };
        if let (Some(young), Some(poisson), Some(density)) =
            (steel("young", 210e9), steel("poisson", 0.3), steel("density", 7800.0))
        {
            let shear = young / (2.0 * (1.0 + poisson));
            self.offer("shear_wave", (shear / density).sqrt(), "case, sqrt(G/rho)");
        }
    }

    fn read_summary(&mut self) {
        let Some(summary) = self.summary.clone() else {
            // a run in progress
            return self.offer_driven_creepage();
        };
        let hertz = summary.half_space.unwrap_or_default();
        for (name, value) in [
            ("peak_pressure", hertz.peak_pressure),
            ("approach", hertz.approach),
            ("half_length", hertz.half_length),
            ("half_width", hertz.half_width),
        ] {
            if let Some(value) = value {
                self.offer(name, value, "summary, half_space");
            }
        }
        // a line contact has no approach
        if hertz.approach == Some(0.0) {
            self.shape = PatchShape::Rectangle;
        }
        self.offer("dt", summary.dt, "summary");
        // over a table the mean may vanish where slip does not
        self.offer_largest_creepage();
        if let Some(creepage) = summary.contact.creepage {
            self.offer("creepage", creepage, "summary, mean of the window");
        }
        self.offer_driven_creepage();
        let window = summary.window.as_ref();
        if let Some((from, to)) = window.and_then(|window| window.from.zip(window.to)) {
            self.window = Some([from, to]);
        }
    }

    /// The largest creepage of a table over time.
    fn offer_largest_creepage(&mut self) {
        let table =
            self.case.as_ref().and_then(|case| value_at(case, "drive.creepage")?.as_array());
        let values = table.into_iter().flatten().filter_map(|point| float(point.get(1)?));
        let largest = values.max_by(|a, b| a.abs().total_cmp(&b.abs()));
        if let Some(largest) = largest {
            self.offer("creepage", largest, "case, largest of drive.creepage");
        }
    }

    fn offer_driven_creepage(&mut self) {
        self.offer_largest_creepage();
        if let Some(creepage) = self.number("drive.creepage") {
            self.offer("creepage", creepage, "case, drive.creepage");
        }
    }

    /// Time step and creepage from the history: those of a run without a summary.
    fn read_history(&mut self, path: &Path) -> Result<(), PostError> {
        let Some(history) = open_history(path)? else { return Ok(()) };
        if let (Some(time), Some(step)) =
            (history.column(&HISTORY.time)?, history.column(&HISTORY.step)?)
            && let ([t0, .., t1], [n0, .., n1]) = (&time[..], &step[..])
        {
            self.offer("dt", (t1 - t0) / (n1 - n0), "history");
        }
        if let Some(last) = history.column(&HISTORY.creepage)?.and_then(|c| c.last().copied()) {
            self.offer("creepage", last, "history, last row");
        }
        Ok(())
    }
}

pub(crate) fn value_at<'a>(table: &'a toml::Table, path: &str) -> Option<&'a toml::Value> {
    let (head, rest) = path.split_once('.').unwrap_or((path, ""));
    let value = table.get(head)?;
    if rest.is_empty() { Some(value) } else { value_at(value.as_table()?, rest) }
}

pub(crate) fn number_at(table: &toml::Table, path: &str) -> Option<f64> {
    float(value_at(table, path)?)
}

fn float(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
}

fn read_text(path: &Path, kind: Kind) -> Result<Option<String>, PostError> {
    match input::text(path, kind) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.is_missing() => Ok(None),
        Err(error) => Err(PostError::Text { path: path.into(), reason: error.problem() }),
    }
}

pub(crate) fn read_toml(path: &Path) -> Result<Option<toml::Table>, PostError> {
    let failed = |error: toml::de::Error| PostError::Text {
        path: path.into(),
        reason: format!("is no TOML: {}", error.message()),
    };
    read_text(path, input::CASE)?.map(|text| text.parse().map_err(failed)).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_of_slip_counts_creepage_lateral_creepage_and_spin() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(file::CONTACT);
        std::fs::write(&file, "").unwrap();
        let slip = |drive: &str| {
            let case = format!("[drive]\nspeed = 40.0\n{drive}\n[scales]\nhalf_length = 5e-3\n");
            std::fs::write(folder.path().join("case.toml"), case).unwrap();
            let mut basis = Basis::read(&RunPaths::of(&file).unwrap()).unwrap();
            basis.complete();
            basis.scale("slip_speed")
        };
        let near = |found: Option<f64>, asked: f64| (found.unwrap() / asked - 1.0).abs() < 1e-12;
        assert!(near(slip("creepage = -3e-3"), 0.12));
        assert!(near(slip("creepage = 0.0\nlateral_creepage = 4e-3"), 0.16));
        assert!(near(slip("creepage = 3e-3\nlateral_creepage = -4e-3"), 0.2));
        assert!(near(slip("creepage = 0.0\nspin = 0.5"), 0.1));
        assert!(near(slip("creepage = 1e-9"), 4e-4));
        assert_eq!(slip("creepage = 0.0"), None);
        // a wheel with profiles slips by its position, too
        let position = r#"{ "position": { "lateral": 1e-3, "spin": 0.8 } }"#;
        std::fs::write(folder.path().join("summary.json"), position).unwrap();
        assert!(near(slip("creepage = 0.0\nlateral_creepage = 2e-3\nspin = 0.0"), 0.2));
    }
}
