//! Lengthening of a file before anything in it refers to addresses behind its old end.
//!
//! libhdf5 reads the end of a file once, from the superblock, at opening, and refuses every address
//! behind it. rust-hdf5 writes the superblock last, after the headers and counts that refer to the
//! new data: a reader that opened just before and reads the count just after would meet an address
//! behind its end. Hence the file is lengthened first, then its new end is written, then the data and
//! headers; closing truncates the file to what is used. The order of the first two matters as well:
//! libhdf5 refuses a file that is shorter than its superblock says.

use crate::files::input;
use crate::hdf5::PAGE;
use rust_hdf5::format::superblock::SuperblockV2V3;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::path::Path;

/// Bytes for chunk indices, new chunks of rows, and what compression adds to data that it cannot shorten.
/// They cost nothing: the file is sparse there, and truncated when it is closed.
const SLACK: u64 = 1 << 20;

/// A lengthened file whose superblock does not yet say so.
pub(crate) struct Extension {
    file: File,
    superblock: SuperblockV2V3,
}

impl Extension {
    /// Lengthens the file at `path` for `bytes` of data and their indices. To be called after rust-hdf5 has
    /// opened the file, since it appends at the length that it finds.
    pub fn of(path: &Path, bytes: usize) -> io::Result<Self> {
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
    pub fn announce(mut self) -> io::Result<()> {
        self.file.rewind()?;
        self.file.write_all(&self.superblock.encode())
    }
}

/// The end that the superblock of a file names.
pub(crate) fn end_of_file(path: &Path) -> io::Result<u64> {
    let mut image = [0; 48];
    let mut file = input::open(path, input::RESULTS).map_err(io::Error::other)?;
    file.read_exact(&mut image)?;
    let superblock = SuperblockV2V3::decode(&image).map_err(io::Error::other)?;
    Ok(superblock.end_of_file_address)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use rust_hdf5::{H5File, LibverBound};

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
}
