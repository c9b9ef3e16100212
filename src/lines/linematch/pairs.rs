//! Two-view matching (B99 3.1): candidates in the epipolar beam, scored by the correlation of the
//! lines' neighbourhoods.
//!
//! The paper matches consecutive views only. A line near-parallel to a baseline is undetermined by
//! that pair, so here every selected pair of views is searched and each hypothesis tested for its
//! own conditioning: lines along the flight are matched across it.
//!
//! Each segment is compared only with those in its beam (about 3 to 10 with the height range of a
//! suburb), so that the work grows with segments x views x density, not with their square.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::line_strip::{EdgelScore, LineStrip, StripFrame, StripSide, correlate};
use super::pass::Pass;
use super::segment_geometry::{
    Compatibility, PreparedSegments, SegmentGeometry, SegmentRef, epipolar_beam, ray_in_plane,
};
use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::{Plane, Segment3};
use crate::base::ids::ViewId;
use crate::base::params::MatchParams;
use crate::lines::lines3d::{Side, ThetaFrame};
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, Homography, homography_of_plane};
use crate::photographs::raster::Channel;

/// Two segments that may be images of one line.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SegmentPair {
    /// Segment of the view with the lower index.
    pub a: SegmentRef,
    /// Segment of the other view.
    pub b: SegmentRef,
    /// The stretch of the 3D line that both see, directed as `a`, metres.
    pub overlap: Segment3,
    /// Its length in the first view, pixels.
    pub overlap_px: f64,
    /// Photometric score of the better side, 0 to 1.
    pub score: f64,
}

/// The outcome of the pair search for one segment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PairSearch {
    /// Candidates in beams that passed the geometric tests.
    pub candidates: u32,
    /// Best score among them.
    pub best: f64,
}

/// All pair hypotheses that any later step uses: those above `pair_score * with_segment`.
#[derive(Default)]
pub(crate) struct SegmentPairs {
    /// The pairs of one pass, sorted by (a, b).
    pub pairs: Vec<SegmentPair>,
    /// For each view and segment, the outcome of its search in both directions.
    pub searches: Vec<Vec<PairSearch>>,
}

/// The input of a search for pairs.
pub(super) struct PairScope<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its segments.
    pub prepared: &'a PreparedSegments,
    /// Pairs of views with common ground.
    pub view_pairs: &'a [(ViewId, ViewId)],
    /// Heights between which lines are sought, metres.
    pub z_range: [f64; 2],
    /// Matching parameters.
    pub params: &'a MatchParams,
    /// The properties in which two segments must agree.
    pub compatibility: Compatibility,
}

/// Matches every segment that is not taken yet with those of its partner views.
pub(super) fn match_pairs(
    scope: &PairScope,
    taken: impl Fn(SegmentRef) -> bool + Sync,
    pass: Pass,
) -> Sharded<SegmentPairs> {
    let free: Vec<SegmentRef> = (scope.scene.view_ids())
        .flat_map(|view| scope.prepared.of_view(view))
        .map(|(name, _)| name)
        .filter(|name| !taken(*name))
        .collect();
    let found = sharded_map(
        pass.map_name("pairs"),
        &free,
        pass.progress_part(0.2..0.5),
        |_, name| scope.pairs_of(*name, &taken),
    )?;
    let mut searches: Vec<Vec<PairSearch>> = (scope.prepared.views.iter())
        .map(|v| vec![PairSearch::default(); v.segments.len()])
        .collect();
    let mut pairs: Vec<SegmentPair> = Vec::new();
    let least = scope.params.pair_score * scope.params.with_segment;
    for pair in found.into_iter().flatten() {
        for s in [pair.a, pair.b] {
            let search = &mut searches[s.view.index()][s.segment.index()];
            search.candidates += 1;
            search.best = search.best.max(pair.score);
        }
        if pair.score >= least {
            pairs.push(pair);
        }
    }
    Ok(SegmentPairs { pairs, searches })
}

impl SegmentPairs {
    /// Adds those of a further pass.
    pub(crate) fn append(&mut self, more: Self) {
        self.pairs.extend(more.pairs);
        self.searches.resize(more.searches.len(), Vec::new());
        for (view, searches) in self.searches.iter_mut().zip(more.searches) {
            view.resize(searches.len(), PairSearch::default());
            for (search, again) in view.iter_mut().zip(searches) {
                search.candidates += again.candidates;
                search.best = search.best.max(again.best);
            }
        }
    }
}

impl PairScope<'_> {
    /// Scores a segment against its candidates in all partner views of higher index.
    fn pairs_of(&self, name: SegmentRef, taken: &impl Fn(SegmentRef) -> bool) -> Vec<SegmentPair> {
        let Some(geometry) = self.prepared.get(name) else {
            return Vec::new();
        };
        let first = self.scene.view(name.view);
        let frame = StripFrame::new(&geometry.segment, self.params.window_px);
        // The surroundings of a line show in grey values, whichever channel shows the line.
        let channel = if self.compatibility.kind {
            geometry.kind.channel()
        } else {
            Channel::Grey
        };
        let strip = LineStrip::reference(first.channel(channel).0, &frame);
        let mut pairs = Vec::new();
        let partners = self.view_pairs.iter().filter(|(v, _)| *v == name.view);
        for (_, other) in partners {
            let camera = self.scene.camera(*other);
            let Some(beam) = epipolar_beam(&first.camera, &geometry.segment, camera, self.z_range)
            else {
                continue;
            };
            let near =
                (self.prepared.views[other.index()].index).near_quad(&beam, self.params.gate_px);
            for id in near {
                let b = SegmentRef {
                    view: *other,
                    segment: crate::base::ids::SegmentId(id),
                };
                let candidate = self
                    .prepared
                    .get(b)
                    .filter(|c| !taken(b) && self.compatibility.allows(geometry.kind, c.kind));
                let Some(common) = candidate
                    .and_then(|c| PairGeometry::new([&first.camera, camera], [geometry, c], self))
                else {
                    continue;
                };
                let views = [name.view, *other];
                let score = pair_score(
                    self.scene,
                    views,
                    channel,
                    &frame,
                    &strip,
                    &common,
                    self.params,
                );
                pairs.push(SegmentPair {
                    a: name,
                    b,
                    overlap: common.overlap,
                    overlap_px: common.to_px - common.from_px,
                    score,
                });
            }
        }
        pairs
    }
}

/// The 3D line that two segments would have in common.
struct PairGeometry {
    overlap: Segment3,
    /// The overlap along the first segment, pixels from its start.
    from_px: f64,
    to_px: f64,
}

impl PairGeometry {
    /// The common stretch, where it is long enough, well conditioned, in the height range, not too
    /// steep, and of one contrast direction.
    fn new(
        [first, second]: [&Camera; 2],
        [a, b]: [&SegmentGeometry; 2],
        scope: &PairScope,
    ) -> Option<Self> {
        let params = scope.params;
        let sine = |plane: &Plane, rays: &[Vector3<f64>; 2]| {
            let [s, e] = rays.map(|r| plane.normal.dot(&r).abs());
            s.min(e)
        };
        if sine(&b.plane, &a.rays) < params.min_intersection_sine
            || sine(&a.plane, &b.rays) < params.min_intersection_sine
        {
            return None;
        }
        let meet = |center: &Point3<f64>, rays: &[Vector3<f64>; 2], plane: &Plane| {
            Some([
                ray_in_plane(center, &rays[0], plane)?,
                ray_in_plane(center, &rays[1], plane)?,
            ])
        };
        let [a0, a1] = meet(&first.center, &a.rays, &b.plane)?;
        let [b0, b1] = meet(&second.center, &b.rays, &a.plane)?;
        let length = (a1 - a0).norm();
        let direction = (a1 - a0) / length.max(1e-9);
        let (t0, t1) = ((b0 - a0).dot(&direction), (b1 - a0).dot(&direction));
        if scope.compatibility.contrast && t1 <= t0 {
            return None;
        }
        let (from, to) = (t0.min(t1).max(0.0), t0.max(t1).min(length));
        let px = a.length_px / length;
        // The ends of detected segments are not reliable: a window's half may be missing.
        if (to - from) * px < params.min_edgels as f64 {
            return None;
        }
        let overlap = Segment3::new(a0 + direction * from, a0 + direction * to);
        let [low, high] = scope.z_range;
        let in_range = |z: f64| z >= low && z <= high;
        let steepest = crate::base::math::sin(params.max_slope_deg.to_radians());
        (in_range(overlap.p0.z) && in_range(overlap.p1.z) && direction.z.abs() <= steepest)
            .then_some(Self {
                overlap,
                from_px: from * px,
                to_px: to * px,
            })
    }
}

/// Photometric score of two segments over their common stretch: the better side, each with the best
/// of its planes.
fn pair_score(
    scene: &Scene,
    views: [ViewId; 2],
    channel: Channel,
    frame: &StripFrame,
    strip: &LineStrip,
    common: &PairGeometry,
    params: &MatchParams,
) -> f64 {
    let start = (common.from_px.round() as usize).min(frame.edgels - 1);
    let end = (common.to_px.round() as usize).clamp(start + 1, frame.edgels);
    let part = frame.part(start, end - start);
    let strip = strip.part(start, end - start);
    let score = |side: StripSide, theta_deg: f64| {
        side_correlation(
            scene,
            views,
            channel,
            &part,
            &strip,
            &common.overlap,
            side,
            theta_deg,
            params,
        )
        .map(|c| EdgelScore::of(&c, params.edgel_correlation))
        .filter(|s| s.included >= params.min_edgels)
        .map_or(0.0, |s| s.score)
    };
    let mut best = 0.0f64;
    for &theta in &params.plane_angles_deg {
        for side in StripSide::BOTH {
            best = best.max(score(side, theta));
        }
        // Where a plane explains a side well enough, no other is tried.
        if best >= 1.5 * params.pair_score {
            break;
        }
    }
    best
}

/// Correlations at the edgels of a reference strip with another view, see [`side_strip`].
#[allow(clippy::too_many_arguments)] // A struct of them would be used once.
fn side_correlation(
    scene: &Scene,
    views: [ViewId; 2],
    channel: Channel,
    frame: &StripFrame,
    strip: &LineStrip,
    line: &Segment3,
    side: StripSide,
    theta_deg: f64,
    params: &MatchParams,
) -> Option<Vec<f32>> {
    let warped = side_strip(scene, views, channel, frame, line, side, theta_deg)?;
    Some(correlate(strip, &warped, side, params.noise))
}

/// One side of a line's strip in the second view, warped by the half-plane at `theta_deg`. `None`
/// for a line without such a plane.
pub(super) fn side_strip(
    scene: &Scene,
    [first, second]: [ViewId; 2],
    channel: Channel,
    frame: &StripFrame,
    line: &Segment3,
    side: StripSide,
    theta_deg: f64,
) -> Option<LineStrip> {
    let view = scene.view(second);
    let h = side_homography(scene.camera(first), &view.camera, line, side, theta_deg)?;
    Some(LineStrip::warped(view.channel(channel).0, &h, frame, side))
}

/// The homography of the half-plane at `theta_deg` on one side of a line, the side as seen in
/// `first`.
fn side_homography(
    first: &Camera,
    second: &Camera,
    line: &Segment3,
    side: StripSide,
    theta_deg: f64,
) -> Option<Homography> {
    // What is right on the screen of a camera that looks down is right from above.
    let from_above = match side {
        StripSide::Left => Side::Left,
        StripSide::Right => Side::Right,
    };
    let plane = ThetaFrame::new(line, from_above)?.plane(line, theta_deg.to_radians());
    homography_of_plane(first, second, &plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::Segment2;
    use crate::lines::lines2d::SegmentKind;
    use crate::lines::lines3d::planted;

    #[test]
    fn a_rising_side_is_warped_as_it_rises() {
        let scene = planted::scene();
        let line = Segment3::new(Point3::new(-3.0, 1.0, 4.0), Point3::new(5.0, 2.0, 4.5));
        for (i, j) in [(0, 1), (0, 2), (3, 1)] {
            let (first, second) = (&scene.views[i].camera, &scene.views[j].camera);
            for (side, sign) in [(StripSide::Left, 1.0), (StripSide::Right, -1.0)] {
                // Two metres to the side and, at 40 degrees, upwards.
                let left = Vector3::z().cross(&line.direction()).normalize();
                let theta = 40.0f64.to_radians();
                let up = line.direction().cross(&left);
                let world = line.at(0.4)
                    + left * (2.0 * sign * crate::base::math::cos(theta))
                    + up * (2.0 * crate::base::math::sin(theta));
                let h = side_homography(first, second, &line, side, 40.0).unwrap();
                let seen = first.project(&world).unwrap();
                assert!((h.apply(&seen).unwrap() - second.project(&world).unwrap()).norm() < 1e-6);
                // It lies on that side of the line in the first view.
                let image = Segment2::new(
                    first.project(&line.p0).unwrap(),
                    first.project(&line.p1).unwrap(),
                );
                let right = image.line().dot(&Vector3::new(seen.x, seen.y, 1.0)) > 0.0;
                assert_eq!(right, side == StripSide::Right);
            }
        }
    }

    fn pairs_of(
        scene: &Scene,
        prepared: &PreparedSegments,
        view_pairs: &[(ViewId, ViewId)],
        compatibility: Compatibility,
    ) -> SegmentPairs {
        let params = MatchParams::default();
        let scope = PairScope {
            scene,
            prepared,
            view_pairs,
            z_range: [-2.0, 8.0],
            params: &params,
            compatibility,
        };
        match_pairs(&scope, |_| false, Pass::Second).unwrap()
    }

    const COMPATIBLE: Compatibility = Compatibility {
        contrast: true,
        kind: true,
    };

    #[test]
    fn a_line_along_the_baseline_is_no_pair() {
        let scene = planted::scene();
        let segments = planted::segments(&scene);
        let prepared = PreparedSegments::new(&scene, &segments);
        let view_pairs: Vec<_> = [(0, 1), (0, 3)]
            .map(|(a, b)| (ViewId(a), ViewId(b)))
            .to_vec();
        let pairs = pairs_of(&scene, &prepared, &view_pairs, COMPATIBLE);
        // Edge 1 runs along x, the direction of the baseline of views 0 and 1, edge 0 across it.
        let found = |edge: u32, other: u32| {
            let name = |v| SegmentRef {
                view: ViewId(v),
                segment: crate::base::ids::SegmentId(edge),
            };
            pairs.score(name(0), name(other)) > 0.0
        };
        assert!(found(0, 1) && !found(1, 1), "within the strip");
        assert!(found(1, 3) && !found(0, 3), "across the strips");
    }

    #[test]
    fn slopes_are_matched_by_the_search_over_angles_alone() {
        let scene = planted::gable();
        let segments: Vec<Vec<_>> = (scene.views.iter())
            .map(|view| {
                let end = |t| view.camera.project(&planted::ridge().at(t)).unwrap();
                vec![planted::detected(Segment2::new(end(0.05), end(0.95)), 0)]
            })
            .collect();
        let prepared = PreparedSegments::new(&scene, &segments);
        let name = |v| SegmentRef {
            view: ViewId(v),
            segment: crate::base::ids::SegmentId(0),
        };
        let score = |other: u32, plane_angles_deg: Vec<f64>| {
            let params = MatchParams {
                plane_angles_deg,
                edgel_correlation: 0.65,
                ..MatchParams::default()
            };
            let scope = PairScope {
                scene: &scene,
                prepared: &prepared,
                view_pairs: &[(ViewId(0), ViewId(other))],
                z_range: [-2.0, 8.0],
                params: &params,
                compatibility: COMPATIBLE,
            };
            match_pairs(&scope, |_| false, Pass::Second)
                .unwrap()
                .score(name(0), name(other))
        };
        let params = MatchParams::default();
        // Within a strip, and in strips flown in opposite directions.
        for other in [1, 2] {
            let level = score(other, vec![0.0]);
            let searched = score(other, params.plane_angles_deg.clone());
            assert!(level < 0.5, "{level} by level windows");
            assert!(searched > 0.75, "{searched} by the search");
        }
    }

    #[test]
    fn segments_in_colour_and_in_grey_values_are_no_pair() {
        let scene = planted::scene();
        let view_pairs = [(ViewId(0), ViewId(3))];
        let name = |v| SegmentRef {
            view: ViewId(v),
            segment: crate::base::ids::SegmentId(1),
        };
        let score = |in_color: &[usize], compatibility: Compatibility| {
            let mut segments = planted::segments(&scene);
            for &view in in_color {
                segments[view][1].kind = SegmentKind::Color;
            }
            let prepared = PreparedSegments::new(&scene, &segments);
            let pairs = pairs_of(&scene, &prepared, &view_pairs, compatibility);
            pairs.score(name(0), name(3))
        };
        // The scene has no colour, so that grey values replace it.
        assert!(score(&[], COMPATIBLE) > 0.0 && score(&[0, 3], COMPATIBLE) > 0.0);
        assert_eq!(score(&[0], COMPATIBLE), 0.0);
        assert_eq!(score(&[3], COMPATIBLE), 0.0);
        let any = Compatibility {
            kind: false,
            ..COMPATIBLE
        };
        assert!(score(&[3], any) > 0.0, "where they need not be alike");
    }
}
