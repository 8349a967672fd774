//! Connected parts.

/// Disjoint sets of items, joined pair by pair: the least item represents its set; path halving (Tarjan and van
/// Leeuwen 1984).
pub(super) struct Parts(Vec<u32>);

impl Parts {
    /// Each item by itself.
    pub(super) fn new(items: usize) -> Self {
        Self((0..items as u32).collect())
    }

    /// The least item of the part of `i`.
    pub(super) fn of(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            self.0[i as usize] = self.0[self.0[i as usize] as usize];
            i = self.0[i as usize];
        }
        i
    }

    /// Joins the parts of two items.
    pub(super) fn join(&mut self, i: u32, j: u32) {
        let (i, j) = (self.of(i), self.of(j));
        self.0[i.max(j) as usize] = i.min(j);
    }

    /// The least item outside the largest part, if there is one.
    pub(super) fn apart(&mut self) -> Option<u32> {
        let part: Vec<u32> = (0..self.0.len() as u32).map(|i| self.of(i)).collect();
        let mut size = vec![0u32; part.len()];
        part.iter().for_each(|&p| size[p as usize] += 1);
        let largest = (0..size.len()).rev().max_by_key(|&p| size[p])? as u32;
        (0..part.len() as u32).find(|&i| part[i as usize] != largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_item_apart_is_of_a_smaller_part() {
        let mut parts = Parts::new(5);
        for (i, j) in [(1, 2), (4, 2), (0, 3)] {
            parts.join(i, j);
        }
        assert_eq!(parts.apart(), Some(0));
        parts.join(3, 4);
        assert_eq!(parts.apart(), None);
        assert_eq!(Parts::new(0).apart(), None);
    }
}
