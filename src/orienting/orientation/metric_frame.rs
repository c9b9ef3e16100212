//! Geocentric or geographic positions become a local metric frame: x east, y north, z up
//! (ellipsoidal height).
//!
//! * Geocentric coordinates (Metashape's chunks, many GNSS solutions) are recognised by their
//!   distance from the centre of the Earth; near the equator by cameras that look towards it.
//! * Longitude, latitude and height: where a system of them is stated, at any height; else
//!   positions that differ by less than a degree, at flying heights.
//!
//! The frame is the tangent plane (WGS84) at the mean position, rounded to 0.001 degrees. Within a
//! kilometre of the anchor the ellipsoid falls 8 cm below it. Rotations of geographic lists are
//! taken as relative to east, north and up at each camera.

use nalgebra::{Matrix3, Point3, Vector3};

use super::geodesy::{Anchor, geocentric_of};
use super::image_orientation::Orientation;

/// Distances of aerial cameras from the centre of the Earth, metres.
const EARTH_M: [f64; 2] = [6_330_000.0, 6_430_000.0];

/// What the coordinates of the projection centres are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CoordinateKind {
    Geocentric,
    LonLat,
    LatLon,
}

/// Turns geocentric or geographic positions into a local metric frame; `None` where they are metric
/// already. `is_geographic`: longitude and latitude are stated, not guessed.
pub fn to_metric_frame(orientations: &mut [Orientation], is_geographic: bool) -> Option<Anchor> {
    let kind = coordinate_kind(orientations, is_geographic)?;
    let geocentric = |c: &Point3<f64>| match kind {
        CoordinateKind::Geocentric => *c,
        CoordinateKind::LonLat => geocentric_of(c.x, c.y, c.z),
        CoordinateKind::LatLon => geocentric_of(c.y, c.x, c.z),
    };
    let centers: Vec<Point3<f64>> = orientations.iter().map(|o| geocentric(&o.center)).collect();
    let sum = centers.iter().fold(Vector3::zeros(), |s, c| s + c.coords);
    let anchor = Anchor::near(&Point3::from(sum / centers.len() as f64));
    for (orientation, center) in orientations.iter_mut().zip(centers) {
        let axes = match kind {
            CoordinateKind::Geocentric => Matrix3::identity(),
            _ => Anchor::near(&center).exact_axes(&center),
        };
        // axes: geocentric to east, north, up where the angles were measured.
        let turned = |r: &Matrix3<f64>| r * axes * anchor.axes().transpose();
        orientation.r = turned(&orientation.r);
        for (_, r) in &mut orientation.readings {
            *r = turned(r);
        }
        orientation.center = anchor.local(&center);
        orientation.angles = None;
    }
    Some(anchor)
}

fn coordinate_kind(orientations: &[Orientation], is_stated: bool) -> Option<CoordinateKind> {
    let centers = || orientations.iter().map(|o| &o.center);
    // Map coordinates can be that large too (northings at 57 degrees, oblique views to the south),
    // but not 20 km high.
    let is_no_map = |o: &Orientation| {
        o.center.z.abs() > 20_000.0
            || o.r.row(2).transpose().dot(&o.center.coords) < -0.95 * o.center.coords.norm()
    };
    let at_surface = |c: &Point3<f64>| (EARTH_M[0]..EARTH_M[1]).contains(&c.coords.norm());
    if orientations.is_empty() {
        None
    } else if centers().all(at_surface) && orientations.iter().all(is_no_map) {
        Some(CoordinateKind::Geocentric)
    } else if centers().all(are_degrees)
        && (is_stated
            || centers().all(is_flying)
                && (0..2).all(|i| is_small_spread(centers().map(move |c| c[i]))))
    {
        // Beyond 90 degrees only longitudes reach; else x is the longitude, as in X Y Z.
        Some(if centers().any(|c| c.y.abs() > 90.0) {
            CoordinateKind::LatLon
        } else {
            CoordinateKind::LonLat
        })
    } else {
        None
    }
}

fn are_degrees(c: &Point3<f64>) -> bool {
    c.x.abs() <= 180.0 && c.y.abs() <= 180.0 && c.x.abs().min(c.y.abs()) <= 90.0
}

/// Is this a plausible flying height in metres?
fn is_flying(c: &Point3<f64>) -> bool {
    (20.0..20_000.0).contains(&c.z)
}

/// No flight has baselines of centimetres: coordinates that differ so little are degrees.
fn is_small_spread(values: impl Iterator<Item = f64> + Clone) -> bool {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(f64::NEG_INFINITY, f64::max);
    // In degrees that is 22 km. Assumption: no flight is as small in metres, none as large in
    // degrees.
    const LEAST_BASELINE_M: f64 = 0.2;
    high - low < LEAST_BASELINE_M
}

#[cfg(test)]
mod tests {
    use super::super::geodesy::geographic_of;
    use super::super::image_orientation::pinhole;
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
    use crate::orienting::synthetic::gable_scene;
    use crate::photographs::camera::Camera;

    /// The gable house at a position on the Earth: its cameras geocentric or geographic. Only east
    /// of 90 degrees the latitude shows which of two numbers it is.
    fn abroad(kind: CoordinateKind) -> (Vec<Orientation>, Anchor) {
        let is_east = kind == CoordinateKind::LatLon;
        let anchor = Anchor {
            lon_deg: if is_east { 151.207 } else { 8.412 },
            lat_deg: 49.013,
            height_m: 0.0,
        };
        let (scene, _) = gable_scene(48);
        let of_view = |camera: &Camera| {
            let local = camera.center;
            let at = anchor.zero() + anchor.axes().transpose() * local.coords;
            if kind == CoordinateKind::Geocentric {
                return pinhole("a", "a", camera.k, camera.r * anchor.axes(), at);
            }
            let there = Anchor::near(&at).exact_axes(&at);
            let r = camera.r * anchor.axes() * there.transpose();
            let [lon, lat, height] = geographic_of(&at);
            let (x, y) = if is_east { (lat, lon) } else { (lon, lat) };
            pinhole("a", "a", camera.k, r, Point3::new(x, y, height))
        };
        (
            scene.views.iter().map(|v| of_view(&v.camera)).collect(),
            anchor,
        )
    }

    #[test]
    fn a_house_anywhere_on_the_earth_keeps_its_projections() {
        let (scene, truth) = gable_scene(48);
        for kind in [
            CoordinateKind::Geocentric,
            CoordinateKind::LonLat,
            CoordinateKind::LatLon,
        ] {
            let (mut orientations, anchor) = abroad(kind);
            assert_eq!(to_metric_frame(&mut orientations, false), Some(anchor));
            for (o, view) in orientations.iter().zip(&scene.views) {
                let camera = Camera {
                    r: o.r,
                    center: o.center,
                    ..view.camera.clone()
                };
                for corner in truth.facets.iter().flat_map(|(_, ring)| ring) {
                    let (p, q) = (
                        camera.project(corner).unwrap(),
                        view.camera.project(corner).unwrap(),
                    );
                    assert!((p - q).norm() < 0.01, "{p} {q}");
                }
                let there = anchor.geographic(&o.center);
                assert!(
                    (there[2]
                        - geographic_of(
                            &(anchor.zero()
                                + anchor.axes().transpose() * view.camera.center.coords)
                        )[2])
                        .abs()
                        < 1e-6
                );
            }
        }
    }

    #[test]
    fn stated_degrees_are_places_at_any_height() {
        for lower_m in [0.0, 95.0, 400.0, 1100.0] {
            let (mut high, anchor) = abroad(CoordinateKind::LonLat);
            let mut low = high.clone();
            low.iter_mut().for_each(|o| o.center.z -= lower_m);
            assert_eq!(to_metric_frame(&mut low, true), Some(anchor));
            to_metric_frame(&mut high, true);
            for (low, high) in low.iter().zip(&high) {
                let off = high.center - low.center - Vector3::z() * lower_m;
                // Verticals 600 m apart converge by a ten-thousandth.
                assert!(off.norm() < 1e-3 + 1e-4 * lower_m, "{off}");
            }
        }
        let (mut metres, _) = abroad(CoordinateKind::LonLat);
        metres.iter_mut().for_each(|o| o.center.x += 432_000.0);
        assert_eq!(to_metric_frame(&mut metres, true), None);
    }

    #[test]
    fn oblique_and_level_views_are_places_on_the_earth_too() {
        let (mut orientations, anchor) = abroad(CoordinateKind::Geocentric);
        let tilt = rotation_from_axis_angle(&Vector3::new(1.4, 0.0, 0.0));
        orientations[0].r = tilt.matrix() * orientations[0].r;
        assert_eq!(to_metric_frame(&mut orientations, false), Some(anchor));
    }

    #[test]
    fn maps_and_local_frames_stay_as_they_are() {
        let (scene, _) = gable_scene(48);
        // A northing of 6.37 million metres lies in Denmark, not the radius of the Earth.
        for origin in [
            [0.0; 3],
            [432_100.0, 5_412_300.0, 0.0],
            [500_000.0, 6_350_000.0, 0.0],
        ] {
            let mut orientations: Vec<Orientation> = (scene.views.iter())
                .map(|v| {
                    pinhole(
                        "a",
                        "a",
                        v.camera.k,
                        v.camera.r,
                        v.camera.center + Vector3::from(origin),
                    )
                })
                .collect();
            let before = orientations.clone();
            assert_eq!(to_metric_frame(&mut orientations, false), None);
            assert_eq!(orientations, before);
            // Nor when they look south, down by 40 degrees.
            let tilt = rotation_from_axis_angle(&Vector3::new(-50f64.to_radians(), 0.0, 0.0));
            orientations
                .iter_mut()
                .for_each(|o| o.r *= tilt.inverse().matrix());
            assert_eq!(to_metric_frame(&mut orientations, false), None);
        }
    }
}
