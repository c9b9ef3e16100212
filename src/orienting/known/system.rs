//! The coordinate system that a file states, and the way from it to the scene's frame.

use nalgebra::{Point3, Vector3};

use crate::orienting::orientation::{Anchor, TransverseMercator, geocentric_of};

/// What a file says of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum StatedSystem {
    /// Nothing: they are those of the scene.
    Unstated,
    /// Longitude and latitude on WGS84.
    LongitudeLatitude,
    /// EPSG code of their system.
    Code(u32),
    /// A system that is named, but not by a code.
    Other(String),
}

/// The system of a scene's world frame, as far as it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldSystem {
    /// EPSG code.
    pub epsg: Option<u32>,
    /// Geodetic position of the world's origin, for a world of x east, y north, z up.
    pub anchor: Option<Anchor>,
}

/// Codes of longitude and latitude: WGS84 in two and three dimensions, ETRS89, NAD83, SWEREF99.
const GEOGRAPHIC: [u32; 6] = [4326, 4979, 4258, 4937, 4269, 4619];

impl StatedSystem {
    /// By the text of a name or an address.
    pub(super) fn named(text: &str) -> Self {
        if text.contains("CRS84") {
            return Self::LongitudeLatitude;
        }
        let code = crate::orienting::orientation::epsg_of(text);
        code.map_or_else(|| Self::Other(text.chars().take(80).collect()), Self::Code)
    }

    /// Are coordinates longitude and latitude, in this order?
    fn is_geographic(&self) -> bool {
        match self {
            Self::LongitudeLatitude => true,
            Self::Code(code) => GEOGRAPHIC.contains(code),
            Self::Unstated | Self::Other(_) => false,
        }
    }

    fn describe(&self) -> String {
        match self {
            Self::Unstated => "no stated system".to_owned(),
            Self::LongitudeLatitude => "longitude and latitude".to_owned(),
            Self::Code(code) if GEOGRAPHIC.contains(code) => {
                format!("longitude and latitude (EPSG:{code})")
            }
            Self::Code(code) => format!("EPSG:{code}"),
            Self::Other(name) => format!("the system {name}"),
        }
    }
}

impl WorldSystem {
    fn describe(&self) -> String {
        match (self.epsg, self.anchor) {
            (Some(code), _) => format!("EPSG:{code}"),
            (None, Some(_)) => "metres east and north of a place".to_owned(),
            (None, None) => "not known".to_owned(),
        }
    }

    /// Are coordinates of a stated system those of the scene as they are? Otherwise why not. Of a
    /// scene whose system is not known any metres may be.
    pub(super) fn is_frame_of(&self, stated: &StatedSystem) -> Result<(), String> {
        let grid = TransverseMercator::of_epsg;
        let is_same = match (stated, self.epsg, self.anchor) {
            (StatedSystem::Unstated, ..) => true,
            (_, None, None) => !stated.is_geographic(),
            (StatedSystem::Code(code), Some(own), _) => {
                *code == own || grid(*code).is_some_and(|g| Some(g) == grid(own))
            }
            _ => false,
        };
        is_same.then_some(()).ok_or_else(|| self.mismatch(stated))
    }

    fn mismatch(&self, stated: &StatedSystem) -> String {
        let (stated, own) = (stated.describe(), self.describe());
        format!("its coordinates are in {stated}, and the system of the orientation is {own}")
    }

    /// The way from coordinates of a stated system to the scene's world frame; otherwise why there
    /// is none.
    pub(super) fn way_from(&self, stated: &StatedSystem) -> Result<Way, String> {
        if self.is_frame_of(stated).is_ok() {
            return Ok(Way::Same);
        }
        let from = match stated {
            _ if stated.is_geographic() => None,
            StatedSystem::Code(code) => {
                Some(TransverseMercator::of_epsg(*code).ok_or_else(|| self.mismatch(stated))?)
            }
            _ => return Err(self.mismatch(stated)),
        };
        let to = match (self.anchor, self.epsg.and_then(TransverseMercator::of_epsg)) {
            (Some(anchor), _) => Target::Anchor(anchor),
            (None, Some(grid)) => Target::Grid(grid),
            (None, None) => return Err(self.mismatch(stated)),
        };
        Ok(Way::Through { from, to })
    }
}

/// From a file's coordinates in plan to the scene's world frame.
pub(super) enum Way {
    Same,
    /// By longitude and latitude, from a grid or as they are.
    Through {
        from: Option<TransverseMercator>,
        to: Target,
    },
}

pub(super) enum Target {
    Grid(TransverseMercator),
    Anchor(Anchor),
}

impl Way {
    /// A position in the world frame; `None` where it is no place on the Earth.
    pub(super) fn world(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let Self::Through { from, to } = self else {
            return Some([x, y]);
        };
        let [lon, lat] = from.map_or([x, y], |grid| grid.geographic(x, y));
        if !(lon.abs() <= 180.0 && lat.abs() <= 90.0) {
            return None;
        }
        let found = match to {
            Target::Grid(grid) => grid.projected(lon, lat),
            Target::Anchor(anchor) => {
                // The height of the plan is that of the anchor: 100 m of it are 0.1 mm in a
                // kilometre.
                let place: Point3<f64> = geocentric_of(lon, lat, anchor.height_m);
                let local: Vector3<f64> = anchor.local(&place).coords;
                [local.x, local.y]
            }
        };
        found.iter().all(|v| v.is_finite()).then_some(found)
    }
}
