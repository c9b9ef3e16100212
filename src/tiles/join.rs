//! The parts of all cells as one.

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::{Point2, Point3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use super::atlases::AtlasPlaces;
use super::fields;
use super::model_parts::{append, middle, walls_of};
use super::tile::Cell;
use crate::base::evidence::Candidates;
use crate::base::geometry::{Polygon, Segment2};
use crate::base::ids::{HalfPlaneId, LineId, ViewId};
use crate::base::params::TextureParams;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::photographs::raster::colours_of_blocks;
use crate::planes::half_planes::HalfPlane;
use crate::results::export::{
    ExportInput, SquareContent, TILESET_FILE, atlas_jpeg, export_all, glb_of, tileset_of_squares,
};
use crate::results::texture::{FaceTexture, TexturedModel};
use crate::roofs::model::{Building, BuildingWalls, RoofModel, Surface};

/// Two buildings that share more of the smaller one's footprint are the same building, found in two
/// cells.
const SAME_BUILDING: f64 = 0.2;

/// What was found in a cell.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CellPart {
    /// The cell.
    pub cell: Cell,
    /// Origin of its local frame.
    pub origin: Vector3<f64>,
    /// Of each of its views: the view of the whole scene, and column, row, width and height of its
    /// part, pixels.
    pub views: Vec<(ViewId, [f64; 4])>,
    /// Image segments of each of its views.
    pub segments: Vec<Vec<ImageSegment>>,
    /// 3D lines.
    pub lines: Vec<Line3d>,
    /// Half-planes at these.
    pub half_planes: Vec<HalfPlane>,
    /// The lines and facets that were weighed.
    #[serde(with = "fields::candidates")]
    pub candidates: Candidates,
    /// The buildings that it may be responsible for.
    pub model: RoofModel,
    /// For each of them where its walls stand.
    pub walls: Vec<BuildingWalls>,
    /// Their textures.
    #[serde(with = "fields::textured")]
    pub textured: TexturedModel,
}

/// One model of all cells.
#[derive(Clone, Debug)]
pub struct Joined {
    /// Names and cameras of the whole images, without pixels.
    pub scene: Scene,
    /// Image segments of each view, each stretch of an image once.
    pub segments: Vec<Vec<ImageSegment>>,
    /// 3D lines of the cores, and those that kept facets refer to.
    pub lines: Vec<Line3d>,
    /// Half-planes at these.
    pub half_planes: Vec<HalfPlane>,
    /// The lines and facets of the cores that were weighed.
    pub candidates: Candidates,
    /// All buildings.
    pub model: RoofModel,
    /// For each of them where its walls stand.
    pub walls: Vec<BuildingWalls>,
    /// Their textures, in one atlas.
    pub textured: TexturedModel,
    /// The cells that have buildings in it, and which: by their part, and in the order of both.
    chosen: Vec<Chosen>,
}

/// What is taken of a part.
#[derive(Clone, Debug)]
struct Chosen {
    /// The index of the part.
    part: usize,
    /// Its buildings, by their indices in the part.
    buildings: Vec<usize>,
    /// The same, by their indices in the joined model.
    joined: Range<usize>,
}

impl Joined {
    /// The files of the model, but for the report: name and bytes.
    pub fn files(&self, params: &TextureParams) -> Vec<(String, Vec<u8>)> {
        let Self {
            scene,
            segments,
            lines,
            half_planes,
            candidates,
            model,
            walls,
            textured,
            chosen: _,
        } = self;
        export_all(
            &ExportInput {
                scene,
                segments,
                lines,
                half_planes,
                candidates,
                model,
                walls,
                textured,
            },
            params,
        )
    }

    /// How many squares have buildings.
    pub(super) fn squares_with_buildings(&self) -> usize {
        self.chosen.len()
    }

    /// The model of each square as a file by itself (glTF, in the frame of the whole) with its own
    /// textures, and the tileset that names them. `parts` are those that were joined.
    pub(super) fn squares(&self, parts: &[CellPart], quality: u8) -> Vec<(String, Vec<u8>)> {
        let mut files = Vec::new();
        let mut squares = Vec::new();
        for Chosen {
            part,
            buildings,
            joined,
        } in &self.chosen
        {
            let (part, place) = (&parts[*part], parts[*part].cell.place());
            let same = squares.iter().filter(|(other, _)| *other == place).count();
            let faces: Vec<Vec<FaceTexture>> = (buildings.iter())
                .map(|&b| part.textured.faces[b].clone())
                .collect();
            let atlas = atlas_jpeg(&part.textured, quality);
            let textures = (&faces[..], &atlas[..]);
            let model = glb_of(&self.scene, &self.model, joined.clone(), textures);
            let name = match same {
                0 => format!("square_{}_{}.glb", place[0], place[1]),
                n => format!("square_{}_{}_{}.glb", place[0], place[1], n + 1),
            };
            files.push((name, model));
            squares.push((place, joined.clone()));
        }
        let contents: Vec<SquareContent> = (squares.into_iter().zip(&files))
            .map(|((place, joined), (uri, _))| SquareContent {
                place,
                buildings: &self.model.buildings[joined],
                uri,
            })
            .collect();
        let tileset = tileset_of_squares(&self.scene, &contents);
        files.push((TILESET_FILE.to_owned(), tileset));
        files
    }
}

/// Joins the parts of the cells of an area; `scene` has the views of all of them.
pub fn join(scene: Scene, parts: &[CellPart]) -> Joined {
    let mut joined = Joined {
        segments: vec![Vec::new(); scene.views.len()],
        scene,
        lines: Vec::new(),
        half_planes: Vec::new(),
        candidates: Candidates::default(),
        model: RoofModel::default(),
        walls: Vec::new(),
        textured: TexturedModel {
            atlas: image::RgbImage::new(0, 0),
            faces: Vec::new(),
        },
        chosen: Vec::new(),
    };
    let chosen = choose(parts);
    let mut covered: Vec<Vec<[f64; 4]>> = vec![Vec::new(); joined.scene.views.len()];
    let AtlasPlaces {
        reduction, corners, ..
    } = join_atlases(parts, &chosen, &mut joined.textured);
    for (i, (buildings, corner)) in chosen.into_iter().zip(corners).enumerate() {
        let part = &parts[i];
        join_segments(part, &mut joined.segments, &mut covered);
        let is_own = |p: &Point3<f64>| owns(parts, i, &(p.xy() + part.origin.xy()));
        let ids = join_lines(part, &buildings, is_own, &mut joined);
        let first = joined.model.buildings.len();
        join_buildings(part, &buildings, &ids, (reduction, corner), &mut joined);
        join_candidates(part, is_own, &mut joined);
        if !buildings.is_empty() {
            joined.chosen.push(Chosen {
                part: i,
                buildings,
                joined: first..joined.model.buildings.len(),
            });
        }
    }
    joined
}

/// Is a place of the world that of a part? It is of the one in whose core it lies deepest.
fn owns(parts: &[CellPart], index: usize, p: &Point2<f64>) -> bool {
    let depth = parts[index].cell.depth(p);
    let mut others = parts.iter().enumerate().filter(|(i, _)| *i != index);
    depth >= 0.0
        && others.all(|(i, other)| {
            let of_other = other.cell.depth(p);
            of_other < depth || (of_other == depth && index < i)
        })
}

/// For each part, the buildings to take: each building once, from the cell in whose core its middle
/// lies deepest.
fn choose(parts: &[CellPart]) -> Vec<Vec<usize>> {
    let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
    for (p, part) in parts.iter().enumerate() {
        for (b, building) in part.model.buildings.iter().enumerate() {
            let depth = part.cell.depth(&(middle(building) + part.origin.xy()));
            candidates.push((depth, p, b));
        }
    }
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut taken: Vec<(usize, usize)> = Vec::new();
    for (_, p, b) in candidates {
        let building = |(p, b): (usize, usize)| (&parts[p].model.buildings[b], parts[p].origin);
        let is_same =
            |&other: &(usize, usize)| other.0 != p && are_same(building(other), building((p, b)));
        if !taken.iter().any(is_same) {
            taken.push((p, b));
        }
    }
    let of_part = |p: usize| {
        let mut own: Vec<usize> = taken.iter().filter(|t| t.0 == p).map(|t| t.1).collect();
        own.sort_unstable();
        own
    };
    (0..parts.len()).map(of_part).collect()
}

/// Do the footprints of two buildings (and the origins of their frames) cover each other?
fn are_same(a: (&Building, Vector3<f64>), b: (&Building, Vector3<f64>)) -> bool {
    let by = a.1 - b.1;
    let (a, b) = (footprint(a.0, &Vector3::zeros()), footprint(b.0, &by));
    let size = |polygon: &Polygon| polygon.signed_area().abs();
    size(&a.and(&b)) > SAME_BUILDING * size(&a).min(size(&b))
}

/// The ground rings of a building in plan, in a frame whose origin lies `by` further; outer rings
/// and holes run opposite ways.
fn footprint(building: &Building, by: &Vector3<f64>) -> Polygon {
    let solid = &building.solid;
    let corner = |&i: &u32| (solid.vertices[i as usize] - by).xy();
    let grounds = solid.faces.iter().filter(|f| f.surface == Surface::Ground);
    let rings = grounds.flat_map(|f| &f.rings);
    Polygon {
        rings: rings
            .map(|ring| ring.iter().map(corner).collect())
            .collect(),
    }
}

/// Puts the atlases of the parts that have buildings into one.
fn join_atlases(parts: &[CellPart], chosen: &[Vec<usize>], to: &mut TexturedModel) -> AtlasPlaces {
    let size = |(part, buildings): (&CellPart, &Vec<usize>)| match buildings.is_empty() {
        true => [0, 0],
        false => part.textured.atlas.dimensions().into(),
    };
    let sizes: Vec<[u32; 2]> = parts.iter().zip(chosen).map(size).collect();
    let places = AtlasPlaces::of(&sizes);
    to.atlas = image::RgbImage::new(places.size[0], places.size[1]);
    for ((part, _), [x, y]) in
        (parts.iter().zip(&sizes).zip(&places.corners)).filter(|((_, size), _)| **size != [0, 0])
    {
        let atlas = match places.reduction {
            1 => Cow::Borrowed(&part.textured.atlas),
            reduction => Cow::Owned(colours_of_blocks(&part.textured.atlas, reduction)),
        };
        image::imageops::replace(&mut to.atlas, &*atlas, i64::from(*x), i64::from(*y));
    }
    places
}

/// Adds the segments of the stretches of images that no earlier part has shown.
fn join_segments(part: &CellPart, to: &mut [Vec<ImageSegment>], covered: &mut [Vec<[f64; 4]>]) {
    for (&(view, place), segments) in part.views.iter().zip(&part.segments) {
        let seen = &mut covered[view.index()];
        for segment in segments {
            let mut moved = segment.clone();
            moved.segment = shifted(&segment.segment, &place);
            let m = moved.segment.midpoint();
            let inside =
                |[x, y, w, h]: &[f64; 4]| m.x >= *x && m.y >= *y && m.x < x + w && m.y < y + h;
            if !seen.iter().any(inside) {
                to[view.index()].push(moved);
            }
        }
        seen.push(place);
    }
}

fn shifted(segment: &Segment2, [x, y, ..]: &[f64; 4]) -> Segment2 {
    let by = Vector2::new(*x, *y);
    Segment2::new(segment.p0 + by, segment.p1 + by)
}

/// New ids of lines and half-planes; `None` for those that are left out.
struct NewIds {
    lines: Vec<Option<LineId>>,
    half_planes: Vec<Option<HalfPlaneId>>,
}

fn join_lines(
    part: &CellPart,
    buildings: &[usize],
    is_own: impl Fn(&Point3<f64>) -> bool,
    joined: &mut Joined,
) -> NewIds {
    let by = joined.scene.origin - part.origin;
    let facets = buildings
        .iter()
        .flat_map(|&b| &part.model.buildings[b].facets);
    let mut needed = vec![false; part.lines.len()];
    for line in facets.flat_map(|f| &part.model.facets[f.index()].lines) {
        needed[line.index()] = true;
    }
    let mut ids = NewIds {
        lines: vec![None; part.lines.len()],
        half_planes: Vec::new(),
    };
    for (i, line) in part.lines.iter().enumerate() {
        if !(needed[i] || is_own(&line.at(0.5))) {
            continue;
        }
        ids.lines[i] = Some(LineId::from_index(joined.lines.len()));
        let mut line = line.clone();
        line.segment.p0 -= by;
        line.segment.p1 -= by;
        for support in &mut line.supports {
            let (view, place) = part.views[support.view.index()];
            support.view = view;
            support.stretch = shifted(&support.stretch, &place);
            // They count the segments of the part.
            support.segments.clear();
            support.edge = None;
        }
        joined.lines.push(line);
    }
    for half_plane in &part.half_planes {
        let line = ids.lines[half_plane.line.index()];
        ids.half_planes
            .push(line.map(|_| HalfPlaneId::from_index(joined.half_planes.len())));
        if let Some(line) = line {
            let views = half_plane
                .views
                .iter()
                .map(|v| part.views[v.index()].0)
                .collect();
            let plane = half_plane.plane.relative_to(&by);
            joined.half_planes.push(HalfPlane {
                line,
                views,
                plane,
                ..half_plane.clone()
            });
        }
    }
    ids
}

/// Adds the candidates at the places of a part.
fn join_candidates(part: &CellPart, is_own: impl Fn(&Point3<f64>) -> bool, joined: &mut Joined) {
    let by = joined.scene.origin - part.origin;
    let moved = part.candidates.moved(&by, is_own);
    joined.candidates.lines.extend(moved.lines);
    joined.candidates.facets.extend(moved.facets);
}

fn join_buildings(
    part: &CellPart,
    buildings: &[usize],
    ids: &NewIds,
    (reduction, [left, top]): (u32, [u32; 2]),
    joined: &mut Joined,
) {
    let mut model = (part.model.clone()).relative_to(&(joined.scene.origin - part.origin));
    for facet in &mut model.facets {
        facet.lines = facet
            .lines
            .iter()
            .filter_map(|l| ids.lines[l.index()])
            .collect();
        facet.half_planes = facet
            .half_planes
            .iter()
            .filter_map(|h| ids.half_planes[h.index()])
            .collect();
    }
    let (old, new) = (
        part.textured.atlas.dimensions(),
        joined.textured.atlas.dimensions(),
    );
    let old = [old.0, old.1].map(|side| side as f32 / reduction as f32);
    let place = |uv: &mut [f32; 2]| {
        uv[0] = (left as f32 + uv[0] * old[0]) / new.0 as f32;
        uv[1] = (top as f32 + uv[1] * old[1]) / new.1 as f32;
    };
    for &b in buildings {
        append(&mut joined.model, &model, b);
        let joint = joined.model.buildings.last().expect("one was appended");
        let (own, by) = (&part.model.buildings[b], joined.scene.origin - part.origin);
        let walls = part.walls.get(b);
        let walls = walls.map(|walls| walls_of(walls, own, joint, &by));
        joined.walls.push(walls.unwrap_or_default());
        let mut faces = part.textured.faces[b].clone();
        for face in &mut faces {
            face.uv.iter_mut().flatten().for_each(place);
            face.view = face.view.map(|v| part.views[v.index()].0);
        }
        joined.textured.faces.push(faces);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::texture::FaceTexture;
    use crate::roofs::model::check_invariants;
    use crate::tiles::fixture::house;

    fn part(cell: Cell, origin: [f64; 3], houses: &[[f64; 2]]) -> CellPart {
        let origin = Vector3::from(origin);
        let mut model = RoofModel::default();
        for h in houses {
            append(&mut model, &house([h[0] - origin.x, h[1] - origin.y]), 0);
        }
        let uv = |b: &Building| {
            let faces = b.solid.faces.iter();
            faces
                .map(|f| FaceTexture {
                    view: None,
                    uv: f.rings.iter().map(|r| vec![[0.5, 0.5]; r.len()]).collect(),
                })
                .collect()
        };
        let faces = model.buildings.iter().map(uv).collect();
        // Walls below the rim: a solid like that of the building.
        let walls = |b: &Building| BuildingWalls {
            solid: Some(b.solid.clone()),
            ..BuildingWalls::default()
        };
        let walls = model.buildings.iter().map(walls).collect();
        let textured = TexturedModel {
            atlas: image::RgbImage::new(8, 4),
            faces,
        };
        CellPart {
            cell,
            origin,
            views: Vec::new(),
            segments: Vec::new(),
            lines: Vec::new(),
            half_planes: Vec::new(),
            candidates: Candidates::default(),
            model,
            walls,
            textured,
        }
    }

    #[test]
    fn a_house_on_the_seam_is_taken_once() {
        let tiles = crate::tiles::plan_tiles([0.0, 0.0, 120.0, 50.0], 60.0).unwrap();
        // One house in each core; one on the seam at x = 60, seen a little differently from both
        // sides.
        let west = part(tiles[0].cells[0], [0.0; 3], &[[20.0, 20.0], [59.9, 25.0]]);
        let east = part(
            tiles[1].cells[0],
            [100.0, 0.0, 5.0],
            &[[60.2, 25.0], [80.0, 20.0]],
        );
        let parts = [west, east];
        let joined = join(Scene::default(), &parts);
        assert_eq!(joined.model.buildings.len(), 3);
        for (building, walls) in joined.model.buildings.iter().zip(&joined.walls) {
            assert_eq!(walls.solid.as_ref(), Some(&building.solid));
        }
        assert_eq!(check_invariants(&joined.model), []);
        let mut middles: Vec<i64> = joined
            .model
            .buildings
            .iter()
            .map(|b| (middle(b).x * 10.0).round() as i64)
            .collect();
        middles.sort_unstable();
        assert_eq!(middles, [200, 602, 800]);
        // Heights follow the frame: the eastern cell's zero is 5 m higher.
        let lowest = |b: &Building| {
            b.solid
                .vertices
                .iter()
                .map(|p| p.z)
                .fold(f64::INFINITY, f64::min)
        };
        assert!(
            joined
                .model
                .buildings
                .iter()
                .all(|b| lowest(b) == b.ground_z)
        );
        assert_eq!(
            joined
                .model
                .buildings
                .iter()
                .filter(|b| b.ground_z == 5.0)
                .count(),
            2
        );
        // The second atlas lies below the first.
        assert_eq!(joined.textured.atlas.dimensions(), (8, 8));
        let v: Vec<f32> = joined
            .textured
            .faces
            .iter()
            .map(|faces| faces[0].uv[0][0][1])
            .collect();
        assert_eq!(v, [0.25, 0.75, 0.75]);
        // Each square is a file whose buildings have the numbers of the whole.
        let files = joined.squares(&parts, 80);
        let names: Vec<&str> = files.iter().map(|(name, _)| &**name).collect();
        assert_eq!(names, ["square_0_0.glb", "square_1_0.glb", "tileset.json"]);
        let numbers = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes);
            let named = |i: &usize| text.contains(&format!("\"building\":{i}"));
            (1..=3).filter(named).collect::<Vec<usize>>()
        };
        assert_eq!(numbers(&files[0].1), [1]);
        assert_eq!(numbers(&files[1].1), [2, 3]);
        let tileset: serde_json::Value = serde_json::from_slice(&files[2].1).unwrap();
        let children = tileset["root"]["children"].as_array().unwrap();
        let uris: Vec<&str> = (children.iter())
            .map(|child| child["content"]["uri"].as_str().unwrap())
            .collect();
        assert_eq!(uris, names[..2]);
    }
}
