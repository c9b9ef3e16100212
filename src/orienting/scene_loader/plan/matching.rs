//! Which image has which orientation, and what is left over.

use super::Plan;
use crate::base::error::{Error, listed};
use crate::orienting::orientation::{InputFile, Orientation};
use crate::orienting::scene_loader::assignment::{
    Ambiguity, Assignment, LeftOut, assign, assign_in_order,
};
use crate::photographs::camera::FEWEST_VIEWS;

impl Plan {
    /// Gives each image its orientation; what is left over is named.
    pub(super) fn match_orientations(
        &mut self,
        files: &[InputFile],
        orientations: Vec<Orientation>,
        selected: bool,
    ) {
        let candidates = self.image_candidates(files);
        let mut found = assign(&orientations, &candidates);
        let paths: Vec<&str> = (self.images.iter())
            .map(|image| &*files[image.file].path)
            .collect();
        let label = self.orientation.clone().unwrap_or("any file".to_owned());
        let fits = !found.ambiguous.is_empty() || found.of_image.iter().any(Option::is_some);
        if let (false, Some(order)) = (fits, assign_in_order(&orientations, &candidates)) {
            let stated: Vec<&str> = order.iter().map(|&one| &*orientations[one].image).collect();
            let pairs =
                (paths.iter().zip(&stated)).map(|(path, name)| format!("{path} for {name}"));
            self.warnings.push(format!(
                "no image is called as {label} says; they were taken in the order of their names: {}",
                listed(pairs)
            ));
            self.unless_agreed = Some(too_few_oriented(0, &paths, &stated, &label));
            found.of_image = order.into_iter().map(Some).collect();
        }
        let unreadable =
            (found.of_image.iter().zip(&self.images)).filter_map(|(of_image, image)| {
                image.unreadable.clone().filter(|_| of_image.is_some())
            });
        let mut errors: Vec<Error> = unreadable.collect();
        let unclear = found.ambiguous.iter();
        errors.extend(unclear.map(|same| ambiguous(same, &orientations, &paths)));
        let left = LeftOver::of(&found, &orientations, &paths);
        if left.oriented < FEWEST_VIEWS && errors.is_empty() && !left.images.is_empty() {
            errors.push(too_few_oriented(
                left.oriented,
                &left.images,
                &left.orientations,
                &label,
            ));
        }
        self.warnings.extend(left.notices(&label, selected));
        self.errors.extend(errors);
        for (image, one) in self.images.iter_mut().zip(found.of_image) {
            image.orientation = one.map(|one| orientations[one].clone());
        }
    }
}

/// What an assignment leaves over.
struct LeftOver<'a> {
    /// Orientations that an image has.
    oriented: usize,
    /// Images without an orientation.
    images: Vec<&'a str>,
    /// Masks and copies of images, each with what was taken in its place.
    copies: Vec<String>,
    /// Orientations without an image.
    orientations: Vec<&'a str>,
}

impl<'a> LeftOver<'a> {
    fn of(found: &Assignment, orientations: &'a [Orientation], paths: &[&'a str]) -> Self {
        let images = (0..paths.len())
            .filter(|&i| found.of_image[i].is_none() && found.left_out[i].is_none())
            .filter(|i| found.ambiguous.iter().all(|same| !same.images.contains(i)))
            .map(|i| paths[i]);
        let copies = found
            .left_out
            .iter()
            .zip(paths)
            .filter_map(|(why, path)| match (*why)? {
                LeftOut::For(taken) => Some(format!("{path} ({} was taken)", paths[taken])),
                LeftOut::WithCopies => Some((*path).to_owned()),
            });
        let mut used = vec![false; orientations.len()];
        for one in found.of_image.iter().flatten() {
            used[*one] = true;
        }
        let unused = (orientations.iter().zip(&used)).filter(|(_, used)| !**used);
        Self {
            oriented: used.iter().filter(|used| **used).count(),
            images: images.collect(),
            copies: copies.collect(),
            orientations: unused.map(|(o, _)| &*o.image).collect(),
        }
    }

    /// In words; where photographs were selected nobody asks for the other orientations.
    fn notices(&self, label: &str, selected: bool) -> Vec<String> {
        let mut notices = Vec::new();
        if !self.images.is_empty() {
            notices.push(format!(
                "images without an orientation in {label}, left out: {}",
                listed(&self.images)
            ));
        }
        if !self.copies.is_empty() {
            notices.push(format!(
                "masks or copies of images, left out because an orientation belongs to one image: {}",
                listed(&self.copies)
            ));
        }
        if !self.orientations.is_empty() && !selected {
            notices.push(format!(
                "orientations without an image, ignored: {}",
                listed(&self.orientations)
            ));
        }
        notices
    }
}

fn ambiguous(same: &Ambiguity, orientations: &[Orientation], paths: &[&str]) -> Error {
    let images: Vec<&str> = same.images.iter().map(|&i| paths[i]).collect();
    let sources = listed((same.orientations.iter()).map(|&i| &*orientations[i].source));
    match images[..] {
        [one] => Error::file(
            one,
            format!("two orientations are called like the image ({sources})"),
            "remove one of them",
        ),
        _ => Error::scene(
            format!(
                "{} have the same name, and nothing tells which of them belongs to {sources}",
                images.join(" and ")
            ),
            "rename or remove one, or give them the folders that the orientation states",
        ),
    }
}

/// The refusal of images of which too few have an orientation.
fn too_few_oriented(oriented: usize, without: &[&str], unused: &[&str], label: &str) -> Error {
    let named = match unused.is_empty() {
        true => String::new(),
        false => format!(" (it names {})", listed(unused.iter())),
    };
    Error::scene(
        format!(
            "{oriented} {} an orientation in {label}, but three are needed: none for {}{named}",
            if oriented == 1 {
                "image has"
            } else {
                "images have"
            },
            listed(without.iter())
        ),
        "add the orientation of the others, or give the images the names that it states",
    )
}
