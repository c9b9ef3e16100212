//! From a pair or triple to a line over N views (B99 3.4): the 3D line is projected into all views,
//! segments near the projection are adopted, the line is fitted again, merged and grown, and its
//! views are counted.

use serde::Serialize;

use super::ends::sharpened;
use super::grow::supported_stretch;
use super::profile::{Profile, ViewProfile};
use crate::geometry::{Segment2, Segment3};
use crate::ids::ViewId;
use crate::linematch::sight::{Alike, SegmentRef, Sights};
use crate::linematch::strip::EdgelScore;
use crate::lines2d::GuidedEdge;
use crate::lines2d::ImageSegment;
use crate::lines3d::{LineFit, Observation, conditioning, fit_line};
use crate::lines3d::{LineSupport, SupportKind};
use crate::params::Lines3dParams;
use crate::params::MatchParams;
use crate::scene::Scene;
use crate::sorting::sort_by_key;

/// How often segments are adopted and the line fitted again. Assumption: the second round changes
/// few lines, a third none.
const ROUNDS: usize = 2;
/// Least number of views with a segment. Two interpretation planes always meet in a line; the third
/// makes it evidence, correlation without a segment then adds to it.
const MIN_MEASURED: usize = 3;
/// Least number of views with an edge and views with a detected segment, together: three of three, or two with
/// four where the edge was found again. Where there are three views in all, two with segments do: fewer chances to be
/// wrong, and no fourth view to make up for a segment that was missed.
const MIN_EVIDENCE: usize = 6;
const MIN_EVIDENCE_OF_THREE: usize = 5;
/// Where so many views see a line, [`MatchParams::min_views`] must support it (B99 3.4).
pub const MANY_VIEWS: usize = 6;
/// How far beside a line, in gates, a segment belongs to it and starts no other line.
const OWN: f64 = 1.5;
/// A stretch reaches past the detected segments by this much to count as grown, px: more than a piece of
/// a measured edge.
const GROWN_PX: f64 = 6.0;

/// Why a hypothesis that no other line took the segments of did not become a match.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Rejection {
    /// No line fits the segments.
    NoFit,
    /// The line is not determined well enough across itself.
    IllConditioned,
    /// One view alone determines it in some direction: whatever segment lies there fits.
    Unverified,
    /// The edge shows in fewer than three views.
    TooFewEdges,
    /// Too few views have a segment of their own on it.
    TooFewSegments,
    /// The neighbourhoods of its edges differ between the views.
    NotAlike,
    /// Fewer than the minimum of views support it.
    TooFewViews,
    /// The supported stretch is shorter than the minimum of edgels.
    TooShort,
    /// It leaves the height range.
    OutsideHeights,
}

/// A line over N views, not yet compared with others.
#[derive(Clone)]
pub struct Line {
    /// The fitted line, directed by contrast where that is the same in all views.
    pub segment: Segment3,
    /// The fit: the same line between other ends.
    pub fit: LineFit,
    /// Its supports, by view.
    pub supports: Vec<LineSupport>,
}

/// What [`complete_line`] needs of the whole.
pub struct Context<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The detected segments.
    pub segments: &'a [Vec<ImageSegment>],
    /// The same, prepared.
    pub sights: &'a Sights,
    /// Heights between which lines are sought, metres.
    pub z_range: [f64; 2],
    /// Matching parameters.
    pub params: &'a MatchParams,
    /// Fitting parameters.
    pub fitting: &'a Lines3dParams,
    /// What the segments of a line must have in common.
    pub alike: Alike,
}

/// Tells which segments belong to other lines.
pub type Taken<'a> = &'a dyn Fn(SegmentRef) -> bool;

/// Completes a hypothesis from some of its segments; `taken` tells which segments belong to other
/// lines.
pub fn complete_line(
    context: &Context,
    start: &Segment3,
    seeds: &[SegmentRef],
    taken: Taken,
) -> Result<Line, Rejection> {
    let (mut fit, mut segments) = context.fit_consistent(start, seeds)?;
    for _ in 0..ROUNDS {
        let adopted = context.adopt(&fit.line, &segments, &[], 1.0, taken);
        (fit, segments) = context.fit_consistent(&fit.line, &adopted)?;
    }
    let (mut fit, mut edges) = context.measure_again(fit, &segments, taken)?;
    let mut segments = context.adopt(&fit.line, &segments, &edges, OWN, taken);
    loop {
        let evidence = edges.len() + views_of(&segments);
        if evidence < context.least_evidence() {
            return Err(Rejection::TooFewSegments);
        }
        let profile = context.profile(&fit.line, &segments, &edges)?;
        let stretch = supported_stretch(&profile, context.params).ok_or(Rejection::TooFewViews)?;
        let stretch = sharpened(context.scene, &profile, stretch);
        if stretch.1 - stretch.0 + 1 < context.params.min_edgels {
            return Err(Rejection::TooShort);
        }
        let supports = context.supports(&profile, stretch);
        let disagreeing = disagreeing_views(&profile, &supports, context.params);
        if disagreeing.is_empty() {
            let ends = [profile.t[stretch.0], profile.t[stretch.1]];
            let expected = context.expected_views(&profile, stretch);
            return context.check_line(fit, ends, expected, supports);
        }
        segments.retain(|s| !disagreeing.contains(&s.view));
        edges.retain(|e| !disagreeing.contains(&e.view));
        if edges.len() < MIN_MEASURED {
            return Err(Rejection::NotAlike);
        }
        (fit, edges) = context.fit_edges(&fit.line, &edges)?;
    }
}

/// Views that have segments on the line but see another edge nearby: those that do not support it
/// photometrically and, where the views are not alike in the mean, the one least like the others. A
/// wrong view displaces the line and with it the windows of the right ones, so one is left out at a
/// time. Three edges that meet in a line may do so by chance and have to be alike, or two of them so much that they need no
/// third ([`pair_suffices`]); from the fourth on it is enough that they are half as much, as with any segment at a
/// predicted position (B99 3.2).
fn disagreeing_views(
    profile: &Profile,
    supports: &[LineSupport],
    params: &MatchParams,
) -> Vec<ViewId> {
    let measured = profile.views.iter().filter(|v| v.measured());
    let mean = supports.iter().map(|s| s.score).sum::<f64>() / supports.len().max(1) as f64;
    if mean < least_mean(profile.measured(), params) && !pair_suffices(profile, supports, params) {
        let worst = measured.min_by(|a, b| a.agreement.total_cmp(&b.agreement));
        return worst.map(|v| v.view).into_iter().collect();
    }
    let supported = |v: &&ViewProfile| supports.iter().any(|s| s.view == v.view);
    measured.filter(|v| !supported(v)).map(|v| v.view).collect()
}

/// Are two of three edges as alike as is asked where no segment verifies them (B99 3.2)? Then the place of the third view's
/// segment does: the other strip may see an eave before another ground and its roof in another light.
fn pair_suffices(profile: &Profile, supports: &[LineSupport], params: &MatchParams) -> bool {
    let reference = profile.views[profile.reference].view;
    let mut others = supports
        .iter()
        .filter(|s| s.edge.is_some() && s.view != reference);
    let least = params.pair_score * params.without_segment;
    profile.measured() == MIN_MEASURED && others.any(|s| s.score >= least)
}

/// What the supports of a line must score in the mean, given the number of views with an edge.
fn least_mean(measured: usize, params: &MatchParams) -> f64 {
    let factor = match measured > MIN_MEASURED {
        true => params.with_segment,
        false => 1.0,
    };
    params.pair_score * factor
}

/// What a view with an edge must score, given how uncertain the others leave the line, as a share of what is allowed. Where
/// they determine it, the edge is a measurement at the predicted position; where they do not, any parallel edge would fit, and
/// its grey values have to agree as much as without one. Where views are `few` there is a way between, which six views do not
/// need: the less certain the others are, the more it has to agree.
fn least_score(uncertainty: f64, few: bool, params: &MatchParams) -> f64 {
    let without_edge = params.pair_score * params.without_segment;
    if uncertainty <= 1.0 {
        return f64::NEG_INFINITY;
    }
    if !few || uncertainty >= 2.0 {
        return without_edge;
    }
    params.pair_score + (without_edge - params.pair_score) * (uncertainty - 1.0)
}

/// The first of the largest residuals.
fn worst_residual(residuals: &[f64]) -> Option<usize> {
    (0..residuals.len()).max_by(|&i, &j| residuals[i].total_cmp(&residuals[j]).then(j.cmp(&i)))
}

/// Number of views among segments sorted by view.
fn views_of(segments: &[SegmentRef]) -> usize {
    segments.chunk_by(|a, b| a.view == b.view).count()
}

impl Context<'_> {
    fn profile(
        &self,
        line: &Segment3,
        segments: &[SegmentRef],
        edges: &[GuidedEdge],
    ) -> Result<Profile, Rejection> {
        Profile::new(self.scene, self.sights, line, segments, edges, self.params)
            .ok_or(Rejection::NoFit)
    }

    /// Measures the edge again in every view that sees the line, and fits the line to what was found.
    fn measure_again(
        &self,
        mut fit: LineFit,
        segments: &[SegmentRef],
        taken: Taken,
    ) -> Result<(LineFit, Vec<GuidedEdge>), Rejection> {
        let mut edges = Vec::new();
        for _ in 0..ROUNDS {
            let found: Vec<GuidedEdge> = (self.scene.view_ids())
                .filter_map(|view| self.measure(&fit.line, segments, view, taken))
                .collect();
            (fit, edges) = self.fit_edges(&fit.line, &found)?;
        }
        Ok((fit, edges))
    }

    /// [`Self::fit_consistent`] for measured edges.
    fn fit_edges(
        &self,
        start: &Segment3,
        edges: &[GuidedEdge],
    ) -> Result<(LineFit, Vec<GuidedEdge>), Rejection> {
        let mut kept = edges.to_vec();
        loop {
            if kept.len() < MIN_MEASURED {
                return Err(Rejection::TooFewEdges);
            }
            let fit = fit_line(&self.observed(kept.iter()), start, self.fitting)
                .ok_or(Rejection::NoFit)?;
            match worst_residual(&fit.residuals) {
                Some(worst) if fit.residuals[worst] > self.fitting.max_residual => {
                    kept.remove(worst);
                }
                _ => return Ok((fit, kept)),
            }
        }
    }

    fn observed<'e>(&self, edges: impl Iterator<Item = &'e GuidedEdge>) -> Vec<Observation<'_>> {
        edges
            .map(|e| Observation::of(e, self.scene.camera(e.view)))
            .collect()
    }

    /// Fits the line to those segments that agree with each other: the worst is dropped and the
    /// line fitted again until none is farther than `max_residual`. The robust loss alone leaves a
    /// line between two parallel edges a pixel apart.
    fn fit_consistent(
        &self,
        start: &Segment3,
        segments: &[SegmentRef],
    ) -> Result<(LineFit, Vec<SegmentRef>), Rejection> {
        let mut kept = segments.to_vec();
        loop {
            let fit = self.fit(start, &kept)?;
            let worst = worst_residual(&fit.residuals).ok_or(Rejection::NoFit)?;
            if fit.residuals[worst] <= self.fitting.max_residual {
                return Ok((fit, kept));
            }
            kept.remove(worst);
        }
    }

    /// How far each segment agrees with the line that fits those that agree best, 0 to 1: 1/2 at a
    /// standard deviation. `None` where nothing fits.
    pub fn agreement(&self, start: &Segment3, segments: &[SegmentRef]) -> Option<Vec<f64>> {
        let (fit, kept) = self.fit_consistent(start, segments).ok()?;
        let agrees = |s: &SegmentRef| {
            let i = kept.iter().position(|k| k == s)?;
            Some(1.0 / (1.0 + fit.residuals[i] * fit.residuals[i]))
        };
        Some(segments.iter().map(|s| agrees(s).unwrap_or(0.0)).collect())
    }

    fn fit(&self, start: &Segment3, segments: &[SegmentRef]) -> Result<LineFit, Rejection> {
        fit_line(&self.observations(segments), start, self.fitting).ok_or(Rejection::NoFit)
    }

    fn observations(&self, segments: &[SegmentRef]) -> Vec<Observation<'_>> {
        segments
            .iter()
            .map(|s| {
                let detected = &self.segments[s.view.index()][s.segment.index()];
                Observation {
                    camera: self.scene.camera(s.view),
                    segment: detected.segment,
                    covariance: detected.covariance,
                }
            })
            .collect()
    }

    /// Does something verify every view? Each is left out in turn; `limit_m` is how uncertain the others may leave the line.
    fn every_view_verified(
        &self,
        fit: &LineFit,
        [t0, t1]: [f64; 2],
        supports: &[LineSupport],
        limit_m: f64,
    ) -> bool {
        let line = crate::linematch::triples::stretch_of(&fit.line, t0, t1);
        let sigma_without = |left_out: &LineSupport| {
            let others = supports.iter().filter(|s| s.view != left_out.view);
            let edges = others.filter_map(|s| s.edge.as_ref());
            conditioning(&self.observed(edges), &line, self.fitting)
                .map_or(f64::INFINITY, |c| c.sigma_at(0.0).max(c.sigma_at(1.0)))
        };
        let few = self.scene.views.len() <= self.params.min_views;
        let least = |uncertainty| least_score(uncertainty, few, self.params);
        let mut measured = supports.iter().filter(|s| s.edge.is_some());
        measured.all(|s| {
            s.score >= least(f64::INFINITY) || s.score >= least(sigma_without(s) / limit_m)
        })
    }

    /// The views that support the stretch.
    fn supports(&self, profile: &Profile, stretch: (usize, usize)) -> Vec<LineSupport> {
        let mut supports: Vec<LineSupport> = (0..profile.views.len())
            .filter(|i| *i != profile.reference)
            .filter_map(|i| self.support(profile, &profile.views[i], stretch, None))
            .collect();
        // The reference view agrees with itself; its score is what the others say.
        let mean = supports.iter().map(|s| s.score).sum::<f64>() / supports.len().max(1) as f64;
        let reference = &profile.views[profile.reference];
        supports.extend(self.support(profile, reference, stretch, Some(mean)));
        sort_by_key(&mut supports, |s| s.view);
        supports
    }

    /// The support of one view: with a segment at half the threshold, without at one and a half
    /// (B99 3.2). Of three edges one with a segment is judged together with the others, by [`disagreeing_views`].
    fn support(
        &self,
        profile: &Profile,
        view: &ViewProfile,
        (start, end): (usize, usize),
        score: Option<f64>,
    ) -> Option<LineSupport> {
        let (t0, t1) = (profile.t[start], profile.t[end]);
        let segments: Vec<_> = view
            .segments
            .iter()
            .filter(|(_, [s, e])| e.min(t1) - s.max(t0) >= 0.5 * (e - s).min(t1 - t0))
            .collect();
        let correlation = &view.correlation[start..=end];
        let seen = EdgelScore::of(correlation, self.params.edgel_correlation);
        let score = score.unwrap_or(seen.score);
        let measured = view.edge.is_some() || !segments.is_empty();
        let one_of_three = profile.measured() == MIN_MEASURED && view.measured();
        let factor = match (measured, one_of_three && !segments.is_empty()) {
            (_, true) => 0.0,
            (true, false) => self.params.with_segment,
            (false, false) => self.params.without_segment,
        };
        let enough = measured || seen.included >= self.params.min_edgels;
        (enough && score >= self.params.pair_score * factor).then_some(())?;

        let supported: Vec<usize> = (start..=end)
            .filter(|&e| {
                view.detected[e] || f64::from(view.correlation[e]) >= self.params.edgel_correlation
            })
            .collect();
        let (first, last) = (*supported.first()?, *supported.last()?);
        let stretch = Segment2::new(
            view.image.at(profile.t[first])?,
            view.image.at(profile.t[last])?,
        );
        let outermost = segments
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(f, t), (_, [s, e])| {
                (f.min(s.max(t0)), t.max(e.min(t1)))
            });
        let detected_px = (outermost.1 - outermost.0)
            * (stretch.length() / (profile.t[last] - profile.t[first]).max(1e-9));
        let kind = match segments.len() {
            2.. => SupportKind::Merged,
            1 if stretch.length() <= detected_px + GROWN_PX => SupportKind::Matched,
            _ => SupportKind::Grown,
        };
        Some(LineSupport {
            view: view.view,
            segments: segments.iter().map(|(id, _)| *id).collect(),
            stretch,
            score: score.min(1.0),
            kind,
            edge: view.edge.clone(),
        })
    }

    fn least_evidence(&self) -> usize {
        if self.scene.views.len() > MIN_MEASURED {
            MIN_EVIDENCE
        } else {
            MIN_EVIDENCE_OF_THREE
        }
    }

    /// Number of views that ought to support the line: `min_views` where many see it.
    fn expected_views(&self, profile: &Profile, (start, end): (usize, usize)) -> usize {
        let middle = 0.5 * (profile.t[start] + profile.t[end]);
        let sees = |v: &&ViewProfile| {
            let x = v.image.at(middle);
            x.is_some_and(|x| self.scene.camera(v.view).contains(&x, 1.0))
        };
        let seeing = profile.views.iter().filter(sees).count();
        if seeing >= MANY_VIEWS {
            self.params.min_views
        } else {
            MIN_MEASURED
        }
    }

    /// The last tests of a completed line, with the stretch t0 to t1 (metres) of the fit.
    ///
    /// Of four of six views (B99 3.4) three do for now, where their mean score is what a pair must have by itself: how many can
    /// see the line, the finished model will know, and it then asks for the fourth ([`crate::buildings::judge_lines`]).
    fn check_line(
        &self,
        fit: LineFit,
        [t0, t1]: [f64; 2],
        expected_views: usize,
        supports: Vec<LineSupport>,
    ) -> Result<Line, Rejection> {
        let length = fit.line.length();
        let segment = crate::linematch::triples::stretch_of(&fit.line, t0, t1);
        let camera = self.scene.camera(supports[0].view);
        let pixel_m = camera.ground_pixel(&segment.p0);
        let length_px = segment.length() / pixel_m;
        let largest_m = self.fitting.largest_sigma_px(length_px) * pixel_m;
        if fit.sigma_at(t0 / length).max(fit.sigma_at(t1 / length)) > largest_m {
            return Err(Rejection::IllConditioned);
        }
        let score = supports.iter().map(|s| s.score).sum::<f64>() / supports.len() as f64;
        if !self.every_view_verified(&fit, [t0, t1], &supports, 2.0 * largest_m) {
            return Err(Rejection::Unverified);
        }
        let measured = supports.iter().filter(|s| s.edge.is_some()).count();
        let certain = score >= self.params.pair_score;
        if measured < MIN_MEASURED || (supports.len() < expected_views && !certain) {
            return Err(Rejection::TooFewViews);
        }
        // The one view that verifies two others is hit by chance the more easily the shorter the line.
        if measured == MIN_MEASURED && length_px < 2.0 * self.params.min_edgels as f64 {
            return Err(Rejection::TooShort);
        }
        let [low, high] = self.z_range;
        if [segment.p0.z, segment.p1.z]
            .iter()
            .any(|z| *z < low || *z > high)
        {
            return Err(Rejection::OutsideHeights);
        }
        Ok(Line {
            segment,
            fit,
            supports,
        })
    }
}

#[cfg(test)]
impl<'a> Context<'a> {
    /// That of a first pass over a planted scene.
    pub fn of_planted(
        scene: &'a Scene,
        segments: &'a [Vec<ImageSegment>],
        sights: &'a Sights,
        (params, fitting): (&'a MatchParams, &'a Lines3dParams),
    ) -> Self {
        Self {
            scene,
            segments,
            sights,
            z_range: [-2.0, 8.0],
            params,
            fitting,
            alike: Alike {
                contrast: true,
                kind: true,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::SegmentId;
    use crate::linematch::planted;
    use crate::lines2d::SegmentKind;
    use crate::lines3d::ProjectedLine;

    /// Three views with edges: two that correlate by `pair`, and one that does not, with a segment of its own or without: which
    /// views support the line, and which are left out.
    fn beside_a_pair(own_segment: bool, pair: f32) -> (Vec<u32>, Vec<ViewId>) {
        const EDGELS: usize = 100;
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let segments = planted::segments(&scene);
        let sights = Sights::new(&scene, &segments);
        let context = Context::of_planted(&scene, &segments, &sights, (&params, &fitting));
        let view = |(index, correlation): (usize, f32)| ViewProfile {
            view: ViewId(index as u32),
            image: ProjectedLine::new(&scene.views[index].camera, &line).unwrap(),
            segments: match own_segment || correlation > 0.0 {
                true => vec![(SegmentId(0), [0.0, line.length()])],
                false => Vec::new(),
            },
            edge: Some(GuidedEdge {
                view: ViewId(index as u32),
                kind: SegmentKind::Edge,
                segment: planted::part_of(&scene, index, 0, 0.0, 1.0),
                covariance: nalgebra::Matrix2::identity(),
                pieces: Vec::new(),
            }),
            detected: vec![true; EDGELS],
            inside: vec![true; EDGELS],
            correlation: vec![correlation; EDGELS],
            agreement: f64::from(correlation),
        };
        let step = line.length() / EDGELS as f64;
        let profile = Profile {
            t: (0..EDGELS).map(|e| e as f64 * step).collect(),
            reference: 0,
            views: [(0, 1.0), (1, pair), (3, 0.0)].map(view).into(),
        };
        let supports = context.supports(&profile, (0, EDGELS - 1));
        let left_out = disagreeing_views(&profile, &supports, &params);
        (supports.iter().map(|s| s.view.0).collect(), left_out)
    }

    #[test]
    fn a_segment_in_its_place_verifies_two_views_that_are_very_alike() {
        assert_eq!(beside_a_pair(true, 0.8), (vec![0, 1, 3], vec![]));
        let third = vec![ViewId(3)];
        assert_eq!(beside_a_pair(true, 0.7).1, third, "not alike enough");
        assert_eq!(beside_a_pair(false, 0.8).1, third, "no segment");
    }

    /// The views that are left out of a line whose first `count` views have edges and score `score`.
    fn left_out(count: usize, score: f64) -> Vec<ViewId> {
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let edge = |view: usize| GuidedEdge {
            view: ViewId(view as u32),
            kind: SegmentKind::Edge,
            segment: planted::part_of(&scene, view, 0, 0.1, 0.9),
            covariance: nalgebra::Matrix2::identity(),
            pieces: Vec::new(),
        };
        let views = (0..count).map(|view| ViewProfile {
            view: ViewId(view as u32),
            image: ProjectedLine::new(&scene.views[view].camera, &line).unwrap(),
            segments: Vec::new(),
            edge: Some(edge(view)),
            detected: Vec::new(),
            inside: Vec::new(),
            correlation: Vec::new(),
            agreement: [0.4, 0.2, 0.3, 0.5, 0.6][view],
        });
        let profile = Profile {
            t: Vec::new(),
            reference: 0,
            views: views.collect(),
        };
        let supports = (0..count).map(|view| LineSupport {
            view: ViewId(view as u32),
            segments: Vec::new(),
            stretch: planted::part_of(&scene, view, 0, 0.1, 0.9),
            score,
            kind: SupportKind::Matched,
            edge: Some(edge(view)),
        });
        disagreeing_views(
            &profile,
            &supports.collect::<Vec<_>>(),
            &MatchParams::default(),
        )
    }

    #[test]
    fn three_edges_have_to_be_as_alike_as_a_pair_and_more_half_as_much() {
        let least_alike = vec![ViewId(1)];
        assert_eq!(left_out(3, 0.55), []);
        assert_eq!(left_out(3, 0.45), least_alike);
        assert_eq!(left_out(4, 0.45), []);
        assert_eq!(left_out(5, 0.3), []);
        assert_eq!(left_out(5, 0.2), least_alike);
    }

    /// What becomes of a line that `count` views with edges support, of as many as should, at a score.
    fn checked(count: usize, expected: usize, score: f64) -> Option<Rejection> {
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let segments = planted::segments(&scene);
        let sights = Sights::new(&scene, &segments);
        let context = Context::of_planted(&scene, &segments, &sights, (&params, &fitting));
        // Any two of the first three determine it.
        let edges: Vec<GuidedEdge> = [0, 1, 4, 2, 3][..count]
            .iter()
            .map(|&view| GuidedEdge {
                view: ViewId(view as u32),
                kind: SegmentKind::Edge,
                segment: planted::part_of(&scene, view, 0, 0.0, 1.0),
                covariance: nalgebra::Matrix2::new(1e-3, 0.0, 0.0, 1e-6),
                pieces: Vec::new(),
            })
            .collect();
        let fit = fit_line(&context.observed(edges.iter()), &line, &fitting).expect("a line");
        let support = |edge: &GuidedEdge| LineSupport {
            view: edge.view,
            segments: Vec::new(),
            stretch: edge.segment,
            score,
            kind: SupportKind::Matched,
            edge: Some(edge.clone()),
        };
        let supports = edges.iter().map(support).collect();
        let ends = [0.0, line.length()];
        context.check_line(fit, ends, expected, supports).err()
    }

    #[test]
    fn too_few_views_have_to_be_as_alike_as_a_pair() {
        let too_few = Some(Rejection::TooFewViews);
        assert_eq!(checked(4, 4, 0.4), None, "four of four");
        assert_eq!(checked(3, 4, 0.4), too_few, "three of four");
        assert_eq!(checked(3, 3, 0.4), None, "three of three");
        assert_eq!(checked(3, 4, 0.5), None, "three that a pair would do with");
    }

    #[test]
    fn four_views_are_expected_where_six_see_a_line() {
        let places = [0.0, 8.0, 16.0, 24.0, 32.0, 40.0].map(|x| (x, 0.0, 0.0));
        let expected = |count: usize, looks_away: usize| {
            let mut scene = planted::views_from(&places[..count]);
            for view in &mut scene.views[..looks_away] {
                view.camera.k[(0, 2)] += 1000.0;
            }
            let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
            let sights = Sights { views: Vec::new() };
            let context = Context::of_planted(&scene, &[], &sights, (&params, &fitting));
            let line = planted::edges()[0];
            let view = |index: usize| ViewProfile {
                view: ViewId(index as u32),
                image: ProjectedLine::new(&scene.views[index].camera, &line).unwrap(),
                segments: Vec::new(),
                edge: None,
                detected: Vec::new(),
                inside: Vec::new(),
                correlation: Vec::new(),
                agreement: 0.0,
            };
            let profile = Profile {
                t: vec![0.0, line.length()],
                reference: 0,
                views: (0..count).map(view).collect(),
            };
            context.expected_views(&profile, (0, 1))
        };
        assert_eq!([expected(6, 0), expected(5, 0)], [4, 3]);
        assert_eq!(expected(6, 1), 3, "the sixth looks elsewhere");
    }

    #[test]
    fn the_less_certain_the_others_the_more_a_view_has_to_agree() {
        let params = MatchParams::default();
        let (pair, alone) = (0.5, 0.75);
        for few in [false, true] {
            assert!(least_score(0.9, few, &params) < 0.0);
            assert_eq!(least_score(2.5, few, &params), alone);
            assert_eq!(least_score(f64::INFINITY, few, &params), alone);
        }
        assert_eq!(least_score(1.5, false, &params), alone);
        assert!((least_score(1.0 + 1e-9, true, &params) - pair).abs() < 1e-6);
        assert!((least_score(1.4, true, &params) - 0.6).abs() < 1e-12);
    }
}
