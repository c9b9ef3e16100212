//! InphoLens distortion as INPHO states it.
//!
//! `$RADIAL_COEFFS` (k0, k1, ...) and `$DECENTRE_COEFFS` (p1, p2) of `$DISTORTION_TYPE :
//! Polynomial`, or a table of radius and distortion (a key of DISTORTION with rows of two numbers).
//!
//! ```text
//! measured - ideal = (x, y) (k0 + k1 r^2 + k2 r^4 + ...)
//!                    + (p1 (r^2 + 2 x^2) + 2 p2 x y, p2 (r^2 + 2 y^2) + 2 p1 x y)
//! ```
//!
//! Assumption: x, y and r are the measured position in mm from the principal point, as is usual in
//! photogrammetry, and the distortion is positive outwards, as on calibration certificates. A
//! table's distortion is in mm, or in micrometres where mm would be more than a twentieth of the
//! radius. If the images are free of distortion already, the orientation check will show it.

use nalgebra::Vector2;

use super::block::ProjectBlock;
use crate::base::error::Result;

/// The distortion: measured minus ideal position, mm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum InphoLens {
    None,
    /// Radial k0, k1, ..., and p1, p2.
    Polynomial(Vec<f64>, [f64; 2]),
    /// Radius and distortion.
    Table(Vec<[f64; 2]>),
}

impl InphoLens {
    pub(super) fn read(camera: &ProjectBlock) -> Result<Self> {
        if camera.values.contains_key("RADIAL_COEFFS") {
            let radial = camera.all_numbers("RADIAL_COEFFS")?;
            let decentre = camera.all_numbers("DECENTRE_COEFFS")?;
            let at = |i: usize| decentre.get(i).copied().unwrap_or(0.0);
            let lens = Self::Polynomial(radial, [at(0), at(1)]);
            return Ok(if lens.is_zero() { Self::None } else { lens });
        }
        let mut tables = (camera.values.iter())
            .filter(|(key, lines)| key.contains("DISTORTION") && lines.len() > 2)
            .map(|(key, _)| *key);
        let Some(key) = tables.next() else {
            return Ok(Self::None);
        };
        let numbers = camera.all_numbers(key)?;
        if numbers.len() % 2 != 0 {
            let problem = format!("${key} has {} numbers", numbers.len());
            return Err(camera.start.error(problem, "pairs: radius and distortion"));
        }
        let rows = || numbers.chunks(2).map(|pair| [pair[0], pair[1]]);
        let is_mm = rows().all(|[radius, d]| d.abs() <= 0.05 * radius.abs());
        let unit = if is_mm { 1.0 } else { 1e-3 };
        let lens = Self::Table(rows().map(|[radius, d]| [radius, d * unit]).collect());
        Ok(if lens.is_zero() { Self::None } else { lens })
    }

    fn is_zero(&self) -> bool {
        match self {
            Self::None => true,
            Self::Polynomial(radial, decentre) => radial.iter().chain(decentre).all(|&v| v == 0.0),
            Self::Table(rows) => rows.iter().all(|row| row[1] == 0.0),
        }
    }

    /// Radii at which the distortion is known or sampled, mm, up to the farthest corner.
    pub(super) fn radii(&self, farthest_mm: f64) -> Vec<f64> {
        // Radii at which a polynomial is sampled. Assumption: several for each of its terms.
        const RADII: i32 = 24;
        match self {
            Self::None => Vec::new(),
            Self::Polynomial(..) => {
                let radius = |i| farthest_mm * f64::from(i) / f64::from(RADII);
                (1..=RADII).map(radius).collect()
            }
            Self::Table(rows) => rows.iter().map(|row| row[0]).filter(|&r| r > 0.0).collect(),
        }
    }

    /// The ideal position of a measured one, mm from the principal point.
    pub(super) fn ideal(&self, measured: &Vector2<f64>) -> Vector2<f64> {
        let (x, y, r2) = (measured.x, measured.y, measured.norm_squared());
        match self {
            Self::None => *measured,
            Self::Polynomial(radial, [p1, p2]) => {
                let g = radial.iter().rev().fold(0.0, |sum, k| sum * r2 + k);
                let aside = Vector2::new(
                    p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y,
                    p2 * (r2 + 2.0 * y * y) + 2.0 * p1 * x * y,
                );
                measured * (1.0 - g) - aside
            }
            // Only used at the radii of the rows.
            Self::Table(rows) => {
                let radius = r2.sqrt();
                let gap = |row: &[f64; 2]| (row[0] - radius).abs();
                let row = rows.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
                measured * (1.0 - row.map_or(0.0, |row| row[1]) / radius)
            }
        }
    }
}
