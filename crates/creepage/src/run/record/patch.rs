//! Measures of the patch on the bar.

use super::images::{Images, mirrored};
use super::row::PatchMeasures;
use super::surfaces::Surfaces;
use crate::case::hertz::patch_shape;
use crate::case::schema::Case;
use crate::scenario::{BAR, DISK};
use contact::NodalContact;
use contact::patch::{self, PatchShape};
use nalgebra::Vector3;

/// Where the patch is measured, and the scales.
pub(super) struct Patch {
    shape: PatchShape,
    /// Undeformed positions of the bar's nodes (m), and those with their images.
    bar: Vec<Vector3<f64>>,
    whole_bar: Vec<Vector3<f64>>,
    /// Buffer: pressures (Pa) there.
    whole_pressure: Vec<f64>,
    /// Rows of the bar's table on the centre line, by x.
    centreline: Vec<usize>,
    /// Element size (m) where the patch may drift sideways, and its centre line with it.
    drifts: Option<f64>,
    /// Buffer: x (m) of the nodes of the centre line in contact, and whether they stick.
    line: Vec<(f64, bool)>,
    /// How many parts alike make up the bodies, of which one is modelled.
    multiplicity: f64,
    enforced_on: Option<usize>,
    hertz_pressure: f64,
}

impl Patch {
    /// The patch on `surfaces`, of which Hertz gives the peak pressure (Pa).
    pub(super) fn new(
        case: &Case,
        surfaces: &Surfaces<'_>,
        images: &Images,
        hertz_pressure: f64,
    ) -> Self {
        let bar = &surfaces.points[BAR];
        let mut whole_bar = Vec::with_capacity(images.counts()[BAR]);
        images.of_side(BAR, bar, mirrored, &mut whole_bar);
        let size = case.mesh.zone.size;
        let centreline = centreline(bar, 0.0, size);
        let drifts = (!case.is_half_space() && case.drift() > 0.0).then_some(size);
        Self {
            shape: patch_shape(case),
            bar: bar.clone(),
            whole_pressure: Vec::with_capacity(whole_bar.len()),
            whole_bar,
            line: Vec::with_capacity(centreline.len()),
            centreline,
            drifts,
            multiplicity: if surfaces.half { 2.0 } else { 1.0 },
            enforced_on: surfaces.enforced_on,
            hertz_pressure,
        }
    }

    /// The patch by `tables`, with the hub at `hub_x` (m).
    pub(super) fn measure(
        &mut self,
        tables: &[NodalContact; 2],
        images: &Images,
        hub_x: f64,
    ) -> PatchMeasures {
        let bar = &tables[BAR];
        self.whole_pressure.clear();
        images.of_side(BAR, &bar.pressure, |p| p, &mut self.whole_pressure);
        let fit = patch::fit(self.shape, &self.whole_bar, &self.whole_pressure);
        if let (Some(size), Some(fit)) = (self.drifts, &fit) {
            self.centreline = centreline(&self.bar, fit.yc, size);
        }
        let fit = fit.map_or([f64::NAN; 5], |f| [f.a, f.b, f.p0, f.xc - hub_x, f.area]);
        let areas = patch::areas(&bar.pressure, &bar.area, &bar.state);
        PatchMeasures {
            fit,
            areas: patch::PatchAreas { contact: self.multiplicity * areas.contact, ..areas },
            peak_shear: bar.shear.iter().map(|s| s.norm()).fold(0.0, f64::max),
            cone_excess: self.cone_excess(tables),
            stick_border: self.stick_border(bar, hub_x + fit[3]),
        }
    }

    /// Largest (|shear| - mu p) over the Hertz peak pressure, on the surfaces at whose nodes friction is
    /// enforced.
    fn cone_excess(&self, tables: &[NodalContact; 2]) -> f64 {
        let excess = |t: &NodalContact| {
            (0..t.nodes.len())
                .map(|i| (t.shear[i].norm() - t.mu[i] * t.pressure[i]) / self.hertz_pressure)
                .fold(f64::NEG_INFINITY, f64::max)
        };
        let sides =
            [DISK, BAR].into_iter().filter(|side| self.enforced_on.is_none_or(|on| on == *side));
        sides.map(|side| excess(&tables[side])).fold(f64::NEG_INFINITY, f64::max).max(0.0)
    }

    /// Rear end of the longest run of sticking nodes on the bar's centre line, half a spacing
    /// behind its last node, relative to `centre` (m).
    fn stick_border(&mut self, bar: &NodalContact, centre: f64) -> f64 {
        self.line.clear();
        for &i in &self.centreline {
            if bar.pressure[i] > patch::IN_CONTACT * self.hertz_pressure {
                self.line.push((self.bar[i][0], bar.state[i] == 1));
            }
        }
        let (mut best, mut start) = ((0, f64::NAN), None);
        for (k, &(x, sticks)) in self.line.iter().enumerate() {
            if !sticks {
                start = None;
                continue;
            }
            let (first, rear) = *start.get_or_insert_with(|| {
                let behind = if k > 0 { self.line[k - 1].0 } else { x };
                (k, 0.5 * (behind + x))
            });
            if k + 1 - first > best.0 {
                best = (k + 1 - first, rear);
            }
        }
        best.1 - centre
    }
}

/// Nodes of the line along x that lies nearest to `y` (m), in ascending x. Of two lines at the same distance, as on a
/// slice or with an odd number of elements across, the one further along +y.
fn centreline(points: &[Vector3<f64>], y: f64, size: f64) -> Vec<usize> {
    let least = points.iter().map(|x| (x[1] - y).abs()).fold(f64::INFINITY, f64::min);
    let slack = 0.1 * size;
    let near = |i: usize, y: f64| (points[i][1] - y).abs() <= slack;
    let line = if (0..points.len()).any(|i| near(i, y + least)) { y + least } else { y - least };
    let on_it = |&i: &usize| near(i, line);
    let mut line: Vec<usize> = (0..points.len()).filter(on_it).collect();
    line.sort_by(|&i, &j| points[i][0].total_cmp(&points[j][0]));
    line
}
