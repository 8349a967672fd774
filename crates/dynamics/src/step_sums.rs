//! Sums over the nodes of a step of central difference.

use crate::hub::Resultant;

/// What the update sums up over the free nodes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NodeSums {
    /// sum 1/2 m v^{n-1/2} . v^{n+1/2} (J), the kinetic energy that central difference
    /// conserves; zero unless asked for.
    pub(crate) kinetic: f64,
    /// Power that the dashpots dissipate (W).
    pub(crate) dashpot_power: f64,
    /// Reaction of the upper body's dashpots on the hub; on a straight path force in x and z and moment about y alone.
    pub(crate) reaction: Resultant,
}

impl NodeSums {
    pub(crate) fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.dashpot_power += other.dashpot_power;
        self.reaction.add(&other.reaction);
    }
}
