//! Terrain, footprints and point clouds among the files: those that the options name, else the only
//! ones.

use nalgebra::{Point2, Vector3};

use super::input::LoadOptions;
use super::names::belongs_to;
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

/// The CityJSON file whose model is opened, where there are no photographs and no orientation;
/// `None` also where there are several.
pub fn opened_model(files: &[InputFile]) -> Option<&InputFile> {
    let kinds = kinds_of(files, &LoadOptions::default());
    let mut models = None;
    for (file, kind) in files.iter().zip(&kinds) {
        match kind {
            FileKind::Footprints if file.text().contains("\"CityObjects\"") => {
                if models.replace(file).is_some() {
                    return None;
                }
            }
            FileKind::Ignored | FileKind::Footprints | FileKind::Terrain => {}
            _ => return None,
        }
    }
    models
}

/// The scene that things are known of.
pub(super) struct KnownOf<'a> {
    pub system: WorldSystem,
    pub origin: Vector3<f64>,
    /// The region of interest or the box of what the views show, local frame: of a point cloud
    /// only the surroundings are kept.
    pub area: Option<[f64; 4]>,
    /// Places on the ground that three or more views show, on a grid, local frame.
    pub places: Vec<Point2<f64>>,
    /// The area of these places, square metres.
    pub shown_m2: f64,
    pub options: &'a LoadOptions,
}

/// A file, and whether an option names it: what lies there by chance refuses nothing.
#[derive(Clone, Copy)]
struct Meant<'a> {
    file: &'a InputFile,
    is_named: bool,
}

impl Meant<'_> {
    /// What was read; of a file that nobody named a refusal is only said.
    fn used<T>(&self, read: Result<T>, warnings: &mut Vec<String>) -> Result<Option<T>> {
        let said = match &read {
            _ if self.is_named => return read.map(Some),
            Ok(_) => format!("{} is used: it lies among the files", self.file.path),
            Err(problem) => format!("{LEFT_OUT} {problem}"),
        };
        if !warnings.contains(&said) {
            warnings.push(said);
        }
        Ok(read.ok())
    }
}

/// What stands before the reason why a file that nobody named was left out.
const LEFT_OUT: &str = "left out, since it only lies among the files:";

impl KnownOf<'_> {
    /// Reads what is known, with what is to be said of it.
    pub(super) fn read(
        &self,
        files: &[InputFile],
        kinds: &[FileKind],
    ) -> Result<(Known, Vec<String>)> {
        let mut warnings = Vec::new();
        let [terrain, footprints, cloud] = meant(files, kinds, self.options, &mut warnings)?;
        let mut known = Known::default();
        if let Some(meant) = terrain {
            let beside = files.iter().zip(kinds).find(|(file, kind)| {
                **kind == FileKind::ReferenceSystem && belongs_to(file, meant.file)
            });
            let beside = beside.map(|(file, _)| file.text());
            known.terrain = self.terrain(meant, beside.as_deref(), &mut warnings)?;
        }
        if let Some(meant) = cloud {
            let read = self.point_cloud(meant.file);
            known.point_cloud = meant.used(read, &mut warnings)?.map(Into::into);
        }
        if let Some(meant) = footprints {
            let mut said = Vec::new();
            let read = self.footprints(meant, &mut said);
            known.footprints = meant.used(read, &mut warnings)?.map(Into::into);
            warnings.extend(said);
        }
        Ok((known, warnings))
    }

    fn terrain(
        &self,
        meant: Meant,
        beside: Option<&str>,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Terrain>> {
        let accuracy_m = self
            .options
            .terrain_accuracy_m
            .unwrap_or(TERRAIN_ACCURACY_M);
        let read = Terrain::read(meant.file, beside, &self.system, self.origin, accuracy_m);
        let is_roofs = self.options.point_cloud.as_ref() == Some(&meant.file.path);
        let found = match read {
            // Its roofs are of use without its ground.
            Err(problem) if !meant.is_named && is_cloud(meant.file) => {
                warnings.push(format!("as terrain it is not used: {problem}"));
                None
            }
            // A cloud that is named is the terrain by that.
            Ok(terrain) if is_roofs => Some(terrain),
            read => meant.used(read, warnings)?,
        };
        warnings.extend(found.as_ref().and_then(Terrain::notice));
        Ok(found)
    }

    fn point_cloud(&self, file: &InputFile) -> Result<PointCloud> {
        let stated = self.options.point_cloud_accuracy_m;
        let around = |[x0, y0, x1, y1]: [f64; 4]| {
            let margin = POINTS_MARGIN_M;
            [x0 - margin, y0 - margin, x1 + margin, y1 + margin]
        };
        PointCloud::read(
            file,
            &self.system,
            self.origin,
            stated.unwrap_or(POINT_CLOUD_ACCURACY_M),
            self.area.map(around),
        )
    }

    fn footprints(&self, meant: Meant, said: &mut Vec<String>) -> Result<Register> {
        let stated = self.options.footprint_accuracy_m;
        let accuracy_m = stated.unwrap_or(FOOTPRINT_ACCURACY_M);
        let read = Register::read(meant.file, &self.system, self.origin, accuracy_m, said)?;
        let register = read.without_areas(&self.places, self.shown_m2, said)?;
        let Some(area) = self.area.filter(|area| !register.reaches(*area)) else {
            return Ok(register);
        };
        let is_exchanged = Register::reaches_exchanged(meant.file, &self.system, self.origin, area);
        let (problem, advice) = match is_exchanged {
            true => (
                "its footprints lie where the photographs do with x and y exchanged (latitude \
                 before longitude, northing before easting)",
                "exchange them in it",
            ),
            false if meant.is_named => return Ok(register),
            false => (
                "none of its footprints lies where the photographs do",
                "name its system in it, or leave it out (--without)",
            ),
        };
        Err(Error::file(register.file, problem, advice))
    }
}

/// Is a raster called a surface model, as programs call theirs (dsm.tif, odm_dem/dsm.tif,
/// site_DOM.tif)? Its roofs are no ground.
fn is_surface_model(file: &InputFile) -> bool {
    let name = file.name().to_ascii_lowercase();
    let mut words = name.split(|c: char| !c.is_ascii_alphanumeric());
    words.any(|word| ["dsm", "dom", "ndsm", "ndom", "chm"].contains(&word))
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
) -> Result<[Option<Meant<'a>>; 3]> {
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
    let (surfaces, grids): (Vec<&InputFile>, Vec<&InputFile>) = (terrains.iter().copied())
        .filter(|f| !is_cloud(f))
        .partition(|f| is_surface_model(f));
    let clouds: Vec<&InputFile> = terrains.iter().copied().filter(|f| is_cloud(f)).collect();
    let grounds = if grids.is_empty() { &clouds } else { &grids };
    let named = options.terrain.as_deref();
    let surfaces = surfaces.iter().filter(|file| Some(&*file.path) != named);
    warnings.extend(surfaces.map(|file| {
        format!(
            "{LEFT_OUT} {} is a surface model by its name, and roofs are no ground",
            file.path
        )
    }));
    let terrain = match options.ground_z {
        Some(_) => None,
        None => chosen(files, named, grounds, warnings)?,
    };
    let footprints = chosen(files, options.footprints.as_deref(), &registers, warnings)?;
    let mut said = Vec::new();
    let cloud = match (&options.point_cloud, named, terrain) {
        // The cloud that is named as the terrain is the one that is meant.
        (None, Some(_), Some(meant)) if is_cloud(meant.file) => Some(meant),
        _ => chosen(files, options.point_cloud.as_deref(), &clouds, &mut said)?,
    };
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
) -> Result<Option<Meant<'a>>> {
    let meant = |file: &'a InputFile, is_named: bool| Some(Meant { file, is_named });
    match (named, of_kind) {
        (Some(path), _) => {
            let file = files.iter().find(|file| file.path == path);
            let missing = || Error::file(path, "it is not among the files", "add it to them");
            Ok(meant(file.ok_or_else(missing)?, true))
        }
        (None, []) => Ok(None),
        (None, [file]) => Ok(meant(file, false)),
        (None, several) => {
            let names = listed(several.iter().map(|file| &*file.path));
            warnings.push(format!(
                "none of {names} is used: name the one that is meant"
            ));
            Ok(None)
        }
    }
}
