//! The mesh of a case alone: counts, quality, stable step, memory and run-time estimate.

use std::path::Path;

use crate::case::schema::{Case, Enforcement, Symmetry};
use crate::run::cost::step_seconds;
use crate::run::disk::{Disk, DiskEstimate};
use crate::run::error::RunError;
use crate::run::folder::default_folder;
use crate::run::mesh_file::write_mesh;
use crate::run::processes::{Leader, SharedWork};
use crate::scenario::memory::BYTES_PER_ELEMENT;
use crate::scenario::numbers::numbers;
use crate::scenario::wheel_on_rail::PositionReport;
use output::summary::Numbers;
use serde::Serialize;
use std::collections::BTreeMap;

/// The mesh of a case, and what a run of it takes.
#[derive(Clone, Debug, Default, Serialize)]
pub struct MeshReport {
    /// Name of the case.
    pub name: String,
    /// Whether half of the bodies is modelled.
    pub symmetry: Symmetry,
    /// Number of elements.
    pub elements: usize,
    /// How many of them are fully integrated.
    pub fully_integrated: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// The bodies.
    pub bodies: Vec<BodyReport>,
    /// What was chosen or corrected, and what to expect of falling friction.
    pub notes: Vec<String>,
    /// Where a wheel with profiles touches the rail, and how it would press half-spaces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<PositionReport>,
    /// The dimensionless numbers of contact and friction.
    pub numbers: Numbers,
    /// Shapes of the elements.
    pub quality: QualityReport,
    /// Time steps (s).
    pub stable_dt: StableStep,
    /// What a run takes.
    pub estimate: Estimate,
    /// How several processes would share a run, if that was asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shared: Option<SharedWork>,
}

/// A body of a mesh.
#[derive(Clone, Debug, Default, Serialize)]
pub struct BodyReport {
    /// Its name.
    pub name: String,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of elements.
    pub elements: usize,
    /// Its sets of nodes, with the number of nodes of each.
    pub sets: BTreeMap<String, usize>,
}

/// Shapes of the elements of a mesh; [`mesh::Quality`] defines the numbers.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct QualityReport {
    /// Least scaled Jacobian.
    pub min_scaled_jacobian: f64,
    /// Mean scaled Jacobian.
    pub mean_scaled_jacobian: f64,
    /// Largest ratio of an element's longest edge to its shortest.
    pub max_aspect: f64,
    /// Shortest edge (m).
    pub min_edge: f64,
    /// Element with the least scaled Jacobian.
    pub worst_element: usize,
}

/// Time steps (s).
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct StableStep {
    /// Below this every element alone is stable.
    pub bound: f64,
    /// The element that gives this bound.
    pub bound_element: usize,
    /// Its centre (m).
    pub bound_element_centre: [f64; 3],
    /// 2/omega of the elastic bodies, by power iteration.
    pub power_iteration: f64,
    /// The step of the case.
    pub step: f64,
}

/// What a run takes.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Estimate {
    /// Memory (MB).
    pub memory_mb: f64,
    /// Number of steps.
    pub steps: f64,
    /// Time (s); none of implicit steps.
    pub run_time_s: Option<f64>,
    /// Whether closed springs lower the step.
    pub springs_lower_the_step: bool,
    /// Room on the disk.
    pub disk: DiskEstimate,
}

/// Builds the mesh of a case, writes it to `out` if given (`.vtu` or `.msh` by its ending, else VTKHDF), and reports on it:
/// counts, quality, stable steps (s), memory (MB), run time (s; null for implicit steps) and room on the disk (MB), and how so
/// many processes (`ranks`) would share the run. The step, and with it the run time, is that without contact: closed springs of
/// penalty contact lower it.
///
/// # Errors
/// A mesh that cannot be made or read, or that this machine has no memory for; a file that cannot be written.
pub fn mesh_report(
    case: &Case,
    out: Option<&Path>,
    ranks: Option<usize>,
) -> Result<MeshReport, RunError> {
    if ranks.is_some() {
        Leader::check(case)?;
    }
    if out.is_none()
        && let Some(found) = position_report(case)?
    {
        return Ok(found);
    }
    let model = crate::scenario::model(case)?;
    let mut solid = model.solid(case)?;
    let quality = mesh::quality(&model.mesh);
    let (bound, bound_element) =
        solid::element_frequency_bound(&model.mesh, &model.materials, model.elements());
    let omega = model.elastic_frequency(&mut solid);
    let elements = model.mesh.hexes.len();
    let nodes = model.mesh.nodes.len();
    let step = case.step().under(case.stable_limit(omega));
    let steps = (case.duration() / step).ceil();
    // How many products with the stiffness an implicit step takes depends on its contact: 140 to 4000 in the cases of the project.
    let explicit = case.theta().is_none();
    let run_time = explicit.then(|| steps * step_seconds(&mut solid, nodes));
    if let Some(path) = out {
        write_mesh(path, case, &model)?;
    }
    let shared =
        ranks.map(|ranks| SharedWork::of_model(case, &model, &mut solid, ranks)).transpose()?;
    let friction = numbers(case, &model, step);
    let bodies = model.mesh.bodies.iter().map(|body| BodyReport {
        name: body.name.clone(),
        nodes: body.nodes.len(),
        elements: body.hexes.len(),
        sets: body.node_sets.iter().map(|(name, nodes)| (name.clone(), nodes.len())).collect(),
    });
    Ok(MeshReport {
        name: case.name.clone(),
        symmetry: case.mesh.symmetry,
        position: model.position,
        elements,
        fully_integrated: model.fully_integrated(),
        nodes,
        bodies: bodies.collect(),
        notes: model
            .notes
            .iter()
            .cloned()
            .chain(model.position.iter().flat_map(PositionReport::lines))
            .chain(friction.line())
            .chain(friction.expectation())
            .collect(),
        numbers: friction.result(),
        quality: QualityReport {
            min_scaled_jacobian: quality.min_scaled_jacobian,
            mean_scaled_jacobian: quality.mean_scaled_jacobian,
            max_aspect: quality.max_aspect,
            min_edge: quality.min_edge,
            worst_element: quality.worst_element,
        },
        stable_dt: StableStep {
            bound: 2.0 / bound,
            bound_element,
            bound_element_centre: solid.centre(bound_element).into(),
            power_iteration: 2.0 / omega,
            step,
        },
        estimate: Estimate {
            memory_mb: elements as f64 * BYTES_PER_ELEMENT / 1e6,
            steps,
            run_time_s: run_time,
            springs_lower_the_step: explicit && case.contact.enforcement == Enforcement::Penalty,
            disk: Disk::of(case, &model, steps).estimate(&default_folder(case)),
        },
        shared,
    })
}

/// What there is to report of half-spaces with profiles.
fn position_report(case: &Case) -> Result<Option<MeshReport>, RunError> {
    if !case.is_half_space() {
        return Ok(None);
    }
    let position = crate::scenario::position(case)?;
    Ok(position.map(|position| MeshReport {
        name: case.name.clone(),
        notes: position.lines().into(),
        position: Some(position),
        ..MeshReport::default()
    }))
}
