//! Maps of the patch at one instant, as CONTACT draws them: tractions, slip velocity, stick and slip, and the
//! coefficient of friction.

use super::caption::caption;
use super::maps::{SEAM, seamless, speeds, state_colour, states};
use super::scene::{Instant, Scene, time_label};
use crate::chart::{Axis, Cell, Draw, Figure, Fill, Key, Panel, Scale, Series, colour};
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};

/// Most arrows along the patch.
const ARROWS: f64 = 16.0;
/// Arrows shorter than this share of the longest are left out.
const SHORTEST: f64 = 0.05;
/// Cells across Hertz's ellipse.
const FINE: usize = 60;

/// A node in contact.
struct Node {
    row: usize,
    /// x from the patch's centre, and y (mm).
    at: [f64; 2],
    /// Lower and upper corner of its cell (mm).
    cell: [[f64; 2]; 2],
}

/// The nodes in contact at an instant, on the body that is drawn.
pub(super) struct Patch<'a> {
    scene: &'a Scene<'a>,
    instant: &'a Instant,
    nodes: Vec<Node>,
}

/// The maps at the last instant. `None` where the surface has fewer than three lines of nodes along x, as in plane
/// strain, and where nothing is in contact.
pub(super) fn maps(scene: &Scene<'_>) -> Option<Figure> {
    let patch = Patch::of(scene, scene.instants.last()?)?;
    let frame = &patch.instant.frame;
    let largest = patch.nodes.iter().map(|node| frame.pressure[node.row]).fold(0.0, f64::max);
    let top = largest.max(scene.hertz("peak_pressure").unwrap_or(0.0));
    let pressure = values("p_{n} (MPa)", [0.0, 1e-6 * top]);
    let body = crate::check::surface::body_name(scene.body);
    let mut panels = vec![patch.map("Pressure", &pressure, |row| 1e-6 * frame.pressure[row])];
    let by_hertz = hertz(scene, &pressure).map(|panel| patch.panel(panel));
    let beside = if by_hertz.is_some() {
        " The pressure stands beside that of half-spaces by Hertz."
    } else {
        ""
    };
    panels.extend(by_hertz);
    panels.push(patch.vectors(&format!("Shear on the {body}"), "p_{f} (MPa)", 1e-6, &frame.shear));
    panels.push(patch.slip(&format!("Slip velocity of the {body}")));
    panels.extend(patch.states());
    panels.extend(patch.friction());
    let text = format!(
        "The patch at {}; rolling is to the right.{beside} Arrows are in proportion to the shear and to the slip \
         velocity; the black line is the border of contact.",
        time_label(patch.instant)
    );
    let rows = panels.len().div_ceil(3) as u32;
    Some(Figure {
        size: [1080, 300 * rows + 66],
        columns: 3,
        panels,
        caption: caption(scene, &text),
    })
}

fn values(label: &str, range: [f64; 2]) -> Key {
    Key::Values { label: label.into(), range, scale: Scale::Linear }
}

impl<'a> Patch<'a> {
    fn of(scene: &'a Scene<'a>, instant: &'a Instant) -> Option<Self> {
        let surface = &scene.history.surface;
        let rows = || (0..surface.points.len()).filter(|row| surface.body[*row] == scene.body);
        let line = |row: usize| (surface.points[row][1] / (0.5 * scene.scales.size)).round() as i64;
        let lines: BTreeSet<i64> = rows().map(line).collect();
        let nodes: Vec<Node> = rows()
            .filter(|row| scene.in_contact(&instant.frame, *row))
            .map(|row| {
                let x = scene.position(&instant.frame, row);
                let at = [1e3 * (x[0] - instant.centre), 1e3 * x[1]];
                Node { row, at, cell: scene.cell(instant, row) }
            })
            .collect();
        (lines.len() > 2 && !nodes.is_empty()).then_some(Self { scene, instant, nodes })
    }

    /// The range of all maps (mm).
    fn panel(&self, panel: Panel) -> Panel {
        let [width, height] = self.scene.map_ends(self.nodes.iter().map(|node| node.cell));
        let x = Axis::linear("x from the patch's centre (mm)").over(-width, width);
        Panel { x, y: Axis::linear("y (mm)").over(-height, height), to_scale: true, ..panel }
    }

    /// A map with the border of contact; a node without a colour is left blank.
    fn cells(&self, title: &str, key: &Key, colour_of: impl Fn(usize) -> Option<[u8; 3]>) -> Panel {
        let cell = |node: &Node| {
            let [low, high] = seamless(node.cell);
            Some(Cell { low, high, colour: colour_of(node.row)? })
        };
        let cells = self.nodes.iter().filter_map(cell).collect();
        self.panel(Panel {
            title: title.into(),
            fill: Some(Fill { cells, key: key.clone() }),
            series: vec![line(self.border())],
            ..Panel::new(Axis::linear(""), Axis::linear(""))
        })
    }

    /// A map of a value, blank where it is not a number.
    fn map(&self, title: &str, key: &Key, value: impl Fn(usize) -> f64) -> Panel {
        self.cells(title, key, |row| {
            Some(value(row)).filter(|v| v.is_finite()).map(|v| key.colour(v))
        })
    }

    /// The magnitude of a vector field, `factor` times, with arrows.
    fn vectors(&self, title: &str, label: &str, factor: f64, field: &[Vector3<f64>]) -> Panel {
        let size = |row: usize| factor * field[row].norm();
        let largest = self.nodes.iter().map(|node| size(node.row)).fold(0.0, f64::max);
        let key = values(label, [0.0, if largest > 0.0 { largest } else { 1.0 }]);
        let mut panel = self.map(title, &key, size);
        panel.series.push(self.arrows(field));
        panel
    }

    fn slip(&self, title: &str) -> Panel {
        let field = &self.instant.frame.slip_velocity;
        let key = speeds(self.nodes.iter().map(|node| field[node.row].norm()));
        let mut panel = self.map(title, &key, |row| field[row].norm());
        panel.series.push(self.arrows(field));
        panel
    }

    fn states(&self) -> Option<Panel> {
        let states_of = self.instant.frame.state.as_ref()?;
        let colour_of =
            |row: usize| Some(states_of[row]).filter(|s| *s > 0).map(|s| state_colour(Some(s)));
        Some(self.cells("Stick and slip", &states(), colour_of))
    }

    /// The coefficient that the algorithm used, else that of the law at the slip speed.
    fn friction(&self) -> Option<Panel> {
        let frame = &self.instant.frame;
        let law = self.scene.basis.law;
        if frame.mu.is_none() && law.is_none() {
            return None;
        }
        let mu = |row: usize| match (&frame.mu, law) {
            (Some(mu), _) => mu[row],
            (None, Some(law)) => law.mu(frame.slip_velocity[row].norm()),
            (None, None) => f64::NAN,
        };
        let ends = self.nodes.iter().map(|node| mu(node.row)).filter(|mu| mu.is_finite());
        let [low, high] = ends
            .fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], mu| [low.min(mu), high.max(mu)]);
        let range = match (low < 0.98 * high, high > 0.0) {
            (true, _) => [low, high],
            (false, true) => [0.0, high],
            (false, false) => [0.0, 1.0],
        };
        let title = if frame.mu.is_some() {
            "Coefficient of friction"
        } else {
            "Coefficient of friction by the law"
        };
        Some(self.map(title, &values("\u{3bc} (-)", range), mu))
    }

    /// Arrows in proportion to a vector field, with their middle at nodes that are far enough from each other.
    fn arrows(&self, field: &[Vector3<f64>]) -> Series {
        let apart = (2e3 * self.scene.reach() / ARROWS).max(1e3 * self.scene.scales.size);
        let cell = |node: &Node| node.at.map(|x| (x / apart).round() as i64);
        let off = |node: &Node| -> f64 {
            (0..2).map(|i| (node.at[i] / apart - (node.at[i] / apart).round()).powi(2)).sum()
        };
        let mut shown = BTreeMap::<[i64; 2], &Node>::new();
        for node in &self.nodes {
            let place = shown.entry(cell(node)).or_insert(node);
            if off(node) < off(place) {
                *place = node;
            }
        }
        let along = |node: &Node| field[node.row].xy();
        let length = |node: &Node| libm::hypot(along(node)[0], along(node)[1]);
        let longest = shown.values().map(|node| length(node)).fold(0.0, f64::max);
        let long_enough = |node: &&&Node| length(node) > SHORTEST * longest;
        let points = shown.values().filter(long_enough).flat_map(|node| {
            [-0.5, 0.5].map(|end| {
                let by = end * 0.95 * apart / longest;
                [0, 1].map(|i| node.at[i] + by * along(node)[i])
            })
        });
        Series { label: String::new(), points: points.collect(), draw: Draw::Arrows(colour::BLACK) }
    }

    /// The sides of cells at which a node in contact meets one that is not; a point that is not a number ends each.
    fn border(&self) -> Vec<[f64; 2]> {
        let surface = &self.scene.history.surface;
        let node_at: BTreeMap<usize, &Node> =
            self.nodes.iter().map(|node| (node.row, node)).collect();
        let mut met = BTreeSet::new();
        let mut points = Vec::new();
        for face in &surface.faces {
            for i in 0..4 {
                let [a, b] = [face[i] as usize, face[(i + 1) % 4] as usize];
                for [inside, outside] in [[a, b], [b, a]] {
                    let Some(node) = node_at.get(&inside) else { continue };
                    if node_at.contains_key(&outside) || !met.insert([inside, outside]) {
                        continue;
                    }
                    let [from, to] = [inside, outside].map(|row| surface.points[row]);
                    let across = [to[0] - from[0], to[1] - from[1]];
                    points.extend(side(node, across));
                    points.push([f64::NAN; 2]);
                }
            }
        }
        points
    }
}

/// The side of a node's cell that faces the direction `towards`.
fn side(node: &Node, towards: [f64; 2]) -> [[f64; 2]; 2] {
    let axis = usize::from(towards[1].abs() > towards[0].abs());
    let beyond = usize::from(towards[axis] > 0.0);
    node.cell.map(|mut corner| {
        corner[axis] = node.cell[beyond][axis];
        corner
    })
}

fn line(points: Vec<[f64; 2]>) -> Series {
    Series { label: String::new(), points, draw: Draw::Line(colour::BLACK) }
}

/// Hertz's pressure with the border of its ellipse, where a, b and p0 are known apart from the records.
fn hertz(scene: &Scene<'_>, key: &Key) -> Option<Panel> {
    let (a, b) = (1e3 * scene.hertz("half_length")?, 1e3 * scene.hertz("half_width")?);
    let peak = 1e-6 * scene.hertz("peak_pressure")?;
    let step = [2.0 * a / FINE as f64, 2.0 * b / FINE as f64];
    let mut cells = Vec::new();
    for i in 0..FINE {
        for j in 0..FINE {
            let low = [-a + i as f64 * step[0], -b + j as f64 * step[1]];
            let middle = [low[0] + 0.5 * step[0], low[1] + 0.5 * step[1]];
            // half the length of the ellipse at this y
            let half = a * (1.0 - (middle[1] / b).powi(2)).sqrt();
            if low[0] < half && low[0] + step[0] > -half {
                let inside = (1.0 - (middle[0] / a).powi(2) - (middle[1] / b).powi(2)).max(0.0);
                let high = [(low[0] + SEAM * step[0]).min(half), low[1] + SEAM * step[1]];
                let low = [low[0].max(-half), low[1]];
                cells.push(Cell { low, high, colour: key.colour(peak * inside.sqrt()) });
            }
        }
    }
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / 120.0;
    let ellipse = (0..=120).map(|i| [a * libm::cos(angle(i)), b * libm::sin(angle(i))]);
    Some(Panel {
        title: "Pressure by Hertz".into(),
        fill: Some(Fill { cells, key: key.clone() }),
        series: vec![line(ellipse.collect())],
        ..Panel::new(Axis::linear(""), Axis::linear(""))
    })
}
