//! Keys of lower layers that have no meaning beside those of higher ones.

use crate::case::error::{CaseError, raise};
use crate::case::keys::KEYS;
use crate::case::layers::Layers;
use crate::case::schema::BodyModel;
use crate::case::value::{float, get, remove};
use toml::{Table, Value};

const MODEL: &str = "model";
const CREEPAGE: &str = "drive.creepage";
const RAMP: &str = "drive.ramp";

/// Removes the keys that have no meaning for the model of the case from the layers below the one that chooses it, and
/// names them.
///
/// # Errors
/// Such keys in the layer that chooses the model, or in one above it: all of them.
pub fn leave_out(layers: &mut Layers) -> Result<Vec<&'static str>, CaseError> {
    let given = get(&layers.table, MODEL);
    let model = match given.map(|word| word.as_str().and_then(BodyModel::named)) {
        None => BodyModel::default(),
        Some(Some(model)) => model,
        // refused where each key is checked
        Some(None) => return Ok(Vec::new()),
    };
    let chosen = layers.places.height(MODEL);
    let useless = KEYS.iter().filter(|key| !key.has_meaning_for(model)).map(|key| key.path);
    let given = useless.filter(|path| get(&layers.table, path).is_some());
    let (left_out, refused): (Vec<_>, Vec<_>) = given.partition(|path| {
        let height = layers.places.height(path);
        height.zip(chosen).is_some_and(|(height, chosen)| height < chosen)
    });
    let error = |path: &&str| {
        let message = format!("{path} has no meaning for model = \"{}\"", model.word());
        layers.places.error(path, &message, "leave it out")
    };
    raise(refused.iter().map(error).collect())?;
    left_out.iter().for_each(|path| layers.drop_key(path));
    Ok(left_out)
}

/// Removes a ramp that the layers below a table give, unless lateral creepage or spin rise over it: the table says all.
pub(crate) fn drop_ramp(layers: &mut Layers) {
    let table = get(&layers.table, CREEPAGE).is_some_and(Value::is_array);
    let number = |path| get(&layers.table, path).and_then(float).unwrap_or(0.0);
    let rises = ["drive.lateral_creepage", "drive.spin"].into_iter().any(|key| number(key) != 0.0);
    let heights = [RAMP, CREEPAGE].map(|key| layers.places.height(key));
    if table && !rises && heights[0] < heights[1] {
        layers.drop_key(RAMP);
    }
}

/// Removes the crowns in whose place there are profiles.
pub fn drop_crowns(table: &mut Table) {
    for body in ["disk", "bar"] {
        if get(table, &format!("{body}.profile")).is_some() {
            remove(table, &format!("{body}.crown_radius"));
        }
    }
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
