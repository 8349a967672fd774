//! The solution of an implicit step: Newton's method on velocities, contact corrected after each iteration.

use super::columns::side_of;
use super::operator::{Frame, StepMatrix};
use super::{Implicit, Solved, Span};
use crate::dashpots::RigidMotion;
use crate::hub::{HubState, Resultant};
use crate::nodal_state::NodalState;
use crate::paired;
use crate::system::System;
use crate::unsolved::Unsolved;
use contact::{ContactSums, Corrected, Method};
use mesh::Padded;
use nalgebra::Vector3;
use solid::linear::{Vector, inner};

/// A step is solved where the residual over the forces, and the change of contact forces over the largest, are below this.
const TOLERANCE: f64 = 1e-8;
/// Part to which the residual falls in a linear solution: contact changes it again.
const LINEAR: f64 = 1e-2;
const MOST_ITERATIONS: usize = 80;
const MOST_PRODUCTS: usize = 4000;

/// Side 0 of contact is the upper body, which turns.
const UPPER: usize = 0;

impl Implicit {
    /// Solves a span as one step. Changes neither displacements nor velocities; where it fails, contact is as it was.
    pub(crate) fn solve(
        &mut self,
        system: &mut System,
        nodes: &mut NodalState,
        span: Span,
    ) -> Result<Solved, Unsolved> {
        let Span { time, dt, .. } = span;
        let angle = system.hub.as_ref().map_or(0.0, |hub| hub.state.angle);
        let frame = Frame { lead: self.theta * dt, dt, angle, with_hub: true };
        self.begin_contact(system, nodes, span, frame);
        self.operator.set(system, nodes, frame);
        self.w.copy_from_slice(&nodes.velocity);
        let old = system.hub.as_ref().map(|hub| hub.state).unwrap_or_default();
        let (mut hub, mut unknown) = (old, [old.vz, old.omega]);
        let mut load = Resultant::default();
        let (mut corrected, mut largest) = (Corrected::default(), 0.0_f64);
        let mut at = Unsolved { step: dt, iterations: 0, residual: f64::INFINITY, change: 0.0 };
        for iteration in 1..=MOST_ITERATIONS {
            at.iterations = iteration;
            self.effort.iterations += 1;
            if let Some(body) = &mut system.hub {
                hub = body.predicted([time, dt], &load, Some(unknown));
                body.place_velocities([old, hub], dt, &mut self.w);
            }
            let (mut solved, scale) = self.residual(system, nodes, span, [old, hub], &mut load);
            self.force_on_hub(system, span, &load, hub);
            let norm = self.residual_norm();
            // forces that nothing balances yet are forces too
            largest = largest.max(scale).max(norm);
            at.residual = if norm > 0.0 { norm / largest } else { norm };
            at.change = corrected.change;
            let settled = at.change <= TOLERANCE && corrected.unconverged <= TOLERANCE;
            if at.residual <= TOLERANCE && settled && iteration > 1 {
                (solved.load, solved.hub) = (load, hub);
                solved.contact = self.end_contact(system, nodes, span);
                return Ok(solved);
            }
            if !at.residual.is_finite() || at.change.is_nan() {
                break;
            }
            let Self { operator, gradients, residual, correction, .. } = self;
            let accuracy = LINEAR.max((0.1 * TOLERANCE / at.residual).min(0.3));
            let mut matrix = StepMatrix { operator, system, nodes };
            self.effort.products +=
                gradients.solve(&mut matrix, residual, correction, accuracy, MOST_PRODUCTS).1;
            self.w.add(1.0, &self.correction.nodes);
            (0..2).for_each(|i| unknown[i] += self.correction.hub[i]);
            corrected = self.correct_contact(system, nodes, span);
        }
        if let Some(Method::Exact(contact)) = &mut system.contact {
            contact.reject_implicit();
        }
        Err(at)
    }

    /// Follows the surfaces to the beginning of the span, and sets the Delassus operator up.
    fn begin_contact(
        &mut self,
        system: &mut System,
        nodes: &mut NodalState,
        Span { time, dt, cuts }: Span,
        frame: Frame,
    ) {
        let (Some(mut contact), Some(mut fields)) = (system.contact.take(), nodes.trace.take())
        else {
            return;
        };
        fields.gather_positions(&nodes.displacement);
        fields.gather_velocities(&nodes.velocity);
        let motion = fields.motion(time, dt);
        contact.follow(&motion);
        if let Method::Exact(exact) = &mut contact {
            exact.begin_implicit(&motion, &system.paired);
            let (columns, rows) = (&mut self.columns[cuts], &self.rows);
            let mut borne: Vec<u32> = exact.borne_by().collect();
            borne.sort_unstable();
            borne.dedup();
            let sources: Vec<u32> =
                borne.iter().map(|&node| rows.source(fields.trace(), node, &borne)).collect();
            for &node in &sources {
                let matrix = (&mut self.operator, &mut self.gradients);
                let room = [&mut self.residual, &mut self.correction];
                self.effort.products +=
                    columns.find(node, fields.trace(), matrix, (system, nodes), room, frame);
            }
            let turned = system.hub.is_some();
            let compliance = |node: u32, loaded: u32| {
                let on_upper = turned && side_of(fields.trace(), loaded) == UPPER;
                let at = borne.binary_search(&loaded).unwrap_or_default();
                let nodes = [node, loaded, sources[at]];
                columns.block(fields.trace(), rows, nodes, on_upper.then_some(frame.angle))
            };
            exact.set_compliance(&compliance);
        }
        (system.contact, nodes.trace) = (Some(contact), Some(fields));
    }

    /// Corrects the contact forces for the velocities found so far.
    fn correct_contact(
        &mut self,
        system: &mut System,
        nodes: &mut NodalState,
        Span { time, dt, .. }: Span,
    ) -> Corrected {
        let (Some(Method::Exact(exact)), Some(fields)) = (&mut system.contact, &mut nodes.trace)
        else {
            return Corrected::default();
        };
        fields.gather_velocities(&self.w);
        exact.solve_implicit(&fields.motion(time, dt))
    }

    /// Ends the step for contact.
    fn end_contact(
        &mut self,
        system: &mut System,
        nodes: &mut NodalState,
        Span { time, dt, .. }: Span,
    ) -> ContactSums {
        let (Some(Method::Exact(exact)), Some(fields)) = (&mut system.contact, &mut nodes.trace)
        else {
            return ContactSums::default();
        };
        fields.gather_velocities(&self.w);
        fields.clear_forces();
        let step = fields.step(time, dt);
        exact.end_implicit(&step.motion, &system.paired, step.force)
    }

    /// Sets the residual of the nodes at `w` with the forces of contact found so far, and the load on the hub; returns the powers of the step and the norm of the
    /// forces.
    fn residual(
        &mut self,
        system: &mut System,
        nodes: &mut NodalState,
        Span { time, dt, .. }: Span,
        [old, new]: [HubState; 2],
        load: &mut Resultant,
    ) -> (Solved, f64) {
        let lead = self.theta * dt;
        for ((to, u), w) in self.moved.iter_mut().zip(&nodes.displacement).zip(&self.w) {
            *to = Padded([u[0] + lead * w[0], u[1] + lead * w[1], u[2] + lead * w[2], 0.0]);
        }
        let mut solved = Solved::default();
        let force = &mut self.residual.nodes;
        force.fill(Padded::ZERO);
        let sums = system.solid.subtract_internal_force(&self.moved, &self.w, force, false);
        solved.dissipated = sums.viscous_power;
        let scale = inner(force, force);
        let at = time + lead;
        system.load.apply(at, force);
        solved.given = system.load.power(at, &self.w);
        solved.given += system.quiet.add_reactions(&self.w, force);
        if let Some(fields) = &mut nodes.trace
            && let Some(Method::Exact(exact)) = &mut system.contact
        {
            // contact loads the first nodes of pairs
            paired::share(&system.paired, force);
            fields.gather_forces(fields.all(), force);
            exact.add_forces(fields.step(time, dt).force);
            fields.scatter_forces(fields.all(), force);
            paired::follow(&system.paired, force);
        }
        if let Some(hub) = &system.hub {
            // only elements load nodes that it carries
            let between = |a: f64, b: f64| a + self.theta * (b - a);
            let [x, y, z] = [between(old.x, new.x), between(old.y, new.y), between(old.z, new.z)];
            *load = hub.resultant_about(Vector3::new(x, y, z), &self.moved, force);
        }
        let inertia = self.add_dashpots_and_inertia(system, nodes, lead, &mut solved, load);
        self.operator.reduce(system, nodes, &mut self.residual.nodes);
        (solved, scale.max(inertia).sqrt())
    }

    /// Adds the forces of the dashpots and of inertia to the residual; returns the square of the norm of the latter.
    fn add_dashpots_and_inertia(
        &mut self,
        system: &System,
        nodes: &NodalState,
        lead: f64,
        solved: &mut Solved,
        load: &mut Resultant,
    ) -> f64 {
        let motion = system.hub.as_ref().map(RigidMotion::new).unwrap_or_default();
        let reference = system.solid.reference();
        let (mut square, mut power) = (exact_sum::ExactSum::ZERO, exact_sum::ExactSum::ZERO);
        let mut reaction = [exact_sum::ExactSum::ZERO; 6];
        let dashpots = self.operator.dashpots();
        let alpha = system.mass_damping;
        for (n, f) in self.residual.nodes.iter_mut().enumerate() {
            let inverse = nodes.inverse_mass[n];
            if inverse == 0.0 {
                continue;
            }
            let (w, v) = (self.w[n], nodes.velocity[n]);
            let on_upper = alpha > 0.0 && system.upper.contains(&n);
            let (rigid, arm) =
                if on_upper { motion.at(reference[n]) } else { ([0.0; 4], [0.0; 3]) };
            let mut pull = Vector3::zeros();
            for i in 0..3 {
                // the dashpot of mass damping is relative to the rigid motion, that of a quiet end to the ground
                let c = dashpots[n][i];
                let dashpot = c * w[i] - alpha / inverse * rigid[i];
                let inertia = (w[i] - v[i]) / (inverse * lead);
                f[i] -= dashpot + inertia;
                square.add(inertia * inertia);
                power.add(dashpot * (w[i] - rigid[i]));
                pull[i] = dashpot;
            }
            if on_upper {
                let moment = Vector3::from(arm).cross(&pull);
                let all = pull.iter().chain(&moment);
                reaction.iter_mut().zip(all).for_each(|(sum, of)| sum.add(*of));
            }
        }
        solved.dissipated += power.value();
        let [fx, fy, fz, mx, my, mz] = reaction.map(|sum| sum.value());
        load.add(&Resultant { force: Vector3::new(fx, fy, fz), moment: Vector3::new(mx, my, mz) });
        square.value()
    }

    /// Sets the residual of the hub: what its velocity misses of that which `load` gives it.
    fn force_on_hub(
        &mut self,
        system: &mut System,
        Span { time, dt, .. }: Span,
        load: &Resultant,
        now: HubState,
    ) {
        self.residual.hub = [0.0; 2];
        let Some(hub) = &mut system.hub else { return };
        let then = hub.predicted([time, dt], load, None);
        let missed = [then.vz - now.vz, then.omega - now.omega];
        let mass = self.operator.hub_mass();
        for i in (0..2).filter(|&i| self.operator.free()[i]) {
            self.residual.hub[i] = (mass[i][0] * missed[0] + mass[i][1] * missed[1]) / dt;
        }
    }

    /// Norm of the residual (N), the hub's force included.
    fn residual_norm(&self) -> f64 {
        let [force, _] = self.residual.hub;
        let square = |f: &Padded| f.vector().norm_squared();
        (exact_sum::sum(self.residual.nodes.iter().map(square)) + force * force).sqrt()
    }
}
