//! The files below a scene's folder, symbolic links followed, and a count of what the folder holds.

use std::collections::{BTreeMap, HashSet, VecDeque};
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use ridgeline::orienting::orientation::{FileKind, detect};
use ridgeline::orienting::scene_loader::unpack;

use super::failure::Failure;
use super::scene_files::SceneFiles;

/// Extensions of images.
const IMAGE_EXTENSIONS: [&str; 5] = ["jpg", "jpeg", "png", "tif", "tiff"];

/// Extensions of orientation files and of what is known beforehand; the readers go by the content.
const OTHER_EXTENSIONS: [&str; 21] = [
    "txt", "p", "json", "geojson", "xml", "out", "nvm", "camera", "bin", "xyz", "prj", "ori",
    "zip", "las", "laz", "asc", "geojsonl", "geojsons", "jsonl", "ndjson", "ldjson",
];

/// Largest file beside the photographs that is read, bytes: COLMAP writes some hundred bytes for
/// every tie point.
const MAX_OTHER_BYTES: u64 = 1 << 30;

/// Most links that one notice names; the others are counted.
const MOST_NAMED: usize = 5;

/// What a folder or an archive holds.
#[derive(Default)]
pub(super) struct FolderContents {
    /// Files that were read, by kind.
    read: BTreeMap<String, usize>,
    /// Files that no reader takes, by kind.
    unread: BTreeMap<String, usize>,
    broken: Vec<String>,
    cycles: Vec<String>,
    duplicates: Vec<String>,
    /// Reference systems of files that no reader takes, each with its file.
    of_unread: Vec<String>,
}

impl FolderContents {
    /// One sentence for each kind of link that was not followed.
    pub(super) fn notices(&self) -> Vec<String> {
        let sorts = [
            (&self.broken, "links that lead nowhere, left out"),
            (&self.cycles, "links to folders around them, not followed"),
            (&self.duplicates, "links to what is read already, left out"),
            (
                &self.of_unread,
                "reference systems of files that are not read, left out",
            ),
        ];
        let sentence = |(links, what): (&Vec<String>, &str)| {
            let named = links[..links.len().min(MOST_NAMED)].join(", ");
            let more = match links.len().saturating_sub(MOST_NAMED) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            format!("{what}: {named}{more}")
        };
        let given = sorts.into_iter().filter(|(links, _)| !links.is_empty());
        given.map(sentence).collect()
    }
}

/// As "12 JPEG, 2 text; not read: 1 PDF".
impl fmt::Display for FolderContents {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let listed = |counts: &BTreeMap<String, usize>| {
            let mut counts: Vec<_> = counts.iter().collect();
            counts.sort_by_key(|&(kind, &count)| (std::cmp::Reverse(count), kind.clone()));
            let parts: Vec<_> = counts.iter().map(|(k, n)| format!("{n} {k}")).collect();
            parts.join(", ")
        };
        match (self.read.is_empty(), self.unread.is_empty()) {
            (true, true) => write!(f, "no files"),
            (false, true) => write!(f, "{}", listed(&self.read)),
            (true, false) => write!(f, "none that is read; not read: {}", listed(&self.unread)),
            (false, false) => write!(
                f,
                "{}; not read: {}",
                listed(&self.read),
                listed(&self.unread)
            ),
        }
    }
}

/// All files below `folder` that may belong to a scene, in no order; paths are relative to the
/// folder and have forward slashes. Each folder is read once, under its own path rather than a
/// link's. The folder `results` is left out.
pub(super) fn walk(folder: &Path, results: &Path) -> Result<(SceneFiles, FolderContents), Failure> {
    let mut walk = FolderWalk {
        // An empty path (no results are written) is none.
        results: fs::canonicalize(results).ok(),
        ..FolderWalk::default()
    };
    walk.folder(folder, "", &real_path(folder)?)?;
    while let Some(link) = walk.links.pop_front() {
        walk.follow(&link)?;
    }
    walk.leave_out_systems_of_unread();
    Ok((walk.files, walk.seen))
}

/// The files of an archive that is the whole scene.
pub(super) fn open_archive(path: &Path) -> Result<(SceneFiles, FolderContents), Failure> {
    let mut walk = FolderWalk::default();
    walk.add(path, "scene.zip")?;
    Ok((walk.files, walk.seen))
}

/// A link that is followed after everything in the scene's own folders has been read.
struct PendingLink {
    path: PathBuf,
    relative: String,
    /// The folder that contains it, as a path without links.
    parent: PathBuf,
}

#[derive(Default)]
struct FolderWalk {
    results: Option<PathBuf>,
    /// Folders and files that were reached, as paths without links.
    reached: HashSet<PathBuf>,
    links: VecDeque<PendingLink>,
    /// Paths of the files that no reader takes.
    unread: Vec<String>,
    files: SceneFiles,
    seen: FolderContents,
}

impl FolderWalk {
    /// Reads a folder; `real` is its path without links.
    fn folder(&mut self, folder: &Path, prefix: &str, real: &Path) -> Result<(), Failure> {
        self.reached.insert(real.to_owned());
        let entries = fs::read_dir(folder).map_err(|e| unreadable(folder, e))?;
        let entries: io::Result<Vec<_>> = entries.collect();
        let mut entries = entries.map_err(|e| unreadable(folder, e))?;
        entries.sort_by_key(fs::DirEntry::file_name);
        for entry in entries {
            let (path, name) = (entry.path(), entry.file_name());
            let shown = name.to_string_lossy();
            if shown.starts_with('.') {
                continue;
            }
            let relative = format!("{prefix}{shown}");
            let kind = entry.file_type().map_err(|e| unreadable(&path, e))?;
            if kind.is_symlink() {
                self.links.push_back(PendingLink {
                    path,
                    relative,
                    parent: real.to_owned(),
                });
            } else if kind.is_dir() {
                self.enter(&path, &relative, &real.join(&name))?;
            } else if kind.is_file() {
                self.file(&path, &relative, real.join(&name))?;
            }
        }
        Ok(())
    }

    fn enter(&mut self, path: &Path, relative: &str, real: &Path) -> Result<(), Failure> {
        if self.results.as_deref() == Some(real) {
            return Ok(());
        }
        if self.reached.contains(real) {
            self.seen.duplicates.push(relative.to_owned());
            return Ok(());
        }
        self.folder(path, &format!("{relative}/"), real)
    }

    fn follow(&mut self, link: &PendingLink) -> Result<(), Failure> {
        let named = || {
            let target = fs::read_link(&link.path).unwrap_or_default();
            format!("{} -> {}", link.relative, target.display())
        };
        let target = match fs::canonicalize(&link.path) {
            Ok(target) => target,
            Err(e) if e.kind() == io::ErrorKind::PermissionDenied => {
                return Err(unreadable(&link.path, e));
            }
            // The target is missing, or the links lead to each other.
            Err(_) => {
                self.seen.broken.push(named());
                return Ok(());
            }
        };
        let kind = fs::metadata(&target).map_err(|e| unreadable(&link.path, e))?;
        if kind.is_dir() {
            if link.parent.starts_with(&target) {
                self.seen.cycles.push(named());
                return Ok(());
            }
            if self.reached.contains(&target) {
                self.seen.duplicates.push(named());
                return Ok(());
            }
            return self.enter(&link.path, &link.relative, &target);
        }
        // A link of another name gives the file that name; one of the same name would only make it
        // ambiguous.
        let same_name = link.path.file_name() == target.file_name();
        if same_name && self.reached.contains(&target) {
            self.seen.duplicates.push(named());
        } else if kind.is_file() {
            self.file(&link.path, &link.relative, target)?;
        }
        Ok(())
    }

    fn file(&mut self, path: &Path, relative: &str, real: PathBuf) -> Result<(), Failure> {
        self.reached.insert(real);
        if is_wanted(path) {
            return self.add(path, relative);
        }
        *self.seen.unread.entry(kind_of(relative)).or_default() += 1;
        self.unread.push(relative.to_owned());
        Ok(())
    }

    /// A `.prj` belongs to the file of its name, though that is none that is read (a shapefile).
    fn leave_out_systems_of_unread(&mut self) {
        let is_called = |path: &str, other: &str| {
            Path::new(path).with_extension("") == Path::new(other).with_extension("")
        };
        let read: Vec<String> = self.files.files.iter().map(|f| f.path.clone()).collect();
        let of_unread = &mut self.seen.of_unread;
        self.files.files.retain(|file| {
            let is_alone = || {
                read.iter()
                    .filter(|path| is_called(path, &file.path))
                    .count()
                    == 1
            };
            let is_system = extension(Path::new(&file.path)).as_deref() == Some("prj")
                && detect(file) == FileKind::ReferenceSystem;
            let mut unread = self.unread.iter().filter(|_| is_system && is_alone());
            let of = unread.find(|path| is_called(path, &file.path));
            of_unread.extend(of.map(|of| format!("{} of {of}", file.path)));
            of.is_none()
        });
    }

    /// Adds a file, or those of an archive.
    fn add(&mut self, path: &Path, relative: &str) -> Result<(), Failure> {
        let read = self.files.read(path, relative);
        let unpacked = unpack(read.map_err(|e| unreadable(path, e))?);
        for file in unpacked.map_err(|e| Failure::Input(e.to_string()))? {
            *self.seen.read.entry(kind_of(&file.path)).or_default() += 1;
            self.files.files.push(file);
        }
        Ok(())
    }
}

fn real_path(path: &Path) -> Result<PathBuf, Failure> {
    fs::canonicalize(path).map_err(|e| unreadable(path, e))
}

fn unreadable(path: &Path, e: io::Error) -> Failure {
    Failure::Input(format!("{}: cannot read: {e}", path.display()))
}

fn extension(path: &Path) -> Option<String> {
    path.extension().map(|e| e.to_string_lossy().to_lowercase())
}

/// By extension and size: a folder may hold clouds of whole flights and other large files.
fn is_wanted(path: &Path) -> bool {
    let Some(extension) = extension(path) else {
        return false;
    };
    let small = || fs::metadata(path).is_ok_and(|m| m.len() <= MAX_OTHER_BYTES);
    IMAGE_EXTENSIONS.contains(&&*extension) || (OTHER_EXTENSIONS.contains(&&*extension) && small())
}

/// The usual name of a kind of file.
fn kind_of(path: &str) -> String {
    match extension(Path::new(path)).as_deref() {
        Some("jpg" | "jpeg") => "JPEG".into(),
        Some("tif" | "tiff") => "TIFF".into(),
        Some("txt") => "text".into(),
        Some(other) => other.to_uppercase(),
        None => "without extension".into(),
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::os::unix::fs::symlink;

    use ridgeline::orienting::orientation::InputFile;

    use super::*;

    /// A folder `scene` beside a folder `data`, of files that hold their own path.
    fn planted(paths: &[&str], links: &[(&str, &str)]) -> tempfile::TempDir {
        let top = tempfile::tempdir().unwrap();
        for folder in ["scene", "data"] {
            fs::create_dir(top.path().join(folder)).unwrap();
        }
        for path in paths {
            let full = top.path().join(path);
            fs::create_dir_all(full.parent().unwrap()).unwrap();
            fs::write(full, path).unwrap();
        }
        for (link, target) in links {
            symlink(target, top.path().join(link)).unwrap();
        }
        top
    }

    /// Each file that is read with its content, as "path = content", sorted; and what was seen.
    fn walked(top: &tempfile::TempDir) -> (Vec<String>, FolderContents) {
        let results = top.path().join("scene/results");
        let (files, seen) = walk(&top.path().join("scene"), &results)
            .unwrap_or_else(|_| panic!("the folder can be read"));
        let shown = |f: InputFile| format!("{} = {}", f.path, String::from_utf8_lossy(&f.bytes));
        let mut files: Vec<_> = files.files.into_iter().map(shown).collect();
        files.sort();
        (files, seen)
    }

    #[test]
    fn linked_folders_and_files_are_read_under_the_names_of_the_links() {
        let top = planted(
            &["data/flight/b.jpg", "data/flight/deep/c.PNG", "data/o.txt"],
            &[
                ("scene/images", "../data/flight"),
                ("scene/exterior.txt", "../data/o.txt"),
                ("scene/a.jpg", "../data/flight/b.jpg"),
            ],
        );
        let (files, seen) = walked(&top);
        let expected = [
            "a.jpg = data/flight/b.jpg",
            "exterior.txt = data/o.txt",
            "images/b.jpg = data/flight/b.jpg",
            "images/deep/c.PNG = data/flight/deep/c.PNG",
        ];
        assert_eq!(files, expected);
        assert_eq!(seen.to_string(), "2 JPEG, 1 PNG, 1 text");
        assert!(seen.notices().is_empty());
    }

    #[test]
    fn circles_end() {
        let top = planted(
            &["scene/a.jpg", "data/x/b.jpg"],
            &[
                ("scene/again", "."),
                ("scene/up", ".."),
                ("scene/x", "../data/x"),
                // Out of the scene and back into it.
                ("data/x/back", "../../scene"),
                ("data/x/above", "../../data"),
            ],
        );
        let (files, seen) = walked(&top);
        assert_eq!(files, ["a.jpg = scene/a.jpg", "x/b.jpg = data/x/b.jpg"]);
        let cycles = ["again -> .", "up -> ..", "x/above -> ../../data"];
        assert_eq!(seen.cycles, cycles);
        assert_eq!(seen.duplicates, ["x/back -> ../../scene"]);
    }

    #[test]
    fn a_folder_that_two_links_reach_is_read_once_and_under_its_own_path_if_it_has_one() {
        let top = planted(
            &["data/x/b.jpg", "scene/z/c.jpg", "scene/z/d.jpg"],
            &[
                ("scene/first", "../data/x"),
                ("scene/second", "../data/x"),
                ("scene/a", "z"),
                ("scene/c.jpg", "z/c.jpg"),
                // Another name for the same file.
                ("scene/e.jpg", "z/d.jpg"),
            ],
        );
        let (files, seen) = walked(&top);
        let expected = [
            "e.jpg = scene/z/d.jpg",
            "first/b.jpg = data/x/b.jpg",
            "z/c.jpg = scene/z/c.jpg",
            "z/d.jpg = scene/z/d.jpg",
        ];
        assert_eq!(files, expected);
        let duplicates = ["a -> z", "c.jpg -> z/c.jpg", "second -> ../data/x"];
        assert_eq!(seen.duplicates, duplicates);
    }

    #[test]
    fn broken_links_are_named_and_the_results_are_passed_by() {
        let top = planted(
            &["scene/a.jpg", "scene/results/model_atlas.jpg"],
            &[
                ("scene/gone.jpg", "../data/gone.jpg"),
                ("scene/this", "that"),
                ("scene/that", "this"),
                ("scene/earlier", "results"),
            ],
        );
        let (files, seen) = walked(&top);
        assert_eq!(files, ["a.jpg = scene/a.jpg"]);
        let broken = "links that lead nowhere, left out: \
                      gone.jpg -> ../data/gone.jpg, that -> this, this -> that";
        assert_eq!(seen.notices(), [broken]);
    }

    #[test]
    fn clouds_and_grids_are_read_and_systems_of_unread_files_are_not() {
        let top = planted(
            &[
                "scene/a.laz",
                "scene/b.LAS",
                "scene/c.asc",
                "scene/d.geojsonl",
                "scene/e.city.jsonl",
                "scene/houses.shp",
                "scene/flight.docx",
            ],
            &[],
        );
        let wkt = "PROJCS[\"x\",AUTHORITY[\"EPSG\",\"31467\"]]";
        for name in ["houses", "c", "site"] {
            fs::write(top.path().join(format!("scene/{name}.prj")), wkt).unwrap();
        }
        // INPHO's projects have the same extension.
        fs::write(top.path().join("scene/flight.prj"), "$PROJECT 6\n").unwrap();
        let (files, seen) = walked(&top);
        let names: Vec<&str> = files
            .iter()
            .map(|f| f.split(" = ").next().unwrap())
            .collect();
        let expected = [
            "a.laz",
            "b.LAS",
            "c.asc",
            "c.prj",
            "d.geojsonl",
            "e.city.jsonl",
            "flight.prj",
            "site.prj",
        ];
        assert_eq!(names, expected);
        let said =
            "reference systems of files that are not read, left out: houses.prj of houses.shp";
        assert_eq!(seen.notices(), [said]);
    }

    #[test]
    fn what_was_seen_is_counted_by_kind_and_long_lists_are_cut() {
        let counted = planted(
            &[
                "scene/a.jpeg",
                "scene/b.JPG",
                "scene/c.p",
                "scene/d.pdf",
                "scene/LICENSE",
                "scene/.hidden.jpg",
            ],
            &[],
        );
        assert_eq!(
            walked(&counted).1.to_string(),
            "2 JPEG, 1 P; not read: 1 PDF, 1 without extension"
        );
        assert_eq!(walked(&planted(&[], &[])).1.to_string(), "no files");
        let seen = FolderContents {
            duplicates: (0..7).map(|i| i.to_string()).collect(),
            ..FolderContents::default()
        };
        let notice = "links to what is read already, left out: 0, 1, 2, 3, 4 and 2 more";
        assert_eq!(seen.notices(), [notice]);
    }
}
