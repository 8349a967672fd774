//! What contact keeps from step to step, as plain columns: enough to go on with the same bits.
//!
//! Each kind of row lists its fields once ([`Fields`]), for saving and for restoring alike, so that
//! the two cannot disagree. Left out is what a step computes anew before it reads it. Beside the rows
//! the search keeps where the surfaces were when it last looked: it decides when the lists are made
//! anew, and so the order in which forces are added.

use crate::point::{ContactPoint, Enforced, State};
use crate::search::{Listed, Search};
use crate::surface::{ContactSurface, NONE};
use crate::vector::Vec3;

/// A named array of a state: `values.len() / components` entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, with `/` between group and member.
    pub name: String,
    /// SI units, `"1"` for a pure number.
    pub units: String,
    /// Numbers per entry.
    pub components: usize,
    /// The numbers, entry after entry.
    pub values: Numbers,
}

/// The numbers of a [`Column`].
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Quantities.
    Real(Vec<f64>),
    /// Indices, counters and labels.
    Whole(Vec<u32>),
}

impl Numbers {
    fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Whole(values) => values.len(),
        }
    }
}

/// State of contact between two steps, of either method of enforcement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactState {
    /// The columns, in no order that matters.
    pub columns: Vec<Column>,
}

/// A state that is not of the contact that is to go on from it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    /// A column is not there, or has another shape.
    #[error("the state of contact has no column `{name}` of {shape}")]
    Column {
        /// Its name.
        name: String,
        /// What is wanted.
        shape: String,
    },
    /// An index or a label out of range.
    #[error("`{name}` in the state of contact has an entry that this contact cannot have")]
    Range {
        /// The column.
        name: String,
    },
}

/// The fields of a row, visited one after the other.
pub(crate) trait Fields {
    fn real(&mut self, name: &'static str, units: &'static str, values: &mut [f64]);
    fn whole(&mut self, name: &'static str, value: &mut u32);

    fn number(&mut self, name: &'static str, units: &'static str, value: &mut f64) {
        self.real(name, units, std::slice::from_mut(value));
    }

    fn state(&mut self, state: &mut State) {
        let mut code = *state as u32;
        self.whole("state", &mut code);
        *state = match code {
            1 => State::Stick,
            2 => State::Slip,
            _ => State::Open,
        };
    }

    fn flag(&mut self, name: &'static str, value: &mut bool) {
        let mut code = u32::from(*value);
        self.whole(name, &mut code);
        *value = code != 0;
    }
}

/// Appends a row to the columns of its table; the first, which only makes them, is left out.
struct Gather<'a> {
    table: &'a str,
    columns: Vec<Column>,
    next: usize,
    made: bool,
}

impl Gather<'_> {
    fn column(
        &mut self,
        name: &str,
        units: &str,
        components: usize,
        empty: Numbers,
    ) -> &mut Column {
        if !self.made {
            let name = format!("{}/{name}", self.table);
            self.columns.push(Column { name, units: units.into(), components, values: empty });
        }
        self.next += 1;
        &mut self.columns[self.next - 1]
    }
}

impl Fields for Gather<'_> {
    fn real(&mut self, name: &'static str, units: &'static str, values: &mut [f64]) {
        let made = self.made;
        let column = self.column(name, units, values.len(), Numbers::Real(Vec::new()));
        if let (true, Numbers::Real(kept)) = (made, &mut column.values) {
            kept.extend_from_slice(values);
        }
    }

    fn whole(&mut self, name: &'static str, value: &mut u32) {
        let made = self.made;
        let column = self.column(name, "1", 1, Numbers::Whole(Vec::new()));
        if let (true, Numbers::Whole(kept)) = (made, &mut column.values) {
            kept.push(*value);
        }
    }
}

/// Fills a row from the columns of its table, which are in the order of its fields.
struct Scatter<'a> {
    columns: &'a [&'a Column],
    row: usize,
    next: usize,
}

impl Fields for Scatter<'_> {
    fn real(&mut self, _: &'static str, _: &'static str, values: &mut [f64]) {
        if let Numbers::Real(kept) = &self.columns[self.next].values {
            let n = values.len();
            values.copy_from_slice(&kept[n * self.row..n * (self.row + 1)]);
        }
        self.next += 1;
    }

    fn whole(&mut self, _: &'static str, value: &mut u32) {
        if let Numbers::Whole(kept) = &self.columns[self.next].values {
            *value = kept[self.row];
        }
        self.next += 1;
    }
}

/// Empty columns of a table, in the order of the fields of its rows.
fn layout<E: Enforced>(table: &str) -> Vec<Column> {
    let mut gather = Gather { table, columns: Vec::new(), next: 0, made: false };
    ContactPoint::<E>::near(0, 0).fields(&mut gather);
    gather.columns
}

/// The rows as columns of `table`.
pub(crate) fn save_rows<E: Enforced>(
    table: &str,
    rows: &[ContactPoint<E>],
    state: &mut ContactState,
) {
    let mut gather = Gather { table, columns: layout::<E>(table), next: 0, made: true };
    for row in rows {
        let mut row = *row;
        gather.next = 0;
        row.fields(&mut gather);
    }
    state.columns.append(&mut gather.columns);
}

/// The rows of `table`, which are slaves on `slaves` and have projections on `masters`.
pub(crate) fn restore_rows<E: Enforced>(
    table: &str,
    state: &ContactState,
    slaves: &ContactSurface,
    masters: &ContactSurface,
) -> Result<Vec<ContactPoint<E>>, StateError> {
    let mut columns = Vec::new();
    let mut count = None;
    for wanted in layout::<E>(table) {
        let entries = count.map(|n: usize| n * wanted.components);
        let column = state.find(&wanted.name, &wanted, entries)?;
        count = Some(column.values.len() / wanted.components);
        columns.push(column);
    }
    let mut rows: Vec<ContactPoint<E>> = Vec::new();
    for row in 0..count.unwrap_or(0) {
        let mut made = ContactPoint::<E>::near(0, 0);
        made.fields(&mut Scatter { columns: &columns, row, next: 0 });
        let slave = made.slave as usize;
        let ascends = rows.last().is_none_or(|last| last.slave < made.slave);
        let range = |name: &str| StateError::Range { name: format!("{table}/{name}") };
        if slave >= slaves.nodes.len() || !ascends {
            return Err(range("slave"));
        }
        if made.face as usize >= masters.faces.len() && (made.is_closed() || made.face != NONE) {
            return Err(range("face"));
        }
        rows.push(made);
    }
    Ok(rows)
}

impl ContactState {
    /// A column by its name, of the kind of `like`, with so many numbers if that is known.
    fn find(
        &self,
        name: &str,
        like: &Column,
        numbers: Option<usize>,
    ) -> Result<&Column, StateError> {
        let same_kind = |c: &&Column| {
            matches!(
                (&c.values, &like.values),
                (Numbers::Real(_), Numbers::Real(_)) | (Numbers::Whole(_), Numbers::Whole(_))
            )
        };
        self.columns
            .iter()
            .find(|c| c.name == name)
            .filter(same_kind)
            .filter(|c| c.values.len().is_multiple_of(like.components))
            .filter(|c| numbers.is_none_or(|n| c.values.len() == n))
            .ok_or_else(|| StateError::Column {
                name: name.into(),
                shape: match numbers {
                    Some(n) => format!("{n} numbers"),
                    None => format!("entries of {} numbers", like.components),
                },
            })
    }

    pub(crate) fn push(&mut self, name: &str, units: &str, components: usize, values: Numbers) {
        let (name, units) = (name.into(), units.into());
        self.columns.push(Column { name, units, components, values });
    }

    /// Quantities, so many entries if that is known.
    pub(crate) fn real(
        &self,
        name: &str,
        components: usize,
        entries: Option<usize>,
    ) -> Result<&[f64], StateError> {
        match &self.kept(name, components, entries, Numbers::Real(Vec::new()))?.values {
            Numbers::Real(values) => Ok(values),
            Numbers::Whole(_) => Ok(&[]),
        }
    }

    /// Indices, so many entries if that is known.
    pub(crate) fn whole(
        &self,
        name: &str,
        components: usize,
        entries: Option<usize>,
    ) -> Result<&[u32], StateError> {
        match &self.kept(name, components, entries, Numbers::Whole(Vec::new()))?.values {
            Numbers::Whole(values) => Ok(values),
            Numbers::Real(_) => Ok(&[]),
        }
    }

    /// A column of numbers of the kind of `values`.
    fn kept(
        &self,
        name: &str,
        components: usize,
        entries: Option<usize>,
        values: Numbers,
    ) -> Result<&Column, StateError> {
        let like = Column { name: String::new(), units: String::new(), components, values };
        self.find(name, &like, entries.map(|n| n * components))
    }

    fn push_vectors(&mut self, name: &str, units: &str, values: &[Vec3]) {
        self.push(name, units, 3, Numbers::Real(values.as_flattened().to_vec()));
    }
}

const COUNTERS: &str = "search/steps";

/// What decides when the next search is due.
pub(crate) fn save_search(search: &Search, state: &mut ContactState) {
    for side in 0..2 {
        let name = |what: &str| format!("search/{what}_{side}");
        state.push_vectors(&name("at"), "m", &search.at[side]);
        state.push_vectors(&name("moved"), "m", &search.moved[side]);
        let allowance = Numbers::Real(search.allowance[side].clone());
        state.push(&name("allowance"), "1/m2", 1, allowance);
    }
    let counters = vec![search.steps_to_check, search.steps_since_check];
    state.push(COUNTERS, "1", 2, Numbers::Whole(counters));
}

/// The reverse of [`save_search`].
pub(crate) fn restore_search(
    search: &mut Search,
    state: &ContactState,
    sides: &[ContactSurface; 2],
) -> Result<(), StateError> {
    let counters = state.whole(COUNTERS, 2, Some(1))?;
    for side in 0..2 {
        let name = |what: &str| format!("search/{what}_{side}");
        // Empty before the first search.
        let begun = state.columns.iter().any(|c| c.name == name("at") && c.values.len() > 0);
        let nodes = if begun { sides[side].nodes.len() } else { 0 };
        search.at[side] = state.real(&name("at"), 3, Some(nodes))?.as_chunks().0.to_vec();
        search.moved[side] = state.real(&name("moved"), 3, Some(nodes))?.as_chunks().0.to_vec();
        search.allowance[side] = state.real(&name("allowance"), 1, Some(nodes))?.to_vec();
    }
    (search.steps_to_check, search.steps_since_check) = (counters[0], counters[1]);
    Ok(())
}
