//! The arguments of the command line.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use ridgeline::Method;

/// Three or more calibrated aerial photographs in, textured 3D roof models out.
#[derive(Parser)]
#[command(name = "ridgeline", version)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub(super) enum Command {
    /// Reconstruct the roofs that the photographs in a folder show.
    Reconstruct(Box<ReconstructArgs>),
    /// Check whether the images agree with their orientation, and how far each view is off.
    Check(Box<CheckArgs>),
    /// Compute the orientation of photographs that have none, as COLMAP's text model.
    Orient(Box<OrientArgs>),
    /// Divide a large area into tiles, to be made by many processes or machines.
    Plan(Box<PlanArgs>),
    /// Make the part of one tile of a plan: a file in PLAN/parts.
    Tile(TileArgs),
    /// Join the parts of all tiles of a plan into one model.
    Join(JoinArgs),
    /// Make the roof report of a model again, from its CityJSON: a page that prints, tables, JSON.
    Report(ReportArgs),
    /// Compare two models of one place, from their CityJSON: what both have, and by how much it
    /// differs.
    Compare(CompareArgs),
    /// Correct the model of a CityJSON file by hand, without photographs, and write it in all
    /// formats; in its CityJSON what no correction is about keeps its bytes.
    Correct(CorrectArgs),
    /// Print all parameters with their defaults, as JSON for --params.
    Params,
}

/// The scene and how it is loaded.
#[derive(Args)]
pub(super) struct InputArgs {
    /// Folder or .zip archive with images and orientation files, anywhere in it.
    pub scene: PathBuf,
    /// Which orientation to take where the folder holds several: a part of its path, or the name of
    /// a chunk or block in a file of several; or another folder that holds the orientation.
    #[arg(long, value_name = "PATH")]
    pub orientation: Option<String>,
    /// Leave these files out: a path in the scene, a name, or a pattern with * (any letters) and ?
    /// (one letter), as 'odm_dem/*' or '*.laz'; may be given several times.
    #[arg(long, value_name = "FILE|PATTERN")]
    pub without: Vec<String>,
    /// Use only these views (image names, separated by commas).
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    pub views: Option<Vec<String>>,
    /// Reconstruct only this part of the ground plan, metres in the frame of the orientation.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = parse_roi, allow_hyphen_values = true)]
    pub roi: Option<[f64; 4]>,
    /// Use at most so many views of that part, those that say most about it (12 if not given); more
    /// where they show little of it each, so that half as many see a place.
    #[arg(long, value_name = "N", requires = "roi", value_parser = clap::value_parser!(u16).range(3..))]
    pub max_views: Option<u16>,
    /// Reduce photographs by this factor first, as 2 or 1.5; by default large ones as long as their
    /// pixels stay finer than 5 cm on the ground. 1 uses them in full.
    #[arg(long, value_name = "F", value_parser = parse_reduction)]
    pub reduce: Option<f64>,
    /// Reference system of the orientation's world, as EPSG:25832; it is named in the results.
    #[arg(long, value_name = "EPSG:N", value_parser = parse_crs)]
    pub crs: Option<u32>,
    /// Correct the mistake in the orientation that the images reveal, instead of rejecting the
    /// scene.
    #[arg(long)]
    pub apply_fix: bool,
    /// Go on with an orientation that the images contradict or hardly agree with.
    #[arg(long, conflicts_with = "apply_fix")]
    pub ignore_check: bool,
    /// Leave views that are turned or moved against the others by up to a few pixels as they are,
    /// instead of adjusting them.
    #[arg(long, conflicts_with = "adjust")]
    pub no_adjust: bool,
    /// Adjust such views: the default, unless the parameters say otherwise.
    #[arg(long)]
    pub adjust: bool,
    /// Stop before the reconstruction where it needs more memory than this, megabytes.
    #[arg(long, value_name = "MB")]
    pub memory: Option<u32>,
    /// JSON file with parameters; what it leaves out keeps its default.
    #[arg(long, value_name = "FILE")]
    pub params: Option<PathBuf>,
    /// JSON file with corrections of the model by hand, as the page writes it; instead of those of
    /// the parameters or the project.
    #[arg(long, value_name = "FILE")]
    pub corrections: Option<PathBuf>,
    /// Height of the ground, metres in the frame of the orientation; estimated if not given.
    #[arg(long, value_name = "H", value_parser = parse_finite, allow_hyphen_values = true)]
    pub ground_z: Option<f64>,
    /// Terrain model: a GeoTIFF of heights, an ASCII grid of ESRI, or a point cloud (LAS, LAZ)
    /// whose ground is classified, in the frame of the orientation. The ground and the feet of
    /// walls follow it; a difference of heights that the images show is taken out and named.
    #[arg(long, value_name = "FILE", conflicts_with = "ground_z")]
    pub terrain: Option<PathBuf>,
    /// Standard deviation of the terrain's heights, metres (0.3 if not given).
    #[arg(long, value_name = "M", value_parser = parse_positive, requires = "terrain")]
    pub terrain_accuracy: Option<f64>,
    /// Footprints of buildings, GeoJSON or CityJSON: evidence that clear images overrule. Which of
    /// them the model confirms stands in report.json.
    #[arg(long, value_name = "FILE")]
    pub footprints: Option<PathBuf>,
    /// Standard deviation of the footprints' borders, metres (0.5 if not given).
    #[arg(long, value_name = "M", value_parser = parse_positive, requires = "footprints")]
    pub footprint_accuracy: Option<f64>,
    /// Point cloud (LAS, LAZ) in the frame of the orientation: its points on roofs are evidence
    /// that clear images overrule, and its ground is the terrain where none is given. A cloud that
    /// lies elsewhere or higher is moved to what the images show, and named.
    #[arg(long, value_name = "FILE")]
    pub point_cloud: Option<PathBuf>,
    /// Standard deviation of the cloud's heights, metres (0.15 if not given).
    #[arg(long, value_name = "M", value_parser = parse_positive, requires = "point_cloud")]
    pub point_cloud_accuracy: Option<f64>,
    /// Number of threads; by default one per core. It never changes the result.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// The arguments of `report`.
#[derive(Args)]
pub(super) struct ReportArgs {
    /// Folder that `reconstruct` wrote, or a CityJSON file; the report is written beside the model.
    pub model: PathBuf,
    /// Folder for the report instead; made if missing.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Setbacks of one's own beside the built-in ones: a rule file, as docs/report.md describes it.
    #[arg(long, value_name = "FILE")]
    pub setbacks: Option<PathBuf>,
}

/// The arguments of `compare`.
#[derive(Args)]
pub(super) struct CompareArgs {
    /// Folder that `reconstruct` wrote, or a CityJSON file.
    pub first: PathBuf,
    /// The model that it is compared with, likewise.
    pub second: PathBuf,
    /// Print everything as JSON, facet by facet.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `correct`.
#[derive(Args)]
pub(super) struct CorrectArgs {
    /// Folder that `reconstruct` wrote, or a CityJSON file of anybody.
    pub model: PathBuf,
    /// JSON file with corrections by hand, as the page writes it.
    #[arg(long, value_name = "FILE")]
    pub corrections: PathBuf,
    /// Folder for the corrected model; made if missing.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// The arguments of `check`.
#[derive(Args)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    pub input: InputArgs,
    /// Print everything as JSON.
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `orient`.
#[derive(Args)]
pub(super) struct OrientArgs {
    /// Folder or .zip archive with three or more photographs that overlap by about two thirds; with
    /// --check and without --out the folder of a finished orientation.
    pub photos: PathBuf,
    /// Folder for cameras.txt, images.txt, points3D.txt and the report; made if missing.
    #[arg(long, value_name = "DIR", required_unless_present = "check")]
    pub out: Option<PathBuf>,
    /// Print the control sheet: residuals at control points, check points and stated positions,
    /// what scale and level are worth, the lag of the receiver. Without --out that of a finished
    /// orientation.
    #[arg(long)]
    pub check: bool,
    /// Focal length of all photographs, pixels, where their headers state none or a wrong one; the
    /// adjustment refines it.
    #[arg(long, value_name = "PX", value_parser = parse_positive)]
    pub focal: Option<f64>,
    /// Ground control points as OpenDroneMap's gcp_list.txt, which give the frame; by default a
    /// file of that name among the photographs. A word behind a name says what the point is for:
    /// check (it is kept out of the fit), plan or height (only that is known).
    #[arg(long, value_name = "FILE")]
    pub gcp: Option<PathBuf>,
    /// Read control points or angles that a usual mistake explains (axes exchanged, rows from
    /// below, feet, a roll of 180 degrees) as they were meant, instead of leaving them out.
    #[arg(long)]
    pub apply_fix: bool,
    /// Keep the principal point in the middle, also where the photographs determine it.
    #[arg(long)]
    pub hold_center: bool,
    /// Longer side of the images that are worked on, pixels.
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u16).range(200..=8000))]
    pub working_size: Option<u16>,
    /// Most features of a photograph.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(200..=20000))]
    pub features: Option<u16>,
    /// Number of threads; by default one per core. It never changes the result.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// The arguments of `reconstruct`.
#[derive(Args)]
pub(super) struct ReconstructArgs {
    #[command(flatten)]
    pub input: InputArgs,
    /// Folder for the results; made if missing.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// How roofs are found; by default as the parameters say: lines.
    #[arg(long, value_parser = method_parser())]
    pub method: Option<Method>,
    /// Reconstruct the region tile by tile, each of M metres or so (60 or more), into one model;
    /// without --roi the area that three or more views show. A whole flight of more than 12 views
    /// goes this way by itself.
    #[arg(long, value_name = "M", value_parser = parse_finite, conflicts_with = "project")]
    pub tile: Option<f64>,
    /// Write a project file too: images, orientation, parameters and results in one .zip, which
    /// SCENE takes.
    #[arg(long, value_name = "FILE.zip")]
    pub project: Option<PathBuf>,
}

/// The arguments of `plan`.
#[derive(Args)]
pub(super) struct PlanArgs {
    #[command(flatten)]
    pub input: InputArgs,
    /// Size of a tile, metres (60 or more), about: how much one process does. The model does not
    /// depend on it. Without --roi the area is what three or more views show.
    #[arg(long, value_name = "M", value_parser = parse_finite)]
    pub tile: f64,
    /// Folder for tiles.json and the parts; made if missing.
    #[arg(long, value_name = "PLAN")]
    pub out: PathBuf,
    /// How roofs are found; by default as the parameters say: lines.
    #[arg(long, value_parser = method_parser())]
    pub method: Option<Method>,
}

/// The arguments of `tile`.
#[derive(Args)]
pub(super) struct TileArgs {
    /// Folder of a plan.
    pub plan: PathBuf,
    /// Number of the tile, from 1 to the number of tiles in PLAN/tiles.json.
    #[arg(value_name = "K")]
    pub tile: u32,
    /// Number of threads; by default one per core. It never changes the result.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// The arguments of `join`.
#[derive(Args)]
pub(super) struct JoinArgs {
    /// Folder of a plan whose parts are all made.
    pub plan: PathBuf,
    /// Folder for the results; made if missing.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// The methods by their names.
fn method_parser() -> impl TypedValueParser<Value = Method> {
    let named = |method: Method| PossibleValue::new(method.name()).help(method.summary());
    let of_name = |name: String| Method::ALL.into_iter().find(|m| m.name() == name);
    PossibleValuesParser::new(Method::ALL.map(named))
        .map(move |name| of_name(name).expect("one of the names above"))
}

fn parse_finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("'{text}' is not a number in metres")),
    }
}

fn parse_positive(text: &str) -> Result<f64, String> {
    let parsed = text.trim().parse::<f64>().ok();
    let positive = parsed.filter(|value| value.is_finite() && *value > 0.0);
    positive.ok_or_else(|| format!("'{text}' is not a positive number"))
}

fn parse_reduction(text: &str) -> Result<f64, String> {
    let parsed = text.trim().parse::<f64>().ok();
    let factor = parsed.filter(|factor| (1.0..=64.0).contains(factor));
    factor.ok_or_else(|| format!("'{text}' is not a number from 1 to 64"))
}

fn parse_crs(text: &str) -> Result<u32, String> {
    ridgeline::orienting::orientation::epsg_of(text)
        .ok_or_else(|| format!("'{text}' is not a number of EPSG, as EPSG:25832"))
}

fn parse_roi(text: &str) -> Result<[f64; 4], String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(parse_finite)
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [x0, y0, x1, y1] if x0 < x1 && y0 < y1 => Ok([x0, y0, x1, y1]),
        [_, _, _, _] => Err("x0 must be less than x1, and y0 less than y1".into()),
        _ => Err(format!(
            "{} numbers; expected four: x0,y0,x1,y1",
            numbers.len()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_region_is_four_ordered_numbers() {
        assert_eq!(parse_roi("-1,2,3.5,4"), Ok([-1.0, 2.0, 3.5, 4.0]));
        for bad in ["1,2,3", "3,2,1,4", "1,2,nan,4", "1,2,inf,4", "", "a,b,c,d"] {
            assert!(parse_roi(bad).is_err(), "{bad}");
        }
    }
}
