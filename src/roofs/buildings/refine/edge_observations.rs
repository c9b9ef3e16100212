//! The image edges that belong to the sides of a wireframe.
//!
//! The image of a side is where the model expects an edge. A side may lie off by more than a guided
//! measurement reaches (a closing line where nothing was found, the correlation window that
//! straddles a strong edge), so it is first moved in its facet's plane, and the rows of grey values
//! along it are compared over the views: on the roof they agree, and an edge of the roof stands
//! still, whatever lies on the ground or on a wall moves. From there `measure_edge` (the second
//! look of line matching) measures in every view.

use nalgebra::{Matrix2, Point2};

use super::profiles::{END_SHARE, Extent, ShiftGains, SideProfile, SideProfiles, strongest_near};
use super::wireframe::{SideKind, Wireframe, WireframeSide, WireframeState};
use crate::base::geometry::{Segment2, Segment3, covered};
use crate::base::ids::ViewId;
use crate::base::params::{RefineParams, RoofParams};
use crate::lines::lines2d::{SegmentKind, measure_edge};
use crate::lines::lines3d::{Line3d, edge_whitening};
use crate::orienting::scene::Scene;
use crate::photographs::raster::Channel;
use crate::roofs::model::Occluders;

/// An edge measured in a view for a side.
#[derive(Clone, Debug)]
pub(super) struct EdgeObservation {
    /// Index of the side.
    pub side: usize,
    /// The view.
    pub view: ViewId,
    /// The measured edge, px.
    pub segment: Segment2,
    /// Whitens (offset at the middle in px, angle in rad).
    pub whitening: Matrix2<f64>,
}

/// Measures all sides in all views. Sides without a neighbour may move to another edge first where
/// `search` allows it for their facet; those on one of the matched `lines` go less far for a
/// stronger one, such as the edge of a shadow.
pub(super) fn measure_sides(
    scene: &Scene,
    occluders: &Occluders,
    wireframe: &Wireframe,
    state: &WireframeState,
    search: &[bool],
    lines: &[Line3d],
    params: &RoofParams,
) -> Vec<EdgeObservation> {
    let refine = &params.refine;
    let pixel_m = pixel(scene, wireframe, state);
    let reach_of = |side: &WireframeSide| match search[side.face] && side.kind != SideKind::Crease {
        true => refine.search_m,
        false => refine.reach_px * pixel_m,
    };
    let profiles = crate::base::execution::map(&wireframe.sides, |_, side| {
        (side.kind != SideKind::Foot).then_some(())?;
        let extent = Extent {
            seen_m: refine.search_m,
            compared_m: reach_of(side),
            pixel_m,
        };
        SideProfiles::new(scene, occluders, wireframe, state, side, extent, refine)
    });
    let gains = crate::base::execution::map(&profiles, |i, profiles| {
        let (profiles, side) = (profiles.as_ref()?, &wireframe.sides[i]);
        let known_to_m = match is_on_line(&wireframe.segment(state, side), lines) {
            true => refine.matched_m,
            false => refine.search_m,
        };
        profiles.shift_gains(reach_of(side), known_to_m, params)
    });
    let runs = aligned_runs(wireframe, state, 0.0, |kind| kind == SideKind::Free);
    let of_side = |i: usize, profiles: &Option<SideProfiles>| {
        let run = runs.iter().find(|run| run.contains(&i));
        let together: Vec<&ShiftGains> = match run {
            Some(run) => run.iter().filter_map(|&j| gains[j].as_ref()).collect(),
            None => gains[i].iter().collect(),
        };
        gains[i].as_ref()?;
        let step = best_step(&together)?;
        Some(profiles.as_ref()?.measure(scene, i, step, refine))
    };
    crate::base::execution::map(&profiles, of_side)
        .into_iter()
        .flatten()
        .flatten()
        .collect()
}

/// Do matched lines run along most of a side?
fn is_on_line(side: &Segment3, lines: &[Line3d]) -> bool {
    /// Sine of the angle below which they are parallel (4 degrees).
    const PARALLEL: f64 = 0.07;
    /// Distance within which they are the same, metres in plan and in height. Assumption:
    /// delineation joins lines within 0.3 m.
    const SAME: [f64; 2] = [0.15, 0.35];
    let beside = lines
        .iter()
        .filter_map(|l| side.alongside(&l.segment, PARALLEL));
    let same = beside.filter(|a| a.apart < SAME[0] && a.rise.abs() < SAME[1]);
    let length = (side.p1.xy() - side.p0.xy()).norm();
    covered(same.map(|a| a.stretch), [0.0, length]) >= 0.5 * length
}

/// Size of a pixel on the building, metres.
pub(crate) fn pixel(scene: &Scene, wireframe: &Wireframe, state: &WireframeState) -> f64 {
    let middle = wireframe.corner(state, 0, 0);
    let pixels = scene.views.iter().map(|v| v.camera.ground_pixel(&middle));
    pixels.fold(f64::INFINITY, f64::min)
}

/// Sides of some kinds, of different facets, that go on into each other, such as both halves of a
/// gable's end: they are one edge. From one to the next it may be `gap_m` metres.
pub(crate) fn aligned_runs(
    wireframe: &Wireframe,
    state: &WireframeState,
    gap_m: f64,
    of_kind: impl Fn(SideKind) -> bool,
) -> Vec<Vec<usize>> {
    /// Sine of the angle below which sides are aligned (4 degrees).
    const ALIGNED: f64 = 0.07;
    let direction = |side: &WireframeSide| {
        let s = wireframe.segment(state, side);
        (s.p1.xy() - s.p0.xy()).normalize()
    };
    let mut runs: Vec<Vec<usize>> = Vec::new();
    let mut taken = vec![false; wireframe.sides.len()];
    for first in 0..wireframe.sides.len() {
        if taken[first] || !of_kind(wireframe.sides[first].kind) {
            continue;
        }
        let mut run = vec![first];
        taken[first] = true;
        let mut next = 0;
        while next < run.len() {
            let side = &wireframe.sides[run[next]];
            for (j, other) in wireframe.sides.iter().enumerate() {
                let touch = [[other.ends[0], side.ends[1]], [other.ends[1], side.ends[0]]]
                    .map(|ends| ends.map(|v| wireframe.position(state, v)))
                    .iter()
                    .any(|[p, q]| (p - q).norm() <= gap_m);
                if taken[j] || !of_kind(other.kind) || !touch {
                    continue;
                }
                let (d, e) = (direction(side), direction(other));
                if d.perp(&e).abs() < ALIGNED && d.dot(&e) > 0.0 {
                    taken[j] = true;
                    run.push(j);
                }
            }
            next += 1;
        }
        runs.push(run);
    }
    runs
}

/// The best step from the side at which there is an edge, for one side or for several that are one
/// edge.
fn best_step(sides: &[&ShiftGains]) -> Option<isize> {
    let first = sides.iter().map(|g| g.first).max()?;
    let end = sides
        .iter()
        .map(|g| g.first + g.gain.len() as isize)
        .min()?;
    let sum = |of: fn(&ShiftGains) -> &Vec<f64>, k: isize| -> f64 {
        sides.iter().map(|g| of(g)[(k - g.first) as usize]).sum()
    };
    let edge = |k: isize| sum(|g| &g.edge, k);
    (first + 1..end - 1)
        .filter(|&k| edge(k) > 0.0 && edge(k) >= edge(k - 1) && edge(k) > edge(k + 1))
        .max_by(|&i, &j| {
            let gain = |k| sum(|g| &g.gain, k);
            gain(i).total_cmp(&gain(j)).then(j.cmp(&i))
        })
}

impl SideProfiles {
    /// The edge in every view that shows it, sought around the side moved by `step` steps.
    fn measure(
        &self,
        scene: &Scene,
        side: usize,
        step: isize,
        params: &RefineParams,
    ) -> Vec<EdgeObservation> {
        let offset = step as f64 * self.step_m();
        let place = (self.middle() as isize + step) as usize;
        let moved = |t: f64| self.segment.at(t) + self.outward * offset;
        let of_view = |profile: &SideProfile| {
            let view = profile.view;
            let rising = strongest_near(&profile.differences, place) > 0.0;
            let camera = scene.camera(view);
            let image = |t: f64| camera.project(&moved(t));
            let expected = Segment2::new(image(END_SHARE)?, image(1.0 - END_SHARE)?);
            let outside: Point2<f64> = camera.project(&(moved(0.5) + self.outward * 0.5))?;
            let outwards = (outside - expected.midpoint()).dot(&expected.normal()) > 0.0;
            // Directed by contrast: bright on the side of the normal.
            let expected = if outwards == rising {
                expected
            } else {
                expected.reversed()
            };
            let core = [0.0, expected.length()];
            let edge = measure_edge(
                view,
                scene.view(view).channel(Channel::Grey),
                SegmentKind::Edge,
                &expected,
                core,
                false,
            )?;
            Some(EdgeObservation {
                side,
                view,
                segment: edge.segment,
                whitening: edge_whitening(&edge.covariance, edge.segment.length(), params.floor_px),
            })
        };
        let found: Vec<EdgeObservation> = self.views.iter().filter_map(of_view).collect();
        if found.len() < 2 { Vec::new() } else { found }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector2};

    use super::super::fixture::facets_of;
    use super::*;
    use crate::base::geometry::Plane;
    use crate::base::math;
    use crate::orienting::synthetic::gable_scene;
    use crate::roofs::model::Facet;
    use crate::roofs::testing::{self, facet};

    #[test]
    fn a_wall_goes_on_behind_a_jog() {
        // The eaves of two facets that meet at x = 4 m, one 0.2 m behind the other.
        let raised = |(x, y): &(f64, f64)| Point3::new(*x, *y, 3.0 + 0.5 * y);
        let ring = |corners: &[(f64, f64)]| facet(&corners.iter().map(raised).collect::<Vec<_>>());
        let facets = [
            ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 0.2), (4.0, 3.0), (0.0, 3.0)]),
            ring(&[(4.0, 0.2), (8.0, 0.2), (8.0, 3.0), (4.0, 3.0)]),
        ];
        let (wireframe, state) = Wireframe::new(&facets_of(&facets));
        let longest = |gap_m: f64| {
            let runs = aligned_runs(&wireframe, &state, gap_m, |_| true);
            let eaves = runs.iter().filter(|run| {
                let side = wireframe.segment(&state, &wireframe.sides[run[0]]);
                side.direction().x.abs() > 0.9 && side.p0.y < 1.0
            });
            eaves.map(|run| run.len()).max()
        };
        assert_eq!(longest(0.0), Some(1));
        assert_eq!(longest(0.5), Some(2));
    }

    /// Darkens, until texture is hardly seen, what is seen of a plane within `depth_m` inside a
    /// line in it, and beyond.
    fn cast_shadow(
        scene: &mut Scene,
        plane: &Plane,
        line: &Segment3,
        inward: Vector2<f64>,
        depth_m: f64,
    ) {
        for view in &mut scene.views {
            let (camera, gray) = (&view.camera, &mut view.gray);
            for k in 0..gray.data.len() {
                let at = [k % gray.width, k / gray.width].map(|i| i as f64 + 0.5);
                let ray = camera.ray(&Point2::from(at));
                let depth = -plane.signed_distance(&camera.center) / plane.normal.dot(&ray);
                let p = camera.center + ray * depth;
                if (p.xy() - line.p0.xy()).dot(&inward) < depth_m {
                    gray.data[k] = 0.1 + 0.1 * gray.data[k];
                }
            }
        }
    }

    #[test]
    fn an_eave_on_a_matched_line_is_not_given_up_for_the_edge_of_a_shadow() {
        let (mut scene, truth) = gable_scene(320);
        let facets: Vec<Facet> = truth.facets.iter().map(|(_, ring)| facet(ring)).collect();
        let (wireframe, state) = Wireframe::new(&facets_of(&facets));
        let eave = |side: &&WireframeSide| {
            let s = wireframe.segment(&state, side);
            side.kind == SideKind::Free && (s.p0.z - s.p1.z).abs() < 0.01
        };
        let (index, side) = (wireframe.sides.iter().enumerate())
            .find(|(_, side)| eave(side))
            .expect("an eave");
        let line = wireframe.segment(&state, side);
        let along = (line.p1.xy() - line.p0.xy()).normalize();
        // The facet lies on its left.
        let inward = Vector2::new(-along.y, along.x);
        let plane = facets[side.face].plane;
        cast_shadow(&mut scene, &plane, &line, inward, 0.5);
        let occluders = Occluders::new(&[]);
        // Distance of the measured edges from the eave, in plan, metres.
        let off_by = |lines: &[Line3d]| {
            let params = RoofParams::default();
            let search = [true, true];
            let found = measure_sides(
                &scene, &occluders, &wireframe, &state, &search, lines, &params,
            );
            let offsets = found.iter().filter(|s| s.side == index).map(|s| {
                let camera = scene.camera(s.view);
                let ray = camera.ray(&s.segment.midpoint());
                let depth = -plane.signed_distance(&camera.center) / plane.normal.dot(&ray);
                ((camera.center + ray * depth).xy() - line.p0.xy()).dot(&inward)
            });
            let mut offsets: Vec<f64> = offsets.collect();
            assert!(offsets.len() >= 4, "measured in {} views", offsets.len());
            math::median(&mut offsets).unwrap_or(f64::NAN)
        };
        let matched = testing::line(line.p0, line.p1);
        let by_shadow = off_by(&[]);
        assert!(
            (by_shadow - 0.5).abs() < 0.1,
            "the stronger edge at {by_shadow}"
        );
        let by_line = off_by(&[matched]);
        assert!(by_line.abs() < 0.1, "the eave at {by_line}");
    }

    #[test]
    fn a_side_is_on_a_line_that_runs_along_most_of_it_at_its_height() {
        let side = Segment3::new(Point3::new(0.0, 0.0, 5.0), Point3::new(8.0, 0.0, 6.0));
        let line = |x: [f64; 2], y: f64, lift: f64| {
            let at = |x: f64| Point3::new(x, y, 5.0 + x / 8.0 + lift);
            testing::line(at(x[0]), at(x[1]))
        };
        assert!(is_on_line(&side, &[line([-3.0, 5.0], 0.1, 0.3)]));
        assert!(is_on_line(
            &side,
            &[line([0.0, 2.0], 0.1, 0.0), line([7.9, 5.5], -0.1, 0.0)]
        ));
        assert!(
            !is_on_line(&side, &[line([-3.0, 3.0], 0.1, 0.0)]),
            "along 3 of 8 m"
        );
        assert!(
            !is_on_line(&side, &[line([0.0, 8.0], 0.2, 0.0)]),
            "beside it"
        );
        assert!(
            !is_on_line(&side, &[line([0.0, 8.0], 0.0, -0.5)]),
            "under it"
        );
    }
}
