use halfspace::*;
use std::sync::Arc;
fn main() {
    let arg: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let (h, factor, roll, kind) = (arg[0], arg[1], arg[2], arg[3]);
    // kind 0: static 3d, 1: dynamic 3d, 2: static 2d 3: dynamic 2d
    let bodies = HalfSpaces::new(210e9, 0.3, 7850.0);
    let line = kind >= 2.0;
    let patch = if line { Ellipse { half_length: 6e-3, half_width: None, peak_pressure: 1e9 } } else {
        Ellipse { half_length: 7.1617e-3, half_width: Some(5.3872e-3), peak_pressure: 1.2376e9 } };
    let inertia = if kind as usize % 2 == 0 { Inertia::Static } else { Inertia::Dynamic };
    let v = 38.89;
    let step = if inertia == Inertia::Static { factor * h / v } else { factor * h / bodies.pressure_speed };
    let t0 = std::time::Instant::now();
    let mut r = Rolling::new(Setup { bodies, spacing: h, patch, offset: 0.0, speed: v, start: 0.0, step, inertia, law: Arc::new(friction::Coulomb { mu: 0.5 }) }).unwrap();
    println!("grid {:?} memory {:?} made in {:?}", r.grid(), r.memory(), t0.elapsed());
    let n = (roll / v / step) as usize;
    let t0 = std::time::Instant::now();
    let (mut its, mut worst) = (0, 0.0f64);
    for k in 0..n {
        let t = (k + 1) as f64 * step;
        let x = (t / 0.74e-3).min(1.0);
        let ramp = x * x * (3.0 - 2.0 * x);
        let along = if arg.len() > 5 { Along::Force(arg[5] * ramp * 1e5) } else { Along::Creepage(arg[4] * ramp) };
        let s = r.step(Rigid { along, lateral: 0.0, spin: 0.0 });
        its += s.iterations; worst = worst.max(s.unconverged);
        if (k + 1) % (n / 12).max(1) == 0 {
            let peak = r.patch().map(|p| p.slip_velocity[0].abs()).fold(0.0, f64::max);
            let q = r.patch().map(|p| p.shear[0].abs()).fold(0.0, f64::max);
            println!("{:.2} mm N {:.1} T/N {:.5} creep {:.5e} slip {:.3} its {} {:.1e} peak s {peak:.3} peak tau {:.1}", 1e3 * s.centre, s.normal, s.shear[0] / s.normal, s.creepage, s.slipping as f64 / s.points as f64, s.iterations, s.unconverged, 1e-6*q);
        }
    }
    println!("{n} steps {:?}, mean iterations {:.1}, worst {worst:.1e}", t0.elapsed(), its as f64 / n as f64);
}
