//! The control sheet: residuals of control points and check points apart, those of stated
//! positions, and what the frame is worth.

use std::fmt::Write;

use serde::Deserialize;

use crate::orienting::orientation::FrameSigma;
use crate::orienting::structure_from_motion::frame::Lag;
use crate::orienting::structure_from_motion::ground_control::{ControlResidual, rms_m};

/// What the report of an orientation says of its frame.
#[derive(Clone, Debug, Deserialize)]
pub struct ControlSheet {
    frame: String,
    frame_sigma: Option<FrameSigma>,
    lag: Option<Lag>,
    control: Vec<ControlResidual>,
    photos: Vec<Photo>,
    warnings: Vec<String>,
}

/// A photograph with its distance from its stated position, metres; without the lag where one was
/// taken out.
#[derive(Clone, Debug, Deserialize)]
struct Photo {
    file: String,
    from_stated_m: Option<[f64; 3]>,
    residual_m: Option<[f64; 3]>,
}

impl ControlSheet {
    /// From the report as JSON, `orientation.json`; `None` where it is something else.
    pub fn of_json(json: &str) -> Option<Self> {
        serde_json::from_str(json).ok()
    }

    /// As text.
    pub fn to_text(&self) -> String {
        let mut text = format!("{}\n", self.frame);
        for words in worth_words(self.frame_sigma.as_ref(), self.lag.as_ref()) {
            text += &(words + "\n");
        }
        text += &control_tables(&self.control);
        text += &self.positions();
        if self.control.is_empty() && self.photos.iter().all(|p| p.from_stated_m.is_none()) {
            text += "neither control points nor stated positions give the frame\n";
        }
        for warning in &self.warnings {
            text += &format!("warning: {warning}\n");
        }
        text
    }

    /// A row for each photograph whose position is stated.
    fn positions(&self) -> String {
        let stated = || self.photos.iter().filter(|p| p.from_stated_m.is_some());
        let Some(widest) = stated().map(|p| p.file.chars().count()).max() else {
            return String::new();
        };
        let width = widest.max("photograph".len());
        let has_lag = self.lag.as_ref().is_some_and(|lag| lag.is_applied);
        let without = if has_lag {
            "  without lag x, y, z (m)"
        } else {
            ""
        };
        let mut text = format!(
            "{:<width$}  from stated x, y, z (m){without}\n",
            "photograph"
        );
        for photo in stated() {
            let mut row = format!("{:<width$}", photo.file);
            let left = photo.residual_m.filter(|_| has_lag);
            for [x, y, z] in photo.from_stated_m.into_iter().chain(left) {
                let _ = write!(row, "{x:>9.2}{y:>8.2}{z:>8.2}");
            }
            text += &(row + "\n");
        }
        text
    }
}

/// What scale and level are worth, and the lag of receivers, a sentence each.
pub(super) fn worth_words(sigma: Option<&FrameSigma>, lag: Option<&Lag>) -> Vec<String> {
    let words = [sigma.map(FrameSigma::words), lag.map(Lag::words)];
    words.into_iter().flatten().collect()
}

/// Tables of the residuals at control points and at check points; empty without them.
pub(super) fn control_tables(control: &[ControlResidual]) -> String {
    let of = |is_check: bool| control.iter().filter(move |p| p.role.is_check == is_check);
    let tables = [("control point", false), ("check point", true)];
    (tables.into_iter())
        .map(|(title, is_check)| table(title, &of(is_check).collect::<Vec<_>>()))
        .collect()
}

fn table(title: &str, points: &[&ControlResidual]) -> String {
    let Some(widest) = points.iter().map(|p| p.name.chars().count()).max() else {
        return String::new();
    };
    let width = widest.max(title.len());
    let mut text = format!("{title:<width$}  marks  from stated x, y, z (m)     sigma\n");
    for p in points {
        let [marks, agreeing] = p.marks;
        let number =
            |v: Option<f64>| v.map_or_else(|| format!("{:>9}", "-"), |v| format!("{v:>9.3}"));
        let of = p.residual_m.zip(p.sigma_m).map_or_else(
            || "not seen by two rays that meet".to_owned(),
            |(off, sigma)| off.map(number).concat() + &format!("{sigma:>10.3}"),
        );
        let verdict = if p.residual_m.is_some() && !p.agrees {
            "  wrong"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "{:<width$}{agreeing:>4}/{marks:<2}{of}{verdict}",
            p.name
        );
    }
    let agreeing = points.iter().filter(|p| p.agrees).count();
    let used = points
        .iter()
        .copied()
        .filter(|p| p.role.is_check || p.agrees);
    let _ = writeln!(
        text,
        "{title}s: {agreeing} of {} agree{}",
        points.len(),
        rms_words(rms_m(used))
    );
    text
}

/// Root mean square residuals in plan and height, as far as they are known.
pub(super) fn rms_words([plan, height]: [Option<f64>; 2]) -> String {
    let words = |rms: Option<f64>, of: &str| rms.map(|rms| format!("{rms:.3} m in {of}"));
    let parts = [words(plan, "plan"), words(height, "height")];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    match parts.is_empty() {
        true => String::new(),
        false => format!(", rms {}", parts.join(", ")),
    }
}
