//! Where a file comes from.

/// Where a file comes from: the root attributes of every HDF5 file of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// Version of the program that wrote the file.
    pub creepage_version: String,
    /// Hash of the resolved case.
    pub case_hash: String,
    /// When the run started, ISO 8601 in UTC. The only content that differs between equal runs.
    pub created: String,
    /// Further root attributes: name and text.
    pub attributes: Vec<(String, String)>,
}
