//! The nodal update of central difference: velocity, position, and the force cleared for the next step, in one pass.

use crate::dashpots::{Dashpots, RigidMotion};
use crate::hub::Resultant;
use crate::nodal_state::{Chunk, NodalState, TraceNode};
use crate::partition::CHUNK;
use crate::step_sums::{NodeSums, StepSums};
use mesh::Padded;
use nalgebra::Vector3;
use rayon::prelude::*;
use solid::Level;

/// What an update is told.
#[derive(Clone, Copy)]
pub(crate) struct Update<'a> {
    /// Time step (s).
    pub(crate) dt: f64,
    /// Whether to sum up the kinetic energy.
    pub(crate) kinetic: bool,
    /// The dashpots of mass-proportional damping, if there are any.
    pub(crate) dashpots: Option<&'a Dashpots>,
    /// Reference positions of all nodes (m).
    pub(crate) reference: &'a [Padded],
    /// That of the element kernels.
    pub(crate) level: Level,
}

impl NodalState {
    /// v^{n+1/2} = v^{n-1/2} + dt (f/m - alpha (v^{n-1/2} - v_rigid)) and
    /// u^{n+1} = u^n + dt v^{n+1/2}; clears the forces.
    ///
    /// Nodes of zero inverse mass keep their velocity. Of the `chunks` alone, where some are left out.
    pub(crate) fn advance(&mut self, update: &Update<'_>, chunks: Option<&[bool]>) {
        let taken = |chunk: &Chunk<'_>| chunks.is_none_or(|taken| taken[chunk.first / CHUNK]);
        self.chunks().filter(taken).for_each(|chunk| advance_chunk(chunk, update));
    }

    /// Takes what the last update summed up.
    pub(crate) fn take_sums(&self, update: &Update<'_>, sums: &mut StepSums) {
        if update.kinetic {
            sums.kinetic = self.sum(|c| c.kinetic);
        }
        if update.dashpots.is_some() {
            sums.dashpot_power = self.sum(|c| c.dashpot_power);
            let reaction = |c: &NodeSums, i: usize| {
                if i < 3 { c.reaction.force[i] } else { c.reaction.moment[i - 3] }
            };
            sums.reaction = std::array::from_fn(|i| self.sum(|c| reaction(c, i)));
        }
    }
}

/// A chunk with instructions of a level: the same bits with all, since nothing is fused.
fn advance_chunk(chunk: Chunk<'_>, update: &Update<'_>) {
    if matches!(update.level, Level::Avx512 | Level::Avx2) && update.level.available() {
        // SAFETY: the machine has the instructions.
        #[cfg(target_arch = "x86_64")]
        return unsafe { update_chunk_wide(chunk, update) };
    }
    update_chunk(chunk, update);
}

/// # Safety
/// The machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn update_chunk_wide(chunk: Chunk<'_>, update: &Update<'_>) {
    update_chunk(chunk, update);
}

#[inline(always)]
fn update_chunk(chunk: Chunk<'_>, update: &Update<'_>) {
    let Chunk { u, v, f, inverse_mass, first, sums } = chunk;
    let nodes = Nodes { u, v, f, inverse_mass };
    *sums = match (update.kinetic, update.dashpots) {
        (false, None) => undamped::<false>(nodes, update.dt),
        (true, None) => undamped::<true>(nodes, update.dt),
        (false, Some(dashpots)) => damped::<false>(nodes, first, dashpots, update),
        (true, Some(dashpots)) => damped::<true>(nodes, first, dashpots, update),
    };
}

/// v^{n+1/2} of a node under `force`, as [`NodalState::advance`] gives it up to round-off.
pub(crate) fn free_velocity(
    node: &TraceNode,
    force: Vector3<f64>,
    dt: f64,
    dashpots: Option<&Dashpots>,
) -> Vector3<f64> {
    let &TraceNode { number, reference, velocity: v, inverse_mass } = node;
    let mut after = v + dt * inverse_mass * force;
    if let Some(d) = dashpots.filter(|_| inverse_mass > 0.0) {
        let motion = if d.upper.contains(&number) { d.motion } else { None }.unwrap_or_default();
        let (rigid, _) = motion.at(reference);
        after -= dt * d.alpha * (v - Padded(rigid).vector());
    }
    after
}

/// Some nodes of a chunk.
struct Nodes<'a> {
    u: &'a mut [Padded],
    v: &'a mut [Padded],
    f: &'a mut [Padded],
    inverse_mass: &'a [f64],
}

#[inline(always)]
fn undamped<const KINETIC: bool>(nodes: Nodes<'_>, dt: f64) -> NodeSums {
    let Nodes { u, v, f, inverse_mass } = nodes;
    let mut twice_kinetic = 0.0;
    for (((u, v), f), &w) in u.iter_mut().zip(v).zip(f).zip(inverse_mass) {
        let before = *v;
        let scale = dt * w;
        for i in 0..4 {
            v.0[i] += scale * f.0[i];
            u.0[i] += dt * v.0[i];
            f.0[i] = 0.0;
        }
        if KINETIC && w > 0.0 {
            twice_kinetic += product(before, *v) / w;
        }
    }
    NodeSums { kinetic: 0.5 * twice_kinetic, ..NodeSums::default() }
}

/// The same with dashpots; `first` is the number of the first node. The upper body's nodes are contiguous,
/// so that a chunk falls into at most three runs of one body.
#[inline(always)]
fn damped<const KINETIC: bool>(
    nodes: Nodes<'_>,
    first: usize,
    dashpots: &Dashpots,
    update: &Update<'_>,
) -> NodeSums {
    let Nodes { u, v, f, inverse_mass } = nodes;
    let mut sums = NodeSums::default();
    let end = first + inverse_mass.len();
    let [upper_start, upper_end] =
        [dashpots.upper.start, dashpots.upper.end].map(|n| n.clamp(first, end));
    let runs =
        [(first..upper_start, false), (upper_start..upper_end, true), (upper_end..end, false)];
    for (run, on_upper) in runs {
        let local = run.start - first..run.end - first;
        let motion = if on_upper { dashpots.motion } else { None }.unwrap_or_default();
        let nodes = Nodes {
            u: &mut u[local.clone()],
            v: &mut v[local.clone()],
            f: &mut f[local.clone()],
            inverse_mass: &inverse_mass[local],
        };
        let reference = &update.reference[run];
        let (dt, alpha) = (update.dt, dashpots.alpha);
        let run = if motion.is_sideways() {
            damped_run::<KINETIC, true>(nodes, reference, dt, alpha, &motion)
        } else {
            damped_run::<KINETIC, false>(nodes, reference, dt, alpha, &motion)
        };
        sums.add(&run);
    }
    sums
}

/// Nodes of one body; a body at rest has the default motion, and its ground takes the reaction.
///
/// All sums run over the four entries of the padded vectors side by side, which the compiler turns
/// into vector instructions; the padding of every operand is zero.
#[inline(always)]
fn damped_run<const KINETIC: bool, const SIDEWAYS: bool>(
    nodes: Nodes<'_>,
    reference: &[Padded],
    dt: f64,
    alpha: f64,
    motion: &RigidMotion,
) -> NodeSums {
    let Nodes { u, v, f, inverse_mass } = nodes;
    let [mut power, mut kinetic, mut resultant] = [[0.0; 4]; 3];
    // dashpots times the arms in x, y and z
    let [mut by_x, mut by_y, mut by_z] = [[0.0; 4]; 3];
    for ((((u, v), f), &w), x) in u.iter_mut().zip(v).zip(f).zip(inverse_mass).zip(reference) {
        // nodes that are held or carried move as they are told: no force, no dashpot
        let (mass, rate) = if w > 0.0 { (1.0 / w, alpha) } else { (0.0, 0.0) };
        let (rigid, [ax, ay, az]) =
            if SIDEWAYS { motion.at_sideways(*x) } else { motion.at_straight(*x) };
        let (c, scale, decay) = (rate * mass, dt * w, dt * rate);
        for i in 0..4 {
            let before = v.0[i];
            let relative = before - rigid[i];
            let dashpot = c * relative;
            power[i] += dashpot * relative;
            resultant[i] += dashpot;
            by_z[i] += az * dashpot;
            by_x[i] += ax * dashpot;
            if SIDEWAYS {
                by_y[i] += ay * dashpot;
            }
            let after = before + (scale * f.0[i] - decay * relative);
            if KINETIC {
                kinetic[i] += mass * before * after;
            }
            v.0[i] = after;
            u.0[i] += dt * after;
            f.0[i] = 0.0;
        }
    }
    let about_y = by_z[0] - by_x[2];
    let reaction = if SIDEWAYS {
        let [fx, fy, fz, _] = resultant;
        let moment = Vector3::new(by_y[2] - by_z[1], about_y, by_x[1] - by_y[0]);
        Resultant { force: Vector3::new(fx, fy, fz), moment }
    } else {
        let force = Vector3::new(resultant[0], 0.0, resultant[2]);
        Resultant { force, moment: Vector3::new(0.0, about_y, 0.0) }
    };
    NodeSums {
        kinetic: 0.5 * kinetic.iter().sum::<f64>(),
        dashpot_power: power.iter().sum(),
        reaction: if motion.is_at_rest() { Resultant::default() } else { reaction },
    }
}

#[inline(always)]
fn product(a: Padded, b: Padded) -> f64 {
    a.0[0] * b.0[0] + a.0[1] * b.0[1] + a.0[2] * b.0[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vector_instructions_leave_every_bit_of_the_nodal_update() {
        let field = |scale: f64| -> Vec<Padded> {
            (0..9001)
                .map(|i| {
                    let k = f64::from(i);
                    Padded::new([1.7 * k, 2.3 * k + 1.0, 0.9 * k].map(|x| scale * libm::sin(x)))
                })
                .collect()
        };
        let mass: Vec<f64> =
            (0..9001).map(|i| if i % 97 == 0 { 0.0 } else { 1.0 + f64::from(i % 13) }).collect();
        let reference = field(0.4);
        let dashpots = Dashpots { alpha: 4e3, upper: 100..7000, motion: None };
        for dashpots in [None, Some(&dashpots)] {
            for kinetic in [false, true] {
                let run = |level| {
                    let mut nodes = NodalState::new(field(1e-3), field(40.0), mass.clone());
                    nodes.force = field(1e5);
                    let update =
                        Update { dt: 1e-7, kinetic, dashpots, reference: &reference, level };
                    nodes.advance(&update, None);
                    let mut sums = StepSums::default();
                    nodes.take_sums(&update, &mut sums);
                    let sums = [sums.kinetic, sums.dashpot_power].map(|s| s.value().to_bits());
                    (nodes.displacement, nodes.velocity, sums)
                };
                let plain = run(Level::Portable);
                assert!(!kinetic || f64::from_bits(plain.2[0]) != 0.0);
                for level in Level::ALL {
                    assert_eq!(plain, run(level), "{level:?}");
                }
            }
        }
    }
}
