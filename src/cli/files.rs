//! Reading a scene's folder and writing the results.

use std::fs;
use std::io;
use std::path::Path;

use ridgeline::orientation::InputFile;
use ridgeline::scene_loader::unpack;

use super::Failure;

/// What may be an image.
const IMAGE_EXTENSIONS: [&str; 5] = ["jpg", "jpeg", "png", "tif", "tiff"];

/// What may hold an orientation; the readers look at the content.
const ORIENTATION_EXTENSIONS: [&str; 13] = [
    "txt", "p", "json", "geojson", "xml", "out", "nvm", "camera", "bin", "xyz", "prj", "ori", "zip",
];

/// Largest orientation file that is read, bytes: COLMAP writes some hundred bytes for every tie point.
const MAX_ORIENTATION_BYTES: u64 = 1 << 30;

/// All files below `folder` that may belong to a scene, sorted by path; paths are relative to the folder and
/// have forward slashes. The folder of the results is not a part of the scene, wherever it lies.
pub(super) fn read_scene(folder: &Path, results: &Path) -> Result<Vec<InputFile>, Failure> {
    let mut files = Vec::new();
    if folder.is_file() && is_archive(folder) {
        add(folder, "scene.zip", &mut files)?;
    } else if folder.is_dir() {
        let results = fs::canonicalize(results).ok();
        walk(folder, "", results.as_deref(), &mut files)?;
    } else {
        return Err(Failure::Input(format!(
            "{}: not a folder; give the folder (or .zip archive) that holds the images and their orientation",
            folder.display()
        )));
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(files)
}

/// Writes the files under temporary names first, so that a full disk or an interruption leaves no half
/// a model behind under its final name.
pub(super) fn write_all(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<(), Failure> {
    let failure = |name: &str, e: io::Error| {
        Failure::Output(format!(
            "{}: cannot write: {e}",
            folder.join(name).display()
        ))
    };
    let temporary = |name: &str| folder.join(format!(".{name}.part"));
    let write = || {
        for (name, bytes) in files {
            fs::write(temporary(name), bytes).map_err(|e| failure(name, e))?;
        }
        for (name, _) in files {
            fs::rename(temporary(name), folder.join(name)).map_err(|e| failure(name, e))?;
        }
        Ok(())
    };
    write().inspect_err(|_| {
        // Those that are there: what cannot be removed either was never written.
        for (name, _) in files {
            let _ = fs::remove_file(temporary(name));
        }
    })
}

/// Can a file of this name be written? Asked before hours of work.
pub(super) fn check_writable(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if path.is_dir() || folder.is_some_and(|folder| !folder.is_dir()) {
        let problem = "cannot be written: give a file in a folder that is there";
        return Err(Failure::Input(format!("{}: {problem}", path.display())));
    }
    Ok(())
}

/// Writes one file in the same way.
pub(super) fn write_one(path: &Path, bytes: Vec<u8>) -> Result<(), Failure> {
    let folder = path
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
    let name = name.ok_or_else(|| Failure::Input(format!("{}: names no file", path.display())))?;
    write_all(folder, &[(name, bytes)])
}

/// Adds a file, or those of an archive.
fn add(path: &Path, name: &str, files: &mut Vec<InputFile>) -> Result<(), Failure> {
    let bytes = fs::read(path).map_err(|e| unreadable(path, e))?;
    let unpacked = unpack(InputFile::new(name, bytes));
    files.extend(unpacked.map_err(|e| Failure::Input(e.to_string()))?);
    Ok(())
}

fn unreadable(path: &Path, e: io::Error) -> Failure {
    Failure::Input(format!("{}: cannot read: {e}", path.display()))
}

fn is_archive(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("zip"))
}

fn walk(
    folder: &Path,
    prefix: &str,
    results: Option<&Path>,
    files: &mut Vec<InputFile>,
) -> Result<(), Failure> {
    for entry in fs::read_dir(folder).map_err(|e| unreadable(folder, e))? {
        let entry = entry.map_err(|e| unreadable(folder, e))?;
        let (path, name) = (entry.path(), entry.file_name());
        let name = name.to_string_lossy();
        if name.starts_with('.') {
            continue;
        }
        let relative = format!("{prefix}{name}");
        let kind = entry.file_type().map_err(|e| unreadable(&path, e))?;
        if kind.is_dir() {
            let is_results =
                results.is_some() && fs::canonicalize(&path).ok().as_deref() == results;
            if !is_results {
                walk(&path, &format!("{relative}/"), results, files)?;
            }
        } else if is_wanted(&path) {
            add(&path, &relative, files)?;
        }
    }
    Ok(())
}

/// By extension and size: a folder may hold point clouds and other large things.
fn is_wanted(path: &Path) -> bool {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let Some(extension) = extension.as_deref() else {
        return false;
    };
    let small =
        || fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() <= MAX_ORIENTATION_BYTES);
    IMAGE_EXTENSIONS.contains(&extension)
        || (ORIENTATION_EXTENSIONS.contains(&extension) && small())
}
