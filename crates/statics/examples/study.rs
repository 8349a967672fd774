#![allow(missing_docs, clippy::unwrap_used)]
use solid::*;
use statics::*;
use std::time::Instant;
const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
fn element(x: &[[f64; 3]; 8], m: &Material) -> [[f64; 24]; 24] {
    element_stiffness(x, m, Element { hourglass: HG.with(|h| h.get()) })
}
thread_local! { static HG: std::cell::Cell<f64> = const { std::cell::Cell::new(0.05) }; }
fn sphere(h: f64, extent: f64, growth: f64, lateral: Lateral, m: Material) -> Influence {
    let a = 1.8663e-3;
    let t = Instant::now();
    let i = Block {
        size: h,
        reach: [1.3 * a, 1.3 * a],
        depth: a,
        extent,
        growth,
        lateral,
        material: m,
    }
    .influence(&element, |x, y| (x * x + y * y) / 0.2)
    .unwrap();
    eprintln!("   {} points {:.2} s", i.points().len(), t.elapsed().as_secs_f64());
    i
}
fn ell(h: f64, extent: f64, growth: f64, lateral: Lateral) -> Influence {
    let t = Instant::now();
    let i = Block {
        size: h,
        reach: [1.25 * 7.162e-3, 1.25 * 5.387e-3],
        depth: 5.4e-3,
        extent,
        growth,
        lateral,
        material: STEEL,
    }
    .influence(&element, |x, y| x * x / 0.92 + y * y / 0.6)
    .unwrap();
    eprintln!("   {} points {:.2} s", i.points().len(), t.elapsed().as_secs_f64());
    i
}
fn main() {
    let which = std::env::args().nth(1).unwrap();
    match which.as_str() {
        "hertz" => {
            for (h, e, g) in [
                (0.4e-3, 0.04, 1.4),
                (0.2e-3, 0.04, 1.4),
                (0.1e-3, 0.04, 1.6),
                (0.2e-3, 0.02, 1.4),
                (0.2e-3, 0.08, 1.4),
            ] {
                let i = sphere(h, e, g, Lateral::Symmetric, STEEL);
                let p = press(&i, Press::Load(5e3), None).unwrap();
                let f = ellipsoid(&i, &p).unwrap();
                println!(
                    "sphere h {h} L {e} g {g}: p0 {:.4} (1.3709) a {:.4} b {:.4} (1.8663) approach {:.3} (34.83)",
                    f.p0 * 1e-9,
                    f.a * 1e3,
                    f.b * 1e3,
                    p.approach * 1e6
                );
            }
            for (h, e, g) in
                [(1e-3, 0.1, 1.4), (0.5e-3, 0.1, 1.4), (0.5e-3, 0.05, 1.4), (0.5e-3, 0.2, 1.4)]
            {
                let i = ell(h, e, g, Lateral::Symmetric);
                let p = press(&i, Press::Load(5e4), None).unwrap();
                let f = ellipsoid(&i, &p).unwrap();
                println!(
                    "crown h {h} L {e} g {g}: p0 {:.2} (1237.6) a {:.4} (7.162) b {:.4} (5.387) approach {:.3} (104.1)",
                    f.p0 * 1e-6,
                    f.a * 1e3,
                    f.b * 1e3,
                    p.approach * 1e6
                );
            }
        }
        "kalker" => {
            for nu in [0.25, 0.3] {
                let m = Material { poisson: nu, ..STEEL };
                for h in [0.373e-3, 0.249e-3, 0.1866e-3] {
                    let i = sphere(h, 0.02, 1.5, Lateral::Full, m);
                    let p = press(&i, Press::Load(1e4), None).unwrap();
                    let f = ellipsoid(&i, &p).unwrap();
                    let area: f64 = p.contact.iter().map(|&k| i.points()[k].area).sum();
                    let g = m.shear();
                    let mut c = [0.0; 2];
                    for axis in 0..2 {
                        let mut r = Rolling::new(&i, &p, 30.0).unwrap();
                        let mut rigid = [Rigid::Moved(0.0); 2];
                        rigid[axis] = Rigid::Moved(1e-5 * r.pitch());
                        r.steady(rigid, 1000).unwrap();
                        c[axis] = r.total()[axis] / (g * 1e-5);
                    }
                    println!(
                        "nu {nu} h {h}: fit a {:.4} b {:.4} area/pi {:.4}; C11 {:.4} C22 {:.4}; by fit ab {:.4} {:.4}; by area {:.4} {:.4}",
                        f.a * 1e3,
                        f.b * 1e3,
                        (area / std::f64::consts::PI).sqrt() * 1e3,
                        c[0] / 1.8663e-3f64.powi(2),
                        c[1] / 1.8663e-3f64.powi(2),
                        c[0] / (f.a * f.b),
                        c[1] / (f.a * f.b),
                        c[0] * std::f64::consts::PI / area,
                        c[1] * std::f64::consts::PI / area
                    );
                }
            }
        }
        "kalker2" => {
            let m = STEEL;
            for (h, lat) in [
                (0.373e-3, Lateral::Symmetric),
                (0.249e-3, Lateral::Symmetric),
                (0.1866e-3, Lateral::Symmetric),
                (0.124e-3, Lateral::Symmetric),
            ] {
                let i = sphere(h, 0.02, 1.5, lat, m);
                let p = press(&i, Press::Load(5e3), None).unwrap();
                let c: Vec<f64> = [1e-5, 0.5e-4, 1e-4, 2e-4, 4e-4]
                    .iter()
                    .map(|xi| {
                        let mut r = Rolling::new(&i, &p, 0.3).unwrap();
                        r.steady([Rigid::Moved(xi * r.pitch()), Rigid::Moved(0.0)], 1000).unwrap();
                        2.0 * r.total()[0] / (m.shear() * xi * 1.8663e-3f64.powi(2))
                    })
                    .collect();
                println!(
                    "h {h} C11 at 1e-5, .5, 1, 2, 4e-4: {c:.4?}; extrapolated {:.4} {:.4} {:.4}",
                    2.0 * c[1] - c[2],
                    2.0 * c[2] - c[3],
                    2.0 * c[3] - c[4]
                );
            }
        }
        "kalkerell" => {
            for h in [1e-3, 0.7e-3] {
                let i = ell(h, 0.1, 1.5, Lateral::Full);
                let p = press(&i, Press::Load(1e5), None).unwrap();
                let area: f64 = p.contact.iter().map(|&k| i.points()[k].area).sum();
                let ab = 7.1617e-3 * 5.38717e-3;
                for axis in 0..2 {
                    let mut r = Rolling::new(&i, &p, 30.0).unwrap();
                    let mut rigid = [Rigid::Moved(0.0); 2];
                    rigid[axis] = Rigid::Moved(1e-5 * r.pitch());
                    r.steady(rigid, 1000).unwrap();
                    let c = r.total()[axis] / (STEEL.shear() * 1e-5);
                    println!(
                        "ellipse h {h} axis {axis}: C {:.4} (4.620, 4.172), by area {:.4} (area ratio {:.4})",
                        c / ab,
                        c * std::f64::consts::PI / area,
                        area / (std::f64::consts::PI * ab)
                    );
                }
            }
        }
        "steady" => {
            let h: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
            let e: f64 = std::env::args().nth(3).unwrap().parse().unwrap();
            let hg: f64 = std::env::args().nth(4).map_or(0.05, |s| s.parse().unwrap());
            HG.with(|c| c.set(hg));
            let i = ell(h, e, 1.5, Lateral::Symmetric);
            let p = press(&i, Press::Load(5e4), None).unwrap();
            for q in [0.15, 0.28, 0.4] {
                let t = Instant::now();
                let mut r = Rolling::new(&i, &p, 0.5).unwrap();
                r.steady([Rigid::Forced(q * 5e4), Rigid::Moved(0.0)], 2000).unwrap();
                println!(
                    "# steady h {h} L {e} hg {hg} q {q}: xi {:.5e} stick {:.4} border {:?} peak {:.1} {:.2} s",
                    r.creepage()[0],
                    stick_fraction(&i, &r),
                    stick_border(&i, &r),
                    peak_shear(&i, &r) * 1e-6,
                    t.elapsed().as_secs_f64()
                );
                for ((&k, f), s) in r.contact().iter().zip(r.force()).zip(r.slip()) {
                    let pt = i.points()[k];
                    if pt.at[1] == 0.0 {
                        println!(
                            "{q},{:.4},{:.3},{:.3},{:.3}",
                            pt.at[0] * 1e3,
                            p.force[k] / pt.area * 1e-6,
                            f[0] / pt.area * 1e-6,
                            s[0] / r.pitch() * 38890.0
                        );
                    }
                }
            }
        }
        "creep" => {
            for h in [1e-3, 0.5e-3] {
                let i = ell(h, 0.1, 1.5, Lateral::Symmetric);
                let p = press(&i, Press::Load(5e4), None).unwrap();
                for mu in [0.5, 0.32] {
                    for xi in [0.0002, 0.0005, 0.001, 0.0015, 0.002, 0.003, 0.004, 0.006, 0.01] {
                        let mut r = Rolling::new(&i, &p, mu).unwrap();
                        let n = r.steady([Rigid::Moved(xi * r.pitch()), Rigid::Moved(0.0)], 2000);
                        println!(
                            "h {h} mu {mu} xi {xi}: T/N {:.6} stick {:.4} {n:?}",
                            r.total()[0] / 5e4,
                            stick_fraction(&i, &r)
                        );
                    }
                }
            }
        }
        "penalty" => {
            let i = ell(0.5e-3, 0.1, 1.5, Lateral::Symmetric);
            for sf in [f64::INFINITY, 3.0, 1.0, 0.3, 0.1] {
                let k = sf * 175e9 / 0.5e-3;
                let s = if sf.is_finite() {
                    i.with_springs(Some(k), Some(k))
                } else {
                    i.with_springs(None, None)
                };
                let p = press(&s, Press::Load(5e4), None).unwrap();
                let f = ellipsoid(&s, &p).unwrap();
                let mut r = Rolling::new(&s, &p, 0.5).unwrap();
                let n = r.steady([Rigid::Forced(0.28 * 5e4), Rigid::Moved(0.0)], 2000);
                let peak = p.pressure(&s).iter().fold(0.0f64, |m, p| m.max(*p));
                println!(
                    "SF {sf}: peak p {:.1} fit p0 {:.1} a {:.3} b {:.3} approach {:.2} xi {:.4e} stick {:.3} {n:?}",
                    peak * 1e-6,
                    f.p0 * 1e-6,
                    f.a * 1e3,
                    f.b * 1e3,
                    p.approach * 1e6,
                    r.creepage()[0],
                    stick_fraction(&s, &r)
                );
            }
        }
        "transient" => {
            let i = ell(0.5e-3, 0.1, 1.5, Lateral::Symmetric);
            let p = press(&i, Press::Load(5e4), None).unwrap();
            let mut r = Rolling::new(&i, &p, 0.5).unwrap();
            let rigid = [Rigid::Forced(0.28 * 5e4), Rigid::Moved(0.0)];
            r.shift(rigid).unwrap();
            println!("shift {:.3} um", r.moved()[0] * 1e6);
            for k in 1..=60 {
                r.roll(rigid).unwrap();
                println!("{:.2} mm {:.5e}", k as f64 * 0.5, r.creepage()[0]);
            }
        }
        _ => {}
    }
}
