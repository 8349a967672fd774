//! A run whose steps several processes share: process 0 runs the case as if it were alone, the others assist it.

use crate::case::schema::Case;
use crate::run::error::RunError;
use crate::run::options::RunOptions;
use crate::scenario::{InitialState, KeptState, Model, model, restart};
use dynamics::{Partition, Ranks, Simulation, SimulationState};
use output::layout::file;
use serde::{Deserialize, Serialize};
use solid::Level;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A node of the contact surfaces takes contact about as long as an element takes to compute, in elements: of the reference disk and
/// bar at 1 mm.
const CONTACT: f64 = 0.1;

/// A fully integrated element takes about as long as this many one-point elements.
const FULL: f64 = 4.0;

/// What the other processes must know to be in the state of process 0.
#[derive(Serialize, Deserialize)]
struct Told {
    /// The case, and the file that relative paths in it are beside.
    case: String,
    file: PathBuf,
    /// The instruction set of the kernels.
    kernels: String,
    found: KeptState,
    simulation: SimulationState,
    partition: Partition,
}

/// The first of several processes. The others wait until it tells them what to do; where it never comes to that, they end when
/// it is dropped.
#[derive(Debug)]
pub struct Leader {
    ranks: Arc<dyn Ranks>,
    told: AtomicBool,
}

impl Leader {
    /// The first of these processes.
    pub fn new(ranks: Arc<dyn Ranks>) -> Self {
        Self { ranks, told: AtomicBool::new(false) }
    }

    /// Whether the steps of a case can be shared.
    ///
    /// # Errors
    /// A case that one process must run.
    pub(super) fn check(case: &Case) -> Result<(), RunError> {
        let alone = [
            (case.is_half_space(), "half-spaces"),
            (case.theta().is_some(), "implicit steps"),
            (case.mesh.window.is_some(), "a fine zone that follows the contact (mesh.window)"),
            (case.mesh.plane_strain, "a slice in plane strain"),
        ];
        match alone.into_iter().find(|(is, _)| *is) {
            Some((_, what)) => Err(RunError::OneProcess { what }),
            None => Ok(()),
        }
    }

    /// How many processes there are.
    pub(super) fn size(&self) -> usize {
        self.ranks.size()
    }

    /// Shares the steps of the simulation with the other processes.
    pub(super) fn share(
        &self,
        case: &Case,
        options: &RunOptions,
        model: &Model,
        facts: &InitialState,
        simulation: &mut Simulation,
    ) -> Result<(), RunError> {
        let told = Told {
            case: case.to_toml(),
            file: options.folder(case).join(file::CASE),
            kernels: model.kernels.name().into(),
            found: facts.found(),
            simulation: simulation.snapshot(),
            partition: match &options.partition {
                Some(partition) => partition.clone(),
                None => partition(model, self.ranks.size()),
            },
        };
        let mut bytes = output::bytes_of(&told)?;
        self.told.store(true, Ordering::Relaxed);
        self.ranks.broadcast(&mut bytes);
        agree(&self.ranks, true)?;
        simulation.take_share(self.ranks.clone(), told.partition);
        Ok(())
    }
}

impl Drop for Leader {
    fn drop(&mut self) {
        if !self.told.load(Ordering::Relaxed) {
            self.ranks.broadcast(&mut Vec::new());
        }
    }
}

/// Shares the steps of the run of process 0, with so many threads, until they are done.
///
/// # Errors
/// A mesh that cannot be made here, kernels or memory that are not here.
pub fn assist(ranks: &Arc<dyn Ranks>, threads: usize) -> Result<(), RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    pool.install(|| {
        let mut bytes = Vec::new();
        ranks.broadcast(&mut bytes);
        if bytes.is_empty() {
            return Ok(());
        }
        let told: Result<Told, RunError> = output::of_bytes(&bytes).map_err(RunError::from);
        let made = told.and_then(|told| Ok((simulation(&told)?, told.partition)));
        let agreed = agree(ranks, made.is_ok());
        let (mut simulation, partition) = made?;
        if agreed.is_ok() {
            simulation.take_share(ranks.clone(), partition);
            simulation.assist();
        }
        // where another process is not ready, that says why
        Ok(())
    })
}

/// The simulation in the state of process 0.
fn simulation(told: &Told) -> Result<Simulation, RunError> {
    let case = Case::from_text(&told.case, &told.file, &[])
        .map_err(|error| RunError::Process { reason: error.to_string() })?;
    let mut model = model(&case)?;
    model.kernels =
        Level::named(&told.kernels).and_then(Level::with_the_same_bits).ok_or_else(|| {
            RunError::Process {
                reason: format!("it cannot run {} kernels, which process 0 has", told.kernels),
            }
        })?;
    Ok(restart(&case, &model, told.found.clone(), &told.simulation)?.simulation)
}

/// Whether all processes are `ready`.
fn agree(ranks: &Arc<dyn Ranks>, ready: bool) -> Result<(), RunError> {
    let mut unready = [i64::from(!ready)];
    ranks.add(&mut unready);
    let reason = || "it could not set up the run, and says why".into();
    if unready[0] == 0 { Ok(()) } else { Err(RunError::Process { reason: reason() }) }
}

/// Nodes by recursive coordinate bisection, so that all processes have the same work: process 0 has that of contact besides.
fn partition(model: &Model, processes: usize) -> Partition {
    let mut weight = vec![0.0; model.mesh.nodes.len()];
    for (element, hex) in model.mesh.hexes.iter().enumerate() {
        let cost = if model.full.get(element) == Some(&true) { FULL } else { 1.0 };
        hex.iter().for_each(|&n| weight[n as usize] += cost / 8.0);
    }
    let elements: f64 = weight.iter().sum();
    let mut surface: Vec<u32> =
        model.surfaces.iter().flat_map(|s| s.faces.iter().flat_map(|f| f.nodes)).collect();
    surface.sort_unstable();
    surface.dedup();
    let contact = CONTACT * surface.len() as f64;
    let each = (elements + contact) / processes as f64;
    let mut parts = vec![each; processes];
    parts[0] = (each - contact).max(0.05 * each);
    let reference: Vec<_> = model.mesh.nodes.iter().map(|&x| x.into()).collect();
    Partition::bisected(&reference, &weight, &parts)
}
