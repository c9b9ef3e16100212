//! The house: rooms are floors, and what stands above uses what stands below, never the other way
//! round. No files of a room use each other in a circle either, no file is long, no folder crowded.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/source_tree.rs"]
mod source_tree;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use source_tree::{SourceTree, circles};

/// The groups of `src/lib.rs` and the rooms of each, lowest first.
const FLOORS: [(&str, &[&str]); 12] = [
    (
        "base",
        &[
            "math",
            "least_squares",
            "geometry",
            "line_linker",
            "ids",
            "plan_index",
            "execution",
            "json",
            "params",
            "agreement",
            "error",
            "evidence",
            "labelling",
        ],
    ),
    ("photographs", &["raster", "camera"]),
    (
        "orienting",
        &[
            "orientation",
            "structure_from_motion",
            "known",
            "scene",
            "orientation_check",
            "scene_loader",
            "synthetic",
        ],
    ),
    ("lines", &["lines2d", "lines3d", "linematch", "adjustment"]),
    (
        "planes",
        &[
            "photoconsistency",
            "terrain",
            "half_planes",
            "grouping",
            "hypotheses",
            "dense",
            "coplanar",
            "adjacency",
            "objectspace",
        ],
    ),
    (
        "roofs",
        &[
            "model",
            "testing",
            "solids",
            "facets",
            "obstructions",
            "buildings",
            "corrections",
            "walls",
        ],
    ),
    ("results", &["texture", "roof_report", "export", "figures"]),
    // The crate's face: what runs them.
    ("pipeline", &[]),
    ("tiles", &[]),
    ("wasm", &[]),
    ("cli", &[]),
    ("main", &[]),
];

const MOST_LINES: usize = 600;
const MOST_FILES: usize = 15;
const WIDEST_COMMENT: usize = 100;

/// Every file of `src` by its module path, without tests in files of their own.
fn sources() -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    for path in rust_files(Path::new("src")) {
        let module = path.trim_start_matches("src/").trim_end_matches(".rs");
        let module = module.trim_end_matches("/mod").replace('/', "::");
        if module != "lib" {
            files.insert(
                module,
                fs::read_to_string(&path).expect("a file of the tree"),
            );
        }
    }
    files
}

fn rust_files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of the tree") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path.to_string_lossy().replace('\\', "/"));
        }
    }
    found.sort();
    found
}

/// "FILE uses ROOM" for every import of a room that stands above.
fn climbing(tree: &SourceTree, floors: &[(&str, &[&str])]) -> Vec<String> {
    // The list of a group's rooms stands on its highest floor.
    let floor = |module: &str| {
        let mut parts = module.split("::");
        let group = parts.next()?;
        let height = floors.iter().position(|(name, _)| *name == group)?;
        let rooms = floors[height].1;
        let room = match parts.next() {
            Some(room) if !rooms.is_empty() => rooms.iter().position(|r| *r == room)?,
            _ => rooms.len(),
        };
        Some((height, room))
    };
    let mut found = Vec::new();
    for (from, to) in tree.arrows() {
        match (floor(from), floor(to)) {
            (Some(low), Some(high)) if low < high => found.push(format!("{from} uses {to}")),
            (None, _) => found.push(format!("{from} stands on no floor")),
            (_, None) => found.push(format!("{to} stands on no floor")),
            _ => {}
        }
    }
    found.sort();
    found.dedup();
    found
}

#[test]
fn no_import_climbs() {
    let climbing = climbing(&SourceTree::new(&sources()), &FLOORS);
    assert!(climbing.is_empty(), "{}", climbing.join("\n"));
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let circles: Vec<String> = (circles(&SourceTree::new(&sources())).iter())
        .map(|circle| circle.join(" -> "))
        .collect();
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}

#[test]
fn an_import_that_is_turned_back_is_named() {
    let planted = |upper: &str, lower: &str| {
        let files = [
            ("photographs::camera", lower.to_owned()),
            (
                "planes::half_planes",
                "mod sweep;\npub use sweep::Curve;".to_owned(),
            ),
            ("planes::half_planes::sweep", upper.to_owned()),
        ];
        files.map(|(m, s)| (m.to_owned(), s)).into_iter().collect()
    };
    let upper = "use crate::photographs::camera::Camera;\npub struct Curve;";
    let sound: BTreeMap<String, String> = planted(upper, "pub struct Camera;");
    let tree = SourceTree::new(&sound);
    assert!(climbing(&tree, &FLOORS).is_empty());
    assert!(circles(&tree).is_empty());
    // As an import, inside a function, and through a re-export; what only tests use is free.
    for turned in [
        "use crate::planes::half_planes::Curve;\npub struct Camera;",
        "pub struct Camera;\nfn f() { let _ = crate::planes::half_planes::Curve; }",
        "use crate::planes::half_planes::{self};\npub struct Camera;\nfn f(_: half_planes::Curve) {}",
    ] {
        let tree = SourceTree::new(&planted(upper, turned));
        let found = climbing(&tree, &FLOORS);
        let is_named = found
            .iter()
            .all(|f| f.starts_with("photographs::camera uses planes"));
        assert!(is_named && !found.is_empty(), "{turned}: {found:?}");
    }
    let turned = "use crate::planes::half_planes::Curve;\npub struct Camera;";
    assert_eq!(circles(&SourceTree::new(&planted(upper, turned))).len(), 1);
    let in_tests =
        "pub struct Camera;\n#[cfg(test)]\nmod tests { use crate::planes::half_planes::Curve; }";
    assert!(climbing(&SourceTree::new(&planted(upper, in_tests)), &FLOORS).is_empty());
}

#[test]
fn files_are_short_and_folders_are_not_crowded() {
    let mut findings = Vec::new();
    let mut folders: BTreeMap<String, usize> = BTreeMap::new();
    for path in rust_files(Path::new("src")) {
        let text = fs::read_to_string(&path).expect("a file of the tree");
        let lines = text.lines().count();
        if lines > MOST_LINES {
            findings.push(format!("{path}: {lines} lines"));
        }
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
        *folders.entry(folder.to_owned()).or_default() += 1;
    }
    let crowded = folders.iter().filter(|(_, files)| **files > MOST_FILES);
    findings.extend(crowded.map(|(folder, files)| format!("{folder}: {files} files")));
    assert!(findings.is_empty(), "{}", findings.join("\n"));
}

#[test]
fn comments_are_not_wide() {
    let mut findings = Vec::new();
    for path in ["src", "tests", "benches", "examples"]
        .iter()
        .flat_map(|f| rust_files(Path::new(f)))
    {
        let text = fs::read_to_string(&path).expect("a file of the tree");
        for (i, line) in text.lines().enumerate() {
            let is_comment = line.trim_start().starts_with("//");
            // A link cannot be broken.
            if is_comment && line.chars().count() > WIDEST_COMMENT && !line.contains("http") {
                findings.push(format!("{path}:{}", i + 1));
            }
        }
    }
    assert!(findings.is_empty(), "{}", findings.join("\n"));
}
