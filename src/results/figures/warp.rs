//! The half-plane's homography at work (B99 4.1, figures 10, 11 and 13): the neighbourhood of a
//! line side in the reference view, and every other view warped onto it by H(theta). At the right
//! theta all pictures are alike.

use nalgebra::{Matrix3, Point2, Vector3};
use serde::Serialize;

use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::ViewId;
use crate::base::params::SweepParams;
use crate::lines::lines3d::{Side, ThetaFrame};
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, Homography, homography_of_plane};
use crate::planes::half_planes::{PointsOfInterest, similarity_curve};

/// Rows shown on the other side of the line, pixels: to see where the line is.
const ROWS_BEYOND_PX: f64 = 4.0;

/// All views warped into the reference view.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct WarpedViews {
    /// Angle, radians.
    pub theta: f64,
    /// The reference view: the most textured one.
    pub reference: ViewId,
    /// Sim(theta), the mean over the views that count at this angle alone, 0 to 1.
    pub similarity: f64,
    /// Points of interest as (column, row) of the pictures.
    pub points: Vec<[f64; 2]>,
    /// The row of the line itself.
    pub line_row: f64,
    /// Width of a picture, pixels.
    pub columns: usize,
    /// Height of a picture, pixels.
    pub rows: usize,
    /// The views, the reference first.
    pub views: Vec<WarpedView>,
    /// The pictures one below the other, RGBA; what a view does not show is transparent.
    #[serde(skip)]
    pub rgba: Vec<u8>,
}

/// One view's picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct WarpedView {
    /// The view.
    pub view: ViewId,
    /// Its own Sim(theta); `None` for the reference.
    pub similarity: Option<f64>,
    /// Does it count?
    pub valid: bool,
    /// Where the picture lies in the view, pixels; `None` where a corner is not in front of the
    /// camera.
    pub outline: Option<[Point2<f64>; 4]>,
}

/// The neighbourhood of one side of a line at an angle. `None` for a side that the sweep cannot
/// compare at all.
pub fn warped_views(
    scene: &Scene,
    points: &[PointsOfInterest],
    line: &Segment3,
    side: Side,
    theta: f64,
    params: &SweepParams,
) -> Option<WarpedViews> {
    let curve = similarity_curve(scene, points, line, side, &[theta], params).ok()?;
    let reference = curve.reference?;
    let frame = ThetaFrame::new(line, side)?;
    let plane = frame.plane(line, theta);
    let from = scene.camera(reference);
    let picture = WarpRaster::new(from, line, &frame, params)?;
    let mut warped = WarpedViews {
        theta,
        reference,
        similarity: curve.similarity.first().copied().unwrap_or(0.0),
        points: curve.points.iter().map(|p| picture.place_of(p)).collect(),
        line_row: ROWS_BEYOND_PX,
        columns: picture.columns,
        rows: picture.rows,
        views: Vec::new(),
        rgba: Vec::new(),
    };
    let others = curve.views.iter().map(|v| v.view);
    for view in std::iter::once(reference).chain(others) {
        let own = curve.views.iter().find(|v| v.view == view);
        let h = match own {
            None => Some(Homography(Matrix3::identity())),
            Some(_) => homography_of_plane(from, scene.camera(view), &plane),
        };
        let map = h.map(|h| Homography(h.0 * picture.image_from_picture));
        warped.views.push(WarpedView {
            view,
            similarity: own.map(|v| v.similarity.first().copied().unwrap_or(0.0)),
            valid: own.is_none_or(|v| v.valid),
            outline: map.as_ref().and_then(|m| picture.outline(m)),
        });
        picture.paint(&scene.view(view).rgb, map.as_ref(), &mut warped.rgba);
    }
    Some(warped)
}

/// The raster of the neighbourhood: columns run along the projected line, rows away from it.
struct WarpRaster {
    image_from_picture: Matrix3<f64>,
    columns: usize,
    rows: usize,
}

impl WarpRaster {
    fn new(
        camera: &Camera,
        line: &Segment3,
        frame: &ThetaFrame,
        params: &SweepParams,
    ) -> Option<Self> {
        let image = Segment2::new(camera.project(&line.p0)?, camera.project(&line.p1)?);
        let middle = line.at(0.5);
        let pixel_m = camera.ground_pixel(&middle);
        let outward = camera.project(&(middle + frame.outward * pixel_m))? - image.midpoint();
        let normal = image.normal();
        let across = if normal.dot(&outward) >= 0.0 {
            normal
        } else {
            -normal
        };
        let along = image.direction();
        let start = image.p0 - across * ROWS_BEYOND_PX;
        let depth_px = params.depth_px.min(params.depth_m / pixel_m) + ROWS_BEYOND_PX;
        Some(Self {
            image_from_picture: Matrix3::new(
                along.x, across.x, start.x, along.y, across.y, start.y, 0.0, 0.0, 1.0,
            ),
            columns: (image.length().ceil() as usize).max(1),
            rows: (depth_px.ceil() as usize).max(1),
        })
    }

    /// Column and row of an image point.
    fn place_of(&self, image: &Point2<f64>) -> [f64; 2] {
        let m = &self.image_from_picture;
        let (x, y) = (image.x - m[(0, 2)], image.y - m[(1, 2)]);
        // Both axes are unit vectors at right angles.
        [x * m[(0, 0)] + y * m[(1, 0)], x * m[(0, 1)] + y * m[(1, 1)]]
    }

    fn outline(&self, map: &Homography) -> Option<[Point2<f64>; 4]> {
        let (w, h) = (self.columns as f64, self.rows as f64);
        let corner = |x, y| map.apply(&Point2::new(x, y));
        Some([
            corner(0.0, 0.0)?,
            corner(w, 0.0)?,
            corner(w, h)?,
            corner(0.0, h)?,
        ])
    }

    /// Appends the pixels of a view under a map from the picture to it.
    fn paint(&self, rgb: &image::RgbImage, map: Option<&Homography>, rgba: &mut Vec<u8>) {
        for row in 0..self.rows {
            for column in 0..self.columns {
                let at = Point2::new(column as f64 + 0.5, row as f64 + 0.5);
                let colour = map
                    .and_then(|m| m.apply(&at))
                    .and_then(|p| bilinear(rgb, &p));
                rgba.extend(colour.map_or([0; 4], |[r, g, b]| [r, g, b, 255]));
            }
        }
    }
}

/// The colour at an image position; `None` where one of the four pixels is missing.
fn bilinear(rgb: &image::RgbImage, at: &Point2<f64>) -> Option<[u8; 3]> {
    let at = Vector3::new(at.x - 0.5, at.y - 0.5, 0.0);
    let (column, row) = (at.x.floor(), at.y.floor());
    let inside = column >= 0.0
        && row >= 0.0
        && column + 1.0 < f64::from(rgb.width())
        && row + 1.0 < f64::from(rgb.height());
    if !inside {
        return None;
    }
    let (fx, fy) = (at.x - column, at.y - row);
    let pixel = |dx: u32, dy: u32| rgb.get_pixel(column as u32 + dx, row as u32 + dy).0;
    let [a, b, c, d] = [pixel(0, 0), pixel(1, 0), pixel(0, 1), pixel(1, 1)];
    Some(std::array::from_fn(|k| {
        let mix = |l: u8, r: u8| f64::from(l) + (f64::from(r) - f64::from(l)) * fx;
        let (top, bottom) = (mix(a[k], b[k]), mix(c[k], d[k]));
        (top + (bottom - top) * fy).round() as u8
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::gable_scene;

    /// Mean absolute difference of a picture from the reference's, over what both show.
    fn difference(warped: &WarpedViews, picture: usize) -> f64 {
        let size = 4 * warped.columns * warped.rows;
        let of = |i: usize| warped.rgba[i * size..(i + 1) * size].chunks_exact(4);
        let (mut sum, mut count) = (0.0, 0.0);
        for (a, b) in of(0).zip(of(picture)) {
            if a[3] > 0 && b[3] > 0 {
                sum += (f64::from(a[1]) - f64::from(b[1])).abs();
                count += 1.0;
            }
        }
        sum / f64::max(count, 1.0)
    }

    #[test]
    fn at_the_planes_own_angle_the_views_are_alike() {
        let (scene, truth) = gable_scene(320);
        let params = SweepParams::default();
        let points = PointsOfInterest::detect_all(&scene, &params);
        let mut compared = 0;
        for (edge, (plane, _)) in truth
            .edges
            .iter()
            .flat_map(|e| truth.facets.iter().map(move |f| (e, f)))
        {
            let in_plane = [edge.p0, edge.p1]
                .iter()
                .all(|p| plane.signed_distance(p).abs() < 1e-6);
            if !in_plane {
                continue;
            }
            for side in [Side::Left, Side::Right] {
                let Some(frame) = ThetaFrame::new(edge, side) else {
                    continue;
                };
                let theta = frame.theta_of(plane);
                let at = |theta| warped_views(&scene, &points, edge, side, theta, &params);
                let (Some(right), Some(wrong)) = (at(theta), at(theta - 0.5)) else {
                    continue;
                };
                let valid = right.views.iter().skip(1).filter(|v| v.valid).count();
                if right.similarity < 0.5 || valid < 3 {
                    continue; // the side of the edge where the roof is not
                }
                compared += 1;
                assert!(right.similarity > wrong.similarity);
                let sum =
                    |w: &WarpedViews| (1..w.views.len()).map(|i| difference(w, i)).sum::<f64>();
                assert!(sum(&right) < sum(&wrong));
                let all = right.columns * right.rows * right.views.len();
                assert_eq!(right.rgba.len(), 4 * all);
            }
        }
        assert!(compared >= 2, "{compared} sides compared");
    }
}
