//! The stress below the patch: in the plane y = 0, and over the depth on the axis.

use super::caption::caption;
use super::scene::Scene;
use crate::chart::{Axis, Draw, Face, Figure, Fill, Key, Panel, Scale, Series, colour};
use crate::check::body_name;
use crate::subsurface::Below;
use solid::invariants::{max_shear, von_mises};

/// What is shown along x, along z and over the depth, in half axes of the patch.
const WIDE: f64 = 3.2;
const HIGH: f64 = 1.6;
const DEEP: f64 = 2.5;
/// Points of a line over the depth.
const POINTS: usize = 80;

/// Von Mises stress of both bodies in the plane y = 0, element by element.
pub(super) fn section(scene: &Scene<'_>, below: &Below<'_>) -> Figure {
    let reach = [WIDE, HIGH].map(|share| share * below.half_length());
    let mut cuts: Vec<_> = [0, 1].into_iter().flat_map(|body| below.section(body, reach)).collect();
    // nothing is drawn beyond the axes
    let within = |corner: &[f64; 2]| corner[0].abs() <= reach[0] && corner[1].abs() <= reach[1];
    cuts.retain(|(corners, _)| corners.iter().all(within));
    let values: Vec<f64> = cuts.iter().map(|(_, stress)| 1e-6 * von_mises(stress)).collect();
    let top = values.iter().fold(0.0, |top: f64, value| top.max(*value));
    let key = Key::Values {
        label: "von Mises stress (MPa)".into(),
        range: [0.0, top],
        scale: Scale::Linear,
    };
    let faces = cuts.iter().zip(&values).map(|((corners, _), value)| Face {
        corners: corners.map(|at| at.map(|x| 1e3 * x)),
        colour: key.colour(*value),
    });
    let [x, z] = reach.map(|reach| 1e3 * reach);
    let panel = Panel {
        to_scale: true,
        faces: faces.collect(),
        fill: Some(Fill { cells: Vec::new(), key: key.clone() }),
        ..Panel::new(
            Axis::linear("x from the patch's centre (mm)").over(-x, x),
            Axis::linear("z from the contact (mm)").over(-z, z),
        )
    };
    let text = format!(
        "Von Mises stress of the elements at y = 0 and t = {:.4} ms, the disk above the bar; rolling is to the right.",
        1e3 * below.time
    );
    Figure { size: [1080, 680], columns: 1, panels: vec![panel], caption: caption(scene, &text) }
}

/// What is drawn over the depth: label, colour, value (MPa) of a stress.
type Shown = (&'static str, [u8; 3], fn(&[f64; 6]) -> f64);

const INVARIANTS: [Shown; 2] = [
    ("von Mises stress", colour::BLUE, |s| 1e-6 * von_mises(s)),
    ("largest shear stress", colour::VERMILION, |s| 1e-6 * max_shear(s)),
];
const NORMAL: [Shown; 4] = [
    ("\u{3c3}_{xx}", colour::BLUE, |s| 1e-6 * s[0]),
    ("\u{3c3}_{yy}", colour::GREEN, |s| 1e-6 * s[1]),
    ("\u{3c3}_{zz}", colour::VERMILION, |s| 1e-6 * s[2]),
    ("\u{3c3}_{xz}", colour::PURPLE, |s| 1e-6 * s[5]),
];

/// The stresses on the axis of a body that are drawn, with their depths (m).
struct OnAxis {
    elements: (Vec<f64>, Vec<[f64; 6]>),
    loaded: Vec<[f64; 6]>,
    hertz: Option<Vec<[f64; 6]>>,
}

/// Stresses over the depth on the axis, of the elements and of half-spaces.
pub(super) fn depth(scene: &Scene<'_>, below: &Below<'_>) -> Figure {
    let deepest = DEEP * below.half_length();
    let depths: Vec<f64> = (1..=POINTS).map(|i| deepest * i as f64 / POINTS as f64).collect();
    let bodies = [0, 1].map(|body| OnAxis {
        elements: below.on_axis(body),
        loaded: below.half_space(body, &depths),
        hertz: below.hertz(body, &depths),
    });
    let mut panels = Vec::new();
    for shown in [&INVARIANTS[..], &NORMAL] {
        for (body, on_axis) in (0..).zip(&bodies) {
            let mut series = Vec::new();
            for &(label, colour, value) in shown {
                let line = |all: &[[f64; 6]], at: &[f64], label: &str, draw| Series {
                    label: label.into(),
                    points: at.iter().zip(all).map(|(z, s)| [1e3 * z, value(s)]).collect(),
                    draw,
                };
                let hertz = on_axis.hertz.as_ref();
                series.extend(hertz.map(|all| line(all, &depths, "", Draw::Dashed(colour))));
                series.push(line(&on_axis.loaded, &depths, label, Draw::Line(colour)));
                let (centroids, elements) = &on_axis.elements;
                series.push(line(elements, centroids, "", Draw::Dots(colour, 3.0)));
            }
            let title = format!("On the axis of the {}", body_name(body));
            let x = Axis::linear("depth (mm)").over(0.0, 1e3 * deepest);
            panels.push(Panel { title, series, ..Panel::new(x, Axis::linear("stress (MPa)")) });
        }
    }
    let text = format!(
        "Stress below the centre of the patch at t = {:.4} ms, tension positive. Dots: elements. Lines: a half-space under \
         the pressure and shear of the run. Dashed: a half-space under Hertz's pressure alone.",
        1e3 * below.time
    );
    Figure { size: [960, 760], columns: 2, panels, caption: caption(scene, &text) }
}
