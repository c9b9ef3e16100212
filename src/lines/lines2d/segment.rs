//! Straight image segments and their kinds.

use nalgebra::Matrix2;
use serde::{Deserialize, Serialize};

use crate::base::geometry::Segment2;
use crate::photographs::raster::Channel;

/// The kind of image feature that a segment was detected on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SegmentKind {
    /// A step between two grey values.
    #[default]
    Edge,
    /// A step between two colours that differ little in grey value.
    Color,
}

impl SegmentKind {
    /// All kinds.
    pub const ALL: [Self; 2] = [Self::Edge, Self::Color];

    /// The channel that shows such a segment.
    pub fn channel(self) -> Channel {
        match self {
            Self::Color => Channel::RedBlue,
            Self::Edge => Channel::Grey,
        }
    }

    /// The kind that another view may show in the same place: an eave may stand out in colour
    /// alone.
    pub fn other(self) -> Self {
        match self {
            Self::Edge => Self::Color,
            Self::Color => Self::Edge,
        }
    }
}

/// A straight segment detected in one view, directed by contrast: the brighter side (with
/// [`SegmentKind::Color`] the redder one) lies in the direction of [`Segment2::normal`], to the
/// right of the direction as seen on the screen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageSegment {
    /// Edge in grey values or in colour.
    pub kind: SegmentKind,
    /// End points, pixels.
    pub segment: Segment2,
    /// Mean difference across the edge, bright minus dark side, grey values 0 to 1; of a colour
    /// edge half the difference of red and blue, redder minus bluer side.
    pub contrast: f32,
    /// Number of edgels that the line was fitted to.
    pub edgels: u32,
    /// Covariance of (offset along the normal at the midpoint in px, angle in rad), 2 x 2.
    pub covariance: Matrix2<f64>,
}

impl ImageSegment {
    /// The same segment in an image `factor` times as large.
    pub fn enlarged(&self, factor: usize) -> Self {
        let scale = factor as f64;
        let enlarge = Matrix2::new(scale * scale, scale, scale, 1.0);
        Self {
            segment: self.segment.enlarged(scale),
            edgels: self.edgels * factor as u32,
            covariance: self.covariance.component_mul(&enlarge),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn in_a_larger_image_points_of_the_line_are_as_much_less_certain() {
        let small = ImageSegment {
            kind: SegmentKind::Color,
            segment: Segment2::new(Point2::new(10.0, 20.0), Point2::new(40.0, 60.0)),
            contrast: 0.2,
            edgels: 50,
            covariance: Matrix2::new(0.02, 3e-4, 3e-4, 1e-5),
        };
        let large = small.enlarged(2);
        assert_eq!(large.segment.p1, Point2::new(80.0, 120.0));
        assert_eq!((large.edgels, large.contrast), (100, 0.2));
        // Variance across the line, at a distance along it from the middle.
        let variance = |s: &ImageSegment, along: f64| {
            let c = &s.covariance;
            c[(0, 0)] + 2.0 * along * c[(0, 1)] + along * along * c[(1, 1)]
        };
        for along in [-25.0, 0.0, 10.0] {
            let ratio = variance(&large, 2.0 * along) / variance(&small, along);
            assert!((ratio - 4.0).abs() < 1e-12, "{ratio} at {along}");
        }
    }
}
