//! Coulomb friction on a contact area with given normal forces, for bodies condensed to their surface.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef};
use thiserror::Error;

/// Coulomb's law holds to this fraction of the largest bound.
const TOLERANCE: f64 = 1e-11;

/// Newton steps of a round.
const NEWTON: usize = 25;

/// Sweeps of block Gauss–Seidel after the first round of Newton steps that did not converge; k times as many after
/// the k-th.
const SWEEPS: usize = 40;

/// Rounds at most.
const ROUNDS: usize = 40;

/// Relative rigid motion of the bodies along one tangent (t1 or t2 of [`crate::reference::Influence`]) over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rigid {
    /// A given motion of the master relative to the slave (m).
    Moved(f64),
    /// The motion that gives this sum of the tangential forces on the slave (N).
    Forced(f64),
}

/// Why the tangential problem has no solution, or was not solved.
#[derive(Debug, Error, PartialEq)]
pub enum FrictionError {
    /// The required force is not below the sum of the friction bounds.
    #[error("a tangential force of {force} N exceeds what friction carries, {most} N")]
    Slides {
        /// The required force (N).
        force: f64,
        /// Sum of the bounds (N).
        most: f64,
    },
    /// The iteration did not converge.
    #[error(
        "friction did not converge: Coulomb's law is violated by {violation:e} of the largest \
         bound at point {point}"
    )]
    Stalled {
        /// Largest violation of Coulomb's law over the largest bound.
        violation: f64,
        /// Index among the points in contact.
        point: usize,
    },
}

/// Tangential forces that satisfy Coulomb's law.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Force on each contact point (N), by point, then t1, t2.
    pub force: Vec<f64>,
    /// Slip of the slave relative to the master over the step (m), in the same order.
    pub slip: Vec<f64>,
    /// Rigid motion of the master relative to the slave (m).
    pub moved: [f64; 2],
    /// Friction bound of each contact point (N).
    pub bound: Vec<f64>,
}

/// Friction bounds that depend on the slip of the contact points.
pub(crate) trait SlipBound {
    /// Bound of each point (N) after these slips (m).
    fn bounds(&self, slip: &[f64]) -> Vec<f64>;

    /// By point, the points on whose slip its bound depends, with the derivative (N/m) with respect to it. Newton's method
    /// alone uses them: their error changes the number of iterations, not the solution.
    fn slopes(&self, slip: &[f64]) -> Vec<Vec<(usize, f64)>>;
}

/// The tangential problem of the points in contact: their compliance and friction bounds.
pub(crate) struct Coulomb<'a> {
    /// Tangential displacement per force among the contact points (m/N), by point, then t1, t2.
    pub compliance: MatRef<'a, f64>,
    /// mu times the normal force of each point (N), positive; at rest where it depends on the slip of the step.
    pub bound: &'a [f64],
    /// The bounds as they depend on the slip of the step; `None` where they do not.
    pub slip: Option<&'a dyn SlipBound>,
}

impl Coulomb<'_> {
    /// Forces p with slip s = offset + W p - b at every point, b the rigid motion, and Coulomb's law
    /// |p| <= g, p = -g s/|s| where s is not zero. `offset` (m) and the first guess `start` (N) are by point, then t1,
    /// t2.
    ///
    /// The law in one equation is p = P(p - r s) with P the projection on the disk of radius g
    /// (Alart and Curnier 1991). For given normal forces and a symmetric W the solution minimises a
    /// convex function and is unique. Semismooth Newton finds it in a few steps;
    /// where it does not converge, sweeps of block Gauss–Seidel, which always descend, give a better start.
    ///
    /// A bound g(|s|) that depends on the slip is part of the same equation. Newton's method takes its derivative
    /// along; a sweep takes the bounds at the slip before it. Where g falls too steeply there may be several
    /// solutions or none; the one found is near `start`.
    pub fn solve(
        &self,
        offset: &[f64],
        rigid: [Rigid; 2],
        start: &[f64],
    ) -> Result<Solution, FrictionError> {
        self.alternate(offset, rigid, start, ROUNDS)
    }

    /// The same by Newton's method alone, for a W that is not symmetric. There is no function to minimise then, and a
    /// failure does not mean that there is no solution.
    pub fn solve_directly(
        &self,
        offset: &[f64],
        rigid: [Rigid; 2],
        start: &[f64],
    ) -> Result<Solution, FrictionError> {
        self.alternate(offset, rigid, start, 1)
    }

    fn alternate(
        &self,
        offset: &[f64],
        rigid: [Rigid; 2],
        start: &[f64],
        rounds: usize,
    ) -> Result<Solution, FrictionError> {
        let m = self.bound.len();
        let most: f64 = self.bound.iter().sum();
        let required = rigid.map(|r| if let Rigid::Forced(f) = r { f } else { 0.0 });
        let force = libm::hypot(required[0], required[1]);
        let constant = self.slip.is_none();
        if force.is_nan() || (constant && force >= most) {
            return Err(FrictionError::Slides { force, most });
        }
        let mut state = State {
            force: start.to_vec(),
            moved: rigid.map(|r| if let Rigid::Moved(b) = r { b } else { 0.0 }),
            slip: vec![0.0; 2 * m],
            bound: self.bound.to_vec(),
        };
        let mut worst = (f64::INFINITY, 0);
        for round in 1..=rounds {
            for _ in 0..NEWTON {
                self.update_slip(&mut state, offset);
                worst = self.violation(&state, rigid, most);
                if worst.0 <= TOLERANCE {
                    let State { force, slip, moved, bound } = state;
                    return Ok(Solution { force, slip, moved, bound });
                }
                self.newton(&mut state, rigid);
            }
            if round < rounds {
                for _ in 0..SWEEPS * round {
                    self.sweep(&mut state, offset);
                }
            }
        }
        let most = state.bound.iter().sum();
        if force >= most {
            return Err(FrictionError::Slides { force, most });
        }
        Err(FrictionError::Stalled { violation: worst.0, point: worst.1 })
    }

    fn update_slip(&self, state: &mut State, offset: &[f64]) {
        for (k, slip) in state.slip.iter_mut().enumerate() {
            *slip = offset[k] - state.moved[k % 2];
        }
        for (column, &force) in state.force.iter().enumerate() {
            if force != 0.0 {
                let column = self.compliance.col(column);
                for (slip, w) in state.slip.iter_mut().zip(column.iter()) {
                    *slip += w * force;
                }
            }
        }
        if let Some(law) = self.slip {
            state.bound = law.bounds(&sizes(&state.slip));
        }
    }

    /// The weight r of the slip in p - r s (N/m): the inverse of the point's own mean compliance.
    fn weight(&self, i: usize) -> f64 {
        let w = self.compliance;
        2.0 / (w[(2 * i, 2 * i)] + w[(2 * i + 1, 2 * i + 1)])
    }

    /// p - r s of a point.
    fn trial(&self, state: &State, i: usize) -> [f64; 2] {
        let r = self.weight(i);
        [2 * i, 2 * i + 1].map(|k| state.force[k] - r * state.slip[k])
    }

    /// Largest |p - P(p - r s)| over the largest bound, and its point. The error of a required force, over the sum
    /// `most` of the bounds, counts too, at point 0.
    fn violation(&self, state: &State, rigid: [Rigid; 2], most: f64) -> (f64, usize) {
        let largest = self.bound.iter().fold(0.0f64, |m, g| m.max(*g));
        let mut worst = (0.0, 0);
        for (axis, rigid) in rigid.iter().enumerate() {
            if let Rigid::Forced(force) = rigid {
                let sum: f64 = state.force.iter().skip(axis).step_by(2).sum();
                worst.0 = f64::max(worst.0, (sum - force).abs() / most);
            }
        }
        for (i, &g) in state.bound.iter().enumerate() {
            let p = project(self.trial(state, i), g);
            let off =
                libm::hypot(p[0] - state.force[2 * i], p[1] - state.force[2 * i + 1]) / largest;
            if off > worst.0 || off.is_nan() {
                worst = (off, i);
            }
        }
        worst
    }

    /// One step of Newton's method on p = P(p - r s): stick rows demand s = 0, slip rows
    /// dp - M (dp - r ds) - (q/|q|) dg = P - p with M = (g/|q|)(I - q q/|q|^2), q = p - r s, dg = g' s/|s| ds.
    fn newton(&self, state: &mut State, rigid: [Rigid; 2]) {
        let m = self.bound.len();
        let free: Vec<usize> = (0..2).filter(|&a| matches!(rigid[a], Rigid::Forced(_))).collect();
        let size = 2 * m + free.len();
        let mut matrix = Mat::<f64>::zeros(size, size);
        let mut right = Mat::<f64>::zeros(size, 1);
        let w = self.compliance;
        // Per point, the 2x2 coefficients of dp (`own`) and of ds (`slip`) in its two rows.
        let mut own = vec![[[0.0; 2]; 2]; m];
        let mut slip = vec![[[0.0; 2]; 2]; m];
        for (i, &g) in state.bound.iter().enumerate() {
            let r = self.weight(i);
            let q = self.trial(state, i);
            let length = libm::hypot(q[0], q[1]);
            if length <= g {
                slip[i] = [[1.0, 0.0], [0.0, 1.0]];
                for a in 0..2 {
                    right[(2 * i + a, 0)] = -state.slip[2 * i + a];
                }
            } else {
                let e = [q[0] / length, q[1] / length];
                let p = [g * e[0], g * e[1]];
                for a in 0..2 {
                    for b in 0..2 {
                        let unit = if a == b { 1.0 } else { 0.0 };
                        let turn = g / length * (unit - e[a] * e[b]);
                        // Scaled by 1/r so that all rows are displacements.
                        own[i][a][b] = (unit - turn) / r;
                        slip[i][a][b] = turn;
                    }
                    right[(2 * i + a, 0)] = (p[a] - state.force[2 * i + a]) / r;
                }
            }
        }
        for column in 0..2 * m {
            for i in 0..m {
                let (x, y) = (w[(2 * i, column)], w[(2 * i + 1, column)]);
                for a in 0..2 {
                    let mut entry = slip[i][a][0] * x + slip[i][a][1] * y;
                    if column / 2 == i {
                        entry += own[i][a][column % 2];
                    }
                    matrix[(2 * i + a, column)] = entry;
                }
            }
        }
        self.add_slopes(state, &free, &mut matrix);
        for (k, &axis) in free.iter().enumerate() {
            for i in 0..m {
                for a in 0..2 {
                    matrix[(2 * i + a, 2 * m + k)] -= slip[i][a][axis];
                }
                matrix[(2 * m + k, 2 * i + axis)] = 1.0;
            }
            if let Rigid::Forced(force) = rigid[axis] {
                let sum: f64 = state.force.iter().skip(axis).step_by(2).sum();
                right[(2 * m + k, 0)] = force - sum;
            }
        }
        let step = matrix.partial_piv_lu().solve(&right);
        for k in 0..2 * m {
            state.force[k] += step[(k, 0)];
        }
        for (k, &axis) in free.iter().enumerate() {
            state.moved[axis] += step[(2 * m + k, 0)];
        }
    }

    /// Adds the term -(q/|q|) dg of the slip rows, scaled as they are; columns past the forces are the rigid motions
    /// along `free`.
    fn add_slopes(&self, state: &State, free: &[usize], matrix: &mut Mat<f64>) {
        let Some(law) = self.slip else { return };
        let (m, w) = (state.bound.len(), self.compliance);
        let slipped = sizes(&state.slip);
        for (i, slopes) in law.slopes(&slipped).into_iter().enumerate() {
            let q = self.trial(state, i);
            let length = libm::hypot(q[0], q[1]);
            if length <= state.bound[i] {
                continue;
            }
            let scale = 1.0 / (self.weight(i) * length);
            for (j, slope) in slopes.into_iter().filter(|(j, _)| slipped[*j] > 0.0) {
                let d = [0, 1].map(|b| scale * slope * state.slip[2 * j + b] / slipped[j]);
                for column in 0..2 * m {
                    let change = d[0] * w[(2 * j, column)] + d[1] * w[(2 * j + 1, column)];
                    for a in 0..2 {
                        matrix[(2 * i + a, column)] -= q[a] * change;
                    }
                }
                for (k, &axis) in free.iter().enumerate() {
                    for a in 0..2 {
                        matrix[(2 * i + a, 2 * m + k)] += q[a] * d[axis];
                    }
                }
            }
        }
    }

    /// One sweep of block Gauss–Seidel: each point in turn satisfies Coulomb's law exactly.
    fn sweep(&self, state: &mut State, offset: &[f64]) {
        let m = self.bound.len();
        for i in 0..m {
            let p = [state.force[2 * i], state.force[2 * i + 1]];
            let p = project(p, state.bound[i]);
            [state.force[2 * i], state.force[2 * i + 1]] = p;
        }
        self.update_slip(state, offset);
        for i in 0..m {
            let w = [0, 1].map(|a| [0, 1].map(|b| self.compliance[(2 * i + a, 2 * i + b)]));
            let old = [state.force[2 * i], state.force[2 * i + 1]];
            let without =
                [0, 1].map(|a| state.slip[2 * i + a] - w[a][0] * old[0] - w[a][1] * old[1]);
            let new = point_force(w, without, state.bound[i]);
            for a in 0..2 {
                let change = new[a] - old[a];
                if change != 0.0 {
                    let column = self.compliance.col(2 * i + a);
                    for (slip, w) in state.slip.iter_mut().zip(column.iter()) {
                        *slip += w * change;
                    }
                }
                state.force[2 * i + a] = new[a];
            }
        }
    }
}

/// An iterate, as in [`Solution`].
struct State {
    force: Vec<f64>,
    slip: Vec<f64>,
    moved: [f64; 2],
    bound: Vec<f64>,
}

/// |s| of each point.
fn sizes(slip: &[f64]) -> Vec<f64> {
    slip.chunks_exact(2).map(|s| libm::hypot(s[0], s[1])).collect()
}

/// Projection on the disk of radius `g`.
fn project(q: [f64; 2], g: f64) -> [f64; 2] {
    let length = libm::hypot(q[0], q[1]);
    if length <= g { q } else { [q[0] * g / length, q[1] * g / length] }
}

/// The force of one point with slip s = w p + s_0 under Coulomb's law: w p + s_0 = 0 if that needs
/// no more than `g`, else (w + l I) p = -s_0 with l >= 0 such that |p| = g.
fn point_force(w: [[f64; 2]; 2], s0: [f64; 2], g: f64) -> [f64; 2] {
    let at = |l: f64| {
        let (a, d) = (w[0][0] + l, w[1][1] + l);
        let det = a * d - w[0][1] * w[1][0];
        [(-d * s0[0] + w[0][1] * s0[1]) / det, (w[1][0] * s0[0] - a * s0[1]) / det]
    };
    let stick = at(0.0);
    if libm::hypot(stick[0], stick[1]) <= g {
        return stick;
    }
    // |p| falls with l; above |s_0|/g it is below g.
    let (mut low, mut high) = (0.0, libm::hypot(s0[0], s0[1]) / g);
    for _ in 0..60 {
        let l = 0.5 * (low + high);
        let p = at(l);
        if libm::hypot(p[0], p[1]) > g { low = l } else { high = l }
    }
    project(at(0.5 * (low + high)), g)
}
