//! A wheel at places of a corrugated rail, under the same load: how far its hub goes up and down, compared with half-spaces.
//!
//! Under a constant load on a slowly passed corrugation z = A cos kx the hub moves by A F, with F < 1 since the patch averages
//! over it (the contact filter; Remington 1987, "Wheel/rail rolling noise, I: Theoretical analysis", J. Acoust. Soc. Am. 81).
//! The deformation of wheel and rail at large is that of the load, and so the same at every place.

use crate::body::STEEL;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use creepage::case::Case;
use creepage::case::hertz::hertz;
use creepage::scenario;
use halfspace::{Gap, press};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const CASE: &str = include_str!("../../cases/wheel-rail/corrugation.toml");
const SOURCE: &str = "half-spaces with the same gap (Polonsky and Keer 1999)";

/// Amplitude and wavelength of the corrugation (m).
const AMPLITUDE: f64 = 1e-5;
const LENGTH: f64 = 0.04;
/// Where its crest is (m): under the wheel, before it, and half a wavelength away.
const CRESTS: [f64; 3] = [0.0, 0.25 * LENGTH, 0.5 * LENGTH];
/// Largest difference of the hub's motion from that of half-spaces.
const LIMIT: f64 = 0.05;
/// The same beside crest and trough: a wheel whose motion were a cosine would be off by 0.028.
const LIMIT_BESIDE: f64 = 0.01;
/// Points of the grid of half-spaces in the half length of the patch, and how far it reaches in that length.
const POINTS: f64 = 16.0;
const REACH: f64 = 1.4;

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, AMPLITUDE)
}

/// The same with finite elements on a corrugation of another amplitude (m).
pub(crate) fn run_with(size: Size, amplitude: f64) -> Outcome {
    let h = if size == Size::Quick { 1e-3 } else { 0.7e-3 };
    let [up, mean] = motion(CRESTS.map(|crest| hub(h, amplitude, crest)))?;
    let [reference, reference_mean] = motion(CRESTS.map(half_spaces))?;
    let way = "hub over crest and trough, half the difference over A";
    let bend = "hub beside crest and trough, over their mean, by A";
    Ok(vec![
        Row::asked(way, [reference, up], LIMIT, SOURCE),
        Row::new(
            bend,
            [reference_mean, mean],
            1.0,
            (LIMIT_BESIDE, "a third of the value, of A"),
            SOURCE,
        ),
    ])
}

/// From heights of the hub (m) over a crest, beside it and over a trough: half of the difference of the first and the last, and
/// how far the middle one lies over their mean, both over the amplitude.
fn motion(heights: [Result<f64, Cause>; 3]) -> Result<[f64; 2], Cause> {
    let [crest, beside, trough] = heights;
    let (crest, beside, trough) = (crest?, beside?, trough?);
    Ok([crest - trough, 2.0 * beside - crest - trough].map(|way| 0.5 * way / AMPLITUDE))
}

fn case(h: f64, amplitude: f64, crest: f64) -> Result<Case, Cause> {
    let formula = format!("{amplitude:e}*cos(2*pi*(x - {crest})/{LENGTH})");
    let sets = [
        format!("mesh.zone.size={h}"),
        format!("bar.surface={{ formula = \"{formula}\" }}"),
        "time.roll=1e-3".into(),
    ];
    Ok(Case::from_text(CASE, Path::new("corrugation.toml"), &sets)?)
}

/// Height of the hub (m) in the static preload with elements of `h` (m).
fn hub(h: f64, amplitude: f64, crest: f64) -> Result<f64, Cause> {
    let case = case(h, amplitude, crest)?;
    let model = scenario::model(&case)?;
    let stop = AtomicBool::new(false);
    let start = scenario::start(&case, &model, None, &stop, &mut |_| {}, &mut |_| Ok(()))?;
    Ok(start.facts.preload.ok_or("the case has no preload")?.hub())
}

/// Height of the rigid wheel on half-spaces (m).
fn half_spaces(crest: f64) -> Result<f64, Cause> {
    let case = case(2e-3, AMPLITUDE, crest)?;
    let (patch, rx) = (hertz(&case), case.disk.radius);
    let across = case.bar.crown_radius.curvature();
    let spacing = patch.a / POINTS;
    let reach = [patch.a, patch.b].map(|half| (REACH * half / spacing).ceil() as i64);
    let points = reach.map(|n| (2 * n + 1) as usize);
    let places = (-reach[1]..=reach[1]).flat_map(|j| (-reach[0]..=reach[0]).map(move |i| [i, j]));
    let gap = places.map(|place| {
        let [x, y] = place.map(|n| n as f64 * spacing);
        let height = AMPLITUDE * libm::cos(TAU * (x - crest) / LENGTH);
        x * x / (2.0 * rx) + 0.5 * across * y * y - height
    });
    let gap = Gap { spacing, first: reach.map(|n| -n), points, gap: gap.collect() };
    let steel = halfspace::HalfSpaces::new(STEEL.young, STEEL.poisson, STEEL.density);
    let pressed = press(&steel, &gap, case.load.normal)?;
    if pressed.cut {
        return Err("the grid of the half-spaces is too small".into());
    }
    Ok(-pressed.approach)
}
