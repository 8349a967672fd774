//! Rolling of half-spaces by the spectral method without inertia, beside closed forms and CONTACT.
//!
//! Carter (1926) is line contact ([`carter`](crate::carter)); Kalker's coefficients, steady rolling, the transient from
//! Cattaneo's shift and friction with memory are elliptic contacts that CONTACT (Vollebregt; Kalker 1990) solved by boundary
//! elements, extrapolated to h = 0 or, where that is not said, on its finest grid.
//!
//! Convergence is of first order: the squares of the grid that the edge of the patch cuts belong to it.

use crate::body::STEEL;
use crate::convergence::Convergence;
use crate::half_space::{Hertz, LINE, SPHERE, WHEEL, column, sizes};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use dynamics::smoothstep;
use friction::{Coulomb, Exponential, Memory, NodeFriction, Remembering};
use halfspace::{Along, Ellipse, HalfSpaces, Inertia, Rigid, Rolling, Setup};
use rayon::prelude::*;
use solid::Material;
use std::sync::Arc;

const SOURCE: &str = "CONTACT (Vollebregt), extrapolated to h = 0";
/// Speed of rolling (m/s).
pub(crate) const SPEED: f64 = 38.89;
/// Share of the spacing by which the patch moves in a step: no fraction of small numbers, so that the points pass
/// through all places in the patch.
const STRIDE: f64 = 0.382;
/// Places of the lines of points, over the spacing.
const LINES: [f64; 2] = [0.0, 0.5];
/// A coefficient of friction beyond what any traction needs.
const ADHESION: f64 = 1e4;

/// A patch that rolls at constant rigid motion.
pub(crate) struct Problem<'a> {
    pub(crate) hertz: &'a Hertz,
    pub(crate) material: Material,
    pub(crate) law: Arc<dyn NodeFriction>,
    /// Rolled distance (m), and the part of it at its end over which means are taken.
    pub(crate) distance: f64,
    /// See `distance`.
    pub(crate) mean: f64,
}

/// Means over the last spacings.
#[derive(Clone, Copy, Debug, Default)]
struct Means {
    /// Force over the normal force along x and y.
    traction: [f64; 2],
    creepage: f64,
    /// Largest shear (Pa).
    peak: f64,
    /// Share of the points that stick.
    stick: f64,
    /// Rear end of the zone of stick on the centre line (m).
    border: f64,
}

impl Problem<'_> {
    /// The patch at rest on points of the spacing h (m), whose lines lie `offset` spacings off the centre.
    fn rolling(&self, h: f64, offset: f64) -> Result<Rolling, Cause> {
        let [a, b] = self.hertz.half_axes;
        let Material { young, poisson, density } = self.material;
        let setup = Setup {
            bodies: HalfSpaces::new(young, poisson, density),
            spacing: h,
            patch: Ellipse {
                half_length: a,
                half_width: (b > 0.0).then_some(b),
                peak_pressure: self.hertz.p0,
            }
            .into(),
            offset,
            speed: SPEED,
            start: 0.0,
            step: STRIDE * h / SPEED,
            inertia: Inertia::Static,
            law: Arc::clone(&self.law),
            pressure_factor: None,
        };
        Ok(Rolling::new(setup)?)
    }

    /// Rolls with the spacing h (m).
    fn roll(&self, h: f64, offset: f64, rigid: Rigid) -> Result<Means, Cause> {
        let mut rolling = self.rolling(h, offset)?;
        let steps = (self.distance / (STRIDE * h)).ceil() as usize;
        let last = (self.mean / (STRIDE * h)).round() as usize;
        let mut means = Means::default();
        for n in 0..steps {
            let sums = rolling.step(rigid);
            if sums.unconverged > 0.0 {
                return Err(format!("step {n}: friction did not converge").into());
            }
            if n + last < steps {
                continue;
            }
            let share = 1.0 / last as f64;
            for c in 0..2 {
                means.traction[c] += share * sums.shear[c] / sums.normal;
            }
            means.creepage += share * sums.creepage;
            means.stick += share * (1.0 - sums.slipping as f64 / sums.points as f64);
            let size = |t: [f64; 2]| libm::hypot(t[0], t[1]);
            means.peak += share * rolling.patch().map(|p| size(p.shear)).fold(0.0, f64::max);
            means.border += share * border(&rolling, h);
        }
        Ok(means)
    }

    /// The same on grids of several spacings (m): force over the normal force along x and y, creepage, largest shear (Pa), share
    /// of stick, border of stick (m).
    pub(crate) fn study(
        &self,
        spacings: &[f64],
        rigid: Rigid,
    ) -> Result<Vec<(f64, [f64; 6])>, Cause> {
        spacings
            .par_iter()
            .map(|&h| {
                // the mean over places of the lines: which of them lie in the patch is chance
                let lines = if self.hertz.half_axes[1] > 0.0 { &LINES[..] } else { &LINES[..1] };
                let found: Vec<Means> = lines
                    .par_iter()
                    .map(|&offset| self.roll(h, offset, rigid))
                    .collect::<Result<_, Cause>>()?;
                let mut mean = [0.0; 6];
                for m in &found {
                    let [x, y] = m.traction;
                    let values = [x, y, m.creepage, m.peak, m.stick, m.border];
                    mean.iter_mut().zip(values).for_each(|(a, v)| *a += v / found.len() as f64);
                }
                // that on the centre line itself
                mean[5] = found[0].border;
                Ok((h, mean))
            })
            .collect()
    }
}

/// Rear end of the sticking points on the centre line, half a spacing behind the last (m).
fn border(rolling: &Rolling, h: f64) -> f64 {
    let stuck = rolling.patch().filter(|p| p.line == 0 && !p.slips);
    stuck.map(|p| p.at[0]).fold(f64::INFINITY, f64::min) - 0.5 * h
}

pub(crate) fn along(along: Along) -> Rigid {
    Rigid { along, lateral: 0.0, spin: 0.0 }
}

pub(crate) fn carter(size: Size) -> Outcome {
    const MU: f64 = 0.3;
    const TABLE: [[f64; 2]; 4] =
        [[0.25, 6.225e-4], [0.5, 1.3609e-3], [0.75, 2.3232e-3], [0.9, 3.1771e-3]];
    let a = LINE.half_axes[0];
    let all = [a / 8.0, a / 16.0, a / 32.0, a / 64.0];
    let problem = Problem {
        hertz: &LINE,
        material: STEEL,
        law: Arc::new(Coulomb { mu: MU }),
        distance: 16.0 * a,
        mean: a,
    };
    let mut rows = Vec::new();
    for [share, creepage] in TABLE {
        let force = along(Along::Force(share * MU * LINE.load));
        let found = problem.study(sizes(size, &all), force)?;
        let study = Convergence::by_theory(column(&found, 2), 1.0);
        let quantity = format!("Q/(mu N) = {share}: creepage");
        rows.push(Row::extrapolated(&quantity, creepage, &study, (0.0, ""), "Carter (1926)"));
        rows.push(on_finest(&quantity, creepage, &study, 0.02, "Carter (1926)"));
        let edge = a - 2.0 * a * (1.0 - share).sqrt();
        rows.push(border_row(&format!("Q/(mu N) = {share}"), edge, a, &found, "Carter (1926)"));
    }
    Ok(rows)
}

/// A quantity on the finest grid within `limit` of its reference.
fn on_finest(quantity: &str, reference: f64, study: &Convergence, limit: f64, source: &str) -> Row {
    let row = Row::asked(
        format!("{quantity} on the finest grid"),
        [reference, study.finest()],
        limit,
        source,
    );
    Row { meshes: study.samples().to_vec(), ..row }
}

/// The border of stick within a spacing.
fn border_row(what: &str, edge: f64, a: f64, found: &[(f64, [f64; 6])], source: &str) -> Row {
    let study = Convergence::by_theory(column(found, 5), 1.0);
    let h = found.last().map_or(f64::NAN, |(h, _)| *h);
    let row = Row::new(
        format!("{what}: border of stick on y = 0 (m), over a"),
        [edge, study.finest()],
        a,
        (h / a, "one spacing, h/a"),
        source,
    );
    Row { meshes: study.samples().to_vec(), ..row }
}

pub(crate) fn kalker(size: Size) -> Outcome {
    const SMALL: f64 = 1e-4;
    // the index of a/9 is that of the value on this grid, 10 to 17 % off, and says little of the extrapolated one: of that
    // twice as much is asked as of the full grids
    const QUICK: f64 = 0.02;
    let mut rows = Vec::new();
    let circle = |poisson: f64| Material { poisson, ..STEEL };
    let all = [
        ("circle, nu 0.25", &SPHERE, circle(0.25), [4.1125, 3.6676, 1.4655]),
        ("a/b 1.33, nu 0.3", &WHEEL, STEEL, [4.6200, 4.1722, 1.8773]),
        ("circle, nu 0.3", &SPHERE, circle(0.3), [4.2941, 3.7281, 1.4963]),
    ];
    let bodies = match size {
        Size::Quick => &all[..2],
        Size::Full => &all[..],
    };
    for &(what, hertz, material, references) in bodies {
        let [a, b] = hertz.half_axes;
        let problem = Problem {
            hertz,
            material,
            law: Arc::new(Coulomb { mu: ADHESION }),
            distance: 12.0 * a,
            mean: a,
        };
        let all = [a / 4.0, a / 6.0, a / 9.0, a / 27.0];
        let spin = SMALL / (a * b).sqrt();
        let motions = [
            ("C11", along(Along::Creepage(SMALL)), 0, 1.0),
            ("C22", Rigid { along: Along::Creepage(0.0), lateral: SMALL, spin: 0.0 }, 1, -1.0),
            ("C23", Rigid { along: Along::Creepage(0.0), lateral: 0.0, spin }, 1, -1.0),
        ];
        let scale = material.shear() * a * b * SMALL / hertz.load;
        let found = motions
            .par_iter()
            .map(|(_, rigid, ..)| problem.study(sizes(size, &all), *rigid))
            .collect::<Result<Vec<_>, _>>()?;
        for (((name, _, axis, sign), reference), found) in
            motions.into_iter().zip(references).zip(&found)
        {
            let values = column(found, axis).map(|(h, t)| (h, sign * t / scale));
            let study = Convergence::by_theory(values, 1.0);
            let quantity = format!("{name}, {what}");
            let row = Row::extrapolated(&quantity, reference, &study, (0.0, ""), SOURCE);
            let computed = row.computed;
            if size == Size::Quick {
                rows.push(row.at_most(QUICK));
            } else {
                rows.push(row);
                let quantity = format!("{quantity}, extrapolated");
                rows.push(Row::asked(quantity, [reference, computed], 0.01, SOURCE));
            }
        }
    }
    Ok(rows)
}

/// Spacings of the wheel's problems (m).
fn spacings(size: Size) -> &'static [f64] {
    match size {
        Size::Quick => &[2e-3, 1.4e-3, 1e-3],
        Size::Full => &[1e-3, 0.5e-3, 0.25e-3],
    }
}

pub(crate) fn steady(size: Size) -> Outcome {
    /// T/N, creepage, border of stick on y = 0 (m) and peak shear (Pa).
    const STEADY: [[f64; 4]; 3] = [
        [0.15, 1.1554e-3, -5.275e-3, 416.2e6],
        [0.28, 2.4348e-3, -3.225e-3, 552.8e6],
        [0.40, 4.1370e-3, -0.425e-3, 617.6e6],
    ];
    let a = WHEEL.half_axes[0];
    let problem = Problem {
        hertz: &WHEEL,
        material: STEEL,
        law: Arc::new(Coulomb { mu: 0.5 }),
        distance: 12.0 * a,
        mean: 2.0 * a,
    };
    let mut rows = Vec::new();
    for [traction, creepage, edge, peak] in STEADY {
        let force = along(Along::Force(traction * WHEEL.load));
        let found = problem.study(spacings(size), force)?;
        let at = |what: &str| format!("T/N = {traction}: {what}");
        for (k, what, reference, asked) in
            [(2, "creepage", creepage, 0.01), (3, "peak shear (Pa)", peak, 0.02)]
        {
            let study = Convergence::by_theory(column(&found, k), 1.0);
            let row = Row::extrapolated(&at(what), reference, &study, (0.0, ""), SOURCE);
            if size == Size::Quick {
                // as of Kalker's coefficients
                rows.push(row.at_most(2.0 * asked));
            } else {
                rows.push(row);
                let what = format!("{}, extrapolated", at(what));
                let values = [reference, study.extrapolated()];
                rows.push(Row::asked(what, values, asked, SOURCE));
            }
        }
        rows.push(border_row(&format!("T/N = {traction}"), edge, a, &found, SOURCE));
    }
    Ok(rows)
}

/// Steps of Cattaneo's shift.
const SHIFT: u32 = 24;

pub(crate) fn transient(size: Size) -> Outcome {
    /// Rolled distance (m), and the creepage there on CONTACT's grids of 0.2 and 0.1 mm. CONTACT gives the mean over a step
    /// of one spacing, which belongs to the middle of the step. These values are interpolated between the middles.
    const TRANSIENT: [[f64; 3]; 4] = [
        [4e-3, 1.82918e-3, 1.83281e-3],
        [8e-3, 2.70057e-3, 2.72772e-3],
        [12e-3, 2.39657e-3, 2.40304e-3],
        [20e-3, 2.42108e-3, 2.42823e-3],
    ];
    let problem = Problem {
        hertz: &WHEEL,
        material: STEEL,
        law: Arc::new(Coulomb { mu: 0.5 }),
        distance: 0.022,
        mean: 0.0,
    };
    let force = along(Along::Force(0.28 * WHEEL.load));
    let one = |h: f64, offset: f64| -> Result<Vec<[f64; 2]>, Cause> {
        let mut rolling = problem.rolling(h, offset)?;
        // Cattaneo's shift at rest, so slow in the end that the difference formula forgets it
        rolling.set_speed(0.0);
        for n in 1..=SHIFT {
            let share = smoothstep(f64::from(n), f64::from(SHIFT));
            rolling.step(along(Along::Force(share * 0.28 * WHEEL.load)));
        }
        rolling.set_speed(SPEED);
        let steps = (problem.distance / (STRIDE * h)).ceil() as usize;
        let history = (0..steps).map(|n| {
            let sums = rolling.step(force);
            if sums.unconverged > 0.0 {
                return Err(format!("step {n}: friction did not converge").into());
            }
            // the creepage of a step is that of its middle
            Ok([sums.centre - 0.5 * STRIDE * h, sums.creepage])
        });
        history.collect()
    };
    let histories: Vec<(f64, Vec<[f64; 2]>)> = spacings(size)
        .par_iter()
        .map(|&h| {
            let both: Vec<_> =
                LINES.par_iter().map(|&l| one(h, l)).collect::<Result<_, Cause>>()?;
            Ok((h, both.concat()))
        })
        .collect::<Result<_, Cause>>()?;
    let mut rows = Vec::new();
    for [rolled, coarse, fine] in TRANSIENT {
        // to h = 0, with the first order of steady rolling
        let creepage = 2.0 * fine - coarse;
        // mean over four spacings about the distance
        let values = histories.iter().map(|(h, history)| {
            let near = history.iter().filter(|[x, _]| (x - rolled).abs() <= 2.0 * h);
            let (mut sum, mut n) = (0.0, 0.0);
            near.for_each(|[_, xi]| {
                sum += xi;
                n += 1.0;
            });
            (*h, sum / n)
        });
        let study = Convergence::by_theory(values, 1.0);
        let quantity = format!("creepage after {:.1} mm at T/N = 0.28", 1e3 * rolled);
        rows.push(Row::extrapolated(&quantity, creepage, &study, (0.0, ""), SOURCE));
        if size == Size::Full {
            let values = [creepage, study.extrapolated()];
            rows.push(Row::asked(format!("{quantity}, extrapolated"), values, 0.01, SOURCE));
        }
    }
    Ok(rows)
}

/// CONTACT's steady rolling of the reference wheel under falling friction with memory: distance of memory (m),
/// creepage, T/N, and where its transient ends in a cycle instead of the steady state half its range over T/N, in
/// the last quarter of 30 mm on its grid of 0.1 mm.
pub(crate) const MEMORY: [[f64; 4]; 6] = [
    [3e-6, 1.5e-3, 0.1851, 0.0],
    [3e-6, 2.5e-3, 0.2700, 0.0],
    [3e-6, 4e-3, 0.3461, 0.0095],
    [5e-6, 1.5e-3, 0.1861, 0.0],
    [5e-6, 2.5e-3, 0.2725, 0.0],
    [5e-6, 4e-3, 0.3503, 0.0],
];
/// Where the steady values come from.
pub(crate) const MEMORY_SOURCE: &str = "CONTACT (Vollebregt), steady, grid of 0.1 mm";

/// Falling friction with memory as in [`MEMORY`].
pub(crate) fn remembering(distance: f64) -> Remembering<Exponential> {
    let steady = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
    Remembering { steady, memory: Memory { distance, floor: 1e-3 } }
}

pub(crate) fn memory(size: Size) -> Outcome {
    let source = MEMORY_SOURCE;
    let mut rows = Vec::new();
    for [distance, creepage, traction, cycle] in MEMORY {
        let law = remembering(distance);
        let problem = Problem {
            hertz: &WHEEL,
            material: STEEL,
            law: Arc::new(law),
            distance: 0.090,
            mean: 0.020,
        };
        let found = problem.study(spacings(size), along(Along::Creepage(creepage)))?;
        let study = Convergence::by_theory(column(&found, 0), 1.0);
        let quantity = format!("T/N at creepage {creepage}, memory of {:.0} um", 1e6 * distance);
        let cycles = (cycle, "the limit cycle of the reference");
        let row = Row::extrapolated(&quantity, traction, &study, cycles, source);
        // as of Kalker's coefficients
        rows.push(if size == Size::Quick { row.at_most(0.02 + cycle) } else { row });
        if size == Size::Full && cycle == 0.0 {
            let values = [traction, study.extrapolated()];
            rows.push(Row::asked(format!("{quantity}, extrapolated"), values, 0.01, source));
        }
    }
    Ok(rows)
}
