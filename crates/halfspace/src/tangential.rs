//! The tangential problem of a step: tractions that obey friction at every point of the patch.

use crate::return_mapping::{Friction, TrialPoint, return_mapping};
use crate::rolling::{Along, Rigid, Rolling, Work};

/// Iterations of a step at most, and the change of the slip velocity, over the largest trial velocity of the step, at which they
/// end. In stick the trial velocity is what the traction holds back, some hundred times a slip velocity.
const MOST_ITERATIONS: usize = 2000;
const CONVERGED: f64 = 1e-9;
/// A compliance whose bounds differ by less than this factor is nearly local.
const LOCAL: f64 = 3.0;
/// Iterations after which a point that slips takes the solution in slip where there are several, as if it had slipped in the
/// step before: under friction that falls steeply, neighbours may else make one another stick and slip in turn. Such points
/// leave perfect delay, and are counted (`undelayed`).
const SETTLED: usize = 30;
/// Sets of coefficients of friction that are tried in a step at most, and the change of their tractions, over the largest one,
/// at which they are those of the law.
const MOST_COEFFICIENTS: usize = 1000;
const SAME_COEFFICIENTS: f64 = 1e-9;
/// Steps of Newton's method to a given force at most, and the share of the force at which it ends.
const NEWTON_STEPS: usize = 6;
const BALANCED: f64 = 1e-13;

impl Rolling {
    /// Displacements by the tractions `work.from` at this instant, into `work.now`.
    pub(crate) fn displace(&mut self) {
        let Work { spectra: [taus, found], from, now, .. } = &mut self.work;
        for c in 0..2 {
            self.plane.forward(&from[c], &mut taus[c]);
        }
        self.history.now(taus, found);
        for c in 0..2 {
            self.plane.inverse(&mut found[c], &mut now[c]);
        }
    }

    /// Whether the bounds of the compliance of a step are near each other, as with inertia.
    fn is_nearly_local(&self) -> bool {
        let [least, most] = self.kernel.bounds;
        most < LOCAL * least
    }

    /// The slip velocity over the traction of a point (m/s per Pa) in the iteration. Where the compliance of a step is nearly
    /// local, its mean takes each point to its own solution; else the method of gradients needs its upper bound, and momentum.
    pub(crate) fn local_compliance(&self) -> f64 {
        let [least, most] = self.kernel.bounds;
        let [rate, ..] = self.difference();
        if self.is_nearly_local() { 0.5 * rate * (least + most) } else { rate * most }
    }

    /// Finds tractions that obey friction at every point. Returns the rigid slip backward (m/s), the number of iterations and
    /// the last change if it did not converge.
    pub(crate) fn solve(&mut self, rigid: Rigid) -> (f64, usize, f64) {
        self.work.coefficients.clear();
        let found = self.iterate(rigid);
        let (_, iterations, change) = found;
        if change > 0.0 && change.is_finite() && self.setup.law.is_implicit() {
            self.iterate_coefficients(rigid, iterations).unwrap_or(found)
        } else {
            found
        }
    }

    /// Solves with given coefficients of friction, first those of the law at the slip velocities of the step before, then those
    /// at the slip velocities just found, until they stay. Returns what [`solve`](Self::solve) does, with `iterations` added, or
    /// none for a law without friction at rest.
    ///
    /// At a given creepage given coefficients have one solution, which depends on them continuously. Those of a continuous law
    /// are bounded: by Brouwer's theorem there are coefficients that this maps to themselves, so that tractions that obey the
    /// law exist. Each problem is solved from the tractions of the step before: from those of the problem before, an error
    /// within the tolerance would be another one each time, and the map not one.
    fn iterate_coefficients(
        &mut self,
        rigid: Rigid,
        mut iterations: usize,
    ) -> Option<(f64, usize, f64)> {
        for &(i, at) in &self.points {
            let point = self.point(i, at);
            if point.law_coefficient([0.0; 2]) <= 0.0 {
                return None;
            }
            let before = [0, 1].map(|c| self.fields.slip_velocity[c][i]);
            let mu = point.law_coefficient(before);
            self.work.coefficients.push(mu);
        }
        let mut last = None;
        for _ in 0..MOST_COEFFICIENTS {
            let (backward, more, unsolved) = self.iterate(rigid);
            iterations += more;
            if unsolved > 0.0 {
                return Some((backward, iterations, unsolved));
            }
            let (mut change, mut largest): (f64, f64) = (0.0, 0.0);
            for (k, &(i, at)) in self.points.iter().enumerate() {
                let mu = self.point(i, at).law_coefficient(self.work.found[k].slip_velocity);
                // `max` would hide it
                if !mu.is_finite() {
                    return Some((backward, iterations, f64::INFINITY));
                }
                let pressure = self.fields.pressure[i];
                change = change.max(pressure * (mu - self.work.coefficients[k]).abs());
                largest = largest.max(pressure * mu);
                self.work.coefficients[k] = mu;
                self.work.found[k].mu = mu;
            }
            change /= largest;
            if change <= SAME_COEFFICIENTS {
                return Some((backward, iterations, 0.0));
            }
            last = Some((backward, iterations, change));
        }
        last
    }

    /// Finds tractions by the proximal gradient method, with Nesterov's momentum where the compliance couples far points (Beck
    /// and Teboulle 2009): with a given coefficient the tractions minimise a convex function. Returns what [`solve`](Self::solve)
    /// does.
    fn iterate(&mut self, rigid: Rigid) -> (f64, usize, f64) {
        let [rate, ..] = self.difference();
        let compliance = self.local_compliance();
        let [least, most] = self.kernel.bounds;
        let root = (least / most).sqrt();
        let momentum = if self.is_nearly_local() { 0.0 } else { (1.0 - root) / (1.0 + root) };
        let mut backward = match rigid.along {
            Along::Creepage(creepage) => creepage * self.setup.speed,
            Along::Force(_) => self.backward,
        };
        for c in 0..2 {
            self.work.before[c].copy_from_slice(&self.fields.shear[c]);
            self.work.from[c].copy_from_slice(&self.fields.shear[c]);
        }
        self.work.found.clear();
        self.work.found.resize(self.points.len(), Friction::default());
        let mut change = 0.0;
        for iteration in 1..=MOST_ITERATIONS {
            self.displace();
            if let Along::Force(force) = rigid.along {
                backward = self.backward_at(force, backward, rate, compliance);
            }
            let (mut largest, mut finite): (f64, bool) = (0.0, true);
            change = 0.0;
            for (k, &(i, at)) in self.points.iter().enumerate() {
                let free = self.trial(k, i, backward, rate, compliance);
                let mut point = self.trial_point(k, i, at);
                point.slipped |= iteration > SETTLED && self.work.found[k].slips;
                let found = return_mapping(&point, free, compliance);
                let work = &mut self.work;
                for c in 0..2 {
                    let step = found.shear[c] - work.before[c][i];
                    change = f64::max(change, compliance * step.abs());
                    largest = largest.max(free[c].abs());
                    finite &= step.is_finite();
                    work.from[c][i] = found.shear[c] + momentum * step;
                    work.before[c][i] = found.shear[c];
                }
                work.found[k] = found;
            }
            if !finite {
                return (backward, iteration, f64::INFINITY);
            }
            if change <= CONVERGED * largest {
                return (backward, iteration, 0.0);
            }
            change /= largest;
        }
        (backward, MOST_ITERATIONS, change)
    }

    /// Point `k` of the patch, with its coefficient where that stands for the law's.
    fn trial_point(&self, k: usize, i: usize, at: [f64; 2]) -> TrialPoint<'_> {
        TrialPoint { coefficient: self.work.coefficients.get(k).copied(), ..self.point(i, at) }
    }

    /// Velocity of point `k` of the patch without its own traction, which `compliance` then adds (m/s).
    fn trial(&self, k: usize, i: usize, backward: f64, rate: f64, compliance: f64) -> [f64; 2] {
        let work = &self.work;
        let rigid = [-backward, 0.0];
        [0, 1].map(|c| {
            work.free[k][c] + rigid[c] + rate * work.now[c][i] - compliance * work.from[c][i]
        })
    }

    /// The rigid slip backward (m/s) at which the tractions of this iteration add up to the force along x. Newton's method
    /// starts at `guess`, the rigid slip of the iteration before. Where all points slip it may fail; a bracket does not.
    fn backward_at(&self, force: f64, guess: f64, rate: f64, compliance: f64) -> f64 {
        let tolerance = BALANCED * force.abs();
        let mut backward = guess;
        for _ in 0..NEWTON_STEPS {
            let (found, slope) = self.force_along(backward, rate, compliance);
            let excess = found - force;
            if excess.abs() <= tolerance {
                return backward;
            }
            if !(excess.is_finite() && slope > 0.0) {
                break;
            }
            backward -= excess / slope;
        }
        let mean = force.abs() / self.cell() / self.points.len().max(1) as f64;
        let excess = |backward: f64| self.force_along(backward, rate, compliance).0 - force;
        rising_root(excess, guess, 1e-3 * compliance * mean + 1e-12, tolerance)
    }

    /// The force along x of the tractions of this iteration (N, or N/m in line contact), and its slope over the rigid slip at
    /// a constant coefficient of friction.
    fn force_along(&self, backward: f64, rate: f64, compliance: f64) -> (f64, f64) {
        let (mut sum, mut slope) = (0.0, 0.0);
        for (k, &(i, at)) in self.points.iter().enumerate() {
            let free = self.trial(k, i, backward, rate, compliance);
            let point = self.trial_point(k, i, at);
            let found = return_mapping(&point, free, compliance);
            sum += found.shear[0];
            slope += if found.slips {
                // the traction of the bound turns with the trial velocity
                let [along, across] = free.map(|v| v * v);
                let squared = along + across;
                found.mu * point.at.pressure * across / (squared * squared.sqrt())
            } else {
                1.0 / compliance
            };
        }
        (sum * self.cell(), slope * self.cell())
    }
}

/// The root of a function that rises, near `guess`: by regula falsi with the Illinois rule (Dowell and Jarratt 1971) in a
/// bracket that begins with `width` to each side, until the size of the function is at most `tolerance`.
fn rising_root(function: impl Fn(f64) -> f64, guess: f64, mut width: f64, tolerance: f64) -> f64 {
    let (mut low, mut high) = (guess - width, guess + width);
    let (mut at_low, mut at_high) = (function(low), function(high));
    for _ in 0..60 {
        if at_low <= 0.0 && at_high >= 0.0 {
            break;
        }
        width *= 2.0;
        if at_low > 0.0 {
            (high, at_high) = (low, at_low);
            low -= width;
            at_low = function(low);
        } else {
            (low, at_low) = (high, at_high);
            high += width;
            at_high = function(high);
        }
    }
    let mut side = 0;
    for _ in 0..60 {
        if at_high.is_nan() || at_low.is_nan() || at_high <= at_low {
            break;
        }
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let at = function(middle);
        if at.abs() <= tolerance || high - low <= 1e-15 * (low.abs() + high.abs()) {
            return middle;
        }
        if at < 0.0 {
            (low, at_low) = (middle, at);
            if side == -1 {
                at_high *= 0.5;
            }
            side = -1;
        } else {
            (high, at_high) = (middle, at);
            if side == 1 {
                at_low *= 0.5;
            }
            side = 1;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_far_from_the_guess_is_found_where_the_function_bends() {
        let root = rising_root(|x| x * x * x - 27.0, -40.0, 1e-3, 1e-12);
        assert!((root - 3.0).abs() < 1e-12, "{root}");
    }
}
