//! A run whose steps several processes share: process 0 runs the case as if it were alone, the others assist it.

use crate::case::schema::Case;
use crate::run::error::RunError;
use crate::run::log::Log;
use crate::run::options::RunOptions;
use crate::scenario::{InitialState, KeptState, Model, model, restart_without_moves};
use dynamics::{Partition, Ranks, ShareSize, Simulation, SimulationState, share_sizes};
use output::layout::file;
use serde::{Deserialize, Serialize};
use solid::{FULL_COST, Level, Solid};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// How long contact takes process 0 while the others compute elements, by node of its surfaces, in elements: about half of what the
/// reference disk and bar at 1 mm takes for contact.
const CONTACT: f64 = 0.25;

/// What the other processes must know to be in the state of process 0.
#[derive(Serialize, Deserialize)]
struct SharedRun {
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
    shared: AtomicBool,
}

impl Leader {
    /// The first of these processes.
    pub fn new(ranks: Arc<dyn Ranks>) -> Self {
        Self { ranks, shared: AtomicBool::new(false) }
    }

    /// Whether the other processes have got their share: they end with the run, and share no second one.
    pub(super) fn has_shared(&self) -> bool {
        self.shared.load(Ordering::Relaxed)
    }

    /// Whether the steps of a case can be shared.
    ///
    /// # Errors
    /// A case that one process must run.
    pub(super) fn check(case: &Case) -> Result<(), RunError> {
        let alone = [
            (case.is_half_space(), "half-spaces"),
            (case.theta().is_some(), "implicit steps"),
            (case.mesh.plane_strain, "a slice in plane strain"),
        ];
        match alone.into_iter().find(|(is, _)| *is) {
            Some((_, what)) => Err(RunError::OneProcess { what }),
            None => Ok(()),
        }
    }

    /// Shares the steps of the simulation with the other processes.
    pub(super) fn share(
        &self,
        case: &Case,
        options: &RunOptions,
        model: &Model,
        facts: &InitialState,
        simulation: &mut Simulation,
        log: &mut Log,
    ) -> Result<(), RunError> {
        let shared = SharedRun {
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
        let mut bytes = output::bytes_of(&shared)?;
        self.shared.store(true, Ordering::Relaxed);
        self.ranks.broadcast(&mut bytes);
        agree(&self.ranks, true)?;
        let sizes = simulation.take_share(self.ranks.clone(), shared.partition);
        Ok(log.say(&SharedWork::of(&sizes, model.mesh.hexes.len()).line())?)
    }
}

impl Drop for Leader {
    fn drop(&mut self) {
        if !self.has_shared() {
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
        let shared: Result<SharedRun, RunError> = output::of_bytes(&bytes).map_err(RunError::from);
        let made = shared.and_then(|shared| Ok((simulation(&shared)?, shared.partition)));
        let agreed = agree(ranks, made.is_ok());
        let (mut simulation, partition) = made?;
        if agreed.is_ok() {
            simulation.take_share(ranks.clone(), partition);
            simulation.assist().map_err(RunError::of_processes)?;
        }
        // where another process is not ready, that says why
        Ok(())
    })
}

/// The simulation in the state of process 0.
fn simulation(shared: &SharedRun) -> Result<Simulation, RunError> {
    let case = Case::from_text(&shared.case, &shared.file, &[])
        .map_err(|error| RunError::Process { reason: error.to_string() })?;
    let mut model = model(&case)?;
    model.kernels =
        Level::named(&shared.kernels).and_then(Level::with_the_same_bits).ok_or_else(|| {
            RunError::Process {
                reason: format!("no {} kernels, which process 0 has", shared.kernels),
            }
        })?;
    let found = shared.found.clone();
    Ok(restart_without_moves(&case, &model, found, &shared.simulation)?.simulation)
}

/// Whether all processes are `ready`.
fn agree(ranks: &Arc<dyn Ranks>, ready: bool) -> Result<(), RunError> {
    let reason = || "another process could not set up the run, and says why".into();
    if ranks.all(ready) { Ok(()) } else { Err(RunError::Process { reason: reason() }) }
}

/// How processes share the work of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SharedWork {
    /// How many they are.
    pub processes: usize,
    /// Fewest and most elements that one computes.
    pub elements: [usize; 2],
    /// Elements that more than one compute, counted as often as they are computed again, over all elements.
    pub computed_again: f64,
    /// Most bytes that one sends in a step.
    pub sent: usize,
}

impl SharedWork {
    fn of(sizes: &[ShareSize], elements: usize) -> Self {
        let of = |value: fn(&ShareSize) -> usize| sizes.iter().map(value);
        let computed = || of(|size| size.elements);
        Self {
            processes: sizes.len(),
            elements: [computed().min(), computed().max()].map(Option::unwrap_or_default),
            computed_again: computed().sum::<usize>() as f64 / elements as f64 - 1.0,
            sent: of(|size| size.sent).max().unwrap_or_default(),
        }
    }

    /// Of so many processes that would share a run of this model, whose elements are `solid`.
    pub(super) fn of_model(
        case: &Case,
        model: &Model,
        solid: &mut Solid,
        processes: usize,
    ) -> Result<Self, RunError> {
        let contact = model.contact_nodes(case)?;
        let partition = partition(model, processes);
        let sizes = share_sizes(solid, &partition, processes, &model.hub, contact.trace());
        Ok(Self::of(&sizes, model.mesh.hexes.len()))
    }

    fn line(&self) -> String {
        let Self { processes, elements: [fewest, most], computed_again, sent } = self;
        format!(
            "processes: {processes}, which compute {fewest} to {most} elements each, {:.1} % of all once more, and send up \
             to {:.1} kB in a step each",
            1e2 * computed_again,
            1e-3 * *sent as f64
        )
    }
}

/// Nodes by recursive coordinate bisection, so that all processes have the same work: process 0 has that of contact besides.
fn partition(model: &Model, processes: usize) -> Partition {
    let mut weight = vec![0.0; model.mesh.nodes.len()];
    for (element, hex) in model.mesh.hexes.iter().enumerate() {
        let full = model.full.get(element) == Some(&true);
        let cost = if full { FULL_COST as f64 } else { 1.0 };
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
