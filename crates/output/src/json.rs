use crate::OutputError;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::Error as KeyError;
use serde::de::{IgnoredAny, IntoDeserializer, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::marker::PhantomData;
use std::path::Path;

/// Writes `value` as indented JSON to `path`, which holds the complete old text or the complete new one at any
/// time: the text goes to a temporary file beside it, which is synced and then renamed.
///
/// # Errors
/// A path without a file name, a value that is no JSON, a file that cannot be written.
pub fn write_json_atomically<T: Serialize + ?Sized>(
    path: impl AsRef<Path>,
    value: &T,
) -> Result<(), OutputError> {
    let path = path.as_ref();
    let failed = |reason: String| OutputError::Create { path: path.to_owned(), reason };
    let mut name =
        path.file_name().ok_or_else(|| failed("the path names no file".into()))?.to_owned();
    name.push(".partial");
    let partial = path.with_file_name(name);
    let write = || -> std::io::Result<()> {
        let mut out = BufWriter::new(File::create(&partial)?);
        serde_json::to_writer_pretty(&mut out, value)?;
        out.write_all(b"\n")?;
        out.into_inner()?.sync_all()?;
        std::fs::rename(&partial, path)
    };
    write().map_err(|error| {
        // An incomplete temporary file is of no use; the error to report is `error`.
        let _ = std::fs::remove_file(&partial);
        failed(error.to_string())
    })
}

/// The entries of a map whose keys this version knows: those that a later version adds are left out.
///
/// # Errors
/// What is no map; a value of a known key that cannot be read.
pub fn known<'de, D, K, V>(from: D) -> Result<BTreeMap<K, V>, D::Error>
where
    D: Deserializer<'de>,
    K: Deserialize<'de> + Ord,
    V: Deserialize<'de>,
{
    from.deserialize_map(Known(PhantomData))
}

/// The schema of a map whose keys are words of a type.
pub fn keyed<K: JsonSchema, V: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let (keys, values) = (generator.subschema_for::<K>(), generator.subschema_for::<V>());
    json_schema!({ "type": "object", "propertyNames": keys, "additionalProperties": values })
}

/// A key of a map with more than one name.
pub trait Aliased {
    /// Its names beside that which it is written by.
    fn aliases(&self) -> &'static [&'static str];
}

/// Writes the value of each key under all its names.
///
/// # Errors
/// As of the serializer.
pub fn by_all_names<S, K, V>(map: &BTreeMap<K, V>, to: S) -> Result<S::Ok, S::Error>
where
    S: Serializer,
    K: Aliased + Serialize,
    V: Serialize,
{
    let mut entries = to.serialize_map(None)?;
    for (key, value) in map {
        entries.serialize_entry(key, value)?;
        key.aliases().iter().try_for_each(|name| entries.serialize_entry(name, value))?;
    }
    entries.end()
}

struct Known<K, V>(PhantomData<(K, V)>);

impl<'de, K: Deserialize<'de> + Ord, V: Deserialize<'de>> Visitor<'de> for Known<K, V> {
    type Value = BTreeMap<K, V>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries = BTreeMap::new();
        while let Some(key) = map.next_key::<String>()? {
            match K::deserialize(IntoDeserializer::<KeyError>::into_deserializer(key)) {
                Ok(key) => drop(entries.insert(key, map.next_value()?)),
                Err(_) => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(entries)
    }
}
