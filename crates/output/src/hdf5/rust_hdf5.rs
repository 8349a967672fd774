//! Writing with rust-hdf5, and all that is ours because this library lacks it.
//!
//! | the library | here |
//! |---|---|
//! | writes the links of groups with more than eight members anew at every closing, at first at other places | [`RustHdf5File::fix_link_storage`] |
//! | writes the superblock, which names the end of the file, after the headers that refer to data behind the old end | [`Extension`] |
//! | panics over a damaged index of chunks | [`catch_panic`] |
//! | states characters of texts as strings of length 1 where libhdf5 states bytes, so that C reads them as the file's type alone | h5py and VTK do so |

use super::Growing;
use super::library::{DEFLATE_LEVEL, DatasetSpec, Layout, LibraryResult, Number, ResultFile};
use crate::files::input;
use rust_hdf5::format::superblock::SuperblockV2V3;
use rust_hdf5::{
    DatatypeMessage, FileSpaceStrategy, H5Dataset, H5File, H5Group, Hdf5Error, LibverBound,
    VarLenUnicode,
};
use std::any::Any;
use std::cell::Cell;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::path::{Path, PathBuf};
use std::sync::Once;

/// Page size of the file space (bytes): nothing smaller crosses a multiple of it. Headers and index blocks,
/// which carry checksums, therefore lie within a page of memory, and a kill within the call that rewrites
/// one leaves it old or new.
const PAGE: u64 = 512;

type H5Result<T> = Result<T, Hdf5Error>;

/// A file open for writing.
pub(super) struct RustHdf5File {
    path: PathBuf,
    /// `None` once it is closed.
    file: Option<H5File>,
    /// Extension of the file that the superblock does not state yet.
    extension: Option<Extension>,
}

impl RustHdf5File {
    fn of(path: &Path, file: H5File) -> Self {
        Self { path: path.to_owned(), file: Some(file), extension: None }
    }

    fn file(&self) -> H5Result<&H5File> {
        self.file.as_ref().ok_or_else(|| Hdf5Error::InvalidState("the file is closed".into()))
    }

    fn group_at(&self, path: &[&str]) -> H5Result<H5Group> {
        descend(self.file()?, path)
    }

    /// Appends a row of zeros of whatever type.
    fn append_row(&self, dataset: &str) -> LibraryResult<()> {
        let append = || -> H5Result<()> {
            let dataset = self.file()?.dataset_writer(dataset)?;
            let width = dataset.shape().iter().skip(1).product();
            match dataset.element_size() {
                1 => dataset.append(&vec![0_u8; width]),
                _ => dataset.append(&vec![0_i64; width]),
            }
        };
        Ok(catch_panic(append)?)
    }
}

impl ResultFile for RustHdf5File {
    /// The bound is V110 because VTK cannot read newer ones.
    fn create(path: &Path) -> LibraryResult<Self> {
        let file = H5File::options()
            .no_locking()
            .libver(LibverBound::V110)
            .file_space(FileSpaceStrategy::Page, false, 1)
            .file_space_page_size(PAGE)
            .create(path)?;
        Ok(Self::of(path, file))
    }

    fn open(path: &Path) -> LibraryResult<Self> {
        let file = catch_panic(|| H5File::options().no_locking().open_rw(path))?;
        Ok(Self::of(path, file))
    }

    /// Appends a row to every dataset and removes it again, twice, and then closes the file once more: measured, for
    /// 6 to 120 members of a group. Where a group has more than some twenty, a closing in which the index of chunks
    /// grows still moves links.
    fn fix_link_storage(path: &Path, datasets: &[Growing]) -> LibraryResult<()> {
        for _ in 0..2 {
            let file = Self::open(path)?;
            datasets.iter().try_for_each(|dataset| file.append_row(&dataset.name))?;
            file.close_no_sync()?;
            let file = Self::open(path)?;
            for Growing { name, .. } in datasets {
                file.truncate(name, file.rows(name)?.saturating_sub(1))?;
            }
            file.close_no_sync()?;
        }
        Self::open(path)?.close_no_sync()
    }

    fn group(&self, path: &[&str]) -> LibraryResult<()> {
        if let Some((name, parents)) = path.split_last() {
            self.group_at(parents)?.create_group(name)?;
        }
        Ok(())
    }

    fn text(&self, name: &str, text: &str) -> LibraryResult<()> {
        Ok(self.file()?.set_attr_string(name, text)?)
    }

    fn ascii<const N: usize>(
        &self,
        group: &[&str],
        name: &str,
        text: &[u8; N],
    ) -> LibraryResult<()> {
        let ascii = DatatypeMessage::FixedString { size: N as u32, padding: 1, charset: 0 };
        Ok(self.group_at(group)?.set_attr_typed(name, ascii, text.to_vec())?)
    }

    fn integers(&self, group: &[&str], name: &str, values: &[i64]) -> LibraryResult<()> {
        Ok(self.group_at(group)?.set_attr_array_numeric(name, values)?)
    }

    fn integer(&self, group: &[&str], name: &str, value: i64) -> LibraryResult<()> {
        Ok(catch_panic(|| match group {
            [] => self.file()?.set_attr_numeric(name, &value),
            group => self.group_at(group)?.set_attr_numeric(name, &value),
        })?)
    }

    fn dataset<T: Number>(
        &self,
        at: &DatasetSpec<'_>,
        layout: &Layout,
        data: &[T],
    ) -> LibraryResult<()> {
        let limit: Vec<Option<usize>> = if layout.grows {
            std::iter::once(None).chain(layout.shape.iter().skip(1).map(|n| Some(*n))).collect()
        } else {
            layout.shape.iter().map(|n| Some(*n)).collect()
        };
        let group = self.group_at(at.group)?;
        let mut builder = group.new_dataset::<T>().shape(&layout.shape);
        if let Some(chunk) = &layout.chunk {
            builder = builder.chunk(chunk);
        }
        if layout.grows {
            builder = builder.max_shape(&limit);
        }
        if layout.compressed {
            builder = builder.deflate(DEFLATE_LEVEL.into());
        }
        let dataset = builder.create(at.name)?;
        if !data.is_empty() {
            dataset.write_raw(data)?;
        }
        Ok(describe(&dataset, at)?)
    }

    fn rows(&self, dataset: &str) -> LibraryResult<usize> {
        Ok(catch_panic(|| Ok(rows(&self.file()?.dataset_writer(dataset)?)))?)
    }

    /// The first [`Self::append`] writes the new end into the superblock: late enough that no reader that saw the
    /// short file has yet to read the superblock, early enough that at the closing no reader of the old superblock
    /// has yet to read the count.
    ///
    /// Single rows need it as well: a kill between the headers and the superblock would leave a file whose
    /// headers point behind its end.
    fn extend(&mut self, bytes: usize) -> LibraryResult<()> {
        self.extension = Some(Extension::of(&self.path, bytes)?);
        Ok(())
    }

    fn append<T: Number>(&mut self, dataset: &str, data: &[T]) -> LibraryResult<()> {
        catch_panic(|| self.file()?.dataset_writer(dataset)?.append(data))?;
        Ok(self.extension.take().map_or(Ok(()), Extension::announce)?)
    }

    fn truncate(&self, dataset: &str, rows: usize) -> LibraryResult<()> {
        let truncate = || -> H5Result<()> {
            let dataset = self.file()?.dataset_writer(dataset)?;
            let mut shape = dataset.shape();
            shape.iter_mut().take(1).for_each(|length| *length = rows);
            dataset.set_extent(&shape)
        };
        Ok(catch_panic(truncate)?)
    }

    fn close(mut self) -> LibraryResult<()> {
        Ok(self.file.take().map_or(Ok(()), H5File::close)?)
    }

    fn close_no_sync(mut self) -> LibraryResult<()> {
        let file = self.file.take();
        Ok(catch_panic(|| file.map_or(Ok(()), H5File::close_no_sync))?)
    }
}

/// After an error, which was returned: otherwise the library would print it again on standard error.
impl Drop for RustHdf5File {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            let _ = catch_panic(|| file.close_no_sync());
        }
    }
}

pub(super) fn descend(file: &H5File, path: &[&str]) -> H5Result<H5Group> {
    path.iter().try_fold(file.root_group(), |group, name| group.group(name))
}

fn rows(dataset: &H5Dataset) -> usize {
    dataset.shape().first().copied().unwrap_or(0)
}

fn describe(dataset: &H5Dataset, at: &DatasetSpec<'_>) -> H5Result<()> {
    for (name, text) in [("units", at.units), ("description", at.description)] {
        dataset.new_attr::<VarLenUnicode>().shape(()).create(name)?.write_string(text)?;
    }
    Ok(())
}

/// Bytes for chunk indices, new chunks of rows, and what compression adds to data that it cannot shorten.
/// They cost nothing: the file is sparse there, and truncated when it is closed.
const SLACK: u64 = 1 << 20;

/// A lengthened file whose superblock does not yet say so.
///
/// libhdf5 reads the end of a file once, from the superblock, at opening, and refuses every address behind it. A
/// reader that opened just before a closing and reads the count just after would meet an address behind its end.
/// Hence the file is lengthened first, then its new end is written, then the data and headers; closing truncates
/// the file to what is used. The order of the first two matters as well: libhdf5 refuses a file that is shorter
/// than its superblock says.
struct Extension {
    file: File,
    superblock: SuperblockV2V3,
}

impl Extension {
    /// Lengthens the file at `path` for `bytes` of data and their indices. To be called after rust-hdf5 has
    /// opened the file, since it appends at the length that it finds.
    fn of(path: &Path, bytes: usize) -> io::Result<Self> {
        let mut file = OpenOptions::new().read(true).write(true).open(path)?;
        let mut image = [0; 48];
        file.read_exact(&mut image)?;
        let mut superblock = SuperblockV2V3::decode(&image).map_err(io::Error::other)?;
        let room = SLACK + bytes as u64 + bytes as u64 / 64;
        // the end of a file lies on the border of a page
        superblock.end_of_file_address = (file.metadata()?.len() + room).next_multiple_of(PAGE);
        file.set_len(superblock.end_of_file_address)?;
        Ok(Self { file, superblock })
    }

    /// Writes the new end into the superblock.
    fn announce(mut self) -> io::Result<()> {
        self.file.rewind()?;
        self.file.write_all(&self.superblock.encode())
    }
}

/// The end that the superblock of a file names.
pub(super) fn end_of_file(path: &Path) -> io::Result<u64> {
    let mut image = [0; 48];
    let mut file = input::open(path, input::RESULTS).map_err(io::Error::other)?;
    file.read_exact(&mut image)?;
    let superblock = SuperblockV2V3::decode(&image).map_err(io::Error::other)?;
    Ok(superblock.end_of_file_address)
}

thread_local! {
    /// Whether this thread is within [`catch_panic`].
    static WITHIN: Cell<bool> = const { Cell::new(false) };
}

/// The library checks most of what it reads, but not the parameters of a damaged index of chunks, which are not
/// accessible, so that they cannot be checked before.
///
/// What `call` returns; its panic, of which nothing is printed, becomes an error. `call` must only call the
/// library.
///
/// The first call replaces the panic hook of the process by one that prints nothing within this function.
///
/// Asserted to be safe on unwinding: what the library shares between calls are cells, which unwinding
/// releases, and caches behind locks, which it no longer uses once they are poisoned.
pub(super) fn catch_panic<T>(call: impl FnOnce() -> Result<T, Hdf5Error>) -> Result<T, Hdf5Error> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !WITHIN.get() {
                before(panic);
            }
        }));
    });
    WITHIN.set(true);
    let result = catch_unwind(AssertUnwindSafe(call));
    WITHIN.set(false);
    result.unwrap_or_else(|panic| {
        let reason = text(panic.as_ref());
        Err(Hdf5Error::InvalidState(format!("damaged: the HDF5 library broke off ({reason})")))
    })
}

fn text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a reason")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_panic_becomes_an_error_with_its_text() {
        let bitmap: Vec<u8> = Vec::new();
        let error = catch_panic(|| Ok(bitmap[std::hint::black_box(0)])).map_err(|e| e.to_string());
        assert!(error.is_err_and(|text| text.contains("the len is 0 but the index is 0")));
        let error = catch_panic::<()>(|| panic!("page {}", 7)).map_err(|e| e.to_string());
        assert!(error.is_err_and(|text| text.contains("broke off (page 7)")));
        assert_eq!(catch_panic(|| Ok(3)).ok(), Some(3));
    }

    fn end(path: &Path) -> u64 {
        let image = std::fs::read(path).unwrap();
        SuperblockV2V3::decode(&image).unwrap().end_of_file_address
    }

    #[test]
    fn the_file_is_never_shorter_than_its_superblock_says() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.h5");
        let options = H5File::options().no_locking().libver(LibverBound::V110);
        options.create(&path).unwrap().close().unwrap();
        let length = || std::fs::metadata(&path).unwrap().len();
        let before = length();
        assert_eq!(end(&path), before);

        let open = H5File::options().no_locking().open_rw(&path).unwrap();
        let extension = Extension::of(&path, 6_400).unwrap();
        let lengthened = (before + SLACK + 6_500).next_multiple_of(PAGE);
        assert_eq!(length(), lengthened);
        assert_eq!(end(&path), before, "announced before there was room");
        extension.announce().unwrap();
        assert_eq!(end(&path), lengthened);
        let reader = H5File::options().no_locking().open(&path);
        assert!(reader.is_ok(), "not readable while there is room");

        open.close().unwrap();
        assert_eq!((length(), end(&path)), (before, before), "closing takes back unused room");
    }

    const GROUPS: [&[&str]; 3] = [&["mesh"], &["mesh", "points"], &["mesh", "cells"]];

    /// A file with this many datasets in each group.
    fn create(path: &Path, members: usize) -> Vec<Growing> {
        let file = RustHdf5File::create(path).unwrap();
        let layout = Layout { shape: vec![0], chunk: Some(vec![4]), compressed: true, grows: true };
        let mut datasets = Vec::new();
        for group in GROUPS {
            file.group(group).unwrap();
            for name in (0..members).map(|k| format!("field_{k}")) {
                let (units, description) = ("m", "a field");
                let at = DatasetSpec { group, name: &name, units, components: 1, description };
                file.dataset::<f64>(&at, &layout, &[]).unwrap();
                datasets.push(Growing { name: format!("{}/{name}", group.join("/")), rows: 4 });
            }
        }
        file.integer(GROUPS[0], "count", 0).unwrap();
        file.close().unwrap();
        datasets
    }

    fn append(path: &Path, datasets: &[Growing], count: i64) {
        let mut file = RustHdf5File::open(path).unwrap();
        file.extend(32 * datasets.len()).unwrap();
        datasets.iter().for_each(|dataset| file.append(&dataset.name, &[0.5; 4]).unwrap());
        file.integer(GROUPS[0], "count", count).unwrap();
        file.close_no_sync().unwrap();
    }

    /// Places and beginnings of the fractal heaps and B-trees that hold links.
    fn links(path: &Path) -> Vec<(usize, Vec<u8>)> {
        let bytes = std::fs::read(path).unwrap();
        let lengths =
            [("FRHP", 142), ("FHDB", 38), ("FHIB", 38), ("BTHD", 38), ("BTLF", 38), ("BTIN", 38)];
        let block = |at: usize| {
            let (_, length) =
                lengths.iter().find(|(mark, _)| bytes[at..].starts_with(mark.as_bytes()))?;
            Some((at, bytes[at..at + length].to_vec()))
        };
        (0..bytes.len() - 142).filter_map(block).collect()
    }

    #[test]
    fn appends_leave_the_links_where_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.h5");
        for members in [6, 9, 20, 40] {
            let datasets = create(&path, members);
            RustHdf5File::fix_link_storage(&path, &datasets).unwrap();
            let before = links(&path);
            assert_eq!(before.is_empty(), members == 6);
            for count in 1..=6 {
                append(&path, &datasets, count);
                assert!(links(&path) == before, "{members} datasets in each group, append {count}");
            }
        }
    }
}
