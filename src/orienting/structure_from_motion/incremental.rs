//! Incremental registration: a first pair, then one photograph after the other by resection
//! (Snavely, Seitz, Szeliski 2006; Schönberger, Frahm 2016).

use nalgebra::{Point3, Rotation3};

use super::block::{Block, Observation, Pose};
use super::bundle::{BundleOptions, adjust};
use super::intrinsics::{Intrinsics, PARAMETERS};
use super::resection::{ResectionProblem, resect};
use super::triangulation::{LEAST_ANGLE, largest_angle, triangulate};
use super::two_view::{PairKind, TwoViewGeometry};
use crate::base::execution::{map, reached};
use crate::base::math::{RAYLEIGH_MEDIAN, SURE_RESIDUAL_SIGMAS};

/// A pair whose matches agree with one geometry.
pub(super) struct VerifiedPair {
    pub photos: [usize; 2],
    /// Keypoints of the first and of the second.
    pub matches: Vec<(usize, usize)>,
    pub geometry: TwoViewGeometry,
}

/// First pairs that are tried.
const MOST_STARTS: usize = 6;

/// Fewest points that a photograph must see, and each of the first pair; and share of those it sees
/// that must agree.
pub(super) const FEWEST_POINTS: usize = 15;
const LEAST_SHARE: f64 = 0.25;

/// Photographs tried at a time: those that see the most points.
const PHOTOGRAPHS_TRIED: usize = 4;

/// Growth of the block after which all of it is adjusted.
const GROWTH: f64 = 1.2;

/// Rays whose median angle is larger gain nothing more, radians.
const BEST_ANGLE: f64 = 12.0 * std::f64::consts::PI / 180.0;

/// Rounds of adjusting and removing outliers at the end. Assumption: what the last one removes
/// changes nothing.
const FINAL_ROUNDS: usize = 3;

/// What sees a block grow.
pub(super) type OnGrowth<'a> = &'a mut dyn FnMut(&Block);

/// Registers as many photographs as possible. The block receives poses, points and calibrated
/// cameras; without a usable first pair it stays empty. `prior` is that of the adjustment;
/// `on_growth` sees the block with every photograph that joins.
pub(super) fn register(
    block: &mut Block,
    pairs: &[VerifiedPair],
    prior: [f64; PARAMETERS],
    on_growth: OnGrowth,
) {
    let means = block.cameras.clone();
    let of_photo = tracks_of_photos(block);
    let joinable = joinable(block.photos.len(), pairs);
    let mut best: Option<Block> = None;
    for pair in starts(pairs).into_iter().take(MOST_STARTS) {
        let mut attempt = block.clone();
        let growing = Growing {
            means: &means,
            of_photo: &of_photo,
            prior,
            joinable,
        };
        if !growing.start(&mut attempt, pair) {
            continue;
        }
        growing.grow(&mut attempt, on_growth);
        let count = |b: &Block| b.registered().len();
        let is_better = best.as_ref().is_none_or(|b| count(&attempt) > count(b));
        if is_better {
            best = Some(attempt);
        }
        if best.as_ref().is_some_and(|b| count(b) * 10 >= joinable * 9) {
            break;
        }
    }
    if let Some(best) = best {
        *block = best;
        finish(block, &means, prior);
    }
}

/// Most photographs that pairs with parallax connect.
fn joinable(photos: usize, pairs: &[VerifiedPair]) -> usize {
    let mut groups: Vec<usize> = (0..photos).collect();
    for pair in pairs {
        let [a, b] = pair.photos.map(|p| groups[p]);
        groups
            .iter_mut()
            .filter(|g| **g == a.max(b))
            .for_each(|g| *g = a.min(b));
    }
    let size = |group: usize| groups.iter().filter(|g| **g == group).count();
    (0..photos).map(size).max().unwrap_or(0)
}

/// Pairs to start from, the best first: many matches that meet at a good angle. Planar pairs allow
/// two poses, so they come last.
fn starts(pairs: &[VerifiedPair]) -> Vec<&VerifiedPair> {
    let quality = |pair: &VerifiedPair| {
        let angle = (pair.geometry.angle / BEST_ANGLE).min(1.0);
        let of_kind = match pair.geometry.kind {
            PairKind::General => 1.0,
            PairKind::Planar => 0.2,
            PairKind::Rotation => 0.0,
        };
        pair.matches.len() as f64 * angle * of_kind
    };
    let mut order: Vec<&VerifiedPair> = pairs.iter().filter(|p| quality(p) > 0.0).collect();
    order.sort_by(|a, b| {
        quality(b)
            .total_cmp(&quality(a))
            .then(a.photos.cmp(&b.photos))
    });
    order
}

/// Tracks of every photograph, with the place of its observation in each.
fn tracks_of_photos(block: &Block) -> Vec<Vec<(usize, usize)>> {
    let mut of_photo = vec![Vec::new(); block.photos.len()];
    for (track, t) in block.tracks.iter().enumerate() {
        for (place, o) in t.observations.iter().enumerate() {
            of_photo[o.photo].push((track, place));
        }
    }
    of_photo
}

struct Growing<'a> {
    means: &'a [Intrinsics],
    of_photo: &'a [Vec<(usize, usize)>],
    prior: [f64; PARAMETERS],
    joinable: usize,
}

impl Growing<'_> {
    /// Poses and points of the first pair; `false` where it has too few points.
    fn start(&self, block: &mut Block, pair: &VerifiedPair) -> bool {
        let [first, second] = pair.photos;
        let relative = &pair.geometry.pose;
        block.photos[first].pose = Some(Pose {
            rotation: Rotation3::identity(),
            center: Point3::origin(),
        });
        block.photos[second].pose = Some(Pose {
            rotation: relative.rotation,
            center: Point3::from(-(relative.rotation.inverse() * relative.translation)),
        });
        let tracks: Vec<usize> = self.of_photo[first].iter().map(|t| t.0).collect();
        retriangulate(block, &tracks);
        let count = |b: &Block| b.tracks.iter().filter(|t| t.point.is_some()).count();
        if count(block) < 2 * FEWEST_POINTS {
            return false;
        }
        // Two views do not calibrate a camera.
        let held = BundleOptions {
            prior: [0.0; PARAMETERS],
            ..self.options(8)
        };
        adjust(block, self.means, &held);
        remove_outliers(block);
        count(block) >= 2 * FEWEST_POINTS
    }

    fn options(&self, steps: usize) -> BundleOptions {
        BundleOptions {
            steps,
            least_gain: 1e-4,
            prior: self.prior,
        }
    }

    /// Adds photographs as long as one sees points enough.
    fn grow(&self, block: &mut Block, on_growth: OnGrowth) {
        let mut adjusted = block.registered().len();
        loop {
            let mut added = self.next(block);
            let registered = block.registered().len();
            let is_due = registered as f64 >= GROWTH * adjusted as f64 || registered < 8;
            if (added && is_due) || (!added && registered > adjusted) {
                let steps = if registered < 8 { 8 } else { 5 };
                adjust(block, self.means, &self.options(steps));
                remove_outliers(block);
                complete(block);
                adjusted = registered;
                reached(0.7 + 0.2 * registered as f64 / self.joinable.max(1) as f64);
                added = true;
            }
            if !added {
                break;
            }
            on_growth(block);
        }
    }

    /// Registers the photograph that sees the most points and agrees with them.
    fn next(&self, block: &mut Block) -> bool {
        let mut order: Vec<(usize, usize)> = (0..block.photos.len())
            .filter(|&p| block.photos[p].pose.is_none())
            .map(|p| (self.seen(block, p).len(), p))
            .filter(|(seen, _)| *seen >= FEWEST_POINTS)
            .collect();
        order.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        for tried in order.chunks(PHOTOGRAPHS_TRIED) {
            let poses = map(tried, |_, &(_, photo)| self.pose(block, photo));
            let found = tried
                .iter()
                .zip(poses)
                .find_map(|(&(_, p), pose)| Some((p, pose?)));
            if let Some((photo, pose)) = found {
                block.photos[photo].pose = Some(pose);
                self.take_points(block, photo);
                return true;
            }
        }
        false
    }

    /// Tracks with a point that a photograph sees.
    fn seen(&self, block: &Block, photo: usize) -> Vec<(usize, usize)> {
        let tracks = self.of_photo[photo].iter().copied();
        tracks
            .filter(|(t, _)| block.tracks[*t].point.is_some())
            .collect()
    }

    fn pose(&self, block: &Block, photo: usize) -> Option<Pose> {
        let points: Vec<_> = (self.seen(block, photo).into_iter())
            .filter_map(|(track, place)| {
                let track = &block.tracks[track];
                Some((track.point?, block.pixel(&track.observations[place])))
            })
            .collect();
        let problem = ResectionProblem {
            intrinsics: block.intrinsics(photo),
            points: &points,
            sigma_px: block.photos[photo].sigma_px,
        };
        let found = resect(&problem, photo as u64)?;
        let inliers = found.inliers.len();
        let is_sound =
            inliers >= FEWEST_POINTS && inliers as f64 >= LEAST_SHARE * points.len() as f64;
        is_sound.then_some(found.model)
    }

    /// The photograph's rays join points, and new points arise.
    fn take_points(&self, block: &mut Block, photo: usize) {
        let mut open = Vec::new();
        for &(track, place) in &self.of_photo[photo] {
            let t = &block.tracks[track];
            match t.point {
                Some(point) => {
                    let fits =
                        block.residual(&t.observations[place], &point) <= SURE_RESIDUAL_SIGMAS;
                    block.tracks[track].observations[place].is_used = fits;
                }
                None => open.push(track),
            }
        }
        retriangulate(block, &open);
    }
}

/// Tries to find points of tracks that have none.
fn retriangulate(block: &mut Block, tracks: &[usize]) {
    let found = map(tracks, |_, &track| {
        let track = &block.tracks[track];
        match track.point {
            Some(_) => None,
            None => triangulate(block, &track.observations),
        }
    });
    for (&track, found) in tracks.iter().zip(found) {
        if let Some((point, used)) = found {
            let track = &mut block.tracks[track];
            track.point = Some(point);
            for (i, o) in track.observations.iter_mut().enumerate() {
                o.is_used = used.contains(&i);
            }
        }
    }
}

/// Points for tracks that have none yet, or lost them.
fn complete(block: &mut Block) {
    let open: Vec<usize> = (0..block.tracks.len())
        .filter(|&t| block.tracks[t].point.is_none())
        .collect();
    retriangulate(block, &open);
}

/// Rays that miss their points no longer count, others count again; points without two rays at an
/// angle go.
pub(super) fn remove_outliers(block: &mut Block) {
    let judged: Vec<Option<Vec<bool>>> = map(&block.tracks, |_, track| {
        let point = track.point?;
        let fits: Vec<bool> = (track.observations.iter())
            .map(|o| block.residual(o, &point) <= SURE_RESIDUAL_SIGMAS)
            .collect();
        let used: Vec<Observation> = (track.observations.iter().zip(&fits))
            .filter(|(_, fits)| **fits)
            .map(|(o, _)| *o)
            .collect();
        let is_point = used.len() >= 2 && largest_angle(block, &used, &point) >= LEAST_ANGLE;
        is_point.then_some(fits)
    });
    for (track, fits) in block.tracks.iter_mut().zip(judged) {
        if fits.is_none() {
            track.point = None;
        }
        for (i, o) in track.observations.iter_mut().enumerate() {
            o.is_used = fits.as_ref().is_some_and(|fits| fits[i]);
        }
    }
}

/// Adjusts all of the block; outliers are judged by the accuracy that the residuals show.
fn finish(block: &mut Block, means: &[Intrinsics], prior: [f64; PARAMETERS]) {
    for round in 0..FINAL_ROUNDS {
        let options = BundleOptions {
            steps: if round + 1 == FINAL_ROUNDS { 20 } else { 8 },
            least_gain: if round + 1 == FINAL_ROUNDS {
                1e-6
            } else {
                1e-4
            },
            prior,
        };
        adjust(block, means, &options);
        reached(0.9 + 0.1 * (round + 1) as f64 / FINAL_ROUNDS as f64);
        if round + 1 < FINAL_ROUNDS {
            measure_accuracy(block);
            remove_outliers(block);
            complete(block);
        }
    }
    drop_weak(block);
}

/// The standard deviations of keypoints become what the median residual says.
fn measure_accuracy(block: &mut Block) {
    let mut residuals: Vec<f64> = (block.tracks.iter())
        .filter_map(|t| Some((t, t.point?)))
        .filter(|(t, _)| t.used().count() >= 3)
        .flat_map(|(t, point)| t.used().map(move |o| (o, point)))
        .map(|(o, point)| block.residual(o, &point))
        .filter(|r| r.is_finite())
        .collect();
    if let Some(median) = crate::base::math::median(&mut residuals) {
        let factor = (median / RAYLEIGH_MEDIAN).clamp(0.25, 2.0);
        block.photos.iter_mut().for_each(|p| p.sigma_px *= factor);
    }
}

/// Photographs that lost their points in the end lose their poses.
fn drop_weak(block: &mut Block) {
    let mut rays = vec![0usize; block.photos.len()];
    for track in block.tracks.iter().filter(|t| t.point.is_some()) {
        track.used().for_each(|o| rays[o.photo] += 1);
    }
    for (photo, rays) in block.photos.iter_mut().zip(rays) {
        if rays < FEWEST_POINTS {
            photo.pose = None;
        }
    }
    remove_outliers(block);
}
