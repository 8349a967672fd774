//! The fields of a data line, declared once: name, columns, and what a case does with each.
//!
//! A line is read through its [`Layout`], which hands out the fields that a case takes. All others must be blank or
//! rest at their default, unless they have no effect on a case: a field that nobody reads cannot hold anything
//! unnoticed.
//!
//! Source of names, columns and defaults: LS-DYNA Keyword User's Manual, vol. I and II, and the keyword classes of
//! PyDYNA, which are made of it.

/// A field of a data line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    /// Its name in the manual.
    pub(super) name: &'static str,
    /// Its width in the standard format (characters).
    pub(super) width: usize,
    pub(super) role: Role,
}

/// What a case does with a field.
#[derive(Clone, Copy, Debug)]
pub(super) enum Role {
    /// Takes its number.
    Taken(Taken),
    /// Nothing: it must be blank, 0 or one of these numbers.
    Rests(&'static [f64]),
    /// Nothing: it must be blank or one of these words, in capitals.
    Says(&'static [&'static str]),
    /// Nothing, whatever it holds.
    Idle,
}

/// Which numbers a field may hold that a case takes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Taken {
    /// Any; a blank is 0.
    Real,
    /// Any; this where the field is blank or 0, as LS-DYNA takes it.
    RealOr(f64),
    /// Whole numbers; a blank is 0.
    Whole,
    /// The number of something: whole and not below 0; a blank is 0.
    Number,
}

impl Field {
    /// The field with this width in the standard format.
    pub(super) const fn wide(self, width: usize) -> Self {
        Self { width, ..self }
    }
}

const fn field(name: &'static str, role: Role) -> Field {
    Field { name, width: 10, role }
}

/// A field whose number is taken; 0 where it is blank.
pub(super) const fn real(name: &'static str) -> Field {
    field(name, Role::Taken(Taken::Real))
}

/// A field whose number is taken; `default` where it is blank or 0.
pub(super) const fn real_or(name: &'static str, default: f64) -> Field {
    field(name, Role::Taken(Taken::RealOr(default)))
}

/// A field whose whole number is taken; 0 where it is blank.
pub(super) const fn whole(name: &'static str) -> Field {
    field(name, Role::Taken(Taken::Whole))
}

/// A field that names something by its number; 0 where it is blank.
pub(super) const fn number(name: &'static str) -> Field {
    field(name, Role::Taken(Taken::Number))
}

/// Fields of eight columns that name things by their numbers.
pub(super) const fn numbers<const N: usize>(names: [&'static str; N]) -> [Field; N] {
    let mut fields = [number("").wide(8); N];
    let mut i = 0;
    while i < N {
        fields[i].name = names[i];
        i += 1;
    }
    fields
}

/// A field without a place in a case, which must be blank or 0.
pub(super) const fn zero(name: &'static str) -> Field {
    field(name, Role::Rests(&[]))
}

/// A field without a place in a case, which must be blank, 0 or one of `defaults`.
pub(super) const fn rests(name: &'static str, defaults: &'static [f64]) -> Field {
    field(name, Role::Rests(defaults))
}

/// A field without a place in a case, which must be blank or one of `words`, in capitals.
pub(super) const fn says(name: &'static str, words: &'static [&'static str]) -> Field {
    field(name, Role::Says(words))
}

/// A field that asks for output.
pub(super) const fn output(name: &'static str) -> Field {
    field(name, Role::Idle)
}

/// A field about what a disk and a bar of solids lack: shells, beams, rigid walls, rotations of nodes.
pub(super) const fn absent(name: &'static str) -> Field {
    field(name, Role::Idle)
}

/// A field that tunes LS-DYNA's search for contact, or an option of its card that is refused itself.
pub(super) const fn search(name: &'static str) -> Field {
    field(name, Role::Idle)
}

/// A field about other axes than the axle, about which the hub of a case does not turn.
pub(super) const fn other_axis(name: &'static str) -> Field {
    field(name, Role::Idle)
}

/// The fields of a data line, `N` of which are taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout<const N: usize>(pub(super) &'static [Field]);

impl<const N: usize> Layout<N> {
    /// The layout of these fields; a constant of another `N` than that of the fields that are taken does not compile.
    pub(super) const fn new(fields: &'static [Field]) -> Self {
        let (mut i, mut taken) = (0, 0);
        while i < fields.len() {
            if let Role::Taken(_) = fields[i].role {
                taken += 1;
            }
            i += 1;
        }
        assert!(taken == N, "the values of a layout are those of its fields that are taken");
        Self(fields)
    }
}
