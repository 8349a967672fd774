//! The runs of a sweep, in groups along its axes.

use super::measures::SweepMeasure;
use crate::sweep::result::{Entry, Measured, SweepResult};
use std::path::{Path, PathBuf};
use toml::Value;

/// A sweep along its axes.
pub(crate) struct Sweep<'a> {
    /// Its folder.
    pub folder: PathBuf,
    /// Keys of the axes, without that of the members of an ensemble.
    pub axes: Vec<&'a str>,
    /// The runs; of a sweep with an ensemble its points, means over their members.
    pub runs: Vec<Entry<'a>>,
    /// Whether the runs are points of an ensemble.
    pub ensemble: bool,
}

/// Values of an axis and the runs that have them.
type Members<'a> = Vec<(f64, Entry<'a>)>;

/// Runs that differ in one axis only.
pub(crate) struct Group<'a> {
    /// The other axes in which groups differ, with their values; empty where there are none.
    pub label: String,
    /// Value of the axis and run, by rising value.
    pub members: Members<'a>,
}

impl Group<'_> {
    /// A measure over the axis; runs without it are left out.
    pub fn points(&self, measure: &SweepMeasure) -> Vec<(f64, Measured)> {
        self.members.iter().filter_map(|(x, run)| Some((*x, measure.of(*run)?))).collect()
    }
}

impl<'a> Sweep<'a> {
    /// The sweep in `folder`.
    pub fn of(folder: &Path, result: &'a SweepResult) -> Self {
        let members = result.plan.ensemble.as_deref().filter(|_| !result.points.is_empty());
        let axes = result.plan.parameters.iter().map(String::as_str);
        Self {
            folder: folder.into(),
            axes: axes.filter(|axis| Some(*axis) != members).collect(),
            runs: match members {
                Some(_) => result.points.iter().map(Entry::Point).collect(),
                None => result.runs.iter().map(Entry::Run).collect(),
            },
            ensemble: members.is_some(),
        }
    }

    /// Runs that reached their end: the others have no results to draw.
    pub fn completed(&self) -> impl Iterator<Item = Entry<'a>> + '_ {
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
            .filter_map(|run| number_in_form(run, axis))
            .map(|(form, _)| form)
            .collect();
        let count = |form: &str| forms.iter().filter(|other| **other == form).count();
        // the first of equals: `max_by_key` takes the last
        forms.iter().rev().copied().max_by_key(|form| count(form)).unwrap_or_default()
    }

    /// The number that a run has on an axis, in the form of the axis.
    pub fn number(&self, run: Entry<'a>, axis: &str) -> Option<f64> {
        let (form, number) = number_in_form(run, axis)?;
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

    /// The completed runs in groups that differ in `axis` only, in the order of the sweep. A run that has no other
    /// value of the axis beside it is in none; where that holds for all (axes that vary together), they are one group.
    pub fn groups(&self, axis: &str) -> Vec<Group<'a>> {
        let others: Vec<&str> = self.axes.iter().copied().filter(|other| *other != axis).collect();
        let text = |run: Entry<'a>, other: &&str| value_text(run.parameters().get(*other));
        let mut groups: Vec<(Vec<String>, Members<'a>)> = Vec::new();
        for run in self.runs.iter().copied() {
            let Some(value) = self.number(run, axis) else { continue };
            let values: Vec<String> = others.iter().map(|other| text(run, other)).collect();
            match groups.iter_mut().find(|(known, _)| *known == values) {
                Some((_, members)) => members.push((value, run)),
                None => groups.push((values, vec![(value, run)])),
            }
        }
        if groups.iter().all(|(_, members)| members.len() < 2) {
            let all = groups.into_iter().flat_map(|(_, members)| members);
            groups = vec![(Vec::new(), all.collect())];
        }
        groups.retain(|(_, members)| members.len() > 1);
        let first = groups.first().map(|(values, _)| values.clone()).unwrap_or_default();
        let differs = |i: usize| groups.iter().any(|(values, _)| values[i] != first[i]);
        let differing: Vec<usize> = (0..first.len()).filter(|i| differs(*i)).collect();
        let label = |values: &[String]| {
            let parts = differing.iter().map(|i| format!("{} = {}", others[*i], values[*i]));
            parts.collect::<Vec<_>>().join(", ")
        };
        let group = |(values, mut members): (Vec<String>, Members<'a>)| {
            members.retain(|(_, run)| run.completed());
            members.sort_by(|a, b| a.0.total_cmp(&b.0));
            Group { label: label(&values), members }
        };
        groups.into_iter().map(group).filter(|group| !group.members.is_empty()).collect()
    }

    /// The run with exact contact that else equals a run of the group, if there is one beside those with springs.
    pub fn exact_beside(&self, group: &Group<'a>) -> Option<Entry<'a>> {
        let enforcement = |run: Entry<'a>| run.parameters().get(ENFORCEMENT)?.as_str();
        let alike = |a: Entry<'a>, b: Entry<'a>| {
            let mut others = self.axes.iter().filter(|axis| **axis != ENFORCEMENT);
            others.all(|axis| a.parameters().get(*axis) == b.parameters().get(*axis))
        };
        let beside = |exact: Entry<'a>| {
            let springs = |run: Entry<'a>| enforcement(run) != Some(EXACT) && alike(run, exact);
            group.members.iter().any(|(_, run)| springs(*run))
        };
        self.completed().find(|run| enforcement(*run) == Some(EXACT) && beside(*run))
    }
}

/// Key of the enforcement of contact, and its word for contact without springs.
const ENFORCEMENT: &str = "contact.enforcement";
const EXACT: &str = "exact";

/// The form of a parameter and its number.
fn number_in_form<'a>(run: Entry<'a>, key: &str) -> Option<(&'a str, f64)> {
    let value = run.parameters().get(key)?;
    let only = || value.as_table().filter(|table| table.len() == 1)?.iter().next();
    let (form, value) = only().map_or(("", value), |(form, value)| (form.as_str(), value));
    Some((form, number(value).filter(|number| number.is_finite())?))
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|integer| integer as f64))
}

/// Smallest and largest time step of runs (s), where they differ by more than rounding.
pub(crate) fn steps<'a>(runs: impl Iterator<Item = Entry<'a>>) -> Option<[f64; 2]> {
    let [least, most] = runs
        .filter_map(Entry::step)
        .fold([f64::INFINITY, 0.0], |[a, b], step| [f64::min(a, step), f64::max(b, step)]);
    (most > (1.0 + SAME_STEP) * least).then_some([least, most])
}

/// Relative difference of steps that are one: members of an ensemble differ by their disturbance.
const SAME_STEP: f64 = 1e-6;

/// A parameter's value as text.
pub(crate) fn value_text(value: Option<&Value>) -> String {
    match value {
        None => "\u{2013}".into(),
        Some(Value::String(text)) => text.clone(),
        Some(Value::Table(table)) => {
            let entries = table.iter().map(|(word, v)| format!("{word} {}", value_text(Some(v))));
            entries.collect::<Vec<_>>().join(", ")
        }
        Some(other) => number(other).map_or_else(|| other.to_string(), short),
    }
}

/// A number to four significant digits, without trailing zeros.
pub(super) fn short(x: f64) -> String {
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
