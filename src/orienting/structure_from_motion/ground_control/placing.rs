//! The block brought into the frame of control points, if that can be true.

use nalgebra::Point3;

use super::fit::{Fit, fitted, without_keypoints};
use super::gcp_list::GroundControl;
use super::marks::Marks;
use super::mistakes::{Mistake, under};
use crate::base::math::median;
use crate::orienting::orientation::{Anchor, LinearUnit, PlanUnit, SystemUnits};
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::frame::{
    ByControl, Doubt, FrameBasis, OFFER, StatedPose, control_doubts,
};

/// What is known beside a list.
pub(in super::super) struct Beside<'a> {
    /// Paths of the photographs.
    pub paths: &'a [&'a str],
    /// What their headers state, and the zero of that.
    pub stated: &'a [StatedPose],
    pub anchor: Option<Anchor>,
    /// Is a usual mistake to be read as it was meant?
    pub applies_fix: bool,
}

/// A list as it is read, how it fits, and what speaks against it.
struct Reading {
    control: GroundControl,
    fit: Fit,
    doubts: Vec<Doubt>,
    /// Mean height of the photographs above those in their headers, metres.
    above_headers_m: Option<f64>,
}

impl Beside<'_> {
    /// How far the heights in the headers are below those of a fit, metres.
    fn below(&self, block: &Block, fit: &Fit, control: &GroundControl) -> Option<f64> {
        let anchor = self.anchor?;
        let off = (block.photos.iter().zip(self.stated)).filter_map(|(photo, stated)| {
            let own = stated.position.filter(|_| !stated.lacks_height)?;
            let placed = fit.similarity.point(&photo.pose.as_ref()?.center);
            let height = (control.anchor).map_or(placed.z, |zero| zero.geographic(&placed)[2]);
            Some(height - anchor.geographic(&own)[2])
        });
        median(&mut off.collect::<Vec<f64>>())
    }
}

/// Largest distance of the sea's level from the ellipsoid, metres (EGM2008: -107 to 86), by which
/// heights of receivers may be off.
const LARGEST_UNDULATION_M: f64 = 107.0;

/// Losses that differ by less say nothing: a hundred to one is twice its logarithm in squares.
const SURE_LOSS: f64 = 9.21;

/// Brings the block into the frame of the control points, with what is doubtful of them. Without a
/// frame the block stays as it is, and the words say why.
pub(in super::super) fn to_control(
    block: &mut Block,
    control: &GroundControl,
    beside: &Beside,
) -> (Option<FrameBasis>, Vec<String>) {
    let light = without_keypoints(block);
    let marks = Marks::of(control, block, beside.paths);
    let mut words = marks.words();
    words.extend(control.words());
    let fits = heights_read(control).into_iter().map(|control| {
        let fit = fitted(&light, &marks, &control)?;
        Ok(Reading::of(control, fit, block, beside))
    });
    let fits: Vec<Result<Reading, String>> = fits.collect();
    let why = fits.iter().find_map(|fit| fit.as_ref().err().cloned());
    let (as_stated, of_heights) = with_heights(fits.into_iter().flatten().collect());
    if let Some(reading) = as_stated.as_ref().filter(|r| r.is_sound()) {
        words.extend(of_heights);
        return (Some(reading.place(block)), words);
    }
    let least = as_stated.as_ref().map_or(0, |r| r.fit.agreeing);
    let explained = (Mistake::possible(control, &marks, &light).into_iter())
        .filter_map(|mistake| {
            let (control, fit) = under(mistake, control, &marks, &light)?;
            Some((mistake, Reading::of(control, fit, block, beside)))
        })
        .filter(|(_, r)| r.is_sound() && r.fit.agreeing >= least);
    let explained = likeliest(explained.collect());
    let speaks = match (&as_stated, why) {
        (Some(reading), _) => reading.against(),
        (None, why) => why.unwrap_or_default(),
    };
    match &explained[..] {
        [] => {
            let possible = as_stated.filter(|r| !r.doubts.iter().any(Doubt::is_impossible));
            words.push(format!(
                "{speaks}: check coordinates, their system and order, and marks in {}{}",
                GroundControl::FILE,
                if possible.is_some() {
                    ""
                } else {
                    ". They were not used"
                }
            ));
            (possible.map(|r| r.place(block)), words)
        }
        [(mistake, reading)] if beside.applies_fix => {
            let mistake = mistake.words();
            words.push(format!(
                "{speaks}; {} was read with {mistake}",
                GroundControl::FILE
            ));
            (Some(reading.place(block)), words)
        }
        _ => {
            words.push(explanation(&speaks, &explained));
            (None, words)
        }
    }
}

/// The readings with the most agreeing points that are as likely as the likeliest of them.
fn likeliest(mut explained: Vec<(Mistake, Reading)>) -> Vec<(Mistake, Reading)> {
    explained.sort_by(|(_, a), (_, b)| {
        let by_count = b.fit.agreeing.cmp(&a.fit.agreeing);
        by_count.then(a.fit.loss.total_cmp(&b.fit.loss))
    });
    if let Some((most, least)) = explained.first().map(|(_, r)| (r.fit.agreeing, r.fit.loss)) {
        let is_as_likely = |fit: &Fit| fit.agreeing == most && fit.loss < least + SURE_LOSS;
        explained.retain(|(_, r)| is_as_likely(&r.fit));
    }
    explained
}

/// What explains a list that cannot be true as it stands.
fn explanation(speaks: &str, explained: &[(Mistake, Reading)]) -> String {
    let names: Vec<String> = explained
        .iter()
        .map(|(mistake, _)| mistake.words())
        .collect();
    let fit = &explained[0].1.fit;
    let offer = match explained {
        [_] => format!("correct {}, or {OFFER}", GroundControl::FILE),
        _ => format!("correct {}", GroundControl::FILE),
    };
    format!(
        "{speaks}; with {} {} of {} agree, rms {:.3} m in plan and {:.3} m in height: {offer}. They \
         were not used",
        names.join(", or "),
        fit.agreeing,
        fit.control,
        fit.rms_m[0],
        fit.rms_m[1]
    )
}

/// A list whose system states no unit of heights, in that of its plan and in metres.
fn heights_read(control: &GroundControl) -> Vec<GroundControl> {
    match (control.units.plan, control.units.height) {
        (PlanUnit::Length(unit), None) if !unit.is_metre() => [unit, LinearUnit::METRE]
            .map(|height| {
                control.in_units(SystemUnits {
                    height: Some(height),
                    ..control.units
                })
            })
            .into(),
        _ => vec![control.clone()],
    }
}

/// The reading whose heights fit the plan and the headers, and the words of that choice.
fn with_heights(mut readings: Vec<Reading>) -> (Option<Reading>, Option<String>) {
    if readings.len() < 2 {
        return (readings.pop(), None);
    }
    let key = |r: &Reading| (r.doubts.len(), std::cmp::Reverse(r.fit.agreeing));
    let by_fit = match key(&readings[0]).cmp(&key(&readings[1])) {
        std::cmp::Ordering::Equal => {
            let off = readings[1].fit.loss - readings[0].fit.loss;
            (off.abs() > SURE_LOSS).then(|| usize::from(off < 0.0))
        }
        order => Some(usize::from(order.is_gt())),
    };
    let by_headers = || {
        let off = [0, 1].map(|i| readings[i].above_headers_m);
        let [Some(a), Some(b)] = off.map(|o| o.map(f64::abs)) else {
            return None;
        };
        // Nearer to the headers than any geoid takes the other.
        let is_sure = a.min(b) < LARGEST_UNDULATION_M && a.max(b) > LARGEST_UNDULATION_M;
        is_sure.then(|| usize::from(b < a))
    };
    let (taken, reason) = match (by_fit, by_headers()) {
        (Some(i), _) => (i, "which fits the photographs and their headers"),
        (None, Some(i)) => (i, "which fits the heights in the headers"),
        (None, None) => (0, "as the plan; say EPSG:CODE+5703 for heights in metres"),
    };
    let reading = readings.swap_remove(taken);
    let unit = reading
        .control
        .units
        .height
        .map_or_else(String::new, |u| u.words());
    let words = format!(
        "{} states no unit of heights: they were taken in {unit}, {reason}",
        reading.control.system
    );
    (Some(reading), Some(words))
}

impl Reading {
    fn of(control: GroundControl, fit: Fit, block: &Block, beside: &Beside) -> Self {
        let on_earth = |p: &Point3<f64>| control.on_earth(p);
        let above_headers_m = beside.below(block, &fit, &control);
        let against = ByControl {
            anchor: beside.anchor,
            on_earth: &on_earth,
            above_headers_m,
        };
        let doubts = control_doubts(
            block,
            &fit.similarity,
            beside.stated,
            fit.tilt_sigma,
            against,
        );
        Self {
            control,
            fit,
            doubts,
            above_headers_m,
        }
    }

    /// Does nothing speak against it, and do most of its points agree?
    fn is_sound(&self) -> bool {
        self.doubts.is_empty() && 2 * self.fit.agreeing > self.fit.control
    }

    /// What speaks against it, in words.
    fn against(&self) -> String {
        if self.doubts.is_empty() {
            let [agreeing, all] = [self.fit.agreeing, self.fit.control];
            return format!("{agreeing} of {all} ground control points agree with each other");
        }
        let against: Vec<String> = self.doubts.iter().map(Doubt::words).collect();
        format!("the ground control points {}", against.join(", and "))
    }

    /// Brings the block into the frame.
    fn place(&self, block: &mut Block) -> FrameBasis {
        self.fit.similarity.apply(block);
        FrameBasis::Control {
            system: self.control.system.clone(),
            epsg: self.control.epsg,
            anchor: self.control.anchor,
            offset: self.control.offset.into(),
            points: self.fit.points.clone(),
            rms_m: self.fit.rms_m,
            sigma: self.fit.sigma,
        }
    }
}
