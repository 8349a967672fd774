//! Arrays over the points or the cells of a grid that say which belong to sets.

use super::foreign::Set;
use super::joined;
use std::collections::BTreeMap;

/// A cell of the grid: a hexahedron with its index among them, a quadrangle, or one that is ignored.
pub(super) enum Cell {
    Hex(u32, [u32; 8]),
    Quad([u32; 4]),
    Ignored,
}

/// An array that has one number for each point or cell.
pub(super) struct SetArray<'a> {
    pub(super) name: &'a str,
    pub(super) values: &'a [i64],
    /// Whether its numbers are of a type of at least 32 bits, as those are that meshio joins sets to.
    pub(super) wide: bool,
    /// The cells that it is over; `None` if it is over points.
    pub(super) cells: Option<&'a [Cell]>,
}

/// The sets that the arrays of a grid hold.
#[derive(Default)]
pub(super) struct SetsOfArrays {
    /// Sets that have an array each.
    single: BTreeMap<String, Set>,
    /// Sets that share an array.
    shared: BTreeMap<String, Set>,
    /// What the user should know, a sentence each.
    pub(super) notes: Vec<String>,
}

impl SetsOfArrays {
    /// Takes the sets of an array, if it holds any: of zeros and ones that of its name, and of numbers of sets those
    /// whose names make up its own, or go by their numbers where the numbers are those of Gmsh's groups.
    pub(super) fn take(&mut self, array: &SetArray) {
        let flags = array.values.iter().all(|value| [0, 1].contains(value));
        let has = |value: i64| array.values.contains(&value);
        if flags && has(1) {
            let bodies = array.name == "body" && array.cells.is_some() && has(0);
            let sets = array.numbered(2);
            let named: &[(&str, &Set)] = if bodies {
                &[("disk", &sets[0]), ("bar", &sets[1])]
            } else {
                &[(array.name, &sets[1])]
            };
            for (name, set) in named {
                self.single.entry((*name).to_owned()).or_default().add(set);
            }
        }
        if !array.wide {
            return;
        }
        if array.name == "gmsh:physical" && array.cells.is_some() {
            for (group, set) in array.groups() {
                self.shared.entry(group.to_string()).or_default().add(&set);
            }
        } else if let Some(names) = joined::names(array.name, array.values, array.cells.is_none()) {
            if names.len() > 1 {
                let (name, list) = (array.name, names.join("`, `"));
                self.notes.push(format!("the array `{name}` is read as the sets `{list}`"));
            }
            let sets = array.numbered(names.len());
            for (name, set) in names.into_iter().zip(sets) {
                self.shared.entry(name).or_default().add(&set);
            }
        }
    }

    /// The sets by their names. An array of its own says more surely what a set is than one that it shares.
    pub(super) fn sets(self) -> BTreeMap<String, Set> {
        let mut sets = self.shared;
        sets.extend(self.single);
        sets
    }
}

impl SetArray<'_> {
    /// Sets by the numbers of their members, from 0 to below `count`.
    fn numbered(&self, count: usize) -> Vec<Set> {
        let mut sets = vec![Set::default(); count];
        for (index, value) in self.values.iter().enumerate() {
            let set = usize::try_from(*value).ok().and_then(|number| sets.get_mut(number));
            if let Some(set) = set {
                self.put(index, set);
            }
        }
        sets
    }

    /// Sets by the numbers of their members; 0 is for members of none.
    fn groups(&self) -> BTreeMap<i64, Set> {
        let mut groups = BTreeMap::<i64, Set>::new();
        for (index, value) in self.values.iter().enumerate().filter(|(_, value)| **value != 0) {
            self.put(index, groups.entry(*value).or_default());
        }
        groups
    }

    fn put(&self, index: usize, set: &mut Set) {
        match self.cells.map(|cells| &cells[index]) {
            None => set.nodes.push(index as u32),
            Some(Cell::Hex(hex, _)) => set.hexes.push(*hex),
            Some(Cell::Quad(nodes)) => set.faces.push(*nodes),
            Some(Cell::Ignored) => {}
        }
    }
}

impl Set {
    fn add(&mut self, other: &Self) {
        self.nodes.extend(&other.nodes);
        self.hexes.extend(&other.hexes);
        self.faces.extend(&other.faces);
    }
}
