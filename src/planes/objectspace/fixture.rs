//! Planted image lines for the tests of this method.

use nalgebra::{Matrix2, Point2, Vector3};

use super::oris::RegionLine;
use crate::base::geometry::{Segment2, Segment3};
use crate::lines::lines2d::ImageSegment;
use crate::orienting::scene::Scene;
use crate::orienting::synthetic::gable_scene;

/// The cameras of a synthetic scene, at most six.
pub(crate) fn rig(views: usize) -> Scene {
    let (mut scene, _) = gable_scene(320);
    scene.views.truncate(views);
    scene
}

/// The images of 3D lines in all views but the hidden ones, off by up to 0.3 px, and among them
/// unrelated lines of the same direction as the first one, at random places: `outliers` is their
/// share of all lines.
pub(crate) fn planted_lines(
    scene: &Scene,
    truth: &[Segment3],
    outliers: f64,
    hidden: &[usize],
) -> Vec<Vec<RegionLine>> {
    let mut random = Lcg64(99);
    let views = scene.views.iter().enumerate();
    views
        .map(|(k, view)| {
            let image = |s: &Segment3| {
                let p = |p| view.camera.project(&p).expect("the cameras look down");
                Segment2::new(p(s.p0), p(s.p1))
            };
            let mut lines = Vec::new();
            for s in truth.iter().filter(|_| !hidden.contains(&k)) {
                let s = image(s);
                let mut off = |p: Point2<f64>| p + s.normal() * (0.6 * random.next() - 0.3);
                lines.push(region_line(Segment2::new(off(s.p0), off(s.p1))));
            }
            let count = (truth.len() as f64 * outliers / (1.0 - outliers)).round() as usize;
            for _ in 0..count {
                let place = Vector3::new(
                    4.0 * random.next() - 2.0,
                    20.0 * random.next() - 10.0,
                    10.0 * random.next(),
                );
                let at = place - truth[0].at(0.5).coords;
                let moved = Segment3::new(truth[0].p0 + at, truth[0].p1 + at);
                lines.push(region_line(image(&moved)));
            }
            lines
        })
        .collect()
}

fn region_line(segment: Segment2) -> RegionLine {
    RegionLine {
        line: ImageSegment {
            segment,
            contrast: 0.2,
            edgels: segment.length() as u32,
            covariance: Matrix2::identity() * 0.01,
            kind: crate::lines::lines2d::SegmentKind::Edge,
        },
        sides: [0.3, 0.5],
        vector: 0,
    }
}

struct Lcg64(u64);

impl Lcg64 {
    /// A number from 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1u64 << 31) as f64
    }
}
