//! A key of a case file: what it may hold, its unit, and what to do where its value is refused.

use toml::Value;

use crate::case::form::{Form, Range, within};
use crate::case::schema::BodyModel;
use crate::case::value::whole;

/// What a number usually is, and the other units in which people think of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Usual {
    /// Plausible values, in the unit of the key.
    pub range: Range,
    /// Other units by name, each with what one of it is in the unit of the key.
    pub also_in: &'static [(&'static str, f64)],
}

/// One key of a case file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Dotted path; `[]` stands for the index in an array of tables.
    pub path: &'static str,
    /// What it holds.
    pub form: Form,
    /// SI unit; `-` for dimensionless, empty where the value is no number.
    pub unit: &'static str,
    /// Whether a case must give it.
    pub needed: bool,
    /// What to do where the value is refused, or the key is missing.
    pub remedy: &'static str,
    /// The key that must be given for this one to be used, and the words of which that key must be one; no words
    /// where any value of it will do.
    pub only: Option<(&'static str, &'static [&'static str])>,
    /// The key that it replaces: the two are not given together in one layer, and this one removes the other from
    /// the layers below.
    pub instead_of: Option<&'static str>,
    /// The model for which alone it has meaning; none where it has meaning for all.
    pub model: Option<BodyModel>,
    /// Values in which a wrong unit shows; none where none is told.
    pub usual: Option<Usual>,
}

impl Key {
    /// The key at a path. The table of keys is made once, and its paths are kept as long as the program runs.
    pub(crate) fn at(self, path: String) -> Self {
        Self { path: path.leak(), ..self }
    }

    /// The key, used only where `other` is one of `words`; without words, where `other` is given.
    pub(crate) const fn only_with(
        self,
        other: &'static str,
        words: &'static [&'static str],
    ) -> Self {
        Self { only: Some((other, words)), ..self }
    }

    /// The key, which replaces `other`.
    pub(crate) const fn instead_of(self, other: &'static str) -> Self {
        Self { instead_of: Some(other), ..self }
    }

    /// The key, which has no meaning for half-spaces.
    pub(crate) const fn finite_elements_only(self) -> Self {
        Self { model: Some(BodyModel::FiniteElements), ..self }
    }

    /// The key, which has meaning for half-spaces alone.
    pub(crate) const fn half_space_only(self) -> Self {
        Self { model: Some(BodyModel::HalfSpace), ..self }
    }

    /// The key, whose plausible values lie in `range`; values beyond it that would not in one of the units `also_in` are
    /// told.
    pub(crate) const fn usually(
        self,
        range: Range,
        also_in: &'static [(&'static str, f64)],
    ) -> Self {
        Self { usual: Some(Usual { range, also_in }), ..self }
    }

    /// What it allows, as a noun phrase.
    pub fn allowed(&self) -> String {
        self.form.allowed(self.unit)
    }

    /// Why a value is not allowed, if it is not: the value, then what is allowed.
    pub fn mistake(&self, value: &Value) -> Option<String> {
        self.form.mistake(self.unit, value)
    }

    /// Turns a value that is allowed for the key into the one that the case holds: a whole number is an integer also where
    /// it was written as `1e2`.
    pub(crate) fn hold(&self, value: &mut Value) {
        if let (Form::Count(..), Some(Ok(n))) = (self.form, whole(value).map(i64::try_from)) {
            *value = Value::Integer(n);
        }
    }

    /// Whether it has meaning for a model.
    pub fn has_meaning_for(&self, model: BodyModel) -> bool {
        self.model.is_none_or(|only| only == model)
    }

    /// Whether every case must give it.
    pub fn is_always_needed(&self) -> bool {
        self.needed && self.only.is_none() && !self.path.contains("[]")
    }
}

/// Other units of a ratio.
pub(crate) const OF_A_HUNDRED: &[(&str, f64)] = &[("per cent", 1e-2), ("per mille", 1e-3)];
/// Other units of a speed in m/s.
pub(crate) const OF_SPEED: &[(&str, f64)] = &[("km/h", 1.0 / 3.6)];

/// A row of the table of keys, without its path.
pub(crate) const fn key(form: Form, unit: &'static str, remedy: &'static str) -> Key {
    Key {
        path: "",
        form,
        unit,
        needed: false,
        remedy,
        only: None,
        instead_of: None,
        model: None,
        usual: None,
    }
}

/// The same, of a key that must be given.
pub(crate) const fn needed(form: Form, unit: &'static str, remedy: &'static str) -> Key {
    Key { needed: true, ..key(form, unit, remedy) }
}

/// The same, of a key that must be one of `words`.
pub(crate) const fn word(words: &'static [&'static str]) -> Key {
    key(Form::Word(words), "", "choose one of the words")
}

use crate::case::irregularity::Coordinate;

use Form::{Crown, Flag, Heights, Number, Profile, Stiffness, Text};

pub(crate) const FLAG: Key = key(Flag, "", "give true or false, without quotes");
pub(crate) const LENGTH: Key =
    key(Number(within(1e-8, 10.0)), "m", "give the length in metres: 0.06 for 60 mm");
pub(crate) const CROWN: Key =
    key(Crown(within(1e-8, 1e4)), "m", "give the radius in metres, or \"flat\"");
pub(crate) const PROFILE: Key = key(
    Profile,
    "",
    "give the name of a profile, the path of a file in millimetres, relative to this one, or points in metres: `profile = \"60E1\"`",
);
pub(crate) const BAR_HEIGHTS: Key = key(
    Heights(Coordinate::X),
    "",
    "give heights in metres over x and y in metres: `surface = { formula = \"1e-5*cos(2*pi*x/0.04)\" }`, or `{ file = \"rail.csv\" }`",
)
.finite_elements_only();
pub(crate) const DISK_HEIGHTS: Key = key(
    Heights(Coordinate::Angle),
    "",
    "give heights in metres over the angle in rad: `out_of_round = { formula = \"1e-4*cos(3*angle)\" }`, or \
     `{ file = \"wheel.csv\" }`",
)
.finite_elements_only();
pub(crate) const ANGLE: Key =
    key(Number(within(-0.5, 0.5)), "rad", "give the angle in radians: 5e-3 for 5 mrad");
pub(crate) const YOUNG: Key =
    key(Number(within(1e3, 1e13)), "Pa", "give Young's modulus in pascal: 210e9 for steel");
pub(crate) const POISSON: Key = key(
    Number(within(0.0, 0.49999)),
    "-",
    "an explicit solid needs a finite wave speed: steel has 0.3, rubber-like bodies up to 0.49",
);
pub(crate) const DENSITY: Key =
    key(Number(within(1.0, 1e5)), "kg/m^3", "give the density in kg/m^3: 7800 for steel");
pub(crate) const SET: Key =
    key(Text, "", "give the name of a set of the mesh file in quotes").only_with("mesh.file", &[]);
pub(crate) const INTERVAL: Key = key(
    Number(within(1e-15, 10.0)),
    "s",
    "give a positive time in seconds: 5.7e-6 for 5.7 microseconds",
);
pub(crate) const PENALTY: Key = key(
    Stiffness,
    "-",
    "give a scale factor (0.1), an areal stiffness ({ stiffness = 3.5e13 }) or a fraction of the stability \
     limit ({ stability = 0.5 })",
);
