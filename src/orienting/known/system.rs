//! The coordinate system that a file states, and the way between it and the scene's frame.

use nalgebra::{Point3, Vector3};

use crate::orienting::orientation::{
    A_M, Anchor, LinearUnit, PlanUnit, SystemUnits, TransverseMercator, epsg_of, geocentric_of,
    is_geographic, plane_of, units_of, units_of_code,
};

/// What a file says of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StatedSystem {
    pub plan: StatedPlan,
    /// Metres in a unit of its coordinates in plan.
    pub plan_unit_m: f64,
    /// Metres in a unit of its heights.
    pub height_unit_m: f64,
}

/// What a file says of its coordinates in plan.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum StatedPlan {
    /// Nothing: they are those of the scene.
    Unstated,
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

impl From<StatedPlan> for StatedSystem {
    /// With the units of its code, metres where it has none.
    fn from(plan: StatedPlan) -> Self {
        let units = match plan {
            StatedPlan::Code(code) => Some(units_of_code(code)),
            _ => None,
        };
        Self::with(plan, units)
    }
}

impl StatedSystem {
    pub(super) fn unstated() -> Self {
        StatedPlan::Unstated.into()
    }

    pub(super) fn longitude_latitude() -> Self {
        StatedPlan::Code(4326).into()
    }

    /// By the text of a name, an address, or well-known text.
    pub(super) fn named(text: &str) -> Self {
        let plan = epsg_of(text).map_or_else(
            || StatedPlan::Other(text.chars().take(80).collect()),
            StatedPlan::Code,
        );
        Self::with(plan, units_of(text))
    }

    fn with(plan: StatedPlan, units: Option<SystemUnits>) -> Self {
        let of_plan = units.and_then(|units| match units.plan {
            PlanUnit::Length(unit) => Some(unit),
            PlanUnit::Angle(_) | PlanUnit::Geocentric => None,
        });
        // Heights that state no unit are in that of the plan, as ISO 19111 has it in space.
        let of_heights = units.and_then(|units| units.height).or(of_plan);
        let metres = |unit: Option<LinearUnit>| unit.map_or(1.0, |unit| unit.metres);
        Self {
            plan,
            plan_unit_m: metres(of_plan),
            height_unit_m: metres(of_heights),
        }
    }

    /// Are coordinates longitude and latitude, in this order?
    fn is_geographic(&self) -> bool {
        matches!(self.plan, StatedPlan::Code(code) if is_geographic(code))
    }

    fn describe(&self) -> String {
        match &self.plan {
            StatedPlan::Unstated => "no stated system".to_owned(),
            StatedPlan::Code(code) if is_geographic(*code) => {
                format!("longitude and latitude (EPSG:{code})")
            }
            StatedPlan::Code(code) => format!("EPSG:{code}"),
            StatedPlan::Other(name) => {
                let unit = LinearUnit {
                    metres: self.plan_unit_m,
                };
                format!("the system {name}, in {}", unit.words())
            }
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

    /// Is it known where on the Earth the scene lies?
    pub(super) fn is_known(&self) -> bool {
        self.epsg.is_some() || self.anchor.is_some()
    }

    /// Are coordinates of a stated system, in metres, those of the scene as they are? Of a scene
    /// whose system is not known any metres may be.
    fn is_frame_of(&self, stated: &StatedSystem) -> bool {
        match (&stated.plan, self.epsg, self.anchor) {
            (StatedPlan::Unstated, ..) => true,
            (_, None, None) => !stated.is_geographic(),
            (StatedPlan::Code(code), Some(own), _) => plane_of(*code) == plane_of(own),
            _ => false,
        }
    }

    fn mismatch(&self, stated: &StatedSystem) -> String {
        let (stated, own) = (stated.describe(), self.describe());
        format!("its coordinates are in {stated}, and the system of the orientation is {own}")
    }

    /// The way from coordinates of a stated system to the scene's world frame; otherwise why there
    /// is none.
    pub(super) fn way_from(&self, stated: &StatedSystem) -> Result<Way, String> {
        let through = match self.is_frame_of(stated) {
            true => None,
            false => Some(self.through(stated)?),
        };
        Ok(Way {
            plan_unit_m: stated.plan_unit_m,
            height_unit_m: stated.height_unit_m,
            through,
        })
    }

    fn through(&self, stated: &StatedSystem) -> Result<Through, String> {
        let grid = TransverseMercator::of_epsg;
        let from = match stated.plan {
            _ if stated.is_geographic() => None,
            StatedPlan::Code(code) => Some(grid(code).ok_or_else(|| self.mismatch(stated))?),
            _ => return Err(self.mismatch(stated)),
        };
        let to = match (self.anchor, self.epsg.and_then(grid)) {
            (Some(anchor), _) => Target::Anchor(anchor),
            (None, Some(grid)) => Target::Grid(grid),
            (None, None) => return Err(self.mismatch(stated)),
        };
        Ok(Through { from, to })
    }
}

/// Between a file's coordinates and the scene's world frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Way {
    plan_unit_m: f64,
    /// Metres in a unit of its heights.
    pub(super) height_unit_m: f64,
    /// By longitude and latitude, where the frames are not the same.
    through: Option<Through>,
}

#[derive(Clone, Debug, PartialEq)]
struct Through {
    /// The file's grid; `None` where it has longitude and latitude.
    from: Option<TransverseMercator>,
    to: Target,
}

#[derive(Clone, Debug, PartialEq)]
enum Target {
    Grid(TransverseMercator),
    Anchor(Anchor),
}

impl Way {
    /// The way of coordinates in metres that are those of the scene.
    pub(super) fn same() -> Self {
        Self {
            plan_unit_m: 1.0,
            height_unit_m: 1.0,
            through: None,
        }
    }

    /// Metres in a unit of the file's coordinates in plan; `None` of longitude and latitude.
    pub(super) fn plan_unit_m(&self) -> Option<f64> {
        let is_angle = self.through.as_ref().is_some_and(|t| t.from.is_none());
        (!is_angle).then_some(self.plan_unit_m)
    }

    /// A position in plan in the world frame; `None` where it is no place on the Earth.
    pub(super) fn world(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        // The height of the plan is that of the anchor: 100 m of it are 0.1 mm in a kilometre.
        let anchor_m = match &self.through {
            Some(Through {
                to: Target::Anchor(anchor),
                ..
            }) => anchor.height_m,
            _ => 0.0,
        };
        let [x, y, _] = self.world_in_space([x, y, anchor_m / self.height_unit_m])?;
        Some([x, y])
    }

    /// A position in the world frame; `None` where it is no place on the Earth.
    pub(super) fn world_in_space(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        let z = z * self.height_unit_m;
        let in_metres = [x, y].map(|v| v * self.plan_unit_m);
        let Some(Through { from, to }) = &self.through else {
            return Some([in_metres[0], in_metres[1], z]);
        };
        let [lon, lat] = from.map_or([x, y], |grid| grid.geographic(in_metres[0], in_metres[1]));
        if !(lon.abs() <= 180.0 && lat.abs() <= 90.0) {
            return None;
        }
        let found = match to {
            Target::Grid(grid) => {
                let [x, y] = grid.projected(lon, lat);
                [x, y, z]
            }
            Target::Anchor(anchor) => {
                let place: Point3<f64> = geocentric_of(lon, lat, z);
                let local: Vector3<f64> = anchor.local(&place).coords;
                local.into()
            }
        };
        found.iter().all(|v| v.is_finite()).then_some(found)
    }

    /// The file's position in plan of one of the world frame.
    pub(super) fn back(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let in_metres = match &self.through {
            None => [x, y],
            Some(Through { from, to }) => {
                let [lon, lat] = match to {
                    Target::Grid(grid) => grid.geographic(x, y),
                    Target::Anchor(anchor) => {
                        let [lon, lat, _] = anchor.geographic(&Point3::new(x, y, 0.0));
                        [lon, lat]
                    }
                };
                match from {
                    None => return [lon, lat],
                    Some(grid) => grid.projected(lon, lat),
                }
            }
        };
        in_metres.map(|v| v / self.plan_unit_m)
    }

    /// Height in the world frame, at a position in plan of it, of one in metres above the file's
    /// zero.
    pub(super) fn height(&self, [x, y]: [f64; 2], z: f64) -> f64 {
        match &self.through {
            Some(Through {
                to: Target::Anchor(anchor),
                ..
            }) => {
                // The ellipsoid falls away from the plane that touches it.
                z - anchor.height_m - (x * x + y * y) / (2.0 * A_M)
            }
            _ => z,
        }
    }
}
