//! How long the sun shines on a roof in the course of a year, with the shade of the model's own
//! roofs and walls.

use std::f64::consts::TAU;

use nalgebra::{Point2, Point3, Vector3};
use serde::Serialize;

use crate::base::execution::map;
use crate::base::geometry::mean_point;
use crate::base::ids::FacetId;
use crate::base::math::sin_cos;
use crate::roofs::model::{Facet, Occluders, RoofModel};

/// The day of each month whose declination is about the mean of the month's, counted from the first
/// of January (Klein 1977, "Calculation of monthly average insolation on tilted surfaces").
const MEAN_DAYS: [f64; 12] = [
    17.0, 47.0, 75.0, 105.0, 135.0, 162.0, 198.0, 228.0, 258.0, 288.0, 318.0, 344.0,
];
/// Days of each month.
const DAYS: [f64; 12] = [
    31.0, 28.0, 31.0, 30.0, 31.0, 30.0, 31.0, 31.0, 30.0, 31.0, 30.0, 31.0,
];
/// Steps of a day, each an hour that its middle stands for.
const HOURS: usize = 24;

/// Places along each side of a facet's box.
const PLACES: usize = 5;

/// What lies on a ray to the sun is looked for up to this distance, metres: no roof is higher.
const RAY_LENGTH_M: f64 = 1e4;

/// The sun on a facet, where no cloud, tree or hill is in its way.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Sunshine {
    /// The facet.
    pub facet: FacetId,
    /// Hours of direct sun on a day of each month, mean over the facet.
    pub hours_a_day: [f64; 12],
    /// The same in a whole year.
    pub hours_a_year: f64,
}

/// The sun on all facets of a model at a latitude, degrees; its grid north is turned clockwise from
/// true north by `grid_north_deg`.
pub fn sunshine(model: &RoofModel, latitude_deg: f64, grid_north_deg: f64) -> Vec<Sunshine> {
    let occluders = Occluders::new(&model.facets);
    let suns = MEAN_DAYS.map(|day| {
        let declination = declination_deg(day);
        (0..HOURS)
            .map(|hour| to_sun(latitude_deg, declination, hour as f64 + 0.5))
            .filter(|sun| sun.z > 0.0)
            .map(|sun| turned(&sun, grid_north_deg))
            .collect::<Vec<_>>()
    });
    map(&model.facets, |i, facet| {
        let places = places(facet);
        let lit = |sun: &Vector3<f64>| -> f64 {
            if facet.plane.normal.dot(sun) <= 0.0 {
                return 0.0;
            }
            let is_lit = |p: &&Point3<f64>| !occluders.hide(p, &(**p + sun * RAY_LENGTH_M));
            places.iter().filter(is_lit).count() as f64 / places.len() as f64
        };
        let hours_a_day = suns
            .each_ref()
            .map(|suns| suns.iter().map(lit).sum::<f64>());
        Sunshine {
            facet: FacetId::from_index(i),
            hours_a_day,
            hours_a_year: hours_a_day.iter().zip(DAYS).map(|(h, days)| h * days).sum(),
        }
    })
}

/// Declination of the sun on a day of the year, degrees (Cooper 1969, "The absorption of radiation
/// in solar stills").
fn declination_deg(day: f64) -> f64 {
    23.45 * sin_cos(TAU * (284.0 + day) / 365.0).0
}

/// Unit vector to the sun, east, north, up, at an hour of solar time.
fn to_sun(latitude_deg: f64, declination_deg: f64, hour: f64) -> Vector3<f64> {
    let (sin_lat, cos_lat) = sin_cos(latitude_deg.to_radians());
    let (sin_dec, cos_dec) = sin_cos(declination_deg.to_radians());
    let (sin_hour, cos_hour) = sin_cos(TAU * (hour - 12.0) / 24.0);
    Vector3::new(
        -cos_dec * sin_hour,
        cos_lat * sin_dec - sin_lat * cos_dec * cos_hour,
        sin_lat * sin_dec + cos_lat * cos_dec * cos_hour,
    )
}

/// A direction in the axes of a grid whose north is turned clockwise.
fn turned(v: &Vector3<f64>, grid_north_deg: f64) -> Vector3<f64> {
    let (sin, cos) = sin_cos(grid_north_deg.to_radians());
    Vector3::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z)
}

/// Places on a facet, evenly in plan; of a narrow one its middle.
fn places(facet: &Facet) -> Vec<Point3<f64>> {
    let [low, high] = facet.plan_bounds();
    let at = |k: usize, axis: usize| {
        low[axis] + (k as f64 + 0.5) / PLACES as f64 * (high[axis] - low[axis])
    };
    let all = (0..PLACES).flat_map(|i| (0..PLACES).map(move |j| Point2::new(at(i, 0), at(j, 1))));
    let inside: Vec<Point3<f64>> = (all.filter(|p| facet.covers(p)))
        .map(|p| facet.plane.lift(p.x, p.y))
        .collect();
    match inside.is_empty() {
        true => vec![mean_point(&facet.outer)],
        false => inside,
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{gable, roof};
    use super::*;
    use crate::roofs::solids::close_buildings;

    fn model(facets: &[Facet]) -> RoofModel {
        close_buildings(facets, |_| 0.0).0
    }

    fn flat(x: f64, y: f64, size: f64, z: f64) -> Facet {
        let corners = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)];
        roof(&corners, [z, 0.0, 0.0])
    }

    #[test]
    fn at_the_equator_every_day_has_twelve_hours() {
        let [sun] = &sunshine(&model(&[flat(0.0, 0.0, 10.0, 5.0)]), 0.0, 0.0)[..] else {
            panic!("one facet");
        };
        assert_eq!(sun.hours_a_day, [12.0; 12]);
        assert_eq!(sun.hours_a_year, 12.0 * 365.0);
    }

    #[test]
    fn at_noon_the_sun_stands_in_the_south_as_high_as_latitude_and_season_say() {
        for (latitude, day) in [(50.0, 17.0), (50.0, 162.0), (-30.0, 344.0)] {
            let declination = declination_deg(day);
            let sun = to_sun(latitude, declination, 12.0);
            let zenith = (latitude - declination).to_radians();
            let (sin, cos) = sin_cos(zenith);
            assert!((sun - Vector3::new(0.0, -sin, cos)).norm() < 1e-12, "{sun}");
            assert!((to_sun(latitude, declination, 7.3).norm() - 1.0).abs() < 1e-12);
            // In the morning in the east.
            assert!(to_sun(latitude, declination, 9.0).x > 0.0);
        }
        assert!((declination_deg(172.0) - 23.45).abs() < 0.01);
        // Where the grid's north is true east, its east is true south.
        let south = turned(&-Vector3::y(), 90.0);
        assert!((south - Vector3::x()).norm() < 1e-12, "{south}");
    }

    #[test]
    fn a_southern_slope_has_more_sun_in_winter_and_east_and_west_have_the_same() {
        let gable = model(&gable());
        let slopes = |found: Vec<Sunshine>| -> [f64; 2] {
            let of = |is_south: bool| {
                let is_own = |s: &&Sunshine| {
                    let normal = gable.facets[s.facet.index()].plane.normal;
                    (normal.y < 0.0) == is_south
                };
                found.iter().find(is_own).unwrap().hours_a_day[11]
            };
            [of(true), of(false)]
        };
        let [south, north] = slopes(sunshine(&gable, 50.0, 0.0));
        assert!(south >= 7.0 && north < 1.0, "{south} {north}");
        // The same house in a grid whose north is true east: it looks to the east and to the west.
        let [east, west] = slopes(sunshine(&gable, 50.0, -90.0));
        assert!((east - west).abs() < 1e-9 && east > north, "{east} {west}");
    }

    #[test]
    fn a_tower_in_the_south_takes_the_sun_of_noon() {
        let low = flat(0.0, 0.0, 4.0, 3.0);
        let alone = sunshine(&model(std::slice::from_ref(&low)), 50.0, 0.0)[0].hours_a_day;
        let both = model(&[low, flat(-3.0, -12.0, 10.0, 30.0)]);
        let found = sunshine(&both, 50.0, 0.0);
        let shaded = (found.iter())
            .find(|s| both.facets[s.facet.index()].plane.z_at(0.0, 0.0) < 4.0)
            .unwrap();
        for (with, without) in shaded.hours_a_day.iter().zip(alone) {
            assert!(*with < without - 2.0, "{with} {without}");
        }
    }
}
