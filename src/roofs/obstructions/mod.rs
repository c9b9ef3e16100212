//! What stands on roofs: chimneys, air handlers, skylights with curbs, dormers too small for faces
//! of their own.
//!
//! ```text
//! surface   a facet's surface in each view, and where something hides it
//! block     the upright block that explains best what hides it
//! islands   facets within another one that are no roofs by their size
//! ```
//!
//! A block hides of a facet what lies behind it in each view: its base, and the strip over which
//! its top leans. Of all places, from the likeliest on, that say more than the best of as many says
//! by chance, and that are not yet explained, the block there is fitted, and what it hides is
//! explained. A fitted table (`EvidenceModel::of_obstructions`) weighs what was measured of a
//! block: something that hides a roof may also be a tree, a wire, or a neighbour.

mod block;
mod islands;
mod surface;

pub(crate) use islands::take_out_islands;

use nalgebra::{Point3, Vector2};

use self::block::Block;
use self::surface::SeenSurface;
use crate::base::evidence::{Evidence, EvidenceModel, JudgedFacet, WindowCounts};
use crate::base::geometry::{Plane, Polygon, plan_sides};
use crate::base::ids::ViewId;
use crate::base::math::{larger, ln};
use crate::orienting::scene::{Scene, excess_green};
use crate::roofs::facets::PartVisibility;
use crate::roofs::model::{Facet, Obstruction, Occluders, RoofModel};

/// Least distance of samples, metres, as where facets are found.
pub(crate) const FINEST_SAMPLE_M: f64 = 0.06;
/// Cells of a surface: those of the largest halls are wider, and none takes more than 80 MB.
const SURFACE_CELLS: f64 = 4e5;
/// Three to one, as for lines of the finished model: what usable areas leave out should be there.
const ACCEPTED_NATS: f64 = 1.1;
/// What lies so near to an obstruction may be its border, metres.
const BORDER_M: f64 = 0.15;
/// How far around a block the surface is looked at, metres.
const RING_WIDTH_M: f64 = 0.3;
/// A roof that falls by less has no direction: gradient.
const LEVEL_GRADIENT: f64 = 0.05;

/// Finds what stands on the facets of a model, and adds it to what is known to do so. Returns all
/// blocks that were weighed, by their tops.
pub(crate) fn find_obstructions(scene: &Scene, model: &mut RoofModel) -> Vec<JudgedFacet> {
    let occluders = Occluders::new(&model.facets);
    let found = crate::base::execution::map(&model.facets, |_, facet| {
        blocks_on(scene, facet, &occluders)
    });
    let mut judged: Vec<(usize, Weighed)> = (found.into_iter().enumerate())
        .flat_map(|(i, blocks)| blocks.into_iter().map(move |block| (i, block)))
        .collect();
    // One on a ridge stands on both of its facets.
    judged.sort_by(|(_, a), (_, b)| {
        b.judged
            .evidence
            .nats()
            .total_cmp(&a.judged.evidence.nats())
    });
    for (facet, weighed) in &mut judged {
        let mut others = model.facets.iter().flat_map(|f| &f.obstructions);
        let is_known = others.any(|other| other.shares_its_place(&weighed.obstruction));
        weighed.judged.accepted &= !is_known;
        if weighed.judged.accepted {
            let obstruction = weighed.obstruction.clone();
            model.facets[*facet].obstructions.push(obstruction);
        }
    }
    judged
        .into_iter()
        .map(|(_, weighed)| weighed.judged)
        .collect()
}

/// A block, and what speaks for it.
struct Weighed {
    obstruction: Obstruction,
    judged: JudgedFacet,
}

/// What may stand on a facet.
fn blocks_on(scene: &Scene, facet: &Facet, occluders: &Occluders) -> Vec<Weighed> {
    let Some(first) = facet.outer.first() else {
        return Vec::new();
    };
    let pixels = scene.views.iter().map(|v| v.camera.ground_pixel(first));
    let pixel = pixels.fold(f64::INFINITY, f64::min);
    let [min, max] = facet.plan_bounds();
    let finest = ((max.x - min.x) * (max.y - min.y) / SURFACE_CELLS).sqrt();
    let step = larger(larger(pixel, FINEST_SAMPLE_M), finest);
    let hidden = |v: ViewId, p: &Point3<f64>| occluders.hide(p, &scene.camera(v).center);
    let visibility = PartVisibility::new(scene, facet, step, &hidden);
    let hidden = |v: ViewId, p: &Point3<f64>| visibility.is_hidden(v, &p.xy());
    let Some(mut seen) = SeenSurface::new(scene, facet, step, &hidden) else {
        return Vec::new();
    };
    let (likely, by_chance) = Block::likely(&seen, &facet.plane, direction_of(facet));
    let mut found = Vec::new();
    for small in likely {
        // What was found may have explained what spoke for this one.
        if small.votes(&seen, &facet.plane) > by_chance {
            let (block, nats) = small.fitted(&seen, &facet.plane);
            if nats > by_chance {
                found.push(weighed(scene, facet, &seen, &block, nats));
            }
            let widened = block.widened(BORDER_M);
            seen.explain(|seen, view| widened.shade(seen, view, &facet.plane));
        }
    }
    found
}

/// A block with what speaks for it.
fn weighed(scene: &Scene, facet: &Facet, seen: &SeenSurface, block: &Block, nats: f64) -> Weighed {
    let evidence = evidence_of(scene, facet, seen, block, nats);
    // A cell that is hidden in part differs like one that is hidden.
    let outline = block.widened(-0.5 * seen.grid.step).outline();
    let top = facet.plane.z_at(block.middle.x, block.middle.y) + block.height;
    Weighed {
        obstruction: Obstruction {
            outline: outline.to_vec(),
            height_m: block.height,
            height_sigma_m: Some(block.height_sigma(seen, &facet.plane)),
            probability: evidence.probability(),
        },
        judged: JudgedFacet {
            outline: block.outline().map(|p| Point3::new(p.x, p.y, top)).to_vec(),
            holes: Vec::new(),
            plane: Plane::level(top),
            accepted: evidence.accepts(ACCEPTED_NATS),
            evidence,
            windows: WindowCounts::default(),
        },
    }
}

/// The direction in which a facet falls, or that of its longest side.
fn direction_of(facet: &Facet) -> Vector2<f64> {
    let normal = &facet.plane.normal;
    let gradient = normal.xy() / normal.z;
    let sides = plan_sides(&facet.outer).map(|[p, q]| q - p);
    let longest = sides.max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    let direction = match gradient.norm() > LEVEL_GRADIENT {
        true => gradient,
        false => longest.unwrap_or(gradient),
    };
    direction.try_normalize(0.0).unwrap_or(Vector2::x())
}

/// What the views say of the cells that a block hides: nats, and their number.
fn said_of(seen: &SeenSurface, block: &Block, plane: &Plane) -> [f64; 2] {
    let of_views =
        (seen.views.iter()).map(|view| seen.within(view, &block.shade(seen, view, plane)));
    of_views.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

/// What speaks for a block and against it.
fn evidence_of(
    scene: &Scene,
    facet: &Facet,
    seen: &SeenSurface,
    block: &Block,
    nats: f64,
) -> Evidence {
    let [total, wide] =
        [*block, block.widened(RING_WIDTH_M)].map(|b| said_of(seen, &b, &facet.plane));
    let around = [wide[0] - total[0], wide[1] - total[1]];
    let outline: Polygon = block.outline().to_vec().into();
    let top = facet.plane.z_at(block.middle.x, block.middle.y) + block.height;
    let places: Vec<Point3<f64>> = (block.outline().iter())
        .map(|corner| nalgebra::center(corner, &block.middle))
        .chain([block.middle])
        .map(|p| Point3::new(p.x, p.y, top))
        .collect();
    EvidenceModel::of_obstructions().weigh(&[
        ("ln_nats", ln(nats)),
        ("nats_a_cell", total[0] / larger(total[1], 1.0)),
        ("nats_a_cell_around", around[0] / larger(around[1], 1.0)),
        ("height_m", block.height),
        ("ln_area_m2", ln(outline.area())),
        ("width_m", 2.0 * block.half[0].min(block.half[1])),
        ("inside_m", facet.plan().depth(&block.middle)),
        ("excess_green", excess_green(scene, &places)),
    ])
}

#[cfg(test)]
mod tests {
    use nalgebra::Point2;

    use super::*;
    use crate::planes::rendered_planes::{level_ground, scene, textured};
    use crate::roofs::testing;

    /// A level roof of 10 m by 8 m.
    fn facet() -> Facet {
        let corners = [(-5.0, -4.0), (5.0, -4.0), (5.0, 4.0), (-5.0, 4.0)];
        testing::facet(&corners.map(|(x, y)| Point3::new(x, y, 5.0)))
    }

    /// The roof, on which something stands at a height, in colours.
    fn roof_with(top: f64, machine: fn(f64, f64) -> bool) -> Scene {
        let mut scene = scene(&[
            textured(Plane::level(5.0 + top), machine),
            textured(Plane::level(5.0), |x, y| x.abs() < 5.0 && y.abs() < 4.0),
            level_ground(),
        ]);
        for view in &mut scene.views {
            let gray = &view.gray;
            view.rgb = image::RgbImage::from_fn(gray.width as u32, gray.height as u32, |x, y| {
                let value = 255.0 * gray.get(x as usize, y as usize);
                image::Rgb([value as u8; 3])
            });
        }
        scene
    }

    fn likeliest(scene: &Scene) -> Option<(Block, f64)> {
        let seen = SeenSurface::new(scene, &facet(), 0.1, &|_, _| false).unwrap();
        let (likely, _) = Block::likely(&seen, &facet().plane, Vector2::x());
        (likely.first()).map(|block| block.fitted(&seen, &facet().plane))
    }

    #[test]
    fn a_block_is_found_where_it_stands_as_high_as_it_is() {
        let machine = |x: f64, y: f64| (x - 1.0).abs() < 0.8 && (y + 0.5).abs() < 0.6;
        let roof = roof_with(1.0, machine);
        let (block, _) = likeliest(&roof).unwrap();
        assert!(
            (block.middle - Point2::new(1.0, -0.5)).norm() < 0.2,
            "{block:?}"
        );
        assert!((block.height - 1.0).abs() < 0.25, "{block:?}");
        let [along, across] = block.half;
        assert!(
            (along - 0.8).abs() < 0.2 && (across - 0.6).abs() < 0.2,
            "{block:?}"
        );

        let facets = vec![facet()];
        let mut model = RoofModel {
            facets,
            buildings: Vec::new(),
        };
        find_obstructions(&roof, &mut model);
        let [found] = &model.facets[0].obstructions[..] else {
            panic!("{:?}", model.facets[0].obstructions);
        };
        assert!((Polygon::from(found.outline.clone()).area() - 1.92).abs() < 0.8);
        assert!(found.height_sigma_m.unwrap() < 0.6 && found.probability > 0.5);
        // What is known to stand there is not found again.
        find_obstructions(&roof, &mut model);
        assert_eq!(model.facets[0].obstructions.len(), 1);
    }

    #[test]
    fn nothing_stands_on_a_bare_roof() {
        assert_eq!(likeliest(&roof_with(1.0, |_, _| false)), None);
    }

    #[test]
    fn too_few_views_say_nothing() {
        let mut roof = roof_with(1.0, |x, y| x.abs() < 0.8 && y.abs() < 0.6);
        roof.views.truncate(2);
        assert!(SeenSurface::new(&roof, &facet(), 0.1, &|_, _| false).is_none());
    }
}
