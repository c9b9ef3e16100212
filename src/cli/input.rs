//! A scene as the arguments name it: its files, options and parameters.

use std::fs;
use std::path::{Path, PathBuf};

use ridgeline::base::params::{Correction, Params, corrections_from_json};
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene_loader::{LoadOptions, Project, open_project};

use super::args::InputArgs;
use super::failure::Failure;
use super::files;
use super::scene_files::SceneFiles;

/// A scene's files, options and parameters.
pub(super) struct OpenedScene {
    pub files: SceneFiles,
    pub options: LoadOptions,
    pub params: Params,
    /// Kinds and numbers of the files, in a sentence.
    pub seen: String,
}

/// A refusal of a scene, with a count of its files.
pub(super) fn refusal(error: &ridgeline::Error, seen: &str) -> Failure {
    Failure::Input(format!("{error}\n{seen}"))
}

/// Reads the files. What the arguments leave out is as in the project, where one is opened.
pub(super) fn open(
    args: &InputArgs,
    given: StatedFiles,
    results: &Path,
) -> Result<OpenedScene, Failure> {
    set_threads(args.threads);
    let ReadFiles {
        mut files,
        project,
        beside,
        seen,
    } = read_files(&args.scene, args.orientation.as_deref(), results)?;
    leave_out(&mut files.files, &args.without).map_err(|e| refusal(&e, &seen))?;
    let stated = project.options;
    let known = |files: &mut SceneFiles, path: &Option<PathBuf>| {
        let path = path.as_deref();
        path.map(|path| add_known(&mut files.files, path))
            .transpose()
    };
    let terrain = known(&mut files, &args.terrain)?;
    let footprints = known(&mut files, &args.footprints)?;
    let point_cloud = known(&mut files, &args.point_cloud)?;
    let options = LoadOptions {
        orientation: beside
            .or_else(|| Some(below(&args.scene, args.orientation.as_deref()?)))
            .or(stated.orientation),
        views: args.views.clone().or(stated.views),
        roi: args.roi.or(stated.roi),
        max_views: args.max_views.map(usize::from).or(stated.max_views),
        ground_z: args.ground_z.or(stated.ground_z),
        ground_range: stated.ground_range,
        reduction: args.reduce.or(stated.reduction),
        terrain: terrain.or(stated.terrain),
        terrain_accuracy_m: args.terrain_accuracy.or(stated.terrain_accuracy_m),
        footprints: footprints.or(stated.footprints),
        footprint_accuracy_m: args.footprint_accuracy.or(stated.footprint_accuracy_m),
        point_cloud: point_cloud.or(stated.point_cloud),
        point_cloud_accuracy_m: args.point_cloud_accuracy.or(stated.point_cloud_accuracy_m),
        unused: stated.unused,
        epsg: args.crs.or(stated.epsg),
        memory_mb: args.memory.or(stated.memory_mb),
        apply_fix: args.apply_fix || stated.apply_fix,
        ignore_check: args.ignore_check || stated.ignore_check,
    };
    Ok(OpenedScene {
        files,
        options,
        params: with_switches(given, project.params, args),
        seen,
    })
}

/// The files of a scene.
pub(super) struct ReadFiles {
    pub files: SceneFiles,
    /// What they say of a run, where they are those of a project.
    project: Project,
    /// Where the files of an orientation beside the scene were put.
    beside: Option<String>,
    /// Kinds and numbers of the files, in a sentence.
    pub seen: String,
}

/// Reads a scene, and the orientation where that lies in another folder.
pub(super) fn read_files(
    scene: &Path,
    orientation: Option<&str>,
    results: &Path,
) -> Result<ReadFiles, Failure> {
    let (mut files, seen) = files::read_scene(scene, results)?;
    for notice in seen.notices() {
        eprintln!("warning: {notice}");
    }
    let beside = orientation.map(Path::new);
    let beside = beside.filter(|path| path.is_dir() && !lies_in(path, scene));
    let beside = match beside {
        Some(path) => Some(add_orientation(&mut files.files, path)?),
        None => None,
    };
    let seen = format!("{} holds {seen}", scene.display());
    let inner = std::mem::take(&mut files.files);
    let (inner, project) = open_project(inner).map_err(|e| refusal(&e, &seen))?;
    Ok(ReadFiles {
        files: files.with(inner),
        project: project.unwrap_or_default(),
        beside,
        seen,
    })
}

/// The parameters, with what the arguments say of them.
fn with_switches(given: StatedFiles, stated: Params, args: &InputArgs) -> Params {
    let mut params = given.params.unwrap_or(stated);
    if let Some(corrections) = given.corrections {
        params.corrections = corrections;
    }
    if args.adjust || args.no_adjust {
        params.adjustment.enabled = args.adjust;
    }
    params
}

/// Is a folder the scene's or one within it?
fn lies_in(folder: &Path, scene: &Path) -> bool {
    match (fs::canonicalize(folder), fs::canonicalize(scene)) {
        (Ok(folder), Ok(scene)) => folder.starts_with(scene),
        _ => true,
    }
}

/// Adds the orientation files of a folder beside the scene (as `orient` writes one), under a folder
/// of their own, whose name is returned.
fn add_orientation(files: &mut Vec<InputFile>, folder: &Path) -> Result<String, Failure> {
    let (beside, _) = files::read_scene(folder, Path::new(""))?;
    let name = format!(
        "{}/",
        folder.file_name().unwrap_or_default().to_string_lossy()
    );
    let is_image =
        |file: &InputFile| ridgeline::photographs::raster::image_format(&file.bytes).is_some();
    let orientations = beside.files.into_iter().filter(|file| !is_image(file));
    files.extend(orientations.map(|file| {
        let path = format!("{name}{}", file.path);
        InputFile::new(&path, file.bytes)
    }));
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(name)
}

/// Adds a file of what is known, under a folder of its own, and the `.prj` of its name beside it;
/// its path there is returned.
pub(super) fn add_known(files: &mut Vec<InputFile>, path: &Path) -> Result<String, Failure> {
    let known = |path: &Path, bytes: Vec<u8>| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        InputFile::new(&format!("known/{name}"), bytes)
    };
    let bytes = fs::read(path).map_err(|e| {
        let problem = format!("{}: cannot be read: {e}; check the path", path.display());
        Failure::Input(problem)
    })?;
    let file = known(path, bytes);
    let own = file.path.clone();
    let beside = ["prj", "PRJ"].map(|extension| path.with_extension(extension));
    let beside = beside
        .iter()
        .find_map(|path| Some(known(path, fs::read(path).ok()?)));
    for file in [Some(file), beside].into_iter().flatten() {
        // It takes the place of the one that a project held, and of itself among the scene's files.
        let is_it = |other: &InputFile| other.name() == file.name() && other.bytes == file.bytes;
        files.retain(|other| other.path != file.path && !is_it(other));
        files.push(file);
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(own)
}

/// Leaves out the files that patterns name; one that names none is refused.
fn leave_out(files: &mut Vec<InputFile>, patterns: &[String]) -> ridgeline::Result<()> {
    for pattern in patterns {
        let before = files.len();
        let wanted = pattern.replace('\\', "/");
        let wanted = wanted.trim_start_matches("./").trim_end_matches('/');
        let folder = format!("{wanted}/");
        files.retain(|file| {
            let is_named = fits(wanted, &file.path) || fits(wanted, file.name());
            !is_named && !file.path.starts_with(&folder)
        });
        if files.len() == before {
            return Err(ridgeline::Error::scene(
                format!("--without {pattern} names none of the files"),
                "give a path in the scene, a name, or a pattern with * and ?",
            ));
        }
    }
    Ok(())
}

/// Does a name fit a pattern, where * stands for any letters and ? for one?
fn fits(pattern: &str, name: &str) -> bool {
    let mut rest = pattern.chars();
    match (rest.next(), name.chars().next()) {
        (None, first) => first.is_none(),
        (Some('*'), first) => {
            let after = first.map(|c| &name[c.len_utf8()..]);
            fits(rest.as_str(), name) || after.is_some_and(|after| fits(pattern, after))
        }
        (Some(c), Some(first)) => {
            (c == '?' || c == first) && fits(rest.as_str(), &name[first.len_utf8()..])
        }
        (Some(_), None) => false,
    }
}

/// A path relative to the scene's folder, also where the whole path was given.
fn below(scene: &Path, path: &str) -> String {
    let inner = Path::new(path).strip_prefix(scene);
    inner.map_or_else(
        |_| path.to_owned(),
        |inner| inner.to_string_lossy().into_owned(),
    )
}

/// What arguments name in files of their own.
pub(super) struct StatedFiles {
    params: Option<Params>,
    corrections: Option<Vec<Correction>>,
}

/// The parameters of `--params` and the corrections of `--corrections`.
pub(super) fn read_params(args: &InputArgs) -> Result<StatedFiles, Failure> {
    let bad =
        |path: &Path, problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let read =
        |path: &Path| fs::read_to_string(path).map_err(|e| bad(path, format!("cannot read: {e}")));
    let params = |path: &PathBuf| {
        Params::from_json(&read(path)?).map_err(|e| {
            let advice = "`ridgeline params` prints all parameters with their defaults";
            bad(path, format!("{e}; {advice}"))
        })
    };
    let corrections = |path: &PathBuf| {
        corrections_from_json(&read(path)?).map_err(|e| {
            let advice = "it takes the list of corrections that the page saves";
            bad(path, format!("{e}; {advice}"))
        })
    };
    Ok(StatedFiles {
        params: args.params.as_ref().map(params).transpose()?,
        corrections: args.corrections.as_ref().map(corrections).transpose()?,
    })
}

pub(super) fn set_threads(threads: Option<u16>) {
    if let Some(threads) = threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global()
            .expect("the pool is set once, before its first use");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_name_files_by_path_name_and_folder() {
        let paths = [
            "a.laz",
            "odm_dem/dsm.tif",
            "odm_dem/dtm.tif",
            "images/b.jpg",
        ];
        for (pattern, left) in [
            ("*.laz", vec![1, 2, 3]),
            ("dsm.tif", vec![0, 2, 3]),
            ("odm_dem/d?m.tif", vec![0, 3]),
            ("odm_dem", vec![0, 3]),
            ("./odm_dem/", vec![0, 3]),
            ("odm*", vec![0, 3]),
            ("*d*m.t*f", vec![0, 3]),
            ("images\\b.jpg", vec![0, 1, 2]),
        ] {
            let mut files = paths.map(|path| InputFile::new(path, Vec::new())).to_vec();
            leave_out(&mut files, &[pattern.to_owned()]).unwrap();
            let found: Vec<&str> = files.iter().map(|file| &*file.path).collect();
            let expected: Vec<&str> = left.into_iter().map(|i| paths[i]).collect();
            assert_eq!(found, expected, "{pattern}");
        }
        let mut files = vec![InputFile::new("a.laz", Vec::new())];
        let none = leave_out(&mut files, &["*.las".to_owned()]);
        assert!(none.unwrap_err().to_string().contains("names none"));
    }

    #[test]
    fn a_file_that_an_option_names_counts_once_though_it_lies_in_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("dtm.tif");
        fs::write(&path, b"heights").unwrap();
        let mut files = [
            ("a/dtm.tif", "heights"),
            ("b/dtm.tif", "others"),
            ("c.tif", "heights"),
        ]
        .map(|(path, text)| InputFile::new(path, text.into()))
        .to_vec();
        let Ok(own) = add_known(&mut files, &path) else {
            panic!("it is there")
        };
        let paths: Vec<&str> = files.iter().map(|file| &*file.path).collect();
        assert_eq!(own, "known/dtm.tif");
        assert_eq!(paths, ["b/dtm.tif", "c.tif", "known/dtm.tif"]);
    }

    #[test]
    fn a_whole_path_counts_from_the_scene() {
        let scene = Path::new("data/scene");
        assert_eq!(below(scene, "data/scene/a/cameras.json"), "a/cameras.json");
        assert_eq!(below(scene, "cameras.json"), "cameras.json");
        assert_eq!(below(scene, "data/scenery/a.json"), "data/scenery/a.json");
    }
}
