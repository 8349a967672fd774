//! A friction law of one's own: polishing, friction that falls with the work done against it.
//!
//! A block of four mass points slides over a held plate and comes to rest:
//!
//! ```sh
//! cargo run --release -p creepage-contact --example own_law
//! ```

use contact::{
    BodyMaterial, ContactStep, ExactContact, ExactSettings, FreeMotion, TraceFields, TraceStep,
};
use friction::{NodeConditions, NodeFriction};
use mesh::{Face, Mesh, Padded, Surface};
use nalgebra::Vector3;
use std::error::Error;

/// `mu = smooth + (rough - smooth) exp(-W/W_0)`, with the work of friction per area
/// `W = integral mu p |s| dt` that the node has done since it came into contact. `W` is the state.
#[derive(Clone, Copy, Debug)]
struct Polishing {
    rough: f64,
    smooth: f64,
    /// `W_0` (J/m^2).
    work: f64,
}

impl NodeFriction for Polishing {
    fn begin(&self, _at: &NodeConditions) -> [f64; 2] {
        [0.0; 2]
    }

    fn advance(
        &self,
        [work, _]: [f64; 2],
        slip_speed: f64,
        at: &NodeConditions,
        dt: f64,
    ) -> [f64; 2] {
        let power = self.mu([work, 0.0], slip_speed, at) * at.pressure * slip_speed;
        [work + power * dt, 0.0]
    }

    fn mu(&self, [work, _]: [f64; 2], _slip_speed: f64, _at: &NodeConditions) -> f64 {
        self.smooth + (self.rough - self.smooth) * libm::exp(-work / self.work)
    }

    fn mu_static(&self) -> f64 {
        self.rough
    }
}

/// A cube over `low`..`low + size` (m): its nodes, with the lower four first.
fn cube(low: [f64; 3], size: f64) -> Vec<Vector3<f64>> {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let at = |z: f64| corners.map(|[x, y]| Vector3::from(low) + size * Vector3::new(x, y, z));
    [at(0.0), at(1.0)].concat()
}

const SPEED: f64 = 1.0;
const MASS: f64 = 1e-3;
const LOAD: f64 = 40.0;
const DT: f64 = 1e-6;

/// Speed of the block (m/s) after each step until it rests.
fn slide(law: impl NodeFriction + 'static) -> Result<Vec<f64>, Box<dyn Error>> {
    // block 0..8, plate 8..16; faces look at one another
    let mesh = Mesh {
        nodes: [cube([0.0, 0.0, 0.0], 0.01), cube([-0.05, -0.05, -0.1], 0.1)].concat(),
        hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7], [8, 9, 10, 11, 12, 13, 14, 15]],
        ..Mesh::default()
    };
    let surface =
        |nodes, hex| Surface { faces: vec![Face { nodes, hex }], smooth: None, irregularity: None };
    let (under, top) = (surface([0, 3, 2, 1], 0), surface([12, 13, 14, 15], 1));
    let steel = BodyMaterial { bulk_modulus: 175e9, density: 7800.0 };
    let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
    let mut contact =
        ExactContact::new(&mesh, [(&under, steel), (&top, steel)], &settings, Box::new(law))?;

    let reference: Vec<Padded> = mesh.nodes.iter().copied().map(Padded::from).collect();
    let inverse_mass: Vec<f64> = (0..16).map(|i| if i < 8 { 1.0 / MASS } else { 0.0 }).collect();
    let mut fields = TraceFields::new(contact.trace(), &reference, &inverse_mass);
    let mut displacement = vec![Padded::ZERO; 16];
    let mut velocity = vec![Padded::ZERO; 16];
    velocity[..8].fill(Padded::new([SPEED, 0.0, 0.0]));
    let mut speeds = Vec::new();
    while velocity[0][0] > 0.0 && speeds.len() < 100_000 {
        let mut force = vec![Padded::ZERO; 16];
        // pressed down at its lower nodes
        force[..4].fill(Padded::new([0.0, 0.0, -0.25 * LOAD]));
        let step = |v: Padded, inverse_mass: f64, force: Vector3<f64>| {
            v.vector() + DT * inverse_mass * force
        };
        fields.gather_positions(&displacement);
        fields.gather_velocities(&velocity);
        let time = speeds.len() as f64 * DT;
        contact.follow(&fields.motion(time, DT));
        fields.gather_forces(fields.all(), &force);
        let TraceStep { motion, force: on_surfaces, .. } = fields.step(time, DT);
        let free = |node: u32, force: Vector3<f64>| {
            step(motion.velocity[node as usize], motion.inverse_mass[node as usize], force)
        };
        contact.apply(&motion, &FreeMotion { velocity: &free }, on_surfaces);
        fields.scatter_forces(fields.all(), &mut force);
        let moved: Vec<_> =
            (0..16).map(|n| step(velocity[n], inverse_mass[n], force[n].vector())).collect();
        for ((v, u), moved) in velocity.iter_mut().zip(&mut displacement).zip(moved) {
            *v = moved.into();
            *u += DT * moved;
        }
        speeds.push(velocity[0][0]);
    }
    Ok(speeds)
}

const LAW: Polishing = Polishing { rough: 0.5, smooth: 0.2, work: 2.0 };

fn main() -> Result<(), Box<dyn Error>> {
    let speeds = slide(LAW)?;
    println!("  t (ms)   v (m/s)   mu");
    let weight = 0.25 * LOAD / MASS;
    let mut before = SPEED;
    for (i, speed) in speeds.iter().enumerate() {
        if i % 20 == 0 {
            let mu = (before - speed) / (DT * weight);
            println!("{:8.3} {speed:9.4} {mu:7.4}", 1e3 * DT * (i + 1) as f64);
        }
        before = *speed;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_falls_from_rough_to_smooth_by_the_work_done() -> Result<(), Box<dyn Error>> {
        let speeds = slide(LAW)?;
        let weight = 0.25 * LOAD / MASS;
        let pressure = LOAD / 1e-4;
        let mut before = SPEED;
        let mut work = 0.0;
        for (i, &speed) in speeds[..speeds.len() - 1].iter().enumerate() {
            let mu = (before - speed) / (DT * weight);
            let law = LAW.smooth + (LAW.rough - LAW.smooth) * libm::exp(-work / LAW.work);
            assert!((mu - law).abs() < 1e-6, "{i}: {mu} {law}");
            work += mu * pressure * speed * DT;
            before = speed;
        }
        assert!(work > 2.0 * LAW.work, "it polishes: {work}");
        assert!(speeds.last().is_some_and(|v| *v == 0.0 || v.abs() < 1e-12));
        Ok(())
    }
}
