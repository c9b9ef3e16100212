//! The ellipsoid (WGS84), and local frames that touch it: x east, y north, z up.

use nalgebra::{Matrix3, Point3};
use serde::{Deserialize, Serialize};

use crate::base::math;

/// Semi-major axis of WGS84 and of GRS80, metres.
pub(crate) const A_M: f64 = 6_378_137.0;

/// Square of its first eccentricity.
const E2: f64 = 6.694_379_990_141_316e-3;

/// No scene is as large, metres: what lies farther from it is another place, and coordinates beyond
/// are those of a map, of which an origin is taken off. Single precision holds a millimetre of what
/// is nearer. Assumption.
pub(crate) const LARGEST_SCENE_M: f64 = 10_000.0;

/// No datums of heights are further apart, metres: the geoid lies between 107 below and 86 above
/// the ellipsoid, and datums of charts and old levels some metres beside it.
pub const MOST_DATUM_M: f64 = 200.0;

/// Longitude and latitude of a frame's zero, degrees, and the ellipsoidal height that its z starts
/// from, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Anchor {
    /// Longitude, degrees east.
    pub lon_deg: f64,
    /// Latitude, degrees north.
    pub lat_deg: f64,
    /// Height of z = 0 above the ellipsoid, metres.
    pub height_m: f64,
}

impl Anchor {
    /// The anchor at the ellipsoid below a geocentric point, rounded.
    pub(crate) fn near(center: &Point3<f64>) -> Self {
        let [lon_deg, lat_deg, _] = geographic_of(center);
        let round = |v: f64| (v * 1000.0).round() / 1000.0;
        Self {
            lon_deg: round(lon_deg),
            lat_deg: round(lat_deg),
            height_m: 0.0,
        }
    }

    /// Rows east, north, up in geocentric coordinates.
    pub(crate) fn axes(&self) -> Matrix3<f64> {
        east_north_up(self.lon_deg, self.lat_deg)
    }

    /// Rows east, north, up at a point itself.
    pub(crate) fn exact_axes(&self, center: &Point3<f64>) -> Matrix3<f64> {
        let [lon, lat, _] = geographic_of(center);
        east_north_up(lon, lat)
    }

    /// Geocentric coordinates of the frame's zero.
    pub(crate) fn zero(&self) -> Point3<f64> {
        geocentric_of(self.lon_deg, self.lat_deg, self.height_m)
    }

    /// Local coordinates of a geocentric point, metres.
    pub(crate) fn local(&self, geocentric: &Point3<f64>) -> Point3<f64> {
        Point3::from(self.axes() * (geocentric - self.zero()))
    }

    /// Longitude and latitude in degrees and ellipsoidal height in metres of a local point.
    pub fn geographic(&self, local: &Point3<f64>) -> [f64; 3] {
        geographic_of(&(self.zero() + self.axes().transpose() * local.coords))
    }
}

/// Rows east, north, up in geocentric coordinates.
fn east_north_up(lon_deg: f64, lat_deg: f64) -> Matrix3<f64> {
    let ((sl, cl), (sp, cp)) = (
        math::sin_cos(lon_deg.to_radians()),
        math::sin_cos(lat_deg.to_radians()),
    );
    Matrix3::new(-sl, cl, 0.0, -sp * cl, -sp * sl, cp, cp * cl, cp * sl, sp)
}

/// Geocentric coordinates of longitude, latitude (degrees) and ellipsoidal height.
pub(crate) fn geocentric_of(lon_deg: f64, lat_deg: f64, height_m: f64) -> Point3<f64> {
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
pub(crate) fn geographic_of(c: &Point3<f64>) -> [f64; 3] {
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
    use super::*;

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
}
