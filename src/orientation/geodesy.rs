//! Positions on the ellipsoid become a local metric frame: x east, y north, z up (ellipsoidal height at the anchor).
//!
//! * Geocentric coordinates (Metashape's chunks, many GNSS solutions) are known by their distance from the middle of
//!   the Earth, and by cameras that look towards it.
//! * Longitude, latitude and height in lists: positions that differ by less than a degree, at flying heights.
//!
//! The frame is the tangent plane (WGS84) at the mean position, rounded to 0.001 degrees. Within a kilometre of the
//! anchor the Earth falls by 8 cm below it. Rotations of geographic lists are taken as those against east, north and
//! up at each camera.

use nalgebra::{Matrix3, Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::Orientation;
use crate::math;

/// Semi-major axis of WGS84, metres.
const A_M: f64 = 6_378_137.0;

/// Square of its first eccentricity.
const E2: f64 = 6.694_379_990_141_316e-3;

/// Distances from the middle of the Earth at which cameras fly, metres.
const EARTH_M: [f64; 2] = [6_330_000.0, 6_430_000.0];

/// Longitude and latitude of a frame's zero, degrees, and the ellipsoidal height that its z starts from, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Anchor {
    /// Longitude, degrees east.
    pub lon_deg: f64,
    /// Latitude, degrees north.
    pub lat_deg: f64,
    /// Height of z = 0 above the ellipsoid, metres.
    pub height_m: f64,
}

/// The order of a list's first two coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Geocentric,
    LonLat,
    LatLon,
}

/// Turns geocentric or geographic positions into a local metric frame; `None` where they are metric already.
pub fn to_metric_frame(orientations: &mut [Orientation]) -> Option<Anchor> {
    let kind = kind(orientations)?;
    let geocentric = |c: &Point3<f64>| match kind {
        Kind::Geocentric => *c,
        Kind::LonLat => geocentric_of(c.x, c.y, c.z),
        Kind::LatLon => geocentric_of(c.y, c.x, c.z),
    };
    let centers: Vec<Point3<f64>> = orientations.iter().map(|o| geocentric(&o.center)).collect();
    let sum = centers.iter().fold(Vector3::zeros(), |s, c| s + c.coords);
    let anchor = Anchor::near(&Point3::from(sum / centers.len() as f64));
    for (orientation, center) in orientations.iter_mut().zip(centers) {
        let axes = match kind {
            Kind::Geocentric => Matrix3::identity(),
            _ => Anchor::near(&center).exact_axes(&center),
        };
        // axes: geocentric to east, north, up where the angles were measured.
        orientation.r = orientation.r * axes * anchor.axes().transpose();
        orientation.center = anchor.local(&center);
        orientation.angles = None;
    }
    Some(anchor)
}

fn kind(orientations: &[Orientation]) -> Option<Kind> {
    let centers = || orientations.iter().map(|o| &o.center);
    // Maps have such coordinates too (northings at 57 degrees), with oblique views to the south; but no height of 20 km.
    let looks_down = |o: &Orientation| {
        let least = if o.center.z.abs() > 20_000.0 {
            0.5
        } else {
            0.95
        };
        o.r.row(2).transpose().dot(&o.center.coords) < -least * o.center.coords.norm()
    };
    let at_surface = |c: &Point3<f64>| (EARTH_M[0]..EARTH_M[1]).contains(&c.coords.norm());
    if orientations.is_empty() {
        None
    } else if centers().all(at_surface) && orientations.iter().all(looks_down) {
        Some(Kind::Geocentric)
    } else if centers().all(is_geographic)
        && (0..2).all(|i| is_small_spread(centers().map(move |c| c[i])))
    {
        // Beyond 90 degrees only longitudes reach; else x is the longitude, as in X Y Z.
        Some(if centers().any(|c| c.y.abs() > 90.0) {
            Kind::LatLon
        } else {
            Kind::LonLat
        })
    } else {
        None
    }
}

/// Degrees, and a height from which roofs are photographed, metres.
fn is_geographic(c: &Point3<f64>) -> bool {
    c.x.abs() <= 180.0
        && c.y.abs() <= 180.0
        && c.x.abs().min(c.y.abs()) <= 90.0
        && (20.0..20_000.0).contains(&c.z)
}

/// No flight has baselines of centimetres: then the numbers are degrees.
fn is_small_spread(values: impl Iterator<Item = f64> + Clone) -> bool {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(f64::NEG_INFINITY, f64::max);
    const LEAST_M: f64 = 0.2;
    high - low < LEAST_M
}

impl Anchor {
    /// The anchor at the ellipsoid below a geocentric point, rounded.
    fn near(center: &Point3<f64>) -> Self {
        let [lon_deg, lat_deg, _] = geographic_of(center);
        let round = |v: f64| (v * 1000.0).round() / 1000.0;
        Self {
            lon_deg: round(lon_deg),
            lat_deg: round(lat_deg),
            height_m: 0.0,
        }
    }

    /// Rows east, north, up in geocentric coordinates.
    fn axes(&self) -> Matrix3<f64> {
        east_north_up(self.lon_deg, self.lat_deg)
    }

    /// Rows east, north, up at a point itself.
    fn exact_axes(&self, center: &Point3<f64>) -> Matrix3<f64> {
        let [lon, lat, _] = geographic_of(center);
        east_north_up(lon, lat)
    }

    fn zero(&self) -> Point3<f64> {
        geocentric_of(self.lon_deg, self.lat_deg, self.height_m)
    }

    /// Local coordinates of a geocentric point, metres.
    fn local(&self, geocentric: &Point3<f64>) -> Point3<f64> {
        Point3::from(self.axes() * (geocentric - self.zero()))
    }

    /// Longitude and latitude in degrees and ellipsoidal height in metres of a local point.
    pub fn geographic(&self, local: &Point3<f64>) -> [f64; 3] {
        geographic_of(&(self.zero() + self.axes().transpose() * local.coords))
    }
}

fn east_north_up(lon_deg: f64, lat_deg: f64) -> Matrix3<f64> {
    let ((sl, cl), (sp, cp)) = (
        math::sin_cos(lon_deg.to_radians()),
        math::sin_cos(lat_deg.to_radians()),
    );
    Matrix3::new(-sl, cl, 0.0, -sp * cl, -sp * sl, cp, cp * cl, cp * sl, sp)
}

fn geocentric_of(lon_deg: f64, lat_deg: f64, height_m: f64) -> Point3<f64> {
    let ((sl, cl), (sp, cp)) = (
        math::sin_cos(lon_deg.to_radians()),
        math::sin_cos(lat_deg.to_radians()),
    );
    let n = A_M / (1.0 - E2 * sp * sp).sqrt();
    Point3::new(
        (n + height_m) * cp * cl,
        (n + height_m) * cp * sl,
        (n * (1.0 - E2) + height_m) * sp,
    )
}

/// Longitude, latitude (degrees), height (metres).
fn geographic_of(c: &Point3<f64>) -> [f64; 3] {
    let lon = math::atan2(c.y, c.x);
    let p = (c.x * c.x + c.y * c.y).sqrt();
    // A fixed point of tan(lat) = (z + e2 N sin(lat)) / p; each step gains more than two digits.
    let mut lat = math::atan2(c.z, p * (1.0 - E2));
    let mut height = 0.0;
    for _ in 0..10 {
        let (s, cos) = math::sin_cos(lat);
        let n = A_M / (1.0 - E2 * s * s).sqrt();
        lat = math::atan2(c.z + E2 * n * s, p);
        // Well defined at the poles as well as at the equator.
        height = p * cos + c.z * s - A_M * (1.0 - E2 * s * s).sqrt();
    }
    [lon.to_degrees(), lat.to_degrees(), height]
}

#[cfg(test)]
mod tests {
    use super::super::pinhole;
    use super::*;
    use crate::camera::Camera;
    use crate::geometry::rotation_from_axis_angle;
    use crate::synthetic::gable_scene;

    #[test]
    fn known_points_of_the_ellipsoid() {
        let p = geocentric_of(0.0, 0.0, 100.0);
        assert!((p - Point3::new(A_M + 100.0, 0.0, 0.0)).norm() < 1e-6);
        // The semi-minor axis of WGS84 is 6356752.3142 m.
        assert!((geocentric_of(77.0, 90.0, 0.0).z - 6_356_752.314_2).abs() < 1e-3);
        for [lon, lat, h] in [
            [8.4, 49.0, 320.0],
            [-70.1, -33.4, 2500.0],
            [179.9, 0.0, 50.0],
            [10.0, 89.9, 10.0],
        ] {
            let back = geographic_of(&geocentric_of(lon, lat, h));
            assert!(
                (back[0] - lon).abs() < 1e-10
                    && (back[1] - lat).abs() < 1e-10
                    && (back[2] - h).abs() < 1e-6,
                "{back:?}"
            );
        }
    }

    /// The gable house at a place of the Earth: its cameras geocentric or geographic.
    fn abroad(geographic: bool) -> (Vec<Orientation>, Anchor) {
        let anchor = Anchor {
            lon_deg: 8.412,
            lat_deg: 49.013,
            height_m: 0.0,
        };
        let (scene, _) = gable_scene(48);
        let of_view = |camera: &Camera| {
            let local = camera.center;
            let at = anchor.zero() + anchor.axes().transpose() * local.coords;
            if geographic {
                let there = Anchor::near(&at).exact_axes(&at);
                let r = camera.r * anchor.axes() * there.transpose();
                pinhole("a", "a", camera.k, r, Point3::from(geographic_of(&at)))
            } else {
                pinhole("a", "a", camera.k, camera.r * anchor.axes(), at)
            }
        };
        (
            scene.views.iter().map(|v| of_view(&v.camera)).collect(),
            anchor,
        )
    }

    #[test]
    fn a_house_anywhere_on_the_earth_keeps_its_projections() {
        let (scene, truth) = gable_scene(48);
        for geographic in [false, true] {
            let (mut orientations, anchor) = abroad(geographic);
            assert_eq!(to_metric_frame(&mut orientations), Some(anchor));
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
    fn maps_and_local_frames_stay_as_they_are() {
        let (scene, _) = gable_scene(48);
        // A northing of 6.37 million metres is a place in Denmark, not the radius of the Earth.
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
            assert_eq!(to_metric_frame(&mut orientations), None);
            assert_eq!(orientations, before);
            // Nor when they look south, down by 40 degrees.
            let tilt = rotation_from_axis_angle(&Vector3::new(-50f64.to_radians(), 0.0, 0.0));
            orientations
                .iter_mut()
                .for_each(|o| o.r *= tilt.inverse().matrix());
            assert_eq!(to_metric_frame(&mut orientations), None);
        }
    }
}
