//! How well the block sticks to the belt: slip in the first adhesion and after the first capture.

use crate::{Parameters, State};
use serde::Serialize;

/// Spurious slip after the belt has captured the block again: the exact solution sticks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ringing {
    /// Time of the capture (s), at which the slip velocity has returned to zero after a collapse.
    pub capture: f64,
    /// Largest slip speed in the window from one to two tenths of the sticking time after the capture (m/s). The
    /// sticking time is that in which the belt stretches the spring from zero to static friction.
    pub peak: f64,
    /// Root mean square of the slip velocity over that window (m/s).
    pub rms: f64,
    /// The same over the next tenth (m/s); equal to `rms` for undamped ringing.
    pub later_rms: f64,
}

/// Root mean square and peak of the slip velocity.
#[derive(Clone, Copy, Debug, Default)]
struct SlipStatistics {
    /// Sum of squares (m^2/s^2).
    sum: f64,
    steps: u64,
    peak: f64,
}

impl SlipStatistics {
    fn add(&mut self, slip: f64) {
        self.sum += slip * slip;
        self.steps += 1;
        self.peak = self.peak.max(slip.abs());
    }

    fn rms(&self) -> f64 {
        (self.sum / self.steps as f64).sqrt() // NaN without steps
    }
}

/// Phase of a run. The numbers are the time of the capture (s).
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// The first adhesion, up to half of static friction.
    Adhesion,
    /// From there to the first collapse.
    Loading,
    Collapse,
    Captured(f64),
    /// Both windows after the capture have passed.
    Complete(f64),
    /// The next collapse came before the windows had passed.
    Incomplete,
}

/// Watches a run pass through adhesion, collapse and capture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StickWatch {
    phase: Phase,
    /// Half of static friction (N).
    half: f64,
    /// A tenth of the sticking time (s).
    tenth: f64,
    adhesion: SlipStatistics,
    windows: [SlipStatistics; 2],
}

impl StickWatch {
    pub(crate) fn new(p: &Parameters) -> Self {
        let at_rest = (p.v0 - p.belt).abs() <= p.adhesion;
        Self {
            phase: if at_rest { Phase::Adhesion } else { Phase::Loading },
            half: 0.5 * p.mu_static() * p.normal_force,
            tenth: 0.1 * p.reach() / p.belt.abs(),
            adhesion: SlipStatistics::default(),
            windows: [SlipStatistics::default(); 2],
        }
    }

    #[inline]
    pub(crate) fn observe(&mut self, p: &Parameters, time: f64, state: &State) {
        // in a collapse the spring drives the block against the belt's direction
        let against = |v: f64| v * p.belt < 0.0;
        match self.phase {
            Phase::Adhesion if (p.spring * state.x).abs() < self.half => {
                self.adhesion.add(state.slip);
            }
            Phase::Adhesion => self.phase = Phase::Loading,
            Phase::Loading if against(state.v) => self.phase = Phase::Collapse,
            Phase::Collapse if !against(state.slip) => self.phase = Phase::Captured(time),
            Phase::Captured(_) if against(state.v) => self.phase = Phase::Incomplete,
            Phase::Captured(capture) => {
                let tenths = (time - capture) / self.tenth;
                if (1.0..2.0).contains(&tenths) {
                    self.windows[0].add(state.slip);
                } else if (2.0..3.0).contains(&tenths) {
                    self.windows[1].add(state.slip);
                } else if tenths >= 3.0 {
                    self.phase = Phase::Complete(capture);
                }
            }
            Phase::Loading | Phase::Collapse | Phase::Incomplete | Phase::Complete(_) => {}
        }
    }

    /// Root mean square of the slip velocity in the first adhesion (m/s); NaN if there was none.
    pub(crate) fn adhesion_slip(&self) -> f64 {
        self.adhesion.rms()
    }

    /// Slip after the first capture, if the run covers both windows.
    pub(crate) fn ringing(&self) -> Option<Ringing> {
        let Phase::Complete(capture) = self.phase else { return None };
        let [first, later] = &self.windows;
        Some(Ringing { capture, peak: first.peak, rms: first.rms(), later_rms: later.rms() })
    }
}
