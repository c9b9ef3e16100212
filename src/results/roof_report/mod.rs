//! What people ask of a roof: areas, slopes, directions, lengths of ridges, hips, valleys, eaves
//! and rakes, heights, volumes, each with its standard deviation, and the photographs that show it.
//!
//! ```text
//! comparison      two models of one place
//! edges           kinds of edges, from the facets alone
//! estimate        a number and its standard deviation
//! framed          what scale and level of the frame add to standard deviations
//! straight_sides  corners in plan, and the straight sides between them
//! shape           a building as a function of uncertain numbers, whose errors are propagated
//! setbacks        rules of what is kept clear along edges
//! usable          what a rule leaves of a facet
//! sunshine        how long the sun shines on facets
//! waste           what is added for cut-offs
//! photographs     which views show a facet
//! ```
//!
//! Heights and volumes are above the ground as the building has it; how well the height of the
//! ground is known is in no standard deviation.

mod comparison;
mod edges;
mod estimate;
mod framed;
mod photographs;
mod setbacks;
mod shape;
mod straight_sides;
mod sunshine;
mod usable;
mod waste;

pub use comparison::{Compared, Comparison, compare};
pub use edges::{RoofEdge, RoofEdgeKind, roof_edges};
pub use estimate::Estimate;
pub use photographs::views_of_facets;
pub use setbacks::SetbackRule;
pub use sunshine::{Sunshine, sunshine};
pub use waste::{WasteClass, WasteTable};

use nalgebra::Point3;

use self::shape::{Part, Shape};
use self::usable::usable_part;
use crate::base::geometry::Polygon;
use crate::base::ids::{BuildingId, FacetId};
use crate::roofs::model::{Building, Facet, RoofModel};

/// Slopes below this have no direction, degrees: that of a roof which drains is more.
const LEVEL_SLOPE_DEG: f64 = 1.0;

/// A length for each kind of edge, in the order of [`RoofEdgeKind::ALL`], metres; `None` where
/// there is no such edge.
pub type Lengths = [Option<Estimate>; RoofEdgeKind::ALL.len()];

/// What a rule of setbacks leaves of a facet.
#[derive(Clone, Debug, PartialEq)]
pub struct UsableArea {
    /// Area on the facet's plane, square metres.
    pub area_m2: Estimate,
    /// What it is in plan, metres; empty where nothing is left.
    pub plan: Polygon,
}

/// A facet in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct FacetReport {
    /// The facet.
    pub facet: FacetId,
    /// Area on its plane, square metres.
    pub area_m2: Estimate,
    /// Area in plan, square metres.
    pub plan_area_m2: Estimate,
    /// Slope, degrees.
    pub slope_deg: Estimate,
    /// Where it falls to, degrees clockwise from grid north; `None` for a level one.
    pub azimuth_deg: Option<Estimate>,
    /// Its lowest corner above the ground, metres.
    pub lowest_m: Estimate,
    /// Its highest corner above the ground, metres.
    pub highest_m: Estimate,
    /// Lengths of its edges, those that it shares with others too.
    pub lengths: Lengths,
    /// What each rule leaves of it, in the order of the rules.
    pub usable: Vec<UsableArea>,
    /// Probability that it is a roof's face.
    pub probability: f64,
}

/// An edge with its length.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeReport {
    /// The edge.
    pub edge: RoofEdge,
    /// Its length in space, metres.
    pub length_m: Estimate,
}

/// A building in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildingReport {
    /// The building.
    pub building: BuildingId,
    /// Its facets.
    pub facets: Vec<FacetReport>,
    /// Its edges, each once.
    pub edges: Vec<EdgeReport>,
    /// Area of all facets on their planes, square metres.
    pub area_m2: Estimate,
    /// The same in plan.
    pub plan_area_m2: Estimate,
    /// Volume between roof and ground, cubic metres.
    pub volume_m3: Estimate,
    /// The lowest corner of its roof above the ground, metres.
    pub lowest_m: Estimate,
    /// The highest corner of its roof above the ground, metres.
    pub highest_m: Estimate,
    /// Lengths of its edges, each counted once.
    pub lengths: Lengths,
    /// What each rule leaves of all facets, on their planes, square metres.
    pub usable_m2: Vec<Estimate>,
    /// Probability that all of its facets are roof faces, each taken by itself.
    pub probability: f64,
}

impl BuildingReport {
    /// Length of hips and valleys on a square metre of roof, metres.
    pub fn cut_m_per_m2(&self) -> f64 {
        let of = RoofEdgeKind::ALL.into_iter().zip(&self.lengths);
        let cut = of.filter(|(kind, _)| matches!(kind, RoofEdgeKind::Hip | RoofEdgeKind::Valley));
        cut.filter_map(|(_, length)| Some((*length)?.value))
            .sum::<f64>()
            / self.area_m2.value
    }
}

/// All buildings of a model in numbers, with what rules of setbacks leave of their facets.
pub fn roof_report(model: &RoofModel, rules: &[SetbackRule]) -> Vec<BuildingReport> {
    (model.buildings.iter().enumerate())
        .map(|(i, building)| building_report(model, BuildingId::from_index(i), building, rules))
        .collect()
}

fn building_report(
    model: &RoofModel,
    id: BuildingId,
    building: &Building,
    rules: &[SetbackRule],
) -> BuildingReport {
    let members: Vec<(FacetId, &Facet)> = (building.facets.iter())
        .map(|&f| (f, &model.facets[f.index()]))
        .collect();
    let edges = roof_edges(&members);
    let shape = Shape::new(&members, building.ground_z);
    // Per facet and rule.
    let left_of = |(i, &(id, facet)): (usize, &(FacetId, &Facet))| -> Vec<(Polygon, Part)> {
        let own = edges_of(&edges, id);
        (rules.iter())
            .map(|rule| usable_part(&shape, i, facet, &own, rule))
            .collect()
    };
    let left: Vec<Vec<(Polygon, Part)>> = members.iter().enumerate().map(left_of).collect();
    let facets: Vec<FacetReport> = (members.iter().enumerate())
        .map(|(i, &(id, facet))| {
            let height = height_range([facet], building.ground_z);
            facet_report(
                &shape,
                i,
                (id, facet),
                &edges_of(&edges, id),
                height,
                &left[i],
            )
        })
        .collect();
    let sum =
        |f: &dyn Fn(&[f64], usize) -> f64, x: &[f64]| (0..members.len()).map(|i| f(x, i)).sum();
    let all = || members.iter().map(|(_, facet)| *facet);
    let [lowest_m, highest_m] = height_range(all(), building.ground_z);
    BuildingReport {
        building: id,
        area_m2: shape.estimate(&|x| sum(&|x, i| shape.area(x, i), x)),
        plan_area_m2: shape.estimate(&|x| sum(&|x, i| shape.plan_area(x, i), x)),
        volume_m3: shape.estimate(&|x| sum(&|x, i| shape.volume_below(x, i), x)),
        lowest_m,
        highest_m,
        lengths: lengths(&shape, &edges.iter().collect::<Vec<_>>()),
        usable_m2: (0..rules.len())
            .map(|rule| {
                let area = |x: &[f64], i: usize| shape.area_of_part(x, i, &left[i][rule].1);
                shape.estimate(&|x| sum(&area, x))
            })
            .collect(),
        probability: all().map(|facet| facet.probability).product(),
        edges: (edges.iter())
            .map(|edge| EdgeReport {
                edge: edge.clone(),
                length_m: shape.estimate(&|x| shape.length(x, edge)),
            })
            .collect(),
        facets,
    }
}

fn facet_report(
    shape: &Shape,
    i: usize,
    (id, facet): (FacetId, &Facet),
    edges: &[&RoofEdge],
    [lowest_m, highest_m]: [Estimate; 2],
    left: &[(Polygon, Part)],
) -> FacetReport {
    let slope_deg = facet_slope_deg(facet);
    let usable = left.iter().map(|(plan, part)| UsableArea {
        area_m2: shape.estimate(&|x| shape.area_of_part(x, i, part)),
        plan: plan.clone(),
    });
    FacetReport {
        facet: id,
        area_m2: shape.estimate(&|x| shape.area(x, i)),
        plan_area_m2: shape.estimate(&|x| shape.plan_area(x, i)),
        slope_deg: Estimate {
            value: slope_deg,
            sigma: facet.uncertainty.as_ref().map(|u| u.slope_deg),
        },
        azimuth_deg: (slope_deg >= LEVEL_SLOPE_DEG).then(|| azimuth(shape, i)),
        lowest_m,
        highest_m,
        lengths: lengths(shape, edges),
        usable: usable.collect(),
        probability: facet.probability,
    }
}

/// The edges of a facet, those that it shares with others too.
fn edges_of(edges: &[RoofEdge], id: FacetId) -> Vec<&RoofEdge> {
    let is_own = |e: &&RoofEdge| e.facet == id || e.borders_on(id);
    edges.iter().filter(is_own).collect()
}

fn facet_slope_deg(facet: &Facet) -> f64 {
    crate::base::math::acos(facet.plane.normal.z.clamp(-1.0, 1.0)).to_degrees()
}

/// The direction of the steepest fall, 0 to 360 degrees.
fn azimuth(shape: &Shape, facet: usize) -> Estimate {
    let turned = shape.estimate(&|x| shape.turn_deg(x, facet));
    Estimate {
        value: shape.azimuth_deg(facet),
        ..turned
    }
}

/// Lowest and highest corner above the ground, with what is stated of their heights.
fn height_range<'a>(facets: impl IntoIterator<Item = &'a Facet>, ground_z: f64) -> [Estimate; 2] {
    let with_corners = |facet: &'a Facet| facet.outer.iter().map(move |p| (facet, p));
    let corners: Vec<(&Facet, &Point3<f64>)> = facets.into_iter().flat_map(with_corners).collect();
    let by_height =
        |a: &&(&Facet, &Point3<f64>), b: &&(&Facet, &Point3<f64>)| a.1.z.total_cmp(&b.1.z);
    let (low, high) = (
        corners.iter().min_by(by_height),
        corners.iter().max_by(by_height),
    );
    [low, high].map(|corner| {
        let (facet, p) = corner.expect("a facet has corners");
        let known = facet.uncertainty.as_ref();
        Estimate {
            value: p.z - ground_z,
            sigma: known.and_then(|u| u.at(p)).map(|sigma| sigma.z),
        }
    })
}

/// Sums of the lengths of edges, by kind.
fn lengths(shape: &Shape, edges: &[&RoofEdge]) -> Lengths {
    RoofEdgeKind::ALL.map(|kind| {
        let of_kind: Vec<_> = edges.iter().filter(|e| e.kind == kind).collect();
        let sum = |x: &[f64]| of_kind.iter().map(|e| shape.length(x, e)).sum();
        (!of_kind.is_empty()).then(|| shape.estimate(&sum))
    })
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod usable_tests;
