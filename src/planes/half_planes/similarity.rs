//! `Sim(theta)` of one line side (B99 4.1):
//!
//! `Sim(theta) = sum over valid views i, integral over POI of w(x) Cor^2(x, H^i(theta) x)`,
//!
//! with `w(x)` inversely proportional to the distance of x from the projected line, and normalised
//! so that Sim is in (0, 1): the weights of a view's points sum to one and the views are averaged.
//!
//! Deviation: a negative correlation counts as 0, not as its square, because an inverted pattern is
//! no support. The margin beside the line keeps 1/distance finite.

use nalgebra::Point2;
use wide::f64x4;

use super::poi::PointsOfInterest;
use super::posterior::{FourModels, WindowModel, evidence_of_view};
use super::trace::SweepRejection;
use crate::base::geometry::Segment3;
use crate::base::ids::ViewId;
use crate::base::params::{Acceptance, SweepParams};
use crate::lines::lines3d::{Side, ThetaFrame};
use crate::orienting::scene::Scene;
use crate::photographs::camera::homography_of_plane;
use crate::photographs::raster::corners;
use crate::planes::photoconsistency::{CorrelationWindows, LineSideStrip, StripPatch};

/// Similarity and evidence of one view at one theta.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ViewScore {
    /// Weighted mean of `Cor^2` over the points of interest, 0 to 1; 0 where the view does not see
    /// the half-plane.
    pub similarity: f64,
    /// Share of the points of interest with a high correlation, 0 to 1.
    pub high: f64,
    /// Evidence for the plane, see [`super::posterior`]; 0 where the view does not see the
    /// half-plane.
    pub evidence: f64,
}

/// One line side, ready to be compared at any theta.
pub(crate) struct LineSide<'a> {
    scene: &'a Scene,
    params: &'a SweepParams,
    line: Segment3,
    /// The frame of theta.
    pub frame: ThetaFrame,
    /// "The choice of the first view [...] can be automated by selecting the most textured image".
    pub reference: ViewId,
    /// The other views, in order.
    pub others: Vec<ViewId>,
    strip: LineSideStrip,
    windows: CorrelationWindows,
    /// Normalised weight of every site.
    weights: Vec<f64>,
    /// What is expected of the sites, four at a time.
    expected: Vec<ExpectedCorrelations>,
    warped: StripPatch,
    /// One a site, then zeros to a multiple of four.
    correlations: Vec<f64>,
    /// Correlations computed so far.
    pub count: u64,
    /// Strip pixels warped so far.
    pub pixels: u64,
}

/// What is expected of four sites. Beyond the last site all of it is nothing.
#[derive(Clone, Copy, Debug)]
struct ExpectedCorrelations {
    /// One for each site.
    present: f64x4,
    /// Normalised weights.
    weight: f64x4,
    /// What they correlate by on a plane.
    models: FourModels,
    /// From which correlation on theirs is high.
    high_from: f64x4,
}

impl<'a> LineSide<'a> {
    /// Chooses the reference view and its points of interest.
    pub(super) fn new(
        scene: &'a Scene,
        points: &[PointsOfInterest],
        line: &Segment3,
        side: Side,
        params: &'a SweepParams,
    ) -> Result<Self, SweepRejection> {
        let frame = ThetaFrame::new(line, side).ok_or(SweepRejection::NoFrame)?;
        let (reference, strip, pixels) =
            most_textured(scene, points, line, &frame, params).ok_or(SweepRejection::TooShort)?;
        // Rows that no window reaches need not be warped.
        let last = pixels.iter().map(|p| p.1).max().unwrap_or(0);
        let strip = strip.truncated(last + params.window_px / 2 + 1);
        let mut patch = StripPatch::default();
        patch.warp(
            &scene.view(reference).gray,
            &strip,
            &strip.image_from_strip(),
        );
        let windows = CorrelationWindows::new(patch, params.window_px, &pixels);
        if windows.sites.len() < params.min_points {
            return Err(SweepRejection::NoPointsOfInterest);
        }
        let mut weights: Vec<f64> = windows
            .sites
            .iter()
            .map(|site| 1.0 / strip.distance_px(site.row))
            .collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|w| *w /= sum);
        let noise = scene.view(reference).noise;
        let sites = windows.sites.iter();
        let models: Vec<WindowModel> = sites
            .map(|s| WindowModel::new(s.contrast(), noise))
            .collect();
        let fours = models.chunks(4).zip(weights.chunks(4));
        let expected = fours
            .map(|(models, weights)| ExpectedCorrelations::new(models, weights, params))
            .collect();
        Ok(Self {
            scene,
            params,
            expected,
            line: *line,
            frame,
            reference,
            others: scene.view_ids().filter(|&id| id != reference).collect(),
            strip,
            windows,
            weights,
            warped: StripPatch::default(),
            correlations: Vec::new(),
            count: 0,
            pixels: 0,
        })
    }

    /// Positions of the points of interest in the reference view, pixels.
    pub(super) fn points(&self) -> Vec<Point2<f64>> {
        let m = self.strip.image_from_strip();
        let at = |v: usize| v as f64 + 0.5;
        self.windows
            .sites
            .iter()
            .map(|s| {
                (m * nalgebra::Vector3::new(at(s.column), at(s.row), 1.0))
                    .xy()
                    .into()
            })
            .collect()
    }

    /// Weighted mean distance of the points of interest from the line, metres on the ground: the
    /// lever with which theta is measured. (The least-squares lever `E[d^2] / E[d]` is too long:
    /// the correlation of a far point is lost before it can pull; measured on lines displaced by a
    /// known noise, it makes sigma a third too small.)
    pub(super) fn lever_m(&self) -> f64 {
        let camera = self.scene.camera(self.reference);
        let sites = self.windows.sites.iter().zip(&self.weights);
        let mean_px: f64 = sites.map(|(s, w)| w * self.strip.distance_px(s.row)).sum();
        mean_px * camera.ground_pixel(&self.line.at(0.5))
    }

    /// Does the reference view see the upper side of the half-plane? Elsewhere theta has no
    /// meaning.
    pub(super) fn is_visible(&self, theta: f64) -> bool {
        self.sees(self.reference, theta)
    }

    /// Compares the reference with one view under `H(theta)`.
    pub(super) fn score(&mut self, view: ViewId, theta: f64) -> ViewScore {
        let scene = self.scene;
        if !self.sees(view, theta) {
            return ViewScore::default();
        }
        let (from, to) = (scene.camera(self.reference), scene.view(view));
        let plane = self.frame.plane(&self.line, theta);
        let Some(h) = homography_of_plane(from, &to.camera, &plane) else {
            return ViewScore::default();
        };
        let view_from_strip = h.0 * self.strip.image_from_strip();
        let size = [self.strip.columns as f64, self.strip.rows as f64];
        let Some(whole) = corners(&view_from_strip, [0.0, 0.0], size) else {
            return ViewScore::default();
        };
        self.warped.warp(&to.gray, &self.strip, &view_from_strip);
        self.windows.correlate(&self.warped, &mut self.correlations);
        self.correlations.resize(4 * self.expected.len(), 0.0);
        self.count += self.windows.sites.len() as u64;
        self.pixels += (self.strip.columns * self.strip.rows) as u64;
        if whole.iter().all(|c| to.camera.contains(c, 0.5)) {
            return self.reduce(|_| f64x4::ONE);
        }
        let shows = |site| self.window_is_inside(site, &to.camera, &view_from_strip);
        self.reduce(|four| lanes(|lane| f64::from(u8::from(shows(4 * four + lane)))))
    }

    /// Weighted mean over the sites that the view shows: `shown` is one for those among the i-th
    /// four.
    fn reduce(&self, shown: impl Fn(usize) -> f64x4) -> ViewScore {
        let zero = f64x4::ZERO;
        let (mut weight, mut similarity, mut points) = (zero, zero, zero);
        let (mut high, mut evidence) = (zero, zero);
        let fours = self.expected.iter().zip(self.correlations.chunks_exact(4));
        for (i, (expected, cor)) in fours.enumerate() {
            let (shown, cor) = (shown(i), lanes(|lane| cor[lane]));
            let w = expected.weight * shown;
            evidence += w * expected.models.evidence(cor);
            let positive = cor.fast_max(zero);
            weight += w;
            similarity += w * positive * positive;
            points += expected.present * shown;
            high += cor.simd_ge(expected.high_from).select(shown, zero);
        }
        let [weight, similarity, points, high, evidence] =
            [weight, similarity, points, high, evidence].map(sum);
        // A view that shows less than half of the neighbourhood does not see it.
        if weight < 0.5 {
            return ViewScore::default();
        }
        ViewScore {
            similarity: similarity / weight,
            high: high / points,
            evidence: evidence_of_view(evidence / weight, self.windows_side_by_side()),
        }
    }

    /// How many windows the neighbourhood holds that do not overlap, at most one a site.
    fn windows_side_by_side(&self) -> f64 {
        let area = (self.strip.columns * self.strip.rows) as f64;
        let window = (self.params.window_px * self.params.window_px).max(1) as f64;
        (area / window).min(self.windows.sites.len() as f64)
    }

    fn window_is_inside(
        &self,
        site: usize,
        camera: &crate::photographs::camera::Camera,
        view_from_strip: &nalgebra::Matrix3<f64>,
    ) -> bool {
        let Some(site) = self.windows.sites.get(site) else {
            return false;
        };
        let half = self.params.window_px as f64 * 0.5;
        let (x, y) = (site.column as f64 + 0.5, site.row as f64 + 0.5);
        corners(view_from_strip, [x - half, y - half], [x + half, y + half])
            .is_some_and(|c| c.iter().all(|c| camera.contains(c, 0.5)))
    }

    /// Does the view look onto the upper side of the half-plane, not too obliquely?
    fn sees(&self, view: ViewId, theta: f64) -> bool {
        // The sine of 6 degrees: there a pixel covers ten on the plane.
        const MIN_SINE: f64 = 0.1;
        let to_camera = self.scene.camera(view).center - self.line.at(0.5);
        let normal = self.frame.plane(&self.line, theta).normal;
        normal.dot(&to_camera) > MIN_SINE * to_camera.norm()
    }
}

impl ExpectedCorrelations {
    /// Of up to four sites.
    fn new(models: &[WindowModel], weights: &[f64], params: &SweepParams) -> Self {
        let lane = |i: usize| models.get(i).zip(weights.get(i));
        let of = |value: &dyn Fn(&WindowModel, f64) -> f64, absent: f64| {
            lanes(|i| lane(i).map_or(absent, |(model, &weight)| value(model, weight)))
        };
        Self {
            present: of(&|_, _| 1.0, 0.0),
            weight: of(&|_, weight| weight, 0.0),
            models: FourModels::new(std::array::from_fn(|i| {
                models.get(i).copied().unwrap_or_default()
            })),
            high_from: of(&|model, _| high_correlation(model, params), f64::INFINITY),
        }
    }
}

/// In one order everywhere: processors add lanes as suits them.
fn sum(four: f64x4) -> f64 {
    let [a, b, c, d] = four.to_array();
    (a + b) + (c + d)
}

fn lanes(value: impl Fn(usize) -> f64) -> f64x4 {
    f64x4::new(std::array::from_fn(value))
}

/// The correlation from which on a site counts as high: less than usual where noise keeps it down,
/// unless the printed thresholds alone decide.
fn high_correlation(model: &WindowModel, params: &SweepParams) -> f64 {
    // Half-way between chance and a surface, about.
    const OF_EXPECTED: f64 = 0.75;
    match params.acceptance {
        Acceptance::Printed => params.high_correlation,
        _ => (OF_EXPECTED * model.rho()).min(params.high_correlation),
    }
}

/// A view, the strip in it and the strip's pixels (column, row) that are points of interest.
type ReferenceNeighbourhood = (ViewId, LineSideStrip, Vec<(usize, usize)>);

/// The view in which the neighbourhood holds the most points of interest, with its strip and their
/// pixels, ordered by row. The first one wins a tie.
fn most_textured(
    scene: &Scene,
    points: &[PointsOfInterest],
    line: &Segment3,
    frame: &ThetaFrame,
    params: &SweepParams,
) -> Option<ReferenceNeighbourhood> {
    let mut best: Option<ReferenceNeighbourhood> = None;
    for id in scene.view_ids() {
        let Some(strip) = LineSideStrip::new(scene.camera(id), line, frame, params) else {
            continue;
        };
        let [min, max] = strip.bounds();
        let columns = strip.columns;
        let mut places: Vec<usize> = points[id.index()]
            .within(min, max)
            .filter_map(|p| strip.pixel_of(&p))
            .map(|(column, row)| row * columns + column)
            .collect();
        places.sort_unstable();
        places.dedup();
        if best.as_ref().is_none_or(|b| places.len() > b.2.len()) {
            let pixels = places.iter().map(|&p| (p % columns, p / columns));
            best = Some((id, strip, pixels.collect()));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::Plane;
    use crate::planes::rendered_planes::{TexturedPlane, scene};
    use nalgebra::{Point3, Vector3};

    #[test]
    fn weights_are_inverse_to_the_distance_and_sum_to_one() {
        let ground = TexturedPlane {
            plane: Plane::from_point_normal(&Point3::origin(), &Vector3::z()).unwrap(),
            exists: |_, _| true,
            texture: 0.3,
        };
        let scene = scene(&[ground]);
        let params = SweepParams::default();
        let points = PointsOfInterest::detect_all(&scene, &params);
        let line = Segment3::new(Point3::new(-4.0, 1.0, 0.0), Point3::new(4.0, -1.0, 0.0));
        let mut side = LineSide::new(&scene, &points, &line, Side::Right, &params).unwrap();
        assert!((side.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let product = |i: usize| {
            let distance = side.strip.distance_px(side.windows.sites[i].row);
            side.weights[i] * distance
        };
        assert!((1..side.weights.len()).all(|i| (product(i) - product(0)).abs() < 1e-12));

        // The mean of squares by hand; an inverted window counts as none.
        side.correlations = vec![-1.0; 4 * side.expected.len()];
        // The last one, too, which may not stand among four.
        let (last, sites) = (side.weights.len() - 1, side.weights.len() as f64);
        side.correlations[last] = 0.3;
        side.correlations[0] = 0.5;
        side.correlations[1] = 0.7;
        let score = side.reduce(|_| f64x4::ONE);
        let expected = side.weights[0] * 0.25 + side.weights[1] * 0.49 + side.weights[last] * 0.09;
        assert!((score.similarity - expected).abs() < 1e-12);
        assert!((score.high - 1.0 / sites).abs() < 1e-12);
        assert_eq!(
            side.reduce(|i| f64x4::splat(f64::from(u8::from(i == 0)))),
            ViewScore::default(),
            "too little in view"
        );
    }
}
