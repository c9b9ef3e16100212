//! The part of each image that may show the region of interest.
//!
//! The region is a rectangle in plan; how high its ground and its roofs are is known only roughly, so the
//! part is the bounding box of the region at the lowest and at the highest possible height, and a margin.

use nalgebra::{Point3, Vector3};

use super::input::InputFile;
use super::names::listed;
use super::plan::PlannedView;
use crate::{Error, Result};

/// Buildings rise above the ground by no more than this, metres. Assumption: roofs of houses and halls.
const TALLEST_M: f64 = 60.0;

/// Pixels around the box, so that filters and windows at its border find their neighbours.
const MARGIN_PX: f64 = 40.0;

/// Smallest part worth keeping, pixels along a side.
const SMALLEST_PX: u32 = 64;

/// A box in the local frame.
#[derive(Debug)]
pub(super) struct Region {
    corners: Vec<Point3<f64>>,
}

impl Region {
    /// From x0, y0, x1, y1 in the world of the input and the range of the ground's height.
    pub(super) fn new(roi: [f64; 4], origin: &Vector3<f64>, heights: [f64; 2]) -> Result<Self> {
        let [x0, y0, x1, y1] = roi;
        if !(roi.iter().all(|v| v.is_finite()) && x0 < x1 && y0 < y1) {
            return Err(Error::Scene {
                problem: format!("the region of interest {x0},{y0},{x1},{y1} is empty"),
                advice: "give x0,y0,x1,y1 in metres with x0 < x1 and y0 < y1".to_owned(),
            });
        }
        let heights = [heights[0], heights[1] + TALLEST_M];
        let plan = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        let corners = heights
            .iter()
            .flat_map(|&z| plan.map(|[x, y]| Point3::new(x - origin.x, y - origin.y, z)))
            .collect();
        Ok(Self { corners })
    }

    /// Cuts the region out of each view; views that do not show it are left out with a warning.
    pub(super) fn cut(
        &self,
        files: &[InputFile],
        views: &mut Vec<PlannedView>,
    ) -> Result<Vec<String>> {
        let mut blind = Vec::new();
        views.retain_mut(|view| {
            view.part = self.part(view);
            if view.part.is_none() {
                blind.push(files[view.file].name().to_owned());
            }
            view.part.is_some()
        });
        if views.len() < 3 {
            return Err(Error::Scene {
                problem: format!(
                    "the region of interest is seen by {} views, but three are needed",
                    views.len()
                ),
                advice: "give it as x0,y0,x1,y1 in metres of the orientation's coordinates"
                    .to_owned(),
            });
        }
        Ok(if blind.is_empty() {
            Vec::new()
        } else {
            vec![format!(
                "views that do not show the region of interest, left out: {}",
                listed(blind.iter())
            )]
        })
    }

    /// Column, row, width, height of the part of a view.
    fn part(&self, view: &PlannedView) -> Option<[u32; 4]> {
        let camera = &view.whole;
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for corner in &self.corners {
            match camera.project(corner) {
                Some(p) => {
                    low = [low[0].min(p.x), low[1].min(p.y)];
                    high = [high[0].max(p.x), high[1].max(p.y)];
                }
                // The region reaches behind an oblique camera: all of the image may show it.
                None => (low, high) = ([f64::NEG_INFINITY; 2], [f64::INFINITY; 2]),
            }
        }
        let span = |low: f64, high: f64, size: u32| {
            let from = (low - MARGIN_PX).floor().clamp(0.0, f64::from(size)) as u32;
            let to = (high + MARGIN_PX).ceil().clamp(0.0, f64::from(size)) as u32;
            (to >= from + SMALLEST_PX.min(size)).then(|| (from, to - from))
        };
        let (column, width) = span(low[0], high[0], camera.width)?;
        let (row, height) = span(low[1], high[1], camera.height)?;
        Some([column, row, width, height])
    }
}
