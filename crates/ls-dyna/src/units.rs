//! Consistent units of a keyword file.

/// Length, mass and time in metres, kilograms and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

impl Units {
    /// Units named as `mm-ton-s`: length (`m`, `cm`, `mm`, `in`), mass (`kg`, `ton`, `g`) and time
    /// (`s`, `ms`, `us`).
    pub fn parse(text: &str) -> Option<Self> {
        let find = |name: &str, units: &[(&str, f64)]| {
            units.iter().find(|(unit, _)| *unit == name).map(|(_, size)| *size)
        };
        let mut names = text.split('-');
        let length =
            find(names.next()?, &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("in", 0.0254)])?;
        let mass = find(names.next()?, &[("kg", 1.0), ("ton", 1e3), ("g", 1e-3)])?;
        let time = find(names.next()?, &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6)])?;
        names.next().is_none().then_some(Self { length, mass, time })
    }

    /// A length in metres.
    pub(super) fn length(self) -> f64 {
        self.length
    }

    /// A time in seconds.
    pub(super) fn time(self) -> f64 {
        self.time
    }

    /// A velocity in m/s.
    pub(super) fn velocity(self) -> f64 {
        self.length / self.time
    }

    /// A force in N.
    pub(super) fn force(self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }

    /// A stress in Pa.
    pub(super) fn stress(self) -> f64 {
        self.mass / (self.length * self.time * self.time)
    }

    /// A density in kg/m^3.
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
