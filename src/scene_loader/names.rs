//! How images and orientations find each other by name, and how messages list names.

use crate::orientation::{Orientation, base_name, stem};

/// How well a name in an orientation file fits an image's; less is better, `None` is not at all.
pub(crate) fn match_rank(oriented: &str, image: &str) -> Option<u8> {
    let name = base_name(oriented);
    let fits = |a: &str, b: &str| {
        if a == b {
            Some(0)
        } else {
            (a.to_lowercase() == b.to_lowercase()).then_some(3)
        }
    };
    [
        fits(name, image),
        fits(name, stem(image)).map(|rank| rank + 1),
        fits(stem(name), stem(image)).map(|rank| rank + 2),
    ]
    .into_iter()
    .flatten()
    .min()
}

/// The orientations that fit an image best.
pub(crate) fn best_match(orientations: &[Orientation], image: &str) -> Vec<usize> {
    let ranks: Vec<Option<u8>> = orientations
        .iter()
        .map(|o| match_rank(&o.image, image))
        .collect();
    let best = ranks.iter().flatten().min();
    (0..ranks.len())
        .filter(|&i| best.is_some() && ranks[i].as_ref() == best)
        .collect()
}

/// Names in a row; long lists are cut short.
pub(crate) fn listed(names: impl Iterator<Item = impl AsRef<str>>) -> String {
    const MOST: usize = 8;
    let names: Vec<String> = names.map(|n| n.as_ref().to_owned()).collect();
    let mut text = names[..names.len().min(MOST)].join(", ");
    if names.len() > MOST {
        text.push_str(&format!(" and {} more", names.len() - MOST));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_name_wins() {
        assert_eq!(match_rank("a/b.jpg", "b.jpg"), Some(0));
        assert_eq!(match_rank("b", "b.jpg"), Some(1));
        assert_eq!(match_rank("b.tif", "b.jpg"), Some(2));
        assert_eq!(match_rank("B.JPG", "b.jpg"), Some(3));
        assert_eq!(
            match_rank("b.c", "b.c.jpg"),
            Some(1),
            "a dot is no extension"
        );
        assert_eq!(match_rank("b.1.tif", "b.2.jpg"), None);
        assert_eq!(match_rank("ab.jpg", "b.jpg"), None);
    }

    #[test]
    fn long_lists_are_cut() {
        assert_eq!(listed(["a", "b"].iter()), "a, b");
        assert!(listed((0..20).map(|i| i.to_string())).ends_with("7 and 12 more"));
    }
}
