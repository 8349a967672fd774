//! Memory: what a run needs, what the machine has, what was used.

use crate::run_error::RunError;

/// Bytes per element of a whole run; the static preload takes the most.
pub(crate) const BYTES_PER_ELEMENT: f64 = 950.0;

/// Refuses a mesh that would bring the machine to its knees, where the system tells what is free.
pub(crate) fn enough_memory(elements: usize) -> Result<(), RunError> {
    let free_gb = free_mb() / 1e3;
    let needed_gb = elements as f64 * BYTES_PER_ELEMENT / 1e9;
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
