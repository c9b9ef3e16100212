//! Points of a cloud as evidence for roofs, in nats.
//!
//! A position of the plan is told by the point of the cloud nearest to it. With r its height above
//! a plane, and h its height above the ground, a cloud that is right as often as its parameters say
//! tells the plane from no roof by
//!
//! ```text
//! L = ((1 - o) N(r; s) + o / R) / (g N(h; s0) + (1 - g) / R),   s^2 = sz^2 + (slope sxy)^2
//! ```
//!
//! o being the share of the points above a roof that are not on it, g that of the points on the
//! ground where no roof is, and R the range of heights of all others. So many points as are
//! independent of each other count for a square metre: at most five nats, as much as clear images
//! say.
//!
//! With the probability w that the cloud belongs here every ratio becomes w L + (1 - w). A plane
//! as a whole may be no roof, or none any more, by the share e of those in error; then the points
//! are as likely as by the better of both,
//!
//! ```text
//! L' = ((1 - e) L + e max(L, 1)) / ((1 - e) + e max(L, 1))
//! ```
//!
//! so that what the cloud says of a facet lies between the logarithms of e and of 1 / e.

use std::sync::Arc;

use nalgebra::{Point2, Vector2};

use super::input::PlacedCloud;
use crate::base::evidence::{EvidenceTerm, POINT_CLOUD, nats_where_it_belongs};
use crate::base::geometry::Plane;
use crate::base::math::{exp, hypot, larger, ln, normal_density};
use crate::photographs::raster::mark_inside;
use crate::planes::dense::LEAST_SIGMA_M;
use crate::planes::photoconsistency::PlanGrid;
use crate::planes::terrain::Ground;
use crate::roofs::model::Facet;

/// A point tells of positions as far away as this, metres, where no other is nearer. Assumption: a
/// cloud has a point on a square metre; farther ones lie on other surfaces.
const REACH_M: f64 = 0.75;
/// Standard deviation of the height of the ground, metres, as the images show it: a few
/// decimetres.
const GROUND_SIGMA_M: f64 = 0.3;

/// A point cloud over the plan of a scene.
#[derive(Clone, Debug)]
pub(crate) struct CloudEvidence {
    cloud: Arc<PlacedCloud>,
    grid: PlanGrid,
    /// The point nearest to each sample; `u32::MAX` for none.
    nearest: Vec<u32>,
    /// How likely each point is where no roof is, per metre of height.
    elsewhere: Vec<f64>,
}

/// A height of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceHeight {
    /// Plan position, metres.
    pub at: Point2<f64>,
    /// Metres.
    pub z: f64,
    /// Standard deviation, metres.
    pub sigma_m: f64,
    /// Neighbouring heights share their errors: as so many independent ones it counts.
    pub independent: f64,
}

/// What a cloud says of one plane.
pub(super) struct OfPlane<'a> {
    cloud: &'a CloudEvidence,
    plane: Plane,
    /// Standard deviation of a point's height above it, metres.
    sigma_m: f64,
}

/// What points say of a plane.
struct Said {
    /// Of a roof there against none, nats.
    nats: f64,
    /// Share of the points that speak for it; a half where there are none.
    on_it: f64,
}

impl CloudEvidence {
    /// Lays the cloud over the plan.
    pub(super) fn new(cloud: Arc<PlacedCloud>, ground: &Ground, window: &PlanGrid) -> Self {
        let grid = window.in_samples();
        let step = grid.step;
        let mut nearest = vec![(u32::MAX, REACH_M as f32); grid.width * grid.height];
        let reach = (REACH_M / step).ceil() as isize;
        for (i, p) in cloud.points.iter().enumerate() {
            let at = (p.xy() - grid.origin) / step;
            let [column, row] = [at.x, at.y].map(|v| v.floor() as isize);
            for (r, c) in (-reach..=reach).flat_map(|r| (-reach..=reach).map(move |c| (r, c))) {
                let (Ok(c), Ok(r)) = (usize::try_from(column + c), usize::try_from(row + r)) else {
                    continue;
                };
                if c < grid.width && r < grid.height {
                    let stored = &mut nearest[r * grid.width + c];
                    let away = (grid.center(c, r) - p.xy()).norm() as f32;
                    if away < stored.1 {
                        *stored = (i as u32, away);
                    }
                }
            }
        }
        let params = &cloud.params;
        let sigma_m = hypot(cloud.accuracy_m, GROUND_SIGMA_M);
        let elsewhere = cloud.points.iter().map(|p| {
            let height = p.z - ground.z_at(&p.xy());
            params.ground_share * normal_density(height, sigma_m)
                + (1.0 - params.ground_share) / params.range_m
        });
        Self {
            elsewhere: elsewhere.collect(),
            nearest: nearest.into_iter().map(|(i, _)| i).collect(),
            cloud,
            grid,
        }
    }

    /// What it says of a plane.
    pub(super) fn of(&self, plane: &Plane) -> OfPlane<'_> {
        let slope = plane.normal.xy().norm() / larger(plane.normal.z, 0.1);
        let place = slope * self.cloud.params.place_sigma_m;
        OfPlane {
            cloud: self,
            plane: *plane,
            sigma_m: larger(hypot(self.cloud.accuracy_m, place), LEAST_SIGMA_M),
        }
    }

    /// The height of the point nearest to a position, of which there is one every so many metres.
    pub(super) fn height_at(&self, p: &Point2<f64>, spacing: f64) -> Option<SurfaceHeight> {
        let (column, row) = self.grid.cell(p)?;
        let point = *self.nearest.get(row * self.grid.width + column)? as usize;
        let p = self.cloud.points.get(point)?;
        Some(SurfaceHeight {
            at: p.xy(),
            z: p.z,
            sigma_m: larger(self.cloud.accuracy_m, LEAST_SIGMA_M),
            independent: self.cloud.params.independent_per_m2 * spacing * spacing,
        })
    }

    /// What it says of a facet.
    pub(super) fn of_facet(&self, facet: &Facet) -> EvidenceTerm {
        let said = self.said(facet, &facet.plane);
        let e = self.cloud.params.in_error;
        // Beyond that both ratios are at their bounds.
        let ratio = exp(said.nats.clamp(-LARGEST_ODDS_NATS, LARGEST_ODDS_NATS));
        let older = e * larger(ratio, 1.0);
        let ratio = ((1.0 - e) * ratio + older) / (1.0 - e + older);
        EvidenceTerm {
            feature: POINT_CLOUD,
            value: said.on_it,
            nats: self.weighed(ratio),
        }
    }

    /// How much likelier the points over a facet are on one plane than on another, nats.
    pub(crate) fn prefers(&self, facet: &Facet, plane: &Plane, to: &Plane) -> f64 {
        let [said, instead] = [plane, to].map(|plane| self.said(facet, plane).nats);
        let odds = (said - instead).clamp(-LARGEST_ODDS_NATS, LARGEST_ODDS_NATS);
        self.weighed(exp(odds))
    }

    /// What the points over a facet say of a plane.
    fn said(&self, facet: &Facet, plane: &Plane) -> Said {
        let of_plane = self.of(plane);
        let PlanGrid { origin, step, .. } = self.grid;
        let [low, high] = facet.plan_bounds();
        let corner = |p: Point2<f64>| {
            let at = (p - origin) / step;
            [(at.x, self.grid.width), (at.y, self.grid.height)]
                .map(|(v, size)| v.clamp(0.0, (size - 1) as f64) as usize)
        };
        let ([c0, r0], [c1, r1]) = (corner(low), corner(high));
        let (width, height) = (c1 + 1 - c0, r1 + 1 - r0);
        let shift = Vector2::new(c0 as f64, r0 as f64);
        let plan = (facet.plan()).mapped(|p| Point2::from((p - origin) / step - shift));
        let mut covered = vec![false; width * height];
        mark_inside(&plan, width, height, &mut covered);
        let (mut nats, mut on_it, mut told) = (0.0, 0.0, 0.0);
        for k in (0..covered.len()).filter(|k| covered[*k]) {
            if let Some(ratio) = of_plane.ratio(c0 + k % width, r0 + k / width) {
                nats += ln(ratio) * step * step * self.cloud.params.independent_per_m2;
                told += 1.0;
                on_it += if ratio > 1.0 { 1.0 } else { 0.0 };
            }
        }
        Said {
            nats,
            on_it: if told > 0.0 { on_it / told } else { 0.5 },
        }
    }

    /// The logarithm of a ratio that holds where the cloud belongs here.
    fn weighed(&self, ratio: f64) -> f64 {
        nats_where_it_belongs(self.cloud.belongs, ratio)
    }
}

/// Odds beyond are certainty, and their exponential stays finite.
const LARGEST_ODDS_NATS: f64 = 100.0;

impl OfPlane<'_> {
    /// What it says at a position of the plan, nats for each square metre; 0 where it has no point.
    pub(super) fn nats_at(&self, p: &Point2<f64>) -> f64 {
        let cell = self.cloud.grid.cell(p);
        let ratio = cell.and_then(|(column, row)| self.ratio(column, row));
        let independent = self.cloud.cloud.params.independent_per_m2;
        ratio.map_or(0.0, |ratio| independent * self.cloud.weighed(ratio))
    }

    /// L of a sample.
    fn ratio(&self, column: usize, row: usize) -> Option<f64> {
        let sample = row * self.cloud.grid.width + column;
        let point = *self.cloud.nearest.get(sample)? as usize;
        let p = self.cloud.cloud.points.get(point)?;
        let params = &self.cloud.cloud.params;
        let off = p.z - self.plane.z_at(p.x, p.y);
        let on_roof = (1.0 - params.off_share) * normal_density(off, self.sigma_m)
            + params.off_share / params.range_m;
        Some(on_roof / self.cloud.elsewhere[point])
    }
}

#[cfg(test)]
use {crate::base::params::PointCloudParams, nalgebra::Point3};

#[cfg(test)]
impl CloudEvidence {
    /// That of points every half metre at one height over 10 m by 8 m around the origin, which
    /// belong here with this probability.
    pub(crate) fn of_level_points(z: f64, belongs: f64) -> Self {
        let places = (-10..=10).flat_map(|x| (-8..=8).map(move |y| (x, y)));
        let point = |(x, y)| Point3::new(0.5 * f64::from(x), 0.5 * f64::from(y), z);
        let cloud = PlacedCloud {
            points: places.map(point).collect(),
            accuracy_m: 0.05,
            belongs,
            params: PointCloudParams::default(),
        };
        let plan = PlanGrid::covering(Point2::new(-5.0, -4.0), Point2::new(5.0, 4.0), 0.5);
        Self::new(Arc::new(cloud), &Ground::level(0.0), &plan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing;

    #[test]
    fn points_prefer_the_plane_that_they_lie_on_as_far_as_they_belong_here() {
        let corners = [(-5.0, -4.0), (5.0, -4.0), (5.0, 4.0), (-5.0, 4.0)];
        let facet = testing::facet(&corners.map(|(x, y)| Point3::new(x, y, 5.4)));
        let [on, off] = [5.4, 5.0].map(Plane::level);
        let surely = CloudEvidence::of_level_points(5.4, 1.0);
        let nats = surely.prefers(&facet, &on, &off);
        // A point that is eight standard deviations off is one that lies on no roof.
        let params = PointCloudParams::default();
        let stray = params.off_share / params.range_m;
        let peak = (1.0 - params.off_share) * normal_density(0.0, 0.05);
        let of_point = ln((peak + stray) / stray);
        assert!(
            (nats - (80.0 * of_point).min(LARGEST_ODDS_NATS)).abs() < 1e-6,
            "{nats}"
        );
        assert!((nats + surely.prefers(&facet, &off, &on)).abs() < 1e-6);
        assert_eq!(surely.prefers(&facet, &on, &on), 0.0);
        // One that may be of elsewhere says less against a plane than that it is of elsewhere.
        let hardly = CloudEvidence::of_level_points(5.4, 0.3);
        let against = hardly.prefers(&facet, &off, &on);
        assert!((against - ln(0.7)).abs() < 1e-6, "{against}");
    }

    #[test]
    fn points_tell_a_roof_from_the_ground_and_from_a_plane_beside_it() {
        let cloud = CloudEvidence::of_level_points(5.0, 1.0);
        let at = Point2::new(1.1, -0.6);
        let nats = |z: f64| cloud.of(&Plane::level(z)).nats_at(&at);
        assert!(nats(5.0) > 3.0, "{}", nats(5.0));
        assert!(nats(5.2) < nats(5.1) && nats(5.1) < nats(5.0));
        assert!(nats(7.0) < 0.0);
        let bare = CloudEvidence::of_level_points(0.0, 1.0);
        assert!(bare.of(&Plane::level(5.0)).nats_at(&at) < -3.0);
    }
}
