//! Segments and lines as typed arrays.

use js_sys::{Float32Array, Float64Array};

use crate::base::geometry::Segment2;
use crate::lines::lines3d::Line3d;

/// (x0, y0, x1, y1) per segment, pixels.
pub(super) fn segment_array<'a>(segments: impl Iterator<Item = &'a Segment2>) -> Float32Array {
    let numbers: Vec<f32> = segments.flat_map(end_points_px).collect();
    Float32Array::from(&numbers[..])
}

/// The end points in single precision.
pub(super) fn end_points_px(s: &Segment2) -> [f32; 4] {
    [s.p0.x, s.p0.y, s.p1.x, s.p1.y].map(|v| v as f32)
}

/// (x, y, z) of both end points per line, metres, local frame.
pub(super) fn line_array(lines: &[Line3d]) -> Float64Array {
    let numbers: Vec<f64> = lines
        .iter()
        .flat_map(|l| [l.segment.p0, l.segment.p1])
        .flat_map(|p| [p.x, p.y, p.z])
        .collect();
    Float64Array::from(&numbers[..])
}
