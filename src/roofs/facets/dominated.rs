//! Planes that a stronger one explains: whatever they say, it says as well.
//!
//! A roof is proposed many times: by its lines, its half-planes, its patches. A copy explains no
//! position that the best of them does not, but its border lines cut the plan into ever smaller
//! cells. A plane has to pay for itself, as a label costs in the energies of multi-model fitting
//! (Isack and Boykov 2012).

use nalgebra::Point2;

use super::point_cloud::{CloudEvidence, OfPlane};
use crate::base::math::larger;
use crate::planes::hypotheses::PlaneHypothesis;
use crate::planes::photoconsistency::{ConsistencyMap, PlanGrid, ShiftableWindows};

/// The price of one more plane, nats. Of 1, 2, 3, 4 and 8 the largest that cost the sixteen fitting
/// scenes nothing.
const PLANE_NATS: f64 = 2.0;
/// Positions this far apart, metres, tell what windows of a metre say.
const SPACING: f64 = 0.35;

/// A hypothesis with what speaks for it.
pub(super) struct SupportedPlane {
    pub hypothesis: PlaneHypothesis,
    pub support: Support,
}

/// The hypotheses with what the views and a point cloud say for them.
pub(super) fn supported(
    hypotheses: Vec<PlaneHypothesis>,
    ground: Option<&ConsistencyMap>,
    windows: &ShiftableWindows,
    grid: &PlanGrid,
    cloud: Option<&CloudEvidence>,
) -> Vec<SupportedPlane> {
    let supports = crate::base::execution::map(&hypotheses, |_, h| {
        let of_cloud = cloud.map(|cloud| cloud.of(&h.group.plane));
        Support::of(h, ground, windows, grid, of_cloud.as_ref())
    });
    (hypotheses.into_iter().zip(supports))
        .map(|(hypothesis, support)| SupportedPlane {
            hypothesis,
            support,
        })
        .collect()
}

/// Those, in their order, that say more than their price which no stronger one says.
pub(super) fn without_dominated(planes: Vec<SupportedPlane>) -> Vec<SupportedPlane> {
    let supports: Vec<&Support> = planes.iter().map(|plane| &plane.support).collect();
    let stays = not_dominated(&supports);
    (planes.into_iter().zip(stays))
        .filter_map(|(plane, stays)| stays.then_some(plane))
        .collect()
}

/// Columns and rows of a grid from one position to the next.
pub(super) fn columns_apart(grid: &PlanGrid) -> usize {
    (SPACING / grid.step).round().max(1.0) as usize
}

/// Which of several planes no stronger one of those that stay dominates.
fn not_dominated(supports: &[&Support]) -> Vec<bool> {
    let mut strongest: Vec<usize> = (0..supports.len()).collect();
    strongest.sort_by(|a, b| {
        supports[*b]
            .total
            .total_cmp(&supports[*a].total)
            .then(a.cmp(b))
    });
    let mut stays = vec![false; supports.len()];
    let mut kept: Vec<&Support> = Vec::new();
    for i in strongest {
        let support = supports[i];
        let pays = |other: &&Support| support.pays_beside(other);
        if support.total > PLANE_NATS && kept.iter().all(pays) {
            stays[i] = true;
            kept.push(support);
        }
    }
    stays
}

/// Where the views and a point cloud speak for a plane more than for the ground.
#[derive(Default)]
pub(super) struct Support {
    /// Positions of the plan, ascending, with what is said there, nats.
    positions: Vec<(u32, f64)>,
    total: f64,
}

impl Support {
    /// At some of the columns and rows of `grid` ([`columns_apart`]).
    fn of(
        h: &PlaneHypothesis,
        ground: Option<&ConsistencyMap>,
        windows: &ShiftableWindows,
        grid: &PlanGrid,
        cloud: Option<&OfPlane>,
    ) -> Self {
        let every = columns_apart(grid);
        let window = &h.map.grid;
        let (dc, dr) = window.offset_in(grid);
        let places = |size: usize, offset: isize, of_grid: usize| {
            (0..size).filter_map(move |own| {
                let at = own.checked_add_signed(offset)?;
                (at < of_grid && at.is_multiple_of(every)).then_some((own, at))
            })
        };
        let spacing = every as f64 * grid.step;
        let area = spacing * spacing;
        let mut support = Self::default();
        for (row, r) in places(window.height, dr, grid.height) {
            let of_region = h.region.row(window.center(0, row).y);
            for (column, c) in places(window.width, dc, grid.width) {
                let single_view = h.single_view.at(row * window.width + column);
                let observed = windows.evidence_at(&h.map, [column, row]);
                let place = window.center(column, row);
                let of_cloud = cloud.map_or(0.0, |cloud| cloud.nats_at(&place));
                let said = observed.nats_with_prior() + single_view + of_cloud;
                if said <= 0.0 || !of_region.contains(place.x) {
                    continue;
                }
                let of_ground = ground.map(|g| windows.evidence_at(g, [c, r]).nats_with_prior());
                let nats = area * (said - larger(of_ground.unwrap_or(0.0), 0.0));
                if nats > 0.0 {
                    support.positions.push(((r * grid.width + c) as u32, nats));
                    support.total += nats;
                }
            }
        }
        support
    }

    /// The positions in plan, metres.
    pub(super) fn places<'a>(
        &'a self,
        grid: &'a PlanGrid,
    ) -> impl Iterator<Item = Point2<f64>> + 'a {
        let places = (self.positions.iter()).map(|(position, _)| *position as usize);
        places.map(|k| grid.center(k % grid.width, k / grid.width))
    }

    /// Is more than the price of a plane lost when another one stands for this one?
    fn pays_beside(&self, other: &Self) -> bool {
        let mut others = other.positions.iter().peekable();
        let lost = self.positions.iter().map(|&(position, nats)| {
            while others.next_if(|o| o.0 < position).is_some() {}
            let same = others.peek().filter(|o| o.0 == position);
            larger(nats - same.map_or(0.0, |o| o.1), 0.0)
        });
        // Nothing is negative: the sum only grows.
        let mut sums = lost.scan(0.0, |sum, lost| {
            *sum += lost;
            Some(*sum)
        });
        sums.any(|sum| sum > PLANE_NATS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane that is seen from one position to another, with so many nats at each.
    fn support(positions: std::ops::Range<u32>, nats: f64) -> Support {
        let positions: Vec<(u32, f64)> = positions.map(|p| (p, nats)).collect();
        Support {
            total: nats * positions.len() as f64,
            positions,
        }
    }

    #[test]
    fn a_copy_falls_and_what_reaches_farther_or_says_more_stays() {
        let roof = || support(100..200, 0.5);
        let stays = |planes: &[Support]| not_dominated(&planes.iter().collect::<Vec<_>>());
        assert_eq!(stays(&[support(120..180, 0.4), roof()]), [false, true]);
        assert_eq!(stays(&[roof(), roof()]), [true, false], "of two the first");
        assert_eq!(stays(&[roof(), support(190..210, 0.4)]), [true, true]);
        assert_eq!(stays(&[roof(), support(195..202, 0.4)]), [true, false]);
        assert_eq!(stays(&[roof(), support(140..150, 0.8)]), [true, true]);
        assert_eq!(stays(&[support(0..3, 0.5)]), [false], "worth no plane");
    }

    #[test]
    fn a_plane_is_not_dominated_by_several_others_together() {
        let halves = [support(0..60, 0.5), support(60..120, 0.5)];
        let both = support(5..115, 0.49);
        let [first, second] = halves;
        assert_eq!(not_dominated(&[&first, &both, &second]), [true; 3]);
    }
}
