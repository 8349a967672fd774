//! Friction between two bodies that are pressed together: the Cattaneo shift, and rolling in steps
//! of one pitch of the grid of contact points.

use crate::reference::friction::{Coulomb, FrictionError, Rigid, SlipBound, Solution};
use crate::reference::slip_law::{Particles, Patch, SlipLaw};
use crate::reference::{Influence, Pressed};
use faer::Mat;
use thiserror::Error;

/// Coordinates of the grid that differ by less than this fraction of its pitch are the same.
const SAME: f64 = 0.05;

/// No point upstream: the leading edge of the grid.
const NONE: usize = usize::MAX;

/// Why rolling cannot be computed.
#[derive(Debug, Error, PartialEq)]
pub enum RollingError {
    /// The points do not form a grid that is uniform along x.
    #[error("rolling needs points at one pitch along x; at x = {x} m, y = {y} m there is none")]
    Grid {
        /// Coordinate x of the point without a neighbour (m).
        x: f64,
        /// Its coordinate y (m).
        y: f64,
    },
    /// The contact reaches the leading or trailing border of the potential contact area; its lateral borders are not
    /// checked.
    #[error(
        "contact reaches the border of the potential contact area at x = {x} m, y = {y} m; \
         enlarge it"
    )]
    Border {
        /// Coordinate x of the point at the border (m).
        x: f64,
        /// Its coordinate y (m).
        y: f64,
    },
    /// The coefficient of friction is not a finite number above zero.
    #[error("a coefficient of friction of {mu} cannot be used")]
    Friction {
        /// The coefficient.
        mu: f64,
    },
    /// The speed of rolling of a law that depends on the slip velocity is not a finite number above zero.
    #[error("a speed of rolling of {speed} m/s cannot be used")]
    Speed {
        /// The speed (m/s).
        speed: f64,
    },
    /// The tangential problem of a step failed.
    #[error(transparent)]
    Step(#[from] FrictionError),
    /// Rolling did not become steady.
    #[error("rolling is not steady after {steps} steps: forces still change by {change:e}")]
    Unsteady {
        /// Steps made.
        steps: usize,
        /// Largest change of a force in the last step, over the largest bound.
        change: f64,
    },
}

/// Rolling is steady when no force changes by more than this fraction of the
/// largest bound over a step.
pub(crate) const STEADY: f64 = 1e-8;

/// State of a contact point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adhesion {
    /// No slip.
    Stick,
    /// The bound is reached.
    Slip,
}

/// Two bodies in contact with friction, in the frame that moves with the contact. Vectors of two numbers are
/// along the tangents t1 and t2 of [`Influence`], x and y where the normal is z.
///
/// The slave rolls towards +x: particles enter the contact at its leading edge, at +x, and leave
/// at -x. Over a step of one pitch h the particle at a point comes from the point upstream, the neighbour at +x. With w
/// the tangential displacement of the slave relative to the master, the slip of point i is (Kalker 1990)
///
/// s_i = w_i(t) - w_up(i)(t - dt) - xi h.
///
/// Creepage xi is the rigid velocity of the master relative to the slave over the speed of rolling: a slave
/// driven faster than it rolls, xi_x = (omega R - V)/V > 0, receives a force along +x. Spin is
/// zero. A displacement common to all points cancels in the steady state, so that the compliance of the
/// bodies far from the contact does not change the creepage of steady rolling.
///
/// Normal forces are given: the tangential ones do not change them.
///
/// The coefficient of friction is constant, or that of a [`SlipLaw`]. Then the state of the law moves with the
/// particles, and each step solves for forces, slip and coefficients at once.
pub struct Rolling<'a> {
    influence: &'a Influence,
    contact: Vec<usize>,
    /// Normal force of the contact points (N), and their friction bound at the end of the last step (N).
    normal: Vec<f64>,
    bound: Vec<f64>,
    /// What the particles remember; `None` with a constant coefficient.
    particles: Option<Particles>,
    /// Tangential compliance among the contact points (m/N).
    matrix: Mat<f64>,
    /// The point upstream of each point; [`NONE`] at the leading edge of the grid.
    upstream: Vec<usize>,
    pitch: f64,
    /// Tangential displacement of all points due to the normal forces (m), by point, then t1, t2.
    pressed: Vec<f64>,
    /// Force (N) and slip (m) of the contact points, by point, then t1, t2.
    force: Vec<f64>,
    slip: Vec<f64>,
    moved: [f64; 2],
    /// Tangential displacement of all points at the end of the last step (m).
    displacement: Vec<f64>,
}

impl<'a> Rolling<'a> {
    /// Bodies pressed together, without tangential force, with the coefficient of friction `mu`. `pressed` is a result
    /// of [`crate::reference::press`] with the same `influence`.
    ///
    /// # Errors
    /// [`RollingError::Grid`], [`RollingError::Border`], [`RollingError::Friction`].
    pub fn new(influence: &'a Influence, pressed: &Pressed, mu: f64) -> Result<Self, RollingError> {
        let rough = mu > 0.0 && mu.is_finite();
        if !rough {
            return Err(RollingError::Friction { mu });
        }
        let mut rolling = Self::frictionless(influence, pressed)?;
        rolling.bound = rolling.normal.iter().map(|n| mu * n).collect();
        Ok(rolling)
    }

    /// The same with a friction law. All contact points are at the beginning of contact.
    ///
    /// The coefficient is that of the slip velocity of the same step also where a law, such as
    /// [`friction::Lagged`], asks for that of the step before.
    ///
    /// # Errors
    /// [`RollingError::Grid`], [`RollingError::Border`], [`RollingError::Friction`], [`RollingError::Speed`].
    pub fn with_law(
        influence: &'a Influence,
        pressed: &Pressed,
        law: SlipLaw,
    ) -> Result<Self, RollingError> {
        let speed = law.speed;
        let moves = speed > 0.0 && speed.is_finite();
        if !moves {
            return Err(RollingError::Speed { speed });
        }
        let mut rolling = Self::frictionless(influence, pressed)?;
        let particles = Particles::new(law, rolling.pitch, &rolling.patch());
        rolling.bound = particles.at_rest(&rolling.patch());
        let mut bounds = rolling.bound.iter().zip(&rolling.normal);
        if let Some((g, n)) = bounds.find(|(g, _)| !(**g > 0.0 && g.is_finite())) {
            return Err(RollingError::Friction { mu: g / n });
        }
        rolling.particles = Some(particles);
        Ok(rolling)
    }

    /// Bodies pressed together whose friction bounds are zero.
    fn frictionless(influence: &'a Influence, pressed: &Pressed) -> Result<Self, RollingError> {
        let (upstream, pitch) = upstream(influence)?;
        let contact = pressed.contact.clone();
        let mut has_downstream = vec![false; upstream.len()];
        upstream.iter().filter(|&&u| u != NONE).for_each(|&u| has_downstream[u] = true);
        if let Some(&i) = contact.iter().find(|&&i| upstream[i] == NONE || !has_downstream[i]) {
            let [x, y, _] = influence.points[i].at.into();
            return Err(RollingError::Border { x, y });
        }
        let m = contact.len();
        let place = |k: usize| 2 * contact[k / 2] + k % 2;
        let matrix = Mat::from_fn(2 * m, 2 * m, |i, j| influence.shear[(place(i), place(j))]);
        let n = influence.points.len();
        let mut normal = vec![0.0; 2 * n];
        if let Some(coupling) = &influence.coupling {
            for &j in &contact {
                for (k, u) in normal.iter_mut().enumerate() {
                    *u += coupling[(k, j)] * pressed.force[j];
                }
            }
        }
        Ok(Self {
            influence,
            bound: vec![0.0; m],
            normal: contact.iter().map(|&i| pressed.force[i]).collect(),
            particles: None,
            contact,
            matrix,
            upstream,
            pitch,
            displacement: normal.clone(),
            pressed: normal,
            force: vec![0.0; 2 * m],
            slip: vec![0.0; 2 * m],
            moved: [0.0; 2],
        })
    }

    /// Moves the bodies along the tangents t1 and t2 without rolling; as the first step, the problem of Cattaneo and
    /// Mindlin. With a [`SlipLaw`] the shift is so slow that coefficients are those of rest and states stay.
    ///
    /// # Errors
    /// [`RollingError::Step`].
    pub fn shift(&mut self, rigid: [Rigid; 2]) -> Result<(), RollingError> {
        let at_rest = self.particles.as_ref().map(|particles| particles.at_rest(&self.patch()));
        let bound = at_rest.as_ref().unwrap_or(&self.bound);
        let solution = self.solve(rigid, |i| i, bound, None)?;
        self.take(solution);
        Ok(())
    }

    /// Rolls by one pitch. `rigid` is along t1 and t2; a given motion is the creepage times the pitch.
    ///
    /// # Errors
    /// [`RollingError::Step`].
    pub fn roll(&mut self, rigid: [Rigid; 2]) -> Result<(), RollingError> {
        let step = self.particles.as_ref().map(|particles| particles.step(&self.patch()));
        let law = step.as_ref().map(|step| step as &dyn SlipBound);
        let at_rest = law.map(|law| law.bounds(&vec![0.0; self.contact.len()]));
        let bound = at_rest.as_ref().unwrap_or(&self.bound);
        let solution = self.solve(rigid, |i| self.upstream[i], bound, law)?;
        if let (Some(particles), Some(step)) = (&mut self.particles, &step) {
            particles.take(step, &self.contact, &solution.slip);
        }
        self.take(solution);
        Ok(())
    }

    /// Goes on from the end of the step of `last`, the same bodies with the contact at another place on the same points. The
    /// particle at a point was there before, or, where the grid `moves_on`, at the point upstream.
    ///
    /// # Errors
    /// [`RollingError::Step`].
    pub(crate) fn go_on(
        &mut self,
        last: &Self,
        moves_on: bool,
        rigid: [Rigid; 2],
    ) -> Result<(), RollingError> {
        self.displacement.copy_from_slice(&last.displacement);
        let before = |i: usize| if moves_on { self.upstream[i] } else { i };
        let solution = self.solve(rigid, before, &self.bound, None)?;
        self.take(solution);
        Ok(())
    }

    /// The contact points, for a law.
    fn patch(&self) -> Patch<'_> {
        Patch {
            points: &self.influence.points,
            contact: &self.contact,
            normal: &self.normal,
            upstream: &self.upstream,
        }
    }

    /// Rolls until the forces no longer change, at most `steps` pitches, and returns the number of pitches.
    ///
    /// A first guess solves for the state that one pitch of rolling reproduces,
    /// s_i = w_i - w_up(i) - xi h with both displacements of the same state, first with constant bounds, then with those
    /// of a law: one system each instead of hundreds of steps. If Newton's method does not find it, rolling starts from the
    /// current state. In either case steps of rolling decide whether the state is steady.
    /// With a [`SlipLaw`] a mesh may have several steady states, and a steady state may be unstable: rolling
    /// from rest then ends in another one, or in a cycle.
    ///
    /// # Errors
    /// [`RollingError::Step`], [`RollingError::Unsteady`].
    pub fn steady(&mut self, rigid: [Rigid; 2], steps: usize) -> Result<usize, RollingError> {
        self.guess(rigid);
        let largest = self.bound.iter().fold(0.0f64, |m, g| m.max(*g));
        let mut change = f64::INFINITY;
        for step in 1..=steps {
            let before = self.force.clone();
            self.roll(rigid)?;
            let changes = before.iter().zip(&self.force).map(|(a, b)| (a - b).abs());
            change = changes.fold(0.0, f64::max) / largest;
            if change <= STEADY {
                return Ok(step);
            }
        }
        Err(RollingError::Unsteady { steps, change })
    }

    /// Takes the state that a pitch of rolling reproduces, if Newton's method finds it: with constant bounds, and with
    /// those of a law from there on.
    pub(crate) fn guess(&mut self, rigid: [Rigid; 2]) {
        let Some(guess) = self.reproduced(rigid, None) else { return };
        self.take(guess);
        let Some(particles) = &self.particles else { return };
        let step = particles.steady(&self.patch());
        let Some(guess) = self.reproduced(rigid, Some(&step)) else { return };
        if let Some(particles) = &mut self.particles {
            particles.take(&step, &self.contact, &guess.slip);
        }
        self.take(guess);
    }

    /// The state that a pitch of rolling reproduces, if Newton's method finds it from the state now.
    fn reproduced(&self, rigid: [Rigid; 2], slip: Option<&dyn SlipBound>) -> Option<Solution> {
        let size = 2 * self.contact.len();
        let here = |k: usize| 2 * self.contact[k / 2] + k % 2;
        let ahead = |k: usize| 2 * self.upstream[self.contact[k / 2]] + k % 2;
        let shear = &self.influence.shear;
        let matrix =
            Mat::from_fn(size, size, |i, j| shear[(here(i), here(j))] - shear[(ahead(i), here(j))]);
        let offset: Vec<f64> =
            (0..size).map(|k| self.pressed[here(k)] - self.pressed[ahead(k)]).collect();
        let friction = Coulomb { compliance: matrix.as_ref(), bound: &self.bound, slip };
        friction.solve_directly(&offset, rigid, &self.force).ok()
    }

    /// One step; `before` gives the point at which the particle of a contact point was before it, `bound` and
    /// `slip` are as in [`Coulomb`].
    fn solve(
        &self,
        rigid: [Rigid; 2],
        before: impl Fn(usize) -> usize,
        bound: &[f64],
        slip: Option<&dyn SlipBound>,
    ) -> Result<Solution, RollingError> {
        let m = self.contact.len();
        let mut offset = vec![0.0; 2 * m];
        for (k, &i) in self.contact.iter().enumerate() {
            let from = before(i);
            for a in 0..2 {
                offset[2 * k + a] = self.pressed[2 * i + a] - self.displacement[2 * from + a];
            }
        }
        let friction = Coulomb { compliance: self.matrix.as_ref(), bound, slip };
        Ok(friction.solve(&offset, rigid, &self.force)?)
    }

    /// Sets forces, slip, bounds and rigid motion, and computes the displacements of all points from them.
    fn take(&mut self, solution: Solution) {
        self.force = solution.force;
        self.slip = solution.slip;
        self.bound = solution.bound;
        self.moved = solution.moved;
        self.displacement.copy_from_slice(&self.pressed);
        for (k, &force) in self.force.iter().enumerate() {
            let column = self.influence.shear.col(2 * self.contact[k / 2] + k % 2);
            for (u, w) in self.displacement.iter_mut().zip(column.iter()) {
                *u += w * force;
            }
        }
    }

    /// The pitch of the grid along x (m).
    pub fn pitch(&self) -> f64 {
        self.pitch
    }

    /// The contact points (indices into [`Influence::points`]); lists by contact point are in this order.
    pub fn contact(&self) -> &[usize] {
        &self.contact
    }

    /// Tangential force on the slave at each contact point (N), along t1 and t2.
    pub fn force(&self) -> Vec<[f64; 2]> {
        self.force.chunks_exact(2).map(|p| [p[0], p[1]]).collect()
    }

    /// Friction bound of each contact point in the last step, mu times its normal force (N).
    pub fn bound(&self) -> &[f64] {
        &self.bound
    }

    /// Slip of the slave relative to the master at each contact point over the last step (m), along t1 and t2. Divided
    /// by the pitch and multiplied by the speed of rolling it is the slip velocity (m/s).
    pub fn slip(&self) -> Vec<[f64; 2]> {
        self.slip.chunks_exact(2).map(|s| [s[0], s[1]]).collect()
    }

    /// State of each contact point in the last step: slip where the force is the bound, within 1e-9 of it.
    pub fn adhesion(&self) -> Vec<Adhesion> {
        let bounds = self.bound.iter().zip(self.force.chunks_exact(2));
        bounds
            .map(|(g, p)| {
                let slips = libm::hypot(p[0], p[1]) >= g * (1.0 - 1e-9);
                if slips { Adhesion::Slip } else { Adhesion::Stick }
            })
            .collect()
    }

    /// Sum of the tangential forces on the slave (N), along t1 and t2.
    pub fn total(&self) -> [f64; 2] {
        let sum = |a: usize| self.force.iter().skip(a).step_by(2).sum();
        [sum(0), sum(1)]
    }

    /// Rigid motion of the master relative to the slave over the last step (m), along t1 and t2.
    pub fn moved(&self) -> [f64; 2] {
        self.moved
    }

    /// Creepage of the last step (dimensionless): the rigid motion over the pitch, along t1 and t2.
    pub fn creepage(&self) -> [f64; 2] {
        self.moved.map(|b| b / self.pitch)
    }
}

/// The point upstream (at +x) of each point, and the pitch.
fn upstream(influence: &Influence) -> Result<(Vec<usize>, f64), RollingError> {
    let points = &influence.points;
    let mut order: Vec<usize> = (0..points.len()).collect();
    let at = |i: usize| points[i].at;
    // The pitch is the least distance between two columns of points.
    let mut xs: Vec<f64> = points.iter().map(|p| p.at[0]).collect();
    xs.sort_by(f64::total_cmp);
    let span = xs[xs.len() - 1] - xs[0];
    let none = RollingError::Grid { x: xs[0], y: points[0].at[1] };
    let pitch =
        xs.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 1e-6 * span).fold(span, f64::min);
    if pitch.is_nan() || pitch <= 0.0 {
        return Err(none);
    }
    let cell = |v: f64| (v / (SAME * pitch)).round();
    order.sort_by(|&a, &b| {
        cell(at(a)[1]).total_cmp(&cell(at(b)[1])).then(at(a)[0].total_cmp(&at(b)[0]))
    });
    let mut next = vec![NONE; points.len()];
    for pair in order.windows(2) {
        let [[x, y, _], [x_up, y_up, _]] = [pair[0], pair[1]].map(|i| at(i).into());
        if (y_up - y).abs() <= 2.0 * SAME * pitch {
            if (x_up - x - pitch).abs() > SAME * pitch {
                return Err(RollingError::Grid { x, y });
            }
            next[pair[0]] = pair[1];
        }
    }
    Ok((next, pitch))
}
