//! Memory: what a run needs, what the machine has, what was used.

use crate::run_error::RunError;
use crate::schema::Case;

/// Bytes per element of a whole run; the static preload takes the most.
pub(crate) const BYTES_PER_ELEMENT: f64 = 950.0;

/// Bytes per element of its mesh alone, with the elements set up.
const BYTES_PER_MESH_ELEMENT: f64 = 400.0;

/// Refuses a case before its mesh is made where the fine zones alone, which are known without it, are more
/// than the machine can hold at so many bytes per element.
pub(crate) fn enough_for_zones(case: &Case, bytes_per_element: f64) -> Result<(), RunError> {
    let zone = &case.mesh.zone;
    let across = if case.mesh.plane_strain { 1.0 } else { zone.width / zone.size };
    let elements = 2.0 * zone.length * zone.depth / zone.size.powi(2) * across;
    fits(elements as usize, bytes_per_element, free_mb())
}

/// The same for the mesh alone.
pub(crate) fn enough_for_mesh(case: &Case) -> Result<(), RunError> {
    enough_for_zones(case, BYTES_PER_MESH_ELEMENT)
}

/// Refuses a mesh that would bring the machine to its knees, where the system tells what is free.
pub(crate) fn enough_memory(elements: usize) -> Result<(), RunError> {
    fits(elements, BYTES_PER_ELEMENT, free_mb())
}

fn fits(elements: usize, bytes_per_element: f64, free_mb: f64) -> Result<(), RunError> {
    let free_gb = free_mb / 1e3;
    let needed_gb = elements as f64 * bytes_per_element / 1e9;
    if needed_gb > free_gb {
        return Err(RunError::Memory { elements, needed_gb, free_gb });
    }
    Ok(())
}

/// Memory that the machine has free (MB); infinite where the system does not tell.
pub(crate) fn free_mb() -> f64 {
    let table = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = table.lines().find_map(|l| l.strip_prefix("MemAvailable:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kib.map_or(f64::INFINITY, |k| k * 1024.0 / 1e6)
}

/// Largest resident memory of this process so far (MB); zero where the system does not tell.
pub(crate) fn peak_rss_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kib.map_or(0.0, |k| k * 1024.0 / 1e6)
}
