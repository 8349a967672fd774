//! A fine zone that follows the contact: its moves, and what they would miss of the deformation of the bodies.

use crate::case::hertz::{Hertz, hertz};
use crate::case::schema::Case;
use crate::scenario::error::ScenarioError;
use crate::scenario::model::{BAR, DISK, Model};
use crate::scenario::preload::PreloadError;
use dynamics::{MeshMove, Missed, Window};
use mesh::geometry::adjugate;
use mesh::{Chart, Padded, Source};
use nalgebra::{Matrix2, Vector2};
use solid::Solid;
use statics::{LinearStatics, Problem, StaticsError, Supports};
use std::ops::Range;

/// Residual over the load at which the displacements at rest are accepted.
const TOLERANCE: f64 = 1e-5;

/// Places along a body closer than this (m) are one.
const SLACK: f64 = 1e-9;

/// The moves of a fine zone that follows the contact, by whole columns of it, if it does.
///
/// # Errors
/// A zone whose columns are not alike; displacements at rest that are not found.
pub(super) fn window(
    case: &Case,
    model: &Model,
    solid: &mut Solid,
) -> Result<Option<Window>, ScenarioError> {
    let Some(columns) = case.window_columns() else { return Ok(None) };
    let by = f64::from(columns) * case.mesh.zone.size;
    let radius = case.axle_height();
    let bodies = [(DISK, Chart::Ring { radius }), (BAR, Chart::Straight)]
        .map(|(side, chart)| RolledBody { model, side, chart });
    let sources = bodies.each_ref().map(|body| {
        let place = &model.mesh.bodies[body.side];
        mesh::sources_ahead(&model.mesh, place, body.chart, by, case.mesh.zone.size)
    });
    for (body, sources) in bodies.iter().zip(&sources) {
        body.repeats(sources, case.mesh.zone_along()[1] - by)?;
    }
    let at_rest =
        AtRest::new(model, solid, &bodies, &patch(case), by).map_err(PreloadError::from)?;
    let [of_disk, of_bar] = sources;
    let [disk, bar] = [(&bodies[DISK], of_disk, by / radius), (&bodies[BAR], of_bar, by)].map(
        |(body, sources, by)| {
            let missed = at_rest.missed(body, &sources);
            MeshMove { nodes: body.nodes(), sources, by, missed }
        },
    );
    Ok(Some(Window::new(disk, bar)))
}

/// Hertz's patch; one smaller than an element would hold no node.
fn patch(case: &Case) -> Hertz {
    let (patch, size) = (hertz(case), case.mesh.zone.size);
    Hertz { a: patch.a.max(size), b: patch.b.max(size), ..patch }
}

/// Coordinates of a body: along its surface, and outward from it.
const ALONG: usize = 0;
const OUTWARD: usize = 2;

/// A body that contact rolls over.
struct RolledBody<'a> {
    model: &'a Model,
    side: usize,
    chart: Chart,
}

impl RolledBody<'_> {
    fn nodes(&self) -> Range<usize> {
        self.model.mesh.bodies[self.side].nodes.clone()
    }

    /// Refuses a fine zone of which not every node up to `front` (m) takes over the motion of another.
    fn repeats(&self, sources: &[Source], front: f64) -> Result<(), ScenarioError> {
        let first = self.nodes().start;
        let repeats = |&n: &u32| {
            let n = n as usize;
            let along = self.chart.of(self.model.mesh.nodes[n]).x;
            along > front + SLACK || matches!(sources[n - first], Source::Node(_))
        };
        let zone = &self.model.zones[self.side];
        if zone.iter().flat_map(|face| &face.nodes).all(repeats) {
            return Ok(());
        }
        let body = self.model.mesh.bodies[self.side].name.clone();
        Err(ScenarioError::Pattern { body })
    }

    /// Adds one newton in a `direction` to the `load`, spread over the surface as the pressure of Hertz's `patch` with its
    /// centre `at` (m) along the body.
    fn press(&self, at: f64, direction: usize, patch: &Hertz, load: &mut [Padded]) {
        let nodes = &self.model.mesh.nodes;
        let mut weights = Vec::new();
        for face in &self.model.zones[self.side] {
            let areas = mesh::quad_corner_areas(&face.nodes.map(|n| nodes[n as usize]));
            for (&n, area) in face.nodes.iter().zip(areas) {
                let q = self.chart.of(nodes[n as usize]);
                let inside = 1.0 - ((q.x - at) / patch.a).powi(2) - (q.y / patch.b).powi(2);
                weights.push((n as usize, area * inside.max(0.0).sqrt()));
            }
        }
        let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
        for (n, weight) in weights {
            load[n] += weight / total * self.chart.directions(nodes[n]).column(direction);
        }
    }

    /// Adds the centrifugal force (N) at one radian per second to the `load`.
    fn spin(&self, load: &mut [Padded]) {
        for n in self.nodes() {
            let place = self.model.mesh.nodes[n];
            let distance = self.chart.of(place)[OUTWARD];
            let outward = self.chart.directions(place);
            load[n] += self.model.mass[n] * distance * outward.column(OUTWARD);
        }
    }

    /// Components of a vector at a node along the coordinates of the body.
    fn components(&self, n: usize, v: Padded) -> Padded {
        self.chart.directions(self.model.mesh.nodes[n]).tr_mul(&v.vector()).into()
    }
}

/// A load (N) and the displacements (m) of the bodies at rest under it, of all nodes.
struct Response {
    load: Vec<Padded>,
    displacement: Vec<Padded>,
}

/// The bodies at rest under unit loads.
struct AtRest {
    /// One newton along the surface and one outward, where contact is before a move.
    before: [Response; 2],
    /// The same, where contact is after it.
    after: [Response; 2],
    /// Displacements under the centrifugal force of the disk at one radian per second.
    spinning: Vec<Padded>,
}

impl AtRest {
    /// Of bodies whose mesh moves `by` (m) when the middle of contact's `patch` is half of that ahead of the middle of the zone.
    fn new(
        model: &Model,
        solid: &mut Solid,
        bodies: &[RolledBody<'_>; 2],
        patch: &Hertz,
        by: f64,
    ) -> Result<Self, StaticsError> {
        let mut held = model.clamped.clone();
        held.extend(&model.hub);
        let supports = Supports { held, tied: Vec::new(), sliding: model.sliding.clone() };
        let problem = Problem {
            mesh: &model.mesh,
            supports: &supports,
            spin: None,
            tolerance: TOLERANCE,
            max_iterations: 1,
        };
        let mut statics = LinearStatics::new(solid, &problem)?;
        let no_load = vec![Padded::ZERO; model.mesh.nodes.len()];
        let mut pressed = |at: f64, direction: usize| {
            let mut load = no_load.clone();
            bodies.iter().for_each(|body| body.press(at, direction, patch, &mut load));
            let displacement = statics.displacement(&load)?;
            Ok::<_, StaticsError>(Response { load, displacement })
        };
        let before = [pressed(0.5 * by, ALONG)?, pressed(0.5 * by, OUTWARD)?];
        let after = [pressed(-0.5 * by, ALONG)?, pressed(-0.5 * by, OUTWARD)?];
        let mut load = no_load;
        bodies[DISK].spin(&mut load);
        Ok(Self { before, after, spinning: statics.displacement(&load)? })
    }

    /// What `sources` of the nodes of a body miss of these displacements.
    fn missed(&self, body: &RolledBody<'_>, sources: &[Source]) -> Missed {
        let [along, outward] = &self.before;
        let under = |before: &[Padded], steady: Option<&[Padded]>| {
            let after = self.after_move(body, before, steady);
            let missed = |(n, source): (usize, &Source)| {
                let carried = source.of(|m| body.components(m as usize, before[m as usize]));
                let wanted = body.components(n, after(n));
                Padded::from(wanted.vector() - carried.vector())
            };
            body.nodes().zip(sources).map(missed).collect()
        };
        Missed {
            along: under(&along.displacement, None),
            outward: under(&outward.displacement, None),
            centrifugal: under(&self.spinning, Some(&self.spinning)),
        }
    }

    /// The displacements after a move that stand for those `before` it: the `steady` ones, and those of a force of contact that
    /// puts the patch where it was. The same force would not do: the mesh gives way a little differently in the two
    /// places, and the body would slip by the difference at every move.
    fn after_move<'a>(
        &'a self,
        body: &RolledBody<'_>,
        before: &[Padded],
        steady: Option<&'a [Padded]>,
    ) -> impl Fn(usize) -> Padded + 'a {
        // mean displacement of the patch along a unit load, weighted as the load is
        let of_patch = |response: &Response, u: &[Padded]| -> f64 {
            let work = |n: usize| response.load[n].vector().dot(&u[n].vector());
            body.nodes().map(work).sum()
        };
        let missing = Vector2::from_fn(|i, _| {
            let there = steady.map_or(0.0, |u| of_patch(&self.after[i], u));
            of_patch(&self.before[i], before) - there
        });
        let after = &self.after;
        let compliance = Matrix2::from_fn(|i, j| of_patch(&after[i], &after[j].displacement));
        let force = adjugate(&compliance) * missing / compliance.determinant();
        move |n| {
            let steady = steady.map_or(Padded::ZERO, |u| u[n]).vector();
            let [a, b] = after.each_ref().map(|response| response.displacement[n].vector());
            Padded::from(steady + force[0] * a + force[1] * b)
        }
    }
}
