//! What the colours of a scene can show.

use output::FieldSpec;
use output::layout::{BODIES, CONTACT, file};
use serde::Serialize;

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Drawable {
    /// Both bodies, of `fields.vtkhdf`.
    Bodies,
    /// Both contact surfaces, of `contact.vtkhdf`.
    Contact,
}

impl Drawable {
    /// The file of the run that holds it.
    pub fn file(self) -> &'static str {
        match self {
            Self::Bodies => file::FIELDS,
            Self::Contact => file::CONTACT,
        }
    }

    /// What its colours can show.
    pub fn quantities(self) -> impl Iterator<Item = Quantity> {
        Quantity::ALL.into_iter().filter(move |quantity| quantity.of() == self)
    }
}

/// What the colours of a scene show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Von Mises stress, at a node the mean of the elements around it.
    VonMises,
    /// Size of the velocity.
    Velocity,
    /// Size of the deformation.
    Deformation,
    /// Contact pressure.
    Pressure,
    /// Size of the shear traction.
    Shear,
    /// Size of the slip velocity, zero where there is no pressure.
    SlipVelocity,
}

impl Quantity {
    /// All, those of the bodies first; the first of each is the one that is shown unless another is chosen.
    pub const ALL: [Self; 6] = [
        Self::VonMises,
        Self::Velocity,
        Self::Deformation,
        Self::Pressure,
        Self::Shear,
        Self::SlipVelocity,
    ];

    /// Name in the data of a scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::VonMises => "von_mises",
            Self::Velocity => "velocity",
            Self::Deformation => "deformation",
            Self::Pressure => "pressure",
            Self::Shear => "shear",
            Self::SlipVelocity => "slip_velocity",
        }
    }

    /// What it is of.
    pub fn of(self) -> Drawable {
        match self {
            Self::VonMises | Self::Velocity | Self::Deformation => Drawable::Bodies,
            Self::Pressure | Self::Shear | Self::SlipVelocity => Drawable::Contact,
        }
    }

    /// Label of the colour bar with the unit, and the size of that unit (SI).
    pub(crate) fn label(self) -> (&'static str, f64) {
        match self {
            Self::VonMises => ("von Mises stress (MPa)", 1e6),
            Self::Velocity => ("speed (m/s)", 1.0),
            Self::Deformation => ("deformation (µm)", 1e-6),
            Self::Pressure => ("pressure (MPa)", 1e6),
            Self::Shear => ("shear traction (MPa)", 1e6),
            Self::SlipVelocity => ("slip velocity (m/s)", 1.0),
        }
    }

    /// The dataset from which it is made; `None` for the deformation, which may have to be found. Von Mises stress is
    /// also made of the tensor.
    pub(crate) fn dataset(self) -> Option<&'static FieldSpec> {
        match self {
            Self::VonMises => Some(&BODIES.von_mises),
            Self::Velocity => Some(&BODIES.velocity),
            Self::Deformation => None,
            Self::Pressure => Some(&CONTACT.pressure),
            Self::Shear => Some(&CONTACT.shear),
            Self::SlipVelocity => Some(&CONTACT.slip_velocity),
        }
    }
}
