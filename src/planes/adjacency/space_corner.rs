//! A corner in space from its images: place and edges by least squares, and what speaks for them.

use nalgebra::{Matrix2, Matrix2x3, Matrix3, Point3, RowVector3, Vector2, Vector3};
use serde::Serialize;

use super::graph::{CornerEdge, ImageCorner, ImageGraph};
use crate::base::ids::ViewId;
use crate::base::math::{atan2, ln, median};
use crate::orienting::scene::Scene;
use crate::planes::coplanar::log_normal;

/// A corner in space.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SpaceCorner {
    /// The place, metres, local frame.
    pub at: Point3<f64>,
    /// Its covariance, m^2, 3 x 3.
    pub covariance: [[f64; 3]; 3],
    /// Its images: view, and the corner in the graph of that view; ascending.
    pub images: Vec<[u32; 2]>,
    /// Its edges, clockwise as seen from above.
    pub edges: Vec<SpaceEdge>,
    /// What its images' places say, against as many corners by chance, nats.
    pub place_nats: f64,
    /// What the colours of its regions say, nats.
    pub color_nats: f64,
}

/// An edge of a corner in space.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SpaceEdge {
    /// Unit direction away from the corner.
    pub direction: Vector3<f64>,
    /// Covariance of the direction, 3 x 3, nothing along it.
    pub covariance: [[f64; 3]; 3],
    /// How far it reaches, metres: the median of its images.
    pub length_m: f64,
    /// The corner in space that most of its images lead to.
    pub neighbour: Option<u32>,
    /// Its images: view, and the edge of the corner in that view.
    pub images: Vec<[u32; 2]>,
    /// What its images' directions say, against as many edges by chance, nats.
    pub nats: f64,
}

impl SpaceCorner {
    /// What speaks for it, against chance, nats.
    pub fn nats(&self) -> f64 {
        let edges: f64 = self.edges.iter().map(|e| e.nats).sum();
        self.place_nats + edges + self.color_nats
    }
}

impl SpaceEdge {
    /// The far end, metres.
    pub fn far(&self, corner: &Point3<f64>) -> Point3<f64> {
        corner + self.direction * self.length_m
    }
}

/// The image of a corner.
#[derive(Clone, Copy)]
pub(super) struct Sighting<'a> {
    pub view: ViewId,
    pub corner: &'a ImageCorner,
}

impl<'a> Sighting<'a> {
    pub(super) fn of(graphs: &'a [ImageGraph], [view, index]: [u32; 2]) -> Self {
        Self {
            view: ViewId(view),
            corner: &graphs[view as usize].corners[index as usize],
        }
    }
}

/// The place that fits some images best, and its covariance. `None` where the rays do not meet in
/// front of the cameras.
pub(super) fn place(scene: &Scene, seen: &[Sighting]) -> Option<(Point3<f64>, Matrix3<f64>)> {
    /// Corners are a hundredth of their distance off at the start, and the steps are Newton's.
    const ROUNDS: usize = 4;
    let (mut m, mut v) = (Matrix3::zeros(), Vector3::zeros());
    let origin = scene.camera(seen.first()?.view).center;
    for s in seen {
        let camera = scene.camera(s.view);
        let ray = camera.ray(&s.corner.at);
        let across = Matrix3::identity() - ray * ray.transpose();
        m += across;
        v += across * (camera.center - origin);
    }
    let mut at = origin + m.try_inverse()? * v;
    let mut covariance = Matrix3::zeros();
    for _ in 0..ROUNDS {
        let (mut information, mut sum) = (Matrix3::zeros(), Vector3::zeros());
        for s in seen {
            let camera = scene.camera(s.view);
            let (image, j) = (camera.project(&at)?, camera.project_jacobian(&at)?);
            let weight = s.corner.covariance().try_inverse()?;
            information += j.transpose() * weight * j;
            sum += j.transpose() * weight * (s.corner.at - image);
        }
        covariance = information.try_inverse()?;
        at += covariance * sum;
    }
    Some((at, covariance))
}

/// Logarithm of the normal density of a place in an image around another one.
pub(super) fn log_normal_2(off: &Vector2<f64>, covariance: &Matrix2<f64>) -> Option<f64> {
    let inverse = covariance.try_inverse()?;
    let area = std::f64::consts::TAU * covariance.determinant().sqrt();
    Some(-0.5 * off.dot(&(inverse * off)) - ln(area))
}

/// An image of a direction: what the sine of the angle to an edge is, linear in the direction.
struct EdgeImage<'a> {
    image: [u32; 2],
    edge: &'a CornerEdge,
    /// Derivative of the place in the image by that in space, pixels per metre.
    jacobian: Matrix2x3<f64>,
    /// The edges that a direction could be of by chance, per radian.
    density: f64,
}

impl EdgeImage<'_> {
    fn normal(&self) -> RowVector3<f64> {
        let d = &self.edge.direction;
        RowVector3::from(Vector2::new(-d.y, d.x).transpose() * self.jacobian)
    }

    /// Whether a direction leaves the corner on the side of the edge.
    fn is_ahead(&self, direction: &Vector3<f64>) -> bool {
        (self.jacobian * direction).dot(&self.edge.direction) > 0.0
    }

    /// Sine of the angle between a direction's image and the edge, and its derivative.
    fn residual(&self, direction: &Vector3<f64>) -> (f64, RowVector3<f64>) {
        let row = self.normal() / (self.jacobian * direction).norm().max(1e-12);
        ((row * direction).x, row)
    }
}

/// A direction with the covariance of its two numbers, by its edges' images.
struct Direction<'a> {
    images: Vec<&'a EdgeImage<'a>>,
    direction: Vector3<f64>,
    /// Covariance, 3 x 3, nothing along the direction.
    covariance: Matrix3<f64>,
    /// Determinant of the covariance in the two directions across.
    determinant: f64,
}

impl<'a> Direction<'a> {
    fn fit(images: Vec<&'a EdgeImage<'a>>, start: Vector3<f64>) -> Option<Self> {
        let mut found = Self {
            images,
            direction: start,
            covariance: Matrix3::zeros(),
            determinant: 0.0,
        };
        // Weights depend on the direction; they change little after the second round.
        for _ in 0..3 {
            let d = found.direction;
            let side = if d.z.abs() < 0.9 {
                Vector3::z()
            } else {
                Vector3::x()
            };
            let e1 = d.cross(&side).normalize();
            let e2 = d.cross(&e1);
            let (mut information, mut sum) = (Matrix2::zeros(), Vector2::zeros());
            for image in &found.images {
                let (r, row) = image.residual(&d);
                let g = Vector2::new((row * e1).x, (row * e2).x);
                let weight = 1.0 / (image.edge.sigma * image.edge.sigma);
                information += g * g.transpose() * weight;
                sum -= g * (r * weight);
            }
            let inverse = information.try_inverse()?;
            let step = inverse * sum;
            found.direction = (d + e1 * step.x + e2 * step.y).normalize();
            let frame = nalgebra::Matrix3x2::from_columns(&[e1, e2]);
            found.covariance = frame * inverse * frame.transpose();
            found.determinant = inverse.determinant();
        }
        let is_ahead = |image: &&EdgeImage| image.is_ahead(&found.direction);
        (found.determinant > 0.0 && found.images.iter().all(is_ahead)).then_some(found)
    }

    /// With the images of other views that it is likelier to have than chance.
    fn grown(mut self, all: &'a [EdgeImage<'a>]) -> Option<Self> {
        for image in all {
            if self.images.iter().any(|i| i.image[0] == image.image[0]) {
                continue;
            }
            let nats = |image: &EdgeImage| {
                let (r, row) = image.residual(&self.direction);
                let variance = image.edge.sigma * image.edge.sigma
                    + (row * self.covariance * row.transpose()).x;
                image
                    .is_ahead(&self.direction)
                    .then(|| log_normal(r, variance) - ln(image.density))
            };
            let of_view = all.iter().filter(|i| i.image[0] == image.image[0]);
            let weighed = of_view.filter_map(|i| Some((nats(i)?, i)));
            let best = weighed.max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, best)) = best.filter(|(n, _)| *n > 0.0) {
                let mut images = self.images.clone();
                images.push(best);
                self = Self::fit(images, self.direction)?;
            }
        }
        Some(self)
    }

    /// Evidence for one direction behind its images, all directions being as likely before,
    /// against as many edges by chance; nats.
    fn nats(&self) -> f64 {
        let of_images: f64 = (self.images.iter())
            .map(|image| {
                let variance = image.edge.sigma * image.edge.sigma;
                log_normal(image.residual(&self.direction).0, variance) - ln(image.density)
            })
            .sum();
        // The integral over the two numbers of the direction, over the area of the sphere.
        of_images + ln(0.5 * self.determinant.sqrt())
    }
}

/// The edges in space of a corner: directions that three views or more agree on, the likeliest
/// first, each image of an edge once; then clockwise. Two views always agree on a direction.
pub(super) fn edges(scene: &Scene, at: &Point3<f64>, seen: &[Sighting]) -> Vec<SpaceEdge> {
    // So many agree on any direction.
    const TWO_VIEWS: usize = 2;
    let mut images: Vec<EdgeImage> = Vec::new();
    for s in seen {
        let Some(jacobian) = scene.camera(s.view).project_jacobian(at) else {
            continue;
        };
        let density = s.corner.edges.len() as f64 / std::f64::consts::TAU;
        images.extend(
            s.corner
                .edges
                .iter()
                .enumerate()
                .map(|(k, edge)| EdgeImage {
                    image: [s.view.0, k as u32],
                    edge,
                    jacobian,
                    density,
                }),
        );
    }
    let mut found: Vec<Direction> = Vec::new();
    for (i, a) in images.iter().enumerate() {
        for b in images[i + 1..].iter().filter(|b| b.image[0] != a.image[0]) {
            let across = a.normal().transpose().cross(&b.normal().transpose());
            let Some(along) = across.try_normalize(1e-9) else {
                continue;
            };
            let start = if a.is_ahead(&along) { along } else { -along };
            let direction = Direction::fit(vec![a, b], start).and_then(|d| d.grown(&images));
            found.extend(direction.filter(|d| d.images.len() > TWO_VIEWS && d.nats() > 0.0));
        }
    }
    found.sort_by(|a, b| b.nats().total_cmp(&a.nats()));
    let mut used: Vec<[u32; 2]> = Vec::new();
    let mut edges: Vec<SpaceEdge> = Vec::new();
    for direction in found {
        if direction.images.iter().any(|i| used.contains(&i.image)) {
            continue;
        }
        used.extend(direction.images.iter().map(|i| i.image));
        edges.push(space_edge(scene, at, &direction));
    }
    let angle = |e: &SpaceEdge| atan2(e.direction.y, e.direction.x);
    edges.sort_by(|a, b| angle(b).total_cmp(&angle(a)));
    edges
}

fn space_edge(scene: &Scene, at: &Point3<f64>, found: &Direction) -> SpaceEdge {
    let d = found.direction;
    let mut lengths: Vec<f64> = (found.images.iter())
        .map(|image| {
            // Where the edge's line is nearest to the ray through the far end of its image.
            let camera = scene.camera(ViewId(image.image[0]));
            let ray = camera.ray(&image.edge.far);
            let (w, c) = (at - camera.center, d.dot(&ray));
            (c * ray.dot(&w) - d.dot(&w)) / (1.0 - c * c).max(1e-9)
        })
        .collect();
    let mut images: Vec<[u32; 2]> = found.images.iter().map(|i| i.image).collect();
    images.sort_unstable();
    SpaceEdge {
        direction: d,
        covariance: found.covariance.into(),
        length_m: median(&mut lengths).unwrap_or(0.0).max(0.0),
        neighbour: None,
        images,
        nats: found.nats(),
    }
}
