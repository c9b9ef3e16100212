//! Verification (B99 4.3): the tests that a facet must pass.
//!
//! "Intensity similarity over the complete image set" first is that of the better half of all pairs
//! of views, since occluders are not known yet; what these accept is tested again with all pairs of
//! the views that see a facet past the others.
//!
//! ```text
//! rejection         why facets are rejected
//! interior          photo-consistency inside a facet, away from its edges
//! displaced_plane   the facet against its own plane moved up and down
//! vegetation        how green a facet is
//! boundary_leakage  what a facet covers beyond a line that bounds it
//! ```

mod boundary_leakage;
mod displaced_plane;
mod interior;
mod rejection;
mod vegetation;

pub(crate) use boundary_leakage::boundary_leakage;
pub use rejection::{FacetRejection, RejectedFacet};

use std::collections::BTreeSet;

use self::displaced_plane::{displaced_plane_margin, displaced_plane_test};
use self::interior::{InteriorSums, InteriorWindows, visible_interior};
use self::vegetation::{GREEN, excess_green};
use super::borders::Arrangement;
use super::competing_planes::CompetingPlanes;
use super::delineation::Outline;
use crate::geometry::{Plane, mean_point};
use crate::model::{Facet, Occluders};
use crate::params::RoofParams;
use crate::photoconsistency::WINDOW;
use crate::planes::{ON_SURFACE, TEXTURED};
use crate::scene::Scene;
use crate::terrain::Ground;

/// Height above the ground that no eave is below, metres. Assumption: with a few decimetres for the
/// ground's own error.
const LOWEST_EAVE: f64 = 1.0;
/// Share of a facet that may lie on the ground for the rest to be a roof still: a corner drawn too
/// far. Assumption: of a bank that rises to the height of an eave more lies lower than
/// [`LOWEST_EAVE`].
const MOST_ON_GROUND: f64 = 0.15;
/// Share of its outline on lines from which on a green facet is bounded as roofs are. Assumption.
const MOST_REAL: f64 = 0.5;
/// Cosine of the slope (26 degrees) below which a facet without a half-plane may be a roof that
/// shines: the views of a metal roof of real-barns, at 22 degrees, agree by no more than chance.
const FLAT_COSINE: f64 = 0.9;
/// Share of its outline on lines from which on a facet is bounded by them all around. Measured: of
/// the steep rendered facets without a half-plane that views agree on by chance at most, 25 of 26
/// false ones and 1 of 5 true ones have less.
const ALL_REAL: f64 = 0.85;
/// Share of a facet that another plane must be able to cover to take its place. Assumption.
const ALMOST_ALL: f64 = 0.9;
/// Standard deviations by which the views must agree better on it. Assumption: as usual.
const CLEARLY: f64 = 3.0;

/// The excess green of a facet that is as green as plants and is no clear roof, by its outline or
/// by its inside.
fn vegetation(
    facet: &Facet,
    inside: &InteriorWindows,
    interior: &InteriorSums,
    colours: &Scene,
) -> Option<f64> {
    if facet.real_ratio >= MOST_REAL && interior.is_clear() {
        return None;
    }
    let places = inside.places().map(|p| facet.plane.lift(p.x, p.y));
    let green = excess_green(colours, &places.collect::<Vec<_>>());
    (green > GREEN).then_some(green)
}

/// Area inside a facet's outer ring, on its plane, square metres.
fn sloped_area(facet: &Facet) -> f64 {
    facet.plan_area() / facet.plane.normal.z
}

/// Is a facet large enough, and as high above the ground as roofs are?
fn is_placed_like_a_roof(
    facet: &Facet,
    ground: &Ground,
    params: &RoofParams,
) -> Result<(), FacetRejection> {
    let area_m2 = sloped_area(facet);
    if area_m2 < params.min_area_m2 {
        return Err(FacetRejection::TooSmall { area_m2 });
    }
    let middle = mean_point(&facet.outer);
    let height_m = middle.z - ground.z_at(&middle.xy());
    if height_m < params.min_height_m {
        return Err(FacetRejection::NearGround { height_m });
    }
    let heights = facet.outer.iter().map(|p| p.z - ground.z_at(&p.xy()));
    let lowest_m = heights.fold(f64::INFINITY, f64::min);
    if lowest_m < LOWEST_EAVE {
        return Err(FacetRejection::ReachesGround { lowest_m });
    }
    Ok(())
}

/// Might a facet span a gap between an edge and a lower one? No half-plane shows that it continues
/// beside its lines, it is steep, as flat roofs that shine are not, and part of its outline is no
/// line.
fn may_bridge(facet: &Facet) -> bool {
    let is_flat = facet.plane.normal.z >= FLAT_COSINE;
    facet.half_planes.is_empty() && !is_flat && facet.real_ratio < ALL_REAL
}

/// The cells of a facet that come down to the ground, where these are few: without them it may be a
/// roof.
pub(crate) fn tail_on_ground(
    plane: &Plane,
    cells: &[usize],
    arrangement: &Arrangement,
    ground: &Ground,
) -> Option<Vec<usize>> {
    let of_facet: BTreeSet<usize> = cells.iter().copied().collect();
    let on_ground = |corners: &[usize; 3]| {
        let mut corners = corners.iter().map(|&v| arrangement.vertices[v]);
        corners.any(|p| plane.z_at(p.x, p.y) - ground.z_at(&p) < LOWEST_EAVE)
    };
    let low: BTreeSet<usize> = (arrangement.triangles.iter())
        .filter(|(corners, cell)| of_facet.contains(cell) && on_ground(corners))
        .map(|(_, cell)| *cell)
        .collect();
    let area =
        |cells: &BTreeSet<usize>| -> f64 { cells.iter().map(|&c| arrangement.areas[c]).sum() };
    let few = area(&low) < MOST_ON_GROUND * area(&of_facet);
    (few && !low.is_empty()).then(|| low.into_iter().collect())
}

/// Verifies a facet between the other facets and over the ground. `colours` are the photographs as
/// they were taken.
pub(crate) fn verify(
    competing: &CompetingPlanes,
    facet: &Facet,
    outline: &Outline,
    occluders: &Occluders,
    ground: &Ground,
    colours: &Scene,
    params: &RoofParams,
) -> Result<(), FacetRejection> {
    is_placed_like_a_roof(facet, ground, params)?;
    let map = &competing.maps[outline.plane as usize];
    let inside = InteriorWindows::of(facet, map);
    if inside.is_narrow() {
        return Err(FacetRejection::TooNarrow {
            window_m: WINDOW as f64 * map.grid.step,
        });
    }
    let interior = inside.sums(params.min_correlation);
    let agreed = is_agreed_on(competing, facet, outline, &interior, occluders, params);
    let hidden = competing.hidden_by(occluders);
    let displaced_plane_margin = |least_m: f64| {
        displaced_plane_margin(&competing.scene, facet, map.grid.step, least_m, &hidden)
    };
    displaced_plane_test(agreed, facet, &interior, displaced_plane_margin)?;
    if let Some(excess_green) = vegetation(facet, &inside, &interior, colours) {
        return Err(FacetRejection::Vegetation { excess_green });
    }
    if let Some((by, sigmas)) = better_plane(competing, outline, &inside) {
        return Err(FacetRejection::Dominated { by, sigmas });
    }
    Ok(())
}

/// The similarity test: are the views consistent inside a facet, given the support of its outline?
fn is_agreed_on(
    competing: &CompetingPlanes,
    facet: &Facet,
    outline: &Outline,
    interior: &InteriorSums,
    occluders: &Occluders,
    params: &RoofParams,
) -> Result<(), FacetRejection> {
    if interior.contradicts() {
        return Err(FacetRejection::Dissimilar {
            similarity: interior.correlation / interior.weight,
        });
    }
    // The better half of the pairs leaves out occluded views, and with them as many that see the
    // facet.
    let doubtful = may_bridge(facet) && interior.is_doubtful();
    if doubtful || interior.contradicts_overall() {
        let step = competing.maps[outline.plane as usize].grid.step;
        let hidden = competing.hidden_by(occluders);
        let seen = visible_interior(
            &competing.scene,
            facet,
            step,
            &hidden,
            params.min_correlation,
        );
        let similarity = seen.overall / seen.weight;
        if seen.contradicts_overall() {
            return Err(FacetRejection::Contradicted { similarity });
        }
        if doubtful && seen.is_by_chance() {
            return Err(FacetRejection::Bridge { similarity });
        }
    }
    // What little texture there is must not contradict the plane.
    let (weight, least) = texture(competing, outline);
    let sloped_m2 = sloped_area(facet);
    if facet.similarity * weight < least && weight > 0.1 * sloped_m2 {
        return Err(FacetRejection::Dissimilar {
            similarity: facet.similarity,
        });
    }
    // Where the images show the surface itself, its outline need not lie on lines.
    let shown = facet.similarity >= f64::from(ON_SURFACE)
        && weight >= f64::from(TEXTURED) * sloped_m2 * facet.plane.normal.z;
    if facet.real_ratio < params.min_real_ratio && !shown {
        return Err(FacetRejection::Unsupported {
            real_ratio: facet.real_ratio,
        });
    }
    Ok(())
}

/// Another plane that could cover a facet and that the views agree on clearly better inside it. A
/// level plane through the ridges of two roofs has more edges than the roof between them, and
/// little else.
fn better_plane(
    competing: &CompetingPlanes,
    outline: &Outline,
    inside: &InteriorWindows,
) -> Option<(u32, f64)> {
    let area = |plane: u32| -> f64 {
        let evidence = (outline.cells.iter()).filter_map(|&c| competing.evidence.get(c, plane));
        evidence.map(|e| e.area).sum()
    };
    let most = ALMOST_ALL * area(outline.plane);
    let others = (0..competing.planes.len() as u32).filter(|p| *p != outline.plane);
    let rivals = others.filter(|p| area(*p) >= most);
    let best = rivals
        .map(|p| (p, inside.advantage_of(&competing.maps[p as usize])))
        .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
    (best.1 > CLEARLY).then_some(best)
}

/// Texture weight over an outline, square metres, and its product with the least correlation.
fn texture(competing: &CompetingPlanes, outline: &Outline) -> (f64, f64) {
    let evidence = (outline.cells.iter()).filter_map(|&c| competing.evidence.get(c, outline.plane));
    evidence.fold((0.0, 0.0), |(w, l), e| (w + e.weight, l + e.least))
}

#[cfg(test)]
mod tests {
    use super::super::borders::{Border, BorderKind};
    use super::interior::interior_map;
    use super::*;
    use crate::ids::{HalfPlaneId, ViewId};
    use crate::synthetic::gable_scene;
    use crate::testing;
    use nalgebra::{Point3, Vector3};

    const MIN_CORRELATION: f64 = 0.45;

    /// A rendered roof and one of its facets.
    fn scene_and_facet() -> (Scene, Facet) {
        let (scene, truth) = gable_scene(320);
        let facet = testing::facet(&truth.facets[0].1);
        (scene, facet)
    }

    /// Do the better half of the pairs of views, and all of them, contradict a facet, without the
    /// `hidden` views?
    fn against(scene: &Scene, facet: &Facet, hidden: &[usize]) -> [bool; 2] {
        let hidden = |view: ViewId, _: &_| hidden.contains(&view.index());
        let sums = visible_interior(scene, facet, 0.1, &hidden, MIN_CORRELATION);
        assert!(sums.weight > 100.0, "the texture is strong");
        [sums.contradicts(), sums.contradicts_overall()]
    }

    #[test]
    fn the_views_that_see_a_facet_verify_it_whatever_the_others_show() {
        let (mut scene, facet) = scene_and_facet();
        assert_eq!(against(&scene, &facet, &[]), [false, false]);
        for view in &mut scene.views[..3] {
            view.gray.data.reverse();
        }
        assert_eq!(against(&scene, &facet, &[]), [false, true]);
        assert_eq!(against(&scene, &facet, &[0, 1, 2]), [false, false]);
    }

    #[test]
    fn a_plane_that_the_better_half_excuses_is_refused_by_all_views() {
        let (scene, facet) = scene_and_facet();
        let raised = |by: f64| {
            let ring = facet.outer.iter().map(|p| p + Vector3::z() * by);
            testing::facet(&ring.collect::<Vec<_>>())
        };
        let found: Vec<[bool; 2]> = (0..20)
            .map(|step| against(&scene, &raised(0.05 * f64::from(step)), &[]))
            .collect();
        assert_eq!((found[0], found[19]), ([false; 2], [true; 2]));
        assert!(found.contains(&[false, true]) && !found.contains(&[true, false]));
    }

    #[test]
    fn a_steep_facet_without_a_half_plane_may_bridge_a_gap() {
        let facet = |rise: f64, real_ratio: f64, half_planes: usize| {
            let corner = |x: f64, y: f64| Point3::new(x, y, 5.0 + rise * y);
            Facet {
                real_ratio,
                half_planes: (0..half_planes).map(HalfPlaneId::from_index).collect(),
                ..testing::facet(&[corner(0.0, 0.0), corner(9.0, 0.0), corner(9.0, 4.0)])
            }
        };
        assert!(may_bridge(&facet(1.2, 0.6, 0)));
        assert!(!may_bridge(&facet(1.2, 0.6, 1)), "it goes on beside a line");
        assert!(!may_bridge(&facet(0.4, 0.6, 0)), "metal");
        assert!(!may_bridge(&facet(1.2, 0.9, 0)), "lines all around");
    }

    #[test]
    fn a_green_facet_must_be_a_roof_by_its_lines_and_by_its_inside() {
        let (mut scene, facet) = scene_and_facet();
        let of = |scene: &Scene, raised: f64, real_ratio: f64| {
            let ring = facet.outer.iter().map(|p| p + Vector3::z() * raised);
            let facet = Facet {
                real_ratio,
                ..testing::facet(&ring.collect::<Vec<_>>())
            };
            let map = interior_map(scene, &facet, 0.1, &|_, _| false);
            let inside = InteriorWindows::of(&facet, &map);
            vegetation(&facet, &inside, &inside.sums(MIN_CORRELATION), scene).is_some()
        };
        assert!(!of(&scene, 0.0, 0.2) && !of(&scene, 2.0, 0.9), "red tiles");
        for view in &mut scene.views {
            let hedge = |p: &mut image::Rgb<u8>| p.0 = [p[0] / 2, p[0] / 2 + 20, p[0] / 2];
            view.rgb.pixels_mut().for_each(hedge);
        }
        assert!(of(&scene, 0.0, 0.2) && of(&scene, 2.0, 0.9));
        assert!(!of(&scene, 0.0, 0.9), "a copper roof");
    }

    /// A plan of 30 m by 30 m, cut by lines across at these x.
    fn cut_at(places: &[f64]) -> Arrangement {
        let border = |a: [f64; 2], b: [f64; 2]| Border {
            kind: BorderKind::Real,
            a: a.into(),
            b: b.into(),
        };
        let corners = [[-10.0, -10.0], [20.0, -10.0], [20.0, 20.0], [-10.0, 20.0]];
        let frame = (0..4).map(|i| border(corners[i], corners[(i + 1) % 4]));
        let cuts = places.iter().map(|&x| border([x, -10.0], [x, 20.0]));
        Arrangement::new(&frame.chain(cuts).collect::<Vec<_>>())
    }

    #[test]
    fn a_roof_loses_the_tail_that_comes_down_to_the_ground_and_a_bank_all() {
        // It falls from 9 m at x = 0 to 1 m at x = 8; above the ground at 2 m, its lowest eave is
        // at x = 6.
        let slope =
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 9.0), &Vector3::new(1.0, 0.0, 1.0));
        let slope = slope.expect("a normal");
        let arrangement = cut_at(&[0.0, 5.0, 5.8, 6.2, 8.0]);
        let ground = Ground::level(2.0);
        let mut cells: Vec<usize> = (0..arrangement.cells).collect();
        let middle = |cell: usize| {
            let of = arrangement.triangles.iter().filter(|t| t.1 == cell);
            let xs: Vec<f64> = of
                .flat_map(|t| t.0.map(|v| arrangement.vertices[v].x))
                .collect();
            xs.iter().sum::<f64>() / xs.len() as f64
        };
        cells.sort_by(|a, b| middle(*a).total_cmp(&middle(*b)));
        let tail = |cells: &[usize]| tail_on_ground(&slope, cells, &arrangement, &ground);
        assert_eq!(tail(&cells[1..3]), None, "all of it is high");
        assert_eq!(
            tail(&cells[1..4]),
            Some(vec![cells[3]]),
            "0.4 of 6.2 m reach below"
        );
        assert_eq!(tail(&cells[1..5]), None, "2.2 of 8 m are too much");
    }
}
