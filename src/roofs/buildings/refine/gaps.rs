//! Gaps between facets that delineation has closed.
//!
//! An alley between two houses is hardly wider than a correlation window, dark, and without a
//! border line at its far side, so that the lower roof is delineated up to the wall of the higher
//! one. Rows of grey values along the wall, one for each distance from it, show where the views
//! cease to agree on the roof's plane. The roof is cut back to there when this lowers the energy of
//! the labelling, with rows in the place of windows.

use nalgebra::{Point2, Vector2};
use serde::Serialize;

use super::edge_observations::{aligned_runs, pixel};
use super::profiles::{CutBackGain, Extent, SideProfiles};
use super::wireframe::{SideKind, Wireframe, WireframeState};
use crate::base::geometry::{Segment3, signed_area};
use crate::base::params::RoofParams;
use crate::orienting::scene::Scene;
use crate::roofs::model::{Facet, Occluders, RoofModel, is_simple};

/// A facet that ends before the neighbour up to which it was delineated.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct RoofGap {
    /// Its delineated side, metres.
    pub side: Segment3,
    /// Width of the gap in plan, metres.
    pub width_m: f64,
    /// Energy of the labelling gained by the cut, nats.
    pub gain_nats: f64,
}

/// The facets of a closed model, cut back where they end before a higher or lower neighbour; the
/// result has to be closed again.
pub fn cut_back_at_gaps(
    scene: &Scene,
    model: &RoofModel,
    params: &RoofParams,
) -> (Vec<Facet>, Vec<RoofGap>) {
    let mut facets = model.facets.clone();
    let mut gaps = Vec::new();
    if !params.refine.refine {
        return (facets, gaps);
    }
    let occluders = Occluders::new(&model.facets);
    for building in &model.buildings {
        let members: Vec<&Facet> = building
            .facets
            .iter()
            .map(|f| &model.facets[f.index()])
            .collect();
        let (wireframe, state) = Wireframe::new(&members);
        let cut_backs = cut_backs(scene, &occluders, &wireframe, &state, params);
        for (face, id) in building.facets.iter().enumerate() {
            let of_face = |cut: &&CutBack| wireframe.sides[cut.side].face == face;
            let of_facet = cut_backs.iter().filter(of_face).collect();
            let Some((ring, own)) = apply_cut_backs(&wireframe, &state, face, of_facet) else {
                continue;
            };
            let facet = &mut facets[id.index()];
            let plane = facet.plane;
            facet.outer = ring
                .into_iter()
                .map(|(p, old)| {
                    old.map_or_else(|| plane.lift(p.x, p.y), |i| members[face].outer[i])
                })
                .collect();
            gaps.extend(own.into_iter().map(|cut| RoofGap {
                side: wireframe.segment(&state, &wireframe.sides[cut.side]),
                width_m: cut.width_m,
                gain_nats: cut.gain_nats,
            }));
        }
    }
    (facets, gaps)
}

/// Gains of cutting a facet back from a side where it meets a wall.
struct WallSideGains {
    /// By steps back from the side.
    gain: Vec<CutBackGain>,
    step_m: f64,
}

/// A side that moves back.
struct CutBack {
    side: usize,
    width_m: f64,
    gain_nats: f64,
}

/// The sides at walls whose cut lowers the energy; collinear sides are decided together.
fn cut_backs(
    scene: &Scene,
    occluders: &Occluders,
    wireframe: &Wireframe,
    state: &WireframeState,
    params: &RoofParams,
) -> Vec<CutBack> {
    let at_wall = |kind| matches!(kind, SideKind::Step | SideKind::Foot);
    let pixel_m = pixel(scene, wireframe, state);
    let side_gains = crate::base::execution::map(&wireframe.sides, |_, side| {
        let extent = Extent {
            seen_m: params.refine.part_m,
            compared_m: params.refine.part_m,
            pixel_m,
        };
        at_wall(side.kind).then_some(())?;
        let profiles = SideProfiles::new(
            scene,
            occluders,
            wireframe,
            state,
            side,
            extent,
            &params.refine,
        )?;
        Some(WallSideGains {
            gain: profiles.cut_back_gains(params)?,
            step_m: profiles.step_m(),
        })
    });
    let mut cut_backs = Vec::new();
    for run in aligned_runs(wireframe, state, params.refine.jog_m, at_wall) {
        let measured: Vec<_> = (run.iter())
            .filter_map(|&i| Some((i, side_gains[i].as_ref()?)))
            .collect();
        let Some(steps) = measured.iter().map(|(_, w)| w.gain.len()).min() else {
            continue;
        };
        // Steps back from the side.
        let sum = |of: fn(&CutBackGain) -> f64, back: usize| -> f64 {
            measured.iter().map(|(_, w)| of(&w.gain[back])).sum()
        };
        let gain = |back: usize| sum(|w| w.nats, back);
        let step_m = measured[0].1.step_m;
        let first = (params.refine.least_part_m / step_m).ceil() as usize;
        let best = (first..steps).max_by(|&i, &j| gain(i).total_cmp(&gain(j)).then(j.cmp(&i)));
        // Without agreement on what remains the views say nothing about this plane.
        let clear = |&b: &usize| gain(b) > 0.0 && sum(|w| w.remaining_nats, b) > 0.0;
        let Some(back) = best.filter(clear) else {
            continue;
        };
        cut_backs.extend(measured.iter().map(|&(side, _)| CutBack {
            side,
            width_m: (back + 1) as f64 * step_m,
            gain_nats: gain(back),
        }));
    }
    cut_backs
}

/// A corner of a ring that was cut back, and which one it was where it has stayed.
type CutBackCorner = (Point2<f64>, Option<usize>);

/// The outer ring of a facet after its feasible cuts, the largest gain first; and these cuts.
fn apply_cut_backs<'c>(
    wireframe: &Wireframe,
    state: &WireframeState,
    face: usize,
    mut cut_backs: Vec<&'c CutBack>,
) -> Option<(Vec<CutBackCorner>, Vec<&'c CutBack>)> {
    cut_backs.sort_by(|a, b| {
        b.gain_nats
            .total_cmp(&a.gain_nats)
            .then(a.side.cmp(&b.side))
    });
    let (mut ring, mut taken) = (None, Vec::new());
    for cut in cut_backs {
        taken.push(cut);
        match cut_back(wireframe, state, face, &taken) {
            Some(smaller) => ring = Some(smaller),
            None => drop(taken.pop()),
        }
    }
    ring.map(|ring| (ring, taken))
}

/// The outer ring of a facet with some sides moved back. `None` when nothing moves, too little is
/// left, or what is left is no facet.
fn cut_back(
    wireframe: &Wireframe,
    state: &WireframeState,
    face: usize,
    cut_backs: &[&CutBack],
) -> Option<Vec<CutBackCorner>> {
    let ring = &wireframe.faces[face][0];
    let n = ring.len();
    let mut offsets = vec![0.0; n];
    for cut in cut_backs {
        let [first, last] = wireframe.sides[cut.side].ends;
        let mut i = ring.iter().position(|&v| v == first)?;
        while ring[i] != last {
            offsets[i] = cut.width_m;
            i = (i + 1) % n;
        }
    }
    if offsets.iter().all(|&s| s == 0.0) {
        return None;
    }
    let at = |i: usize| wireframe.position(state, ring[i % n]);
    let mut lines: Vec<RingLine> = Vec::with_capacity(n + 2);
    for i in 0..n {
        let (before, p, after) = (at(i + n - 1), at(i), at(i + 1));
        let [u, v] = [p - before, after - p].map(|d| Vector2::new(d.y, -d.x).normalize());
        let (s, t) = (offsets[(i + n - 1) % n], offsets[i]);
        // Where only a part of a straight side moves, a short side across joins both.
        if u.perp(&v).abs() <= CORNER_SINE && s != t {
            lines.push(RingLine {
                through: p,
                along: if s > t { u } else { -u },
                corner: None,
            });
        }
        lines.push(RingLine {
            through: p - v * t,
            along: (after - p).normalize(),
            corner: (t == 0.0).then_some(i),
        });
    }
    let moved = corners(lines, &at, n)?;
    let new: Vec<Point2<f64>> = moved.iter().map(|m| m.0).collect();
    let old = (0..n).map(at);
    let is_enough = signed_area(new.iter().copied()) > LEAST_LEFT * signed_area(old);
    (is_enough && is_simple(&new)).then_some(moved)
}

/// Sides at less than this sine (15 degrees) go on into each other.
const CORNER_SINE: f64 = 0.25;
/// Least share of a facet's area that is left of it.
const LEAST_LEFT: f64 = 0.3;

/// A side of a ring on its way to be cut back.
#[derive(Clone, Copy)]
struct RingLine {
    through: Point2<f64>,
    along: Vector2<f64>,
    /// Its first corner in the old ring, if it has not moved.
    corner: Option<usize>,
}

/// The corners between consecutive lines. Sides that would run backwards are left out: what they
/// bounded is gone.
fn corners(
    mut lines: Vec<RingLine>,
    at: &impl Fn(usize) -> Point2<f64>,
    n: usize,
) -> Option<Vec<CutBackCorner>> {
    loop {
        let m = lines.len();
        if m < 3 {
            return None;
        }
        // The last corner of a line and the first of the next: one, but for lines that go on side
        // by side.
        let joint = |i: usize| -> [CutBackCorner; 2] {
            let (a, b) = (&lines[(i + m - 1) % m], &lines[i % m]);
            let one = |corner: CutBackCorner| [corner, corner];
            if let (Some(i), Some(j)) = (a.corner, b.corner)
                && (i + 1) % n == j
            {
                return one((at(j), Some(j)));
            }
            let sine = a.along.perp(&b.along);
            if sine.abs() > CORNER_SINE {
                let t = (b.through - a.through).perp(&b.along) / sine;
                return one((a.through + a.along * t, None));
            }
            let foot = a.through + a.along * (b.through - a.through).dot(&a.along);
            [(foot, None), (b.through, None)]
        };
        let joints: Vec<[CutBackCorner; 2]> = (0..m).map(joint).collect();
        let backwards =
            |&i: &usize| (joints[(i + 1) % m][0].0 - joints[i][1].0).dot(&lines[i].along) < 0.0;
        if let Some(i) = (0..m).find(backwards) {
            lines.remove(i);
            continue;
        }
        let mut ring: Vec<CutBackCorner> = Vec::with_capacity(m + 2);
        for corner in joints.into_iter().flatten() {
            if ring
                .last()
                .is_none_or(|last| (last.0 - corner.0).norm() > 1e-6)
            {
                ring.push(corner);
            }
        }
        return Some(ring);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::row_scene;
    use crate::roofs::solids::close_buildings;
    use crate::roofs::testing::facet;
    use nalgebra::Point3;

    #[test]
    fn roofs_that_were_drawn_over_a_gap_are_cut_back() {
        // Two gables in line, 3 m apart, both drawn up to a wall 1.2 m from the first; the second
        // stands half a metre too high.
        let (scene, truth) = row_scene(320);
        let rings: Vec<&Vec<Point3<f64>>> = truth.facets.iter().map(|f| &f.1).collect();
        let drawn = |ring: usize, other: usize, share: f64, lift: f64| {
            let corner = |p: &Point3<f64>| {
                let across = rings[other].iter().find(|q| (*q - p).norm() < 3.5);
                let at = across.map_or(*p, |q| p + (q - p) * share);
                Point3::new(at.x, at.y, at.z + lift)
            };
            facet(&rings[ring].iter().map(corner).collect::<Vec<_>>())
        };
        let facets = [
            drawn(0, 2, 0.4, 0.0),
            drawn(1, 3, 0.4, 0.0),
            drawn(2, 0, 0.6, 0.5),
            drawn(3, 1, 0.6, 0.5),
        ];
        let (model, _) = close_buildings(&facets, |_| truth.ground_z);
        assert_eq!(model.buildings.len(), 1);
        let (parted, gaps) = cut_back_at_gaps(&scene, &model, &RoofParams::default());
        let first: Vec<f64> = (gaps.iter().map(|p| p.width_m))
            .filter(|w| (w - 1.2).abs() < 0.2)
            .collect();
        assert_eq!(first.len(), 2, "{gaps:?}");
        // The first house is back where it was: the cut goes into the roof, not beyond the wall.
        let corners: Vec<&Point3<f64>> = parted.iter().flat_map(|f| &f.outer).collect();
        for p in rings[0].iter().chain(rings[1]) {
            assert!(corners.iter().any(|q| (p - *q).norm() < 0.25), "{p}");
        }
        let (closed, _) = close_buildings(&parted, |_| truth.ground_z);
        assert_eq!(closed.buildings.len(), 2);
    }
}
