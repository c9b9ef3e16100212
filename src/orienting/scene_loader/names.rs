//! The names by which views go, and how messages list names.

use std::collections::BTreeMap;

use crate::orienting::orientation::{InputFile, stem};

/// The names of views: without folders, or with as many as tell them apart.
pub(crate) fn view_names(paths: &[&str]) -> Vec<String> {
    let parts: Vec<Vec<&str>> = paths.iter().map(|p| p.rsplit('/').collect()).collect();
    let mut depths = vec![1; paths.len()];
    let name = |i: usize, depth: usize| {
        let mut parts = parts[i][..depth].to_vec();
        parts.reverse();
        parts.join("/")
    };
    loop {
        let mut same: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (i, &depth) in depths.iter().enumerate() {
            same.entry(name(i, depth)).or_default().push(i);
        }
        let repeated = same.into_values().filter(|views| views.len() > 1);
        let short: Vec<usize> = repeated
            .flatten()
            .filter(|&i| depths[i] < parts[i].len())
            .collect();
        if short.is_empty() {
            return (0..paths.len()).map(|i| name(i, depths[i])).collect();
        }
        for i in short {
            depths[i] += 1;
        }
    }
}

/// Does a file state the system of another one, by its name beside it?
pub(crate) fn belongs_to(stating: &InputFile, other: &InputFile) -> bool {
    let key = |file: &InputFile| stem(file.name()).to_lowercase();
    stating.path != other.path && stating.folder() == other.folder() && key(stating) == key(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_named_by_as_many_folders_as_tell_them_apart() {
        let paths = ["x/a.jpg", "p/c0/1.jpg", "p/c1/1.jpg", "q/c1/1.jpg", "2.jpg"];
        let names = ["a.jpg", "c0/1.jpg", "p/c1/1.jpg", "q/c1/1.jpg", "2.jpg"];
        assert_eq!(view_names(&paths), names);
        assert_eq!(view_names(&["1.jpg", "c/1.jpg"]), ["1.jpg", "c/1.jpg"]);
        assert_eq!(view_names(&["1.jpg", "1.jpg"]), ["1.jpg", "1.jpg"]);
    }
}
