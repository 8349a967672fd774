//! Curves over time, and what of them a case can say: its values do not depend on time but for one ramp.

use crate::ls_dyna::cards::Card;
use crate::ls_dyna::cards::six;
use crate::ls_dyna::deck::Deck;
use crate::ls_dyna::error::{DeckError, DeckLine, lacks, syntax, unknown, unsupported};
use crate::ls_dyna::fields::{Layout, number, real, real_or, zero};

const HEAD: Layout<5> = Layout::new(&[
    number("LCID"),
    zero("SIDR"),
    real_or("SFA", 1.0),
    real_or("SFO", 1.0),
    real("OFFA"),
    real("OFFO"),
    zero("DATTYP"),
    zero("LCINT"),
]);

const POINT: Layout<2> = Layout::new(&[real("A1").wide(20), real("O1").wide(20)]);

/// The points of a curve, scaled and shifted as its card says, and the line of the card.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    id: u64,
    place: DeckLine,
    points: Vec<[f64; 2]>,
}

/// What a curve does from the time at which the disk begins to roll to `ENDTIM`.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    /// Its values in the order of time: that at the begin, those of its points and that at the end.
    values: Vec<f64>,
    /// Its value at the end.
    pub(crate) last: f64,
    /// Whether it is 0 until the disk rolls.
    pub(crate) rests_before: bool,
    /// How long it changes; all the time where it changes up to the end.
    pub(crate) changes: f64,
    /// Whether it changes up to the end and beyond.
    pub(crate) goes_on: bool,
}

/// Values that differ by less than this share are the same: a column of ten holds six digits.
const SAME: f64 = 1e-5;
/// A curve that jumps within this share of the time in which the disk rolls begins with the value after the jump.
const JUMP: f64 = 1e-3;

impl Course {
    /// Whether it keeps one value.
    pub(crate) fn is_constant(&self) -> bool {
        self.ramps_from(self.last)
    }

    /// Whether it goes from `start` to its last value without turning back.
    pub(crate) fn ramps_from(&self, start: f64) -> bool {
        let scale = SAME * start.abs().max(self.last.abs());
        let up = if self.last < start { -1.0 } else { 1.0 };
        let values = [start].into_iter().chain(self.values.iter().copied());
        let mut most = f64::NEG_INFINITY;
        values.map(|value| up * value).all(|value| {
            let rises = value >= most - scale && value <= up * self.last + scale;
            most = most.max(value);
            rises
        })
    }
}

impl Curve {
    /// Its value at a time within its points, by linear interpolation; at a jump that before it.
    fn at(&self, t: f64) -> f64 {
        let next = self.points.partition_point(|[at, _]| *at < t);
        let Some(&[t1, y1]) = self.points.get(next) else { return f64::NAN };
        let before = next.checked_sub(1).and_then(|i| self.points.get(i));
        match before {
            Some(&[t0, y0]) if t1 > t => y0 + (y1 - y0) * ((t - t0) / (t1 - t0)),
            _ => y1,
        }
    }

    /// The largest absolute value of its points up to a time.
    pub(super) fn largest_until(&self, t: f64) -> f64 {
        let until = self.points.iter().filter(|[at, _]| *at <= t);
        until.map(|[_, value]| value.abs()).fold(0.0, f64::max)
    }

    /// Whether it is 0 from time 0 to `t`.
    fn rests_until(&self, t: f64) -> bool {
        let mut before = self.points.iter().filter(|[at, _]| (0.0..t).contains(at));
        t <= 0.0 || self.at(t) == 0.0 && before.all(|[_, value]| *value == 0.0)
    }

    /// Its course from `begins` to `end`, times in the units of the deck.
    fn course(&self, begins: f64, end: f64) -> Course {
        let last = self.at(end);
        let start = begins + JUMP * (end - begins);
        let inner: Vec<_> =
            self.points.iter().copied().filter(|[t, _]| (start..end).contains(t)).collect();
        let mut course = vec![[start, self.at(start)]];
        course.extend(inner);
        course.push([end, last]);
        let changed = course.iter().rposition(|[_, value]| *value != last);
        let settles = changed.and_then(|i| course.get(i + 1)).map_or(begins, |[t, _]| *t);
        let after = self.points.iter().find(|[t, _]| *t > end).map_or(last, |[_, value]| *value);
        Course {
            values: course.iter().map(|[_, value]| *value).collect(),
            last,
            rests_before: self.rests_until((1.0 - JUMP) * begins),
            changes: settles - begins,
            goes_on: settles >= end && after != last,
        }
    }
}

impl Deck {
    /// Takes `*DEFINE_CURVE`; whether the card is one.
    pub(super) fn curve_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        if card.name != "DEFINE_CURVE" {
            return Ok(false);
        }
        let head = card.line(0)?;
        let [id, sfa, sfo, offa, offo] = head.take(&HEAD)?;
        self.first("curve", id as u64, &head.place())?;
        let mut points: Vec<[f64; 2]> = Vec::new();
        if offa > 0.0 {
            // LS-DYNA's curve over time is 0 before its offset
            points.extend([[0.0, 0.0], [0.999 * sfa * offa, 0.0]]);
        }
        for line in card.further_lines() {
            let [a, o] = line.take(&POINT)?;
            let point = [sfa * (a + offa), sfo * (o + offo)];
            if points.last().is_some_and(|[before, _]| *before > point[0]) {
                let what = format!(
                    "the time {} of a curve is before that of its last point",
                    six(point[0])
                );
                return Err(syntax(&line.place(), what));
            }
            points.push(point);
        }
        let (id, place) = (id as u64, head.place());
        self.curves.insert(id, Curve { id, place, points });
        Ok(true)
    }

    /// The time at which the deck ends, `ENDTIM`.
    pub(crate) fn end(&self) -> Result<f64, DeckError> {
        let end = self.endtim.filter(|t| *t > 0.0).ok_or_else(|| lacks("*CONTROL_TERMINATION"))?;
        if self.begins >= end {
            return Err(lacks("*CONTROL_TERMINATION after the start of the initial velocities"));
        }
        Ok(end)
    }

    /// How long the disk rolls, in units of the deck.
    pub(crate) fn rolls(&self) -> Result<f64, DeckError> {
        Ok(self.end()? - self.begins)
    }

    /// What a curve to which a line of the deck refers does while the disk rolls.
    ///
    /// # Errors
    /// No such curve; one whose points do not cover that time.
    pub(crate) fn course(&self, curve: u64, at: &DeckLine) -> Result<Course, DeckError> {
        let found = self.curves.get(&curve).filter(|curve| !curve.points.is_empty());
        let curve = found.ok_or_else(|| unknown(at, "the card", format!("curve {curve}")))?;
        let (begins, end) = (self.begins, self.end()?);
        let times = [curve.points.first(), curve.points.last()].map(|p| p.map_or(0.0, |p| p[0]));
        if times[0] > begins || times[1] < end {
            let what = format!(
                "curve {}, whose points do not reach from {} to ENDTIM = {},",
                curve.id,
                six(begins),
                six(end)
            );
            let remedy =
                "give it a first point at the start of rolling and a last one at ENDTIM or later";
            return Err(unsupported(&curve.place, what, remedy));
        }
        Ok(curve.course(begins, end))
    }
}
