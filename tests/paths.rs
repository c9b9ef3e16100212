//! What documents and comments name exists: paths from the root of the tree in Markdown and in the
//! comments of Rust, TypeScript, Python and shell, and the relative links of Markdown.
#![cfg(not(target_arch = "wasm32"))]

use std::fs;
use std::path::{Component, Path, PathBuf};

/// What a path from the root begins with.
const TOPS: [&str; 8] = [
    "src/",
    "www/",
    "tests/",
    "docs/",
    "benches/",
    "examples/",
    ".cargo/",
    ".github/",
];
/// Made by a build or a run, and ignored by git.
const MADE: [&str; 7] = [
    "www/dist",
    "www/node_modules",
    "www/package/dist",
    "www/public/entrance",
    "www/screenshots",
    "www/src/pkg",
    "www/src/pkg-orient",
];
/// Folders without documents and sources of ours.
const PASSED_OVER: [&str; 5] = [
    "target",
    "node_modules",
    "fixtures",
    "test-results",
    "playwright-report",
];

#[test]
fn what_documents_and_comments_name_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let exists = |path: &str| MADE.iter().any(|made| is_in(path, made)) || root.join(path).exists();
    let mut missing = Vec::new();
    for path in files_in(root) {
        let text = fs::read_to_string(root.join(&path)).expect("text in UTF-8");
        missing.extend(missing_paths(&path, &text, &exists));
    }
    let count = missing.len();
    assert!(
        missing.is_empty(),
        "{count} missing:\n{}",
        missing.join("\n")
    );
}

#[test]
fn a_path_that_leads_nowhere_is_named_with_its_line() {
    let known = [
        "src",
        "src/base/math.rs",
        "docs",
        "docs/rooms/planes.md",
        "docs/rooms/src/b.rs",
    ];
    let exists = |path: &str| known.contains(&path);
    let document = "See `src/base/math.rs` and\n[planes](planes.md#sweep), [out](https://a.b/src/c.rs), [gone](../gone.md).\n\
                    Not `www/src/gone.ts`, `src/NAME.rs`, `src/gone/*.rs`, `src/b.rs` nor (docs/)";
    let expected = [
        "docs/rooms/a.md:2: docs/gone.md",
        "docs/rooms/a.md:3: www/src/gone.ts",
        "docs/rooms/a.md:3: src/gone",
    ];
    assert_eq!(
        missing_paths("docs/rooms/a.md", document, &exists),
        expected
    );
    let rust =
        "let a = \"tests/none\"; /".to_owned() + "/ as in tests/gone.rs.\n//! `src`, xsrc/none";
    assert_eq!(
        missing_paths("src/a.rs", &rust, &exists),
        ["src/a.rs:1: tests/gone.rs"]
    );
    let typescript = "/**\n * `src/gone`\n */\nimport \"../src/none\";";
    assert_eq!(
        missing_paths("www/a.ts", typescript, &exists),
        ["www/a.ts:2: src/gone"]
    );
}

/// "FILE:LINE: PATH" of all that leads nowhere.
fn missing_paths(file: &str, text: &str, exists: &dyn Fn(&str) -> bool) -> Vec<String> {
    let kind = Path::new(file)
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("");
    let mut found = Vec::new();
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    for (line, number) in text.lines().zip(1..) {
        let mut named = named_from_root(said(line, kind));
        named.retain(|path| !exists(&plain(&folder.join(path))));
        if kind == "md" {
            named.extend(linked(line).iter().map(|link| plain(&folder.join(link))));
        }
        named.retain(|path| !exists(path));
        found.extend(named.iter().map(|path| format!("{file}:{number}: {path}")));
    }
    found
}

/// What of a line is said to people: of Markdown and Python (whose docstrings are prose) all, else
/// the comment.
fn said<'a>(line: &'a str, kind: &str) -> &'a str {
    let (mark, trimmed) = match kind {
        "md" | "py" => return line,
        "rs" | "ts" | "tsx" | "mjs" => ("//", line.trim_start()),
        _ => ("#", line.trim_start()),
    };
    if mark == "//" && (trimmed.starts_with('*') || trimmed.starts_with("/*")) {
        return trimmed;
    }
    line.find(mark).map_or("", |at| &line[at..])
}

/// Paths that begin with a folder of the root; of one with a placeholder (`NAME.rs`, `*.json`) the
/// folders before it.
fn named_from_root(text: &str) -> Vec<String> {
    let is_of_path = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    let is_placeholder = |c: char| "*{<$%[".contains(c);
    let words = text.split(|c: char| !is_of_path(c) && !is_placeholder(c));
    let of_root = words.filter(|word| TOPS.iter().any(|top| word.starts_with(top)));
    of_root
        .map(|word| {
            let end = word
                .find(is_placeholder)
                .map_or(word.len(), |at| word[..at].rfind('/').unwrap_or(0));
            let parts = word[..end].trim_end_matches(['.', '-', '/']).split('/');
            parts
                .take_while(|part| !is_capitals(part))
                .collect::<Vec<_>>()
                .join("/")
        })
        .collect()
}

/// `NAME.rs`, but not `README.md`.
fn is_capitals(part: &str) -> bool {
    let stem = part.split('.').next().expect("one part at least");
    stem.len() > 1 && stem != "README" && stem.chars().all(|c| c.is_ascii_uppercase())
}

/// The files that the links of a line lead to.
fn linked(line: &str) -> Vec<&str> {
    let targets = line.split("](").skip(1);
    let paths = targets.filter_map(|target| target.split([')', ' ', '#']).next());
    paths
        .filter(|path| !path.is_empty() && !path.contains(':'))
        .collect()
}

/// The path without `.` and `..`.
fn plain(path: &Path) -> String {
    let mut parts: Vec<String> = Vec::new();
    for component in path.components() {
        match component {
            Component::ParentDir if parts.pop().is_none() => parts.push("..".into()),
            Component::Normal(part) => parts.push(part.to_string_lossy().into_owned()),
            _ => {}
        }
    }
    parts.join("/")
}

fn is_in(path: &str, folder: &str) -> bool {
    path.strip_prefix(folder)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// Documents and sources below a folder, by their path from it, in order.
fn files_in(root: &Path) -> Vec<String> {
    let mut todo = vec![PathBuf::new()];
    let mut found = Vec::new();
    while let Some(folder) = todo.pop() {
        for entry in fs::read_dir(root.join(&folder)).expect("a folder of the tree") {
            let entry = entry.expect("an entry");
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = plain(&folder.join(&name));
            if entry.path().is_dir() {
                let is_hidden =
                    name.starts_with('.') && ![".github", ".ci"].contains(&name.as_str());
                let is_made = MADE.iter().any(|made| is_in(&path, made));
                if !is_hidden && !is_made && !PASSED_OVER.contains(&name.as_str()) {
                    todo.push(path.into());
                }
            } else if is_read(&name) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn is_read(name: &str) -> bool {
    let kinds = ["md", "rs", "ts", "tsx", "mjs", "py", "sh", "toml", "yml"];
    let kind = Path::new(name).extension().and_then(|e| e.to_str());
    name == "Makefile" || kind.is_some_and(|kind| kinds.contains(&kind))
}
