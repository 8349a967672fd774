//! How still the block sits on the belt: slip in the first adhesion and after the first capture.

use crate::{Parameters, State};

/// Slip velocity after the belt has captured the block again, in which there should be none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ringing {
    /// Time of the capture: after a collapse the slip velocity is back at zero (s).
    pub capture: f64,
    /// Largest slip speed from one to two tenths of the sticking time after the capture (m/s).
    pub peak: f64,
    /// Root mean square of the slip velocity over that time (m/s).
    pub rms: f64,
    /// The same over the next tenth: equal for a ringing without damping (m/s).
    pub later_rms: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    steps: u64,
    peak: f64,
}

impl Mean {
    fn add(&mut self, slip: f64) {
        self.sum += slip * slip;
        self.steps += 1;
        self.peak = self.peak.max(slip.abs());
    }

    fn rms(&self) -> f64 {
        (self.sum / self.steps as f64).sqrt() // NaN without steps
    }
}

/// Where the run is; times of the capture in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// The first adhesion, up to half of static friction.
    Adhesion,
    /// Further on, up to the first collapse.
    Loading,
    Collapse,
    Captured(f64),
    /// Both windows after the capture have passed.
    Rung(f64),
    /// The next collapse came before.
    Broken,
}

/// Watches a run pass through adhesion, collapse and capture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StickWatch {
    phase: Phase,
    half: f64,
    tenth: f64,
    adhesion: Mean,
    windows: [Mean; 2],
}

impl StickWatch {
    pub(crate) fn new(p: &Parameters) -> Self {
        let at_rest = (p.v0 - p.belt).abs() <= p.adhesion;
        Self {
            phase: if at_rest { Phase::Adhesion } else { Phase::Loading },
            half: 0.5 * p.mu_static() * p.normal_force,
            tenth: 0.1 * p.reach() / p.belt.abs(),
            adhesion: Mean::default(),
            windows: [Mean::default(); 2],
        }
    }

    #[inline]
    pub(crate) fn see(&mut self, p: &Parameters, time: f64, state: &State) {
        // in a collapse the spring drives the block against the belt's direction
        let against = |v: f64| v * p.belt < 0.0;
        match self.phase {
            Phase::Adhesion if (p.spring * state.x).abs() < self.half => {
                self.adhesion.add(state.slip);
            }
            Phase::Adhesion => self.phase = Phase::Loading,
            Phase::Loading if against(state.v) => self.phase = Phase::Collapse,
            Phase::Collapse if !against(state.slip) => self.phase = Phase::Captured(time),
            Phase::Captured(_) if against(state.v) => self.phase = Phase::Broken,
            Phase::Captured(capture) => {
                let tenths = (time - capture) / self.tenth;
                if (1.0..2.0).contains(&tenths) {
                    self.windows[0].add(state.slip);
                } else if (2.0..3.0).contains(&tenths) {
                    self.windows[1].add(state.slip);
                } else if tenths >= 3.0 {
                    self.phase = Phase::Rung(capture);
                }
            }
            Phase::Loading | Phase::Collapse | Phase::Broken | Phase::Rung(_) => {}
        }
    }

    pub(crate) fn adhesion_slip(&self) -> f64 {
        self.adhesion.rms()
    }

    pub(crate) fn ringing(&self) -> Option<Ringing> {
        let Phase::Rung(capture) = self.phase else { return None };
        let [first, later] = &self.windows;
        Some(Ringing { capture, peak: first.peak, rms: first.rms(), later_rms: later.rms() })
    }
}
