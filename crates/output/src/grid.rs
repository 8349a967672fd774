//! One transient VTKHDF unstructured grid with a mesh that does not change.

use crate::OutputError;
use crate::checksums::{Checksums, Kept};
use crate::field::FieldSpec;
use crate::hdf5::{Appender, Creator, DatasetSpec, Growing, cut_to_go_on, undo};
use crate::layout::{CONSTANT, MESH, STEP_COUNT, STEPS, STEPS_GROUP, data_path, step_path};
use crate::provenance::Provenance;
use std::path::{Path, PathBuf};

/// Connectivity of a grid whose cells all have one shape; point indices from 0.
#[derive(Clone, Copy, Debug)]
pub enum Cells<'a> {
    /// Eight-node hexahedra in the order of `VTK_HEXAHEDRON` (VTK cell type 12).
    Hexahedra(&'a [[u32; 8]]),
    /// Four-node faces, counter-clockwise seen from outside (VTK cell type 9).
    Quads(&'a [[u32; 4]]),
}

impl Cells<'_> {
    fn count(&self) -> usize {
        match self {
            Cells::Hexahedra(cells) => cells.len(),
            Cells::Quads(cells) => cells.len(),
        }
    }

    fn corners(&self) -> usize {
        match self {
            Cells::Hexahedra(_) => 8,
            Cells::Quads(_) => 4,
        }
    }

    fn vtk_type(&self) -> u8 {
        match self {
            Cells::Hexahedra(_) => 12,
            Cells::Quads(_) => 9,
        }
    }

    fn connectivity(&self) -> &[u32] {
        match self {
            Cells::Hexahedra(cells) => cells.as_flattened(),
            Cells::Quads(cells) => cells.as_flattened(),
        }
    }
}

/// Values of one field at every point or every cell of a grid, in the units of its specification.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// One number each.
    Scalar(&'a [f64]),
    /// Components x, y, z.
    Vector(&'a [[f64; 3]]),
    /// Symmetric tensor in VTK's order: xx, yy, zz, xy, yz, xz.
    Tensor(&'a [[f64; 6]]),
    /// One integer from 0 to 255 each (a label or a state).
    Integer(&'a [u8]),
}

impl Values<'_> {
    pub(crate) fn count(&self) -> usize {
        match self {
            Values::Scalar(values) => values.len(),
            Values::Vector(values) => values.len(),
            Values::Tensor(values) => values.len(),
            Values::Integer(values) => values.len(),
        }
    }

    pub(crate) fn components(&self) -> usize {
        match self {
            Values::Scalar(_) | Values::Integer(_) => 1,
            Values::Vector(_) => 3,
            Values::Tensor(_) => 6,
        }
    }

    fn bytes(&self) -> usize {
        let number = if self.is_integer() { size_of::<u8>() } else { size_of::<f64>() };
        self.count() * self.components() * number
    }

    fn is_integer(&self) -> bool {
        matches!(self, Values::Integer(_))
    }
}

/// A field that does not change in time, stored once.
#[derive(Clone, Debug)]
pub struct StaticField<'a> {
    /// Name, units and shape.
    pub spec: FieldSpec,
    /// Its values at every point or cell.
    pub values: Values<'a>,
}

impl<'a> StaticField<'a> {
    /// The field `body`: a label for each cell, 0 disk, 1 bar.
    pub fn body(labels: &'a [u8]) -> Self {
        Self { spec: CONSTANT.body.clone(), values: Values::Integer(labels) }
    }

    /// A set of nodes, one of [`MESH_SETS`](crate::layout::MESH_SETS): 1 for a member, 0 for any other point.
    pub fn set(spec: &FieldSpec, members: &'a [u8]) -> Self {
        Self { spec: spec.clone(), values: Values::Integer(members) }
    }

    /// The field `area`: the tributary area of each point (m2).
    pub fn area(areas: &'a [f64]) -> Self {
        Self { spec: CONSTANT.area.clone(), values: Values::Scalar(areas) }
    }
}

/// The part of a grid that does not change in time.
#[derive(Clone, Debug)]
pub struct GridSpec<'a> {
    /// Reference coordinates (m).
    pub points: &'a [[f64; 3]],
    /// Cells by their points.
    pub cells: Cells<'a>,
    /// Fields stored once, such as `body`.
    pub constant: &'a [StaticField<'a>],
}

/// Writer of one transient VTKHDF file; see the crate's documentation for when it is readable.
#[derive(Debug)]
pub struct TransientGrid {
    path: PathBuf,
    fields: Vec<FieldSpec>,
    constant_names: Vec<(String, bool)>,
    points: usize,
    cells: usize,
    steps: usize,
    sums: Checksums,
}

impl TransientGrid {
    /// Writes mesh, constant fields and metadata to `path` (replacing what is there) and closes it.
    ///
    /// # Errors
    /// An empty grid, a cell with a point that the grid does not have, fields whose names repeat or are not
    /// allowed, values of another shape than their field; a file that cannot be written.
    pub fn create(
        path: impl AsRef<Path>,
        grid: &GridSpec<'_>,
        fields: &[FieldSpec],
        provenance: &Provenance,
    ) -> Result<Self, OutputError> {
        let mut writer = Self::at(path.as_ref(), grid, fields);
        writer.check_grid(grid)?;
        let mut file = Creator::new(&writer.path, provenance)?;
        writer.lay_out_mesh(&mut file, grid)?;
        writer.lay_out_fields(&mut file, grid)?;
        writer.lay_out_steps(&mut file)?;
        file.close(&writer.growing())?;
        writer.sums = Checksums::of_new(&writer.path, writer.names())?;
        Ok(writer)
    }

    /// Continues a file at `path` that was created with the same grid and fields, truncated to the snapshots of
    /// `kept`; [`prove`](crate::verify) says whether it still holds them.
    ///
    /// # Errors
    /// As for [`Self::create`]; a file that has fewer snapshots or is damaged.
    pub fn reopen(
        path: impl AsRef<Path>,
        grid: &GridSpec<'_>,
        fields: &[FieldSpec],
        kept: &Kept,
    ) -> Result<Self, OutputError> {
        let steps = kept.records as usize;
        let mut writer = Self { steps, ..Self::at(path.as_ref(), grid, fields) };
        writer.check_grid(grid)?;
        cut_to_go_on(&writer.path, &writer.growing(), &STEPS_GROUP, STEP_COUNT, steps)?;
        writer.sums = Checksums::of_kept(kept, writer.names());
        Ok(writer)
    }

    /// The extendible datasets, to which a snapshot appends.
    fn growing(&self) -> Vec<Growing> {
        let one = |name: String| Growing { name, rows: 1 };
        let mut all = Vec::new();
        for spec in &self.fields {
            all.push(Growing {
                name: data_path(&spec.name, spec.on_cells),
                rows: self.count(spec.on_cells),
            });
            all.push(one(offset_path(&spec.name, spec.on_cells)));
        }
        for (name, on_cells) in &self.constant_names {
            all.push(one(offset_path(name, *on_cells)));
        }
        all.push(one(step_path(&STEPS.times)));
        all.extend(counts_of_step().map(|(name, _)| one(name)));
        all
    }

    /// Names of the extendible datasets.
    fn names(&self) -> impl Iterator<Item = String> + use<> {
        self.growing().into_iter().map(|dataset| dataset.name)
    }

    fn at(path: &Path, grid: &GridSpec<'_>, fields: &[FieldSpec]) -> Self {
        let name = |field: &StaticField<'_>| (field.spec.name.to_string(), field.spec.on_cells);
        Self {
            path: path.to_owned(),
            fields: fields.to_vec(),
            constant_names: grid.constant.iter().map(name).collect(),
            points: grid.points.len(),
            cells: grid.cells.count(),
            steps: 0,
            sums: Checksums::default(),
        }
    }

    /// Appends the snapshot at `time` (s): `values` in the order of the fields given to [`Self::create`].
    ///
    /// # Errors
    /// Values of another number or shape than the fields; a file that cannot be written or that another process
    /// has changed. The file then still has the snapshots that it had before.
    pub fn append(&mut self, time: f64, values: &[Values<'_>]) -> Result<(), OutputError> {
        self.check_values(values)?;
        // the checksums of the snapshots in the file, to return to should this fail
        let before = self.sums.clone();
        let appended = self.try_append(time, values);
        match appended {
            Ok(()) => self.steps += 1,
            Err(OutputError::Another { .. }) => self.sums = before,
            Err(_) => {
                self.sums = before;
                undo(&self.path, &self.growing(), &STEPS_GROUP, STEP_COUNT, self.steps);
            }
        }
        appended
    }

    fn try_append(&mut self, time: f64, values: &[Values<'_>]) -> Result<(), OutputError> {
        let step = self.steps as i64;
        let mut file = Appender::open(&self.path)?;
        let times = step_path(&STEPS.times);
        file.check_length(&times, self.steps)?;
        file.extend_file(values.iter().map(Values::bytes).sum())?;
        let rows = [self.points, self.cells];
        let Self { fields, constant_names, sums, .. } = self;
        let index = |file: &mut Appender, sums: &mut Checksums, name: &str, number: i64| {
            // far below 2^53, where f64 is exact
            sums.add(name, &[number as f64]);
            file.append(name, &[number])
        };
        for (spec, value) in fields.iter().zip(values) {
            let name = data_path(&spec.name, spec.on_cells);
            match *value {
                Values::Integer(values) => {
                    sums.add_bytes(&name, values);
                    file.append(&name, values)?;
                }
                Values::Scalar(values) => append_reals(&mut file, sums, &name, values)?,
                Values::Vector(values) => {
                    append_reals(&mut file, sums, &name, values.as_flattened())?;
                }
                Values::Tensor(values) => {
                    append_reals(&mut file, sums, &name, values.as_flattened())?;
                }
            }
            let first = step * rows[usize::from(spec.on_cells)] as i64;
            index(&mut file, sums, &offset_path(&spec.name, spec.on_cells), first)?;
        }
        for (name, on_cells) in constant_names {
            index(&mut file, sums, &offset_path(name, *on_cells), 0)?;
        }
        append_reals(&mut file, sums, &times, &[time])?;
        for (name, number) in counts_of_step() {
            index(&mut file, sums, &name, number)?;
        }
        file.close_with_count(&STEPS_GROUP, STEP_COUNT, step + 1)
    }

    /// What a checkpoint keeps of the snapshots written: their number and checksums.
    pub fn kept(&self) -> Kept {
        self.sums.kept(self.steps)
    }

    /// Number of snapshots in the file, those kept from before included.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn count(&self, on_cells: bool) -> usize {
        if on_cells { self.cells } else { self.points }
    }

    fn shape_error(&self, problem: String) -> OutputError {
        OutputError::Shape { path: self.path.clone(), problem }
    }

    fn check_grid(&self, grid: &GridSpec<'_>) -> Result<(), OutputError> {
        if self.points == 0 || self.cells == 0 {
            return Err(self.shape_error(format!(
                "the grid has {} points and {} cells; it needs at least one of each",
                self.points, self.cells
            )));
        }
        if let Some(index) =
            grid.cells.connectivity().iter().find(|&&index| index as usize >= self.points)
        {
            return Err(self.shape_error(format!(
                "a cell names point {index}, but the grid has only {} points (numbered from 0)",
                self.points
            )));
        }
        let constant = grid.constant.iter().map(|field| &field.spec);
        let mut seen = std::collections::BTreeSet::new();
        for spec in constant.chain(&self.fields) {
            if spec.name.is_empty() || spec.name.contains('/') {
                return Err(self.shape_error(format!(
                    "`{}` cannot name a field: use a name that is not empty and has no `/`",
                    spec.name
                )));
            }
            if ![1, 3, 6].contains(&spec.components) || (spec.integer && spec.components != 1) {
                return Err(self.shape_error(format!(
                    "field `{}` has {} components; 1, 3 or 6 numbers or one integer can be written",
                    spec.name, spec.components
                )));
            }
            if !seen.insert((spec.on_cells, &spec.name)) {
                return Err(self.shape_error(format!(
                    "field `{}` is given twice; names must differ",
                    spec.name
                )));
            }
        }
        for field in grid.constant {
            self.check_field(&field.spec, &field.values)?;
        }
        Ok(())
    }

    fn check_values(&self, values: &[Values<'_>]) -> Result<(), OutputError> {
        if values.len() != self.fields.len() {
            return Err(self.shape_error(format!(
                "{} fields handed over, {} expected: pass one per field, in order",
                values.len(),
                self.fields.len()
            )));
        }
        self.fields.iter().zip(values).try_for_each(|(spec, values)| self.check_field(spec, values))
    }

    fn check_field(&self, spec: &FieldSpec, values: &Values<'_>) -> Result<(), OutputError> {
        let count = self.count(spec.on_cells);
        let fits = values.count() == count
            && values.components() == spec.components
            && values.is_integer() == spec.integer;
        if fits {
            return Ok(());
        }
        Err(self.shape_error(format!(
            "field `{}` takes {count} x {} {}, but {} x {} {} were handed over",
            spec.name,
            spec.components,
            if spec.integer { "integers" } else { "numbers" },
            values.count(),
            values.components(),
            if values.is_integer() { "integers" } else { "numbers" },
        )))
    }

    fn lay_out_mesh(&self, file: &mut Creator, grid: &GridSpec<'_>) -> Result<(), OutputError> {
        file.group(&["VTKHDF"])?;
        file.vtkhdf_header(b"UnstructuredGrid")?;
        let corners = grid.cells.corners();
        let connectivity: Vec<i64> =
            grid.cells.connectivity().iter().map(|&index| i64::from(index)).collect();
        let offsets: Vec<i64> = (0..=self.cells).map(|cell| (cell * corners) as i64).collect();
        let types = vec![grid.cells.vtk_type(); self.cells];
        let counts = [
            (&MESH.point_count, self.points),
            (&MESH.cell_count, self.cells),
            (&MESH.connectivity_count, connectivity.len()),
        ];
        let at = |spec| dataset_spec(&["VTKHDF"], spec);
        file.constant(&at(&MESH.points), grid.points.as_flattened())?;
        file.constant(&at(&MESH.connectivity), &connectivity)?;
        file.constant(&at(&MESH.offsets), &offsets)?;
        file.constant(&at(&MESH.types), &types)?;
        counts.into_iter().try_for_each(|(spec, n)| file.constant(&at(spec), &[n as i64]))
    }

    fn lay_out_fields(&self, file: &mut Creator, grid: &GridSpec<'_>) -> Result<(), OutputError> {
        file.group(&["VTKHDF", "PointData"])?;
        file.group(&["VTKHDF", "CellData"])?;
        for StaticField { spec, values } in grid.constant {
            let dataset = field_dataset(spec);
            match *values {
                Values::Scalar(values) => file.constant(&dataset, values)?,
                Values::Vector(values) => file.constant(&dataset, values.as_flattened())?,
                Values::Tensor(values) => file.constant(&dataset, values.as_flattened())?,
                Values::Integer(values) => file.constant(&dataset, values)?,
            }
        }
        for spec in &self.fields {
            let rows = self.count(spec.on_cells);
            if spec.integer {
                file.snapshots::<u8>(&field_dataset(spec), rows)?;
            } else {
                file.snapshots::<f64>(&field_dataset(spec), rows)?;
            }
        }
        Ok(())
    }

    fn lay_out_steps(&self, file: &mut Creator) -> Result<(), OutputError> {
        file.group(&STEPS_GROUP)?;
        let at = |spec| dataset_spec(&STEPS_GROUP, spec);
        file.rows::<f64>(&at(&STEPS.times))?;
        file.rows::<i64>(&at(&STEPS.parts))?;
        file.rows::<i64>(&at(&STEPS.part_offsets))?;
        for spec in [&STEPS.point_offsets, &STEPS.cell_offsets, &STEPS.connectivity_offsets] {
            // VTK wants one column per topology here, and an unstructured grid has one.
            file.column::<i64>(&at(spec))?;
        }
        let groups = [false, true].map(offset_group);
        for group in &groups {
            file.group(group)?;
        }
        let constant = grid_names(&self.constant_names);
        let transient = self.fields.iter().map(|spec| (&*spec.name, spec.on_cells));
        for (name, on_cells) in transient.chain(constant) {
            file.rows::<i64>(&DatasetSpec {
                group: &groups[usize::from(on_cells)],
                name,
                units: "1",
                components: 1,
                description: "first row of each step in the array of this name",
            })?;
        }
        file.count(&STEPS_GROUP, STEP_COUNT, 0)
    }
}

fn append_reals(
    file: &mut Appender,
    sums: &mut Checksums,
    name: &str,
    values: &[f64],
) -> Result<(), OutputError> {
    sums.add(name, values);
    file.append(name, values)
}

/// What every step appends to the datasets of `Steps`: one part, and offsets of zero, since the mesh is stored
/// once.
fn counts_of_step() -> impl Iterator<Item = (String, i64)> {
    let [_, parts, offsets @ ..] = STEPS.each();
    std::iter::once((parts, 1))
        .chain(offsets.map(|spec| (spec, 0)))
        .map(|(spec, n)| (step_path(spec), n))
}

fn grid_names(names: &[(String, bool)]) -> impl Iterator<Item = (&str, bool)> {
    names.iter().map(|(name, on_cells)| (name.as_str(), *on_cells))
}

pub(crate) fn dataset_spec<'a>(group: &'a [&'a str], spec: &'a FieldSpec) -> DatasetSpec<'a> {
    let FieldSpec { name, units, components, description, .. } = spec;
    DatasetSpec { group, name, units, components: *components, description }
}

fn field_dataset(spec: &FieldSpec) -> DatasetSpec<'_> {
    dataset_spec(
        if spec.on_cells { &["VTKHDF", "CellData"] } else { &["VTKHDF", "PointData"] },
        spec,
    )
}

fn offset_group(on_cells: bool) -> [&'static str; 3] {
    ["VTKHDF", "Steps", if on_cells { "CellDataOffsets" } else { "PointDataOffsets" }]
}

fn offset_path(name: &str, on_cells: bool) -> String {
    format!("{}/{name}", offset_group(on_cells).join("/"))
}
