//! The scene of a run in three dimensions: both bodies and their contact surfaces at some of its records, as data for
//! the page that draws it ([`report`](mod@crate::report)), with a still picture of the last of these records.
//!
//! Each node is placed by the rigid motion of its body and by what is left of its displacement, its deformation, which
//! the page magnifies: bodies stay where they are at that time, and the dents of disk and bar face each other.

mod error;
mod quantity;
mod rigid;
mod source;
mod still;

pub use error::SceneError;
pub(crate) use quantity::Drawable;
pub(crate) use source::{Source, ends};

use crate::chart::Figure;
use crate::check::PostError;
use crate::check::basis::{may_be_run, read_toml};
use crate::check::surface::body_name;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nalgebra::Vector3;
use output::layout::file;
use quantity::Quantity;
use rigid::Rigid;
use serde::{Serialize, Serializer};
use source::Record;
use std::collections::BTreeMap;
use std::path::Path;

/// Most bytes of the records of a scene: a page that holds them, by a third longer, is still opened at once.
const BUDGET: usize = 3_500_000;

/// Side of the view of the contact over the largest extent of the patch, and, without contact, over the diameter of
/// the disk.
const PATCHES: f64 = 2.5;
const DIAMETERS: f64 = 0.07;

/// A scene. As JSON it is what `report/scene/README.md` describes; lengths in m, times in s, values in the unit of their
/// label.
#[derive(Debug, Serialize)]
pub struct Scene {
    /// Title of the case; may be empty.
    title: String,
    /// Whether the bodies are modelled for y >= 0 alone.
    half: bool,
    fields: Vec<Field>,
    meshes: Vec<Mesh>,
    frames: Vec<Snapshot>,
    /// Side of what the view of the contact shows (m).
    span: f64,
    /// What a reader should know of it; may be empty.
    note: String,
    /// The contact at the last record.
    #[serde(skip)]
    pub still: Figure,
}

/// A quantity that colours can show.
#[derive(Debug, Serialize)]
struct Field {
    name: &'static str,
    /// With its unit.
    label: &'static str,
    group: Drawable,
    /// Largest value in all records; the scale begins at 0.
    top: f64,
}

/// The surface of a body, or its contact surface.
#[derive(Debug, Serialize)]
struct Mesh {
    name: String,
    group: Drawable,
    /// Reference positions (m).
    points: Packed<f32>,
    /// Corners of the faces, outward.
    quads: Packed<u32>,
}

/// A record.
#[derive(Debug, Serialize)]
struct Snapshot {
    time: f64,
    /// The middle of the patch; without contact the lowest place of the disk (m).
    centre: Vector3<f64>,
    /// As [`Scene::meshes`].
    meshes: Vec<State>,
}

/// A surface at one time.
#[derive(Debug, Serialize)]
struct State {
    /// Rows of the rigid motion: three numbers of the rotation and one of the shift (m).
    rigid: [f64; 12],
    /// Deformation of each node (m).
    deformation: Packed<f32>,
    values: BTreeMap<&'static str, Packed<f32>>,
    /// Shear traction of each node of a contact surface (MPa).
    #[serde(skip_serializing_if = "Option::is_none")]
    shear_vector: Option<Packed<f32>>,
}

/// Numbers of four bytes, in JSON as base64 of their little-endian bytes.
#[derive(Debug, Default)]
struct Packed<T>(Vec<T>);

/// A number of four bytes.
trait FourBytes: Copy {
    fn bytes(self) -> [u8; 4];
}

impl FourBytes for f32 {
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl FourBytes for u32 {
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl<T: FourBytes> Serialize for Packed<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = self.0.iter().flat_map(|number| number.bytes()).collect();
        serializer.serialize_str(&STANDARD.encode(bytes))
    }
}

impl Packed<f32> {
    fn of(numbers: impl Iterator<Item = f64>) -> Self {
        Self(numbers.map(|number| number as f32).collect())
    }
}

/// The surface of one body in one of the two files of a run.
struct Part {
    body: u8,
    /// Rows of the file that are its nodes.
    rows: Vec<usize>,
    /// Corners of its faces, as rows of the file.
    faces: Vec<[u32; 4]>,
}

/// One of the two files of a run: what of it is shown.
struct ShownFile {
    of: Drawable,
    source: Source,
    quantities: Vec<Quantity>,
    parts: Vec<Part>,
}

impl Scene {
    /// Reads the scene of the run in `folder`.
    ///
    /// # Errors
    /// A case in the place of the folder; files that are not there, have no record, or cannot be read.
    pub fn read(folder: &Path) -> Result<Self, SceneError> {
        may_be_run(folder)?;
        if !folder.is_dir() {
            let reason = "is a file: give the folder of the run".into();
            return Err(PostError::Text { path: folder.into(), reason }.into());
        }
        let mut shown = Vec::new();
        let mut missing = None;
        for of in [Drawable::Bodies, Drawable::Contact] {
            match Source::open(folder, of) {
                Ok(source) => shown.push(ShownFile::new(of, source)),
                Err(error @ (SceneError::NoFile { .. } | SceneError::NoRecord(_))) => {
                    missing = missing.or(Some(error));
                }
                Err(error) => return Err(error),
            }
        }
        match (shown.is_empty(), missing) {
            (true, Some(error)) => Err(error),
            _ => Self::of(folder, &shown),
        }
    }

    fn of(folder: &Path, shown: &[ShownFile]) -> Result<Self, SceneError> {
        let case = read_toml(&folder.join(file::CASE))?.unwrap_or_default();
        let times = &shown[0].source.times;
        let size: usize = shown.iter().map(ShownFile::bytes).sum();
        let taken = spread(times.len(), BUDGET / size.max(1));
        let note = match (taken.len(), times.len()) {
            (all, of) if all == of => String::new(),
            (some, of) => format!("{some} of the {of} records are shown."),
        };
        let mut frames = Vec::new();
        let mut patch: f64 = 0.0;
        let mut last = Vec::new();
        for index in taken {
            let at = |shown: &ShownFile| shown.record(times[index]);
            last = shown.iter().map(at).collect::<Result<Vec<Record>, _>>()?;
            let pressed = shown.iter().zip(&last).find_map(|(shown, record)| shown.patch(record));
            patch = patch.max(pressed.map_or(0.0, |(_, extent)| extent));
            let centre = pressed.map_or(last[0].lowest, |(centre, _)| centre);
            let states = shown.iter().zip(&last).flat_map(|(shown, record)| shown.states(record));
            frames.push(Snapshot { time: times[index], centre, meshes: states.collect() });
        }
        let [low, high] = shown[0].source.heights;
        let span = if patch > 0.0 { PATCHES * patch } else { DIAMETERS * (high - low) };
        let fields: Vec<Field> = shown.iter().flat_map(|shown| shown.fields(&frames)).collect();
        let Some(field) = fields.first() else {
            let what = "it holds no field that can be shown".into();
            return Err(PostError::Lacks { path: shown[0].source.path.clone(), what }.into());
        };
        let centre = frames.last().map_or(Vector3::zeros(), |frame| frame.centre);
        let time = frames.last().map_or(0.0, |frame| frame.time);
        let still = still::still(&shown[0], &last[0], field, still::View { centre, span, time });
        Ok(Self {
            title: case.get("title").and_then(|title| title.as_str()).unwrap_or_default().into(),
            half: shown[0].source.half,
            meshes: shown.iter().flat_map(ShownFile::meshes).collect(),
            fields,
            frames,
            span,
            note,
            still,
        })
    }

    /// The scene as the text of a script element.
    pub fn script(&self) -> String {
        serde_json::to_string(self).unwrap_or_default().replace('<', "\\u003c")
    }
}

impl ShownFile {
    fn new(of: Drawable, source: Source) -> Self {
        let quantities = of.quantities().filter(|quantity| source.shows(*quantity)).collect();
        let mut bodies = source.bodies.clone();
        bodies.sort_unstable();
        bodies.dedup();
        let parts = bodies.into_iter().map(|body| Part::new(of, &source, body)).collect();
        Self { of, source, quantities, parts }
    }

    /// Bytes of a record.
    fn bytes(&self) -> usize {
        let nodes: usize = self.parts.iter().map(|part| part.rows.len()).sum();
        let vectors = if self.of == Drawable::Contact { 2 } else { 1 };
        4 * nodes * (3 * vectors + self.quantities.len())
    }

    /// The record nearest to `time` (s).
    fn record(&self, time: f64) -> Result<Record, SceneError> {
        let times = &self.source.times;
        let off = |index: &usize| (times[*index] - time).abs();
        let nearest = (0..times.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        self.source.record(nearest, &self.quantities)
    }

    /// Middle of the patch, weighted by pressure, and its largest extent (m); `None` where nothing presses.
    fn patch(&self, record: &Record) -> Option<(Vector3<f64>, f64)> {
        let part = self.parts.last()?;
        let pressure = record.values.get(Quantity::Pressure.name())?;
        let total: f64 = part.rows.iter().map(|&row| pressure[row]).sum();
        let peak = part.rows.iter().map(|&row| pressure[row]).fold(0.0, f64::max);
        if total <= 0.0 {
            return None;
        }
        // a hundredth: the edge of the patch may be ragged
        let pressed = || part.rows.iter().filter(|&&row| pressure[row] > 0.01 * peak);
        let middle =
            |sum: Vector3<f64>, &row: &usize| sum + pressure[row] / total * record.placed[row];
        let extent = |axis: usize| {
            let [low, high] = source::ends(pressed().map(|&row| record.placed[row][axis]));
            high - low
        };
        Some((part.rows.iter().fold(Vector3::zeros(), middle), extent(0).max(extent(1))))
    }

    fn fields(&self, frames: &[Snapshot]) -> impl Iterator<Item = Field> {
        let largest = |name: &str| {
            let states = frames.iter().flat_map(|frame| &frame.meshes);
            let values = states.filter_map(|state| state.values.get(name)).flat_map(|all| &all.0);
            values.fold(0.0f32, |most, value| most.max(*value))
        };
        self.quantities.iter().map(move |quantity| Field {
            name: quantity.name(),
            label: quantity.label().0,
            group: self.of,
            top: f64::from(largest(quantity.name())),
        })
    }

    fn meshes(&self) -> impl Iterator<Item = Mesh> {
        self.parts.iter().map(|part| {
            let number = |row: &u32| part.rows.binary_search(&(*row as usize)).unwrap_or(0) as u32;
            let points = part.rows.iter().flat_map(|&row| &self.source.points[row]).copied();
            Mesh {
                name: body_name(part.body).to_owned(),
                group: self.of,
                points: Packed::of(points),
                quads: Packed(part.faces.as_flattened().iter().map(number).collect()),
            }
        })
    }

    fn states(&self, record: &Record) -> impl Iterator<Item = State> {
        self.parts.iter().map(move |part| {
            let rows = &part.rows;
            let before: Vec<Vector3<f64>> =
                rows.iter().map(|&row| self.source.points[row]).collect();
            let rigid = |row: &usize| record.placed[*row] - record.deformation[*row];
            let after: Vec<Vector3<f64>> = rows.iter().map(rigid).collect();
            let values = record
                .values
                .iter()
                .map(|(name, values)| (*name, Packed::of(rows.iter().map(|&row| values[row]))));
            let shear = record.shear.as_ref().map(|shear| {
                Packed::of(rows.iter().flat_map(|&row| &shear[row]).map(|traction| 1e-6 * traction))
            });
            State {
                rigid: Rigid::fit(&before, &after).map(Rigid::rows).unwrap_or_default(),
                deformation: Packed::of(
                    rows.iter().flat_map(|&row| &record.deformation[row]).copied(),
                ),
                values: values.collect(),
                shear_vector: shear,
            }
        })
    }
}

impl Part {
    fn new(of: Drawable, source: &Source, body: u8) -> Self {
        let faces: Vec<[u32; 4]> = match of {
            Drawable::Bodies => source.outside(|cell| source.bodies[cell] == body),
            Drawable::Contact => {
                let cells = source.corners.as_chunks().0.iter().zip(&source.bodies);
                cells.filter(|(_, of)| **of == body).map(|(quad, _)| *quad).collect()
            }
        };
        let mut rows: Vec<usize> = faces.as_flattened().iter().map(|&row| row as usize).collect();
        rows.sort_unstable();
        rows.dedup();
        Self { body, rows, faces }
    }
}

/// At most `most` of `count` indices and at least one, evenly spread, with the last and, of several, the first.
fn spread(count: usize, most: usize) -> Vec<usize> {
    let taken = most.clamp(1, count.max(1));
    let last = count.saturating_sub(1);
    (0..taken).map(|i| if taken == 1 { last } else { i * last / (taken - 1) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_spread_from_the_first_to_the_last() {
        assert_eq!(spread(5, 5), [0, 1, 2, 3, 4]);
        assert_eq!(spread(41, 3), [0, 20, 40]);
        assert_eq!(spread(4, 1), [3]);
        assert_eq!(spread(1, 9), [0]);
        assert_eq!(spread(9, 0), [8]);
    }

    #[test]
    fn numbers_are_packed_with_their_lowest_byte_first() {
        let packed = Packed::of([1.0, -0.5].into_iter());
        assert_eq!(serde_json::to_string(&packed).unwrap(), "\"AACAPwAAAL8=\"");
        assert_eq!(serde_json::to_string(&Packed(vec![258u32])).unwrap(), "\"AgEAAA==\"");
    }
}
