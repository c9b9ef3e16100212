//! The unit of the angles: as comments or the heading state it, or as the geometry lets one guess.

use nalgebra::{Matrix3, Vector3};

use super::{CameraFrame, ListedPose};
use crate::orienting::orientation::angles::AngleUnit;
use crate::orienting::orientation::image_orientation::Orientation;

/// The unit that comments or headings name, as a word of its own. "Grad" is no such word: it is a
/// degree in German and a gon elsewhere.
pub(super) fn stated_unit(words: &str) -> Option<AngleUnit> {
    words
        .split(|c: char| !c.is_alphabetic())
        .find_map(|word| match &*word.to_lowercase() {
            "degree" | "degrees" | "deg" | "altgrad" | "degrés" | "degré" | "grados" | "gradi"
            | "graden" => Some(AngleUnit::Degrees),
            "gon" | "gons" | "grads" | "gradian" | "gradians" | "neugrad" | "grades" => {
                Some(AngleUnit::Gon)
            }
            "radian" | "radians" | "rad" | "radianten" | "radianes" | "radianti" | "bogenmaß" => {
                Some(AngleUnit::Radians)
            }
            _ => None,
        })
}

/// The unit under which the rays through the image centres pass nearest to a common point in front
/// of the cameras, relative to its distance.
pub(super) fn guess_unit(frame: &CameraFrame, poses: &[ListedPose]) -> AngleUnit {
    let mut best = (f64::INFINITY, AngleUnit::Degrees);
    for unit in AngleUnit::ALL {
        let orientations: Vec<_> = poses
            .iter()
            .map(|p| p.orientation(frame, unit.radians()))
            .collect();
        let spread = spread_of_rays(&orientations);
        if spread < best.0 {
            best = (spread, unit);
        }
    }
    best.1
}

/// Root mean square angle (radians, small-angle) between the central rays and the directions to the
/// point nearest to all of them; infinite when the point lies behind a camera.
fn spread_of_rays(orientations: &[Orientation]) -> f64 {
    let mean = orientations
        .iter()
        .map(|o| o.center.coords)
        .sum::<Vector3<f64>>()
        / orientations.len() as f64;
    let rays: Vec<(Vector3<f64>, Vector3<f64>)> = orientations
        .iter()
        .filter_map(|o| {
            let (w, h) = o.size?;
            let centre = Vector3::new(f64::from(w) / 2.0, f64::from(h) / 2.0, 1.0);
            let ray = o.r.transpose() * o.k.try_inverse()? * centre;
            Some((o.center.coords - mean, ray.normalize()))
        })
        .collect();
    let across = |ray: &Vector3<f64>| Matrix3::identity() - ray * ray.transpose();
    let normal: Matrix3<f64> = rays.iter().map(|(_, ray)| across(ray)).sum();
    let right: Vector3<f64> = rays.iter().map(|(c, ray)| across(ray) * c).sum();
    let Some(point) = normal.lu().solve(&right) else {
        return f64::INFINITY;
    };
    let squares = rays.iter().map(|(c, ray)| {
        let d = point - c;
        let along = d.dot(ray);
        if along > 0.0 {
            (d.norm_squared() - along * along).max(0.0) / (along * along)
        } else {
            f64::INFINITY
        }
    });
    (squares.sum::<f64>() / rays.len() as f64).sqrt()
}
