//! The views of a picture: which faces, from where, magnified how much.

use super::quantity::Drawable;
use super::source::{DISK, Record, Source, body_name, ends};
use super::{View, Wanted};
use crate::chart::{Camera, Pane, Surface};
use crate::check::vector::{Vec3, axpy};

/// Directions in which the cameras look. z is up, x to the right in all.
const WHOLE: Vec3 = [-0.35, 1.0, -0.3];
const NEAR: Vec3 = [-0.07, 1.0, -0.19];
const FROM_ABOVE: Vec3 = [-0.25, 0.8, -1.0];
const FROM_BELOW: Vec3 = [-0.25, 0.8, 1.0];

/// What the largest deformation takes of the side of a pane, unless the magnification is given.
const SHARE_WHOLE: f64 = 0.02;
const SHARE_NEAR: f64 = 0.05;
/// Side of the close view over the radius of the disk, and over the patch.
const NEAR_RADII: f64 = 0.14;
const PATCHES: f64 = 2.5;
/// Deformation below this share of the side of a pane is round-off.
const ROUND_OFF: f64 = 1e-9;

/// What a camera follows.
#[derive(Clone, Copy, Debug)]
enum Aim {
    /// A place.
    Place(Vec3),
    /// Where the disk is lowest.
    Lowest,
    /// The patch.
    Patch,
}

/// A view.
#[derive(Clone, Debug)]
pub(super) struct Shot {
    what: String,
    faces: Vec<[u32; 4]>,
    mirrored: bool,
    toward: Vec3,
    aim: Aim,
    share: f64,
    span: f64,
    /// How much larger than it is deformation is drawn.
    pub(super) magnify: f64,
    /// Whether there is any: displacements of half-spaces are not recorded.
    deforms: bool,
    lit: bool,
}

/// The views of a run.
pub(super) fn shots(source: &Source, what: Drawable, wanted: &Wanted) -> Vec<Shot> {
    let mut shots = match what {
        Drawable::Fields => {
            let of = [(View::Whole, whole(source)), (View::Contact, near(source))];
            let taken =
                of.into_iter().filter(|(view, _)| [View::Both, *view].contains(&wanted.view));
            taken.map(|(_, shot)| shot).collect()
        }
        Drawable::Contact => surfaces(source),
    };
    for shot in &mut shots {
        shot.magnify = wanted.magnify.unwrap_or(f64::NAN);
        // the whole stays whole
        if !matches!(shot.aim, Aim::Place(_)) {
            shot.span = wanted.span.unwrap_or(shot.span);
        }
    }
    shots
}

fn whole(source: &Source) -> Shot {
    Shot {
        what: "whole".into(),
        faces: outside(source, |_| true),
        mirrored: source.half,
        toward: WHOLE,
        aim: Aim::Place([0.0; 3]),
        share: SHARE_WHOLE,
        span: f64::NAN,
        magnify: f64::NAN,
        deforms: true,
        lit: true,
    }
}

/// The outer faces of the cells that `keep` takes.
fn outside(source: &Source, keep: impl Fn(usize) -> bool) -> Vec<[u32; 4]> {
    let faces = mesh::outer_faces(source.corners.as_chunks().0, keep);
    faces.into_iter().map(|(_, face)| face).collect()
}

/// The contact from the side, cut along the middle of the bodies.
fn near(source: &Source) -> Shot {
    let behind = |cell: usize| source.centre(cell)[1] > 0.0;
    let mut faces = outside(source, behind);
    let mut what = "contact, elements with y > 0";
    // a slice of one element has none there
    if faces.is_empty() {
        (faces, what) = (outside(source, |_| true), "contact");
    }
    let [low, high] = source.heights;
    Shot {
        what: what.into(),
        faces,
        mirrored: false,
        toward: NEAR,
        aim: Aim::Lowest,
        share: SHARE_NEAR,
        span: NEAR_RADII * 0.5 * (high - low),
        magnify: f64::NAN,
        deforms: true,
        lit: true,
    }
}

/// Each contact surface by itself, since one hides the other.
fn surfaces(source: &Source) -> Vec<Shot> {
    let mut bodies = source.bodies.clone();
    bodies.sort_unstable();
    bodies.dedup();
    let shot = |body: u8| {
        let quads = source.corners.as_chunks::<4>().0.iter().zip(&source.bodies);
        let (from, toward) =
            if body == DISK { ("below", FROM_BELOW) } else { ("above", FROM_ABOVE) };
        Shot {
            what: format!("surface of the {} from {from}", body_name(body)),
            faces: quads.filter(|(_, of)| **of == body).map(|(quad, _)| *quad).collect(),
            mirrored: false,
            toward,
            aim: Aim::Patch,
            share: SHARE_NEAR,
            span: f64::NAN,
            magnify: f64::NAN,
            deforms: true,
            // the colours of the two are to be compared
            lit: false,
        }
    };
    // the bar first: it is looked at from above
    bodies.into_iter().rev().map(shot).collect()
}

/// Bounds over all records that are drawn.
#[derive(Clone, Debug)]
pub(super) struct Bounds {
    /// Largest value and largest size of a deformation (m).
    value: f64,
    deformation: f64,
    /// Ends along x, y, z of all nodes, and of the patch in x and y about its middle.
    box_: [[f64; 2]; 3],
    patch: f64,
}

impl Default for Bounds {
    fn default() -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        Self { value: 0.0, deformation: 0.0, box_: [none; 3], patch: 0.0 }
    }
}

impl Bounds {
    pub(super) fn take(&mut self, source: &Source, record: &Record) {
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        self.value = self.value.max(largest(&record.values));
        let sizes = record.deformation.iter().map(|d| crate::check::vector::norm(*d));
        self.deformation = sizes.fold(self.deformation, f64::max);
        for axis in 0..3 {
            let [low, high] = ends(record.placed.iter().map(|p| p[axis]));
            let [l, h] = self.box_[axis];
            self.box_[axis] = [l.min(low), h.max(high)];
        }
        if source.half {
            self.box_[1][0] = self.box_[1][0].min(-self.box_[1][1]);
        }
        let peak = largest(&record.pressure);
        for axis in 0..2 {
            // a hundredth: the edge of the patch may be ragged
            let pairs = record.placed.iter().zip(&record.pressure);
            let loaded = pairs.filter(|(_, p)| **p > 0.01 * peak && peak > 0.0);
            let [low, high] = ends(loaded.map(|(place, _)| place[axis]));
            self.patch = self.patch.max(high - low);
        }
    }

    /// The upper end of the colour bar.
    pub(super) fn top(&self) -> f64 {
        if self.value > 0.0 { self.value } else { 1.0 }
    }
}

impl Shot {
    /// Fixes what is to be the same in all records.
    pub(super) fn scale_to(&mut self, bounds: &Bounds) {
        if let Aim::Place(place) = &mut self.aim {
            *place = bounds.box_.map(|[low, high]| 0.5 * (low + high));
            let camera = Camera::new(*place, self.toward, 1.0);
            let corner = |i: usize| [0, 1, 2].map(|axis| bounds.box_[axis][(i >> axis) & 1]);
            let far =
                (0..8).map(|i| camera.project(corner(i))).map(|[x, y, _]| x.abs().max(y.abs()));
            self.span = 2.1 * far.fold(0.0, f64::max);
        }
        if !self.span.is_finite() {
            let [x, y, _] = bounds.box_.map(|[low, high]| high - low);
            let longest = 1.2 * x.max(y);
            self.span = if bounds.patch > 0.0 { PATCHES * bounds.patch } else { longest };
        }
        self.deforms = bounds.deformation > ROUND_OFF * self.span;
        if !self.magnify.is_finite() {
            let fitting = self.share * self.span / bounds.deformation;
            self.magnify =
                if self.deforms { crate::chart::round_down(fitting.max(1.0)) } else { 1.0 };
        }
    }

    /// The view of a record.
    pub(super) fn pane(&self, record: &Record) -> Pane {
        let mut points = record.magnified(self.magnify);
        let mut quads = self.faces.clone();
        let mut values = record.values.clone();
        if self.mirrored {
            let count = points.len() as u32;
            points.extend_from_within(..);
            points[count as usize..].iter_mut().for_each(|p| p[1] = -p[1]);
            quads.extend(self.faces.iter().map(|face| face.map(|node| node + count)));
            values.extend_from_within(..);
        }
        let title = match self.magnify {
            _ if !self.deforms => self.what.clone(),
            1.0 => format!("{}, deformation as it is", self.what),
            times => format!("{}, deformation × {times}", self.what),
        };
        let camera = Camera::new(self.centre(record), self.toward, self.span);
        Pane { title, camera, surface: Surface { points, quads, values }, lit: self.lit }
    }

    /// Where the camera looks.
    fn centre(&self, record: &Record) -> Vec3 {
        match self.aim {
            Aim::Place(place) => place,
            Aim::Lowest => record.lowest,
            Aim::Patch => {
                let nodes: Vec<usize> =
                    self.faces.as_flattened().iter().map(|n| *n as usize).collect();
                let total: f64 = nodes.iter().map(|n| record.pressure[*n]).sum();
                // without contact the middle of the surface
                let weight = |n: usize| match total > 0.0 {
                    true => record.pressure[n] / total,
                    false => 1.0 / nodes.len() as f64,
                };
                nodes.iter().fold([0.0; 3], |sum, &n| axpy(sum, weight(n), record.placed[n]))
            }
        }
    }
}
