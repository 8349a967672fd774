//! The argument of the paper's Figure 4 as a number: where the slip velocity fluctuates, the shear must
//! fluctuate with it by the law.

/// Standard deviations in time of p_f/p_n, of mu(|s|) and of |s|/s_c at slipping nodes, high-passed.
///
/// The high pass subtracts the mean over a tenth of a contact transit, 2a/(10 V), centred on the
/// sample: this removes the trend along the patch and leaves the fluctuation. A sample counts where the
/// whole span lies in one uninterrupted spell of slip with records at equal intervals.
pub(crate) struct Roughness {
    span: f64,
    last: Option<f64>,
    /// Interval of the records, known from the second one on.
    interval: Option<f64>,
    /// Number of this record since the interval last changed, from 0.
    record: usize,
    /// Records on each side of the middle of the span; zero where they lie too far apart or too close.
    half: usize,
    /// The values of the last `2 half + 1` records, each for all nodes that have slipped, at their places: memory is
    /// accessed nearly in order. A record has no values before a node slips in it.
    ring: Vec<Vec<[f64; 3]>>,
    /// The place of each node in the records of the ring, or [`NONE`] for one that has not slipped, and their number.
    places: Vec<usize>,
    taken: usize,
    /// Number of the record with which the spell of each node began, or [`NONE`].
    since: Vec<usize>,
    sums: Vec<[f64; 3]>,
    weight: f64,
    squares: [f64; 3],
}

const NONE: usize = usize::MAX;

/// Most records in a span, which bounds the memory of the ring. With more there is no measure.
const MOST: usize = 4001;

impl Roughness {
    /// For `nodes` nodes, with means over `span` (s).
    pub fn new(nodes: usize, span: f64) -> Self {
        Self {
            span,
            last: None,
            interval: None,
            record: 0,
            half: 0,
            ring: vec![Vec::new()],
            places: vec![NONE; nodes],
            taken: 0,
            since: vec![NONE; nodes],
            sums: vec![[0.0; 3]; nodes],
            weight: 0.0,
            squares: [0.0; 3],
        }
    }

    /// Begins a record at `time` (s). Where the interval changes, spells restart with the record before.
    pub fn begin(&mut self, time: f64) {
        let Some(last) = self.last.replace(time) else {
            return;
        };
        let step = time - last;
        self.record += 1;
        if self.interval.is_some_and(|interval| (step - interval).abs() <= 0.01 * interval) {
            return;
        }
        let before = (self.record - 1) % self.ring.len();
        self.ring.swap(0, before);
        let nodes = self.since.len();
        let half = (0.5 * self.span / step + 1e-6).floor() as usize;
        self.half = if 2 * half < MOST { half } else { 0 };
        self.ring.resize(2 * self.half + 1, Vec::new());
        for node in 0..nodes {
            if self.since[node] != NONE {
                self.since[node] = 0;
                self.sums[node] = self.ring[0][self.places[node]];
            }
        }
        self.interval = Some(step);
        self.record = 1;
    }

    /// Adds a node that slips in this record, with p_f/p_n, mu(|s|) and |s|/s_c, and its area (m2).
    pub fn add(&mut self, node: usize, values: [f64; 3], area: f64) {
        let whole = self.ring.len();
        let slot = self.record % whole;
        if self.since[node] == NONE {
            self.since[node] = self.record;
            self.sums[node] = [0.0; 3];
        }
        if self.places[node] == NONE {
            self.places[node] = self.taken;
            self.taken += 1;
        }
        let place = self.places[node];
        let row = &mut self.ring[slot];
        if row.len() <= place {
            row.resize(self.taken, [0.0; 3]);
        }
        let gone = std::mem::replace(&mut row[place], values);
        let count = self.record - self.since[node] + 1;
        let sums = &mut self.sums[node];
        for i in 0..3 {
            sums[i] += if count > whole { values[i] - gone[i] } else { values[i] };
        }
        if let (true, Some(interval)) = (self.half > 0 && count >= whole, self.interval) {
            let middle = self.ring[(self.record - self.half) % whole][place];
            let weight = area * interval;
            self.weight += weight;
            for i in 0..3 {
                let away = middle[i] - sums[i] / whole as f64;
                self.squares[i] += weight * away * away;
            }
        }
    }

    /// Adds a node that does not slip: its spell ends.
    pub fn interrupt(&mut self, node: usize) {
        self.since[node] = NONE;
    }

    /// The standard deviations of p_f/p_n, of mu(|s|) and of |s|/s_c; `None` where no spell is long enough.
    pub fn deviations(&self) -> Option<[f64; 3]> {
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
            roughness.begin(t);
            roughness.add(0, [3.0 * t + 0.2 * chatter, 7.0 - t + 0.1 * chatter, chatter], 1.0);
        }
        let [shear, law, slip] = roughness.deviations().unwrap();
        // 0.2 (1 - 1/101): the mean over an odd number of samples keeps one
        assert!((shear - 0.2 * (1.0 - 1.0 / 101.0)).abs() < 1e-6, "{shear}");
        assert!((shear / law - 2.0).abs() < 1e-10);
        assert!((slip / law - 10.0).abs() < 1e-9);
    }

    #[test]
    fn spells_shorter_than_the_span_do_not_count() {
        let mut roughness = Roughness::new(1, 1.0);
        for i in 0..300 {
            if i % 50 == 0 {
                roughness.interrupt(0);
            }
            roughness.begin(0.01 * f64::from(i));
            roughness.add(0, [1.0; 3], 1.0);
        }
        assert_eq!(roughness.deviations(), None);
    }

    #[test]
    fn a_change_of_the_interval_starts_a_new_spell() {
        let mut roughness = Roughness::new(1, 1.0);
        let mut record = |time: f64| {
            roughness.begin(time);
            roughness.add(0, [1.0; 3], 1.0);
        };
        (0..60).for_each(|i| record(0.01 * f64::from(i)));
        (0..60).for_each(|i| record(1.0 + 0.02 * f64::from(i)));
        assert_eq!(roughness.deviations(), Some([0.0; 3]));
        let before = roughness.weight;
        assert!((before / 0.02 - 10.0).abs() < 1e-9, "{before}");
    }

    #[test]
    fn nodes_that_never_slip_take_no_memory_in_the_records() {
        let mut roughness = Roughness::new(1000, 1.0);
        for i in 0..300 {
            roughness.begin(0.01 * f64::from(i));
            let chatter = if i % 2 == 0 { 1.0 } else { -1.0 };
            roughness.add(3, [chatter; 3], 1.0);
            roughness.add(999, [chatter; 3], 1.0);
        }
        assert!(roughness.ring.iter().all(|row| row.len() == 2));
        assert!(roughness.deviations().unwrap().iter().all(|one| (one - 1.0).abs() < 0.01));
    }
}
