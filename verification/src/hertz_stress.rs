//! The stress below a contact without friction, beside Hertz's.
//!
//! The disk of case A is pressed on its bar by exact contact (the static preload). On the axis of the patch the stress
//! of the elements is known at the centroids of each layer: between the two columns of elements at the axis it is linear
//! in x, and the column at y = h/2 stands for y = 0. A parabola through the largest of the layers and its two neighbours
//! gives the greatest shear and its depth. The patch ends between two nodes, so that convergence is of first order, as
//! that of p0 (hertz.rs).
//!
//! Hertz's half-spaces have the stress of `Ellipse::stress_below_centre` (Johnson 1985, Secs. 3.2 and 3.5).

use crate::convergence::Convergence;
use crate::half_space::WHEEL;
use crate::problem::{Cause, Outcome, Size};
use crate::rolling_dynamic::stress_below;
use crate::row::Row;
use halfspace::Ellipse;
use solid::invariants::max_shear;

const SOURCE: &str = "Hertz (1882); Johnson (1985), Secs. 3.2 and 3.5";
const HALF_AN_ELEMENT: (f64, &str) = (0.5, "half an element: it lies between two layers");
const POISSON: f64 = 0.3;
/// Keys of the pressing: some 20 steps, in which nothing moves.
const PRESSED: [&str; 7] = [
    "contact.enforcement=exact",
    "friction.static=0",
    "mesh.zone.length=0.03",
    "mesh.zone.start=-0.015",
    "time.roll=1e-4",
    "output.probes.bar=[]",
    "output.probes.disk=[]",
];

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, &[])
}

/// The problem, where no key of the runs is `planted`.
pub(crate) fn run_with(size: Size, planted: &[&str]) -> Outcome {
    let meshes: &[f64] = match size {
        Size::Quick => &[2e-3, 1.4e-3, 1e-3],
        Size::Full => &[2e-3, 1.4e-3, 1e-3, 0.7e-3],
    };
    let found: Vec<(f64, [[f64; 2]; 2])> = meshes
        .iter()
        .map(|&h| {
            let zone = format!("mesh.zone.size={h}");
            let keys = PRESSED.iter().chain(planted).map(|key| (*key).to_owned());
            let below = stress_below(&keys.chain([zone]).collect::<Vec<_>>())?;
            Ok((h, below.map(|profile| profile.greatest_shear())))
        })
        .collect::<Result<_, Cause>>()?;
    let [depth, shear] = by_hertz();
    let bodies = WHEEL.half_axes[0] / WHEEL.radii[1];
    let model = (bodies, "bodies that are no half-spaces, a over the smaller radius");
    let mut rows = Vec::new();
    for (body, name) in ["disk", "bar"].into_iter().enumerate() {
        let study =
            |k: usize| Convergence::by_theory(found.iter().map(|(h, of)| (*h, of[body][k])), 1.0);
        let what = format!("{name}: greatest shear (Pa)");
        rows.push(Row::converged(what, shear, &study(1), model, SOURCE));
        let (study, finest) = (study(0), meshes.last().copied().unwrap_or(f64::NAN));
        let what = format!("{name}: its depth (m), error in elements");
        let values = [depth, study.finest()];
        let row = Row::new(what, values, finest, HALF_AN_ELEMENT, SOURCE);
        rows.push(Row { meshes: study.samples().to_vec(), order: study.order(), ..row });
    }
    Ok(rows)
}

/// Depth (m) and value (Pa) of the greatest shear below Hertz's ellipse.
fn by_hertz() -> [f64; 2] {
    let [half_length, half_width] = WHEEL.half_axes;
    let ellipse = Ellipse { half_length, half_width: Some(half_width), peak_pressure: WHEEL.p0 };
    let depths = (1..4000).map(|i| f64::from(i) / 4000.0 * half_length);
    let shear = |z: f64| [z, max_shear(&ellipse.stress_below_centre(z, POISSON))];
    depths.map(shear).max_by(|a, b| a[1].total_cmp(&b[1])).unwrap_or_default()
}
