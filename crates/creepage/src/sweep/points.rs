//! From a sweep file to the resolved case of every run.

use std::collections::BTreeMap;

use sha2::{Digest, Sha256};
use toml::Value;

use crate::case::error::CaseError;
use crate::case::name;
use crate::case::schema::{Case, Enforcement, Stiffness};
use crate::case::value::float;
use crate::scenario::{Remedy, ScenarioError};
use crate::sweep::file::{Axis, Mode, Sweep};
use crate::sweep::plan;
use crate::sweep::result::Parameters;
use output::hexadecimal;

/// More runs than this are taken for a typing mistake.
const MOST_RUNS: usize = 10_000;
/// Longest name of a run, without its number.
const LONGEST_NAME: usize = 60;

/// One run of a sweep.
#[derive(Clone, Debug)]
pub struct Point {
    /// Name of the run's folder and of its case: the number of the run and its parameters.
    pub name: String,
    /// Values of the swept keys, by dotted path.
    pub parameters: Parameters,
    /// The resolved case.
    pub case: Case,
    /// Elements of its mesh; zero before [`Sweep::count_elements`].
    pub elements: usize,
    /// Index of its value on each axis.
    pub(crate) indices: Vec<usize>,
}

impl Sweep {
    /// The runs in their order, every case resolved and checked. With [`StepRule::Fixed`](crate::sweep::file::StepRule) each
    /// still has the step of its own limit: [`plan::prepare`] finds the common one.
    ///
    /// # Errors
    /// Too many runs; a run whose case is refused, at the place in the sweep file that causes it.
    pub fn points(&self) -> Result<Vec<Point>, CaseError> {
        let count = self.count();
        if count > MOST_RUNS {
            let message = format!("the axes make {count} runs, more than {MOST_RUNS}");
            let error = self.layers.places.error("axis", &message, "give fewer values");
            return Err(CaseError::Key(Box::new(error)));
        }
        self.combinations().into_iter().enumerate().map(|(n, at)| self.point(n, at)).collect()
    }

    /// How many runs the axes make.
    fn count(&self) -> usize {
        let (alone, crossed): (Vec<&Axis>, Vec<&Axis>) =
            self.axes.iter().partition(|axis| axis.nominal.is_some());
        match self.mode {
            Mode::Zip => self.axes[0].values.len(),
            Mode::Grid => crossed.iter().map(|axis| axis.values.len()).fold(
                1 + alone.iter().map(|axis| axis.values.len() - 1).sum::<usize>(),
                |all, n| all.saturating_mul(n),
            ),
        }
    }

    /// The index of the value on each axis, run by run.
    fn combinations(&self) -> Vec<Vec<usize>> {
        if self.mode == Mode::Zip {
            return (0..self.count()).map(|n| vec![n; self.axes.len()]).collect();
        }
        let nominal: Vec<usize> =
            self.axes.iter().map(|axis| axis.nominal.unwrap_or_default()).collect();
        let with = |at: &[usize], axis: usize, value: usize| {
            let mut at = at.to_vec();
            at[axis] = value;
            at
        };
        let mut all: Vec<Vec<usize>> = Vec::new();
        for (i, axis) in self.axes.iter().enumerate().filter(|(_, axis)| axis.nominal.is_some()) {
            // the point at which all have their nominal values stands on the first of these axes
            let values = (0..axis.values.len()).filter(|&k| all.is_empty() || k != nominal[i]);
            all.extend(values.map(|k| with(&nominal, i, k)).collect::<Vec<_>>());
        }
        if all.is_empty() {
            all.push(nominal);
        }
        for (i, axis) in self.axes.iter().enumerate().filter(|(_, axis)| axis.nominal.is_none()) {
            let values = 0..axis.values.len();
            all = all.iter().flat_map(|at| values.clone().map(move |k| with(at, i, k))).collect();
        }
        all
    }

    fn point(&self, n: usize, indices: Vec<usize>) -> Result<Point, CaseError> {
        let chosen: Vec<(&str, &Value)> = self
            .axes
            .iter()
            .zip(&indices)
            .map(|(axis, &i)| (axis.key.as_str(), &axis.values[i]))
            .collect();
        let name = run_name(n, &chosen);
        let mut sets: Vec<String> =
            self.sets.iter().map(|(key, value)| format!("{key}={value}")).collect();
        sets.extend(chosen.iter().map(|(key, value)| format!("{key}={value}")));
        for follow in &self.follows {
            let x = float(chosen[follow.axis].1).unwrap_or(f64::NAN);
            let value = Value::Float(follow.factor * libm::pow(x, follow.power));
            sets.push(format!("{}={value}", follow.key));
        }
        if self.step.is_some() {
            // The rule takes a fraction of the limit, which an absolute step in the base would override.
            let run =
                Case::read(&self.base, &sets).map_err(|error| self.placed(error, &indices))?;
            if run.time.step.is_some() {
                sets.push(format!("time.factor={}", run.default_factor()));
            }
        }
        sets.push(format!("name=\"{name}\""));
        let case = Case::read(&self.base, &sets).map_err(|error| self.placed(error, &indices))?;
        self.keep_springs(&case)?;
        let parameters =
            chosen.iter().map(|(key, value)| ((*key).to_owned(), (*value).clone())).collect();
        Ok(Point { name, parameters, case, elements: 0, indices })
    }

    /// Refuses to vary the time step where a spring is a fraction of what the step bears: it would vary as well.
    fn keep_springs(&self, case: &Case) -> Result<(), CaseError> {
        let of_the_step = |axis: &Axis| ["time.factor", "time.step"].contains(&axis.key.as_str());
        let Some(i) = self.axes.iter().position(of_the_step) else { return Ok(()) };
        let penalty = &case.contact.penalty;
        let springs = [("normal", penalty.normal), ("tangential", penalty.tangential)];
        let tied = |(_, spring): &(&str, Stiffness)| matches!(spring, Stiffness::Stability(_));
        let Some((name, _)) = springs.into_iter().find(tied) else { return Ok(()) };
        if case.contact.enforcement == Enforcement::Exact {
            return Ok(());
        }
        let message = format!(
            "{} varies the time step, and contact.penalty.{name} is a fraction of the stability limit: the spring would \
             vary with the step",
            self.axes[i].key
        );
        let remedy = "give the spring as a scale factor (0.1) or an areal stiffness ({ stiffness = 3.5e13 })";
        Err(self.layers.places.error(&self.axis_place(i), &message, remedy).into())
    }

    /// Sets [`Point::elements`] of every run by making its mesh; equal meshes are made once.
    ///
    /// # Errors
    /// A mesh that cannot be made.
    pub fn count_elements(&self, points: &mut [Point]) -> Result<(), CaseError> {
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        for point in points {
            let case = &point.case;
            let key = plan::alike((&case.disk, &case.bar, &case.mesh, &case.element));
            let found = key.as_ref().and_then(|key| known.get(key));
            point.elements = match found {
                Some(elements) => *elements,
                None => {
                    let elements = crate::scenario::elements(case);
                    let elements = elements.map_err(|e| self.refused(&e, case, &point.indices))?;
                    known.extend(key.map(|key| (key, elements)));
                    elements
                }
            };
        }
        Ok(())
    }

    /// SHA-256, in hexadecimal, of the cases of `points` and the rule of the step: what identifies the sweep.
    pub fn hash(&self, points: &[Point]) -> String {
        let mut hash = Sha256::new();
        for point in points {
            hash.update(point.case.to_toml());
        }
        hash.update(self.step.map_or("", |rule| rule.word()));
        hexadecimal(&hash.finalize())
    }

    /// An error of a run's case, at the place in the sweep file that caused it, if one did.
    fn placed(&self, error: CaseError, indices: &[usize]) -> CaseError {
        let CaseError::Key(found) = error else {
            return error;
        };
        let Some(place) = self.place_of(&found.key, indices) else {
            return CaseError::Key(found);
        };
        let said = found.message.trim_start_matches("--set: ");
        let remedy = found.help.as_deref().unwrap_or("change this value");
        self.layers.places.error(&place, said, remedy).into()
    }

    /// An error of a run that could not be set up, at the place in the sweep file or the base case that caused it.
    pub(crate) fn refused(
        &self,
        error: &ScenarioError,
        case: &Case,
        indices: &[usize],
    ) -> CaseError {
        let (message, remedy) = (error.to_string(), error.remedy());
        let Some(key) = error.key() else {
            return self
                .layers
                .places
                .error("base", &message, "change the base case or the axes")
                .into();
        };
        match self.place_of(key, indices) {
            Some(place) => self.layers.places.error(&place, &message, &remedy).into(),
            None => case.error_at(key, &message, &remedy),
        }
    }
}

/// The number of the run and its parameters, as a folder's name.
fn run_name(n: usize, chosen: &[(&str, &Value)]) -> String {
    let mut name = String::new();
    for (key, value) in chosen {
        let short = key.rsplit('.').next().unwrap_or(key);
        name += &format!("-{short}-{}", folder_text(value));
    }
    let fit = |c: &char| name::may_hold(*c) && *c != ' ' && c.is_ascii();
    let name: String = name.chars().filter(fit).take(LONGEST_NAME).collect();
    format!("{n:03}{name}")
}

fn folder_text(value: &Value) -> String {
    match value {
        Value::Float(x) => crate::case::value::number(*x),
        Value::Table(table) => {
            let entries: Vec<_> =
                table.iter().map(|(key, value)| format!("{key}-{}", folder_text(value))).collect();
            entries.join("-")
        }
        other => other.to_string(),
    }
}
