//! The mesh of a case alone: counts, quality, stable step, memory and run-time estimate.

use std::path::Path;

use crate::case::schema::{Case, Enforcement};
use crate::run::cost::step_seconds;
use crate::run::disk::Disk;
use crate::run::error::RunError;
use crate::run::folder::default_folder;
use crate::run::mesh_file::write_mesh;
use crate::scenario::memory::BYTES_PER_ELEMENT;
use serde_json::json;

/// Builds the mesh of a case, writes it to `out` if given (`.vtu` or `.msh` by its ending, else VTKHDF), and reports on it:
/// counts, quality, stable steps (s), memory (MB), run time (s; null for implicit steps) and room on the disk (MB). The step, and
/// with it the run time, is that without contact: closed springs of penalty contact lower it.
///
/// # Errors
/// A mesh that cannot be made or read, or that this machine has no memory for; a file that cannot be written.
pub fn mesh_report(case: &Case, out: Option<&Path>) -> Result<serde_json::Value, RunError> {
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
    let bodies: Vec<_> = model
        .mesh
        .bodies
        .iter()
        .map(|b| {
            json!({ "name": b.name, "nodes": b.nodes.len(), "elements": b.hexes.len(),
                         "sets": b.node_sets.iter().map(|(k, v)| (k.clone(), v.len()))
                                  .collect::<std::collections::BTreeMap<_, _>>() })
        })
        .collect();
    Ok(json!({
        "name": case.name,
        "symmetry": case.mesh.symmetry,
        "elements": elements,
        "fully_integrated": model.fully_integrated(),
        "nodes": nodes,
        "bodies": bodies,
        "notes": model.notes,
        "quality": {
            "min_scaled_jacobian": quality.min_scaled_jacobian,
            "mean_scaled_jacobian": quality.mean_scaled_jacobian,
            "max_aspect": quality.max_aspect,
            "min_edge": quality.min_edge,
            "worst_element": quality.worst_element,
        },
        "stable_dt": {
            "bound": 2.0 / bound,
            "bound_element": bound_element,
            "bound_element_centre": solid.centre(bound_element),
            "power_iteration": 2.0 / omega,
            "step": step,
        },
        "estimate": {
            "memory_mb": elements as f64 * BYTES_PER_ELEMENT / 1e6,
            "steps": steps,
            "run_time_s": run_time,
            "springs_lower_the_step": explicit && case.contact.enforcement == Enforcement::Penalty,
            "disk": Disk::of(case, &model, steps).json(&default_folder(case)),
        },
    }))
}
