//! The evidence along a 3D line, edgel by edgel: which views detected a segment there, and which
//! views' neighbourhoods correlate. Merging and growing (B99 3.3) read it.

use nalgebra::Point2;

use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::{SegmentId, ViewId};
use crate::base::params::MatchParams;
use crate::lines::linematch::line_strip::{
    EdgelScore, LineStrip, StripFrame, StripSide, correlate,
};
use crate::lines::linematch::pairs::side_strip;
use crate::lines::linematch::segment_geometry::{PreparedSegments, SegmentRef};
use crate::lines::lines2d::GuidedEdge;
use crate::lines::lines3d::ProjectedLine;
use crate::orienting::scene::Scene;
use crate::photographs::raster::Channel;

/// Least distance of an edgel from the border of the image so that its edge can be seen, px.
pub(crate) const EDGE_MARGIN_PX: f64 = 4.0;

/// The evidence of one view along the line.
pub(super) struct ViewProfile {
    /// The view.
    pub view: ViewId,
    /// The line in it.
    pub image: ProjectedLine,
    /// Its segments on the line, with the stretch of the line they cover, metres.
    pub segments: Vec<(SegmentId, [f64; 2])>,
    /// The edge measured along the line.
    pub edge: Option<GuidedEdge>,
    /// At each edgel: does a segment or a piece of the measured edge lie there?
    pub detected: Vec<bool>,
    /// At each edgel: is it far enough inside the image for its edge to be seen?
    pub inside: Vec<bool>,
    /// At each edgel: correlation with the reference view on the better side; NaN where the view
    /// does not see it. All ones in the reference view itself.
    pub correlation: Vec<f32>,
    /// Mean score with the other views that have segments: low for a view that sees another edge.
    pub agreement: f64,
}

impl ViewProfile {
    /// Is there an edge in this view?
    pub(super) fn measured(&self) -> bool {
        self.edge.is_some()
    }

    /// The stretches of the line, metres, where an edge was found.
    fn covered(&self) -> Vec<[f64; 2]> {
        let pieces = self.edge.iter().flat_map(|e| &e.pieces);
        pieces
            .map(|p| [self.image.t_of(&p.p0), self.image.t_of(&p.p1)])
            .map(|[s, e]| [s.min(e), s.max(e)])
            .collect()
    }
}

/// The evidence of all views along the line.
pub(super) struct LineProfile {
    /// Metres along the line of each edgel; edgels are a pixel apart in the reference view.
    pub t: Vec<f64>,
    /// Index in `views` of the reference view: of those with segments the one most like the others.
    pub reference: usize,
    /// The views that see the line.
    pub views: Vec<ViewProfile>,
}

impl LineProfile {
    /// Samples the evidence along `line`, as far as its segments reach.
    pub(super) fn new(
        scene: &Scene,
        prepared: &PreparedSegments,
        line: &Segment3,
        segments: &[SegmentRef],
        edges: &[GuidedEdge],
        params: &MatchParams,
    ) -> Option<Self> {
        let mut views: Vec<ViewProfile> = scene
            .view_ids()
            .filter_map(|view| {
                let mut profile = view_segments(scene, prepared, line, segments, view)?;
                profile.edge = edges.iter().find(|e| e.view == view).cloned();
                Some(profile)
            })
            .collect();
        let reach = |v: &ViewProfile| v.covered().iter().map(|[s, e]| e - s).sum::<f64>();
        let longest = (0..views.len()).max_by(|&i, &j| {
            reach(&views[i])
                .total_cmp(&reach(&views[j]))
                .then(j.cmp(&i))
        })?;
        let ends = views.iter().flat_map(ViewProfile::covered);
        let (from, to) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(f, t), [s, e]| {
            (f.min(s), t.max(e))
        });
        let image = views[longest].image;
        let frame = StripFrame::new(
            &Segment2::new(image.at(from)?, image.at(to)?),
            params.window_px,
        );
        let t: Vec<f64> = (0..frame.edgels)
            .map(|e| image.t_of(&frame.edgel(e)))
            .collect();
        for view in &mut views {
            let covered = view.covered();
            let on_edge = |t: &f64| covered.iter().any(|[s, e]| t >= s && t <= e);
            view.detected = t.iter().map(on_edge).collect();
            let camera = scene.camera(view.view);
            let in_image = |x: Point2<f64>| camera.contains(&x, EDGE_MARGIN_PX);
            view.inside = (t.iter())
                .map(|t| view.image.at(*t).is_some_and(in_image))
                .collect();
        }
        let stretch = line.stretch(from, to);
        let channel = prepared.kind(segments)?.channel();
        let strips = ProfileStrips::new(scene, channel, &stretch, &frame, longest, &views, params)?;
        let reference = strips.compare(&mut views, params)?;
        Some(Self {
            t,
            reference,
            views,
        })
    }

    /// Number of views with an edge.
    pub(super) fn measured(&self) -> usize {
        with_segments(&self.views).count()
    }

    /// Number of views with the edge at an edgel.
    pub(super) fn detections(&self, edgel: usize) -> usize {
        self.views.iter().filter(|v| v.detected[edgel]).count()
    }

    /// Number of views with an edge whose image reaches an edgel.
    pub(super) fn reaching(&self, edgel: usize) -> usize {
        let reaches = |v: &&ViewProfile| v.measured() && v.inside[edgel];
        self.views.iter().filter(reaches).count()
    }

    /// Number of views whose neighbourhoods agree at an edgel, the reference included.
    pub(super) fn agreeing(&self, edgel: usize, params: &MatchParams) -> usize {
        let agrees = |v: &&ViewProfile| f64::from(v.correlation[edgel]) >= params.edgel_correlation;
        self.views.iter().filter(agrees).count()
    }
}

/// A view with its share of the segments; `None` where it does not see the line.
fn view_segments(
    scene: &Scene,
    prepared: &PreparedSegments,
    line: &Segment3,
    segments: &[SegmentRef],
    view: ViewId,
) -> Option<ViewProfile> {
    let image = ProjectedLine::new(scene.camera(view), line)?;
    let on_line = segments
        .iter()
        .filter(|s| s.view == view)
        .filter_map(|s| {
            let geometry = prepared.get(*s)?;
            let (t0, t1) = (
                image.t_of(&geometry.segment.p0),
                image.t_of(&geometry.segment.p1),
            );
            Some((s.segment, [t0.min(t1), t0.max(t1)]))
        })
        .collect();
    Some(ViewProfile {
        view,
        image,
        segments: on_line,
        edge: None,
        detected: Vec::new(),
        inside: Vec::new(),
        correlation: Vec::new(),
        agreement: 0.0,
    })
}

/// The strips of all views on one grid, on either side of the line, warped by the half-plane that
/// agrees best over the views with segments. On one grid any two views compare without new samples.
struct ProfileStrips {
    sides: [Vec<LineStrip>; 2],
}

impl ProfileStrips {
    fn new(
        scene: &Scene,
        channel: Channel,
        line: &Segment3,
        frame: &StripFrame,
        grid: usize,
        views: &[ViewProfile],
        params: &MatchParams,
    ) -> Option<Self> {
        let first = views[grid].view;
        let measured: Vec<usize> = with_segments(views).collect();
        let pairs = (measured.len() * (measured.len() - 1) / 2) as f64;
        let warped =
            |view, side, theta| side_strip(scene, [first, view], channel, frame, line, side, theta);
        let best = |side: StripSide| {
            let mut chosen: Option<(f64, f64, Vec<LineStrip>)> = None;
            'angles: for &theta in &params.plane_angles_deg {
                let mut strips: Vec<LineStrip> = Vec::with_capacity(measured.len());
                let (mut total, mut left) = (0.0, pairs);
                for &i in &measured {
                    let strip = warped(views[i].view, side, theta)?;
                    for other in &strips {
                        total += side_score(&strip, other, side, params);
                        left -= 1.0;
                    }
                    // No pair scores more than one, so that this angle cannot win any more.
                    if chosen.as_ref().is_some_and(|c| total + left <= c.0) {
                        continue 'angles;
                    }
                    strips.push(strip);
                }
                chosen = Some((total, theta, strips));
                // Where a plane explains the side well enough, no other need be tried.
                if total >= 0.8 * pairs {
                    break;
                }
            }
            let (_, theta, strips) = chosen?;
            let mut sampled = strips.into_iter();
            let strip = |v: &ViewProfile| {
                // Views with segments are in the order of all views.
                let known = v.measured().then(|| sampled.next()).flatten();
                known.or_else(|| warped(v.view, side, theta))
            };
            views.iter().map(strip).collect::<Option<Vec<LineStrip>>>()
        };
        let [left, right] = StripSide::BOTH.map(best);
        Some(Self {
            sides: [left?, right?],
        })
    }

    /// Correlations of two views on the better side (the other may be hidden in one of them).
    fn correlations(&self, i: usize, j: usize, params: &MatchParams) -> (f64, Vec<f32>) {
        let [left, right] = [0, 1].map(|s| {
            let strips = &self.sides[s];
            let c = correlate(&strips[i], &strips[j], StripSide::BOTH[s], params.noise);
            (EdgelScore::of(&c, params.edgel_correlation).score, c)
        });
        if right.0 > left.0 { right } else { left }
    }

    /// Fills in the agreements and the correlations with the reference view, and names it.
    fn compare(&self, views: &mut [ViewProfile], params: &MatchParams) -> Option<usize> {
        let measured: Vec<usize> = with_segments(views).collect();
        // Two views agree as well one way as the other.
        let mut scores = vec![0.0; measured.len() * measured.len()];
        for (p, &i) in measured.iter().enumerate() {
            for (q, &j) in measured[..p].iter().enumerate() {
                let score = self.correlations(i, j, params).0;
                scores[p * measured.len() + q] = score;
                scores[q * measured.len() + p] = score;
            }
        }
        for (&i, scores) in measured.iter().zip(scores.chunks(measured.len().max(1))) {
            let others = measured.iter().zip(scores).filter(|(j, _)| **j != i);
            let sum: f64 = others.map(|(_, score)| score).sum();
            views[i].agreement = sum / (measured.len() - 1).max(1) as f64;
        }
        let agreement = |i: &usize| views[*i].agreement;
        let reference = measured
            .into_iter()
            .max_by(|i, j| agreement(i).total_cmp(&agreement(j)).then(j.cmp(i)))?;
        for (i, view) in views.iter_mut().enumerate() {
            let (_, correlation) = self.correlations(reference, i, params);
            let own = vec![1.0; correlation.len()];
            view.correlation = if i == reference { own } else { correlation };
        }
        Some(reference)
    }
}

fn with_segments(views: &[ViewProfile]) -> impl Iterator<Item = usize> {
    (0..views.len()).filter(|i| views[*i].measured())
}

fn side_score(a: &LineStrip, b: &LineStrip, side: StripSide, params: &MatchParams) -> f64 {
    EdgelScore::of(
        &correlate(a, b, side, params.noise),
        params.edgel_correlation,
    )
    .score
}
