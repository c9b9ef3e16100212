//! 3D Tiles 1.1: `tileset.json`, of one tile whose content is the model, or of a tree of squares,
//! so that a viewer fetches what it shows.
//!
//! Content has y up and is turned to z up by whoever draws it; then it is in the local frame of the
//! scene. The transform of a tile places that on the Earth (EPSG:4978): the map from the frame to
//! the Earth, made linear in the middle of the tile. So the convergence of the meridians and the
//! scale of the grid are in it; what is left is the curvature, d^2 / 2R, 1 cm at 350 m from the
//! middle. Squares have transforms of their own, relative to that of the tile above them. Where the
//! place on the Earth is not known the transforms are left out, and `extras` says so.
//!
//! The tree is a quadtree: four squares of two by two, and so on; what has only one tile below it
//! is that tile. Only its leaves have content. A tile's geometric error is what is amiss where
//! nothing below it is drawn: all of it, the diagonal of its box. Invariant: a box holds the boxes
//! below it, so that errors fall towards the leaves.

use nalgebra::{Matrix3, Matrix4, Point3, Vector3};
use serde_json::{Value, json};

use super::format::{rounded, to_bytes};
use crate::base::geometry::bounds;
use crate::orienting::scene::Scene;
use crate::roofs::model::{Building, RoofModel};

/// Name of the file.
pub const TILESET_FILE: &str = "tileset.json";

/// Half the step of the differences that make the map linear, metres: curvature cancels, and
/// rounding (1e-9 m of 6.4e6 m) stays far below a millimetre.
const HALF_STEP_M: f64 = 50.0;

/// Half a side of the box around nothing, metres.
const LEAST_HALF_M: f64 = 0.5;

/// A part of a square of a grid, and the buildings that its content shows.
#[derive(Clone, Copy, Debug)]
pub struct SquareContent<'a> {
    /// Its column and row on the grid.
    pub place: [i64; 2],
    /// The buildings.
    pub buildings: &'a [Building],
    /// Where the content lies, seen from the tileset.
    pub uri: &'a str,
}

/// The tileset of a model, whose content lies beside it under this name.
pub(super) fn tileset(scene: &Scene, model: &RoofModel, content: &str) -> Vec<u8> {
    written(scene, Node::leaf(scene, &model.buildings, content))
}

/// The tileset of squares, each with some buildings and at its place; the local frame is that
/// of all.
pub fn tileset_of_squares(scene: &Scene, squares: &[SquareContent]) -> Vec<u8> {
    let from = [0, 1].map(|i| squares.iter().map(|s| s.place[i]).min().unwrap_or(0));
    let to = [0, 1].map(|i| squares.iter().map(|s| s.place[i]).max().unwrap_or(0));
    let extent = (to[0] - from[0]).max(to[1] - from[1]) + 1;
    let side = (extent as u64).next_power_of_two() as i64;
    let all: Vec<&SquareContent> = squares.iter().collect();
    let root = tree(scene, &all, from, side).unwrap_or_else(|| Node::leaf(scene, &[], ""));
    written(scene, root)
}

/// The tile of the squares in a block of the grid that begins at a place and has this side.
fn tree(scene: &Scene, squares: &[&SquareContent], [x, y]: [i64; 2], side: i64) -> Option<Node> {
    let leaf = |square: &&SquareContent| Node::leaf(scene, square.buildings, square.uri);
    match (side, squares) {
        (_, []) => return None,
        (1, [square]) => return Some(leaf(square)),
        (1, _) => return Some(Node::above(scene, squares.iter().map(leaf).collect())),
        _ => {}
    }
    let half = side / 2;
    let quarters = [[x, y], [x + half, y], [x, y + half], [x + half, y + half]];
    let below = quarters.into_iter().filter_map(|[x, y]| {
        let is_in = |square: &&&SquareContent| {
            let [column, row] = square.place;
            (x..x + half).contains(&column) && (y..y + half).contains(&row)
        };
        let inside: Vec<&SquareContent> = squares.iter().filter(is_in).copied().collect();
        (!inside.is_empty()).then(|| tree(scene, &inside, [x, y], half))?
    });
    let mut below: Vec<Node> = below.collect();
    match below.len() {
        0 => None,
        1 => below.pop(),
        _ => Some(Node::above(scene, below)),
    }
}

/// A tile with those below it.
struct Node {
    /// Middle of its box, local frame of the scene.
    middle: Point3<f64>,
    /// From the local frame to the Earth, exact in the middle; `None` where that is not known.
    placement: Option<Matrix4<f64>>,
    /// Middle and half the sides of its box, in the frame that the placement places.
    box_middle: Point3<f64>,
    half: Vector3<f64>,
    /// Its tile, without a transform.
    tile: Value,
}

impl Node {
    /// A tile that is drawn. Of no buildings it has no content.
    fn leaf(scene: &Scene, buildings: &[Building], content: &str) -> Self {
        let corners = || buildings.iter().flat_map(|b| &b.solid.vertices);
        let is_empty = corners().next().is_none();
        let [low, high] = match is_empty {
            true => [Point3::origin(); 2],
            false => bounds(corners().copied()),
        };
        let middle = nalgebra::center(&low, &high);
        let mut node = Self::of_box(middle, placement(scene, &middle), [low, high]);
        if !is_empty {
            node.tile["content"] = json!({ "uri": content });
        }
        node
    }

    /// A tile around others.
    fn above(scene: &Scene, below: Vec<Self>) -> Self {
        let [low, high] = bounds(below.iter().map(|node| node.middle));
        let middle = nalgebra::center(&low, &high);
        let placed = placement(scene, &middle);
        let moves: Vec<Option<Matrix4<f64>>> = (below.iter())
            .map(|node| Some(placed?.try_inverse()? * node.placement?))
            .collect();
        let corners = below.iter().zip(&moves).flat_map(|(node, by)| {
            let moved = move |p: Point3<f64>| by.map_or(p, |by| by.transform_point(&p));
            node.corners().map(moved)
        });
        let mut node = Self::of_box(middle, placed, bounds(corners));
        node.tile["geometricError"] = json!(node.diagonal());
        let children: Vec<Value> = (below.into_iter().zip(moves))
            .map(|(node, by)| node.placed(by))
            .collect();
        node.tile["children"] = json!(children);
        node
    }

    fn of_box(
        middle: Point3<f64>,
        placement: Option<Matrix4<f64>>,
        [low, high]: [Point3<f64>; 2],
    ) -> Self {
        let box_middle = nalgebra::center(&low, &high);
        let half = ((high - low) / 2.0).map(|h| h.max(LEAST_HALF_M));
        let tile = json!({
            "boundingVolume": { "box": [
                box_middle.x, box_middle.y, box_middle.z,
                half.x, 0.0, 0.0,
                0.0, half.y, 0.0,
                0.0, 0.0, half.z,
            ] },
            "geometricError": 0.0,
        });
        Self {
            middle,
            placement,
            box_middle,
            half,
            tile,
        }
    }

    /// The corners of its box.
    fn corners(&self) -> [Point3<f64>; 8] {
        std::array::from_fn(|i| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let signs = Vector3::new(sign(0), sign(1), sign(2));
            self.box_middle + self.half.component_mul(&signs)
        })
    }

    /// What is amiss where nothing of it is drawn, metres: all of it.
    fn diagonal(&self) -> f64 {
        rounded(2.0 * self.half.norm(), 3)
    }

    /// Its tile with a transform.
    fn placed(mut self, transform: Option<Matrix4<f64>>) -> Value {
        if let Some(transform) = transform {
            self.tile["transform"] = json!(transform.as_slice());
        }
        self.tile
    }
}

/// A tileset as a file.
fn written(scene: &Scene, root: Node) -> Vec<u8> {
    let mut extras = json!({ "origin": scene.origin.as_slice() });
    if let Some(system) = scene.survey.describe() {
        extras["crs"] = json!(system);
    }
    if root.placement.is_none() {
        extras["placement"] = json!("none: the place on the Earth is not known");
    } else if scene.survey.anchor.is_none() {
        extras["heights"] = json!("those of the grid, taken as ellipsoidal");
    }
    let (error, placement) = (root.diagonal(), root.placement);
    let mut root = root.placed(placement);
    root["refine"] = json!("REPLACE");
    to_bytes(&json!({
        "asset": { "version": "1.1" },
        "geometricError": error,
        "root": root,
        "extras": extras,
    }))
}

/// The matrix from the local frame to geocentric coordinates.
fn placement(scene: &Scene, middle: &Point3<f64>) -> Option<Matrix4<f64>> {
    let on_earth = |p: Point3<f64>| scene.survey.geocentric(&(p + scene.origin));
    let column = |axis: Vector3<f64>| {
        let ends = [HALF_STEP_M, -HALF_STEP_M].map(|step| on_earth(middle + axis * step));
        let [Some(a), Some(b)] = ends else {
            return None;
        };
        Some((a - b) / (2.0 * HALF_STEP_M))
    };
    let axes = Matrix3::from_columns(&[
        column(Vector3::x())?,
        column(Vector3::y())?,
        column(Vector3::z())?,
    ]);
    let zero = on_earth(*middle)? - axes * middle.coords;
    let mut placed = axes.to_homogeneous();
    placed.fixed_view_mut::<3, 1>(0, 3).copy_from(&zero.coords);
    // What is off the Earth (a wrong code) has no place there.
    placed.iter().all(|n| n.is_finite()).then_some(placed)
}
