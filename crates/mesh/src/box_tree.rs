//! Which of many boxes are near another one, by parry's hierarchy of bounding volumes. Only comparisons of coordinates
//! decide: the boxes found depend neither on the shape of the tree nor on the instructions of the processor.

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

/// Boxes along the axes, numbered from zero in the order in which they were given.
pub struct BoxTree(Bvh);

impl BoxTree {
    /// The tree of boxes `[low, high]`. One without a point in it, such as one with NaN, is near no finite box.
    pub fn new<P: Into<[f64; 3]>>(boxes: impl Iterator<Item = [P; 2]>) -> Self {
        let leaf = |corners: [P; 2]| {
            let [low, high] = corners.map(|corner| Vector::from(corner.into()));
            if low.cmple(high).all() { Aabb::new(low, high) } else { Aabb::new_invalid() }
        };
        // the other strategy, Ploc, panics where the area of a box is not finite
        Self(Bvh::from_iter(BvhBuildStrategy::Binned, boxes.map(leaf).enumerate()))
    }

    /// Puts into `found` the boxes that lie within `reach` of the box `[low, high]` along each axis, ascending.
    pub fn near<P: Into<[f64; 3]>>(&self, [low, high]: [P; 2], reach: f64, found: &mut Vec<u32>) {
        let (low, high) = (Vector::from(low.into()), Vector::from(high.into()));
        let about = BvhNode::leaf(Aabb::new(low - reach, high + reach), 0);
        found.clear();
        found.extend(self.0.leaves(|node| node.intersects(&about)));
        found.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Boxes with coordinates of a mesh, some of them equal, and some of `others`; points; and boxes without a point.
    fn some_boxes(
        most: usize,
        others: impl Strategy<Value = f64> + Copy,
    ) -> impl Strategy<Value = Vec<[[f64; 3]; 2]>> {
        let of_mesh = || prop_oneof![(-8_i32..8).prop_map(f64::from), -8.0..8.0_f64];
        let x = move || prop_oneof![16 => of_mesh(), 1 => others];
        let corner = move || [x(), x(), x()];
        let ordered = |[a, b]: [[f64; 3]; 2]| {
            [[0, 1, 2].map(|i| a[i].min(b[i])), [0, 1, 2].map(|i| a[i].max(b[i]))]
        };
        let point = corner().prop_map(|point| [point; 2]);
        let any = [corner(), corner()];
        let one = prop_oneof![8 => any.clone().prop_map(ordered), 1 => any, 1 => point];
        prop::collection::vec(one, 0..most)
    }

    proptest! {
        #[test]
        fn the_boxes_found_are_those_of_all_that_are_near(
            boxes in some_boxes(200, prop::num::f64::ANY),
            others in some_boxes(8, prop::num::f64::NORMAL),
            reach in prop_oneof![Just(0.0), 0.0..2.0],
        ) {
            let tree = BoxTree::new(boxes.iter().copied());
            let mut found = vec![7];
            for other in others {
                tree.near(other, reach, &mut found);
                let [low, high] = [other[0].map(|x| x - reach), other[1].map(|x| x + reach)];
                let is_near = |[a, b]: [[f64; 3]; 2]| {
                    (0..3).all(|i| a[i] <= b[i] && a[i] <= high[i] && b[i] >= low[i])
                };
                let all = (0..).zip(&boxes).filter(|(_, its)| is_near(**its)).map(|(n, _)| n);
                prop_assert_eq!(&found, &all.collect::<Vec<u32>>());
            }
        }
    }

    #[test]
    fn boxes_whose_sizes_shrink_by_a_constant_factor_make_no_tree_too_deep_for_the_stack() {
        let corner = |n: i32| [2.0, 1.4, 1.1].map(|ratio: f64| -ratio.powi(-n));
        let boxes: Vec<_> = (-1_000..1_000).map(|n| [corner(n), corner(n + 1)]).collect();
        let mut found = Vec::new();
        BoxTree::new(boxes.iter().copied()).near([[f64::MIN; 3], [f64::MAX; 3]], 0.0, &mut found);
        assert_eq!(found.len(), 2_000);
    }
}
