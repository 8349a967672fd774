//! Consistent units of a keyword file, and their sizes in SI units.

/// The units of length, mass and time, in metres, kilograms and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    length: f64,
    mass: f64,
    time: f64,
    /// Their names in that order.
    names: [&'static str; 3],
}

impl Units {
    /// Units named as `mm-ton-s`: length (`m`, `cm`, `mm`, `in`), mass (`kg`, `ton`, `g`) and time
    /// (`s`, `ms`, `us`). None for any other text.
    pub fn parse(text: &str) -> Option<Self> {
        let find = |name: &str, units: &[(&'static str, f64)]| {
            units.iter().find(|(unit, _)| *unit == name).copied()
        };
        let mut names = text.split('-');
        let length =
            find(names.next()?, &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("in", 0.0254)])?;
        let mass = find(names.next()?, &[("kg", 1.0), ("ton", 1e3), ("g", 1e-3)])?;
        let time = find(names.next()?, &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6)])?;
        let found = Self {
            length: length.1,
            mass: mass.1,
            time: time.1,
            names: [length.0, mass.0, time.0],
        };
        names.next().is_none().then_some(found)
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
