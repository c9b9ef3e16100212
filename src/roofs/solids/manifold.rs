//! From faces to a closed oriented 2-manifold: twins, separated corners, merged walls.
//!
//! Four walls can meet in one vertical edge: roofs of heights high, low, high, low around a corner,
//! or an outline that touches itself there. Such an edge is shared by two pairs of walls. Each pair
//! that faces the same stretch of outside is joined, and the corners are doubled so that the two
//! pairs only touch. Where a roof with a hole goes around both high parts the corners stay one that
//! way; there the pairs around the same stretch of inside are joined instead.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Point2, Point3};

use super::rings::turn;
use super::walls::{FaceKind, Shell, ShellFace};
use crate::base::geometry::sides;
use crate::base::math;
use crate::roofs::model::WELD_M;

/// Corners within this distance of the straight line between their neighbours are left out where no
/// other face needs them, metres: a tenth of the step in which coordinates are written.
const STRAIGHT_DEVIATION_M: f64 = 1e-5;

/// Sine of the largest angle between a wall and the vertical plane of those that it is merged with:
/// ten degrees, half of what other programs allow between a face and its triangles.
const LARGEST_TURN: f64 = 0.173;

/// Makes the shell a closed oriented 2-manifold. `None` when its faces do not close.
pub(super) fn close_shell(shell: &Shell) -> Option<Shell> {
    let mut closed = merge_walls(separate(shell)?)?;
    while drop_straight_corners(&mut closed) {}
    drop_unused_corners(&mut closed);
    HalfEdges::new(&closed, &BTreeSet::new())?
        .shared
        .is_empty()
        .then_some(closed)
}

/// Doubles corners until no edge is shared by more than two faces.
fn separate(shell: &Shell) -> Option<Shell> {
    let mut inwards = BTreeSet::new();
    loop {
        let (closed, original) = HalfEdges::new(shell, &inwards)?.separate_corners(shell);
        let shared = HalfEdges::new(&closed, &BTreeSet::new())?.shared;
        if shared.is_empty() {
            return Some(closed);
        }
        let before = inwards.len();
        inwards.extend(
            shared
                .iter()
                .map(|&(a, b)| (original[a as usize], original[b as usize])),
        );
        // Neither way of joining helps.
        if inwards.len() == before {
            return None;
        }
    }
}

/// The directed edges of all rings, each with its twin: the same edge, run the other way by the
/// neighbour.
struct HalfEdges {
    /// Start corner, next half-edge, face.
    start: Vec<u32>,
    next: Vec<usize>,
    face: Vec<usize>,
    twin: Vec<usize>,
    /// Edges, upwards, that more than two faces share.
    shared: Vec<(u32, u32)>,
}

impl HalfEdges {
    /// `None` when some edge is not run through equally often both ways. The walls that share the
    /// edges `inwards` are joined around the inside.
    fn new(shell: &Shell, inwards: &BTreeSet<(u32, u32)>) -> Option<Self> {
        let (mut start, mut next, mut face) = (Vec::new(), Vec::new(), Vec::new());
        for (f, ring) in shell
            .faces
            .iter()
            .enumerate()
            .flat_map(|(f, face)| face.rings.iter().map(move |ring| (f, ring)))
        {
            let first = start.len();
            for (i, &corner) in ring.iter().enumerate() {
                start.push(corner);
                face.push(f);
                next.push(if i + 1 == ring.len() {
                    first
                } else {
                    first + i + 1
                });
            }
        }
        let mut of_edge: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        for h in 0..start.len() {
            of_edge
                .entry((start[h], start[next[h]]))
                .or_default()
                .push(h);
        }
        let mut edges = Self {
            twin: vec![usize::MAX; start.len()],
            start,
            next,
            face,
            shared: Vec::new(),
        };
        for (&(a, b), there) in &of_edge {
            let back = of_edge.get(&(b, a))?;
            if there.len() != back.len() {
                return None;
            }
            if shell.corners[a as usize].z <= shell.corners[b as usize].z {
                if there.len() > 1 {
                    edges.shared.push((a, b));
                }
                edges.pair(there, back, inwards.contains(&(a, b)), shell);
            }
        }
        edges.twin.iter().all(|&t| t != usize::MAX).then_some(edges)
    }

    /// Joins the half-edges of one edge: those of walls that go up with those that go down. Outside
    /// is counter-clockwise of a wall that goes up here, so its twin is the next wall in that
    /// turn; inside is clockwise.
    fn pair(&mut self, up: &[usize], down: &[usize], inwards: bool, shell: &Shell) {
        let mut free = down.to_vec();
        for &h in up {
            let from = self.azimuth(h, shell);
            let nearest = (0..free.len())
                .min_by(|&i, &j| {
                    let angle = |k: usize| {
                        let to = self.azimuth(free[k], shell);
                        if inwards {
                            turn(to, from)
                        } else {
                            turn(from, to)
                        }
                    };
                    angle(i).total_cmp(&angle(j))
                })
                .expect("as many down as up");
            let twin = free.remove(nearest);
            self.twin[h] = twin;
            self.twin[twin] = h;
        }
    }

    /// Azimuth in which the wall of a vertical half-edge leaves its plan vertex.
    fn azimuth(&self, h: usize, shell: &Shell) -> f64 {
        let here = self.start[h];
        let mut far = h;
        // The wall's ring leaves the vertical at its other plan vertex.
        while shell.plan[self.start[far] as usize] == shell.plan[here as usize] {
            far = self.next[far];
            if far == h {
                break;
            }
        }
        let d = shell.corners[self.start[far] as usize] - shell.corners[here as usize];
        math::atan2(d.y, d.x)
    }

    /// Gives every fan of faces around a corner a corner of its own; returns the original corner of
    /// each too.
    fn separate_corners(&self, shell: &Shell) -> (Shell, Vec<u32>) {
        let mut corner_of = vec![u32::MAX; self.start.len()];
        let (mut out, mut original) = (Shell::default(), Vec::new());
        for h in 0..self.start.len() {
            if corner_of[h] != u32::MAX {
                continue;
            }
            let corner = out.corners.len() as u32;
            out.corners.push(shell.corners[self.start[h] as usize]);
            out.plan.push(shell.plan[self.start[h] as usize]);
            original.push(self.start[h]);
            // Turn about the corner: the half-edge after the twin starts at the same corner.
            let mut at = h;
            while corner_of[at] == u32::MAX {
                corner_of[at] = corner;
                at = self.next[self.twin[at]];
            }
        }
        let mut h = 0;
        for face in &shell.faces {
            let mut rings = Vec::new();
            for ring in &face.rings {
                rings.push(corner_of[h..h + ring.len()].to_vec());
                h += ring.len();
            }
            out.faces.push(ShellFace {
                kind: face.kind,
                rings,
            });
        }
        (out, original)
    }

    /// The rings around a group of faces, or `None` when there is more than one.
    fn ring_around(&self, group: &[usize], group_of: &[usize]) -> Option<Vec<u32>> {
        let id = group_of[group[0]];
        let inner = |h: usize| group_of[self.face[self.twin[h]]] == id;
        let border: Vec<usize> = (0..self.start.len())
            .filter(|&h| group_of[self.face[h]] == id && !inner(h))
            .collect();
        let first = *border.first()?;
        let mut ring = Vec::new();
        let mut h = first;
        loop {
            ring.push(self.start[h]);
            h = self.next[h];
            while inner(h) {
                h = self.next[self.twin[h]];
            }
            if h == first {
                break;
            }
        }
        let mut seen = ring.clone();
        seen.sort();
        seen.dedup();
        (ring.len() == border.len() && seen.len() == ring.len()).then_some(ring)
    }
}

/// Joins walls that stand in one vertical plane and share a vertical edge (the two halves of a
/// gable end).
fn merge_walls(shell: Shell) -> Option<Shell> {
    let edges = HalfEdges::new(&shell, &BTreeSet::new())?;
    let mut group_of: Vec<usize> = (0..shell.faces.len()).collect();
    let mut groups: Vec<Vec<usize>> = (0..shell.faces.len()).map(|f| vec![f]).collect();
    for h in 0..edges.start.len() {
        let (f, g) = (edges.face[h], edges.face[edges.twin[h]]);
        let (into, from) = (group_of[f], group_of[g]);
        let walls = [f, g]
            .iter()
            .all(|&f| shell.faces[f].kind == FaceKind::Wall);
        let (a, b) = (edges.start[h], edges.start[edges.next[h]]);
        let vertical = shell.plan[a as usize] == shell.plan[b as usize];
        if into == from || !walls || !vertical {
            continue;
        }
        let joined = [groups[into].clone(), groups[from].clone()].concat();
        if in_one_plane(&joined, &shell) {
            for &g in &groups[from] {
                group_of[g] = into;
            }
            groups[from].clear();
            groups[into] = joined;
        }
    }
    let mut merged = Shell {
        faces: Vec::new(),
        ..shell.clone()
    };
    for group in groups.iter().filter(|group| !group.is_empty()) {
        match edges
            .ring_around(group, &group_of)
            .filter(|_| group.len() > 1)
        {
            Some(ring) => merged.faces.push(ShellFace {
                kind: FaceKind::Wall,
                rings: vec![ring],
            }),
            None => merged
                .faces
                .extend(group.iter().map(|&f| shell.faces[f].clone())),
        }
    }
    Some(merged)
}

/// Do walls stand in one vertical plane, facing the same way?
fn in_one_plane(walls: &[usize], shell: &Shell) -> bool {
    let plan = |corner: u32| shell.corners[corner as usize].xy();
    let points: Vec<Point2<f64>> = walls
        .iter()
        .flat_map(|&f| &shell.faces[f].rings[0])
        .map(|&c| plan(c))
        .collect();
    let far = |from: Point2<f64>| {
        *points
            .iter()
            .max_by(|p, q| (*p - from).norm().total_cmp(&(*q - from).norm()))
            .expect("a wall has corners")
    };
    let start = far(points[0]);
    let along = (far(start) - start).normalize();
    // A stretch of a millimetre may cross the plane at any angle and yet stay near it.
    let runs_along = |f: usize| {
        let ring = shell.faces[f].rings[0].iter().map(|&c| plan(c));
        let ring: Vec<Point2<f64>> = ring.collect();
        ring.iter().all(|p| {
            let d = p - ring[0];
            d.perp(&along).abs() <= LARGEST_TURN * d.norm()
        })
    };
    let flat = points
        .iter()
        .all(|p| (p - start).perp(&along).abs() < WELD_M / 2.0);
    // Twice the area of the ring seen from one side has the sign of the way that the wall faces.
    let faces = |f: usize| {
        let ring: Vec<Point3<f64>> = shell.faces[f].rings[0]
            .iter()
            .map(|&c| shell.corners[c as usize])
            .collect();
        sides(&ring).fold(0.0, |sum, [p, q]| {
            let (s, t) = ((p.xy() - start).dot(&along), (q.xy() - start).dot(&along));
            sum + (t - s) * (p.z + q.z)
        }) > 0.0
    };
    flat && walls.iter().all(|&f| runs_along(f))
        && walls.iter().all(|&f| faces(f) == faces(walls[0]))
}

/// Leaves out corners where only two faces meet and the edge between them runs straight on.
fn drop_straight_corners(shell: &mut Shell) -> bool {
    let mut uses: Vec<Vec<(u32, u32)>> = vec![Vec::new(); shell.corners.len()];
    let rings = || shell.faces.iter().flat_map(|f| &f.rings);
    for ring in rings() {
        for i in 0..ring.len() {
            let (before, after) = (
                ring[(i + ring.len() - 1) % ring.len()],
                ring[(i + 1) % ring.len()],
            );
            uses[ring[i] as usize].push((before, after));
        }
    }
    let straight = |corner: usize| match uses[corner][..] {
        [(before, after), (after2, before2)] if before == before2 && after == after2 => {
            let [p, q, r] = [before as usize, corner, after as usize].map(|i| shell.corners[i]);
            let along = r - p;
            (q - p).cross(&along).norm() <= STRAIGHT_DEVIATION_M * along.norm()
                && (q - p).dot(&(r - q)) > 0.0
        }
        _ => false,
    };
    // Neighbours in one pass would change each other's test: every other one waits for the next
    // pass.
    let mut dropped = vec![false; shell.corners.len()];
    for corner in 0..shell.corners.len() {
        dropped[corner] = straight(corner)
            && !uses[corner]
                .iter()
                .any(|&(p, q)| dropped[p as usize] || dropped[q as usize]);
    }
    let long_enough = rings().all(|r| r.iter().filter(|&&c| !dropped[c as usize]).count() >= 3);
    if !long_enough || !dropped.contains(&true) {
        return false;
    }
    for ring in shell.faces.iter_mut().flat_map(|f| &mut f.rings) {
        ring.retain(|&corner| !dropped[corner as usize]);
    }
    true
}

/// Numbers the corners that some ring uses from 0 on.
fn drop_unused_corners(shell: &mut Shell) {
    let mut new = vec![u32::MAX; shell.corners.len()];
    let (mut corners, mut plan) = (Vec::new(), Vec::new());
    for corner in shell.faces.iter_mut().flat_map(|f| &mut f.rings).flatten() {
        let old = *corner as usize;
        if new[old] == u32::MAX {
            new[old] = corners.len() as u32;
            corners.push(shell.corners[old]);
            plan.push(shell.plan[old]);
        }
        *corner = new[old];
    }
    (shell.corners, shell.plan) = (corners, plan);
}
