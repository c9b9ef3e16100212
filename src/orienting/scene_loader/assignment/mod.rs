//! The best assignment of orientations to images: at most one each.
//!
//! ```text
//! order       photographs that were renamed
//! size        images of another size than their orientation states
//! ```
//!
//! Every image that may be meant by the name that an orientation states is a candidate: masks,
//! undistorted twins and thumbnails are called like the photograph. The closest pair is assigned
//! first. Pairs that are equally close are ambiguous where they share an image or an orientation.

mod order;
mod size;
#[cfg(test)]
mod tests;

pub(super) use order::assign_in_order;
pub(super) use size::{factor_in_words, resized, scale};

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use self::size::SizeFit;
use crate::orienting::orientation::{NameEnding, NameFit, Orientation, PathName};

/// An image that may be given an orientation.
#[derive(Clone)]
pub(crate) struct ImageCandidate<'a> {
    pub path: &'a str,
    /// `None` where its header cannot be read.
    pub size: Option<[u32; 2]>,
    /// A PNG without colours, as masks and depth maps are.
    pub is_gray_png: bool,
}

/// Which image has which orientation.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Assignment {
    /// The orientation of each image.
    pub of_image: Vec<Option<usize>>,
    /// Why an image was left out whose name fits.
    pub left_out: Vec<Option<LeftOut>>,
    /// What cannot be told apart.
    pub ambiguous: Vec<Ambiguity>,
}

/// Why an image was left out whose name fits an orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LeftOut {
    /// This image fits better.
    For(usize),
    /// The other images of its folder are copies or masks of photographs.
    WithCopies,
}

/// Images and orientations that fit each other equally well.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Ambiguity {
    pub images: BTreeSet<usize>,
    pub orientations: BTreeSet<usize>,
}

/// How close an orientation and an image are; less is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    is_appended: bool,
    folders: Reverse<usize>,
    size: SizeFit,
    ending: NameEnding,
    is_elsewhere: bool,
    /// By the folder that holds the image, among equal names.
    folder: FolderKind,
    is_gray_png: bool,
    /// How many folders, from the outermost inwards, the image shares with the orientation file.
    near: Reverse<usize>,
}

/// What the name of a folder says of its images: data sets of 3D Gaussian splatting and nerfstudio
/// hold the photographs of the model in `images`, and copies of the same names beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum FolderKind {
    /// `images`.
    Images,
    Other,
    /// `input` (before distortion was removed), or reduced by what the name ends with, `images_4`.
    Copies,
}

impl FolderKind {
    fn of(path: &str) -> Self {
        let mut parts = path.rsplit('/').skip(1);
        let folder = parts.next().unwrap_or_default().to_ascii_lowercase();
        let reduced = folder.rsplit_once('_').map(|(_, factor)| factor);
        match reduced.is_some_and(|factor| factor.parse::<u8>().is_ok()) {
            _ if folder == "images" => Self::Images,
            is_reduced if is_reduced || folder == "input" => Self::Copies,
            _ => Self::Other,
        }
    }
}

/// A candidate.
#[derive(Clone, Copy)]
struct Pair {
    rank: Rank,
    image: usize,
    orientation: usize,
}

/// Assigns orientations to images.
pub(crate) fn assign(orientations: &[Orientation], images: &[ImageCandidate]) -> Assignment {
    let names: Vec<PathName> = images.iter().map(|i| PathName::new(i.path)).collect();
    let keys: Vec<String> = names.iter().map(|name| name.keys()[0].clone()).collect();
    let pairs = pairs(orientations, images, &names, &keys);
    let mut found = Assignment {
        of_image: vec![None; images.len()],
        left_out: vec![None; images.len()],
        ambiguous: Vec::new(),
    };
    let mut image_of: Vec<Option<usize>> = vec![None; orientations.len()];
    let mut unclear = Ambiguity::default();
    // Where a name repeats, the most folders by which one of them was told from the others.
    let mut told_by: HashMap<&str, usize> = HashMap::new();
    for level in pairs.chunk_by(|a, b| a.rank == b.rank) {
        let is_open = |p: &&Pair| {
            let is_told = p.rank.is_elsewhere
                && told_by
                    .get(&*keys[p.image])
                    .is_some_and(|&n| n > p.rank.folders.0);
            let is_free = found.of_image[p.image].is_none() && image_of[p.orientation].is_none();
            let is_clear = !unclear.images.contains(&p.image)
                && !unclear.orientations.contains(&p.orientation);
            is_free && is_clear && !is_told
        };
        let open: Vec<Pair> = level.iter().filter(is_open).copied().collect();
        let (mut of_images, mut of_orientations) = (BTreeMap::new(), BTreeMap::new());
        for pair in &open {
            *of_images.entry(pair.image).or_insert(0) += 1;
            *of_orientations.entry(pair.orientation).or_insert(0) += 1;
        }
        let mut groups: BTreeMap<&str, Ambiguity> = BTreeMap::new();
        for pair in open {
            if of_images[&pair.image] == 1 && of_orientations[&pair.orientation] == 1 {
                found.of_image[pair.image] = Some(pair.orientation);
                image_of[pair.orientation] = Some(pair.image);
                let told = told_by.entry(&keys[pair.image]).or_default();
                *told = (*told).max(pair.rank.folders.0);
            } else {
                let group = groups.entry(&keys[pair.image]).or_default();
                group.images.insert(pair.image);
                group.orientations.insert(pair.orientation);
            }
        }
        for group in groups.into_values() {
            unclear.images.extend(&group.images);
            unclear.orientations.extend(&group.orientations);
            found.ambiguous.push(group);
        }
    }
    for pair in pairs.iter().rev() {
        if found.of_image[pair.image].is_none() && !unclear.images.contains(&pair.image) {
            found.left_out[pair.image] = image_of[pair.orientation].map(LeftOut::For);
        }
    }
    leave_out_copies(&mut found, &pairs, images);
    found
}

/// All pairs whose names fit, the closest first.
fn pairs(
    orientations: &[Orientation],
    images: &[ImageCandidate],
    names: &[PathName],
    keys: &[String],
) -> Vec<Pair> {
    let mut by_key: HashMap<&str, Vec<usize>> = HashMap::new();
    for (image, key) in keys.iter().enumerate() {
        by_key.entry(key).or_default().push(image);
    }
    let mut pairs = Vec::new();
    for (index, orientation) in orientations.iter().enumerate() {
        let mut fits: BTreeMap<usize, NameFit> = BTreeMap::new();
        for stated in PathName::readings(&orientation.image) {
            let keys = stated.keys();
            for &image in keys.iter().filter_map(|key| by_key.get(&**key)).flatten() {
                if let Some(fit) = stated.fit(&names[image]) {
                    let best = fits.entry(image).or_insert(fit);
                    *best = fit.min(*best);
                }
            }
        }
        pairs.extend(fits.into_iter().map(|(image, fit)| Pair {
            rank: rank(orientation, &images[image], fit),
            image,
            orientation: index,
        }));
    }
    pairs.sort_by_key(|pair| (pair.rank, pair.image, pair.orientation));
    pairs
}

fn rank(orientation: &Orientation, image: &ImageCandidate, fit: NameFit) -> Rank {
    fn folders(path: &str) -> impl Iterator<Item = &str> {
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
        folder.split('/')
    }
    let near = folders(&orientation.source)
        .zip(folders(image.path))
        .take_while(|(a, b)| a == b && !a.is_empty())
        .count();
    Rank {
        is_appended: fit.is_appended,
        folders: fit.folders,
        size: match image.size {
            Some(size) => SizeFit::new(orientation, size),
            None => SizeFit::Other,
        },
        ending: fit.ending,
        is_elsewhere: fit.is_elsewhere,
        folder: FolderKind::of(image.path),
        is_gray_png: image.is_gray_png,
        near: Reverse(near),
    }
}

/// A folder of masks or twins loses wherever the photograph is there; what it holds beyond that is
/// no photograph either, unless the orientation states its folder.
fn leave_out_copies(found: &mut Assignment, pairs: &[Pair], images: &[ImageCandidate]) {
    let mut best: BTreeMap<usize, &Pair> = BTreeMap::new();
    for pair in pairs {
        if found.of_image[pair.image] == Some(pair.orientation) {
            best.insert(pair.image, pair);
        } else {
            best.entry(pair.image).or_insert(pair);
        }
    }
    let kind = |image: usize| {
        let path = images[image].path;
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
        (folder, best[&image].rank.is_appended)
    };
    // Of each kind: how many have lost against another image, and how many were taken.
    let mut tally: BTreeMap<(&str, bool), [usize; 2]> = BTreeMap::new();
    for &image in best.keys() {
        let [lost, taken] = tally.entry(kind(image)).or_default();
        *lost += usize::from(found.left_out[image].is_some());
        *taken += usize::from(found.of_image[image].is_some());
    }
    for (&image, pair) in &best {
        let [lost, taken] = tally[&kind(image)];
        let is_stated = pair.rank.folders.0 > 0;
        if found.of_image[image].is_some() && lost > taken && !is_stated {
            found.of_image[image] = None;
            found.left_out[image] = Some(LeftOut::WithCopies);
        }
    }
}
