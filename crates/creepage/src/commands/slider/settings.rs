//! Parameters of the slider from a file and from options.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::case::{Excerpt, table};
use crate::commands::slider::law_numbers::{self, LawNumbers};
#[cfg(feature = "clap")]
use friction::LAWS;
use friction::{Declaration, Expression, FrictionLaw, Kind, Memory, Number, STATIC, Table};
use miette::{Diagnostic, SourceSpan};
use output::files::{input, printable};
use serde::de::IntoDeserializer as _;
use serde::{Deserialize, Serialize};
use slider::{Method, ParameterError, Parameters};
use thiserror::Error;

/// Everything that can be set, as options and, with the same names, as keys of a TOML file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct Settings {
    /// Time stepping [default: implicit]
    #[cfg_attr(feature = "clap", arg(long, value_enum))]
    pub method: Option<MethodName>,
    /// Time step (s) [default: 1e-4]
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", allow_negative_numbers = true))]
    pub dt: Option<f64>,
    /// Simulated time (s) [default: 5]
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", allow_negative_numbers = true))]
    pub t_end: Option<f64>,
    /// Velocity of the belt v_ref (m/s) [default: -1]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S", allow_negative_numbers = true))]
    pub belt: Option<f64>,
    /// Normal force F_n (N) [default: 20]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", allow_negative_numbers = true))]
    pub normal_force: Option<f64>,
    /// Mass (kg) [default: 0.01]
    #[cfg_attr(feature = "clap", arg(long, value_name = "KG", allow_negative_numbers = true))]
    pub mass: Option<f64>,
    /// Spring k_spring (N/m) [default: 10]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N/M", allow_negative_numbers = true))]
    pub spring: Option<f64>,
    /// Damping c_damp (N s/m) [default: 0.04]
    #[cfg_attr(feature = "clap", arg(long, value_name = "C", allow_negative_numbers = true))]
    pub damping: Option<f64>,
    /// Slip velocity s_adhes up to which implicit and explicit take friction for linear (m/s)
    /// [default: 1e-3]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S", allow_negative_numbers = true))]
    pub adhesion: Option<f64>,
    /// Position at t = 0 (m) [default: 0]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", allow_negative_numbers = true))]
    pub x0: Option<f64>,
    /// Velocity at t = 0 (m/s) [default: that of the belt]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S", allow_negative_numbers = true))]
    pub v0: Option<f64>,
    /// Friction law [default: exponential, or what --table or --expression gives]
    #[cfg_attr(feature = "clap", arg(long, value_parser = laws()))]
    pub law: Option<Kind>,
    /// Numbers of the friction law.
    #[serde(flatten)]
    #[cfg_attr(feature = "clap", command(flatten))]
    pub numbers: LawNumbers,
    /// Friction law as a CSV file: slip speed (m/s), mu
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE"))]
    pub table: Option<PathBuf>,
    /// Friction law as a formula in the slip speed s (m/s), for example "0.32 + 0.18*exp(-6*s)"
    #[cfg_attr(feature = "clap", arg(long, value_name = "FORMULA"))]
    pub expression: Option<String>,
    /// Allow friction that rises with slip speed
    #[cfg_attr(feature = "clap", arg(long, num_args = 0..=1, require_equals = true,
        default_missing_value = "true"))]
    pub allow_strengthening: Option<bool>,
    /// Stiffness k_t of the friction spring (penalty, N/m) [default: 1e6]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N/M", allow_negative_numbers = true))]
    pub stiffness: Option<f64>,
    /// Slip distance d_c over which friction adapts (memory, m) [default: 1e-6]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", allow_negative_numbers = true))]
    pub memory_distance: Option<f64>,
    /// Slip speed s_0 at which friction adapts at rest (memory, m/s) [default: 1e-2]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S", allow_negative_numbers = true))]
    pub memory_floor: Option<f64>,
}

/// The methods by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum MethodName {
    /// Backward Euler, Eqs (19)-(27)
    Implicit,
    /// The paper's explicit method, Eqs (28)-(32)
    Explicit,
    /// Explicit, with the friction spring of Eqs (10) and (11)
    Penalty,
    /// Explicit, with friction that honours Eqs (6) and (7) exactly
    Exact,
    /// Exact, with friction that remembers
    Memory,
}

impl MethodName {
    /// The method.
    pub fn method(self) -> Method {
        match self {
            Self::Implicit => Method::Implicit,
            Self::Explicit => Method::Explicit,
            Self::Penalty => Method::Penalty,
            Self::Exact => Method::Exact,
            Self::Memory => Method::Memory,
        }
    }
}

/// The default of a number that its law needs: that of the paper.
pub(super) fn paper(number: &Number) -> Option<f64> {
    (*number == STATIC).then_some(0.5)
}

/// That there is no setting of this name.
pub(super) fn unknown(name: &str) -> String {
    let settings = serde_json::to_value(Settings::default()).unwrap_or_default();
    let names = settings.as_object().into_iter().flat_map(serde_json::Map::keys);
    let mut names: Vec<&str> = names.map(String::as_str).collect();
    for number in law_numbers::numbers() {
        names.push(law_numbers::name(number));
    }
    format!("unknown field `{name}`, expected one of `{}`", names.join("`, `"))
}

/// The laws of the slider, those without state.
#[cfg(feature = "clap")]
fn laws() -> impl clap::builder::TypedValueParser<Value = Kind> {
    use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser as _};
    let value =
        |law: &Declaration| PossibleValue::new(law.word).help(law.sentence.trim_end_matches('.'));
    let steady = LAWS.into_iter().filter(|law| law.is_steady());
    let words = PossibleValuesParser::new(steady.map(value));
    words.try_map(|word| Kind::of(&word).ok_or("there is no such law"))
}

/// A setting that cannot be used.
#[derive(Debug, Error, Diagnostic)]
#[error("{message}")]
pub struct SettingError {
    message: String,
    #[source_code]
    source_code: Option<Excerpt>,
    #[label("here")]
    span: Option<SourceSpan>,
    #[help]
    help: String,
}

/// A file of settings with its text, for messages.
#[derive(Clone, Debug, Default)]
struct File {
    name: String,
    text: String,
    settings: Settings,
}

impl File {
    fn read(path: &Path) -> Result<Self, Box<SettingError>> {
        let name = path.display().to_string();
        let text = input::text(path, input::CASE).map_err(|error| {
            Box::new(SettingError {
                message: format!("{name}: cannot read the parameter file: {}", error.problem()),
                source_code: None,
                span: None,
                help: "give the path of a TOML file with --config".into(),
            })
        })?;
        let file = Self { name, text, settings: Settings::default() };
        let help = "keys are the names of the options with _ for -, for example t_end = 5; see \
                    `creepage slider --help`";
        if let Some((span, problem)) = file.misplaced() {
            return Err(file.error(Some(span), &problem, help));
        }
        match toml::from_str(&file.text) {
            Ok(settings) => Ok(Self { settings, ..file }),
            Err(error) => {
                let message = error.message().replace('\n', "; ");
                let located = file.error(error.span(), &message, help);
                // What is no TOML may be any file that can be read: of it a place is told, and no text.
                let toml = toml::from_str::<toml::Table>(&file.text).is_ok();
                Err(if toml {
                    located
                } else {
                    Box::new(SettingError { source_code: None, span: None, ..*located })
                })
            }
        }
    }

    fn error(&self, span: Option<Range<usize>>, message: &str, help: &str) -> Box<SettingError> {
        let line = span.as_ref().map_or(1, |span| {
            self.text[..span.start.min(self.text.len())].matches('\n').count() + 1
        });
        let shown = span.and_then(|span| Excerpt::of(&self.name, &self.text, span));
        let (source_code, span) = shown.unzip();
        Box::new(SettingError {
            message: printable(&format!("{}:{line}: {message}", self.name)),
            source_code,
            span,
            help: help.into(),
        })
    }

    /// The first key that is no setting, or number of a law that is none, with its problem.
    fn misplaced(&self) -> Option<(Range<usize>, String)> {
        let table = toml::de::DeTable::parse(&self.text).ok()?;
        let settings = serde_json::to_value(Settings::default()).ok()?;
        table.get_ref().iter().find_map(|(key, value)| {
            let name: &str = key.get_ref();
            if law_numbers::named(name).is_some() {
                let number = f64::deserialize(value.clone().into_deserializer());
                return number
                    .err()
                    .map(|error| (value.span(), error.message().replace('\n', "; ")));
            }
            settings.get(name).is_none().then(|| (key.span(), unknown(name)))
        })
    }

    /// Where the value of a key stands.
    fn span(&self, key: &str) -> Option<Range<usize>> {
        let table = toml::de::DeTable::parse(&self.text).ok()?;
        table.get_ref().get(key).map(|value| value.span())
    }
}

/// Options over a file.
#[derive(Clone, Debug)]
pub struct Sources<'a> {
    options: &'a Settings,
    file: File,
}

impl<'a> Sources<'a> {
    /// The options over those of the file, if there is one.
    pub fn new(options: &'a Settings, config: Option<&Path>) -> Result<Self, Box<SettingError>> {
        let file = config.map(File::read).transpose()?.unwrap_or_default();
        Ok(Self { options, file })
    }

    /// The method.
    pub fn method(&self) -> Option<Method> {
        self.options.method.or(self.file.settings.method).map(MethodName::method)
    }

    /// The friction table that is named.
    pub fn table(&self) -> Option<PathBuf> {
        // a path in the file is relative to the file
        let folder = Path::new(&self.file.name).parent().unwrap_or(Path::new(""));
        let in_file = self.file.settings.table.as_ref().map(|path| folder.join(path));
        self.options.table.clone().or(in_file)
    }

    /// The parameters, checked.
    pub fn parameters(&self) -> Result<Parameters, Box<SettingError>> {
        let (options, file) = (self.options, &self.file.settings);
        let default = Parameters::default();
        let memory = Memory::default();
        let belt = options.belt.or(file.belt).unwrap_or(default.belt);
        let or = |a: Option<f64>, b: Option<f64>, default: f64| a.or(b).unwrap_or(default);
        let parameters = Parameters {
            belt,
            normal_force: or(options.normal_force, file.normal_force, default.normal_force),
            mass: or(options.mass, file.mass, default.mass),
            spring: or(options.spring, file.spring, default.spring),
            damping: or(options.damping, file.damping, default.damping),
            adhesion: or(options.adhesion, file.adhesion, default.adhesion),
            law: self.law()?,
            stiffness: or(options.stiffness, file.stiffness, default.stiffness),
            memory: Memory {
                distance: or(options.memory_distance, file.memory_distance, memory.distance),
                floor: or(options.memory_floor, file.memory_floor, memory.floor),
            },
            dt: or(options.dt, file.dt, default.dt),
            end: or(options.t_end, file.t_end, default.end),
            x0: or(options.x0, file.x0, default.x0),
            v0: or(options.v0, file.v0, belt),
        };
        let parameters = parameters.checked().map_err(|error| self.out_of_range(&error))?;
        let allowed = options.allow_strengthening.or(file.allow_strengthening).unwrap_or(false);
        match parameters.law.strengthens() {
            Some(rise) if !allowed => {
                let help = "laws that strengthen are studied with --allow-strengthening";
                let (key, message) = match parameters.law.as_exponential() {
                    Some(law) => {
                        let (rest, fast) = (law.mu_static, law.mu_dynamic);
                        let allowed = "it must be from 0 to mu_static";
                        (
                            "mu_dynamic",
                            format!("mu_dynamic = {fast} is above mu_static = {rest}: {allowed}"),
                        )
                    }
                    None if self.table().is_some() => ("table", rise.to_string()),
                    None => ("expression", rise.to_string()),
                };
                Err(self.at(key, &message, help))
            }
            _ => Ok(parameters),
        }
    }

    /// The message of a parameter out of its range, where it was set.
    pub fn out_of_range(&self, error: &ParameterError) -> Box<SettingError> {
        self.at(error.key, &error.to_string(), "`creepage slider --help` lists the parameters")
    }

    fn law(&self) -> Result<Arc<dyn FrictionLaw>, Box<SettingError>> {
        let (options, file) = (self.options, &self.file.settings);
        let table = self.table();
        let expression = options.expression.as_ref().or(file.expression.as_ref());
        let kind = options.law.or(file.law).unwrap_or(match (&table, &expression) {
            (Some(_), _) => Kind::Table,
            (None, Some(_)) => Kind::Expression,
            (None, None) => Kind::Exponential,
        });
        let law = kind.declaration();
        if !law.is_steady() {
            return Err(self.not_of_the_slider(law));
        }
        let mut parameters = friction::Parameters { law: kind, ..Default::default() };
        for number in law_numbers::numbers() {
            let key = number.key();
            let given = options.numbers.0.get(key).or(file.numbers.0.get(key));
            if let Some(value) = given {
                self.used(law, key, law_numbers::name(number))?;
                let name = law_numbers::name(number);
                let unit = number.unit.trim_matches('-');
                ParameterError::unless_within(number.range, name, value, unit)
                    .map_err(|error| self.out_of_range(&error))?;
            }
            if let Some(value) = given.or(paper(number)) {
                parameters.numbers.set(number, value);
            }
        }
        if let Some(path) = table {
            self.used(law, "table", "table")?;
            parameters.table = Some(read_table(&path)?.points().to_vec());
        }
        if let Some(text) = expression {
            self.used(law, "expression", "expression")?;
            parameters.expression = Some(text.clone());
        }
        if let Some(key) = parameters.missing() {
            return Err(self.missing(law, key));
        }
        let no_law = || self.not_of_the_slider(law);
        parameters.steady(Expression::new).ok_or_else(no_law)?.map_err(|error| {
            self.at("expression", &error.to_string(), "see `creepage slider --help`")
        })
    }

    fn not_of_the_slider(&self, law: &Declaration) -> Box<SettingError> {
        let message =
            format!("the friction law '{}' is none of the slider, which keeps no state", law.word);
        self.at("law", &message, "`creepage slider --help` lists its laws")
    }

    /// Refuses a parameter that the law does not use.
    fn used(&self, law: &Declaration, key: &str, name: &str) -> Result<(), Box<SettingError>> {
        if law.has(key) {
            return Ok(());
        }
        let word = law.word;
        let numbers = law.numbers.iter().map(|(number, _)| law_numbers::name(number));
        let uses: Vec<_> = numbers.chain(law.needs.iter().copied()).collect();
        let message = format!("the friction law '{word}' does not use {name}");
        let help = format!("leave it out, or choose another law; {word} uses {}", uses.join(", "));
        Err(self.at(name, &message, &help))
    }

    fn missing(&self, law: &Declaration, key: &str) -> Box<SettingError> {
        let (name, what) = match (Number::of(key), key) {
            (Some(number), _) => (law_numbers::name(number), number.sentence.trim_end_matches('.')),
            (None, "table") => (key, "a CSV file: slip speed (m/s), mu"),
            (None, _) => (key, "a formula in s, the slip speed (m/s)"),
        };
        let option = name.replace('_', "-");
        let message = format!("the friction law '{}' needs --{option}: {what}", law.word);
        self.at("law", &message, "`creepage slider --help` has examples")
    }

    /// An error about a setting, shown in the file unless an option set it.
    fn at(&self, key: &str, message: &str, help: &str) -> Box<SettingError> {
        let option = format!("--{}", key.replace('_', "-"));
        let options = serde_json::to_value(self.options).unwrap_or_default();
        let by_option = options.get(key).is_some_and(|value| !value.is_null());
        match self.file.span(key) {
            Some(span) if !by_option => self.file.error(Some(span), message, help),
            _ => Box::new(SettingError {
                message: format!("{option}: {message}"),
                source_code: None,
                span: None,
                help: help.into(),
            }),
        }
    }
}

/// The friction law in the file of a friction table.
fn read_table(path: &Path) -> Result<Table, Box<SettingError>> {
    let name = path.display().to_string();
    let failed = |message: String| {
        Box::new(SettingError {
            message: printable(&message),
            source_code: None,
            span: None,
            help: table::REMEDY.into(),
        })
    };
    let text = input::text(path, input::TABLE)
        .map_err(|e| failed(format!("{name}: cannot read the friction table: {}", e.problem())))?;
    table::read(&text)
        .map_err(|mistake| failed(format!("{name}:{}: {}", mistake.line, mistake.problem)))
}
