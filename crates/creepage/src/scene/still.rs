//! The contact at one time as a figure: where a page cannot draw its scene, and on paper.

use super::Field;
use super::ShownFile;
use super::quantity::Drawable;
use super::source::Record;
use crate::chart::{Axis, Face, Figure, Fill, Key, Panel, Scale};
use crate::check::digits::digits;
use mesh::geometry::vector_area;
use nalgebra::Vector3;

/// What the largest deformation takes of the side of the view.
const SHARE: f64 = 0.05;

/// Cabinet projection: the plane y = 0 is seen as it is, and a length along y goes so far along x and z.
const OBLIQUE: [f64; 2] = [0.40, 0.25];

/// Where to look.
pub(super) struct View {
    pub centre: Vector3<f64>,
    /// Side of what is seen (m).
    pub span: f64,
    pub time: f64,
}

/// The faces around the contact with their deformation magnified, the nearer over the farther.
pub(super) fn still(shown: &ShownFile, record: &Record, field: &Field, view: View) -> Figure {
    let key = Key::Values {
        label: field.label.into(),
        range: [0.0, field.top.max(f64::MIN_POSITIVE)],
        scale: Scale::Linear,
    };
    let largest = record.deformation.iter().map(|d| d.norm()).fold(0.0, f64::max);
    let times =
        if largest > 0.0 { round_down((SHARE * view.span / largest).max(1.0)) } else { 1.0 };
    let placed = record.magnified(times);
    let values = &record.values[field.name];
    let half = 0.5 * view.span;
    let mut faces: Vec<(f64, Face)> = Vec::new();
    for quad in near(shown) {
        let corners = quad.map(|node| placed[node as usize] - view.centre);
        let normal = vector_area(corners);
        let line_of_sight = Vector3::new(-OBLIQUE[0], 1.0, -OBLIQUE[1]);
        let drawn = corners.map(|c| [c.x + OBLIQUE[0] * c.y, c.z + OBLIQUE[1] * c.y]);
        let inside = drawn.as_flattened().iter().all(|x| x.abs() <= half);
        if normal.dot(&line_of_sight) >= 0.0 || !inside {
            continue;
        }
        let depth = corners.iter().map(|corner| corner.dot(&line_of_sight)).sum::<f64>();
        let value = quad.iter().map(|&node| 0.25 * values[node as usize]).sum();
        // faces that look to the front have the colours of the key, others are in shade
        let light = 0.7 + 0.3 * (normal[1] / normal.norm()).abs();
        let colour = key.colour(value).map(|part| (f64::from(part) * light) as u8);
        let corners = drawn.map(|[x, z]| [1e3 * (x + view.centre[0]), 1e3 * (z + view.centre[2])]);
        faces.push((depth, Face { corners, colour }));
    }
    faces.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [x, z] = [view.centre[0], view.centre[2]].map(|at| [1e3 * (at - half), 1e3 * (at + half)]);
    let panel = Panel {
        title: format!("t = {} ms, deformation \u{d7} {times}", digits(1e3 * view.time, 4)),
        to_scale: true,
        fill: Some(Fill { cells: Vec::new(), key }),
        faces: faces.into_iter().map(|(_, face)| face).collect(),
        ..Panel::new(
            Axis::linear("x (mm)").over(x[0], x[1]),
            Axis::linear("z (mm)").over(z[0], z[1]),
        )
    };
    let caption =
        "Both bodies around their contact, from the plane y = 0 on; the axes hold in that plane.";
    Figure { size: [760, 760], columns: 1, panels: vec![panel], caption: caption.into() }
}

/// The faces that are drawn: of bodies those of the elements behind y = 0, of a slice of one element all.
fn near(shown: &ShownFile) -> Vec<[u32; 4]> {
    if shown.of == Drawable::Contact {
        // the bar's: the disk would hide it
        return shown.parts.last().map(|part| part.faces.clone()).unwrap_or_default();
    }
    let behind = shown.source.outside(|cell| shown.source.centre(cell)[1] > 0.0);
    if behind.is_empty() { shown.source.outside(|_| true) } else { behind }
}

/// The largest of 1, 2, 5, 10, 20, ... that is not above `value`, at least 1.
fn round_down(value: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(value)));
    let steps = [5.0, 2.0, 1.0].map(|step| step * decade);
    steps.into_iter().find(|step| *step <= value * (1.0 + 1e-12)).unwrap_or(1.0).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnifications_are_round() {
        for (value, round) in [(1.0, 1.0), (1.9, 1.0), (2.0, 2.0), (49.0, 20.0), (1e3, 1e3)] {
            assert_eq!(round_down(value), round, "{value}");
        }
    }
}
