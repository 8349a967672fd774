//! The position of a disk with profiles on its bar.

use crate::case::schema::{Case, Crown, ProfileShape};
use mesh::profile::{ContactPoint, Profile, ProfileBody, ProfileError, WheelOnRail};

/// Half the width (m) of a body that has a crown, beside one that has a profile.
const HALF_WIDTH: f64 = 0.07;

impl Case {
    /// Whether one of the bodies has a profile in the place of a crown.
    pub fn has_profiles(&self) -> bool {
        self.disk.profile.is_some() || self.bar.profile.is_some()
    }

    /// Disk and bar by their profiles, of which a body without one has that of its crown; none where neither has one.
    ///
    /// # Errors
    /// Points that make no profile.
    pub fn wheel_on_rail(&self) -> Result<Option<WheelOnRail>, ProfileError> {
        if !self.has_profiles() {
            return Ok(None);
        }
        let (disk, bar) = (&self.disk, &self.bar);
        Ok(Some(WheelOnRail {
            wheel: shape(disk.profile.as_ref(), disk.crown_radius, ProfileBody::Wheel)?,
            rail: shape(bar.profile.as_ref(), bar.crown_radius, ProfileBody::Rail)?,
            radius: disk.radius,
            lateral: disk.lateral,
            yaw: disk.yaw,
            roll: disk.roll,
            cant: bar.cant,
        }))
    }

    /// Disk and bar by their profiles as [`Case::wheel_on_rail`], with the first point of contact.
    ///
    /// # Errors
    /// Points that make no profile, or a position without contact.
    pub fn first_contact(&self) -> Result<Option<(WheelOnRail, ContactPoint)>, ProfileError> {
        let Some(pair) = self.wheel_on_rail()? else { return Ok(None) };
        let point = pair.first_contact()?;
        Ok(Some((pair, point)))
    }

    /// Height (m) of the axle of an undeformed disk of finite elements over the point of first contact: its rolling radius there.
    pub fn axle_height(&self) -> f64 {
        let contact = self.first_contact().ok().flatten();
        contact.map_or(self.disk.radius, |(_, point)| point.rolling_radius)
    }
}

fn shape(
    profile: Option<&ProfileShape>,
    crown: Crown,
    body: ProfileBody,
) -> Result<Profile, ProfileError> {
    let outward = if body == ProfileBody::Wheel { -1.0 } else { 1.0 };
    match (profile, crown.radius()) {
        (Some(profile), _) => profile.profile(body),
        (None, Some(radius)) => Ok(Profile::crown(outward * radius, HALF_WIDTH.min(0.9 * radius))),
        (None, None) => Ok(Profile::cone(0.0, HALF_WIDTH)),
    }
}
