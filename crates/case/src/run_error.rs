//! Why a run did not come to its end.

use std::path::PathBuf;

use crate::remedy::{Remedy, key, key_of_mesh};

/// Why a run did not come to its end.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RunError {
    /// The run folder cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Folder(#[from] crate::folder::FolderError),
    /// The run cannot be resumed.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Resume(#[from] crate::resume::error::ResumeError),
    /// The state of a checkpoint is not of this model.
    #[error("the checkpoint cannot be used: {0}")]
    #[diagnostic(help("begin the run anew with --force; its results so far are readable"))]
    Restore(#[from] dynamics::RestoreError),
    /// The mesh cannot be built.
    #[error("{}", named(.0))]
    #[diagnostic(help("{}", .0.remedy()))]
    Mesh(#[from] mesh::MeshError),
    /// The mesh file cannot be used.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy))]
    MeshFile(#[from] crate::mesh_file::MeshFileError),
    /// The mesh of a case in plane strain is more than a slice.
    #[error("mesh.plane_strain = true: {0}")]
    #[diagnostic(help(
        "give a mesh one element wide, extruded along y, or mesh.plane_strain = false"
    ))]
    Slice(#[from] mesh::NoSlice),
    /// The elements cannot be set up.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Solid(#[from] solid::SolidError),
    /// The contact cannot be set up.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Contact(#[from] contact::ContactError),
    /// There is no friction law.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Friction(#[from] friction::LawError),
    /// The machine has too little memory for the mesh.
    #[error(
        "the run of {elements} elements needs about {} GB of memory, more than the {} GB that are free: \
         enlarge mesh.zone.size or shrink the zone", gigabytes(*needed_gb), gigabytes(*free_gb)
    )]
    #[diagnostic(help("`creepage mesh` tells what a mesh needs; `ulimit -v` limits what is free"))]
    Memory {
        /// Elements of both bodies.
        elements: usize,
        /// Estimate of what the run needs (GB).
        needed_gb: f64,
        /// What the system has free (GB).
        free_gb: f64,
    },
    /// A surface of the mesh is missing.
    #[error("the mesh has no contact surface in its fine zone")]
    #[diagnostic(help("enlarge mesh.zone"))]
    NoContact,
    /// The function of the friction law is missing.
    #[error("friction.law = \"python\": the run needs the function of its friction law")]
    #[diagnostic(help(
        "hand it over: `creepage.run(case, friction=law)` in Python; friction.source is what it was"
    ))]
    NoLaw,
    /// The time step asked for is not stable.
    #[error(
        "time.step = {step:.4e} s is above the stability limit of {limit:.4e} s, which the closed \
         contact springs lower"
    )]
    #[diagnostic(help("lower time.step, or give time.factor, a fraction of the limit"))]
    Step {
        /// The step asked for (s).
        step: f64,
        /// The stability limit (s).
        limit: f64,
    },
    /// The preload was not found.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Preload(#[from] crate::preload::error::PreloadError),
    /// Result files of a run that was to go on are damaged, or results cannot be written.
    #[error(transparent)]
    #[diagnostic(help("{}", output_help(.0)))]
    Output(#[from] output::OutputError),
    /// A file beside the results cannot be written.
    #[error("cannot write {}: {cause}{}", path.display(), output::room_left(path))]
    #[diagnostic(help(
        "the run has stopped; check that its folder is still there and that the disk has room"
    ))]
    Text {
        /// The file.
        path: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
    /// A built-in case is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Case(#[from] crate::error::CaseError),
    /// Threads cannot be started.
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl RunError {
    /// The key of the case that the error is about, where it is about one.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Mesh(error) => key_of_mesh(error),
            Self::Memory { .. } => Some(key!("mesh.zone.size")),
            Self::Slice(_) => Some(key!("mesh.plane_strain")),
            Self::Step { .. } => Some(key!("time.step")),
            _ => None,
        }
    }

    /// What to do about it, in the keys of the case file.
    pub fn remedy(&self) -> String {
        miette::Diagnostic::help(self).map_or("change this key".into(), |help| help.to_string())
    }

    /// Exit code of the process: 2 for bad input, 3 where the run's own guards stopped it, 130
    /// when interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Folder(crate::folder::FolderError::Lost { .. }) => 3,
            Self::Folder(_)
            | Self::Mesh(_)
            | Self::Solid(_)
            | Self::Contact(_)
            | Self::Friction(_) => 2,
            Self::MeshFile(_)
            | Self::Slice(_)
            | Self::NoContact
            | Self::Case(_)
            | Self::Threads(_)
            | Self::Memory { .. } => 2,
            Self::Step { .. } | Self::Resume(_) | Self::Restore(_) | Self::NoLaw => 2,
            Self::Preload(error) if error.is_interruption() => 130,
            Self::Output(error) if error.damaged().is_some() => 2,
            Self::Preload(_) | Self::Output(_) | Self::Text { .. } => 3,
        }
    }
}

/// What is wrong with a mesh, after the key that it is refused by.
fn named(error: &mesh::MeshError) -> String {
    key_of_mesh(error).map_or(error.to_string(), |key| format!("{key}: {error}"))
}

fn output_help(error: &output::OutputError) -> &'static str {
    if error.damaged().is_some() {
        "copy the files of the run again, or begin it anew with --force"
    } else {
        "the run has stopped; what was written before stays readable, and --resume goes on once the \
         disk has room"
    }
}

fn gigabytes(gb: f64) -> String {
    if gb < 0.1 { format!("{gb:.3}") } else { format!("{gb:.1}") }
}
