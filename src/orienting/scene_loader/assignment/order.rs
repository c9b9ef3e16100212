//! Photographs that were renamed: nothing is called as the orientation says, and the order of the
//! names is all that is left.

use super::ImageCandidate;
use super::size::SizeFit;
use crate::orienting::orientation::Orientation;

/// The orientation of each image by its place in the order of names. `None` unless that is certain
/// as far as files can tell: as many images as orientations, all in one folder, each of the size
/// that its orientation states, and the names in one order however numbers are read. Whether they
/// show what the orientations see, the images themselves must say.
pub(crate) fn assign_in_order(
    orientations: &[Orientation],
    images: &[ImageCandidate],
) -> Option<Vec<usize>> {
    let folder = |path: &str| path.rsplit_once('/').map(|(folder, _)| folder.to_owned());
    let is_one_folder = images
        .windows(2)
        .all(|two| folder(two[0].path) == folder(two[1].path));
    if images.len() != orientations.len() || !is_one_folder {
        return None;
    }
    let stated: Vec<&str> = orientations.iter().map(|o| &*o.image).collect();
    let paths: Vec<&str> = images.iter().map(|i| i.path).collect();
    let mut of_image = vec![0; images.len()];
    for (image, orientation) in order_of(&paths)?.into_iter().zip(order_of(&stated)?) {
        let size = images[image].size?;
        if SizeFit::new(&orientations[orientation], size) != SizeFit::Equal {
            return None;
        }
        of_image[image] = orientation;
    }
    Some(of_image)
}

/// The indices of names in their order; `None` where 10 stands before 9, or where names repeat.
fn order_of(names: &[&str]) -> Option<Vec<usize>> {
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|&i| names[i]);
    let ascends = |two: &[usize]| counted(names[two[0]]) < counted(names[two[1]]);
    order.windows(2).all(ascends).then_some(order)
}

/// A name in pieces: digits by their number, before everything else.
fn counted(name: &str) -> Vec<(u64, &[u8])> {
    let pieces = name
        .as_bytes()
        .chunk_by(|a, b| a.is_ascii_digit() == b.is_ascii_digit());
    let number = |piece: &[u8]| std::str::from_utf8(piece).ok()?.parse().ok();
    pieces
        .map(|piece| (number(piece).unwrap_or(u64::MAX), piece))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{image, stated};
    use super::*;

    fn assigned(names: &[&str], paths: &[&str]) -> Option<Vec<usize>> {
        let orientations: Vec<Orientation> = names.iter().map(|name| stated(name)).collect();
        let images: Vec<ImageCandidate> = paths.iter().map(|path| image(path)).collect();
        assign_in_order(&orientations, &images)
    }

    #[test]
    fn renamed_photographs_keep_their_order() {
        let names = ["s1_02.jpg", "s1_01.jpg", "s2_01.jpg"];
        let of = |paths: &[&str]| assigned(&names, paths);
        assert_eq!(of(&["x/c.jpg", "x/a.jpg", "x/b.jpg"]), Some(vec![2, 1, 0]));
        assert_eq!(of(&["IMG_8.jpg", "IMG_9.jpg"]), None, "too few");
        assert_eq!(of(&["x/a.jpg", "x/b.jpg", "y/c.jpg"]), None, "two folders");
        let ten = ["IMG_8.jpg", "IMG_9.jpg", "IMG_10.jpg"];
        assert_eq!(of(&ten), None, "10 stands before 8, or behind 9");
        assert_eq!(assigned(&ten, &["a.jpg", "b.jpg", "c.jpg"]), None);
        assert_eq!(of(&["f08.jpg", "f09.jpg", "f10.jpg"]), Some(vec![1, 0, 2]));
        assert_eq!(assigned(&["a", "a", "b"], &["1", "2", "3"]), None, "twice");
    }

    #[test]
    fn every_size_must_be_the_one_that_is_stated() {
        let orientations = ["a", "b"].map(stated);
        let mut images = ["1.jpg", "2.jpg"].map(image);
        assert_eq!(assign_in_order(&orientations, &images), Some(vec![0, 1]));
        images[1].size = Some([4000, 2999]);
        assert_eq!(assign_in_order(&orientations, &images), None);
        images[1].size = None;
        assert_eq!(assign_in_order(&orientations, &images), None);
    }
}
