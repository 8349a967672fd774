//! The nodal update: velocity, position, and the force cleared for the next step, in one pass.

use crate::dashpots::{Dashpots, RigidMotion};
use mesh::Padded;
use rayon::prelude::*;
use solid::Level;
use std::ops::Range;

/// Nodes per parallel chunk; fixed, so that partial sums do not depend on the threads. Sums over chunks
/// are exact: the chunks may come in any order.
const CHUNK: usize = 4096;

/// What the update sums up over the free nodes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NodeSums {
    /// sum 1/2 m v^{n-1/2} . v^{n+1/2} (J), the kinetic energy that central difference
    /// conserves; zero unless asked for.
    pub(crate) kinetic: f64,
    /// Power that the dashpots dissipate (W).
    pub(crate) dashpot_power: f64,
    /// Reaction of the disk's dashpots on the hub: force in x and z (N), torque about y (N m).
    pub(crate) reaction: [f64; 3],
}

impl NodeSums {
    /// The sums of all chunks, in whatever order they arrive.
    fn total(chunks: &[Self]) -> Self {
        let sum = |of: fn(&Self) -> f64| exact_sum::sum(chunks.iter().map(of));
        Self {
            kinetic: sum(|c| c.kinetic),
            dashpot_power: sum(|c| c.dashpot_power),
            reaction: [sum(|c| c.reaction[0]), sum(|c| c.reaction[1]), sum(|c| c.reaction[2])],
        }
    }

    fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.dashpot_power += other.dashpot_power;
        for i in 0..3 {
            self.reaction[i] += other.reaction[i];
        }
    }
}

/// v^{n+1/2} = v^{n-1/2} + dt (f/m - alpha (v^{n-1/2} - v_rigid)) and
/// u^{n+1} = u^n + dt v^{n+1/2}; clears `force`.
///
/// Nodes of zero inverse mass keep their velocity. `partial` holds one entry per chunk; `level` is that of
/// the element kernels.
pub(crate) fn advance(
    displacement: &mut [Padded],
    velocity: &mut [Padded],
    force: &mut [Padded],
    inverse_mass: &[f64],
    dt: f64,
    kinetic: bool,
    dashpots: Option<&Dashpots<'_>>,
    partial: &mut [NodeSums],
    level: Level,
) -> NodeSums {
    let pass = Pass { dt, kinetic, dashpots };
    displacement
        .par_chunks_mut(CHUNK)
        .zip(velocity.par_chunks_mut(CHUNK))
        .zip(force.par_chunks_mut(CHUNK).zip(inverse_mass.par_chunks(CHUNK)))
        .zip(partial.par_iter_mut())
        .enumerate()
        .for_each(|(chunk, (((u, v), (f, inverse_mass)), sums))| {
            let chunk = Chunk { u, v, f, inverse_mass, first: chunk * CHUNK };
            *sums = advance_chunk(level, chunk, pass);
        });
    if kinetic || dashpots.is_some() { NodeSums::total(partial) } else { NodeSums::default() }
}

/// The nodes of a chunk, from node `first` on.
struct Chunk<'a> {
    u: &'a mut [Padded],
    v: &'a mut [Padded],
    f: &'a mut [Padded],
    inverse_mass: &'a [f64],
    first: usize,
}

/// What is the same for all chunks.
#[derive(Clone, Copy)]
struct Pass<'a> {
    dt: f64,
    kinetic: bool,
    dashpots: Option<&'a Dashpots<'a>>,
}

/// A chunk with instructions of `level`: the same bits with all, since nothing is fused.
fn advance_chunk(level: Level, chunk: Chunk<'_>, pass: Pass<'_>) -> NodeSums {
    #[cfg(target_arch = "x86_64")]
    if matches!(level, Level::Avx512 | Level::Avx2) && level.available() {
        // SAFETY: the machine has the instructions.
        return unsafe { update_chunk_wide(chunk, pass) };
    }
    update_chunk(chunk, pass)
}

/// # Safety
/// The machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn update_chunk_wide(chunk: Chunk<'_>, pass: Pass<'_>) -> NodeSums {
    update_chunk(chunk, pass)
}

#[inline(always)]
fn update_chunk(chunk: Chunk<'_>, pass: Pass<'_>) -> NodeSums {
    let Chunk { u, v, f, inverse_mass, first } = chunk;
    let Pass { dt, kinetic, dashpots } = pass;
    let nodes = first..first + inverse_mass.len();
    match (kinetic, dashpots) {
        (false, None) => update::<false>(u, v, f, inverse_mass, dt),
        (true, None) => update::<true>(u, v, f, inverse_mass, dt),
        (false, Some(d)) => damped::<false>(u, v, f, inverse_mass, dt, d, nodes),
        (true, Some(d)) => damped::<true>(u, v, f, inverse_mass, dt, d, nodes),
    }
}

/// v^{n+1/2} of one node under `force`, as [`advance`] gives it up to round-off.
pub(crate) fn free_velocity(
    node: usize,
    v: [f64; 3],
    force: [f64; 3],
    inverse_mass: f64,
    dt: f64,
    dashpots: Option<&Dashpots<'_>>,
) -> [f64; 3] {
    let mut after = [0, 1, 2].map(|i: usize| v[i] + dt * inverse_mass * force[i]);
    if let Some(d) = dashpots.filter(|_| inverse_mass > 0.0) {
        let motion = if d.disk.contains(&node) { d.motion } else { None }.unwrap_or_default();
        let (rigid, _) = motion.at(d.reference[node]);
        for i in 0..3 {
            after[i] -= dt * d.alpha * (v[i] - rigid[i]);
        }
    }
    after
}

/// Number of chunks, hence of partial sums, for `nodes` nodes.
pub(crate) fn chunks(nodes: usize) -> usize {
    nodes.div_ceil(CHUNK)
}

#[inline(always)]
fn update<const KINETIC: bool>(
    u: &mut [Padded],
    v: &mut [Padded],
    f: &mut [Padded],
    inverse_mass: &[f64],
    dt: f64,
) -> NodeSums {
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

/// The same with dashpots; `nodes` are the chunk's node numbers. The disk's nodes are contiguous,
/// so that a chunk falls into at most three runs of one body.
#[inline(always)]
fn damped<const KINETIC: bool>(
    u: &mut [Padded],
    v: &mut [Padded],
    f: &mut [Padded],
    inverse_mass: &[f64],
    dt: f64,
    dashpots: &Dashpots<'_>,
    nodes: Range<usize>,
) -> NodeSums {
    let mut sums = NodeSums::default();
    let within = |n: usize| n.clamp(nodes.start, nodes.end);
    let (start, end) = (within(dashpots.disk.start), within(dashpots.disk.end));
    let runs = [(nodes.start..start, false), (start..end, true), (end..nodes.end, false)];
    for (run, on_disk) in runs {
        let local = run.start - nodes.start..run.end - nodes.start;
        let motion = if on_disk { dashpots.motion } else { None }.unwrap_or_default();
        let run = damped_run::<KINETIC>(
            &mut u[local.clone()],
            &mut v[local.clone()],
            &mut f[local.clone()],
            &inverse_mass[local],
            &dashpots.reference[run],
            dt,
            dashpots.alpha,
            &motion,
        );
        sums.add(&run);
    }
    sums
}

/// Nodes of one body; a body at rest has the default motion, and its ground takes the reaction.
///
/// All sums run over the four entries of the padded vectors side by side, which the compiler turns
/// into vector instructions; the padding of every operand is zero.
#[inline(always)]
fn damped_run<const KINETIC: bool>(
    u: &mut [Padded],
    v: &mut [Padded],
    f: &mut [Padded],
    inverse_mass: &[f64],
    reference: &[Padded],
    dt: f64,
    alpha: f64,
    motion: &RigidMotion,
) -> NodeSums {
    let [mut power, mut kinetic, mut drags, mut about_z, mut about_x] = [[0.0; 4]; 5];
    for ((((u, v), f), &w), x) in u.iter_mut().zip(v).zip(f).zip(inverse_mass).zip(reference) {
        // nodes that are held or carried move as they are told: no force, no dashpot
        let (mass, rate) = if w > 0.0 { (1.0 / w, alpha) } else { (0.0, 0.0) };
        let (rigid, [ax, az]) = motion.at(*x);
        let (c, scale, decay) = (rate * mass, dt * w, dt * rate);
        for i in 0..4 {
            let before = v.0[i];
            let relative = before - rigid[i];
            let drag = c * relative;
            power[i] += drag * relative;
            drags[i] += drag;
            about_z[i] += az * drag;
            about_x[i] += ax * drag;
            let after = before + (scale * f.0[i] - decay * relative);
            if KINETIC {
                kinetic[i] += mass * before * after;
            }
            v.0[i] = after;
            u.0[i] += dt * after;
            f.0[i] = 0.0;
        }
    }
    let reaction = [drags[0], drags[2], about_z[0] - about_x[2]];
    NodeSums {
        kinetic: 0.5 * kinetic.iter().sum::<f64>(),
        dashpot_power: power.iter().sum(),
        reaction: if motion.is_at_rest() { [0.0; 3] } else { reaction },
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
        let dashpots =
            Dashpots { alpha: 4e3, disk: 100..7000, reference: &reference, motion: None };
        for dashpots in [None, Some(&dashpots)] {
            for kinetic in [false, true] {
                let run = |level| {
                    let (mut u, mut v, mut f) = (field(1e-3), field(40.0), field(1e5));
                    let mut partial = vec![NodeSums::default(); chunks(u.len())];
                    let sums = advance(
                        &mut u,
                        &mut v,
                        &mut f,
                        &mass,
                        1e-7,
                        kinetic,
                        dashpots,
                        &mut partial,
                        level,
                    );
                    let sums = [sums.kinetic, sums.dashpot_power].map(f64::to_bits);
                    (u, v, sums)
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
