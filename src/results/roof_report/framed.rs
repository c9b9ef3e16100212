//! What the frame adds to the standard deviations of a building: its scale and its level are off
//! for all of it alike, and independently of how the building was measured.
//!
//! ```text
//! length, height: s L   area: 2 s A   volume: 3 s V   slope: t   azimuth: t / tan(slope)
//! ```
//!
//! s is the standard deviation of the scale as a share, t that of the level as an angle; both add
//! to what was measured as squares.

use super::{BuildingReport, Estimate, Lengths};
use crate::base::math::{hypot, sin_cos};
use crate::orienting::orientation::FrameSigma;

impl Estimate {
    /// With an independent error more, where the own one is known.
    fn and(self, sigma: f64) -> Self {
        Self {
            sigma: self.sigma.map(|own| hypot(own, sigma)),
            ..self
        }
    }

    /// With what a scale off by this share does to a quantity of this many dimensions.
    fn scaled(&mut self, scale: f64, dimensions: f64) {
        *self = self.and(scale * dimensions * self.value);
    }
}

fn scale_all(lengths: &mut Lengths, scale: f64) {
    (lengths.iter_mut().flatten()).for_each(|length| length.scaled(scale, 1.0));
}

impl BuildingReport {
    /// The same in a frame that is known as well as this.
    pub fn in_frame(mut self, frame: &FrameSigma) -> Self {
        let (scale, tilt) = (frame.scale(), frame.tilt());
        for facet in &mut self.facets {
            let (sine, cosine) = sin_cos(facet.slope_deg.value.to_radians());
            facet.slope_deg = facet.slope_deg.and(tilt.to_degrees());
            // A level face has no direction, and states none.
            let turn = |azimuth: Estimate| azimuth.and((tilt * cosine / sine).to_degrees());
            facet.azimuth_deg = facet.azimuth_deg.map(turn);
            facet.area_m2.scaled(scale, 2.0);
            facet.plan_area_m2.scaled(scale, 2.0);
            facet.lowest_m.scaled(scale, 1.0);
            facet.highest_m.scaled(scale, 1.0);
            scale_all(&mut facet.lengths, scale);
            (facet.usable.iter_mut()).for_each(|usable| usable.area_m2.scaled(scale, 2.0));
        }
        (self.edges.iter_mut()).for_each(|edge| edge.length_m.scaled(scale, 1.0));
        self.area_m2.scaled(scale, 2.0);
        self.plan_area_m2.scaled(scale, 2.0);
        self.volume_m3.scaled(scale, 3.0);
        self.lowest_m.scaled(scale, 1.0);
        self.highest_m.scaled(scale, 1.0);
        scale_all(&mut self.lengths, scale);
        (self.usable_m2.iter_mut()).for_each(|area| area.scaled(scale, 2.0));
        self
    }
}
