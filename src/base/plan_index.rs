//! A spatial index of boxes in plan.
//!
//! Points are boxes without extent, because each further type of R-tree would add 25 kB of wasm.
//! The tree is always bulk-loaded, because its insertion would add another 20 kB: boxes inserted
//! later are searched linearly until they are many, and then the tree is built again.

use nalgebra::Point2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, Envelope, RTree, RTreeObject};

/// Numbered boxes.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlanIndex {
    boxes: Vec<Numbered>,
    /// The tree of the first boxes; the others were inserted later.
    tree: RTree<Numbered>,
}

type Numbered = GeomWithData<Rectangle<[f64; 2]>, u32>;

/// Number of boxes outside the tree, besides an eighth of those in it, that are searched linearly.
const MAX_OUTSIDE: usize = 32;

impl PlanIndex {
    /// Indexes the boxes between two corners, numbered in their order.
    pub(crate) fn new(boxes: impl Iterator<Item = [Point2<f64>; 2]>) -> Self {
        let boxes: Vec<_> = (boxes.enumerate().map(|(i, b)| numbered(b, i as u32))).collect();
        let tree = RTree::bulk_load(boxes.clone());
        Self { boxes, tree }
    }

    /// Adds a box under a number.
    pub(crate) fn insert(&mut self, corners: [Point2<f64>; 2], number: u32) {
        self.boxes.push(numbered(corners, number));
        let grown = self.tree.size();
        if self.boxes.len() > grown + grown / 8 + MAX_OUTSIDE {
            self.tree = RTree::bulk_load(self.boxes.clone());
        }
    }

    /// The numbers of the boxes that touch the box widened by `margin` on all sides, in no order.
    pub(crate) fn touching(
        &self,
        [a, b]: [Point2<f64>; 2],
        margin: f64,
    ) -> impl Iterator<Item = u32> + use<'_> {
        let low = [a.x.min(b.x) - margin, a.y.min(b.y) - margin];
        let high = [a.x.max(b.x) + margin, a.y.max(b.y) + margin];
        let around = AABB::from_corners(low, high);
        let late = &self.boxes[self.tree.size()..];
        self.tree
            .locate_in_envelope_intersecting(&around)
            .chain(
                late.iter()
                    .filter(move |b| b.envelope().intersects(&around)),
            )
            .map(|found| found.data)
    }
}

fn numbered([a, b]: [Point2<f64>; 2], number: u32) -> Numbered {
    GeomWithData::new(Rectangle::from_corners([a.x, a.y], [b.x, b.y]), number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point2<f64>> {
        (0u8..40, 0u8..40).prop_map(|(x, y)| Point2::new(f64::from(x), f64::from(y)))
    }

    fn touch([a, b]: [Point2<f64>; 2], [c, d]: [Point2<f64>; 2], margin: f64) -> bool {
        (0..2).all(|k| {
            a[k].min(b[k]) <= c[k].max(d[k]) + margin && a[k].max(b[k]) >= c[k].min(d[k]) - margin
        })
    }

    proptest! {
        #[test]
        fn finds_what_looking_at_every_box_finds(
            boxes in prop::collection::vec([point(), point()], 0..60),
            late in prop::collection::vec(point(), 0..90),
            question in [point(), point()],
            margin in 0u8..4,
        ) {
            let mut index = PlanIndex::new(boxes.iter().copied());
            let mut all = boxes.clone();
            for p in late {
                index.insert([p, p], all.len() as u32);
                all.push([p, p]);
            }
            let mut found: Vec<u32> = index.touching(question, f64::from(margin)).collect();
            found.sort();
            let expected: Vec<u32> = (0..all.len() as u32)
                .filter(|&i| touch(all[i as usize], question, f64::from(margin)))
                .collect();
            prop_assert_eq!(found, expected);
        }
    }
}
