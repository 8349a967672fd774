//! Writing with HDF5's own library.

use super::Growing;
use super::library::{DEFLATE_LEVEL, DatasetSpec, Layout, LibraryResult, Number, ResultFile};
use hdf5_metno::dataset::FillTime;
use hdf5_metno::file::LibraryVersion;
use hdf5_metno::types::{FixedAscii, VarLenUnicode};
use hdf5_metno::{
    Dataset, Error, Extent, File, FileBuilder, Group, Hyperslab, Location, Result, SimpleExtents,
    SliceOrIndex,
};
use ndarray::ArrayViewD;
use std::fs::OpenOptions;
use std::path::Path;

/// A file open for writing.
pub(super) struct Libhdf5File(File);

/// The bounds are V18: from V110 on, a file that is open for writing, or whose writer was killed, is marked so in
/// its superblock, and no reader opens it.
fn options() -> FileBuilder {
    let mut options = File::with_options();
    options.with_fapl(|access| {
        access.libver_bounds(LibraryVersion::V18, LibraryVersion::V18).file_locking(false)
    });
    options.with_fcpl(|creation| creation.obj_track_times(false));
    options
}

impl Libhdf5File {
    fn group_at(&self, path: &[&str]) -> Result<Group> {
        self.0.group(&format!("/{}", path.join("/")))
    }
}

impl ResultFile for Libhdf5File {
    fn create(path: &Path) -> LibraryResult<Self> {
        Ok(Self(options().create(path)?))
    }

    fn open(path: &Path) -> LibraryResult<Self> {
        Ok(Self(options().open_rw(path)?))
    }

    /// This library writes links only where they change.
    fn fix_link_storage(_: &Path, _: &[Growing]) -> LibraryResult<()> {
        Ok(())
    }

    fn group(&self, path: &[&str]) -> LibraryResult<()> {
        if let Some((name, parents)) = path.split_last() {
            let parent = self.group_at(parents)?;
            parent.create_group_builder().obj_track_times(false).create(*name)?;
        }
        Ok(())
    }

    fn text(&self, name: &str, text: &str) -> LibraryResult<()> {
        Ok(set_text(&self.0, name, text)?)
    }

    fn ascii<const N: usize>(
        &self,
        group: &[&str],
        name: &str,
        text: &[u8; N],
    ) -> LibraryResult<()> {
        let text = FixedAscii::<N>::from_ascii(text)
            .map_err(|error| Error::Internal(error.to_string()))?;
        let attribute = self.group_at(group)?.new_attr::<FixedAscii<N>>().create(name)?;
        Ok(attribute.write_scalar(&text)?)
    }

    fn integers(&self, group: &[&str], name: &str, values: &[i64]) -> LibraryResult<()> {
        let attribute = self.group_at(group)?.new_attr::<i64>().shape(values.len()).create(name)?;
        Ok(attribute.write(values)?)
    }

    fn integer(&self, group: &[&str], name: &str, value: i64) -> LibraryResult<()> {
        // what the count counts is in the file before it
        self.0.flush()?;
        let group = self.group_at(group)?;
        let attribute = match group.attr(name) {
            Ok(attribute) => attribute,
            Err(_) => group.new_attr::<i64>().create(name)?,
        };
        Ok(attribute.write_scalar(&value)?)
    }

    fn dataset<T: Number>(
        &self,
        at: &DatasetSpec<'_>,
        layout: &Layout,
        data: &[T],
    ) -> LibraryResult<()> {
        let extent = |(axis, &rows): (usize, &usize)| {
            if layout.grows && axis == 0 { Extent::resizable(rows) } else { Extent::fixed(rows) }
        };
        let extents = layout.shape.iter().enumerate().map(extent).collect();
        let group = self.group_at(at.group)?;
        let mut builder =
            group.new_dataset_builder().obj_track_times(false).fill_time(FillTime::IfSet);
        builder = match &layout.chunk {
            Some(chunk) => builder.chunk(chunk),
            None => builder.no_chunk(),
        };
        if layout.compressed {
            builder = builder.deflate(DEFLATE_LEVEL);
        }
        let dataset =
            builder.empty::<T>().shape(SimpleExtents::from_vec(extents)).create(at.name)?;
        if !data.is_empty() {
            dataset.write_raw(data)?;
        }
        set_text(&dataset, "units", at.units)?;
        Ok(set_text(&dataset, "description", at.description)?)
    }

    fn rows(&self, dataset: &str) -> LibraryResult<usize> {
        Ok(rows(&self.0.dataset(dataset)?))
    }

    /// The library does so itself.
    fn extend(&mut self, _: usize) -> LibraryResult<()> {
        Ok(())
    }

    fn append<T: Number>(&mut self, dataset: &str, data: &[T]) -> LibraryResult<()> {
        let dataset = self.0.dataset(dataset)?;
        let (first, mut shape) = (rows(&dataset), dataset.shape());
        let width: usize = shape.iter().skip(1).product();
        shape.iter_mut().take(1).for_each(|rows| *rows = data.len() / width.max(1));
        let mut slices: Vec<SliceOrIndex> = shape.iter().map(|&n| (0..n).into()).collect();
        if let (Some(count), Some(appended)) = (shape.first(), slices.first_mut()) {
            *appended = (first..first + count).into();
            resize(&dataset, first + count)?;
        }
        let view = ArrayViewD::from_shape(shape, data).map_err(Error::from)?;
        Ok(dataset.write_slice(view, Hyperslab::from(slices))?)
    }

    fn truncate(&self, dataset: &str, rows: usize) -> LibraryResult<()> {
        Ok(resize(&self.0.dataset(dataset)?, rows)?)
    }

    fn close(self) -> LibraryResult<()> {
        let path = self.0.filename();
        self.close_no_sync()?;
        Ok(OpenOptions::new().write(true).open(path)?.sync_all()?)
    }

    fn close_no_sync(self) -> LibraryResult<()> {
        Ok(self.0.close()?)
    }
}

fn rows(dataset: &Dataset) -> usize {
    dataset.shape().first().copied().unwrap_or(0)
}

fn resize(dataset: &Dataset, rows: usize) -> Result<()> {
    let mut shape = dataset.shape();
    shape.iter_mut().take(1).for_each(|length| *length = rows);
    dataset.resize(shape)
}

fn set_text(object: &Location, name: &str, text: &str) -> Result<()> {
    let text: VarLenUnicode = text.parse().map_err(|error| Error::Internal(format!("{error}")))?;
    object.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text)
}
