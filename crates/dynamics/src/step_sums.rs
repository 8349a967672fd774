//! Sums over nodes and elements of a step of central difference.

use crate::hub::Resultant;
use crate::quiet::QuietWork;
use exact_sum::{ExactSum, WORDS};
use solid::ForceSums;

/// What the update sums up over the free nodes of a chunk.
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

/// Exact sums of a step, over the nodes and elements of one process until they are added up over all.
#[derive(Default)]
pub(crate) struct StepSums {
    /// Of the elements.
    pub(crate) elements: ForceSums<ExactSum>,
    /// Of the quiet ends.
    pub(crate) quiet: QuietWork<ExactSum>,
    /// Power of given forces after their ramp (W), before the step.
    pub(crate) given: ExactSum,
    /// As [`NodeSums`] has them.
    pub(crate) kinetic: ExactSum,
    pub(crate) dashpot_power: ExactSum,
    pub(crate) reaction: [ExactSum; 6],
    /// Force and moment on the hub.
    pub(crate) load: [ExactSum; 6],
}

impl StepSums {
    /// Words of all sums.
    pub(crate) const WORDS: usize = 22 * WORDS;

    fn each(&mut self) -> [&mut ExactSum; 22] {
        let Self { elements, quiet, given, kinetic, dashpot_power, reaction, load } = self;
        let [rx, ry, rz, rmx, rmy, rmz] = reaction;
        let [lx, ly, lz, lmx, lmy, lmz] = load;
        [
            &mut elements.internal,
            &mut elements.hourglass,
            &mut elements.viscous_power,
            &mut quiet.dissipated_before,
            &mut quiet.dissipated_after,
            &mut quiet.external_before,
            &mut quiet.external_after,
            given,
            kinetic,
            dashpot_power,
            rx,
            ry,
            rz,
            rmx,
            rmy,
            rmz,
            lx,
            ly,
            lz,
            lmx,
            lmy,
            lmz,
        ]
    }

    /// Writes the words of all sums.
    pub(crate) fn write_words(&mut self, words: &mut [i64]) {
        let words = words.as_chunks_mut::<WORDS>().0;
        self.each().into_iter().zip(words).for_each(|(sum, words)| *words = sum.words());
    }

    /// Takes the sums that these words are of.
    pub(crate) fn take_words(&mut self, words: &[i64]) {
        let words = words.as_chunks::<WORDS>().0;
        self.each()
            .into_iter()
            .zip(words)
            .for_each(|(sum, words)| *sum = ExactSum::of_words(words));
    }
}
