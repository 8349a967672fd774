//! The rupture of TPV3 between two half-spaces: see [`rupture`](crate::rupture), whose fault, friction and reference it shares.
//!
//! The stress of a point is the mean over its square. A quarter is solved, by symmetry. Beyond the fault friction holds up
//! to the edges of a rectangle; beyond that the change of traction counts as zero, which waves can tell at the places compared only
//! after the rupture.

use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::{Field, Row};
use crate::rupture::{self, FAULT, PRESSURE, ROCK, SHEAR, SHEAR_OF_SQUARE, SQUARE};
use halfspace::{Fault, FaultSetup, HalfSpaces};
use std::sync::Arc;

/// How far the rupture is followed.
struct Extent {
    /// Half the edges of the rectangle along x and y (m).
    rectangle: [f64; 2],
    /// The run's end (s).
    end: f64,
    /// Places along strike and along dip that are compared (km): multiples of 3 are points of all grids.
    places: [&'static [usize]; 2],
}

/// The whole fault: the last place ruptures at 4.6 s.
const WHOLE: Extent = Extent {
    rectangle: [FAULT[0] + 6e3, FAULT[1] + 6e3],
    end: 5.6,
    places: [&[3, 6, 9, 12], &[3, 6]],
};
/// Its middle: the last place ruptures at 2.4 s, before a P wave of 6 km/s comes back from the rectangle's edges.
const MIDDLE: Extent = Extent { rectangle: [11e3, 10.5e3], end: 3.0, places: [&[3, 6], &[3]] };
/// Steps in which a P wave passes a spacing: the quadrature damps short waves, and with two steps it is what makes half of
/// the delay of the front.
const STEPS: f64 = 4.0;
/// Order of convergence where the grids show none.
const ORDER: f64 = 2.0;

/// Initial shear (Pa) of the model, the mean over a square of the side `h` (m).
fn initial(at: [f64; 2], h: f64) -> f64 {
    let inside = |x: f64| {
        let ends = [x - 0.5 * h, x + 0.5 * h].map(|x| x.clamp(-SQUARE, SQUARE));
        (ends[1] - ends[0]) / h
    };
    let share = inside(at[0]) * inside(at[1]);
    -rupture::SCALE * (SHEAR + share * (SHEAR_OF_SQUARE - SHEAR))
}

/// Rupture times (s) of the points of the quarter, with the spacing h (m).
fn front(h: f64, extent: &Extent) -> Result<Field, Cause> {
    let bodies = HalfSpaces::new(ROCK.young, ROCK.poisson, ROCK.density);
    let step = h / bodies.pressure_speed / STEPS;
    let reach = [0, 1].map(|c| (extent.rectangle[c] / h).round() as usize);
    let mut fault = Fault::new(FaultSetup {
        bodies,
        spacing: h,
        reach,
        step,
        end: extent.end,
        pressure: rupture::SCALE * PRESSURE,
        shear: initial,
        law: Arc::new(rupture::ON_FAULT),
    })?;
    let counts = FAULT.map(|edge| (edge / h).ceil() as usize);
    let mut times = vec![f64::INFINITY; counts[0] * counts[1]];
    let mut before = vec![0.0; times.len()];
    while fault.time() < extent.end {
        if !fault.step() {
            return Err(format!("t = {} s: friction did not converge", fault.time()).into());
        }
        for ([x, y], [sx, sy], _) in fault.points() {
            let [i, j] = [x, y].map(|x| (x / h).round());
            if i as usize >= counts[0] || j as usize >= counts[1] {
                continue;
            }
            let (k, speed) = (i as usize + counts[0] * j as usize, libm::hypot(sx, sy));
            if times[k].is_infinite() && speed > rupture::RUPTURED {
                let over = (speed - rupture::RUPTURED) / (speed - before[k]);
                times[k] = (fault.time() - step * over).max(0.0);
            }
            before[k] = speed;
        }
    }
    let [x, y] = counts.map(|n| (0..n).map(|i| i as f64 * h).collect());
    Ok(Field { name: format!("h = {h} m"), size: h, x, y, values: times })
}

/// Points between middle and edge of the square: its edge lies between points, that of the fault on them. The finest grid takes
/// 3.5 GB of memory; one of 143 m would take four times as much.
const POINTS: [f64; 3] = [4.5, 5.5, 7.5];

pub(crate) fn run(size: Size) -> Outcome {
    let extent = match size {
        Size::Quick => MIDDLE,
        Size::Full => WHOLE,
    };
    let fronts =
        POINTS.iter().map(|n| front(SQUARE / n, &extent)).collect::<Result<Vec<_>, Cause>>()?;
    let mut rows = Vec::new();
    for (axis, name) in [(0, "strike"), (1, "dip")] {
        for &km in extent.places[axis] {
            let [i, j] = if axis == 0 { [km, 0] } else { [0, km] };
            let at = [i, j].map(|k| 1e3 * k as f64);
            let study = Convergence::new(fronts.iter().map(|f| (f.size, f.at(at))), ORDER);
            let reference = rupture::BOUNDARY_INTEGRAL[j][i];
            let step = (rupture::STEP / reference, "one time step of the reference");
            let quantity = format!("arrival {km} km along {name} (s)");
            rows.push(Row::extrapolated(&quantity, reference, &study, step, rupture::SOURCE));
        }
    }
    Ok(rows)
}
