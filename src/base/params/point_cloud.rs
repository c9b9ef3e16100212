//! Parameters of a point cloud as evidence for roofs.

use serde::{Deserialize, Serialize};

/// How far the points of a cloud are believed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PointCloudParams {
    /// Whether points on roofs propose planes and count for them.
    pub enabled: bool,
    /// Probability that a cloud that is given belongs to the place, before the images are compared
    /// with it. Assumption: of ten that are given, one is of the neighbouring tile or another year.
    pub belongs: f64,
    /// Standard deviation in place, metres. Assumption: surveys promise 0.3 m, twice what they
    /// promise of heights.
    pub place_sigma_m: f64,
    /// Share of the points above a roof that do not lie on it. Assumption: chimneys, dormers,
    /// crowns over the eave, walls and what was measured wrongly.
    pub off_share: f64,
    /// Share of the points where no roof is that lie on the ground. Assumption: the others are
    /// those of trees, hedges and cars.
    pub ground_share: f64,
    /// What lies neither on the roof nor on the ground lies anywhere within this height, metres.
    /// Assumption: as high as trees.
    pub range_m: f64,
    /// So many points for each square metre are independent of each other. Assumption: the errors
    /// of a strip are common to its neighbouring points, so that all within a metre count as one.
    pub independent_per_m2: f64,
    /// Share of the planes above the ground in a cloud that are no roofs now: crowns as even as
    /// those, and what was built, rebuilt or torn down since. Of 0.03, 0.15 and 0.3 the one with
    /// the highest quality on six fitting scenes with trees: 0.69, 0.85 and 0.82.
    pub in_error: f64,
    /// Share of the surfaces that the images show clearly, as roofs or as ground, which a cloud of
    /// the place has too. Assumption: matching errs at some, and some have changed.
    pub agreement: f64,
    /// Share of them that a cloud of another place agrees with by chance, at its best shift.
    /// Assumption: roofs of a district are about as high as each other.
    pub chance: f64,
    /// Parts of buildings agree or not as wholes of this area, square metres. Assumption: half a
    /// garage.
    pub part_m2: f64,
    /// Least height above the ground of a plane that the cloud proposes, metres. Assumption: lower
    /// ones are those of hedges, cars and banks.
    pub least_height_m: f64,
    /// Least area of one, square metres. Assumption: half of what a dormer has.
    pub least_area_m2: f64,
}

impl Default for PointCloudParams {
    fn default() -> Self {
        Self {
            enabled: true,
            belongs: 0.9,
            place_sigma_m: 0.3,
            off_share: 0.2,
            ground_share: 0.7,
            range_m: 20.0,
            independent_per_m2: 1.0,
            in_error: 0.15,
            agreement: 0.8,
            chance: 0.2,
            part_m2: 10.0,
            least_height_m: 1.5,
            least_area_m2: 3.0,
        }
    }
}
