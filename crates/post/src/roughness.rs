//! The argument of the paper's Figure 4 as a number: where slip velocity fluctuates, the law wants
//! the shear to fluctuate with it.

use std::collections::VecDeque;

/// Standard deviations in time of p_f/p_n and of mu(|s|) at slipping nodes, both high-passed.
///
/// The high pass subtracts the mean over a tenth of a contact transit, 2a/(10 V), centred on the
/// sample: the trend that every node goes through along the patch drops out, the fluctuation
/// stays. A sample counts where the whole span lies in one uninterrupted spell of slip with
/// records at equal intervals.
pub(crate) struct Roughness {
    span: f64,
    threads: Vec<Option<Spell>>,
    weight: f64,
    squares: [f64; 2],
}

/// An uninterrupted spell of slip of one node.
struct Spell {
    last: f64,
    interval: f64,
    samples: VecDeque<[f64; 2]>,
    sums: [f64; 2],
}

/// Most samples in a span; beyond it the records lie so close that every second one would do.
const MOST: usize = 4001;

impl Roughness {
    /// For `nodes` nodes, with means over `span` (s).
    pub fn new(nodes: usize, span: f64) -> Self {
        Self { span, threads: (0..nodes).map(|_| None).collect(), weight: 0.0, squares: [0.0; 2] }
    }

    /// A node slips at `time`, with p_f/p_n and mu(|s|).
    pub fn add(&mut self, node: usize, time: f64, values: [f64; 2], area: f64) {
        let fresh =
            || Spell { last: time, interval: 0.0, samples: VecDeque::new(), sums: [0.0; 2] };
        let spell = self.threads[node].get_or_insert_with(fresh);
        if let Some(previous) = spell.samples.back().copied() {
            let interval = time - spell.last;
            if spell.samples.len() > 1 && (interval / spell.interval - 1.0).abs() > 0.01 {
                // the rhythm of the records changes: a new spell, from the sample before
                spell.samples.clear();
                spell.samples.push_back(previous);
                spell.sums = previous;
            }
            if spell.samples.len() == 1 {
                spell.interval = interval;
            }
        }
        spell.last = time;
        spell.samples.push_back(values);
        (0..2).for_each(|i| spell.sums[i] += values[i]);
        if spell.samples.len() < 2 {
            return;
        }
        let half = (0.5 * self.span / spell.interval + 1e-6).floor() as usize;
        let whole = 2 * half + 1;
        if half == 0 || whole > MOST {
            return;
        }
        while spell.samples.len() > whole {
            if let Some(gone) = spell.samples.pop_front() {
                (0..2).for_each(|i| spell.sums[i] -= gone[i]);
            }
        }
        if spell.samples.len() == whole {
            let weight = area * spell.interval;
            self.weight += weight;
            for i in 0..2 {
                let away = spell.samples[half][i] - spell.sums[i] / whole as f64;
                self.squares[i] += weight * away * away;
            }
        }
    }

    /// A node does not slip.
    pub fn interrupt(&mut self, node: usize) {
        self.threads[node] = None;
    }

    /// The standard deviations of p_f/p_n and of mu(|s|); `None` where no spell is long enough.
    pub fn deviations(&self) -> Option<[f64; 2]> {
        (self.weight > 0.0).then(|| self.squares.map(|squares| (squares / self.weight).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn trends_drop_out_and_fluctuations_stay() {
        let mut roughness = Roughness::new(1, 1.0);
        for i in 0..1000 {
            let t = 0.01 * f64::from(i);
            let chatter = if i % 2 == 0 { 1.0 } else { -1.0 };
            roughness.add(0, t, [3.0 * t + 0.2 * chatter, 7.0 - t + 0.1 * chatter], 1.0);
        }
        let [shear, law] = roughness.deviations().unwrap();
        // 0.2 (1 - 1/101): the mean over an odd number of samples keeps one
        assert!((shear - 0.2 * (1.0 - 1.0 / 101.0)).abs() < 1e-6, "{shear}");
        assert!((shear / law - 2.0).abs() < 1e-10);
    }

    #[test]
    fn spells_shorter_than_the_span_do_not_count() {
        let mut roughness = Roughness::new(1, 1.0);
        for i in 0..300 {
            if i % 50 == 0 {
                roughness.interrupt(0);
            }
            roughness.add(0, 0.01 * f64::from(i), [1.0, 1.0], 1.0);
        }
        assert_eq!(roughness.deviations(), None);
    }

    #[test]
    fn a_change_of_the_interval_starts_a_new_spell() {
        let mut roughness = Roughness::new(1, 1.0);
        (0..60).for_each(|i| roughness.add(0, 0.01 * f64::from(i), [1.0, 1.0], 1.0));
        (0..60).for_each(|i| roughness.add(0, 1.0 + 0.02 * f64::from(i), [1.0, 1.0], 1.0));
        assert_eq!(roughness.deviations(), Some([0.0; 2]));
        let before = roughness.weight;
        assert!((before / 0.02 - 10.0).abs() < 1e-9, "{before}");
    }
}
