//! Hertz's contact of a wheel on a crown (R 0.46 m on 0.30 m, 100 kN, steel) with finite bodies:
//! penalty against exact enforcement.
//!
//!     cargo run --release -p creepage-statics --example hertz -- 1e-3 exact mortar 1.0 0.3 0.1
//!
//! The first argument is the element size (m), or two of them, `1e-3:1.2e-3`, of disk and bar; the others
//! are enforcements: exact with rows from node to face or with mortar rows, a number being the scale factor
//! of the penalty.
#![allow(clippy::unwrap_used)]

use contact::{
    BodyMaterial, ExactSettings, GapFunction, Normals, PenaltyContact, PenaltySettings, Rows,
    Stiffness,
};
use friction::Coulomb;
use mesh::{Bar, Disk, FineZone, Grading, Padded};
use nalgebra::Vector3;
use solid::{Element, Level, Material, Solid, Viscosity};
use statics::{Axis, Contact, Problem, Supports, Tied};
use std::time::Instant;

const RADIUS: f64 = 0.46;
const LOAD: f64 = 100e3;
const APPROACH: f64 = 104.1e-6;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let sizes = arguments.next().unwrap_or("2e-3".into());
    let (size, of_bar) = sizes.split_once(':').unwrap_or((&sizes, &sizes));
    let zone = |size: &str| FineZone {
        size: size.parse().unwrap(),
        length: 0.08,
        width: 0.02,
        depth: 0.008,
        start: -0.010,
        growth: 1.35,
        coarsest: 0.05,
        grading: Grading::Tensor,
    };
    let disk = Disk { radius: RADIUS, hub_radius: 0.10, width: 0.06, crown: None };
    let bar = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.09 };
    let mesh = mesh::join(&[
        mesh::disk(&disk, &zone(size)).unwrap(),
        mesh::bar(&bar, &zone(of_bar)).unwrap(),
    ]);
    let steel = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
    let element = Element { hourglass: 0.05 };
    let set = |body: usize, name: &str| mesh.bodies[body].node_sets[name].clone();
    let mut held = set(1, "bottom");
    for end in ["rear", "front"] {
        held.extend(mesh.bodies[1].surfaces[end].faces.iter().flat_map(|f| f.nodes));
    }
    let hub = Tied {
        nodes: set(0, "hub"),
        axes: [Axis::Moved(0.0), Axis::Moved(0.0), Axis::Loaded(-LOAD)],
    };
    let supports = Supports { held, tied: vec![hub], ..Supports::default() };
    println!("{} elements, {} nodes", mesh.hexes.len(), mesh.nodes.len());
    for word in arguments {
        let factor: f64 = word.parse().unwrap_or(1.0);
        let rows = match word.as_str() {
            "exact" => Some(Rows::NodeToFace),
            "mortar" => Some(Rows::Mortar),
            _ => None,
        };
        let mut solid =
            Solid::new(&mesh, &[steel; 2], element, Viscosity::default(), Level::detect()).unwrap();
        let settings = PenaltySettings {
            normal: Stiffness::Factor(factor),
            tangential: Stiffness::Factor(factor),
            damping: 0.0,
            curvature: true,
            normals: Normals::Averaged,
        };
        let behind = BodyMaterial { bulk_modulus: steel.bulk(), density: steel.density };
        let sides = [
            (&mesh.bodies[0].surfaces["tread"], behind),
            (&mesh.bodies[1].surfaces["top"], behind),
        ];
        let law = Box::new(Coulomb { mu: 0.0 });
        let mut contact = PenaltyContact::new(&mesh, sides, &settings, None, law).unwrap();
        let problem = Problem {
            mesh: &mesh,
            supports: &supports,
            spin: None,
            tolerance: 1e-9,
            max_iterations: 60,
        };
        let mut start = vec![Padded::ZERO; mesh.nodes.len()];
        let part = if rows.is_none() { 1.0 } else { 0.5 };
        start[mesh.bodies[0].nodes.clone()].iter_mut().for_each(|u| u[2] = -part * APPROACH);
        let exact = ExactSettings {
            slave: Some(0),
            curvature: true,
            rows: rows.unwrap_or_default(),
            ..ExactSettings::default()
        };
        let mut gaps = GapFunction::new(&mesh, sides, &exact).unwrap();
        let enforced = match rows {
            Some(_) => Contact::Multipliers(&mut gaps),
            None => Contact::Penalty(&mut contact),
        };
        let clock = Instant::now();
        let found = statics::solve(&mut solid, enforced, &problem, &start, |now| {
            println!(
                "  {word} {:2}: residual {:.1e}, N {:.3} kN, {} closed, {} CG, step {:.2}",
                now.iteration,
                now.residual,
                now.normal_force / 1e3,
                now.closed,
                now.cg_iterations,
                now.step
            );
            true
        });
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                println!("{word}: {error}");
                continue;
            }
        };
        let wall = clock.elapsed().as_secs_f64();
        let (points, pressure): (Vec<Vector3<f64>>, Vec<f64>) = match rows {
            Some(_) => {
                let at = |n: u32| mesh.at(n);
                found.pressed.iter().map(|(g, f)| (at(g.node), f / g.area)).unzip()
            }
            None => {
                let mut table = contact.nodal_table(0);
                contact.nodal(&mut table);
                let at = |&n: &u32| mesh.at(n);
                (table.nodes.iter().map(at).collect(), table.pressure)
            }
        };
        let fit =
            contact::patch::fit(contact::patch::PatchShape::Ellipse, &points, &pressure).unwrap();
        let peak = pressure.iter().copied().fold(0.0, f64::max);
        let hub = found.displacement[supports.tied[0].nodes[0] as usize][2];
        println!(
            "{word}: p0 {:.1} MPa (largest nodal {:.1}), a {:.3} mm, b {:.3} mm, hub {:.3} um, \
             residual {:.1e} ({:?}, facets {:.1e}), {} Newton, {} CG, {wall:.1} s, peak {:.0} MB",
            fit.p0 / 1e6,
            peak / 1e6,
            fit.a * 1e3,
            fit.b * 1e3,
            hub * 1e6,
            found.report.last.residual,
            found.report.ending,
            found.report.facets,
            found.report.last.iteration,
            found.report.cg_iterations,
            peak_memory_mb()
        );
    }
}

fn peak_memory_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM"));
    line.and_then(|l| l.split_whitespace().nth(1)?.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}
