//! The page and the command line divide a flight into the same squares, leave out the same, and
//! plan the same work.

use std::fmt::Write as _;
use std::io::Cursor;

use ridgeline::base::execution::progress::silent;
use ridgeline::base::params::Params;
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene_loader::{LoadOptions, ground_heights};
use ridgeline::tiles::{Area, BlockPlan, BlockSource, FlightPlan};

/// Photographs of 100 x 100 m from 100 m above level ground, every 20 m along an L: 300 m to the
/// east, and 300 m to the north. The ground is at 0.
fn l_shaped_flight() -> Vec<InputFile> {
    let mut png = Cursor::new(Vec::new());
    let blank = image::GrayImage::from_pixel(100, 100, image::Luma([128]));
    blank.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let places = (0..=15).map(|i| (20 * i, 0));
    let places = places.chain((1..=15).map(|i| (0, 20 * i)));
    let mut files = Vec::new();
    let mut list = String::new();
    for (i, (x, y)) in places.enumerate() {
        // Looking down, north up: t = -R C.
        let _ = writeln!(list, "{i} 0 1 0 0 {} {y} 100 1 p{i:02}.png\n", -x);
        files.push(InputFile::new(
            &format!("p{i:02}.png"),
            png.get_ref().clone(),
        ));
    }
    let camera = b"1 PINHOLE 100 100 100 100 50 50\n".to_vec();
    files.push(InputFile::new("cameras.txt", camera));
    files.push(InputFile::new("images.txt", list.into_bytes()));
    files
}

fn options(ground_z: Option<f64>, reduction: Option<f64>) -> LoadOptions {
    LoadOptions {
        ground_z,
        reduction,
        ..LoadOptions::default()
    }
}

/// Tiles, and what is left out: how many squares, and their area.
type Divided = (Vec<[f64; 4]>, usize, f64);

fn square_metres(boxes: &[[f64; 4]]) -> f64 {
    boxes.iter().map(|[a, b, c, d]| (c - a) * (d - b)).sum()
}

fn planned(mut files: &[InputFile], options: &LoadOptions, tile_m: f64) -> BlockPlan {
    let source = BlockSource {
        scene: String::new(),
        orientation: None,
        known: Vec::new(),
    };
    let params = Params::default();
    let plan = BlockPlan::new(source, &mut files, Vec::new(), options, &params, tile_m).unwrap();
    assert_eq!(
        BlockPlan::from_json(&plan.to_json().unwrap()).unwrap(),
        plan
    );
    plan
}

fn of_command_line(files: &[InputFile], options: &LoadOptions, tile_m: f64) -> Divided {
    let plan = planned(files, options, tile_m);
    let tiles = plan.tiles.iter().map(|t| t.core).collect();
    (tiles, plan.left_out.len(), square_metres(&plan.left_out))
}

fn of_page(
    files: &[InputFile],
    options: &LoadOptions,
    ground: Option<[f64; 2]>,
    tile_m: f64,
) -> Divided {
    let plan = FlightPlan::new(files, options, ground, tile_m).unwrap();
    assert_eq!(plan.problem, None);
    // The tiles that the page works off are those that it shows.
    let mut source = files;
    let heights = Some(plan.overview.heights);
    let area = Area::plan(&mut source, options, heights, &Params::default(), tile_m).unwrap();
    let worked_off: Vec<[f64; 4]> = area.tiles().iter().map(|t| t.core).collect();
    assert_eq!(plan.tiles, worked_off);
    let left_out_m2 = square_metres(&plan.left_out);
    (plan.tiles, plan.squares_left_out, left_out_m2)
}

#[test]
fn an_l_shaped_flight_has_the_same_tiles_on_the_page_as_on_the_command_line() {
    let files = l_shaped_flight();
    let stated = options(Some(0.0), None);
    for tile_m in [60.0, 120.0] {
        let on_command_line = of_command_line(&files, &stated, tile_m);
        assert_eq!(of_page(&files, &stated, None, tile_m), on_command_line);
        let (tiles, count, _) = on_command_line;
        let plan = FlightPlan::new(&files, &stated, None, tile_m).unwrap();
        let left_out = plan.left_out;
        let holds = |squares: &[[f64; 4]], x: f64, y: f64| {
            (squares.iter()).any(|&[x0, y0, x1, y1]| x0 <= x && x < x1 && y0 <= y && y < y1)
        };
        // Both arms, and not what they enclose: three photographs show 50 m beside their line.
        for (x, y) in [(210.0, 30.0), (210.0, -30.0), (30.0, 210.0), (-30.0, 210.0)] {
            assert!(holds(&tiles, x, y) && !holds(&left_out, x, y), "{x} {y}");
        }
        for (x, y) in [(150.0, 150.0), (270.0, 270.0), (210.0, 90.0)] {
            assert!(holds(&left_out, x, y), "{x} {y}");
        }
        // 7 x 7 squares less two columns and two rows.
        assert_eq!(count, 25);
    }
}

#[test]
fn a_stated_region_has_all_its_squares() {
    let files = l_shaped_flight();
    let region = LoadOptions {
        roi: Some([0.0, 0.0, 300.0, 300.0]),
        ..options(Some(0.0), None)
    };
    let all = of_page(&files, &region, None, 60.0);
    assert_eq!((all.0.len(), all.1), (25, 0));
    assert_eq!(all, of_command_line(&files, &region, 60.0));
}

#[test]
fn the_size_of_photographs_does_not_change_what_is_left_out() {
    let files = l_shaped_flight();
    let full = of_page(&files, &options(Some(0.0), Some(1.0)), None, 60.0);
    for reduction in [None, Some(2.0), Some(4.0)] {
        let reduced = options(Some(0.0), reduction);
        assert_eq!(of_page(&files, &reduced, None, 60.0), full);
        assert_eq!(of_command_line(&files, &reduced, 60.0), full);
    }
}

#[test]
fn measured_ground_gives_the_same_tiles() {
    let files: Vec<InputFile> = (crate::common::synthetic_files().into_iter())
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect();
    let unknown = options(None, None);
    let ground = ground_heights(&files, &unknown);
    assert!(ground.is_some());
    assert_eq!(
        of_page(&files, &unknown, ground, 60.0),
        of_command_line(&files, &unknown, 60.0)
    );
    // The page measures at whatever size it uses the photographs.
    assert_eq!(ground_heights(&files, &options(None, Some(2.0))), ground);
}

#[test]
fn the_page_works_on_the_cells_of_the_command_line_within_its_memory() {
    let files: Vec<InputFile> = (crate::common::synthetic_files().into_iter())
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect();
    let params = Params::default();
    for memory_mb in [None, Some(26)] {
        let options = LoadOptions {
            memory_mb,
            ..options(None, None)
        };
        let heights = ground_heights(&files, &options);
        let mut area = Area::plan(&mut &files[..], &options, heights, &params, 60.0).unwrap();
        for square in 0..area.squares_to_look_at() {
            let seen = area.look_at(&files, square, &silent()).unwrap();
            area.take_look(&files, &seen).unwrap();
        }
        let plan = planned(&files, &options, 60.0);
        let work = area.work();
        assert_eq!(work.tiles, plan.tiles);
        assert_eq!(Some(work.reduction), plan.options.reduction);
        assert!(work.tiles.iter().any(|tile| tile.memory_mb > 20));
        let mut cells = work.tiles.iter().flat_map(|tile| &tile.cells);
        assert!(cells.all(|cell| cell.left_out.is_none()));
        assert_eq!(work.reduction > 1.0, memory_mb.is_some());
        let mut order = work.order.clone();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..work.tiles.len()));
    }
}
