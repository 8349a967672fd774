//! What the default build writes is what HDF5's own library writes: the files of a run are written again through it,
//! and every object, attribute and number is compared.

#![allow(clippy::unwrap_used, missing_docs)]

use hdf5_metno::types::{FixedAscii, TypeDescriptor};
use hdf5_metno::{Container, Dataset, File, Group, Location};
use output::{
    Cells, Checkpoint, FieldInfo, FieldSpec, GridFile, GridSpec, History, HistoryFile, Provenance,
    StaticField, TransientGrid, Values,
};
use std::path::{Path, PathBuf};

#[test]
#[ignore = "needs a run of the default build in CREEPAGE_RUN: cargo xtask validate libhdf5"]
fn libhdf5_writes_what_the_default_build_writes() {
    let run = PathBuf::from(std::env::var_os("CREEPAGE_RUN").unwrap());
    let folder = tempfile::tempdir().unwrap();
    let names = ["fields.vtkhdf", "contact.vtkhdf", "history.h5", "probes.h5", "checkpoint.h5"];
    let mut compared = 0;
    for name in names {
        let [default, written] = [&*run, folder.path()].map(|folder| folder.join(name));
        if !default.exists() {
            continue; // not every run has every file
        }
        match name {
            "checkpoint.h5" => Checkpoint::read(&default).unwrap().write(folder.path()).unwrap(),
            name if name.ends_with("vtkhdf") => write_grid(&default, &written),
            _ => write_history(&default, &written),
        }
        let [default, written] = [default, written].map(|path| File::open(path).unwrap());
        compared += compare(&default, &written);
    }
    assert!(compared > 100, "{compared} objects are too few to show anything");
}

/// Compares groups with all that is in them; gives the number of groups and datasets.
fn compare(default: &Group, written: &Group) -> usize {
    compare_attributes(default, written);
    let [names, others] = [default, written].map(|group| sorted(group.member_names().unwrap()));
    assert_eq!(others, names, "in {}", default.name());
    let compared = |name: &String| match default.group(name) {
        Ok(group) => compare(&group, &written.group(name).unwrap()),
        Err(_) => {
            compare_datasets(&default.dataset(name).unwrap(), &written.dataset(name).unwrap())
        }
    };
    1 + names.iter().map(compared).sum::<usize>()
}

fn compare_datasets(default: &Dataset, written: &Dataset) -> usize {
    compare_attributes(default, written);
    // chunks, filters, fill value, times of allocation and filling
    let [default_storage, storage] = [default, written].map(|d| d.create_plist().unwrap());
    assert!(storage == default_storage, "{}: {storage:?} {default_storage:?}", default.name());
    compare_content(default, written, &default.name());
    1
}

fn compare_attributes(default: &Location, written: &Location) {
    let [names, others] = [default, written].map(|object| sorted(object.attr_names().unwrap()));
    assert_eq!(others, names, "of {}", default.name());
    for name in names {
        let [default, written] = [default, written].map(|object| object.attr(&name).unwrap());
        compare_content(&default, &written, &name);
    }
}

fn sorted(mut names: Vec<String>) -> Vec<String> {
    names.sort();
    names
}

/// Compares type, shape, largest shape and numbers.
fn compare_content(default: &Container, written: &Container, name: &str) {
    let form = |container: &Container| {
        let kind = container.dtype().unwrap().to_descriptor().unwrap();
        (kind, container.space().unwrap().extents().unwrap())
    };
    assert_eq!(form(written), form(default), "{name}");
    if form(default).0 != TypeDescriptor::VarLenUnicode {
        assert_eq!(written.dtype().unwrap(), default.dtype().unwrap(), "{name}");
    }
    let content = [default, written].map(|container| match form(container).0 {
        TypeDescriptor::VarLenUnicode => text(container, name),
        TypeDescriptor::FixedAscii(16) => {
            container.read_scalar::<FixedAscii<16>>().unwrap().to_string()
        }
        TypeDescriptor::Float(_) => {
            let bits = container.read_raw::<f64>().unwrap().into_iter().map(f64::to_bits);
            format!("{:?}", bits.collect::<Vec<_>>())
        }
        _ => format!("{:?}", container.read_raw::<i64>().unwrap()),
    });
    assert!(content[0] == content[1], "{name} has other content");
}

/// A text of an attribute. rust-hdf5 states another type of character than libhdf5, which therefore does not convert
/// it to its own.
fn text(attribute: &Location, name: &str) -> String {
    let file = rust_hdf5::H5File::options().no_locking().open(attribute.filename()).unwrap();
    match &*attribute.name() {
        "/" => file.attr_string(name).unwrap(),
        path => file.dataset(&path[1..]).unwrap().attr(name).unwrap().read_string().unwrap(),
    }
}

/// The root attributes, whose texts a writer is given.
fn provenance(file: &File) -> Provenance {
    let own = ["creepage_version", "case_hash", "created"];
    let [creepage_version, case_hash, created] = own.map(|name| text(file, name));
    let kind = |name: &str| file.attr(name).unwrap().dtype().unwrap().to_descriptor().unwrap();
    let is_text = |name: &str| kind(name) == TypeDescriptor::VarLenUnicode;
    let names = file.attr_names().unwrap().into_iter();
    let others = names.filter(|name| !own.contains(&&**name) && is_text(name));
    let attributes = others.map(|name| (name.clone(), text(file, &name))).collect();
    Provenance { creepage_version, case_hash, created, attributes }
}

fn description(file: &File, dataset: &str) -> String {
    text(&file.dataset(dataset).unwrap(), "description")
}

/// The values of a field at a step.
struct Snapshot {
    info: FieldInfo,
    numbers: Vec<f64>,
    bytes: Vec<u8>,
}

impl Snapshot {
    fn read(grid: &GridFile, info: &FieldInfo, step: usize) -> Self {
        let numbers = grid.read(&info.name, info.on_cells, step).unwrap();
        let bytes = numbers.iter().map(|number| *number as u8).collect();
        Self { info: info.clone(), numbers, bytes }
    }

    fn values(&self) -> Values<'_> {
        match self.info.components {
            _ if self.info.integer => Values::Integer(&self.bytes),
            3 => Values::Vector(self.numbers.as_chunks().0),
            6 => Values::Tensor(self.numbers.as_chunks().0),
            _ => Values::Scalar(&self.numbers),
        }
    }
}

fn write_grid(default: &Path, written: &Path) {
    let (grid, file) = (GridFile::open(default).unwrap(), File::open(default).unwrap());
    let spec = |info: &FieldInfo| {
        let group = if info.on_cells { "CellData" } else { "PointData" };
        let description = description(&file, &format!("VTKHDF/{group}/{}", info.name));
        FieldSpec {
            name: info.name.clone().into(),
            units: info.units.clone().into(),
            components: info.components,
            integer: info.integer,
            on_cells: info.on_cells,
            description: description.into(),
        }
    };
    let (constant, transient): (Vec<_>, Vec<_>) = grid.fields().iter().partition(|f| f.constant);
    let snapshots: Vec<_> = constant.iter().map(|info| Snapshot::read(&grid, info, 0)).collect();
    let (points, connectivity) = (grid.points().unwrap(), grid.connectivity().unwrap());
    let (hexahedra, quads) = (connectivity.as_chunks().0, connectivity.as_chunks().0);
    let is_solid = connectivity.len() == 8 * grid.cells();
    let mesh = GridSpec {
        points: &points,
        cells: if is_solid { Cells::Hexahedra(hexahedra) } else { Cells::Quads(quads) },
        constant: &snapshots
            .iter()
            .map(|field| StaticField { spec: spec(&field.info), values: field.values() })
            .collect::<Vec<_>>(),
    };
    let fields: Vec<_> = transient.iter().map(|info| spec(info)).collect();
    let mut writer = TransientGrid::create(written, &mesh, &fields, &provenance(&file)).unwrap();
    for (step, time) in grid.times().unwrap().into_iter().enumerate() {
        let all: Vec<_> = transient.iter().map(|info| Snapshot::read(&grid, info, step)).collect();
        let values: Vec<_> = all.iter().map(Snapshot::values).collect();
        writer.append(time, &values).unwrap();
    }
}

fn write_history(default: &Path, written: &Path) {
    let (history, file) = (HistoryFile::open(default).unwrap(), File::open(default).unwrap());
    let names = history.columns().unwrap();
    let column = |name: &String| FieldSpec {
        name: name.clone().into(),
        units: history.units(name).unwrap().into(),
        description: description(&file, name).into(),
        ..FieldSpec::scalar("", "", "")
    };
    let columns: Vec<_> = names.iter().map(column).collect();
    let numbers: Vec<_> = names.iter().map(|name| history.read(name).unwrap()).collect();
    let mut writer = History::create(written, &columns, &provenance(&file)).unwrap();
    for row in 0..history.rows() {
        let row: Vec<_> = numbers.iter().map(|column| column[row]).collect();
        writer.append(&row).unwrap();
    }
}
