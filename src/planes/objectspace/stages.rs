//! The four stages of the method, each from typed input to `(value, trace)`.

use nalgebra::{Matrix3, Point3};
use serde::{Deserialize, Serialize};

use super::clusters::{ClusterAxes, ClusterLine, ClusterTrace, cluster_lines};
use super::image_lines::{ImageLine, image_lines};
use super::oris::{ColorImage, RegionLine, Segmentation, region_lines, segment_regions};
use super::rectangles::OccludingSolid;
use super::rectangles::best_set;
use super::rectangles::{PlaneCandidate, PlaneRejection, PlaneSearch, PlaneTrace};
use super::windows::{Window, WindowTrace, find_windows};
use crate::base::evidence::{JudgedFacet, WindowCounts};
use crate::base::execution::{Sharded, reached, sharded_map};
use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::ProposalOrigin;
use crate::base::params::{ObjectSpaceParams, Params};
use crate::lines::linematch::scene_heights;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::{Line3d, LineSupport, SupportKind};
use crate::orienting::scene::Scene;
use crate::planes::grouping::ProposedPlane;
use crate::planes::terrain::Ground;

/// Regions of every view and the lines on their boundaries (W96 3.3).
pub fn find_regions(
    scene: &Scene,
    params: &ObjectSpaceParams,
) -> Sharded<(Vec<Vec<RegionLine>>, Vec<Segmentation>)> {
    let per_view = sharded_map("views", &scene.views, 0.0..1.0, |_, view| {
        let image = ColorImage::new(&view.gray, &view.rgb);
        let segmentation = segment_regions(&image, &params.oris);
        (
            region_lines(&image, &segmentation, &params.oris),
            segmentation,
        )
    })?;
    Ok(per_view.into_iter().unzip())
}

/// Windows around buildings with their main directions (W96 3.4).
pub fn find_directions(
    scene: &Scene,
    lines: &[Vec<RegionLine>],
    params: &ObjectSpaceParams,
) -> Sharded<(Vec<Window>, WindowTrace)> {
    let z_range = params
        .windows
        .z_range_m
        .map(|z| z.map(|z| z - scene.origin.z));
    let z_range = match z_range {
        Some(z_range) => z_range,
        None => scene_heights(scene, &image_segments(lines))?,
    };
    let o = scene.origin;
    let given = params
        .windows
        .given_m
        .iter()
        .map(|&[x0, y0, x1, y1]| [x0 - o.x, y0 - o.y, x1 - o.x, y1 - o.y]);
    let given: Vec<[f64; 4]> = given.collect();
    find_windows(scene, &image_lines(scene, lines), z_range, &given, params)
}

/// The image lines in the form that the files and the other method have.
pub fn image_segments(lines: &[Vec<RegionLine>]) -> Vec<Vec<ImageSegment>> {
    lines
        .iter()
        .map(|view| view.iter().map(|l| l.line.clone()).collect())
        .collect()
}

/// A 3D line with the main direction that it was found in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundLine {
    /// Index of the window.
    pub window: usize,
    /// Index of the pair of main directions in the window, and which of the two.
    pub direction: [usize; 2],
    /// The line.
    pub line: ClusterLine,
}

/// 3D lines of all windows and directions (W96 3.5).
pub fn find_clusters(
    scene: &Scene,
    lines: &[Vec<RegionLine>],
    windows: &[Window],
    params: &ObjectSpaceParams,
) -> Sharded<(Vec<FoundLine>, Vec<ClusterTrace>)> {
    let image_lines = image_lines(scene, lines);
    let tasks: Vec<(usize, [usize; 2])> = windows
        .iter()
        .enumerate()
        .flat_map(|(w, window)| {
            (0..window.directions.len()).flat_map(move |d| [(w, [d, 0]), (w, [d, 1])])
        })
        .collect();
    let results = sharded_map("clusters", &tasks, 0.0..1.0, |_, &(w, [pair, axis])| {
        let window = &windows[w];
        let shown: Vec<usize> = (0..image_lines.len())
            .filter(|&k| window.shows(&image_lines[k]))
            .collect();
        let inside: Vec<ImageLine> = shown.iter().map(|&k| image_lines[k].clone()).collect();
        let direction = window.directions[pair].axes()[axis];
        let (mut lines, trace) = cluster_lines(
            scene,
            &inside,
            &direction,
            window.z_range_m,
            &params.clusters,
        );
        for line in &mut lines {
            line.supports.iter_mut().for_each(|k| *k = shown[*k]);
        }
        (lines, trace)
    })?;
    let (mut found, mut traces) = (Vec::new(), Vec::new());
    for ((window, direction), (lines, trace)) in tasks.into_iter().zip(results) {
        found.extend(lines.into_iter().map(|line| FoundLine {
            window,
            direction,
            line,
        }));
        traces.push(trace);
    }
    Ok((found, traces))
}

/// What the search for planes did.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct RectangleTrace {
    /// Every pair of parallel lines.
    pub pairs: Vec<PlaneTrace>,
    /// All candidates.
    pub candidates: Vec<PlaneCandidate>,
    /// The chosen ones.
    pub chosen: Vec<usize>,
}

impl RectangleTrace {
    /// Every candidate with what speaks for it and against it.
    pub(crate) fn judged(&self) -> Vec<JudgedFacet> {
        let judged = self
            .candidates
            .iter()
            .enumerate()
            .map(|(k, c)| JudgedFacet {
                outline: c.ring.clone(),
                holes: Vec::new(),
                plane: c.plane,
                accepted: self.chosen.binary_search(&k).is_ok(),
                evidence: c.features.evidence(),
                windows: WindowCounts::default(),
            });
        judged.collect()
    }
}

/// The ground, swept between the heights of the windows: the 3D lines may all be those of a roof.
pub fn ground_of_clusters(
    scene: &Scene,
    windows: &[Window],
    found: &[FoundLine],
) -> Sharded<Ground> {
    let segments: Vec<Segment3> = found.iter().map(|f| f.line.segment).collect();
    let z_range = windows.first().map(|w| w.z_range_m);
    Ground::of_segments(scene, &segments, z_range)
}

/// Planes between parallel lines, and the best set of them (W96 3.6).
pub fn find_rectangles(
    scene: &Scene,
    lines: &[Vec<RegionLine>],
    windows: &[Window],
    found: &[FoundLine],
    ground: &Ground,
    params: &Params,
) -> Sharded<RectangleTrace> {
    let image_lines = image_lines(scene, lines);
    let all: Vec<ClusterLine> = found.iter().map(|f| f.line.clone()).collect();
    let mut search = PlaneSearch {
        scene,
        image_lines: &image_lines,
        lines: &all,
        ground,
        solids: &[],
        params: &params.objectspace.planes,
        border_nats_per_m: params.roof.border_nats_per_m,
    };
    let mut trace = RectangleTrace::default();
    let axes =
        |&[w, d, axis]: &[usize; 3]| ClusterAxes::new(&windows[w].directions[d].axes()[axis]);
    let searches: Vec<[usize; 3]> = (0..windows.len())
        .flat_map(|w| (0..windows[w].directions.len()).map(move |d| [w, d]))
        .flat_map(|[w, d]| [[w, d, 0], [w, d, 1]])
        .collect();
    // No search depends on another: they are all made before the first is looked at.
    let searched = searches.iter().enumerate().map(|(done, of)| {
        let planes = search_planes(&search, &axes(of), found, *of);
        reached(0.1 + 0.7 * (done + 1) as f64 / searches.len() as f64);
        planes
    });
    for planes in searched.collect::<Vec<_>>() {
        let (candidates, pairs) = planes?;
        trace.candidates.extend(candidates);
        trace.pairs.extend(pairs);
    }
    trace.chosen = best_set(&trace.candidates);
    let chosen = trace.chosen.iter().map(|&k| &trace.candidates[k]);
    let solids: Vec<OccludingSolid> = chosen
        .map(|c| OccludingSolid::new(&c.plane, &c.ring))
        .collect();
    search.solids = &solids;
    if search_occluded(
        &search,
        |lines| axes(&of_line(&found[lines[0]])),
        &mut trace,
    )? {
        trace.chosen = best_set(&trace.candidates);
    }
    Ok(trace)
}

/// Window, pair of directions and direction of a line.
fn of_line(line: &FoundLine) -> [usize; 3] {
    [line.window, line.direction[0], line.direction[1]]
}

/// Quadrilaterals and triangles of one direction.
fn search_planes(
    search: &PlaneSearch,
    axes: &ClusterAxes,
    found: &[FoundLine],
    of: [usize; 3],
) -> Sharded<(Vec<PlaneCandidate>, Vec<PlaneTrace>)> {
    let [w, d, axis] = of;
    let lines_of = |of: [usize; 3]| (0..found.len()).filter(move |&k| of_line(&found[k]) == of);
    let members: Vec<usize> = lines_of(of).collect();
    let quadrilaterals = search.candidates(axes, &members);
    let across = lines_of([w, d, 1 - axis]).map(|k| &found[k].line.segment);
    let apexes: Vec<Point3<f64>> = across.flat_map(|s| [s.p0, s.p1]).collect();
    let triangles = search.triangles(axes, &members, &apexes);
    let (mut candidates, pairs) = quadrilaterals?;
    candidates.extend(triangles?);
    Ok((candidates, pairs))
}

/// Searches again the pairs that were too weak, where the solids hide them from some views; is
/// there any new candidate?
fn search_occluded(
    search: &PlaneSearch,
    axes: impl Fn([usize; 2]) -> ClusterAxes + Sync,
    trace: &mut RectangleTrace,
) -> Sharded<bool> {
    let weak: Vec<usize> = (0..trace.pairs.len())
        .filter(|&k| trace.pairs[k].rejection == Some(PlaneRejection::Weak))
        .collect();
    if search.solids.is_empty() {
        return Ok(false);
    }
    let again = sharded_map("behind", &weak, 0.8..1.0, |_, &k| {
        let lines = trace.pairs[k].lines;
        search.candidates_between(&axes(lines), lines)
    })?;
    let before = trace.candidates.len();
    for (k, candidates) in weak.into_iter().zip(again) {
        if !candidates.is_empty() {
            trace.pairs[k].rejection = None;
        }
        trace.candidates.extend(candidates);
    }
    Ok(trace.candidates.len() > before)
}

/// All candidates for the other method; those that this one chose come first. Which of
/// them cover what is then decided together with all other planes, so that what excluded each other
/// here may compete again.
pub fn proposed_planes(trace: &RectangleTrace) -> Vec<ProposedPlane> {
    let mut order: Vec<usize> = (0..trace.candidates.len()).collect();
    let chosen = |k: &usize| trace.chosen.binary_search(k).is_ok();
    order.sort_by(|a, b| {
        let measure = |k: &usize| trace.candidates[*k].measure_nats;
        let chosen_first = chosen(b).cmp(&chosen(a));
        chosen_first.then(measure(b).total_cmp(&measure(a)))
    });
    let proposed = order.into_iter().map(|k| {
        let c = &trace.candidates[k];
        ProposedPlane {
            origin: ProposalOrigin::Rectangle(k as u32),
            plane: c.plane,
            ring: c.ring.clone(),
            sides_on_edges: true,
        }
    });
    proposed.collect()
}

/// The 3D lines in the form that the files and the other method have.
pub fn world_lines(scene: &Scene, lines: &[Vec<RegionLine>], found: &[FoundLine]) -> Vec<Line3d> {
    let image_lines = image_lines(scene, lines);
    found
        .iter()
        .map(|f| world_line(&image_lines, &f.line))
        .collect()
}

fn world_line(image_lines: &[ImageLine], line: &ClusterLine) -> Line3d {
    let variance = line.sigma_m * line.sigma_m;
    let supports = line.coverage.iter().map(|&(view, score)| {
        let own = || {
            line.supports
                .iter()
                .map(|&k| &image_lines[k])
                .filter(move |s| s.view == view)
        };
        let camera = own().next().map(|s| s.camera);
        let ends = [line.segment.p0, line.segment.p1]
            .map(|p| camera.and_then(|c| c.project(&p)).unwrap_or_default());
        LineSupport {
            view,
            segments: own().map(|s| s.line).collect(),
            stretch: Segment2::new(ends[0], ends[1]),
            score,
            kind: SupportKind::Matched,
            edge: None,
        }
    });
    Line3d {
        origin: Default::default(),
        segment: line.segment,
        sigma_m: line.sigma_m,
        covariance: [Matrix3::identity() * variance; 2],
        probability: 1.0,
        supports: supports.collect(),
        contradiction: None,
    }
}
