//! Keys that have no meaning for the model of a case.

use crate::case::check::raise;
use crate::case::error::CaseError;
use crate::case::keys::KEYS;
use crate::case::layers::{Layers, Origin, get, remove};
use crate::case::model::{BodyModel, LeftOut};
use toml::{Table, Value};

const MODEL: &str = "model";

/// Removes the keys that have no meaning for the model of the case from the layers below the one that chooses it.
///
/// # Errors
/// Such keys in the layer that chooses the model, or in one above it: all of them.
pub fn leave_out(layers: &mut Layers) -> Result<LeftOut, CaseError> {
    let given = get(&layers.table, MODEL);
    let model = match given.map(|word| word.as_str().and_then(BodyModel::named)) {
        None => BodyModel::default(),
        Some(Some(model)) => model,
        // refused where each key is checked
        Some(None) => return Ok(LeftOut::default()),
    };
    let chosen = layers.origins.get(MODEL).map(|origin| layers.height(origin));
    let below = |origin: &Origin| chosen.is_some_and(|chosen| layers.height(origin) < chosen);
    let useless = KEYS.iter().filter(|key| !key.has_meaning_for(model));
    let (mut left_out, mut errors) = (Vec::new(), Vec::new());
    for key in useless.filter(|key| get(&layers.table, key.path).is_some()) {
        if layers.origins.get(key.path).is_some_and(below) {
            left_out.push(key.path);
        } else {
            let message = format!("{} has no meaning for model = \"{}\"", key.path, model.word());
            errors.push(layers.error_at(key.path, &message, "leave it out"));
        }
    }
    raise(errors)?;
    left_out.iter().for_each(|path| layers.drop_key(path));
    Ok(LeftOut(left_out))
}

/// Removes from the keys of a case those that have no meaning for its model, and sections that then are empty.
pub fn keep_meaningful(table: &mut Table, model: BodyModel) {
    for key in KEYS.iter().filter(|key| !key.has_meaning_for(model)) {
        remove(table, key.path);
    }
    drop_empty(table);
}

fn drop_empty(table: &mut Table) {
    table.retain(|_, value| match value {
        Value::Table(section) => {
            drop_empty(section);
            !section.is_empty()
        }
        _ => true,
    });
}
