//! The runs of a sweep, from its document.

use crate::check::PostError;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A sweep, from its document `sweep.json`.
pub(crate) struct Sweep<'a> {
    /// Its folder.
    pub folder: PathBuf,
    /// Keys of the axes, without that of the members of an ensemble.
    pub axes: Vec<&'a str>,
    /// The runs; of a sweep with an ensemble its points, means over their members.
    pub runs: Vec<Run<'a>>,
    /// Whether the runs are points of an ensemble.
    pub ensemble: bool,
}

/// A run of a sweep.
#[derive(Clone, Copy)]
pub(crate) struct Run<'a> {
    /// Its entry in the document.
    pub entry: &'a Value,
}

/// Runs that differ in one axis only.
pub(crate) struct Group<'a> {
    /// The other axes with their values; empty where there are none.
    pub label: String,
    /// Value of the axis and run, by rising value.
    pub members: Vec<(f64, Run<'a>)>,
}

impl<'a> Sweep<'a> {
    /// The sweep of a document.
    ///
    /// # Errors
    /// A document that is no sweep.
    pub fn of(folder: &Path, document: &'a Value) -> Result<Self, PostError> {
        let lacks = |what: &str| PostError::Text {
            path: folder.join("sweep.json"),
            reason: format!("is no sweep: it has no {what}"),
        };
        let axes = document["parameters"].as_array().ok_or_else(|| lacks("parameters"))?;
        let runs = document["runs"].as_array().ok_or_else(|| lacks("runs"))?;
        let members = document["ensemble"].as_str();
        let points = document["points"].as_array().filter(|_| members.is_some());
        Ok(Self {
            folder: folder.into(),
            axes: axes
                .iter()
                .filter_map(Value::as_str)
                .filter(|axis| Some(*axis) != members || points.is_none())
                .collect(),
            runs: points.unwrap_or(runs).iter().map(|entry| Run { entry }).collect(),
            ensemble: points.is_some(),
        })
    }

    /// Runs that reached their end: the others have no results to draw.
    pub fn completed(&self) -> impl Iterator<Item = Run<'a>> + '_ {
        self.runs.iter().copied().filter(|run| run.completed())
    }

    /// Axes with more than one number as a value among the runs that completed.
    pub fn numeric_axes(&self) -> Vec<&'a str> {
        let varies = |axis: &&str| self.values(axis).len() > 1;
        self.axes.iter().copied().filter(varies).collect()
    }

    /// The form of an axis's numbers: empty, or the word that a table such as `{ stiffness = 3.5e13 }` has. Of several
    /// forms that of most runs, since numbers of two forms cannot stand on one axis.
    pub fn form(&self, axis: &str) -> &'a str {
        let forms: Vec<&str> = self
            .completed()
            .filter_map(|run| run.number_in_form(axis))
            .map(|(form, _)| form)
            .collect();
        let count = |form: &str| forms.iter().filter(|other| **other == form).count();
        // the first of equals: `max_by_key` takes the last
        forms.iter().rev().copied().max_by_key(|form| count(form)).unwrap_or_default()
    }

    /// The number that a run has on an axis, in the form of the axis.
    pub fn number(&self, run: Run<'a>, axis: &str) -> Option<f64> {
        let (form, number) = run.number_in_form(axis)?;
        (form == self.form(axis)).then_some(number)
    }

    /// The values of an axis, rising.
    pub fn values(&self, axis: &str) -> Vec<f64> {
        let mut values: Vec<f64> =
            self.completed().filter_map(|run| self.number(run, axis)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }

    /// The completed runs in groups that differ in `axis` only, in the order of the document. Where no two runs
    /// do (axes that vary together), all of them are one group.
    pub fn groups(&self, axis: &str) -> Vec<Group<'a>> {
        let mut groups: Vec<Group<'a>> = Vec::new();
        let mut all = Group { label: String::new(), members: Vec::new() };
        for run in self.completed() {
            let Some(value) = self.number(run, axis) else {
                continue;
            };
            let others = self.axes.iter().filter(|other| **other != axis);
            let label: Vec<String> = others
                .map(|other| format!("{other} = {}", value_text(&run.parameter(other))))
                .collect();
            let label = label.join(", ");
            all.members.push((value, run));
            match groups.iter_mut().find(|group| group.label == label) {
                Some(group) => group.members.push((value, run)),
                None => groups.push(Group { label, members: vec![(value, run)] }),
            }
        }
        if groups.iter().all(|group| group.members.len() < 2) {
            groups = vec![all];
        }
        for group in &mut groups {
            group.members.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        groups
    }
}

impl<'a> Run<'a> {
    pub fn status(self) -> &'a str {
        self.entry["status"].as_str().unwrap_or("unknown")
    }

    /// A run without a status counts as completed where it has a summary.
    pub fn completed(self) -> bool {
        match self.entry["status"].as_str() {
            Some(status) => status == "completed",
            None => self.entry["summary"].is_object(),
        }
    }

    pub fn parameter(self, key: &str) -> Value {
        self.entry["parameters"][key].clone()
    }

    /// The form of a parameter and its number.
    fn number_in_form(self, key: &str) -> Option<(&'a str, f64)> {
        let value = &self.entry["parameters"][key];
        let only = || value.as_object().filter(|table| table.len() == 1)?.iter().next();
        let (form, value) = only().map_or(("", value), |(form, value)| (form.as_str(), value));
        Some((form, value.as_f64().filter(|number| number.is_finite())?))
    }

    /// Its time step (s).
    pub fn step(self) -> Option<f64> {
        self.entry.pointer("/summary/dt")?.as_f64()
    }

    /// Its folder, relative to that of the sweep.
    pub fn folder(self) -> Option<&'a Path> {
        self.entry["run"].as_str().map(Path::new)
    }
}

/// Smallest and largest time step of runs (s), where they differ by more than rounding.
pub(crate) fn steps<'a>(runs: impl Iterator<Item = Run<'a>>) -> Option<[f64; 2]> {
    let [least, most] = runs
        .filter_map(Run::step)
        .fold([f64::INFINITY, 0.0], |[a, b], step| [f64::min(a, step), f64::max(b, step)]);
    (most > (1.0 + SAME_STEP) * least).then_some([least, most])
}

/// Relative difference of steps that are one: members of an ensemble differ by their disturbance.
const SAME_STEP: f64 = 1e-6;

/// A parameter's value as text.
pub(crate) fn value_text(value: &Value) -> String {
    match value {
        Value::Number(n) => n.as_f64().map_or(String::new(), short),
        Value::String(text) => text.clone(),
        Value::Null => "\u{2013}".into(),
        Value::Object(table) => {
            let entries: Vec<String> =
                table.iter().map(|(word, value)| format!("{word} {}", value_text(value))).collect();
            entries.join(", ")
        }
        other => other.to_string(),
    }
}

/// A number to four significant digits, without trailing zeros.
fn short(x: f64) -> String {
    let x = format!("{x:.3e}").parse().unwrap_or(x);
    let plain = x == 0.0 || (1e-3..1e6).contains(&f64::abs(x));
    let text = if plain { format!("{x}") } else { format!("{x:e}") };
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn values_of_an_axis_are_short() {
        for (x, text) in [(0.01, "0.01"), (10.0, "10"), (0.0, "0"), (0.123_456, "0.1235")] {
            assert_eq!(short(x), text);
        }
        assert_eq!(short(-5e-9), "\u{2212}5e\u{2212}9");
    }
}
