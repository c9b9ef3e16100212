//! Candidates with what spoke for them and against them, as they are written out: the page and the
//! calibration read why each of them lives or not.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::Evidence;
use crate::base::geometry::{Plane, Segment3, mean_point};

/// The candidates of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Candidates {
    /// Every matched line, by its views alone.
    pub lines: Vec<JudgedLine>,
    /// Every line, with those that the model adds, in the finished model.
    pub model_lines: Vec<JudgedLine>,
    /// Every facet that was weighed.
    pub facets: Vec<JudgedFacet>,
    /// Every block that may stand on a roof, by its top.
    pub obstructions: Vec<JudgedFacet>,
    /// Every plane between parallel lines that was weighed.
    pub rectangles: Vec<JudgedFacet>,
    /// Every surface of dense matching.
    pub surfaces: Vec<JudgedSurface>,
}

/// A surface of which was weighed what it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JudgedSurface {
    /// The middles of its patches, metres, local frame.
    pub patches: Vec<Point3<f64>>,
    /// For a building rather than ground or vegetation.
    pub building: Evidence,
    /// For vegetation rather than ground.
    pub vegetation: Evidence,
}

/// A line that was weighed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JudgedLine {
    /// End points, metres, local frame.
    pub segment: Segment3,
    /// What speaks for it and against it.
    pub evidence: Evidence,
}

/// A facet that was weighed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct JudgedFacet {
    /// Its outline, metres, local frame.
    pub outline: Vec<Point3<f64>>,
    /// Its holes.
    pub holes: Vec<Vec<Point3<f64>>>,
    /// Its plane.
    pub plane: Plane,
    /// Was it taken into the model?
    pub accepted: bool,
    /// What speaks for it and against it.
    pub evidence: Evidence,
    /// How the views agree inside it; the page draws none of it.
    #[serde(skip)]
    pub windows: WindowCounts,
}

/// The correlation windows inside a facet, counted on its plane and on its plane moved up and down.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WindowCounts {
    /// On its plane.
    pub on: WindowHistogram,
    /// On all the moved ones.
    pub beside: WindowHistogram,
}

/// Numbers of windows by texture weight and correlation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WindowHistogram {
    counts: [[u32; WindowHistogram::CORRELATIONS]; WindowHistogram::WEIGHTS_BELOW.len()],
}

impl WindowHistogram {
    /// Upper ends of the classes of texture weights: narrow where most windows are.
    pub const WEIGHTS_BELOW: [f32; 9] = [0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 1.01];
    /// Number of classes of correlations, from -1 in steps of a tenth; the last one holds 1 alone.
    pub const CORRELATIONS: usize = 21;

    /// Counts a window; one without texture says nothing.
    pub(crate) fn add(&mut self, weight: f32, correlation: f32) {
        if weight <= 0.0 {
            return;
        }
        let row = Self::WEIGHTS_BELOW.partition_point(|below| *below <= weight);
        let column = (10.0 * (correlation + 1.0)).clamp(0.0, 20.0) as usize;
        self.counts[row.min(Self::WEIGHTS_BELOW.len() - 1)][column] += 1;
    }

    /// For each class of weights, the number in each class of correlations.
    pub fn rows(&self) -> impl Iterator<Item = &[u32]> {
        self.counts.iter().map(|row| &row[..])
    }
}

impl Candidates {
    /// Those in the middle of which `holds` is true, in a frame whose origin lies `by` further.
    pub(crate) fn moved(&self, by: &Vector3<f64>, holds: impl Fn(&Point3<f64>) -> bool) -> Self {
        let line = |line: &JudgedLine| JudgedLine {
            segment: Segment3::new(line.segment.p0 - by, line.segment.p1 - by),
            ..line.clone()
        };
        let ring = |ring: &Vec<Point3<f64>>| ring.iter().map(|p| p - by).collect();
        let facet = |facet: &JudgedFacet| JudgedFacet {
            outline: ring(&facet.outline),
            holes: facet.holes.iter().map(ring).collect(),
            plane: facet.plane.relative_to(by),
            ..facet.clone()
        };
        let lines_of = |lines: &[JudgedLine]| -> Vec<JudgedLine> {
            let inside = lines.iter().filter(|l| holds(&l.segment.at(0.5)));
            inside.map(line).collect()
        };
        let surface = |surface: &JudgedSurface| JudgedSurface {
            patches: ring(&surface.patches),
            ..surface.clone()
        };
        let surfaces = (self.surfaces.iter()).filter(|s| holds(&mean_point(&s.patches)));
        let facets_of = |facets: &[JudgedFacet]| -> Vec<JudgedFacet> {
            let inside = facets.iter().filter(|f| holds(&mean_point(&f.outline)));
            inside.map(facet).collect()
        };
        Self {
            lines: lines_of(&self.lines),
            model_lines: lines_of(&self.model_lines),
            facets: facets_of(&self.facets),
            obstructions: facets_of(&self.obstructions),
            rectangles: facets_of(&self.rectangles),
            surfaces: surfaces.map(surface).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_counted_in_their_classes() {
        let mut counts = WindowHistogram::default();
        for (weight, correlation) in [(0.0, 0.9), (0.1, -1.0), (0.75, 0.55), (1.0, 1.0)] {
            counts.add(weight, correlation);
        }
        let rows: Vec<&[u32]> = counts.rows().collect();
        assert_eq!(rows.iter().map(|r| r.iter().sum::<u32>()).sum::<u32>(), 3);
        assert_eq!([rows[0][0], rows[3][15], rows[8][20]], [1; 3]);
    }

    #[test]
    fn candidates_move_with_their_frame_and_those_elsewhere_stay_out() {
        let evidence = Evidence {
            prior: 1.0,
            terms: Vec::new(),
        };
        let line = |x: f64| JudgedLine {
            segment: Segment3::new(Point3::new(x, 0.0, 5.0), Point3::new(x, 4.0, 5.0)),
            evidence: evidence.clone(),
        };
        let surface = |x: f64| JudgedSurface {
            patches: vec![Point3::new(x, 0.0, 5.0)],
            building: evidence.clone(),
            vegetation: evidence.clone(),
        };
        let outline = [(0.0, 0.0), (6.0, 0.0), (0.0, 6.0)].map(|(x, y)| Point3::new(x, y, 5.0));
        let facet = JudgedFacet {
            outline: outline.to_vec(),
            holes: Vec::new(),
            plane: Plane {
                normal: Vector3::z(),
                d: -5.0,
            },
            accepted: true,
            evidence: evidence.clone(),
            windows: WindowCounts::default(),
        };
        let all = Candidates {
            lines: vec![line(1.0), line(90.0)],
            model_lines: vec![line(2.0)],
            facets: vec![facet],
            obstructions: Vec::new(),
            rectangles: Vec::new(),
            surfaces: [1.0, 90.0].map(surface).to_vec(),
        };
        let moved = all.moved(&Vector3::new(10.0, 0.0, 2.0), |p| p.x < 50.0);
        assert_eq!([moved.lines.len(), moved.model_lines.len()], [1, 1]);
        assert_eq!(moved.lines[0].segment.p0, Point3::new(-9.0, 0.0, 3.0));
        assert_eq!(moved.facets[0].outline[1], Point3::new(-4.0, 0.0, 3.0));
        assert_eq!(moved.surfaces.len(), 1);
        assert_eq!(moved.surfaces[0].patches, [Point3::new(-9.0, 0.0, 3.0)]);
        assert!((moved.facets[0].plane.z_at(0.0, 0.0) - 3.0).abs() < 1e-12);
    }
}
