//! Terrain, footprints and point clouds among the files: those that the options name, else the only
//! ones.

use nalgebra::Vector3;

use super::input::LoadOptions;
use crate::base::error::{Error, Result, listed};
use crate::orienting::known::{
    FOOTPRINT_ACCURACY_M, Known, POINT_CLOUD_ACCURACY_M, PointCloud, Register, TERRAIN_ACCURACY_M,
    Terrain, WorldSystem,
};
use crate::orienting::orientation::{FileKind, InputFile, POINT_CLOUD, detect};

/// By this property the program's own maps are told from a register: what it has found itself
/// confirms nothing.
const OWN_PROPERTY: &str = "\"lowest_roof_m\"";

/// Points are of use this far around the region of interest, or what the views show, metres.
/// Assumption: roofs begin inside it and reach as far beyond.
const POINTS_MARGIN_M: f64 = 30.0;

/// What each file is; what the options name as terrain or footprints is that.
pub(super) fn kinds_of(files: &[InputFile], options: &LoadOptions) -> Vec<FileKind> {
    let is = |file: &InputFile, named: &Option<String>| named.as_ref() == Some(&file.path);
    let kind = |file: &InputFile| match file {
        _ if is(file, &options.terrain) => FileKind::Terrain,
        _ if is(file, &options.footprints) => FileKind::Footprints,
        _ if is(file, &options.point_cloud) => FileKind::Terrain,
        _ => detect(file),
    };
    files.iter().map(kind).collect()
}

/// Reads what is known, for a scene with this system and origin; with what is to be said of it.
/// `area` is the region of interest or the box of what the views show, local frame: of a point
/// cloud only the surroundings are kept.
pub(super) fn read_known(
    files: &[InputFile],
    kinds: &[FileKind],
    options: &LoadOptions,
    system: &WorldSystem,
    origin: Vector3<f64>,
    area: Option<[f64; 4]>,
) -> Result<(Known, Vec<String>)> {
    let mut warnings = Vec::new();
    let [terrain, footprints, cloud] = meant(files, kinds, options, &mut warnings)?;
    let terrain = match terrain {
        Some(file) => {
            let accuracy_m = options.terrain_accuracy_m.unwrap_or(TERRAIN_ACCURACY_M);
            match Terrain::read(file, system, origin, accuracy_m) {
                // Its roofs are of use without its ground.
                Err(problem) if options.terrain.is_none() && is_cloud(file) => {
                    warnings.push(format!("as terrain it is not used: {problem}"));
                    None
                }
                read => Some(read?),
            }
        }
        None => None,
    };
    let cloud = cloud.map(|file| {
        let accuracy_m = options
            .point_cloud_accuracy_m
            .unwrap_or(POINT_CLOUD_ACCURACY_M);
        let around = |[x0, y0, x1, y1]: [f64; 4]| {
            [
                x0 - POINTS_MARGIN_M,
                y0 - POINTS_MARGIN_M,
                x1 + POINTS_MARGIN_M,
                y1 + POINTS_MARGIN_M,
            ]
        };
        PointCloud::read(file, system, origin, accuracy_m, area.map(around))
    });
    let register = footprints.map(|file| {
        let accuracy_m = options.footprint_accuracy_m.unwrap_or(FOOTPRINT_ACCURACY_M);
        Register::read(file, system, origin, accuracy_m, &mut warnings)
    });
    let known = Known {
        terrain,
        footprints: register.transpose()?.map(Into::into),
        point_cloud: cloud.transpose()?.map(Into::into),
    };
    Ok((known, warnings))
}

fn is_cloud(file: &InputFile) -> bool {
    file.bytes.starts_with(POINT_CLOUD)
}

/// The files of the terrain, the footprints and the point cloud.
fn meant<'a>(
    files: &'a [InputFile],
    kinds: &[FileKind],
    options: &LoadOptions,
    warnings: &mut Vec<String>,
) -> Result<[Option<&'a InputFile>; 3]> {
    let of_kind = |kind: FileKind| {
        let all = files.iter().zip(kinds);
        all.filter(move |(file, k)| **k == kind && !options.unused.contains(&file.path))
            .map(|(file, _)| file)
    };
    let terrains: Vec<&InputFile> = of_kind(FileKind::Terrain).collect();
    // Of CityJSON nothing tells whether it is a result of this program.
    let is_register = |file: &&InputFile| {
        let text = file.text();
        !text.contains("\"CityObjects\"") && !text.contains(OWN_PROPERTY)
    };
    let registers: Vec<&InputFile> = of_kind(FileKind::Footprints).filter(is_register).collect();
    // Beside a grid a cloud is asked for its roofs only.
    let grids: Vec<&InputFile> = terrains.iter().copied().filter(|f| !is_cloud(f)).collect();
    let grounds = if grids.is_empty() { &terrains } else { &grids };
    let terrain = match options.ground_z {
        Some(_) => None,
        None => chosen(files, options.terrain.as_deref(), grounds, warnings)?,
    };
    let footprints = chosen(files, options.footprints.as_deref(), &registers, warnings)?;
    let clouds: Vec<&InputFile> = match (&options.terrain, terrain) {
        // The cloud that is named as the terrain is the one that is meant.
        (Some(_), Some(file)) if is_cloud(file) => vec![file],
        _ => terrains.iter().copied().filter(|f| is_cloud(f)).collect(),
    };
    let mut said = Vec::new();
    let cloud = chosen(files, options.point_cloud.as_deref(), &clouds, &mut said)?;
    // The same may have been said of them as terrain.
    said.retain(|said| !warnings.contains(said));
    warnings.extend(said);
    Ok([terrain, footprints, cloud])
}

/// The file that is named, else the only one of its kind.
fn chosen<'a>(
    files: &'a [InputFile],
    named: Option<&str>,
    of_kind: &[&'a InputFile],
    warnings: &mut Vec<String>,
) -> Result<Option<&'a InputFile>> {
    match (named, of_kind) {
        (Some(path), _) => {
            let file = files.iter().find(|file| file.path == path);
            let missing = || Error::File {
                file: path.to_owned(),
                problem: "it is not among the files".to_owned(),
                advice: "add it to them".to_owned(),
            };
            Ok(Some(file.ok_or_else(missing)?))
        }
        (None, []) => Ok(None),
        (None, [file]) => {
            warnings.push(format!("{} is used: it lies among the files", file.path));
            Ok(Some(file))
        }
        (None, several) => {
            let names = listed(several.iter().map(|file| &*file.path));
            warnings.push(format!(
                "none of {names} is used: name the one that is meant"
            ));
            Ok(None)
        }
    }
}
