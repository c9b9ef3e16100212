//! The regions of an image graph: what lies between two edges of a corner, and goes on along an
//! edge to the corner at its other end.

use nalgebra::{Point2, Vector2, Vector3};

use super::graph::{GraphRegion, ImageCorner, ImageGraph};
use crate::base::math::{atan2, sin_cos};
use crate::orienting::scene::View;

/// Directions and distances at which a sector is sampled.
const DIRECTIONS: usize = 5;
const DISTANCES: usize = 5;

/// The graph of corners whose edges are in cyclic order.
pub(super) fn with_regions(view: &View, mut corners: Vec<ImageCorner>) -> ImageGraph {
    let first: Vec<usize> = (corners.iter())
        .scan(0, |sum, c| {
            let at = *sum;
            *sum += c.edges.len();
            Some(at)
        })
        .collect();
    let sectors: Vec<[u32; 2]> = (corners.iter().enumerate())
        .flat_map(|(c, corner)| (0..corner.edges.len()).map(move |k| [c as u32, k as u32]))
        .collect();
    let mut class: Vec<usize> = (0..sectors.len()).collect();
    for (i, &[c, k]) in sectors.iter().enumerate() {
        let Some([n, m]) = corners[c as usize].edges[k as usize].neighbour else {
            continue;
        };
        // What is to the right of an edge is to the left of the same edge seen from its far end:
        // it follows the edge before it there.
        let there = corners[n as usize].edges.len();
        let other = first[n as usize] + (m as usize + there - 1) % there;
        let [a, b] = [i, other].map(|s| root(&class, s));
        class[a.max(b)] = a.min(b);
    }
    let mut numbers = vec![u32::MAX; sectors.len()];
    let mut regions: Vec<GraphRegion> = Vec::new();
    for (i, &[c, k]) in sectors.iter().enumerate() {
        let class = root(&class, i);
        if numbers[class] == u32::MAX {
            numbers[class] = regions.len() as u32;
            regions.push(GraphRegion::default());
        }
        corners[c as usize].edges[k as usize].region = numbers[class];
        regions[numbers[class] as usize].sectors.push([c, k]);
    }
    for corner in &corners {
        let n = corner.edges.len();
        for k in 0..n {
            let [a, b] = [corner.edges[(k + n - 1) % n].region, corner.edges[k].region];
            if a != b {
                regions[a as usize].neighbours.push(b);
                regions[b as usize].neighbours.push(a);
            }
        }
    }
    for region in &mut regions {
        region.neighbours.sort_unstable();
        region.neighbours.dedup();
        let of_sector = |&[c, k]: &[u32; 2]| sector_color(view, &corners[c as usize], k as usize);
        let colors: Vec<Vector3<f64>> = region.sectors.iter().filter_map(of_sector).collect();
        region.color = (!colors.is_empty())
            .then(|| (colors.iter().sum::<Vector3<f64>>() / colors.len() as f64).into());
    }
    ImageGraph { corners, regions }
}

fn root(class: &[usize], mut i: usize) -> usize {
    while class[i] != i {
        i = class[i];
    }
    i
}

/// Mean colour between an edge of a corner and the next, as far out as the shorter of both is long.
pub(super) fn sector_color(view: &View, corner: &ImageCorner, k: usize) -> Option<Vector3<f64>> {
    let [edge, next] = [k, k + 1].map(|k| &corner.edges[k % corner.edges.len()]);
    let [from, to] = [edge, next].map(|e| atan2(e.direction.y, e.direction.x));
    let opening = (to - from).rem_euclid(std::f64::consts::TAU);
    let reach = [edge, next].map(|e| (e.far - corner.at).norm());
    let reach = reach[0].min(reach[1]);
    let mut colors = Vec::new();
    for i in 0..DIRECTIONS {
        let (s, c) = sin_cos(from + opening * (i as f64 + 0.5) / DIRECTIONS as f64);
        for j in 0..DISTANCES {
            // Next to the corner a pixel shows what is beyond the edges as well.
            let distance = reach * (0.5 + 0.5 * j as f64 / DISTANCES as f64);
            colors.extend(color_at(view, &(corner.at + Vector2::new(c, s) * distance)));
        }
    }
    (!colors.is_empty()).then(|| colors.iter().sum::<Vector3<f64>>() / colors.len() as f64)
}

/// Lightness and two differences of the pixel at a place.
fn color_at(view: &View, p: &Point2<f64>) -> Option<Vector3<f64>> {
    (p.x >= 0.0 && p.y >= 0.0).then_some(())?;
    let pixel = view.rgb.get_pixel_checked(p.x as u32, p.y as u32)?;
    let [r, g, b] = pixel.0.map(|v| f64::from(v) / 255.0);
    Some(Vector3::new((r + g + b) / 3.0, r - b, g - 0.5 * (r + b)))
}
