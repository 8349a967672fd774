//! Consistent units of a keyword file, and their sizes in SI units.

use std::str::FromStr;

/// The units of length, mass and time, in metres, kilograms and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    length: f64,
    mass: f64,
    time: f64,
    /// Their names in that order.
    names: [&'static str; 3],
}

impl Default for Units {
    /// Millimetres, tons and seconds, which give newtons and megapascals.
    fn default() -> Self {
        Self { length: 1e-3, mass: 1e3, time: 1.0, names: ["mm", "ton", "s"] }
    }
}

impl FromStr for Units {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Self::parse(text).ok_or(
            "a length (m, cm, mm, in), a mass (kg, ton, g) and a time (s, ms, us) are needed, as mm-ton-s",
        )
    }
}

const LENGTHS: [(&str, f64); 4] = [("mm", 1e-3), ("m", 1.0), ("cm", 1e-2), ("in", 0.0254)];
const MASSES: [(&str, f64); 3] = [("ton", 1e3), ("kg", 1.0), ("g", 1e-3)];
const TIMES: [(&str, f64); 3] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6)];

impl Units {
    /// Units named as `mm-ton-s`: length (`m`, `cm`, `mm`, `in`), mass (`kg`, `ton`, `g`) and time
    /// (`s`, `ms`, `us`). None for any other text.
    pub fn parse(text: &str) -> Option<Self> {
        Self::all().find(|units| units.name() == text)
    }

    /// All of them, the usual ones of each kind first.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let of_length = |(length_name, length)| {
            MASSES.into_iter().flat_map(move |(mass_name, mass)| {
                TIMES.into_iter().map(move |(time_name, time)| Self {
                    length,
                    mass,
                    time,
                    names: [length_name, mass_name, time_name],
                })
            })
        };
        LENGTHS.into_iter().flat_map(of_length)
    }

    /// Their names, those of length, mass and time.
    pub(super) fn names(self) -> [&'static str; 3] {
        self.names
    }

    /// Their names, as [`Units::parse`] reads them.
    pub fn name(&self) -> String {
        self.names.join("-")
    }

    /// The unit of length (m).
    pub(super) fn length(self) -> f64 {
        self.length
    }

    /// The unit of mass (kg).
    pub(super) fn mass(self) -> f64 {
        self.mass
    }

    /// The unit of time (s).
    pub(super) fn time(self) -> f64 {
        self.time
    }

    /// The unit of velocity (m/s).
    pub(super) fn velocity(self) -> f64 {
        self.length / self.time
    }

    /// The unit of force (N).
    pub(super) fn force(self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }

    /// The unit of stress (Pa).
    pub(super) fn stress(self) -> f64 {
        self.mass / (self.length * self.time * self.time)
    }

    /// The unit of density (kg/m^3).
    pub(super) fn density(self) -> f64 {
        self.mass / (self.length * self.length * self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn millimetres_tons_and_seconds_give_newtons_and_megapascals() {
        let units = Units::parse("mm-ton-s").unwrap();
        let near = |x: f64, y: f64| (x - y).abs() < 1e-12 * y;
        assert!(near(units.force(), 1.0) && near(units.stress(), 1e6));
        assert!(near(7.8e-9 * units.density(), 7800.0));
        assert!(near(Units::parse("cm-g-us").unwrap().stress(), 1e11), "megabar");
        for wrong in ["", "mm", "mm-ton", "mm-ton-s-K", "ft-lb-s"] {
            assert_eq!(Units::parse(wrong), None, "{wrong}");
        }
    }
}
