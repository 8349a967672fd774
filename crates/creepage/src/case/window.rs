//! A fine zone that follows the contact: how far its mesh moves at a time.

use crate::case::hertz::hertz;
use crate::case::schema::Case;

/// The half of a patch beyond Hertz's, which meshes and penalties make longer.
const PATCH: f64 = 1.15;

/// A move of more columns gains nothing.
const MOST_COLUMNS: u32 = 16;

impl Case {
    /// What the patch needs of the zone before and behind its centre (m).
    fn patch_reach(&self) -> f64 {
        PATCH * hertz(self).a + self.mesh.zone.size
    }

    /// The shortest zone (m) that can follow the contact.
    pub fn shortest_window(&self) -> f64 {
        2.0 * self.patch_reach() + self.mesh.zone.size
    }

    /// By how many columns of elements the mesh moves at a time: a power of two, the pattern with which columns are merged;
    /// zero where the zone has no room for the patch. None where the zone stays.
    pub fn window_columns(&self) -> Option<u32> {
        self.mesh.window?;
        let [rear, front] = self.mesh.zone_along();
        let room = (front - rear - 2.0 * self.patch_reach()) / self.mesh.zone.size + 1e-9;
        let mut columns = MOST_COLUMNS;
        while columns > 0 && f64::from(columns) > room {
            columns /= 2;
        }
        Some(columns)
    }
}
