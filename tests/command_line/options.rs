//! Every option that a message names exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The options that the help of a command names.
fn options_of(command: &[&str]) -> BTreeSet<String> {
    let mut ridgeline = Command::new(env!("CARGO_BIN_EXE_ridgeline"));
    let output = ridgeline.args(command).arg("--help").output().unwrap();
    named_in(&crate::printed(&output))
}

/// Words of two dashes in a text, without what looks like one inside a word.
fn named_in(text: &str) -> BTreeSet<String> {
    let of_option = |c: char| c.is_ascii_lowercase() || c == '-';
    let starts = text.match_indices("--").filter(|(at, _)| {
        let before = text[..*at].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && c != '-')
    });
    starts
        .map(|(at, _)| {
            text[at..]
                .chars()
                .take_while(|c| of_option(*c))
                .collect::<String>()
        })
        .filter(|option| option.len() > 3)
        .map(|option| option.trim_end_matches('-').to_owned())
        .collect()
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_option_that_a_message_names_exists() {
    let help = [
        "reconstruct",
        "check",
        "orient",
        "plan",
        "tile",
        "join",
        "report",
        "params",
    ];
    let known: BTreeSet<String> = help
        .iter()
        .flat_map(|command| options_of(&[command]))
        .collect();
    assert!(
        known.contains("--crs") && known.contains("--apply-fix"),
        "{known:?}"
    );
    let mut files = Vec::new();
    rust_files(Path::new("src"), &mut files);
    let mut named = BTreeSet::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        let code = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        for option in code.flat_map(named_in) {
            named.insert((option, file.display().to_string()));
        }
    }
    assert!(named.len() > 5, "{named:?}");
    let unknown: Vec<_> = named
        .iter()
        .filter(|(option, _)| !known.contains(option))
        .collect();
    assert!(unknown.is_empty(), "{unknown:?}");
}

#[test]
fn options_are_told_from_dashes() {
    let of = |text: &str| named_in(text).into_iter().collect::<Vec<_>>();
    assert_eq!(
        of("with --out DIR (--crs EPSG:1), a--b, ---, --"),
        ["--crs", "--out"]
    );
}
