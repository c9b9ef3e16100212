//! The orientations that a scene may be loaded with: files, and groups within a file.

use serde::Serialize;

use super::assignment::{ImageCandidate, assign};
use crate::base::error::listed;
use crate::orienting::orientation::{Format, InputFile, Orientation, OrientationSet};
use crate::photographs::camera::FEWEST_VIEWS;

/// One of the orientations that a scene may be given.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct OrientationCandidate {
    /// Its format and files, in words; and the chunk or block, where a file holds several.
    pub label: String,
    /// The path by which [`LoadOptions::orientation`](super::LoadOptions::orientation) chooses it,
    /// and the group's label.
    pub path: String,
}

impl OrientationCandidate {
    /// One for each set of files.
    pub(crate) fn of(sets: &[OrientationSet], files: &[InputFile]) -> Vec<Self> {
        let candidate = |set: &OrientationSet| Self {
            label: format!("{}: {}", set.format.name(), set.label(files)),
            path: files[set.files[0]].path.clone(),
        };
        sets.iter().map(candidate).collect()
    }

    /// Puts the groups of a set in its place, the preferred one first.
    pub(crate) fn split(candidates: &mut Vec<Self>, index: usize, groups: &[String]) {
        if groups.len() < 2 {
            return;
        }
        let Self { label, path } = candidates[index].clone();
        let of_groups = groups.iter().map(|group| Self {
            label: format!("{label}: {group}"),
            path: labelled(&path, group),
        });
        candidates.splice(index..=index, of_groups);
    }
}

fn labelled(path: &str, group: &str) -> String {
    format!("{path}: {group}")
}

/// A set of files, by its index, and the group in it that was asked for.
#[derive(Debug, PartialEq)]
pub(crate) struct Choice {
    pub set: usize,
    pub group: Option<String>,
}

/// The preferred set, or the one that a part of a path or of a group's label names.
pub(crate) fn choose(
    sets: &[OrientationSet],
    files: &[InputFile],
    wanted: Option<&str>,
) -> Option<Choice> {
    let Some(wanted) = wanted else {
        return (!sets.is_empty()).then_some(Choice {
            set: 0,
            group: None,
        });
    };
    let folder = wanted.trim_end_matches('/');
    let by_path = |fits: &dyn Fn(&str) -> bool| {
        sets.iter()
            .position(|set| set.files.iter().any(|&i| fits(&files[i].path)))
    };
    // A whole path names one set, even where it is a part of another's.
    let set = by_path(&|path| path == folder).or_else(|| by_path(&|path| path.contains(folder)));
    set.map(|set| Choice { set, group: None })
        .or_else(|| choose_group(sets, files, wanted))
}

/// A whole label names one group, even where it is a part of another's.
fn choose_group(sets: &[OrientationSet], files: &[InputFile], wanted: &str) -> Option<Choice> {
    let mut all = Vec::new();
    for (set, files_of) in sets
        .iter()
        .enumerate()
        .filter(|(_, s)| has_groups(s.format))
    {
        // What cannot be read has no groups to choose.
        let read = files_of.read(files, &mut Vec::new()).unwrap_or_default();
        let path = &files[files_of.files[0]].path;
        let named = groups(&read).into_iter().map(|group| {
            let label = labelled(path, &group);
            (label, set, group)
        });
        all.extend(named);
    }
    let whole = all
        .iter()
        .find(|(label, _, group)| label == wanted || group == wanted);
    let (_, set, group) =
        whole.or_else(|| all.iter().find(|(label, ..)| label.contains(wanted)))?;
    Some(Choice {
        set: *set,
        group: Some(group.clone()),
    })
}

/// Formats of which one file may orient the same images several times.
fn has_groups(format: Format) -> bool {
    matches!(format, Format::Metashape | Format::Blocks)
}

/// The labels of the groups, the preferred one first.
fn groups(orientations: &[Orientation]) -> Vec<String> {
    let mut groups: Vec<String> = Vec::new();
    for group in orientations.iter().rev().filter_map(|o| o.group.as_ref()) {
        if !groups.contains(group) {
            groups.push(group.clone());
        }
    }
    groups
}

/// The orientations of one group.
#[derive(Debug, PartialEq)]
pub(crate) struct TakenGroup {
    pub orientations: Vec<Orientation>,
    /// Its label, where there are several.
    pub group: Option<String>,
    /// All labels, the preferred one first.
    pub groups: Vec<String>,
    was_asked_for: bool,
}

/// The group that is wanted; without a wish the preferred one, unless it orients too few of the
/// images and another one orients more.
pub(crate) fn take_group(
    orientations: Vec<Orientation>,
    wanted: Option<&str>,
    images: &[ImageCandidate],
) -> TakenGroup {
    let groups = groups(&orientations);
    if groups.len() < 2 {
        return TakenGroup {
            orientations,
            group: None,
            groups,
            was_asked_for: false,
        };
    }
    let of = |group: &str| -> Vec<Orientation> {
        let is_of = |o: &&Orientation| o.group.as_deref() == Some(group);
        orientations.iter().filter(is_of).cloned().collect()
    };
    let oriented = |group: &str| assign(&of(group), images).of_image.iter().flatten().count();
    let mut group = &groups[0];
    if let Some(wanted) = groups.iter().find(|group| Some(&***group) == wanted) {
        group = wanted;
    } else if oriented(group) < FEWEST_VIEWS {
        // The first of several with the same number is the preferred one.
        group = groups
            .iter()
            .rev()
            .max_by_key(|group| oriented(group))
            .unwrap_or(group);
    }
    TakenGroup {
        orientations: of(group),
        group: Some(group.clone()),
        was_asked_for: wanted.is_some(),
        groups: groups.clone(),
    }
}

impl TakenGroup {
    /// What was taken of several groups, where nobody chose.
    pub(crate) fn warning(&self, label: &str) -> Option<String> {
        let taken = self.group.as_ref().filter(|_| !self.was_asked_for)?;
        let others = self.groups.iter().filter(|group| *group != taken);
        Some(format!(
            "{label} holds {} orientations: {taken} was taken, not {} (--orientation takes their \
             names)",
            self.groups.len(),
            listed(others)
        ))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Point3};

    use super::*;

    /// Names of images, each with the group of its orientation.
    fn orientations(all: &[(&str, Option<&str>)]) -> Vec<Orientation> {
        let one = |&(image, group): &(&str, Option<&str>)| Orientation {
            image: image.to_owned(),
            source: "cameras.xml, line 1".to_owned(),
            k: Matrix3::identity(),
            distortion: None,
            r: Matrix3::identity(),
            center: Point3::origin(),
            size: None,
            from_middle: false,
            angles: None,
            crop: None,
            readings: Vec::new(),
            group: group.map(str::to_owned),
        };
        all.iter().map(one).collect()
    }

    fn images() -> Vec<ImageCandidate<'static>> {
        let candidate = |path| ImageCandidate {
            path,
            size: Some([4, 3]),
            is_gray_png: false,
        };
        ["1.jpg", "2.jpg", "3.jpg"].map(candidate).to_vec()
    }

    const TWICE: [(&str, Option<&str>); 6] = [
        ("1.jpg", Some("Chunk")),
        ("2.jpg", Some("Chunk")),
        ("3.jpg", Some("Chunk")),
        ("1.jpg", Some("Chunk (copy)")),
        ("2.jpg", Some("Chunk (copy)")),
        ("3.jpg", Some("Chunk (copy)")),
    ];

    #[test]
    fn of_several_groups_the_last_is_taken_and_the_others_are_named() {
        let taken = take_group(orientations(&TWICE), None, &images());
        assert_eq!(taken.group.as_deref(), Some("Chunk (copy)"));
        assert_eq!(taken.orientations, orientations(&TWICE[3..]));
        let words = taken.warning("cameras.xml").unwrap();
        let start = "cameras.xml holds 2 orientations: Chunk (copy) was taken, not Chunk (";
        assert!(words.starts_with(start), "{words}");
        let wanted = take_group(orientations(&TWICE), Some("Chunk"), &images());
        assert_eq!(wanted.orientations, orientations(&TWICE[..3]));
        assert_eq!(wanted.warning("cameras.xml"), None);
        // One group, or none, is nothing to choose from.
        for all in [&TWICE[..3], &[("1.jpg", None), ("2.jpg", None)]] {
            let taken = take_group(orientations(all), None, &images());
            assert_eq!(taken.orientations, orientations(all));
            assert_eq!((&taken.group, taken.warning("x")), (&None, None));
        }
    }

    #[test]
    fn a_group_of_other_images_is_not_preferred() {
        let mut all = TWICE;
        for (image, _) in &mut all[3..] {
            *image = "of another flight.jpg";
        }
        let taken = take_group(orientations(&all), None, &images());
        assert_eq!(taken.group.as_deref(), Some("Chunk"));
        // Where neither orients enough, the preferred one is as good.
        let taken = take_group(orientations(&all), None, &[]);
        assert_eq!(taken.group.as_deref(), Some("Chunk (copy)"));
    }

    #[test]
    fn candidates_list_the_groups_in_the_place_of_their_file() {
        let candidate = |label: &str, path: &str| OrientationCandidate {
            label: label.to_owned(),
            path: path.to_owned(),
        };
        let mut all = vec![
            candidate("A: a.txt", "a.txt"),
            candidate("M: c.xml", "c.xml"),
        ];
        let groups = ["2", "1"].map(str::to_owned);
        OrientationCandidate::split(&mut all, 1, &groups[..1]);
        assert_eq!(all.len(), 2);
        OrientationCandidate::split(&mut all, 1, &groups);
        assert_eq!(
            all[1..],
            [
                candidate("M: c.xml: 2", "c.xml: 2"),
                candidate("M: c.xml: 1", "c.xml: 1")
            ]
        );
    }
}
