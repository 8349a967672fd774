//! The numbers of a law that are given.

use crate::{NUMBERS, Number};
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;

/// Numbers by their keys, all of them of [`NUMBERS`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(BTreeMap<&'static str, f64>);

impl Values {
    /// The number with this key, if it is given.
    pub fn get(&self, key: &str) -> Option<f64> {
        self.0.get(key).copied()
    }

    /// Gives a number.
    pub fn set(&mut self, number: &Number, value: f64) {
        self.0.insert(number.key(), value);
    }

    /// The numbers that are given, in the order of [`NUMBERS`].
    pub fn given(&self) -> impl Iterator<Item = (&'static Number, f64)> {
        NUMBERS.iter().filter_map(|number| Some((number, self.get(number.key())?)))
    }
}

impl Number {
    /// The number with a given key.
    pub fn of(key: &str) -> Option<&'static Self> {
        NUMBERS.iter().find(|number| number.key() == key)
    }
}

impl Serialize for Values {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.given().map(|(number, value)| (number.key(), value)))
    }
}

impl<'de> Deserialize<'de> for Values {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Given)
    }
}

struct Given;

impl<'de> Visitor<'de> for Given {
    type Value = Values;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("parameters of a friction law")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Values, A::Error> {
        let mut values = Values::default();
        while let Some(key) = map.next_key::<String>()? {
            let Some(number) = Number::of(&key) else {
                return Err(A::Error::custom(format!("unknown field `{key}`")));
            };
            if let Some(value) = map.next_value::<Option<f64>>()? {
                values.set(number, value);
            }
        }
        Ok(values)
    }
}
