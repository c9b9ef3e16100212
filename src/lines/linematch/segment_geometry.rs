//! The geometry of detected segments that matching uses repeatedly, computed once.

use nalgebra::{Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::index::SegmentIndex;
use crate::base::geometry::{Plane, Segment2};
use crate::base::ids::{SegmentId, ViewId};
use crate::lines::lines2d::{ImageSegment, SegmentKind};
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, plane_of_image_line};

/// The identity of a segment of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SegmentRef {
    /// The view.
    pub view: ViewId,
    /// The segment in it.
    pub segment: SegmentId,
}

/// The properties in which all segments of a line must agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Compatibility {
    /// The bright side.
    pub contrast: bool,
    /// The kind.
    pub kind: bool,
}

impl Compatibility {
    /// Steps either way, in grey values or in colour.
    pub(super) const ANY: Self = Self {
        contrast: false,
        kind: false,
    };

    /// May segments of these kinds show one line?
    pub(super) fn allows(self, a: SegmentKind, b: SegmentKind) -> bool {
        a == b || !self.kind
    }
}

/// A segment with its rays and its interpretation plane.
pub(super) struct SegmentGeometry {
    /// The segment, directed by contrast.
    pub segment: Segment2,
    /// In which channel it shows.
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

impl SegmentGeometry {
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
pub(super) struct PreparedView {
    /// One for each detected segment; `None` for one without length.
    pub segments: Vec<Option<SegmentGeometry>>,
    /// The same by place.
    pub index: SegmentIndex,
}

impl PreparedView {
    /// Prepares the segments of one view.
    pub(super) fn new(camera: &Camera, detected: &[ImageSegment]) -> Self {
        Self {
            segments: detected
                .iter()
                .map(|s| SegmentGeometry::new(camera, s))
                .collect(),
            index: SegmentIndex::new(
                camera.width,
                camera.height,
                detected.iter().map(|s| s.segment),
            ),
        }
    }
}

/// All views' segments, ready for matching.
pub(super) struct PreparedSegments {
    /// One for each view.
    pub views: Vec<PreparedView>,
}

impl PreparedSegments {
    /// Prepares the segments of all views.
    pub(super) fn new(scene: &Scene, segments: &[Vec<ImageSegment>]) -> Self {
        let views = scene
            .views
            .iter()
            .zip(segments)
            .map(|(view, detected)| PreparedView::new(&view.camera, detected))
            .collect();
        Self { views }
    }

    /// The segment of this name; `None` for one without length.
    pub(super) fn get(&self, name: SegmentRef) -> Option<&SegmentGeometry> {
        self.views[name.view.index()].segments[name.segment.index()].as_ref()
    }

    /// The most frequent kind of a line's segments, on a tie the first in [`SegmentKind::ALL`];
    /// `None` without segments.
    pub(super) fn kind(&self, segments: &[SegmentRef]) -> Option<SegmentKind> {
        let shown = |kind: &SegmentKind| {
            let own = segments.iter().filter_map(|s| self.get(*s));
            own.filter(|geometry| geometry.kind == *kind).count()
        };
        let most = SegmentKind::ALL.into_iter().rev().max_by_key(shown)?;
        (shown(&most) > 0).then_some(most)
    }

    /// The names of all segments of a view that can be matched.
    pub(super) fn of_view(
        &self,
        view: ViewId,
    ) -> impl Iterator<Item = (SegmentRef, &SegmentGeometry)> {
        let segments = self.views[view.index()].segments.iter().enumerate();
        segments.filter_map(move |(i, geometry)| {
            let segment = SegmentId::from_index(i);
            Some((SegmentRef { view, segment }, geometry.as_ref()?))
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
pub(super) fn ray_in_plane(
    center: &Point3<f64>,
    ray: &Vector3<f64>,
    plane: &Plane,
) -> Option<Point3<f64>> {
    let slope = plane.normal.dot(ray);
    let depth = -plane.signed_distance(center) / slope;
    (slope.abs() > 1e-9 && depth > 0.0).then(|| center + ray * depth)
}
