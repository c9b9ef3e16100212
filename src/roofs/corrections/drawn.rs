//! An edge drawn in one photograph: its line in space.

use nalgebra::{Matrix3, Point2, Point3};

use super::draft::{Draft, House};
use super::outcome::NotApplied;
use super::place::corners;
use crate::base::geometry::{Plane, Segment2, bounds};
use crate::base::ids::ViewId;
use crate::base::params::Params;
use crate::lines::linematch::{DrawnEdge, line_of_drawn};
use crate::lines::lines3d::{Line3d, LineOrigin};
use crate::orienting::scene::Scene;
use crate::photographs::camera::Camera;

/// Ends nearer to each other than so many standard deviations of the hand have no direction.
const LENGTH_SIGMAS: f64 = 4.0;
/// No hand is more accurate, px.
const LEAST_SIGMA_PX: f64 = 0.01;

/// An edge that is drawn in a photograph, and where it is sought.
pub(super) struct Sought {
    edge: DrawnEdge,
    /// Between the ground and as high as a roof over the building can reach, metres.
    z_range: [f64; 2],
    /// The plane of the facet in which it is drawn.
    plane: Option<Plane>,
}

impl Sought {
    pub(super) fn new(
        scene: &Scene,
        draft: &Draft,
        photograph: &str,
        (pixels, sigma_px): (&[Point2<f64>; 2], f64),
        params: &Params,
    ) -> Result<Self, NotApplied> {
        let segment = Segment2::new(pixels[0], pixels[1]);
        // What is no number is refused.
        let is_plausible = sigma_px >= LEAST_SIGMA_PX;
        if !is_plausible {
            return Err(NotApplied::Implausible);
        }
        let named = scene.views.iter().position(|v| v.name == photograph);
        let view = ViewId::from_index(named.ok_or(NotApplied::NoPhotograph)?);
        let camera = scene.camera(view);
        let is_inside = pixels.iter().all(|x| camera.contains(x, 0.0));
        let least = (params.matching.min_edgels as f64).max(LENGTH_SIGMAS * sigma_px);
        if !is_inside || segment.length() < least {
            return Err(NotApplied::NotInPhotograph);
        }
        Ok(Self {
            z_range: heights(camera, draft, &segment).ok_or(NotApplied::NoBuilding)?,
            plane: plane_below(scene, draft, view, &segment.midpoint()),
            edge: DrawnEdge {
                view,
                segment,
                sigma_px,
            },
        })
    }

    /// Its line, as other photographs show it.
    pub(super) fn matched(&self, scene: &Scene, params: &Params) -> Option<Line3d> {
        let planes: Vec<Plane> = self.plane.into_iter().collect();
        let places = (self.z_range, &planes[..]);
        line_of_drawn(
            scene,
            &self.edge,
            places,
            (&params.matching, &params.lines3d),
        )
    }

    /// Its line on the facet in which it is drawn, as well as the hand knows it: without supports.
    pub(super) fn on_facet(&self, scene: &Scene) -> Option<Line3d> {
        let segment = self.edge.on_plane(scene, &self.plane?)?;
        let pixel_m = scene.camera(self.edge.view).ground_pixel(&segment.at(0.5));
        let sigma_m = self.edge.sigma_px * pixel_m;
        let covariance = Matrix3::identity() * (sigma_m * sigma_m);
        Some(Line3d {
            origin: LineOrigin::Matched,
            segment,
            sigma_m,
            covariance: [covariance; 2],
            probability: 1.0,
            supports: Vec::new(),
            contradiction: None,
        })
    }
}

/// The plane of the facet that a photograph shows at a place.
fn plane_below(scene: &Scene, draft: &Draft, view: ViewId, at: &Point2<f64>) -> Option<Plane> {
    let camera = scene.camera(view);
    let ray = camera.ray(at);
    let seen = draft.facets().filter_map(|(place, f)| {
        let plane = f.facet.plane;
        let depth = -plane.signed_distance(&camera.center) / plane.normal.dot(&ray);
        let point = camera.center + ray * depth;
        (depth > 0.0 && draft.facet_below(&point.xy()) == Some(place)).then_some((depth, plane))
    });
    let nearest = seen.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, plane)| plane)
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
