//! The stress below the patch: that of the elements on the axis of the patch and in the plane y = 0, beside that of
//! half-spaces.
//!
//! Stresses are in Pa, tension positive, in the global frame. The depth counts from the surface into each body.

use crate::check::basis::{Basis, RunPaths, number_at, value_at};
use crate::check::frames::{ContactHistory, Frame};
use crate::check::patch_series::{self, PatchMeasure};
use crate::check::{PostError, Scales, body_name};
use crate::scene::{Drawable, SceneError, Source, ends};
use contact::patch::PatchShape;
use halfspace::{Ellipse, LoadedCell, plane_stress_below, stress_below};
use mesh::HEX_FACES;
use nalgebra::Vector3;
use output::layout::BODIES;
use schemars::JsonSchema;
use serde::Serialize;
use solid::invariants::{hydrostatic, max_shear, von_mises};
use std::collections::HashMap;

/// Depth to which the profile goes, in half axes a of the patch.
const DEEP: f64 = 3.0;
/// Elements beside the axis among which it is looked for, in element sizes.
const BESIDE: f64 = 3.0;

/// Stress over the depth on the axis of the patch in one body, at the last record of `fields.vtkhdf`.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct StressProfile {
    /// The body, `disk` or `bar`.
    pub body: String,
    /// Time of the record of the bodies (s).
    pub time: f64,
    /// Time of the record of the tractions, the nearest to it (s).
    pub contact_time: f64,
    /// x of the axis, the centre of the patch (m).
    pub x: f64,
    /// Hertz's half axis along x (m).
    pub half_length: Option<f64>,
    /// Hertz's peak pressure (Pa).
    pub peak_pressure: Option<f64>,
    /// Depths below the surface, at the centroids of the elements (m).
    #[schemars(extend("x-numpy" = true))]
    pub depth: Vec<f64>,
    /// Stress of the elements.
    pub elements: Stresses,
    /// Stress of a half-space under the pressure and shear that the run has on this body.
    pub half_space: Stresses,
    /// Stress of a half-space under Hertz's pressure without shear; none where Hertz's patch is not known.
    pub hertz: Option<Stresses>,
}

/// Stresses at the depths of a profile (Pa), tension positive; x rolls, y is lateral, z is up.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct Stresses {
    /// Von Mises stress.
    #[schemars(extend("x-numpy" = true))]
    pub von_mises: Vec<f64>,
    /// Largest shear stress, half of largest less smallest principal stress.
    #[schemars(extend("x-numpy" = true))]
    pub max_shear: Vec<f64>,
    /// A third of the trace.
    #[schemars(extend("x-numpy" = true))]
    pub hydrostatic: Vec<f64>,
    /// Normal stress along x.
    #[schemars(extend("x-numpy" = true))]
    pub xx: Vec<f64>,
    /// Normal stress along y.
    #[schemars(extend("x-numpy" = true))]
    pub yy: Vec<f64>,
    /// Normal stress along z.
    #[schemars(extend("x-numpy" = true))]
    pub zz: Vec<f64>,
    /// Shear stress.
    #[schemars(extend("x-numpy" = true))]
    pub xz: Vec<f64>,
}

impl StressProfile {
    /// The greatest shear stress of the elements: its depth (m) and value (Pa), by a parabola through the layer with the
    /// largest and its neighbours. NaN where the largest is at an end.
    pub fn greatest_shear(&self) -> [f64; 2] {
        let (z, shear) = (&self.depth, &self.elements.max_shear);
        let largest = (0..z.len()).max_by(|a, b| shear[*a].total_cmp(&shear[*b]));
        let Some(k) = largest.filter(|k| (1..z.len().saturating_sub(1)).contains(k)) else {
            return [f64::NAN; 2];
        };
        let slope = |i: usize| (shear[i + 1] - shear[i]) / (z[i + 1] - z[i]);
        let bend = (slope(k) - slope(k - 1)) / (z[k + 1] - z[k - 1]);
        let depth = 0.5 * (z[k - 1] + z[k]) - 0.5 * slope(k - 1) / bend;
        let value = shear[k] + (depth - z[k]) * (slope(k - 1) + bend * (depth - z[k - 1]));
        [depth, value]
    }
}

impl Stresses {
    /// Of stresses xx yy zz xy yz xz.
    pub(crate) fn of(all: &[[f64; 6]]) -> Self {
        let each = |of: &dyn Fn(&[f64; 6]) -> f64| all.iter().map(of).collect();
        Self {
            von_mises: each(&von_mises),
            max_shear: each(&max_shear),
            hydrostatic: each(&hydrostatic),
            xx: each(&|s| s[0]),
            yy: each(&|s| s[1]),
            zz: each(&|s| s[2]),
            xz: each(&|s| s[5]),
        }
    }
}

/// A run's stress and tractions at its last record of the bodies.
pub(crate) struct Below<'a> {
    history: &'a ContactHistory,
    basis: &'a Basis,
    source: Source,
    pub(crate) time: f64,
    /// The record of contact nearest in time, and the centre of its patch (m).
    frame: Frame,
    patch_x: f64,
    /// x of the axis at the time of the bodies, and z of the contact (m).
    axis: [f64; 2],
    /// Where the nodes are (m).
    placed: Vec<Vector3<f64>>,
    stress: Vec<[f64; 6]>,
    /// Edge of an element of the contact surfaces, and half axis of the patch along x (m).
    size: f64,
    half_length: f64,
    /// Poisson's ratio of disk and bar.
    poisson: [f64; 2],
}

/// The elements that have a face, by its sorted nodes.
type Sharing = HashMap<[u32; 4], Vec<usize>>;

/// Poisson's ratio of disk and bar, by the case.
fn poisson(basis: &Basis) -> Option<[f64; 2]> {
    let case = basis.case.as_ref()?;
    let of = |body: u8| {
        let own = number_at(case, &format!("{}.material.poisson", body_name(body)));
        own.or_else(|| number_at(case, "material.poisson"))
    };
    Some([of(0)?, of(1)?])
}

fn sorted(mut nodes: [u32; 4]) -> [u32; 4] {
    nodes.sort_unstable();
    nodes
}

/// A face of an element in the plane y = 0: corners x from the axis and z from the contact (m), and its stress.
pub(crate) type Cut = ([[f64; 2]; 4], [f64; 6]);

impl<'a> Below<'a> {
    /// `None` where the run has not written the stress tensor, has no contact then, or has no case with its material.
    ///
    /// # Errors
    /// Records that cannot be read or hold values that are not numbers.
    pub(crate) fn read(
        paths: &RunPaths,
        history: &'a ContactHistory,
        basis: &'a Basis,
        scales: &Scales,
    ) -> Result<Option<Self>, PostError> {
        let source = match Source::open(&paths.folder, Drawable::Bodies) {
            Ok(source) => source,
            Err(SceneError::Post(error)) => return Err(error),
            Err(_) => return Ok(None),
        };
        let Some((last, &time)) = source.times.iter().enumerate().next_back() else {
            return Ok(None);
        };
        let (true, Some(poisson)) = (source.has(&BODIES.stress), poisson(basis)) else {
            return Ok(None);
        };
        let away = |i: &usize| (history.times[*i] - time).abs();
        let nearest = (0..history.times.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
        let frame = history.record(nearest.unwrap_or_default())?;
        let bar = history.surface.bodies().last().copied().unwrap_or(0);
        let measured =
            patch_series::measure(&history.surface, &frame, bar, scales.peak_pressure, basis.shape);
        let patch_x = measured.values[PatchMeasure::Centre as usize];
        if !patch_x.is_finite() {
            return Ok(None);
        }
        let x = patch_x + basis.scale("speed").unwrap_or(0.0) * (time - frame.time);
        let (record, stress) = match (source.record(last, &[]), source.stress(last)) {
            (Ok(record), Ok(stress)) => (record, stress),
            (Err(SceneError::Post(error)), _) | (_, Err(SceneError::Post(error))) => {
                return Err(error);
            }
            _ => return Ok(None),
        };
        Ok(Some(Self {
            history,
            basis,
            time,
            frame,
            patch_x,
            axis: [x, record.lowest.z],
            placed: record.placed,
            stress,
            size: scales.size,
            half_length: basis
                .scale("half_length")
                .unwrap_or(measured.values[PatchMeasure::HalfLength as usize]),
            poisson,
            source,
        }))
    }

    /// Hertz's half axis along x, or that of the fitted pressure (m).
    pub(crate) fn half_length(&self) -> f64 {
        self.half_length
    }

    fn corners(&self, element: usize) -> &[u32; 8] {
        &self.source.corners.as_chunks().0[element]
    }

    /// The mean of places of nodes (m).
    fn middle(&self, nodes: &[u32]) -> Vector3<f64> {
        nodes.iter().map(|&node| self.placed[node as usize]).sum::<Vector3<f64>>()
            / nodes.len() as f64
    }

    /// Elements of a body whose middle is within `reach` of the axis and of the contact: along x, y and z (m).
    fn near(&self, body: u8, reach: [f64; 3]) -> Vec<usize> {
        let [x, z] = self.axis;
        let within = |element: &usize| {
            let at = self.middle(self.corners(*element)) - Vector3::new(x, 0.0, z);
            (0..3).all(|i| at[i].abs() < reach[i])
        };
        let mine = (0..self.stress.len()).filter(|e| self.source.bodies[*e] == body);
        mine.filter(within).collect()
    }

    /// Whether the depth of a body rises (1) or falls (-1) with z.
    fn inward(body: u8) -> f64 {
        if body == 0 { 1.0 } else { -1.0 }
    }

    /// The faces of an element.
    fn faces(&self, element: usize) -> [[u32; 4]; 6] {
        HEX_FACES.map(|face| face.map(|corner| self.corners(element)[corner]))
    }

    /// From an element at the surface, with its face there, the elements below it, each through the face opposite to the one
    /// above, as far as they lie below one another.
    fn column(&self, body: u8, (first, top): (usize, [u32; 4]), sharing: &Sharing) -> Vec<usize> {
        let (mut column, mut face) = (vec![first], top);
        while let Some(&element) = column.last() {
            let opposite = |f: &[u32; 4]| f.iter().all(|node| !face.contains(node));
            let Some(below) = self.faces(element).into_iter().find(opposite) else { break };
            let beyond = sharing.get(&sorted(below)).into_iter().flatten();
            let Some(next) = beyond.copied().find(|e| *e != element) else { break };
            let at = self.middle(self.corners(next));
            let step = at - self.middle(self.corners(element));
            // where elements grow 2:1, some of them lie beside
            let aside = (at - self.middle(&top)).xy().norm();
            if step.z * Self::inward(body) < 0.7 * step.norm() || aside > self.size {
                break;
            }
            column.push(next);
            face = below;
        }
        column
    }

    /// The stress on the axis over the depth (m), a value for each layer of elements: linear in x between the centroids
    /// of the columns of elements on both sides of the axis, in y the mean of the columns nearest y = 0. A body
    /// modelled for y >= 0 alone has its mirror image beside it.
    pub(crate) fn on_axis(&self, body: u8) -> (Vec<f64>, Vec<[f64; 6]>) {
        let beside = BESIDE * self.size;
        let elements = self.near(body, [beside, beside, DEEP * self.half_length]);
        let all: Vec<(usize, [u32; 4])> =
            elements.iter().flat_map(|&e| self.faces(e).map(|face| (e, face))).collect();
        let mut sharing = Sharing::new();
        for (element, face) in &all {
            sharing.entry(sorted(*face)).or_default().push(*element);
        }
        // those of the surface: a face of the cut through the mesh looks sideways
        let outer = |(element, face): &&(usize, [u32; 4])| {
            let out = self.middle(face) - self.middle(self.corners(*element));
            let high = (self.middle(face).z - self.axis[1]).abs() < 0.5 * self.size;
            let up = -out.z * Self::inward(body) > 0.5 * out.norm();
            high && up && sharing[&sorted(*face)].len() == 1
        };
        let tops: Vec<_> = all.iter().filter(outer).collect();
        let off = |face: &[u32; 4]| self.middle(face).y.abs();
        let least = tops.iter().map(|(_, face)| off(face)).fold(f64::INFINITY, f64::min);
        // of each layer the sums of weight times stress, depth and one
        let mut layers: Vec<[f64; 8]> = Vec::new();
        for &&(first, top) in tops.iter().filter(|(_, face)| off(face) < least + 0.1 * self.size) {
            let [low, high] = ends(top.iter().map(|&node| self.placed[node as usize].x));
            let above = self.middle(&top);
            let weight = 1.0 - (above.x - self.axis[0]).abs() / (high - low);
            if weight <= 0.0 {
                continue;
            }
            for (layer, element) in
                self.column(body, (first, top), &sharing).into_iter().enumerate()
            {
                let depth = (self.middle(self.corners(element)) - above).norm();
                layers.resize(layers.len().max(layer + 1), [0.0; 8]);
                let values = self.stress[element].into_iter().chain([depth, 1.0]);
                layers[layer].iter_mut().zip(values).for_each(|(sum, v)| *sum += weight * v);
            }
        }
        // below the depth that all columns reach the sums are of fewer of them
        let whole = layers.first().map_or(0.0, |layer| layer[7]);
        layers.retain(|layer| layer[7] > 0.99 * whole);
        let mean = |layer: &[f64; 8]| {
            let [xx, yy, zz, xy, yz, xz, ..] = layer.map(|sum| sum / layer[7]);
            // the mirror image has these with the other sign
            let mirrored = if self.source.half { 0.0 } else { 1.0 };
            [xx, yy, zz, mirrored * xy, mirrored * yz, xz]
        };
        let depth = layers.iter().map(|layer| layer[6] / layer[7]).collect();
        (depth, layers.iter().map(mean).collect())
    }

    /// The faces of a body in the plane y = 0, as far from the axis along x and from the contact along z (m).
    pub(crate) fn section(&self, body: u8, [x, z]: [f64; 2]) -> Vec<Cut> {
        let y = |node: &u32| self.placed[*node as usize].y;
        let cut = |element: &usize| {
            let [low, high] = ends(self.corners(*element).iter().map(y));
            low < 0.1 * self.size && high > 0.1 * self.size
        };
        let near = self.near(body, [x, x, z]).into_iter().filter(cut);
        near.map(|element| {
            let mut nodes = *self.corners(element);
            nodes.sort_by(|a, b| y(a).total_cmp(&y(b)));
            let mut corners = [0, 1, 2, 3].map(|i: usize| {
                let at = self.placed[nodes[i] as usize];
                [at.x - self.axis[0], at.z - self.axis[1]]
            });
            let centre = [0, 1].map(|i: usize| corners.iter().map(|c| 0.25 * c[i]).sum::<f64>());
            let angle = |c: &[f64; 2]| libm::atan2(c[1] - centre[1], c[0] - centre[0]);
            corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            (corners, self.stress[element])
        })
        .collect()
    }

    /// The surface of a body in contact, with the tractions on it; x and y from the centre of the patch (m).
    fn loaded(&self, body: u8, plane: bool) -> Vec<LoadedCell> {
        let surface = &self.history.surface;
        let halves = surface.halves();
        let rows = match plane {
            true => surface.centreline(body, self.size),
            false => (0..surface.points.len()).filter(|row| surface.body[*row] == body).collect(),
        };
        let loaded = rows.into_iter().filter(|row| self.frame.pressure[*row] > 0.0);
        loaded
            .map(|row| {
                let at = self.frame.position(surface, row) - self.patch_x * Vector3::x();
                let end = |end: usize| [0, 1].map(|axis| at[axis] + halves[row][axis][end]);
                let shear = self.frame.shear[row];
                let traction = [shear.x, shear.y, self.frame.pressure[row]];
                LoadedCell { low: end(0), high: end(1), traction }
            })
            .collect()
    }

    /// The stress on the axis of a half-space under the run's tractions, at depths (m).
    pub(crate) fn half_space(&self, body: u8, depths: &[f64]) -> Vec<[f64; 6]> {
        let plane = self.basis.case.as_ref().and_then(|case| value_at(case, "mesh.plane_strain"));
        let plane = plane.and_then(toml::Value::as_bool).unwrap_or(false);
        let (cells, nu) = (self.loaded(body, plane), self.poisson[usize::from(body)]);
        let below = if plane { plane_stress_below } else { stress_below };
        let at = |depth: &f64| {
            let [xx, yy, zz, xy, yz, xz] = below(&cells, [0.0, 0.0, *depth], nu);
            let turned = Self::inward(body);
            [xx, yy, zz, xy, turned * yz, turned * xz]
        };
        depths.iter().map(at).collect()
    }

    /// The stress on the axis of a half-space under Hertz's pressure, at depths (m); `None` where his patch is not known.
    pub(crate) fn hertz(&self, body: u8, depths: &[f64]) -> Option<Vec<[f64; 6]>> {
        let half_width = match self.basis.shape {
            PatchShape::Ellipse => Some(self.basis.hertz("half_width")?),
            PatchShape::Rectangle => None,
        };
        let pressure = Ellipse {
            half_length: self.basis.hertz("half_length")?,
            half_width,
            peak_pressure: self.basis.hertz("peak_pressure")?,
        };
        let nu = self.poisson[usize::from(body)];
        Some(depths.iter().map(|depth| pressure.stress_below_centre(*depth, nu)).collect())
    }

    /// The profile of a body.
    pub(crate) fn profile(&self, body: u8) -> StressProfile {
        let (depth, elements) = self.on_axis(body);
        StressProfile {
            body: body_name(body).into(),
            time: self.time,
            contact_time: self.frame.time,
            x: self.axis[0],
            half_length: self.basis.hertz("half_length"),
            peak_pressure: self.basis.hertz("peak_pressure"),
            elements: Stresses::of(&elements),
            half_space: Stresses::of(&self.half_space(body, &depth)),
            hertz: self.hertz(body, &depth).map(|all| Stresses::of(&all)),
            depth,
        }
    }
}

/// The stress over the depth on the axis of the patch: of the disk and of the bar, at the last record of the bodies.
///
/// # Errors
/// Files that cannot be read; a run that has not written the stress tensor, or whose bodies do not touch then.
pub fn stress_profiles(
    paths: &RunPaths,
    basis: &mut Basis,
) -> Result<[StressProfile; 2], PostError> {
    let history = ContactHistory::open(&paths.contact)?;
    let scales = Scales::resolve(basis, &history, &(0..history.times.len()))?;
    let below = Below::read(paths, &history, basis, &scales)?.ok_or_else(|| PostError::Lacks {
        path: paths.folder.clone(),
        what: "no stress below a patch: a run writes it with output.stress = true, and where its bodies touch \
               at the last record of fields.vtkhdf"
            .into(),
    })?;
    Ok([0, 1].map(|body| below.profile(body)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_shear_of_a_parabola_is_its_apex() {
        let depth = vec![0.5, 1.5, 2.5, 4.0];
        let shear = |z: f64| 7.0 - 2.0 * (z - 1.8) * (z - 1.8);
        let elements = Stresses {
            max_shear: depth.iter().map(|z| shear(*z)).collect(),
            ..Stresses::default()
        };
        let profile = StressProfile { depth, elements, ..StressProfile::default() };
        let [z, value] = profile.greatest_shear();
        assert!((z - 1.8).abs() < 1e-12 && (value - 7.0).abs() < 1e-12, "{z} {value}");
    }
}
