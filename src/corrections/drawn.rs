//! An edge drawn in one photograph: its line in space, and the planes on both sides of it.

use nalgebra::{Matrix3, Point2, Point3, Vector3};

use super::draft::{Draft, House};
use super::outcome::NotApplied;
use super::place::corners;
use crate::camera::Camera;
use crate::geometry::{Segment2, bounds};
use crate::ids::{LineId, ViewId};
use crate::linematch::line_of_drawn;
use crate::lines3d::{Line3d, Side};
use crate::params::{Acceptance, Params, SweepParams};
use crate::planes::{HalfPlane, PointsOfInterest, SweepTrace, sweep_side};
use crate::raster::Gray;
use crate::scene::{Scene, Survey, View};

/// The line of an edge that is drawn in a photograph, between the ground and as high as a roof
/// over the building can reach.
pub(super) fn line_in_space(
    scene: &Scene,
    draft: &Draft,
    photograph: &str,
    pixels: &[Point2<f64>; 2],
    params: &Params,
) -> Result<Line3d, NotApplied> {
    let drawn = Segment2::new(pixels[0], pixels[1]);
    let named = scene.views.iter().position(|v| v.name == photograph);
    let view = ViewId::from_index(named.ok_or(NotApplied::NoPhotograph)?);
    let camera = scene.camera(view);
    // What is no number is in no photograph.
    let is_inside = [drawn.p0, drawn.p1].iter().all(|x| camera.contains(x, 0.0));
    if !is_inside || drawn.length() < params.matching.min_edgels as f64 {
        return Err(NotApplied::NotInPhotograph);
    }
    let z_range = heights(camera, draft, &drawn).ok_or(NotApplied::NoBuilding)?;
    let parameters = (&params.matching, &params.lines3d);
    line_of_drawn(scene, view, &drawn, z_range, parameters).ok_or(NotApplied::NoLine)
}

/// The heights between which an edge can lie that is drawn over some buildings of a photograph;
/// `None` where it is drawn over none.
fn heights(camera: &Camera, draft: &Draft, drawn: &Segment2) -> Option<[f64; 2]> {
    let middle = drawn.midpoint();
    let ranges = draft.houses.iter().filter_map(|house| {
        let [low, high] = range_of(house);
        let roof = || house.facets.iter().flat_map(|f| corners(&f.facet));
        let at = |z: f64| roof().map(move |p| camera.project(&Point3::new(p.x, p.y, z)));
        let seen: Vec<Point2<f64>> = at(low).chain(at(high)).collect::<Option<_>>()?;
        let [least, most] = bounds(seen);
        let is_over = (0..2).all(|i| least[i] <= middle[i] && middle[i] <= most[i]);
        is_over.then_some([low, high])
    });
    ranges.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// From the ground below a building to where its highest corner would be a ridge over the whole
/// house, metres. Assumption: no roof whose top is missing rises by more than half the width of
/// the house, as one of 45 degrees does.
fn range_of(house: &House) -> [f64; 2] {
    let roof = || house.facets.iter().flat_map(|f| corners(&f.facet));
    let [low, high] = bounds(roof().map(Point3::xy));
    let width = (high - low).min();
    let top = roof().fold(f64::NEG_INFINITY, |top, p| top.max(p.z));
    [house.building.ground_z, top + 0.5 * width]
}

/// Least probability of a half-plane beside a drawn edge: likelier there than not. No grouping
/// follows, which tolerates few that are wrong, and without one the half keeps its plane.
const LEAST_PROBABILITY: f64 = 0.5;

/// The half-planes that the photographs show to the left and to the right of a line (B99 4.1).
pub(super) fn sides(scene: &Scene, line: &Line3d, params: &Params) -> [Option<HalfPlane>; 2] {
    let sweep = SweepParams {
        acceptance: Acceptance::Posterior,
        min_probability: LEAST_PROBABILITY,
        ..params.sweep.clone()
    };
    let near = around(scene, line, 2.0 * sweep.depth_px);
    let points = PointsOfInterest::detect_all(&near, &sweep);
    let mut trace = SweepTrace::default();
    [Side::Left, Side::Right].map(|side| {
        let id = LineId::from_index(0);
        sweep_side(&near, &points, id, line, side, &sweep, &mut trace)
    })
}

/// The parts of the photographs around a line, without colours: the sweep looks no farther.
fn around(scene: &Scene, line: &Line3d, margin_px: f64) -> Scene {
    let part = |view: &View| {
        let ends = [line.segment.p0, line.segment.p1].map(|p| view.camera.project(&p));
        let [low, high] = bounds(ends.into_iter().flatten());
        let whole = [view.gray.width, view.gray.height];
        let pixel = |x: f64, axis: usize| x.clamp(0.0, whole[axis] as f64) as usize;
        let [x0, y0] = [0, 1].map(|i| pixel(low[i] - margin_px, i));
        let [x1, y1] = [0, 1].map(|i| pixel((high[i] + margin_px).ceil(), i));
        (x0 < x1 && y0 < y1).then_some(())?;
        let gray = Gray::from_fn(x1 - x0, y1 - y0, |x, y| view.gray.get(x0 + x, y0 + y));
        let shift = Vector3::new(x0 as f64, y0 as f64, 0.0);
        let moved = Matrix3::identity() - shift * Vector3::z().transpose();
        Some(View {
            name: view.name.clone(),
            camera: Camera {
                k: moved * view.camera.k,
                width: gray.width as u32,
                height: gray.height as u32,
                ..view.camera.clone()
            },
            gray,
            rgb: image::RgbImage::new(0, 0),
            noise: view.noise,
            red_blue: None,
        })
    };
    Scene {
        views: scene.views.iter().filter_map(part).collect(),
        origin: scene.origin,
        ground_z: scene.ground_z,
        region: None,
        known: Default::default(),
        warnings: Vec::new(),
        survey: Survey::default(),
    }
}
