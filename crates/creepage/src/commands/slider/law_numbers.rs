//! The numbers of friction laws as settings of the slider, taken from the declarations of the laws.

use friction::{LAWS, NUMBERS, Number, Values};
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

use super::settings::unknown;

/// The numbers that are given of a law without state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LawNumbers(pub Values);

/// The numbers that the laws of the slider take.
pub(super) fn numbers() -> impl Iterator<Item = &'static Number> {
    let steady = |key: &str| LAWS.iter().any(|law| law.is_steady() && law.has(key));
    NUMBERS.iter().filter(move |number| steady(number.key()))
}

/// The name of a number in a file of settings: its key, of a coefficient with mu before it.
pub(super) fn name(number: &Number) -> &'static str {
    match number.key() {
        "static" => "mu_static",
        "dynamic" => "mu_dynamic",
        key => key,
    }
}

/// The number with a name.
pub(super) fn named(wanted: &str) -> Option<&'static Number> {
    numbers().find(|number| name(number) == wanted)
}

impl Serialize for LawNumbers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.given().map(|(number, value)| (name(number), value)))
    }
}

impl<'de> Deserialize<'de> for LawNumbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Given)
    }
}

/// Reads what no other setting has taken.
struct Given;

impl<'de> Visitor<'de> for Given {
    type Value = LawNumbers;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("settings of the slider")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<LawNumbers, A::Error> {
        let mut values = Values::default();
        while let Some(key) = map.next_key::<String>()? {
            let number = named(&key).ok_or_else(|| A::Error::custom(unknown(&key)))?;
            if let Some(value) = map.next_value::<Option<f64>>()? {
                values.set(number, value);
            }
        }
        Ok(LawNumbers(values))
    }
}

#[cfg(feature = "clap")]
mod options {
    use super::{LawNumbers, name, numbers};
    use clap::{Arg, ArgGroup, ArgMatches, Args, Command, FromArgMatches, value_parser};
    use friction::{LAWS, LeftOut, Number, Values};
    use std::sync::LazyLock;

    /// A number with the texts of its option.
    struct NumberOption {
        number: &'static Number,
        long: String,
        placeholder: String,
        help: String,
    }

    static OPTIONS: LazyLock<Vec<NumberOption>> =
        LazyLock::new(|| numbers().map(NumberOption::of).collect());

    impl NumberOption {
        fn of(number: &'static Number) -> Self {
            let takes = |law: &friction::Declaration| {
                let own = law.numbers.iter().find(|(own, _)| own == number)?;
                law.is_steady().then_some((law.word, own.1))
            };
            let takers: Vec<_> = LAWS.into_iter().filter_map(takes).collect();
            let laws: Vec<_> = takers.iter().map(|(word, _)| *word).collect();
            let mut sentence = number.sentence.trim_end_matches('.').to_owned();
            for other in numbers() {
                let option = format!("--{}", name(other).replace('_', "-"));
                sentence = sentence.replace(&format!("`{}`", other.key()), &option);
            }
            let mut help = format!("{sentence} ({})", laws.join(", "));
            let default = |(word, left_out): &(&'static str, LeftOut)| match left_out {
                LeftOut::Default(value) => Some((*word, *value)),
                _ => Some((*word, super::super::settings::paper(number)?)),
            };
            let defaults: Vec<_> = takers.iter().filter_map(default).collect();
            if let [(_, value), ..] = defaults[..] {
                let with = defaults.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
                let with =
                    if with == laws.join(", ") { String::new() } else { format!(" with {with}") };
                help += &format!(" [default{with}: {value}]");
            }
            let placeholder = match number.unit {
                "-" if name(number).starts_with("mu_") => "MU".into(),
                "-" => name(number).to_uppercase(),
                unit => unit.to_uppercase(),
            };
            Self { number, long: name(number).replace('_', "-"), placeholder, help }
        }
    }

    impl Args for LawNumbers {
        fn augment_args(command: Command) -> Command {
            let args = OPTIONS.iter().map(|option| {
                Arg::new(name(option.number))
                    .long(option.long.as_str())
                    .value_name(option.placeholder.as_str())
                    .help(option.help.as_str())
                    .value_parser(value_parser!(f64))
                    .allow_negative_numbers(true)
            });
            let names = numbers().map(name);
            command.args(args).group(ArgGroup::new("LawNumbers").multiple(true).args(names))
        }

        fn augment_args_for_update(command: Command) -> Command {
            Self::augment_args(command)
        }
    }

    impl FromArgMatches for LawNumbers {
        fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
            let mut values = Values::default();
            for number in numbers() {
                if let Some(value) = matches.get_one::<f64>(name(number)) {
                    values.set(number, *value);
                }
            }
            Ok(Self(values))
        }

        fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
            *self = Self::from_arg_matches(matches)?;
            Ok(())
        }
    }
}
