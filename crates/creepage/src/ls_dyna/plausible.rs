//! Whether the numbers of a deck are those of a disk on a bar in the units that were given.
//!
//! Source of the ranges: Ashby (2011), "Materials Selection in Mechanical Design", chart of Young's modulus over density.

use crate::ls_dyna::cards::six;
use crate::ls_dyna::error::{DeckError, Fault};
use crate::ls_dyna::units::Units;

/// Numbers of a deck that have units, in those of the deck.
pub(crate) struct Numbers {
    /// Density and Young's modulus of disk and bar.
    pub(crate) materials: [[f64; 2]; 2],
    /// Radius of the disk.
    pub(crate) radius: f64,
    /// Rolling speed.
    pub(crate) speed: f64,
}

/// Densities of solids (kg/m^3), from wood and foams to osmium.
const DENSITY: [f64; 2] = [50.0, 25e3];
/// Young's moduli of solids (Pa), from gels to diamond.
const YOUNG: [f64; 2] = [1e3, 1.3e12];
/// Solids of a density above the first number (kg/m^3) are no softer than the second (Pa).
const DENSE: [f64; 2] = [2500.0, 5e9];
/// No wave in a solid is faster (m/s).
const FASTEST: f64 = 2e4;
/// Radii (m) and rolling speeds (m/s) that a case may have, and usual ones.
const RADIUS: [[f64; 2]; 2] = [[0.0, 10.0], [1e-3, 2.0]];
const SPEED: [[f64; 2]; 2] = [[0.0, 500.0], [1e-3, 300.0]];

impl Numbers {
    /// Refuses units in which the numbers make no disk on a bar, while they do in others.
    ///
    /// # Errors
    /// Such units, with those that fit.
    pub(crate) fn fit(&self, given: Units) -> Result<(), DeckError> {
        let Some(shown) = self.impossible(given) else { return Ok(()) };
        let fits = |units: &Units| {
            let within = |x: f64, range: [f64; 2]| (range[0]..=range[1]).contains(&x);
            self.impossible(*units).is_none()
                && within(self.radius * units.length(), RADIUS[1])
                && within(self.speed * units.velocity(), SPEED[1])
        };
        let fitting: Vec<_> = Units::all().filter(fits).map(|units| self.in_units(units)).collect();
        if fitting.is_empty() {
            return Ok(());
        }
        let fitting = fitting[..fitting.len().min(3)].join(", or ");
        let what = format!("{} is not that of the deck: {shown}", given.name());
        Err(DeckError::of(Fault::Unit { what, fitting }))
    }

    /// What no disk on a bar has in these units.
    fn impossible(&self, units: Units) -> Option<String> {
        let outside = |x: f64, [low, high]: [f64; 2]| x < low || x > high;
        for [density, young] in self.materials {
            let (density, young) = (density * units.density(), young * units.stress());
            let waves = (young / density).sqrt();
            if outside(density, DENSITY)
                || outside(young, YOUNG)
                || density > DENSE[0] && young < DENSE[1]
                || waves > FASTEST
            {
                return Some(format!(
                    "no solid has a density of {} kg/m^3 and a Young's modulus of {} Pa",
                    six(density),
                    six(young)
                ));
            }
        }
        let (radius, speed) = (self.radius * units.length(), self.speed * units.velocity());
        (outside(radius, RADIUS[0]) || outside(speed, SPEED[0])).then(|| {
            let (radius, speed) = (six(radius), six(speed));
            format!("the disk would have a radius of {radius} m and a speed of {speed} m/s")
        })
    }

    /// The units and what the numbers are in them.
    fn in_units(&self, units: Units) -> String {
        let [[density, young], _] = self.materials;
        format!(
            "{} (density {} kg/m^3, Young's modulus {} Pa, radius {} m, speed {} m/s)",
            units.name(),
            six(density * units.density()),
            six(young * units.stress()),
            six(self.radius * units.length()),
            six(self.speed * units.velocity())
        )
    }
}
