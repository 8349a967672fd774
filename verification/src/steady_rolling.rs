//! Steady rolling of the reference wheel on its crown compared with CONTACT.
//!
//! CONTACT (Vollebregt; Kalker 1990) solves the same quasi-static problem on half-spaces with
//! boundary elements. Its creepages, areas and peaks are extrapolated to h = 0; its profiles along
//! y = 0 are those of its finest grid, 0.05 mm (data/steady-rolling-y0.csv).
//!
//! Convergence is of first order (carter.rs).

use crate::convergence::Convergence;
use crate::half_space::{HalfSpaces, WHEEL, WHEEL_EXTENT, WHEEL_SIZES, column, on_meshes, sizes};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::{
    Influence, Lateral, Rigid, Rolling, peak_shear, stick_border, stick_fraction,
};
use crate::row::Row;

pub(crate) const MU: f64 = 0.5;
/// Speed of rolling of the reference (m/s).
const SPEED: f64 = 38.89;
pub(crate) const SOURCE: &str = "CONTACT (Vollebregt), extrapolated to h = 0";
const PROFILES: &str = "CONTACT (Vollebregt), grid of 0.05 mm";

/// T/N, creepage, share of the patch that sticks, border of stick on y = 0 (m) and peak shear (Pa).
pub(crate) const STEADY: [[f64; 5]; 3] = [
    [0.15, 1.1554e-3, 0.8333, -5.275e-3, 416.2e6],
    [0.28, 2.4348e-3, 0.6517, -3.225e-3, 552.8e6],
    [0.40, 4.1370e-3, 0.4242, -0.425e-3, 617.6e6],
];

/// mu, creepage and T/N.
const CURVE: [[f64; 3]; 8] = [
    [0.5, 0.0005, 0.068871],
    [0.5, 0.0015, 0.188622],
    [0.5, 0.003, 0.326197],
    [0.5, 0.006, 0.472259],
    [0.5, 0.010, 0.499670],
    [0.32, 0.0005, 0.067163],
    [0.32, 0.0015, 0.174037],
    [0.32, 0.004, 0.305938],
];

fn blocks(size: Size) -> Result<Vec<(f64, HalfSpaces<'static>)>, Cause> {
    on_meshes(sizes(size, &WHEEL_SIZES), |h| {
        HalfSpaces::new(&WHEEL, WHEEL.block(h, WHEEL_EXTENT, Lateral::Symmetric))
    })
}

pub(crate) fn steady(size: Size) -> Outcome {
    let blocks = blocks(size)?;
    let body = WHEEL.body(WHEEL_EXTENT);
    let [a, _] = WHEEL.half_axes;
    let tables = profiles()?;
    let mut rows = Vec::new();
    for ([traction, creepage, stick, border, peak], table) in STEADY.into_iter().zip(&tables) {
        let found: Vec<(f64, [f64; 7])> = blocks
            .iter()
            .map(|(h, blocks)| Ok((*h, rolled(blocks, traction, table)?)))
            .collect::<Result<_, Cause>>()?;
        let study = |k: usize| Convergence::by_theory(column(&found, k), 1.0);
        let at = |what: &str| format!("T/N = {traction}: {what}");
        let h = found.last().map_or(f64::NAN, |(h, _)| *h);
        rows.push(Row::extrapolated(&at("creepage"), creepage, &study(0), body, SOURCE));
        rows.push(Row::extrapolated(&at("peak shear (Pa)"), peak, &study(1), body, SOURCE));
        let share = at("share of the patch that sticks");
        // whole nodes stick or slip: the share scatters, and extrapolation would multiply that
        rows.push(Row::converged(share, stick, &study(2), body, SOURCE));
        let one = (h / a, "one element, h/a");
        let what = at("border of stick on y = 0 (m), over a");
        rows.push(on_finest(what, &study(3), border, a, one, SOURCE));
        for (k, what) in ["p over p0", "p_f over mu p0", "slip over its peak"].iter().enumerate() {
            let what = at(&format!("rms difference of {what} along y = 0"));
            let study = study(4 + k);
            let from = format!("{}; and half a cell of the reference's grid", study.explain());
            let limit = match k {
                0 => (study.uncertainty() + table.moved(k, table.grid[1]), from.as_str()),
                // steps at the border of stick
                _ => (table.moved(k, h), "the reference moved by half an element"),
            };
            rows.push(on_finest(what, &study, 0.0, 1.0, limit, PROFILES));
        }
    }
    Ok(rows)
}

/// A quantity on the finest mesh, with a limit that is not that of its mesh study.
fn on_finest(
    what: String,
    study: &Convergence,
    reference: f64,
    scale: f64,
    limit: (f64, &str),
    source: &str,
) -> Row {
    let row = Row::new(what, [reference, study.finest()], scale, limit, source);
    Row { meshes: study.samples().to_vec(), order: study.order(), ..row }
}

/// Creepage, peak shear (Pa), share of stick, border of stick (m) and the rms differences of the
/// three profiles.
fn rolled(blocks: &HalfSpaces<'_>, traction: f64, table: &Profiles) -> Result<[f64; 7], Cause> {
    let force = |_| Rigid::Forced(traction * blocks.load);
    let [creepage, peak, share, p, shear, slip] = blocks.over_a_pitch(|influence, apex| {
        let rolling = blocks.roll(influence, MU, force)?;
        let [p, shear, slip] = table.differences(influence, &rolling, apex);
        let share = stick_fraction(influence, &rolling);
        Ok([rolling.creepage()[0], peak_shear(influence, &rolling), share, p, shear, slip])
    })?;
    // with the apex on a node the border is that of the profile along y = 0
    let rolling = blocks.roll(&blocks.influence, MU, force)?;
    let border = stick_border(&blocks.influence, &rolling).ok_or("nothing sticks")?;
    Ok([creepage, peak, share, border, p.sqrt(), shear.sqrt(), slip.sqrt()])
}

/// Pressure over p0, shear over mu p0 and slip over its peak along y = 0 at uniform x.
struct Profiles {
    /// First x and step (m).
    grid: [f64; 2],
    values: Vec<[f64; 3]>,
    /// Peak slip velocity (m/s).
    slip: f64,
}

fn profiles() -> Result<[Profiles; 3], Cause> {
    let text = include_str!("../data/steady-rolling-y0.csv");
    let mut table = Vec::new();
    for line in text.lines().filter(|l| !l.starts_with(['#', 'x'])) {
        table.push(line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?);
    }
    let step = 1e-3 * (table[1][0] - table[0][0]);
    Ok(std::array::from_fn(|k| {
        let slip = 1e-3 * table.iter().map(|r| r[3 + 2 * k]).fold(0.0, f64::max);
        let scaled = |r: &Vec<f64>| {
            let [p, shear, s] = [1e6 * r[1], 1e6 * r[2 + 2 * k], 1e-3 * r[3 + 2 * k]];
            [p / WHEEL.p0, shear / (MU * WHEEL.p0), s / slip]
        };
        let values = table.iter().map(scaled).collect();
        Profiles { grid: [1e-3 * table[0][0], step], values, slip }
    }))
}

impl Profiles {
    /// The profiles at x, interpolated; zero outside the patch.
    fn at(&self, x: f64) -> [f64; 3] {
        let place = (x - self.grid[0]) / self.grid[1];
        let (low, part) = (place.floor(), place - place.floor());
        let value = |i: f64| {
            let inside = i >= 0.0 && (i as usize) < self.values.len();
            if inside { self.values[i as usize] } else { [0.0; 3] }
        };
        let [left, right] = [value(low), value(low + 1.0)];
        std::array::from_fn(|k| left[k] + part * (right[k] - left[k]))
    }

    /// The profiles as a node at x of a mesh of size h (m) represents them: means with the weight of its shape
    /// function.
    fn node(&self, x: f64, h: f64) -> [f64; 3] {
        const SAMPLES: i32 = 16;
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for i in 1 - SAMPLES..SAMPLES {
            let s = f64::from(i) / f64::from(SAMPLES);
            let weight = 1.0 - s.abs();
            let values = self.at(x + s * h);
            (0..3).for_each(|k| sum[k] += weight * values[k]);
            weights += weight;
        }
        sum.map(|s| s / weights)
    }

    /// Mean squares of the differences of pressure, shear and slip over the points on y = 0 in contact.
    fn differences(&self, influence: &Influence, rolling: &Rolling<'_>, apex: f64) -> [f64; 3] {
        let h = rolling.pitch();
        let (mut squares, mut points) = ([0.0; 3], 0);
        for (k, &i) in rolling.contact().iter().enumerate() {
            let point = influence.points()[i];
            if point.at[1].abs() > 1e-3 * h {
                continue;
            }
            let x = point.at[0] - apex;
            let [p, shear, _] = self.node(x, h);
            // the slip over a pitch is that of its middle
            let [.., slip] = self.at(x + 0.5 * h);
            let pressure = rolling.bound()[k] / MU / point.area / WHEEL.p0;
            let carried = rolling.force()[k];
            let carried = libm::hypot(carried[0], carried[1]) / point.area / (MU * WHEEL.p0);
            let slipped = rolling.slip()[k];
            let slipped = libm::hypot(slipped[0], slipped[1]) / h * SPEED / self.slip;
            for (square, d) in
                squares.iter_mut().zip([pressure - p, carried - shear, slipped - slip])
            {
                *square += d * d;
            }
            points += 1;
        }
        squares.map(|s| s / f64::from(points))
    }

    /// Rms change of the k-th profile when it moves by half an element of size h (m).
    fn moved(&self, k: usize, h: f64) -> f64 {
        let ends = [self.grid[0], self.grid[0] + self.grid[1] * self.values.len() as f64];
        let n = 200;
        let square = |i: usize| {
            let x = ends[0] + (ends[1] - ends[0]) * i as f64 / n as f64;
            (self.at(x + 0.5 * h)[k] - self.at(x)[k]).powi(2)
        };
        ((0..=n).map(square).sum::<f64>() / (n + 1) as f64).sqrt()
    }
}

pub(crate) fn creep_force(size: Size) -> Outcome {
    let blocks = blocks(size)?;
    let body = WHEEL.body(WHEEL_EXTENT);
    let mut rows = Vec::new();
    for [mu, creepage, force] in CURVE {
        let found: Vec<(f64, [f64; 1])> = blocks
            .iter()
            .map(|(h, blocks)| {
                let share = |influence: &Influence, _| {
                    let rolling =
                        blocks.roll(influence, mu, |pitch| Rigid::Moved(creepage * pitch))?;
                    Ok([rolling.total()[0] / blocks.load])
                };
                Ok((*h, blocks.over_a_pitch(share)?))
            })
            .collect::<Result<_, Cause>>()?;
        let study = Convergence::by_theory(column(&found, 0), 1.0);
        let quantity = format!("T/N at creepage {creepage}, mu {mu}");
        rows.push(Row::extrapolated(&quantity, force, &study, body, SOURCE));
    }
    Ok(rows)
}
