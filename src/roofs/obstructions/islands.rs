//! Facets that stand on another one and are no roofs by their size.
//!
//! A box on a flat roof, or a dormer, has a plane that the views confirm, so it is found as a facet
//! in a hole of the one below. Whether that is part of the roof is a matter of its size: what
//! people draw as one is a table ([`EvidenceModel::of_islands`]).

use nalgebra::{Point2, Point3};

use crate::base::evidence::EvidenceModel;
use crate::base::geometry::Polygon;
use crate::base::math::{larger, ln};
use crate::roofs::model::{Facet, Obstruction};

/// The facets without those that are obstructions of another one, which is whole below them, and
/// for each of them its index among the given ones.
pub(crate) fn take_out_islands(facets: &[Facet]) -> (Vec<Facet>, Vec<usize>) {
    let middles: Vec<Option<Point2<f64>>> = facets.iter().map(|f| f.plan().centroid()).collect();
    let mut facets = facets.to_vec();
    let mut taken = vec![false; facets.len()];
    for host in 0..facets.len() {
        let mut holes = Vec::new();
        for hole in std::mem::take(&mut facets[host].holes) {
            let plan: Vec<Point2<f64>> = hole.iter().map(|p| p.xy()).collect();
            let plan = Polygon::from(plan).oriented();
            let stands = |i: &usize| *i != host && middles[*i].is_some_and(|p| plan.contains(&p));
            let within: Vec<usize> = (0..facets.len()).filter(stands).collect();
            match island(&facets, host, &within, &plan) {
                Some(obstruction) => {
                    facets[host].obstructions.push(obstruction);
                    within.into_iter().for_each(|i| taken[i] = true);
                }
                None => holes.push(hole),
            }
        }
        facets[host].holes = holes;
    }
    let kept: Vec<usize> = (0..facets.len()).filter(|i| !taken[*i]).collect();
    (kept.iter().map(|&i| facets[i].clone()).collect(), kept)
}

/// What stands in a hole of a facet, where that is no roof.
fn island(facets: &[Facet], host: usize, within: &[usize], hole: &Polygon) -> Option<Obstruction> {
    let below = &facets[host].plane;
    let above = |p: &Point3<f64>| p.z - below.z_at(p.x, p.y);
    let corners = || within.iter().flat_map(|&i| &facets[i].outer);
    let height_m = corners().map(above).fold(0.0, larger);
    let stands = corners().all(|p| above(p) > 0.0) && height_m > 0.0;
    let size = [("ln_area_m2", ln(hole.area()))];
    let is_roof = EvidenceModel::of_islands().weigh(&size).accepts(0.0);
    let probability = within
        .iter()
        .map(|&i| facets[i].probability)
        .fold(0.0, larger);
    (stands && !is_roof).then(|| Obstruction {
        outline: hole.sides().map(|[p, _]| p).collect(),
        height_m,
        height_sigma_m: None,
        probability,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing;

    fn square(half: f64, z: f64) -> [Point3<f64>; 4] {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Point3::new(half * x, half * y, z))
    }

    /// A roof of 20 m by 20 m at 5 m with a square hole, in which a facet lies at a height.
    fn roof_with(half: f64, z: f64) -> Vec<Facet> {
        let mut host = testing::facet(&square(10.0, 5.0));
        let mut hole = square(half, 5.0).to_vec();
        hole.reverse();
        host.holes.push(hole);
        vec![testing::facet(&square(half, z)), host]
    }

    #[test]
    fn a_small_box_is_an_obstruction_of_a_roof_that_is_whole_below_it() {
        let (facets, kept) = take_out_islands(&roof_with(1.0, 5.8));
        assert_eq!((facets.len(), kept), (1, vec![1]));
        assert!(facets[0].holes.is_empty());
        let [found] = &facets[0].obstructions[..] else {
            panic!("{:?}", facets[0].obstructions);
        };
        assert!((found.height_m - 0.8).abs() < 1e-9);
        let plan = crate::base::geometry::signed_area(found.outline.iter().copied());
        assert!((plan - 4.0).abs() < 1e-9, "counter-clockwise");
    }

    #[test]
    fn a_large_one_a_hole_and_a_sunken_one_stay() {
        for kept in [roof_with(4.0, 8.0), roof_with(1.0, 4.5)] {
            assert_eq!(take_out_islands(&kept), (kept.clone(), vec![0, 1]));
        }
        let hole = roof_with(1.0, 5.8).split_off(1);
        assert_eq!(take_out_islands(&hole), (hole.clone(), vec![0]));
    }
}
