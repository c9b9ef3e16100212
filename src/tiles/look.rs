//! A first look at an area, at pixels that tell building, tree and ground apart: where a roof may
//! be. The cells that are reconstructed lie around what it shows, and nowhere else.
//!
//! ```text
//! area -> squares -> lines over the views and surfaces of dense matching, in small photographs
//!                 -> places that one of them shows -> sites: what is connected, with its odds
//!                 -> cells of tiles
//! ```
//!
//! Of the buildings that are found without it hardly any is missed (decision 25).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use nalgebra::{Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::seen_ground::SeenGround;
use super::tile::{CELL_M, Cell, MARGIN_M, Tile, plan_tiles, square_at};
use crate::base::error::{Error, Result};
use crate::base::evidence::EvidenceModel;
use crate::base::execution::Listener;
use crate::base::geometry::Plane;
use crate::base::math::ln;
use crate::base::params::{Params, RoofParams, Source};
use crate::lines::lines3d::Line3d;
use crate::orienting::orientation::FileSource;
use crate::orienting::scene_loader::{LoadOptions, PlannedScene};
use crate::pipeline::{Run, Stage};
use crate::planes::dense::least_rectangle;
use crate::planes::terrain::Ground;
use crate::roofs::buildings::ASKED_PROBABILITY;

/// Photographs are reduced as long as their pixels stay finer than this on the ground, metres:
/// decision 25 has what is missed with larger ones.
pub(super) const LOOK_PIXEL_M: f64 = 0.15;

/// Side of a square that is looked at, cells. Assumption: at such pixels it takes the memory of a
/// few cells.
const SQUARE_CELLS: f64 = 3.0;

/// Side of a place, metres.
const PLACE_M: f64 = 1.0;

/// What is seen marks the places this near to it, metres: half the distance of the patches of dense
/// matching, and of two edges of a small roof.
const REACH_M: f64 = 1.5;

/// A core reaches so far beyond what was seen in it, metres. Assumption: of a roof at least so much
/// is seen that its middle lies no further off.
const SITE_MARGIN_M: f64 = 6.0;

/// What a cell looks at where the ground is known reaches so far beyond its core, metres.
/// Assumption: what hides eaves stands no further off, nor do the eaves of a neighbour.
const NEAR_M: f64 = 12.0;

/// A site that is longer is divided by the grid, metres. Assumption: a long hall; more is a row of
/// buildings.
const LARGEST_M: f64 = CELL_M + MARGIN_M;

/// Squares of [`PLACE_M`] of the world, by column and row.
type Place = [i64; 2];

/// The squares of an area that are looked at.
#[derive(Clone, Debug)]
pub(super) struct FirstLook {
    squares: Vec<Cell>,
    options: LoadOptions,
    params: Params,
}

/// What was seen at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Seen {
    /// Of surfaces that are likelier buildings than not, square metres.
    surface_m2: f64,
    /// Of lines as high above the ground as eaves are, metres.
    lines_m: f64,
    /// Is a roof known there, or was the place not to be looked at?
    is_given: bool,
}

/// What a first look shows: of roofs place by place, and the ground.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Sightings {
    places: BTreeMap<Place, Seen>,
    pub ground: SeenGround,
}

/// A site: what is connected of what a first look shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct Site {
    /// The least rectangle around it, metres, world frame of the input.
    pub outline: [[f64; 2]; 4],
    /// Its ground, square metres.
    pub area_m2: f64,
    /// Of it surfaces that are likelier buildings than not, square metres.
    pub surface_m2: f64,
    /// Length of the lines as high above the ground as eaves are, metres.
    pub lines_m: f64,
    /// The shorter side of the rectangle, metres.
    pub width_m: f64,
    /// Is a roof known there, or was the place not to be looked at?
    pub is_given: bool,
    /// The probability that a roof is there.
    pub probability: f64,
    /// Is it reconstructed? A person is asked about a roof that the model lacks from the same
    /// probability on.
    pub is_worked_on: bool,
}

impl FirstLook {
    /// A look at an area (x0, y0, x1, y1, metres, world frame) with options that reduce photographs
    /// to [`LOOK_PIXEL_M`].
    pub(super) fn new(area: [f64; 4], options: LoadOptions, params: &Params) -> Result<Self> {
        let square = |tile: Tile| {
            // From the south-western cell to the north-eastern one.
            let [x0, y0, ..] = tile.cells[0].region;
            let [.., x1, y1] = tile.cells[tile.cells.len() - 1].region;
            // Lines and surfaces at the border are then seen whole.
            let inner = MARGIN_M - SITE_MARGIN_M;
            Cell {
                core: [x0 + MARGIN_M, y0 + MARGIN_M, x1 - MARGIN_M, y1 - MARGIN_M],
                region: [x0 + inner, y0 + inner, x1 - inner, y1 - inner],
            }
        };
        let tiles = plan_tiles(area, SQUARE_CELLS * CELL_M)?;
        let mut params = params.clone();
        params.sources = vec![Source::Dense];
        Ok(Self {
            squares: tiles.into_iter().map(square).collect(),
            options,
            params,
        })
    }

    /// How many squares there are.
    pub(super) fn len(&self) -> usize {
        self.squares.len()
    }

    /// The options with which a square is loaded; `None` where there is no such square.
    pub(super) fn options(&self, index: usize) -> Option<LoadOptions> {
        let square = self.squares.get(index)?;
        Some(LoadOptions {
            roi: Some(square.region),
            ..self.options.clone()
        })
    }

    /// What all squares show.
    pub(super) fn all(
        &self,
        source: &mut dyn FileSource,
        progress: &Listener,
    ) -> Result<Sightings> {
        let mut seen = Sightings::default();
        for index in 0..self.len() {
            let (done, all) = (index as f64, self.len() as f64);
            let of_all = Listener::clone(progress);
            let listener: Listener = Arc::new(move |fraction| of_all((done + fraction) / all));
            seen.add(self.at(index, source, &listener)?);
        }
        Ok(seen)
    }

    /// What a square shows. One that cannot be loaded may have roofs everywhere: its cells say why.
    /// An error says which photograph cannot be had.
    pub(super) fn at(
        &self,
        index: usize,
        source: &mut dyn FileSource,
        progress: &Listener,
    ) -> Result<Sightings> {
        let square = &self.squares[index];
        let options = self.options(index).expect("there is such a square");
        let planned = PlannedScene::new(source, &options)?;
        let scene = planned.load(source.files());
        source.hold(&|_| Vec::new())?;
        let Ok(scene) = scene else {
            return Ok(Sightings::everywhere(square.core));
        };
        // What a cloud shows of roofs is evidence that images need not have.
        if scene.known.point_cloud.is_some() {
            return Ok(Sightings::everywhere(square.core));
        }
        let mut run = Run::new(scene, self.params.clone());
        run.step(Stage::Dense, progress);
        let mut seen = Sightings::of_run(&run).within(square.core);
        seen.ground = SeenGround::of_run(&run, square);
        Ok(seen)
    }
}

impl Sightings {
    fn everywhere([x0, y0, x1, y1]: [f64; 4]) -> Self {
        let mut all = Self::default();
        all.give([x0, y0], [x1, y1]);
        all
    }

    /// Surfaces that are likelier buildings than not, lines as high above the ground as eaves are,
    /// and footprints that are known.
    fn of_run(run: &Run) -> Self {
        let (scene, results) = (run.scene(), run.results());
        let origin = &scene.origin;
        let mut seen = Self::default();
        if let Some(dense) = &results.dense {
            let patches = &dense.trace.patches;
            let surfaces = dense.value.iter();
            for plane in surfaces.filter(|plane| plane.class.is_building()) {
                for &patch in &plane.patches {
                    let at = seen.mark(patches[patch].middle + origin.xy());
                    at.surface_m2 += dense.trace.spacing_m * dense.trace.spacing_m;
                }
            }
        }
        if let (Some(lines), Some(ground)) = (&results.lines, &results.ground) {
            let evidence = results.evidence_of_matches();
            for (line, _) in (lines.value.iter().zip(evidence))
                .filter(|(_, evidence)| evidence.accepts(0.0))
                .filter(|(line, _)| is_high(line, ground, &run.params().roof))
            {
                seen.mark_line(line, origin);
            }
        }
        for footprint in scene
            .known
            .footprints
            .iter()
            .flat_map(|register| &register.footprints)
        {
            let [low, high] = footprint.bounds().map(|corner| corner + origin.xy());
            seen.give([low.x, low.y], [high.x, high.y]);
        }
        seen
    }

    /// Marks the places near to what was seen, and returns the one where it is.
    fn mark(&mut self, p: Point2<f64>) -> &mut Seen {
        let [[x0, y0], [x1, y1]] = [-REACH_M, REACH_M].map(|by| place_at(p.map(|v| v + by).into()));
        for (x, y) in (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| (x, y))) {
            if (middle_of(&[x, y]) - p).norm() <= REACH_M {
                self.places.entry([x, y]).or_default();
            }
        }
        self.places.entry(place_at(p.into())).or_default()
    }

    fn mark_line(&mut self, line: &Line3d, origin: &Vector3<f64>) {
        let length = line.segment.length();
        let steps = (length / PLACE_M).ceil().max(1.0);
        for i in 0..steps as usize {
            let p: Point3<f64> = line.at((i as f64 + 0.5) / steps) + origin;
            self.mark(p.xy()).lines_m += length / steps;
        }
    }

    /// Marks a box in which a roof is known.
    fn give(&mut self, low: [f64; 2], high: [f64; 2]) {
        let ([x0, y0], [x1, y1]) = (place_at(low), high.map(|v| (v / PLACE_M).ceil() as i64));
        for place in (y0..y1).flat_map(|y| (x0..x1).map(move |x| [x, y])) {
            self.places.entry(place).or_default().is_given = true;
        }
    }

    /// Those in a box of whole places.
    fn within(mut self, [x0, y0, x1, y1]: [f64; 4]) -> Self {
        let ([x0, y0], [x1, y1]) = (place_at([x0, y0]), place_at([x1, y1]));
        self.places
            .retain(|[x, y], _| (x0..x1).contains(x) && (y0..y1).contains(y));
        self
    }

    /// As bytes, to be kept.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        postcard::to_stdvec(self).expect("bytes can be written to memory")
    }

    /// From [`Self::to_bytes`].
    pub(super) fn of_bytes(bytes: &[u8]) -> Result<Self> {
        postcard::from_bytes(bytes).map_err(|error| {
            Error::scene(
                format!("what a first look showed cannot be read: {error}"),
                "look again",
            )
        })
    }

    /// Adds what another square shows.
    pub(super) fn add(&mut self, other: Self) {
        self.places.extend(other.places);
        self.ground.add(other.ground);
    }

    /// What is connected.
    fn connected(&self) -> Vec<BTreeSet<Place>> {
        let mut rest: BTreeSet<Place> = self.places.keys().copied().collect();
        let mut all = Vec::new();
        while let Some(start) = rest.pop_first() {
            let (mut places, mut front) = (BTreeSet::from([start]), vec![start]);
            while let Some([x, y]) = front.pop() {
                for (i, j) in (-1..=1).flat_map(|j| (-1..=1).map(move |i| (i, j))) {
                    if let Some(next) = rest.take(&[x + i, y + j]) {
                        places.insert(next);
                        front.push(next);
                    }
                }
            }
            all.push(places);
        }
        all
    }

    fn weighed(&self, places: &BTreeSet<Place>) -> Site {
        let seen = || places.iter().map(|place| self.places[place]);
        let middles: Vec<Point2<f64>> = places.iter().map(middle_of).collect();
        let corners = least_rectangle(&middles, 0.5 * PLACE_M, &Plane::level(0.0));
        let [along, across] = [corners[1] - corners[0], corners[2] - corners[1]];
        let mut site = Site {
            outline: corners.map(|corner| [corner.x, corner.y].map(rounded)),
            area_m2: places.len() as f64 * PLACE_M * PLACE_M,
            surface_m2: rounded(seen().map(|seen| seen.surface_m2).sum()),
            lines_m: rounded(seen().map(|seen| seen.lines_m).sum()),
            width_m: rounded(along.norm().min(across.norm())),
            is_given: seen().any(|seen| seen.is_given),
            probability: 1.0,
            is_worked_on: true,
        };
        if !site.is_given {
            let features = [
                ("ln_1_plus_surface_m2", ln(1.0 + site.surface_m2)),
                ("ln_1_plus_lines_m", ln(1.0 + site.lines_m)),
                ("ln_width_m", ln(site.width_m)),
            ];
            let evidence = EvidenceModel::of_sites().weigh(&features);
            site.probability = rounded(evidence.probability());
            site.is_worked_on = site.probability >= ASKED_PROBABILITY;
        }
        site
    }

    /// Leaves the tiles of an area the cells in which something was seen, and returns the sites
    /// that reach into it: small ones with their middles in one square of the grid share a cell
    /// around them, longer ones have their own, and the longest keep the cells of the grid.
    pub(super) fn place_cells(&self, tiles: &mut [Tile], area: [f64; 4]) -> Vec<Site> {
        let mut of_grid: BTreeSet<Place> = BTreeSet::new();
        let mut own: Vec<[f64; 4]> = Vec::new();
        let mut shared: BTreeMap<Place, [f64; 4]> = BTreeMap::new();
        let mut sites = Vec::new();
        for places in self.connected() {
            let bounds = bounds_of(&places);
            if !meet(bounds, area) {
                continue;
            }
            let site = self.weighed(&places);
            if site.is_worked_on {
                let [x0, y0, x1, y1] = bounds;
                match (x1 - x0).max(y1 - y0) {
                    length if length > LARGEST_M => {
                        of_grid.extend(places.iter().map(|place| square_at(bounds_of([place]))));
                    }
                    length if length > CELL_M => own.push(bounds),
                    _ => {
                        let all = shared.entry(square_at(bounds)).or_insert(bounds);
                        *all = union(*all, bounds);
                    }
                }
            }
            sites.push(site);
        }
        for tile in tiles {
            let cells = tile.cells.iter().flat_map(|cell| {
                let square = cell.place();
                let is_of_grid = of_grid.contains(&square);
                let small = shared.get(&square).filter(|_| !is_of_grid);
                let longer = own
                    .iter()
                    .filter(move |bounds| square_at(**bounds) == square);
                let around = longer
                    .chain(small)
                    .map(|bounds| Cell::around(*bounds, area, &self.ground));
                is_of_grid.then_some(*cell).into_iter().chain(around)
            });
            tile.cells = cells.collect();
        }
        sites
    }
}

impl Cell {
    /// Around what was seen, within an area; where the ground is not known, it looks as far around
    /// that as the grid's cells do.
    fn around(bounds: [f64; 4], area: [f64; 4], ground: &SeenGround) -> Self {
        let grown = |[x0, y0, x1, y1]: [f64; 4], by: f64| [x0 - by, y0 - by, x1 + by, y1 + by];
        let [x0, y0, x1, y1] = grown(bounds, SITE_MARGIN_M);
        let near = grown([x0, y0, x1, y1], NEAR_M);
        let is_known = ground.within(near, &Vector3::zeros()).is_some();
        Self {
            core: [
                x0.max(area[0]),
                y0.max(area[1]),
                x1.min(area[2]),
                y1.min(area[3]),
            ],
            region: match is_known {
                true => near,
                false => grown([x0, y0, x1, y1], MARGIN_M),
            },
        }
    }
}

/// Is an end of a line as high above the ground as eaves are? A facet's height may differ from its
/// lines' by what they may lie off its plane.
fn is_high(line: &Line3d, ground: &Ground, params: &RoofParams) -> bool {
    let eave_m = params.min_height_m - 3.0 * params.coplanar_distance_m;
    !ground.is_near(&line.segment, eave_m)
}

/// So that it comes back from a file as it was.
fn rounded(value: f64) -> f64 {
    (1000.0 * value).round() / 1000.0
}

fn place_at(p: [f64; 2]) -> Place {
    p.map(|v| (v / PLACE_M).floor() as i64)
}

fn middle_of([x, y]: &Place) -> Point2<f64> {
    Point2::new(*x as f64 + 0.5, *y as f64 + 0.5) * PLACE_M
}

/// The box around places, metres, world frame.
fn bounds_of<'a>(places: impl IntoIterator<Item = &'a Place>) -> [f64; 4] {
    let boxes = places.into_iter().map(|place| {
        let [x, y] = place.map(|v| v as f64 * PLACE_M);
        [x, y, x + PLACE_M, y + PLACE_M]
    });
    boxes.reduce(union).expect("a site has places")
}

fn union(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[0].min(b[0]),
        a[1].min(b[1]),
        a[2].max(b[2]),
        a[3].max(b[3]),
    ]
}

fn meet(a: [f64; 4], b: [f64; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::execution::progress::silent;
    use crate::base::params::Params;
    use crate::orienting::orientation::InputFile;
    use crate::orienting::scene::Scene;
    use crate::orienting::synthetic::{gable_scene, shed_scene, to_files};
    use crate::roofs::testing::line;
    use crate::tiles::Area;
    use crate::tiles::area::NOTHING_SEEN;

    /// The edges of roofs of 10 m by 8 m, with these corners in the south-west.
    fn houses(corners: &[[f64; 2]]) -> Sightings {
        let mut seen = Sightings::default();
        for [x, y] in corners {
            let ring = [[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0], [0.0, 0.0]]
                .map(|[i, j]| Point3::new(x + i, y + j, 5.0));
            for ends in ring.windows(2) {
                seen.mark_line(&line(ends[0], ends[1]), &Vector3::zeros());
            }
        }
        seen
    }

    fn cores(seen: &Sightings, area: [f64; 4]) -> Vec<[f64; 4]> {
        let mut tiles = plan_tiles(area, CELL_M).unwrap();
        seen.place_cells(&mut tiles, area);
        let cells = tiles.iter().flat_map(|tile| &tile.cells);
        cells.map(|cell| cell.core).collect()
    }

    #[test]
    fn a_site_has_the_size_of_what_was_seen_and_a_lone_line_is_no_roof() {
        let seen = houses(&[[20.0, 20.0]]);
        let places = &seen.connected()[0];
        let site = seen.weighed(places);
        assert_eq!(seen.connected().len(), 1);
        assert_eq!(site.lines_m, 36.0);
        assert!((site.width_m - 11.0).abs() <= 1.0, "{site:?}");
        assert!(site.is_worked_on && site.probability > 0.5, "{site:?}");
        let mut fence = Sightings::default();
        let ends = [0.0, 3.0].map(|x| Point3::new(x, 0.0, 2.0));
        fence.mark_line(&line(ends[0], ends[1]), &Vector3::zeros());
        let site = fence.weighed(&fence.connected()[0]);
        assert!(!site.is_worked_on && site.probability > 0.0, "{site:?}");
        assert_eq!(Sightings::of_bytes(&seen.to_bytes()).unwrap(), seen);
        assert!(Sightings::of_bytes(&[9]).is_err());
    }

    #[test]
    fn cells_lie_around_what_was_seen() {
        let area = [0.0, 0.0, 400.0, 400.0];
        // The first two share a square of the grid, the third crosses a border of it.
        let seen = houses(&[[20.0, 20.0], [40.0, 20.0], [112.0, 80.0]]);
        let found = cores(&seen, area);
        assert_eq!(found.len(), 2);
        for (core, [x0, y0, x1, y1]) in found
            .iter()
            .zip([[20.0, 20.0, 50.0, 28.0], [112.0, 80.0, 122.0, 88.0]])
        {
            let by = SITE_MARGIN_M + REACH_M;
            let expected = [x0 - by, y0 - by, x1 + by, y1 + by];
            assert!(
                (0..4).all(|i| (core[i] - expected[i]).abs() <= 1.0),
                "{core:?}"
            );
        }
        // Tiles and area decide nothing.
        let all = |size: f64, area: [f64; 4]| {
            let mut tiles = plan_tiles(area, size).unwrap();
            seen.place_cells(&mut tiles, area);
            let cells = tiles.into_iter().flat_map(|tile| tile.cells);
            cells.map(|cell| cell.region).collect::<Vec<_>>()
        };
        assert_eq!(all(60.0, area), all(240.0, area));
        assert_eq!(all(60.0, [60.0, 60.0, 200.0, 200.0]), all(60.0, area)[1..]);
    }

    #[test]
    fn a_row_longer_than_a_square_has_its_own_cell_and_a_longer_one_those_of_the_grid() {
        let area = [0.0, 0.0, 400.0, 400.0];
        let row = |count: i32| {
            let corners = (0..count).map(|i| [10.0 + 11.0 * f64::from(i), 25.0]);
            houses(&corners.collect::<Vec<_>>())
        };
        let [[x0, _, x1, _]] = cores(&row(7), area)[..] else {
            panic!("not one cell")
        };
        assert!(x0 < 10.0 && x1 > 86.0, "{x0} {x1}");
        let mut squares = cores(&row(20), area).into_iter();
        for i in 0..4 {
            let x0 = f64::from(i) * CELL_M;
            assert_eq!(squares.next(), Some([x0, 0.0, x0 + CELL_M, CELL_M]));
        }
        assert_eq!(squares.next(), None);
    }

    /// The outcome of the tile of an area, and how many places were seen to hold no roof.
    fn outcome(scene: &Scene, roi: [f64; 4]) -> (String, String) {
        let files: Vec<InputFile> = (to_files(scene).into_iter())
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect();
        let options = LoadOptions {
            roi: Some(roi),
            ..LoadOptions::default()
        };
        let params = Params::default();
        let mut source = &files[..];
        let mut area = Area::plan(&mut source, &options, Some([0.0, 8.0]), &params, 60.0).unwrap();
        // Square by square, as the page looks.
        for square in 0..area.squares_to_look_at() {
            let seen = area.look_at(&files, square, &silent()).unwrap();
            area.take_look(&files, &seen).unwrap();
        }
        let words = area.seen_in_words();
        let (_, report) = area.step(&mut source, &silent()).unwrap().unwrap();
        (report.outcome.clone(), words)
    }

    #[test]
    fn a_lawn_beside_a_house_is_left_out_and_one_with_a_shed_is_not() {
        const EAST: [f64; 4] = [26.0, -10.0, 33.0, -1.0];
        let (words, seen) = outcome(&gable_scene(800).0, EAST);
        assert_eq!(words, NOTHING_SEEN);
        assert!(seen.contains("0 m² in 0 tiles"), "{seen}");
        let (words, seen) = outcome(&shed_scene(800).0, EAST);
        assert_eq!(words, "1 building");
        assert!(seen.contains("1 place where a roof may be"), "{seen}");
    }
}
