//! Time and memory of a Cholesky factorisation of disk and bar, to compare with a whole contact problem by conjugate
//! gradients.
//!
//!     cargo run --release -p verification --example factor -- 4e-3
//!     cargo run --release -p creepage-statics --example hertz -- 4e-3 1.0
//!
//! The argument is the element size (m). One thread. One size per call, since the peak memory is that of the process.
#![allow(clippy::unwrap_used)]

use mesh::{Bar, Disk, FineZone, Grading};
use nalgebra::Vector3;
use solid::{Element, Material, element_stiffness};
use statics::Supports;
use std::time::Instant;
use verification::reference::{StiffnessMatrix, Symbolic, Unknowns};

fn main() {
    let size: f64 = std::env::args().nth(1).map_or(4e-3, |word| word.parse().unwrap());
    let zone = FineZone {
        size,
        length: 0.08,
        width: 0.02,
        depth: 0.008,
        start: -0.010,
        growth: 1.35,
        coarsest: 0.05,
        grading: Grading::Tensor,
    };
    let disk = Disk { radius: 0.46, hub_radius: 0.10, width: 0.06, crown: None };
    let bar = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.09 };
    let mesh = mesh::join(&[mesh::disk(&disk, &zone).unwrap(), mesh::bar(&bar, &zone).unwrap()]);
    let steel = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
    let element =
        |x: &[Vector3<f64>; 8], m: &Material| element_stiffness(x, m, Element { hourglass: 0.05 });
    let held = ["bottom", "hub"]
        .iter()
        .zip([1, 0])
        .flat_map(|(set, body): (_, usize)| mesh.bodies[body].node_sets[*set].clone())
        .collect();
    let supports = Supports { held, ..Supports::default() };

    let clock = Instant::now();
    let unknowns = Unknowns::new(&mesh, &supports, &[]).unwrap();
    let stiffness = StiffnessMatrix::assemble(&mesh, &[steel; 2], &element, &unknowns).unwrap();
    let assembled = clock.elapsed().as_secs_f64();
    let symbolic = Symbolic::new(&stiffness).unwrap();
    let analysed = clock.elapsed().as_secs_f64();
    let _factor = symbolic.factor(&stiffness, &unknowns).unwrap();
    let factored = clock.elapsed().as_secs_f64();
    println!(
        "{} elements, {} unknowns: numbered by nested dissection and assembled {assembled:.2} s, analysed \
         {:.2} s, factored {:.2} s; {} entries, peak {:.0} MB",
        mesh.hexes.len(),
        unknowns.count(),
        analysed - assembled,
        factored - analysed,
        symbolic.entries(),
        peak_memory_mb()
    );
}

fn peak_memory_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM"));
    line.and_then(|l| l.split_whitespace().nth(1)?.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}
