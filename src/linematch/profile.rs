//! The evidence along a 3D line, edgel by edgel: which views detected a segment there, and which
//! views' neighbourhoods correlate. Merging and growing (B99 3.3) read it.

use super::pairs::side_correlation;
use super::sight::{SegmentRef, Sights};
use super::strip::{EdgelScore, Strip, StripFrame, StripSide};
use super::triples::stretch_of;
use crate::geometry::{Segment2, Segment3};
use crate::ids::{SegmentId, ViewId};
use crate::lines3d::ProjectedLine;
use crate::params::MatchParams;
use crate::scene::Scene;

/// What one view says along the line.
pub struct ViewProfile {
    /// The view.
    pub view: ViewId,
    /// The line in it.
    pub image: ProjectedLine,
    /// Its segments on the line, with the stretch of the line they cover, metres.
    pub segments: Vec<(SegmentId, [f64; 2])>,
    /// At each edgel: does a segment lie there?
    pub detected: Vec<bool>,
    /// At each edgel: correlation with the reference view on the better side; NaN where the view does
    /// not see it. All ones in the reference view itself.
    pub correlation: Vec<f32>,
}

/// What all views say along the line.
pub struct Profile {
    /// Metres along the line of each edgel; edgels are a pixel apart in the reference view.
    pub t: Vec<f64>,
    /// Index of the reference view in `views`.
    pub reference: usize,
    /// The views that see the line.
    pub views: Vec<ViewProfile>,
}

impl Profile {
    /// Samples the evidence along `line`, as far as its segments reach.
    pub fn new(
        scene: &Scene,
        sights: &Sights,
        line: &Segment3,
        segments: &[SegmentRef],
        params: &MatchParams,
    ) -> Option<Self> {
        let mut views: Vec<ViewProfile> = scene
            .view_ids()
            .filter_map(|view| view_segments(scene, sights, line, segments, view))
            .collect();
        let reach = |v: &ViewProfile| v.segments.iter().map(|(_, [s, e])| e - s).sum::<f64>();
        let reference = (0..views.len()).max_by(|&i, &j| {
            reach(&views[i])
                .total_cmp(&reach(&views[j]))
                .then(j.cmp(&i))
        })?;
        let ends = views.iter().flat_map(|v| v.segments.iter());
        let (from, to) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(f, t), (_, [s, e])| {
            (f.min(*s), t.max(*e))
        });
        let image = views[reference].image;
        let frame = StripFrame::new(
            &Segment2::new(image.at(from)?, image.at(to)?),
            params.window_px,
        );
        let t: Vec<f64> = (0..frame.edgels)
            .map(|e| image.t_of(&frame.edgel(e)))
            .collect();
        for view in &mut views {
            view.detected = t
                .iter()
                .map(|t| view.segments.iter().any(|(_, [s, e])| t >= s && t <= e))
                .collect();
        }
        let stretch = stretch_of(line, from, to);
        correlate_views(scene, &stretch, &frame, reference, &mut views, params)?;
        Some(Self {
            t,
            reference,
            views,
        })
    }

    /// Number of views with a segment at an edgel.
    pub fn detections(&self, edgel: usize) -> usize {
        self.views.iter().filter(|v| v.detected[edgel]).count()
    }

    /// Number of views whose neighbourhoods agree at an edgel, the reference included.
    pub fn agreeing(&self, edgel: usize, params: &MatchParams) -> usize {
        let agrees = |v: &&ViewProfile| f64::from(v.correlation[edgel]) >= params.edgel_correlation;
        self.views.iter().filter(agrees).count()
    }
}

/// A view with its share of the segments; `None` where it does not see the line.
fn view_segments(
    scene: &Scene,
    sights: &Sights,
    line: &Segment3,
    segments: &[SegmentRef],
    view: ViewId,
) -> Option<ViewProfile> {
    let image = ProjectedLine::new(scene.camera(view), line)?;
    let on_line = segments
        .iter()
        .filter(|s| s.view == view)
        .filter_map(|s| {
            let sight = sights.get(*s)?;
            let (t0, t1) = (image.t_of(&sight.segment.p0), image.t_of(&sight.segment.p1));
            Some((s.segment, [t0.min(t1), t0.max(t1)]))
        })
        .collect();
    Some(ViewProfile {
        view,
        image,
        segments: on_line,
        detected: Vec::new(),
        correlation: Vec::new(),
    })
}

/// Fills in the correlations: on either side of the line the half-plane that agrees best over all views, then for
/// each view its better side (the other may be hidden there).
fn correlate_views(
    scene: &Scene,
    line: &Segment3,
    frame: &StripFrame,
    reference: usize,
    views: &mut [ViewProfile],
    params: &MatchParams,
) -> Option<()> {
    let first = views[reference].view;
    let strip = Strip::reference(&scene.view(first).gray, frame);
    let mut best: Vec<(f64, Vec<f32>)> = vec![(-1.0, Vec::new()); views.len()];
    for side in StripSide::BOTH {
        let mut chosen: Option<(f64, Vec<Vec<f32>>)> = None;
        for &theta in &params.plane_angles_deg {
            let correlations: Vec<Vec<f32>> = views
                .iter()
                .enumerate()
                .map(|(i, v)| {
                    if i == reference {
                        return Some(vec![1.0; frame.edgels]);
                    }
                    side_correlation(
                        scene, first, v.view, frame, &strip, line, side, theta, params,
                    )
                })
                .collect::<Option<_>>()?;
            let total: f64 = correlations
                .iter()
                .map(|c| EdgelScore::of(c, params.edgel_correlation).score)
                .sum();
            if chosen.as_ref().is_none_or(|(t, _)| total > *t) {
                chosen = Some((total, correlations));
            }
            // Where a plane explains the side well enough, no other need be tried.
            if total >= 0.8 * views.len() as f64 {
                break;
            }
        }
        for (slot, correlation) in best.iter_mut().zip(chosen?.1) {
            let score = EdgelScore::of(&correlation, params.edgel_correlation).score;
            if score > slot.0 {
                *slot = (score, correlation);
            }
        }
    }
    for (view, (_, correlation)) in views.iter_mut().zip(best) {
        view.correlation = correlation;
    }
    Some(())
}
