//! The window of time over which a run is judged and averaged, the same for all numbers of a document.

use crate::check::PostError;
use crate::check::basis::Basis;
use crate::check::frames::ContactHistory;
use crate::check::statistics::time_weights;
use std::ops::Range;

/// A part of a run that the user asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// From and to (s), both included.
    Between([f64; 2]),
    /// This number of contact transits, 2a/V each, up to the end of the run's evaluation window, or of its
    /// records where they end before it.
    Transits(f64),
}

impl Span {
    /// From and to (s).
    ///
    /// # Errors
    /// Half axis or speed not known; transits that begin before the first record.
    pub(crate) fn resolve(
        self,
        basis: &Basis,
        history: &ContactHistory,
    ) -> Result<[f64; 2], PostError> {
        let transits = match self {
            Self::Between(span) => return Ok(span),
            Self::Transits(transits) => transits,
        };
        let (a, speed) =
            basis.scale("half_length").zip(basis.scale("speed")).ok_or(PostError::Unknown {
                name: "the contact transit 2a/V",
                remedy: "give --scale half_length=M and --scale speed=M/S",
            })?;
        let [first, last] = [history.times[0], history.times[history.times.len() - 1]];
        let interval = match history.times[..] {
            [.., before, last] => last - before,
            _ => 0.0,
        };
        // the last record may lie up to an interval before the end of the window; a run may have ended before
        let whole = |to: f64| last + interval * (1.0 + SAME) >= to;
        let to = basis.window.map(|[_, to]| to).filter(|to| whole(*to)).unwrap_or(last);
        let from = to - transits * 2.0 * a / speed.abs();
        if from < first - SAME * last.abs() {
            return Err(PostError::Asked(format!(
                "{transits} contact transits before {to:e} s begin at {from:e} s, before the first record \
                 ({first:e} s)"
            )));
        }
        Ok([from, to])
    }
}

/// The window and the records of the contact history in it.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    /// From and to (s), both included; infinite where nothing bounds it.
    pub span: [f64; 2],
    /// Indices of the records.
    pub records: Range<usize>,
    /// Whether it is the window of the means in the run's summary.
    pub of_summary: bool,
}

/// Relative difference of two times that is round-off.
const SAME: f64 = 1e-9;

impl Window {
    /// The window that was asked for, else the run's evaluation window, else all records; all records too where
    /// the evaluation window has none, since the run ended before it or has not reached it yet.
    ///
    /// # Errors
    /// A window that was asked for and has no record.
    pub fn resolve(
        asked: Option<Span>,
        basis: &Basis,
        history: &ContactHistory,
    ) -> Result<Self, PostError> {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let own = basis.window.unwrap_or(all);
        let span = asked.map_or(Ok(own), |asked| asked.resolve(basis, history))?;
        match history.window(span) {
            Err(_) if asked.is_none() => {
                Ok(Self { span: all, records: 0..history.times.len(), of_summary: false })
            }
            found => {
                let same = |of_run: [f64; 2]| {
                    let slack = SAME * of_run[1].abs();
                    span.iter().zip(of_run).all(|(end, own)| (end - own).abs() <= slack)
                };
                let of_summary = basis.summary.is_some() && basis.window.is_some_and(same);
                Ok(Self { span, records: found?, of_summary })
            }
        }
    }

    /// From and to (s) as documents show them: an infinite end is replaced by that of the records.
    pub fn ends(&self, times: &[f64]) -> [f64; 2] {
        let ends = [times[self.records.start], times[self.records.end - 1]];
        [0, 1].map(|i| if self.span[i].is_finite() { self.span[i] } else { ends[i] })
    }

    /// The time (s) in the window that each of its records stands for.
    pub fn weights(&self, times: &[f64]) -> Vec<f64> {
        time_weights(times, self.span)[self.records.clone()].to_vec()
    }
}
