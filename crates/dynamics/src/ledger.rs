//! The energy ledger.
//!
//! Central difference conserves T^n = 1/2 v^{n-1/2} . M v^{n+1/2} against trapezoidal work:
//! T^{n+1} - T^n = 1/2 (x^{n+1} - x^n) . (f^n + f^{n+1}). Works are therefore accumulated in two
//! halves around each full step, with the velocity before and after it.

use serde::{Deserialize, Serialize};

/// Energies at a full step (J), with signs as in the balance
/// kinetic + internal + hourglass + contact_stored + friction + damping = external + moved + initial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Kinetic energy in the conserved form.
    pub kinetic: f64,
    /// Strain energy of the elements.
    pub internal: f64,
    /// Hourglass energy of the elements.
    pub hourglass: f64,
    /// Energy in the contact springs, normal and tangential.
    pub contact_stored: f64,
    /// Dissipated by friction so far.
    pub friction_dissipated: f64,
    /// Dissipated by bulk viscosity, Kelvin–Voigt, mass damping, contact dampers and quiet ends.
    pub damping_dissipated: f64,
    /// The part of it that contact took: dampers of the penalty springs; with exact enforcement the
    /// impacts of nodes that close, and what the trapezoidal work of friction exceeds its heat by.
    pub contact_damping: f64,
    /// Work of the hub's drive and load, of the given forces and of the quiet ends' constant
    /// reactions.
    pub external_work: f64,
}

impl Energies {
    /// Everything stored and dissipated (J).
    pub fn total(&self) -> f64 {
        self.kinetic
            + self.internal
            + self.hourglass
            + self.contact_stored
            + self.friction_dissipated
            + self.damping_dissipated
    }
}

/// Works (J) of half a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Works {
    pub(crate) friction: f64,
    /// Of every kind, that of contact among them.
    pub(crate) damping: f64,
    pub(crate) contact_damping: f64,
    pub(crate) external: f64,
}

/// Accumulated works and the balance against the first reading.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Ledger {
    /// Dissipated by friction (J).
    pub friction: f64,
    /// Dissipated by damping of every kind (J).
    pub damping: f64,
    /// The part of it that contact took (J).
    pub contact_damping: f64,
    /// External work (J).
    pub external: f64,
    /// Brought by moves of the mesh with the material that enters, less what leaves with the other and what
    /// interpolation takes (J).
    pub moved: f64,
    /// What the next reading has beyond the external work (J), but for the move of the mesh before it.
    #[serde(skip)]
    expected: Option<f64>,
    initial: Option<Energies>,
    largest_exchange: f64,
    worst_balance: f64,
}

impl Ledger {
    /// Adds the works of half a step.
    pub(crate) fn add(&mut self, works: &Works) {
        self.friction += works.friction;
        self.damping += works.damping;
        self.contact_damping += works.contact_damping;
        self.external += works.external;
    }

    /// The mesh has moved: what the next reading has beyond the external work and `balance` (J) is booked as moved.
    pub(crate) fn expect(&mut self, balance: f64) {
        self.expected = Some(balance);
    }

    /// Takes a reading into the balance; the first one is the initial state.
    pub fn read(&mut self, now: &Energies) {
        if let Some(expected) = self.expected.take() {
            self.moved += now.total() - now.external_work - expected;
        }
        let Some(initial) = self.initial else {
            self.initial = Some(*now);
            self.largest_exchange = now.internal + now.contact_stored;
            return;
        };
        // Net amounts only: the gross works of axle force and torque, which nearly cancel, would
        // flatter the balance.
        let exchange = [
            (now.kinetic - initial.kinetic).abs(),
            now.internal,
            now.friction_dissipated,
            now.damping_dissipated,
            now.external_work.abs(),
        ];
        self.largest_exchange = exchange.into_iter().fold(self.largest_exchange, f64::max);
        self.worst_balance = self.worst_balance.max(self.imbalance(now).abs());
    }

    /// total - external work - moved - initial total (J).
    pub fn imbalance(&self, now: &Energies) -> f64 {
        let initial = self.initial.unwrap_or(*now);
        now.total() - now.external_work - self.moved - (initial.total() - initial.external_work)
    }

    /// Largest imbalance read so far over the largest energy exchanged (dimensionless).
    pub fn balance_error(&self) -> f64 {
        if self.largest_exchange > 0.0 { self.worst_balance / self.largest_exchange } else { 0.0 }
    }

    /// Largest net energy exchanged so far (J).
    pub fn largest_exchange(&self) -> f64 {
        self.largest_exchange
    }

    /// The first reading, if any.
    pub fn initial(&self) -> Option<&Energies> {
        self.initial.as_ref()
    }
}
