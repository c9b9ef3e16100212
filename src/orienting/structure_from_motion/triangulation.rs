//! A point from its rays.

use nalgebra::{Matrix3, Point3, Vector3};

use super::block::{Block, Observation, Pose};
use crate::base::math::{self, SURE_RESIDUAL_SIGMAS};

/// Least angle between two rays of a point, radians.
pub(super) const LEAST_ANGLE: f64 = 1.5 * std::f64::consts::PI / 180.0;

/// Most pairs of rays that are tried for a point.
const MOST_PAIRS: usize = 30;

/// A ray of a registered photograph.
struct Ray<'a> {
    index: usize,
    observation: &'a Observation,
    pose: &'a Pose,
    direction: Vector3<f64>,
}

/// The point with the most rays of a track, and their indices; `None` where two rays that agree do
/// not meet at [`LEAST_ANGLE`]. Every pair of rays proposes the point where it meets.
pub(super) fn triangulate(
    block: &Block,
    observations: &[Observation],
) -> Option<(Point3<f64>, Vec<usize>)> {
    let rays: Vec<Ray> = (observations.iter().enumerate())
        .filter_map(|(index, observation)| {
            let pose = block.photos[observation.photo].pose.as_ref()?;
            Some(Ray {
                index,
                observation,
                pose,
                direction: pose.direction(&block.ray(observation)),
            })
        })
        .collect();
    let mut best: Option<(Point3<f64>, Vec<usize>, f64)> = None;
    let mut pairs = 0;
    // Distant pairs first, which have the larger angles.
    for apart in (1..rays.len()).rev() {
        for i in 0..rays.len() - apart {
            let pair = [&rays[i], &rays[i + apart]];
            if angle(&pair[0].direction, &pair[1].direction) < LEAST_ANGLE {
                continue;
            }
            pairs += 1;
            if pairs > MOST_PAIRS {
                return finished(best);
            }
            let Some(point) = nearest_point(pair.map(|r| (r.pose.center, r.direction))) else {
                continue;
            };
            let (agreeing, sum) = agreeing(block, &rays, &point);
            let is_better = best.as_ref().is_none_or(|(_, most, least)| {
                agreeing.len() > most.len() || (agreeing.len() == most.len() && sum < *least)
            });
            if agreeing.len() >= 2 && is_better {
                // All agreeing rays say more than the pair does, unless they bring another one in.
                let all = agreeing
                    .iter()
                    .map(|&k| (rays[k].pose.center, rays[k].direction));
                let mean = nearest_point(all).unwrap_or(point);
                let indices: Vec<usize> = agreeing.iter().map(|&k| rays[k].index).collect();
                let stays = |p: &Point3<f64>| {
                    let mut each = agreeing.iter();
                    each.all(|&k| block.residual(rays[k].observation, p) <= SURE_RESIDUAL_SIGMAS)
                };
                let point = if stays(&mean) { mean } else { point };
                let is_complete = agreeing.len() == rays.len();
                best = Some((point, indices, sum));
                if is_complete {
                    return finished(best);
                }
            }
        }
    }
    finished(best)
}

/// The rays that agree with a point, and the sum of their squared residuals.
fn agreeing(block: &Block, rays: &[Ray], point: &Point3<f64>) -> (Vec<usize>, f64) {
    let (mut agreeing, mut sum) = (Vec::new(), 0.0);
    for (k, ray) in rays.iter().enumerate() {
        let residual = block.residual(ray.observation, point);
        if residual <= SURE_RESIDUAL_SIGMAS {
            agreeing.push(k);
            sum += residual * residual;
        }
    }
    (agreeing, sum)
}

fn finished(best: Option<(Point3<f64>, Vec<usize>, f64)>) -> Option<(Point3<f64>, Vec<usize>)> {
    best.map(|(point, indices, _)| (point, indices))
}

/// The largest angle between the rays of a point, radians.
pub(super) fn largest_angle(block: &Block, used: &[Observation], point: &Point3<f64>) -> f64 {
    let directions: Vec<Vector3<f64>> = (used.iter())
        .filter_map(|o| block.photos[o.photo].pose.as_ref())
        .map(|pose| (point - pose.center).normalize())
        .collect();
    let mut largest = 0.0f64;
    for (i, a) in directions.iter().enumerate() {
        for b in &directions[i + 1..] {
            largest = largest.max(angle(a, b));
        }
    }
    largest
}

pub(super) fn angle(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    math::atan2(a.cross(b).norm(), a.dot(b))
}

/// The point with the least sum of squared distances from rays.
pub(super) fn nearest_point(
    rays: impl IntoIterator<Item = (Point3<f64>, Vector3<f64>)>,
) -> Option<Point3<f64>> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (center, direction) in rays {
        let across = Matrix3::identity() - direction * direction.transpose();
        normal += across;
        right += across * center.coords;
    }
    normal.cholesky().map(|c| Point3::from(c.solve(&right)))
}
