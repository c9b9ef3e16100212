//! What matching asks of a detected segment again and again, computed once.

use nalgebra::{Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::index::SegmentIndex;
use crate::camera::{Camera, plane_of_image_line};
use crate::geometry::{Plane, Segment2};
use crate::ids::SegmentId;
use crate::ids::ViewId;
use crate::lines2d::{ImageSegment, SegmentKind};
use crate::scene::Scene;

/// Names a segment of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SegmentRef {
    /// The view.
    pub view: ViewId,
    /// The segment in it.
    pub segment: SegmentId,
}

/// What must be the same of all segments that show a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alike {
    /// The bright side, if they are steps.
    pub contrast: bool,
    /// The kind. Where it need not be, steps are still no bars: those run beside the line's edges.
    pub kind: bool,
}

impl Alike {
    /// May segments of these kinds show one line?
    pub fn holds(self, a: SegmentKind, b: SegmentKind) -> bool {
        a == b || (!self.kind && a.is_step() == b.is_step())
    }

    /// Must a segment of this kind run the same way as the others?
    pub fn directs(self, kind: SegmentKind) -> bool {
        self.contrast && kind.is_step()
    }
}

/// A segment with its rays and its interpretation plane.
pub struct Sight {
    /// The segment, directed by contrast.
    pub segment: Segment2,
    /// What it was found on.
    pub kind: SegmentKind,
    /// Its length, pixels.
    pub length_px: f64,
    /// The plane through the projection centre and the segment.
    pub plane: Plane,
    /// Unit directions in the world of the rays through the end points.
    pub rays: [Vector3<f64>; 2],
    /// Standard deviation of the line's position at the end points, pixels.
    pub sigma_px: f64,
}

impl Sight {
    fn new(camera: &Camera, detected: &ImageSegment) -> Option<Self> {
        let segment = detected.segment;
        let length_px = segment.length();
        let half = 0.5 * length_px;
        let variance = detected.covariance[(0, 0)] + half * half * detected.covariance[(1, 1)];
        (length_px > 1.0 && variance.is_finite()).then_some(())?;
        Some(Self {
            segment,
            kind: detected.kind,
            length_px,
            plane: plane_of_image_line(camera, &segment.line())?,
            rays: [camera.ray(&segment.p0), camera.ray(&segment.p1)],
            sigma_px: variance.max(0.0).sqrt(),
        })
    }
}

/// The segments of one view, ready for matching.
pub struct ViewSights {
    /// One for each detected segment; `None` for one without length.
    pub sights: Vec<Option<Sight>>,
    /// Where they are.
    pub index: SegmentIndex,
}

impl ViewSights {
    /// Prepares the segments of one view.
    pub fn new(camera: &Camera, detected: &[ImageSegment]) -> Self {
        Self {
            sights: detected.iter().map(|s| Sight::new(camera, s)).collect(),
            index: SegmentIndex::new(
                camera.width,
                camera.height,
                detected.iter().map(|s| s.segment),
            ),
        }
    }
}

/// All views' segments, ready for matching.
pub struct Sights {
    /// One for each view.
    pub views: Vec<ViewSights>,
}

impl Sights {
    /// Prepares the segments of all views.
    pub fn new(scene: &Scene, segments: &[Vec<ImageSegment>]) -> Self {
        let views = scene
            .views
            .iter()
            .zip(segments)
            .map(|(view, detected)| ViewSights::new(&view.camera, detected))
            .collect();
        Self { views }
    }

    /// The segment of this name; `None` for one without length.
    pub fn get(&self, name: SegmentRef) -> Option<&Sight> {
        self.views[name.view.index()].sights[name.segment.index()].as_ref()
    }

    /// The kind of most of a line's segments, of as many the one that comes first in [`SegmentKind::ALL`]; `None` without segments.
    pub fn kind(&self, segments: &[SegmentRef]) -> Option<SegmentKind> {
        let shown = |kind: &SegmentKind| {
            let own = segments.iter().filter_map(|s| self.get(*s));
            own.filter(|sight| sight.kind == *kind).count()
        };
        let most = SegmentKind::ALL.into_iter().rev().max_by_key(shown)?;
        (shown(&most) > 0).then_some(most)
    }

    /// The names of all segments of a view that can be matched.
    pub fn of_view(&self, view: ViewId) -> impl Iterator<Item = (SegmentRef, &Sight)> {
        let sights = self.views[view.index()].sights.iter().enumerate();
        sights.filter_map(move |(i, sight)| {
            let segment = SegmentId::from_index(i);
            Some((SegmentRef { view, segment }, sight.as_ref()?))
        })
    }
}

/// The epipolar beam of a segment in another view (B99 3.1, figure 2): between the epipolar lines
/// of the two end points, cut to the heights `z_range` (metres). Corners in order around it; `None`
/// where a corner is not in front of the camera.
pub fn epipolar_beam(
    first: &Camera,
    segment: &Segment2,
    second: &Camera,
    z_range: [f64; 2],
) -> Option<[Point2<f64>; 4]> {
    let [low, high] = z_range;
    let corner = |x: &Point2<f64>, z| second.project(&first.at_height(x, z)?);
    Some([
        corner(&segment.p0, low)?,
        corner(&segment.p0, high)?,
        corner(&segment.p1, high)?,
        corner(&segment.p1, low)?,
    ])
}

/// Where the ray through an image point meets the interpretation plane of a segment in another
/// view: the point of the 3D line that both see. `None` where the ray runs along the plane.
pub fn ray_in_plane(
    center: &Point3<f64>,
    ray: &Vector3<f64>,
    plane: &Plane,
) -> Option<Point3<f64>> {
    let slope = plane.normal.dot(ray);
    let depth = -plane.signed_distance(center) / slope;
    (slope.abs() > 1e-9 && depth > 0.0).then(|| center + ray * depth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use SegmentKind::{BrightBar, Color, DarkBar, Edge};

    #[test]
    fn bars_and_steps_are_never_alike() {
        let first = Alike {
            contrast: true,
            kind: true,
        };
        let second = Alike {
            contrast: false,
            kind: false,
        };
        for a in SegmentKind::ALL {
            assert!(first.holds(a, a) && second.holds(a, a));
            assert!(!first.holds(a, a.other()) && second.holds(a, a.other()));
            assert_eq!(a.other().other(), a);
            assert!(!second.directs(a));
        }
        assert!(!second.holds(Edge, BrightBar) && !second.holds(DarkBar, Color));
        assert_eq!(
            [Edge, Color, BrightBar, DarkBar].map(|k| first.directs(k)),
            [true, true, false, false]
        );
    }
}
