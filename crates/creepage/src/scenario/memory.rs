//! Memory: what a run needs, what the machine has free, what this process used.

mod control_groups;

use std::path::Path;

use output::files::input;

use crate::case::schema::Case;
use crate::scenario::error::ScenarioError;

/// Bytes per element that a whole run needs at most, during its static preload.
pub const BYTES_PER_ELEMENT: f64 = 950.0;

/// Bytes per element of the mesh and the elements alone.
const BYTES_PER_MESH_ELEMENT: f64 = 400.0;

/// Checks before the mesh of a case is made that the machine has the memory for it. Only the elements of the fine
/// zones count, which are known without the mesh; a mesh file is not looked at.
///
/// # Errors
/// [`ScenarioError::Memory`] where `bytes_per_element` times their number is more than is free.
pub fn enough_for_zones(case: &Case, bytes_per_element: f64) -> Result<(), ScenarioError> {
    // a mesh that is read has the elements of its file
    if case.mesh.file.is_some() {
        return Ok(());
    }
    let zone = &case.mesh.zone;
    let across = if case.mesh.plane_strain { 1.0 } else { zone.width / zone.size };
    let [rear, front] = case.mesh.zone_along();
    let elements = 2.0 * (front - rear) * zone.depth / zone.size.powi(2) * across;
    let bytes = bytes_per_element / case.mesh.symmetry.multiplicity();
    // also of half a model the whole mesh is made
    fits(elements as usize, bytes.max(BYTES_PER_MESH_ELEMENT), free_mb())
}

/// The same for the mesh and the elements alone.
///
/// # Errors
/// [`ScenarioError::Memory`].
pub fn enough_for_mesh(case: &Case) -> Result<(), ScenarioError> {
    enough_for_zones(case, BYTES_PER_MESH_ELEMENT)
}

/// Checks that the machine has the memory for a run of so many elements, where the system reports what is free.
///
/// # Errors
/// [`ScenarioError::Memory`].
pub fn enough_memory(elements: usize) -> Result<(), ScenarioError> {
    fits(elements, BYTES_PER_ELEMENT, free_mb())
}

fn fits(elements: usize, bytes_per_element: f64, free_mb: f64) -> Result<(), ScenarioError> {
    let free_gb = free_mb / 1e3;
    let needed_gb = elements as f64 * bytes_per_element / 1e9;
    if needed_gb > free_gb {
        return Err(ScenarioError::Memory { elements, needed_gb, free_gb });
    }
    Ok(())
}

/// Memory that the machine has free for this process (MB), within the limits of its control groups and of its address
/// space; infinite where the system does not report it.
pub fn free_mb() -> f64 {
    let free = entry("/proc/meminfo", "MemAvailable:").unwrap_or(f64::INFINITY);
    free.min(control_groups::free_mb(Path::new("/"))).min(address_space_mb())
}

/// Address space that threads reserve and the mesh takes before its size is known (MB). A refusal by the system
/// there would abort the program.
#[cfg(unix)]
const RESERVED_MB: f64 = 200.0;

/// Address space that its limit (`ulimit -v`) leaves to this process (MB).
#[cfg(unix)]
fn address_space_mb() -> f64 {
    let limit = rustix::process::getrlimit(rustix::process::Resource::As).current;
    let taken = entry("/proc/self/status", "VmSize:").unwrap_or(0.0) + RESERVED_MB;
    limit.map_or(f64::INFINITY, |bytes| (bytes as f64 / 1e6 - taken).max(0.0))
}

#[cfg(not(unix))]
fn address_space_mb() -> f64 {
    f64::INFINITY
}

/// Largest resident memory of this process so far (MB); zero where the system does not report it.
pub fn peak_rss_mb() -> f64 {
    entry("/proc/self/status", "VmHWM:").unwrap_or(0.0)
}

/// The entry `name`, in kibibytes, of a table of the system such as `/proc/meminfo` (MB).
fn entry(table: &str, name: &str) -> Option<f64> {
    let table = input::text(Path::new(table), input::LOG).ok()?;
    let line = table.lines().find_map(|l| l.strip_prefix(name))?;
    let kib = line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()?;
    Some(kib * 1024.0 / 1e6)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn what_the_machine_cannot_hold_is_refused_with_both_numbers_and_the_rest_is_not() {
        assert!(fits(2_000_000, 950.0, 1901.0).is_ok());
        let error = fits(2_000_000, 950.0, 500.0).unwrap_err();
        let said = error.to_string();
        for words in ["2000000 elements", "1.9 GB", "0.5 GB that are free", "mesh.zone.size"] {
            assert!(said.contains(words), "{words} is not in {said}");
        }
        assert_eq!((error.exit_code(), error.key()), (2, Some("mesh.zone.size")));
        // a system that does not tell
        assert!(fits(usize::MAX, 950.0, f64::INFINITY).is_ok());
    }

    #[test]
    fn fine_zones_are_counted_before_their_mesh_is_made() {
        let path = std::path::Path::new("a.toml");
        let text =
            "load.normal = 100e3\ndrive.speed = 38.89\ndrive.creepage = 0\nfriction.static = 0.5\n";
        let mut case = Case::from_text(text, path, &[]).unwrap();
        assert!(enough_for_zones(&case, BYTES_PER_ELEMENT).is_ok());
        // so many elements that no machine holds them
        case.mesh.zone.size = 1e-6;
        let begun = std::time::Instant::now();
        let error = crate::scenario::disk_on_bar::model(&case).err().unwrap();
        assert!(matches!(error, ScenarioError::Memory { .. }), "{error}");
        assert!(begun.elapsed().as_secs() < 5);
    }
}
