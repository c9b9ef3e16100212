//! The upright block that explains best what hides a roof.

use nalgebra::{Point2, Point3, Vector2};

use super::surface::{SeenFrom, SeenSurface};
use crate::base::evidence::HidingTable;
use crate::base::geometry::{Plane, convex_hull};
use crate::base::math::{larger, ln};

/// Heights at which something is looked for, metres: from a curb to a tall chimney.
const HEIGHTS_M: [f64; 6] = [0.3, 0.45, 0.7, 1.0, 1.5, 2.2];
/// Half the side of a block that is looked for, metres: a chimney's.
const HALF_M: f64 = 0.25;
/// Steps in which a block is moved and resized at first, metres, and how often they are halved.
const FIRST_STEP_M: f64 = 0.2;
const HALVINGS: usize = 5;
/// Largest block that one search ends with, metres: higher ones are other roofs, or trees.
const HEIGHT_LIMIT_M: f64 = 4.0;
/// Change of the height by which its standard deviation is found, metres.
const BEND_M: f64 = 0.1;

/// A block with a level top. Its base lies on a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    pub middle: Point2<f64>,
    /// Unit vector along one of its sides, in plan.
    pub along: Vector2<f64>,
    /// Half the lengths of its sides, along and across, metres.
    pub half: [f64; 2],
    /// Of its top above the facet at its middle, metres.
    pub height: f64,
}

impl Block {
    /// Small blocks with sides along a direction for which more speaks than for the best of so many
    /// places by chance, the likeliest first, and what speaks for that one, nats.
    pub(super) fn likely(
        seen: &SeenSurface,
        plane: &Plane,
        along: Vector2<f64>,
    ) -> (Vec<Self>, f64) {
        let half_cells = seen.cells_of(HALF_M);
        // Neighbouring places say the same.
        let stride = half_cells.div_ceil(2);
        let places = || {
            let rows = (0..seen.grid.height).step_by(stride);
            rows.flat_map(|row| (0..seen.grid.width).step_by(stride).map(move |c| (c, row)))
        };
        let by_chance = ln((places().count() * HEIGHTS_M.len()) as f64);
        let blocks = places().flat_map(|(column, row)| {
            HEIGHTS_M.map(|height| Self {
                middle: seen.grid.center(column, row),
                along,
                half: [HALF_M; 2],
                height,
            })
        });
        let mut likely: Vec<(Self, f64)> = blocks
            .map(|block| (block, block.votes(seen, plane)))
            .filter(|(_, votes)| *votes > by_chance)
            .collect();
        likely.sort_by(|a, b| b.1.total_cmp(&a.1));
        let likely = likely.into_iter().map(|(block, _)| block);
        (likely.collect(), by_chance)
    }

    /// About what the views say for it, nats: of squares from its base to where its top is seen.
    pub(super) fn votes(&self, seen: &SeenSurface, plane: &Plane) -> f64 {
        let half_cells = seen.cells_of(HALF_M);
        let mut top = plane.lift(self.middle.x, self.middle.y);
        top.z += self.height;
        let of_view = |view: &SeenFrom| {
            let lean = seen.seen_at(view, &top) - self.middle;
            let steps = (lean.norm() / (2.0 * HALF_M)).ceil().max(1.0) as usize;
            let places = (0..=steps).map(|k| self.middle + lean * (k as f64 / steps as f64));
            places
                .map(|p| seen.around(view, &p, half_cells))
                .sum::<f64>()
        };
        HidingTable::fitted().independent * seen.views.iter().map(of_view).sum::<f64>()
    }

    /// Moved and resized as long as more speaks for it.
    pub(super) fn fitted(mut self, seen: &SeenSurface, plane: &Plane) -> (Self, f64) {
        let mut nats = self.nats(seen, plane);
        let mut step = FIRST_STEP_M;
        for _ in 0..HALVINGS {
            loop {
                let better = (self.neighbours(step).into_iter())
                    .map(|block| (block, block.nats(seen, plane)))
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .filter(|(_, other)| *other > nats);
                let Some((block, other)) = better else {
                    break;
                };
                (self, nats) = (block, other);
            }
            step *= 0.5;
        }
        (self, nats)
    }

    /// The blocks with one number changed by a step.
    fn neighbours(&self, step: f64) -> Vec<Self> {
        let mut all = Vec::new();
        for by in [-step, step] {
            all.push(Self {
                height: self.height + by,
                ..*self
            });
            for (side, direction) in self.axes().into_iter().enumerate() {
                all.push(Self {
                    middle: self.middle + direction * by,
                    ..*self
                });
                // One side moves, the other one stays.
                for end in [-0.5, 0.5] {
                    let mut block = *self;
                    block.half[side] += 0.5 * by;
                    block.middle += direction * (end * by);
                    all.push(block);
                }
            }
        }
        let is_block = |b: &Self| {
            let least = b.half[0].min(b.half[1]).min(b.height);
            least >= 0.5 * FIRST_STEP_M && b.height <= HEIGHT_LIMIT_M
        };
        all.retain(is_block);
        all
    }

    /// So many metres wider on all sides.
    pub(super) fn widened(&self, by: f64) -> Self {
        Self {
            half: self.half.map(|half| half + by),
            ..*self
        }
    }

    fn axes(&self) -> [Vector2<f64>; 2] {
        [self.along, Vector2::new(-self.along.y, self.along.x)]
    }

    /// Its outline from above, counter-clockwise.
    pub(super) fn outline(&self) -> [Point2<f64>; 4] {
        let [a, b] = self.axes();
        let [a, b] = [a * self.half[0], b * self.half[1]];
        [-a - b, a - b, a + b, b - a].map(|by| self.middle + by)
    }

    /// What it hides of the facet in a view: a convex ring.
    pub(super) fn shade(
        &self,
        seen: &SeenSurface,
        view: &SeenFrom,
        plane: &Plane,
    ) -> Vec<Point2<f64>> {
        let base = self.outline();
        let top = plane.z_at(self.middle.x, self.middle.y) + self.height;
        let above = base.map(|p| Point3::new(p.x, p.y, larger(top, plane.z_at(p.x, p.y))));
        let hides: Vec<Point2<f64>> = (base.into_iter())
            .chain(above.iter().map(|p| seen.seen_at(view, p)))
            .collect();
        convex_hull(&hides)
    }

    /// What the views say for it, nats.
    pub(super) fn nats(&self, seen: &SeenSurface, plane: &Plane) -> f64 {
        let of_view = |view: &SeenFrom| seen.within(view, &self.shade(seen, view, plane))[0];
        HidingTable::fitted().independent * seen.views.iter().map(of_view).sum::<f64>()
    }

    /// Standard deviation of its height, metres: where the nats fall by one half, and what blocks
    /// that are none add to it.
    pub(super) fn height_sigma(&self, seen: &SeenSurface, plane: &Plane) -> f64 {
        let at = |height: f64| Self { height, ..*self }.nats(seen, plane);
        let [below, here, above] = [-BEND_M, 0.0, BEND_M].map(|by| at(self.height + by));
        let bend = larger(2.0 * here - below - above, f64::MIN_POSITIVE).sqrt();
        HidingTable::fitted().inflated(BEND_M / bend)
    }
}
