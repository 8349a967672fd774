//! Cards in the standard format: columns of ten, with the names of the fields in a comment above.

use crate::ls_dyna::units::Units;
use std::fmt::Write as _;

/// The cards of a deck under way.
pub(super) struct Cards {
    text: String,
    units: Units,
}

impl Cards {
    pub(super) fn new(units: Units) -> Self {
        Self { text: String::new(), units }
    }

    pub(super) fn units(&self) -> Units {
        self.units
    }

    pub(super) fn text(self) -> String {
        self.text
    }

    pub(super) fn line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }

    pub(super) fn comment(&mut self, text: &str) {
        self.line(&format!("$ {text}"));
    }

    pub(super) fn keyword(&mut self, name: &str) {
        self.line(&format!("*{name}"));
    }

    /// A keyword with one line of data.
    pub(super) fn card(&mut self, name: &str, fields: &[(&str, f64)]) {
        self.keyword(name);
        self.fields(fields);
    }

    /// A line of data below the names of its fields.
    pub(super) fn fields(&mut self, fields: &[(&str, f64)]) {
        let mut names = String::new();
        for (i, (name, _)) in fields.iter().enumerate() {
            // the mark of a comment takes the first column
            let width = if i == 0 { 9 } else { 10 };
            // writing to a String cannot fail, here and below
            let _ = write!(names, "{name:>width$}");
        }
        self.line(&format!("${names}"));
        self.numbers(fields.iter().map(|(_, x)| *x));
    }

    /// A line of numbers in columns of ten.
    pub(super) fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for x in numbers {
            let _ = write!(self.text, "{:>10}", ten(x));
        }
        self.text.push('\n');
    }

    /// The points of a curve over time (s), with ordinates in units of the deck.
    pub(super) fn curve(&mut self, id: u64, points: &[[f64; 2]]) {
        self.card("DEFINE_CURVE", &[("LCID", id as f64)]);
        let unit = self.units.time();
        for [t, y] in points {
            let _ = writeln!(self.text, "{:>20}{:>20}", twenty(t / unit), twenty(*y));
        }
    }

    /// A set of nodes, eight a line, by their indices.
    pub(super) fn node_set(&mut self, id: u64, nodes: &[u32]) {
        self.card("SET_NODE_LIST", &[("SID", id as f64)]);
        for line in nodes.chunks(8) {
            self.numbers(line.iter().map(|n| label(*n) as f64));
        }
    }

    /// A set of segments.
    pub(super) fn segment_set(&mut self, id: u64, faces: impl Iterator<Item = [u32; 4]>) {
        self.card("SET_SEGMENT", &[("SID", id as f64)]);
        for face in faces {
            self.numbers(face.map(|n| label(n) as f64));
        }
    }

    /// A node with its position in units of the deck.
    pub(super) fn node(&mut self, index: u32, [x, y, z]: [f64; 3]) {
        let _ = writeln!(self.text, "{:>8}{x:>16.9e}{y:>16.9e}{z:>16.9e}", label(index));
    }

    /// A solid element with its part.
    pub(super) fn solid(&mut self, index: u32, part: u64, nodes: &[u32; 8]) {
        let _ = write!(self.text, "{:>8}{part:>8}", label(index));
        for n in nodes {
            let _ = write!(self.text, "{:>8}", label(*n));
        }
        self.text.push('\n');
    }
}

/// The number of a node or an element in the deck: its index from 1.
pub(super) fn label(index: u32) -> u64 {
    u64::from(index) + 1
}

/// A number for a column of ten: of nine characters, so that a blank parts it from the one before, where these hold six digits.
fn ten(x: f64) -> String {
    let separated = in_width(x, 9);
    let same = separated.parse().is_ok_and(|y: f64| (y - x).abs() <= 1e-6 * x.abs());
    if same { separated } else { in_width(x, 10) }
}

/// A number for a column of twenty.
fn twenty(x: f64) -> String {
    in_width(x, 19)
}

/// The nearest of the numbers that `width` characters hold; without a power of ten where that is as near.
fn in_width(x: f64, width: usize) -> String {
    let plain = (0..=17).map(|digits| format!("{x:.digits$}"));
    let powers = (0..=17).map(|digits| format!("{x:.digits$e}"));
    // 0.5 and .5 are the same to Fortran
    let short = |text: String| match text.strip_prefix("0.") {
        Some(rest) if text.len() > width => format!(".{rest}"),
        _ => text,
    };
    let off = |text: &String| text.parse().map_or(f64::INFINITY, |y: f64| (y - x).abs());
    let fitting = std::iter::once(format!("{x}")).chain(plain).chain(powers).map(short);
    let nearest =
        fitting.filter(|text| text.len() <= width).min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.unwrap_or_else(|| format!("{x:.0e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_fit_their_columns_with_all_digits_that_fit() {
        for (x, text) in [
            (0.0, "0"),
            (2.1e5, "210000"),
            (7.8e-9, "7.8e-9"),
            (0.002542812806, ".002542813"),
            (0.6693448, "0.6693448"),
            (-100_000.0 / 3.0, "-33333.33"),
            (1e-20, "1e-20"),
            (-1.234567e-7, "-1.2346e-7"),
            (123_456_789.0, "123456789"),
        ] {
            assert_eq!(ten(x), text);
        }
        assert_eq!(twenty(84.738_562_091_503_27).len(), 17);
    }
}
