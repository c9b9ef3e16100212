//! Which photographs the marks of a list are in, and what is wrong with those that are in none.

use nalgebra::Point2;

use super::gcp_list::GroundControl;
use crate::base::error::listed;
use crate::orienting::orientation::{PathName, images_called};
use crate::orienting::structure_from_motion::block::Block;

/// Where a photograph shows a point.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    /// Its number in the block.
    pub photo: usize,
    /// Its name as the list has it.
    pub image: String,
    pub pixel: Point2<f64>,
}

/// The marks of all points.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks {
    /// By point.
    pub of_points: Vec<Vec<Mark>>,
    /// Names that fit no photograph.
    unknown: Vec<String>,
    /// Names that fit several.
    ambiguous: Vec<String>,
    /// Photographs without an orientation that are marked.
    unoriented: Vec<String>,
    /// How many marks there are, and how many lie outside of their photograph.
    counts: [usize; 2],
    /// The largest column and row, and the size of the photograph that is surpassed the most.
    farthest: ([f64; 2], [u32; 2]),
}

impl Marks {
    /// Names are matched as those of orientations: folders and extension may differ.
    pub(super) fn of(control: &GroundControl, block: &Block, paths: &[&str]) -> Self {
        let names: Vec<PathName> = paths.iter().map(|path| PathName::new(path)).collect();
        let mut marks = Self::default();
        let once = |list: &mut Vec<String>, name: &String| {
            if !list.contains(name) {
                list.push(name.clone());
            }
        };
        for point in &control.points {
            let mut of_point = Vec::new();
            for (image, pixel) in &point.marks {
                marks.counts[0] += 1;
                match images_called(image, &names)[..] {
                    [] => once(&mut marks.unknown, image),
                    [photo] => {
                        marks.measure(pixel, block.intrinsics(photo).size);
                        if block.photos[photo].pose.is_none() {
                            once(&mut marks.unoriented, image);
                        }
                        of_point.push(Mark {
                            photo,
                            image: image.clone(),
                            pixel: *pixel,
                        });
                    }
                    _ => once(&mut marks.ambiguous, image),
                }
            }
            marks.of_points.push(of_point);
        }
        marks
    }

    fn measure(&mut self, pixel: &Point2<f64>, size: [u32; 2]) {
        let share = |[x, y]: [f64; 2], [w, h]: [u32; 2]| {
            (x / f64::from(w.max(1))).max(y / f64::from(h.max(1)))
        };
        let place = [pixel.x, pixel.y];
        let is_inside = place
            .iter()
            .zip(size)
            .all(|(v, side)| (0.0..=f64::from(side)).contains(v));
        self.counts[1] += usize::from(!is_inside);
        let (most, of) = self.farthest;
        if share(place, size) > share(most, of) {
            self.farthest = (place, size);
        }
    }

    /// How many times as large photographs have to be for all marks to lie inside; at most 1 where
    /// they do.
    pub(super) fn least_factor(&self) -> f64 {
        let ([x, y], [w, h]) = self.farthest;
        (x / f64::from(w.max(1))).max(y / f64::from(h.max(1)))
    }

    /// The same list with the marks of these points only.
    pub(super) fn only(&self, of_points: Vec<Vec<Mark>>) -> Self {
        Self {
            of_points,
            ..self.clone()
        }
    }

    /// The same marks at other places of their photographs, which `size` tells of.
    pub(super) fn moved(&self, moved: impl Fn(&Mark) -> Point2<f64>) -> Self {
        let mut changed = self.clone();
        for mark in changed.of_points.iter_mut().flatten() {
            mark.pixel = moved(mark);
        }
        changed
    }

    /// What is wrong with names and places of marks, a sentence each.
    pub(super) fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        let [all, outside] = self.counts;
        for (names, what) in [
            (&self.unknown, "name no photograph that is there"),
            (
                &self.ambiguous,
                "name several photographs: say the folder too",
            ),
            (&self.unoriented, "are in photographs without orientation"),
        ] {
            if !names.is_empty() {
                words.push(format!("marks of the list {what}: {}", listed(names)));
            }
        }
        if outside > 0 {
            let ([x, y], [w, h]) = self.farthest;
            words.push(format!(
                "{outside} of {all} marks lie outside of their photograph (column {x:.0} of {w}, row \
                 {y:.0} of {h})"
            ));
        }
        words
    }
}
