//! The layers of elements below the contact surfaces.

use crate::case::hertz::hertz;
use crate::case::schema::Case;

/// How deep they reach by default, over Hertz's half length of the patch: the field below the patch varies over that length,
/// and where less of it lies in sound elements slip fluctuates (docs/performance.md).
const DEPTH: f64 = 0.25;

/// And how many there are at least.
const LEAST: u64 = 2;

impl Case {
    /// How many layers of elements below each surface `element.contact_layers` speaks of.
    pub fn contact_layers(&self) -> u64 {
        let deep = || (DEPTH * hertz(self).a / self.mesh.zone.size - 1e-9).ceil() as u64;
        self.element.layers.unwrap_or_else(|| LEAST.max(deep()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::path::Path;

    #[test]
    fn layers_reach_a_quarter_of_the_patch_deep_and_are_two_at_least() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/zhao-li/a-coulomb.toml");
        let layers = |sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
            Case::load(&file, &sets).unwrap().contact_layers()
        };
        // the half length is 7.16 mm
        assert_eq!(layers(&["mesh.zone.size=2e-3"]), 2);
        assert_eq!(layers(&[]), 2);
        assert_eq!(layers(&["mesh.zone.size=0.5e-3"]), 4);
        assert_eq!(layers(&["mesh.zone.size=0.25e-3"]), 8);
        assert_eq!(layers(&["mesh.zone.size=0.25e-3", "element.layers=3"]), 3);
    }
}
