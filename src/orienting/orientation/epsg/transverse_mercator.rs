//! Between coordinates of a national grid and longitude and latitude: the transverse Mercator
//! projection by Krueger's series to the fourth order of the third flattening n (Karney 2011,
//! "Transverse Mercator with an accuracy of a few nanometers", equations 5 to 25, whose series are
//! Krueger's), which is exact to a micrometre within a zone.
//!
//! ```text
//! xi' + i eta' = xi + i eta - sum_j beta_j sin 2j(xi + i eta)
//! chi = asin(sin xi' / cosh eta'),   lambda = lambda_0 + atan(sinh eta' / cos xi')
//! phi = chi + sum_j delta_j sin 2j chi
//! ```

use crate::base::math::{asin, asinh, atan2, cos, cosh, ln, sin, sinh};
use crate::orienting::orientation::A_M;

/// Third flattening of WGS84; that of GRS80 differs by 8e-12: 0.1 mm in latitude.
const N: f64 = 1.679_220_386_383_705e-3;

/// A transverse Mercator projection of the ellipsoid of WGS84.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TransverseMercator {
    pub(in super::super) central_meridian_deg: f64,
    /// Scale on the central meridian.
    pub(in super::super) scale: f64,
    /// Easting of the central meridian, metres.
    pub(in super::super) false_easting_m: f64,
    /// Northing of the equator, metres.
    pub(in super::super) equator_m: f64,
}

impl TransverseMercator {
    /// One whose northing at this latitude of origin is stated, as definitions in words do.
    pub(in super::super) fn with_origin(self, lat_deg: f64, northing_m: f64) -> Self {
        let at = Self {
            equator_m: 0.0,
            ..self
        };
        let [_, arc_m] = at.projected(self.central_meridian_deg, lat_deg);
        Self {
            equator_m: northing_m - arc_m,
            ..self
        }
    }

    /// Do both give the same coordinates within some centimetres?
    pub(in super::super) fn is_near(&self, other: &Self) -> bool {
        // Files round the parameters; 1e-7 degrees are a centimetre, as 1e-8 of scale over 1000 km.
        (self.central_meridian_deg - other.central_meridian_deg).abs() < 1e-7
            && (self.scale - other.scale).abs() < 1e-8
            && (self.false_easting_m - other.false_easting_m).abs() < 0.01
            && (self.equator_m - other.equator_m).abs() < 0.1
    }

    /// Easting and northing of a longitude and a latitude in degrees, metres (equations 7 to 11 of
    /// Karney 2011, with the coefficients alpha of the forward series).
    pub(crate) fn projected(&self, lon_deg: f64, lat_deg: f64) -> [f64; 2] {
        let (n, n2, n3, n4) = (N, N * N, N * N * N, N * N * N * N);
        let alpha = [
            n / 2.0 - 2.0 / 3.0 * n2 + 5.0 / 16.0 * n3 + 41.0 / 180.0 * n4,
            13.0 / 48.0 * n2 - 3.0 / 5.0 * n3 + 557.0 / 1440.0 * n4,
            61.0 / 240.0 * n3 - 103.0 / 140.0 * n4,
            49561.0 / 161_280.0 * n4,
        ];
        let lambda = (lon_deg - self.central_meridian_deg).to_radians();
        let phi = lat_deg.to_radians();
        let e = (4.0 * N).sqrt() / (1.0 + N);
        let atanh = |v: f64| 0.5 * ln((1.0 + v) / (1.0 - v));
        // The conformal latitude, by its tangent.
        let sine = sin(phi);
        let tau = sinh(atanh(sine) - e * atanh(e * sine));
        let (xi1, eta1) = (
            atan2(tau, cos(lambda)),
            asinh(sin(lambda) / (tau * tau + cos(lambda) * cos(lambda)).sqrt()),
        );
        let (mut xi, mut eta) = (xi1, eta1);
        for (i, alpha) in alpha.iter().enumerate() {
            let twice = 2.0 * (i as f64 + 1.0);
            xi += alpha * sin(twice * xi1) * cosh(twice * eta1);
            eta += alpha * cos(twice * xi1) * sinh(twice * eta1);
        }
        let scale = self.scale * radius();
        [
            scale * eta + self.false_easting_m,
            scale * xi + self.equator_m,
        ]
    }

    /// Longitude and latitude of a position, degrees.
    pub(crate) fn geographic(&self, easting: f64, northing: f64) -> [f64; 2] {
        let (n, n2, n3, n4) = (N, N * N, N * N * N, N * N * N * N);
        let beta = [
            n / 2.0 - 2.0 / 3.0 * n2 + 37.0 / 96.0 * n3 - n4 / 360.0,
            n2 / 48.0 + n3 / 15.0 - 437.0 / 1440.0 * n4,
            17.0 / 480.0 * n3 - 37.0 / 840.0 * n4,
            4397.0 / 161_280.0 * n4,
        ];
        let delta = [
            2.0 * n - 2.0 / 3.0 * n2 - 2.0 * n3 + 116.0 / 45.0 * n4,
            7.0 / 3.0 * n2 - 8.0 / 5.0 * n3 - 227.0 / 45.0 * n4,
            56.0 / 15.0 * n3 - 136.0 / 35.0 * n4,
            4279.0 / 630.0 * n4,
        ];
        let radius = radius();
        let xi = (northing - self.equator_m) / (self.scale * radius);
        let eta = (easting - self.false_easting_m) / (self.scale * radius);
        let (mut xi1, mut eta1) = (xi, eta);
        for (i, beta) in beta.iter().enumerate() {
            let twice = 2.0 * (i as f64 + 1.0);
            xi1 -= beta * sin(twice * xi) * cosh(twice * eta);
            eta1 -= beta * cos(twice * xi) * sinh(twice * eta);
        }
        let chi = asin(sin(xi1) / cosh(eta1));
        let terms = delta.iter().enumerate();
        let lat = terms.fold(chi, |lat, (i, d)| {
            lat + d * sin(2.0 * (i as f64 + 1.0) * chi)
        });
        let lon = atan2(sinh(eta1), cos(xi1)).to_degrees() + self.central_meridian_deg;
        [lon, lat.to_degrees()]
    }
}

/// Radius of the sphere whose meridians are as long as the ellipsoid's, metres.
fn radius() -> f64 {
    A_M / (1.0 + N) * (1.0 + N * N / 4.0 + N * N * N * N / 64.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of PROJ 9 (pyproj), to 12 decimals: EPSG code, easting, northing, longitude, latitude.
    const PROJ: [(u32, f64, f64, f64, f64); 6] = [
        (
            25832,
            432_100.0,
            5_412_300.0,
            8.074_262_901_902,
            48.859_946_417_670,
        ),
        (32633, 500_000.0, 0.0, 15.0, 0.0),
        (
            32755,
            312_345.678,
            6_123_456.789,
            144.943_350_018_413,
            -35.014_132_080_108,
        ),
        (
            25833,
            180_000.0,
            6_600_000.0,
            9.357_537_168_250,
            59.416_387_837_432,
        ),
        (
            3006,
            674_032.357,
            6_580_821.991,
            18.059_195_994_179,
            59.330_230_999_055,
        ),
        (
            26910,
            550_123.4,
            4_180_567.8,
            -122.430_868_128_042,
            37.771_070_551_793,
        ),
    ];

    #[test]
    fn positions_are_those_of_proj() {
        for (code, easting, northing, lon, lat) in PROJ {
            let found = TransverseMercator::of_epsg(code)
                .expect("a known code")
                .geographic(easting, northing);
            // 1e-9 degrees are a tenth of a millimetre; the others are of GRS80.
            let least = if code > 32_000 { 1e-10 } else { 2e-9 };
            let off = (found[0] - lon).abs().max((found[1] - lat).abs());
            assert!(off < least, "{code}: {found:?}, {off:e} off");
            let grid = TransverseMercator::of_epsg(code).expect("a known code");
            let back = grid.projected(found[0], found[1]);
            let off = (back[0] - easting).abs().max((back[1] - northing).abs());
            assert!(off < 1e-5, "{code}: {back:?}, {off:e} m off");
        }
        for other in [0, 2056, 3857, 4326, 4978, 31_467, 32_661, 32_700, 25_839] {
            assert_eq!(TransverseMercator::of_epsg(other), None);
        }
    }
}
