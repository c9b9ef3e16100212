//! Corners matched over the views as wholes (B99 2: Bonn, "matching the 2D descriptions over
//! multiple images").
//!
//! A corner and one in the beam of another view start a corner in space; each further view adds
//! the corner that it most likely shows there. Everything that belongs to the corner is judged in
//! one unit, nats against chance:
//!
//! ```text
//! place   ln N(distance from the epipolar line) - ln (corners per px^2 x length of the beam)
//!         ln N(corner - its predicted place)    - ln (corners per px^2), each further view
//! edges   evidence for one direction in space   - ln (edges per radian), each view
//! colours ln (1/2 + 1/2 N_same(difference) / N_any(difference)), each region in each view
//! ```
//!
//! How far colours of one region differ between views, and of any two, is measured in the scene.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix2, Point2, Point3, Vector2, Vector3};

use super::graph::{ImageCorner, ImageGraph};
use super::sectors::sector_color;
use super::space_corner::{Sighting, SpaceCorner, edges, log_normal_2, place};
use crate::base::ids::ViewId;
use crate::base::math::{SIGMA_OVER_MEDIAN, exp, ln, median};
use crate::base::plan_index::PlanIndex;
use crate::orienting::scene::Scene;
use crate::photographs::camera::FEWEST_VIEWS;
use crate::planes::coplanar::log_normal;

/// The graphs of all views, ready to be searched.
pub(super) struct GraphSpace<'a> {
    scene: &'a Scene,
    graphs: &'a [ImageGraph],
    index: Vec<PlanIndex>,
    /// Corners per square pixel, per view.
    density: Vec<f64>,
    /// Least and largest height of a corner, metres.
    heights: [f64; 2],
    colors: Colors,
}

/// Colours of all sectors in units of their spread in the view: `[view][corner][edge]`.
struct Colors {
    sectors: Vec<Vec<Vec<Option<Vector3<f64>>>>>,
    /// Variances of the difference of one region in two views; `None` before it is measured.
    same: Option<Vector3<f64>>,
}

/// Variance of the difference of any two colours in units of their spread.
const ANY_TWO: f64 = 2.0;

impl<'a> GraphSpace<'a> {
    pub(super) fn new(scene: &'a Scene, graphs: &'a [ImageGraph], heights: [f64; 2]) -> Self {
        let index = |g: &ImageGraph| PlanIndex::new(g.corners.iter().map(|c| [c.at; 2]));
        let density = graphs.iter().zip(&scene.views).map(|(graph, view)| {
            let area = f64::from(view.camera.width) * f64::from(view.camera.height);
            graph.corners.len().max(1) as f64 / area
        });
        let colors = crate::base::execution::map(graphs, |v, graph| {
            let of_corner = |c: &ImageCorner| {
                let sectors = 0..c.edges.len();
                sectors
                    .map(|k| sector_color(&scene.views[v], c, k))
                    .collect()
            };
            normalised(graph.corners.iter().map(of_corner).collect())
        });
        Self {
            scene,
            graphs,
            index: graphs.iter().map(index).collect(),
            density: density.collect(),
            heights,
            colors: Colors {
                sectors: colors,
                same: None,
            },
        }
    }

    /// All corners in space, the likeliest first; each corner of an image belongs to one.
    pub(super) fn corners(&mut self) -> Vec<SpaceCorner> {
        let starts: Vec<[u32; 2]> = (self.graphs.iter().enumerate())
            .flat_map(|(v, g)| (0..g.corners.len()).map(move |c| [v as u32, c as u32]))
            .collect();
        let grown = crate::base::execution::map(&starts, |_, start| self.grown_from(*start));
        let sets: BTreeSet<Vec<[u32; 2]>> = grown.into_iter().flatten().collect();
        let sets: Vec<Vec<[u32; 2]>> = sets.into_iter().collect();
        let judged = crate::base::execution::map(&sets, |_, set| self.judge(set));
        let mut judged: Vec<SpaceCorner> = judged.into_iter().flatten().collect();
        self.colors.same = self.measured_differences(&judged);
        for corner in &mut judged {
            corner.color_nats = self.color_nats(corner);
        }
        let order = |a: &SpaceCorner, b: &SpaceCorner| {
            let likelier = b.nats().total_cmp(&a.nats());
            likelier.then_with(|| a.images.cmp(&b.images))
        };
        judged.sort_by(order);
        let mut used = BTreeSet::new();
        let mut found = Vec::new();
        for corner in judged {
            let free: Vec<[u32; 2]> = (corner.images.iter().copied())
                .filter(|image| !used.contains(image))
                .collect();
            let corner = match free.len() == corner.images.len() {
                true => Some(corner),
                false => self.judge(&free).map(|mut rest| {
                    rest.color_nats = self.color_nats(&rest);
                    rest
                }),
            };
            let Some(corner) = corner.filter(|c| c.nats() > 0.0) else {
                continue;
            };
            used.extend(corner.images.iter().copied());
            found.push(corner);
        }
        found.sort_by(order);
        self.join(&mut found);
        found
    }

    /// Joins corners by their edges: an edge leads to the corner that more than half of its images
    /// lead to.
    fn join(&self, corners: &mut [SpaceCorner]) {
        let numbered = corners.iter().enumerate();
        let of_image: BTreeMap<[u32; 2], u32> = numbered
            .flat_map(|(i, corner)| corner.images.iter().map(move |image| (*image, i as u32)))
            .collect();
        let places: Vec<Point3<f64>> = corners.iter().map(|c| c.at).collect();
        for corner in corners {
            let images = &corner.images;
            let in_view = |v: u32| images.iter().find(|i| i[0] == v).map(|i| i[1]);
            for edge in &mut corner.edges {
                let led = edge.images.iter().filter_map(|&[v, k]| {
                    let corners = &self.graphs[v as usize].corners;
                    let there = corners[in_view(v)? as usize].edges[k as usize].neighbour?;
                    of_image.get(&[v, there[0]]).copied()
                });
                let led: Vec<u32> = led.collect();
                let times = |i: u32| led.iter().filter(|other| **other == i).count();
                let most = (led.iter().copied()).find(|i| 2 * times(*i) > edge.images.len());
                if let Some(i) = most {
                    edge.neighbour = Some(i);
                    edge.length_m = (places[i as usize] - corner.at).norm();
                }
            }
        }
    }

    /// The sets of images that a corner starts with those in its beams.
    fn grown_from(&self, start: [u32; 2]) -> Vec<Vec<[u32; 2]>> {
        let later = start[0] as usize + 1..self.graphs.len();
        let seeds = later.flat_map(|w| self.in_beam(start, w));
        seeds
            .filter_map(|second| self.grown(&[start, second]))
            .collect()
    }

    /// The beam of a corner in another view: its ends, and the variance across.
    fn beam(&self, [v, c]: [u32; 2], w: usize) -> Option<([Point2<f64>; 2], Matrix2<f64>)> {
        let [from, to] = [v as usize, w].map(|v| self.scene.camera(ViewId::from_index(v)));
        let corner = &self.graphs[v as usize].corners[c as usize];
        let at = |p: &Point2<f64>, z: f64| to.project(&from.at_height(p, z)?);
        let ends = [
            at(&corner.at, self.heights[0])?,
            at(&corner.at, self.heights[1])?,
        ];
        let z = 0.5 * (self.heights[0] + self.heights[1]);
        let here = at(&corner.at, z)?;
        let [dx, dy] = [Vector2::x(), Vector2::y()].map(|step| at(&(corner.at + step), z));
        let map = Matrix2::from_columns(&[dx? - here, dy? - here]);
        Some((ends, map * corner.covariance() * map.transpose()))
    }

    /// The corners of a view that are likelier than chance to be the image of a corner.
    fn in_beam(&self, start: [u32; 2], w: usize) -> Vec<[u32; 2]> {
        let Some((ends, covariance)) = self.beam(start, w) else {
            return Vec::new();
        };
        let length = (ends[1] - ends[0]).norm().max(1.0);
        let along = (ends[1] - ends[0]) / length;
        let margin = 4.0 * (covariance.trace().sqrt() + 1.0);
        let mut near: Vec<u32> = self.index[w].touching(ends, margin).collect();
        near.sort_unstable();
        let is_likely = |c: &u32| {
            let corner = &self.graphs[w].corners[*c as usize];
            let off = corner.at - ends[0];
            let t = off.dot(&along);
            (-margin..=length + margin).contains(&t)
                && self.beam_nats(corner, &off, &along, &covariance, w, length) > 0.0
        };
        near.retain(is_likely);
        near.into_iter().map(|c| [w as u32, c]).collect()
    }

    fn beam_nats(
        &self,
        corner: &ImageCorner,
        off: &Vector2<f64>,
        along: &Vector2<f64>,
        covariance: &Matrix2<f64>,
        w: usize,
        length: f64,
    ) -> f64 {
        let n = Vector2::new(-along.y, along.x);
        let variance = n.dot(&((covariance + corner.covariance()) * n));
        log_normal(off.dot(&n), variance) - ln(self.density[w] * length)
    }

    /// The images of a corner with those that the other views add; `None` with less than three.
    fn grown(&self, start: &[[u32; 2]]) -> Option<Vec<[u32; 2]>> {
        let mut images = start.to_vec();
        let (mut at, mut covariance) = place(self.scene, &self.sightings(&images))?;
        for w in 0..self.graphs.len() {
            if images.iter().any(|i| i[0] as usize == w) {
                continue;
            }
            let camera = self.scene.camera(ViewId::from_index(w));
            let (Some(image), Some(j)) = (camera.project(&at), camera.project_jacobian(&at)) else {
                continue;
            };
            let predicted = j * covariance * j.transpose();
            let margin = 4.0 * (predicted.trace().sqrt() + 1.0);
            let mut near: Vec<u32> = self.index[w].touching([image; 2], margin).collect();
            near.sort_unstable();
            let weighed = near.into_iter().filter_map(|c| {
                let corner = &self.graphs[w].corners[c as usize];
                let density =
                    log_normal_2(&(corner.at - image), &(predicted + corner.covariance()))?;
                Some((density - ln(self.density[w]), c))
            });
            let best = weighed.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
            if let Some((_, c)) = best.filter(|(nats, _)| *nats > 0.0) {
                images.push([w as u32, c]);
                (at, covariance) = place(self.scene, &self.sightings(&images))?;
            }
        }
        images.sort_unstable();
        (images.len() >= FEWEST_VIEWS).then_some(images)
    }

    fn sightings(&self, images: &[[u32; 2]]) -> Vec<Sighting<'a>> {
        let of = |image: &[u32; 2]| Sighting::of(self.graphs, *image);
        images.iter().map(of).collect()
    }

    /// A corner in space from its images, without colours.
    fn judge(&self, images: &[[u32; 2]]) -> Option<SpaceCorner> {
        (images.len() >= FEWEST_VIEWS).then_some(())?;
        let seen = self.sightings(images);
        let (at, covariance) = place(self.scene, &seen)?;
        let mut known = seen[..1].to_vec();
        let mut nats = 0.0;
        for s in &seen[1..] {
            let w = s.view.index();
            nats += if known.len() == 1 {
                let (ends, covariance) = self.beam(images[0], w)?;
                let length = (ends[1] - ends[0]).norm().max(1.0);
                let along = (ends[1] - ends[0]) / length;
                let off = s.corner.at - ends[0];
                self.beam_nats(s.corner, &off, &along, &covariance, w, length)
            } else {
                let (at, covariance) = place(self.scene, &known)?;
                let camera = self.scene.camera(s.view);
                let j = camera.project_jacobian(&at)?;
                let spread = j * covariance * j.transpose() + s.corner.covariance();
                log_normal_2(&(s.corner.at - camera.project(&at)?), &spread)? - ln(self.density[w])
            };
            known.push(*s);
        }
        Some(SpaceCorner {
            at,
            covariance: covariance.into(),
            images: images.to_vec(),
            edges: edges(self.scene, &at, &seen),
            place_nats: nats,
            color_nats: 0.0,
        })
    }

    /// Colours of the regions between two neighbouring edges of a corner, in the views that show
    /// both next to each other.
    fn region_colors(&self, corner: &SpaceCorner) -> Vec<Vec<Vector3<f64>>> {
        let n = corner.edges.len();
        let of_region = |k: usize| {
            let seen = corner.images.iter().filter_map(|&[v, c]| {
                let index = |k: usize| {
                    let mut images = corner.edges[k % n].images.iter();
                    Some(images.find(|i| i[0] == v)?[1] as usize)
                };
                let (from, to) = (index(k)?, index(k + 1)?);
                let sectors = &self.colors.sectors[v as usize][c as usize];
                ((from + 1) % sectors.len() == to).then(|| sectors[from])?
            });
            seen.collect()
        };
        let regions = if n < 2 { 0 } else { n };
        (0..regions).map(of_region).collect()
    }

    /// Variances of the difference of colours of one region in two views, from corners that place
    /// and edges speak for; robust, for some regions are hidden in one of the views.
    fn measured_differences(&self, corners: &[SpaceCorner]) -> Option<Vector3<f64>> {
        let mut off: [Vec<f64>; 3] = Default::default();
        for corner in corners.iter().filter(|c| c.nats() > 0.0) {
            for colors in self.region_colors(corner) {
                for pair in colors.windows(2) {
                    let d = pair[1] - pair[0];
                    (0..3).for_each(|i| off[i].push(d[i].abs()));
                }
            }
        }
        let sigma = off.map(|mut of| Some(SIGMA_OVER_MEDIAN * median(&mut of)?));
        let [Some(a), Some(b), Some(c)] = sigma else {
            return None;
        };
        let least = 1e-3;
        Some(Vector3::new(a, b, c).map(|s| (s * s).clamp(least, ANY_TWO)))
    }

    /// What the colours of a corner's regions say, nats.
    fn color_nats(&self, corner: &SpaceCorner) -> f64 {
        let Some(same) = &self.colors.same else {
            return 0.0;
        };
        let nats = |d: Vector3<f64>| {
            let of = |i: usize| log_normal(d[i], same[i]) - log_normal(d[i], ANY_TWO);
            ln(0.5 + 0.5 * exp((0..3).map(of).sum::<f64>()))
        };
        let regions = self.region_colors(corner).into_iter();
        regions
            .map(|colors| colors.windows(2).map(|p| nats(p[1] - p[0])).sum::<f64>())
            .sum()
    }
}

/// Colours without the mean of a view and in units of their spread: exposure and haze are those of
/// the view.
fn normalised(mut colors: Vec<Vec<Option<Vector3<f64>>>>) -> Vec<Vec<Option<Vector3<f64>>>> {
    let all: Vec<Vector3<f64>> = colors.iter().flatten().flatten().copied().collect();
    let n = all.len().max(1) as f64;
    let mean = all.iter().sum::<Vector3<f64>>() / n;
    let squares = all.iter().map(|c| (c - mean).component_mul(&(c - mean)));
    let spread = (squares.sum::<Vector3<f64>>() / n).map(|v| v.sqrt().max(1e-6));
    for color in colors.iter_mut().flatten().flatten() {
        *color = (*color - mean).component_div(&spread);
    }
    colors
}
