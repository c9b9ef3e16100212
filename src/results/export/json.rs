//! What the model was made from, as plain JSON: 3D lines, image segments, half-planes.
//!
//! World coordinates are those of the input (scene origin added), metres rounded to 0.1 mm; image
//! positions are pixels rounded to 0.001, centre of the top-left pixel at (0.5, 0.5). Angles are
//! degrees. Lines and half-planes are named by their numbers, which count from 1.

use nalgebra::Point3;
use serde_json::{Value, json};

use super::format::{rounded, to_bytes};
use crate::base::geometry::Segment2;
use crate::base::ids::{HalfPlaneId, ViewId};
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::half_planes::HalfPlane;

/// `lines.json`: 3D lines by their numbers, with the segment of each view that supports them. Lines
/// that the model refutes are left out, with their numbers.
pub fn lines_json(scene: &Scene, lines: &[Line3d]) -> Vec<u8> {
    let point = |p: &Point3<f64>| (p + scene.origin).coords.map(|c| rounded(c, 4));
    let lines: Vec<Value> = Line3d::standing(lines)
        .map(|(id, line)| {
            let views: Vec<Value> = line
                .supports
                .iter()
                .map(|support| {
                    json!({
                        "view": name(scene, support.view),
                        "segment": segment(&support.stretch),
                        "score": rounded(support.score, 4),
                        "kind": support.kind,
                    })
                })
                .collect();
            json!({
                "id": id.number(),
                "p0": point(&line.segment.p0).as_slice(),
                "p1": point(&line.segment.p1).as_slice(),
                "sigma_m": rounded(line.sigma_m, 4),
                "probability": rounded(line.probability, 4),
                "origin": line.origin,
                "views": views,
            })
        })
        .collect();
    to_bytes(&json!({ "lines": lines }))
}

/// `segments.json`: the image segments of every view.
pub fn segments_json(scene: &Scene, segments: &[Vec<ImageSegment>]) -> Vec<u8> {
    let views: Vec<Value> = scene
        .view_ids()
        .zip(segments)
        .map(|(view, segments)| {
            let segments: Vec<_> = segments.iter().map(|s| segment(&s.segment)).collect();
            json!({ "view": name(scene, view), "segments": segments })
        })
        .collect();
    to_bytes(&json!({ "views": views }))
}

/// `halfplanes.json`: the half-planes with the peak of Sim(theta) that they were accepted for (B99
/// figure 12) and their plane `a x + b y + c z + d = 0` in the world frame of the input. Those at
/// lines that the model refutes are left out.
pub fn half_planes_json(scene: &Scene, lines: &[Line3d], half_planes: &[HalfPlane]) -> Vec<u8> {
    let stands = |h: &HalfPlane| {
        lines
            .get(h.line.index())
            .is_none_or(|l| l.contradiction.is_none())
    };
    let half_planes: Vec<Value> = half_planes
        .iter()
        .enumerate()
        .filter(|(_, h)| stands(h))
        .map(|(id, h)| {
            let views: Vec<_> = h.views.iter().map(|&view| name(scene, view)).collect();
            let n = h.plane.normal;
            json!({
                "id": HalfPlaneId::from_index(id).number(),
                "line": h.line.number(),
                "side": h.side,
                "theta_deg": rounded(h.theta.to_degrees(), 4),
                "sigma_theta_deg": rounded(h.sigma_theta.to_degrees(), 4),
                "similarity": rounded(h.similarity, 4),
                "curvature": rounded(h.curvature, 4),
                "amplitude": rounded(h.amplitude, 4),
                "probability": rounded(h.probability, 4),
                "views": views,
                "plane": [n.x, n.y, n.z, h.plane.d - n.dot(&scene.origin)],
            })
        })
        .collect();
    to_bytes(&json!({ "half_planes": half_planes }))
}

fn name(scene: &Scene, view: ViewId) -> &str {
    &scene.view(view).name
}

fn segment(s: &Segment2) -> [f64; 4] {
    [s.p0.x, s.p0.y, s.p1.x, s.p1.y].map(|v| rounded(v, 3))
}
