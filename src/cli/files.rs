//! Reading a scene's folder and writing the results.

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

use super::failure::Failure;
use super::scene_files::SceneFiles;
use super::walk::{self, FolderContents};

/// The files of a scene, sorted by path, and a count of them. The folder of the results is not part
/// of the scene, wherever it lies.
pub(super) fn read_scene(
    folder: &Path,
    results: &Path,
) -> Result<(SceneFiles, FolderContents), Failure> {
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
    files.files.sort_by(|a, b| a.path.cmp(&b.path));
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

/// Writes a file so that it is there whole or not at all, also when the process is killed or the
/// machine stops: under a temporary name of this process, to the disk, then renamed.
pub(super) fn write_durably(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failure = |e: io::Error| Failure::Output(format!("{}: cannot write: {e}", path.display()));
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(failure)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let prefix = format!(".{name}.");
    let temporary = folder.join(format!("{prefix}{}", std::process::id()));
    let write = || {
        let mut file = fs::File::create(&temporary)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&temporary, path)
    };
    write().map_err(|e| {
        // What cannot be removed was never written.
        let _ = fs::remove_file(&temporary);
        failure(e)
    })?;
    // The name is on the disk when the folder is; not every system lets folders be opened.
    if let Ok(folder) = fs::File::open(folder) {
        let _ = folder.sync_all();
    }
    // What killed processes have left of this file.
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(&prefix) {
            let _ = fs::remove_file(entry.path());
        }
    }
    Ok(())
}

fn is_archive(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("zip"))
}
