//! Why a run did not come to its end.

/// Why a run did not come to its end.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RunError {
    /// The run folder cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Folder(#[from] crate::run::folder::FolderError),
    /// The scenario cannot be set up.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scenario(#[from] crate::scenario::ScenarioError),
    /// The run cannot be resumed.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Resume(#[from] crate::run::resume::error::ResumeError),
    /// A surface of the mesh is missing.
    #[error("the mesh has no contact surface in its fine zone")]
    #[diagnostic(help("enlarge mesh.zone"))]
    NoContact,
    /// `friction.law = "python"` without its function.
    #[error("friction.law = \"python\": the run needs the function of its friction law")]
    #[diagnostic(help(
        "hand it over: `creepage.run(case, friction=law)` in Python; friction.source is what it was"
    ))]
    NoLaw,
    /// A function of a friction law for a case that has another law.
    #[error(
        "the run is given the function of a friction law, which friction.law = \"{law}\" does not use"
    )]
    #[diagnostic(help("set friction.law = \"python\", or leave the function out"))]
    UnusedLaw {
        /// The law of the case.
        law: &'static str,
    },
    /// Result files of a run that was to go on are damaged, or results cannot be written.
    #[error(transparent)]
    #[diagnostic(help("{}", output_help(.0)))]
    Output(#[from] output::OutputError),
    /// A file beside the results cannot be written.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Text(#[from] output::NotWritten),
    /// A case that one process must run, under several.
    #[error("{what} cannot be shared by several processes")]
    #[diagnostic(help("run the case without mpirun, with --threads"))]
    OneProcess {
        /// What of the case.
        what: &'static str,
    },
    /// One of the processes that share a run cannot do its part.
    #[error("{reason}")]
    #[diagnostic(help(
        "all machines need the same creepage, the files of the case and its memory"
    ))]
    Process {
        /// What is wrong.
        reason: String,
    },
    /// Threads cannot be started.
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl RunError {
    /// Of processes that cannot go on together: a fault of the program.
    pub(crate) fn of_processes(error: dynamics::RestoreError) -> Self {
        Self::Process { reason: error.to_string() }
    }

    /// The dotted path of the key of the case that the error is about, where it is about one.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Scenario(error) => error.key(),
            _ => None,
        }
    }

    /// What to do about it, in terms of the keys of the case file.
    pub fn remedy(&self) -> String {
        miette::Diagnostic::help(self).map_or("change this key".into(), |help| help.to_string())
    }

    /// Exit code of the process: 2 for bad input, 3 where no preload was found, a file could not be written, or
    /// another process took the folder, 130 when interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Folder(crate::run::folder::FolderError::Lost { .. }) => 3,
            Self::Scenario(error) => error.exit_code(),
            Self::Folder(_) | Self::Resume(_) | Self::NoContact => 2,
            Self::NoLaw | Self::UnusedLaw { .. } | Self::Threads(_) => 2,
            Self::OneProcess { .. } | Self::Process { .. } => 2,
            Self::Output(error) if error.damaged().is_some() => 2,
            Self::Output(_) | Self::Text(_) => 3,
        }
    }
}

fn output_help(error: &output::OutputError) -> &'static str {
    if error.damaged().is_some() {
        "copy the files of the run again, or begin it anew with --force"
    } else {
        "the run has stopped; what was written before stays readable, and --resume goes on once the \
         disk has room"
    }
}
