//! The real lines that may bound a facet (B99 4.3, figure 21): those over some plane, outside of
//! any surface, and above the ground where they can be.
//!
//! A line need not lie in a plane to bound it: a wall's foot, seen below an eave, may be all that
//! was found of it (figure 21 b). Where the eave was found too, the foot is a second border beside
//! it, and the strip between them, in the shade of the roof, often says nothing for or against a
//! plane that reaches that far. There the eave is the border.

use crate::base::geometry::{Plane, Segment3, covered};
use crate::base::params::RoofParams;
use crate::lines::lines3d::Line3d;
use crate::planes::grouping::GroupingInput;
use crate::planes::hypotheses::{PlaneHypothesis, crosses_surface};
use crate::planes::terrain::Ground;

/// How far beside its eave, in plan, the foot of a wall may be, metres. Assumption: no overhang is
/// wider.
const OVERHANG_M: f64 = 1.0;
/// Sine of the angle at which two lines run side by side.
const PARALLEL_SINE: f64 = 0.15;
/// Share of a line that others must run along to take its place. Assumption: half.
const ALONGSIDE_SHARE: f64 = 0.5;

/// The lines that may bound a facet.
pub(crate) fn bounding_lines(
    input: &GroupingInput,
    hypotheses: &[PlaneHypothesis],
    ground: &Ground,
    params: &RoofParams,
) -> Vec<Segment3> {
    let on_ground = |l: &Line3d| ground.is_near(&l.segment, params.min_height_m);
    let above: Vec<Segment3> = (input.lines.iter())
        .filter(|l| !on_ground(l))
        .map(|l| l.segment)
        .collect();
    let bounds = crate::base::execution::map(input.lines, |_, line| {
        let (middle, segment) = (line.at(0.5).xy(), &line.segment);
        let over: Vec<&PlaneHypothesis> = (hypotheses.iter())
            .filter(|h| h.region.contains(&middle))
            .collect();
        let inside = |h: &&PlaneHypothesis| {
            lies_in(&h.group.plane, segment) && crosses_surface(&h.map, segment)
        };
        let is_foot = || on_ground(line) && beside_others(segment, &above);
        !over.is_empty() && !over.iter().any(inside) && !is_foot()
    });
    (input.lines.iter().zip(bounds))
        .filter(|(_, bounds)| *bounds)
        .map(|(line, _)| line.segment)
        .collect()
}

/// Does a line lie in a plane?
fn lies_in(plane: &Plane, line: &Segment3) -> bool {
    // Assumption: some standard deviations of a line's height.
    const IN_PLANE_M: f64 = 0.2;
    plane.signed_distance(&line.p0).abs() < IN_PLANE_M
        && plane.signed_distance(&line.p1).abs() < IN_PLANE_M
}

/// Do others run along most of a line, in plan, within an overhang's width?
fn beside_others(line: &Segment3, others: &[Segment3]) -> bool {
    let beside = (others.iter()).filter_map(|other| line.alongside(other, PARALLEL_SINE));
    let stretches = beside.filter(|a| a.apart <= OVERHANG_M).map(|a| a.stretch);
    let length = (line.p1.xy() - line.p0.xy()).norm();
    length > 0.0 && covered(stretches, [0.0, length]) >= ALONGSIDE_SHARE * length
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    fn line(from: [f64; 3], to: [f64; 3]) -> Segment3 {
        Segment3::new(Point3::from(from), Point3::from(to))
    }

    #[test]
    fn a_line_with_an_eave_along_most_of_it_is_the_foot_of_its_wall() {
        let foot = line([0.0, 0.0, 0.0], [10.0, 0.0, 0.0]);
        let eave = |from: f64, to: f64, beside: f64| line([from, beside, 3.0], [to, beside, 3.2]);
        assert!(beside_others(&foot, &[eave(0.0, 10.0, 0.9)]));
        assert!(
            beside_others(&foot, &[eave(10.0, 0.0, -0.9)]),
            "either way round"
        );
        assert!(beside_others(
            &foot,
            &[eave(-2.0, 3.0, 0.4), eave(7.0, 12.0, -0.4)]
        ));
        assert!(!beside_others(
            &foot,
            &[eave(-2.0, 4.0, 0.4), eave(1.0, 4.0, -0.4)]
        ));
        assert!(
            !beside_others(&foot, &[eave(0.0, 10.0, 1.2)]),
            "farther than any eave"
        );
        let across = line([2.0, -0.9, 3.0], [8.0, 0.9, 3.0]);
        assert!(!beside_others(&foot, &[across]));
        assert!(!beside_others(&foot, &[]));
    }
}
