//! The nodal update: velocity, position, and the force cleared for the next step, for a run of nodes.

use crate::dashpots::{Dashpots, RigidMotion};
use mesh::Padded;
use solid::{Level, SettledNodes};

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
    pub(crate) fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.dashpot_power += other.dashpot_power;
        for i in 0..3 {
            self.reaction[i] += other.reaction[i];
        }
    }
}

/// What is the same for all nodes of a step.
#[derive(Clone, Copy)]
pub(crate) struct Pass<'a> {
    /// 1/m of all nodes (1/kg); nodes of zero inverse mass keep their velocity.
    pub(crate) inverse_mass: &'a [f64],
    /// Time step (s).
    pub(crate) dt: f64,
    /// Whether to sum the kinetic energy.
    pub(crate) kinetic: bool,
    /// Mass damping, if there is any.
    pub(crate) dashpots: Option<&'a Dashpots>,
    /// That of the element kernels.
    pub(crate) level: Level,
}

/// v^{n+1/2} = v^{n-1/2} + dt (f/m - alpha (v^{n-1/2} - v_rigid)) and u^{n+1} = u^n + dt v^{n+1/2}; clears
/// the force. The same bits with all instruction sets, since nothing is fused.
pub(crate) fn advance(nodes: SettledNodes<'_>, pass: Pass<'_>) -> NodeSums {
    #[cfg(target_arch = "x86_64")]
    if pass.level != Level::Portable && pass.level.available() {
        // SAFETY: the machine has the instructions.
        return unsafe { advance_wide(nodes, pass) };
    }
    advance_plain(nodes, pass)
}

/// # Safety
/// The machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn advance_wide(nodes: SettledNodes<'_>, pass: Pass<'_>) -> NodeSums {
    advance_plain(nodes, pass)
}

#[inline(always)]
fn advance_plain(nodes: SettledNodes<'_>, pass: Pass<'_>) -> NodeSums {
    let dt = pass.dt;
    match (pass.kinetic, pass.dashpots) {
        (false, None) => update::<false>(nodes, pass.inverse_mass, dt),
        (true, None) => update::<true>(nodes, pass.inverse_mass, dt),
        (false, Some(d)) => damped::<false>(nodes, pass.inverse_mass, dt, d),
        (true, Some(d)) => damped::<true>(nodes, pass.inverse_mass, dt, d),
    }
}

/// v^{n+1/2} of one node under `force`, as [`advance`] gives it up to round-off.
pub(crate) fn trial(
    node: usize,
    v: [f64; 3],
    force: [f64; 3],
    inverse_mass: f64,
    dt: f64,
    dashpots: Option<&Dashpots>,
    reference: &[Padded],
) -> [f64; 3] {
    let mut after = [0, 1, 2].map(|i: usize| v[i] + dt * inverse_mass * force[i]);
    if let Some(d) = dashpots.filter(|_| inverse_mass > 0.0) {
        let motion = if d.disk.contains(&node) { d.motion } else { None }.unwrap_or_default();
        let (rigid, _) = motion.at(reference[node]);
        for i in 0..3 {
            after[i] -= dt * d.alpha * (v[i] - rigid[i]);
        }
    }
    after
}

#[inline(always)]
fn update<const KINETIC: bool>(nodes: SettledNodes<'_>, inverse_mass: &[f64], dt: f64) -> NodeSums {
    let mut twice_kinetic = 0.0;
    let SettledNodes { displacement, velocity, force, first, .. } = nodes;
    let of_node = displacement.iter_mut().zip(velocity).zip(force).zip(&inverse_mass[first..]);
    for (((u, v), f), &w) in of_node {
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

/// The same with dashpots. The disk's nodes are contiguous, so that a run falls into at most three of one
/// body.
#[inline(always)]
fn damped<const KINETIC: bool>(
    nodes: SettledNodes<'_>,
    inverse_mass: &[f64],
    dt: f64,
    dashpots: &Dashpots,
) -> NodeSums {
    let mut sums = NodeSums::default();
    let SettledNodes { first, reference, displacement: u, velocity: v, force: f } = nodes;
    let inverse_mass = &inverse_mass[first..first + u.len()];
    let within = |n: usize| n.clamp(first, first + u.len()) - first;
    let (start, end) = (within(dashpots.disk.start), within(dashpots.disk.end));
    let runs = [(0..start, false), (start..end, true), (end..u.len(), false)];
    for (run, on_disk) in runs {
        let motion = if on_disk { dashpots.motion } else { None }.unwrap_or_default();
        let run = damped_run::<KINETIC>(
            &mut u[run.clone()],
            &mut v[run.clone()],
            &mut f[run.clone()],
            &inverse_mass[run.clone()],
            &reference[run],
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
        const NODES: usize = 9001;
        let field = |scale: f64| -> Vec<Padded> {
            (0..NODES)
                .map(|i| {
                    let k = i as f64;
                    Padded::new([1.7 * k, 2.3 * k + 1.0, 0.9 * k].map(|x| scale * x.sin()))
                })
                .collect()
        };
        let inverse_mass: Vec<f64> =
            (0..NODES).map(|i| if i % 97 == 0 { 0.0 } else { 1.0 + (i % 13) as f64 }).collect();
        let reference = field(0.4);
        let dashpots = Dashpots { alpha: 4e3, disk: 100..7000, motion: None };
        for dashpots in [None, Some(&dashpots)] {
            for kinetic in [false, true] {
                let run = |level| {
                    let (mut u, mut v, mut f) = (field(1e-3), field(40.0), field(1e5));
                    let nodes = SettledNodes {
                        first: 0,
                        reference: &reference,
                        displacement: &mut u,
                        velocity: &mut v,
                        force: &mut f,
                    };
                    let inverse_mass = &inverse_mass;
                    let pass = Pass { inverse_mass, dt: 1e-7, kinetic, dashpots, level };
                    let sums = advance(nodes, pass);
                    let sums = [sums.kinetic, sums.dashpot_power].map(f64::to_bits);
                    (u, v, sums)
                };
                let plain = run(Level::Portable);
                assert!(!kinetic || f64::from_bits(plain.2[0]) != 0.0);
                assert_eq!(plain, run(Level::detect()));
            }
        }
    }
}
