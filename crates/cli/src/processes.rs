//! The processes that `mpirun` started, as its environment tells: the first speaks for all, the others assist it.

use std::sync::Arc;

use creepage::{Error, Leader};

use crate::commands::Command;
use crate::mpi::Universe;
use crate::terminal;

/// Names of the number of a process, and of how many there are, under `mpirun`, `mpiexec` or `srun`: of Open MPI, of MPICH and
/// what is made of it, and of a Slurm that uses PMIx.
const VARIABLES: [[&str; 2]; 3] = [
    ["OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"],
    ["PMI_RANK", "PMI_SIZE"],
    ["PMIX_RANK", "SLURM_STEP_NUM_TASKS"],
];

/// One of several processes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Process {
    /// Its number, from zero.
    rank: usize,
    /// How many there are.
    size: usize,
}

impl Process {
    /// This one; none where it was started alone.
    pub fn of_several() -> Option<Self> {
        let number = |name: &str| std::env::var(name).ok()?.parse().ok();
        VARIABLES
            .iter()
            .find_map(|[rank, size]| Some(Self { rank: number(rank)?, size: number(size)? }))
            .filter(|process| process.size > 1)
    }

    /// Whether it speaks for all.
    pub fn speaks(self) -> bool {
        self.rank == 0
    }

    /// What joins it to the others for a command.
    ///
    /// # Errors
    /// A command that several processes cannot do together.
    pub fn join(self, command: &Command) -> Result<Universe, Error> {
        let size = self.size;
        if !matches!(command, Command::Run(_)) {
            return Err(Error::Option {
                problem: format!("{size} processes were started for a command of one"),
                help: Some(
                    "only `creepage run` shares its work: start this one without mpirun".into(),
                ),
            });
        }
        Universe::new().ok_or_else(|| Error::Option {
            problem: format!("{size} processes were started, and this program was built without MPI"),
            help: Some(
                "build it with `cargo build --release --features mpi`, or start it without mpirun: \
                 --threads uses all cores of one machine"
                    .into(),
            ),
        })
    }

    /// Assists the first process; returns the exit code. It says what is wrong here alone: what the first can say, it says.
    pub fn assist(self, command: &Command) -> u8 {
        let assisted = self.join(command).map(|universe| match command {
            Command::Run(options) => creepage::assist(&universe.ranks(), options.threads),
            _ => Ok(()),
        });
        match assisted {
            Ok(Ok(())) => 0,
            Ok(Err(error)) => {
                terminal::message(&format!("process {}: {error}", self.rank));
                error.exit_code()
            }
            Err(error) => error.exit_code(),
        }
    }
}

/// Has the first process of `universe` share what the command runs.
pub fn lead(universe: &Universe, command: &mut Command) {
    if let Command::Run(options) = command {
        options.leader = Some(Arc::new(Leader::new(universe.ranks())));
    }
}
