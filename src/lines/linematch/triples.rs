//! Three-view matching (B99 3.2): a pair fixes a 3D line, its image in a third view is the trifocal
//! transfer of the pair, and a segment found there verifies it.
//!
//! Every third view that verifies a pair makes a triple. The triples of one pair share their line,
//! so they are kept together as a [`TripleBundle`]: that is the join of triplets of B99 3.4 for
//! triples with two segments in common. Because each pair of views takes its turn as the first
//! two, all search directions are covered.
//!
//! Deviation: the photometric test alone ("without a segment") adds views to a line in `nview` but
//! does not replace the third segment. Of the lines with two segments and correlation in two or
//! more other views, 28 % were wrong on six views with a base-to-height ratio of 0.2 to 0.4.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::pairs::{PairScope, SegmentPair, SegmentPairs};
use super::pass::Pass;
use super::segment_geometry::{PreparedSegments, SegmentGeometry, SegmentRef};
use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::Segment2;
use crate::base::ids::ViewId;
use crate::base::line_linker::LineLinker;
use crate::lines::lines3d::ProjectedLine;
use crate::orienting::scene::Scene;

/// Largest standard deviation of a transferred line that can be verified, px.
const MAX_SIGMA_PX: f64 = 2.0;

/// A segment at the position that a pair predicts in a third view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verification {
    /// The segment.
    pub segment: SegmentRef,
    /// Its better photometric score with the two segments of the pair.
    pub score: f64,
}

/// A pair with the segments of all third views that verify it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct TripleBundle {
    /// Index into [`SegmentPairs::pairs`].
    pub pair: usize,
    /// By view and segment; several in one view are fragments of one line.
    pub verified: Vec<Verification>,
}

impl TripleBundle {
    /// The verifications of each third view.
    pub(crate) fn views(&self) -> impl Iterator<Item = &[Verification]> {
        self.verified
            .chunk_by(|a, b| a.segment.view == b.segment.view)
    }
}

/// Verifies every pair above the threshold in all other views.
pub(super) fn verify_pairs(
    scope: &PairScope,
    pairs: &SegmentPairs,
    pass: Pass,
) -> Sharded<Vec<TripleBundle>> {
    let strong: Vec<usize> = (0..pairs.pairs.len())
        .filter(|&i| pairs.pairs[i].score >= scope.params.pair_score)
        .collect();
    sharded_map(
        pass.map_name("triples"),
        &strong,
        pass.progress_part(0.5..0.6),
        |_, &index| {
            let pair = &pairs.pairs[index];
            let others =
                (scope.scene.view_ids()).filter(|v| *v != pair.a.view && *v != pair.b.view);
            TripleBundle {
                pair: index,
                verified: others
                    .flat_map(|view| verify_in_view(scope, pairs, pair, view))
                    .collect(),
            }
        },
    )
}

/// Segments of one view at the predicted position that also pass the photometric test.
fn verify_in_view(
    scope: &PairScope,
    pairs: &SegmentPairs,
    pair: &SegmentPair,
    view: ViewId,
) -> Vec<Verification> {
    let (scene, prepared) = (scope.scene, scope.prepared);
    let Some(prediction) = TransferredLine::new(scene, prepared, pair, view) else {
        return Vec::new();
    };
    let reach = scope.params.gate_px.max(3.0 * prediction.sigma_px);
    let ends = [
        prediction.image.at(0.0),
        prediction.image.at(prediction.length),
    ];
    let [Some(start), Some(end)] = ends else {
        return Vec::new();
    };
    let stretch = Segment2::new(start, end);
    let near = prepared.views[view.index()]
        .index
        .near_segment(&stretch, reach);
    near.into_iter()
        .filter_map(|id| {
            let segment = SegmentRef {
                view,
                segment: crate::base::ids::SegmentId(id),
            };
            let geometry = prepared.get(segment)?;
            prediction.agrees(geometry, reach, scope).then_some(())?;
            let score = pairs
                .score(pair.a, segment)
                .max(pairs.score(pair.b, segment));
            (score > 0.0).then_some(Verification { segment, score })
        })
        .collect()
}

impl SegmentPairs {
    /// Score of two segments of different views in either order; zero when they are no pair.
    pub(crate) fn score(&self, s: SegmentRef, t: SegmentRef) -> f64 {
        let key = (s.min(t), s.max(t));
        self.pairs
            .binary_search_by(|p| (p.a, p.b).cmp(&key))
            .map_or(0.0, |i| self.pairs[i].score)
    }
}

/// The trifocal transfer of a pair to a third view, with its uncertainty.
struct TransferredLine {
    image: ProjectedLine,
    /// Length of the predicted stretch along the 3D line, metres.
    length: f64,
    /// Standard deviation across the line at the worse end, pixels.
    sigma_px: f64,
}

impl TransferredLine {
    fn new(
        scene: &Scene,
        prepared: &PreparedSegments,
        pair: &SegmentPair,
        view: ViewId,
    ) -> Option<Self> {
        let camera = scene.camera(view);
        let image = ProjectedLine::new(camera, &pair.overlap)?;
        let length = pair.overlap.length();
        let sigma_px = transfer_sigma(scene, prepared, pair, view, &image)?;
        (sigma_px <= MAX_SIGMA_PX).then_some(Self {
            image,
            length,
            sigma_px,
        })
    }

    /// Does a segment lie on the prediction, over their common stretch?
    fn agrees(&self, geometry: &SegmentGeometry, reach: f64, scope: &PairScope) -> bool {
        let ends = [geometry.segment.p0, geometry.segment.p1];
        let [t0, t1] = ends.map(|p| self.image.t_of(&p));
        if scope.compatibility.contrast && t1 <= t0 {
            return false;
        }
        let (from, to) = (t0.min(t1).max(0.0), t0.max(t1).min(self.length));
        let span = (t1 - t0).abs();
        // Half a window in common, or half of a short one.
        let px = geometry.length_px / span.max(1e-9);
        if (to - from) * px < 0.5 * (scope.params.window_px as f64).min(geometry.length_px) {
            return false;
        }
        let linker = LineLinker::predicted_image(reach).known_to(geometry.sigma_px);
        [from, to].iter().all(|t| {
            let p = geometry.segment.at((t - t0) / (t1 - t0));
            linker.distance(self.image.distance(&p)) >= 0.0
        })
    }
}

/// How far the predicted line moves for one standard deviation of either segment, pixels: an error
/// of `b` moves the point where a ray of `a` meets b's plane along that ray, and the reverse.
fn transfer_sigma(
    scene: &Scene,
    prepared: &PreparedSegments,
    pair: &SegmentPair,
    view: ViewId,
    image: &ProjectedLine,
) -> Option<f64> {
    let (a, b) = (prepared.get(pair.a)?, prepared.get(pair.b)?);
    let (first, second) = (scene.camera(pair.a.view), scene.camera(pair.b.view));
    let third = scene.camera(view);
    let shift =
        |x: &Point3<f64>, along: &Vector3<f64>| Some(image.distance(&third.project(&(x + along))?));
    let mut worst = 0.0f64;
    for x in [pair.overlap.p0, pair.overlap.p1] {
        let ray = |c: &Point3<f64>| (x - c).normalize();
        let (ra, rb) = (ray(&first.center), ray(&second.center));
        let by_b = b.sigma_px * second.ground_pixel(&x) / b.plane.normal.dot(&ra);
        let by_a = a.sigma_px * first.ground_pixel(&x) / a.plane.normal.dot(&rb);
        let (sa, sb) = (shift(&x, &(ra * by_b))?, shift(&x, &(rb * by_a))?);
        worst = worst.max((sa * sa + sb * sb).sqrt());
    }
    worst.is_finite().then_some(worst)
}

#[cfg(test)]
mod tests {
    use super::super::pairs::match_pairs;
    use super::super::segment_geometry::{Compatibility, ray_in_plane};
    use super::*;
    use crate::base::geometry::Segment3;
    use crate::base::ids::SegmentId;
    use crate::base::params::MatchParams;
    use crate::lines::lines2d::ImageSegment;
    use crate::lines::lines3d::planted;
    use nalgebra::Matrix2;

    fn name(view: u32, segment: u32) -> SegmentRef {
        SegmentRef {
            view: ViewId(view),
            segment: SegmentId(segment),
        }
    }

    /// The segments of view 3 that verify the pair of the first edge in views 0 and 1, after a
    /// change of the segment of view 3.
    fn verified(contrast: bool, change: impl Fn(&mut ImageSegment)) -> Vec<SegmentRef> {
        let scene = planted::scene();
        let mut segments = planted::segments(&scene);
        change(&mut segments[3][0]);
        let view_pairs: Vec<_> = (0..5)
            .flat_map(|a| (a + 1..5).map(move |b| (ViewId(a), ViewId(b))))
            .collect();
        let scope = PairScope {
            scene: &scene,
            prepared: &PreparedSegments::new(&scene, &segments),
            view_pairs: &view_pairs,
            z_range: [-2.0, 8.0],
            params: &MatchParams::default(),
            compatibility: Compatibility {
                contrast,
                kind: true,
            },
        };
        let pairs = match_pairs(&scope, |_| false, Pass::Second).unwrap();
        let of_edge = |p: &&SegmentPair| p.a == name(0, 0) && p.b == name(1, 0);
        let pair = pairs.pairs.iter().find(of_edge).expect("the pair");
        let found = verify_in_view(&scope, &pairs, pair, ViewId(3));
        found.into_iter().map(|v| v.segment).collect()
    }

    #[test]
    fn a_segment_at_the_predicted_position_verifies_a_pair() {
        let own = [name(3, 0)];
        assert_eq!(verified(true, |_| ()), own);
        let moved = |by: f64| {
            move |s: &mut ImageSegment| {
                let off = s.segment.normal() * by;
                s.segment = Segment2::new(s.segment.p0 + off, s.segment.p1 + off);
            }
        };
        assert_eq!(verified(true, moved(0.6)), own, "within the gate");
        assert_eq!(verified(true, moved(1.6)), [], "beside it");
        let reverse = |s: &mut ImageSegment| s.segment = s.segment.reversed();
        assert_eq!(verified(true, reverse), [], "bright on the other side");
        assert_eq!(verified(false, reverse), own, "where that may be");
        let elsewhere = |s: &mut ImageSegment| {
            let along = s.segment.p1 - s.segment.p0;
            s.segment = Segment2::new(s.segment.p0 + along * 1.2, s.segment.p1 + along * 1.2);
        };
        assert_eq!(verified(true, elsewhere), [], "behind its end");
    }

    /// Standard deviation in view `third` of an edge transferred from views 0 and `second`, px, if
    /// only the segment of the second one is uncertain by `sigma` px: as stated, and from a shift
    /// of that segment.
    fn transferred(edge: u32, second: u32, third: u32, sigma: f64) -> [f64; 2] {
        let scene = planted::scene();
        let whole = |view: u32, sigma: f64| ImageSegment {
            covariance: Matrix2::new(sigma * sigma, 0.0, 0.0, 0.0),
            ..planted::detected(
                planted::part_of(&scene, view as usize, edge as usize, 0.0, 1.0),
                0,
            )
        };
        let mut segments = vec![Vec::new(); 5];
        segments[0].push(whole(0, 0.0));
        segments[second as usize].push(whole(second, sigma));
        let mut moved = segments.clone();
        let s = &mut moved[second as usize][0].segment;
        let off = s.normal() * sigma;
        *s = Segment2::new(s.p0 + off, s.p1 + off);
        let overlap = |segments: &[Vec<ImageSegment>]| {
            let prepared = PreparedSegments::new(&scene, segments);
            let (a, b) = (
                prepared.get(name(0, 0)).unwrap(),
                prepared.get(name(second, 0)).unwrap(),
            );
            let center = scene.camera(ViewId(0)).center;
            let [start, end] = a.rays.map(|r| ray_in_plane(&center, &r, &b.plane).unwrap());
            Segment3::new(start, end)
        };
        let pair = SegmentPair {
            a: name(0, 0),
            b: name(second, 0),
            overlap: overlap(&segments),
            overlap_px: 100.0,
            score: 1.0,
        };
        let third = ViewId(third);
        let image = ProjectedLine::new(scene.camera(third), &pair.overlap).unwrap();
        let prepared = PreparedSegments::new(&scene, &segments);
        let stated = transfer_sigma(&scene, &prepared, &pair, third, &image).unwrap();
        let shift = |p| {
            image
                .distance(&scene.camera(third).project(&p).unwrap())
                .abs()
        };
        let there = overlap(&moved);
        [stated, shift(there.p0).max(shift(there.p1))]
    }

    #[test]
    fn a_prediction_is_as_uncertain_as_it_moves() {
        // Within the strip and across, far from and near the direction of the baseline.
        for (edge, second, third) in [(0, 1, 4), (0, 2, 3), (1, 3, 2), (1, 2, 4)] {
            let [stated, moved] = transferred(edge, second, third, 0.2);
            assert!(
                stated > 1e-3 && (stated / moved - 1.0).abs() < 0.05,
                "{stated} {moved}"
            );
        }
        // Edge 1 runs along the strip of views 0 and 1, which leave it undetermined in another
        // strip.
        let [along, _] = transferred(1, 1, 3, 0.2);
        let [across, _] = transferred(1, 3, 2, 0.2);
        assert!(
            along > MAX_SIGMA_PX && across < 0.5,
            "{along} and {across} px"
        );
    }
}
