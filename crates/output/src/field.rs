//! The declaration of a dataset: name, units, shape, meaning.

use std::borrow::Cow;

/// Name, units, shape and meaning of a field of a grid, or of a column of a history, which is a scalar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldSpec {
    /// Name of the dataset and of the array in viewers.
    pub name: Cow<'static, str>,
    /// SI units as text, such as `m/s`; `1` for a pure number.
    pub units: Cow<'static, str>,
    /// Numbers per point or cell: 1, 3 or 6.
    pub components: usize,
    /// Whether it is stored as unsigned bytes instead of `f64`.
    pub integer: bool,
    /// Whether its values belong to cells instead of points.
    pub on_cells: bool,
    /// What the field is, in a phrase.
    pub description: Cow<'static, str>,
}

/// Constructors from name, units and description.
macro_rules! shapes {
    ($($(#[$about:meta])* $shape:ident: $components:literal, $integer:literal, $on_cells:literal;)*) => {
        impl FieldSpec {
            $($(#[$about])*
            pub const fn $shape(
                name: &'static str,
                units: &'static str,
                description: &'static str,
            ) -> Self {
                Self {
                    name: Cow::Borrowed(name),
                    units: Cow::Borrowed(units),
                    components: $components,
                    integer: $integer,
                    on_cells: $on_cells,
                    description: Cow::Borrowed(description),
                }
            })*
        }
    };
}

shapes! {
    /// A number at every point, or in every row of a history.
    scalar: 1, false, false;
    /// Components x, y, z at every point.
    vector: 3, false, false;
    /// An integer from 0 to 255 at every point.
    label: 1, true, false;
    /// A number on every cell.
    cell_scalar: 1, false, true;
    /// Three numbers on every cell.
    cell_vector: 3, false, true;
    /// A symmetric tensor on every cell, xx yy zz xy yz xz.
    cell_tensor: 6, false, true;
    /// An integer from 0 to 255 on every cell.
    cell_label: 1, true, true;
}

impl FieldSpec {
    /// Its shape in words, as in the tables of `docs/files.md`: `vector`, `label, cells`.
    pub fn shape(&self) -> String {
        let numbers = match (self.integer, self.components) {
            (true, _) => "label",
            (false, 1) => "scalar",
            (false, 3) => "vector",
            (false, _) => "symmetric tensor",
        };
        if self.on_cells { format!("{numbers}, cells") } else { numbers.to_owned() }
    }
}
