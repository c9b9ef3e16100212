//! Reading a scene's folder and writing the results.

use std::fs;
use std::io;
use std::path::Path;

use ridgeline::orientation::InputFile;

use super::failure::Failure;
use super::walk::{self, FolderContents};

/// The files of a scene, sorted by path, and a count of them. The folder of the results is not part
/// of the scene, wherever it lies.
pub(super) fn read_scene(
    folder: &Path,
    results: &Path,
) -> Result<(Vec<InputFile>, FolderContents), Failure> {
    let (mut files, seen) = if folder.is_file() && is_archive(folder) {
        walk::open_archive(folder)?
    } else if folder.is_dir() {
        walk::walk(folder, results)?
    } else {
        return Err(Failure::Input(format!(
            "{}: not a folder; give the folder (or .zip archive) that holds the images and their orientation",
            folder.display()
        )));
    };
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok((files, seen))
}

/// Writes the files under temporary names first, so that a full disk or an interruption leaves no
/// half a model behind under its final name.
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
        // What cannot be removed was never written.
        for (name, _) in files {
            let _ = fs::remove_file(temporary(name));
        }
    })
}

/// Can a file of this name be written? Checked before hours of work.
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

fn is_archive(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("zip"))
}
