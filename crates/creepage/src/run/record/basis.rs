//! Where a run's files go, and what they say of their origin.

use crate::run::error::RunError;
use output::{FieldSpec, GridSpec, History, Kept, Provenance, Results, TransientGrid};
use std::path::PathBuf;

/// What the files of a run are made from besides the case.
pub(crate) struct RecordBasis {
    pub(crate) folder: PathBuf,
    pub(crate) provenance: Provenance,
    pub(crate) hertz_pressure: f64,
    /// How much of the existing files a resumed run keeps; none for a run that begins.
    pub(crate) keeps: Option<Results>,
}

impl RecordBasis {
    pub(super) fn grid(
        &self,
        name: &str,
        grid: &GridSpec<'_>,
        fields: &[FieldSpec],
        provenance: &Provenance,
        of: fn(&Results) -> &Kept,
    ) -> Result<TransientGrid, RunError> {
        let path = self.folder.join(name);
        Ok(match &self.keeps {
            Some(kept) => TransientGrid::reopen(path, grid, fields, of(kept))?,
            None => TransientGrid::create(path, grid, fields, provenance)?,
        })
    }

    pub(crate) fn history(
        &self,
        name: &str,
        columns: &[FieldSpec],
        of: fn(&Results) -> &Kept,
    ) -> Result<History, RunError> {
        let path = self.folder.join(name);
        Ok(match &self.keeps {
            Some(kept) => History::reopen(path, columns, of(kept))?,
            None => History::create(path, columns, &self.provenance)?,
        })
    }
}
