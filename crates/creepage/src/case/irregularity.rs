//! Heights of a running surface over its smooth shape: by a formula, by points or on a grid, which may stand in a file of their own.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use friction::Formula;
use mesh::{HeightGrid, HeightTable, Heights};
use output::files::input;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::Value;

use crate::case::error::CaseError;
use crate::case::layers::Layers;
use crate::case::table::{Columns, Mistake, columns, of_file, width};
use crate::case::value::{listed, points};

/// Most characters of a formula.
const LONGEST_FORMULA: usize = 4000;

/// The keys of heights, their section and name, and over what they are.
const KEYS: [(&str, &str, Coordinate); 2] =
    [("bar", "surface", Coordinate::X), ("disk", "out_of_round", Coordinate::Angle)];

/// The keys of files of heights.
pub(crate) fn file_keys() -> impl Iterator<Item = String> {
    KEYS.iter().map(|(section, name, _)| format!("{section}.{name}.file"))
}

/// The columns of a grid.
const GRID: Columns<3> =
    Columns { what: ["a place x", "a place y", "a height"], units: ["m", "m", "m"] };

/// What the heights of a surface are given over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// x along the bar (m).
    X,
    /// The angle around the disk (rad), which repeats after a turn.
    Angle,
}

/// Heights of a running surface over its smooth shape (m).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceHeights {
    /// Path of a CSV file with two columns, coordinate and height, of a bar also with three, x, y and height. A case that is read has
    /// its points in their place.
    File(String),
    /// Formula over `x` (m) or `angle` (rad, from -pi to pi), and `y` (m).
    Formula(String),
    /// Points (coordinate, height), coordinates rising: linear between them.
    Points(Vec<[f64; 2]>),
    /// Points (x, y, height) of a bar on a rectangular grid, in any order: bilinear between them.
    Grid(Vec<[f64; 3]>),
}

impl SurfaceHeights {
    /// The heights as a function of the coordinate.
    ///
    /// # Errors
    /// Why a formula or points give none.
    pub fn heights(&self, over: Coordinate) -> Result<Arc<dyn Heights>, String> {
        match self {
            Self::File(path) => Err(format!("the file \"{path}\" was not read")),
            Self::Formula(text) => Ok(Arc::new(Written::parse(text, over)?)),
            Self::Points(points) => Ok(Arc::new(over.table(points.clone())?)),
            Self::Grid(points) => Ok(Arc::new(over.grid(points)?)),
        }
    }

    /// Whether they depend on y.
    pub(crate) fn varies_across(&self, over: Coordinate) -> bool {
        match self {
            Self::Formula(text) => Written::parse(text, over).is_ok_and(|it| it.formula.uses(1)),
            Self::Grid(_) => true,
            Self::File(_) | Self::Points(_) => false,
        }
    }
}

impl Coordinate {
    /// What a value may be, as a noun phrase.
    pub(crate) fn allowed(self) -> String {
        let name = self.name();
        let [columns, grid] = match self {
            Self::X => ["two or three columns", ", or { grid = [[x, y, height], ...] }"],
            Self::Angle => ["two columns", ""],
        };
        format!(
            "{{ formula = \"...\" }} over {name} and y, {{ file = \"...\" }} of {columns}, or {{ points = [[{name}, height], ...] \
             }}{grid}, heights at most {} m",
            mesh::HIGHEST
        )
    }

    /// Its name in a formula.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Angle => "angle",
        }
    }

    fn columns(self) -> Columns<2> {
        match self {
            Self::X => Columns { what: ["a place x", "a height"], units: ["m", "m"] },
            Self::Angle => Columns { what: ["an angle", "a height"], units: ["rad", "m"] },
        }
    }

    /// Points as heights.
    pub(crate) fn table(self, points: Vec<[f64; 2]>) -> Result<HeightTable, String> {
        self.checked(points).map_err(|error| error.to_string())
    }

    fn checked(self, points: Vec<[f64; 2]>) -> Result<HeightTable, mesh::HeightError> {
        match self {
            Self::X => HeightTable::along(points),
            Self::Angle => HeightTable::around(points),
        }
    }

    /// Points on a grid as heights.
    fn grid(self, points: &[[f64; 3]]) -> Result<HeightGrid, String> {
        match self {
            Self::X => HeightGrid::new(points).map_err(|error| error.to_string()),
            Self::Angle => Err("heights around the disk depend on the angle alone".into()),
        }
    }

    /// The points in the text of a file: the name of the key that holds them, and its value.
    fn read(self, text: &str) -> Result<(&'static str, Value), Mistake> {
        let mistake = |e: mesh::HeightError, lines: &[usize]| {
            Mistake::of_point(e.number(), lines, e.to_string())
        };
        if self == Self::X && width(text) == Some(3) {
            let (points, lines) = columns(text, &GRID)?;
            HeightGrid::new(&points).map_err(|e| mistake(e, &lines))?;
            return Ok(("grid", listed(&points)));
        }
        let (points, lines) = columns(text, &self.columns())?;
        self.checked(points.clone()).map_err(|e| mistake(e, &lines))?;
        Ok(("points", listed(&points)))
    }
}

/// Heights by a formula.
#[derive(Clone, Debug)]
struct Written {
    formula: Formula,
    over: Coordinate,
}

impl Written {
    fn parse(text: &str, over: Coordinate) -> Result<Self, String> {
        let length = text.chars().count();
        if length > LONGEST_FORMULA {
            return Err(format!(
                "the formula has {length} characters, more than {LONGEST_FORMULA}"
            ));
        }
        let names = match over {
            Coordinate::X => "x, the place along the bar in m, y, that across it in m, pi",
            Coordinate::Angle => {
                "angle, the angle around the disk in rad, y, the place across it in m, pi"
            }
        };
        let formula = Formula::parse(text, &[over.name(), "y", "pi"], names);
        Ok(Self { formula: formula.map_err(|error| error.to_string())?, over })
    }
}

impl Heights for Written {
    fn at(&self, coordinate: f64, y: f64) -> f64 {
        let within = match self.over {
            Coordinate::X => coordinate,
            Coordinate::Angle => coordinate - TAU * ((coordinate + PI) / TAU).floor(),
        };
        self.formula.value([within, y, PI])
    }
}

/// Whether a value is a formula, points or a grid, right or wrong.
pub(crate) fn is_written(value: &Value) -> bool {
    let Some(table) = value.as_table().filter(|table| table.len() == 1) else { return false };
    table.get("formula").is_some_and(Value::is_str)
        || table.get("points").and_then(points::<2>).is_some()
        || table.get("grid").and_then(points::<3>).is_some()
}

/// Why a formula, points or a grid give no heights, if they do not.
pub(crate) fn mistake(value: &Value, over: Coordinate) -> Option<String> {
    let given: SurfaceHeights = value.clone().try_into().ok()?;
    given.heights(over).err()
}

/// Replaces the path in `bar.surface` and `disk.out_of_round` by the points of that file. The path is relative to the case file
/// that holds it; of an option, to the working directory.
///
/// # Errors
/// A file that cannot be read, or gives no heights.
pub fn inline(layers: &mut Layers) -> Result<(), CaseError> {
    for (key, (section, name, over)) in file_keys().zip(KEYS) {
        let remedy = format!(
            "two columns: {}, rising, and height{}, with a comma between and decimal points; in {} and m without a unit, \
             or in the units that a heading names: `{} ({}), height (um)`",
            over.name(),
            if over == Coordinate::X { ", or three: x, y and height on a grid" } else { "" },
            over.columns().units[0],
            over.name(),
            if over == Coordinate::X { "mm" } else { "deg" }
        );
        let read = |text: &str| over.read(text);
        let points = of_file(layers, &key, input::HEIGHTS, &remedy, read)?;
        let section = layers.table.get_mut(section).and_then(Value::as_table_mut);
        let given = section.and_then(|section| section.get_mut(name)?.as_table_mut());
        // a second entry beside the file is refused where the key is checked
        if let (Some((name, points)), Some(given)) =
            (points, given.filter(|given| given.len() == 1))
        {
            given.clear();
            given.insert(name.into(), points);
        }
    }
    Ok(())
}
