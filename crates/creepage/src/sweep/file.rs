//! The sweep file: a base case, axes, and what follows from them.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use crate::case::CaseFile;
use crate::case::error::{CaseError, KeyError, raise};
use crate::case::key::Key;
use crate::case::keys::{self, Place, meant_key, nearest};
use crate::case::layers::Layers;
use crate::case::name;
use crate::case::value::{float, get, join, show, whole};
use crate::sweep::ensemble;

/// A `log` or `linear` axis with more points than this is taken for a typing mistake.
const MOST_POINTS: usize = 1000;

/// Keys that cannot be swept: they name the case. Nor can those in a list of sections.
const NO_AXIS: [&str; 3] = ["name", "title", "extends"];

/// Keys of the sweep file by section; `[]` stands for the index in an array of tables.
const TOP: [&str; 8] = ["name", "title", "base", "mode", "set", "axis", "derive", "ensemble"];
const AXIS: [&str; 5] = ["key", "nominal", "values", "log", "linear"];
const FORMS: [&str; 3] = ["values", "log", "linear"];
const ENSEMBLE: [&str; 2] = ["members", "seed"];
const SPAN: [&str; 3] = ["from", "to", "n"];
const DERIVE: [&str; 5] = ["key", "rule", "from", "factor", "power"];

/// How axes are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Every value of each axis with every value of the others; the last axis varies fastest. Axes with a nominal
    /// value vary one at a time.
    Grid,
    /// The n-th values of all axes together.
    Zip,
}

impl Mode {
    /// The word in the file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Zip => "zip",
        }
    }
}

/// A key of the case and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Dotted path of the case's key.
    pub key: String,
    /// Its values, each allowed for the key.
    pub values: Vec<Value>,
    /// Index of the value that it keeps while another axis with such a value varies; none where all its values meet
    /// all those of the others.
    pub nominal: Option<usize>,
}

/// What the time step follows where runs differ in their stability limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepRule {
    /// The step of each run is `time.factor` times its own limit.
    Bound,
    /// The step of all runs is `time.factor` times the smallest limit of the sweep.
    Fixed,
}

impl StepRule {
    /// The word in the file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Bound => "bound",
            Self::Fixed => "fixed",
        }
    }
}

/// A key that follows an axis: `factor * axis^power`.
#[derive(Clone, Debug, PartialEq)]
pub struct Follow {
    /// Dotted path of the key that follows.
    pub key: String,
    /// Index into [`Sweep::axes`] of the axis that it follows.
    pub axis: usize,
    /// Factor, in the unit of the key over that of the axis to `power`.
    pub factor: f64,
    /// Power (dimensionless).
    pub power: f64,
}

/// A sweep file, read and checked.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Name: the sweep goes to `runs/<name>` unless `--out` says otherwise.
    pub name: String,
    /// One line that says what the sweep is for.
    pub title: Option<String>,
    /// The sweep file.
    pub path: CaseFile,
    /// The base case's file.
    pub base: CaseFile,
    /// How axes are combined.
    pub mode: Mode,
    /// Keys laid over the base for every run: dotted path and value.
    pub sets: Vec<(String, Value)>,
    /// The axes, at least one.
    pub axes: Vec<Axis>,
    /// What the time step follows; none where the base case and the axes determine it.
    pub step: Option<StepRule>,
    /// Keys that follow an axis.
    pub follows: Vec<Follow>,
    /// Whether the last axis is that of the members of an ensemble.
    pub ensemble: bool,
    pub(crate) layers: Layers,
}

impl Sweep {
    /// Reads a sweep file, or the reference sweep of that name, and checks it against itself and the table of keys. The
    /// base case is not read.
    ///
    /// # Errors
    /// A file that cannot be read, or its mistakes.
    pub fn load(path: &Path) -> Result<Self, CaseError> {
        let file = CaseFile::named(path);
        let layers = Layers::read(&file)?;
        let mut reading = Reading { layers: &layers, errors: Vec::new() };
        let sweep = reading.sweep(file);
        raise(reading.errors)?;
        let sweep = Self { layers, ..sweep };
        sweep.check()?;
        Ok(sweep)
    }

    /// Checks the file as a whole, after its parts: files, keys given twice, lengths of axes, the time step.
    fn check(&self) -> Result<(), CaseError> {
        let refuse = |at: &str, message: &str, remedy: &str| {
            Err(self.layers.places.error(at, message, remedy).into())
        };
        if self.base.on_disk().is_some_and(|base| !base.is_file()) {
            let shown = get(&self.layers.table, "base").map(show).unwrap_or_default();
            let message = format!("base = {shown}: there is no file {}", self.base);
            return refuse("base", &message, "give the path of a case file, relative to this file");
        }
        let mut taken: Vec<&str> = Vec::new();
        for (at, key) in self.given() {
            if taken.contains(&key) {
                return refuse(
                    &at,
                    &format!("{key} is given twice"),
                    "let one place give each key",
                );
            }
            taken.push(key);
        }
        let lengths: Vec<usize> = self.axes.iter().map(|axis| axis.values.len()).collect();
        if self.mode == Mode::Zip
            && let Some(i) = lengths.iter().position(|&n| n != lengths[0])
        {
            let message = format!(
                "mode = \"zip\" takes the values of all axes together, but axis {} has {} values \
                 and the first has {}",
                i + 1,
                lengths[i],
                lengths[0]
            );
            return refuse(&format!("axis[{i}].key"), &message, "give all axes the same number");
        }
        if self.mode == Mode::Zip
            && let Some(i) = self.axes.iter().position(|axis| axis.nominal.is_some())
        {
            let message =
                "mode = \"zip\" takes the values of all axes together: no axis varies alone";
            return refuse(&format!("axis[{i}].nominal"), message, "leave out nominal or the mode");
        }
        let by_axis = |key: &str| self.axes.iter().any(|axis| axis.key == key);
        let given = taken.contains(&"time.step");
        let moves = self.axes.iter().position(|axis| moves_the_limit(&axis.key));
        if let Some(i) = moves
            && self.step.is_none()
            && !given
        {
            let message = format!(
                "{} changes the stability limit: the file must say what the time step does",
                self.axes[i].key
            );
            let remedy = "add [[derive]] with key = \"time.step\" and rule = \"fixed\" (all runs the same step, by the \
                          smallest limit) or \"bound\" (each run a fraction of its own limit), or [set] with time.step";
            return refuse(&format!("axis[{i}].key"), &message, remedy);
        }
        let at = format!("derive[{}].key", self.derive_of("time.step"));
        if self.step.is_some() && given {
            let message = "time.step is derived, but an axis, [set] or another [[derive]] gives it";
            return refuse(&at, message, "leave out the rule or the other");
        }
        if self.step == Some(StepRule::Fixed) && by_axis("time.factor") {
            let message =
                "rule = \"fixed\" gives all runs the same step, but an axis varies time.factor";
            let remedy = "write rule = \"bound\": each run takes its time.factor of its own limit; or leave out that axis";
            return refuse(&at, message, remedy);
        }
        Ok(())
    }

    /// The files that the sweep is made of: its own, its base, those that these extend, and the base's friction
    /// table. A mesh file is not among them.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let base = Layers::read(&self.base).map(|layers| layers.files()).unwrap_or_default();
        self.layers.files().into_iter().chain(self.base.on_disk().cloned()).chain(base).collect()
    }

    /// Every case key that the file gives: its dotted path in the sweep file, and the key.
    fn given(&self) -> Vec<(String, &str)> {
        let sets = self.sets.iter().map(|(key, _)| (join("set", key), key.as_str()));
        let axes = self.axes.iter().enumerate();
        let axes = axes.map(|(i, axis)| (self.axis_place(i), axis.key.as_str()));
        let follows = self.follows.iter();
        let follows =
            follows.map(|f| (format!("derive[{}].key", self.derive_of(&f.key)), f.key.as_str()));
        sets.chain(axes).chain(follows).collect()
    }

    /// Dotted path in the sweep file of axis `i`.
    pub(crate) fn axis_place(&self, i: usize) -> String {
        let members = self.ensemble && i + 1 == self.axes.len();
        if members { "ensemble.members".into() } else { format!("axis[{i}].key") }
    }

    fn derive_of(&self, key: &str) -> usize {
        let derive = get(&self.layers.table, "derive").and_then(Value::as_array);
        let place = |d: &Value| d.get("key").and_then(Value::as_str) == Some(key);
        derive.and_then(|list| list.iter().position(place)).unwrap_or(0)
    }

    /// Dotted path in the sweep file of the value of `key` for the run with these `indices` on the axes.
    pub(crate) fn place_of(&self, key: &str, indices: &[usize]) -> Option<String> {
        if let Some(i) = self.axes.iter().position(|axis| axis.key == key) {
            let value = format!("axis[{i}].values[{}]", indices[i]);
            let written = self.layers.places.origins.contains_key(&value);
            return Some(if written { value } else { self.axis_place(i) });
        }
        // A key in a list of sections has the place of the list.
        let list = key.split('[').next().unwrap_or(key);
        if self.sets.iter().any(|(set, _)| set == list) {
            return Some(join("set", list));
        }
        let derived = self.follows.iter().any(|f| f.key == key);
        derived.then(|| format!("derive[{}].key", self.derive_of(key)))
    }
}

/// Whether a key may change the highest frequency of the preloaded bodies.
fn moves_the_limit(key: &str) -> bool {
    const UNMOVED: [&str; 8] = [
        "friction.",
        "output.",
        "evaluate.",
        "time.",
        "checkpoint.",
        "guards.",
        "preload.disturbance",
        "preload.seed",
    ];
    let drive = key.starts_with("drive.") && key != "drive.speed";
    !drive && !UNMOVED.iter().any(|section| key.starts_with(section))
}

/// The reading of a file; mistakes are gathered, so that one message has them all.
struct Reading<'a> {
    layers: &'a Layers,
    errors: Vec<KeyError>,
}

impl Reading<'_> {
    fn sweep(&mut self, file: CaseFile) -> Sweep {
        let layers = self.layers;
        let table = &layers.table;
        self.known("", table, &TOP);
        let name = self.text(table, "", "name").unwrap_or_else(|| {
            file.path().file_stem().unwrap_or_default().to_string_lossy().into_owned()
        });
        if let Some(message) = name::refused(&name) {
            self.refuse("name", &message, name::REMEDY);
        }
        let base = self.text(table, "", "base").unwrap_or_default();
        if !table.contains_key("base") {
            let message = "base is missing: it must name the case that the sweep varies";
            self.refuse("base", message, "give the path of a case file, relative to this file");
        }
        let mode = match self.text(table, "", "mode").as_deref() {
            None | Some("grid") => Mode::Grid,
            Some("zip") => Mode::Zip,
            Some(other) => {
                let message = format!("mode = {other:?} must be \"grid\" or \"zip\"");
                self.refuse("mode", &message, "choose one of the words");
                Mode::Grid
            }
        };
        let mut sets = Vec::new();
        match table.get("set") {
            Some(Value::Table(set)) => self.sets(set, "", &mut sets),
            Some(other) => self.not_a_section("set", other),
            None => {}
        }
        let mut axes: Vec<Axis> = self
            .list(table, "axis")
            .into_iter()
            .enumerate()
            .filter_map(|(i, axis)| self.axis(&format!("axis[{i}]"), axis))
            .collect();
        if !table.contains_key("axis") && !table.contains_key("ensemble") {
            let remedy = "add [[axis]] with key = \"...\" and values = [...], or [ensemble]";
            self.refuse("axis", "there is no axis: the sweep would vary nothing", remedy);
        }
        let (mut step, mut follows) = (None, Vec::new());
        for (i, derive) in self.list(table, "derive").into_iter().enumerate() {
            self.derive(&format!("derive[{i}]"), derive, &axes, &mut step, &mut follows);
        }
        let members = self.ensemble(table, mode);
        let ensemble = members.is_some();
        if let Some(members) = members {
            axes.push(members);
            if !sets.iter().any(|(key, _)| key == ensemble::DISTURBANCE.0) {
                let (key, size) = ensemble::DISTURBANCE;
                sets.push((key.into(), Value::Float(size)));
            }
        }
        Sweep {
            name,
            title: self.text(table, "", "title"),
            base: file.beside(&base),
            path: file,
            mode,
            sets,
            axes,
            step,
            follows,
            ensemble,
            layers: Layers::default(),
        }
    }

    fn refuse(&mut self, at: &str, message: &str, remedy: &str) {
        self.errors.push(self.layers.places.error(at, message, remedy));
    }

    fn not_a_section(&mut self, at: &str, value: &Value) {
        let message = format!("{at} = {} must be a section", show(value));
        self.refuse(at, &message, &format!("write [{at}] with its keys below it"));
    }

    /// Refuses keys that are not in `names`.
    fn known(&mut self, section: &str, table: &Table, names: &[&str]) {
        for name in table.keys().filter(|name| !names.contains(&name.as_str())) {
            let near = nearest(name, names.iter().copied());
            let meant = near.map(|near| format!("did you mean `{near}`? ")).unwrap_or_default();
            let at = join(section, name);
            let remedy = format!("{meant}there are: {}", names.join(", "));
            self.refuse(&at, &format!("unknown key {at} in a sweep file"), &remedy);
        }
    }

    fn text(&mut self, table: &Table, section: &str, name: &str) -> Option<String> {
        let at = join(section, name);
        match table.get(name)? {
            Value::String(text) => Some(text.clone()),
            other => {
                let message = format!("{at} = {} must be text in quotes", show(other));
                self.refuse(&at, &message, "put it in quotes");
                None
            }
        }
    }

    fn number(&mut self, table: &Table, section: &str, name: &str) -> Option<f64> {
        let at = join(section, name);
        let value = table.get(name)?;
        let number = float(value).filter(|x| x.is_finite());
        if number.is_none() {
            let message = format!("{at} = {} must be a number", show(value));
            self.refuse(&at, &message, "give a number, without quotes");
        }
        number
    }

    /// A whole number from `low` to [`MOST_POINTS`].
    fn count(&mut self, at: &str, value: &Value, low: usize, remedy: &str) -> Option<usize> {
        let n = whole(value).map(|n| n as usize).filter(|n| (low..=MOST_POINTS).contains(n));
        if n.is_none() {
            let shown = show(value);
            let message =
                format!("{at} = {shown} must be a whole number from {low} to {MOST_POINTS}");
            self.refuse(at, &message, remedy);
        }
        n
    }

    /// The tables of an array of tables.
    fn list<'t>(&mut self, table: &'t Table, name: &str) -> Vec<&'t Table> {
        let remedy = format!("write sections [[{name}]] with a key each");
        match table.get(name) {
            None => Vec::new(),
            Some(Value::Array(items)) if items.iter().all(Value::is_table) => {
                if items.is_empty() {
                    self.refuse(name, &format!("{name} is empty"), &remedy);
                }
                items.iter().filter_map(Value::as_table).collect()
            }
            Some(other) => {
                let message = format!("{name} = {} must be a list of sections", show(other));
                self.refuse(name, &message, &remedy);
                Vec::new()
            }
        }
    }

    fn sets(&mut self, table: &Table, prefix: &str, sets: &mut Vec<(String, Value)>) {
        for (name, value) in table {
            let (key, at) = (join(prefix, name), join("set", &join(prefix, name)));
            match (keys::place(&key), value) {
                (Place::Key(known), value) => {
                    self.allowed(&at, known, value);
                    sets.push((key, value.clone()));
                }
                (_, Value::Table(inner)) => self.sets(inner, &key, sets),
                // A list of sections, whose keys are checked with the case.
                (Place::List, Value::Array(_)) => sets.push((key, value.clone())),
                _ => {
                    self.refuse(&at, &format!("unknown key {key}"), &meant_key(&key));
                }
            }
        }
    }

    /// The axis of an ensemble's members: their seeds.
    fn ensemble(&mut self, table: &Table, mode: Mode) -> Option<Axis> {
        let section = match table.get("ensemble")? {
            Value::Table(section) => section,
            other => {
                self.not_a_section("ensemble", other);
                return None;
            }
        };
        self.known("ensemble", section, &ENSEMBLE);
        if mode == Mode::Zip {
            let message =
                "an ensemble repeats every point, but mode = \"zip\" takes values together";
            self.refuse("ensemble", message, "use mode = \"grid\"");
        }
        if !section.contains_key("members") {
            let message =
                "ensemble.members is missing: it must be the number of runs at each point";
            self.refuse("ensemble", message, "members = 8");
        }
        let mut count = |name: &str, low: usize| {
            section.get(name).map(|n| self.count(&join("ensemble", name), n, low, "members = 8"))
        };
        let (members, seed) = (count("members", 2), count("seed", 0).unwrap_or(Some(1)));
        let (members, seed) = (members??, seed? as i64);
        let values = (seed..seed + members as i64).map(Value::Integer).collect();
        Some(Axis { key: ensemble::AXIS.into(), values, nominal: None })
    }

    fn allowed(&mut self, at: &str, key: &Key, value: &Value) -> bool {
        let problem = key.mistake(value);
        if let Some(problem) = &problem {
            self.refuse(at, &format!("{} = {problem}", key.path), key.remedy);
        }
        problem.is_none()
    }

    /// The case's key that a section names.
    fn key(&mut self, at: &str, table: &Table) -> Option<&'static Key> {
        let place = join(at, "key");
        if !table.contains_key("key") {
            let message = format!("{at}.key is missing: it must name a key of the case");
            self.refuse(at, &message, "give the key, such as key = \"contact.penalty.tangential\"");
        }
        let name = self.text(table, at, "key")?;
        match keys::find(&name) {
            Some(_) if NO_AXIS.contains(&name.as_str()) || name.contains('[') => {
                let message = format!("{name} cannot be swept");
                self.refuse(&place, &message, "name a key that runs may differ in");
                None
            }
            Some(key) => Some(key),
            None => {
                self.refuse(&place, &format!("unknown key {name}"), &meant_key(&name));
                None
            }
        }
    }

    fn axis(&mut self, at: &str, table: &Table) -> Option<Axis> {
        self.known(at, table, &AXIS);
        let key = self.key(at, table);
        let forms: Vec<&str> = FORMS.into_iter().filter(|form| table.contains_key(*form)).collect();
        let [form] = forms[..] else {
            let message = format!("{at} must have one of values, log and linear");
            let remedy = "give values = [...], or log or linear = { from = , to = , n = }";
            self.refuse(&join(at, "key"), &message, remedy);
            return None;
        };
        let place = join(at, form);
        let mut values = match (form, &table[form]) {
            ("values", Value::Array(values)) => values.clone(),
            ("values", other) => {
                let message = format!("{place} = {} must be a list", show(other));
                self.refuse(&place, &message, "put the values in brackets: values = [0.1, 1.0]");
                return None;
            }
            (_, Value::Table(span)) => self.span(&place, span, form == "log")?,
            (_, other) => {
                self.not_a_section(&place, other);
                return None;
            }
        };
        if values.is_empty() {
            let message = format!("{place} = [] is empty: the axis has no value");
            self.refuse(&place, &message, "give at least one value, or leave the axis out");
        }
        let key = key?;
        values.iter_mut().for_each(|value| key.hold(value));
        for (i, value) in values.iter().enumerate() {
            let item = format!("{place}[{i}]");
            let item =
                if self.layers.places.origins.contains_key(&item) { item } else { place.clone() };
            if self.allowed(&item, key, value) && values[..i].contains(value) {
                let message = format!("{} = {} stands twice", key.path, show(value));
                self.refuse(&item, &message, "give each value once");
            }
        }
        let nominal = self.nominal(at, table, key, &values)?;
        Some(Axis { key: key.path.into(), values, nominal })
    }

    /// Index of the axis's nominal value among its `values`; `None` after a mistake.
    fn nominal(
        &mut self,
        at: &str,
        table: &Table,
        key: &Key,
        values: &[Value],
    ) -> Option<Option<usize>> {
        let Some(nominal) = table.get("nominal") else { return Some(None) };
        let mut held = nominal.clone();
        key.hold(&mut held);
        let found = values.iter().position(|value| *value == held);
        if found.is_none() {
            let shown: Vec<String> = values.iter().map(show).collect();
            let message = format!("{at}.nominal = {} is no value of the axis", show(nominal));
            let remedy = format!("there are: {}", shown.join(", "));
            self.refuse(&join(at, "nominal"), &message, &remedy);
        }
        found.map(Some)
    }

    /// `n` values from `from` to `to`, the ends to the bit.
    fn span(&mut self, at: &str, table: &Table, log: bool) -> Option<Vec<Value>> {
        self.known(at, table, &SPAN);
        for name in SPAN.iter().filter(|name| !table.contains_key(**name)) {
            self.refuse(at, &format!("{at}.{name} is missing"), "give from, to and n");
        }
        let (from, to) = (self.number(table, at, "from"), self.number(table, at, "to"));
        let n = table
            .get("n")
            .and_then(|n| self.count(&join(at, "n"), n, 2, "give the number of values"));
        let (from, to, n) = (from?, to?, n?);
        if log && !(from > 0.0 && to > 0.0) {
            let message = format!("{at}: a logarithmic axis needs positive ends");
            self.refuse(at, &message, "give positive from and to, or use linear");
            return None;
        }
        let value = |i: usize| {
            let part = i as f64 / (n - 1) as f64;
            match i {
                0 => from,
                _ if i + 1 == n => to,
                _ if log => from * libm::pow(to / from, part),
                _ => from + (to - from) * part,
            }
        };
        Some((0..n).map(|i| Value::Float(value(i))).collect())
    }

    fn derive(
        &mut self,
        at: &str,
        table: &Table,
        axes: &[Axis],
        step: &mut Option<StepRule>,
        follows: &mut Vec<Follow>,
    ) {
        self.known(at, table, &DERIVE);
        let Some(key) = self.key(at, table) else {
            return;
        };
        if key.path == "time.step" && !table.contains_key("from") {
            if step.is_some() {
                self.refuse(&join(at, "key"), "time.step is derived twice", "leave one out");
            }
            *step = match self.text(table, at, "rule").as_deref() {
                Some("bound") => Some(StepRule::Bound),
                Some("fixed") => Some(StepRule::Fixed),
                other => {
                    let place = if other.is_some() { join(at, "rule") } else { join(at, "key") };
                    let message = format!("{at}.rule must be \"bound\" or \"fixed\"");
                    let remedy = "bound: each run time.factor times its own stability limit; fixed: \
                                  all runs time.factor times the smallest limit";
                    self.refuse(&place, &message, remedy);
                    None
                }
            };
            return;
        }
        let from = self.text(table, at, "from");
        let axis = from.as_ref().and_then(|from| axes.iter().position(|axis| axis.key == *from));
        let Some(axis) = axis else {
            let place = if from.is_some() { join(at, "from") } else { join(at, "key") };
            let names: Vec<_> = axes.iter().map(|axis| axis.key.as_str()).collect();
            let message = format!("{at}.from must name the axis that {} follows", key.path);
            self.refuse(&place, &message, &format!("there are: {}", names.join(", ")));
            return;
        };
        let factor = self.number(table, at, "factor").unwrap_or(1.0);
        let power = self.number(table, at, "power").unwrap_or(1.0);
        for value in &axes[axis].values {
            let Some(x) = float(value) else {
                let message = format!("{} follows {}, which is no number", key.path, show(value));
                self.refuse(&join(at, "from"), &message, "let it follow an axis of numbers");
                return;
            };
            if !self.allowed(&join(at, "key"), key, &Value::Float(factor * libm::pow(x, power))) {
                return;
            }
        }
        follows.push(Follow { key: key.path.into(), axis, factor, power });
    }
}

#[cfg(test)]
mod tests {
    use super::moves_the_limit;

    #[test]
    fn what_no_result_depends_on_moves_no_limit() {
        for key in ["guards.penetration", "checkpoint.steps", "friction.static", "drive.creepage"] {
            assert!(!moves_the_limit(key), "{key}");
        }
        for key in ["drive.speed", "mesh.zone.size", "contact.penalty.tangential"] {
            assert!(moves_the_limit(key), "{key}");
        }
    }
}
