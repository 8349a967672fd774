//! Import of contact histories of other codes from CSV into the layout of `contact.vtkhdf`.

use std::io::Read;
use std::path::{Path, PathBuf};

use output::files::input;
use output::layout::{CONSTANT, CONTACT, HISTORY, file};
use output::{
    Cells, FieldSpec, GridSpec, OutputError, Provenance, StaticField, TransientGrid, Values,
};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The tables to read, and the file to write.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ImportContactOptions {
    /// Nodes, one a row: x, y, z (m) and, if wanted, area (m2); the first row is node 0
    #[cfg_attr(feature = "clap", arg(long, value_name = "NODES.csv"))]
    pub nodes: PathBuf,
    /// Faces, one a row: n0, n1, n2, n3 (counter-clockwise seen from outside) and body (0 disk,
    /// 1 bar)
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACES.csv"))]
    pub faces: PathBuf,
    /// Values, one row per time and node, times rising: time, node, pressure, shear_x, shear_y,
    /// shear_z, slip_velocity_x, ..., and, if wanted, gap, mu, state, velocity_x, ...,
    /// displacement_x, ...; nodes without a row are open
    #[cfg_attr(feature = "clap", arg(long, value_name = "VALUES.csv"))]
    pub values: PathBuf,
    /// The file to write
    #[serde(default = "contact_file")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.vtkhdf", default_value = file::CONTACT))]
    pub out: PathBuf,
}

fn contact_file() -> PathBuf {
    file::CONTACT.into()
}

/// The size of an imported history.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Imported {
    /// Number of nodes.
    pub nodes: usize,
    /// Number of faces.
    pub faces: usize,
    /// Number of records written, one per time.
    pub steps: usize,
    /// Number of rows of values read.
    pub rows: usize,
}

/// Why tables cannot be imported.
#[derive(Debug, Error)]
pub enum ImportError {
    /// A table that cannot be read, or a line of it that is wrong.
    #[error("{}: {problem}", path.display())]
    Input {
        /// The table.
        path: PathBuf,
        /// What is wrong, with the line.
        problem: String,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Fields of the layout, and whether they are required.
static FIELDS: [(&FieldSpec, bool); 8] = [
    (&CONTACT.pressure, true),
    (&CONTACT.shear, true),
    (&CONTACT.slip_velocity, true),
    (&CONTACT.gap, false),
    (&CONTACT.mu, false),
    (&CONTACT.state, false),
    (&CONTACT.velocity, false),
    (&CONTACT.displacement, false),
];

/// Reads the tables and writes the history, replacing a file that is there.
///
/// # Errors
/// A table that cannot be read, lacks a column, or has a value that is no number, a node or body that does not
/// exist, or a time that falls; a file that cannot be written.
pub fn import_contact(files: &ImportContactOptions) -> Result<Imported, ImportError> {
    let mut nodes = Table::open(&files.nodes)?;
    let place = nodes.columns(&["x", "y", "z"])?;
    let area_column = nodes.column(&CONSTANT.area.name);
    let (mut points, mut areas) = (Vec::new(), Vec::new());
    while let Some(row) = nodes.next()? {
        points.push([row[place[0]], row[place[1]], row[place[2]]]);
        areas.extend(area_column.map(|column| row[column]));
    }
    let mut table = Table::open(&files.faces)?;
    let corners = table.columns(&["n0", "n1", "n2", "n3"])?;
    let body_column = table.columns(&[&CONSTANT.body.name])?[0];
    let (mut faces, mut body) = (Vec::new(), Vec::new());
    while let Some(row) = table.next()? {
        let mut face = [0; 4];
        for (node, &column) in face.iter_mut().zip(&corners) {
            *node = table.index(row[column], points.len(), "node")? as u32;
        }
        faces.push(face);
        body.push(table.index(row[body_column], 2, "body")? as u8);
    }
    let (steps, rows) = values(files, &points, &areas, &faces, &body)?;
    Ok(Imported { nodes: points.len(), faces: faces.len(), steps, rows })
}

/// Reads the values time by time and writes each record as soon as it is complete.
fn values(
    files: &ImportContactOptions,
    points: &[[f64; 3]],
    areas: &[f64],
    faces: &[[u32; 4]],
    body: &[u8],
) -> Result<(usize, usize), ImportError> {
    let mut table = Table::open(&files.values)?;
    let key = table.columns(&[&HISTORY.time.name, "node"])?;
    let mut fields = Vec::new();
    for (field, needed) in FIELDS {
        let names: Vec<String> = match field.components {
            1 => vec![field.name.to_string()],
            _ => ["x", "y", "z"].iter().map(|axis| format!("{}_{axis}", field.name)).collect(),
        };
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        if needed || table.column(names[0]).is_some() {
            fields.push((field.clone(), table.columns(&names)?));
        }
    }
    let specs: Vec<FieldSpec> = fields.iter().map(|(spec, _)| spec.clone()).collect();
    let mut constant = vec![StaticField::body(body)];
    if !areas.is_empty() {
        constant.push(StaticField::area(areas));
    }
    let grid = GridSpec { points, cells: Cells::Quads(faces), constant: &constant };
    let mut file = TransientGrid::create(&files.out, &grid, &specs, &imported())?;
    let mut record = Record::new(points.len(), &specs);
    let mut time: Option<f64> = None;
    let mut rows = 0;
    while let Some(row) = table.next()? {
        let at = row[key[0]];
        match time {
            Some(now) if at < now => {
                return Err(table.refuse(format!("the time falls from {now:e} to {at:e} s")));
            }
            Some(now) if at > now => record.write(&mut file, now)?,
            _ => {}
        }
        time = Some(at);
        let node = table.index(row[key[1]], points.len(), "node")?;
        if std::mem::replace(&mut record.given[node], true) {
            return Err(table.refuse(format!("node {node} stands twice at {at:e} s")));
        }
        for (column, (spec, places)) in record.columns.iter_mut().zip(&fields) {
            if spec.integer {
                table.index(row[places[0]], STATES, "state")?;
            }
            for (component, &place) in places.iter().enumerate() {
                column[node * places.len() + component] = row[place];
            }
        }
        rows += 1;
    }
    if let Some(now) = time {
        record.write(&mut file, now)?;
    }
    Ok((file.steps(), rows))
}

/// The origin of a file that is of another code.
pub(super) fn imported() -> Provenance {
    Provenance {
        creepage_version: env!("CARGO_PKG_VERSION").into(),
        case_hash: "imported".into(),
        created: "imported".into(),
        attributes: Vec::new(),
    }
}

/// States of a node: open, stick, slip.
const STATES: usize = 3;

/// The values of one time, field by field.
struct Record {
    /// Which nodes have values.
    given: Vec<bool>,
    columns: Vec<Vec<f64>>,
    components: Vec<usize>,
    integer: Vec<bool>,
}

impl Record {
    fn new(nodes: usize, specs: &[FieldSpec]) -> Self {
        Self {
            given: vec![false; nodes],
            columns: specs.iter().map(|spec| vec![0.0; nodes * spec.components]).collect(),
            components: specs.iter().map(|spec| spec.components).collect(),
            integer: specs.iter().map(|spec| spec.integer).collect(),
        }
    }

    fn write(&mut self, file: &mut TransientGrid, time: f64) -> Result<(), ImportError> {
        let states: Vec<Vec<u8>> = self
            .columns
            .iter()
            .zip(&self.integer)
            .map(|(column, integer)| {
                let small = column.iter().filter(|_| *integer);
                small.map(|value| *value as u8).collect()
            })
            .collect();
        let values: Vec<Values<'_>> = (0..self.columns.len())
            .map(|i| match (self.integer[i], self.components[i]) {
                (true, _) => Values::Integer(&states[i]),
                (false, 3) => Values::Vector(self.columns[i].as_chunks().0),
                _ => Values::Scalar(&self.columns[i]),
            })
            .collect();
        file.append(time, &values)?;
        self.columns.iter_mut().for_each(|column| column.fill(0.0));
        self.given.fill(false);
        Ok(())
    }
}

/// A table of numbers with named columns, read row by row.
struct Table {
    path: PathBuf,
    names: Vec<String>,
    rows: csv::StringRecordsIntoIter<Box<dyn Read>>,
    line: u64,
}

impl Table {
    fn open(path: &Path) -> Result<Self, ImportError> {
        let failed = |cause: String| bad_input(path, &cause);
        let file = input::open(path, input::CONTACT_TABLE);
        let file = file.map_err(|error| failed(error.problem()))?;
        let file: Box<dyn Read> = Box::new(input::by_line(file));
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(file);
        let names = reader.byte_headers().map_err(|error| failed(error.to_string()))?;
        let names = names.iter().map(|name| input::decoded(name).into_owned()).collect();
        Ok(Self { path: path.into(), names, rows: reader.into_records(), line: 1 })
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    fn columns(&self, names: &[&str]) -> Result<Vec<usize>, ImportError> {
        let find = |name: &&str| {
            self.column(name).ok_or_else(|| {
                let known = self.names.join(", ");
                bad_input(&self.path, &format!("there is no column {name:?}; it has {known}"))
            })
        };
        names.iter().map(find).collect()
    }

    fn next(&mut self) -> Result<Option<Vec<f64>>, ImportError> {
        let Some(row) = self.rows.next() else {
            return Ok(None);
        };
        let row = row.map_err(|error| bad_input(&self.path, &error.to_string()))?;
        self.line = row.position().map_or(self.line, csv::Position::line);
        let number = |text: &str| match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.refuse(format!("{text:?} is no number"))),
        };
        row.iter().map(number).collect::<Result<_, _>>().map(Some)
    }

    /// A number that counts something, below `end`.
    fn index(&self, value: f64, end: usize, what: &str) -> Result<usize, ImportError> {
        if value >= 0.0 && value < end as f64 && value.fract() == 0.0 {
            return Ok(value as usize);
        }
        let known = match end.checked_sub(1) {
            Some(last) => format!("they are 0 to {last}"),
            None => "there are none at all".into(),
        };
        Err(self.refuse(format!("there is no {what} {value}; {known}")))
    }

    fn refuse(&self, problem: String) -> ImportError {
        bad_input(&self.path, &format!("line {}: {problem}", self.line))
    }
}

fn bad_input(path: &Path, problem: &str) -> ImportError {
    ImportError::Input { path: path.into(), problem: problem.into() }
}
