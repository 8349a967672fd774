//! Exact frictionless contact: a primal-dual active set.
//!
//! At closed slaves the normal displacement is eliminated through the projection,
//! `n . u_s = sum phi_I n . u_I - gap`; the normal force follows from the residual. After every step
//! the set is `{lambda > 0 or gap < 0}`, the semismooth Newton step on
//! `lambda = max(0, lambda - c gap)` (Hintermueller, Ito and Kunisch 2002).

use crate::error::StaticsError;
use crate::link::Link;
use crate::newton::forcing;
use crate::problem::{Ending, Equilibrium, Iteration, NewtonReport};
use crate::system::StaticSystem;
use contact::{Gap, GapFunction};
use mesh::Padded;
use solid::linear::Vector;
use std::collections::{BTreeSet, HashSet};

/// Gap (m) that counts as closed: a few hundred times the round-off of a coordinate.
const CLOSED: f64 = 1e-13;

/// Force over the load that counts as tension.
const TENSION: f64 = 1e-12;

/// The first step carries the bodies far: its linear solution is finer than a guess deserves.
const FIRST: f64 = 1e-2;

/// A residual that is this small and falls no further is round-off.
const ROUND_OFF: f64 = 1e-7;

/// Equilibrium with the slaves of `contact` on their masters from `u`.
pub(crate) fn solve(
    system: &mut StaticSystem<'_>,
    contact: &mut GapFunction,
    mut u: Vec<Padded>,
    observe: &mut dyn FnMut(&Iteration) -> bool,
) -> Result<Equilibrium, StaticsError> {
    let n = u.len();
    let zero = || vec![Padded::ZERO; n];
    let (mut force, mut d, mut r, mut jump) = (zero(), zero(), zero(), zero());
    let mut gaps: Vec<Gap> = Vec::new();
    let mut active: BTreeSet<u32> = BTreeSet::new();
    let mut seen: HashSet<Vec<u32>> = HashSet::new();
    let mut one_by_one = false;
    let mut at = Iteration::default();
    let mut total = 0;
    let mut before = f64::INFINITY;
    let mut energy = system.force(&u, &mut force, true);
    loop {
        contact.at(&system.reference, &u, &mut gaps);
        let changes = changes(&gaps, &force, &active, TENSION * system.scale(&force));
        let changed = !changes.is_empty();
        apply(changes, one_by_one, &mut active);
        // A set that comes back would come back for ever: from then on one slave at a time.
        if changed && !one_by_one {
            one_by_one = !seen.insert(active.iter().copied().collect());
        }
        let closed: Vec<&Gap> = gaps.iter().filter(|g| active.contains(&g.node)).collect();
        if let Some(gap) = closed.iter().find(|g| !system.space.is_free(g.node as usize)) {
            return Err(StaticsError::HeldSlave { node: gap.node as usize });
        }
        let links: Vec<Link> = closed.iter().map(|g| Link::new(g)).collect();
        let pressed: Vec<(Gap, f64)> = closed
            .iter()
            .zip(&links)
            .map(|(g, l)| ((*g).clone(), -l.slave_normal(&force)))
            .collect();
        let widest = closed.iter().fold(0.0, |w: f64, g| w.max(g.gap.abs()));
        at.closed = pressed.iter().map(|(gap, _)| gap.nodes).sum();
        at.normal_force = exact_sum::sum(pressed.iter().map(|p| p.1));
        let drift = system.unresisted(&links);
        system.space.set_links(links);
        r.copy_from_slice(&force);
        system.space.reduce(&mut r);
        at.residual = system.space.residual_norm(&r) / system.scale(&force);
        system.not_inverted(&u)?;
        if !observe(&at) {
            return Err(StaticsError::Interrupted);
        }
        let settled = !changed && widest <= CLOSED && drift.is_none();
        let found = settled && at.residual <= system.problem.tolerance;
        let stalled = settled && at.residual < ROUND_OFF && at.residual > 0.5 * before;
        if found || stalled {
            system.is_pressed(&at, &force)?;
            let ending = if found { Ending::Tolerance } else { Ending::RoundOff };
            let report = NewtonReport {
                last: at,
                cg_iterations: total,
                ending,
                facets: 0.0,
                internal: energy,
            };
            return Ok(Equilibrium { displacement: u, force: r, pressed, report });
        }
        if at.iteration >= system.problem.max_iterations || at.residual.is_nan() {
            return Err(system.slow(at, &r));
        }
        at.iteration += 1;
        if let Some(drift) = drift {
            let closed = |system: &mut StaticSystem<'_>, u: &[Padded]| {
                contact.at(&system.reference, u, &mut gaps);
                gaps.iter().filter(|g| g.gap < 0.0).map(Link::new).collect()
            };
            system.close(&drift, &mut u, &force, closed)?;
            (at.cg_iterations, at.step) = (0, 0.0);
            energy = system.force(&u, &mut force, true);
            before = f64::INFINITY;
            continue;
        }
        // Close the gaps first, by the slaves alone; then restore equilibrium with closed gaps.
        let tolerance = if at.iteration == 1 {
            FIRST
        } else {
            forcing(at.residual, before, system.problem.tolerance)
        };
        before = if changed { f64::INFINITY } else { at.residual };
        jump.set_zero();
        for (gap, link) in closed.iter().zip(&system.space.links) {
            link.add(link.slave, -gap.gap, &mut jump);
        }
        r.copy_from_slice(&force);
        system.subtract_stiffness_product(&jump, &mut r);
        system.space.reduce(&mut r);
        at.cg_iterations = system.step(&mut r, &mut d, tolerance, &at)?;
        total += at.cg_iterations;
        d.add(1.0, &jump);
        u.add(1.0, &d);
        at.step = 1.0;
        energy = system.force(&u, &mut force, true);
    }
}

/// A slave that opens or closes, and by how much it is wrong.
struct Change {
    node: u32,
    closes: bool,
    wrong: f64,
}

/// Closed slaves under tension (N) or gone from the other surface, and open ones that penetrate.
fn changes(gaps: &[Gap], force: &[Padded], active: &BTreeSet<u32>, tension: f64) -> Vec<Change> {
    let mut changes = Vec::new();
    for gap in gaps {
        let node = gap.node;
        if active.contains(&node) {
            let pull = Link::new(gap).slave_normal(force);
            if pull > tension {
                changes.push(Change { node, closes: false, wrong: pull });
            }
        } else if gap.gap < -CLOSED {
            changes.push(Change { node, closes: true, wrong: -gap.gap });
        }
    }
    let near: BTreeSet<u32> = gaps.iter().map(|g| g.node).collect();
    let gone = active.difference(&near);
    changes.extend(gone.map(|&node| Change { node, closes: false, wrong: f64::INFINITY }));
    changes
}

/// Makes the changes; with `one_by_one` only the worst of each kind.
fn apply(changes: Vec<Change>, one_by_one: bool, active: &mut BTreeSet<u32>) {
    let worst = [false, true].map(|closes| {
        let kind = changes.iter().filter(|c| c.closes == closes);
        kind.max_by(|a, b| a.wrong.total_cmp(&b.wrong)).map(|c| c.node)
    });
    for change in changes {
        if one_by_one && worst[usize::from(change.closes)] != Some(change.node) {
            continue;
        }
        if change.closes {
            active.insert(change.node);
        } else {
            active.remove(&change.node);
        }
    }
}
