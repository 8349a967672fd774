//! The provenance of a file.

/// Provenance of a file: the root attributes of every HDF5 file of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// Version of the program that wrote the file.
    pub creepage_version: String,
    /// Hash of the resolved case, hexadecimal.
    pub case_hash: String,
    /// When the run started, ISO 8601 in UTC. The only content that differs between equal runs.
    pub created: String,
    /// Further root attributes of this file: name and text.
    pub attributes: Vec<(String, String)>,
}
