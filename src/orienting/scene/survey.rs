//! Reference system of a scene, and the quality of its orientation.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use crate::base::agreement::AgreementReport;
use crate::orienting::orientation::{
    Anchor, FrameSigma, TransverseMercator, geocentric_of, geographic_of,
};

/// How the description of a local frame begins.
const EAST_NORTH_UP: &str = "east, north, up from longitude";

/// Reference system and quality of the orientation, as far as files and images show it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// EPSG code of the world's reference system, where it is known.
    pub epsg: Option<u32>,
    /// Geodetic position of the world's origin, for a world of x east, y north, z up.
    pub anchor: Option<Anchor>,
    /// What scale and level of the world are worth, where the orientation states it.
    pub frame_sigma: Option<FrameSigma>,
    /// How far each view is shifted against the others, where enough is matched.
    pub shifts: Vec<ViewShift>,
    /// How each view was adjusted to its matched lines; empty where that was not asked for.
    pub adjustments: Vec<ViewAdjustment>,
    /// How often views moved in the adjustment.
    pub adjustment_rounds: usize,
    /// How well the images agree with the orientation that is used; `None` where it was not
    /// checked.
    pub agreement: Option<AgreementReport>,
}

impl Survey {
    /// Geocentric coordinates (EPSG:4978) of a point of the world, metres; `None` where its place
    /// on the Earth is not known. Heights of a national grid are taken as ellipsoidal: how far its
    /// datum is from the ellipsoid (the geoid, up to 100 m) is in no file.
    pub fn geocentric(&self, world: &Point3<f64>) -> Option<Point3<f64>> {
        if let Some(anchor) = &self.anchor {
            return Some(anchor.zero() + anchor.axes().transpose() * world.coords);
        }
        let grid = TransverseMercator::of_epsg(self.epsg?)?;
        let [lon, lat] = grid.geographic(world.x, world.y);
        Some(geocentric_of(lon, lat, world.z))
    }

    /// Longitude and latitude in degrees and height in metres of a point of the world; `None` where
    /// its place on the Earth is not known.
    pub fn geographic(&self, world: &Point3<f64>) -> Option<[f64; 3]> {
        self.geocentric(world).map(|place| geographic_of(&place))
    }

    /// The anchor of a system that [`Self::describe`] put into words.
    pub fn anchor_described(words: &str) -> Option<Anchor> {
        let numbers = words.strip_prefix(EAST_NORTH_UP)?.split([' ', ',']);
        let numbers: Vec<f64> = numbers
            .filter_map(|word| word.parse().ok())
            .filter(|number: &f64| number.is_finite())
            .collect();
        let &[lon_deg, lat_deg, height_m] = &numbers[..] else {
            return None;
        };
        Some(Anchor {
            lon_deg,
            lat_deg,
            height_m,
        })
    }

    /// The coordinate system of the results in words; `None` where the files do not state it.
    pub fn describe(&self) -> Option<String> {
        let of_anchor = |a: &Anchor| {
            let Anchor {
                lon_deg,
                lat_deg,
                height_m,
            } = a;
            format!(
                "{EAST_NORTH_UP} {lon_deg}, latitude {lat_deg}, ellipsoidal height {height_m} m (WGS84)"
            )
        };
        let of_epsg = self.epsg.map(|epsg| format!("EPSG:{epsg}"));
        of_epsg.or_else(|| self.anchor.as_ref().map(of_anchor))
    }
}

/// Shift of a view against the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewShift {
    /// To be added to the principal point, pixels, x right, y down.
    pub shift_px: [f64; 2],
    /// Its standard deviation, pixels; 0 for views that were not shifted.
    pub sigma_px: f64,
    /// Median distance of the view's matches from the projected world points, as stated, pixels.
    pub before_px: f64,
    /// The same with the shifts applied.
    pub after_px: f64,
    /// Number of matches.
    pub places: usize,
}

/// How the adjustment changed a view.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewAdjustment {
    /// Mean motion of the images of its lines, pixels, x right, y down; 0 for views that stay where
    /// they are.
    pub motion_px: [f64; 2],
    /// Its root mean square, pixels.
    pub rms_motion_px: f64,
    /// Angle of the rotation, degrees.
    pub turn_deg: f64,
    /// Distance that the projection centre moved, metres.
    pub move_m: f64,
    /// Median distance of its edges from the images of their lines as stated, pixels.
    pub before_px: f64,
    /// The same after the adjustment.
    pub after_px: f64,
    /// Number of edges.
    pub edges: usize,
}

impl ViewAdjustment {
    /// Was the view moved?
    pub fn moves(&self) -> bool {
        self.rms_motion_px != 0.0
    }
}
