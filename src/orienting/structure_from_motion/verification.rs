//! Matches of pairs that agree with one geometry; and a focal length, where none is stated.

use std::ops::Range;

use nalgebra::{Point2, Vector3};

use super::features::Features;
use super::incremental::VerifiedPair;
use super::intrinsics::{FOCAL_GUESSES, Intrinsics, STATED_FOCAL_ODDS, stated_focal_nats};
use super::matching::{Candidate, mutual_matches};
use super::two_view::{TwoViewGeometry, two_view_geometry};
use crate::base::execution::{Sharded, sharded_map};
use crate::base::math;

/// Fewest matches for which a geometry is sought.
const FEWEST_MATCHES: usize = 24;

/// Pairs that judge them.
const JUDGES: usize = 10;

/// What is known of a photograph before there is a block.
pub(super) struct MatchedPhoto<'a> {
    pub features: &'a Features,
    /// Which camera took it.
    pub camera: usize,
    /// Standard deviation of a keypoint, pixels.
    pub sigma_px: f64,
}

/// Matches of a candidate, by its descriptors alone.
pub(super) struct MatchedPair {
    pub photos: [usize; 2],
    pub matches: Vec<(usize, usize)>,
}

/// Matches all candidates.
pub(super) fn match_pairs(
    photos: &[MatchedPhoto],
    candidates: &[Candidate],
    part: Range<f64>,
) -> Sharded<Vec<MatchedPair>> {
    let found = sharded_map("matches", candidates, part, |_, c| {
        let [a, b] = [c.first, c.second].map(|i| photos[i].features);
        mutual_matches(a, b)
    })?;
    let pairs = (candidates.iter().zip(found)).map(|(c, matches)| MatchedPair {
        photos: [c.first, c.second],
        matches,
    });
    Ok(pairs
        .filter(|p| p.matches.len() >= FEWEST_MATCHES)
        .collect())
}

/// The geometry of all pairs, under each of several hypotheses of the cameras; pairs without one
/// are left out.
pub(super) fn verify(
    photos: &[MatchedPhoto],
    under: &[&[Intrinsics]],
    pairs: &[MatchedPair],
    part: Range<f64>,
) -> Sharded<Vec<Vec<VerifiedPair>>> {
    let sought: Vec<(usize, &MatchedPair)> = (0..under.len())
        .flat_map(|place| pairs.iter().map(move |pair| (place, pair)))
        .collect();
    let found = sharded_map("pairs", &sought, part, |_, &(place, pair)| {
        geometry(photos, under[place], pair)
    })?;
    let mut verified: Vec<Vec<VerifiedPair>> = under.iter().map(|_| Vec::new()).collect();
    for (&(place, pair), geometry) in sought.iter().zip(found) {
        if let Some(geometry) = geometry {
            verified[place].push(VerifiedPair {
                photos: pair.photos,
                matches: geometry.inliers.iter().map(|&i| pair.matches[i]).collect(),
                geometry,
            });
        }
    }
    Ok(verified)
}

fn geometry(
    photos: &[MatchedPhoto],
    cameras: &[Intrinsics],
    pair: &MatchedPair,
) -> Option<TwoViewGeometry> {
    let [first, second] = pair.photos.map(|i| &photos[i]);
    let ray = |photo: &MatchedPhoto, keypoint: usize| -> Vector3<f64> {
        let pixel = Point2::from(photo.features.keypoints[keypoint].position);
        cameras[photo.camera].ray(&pixel).push(1.0)
    };
    let rays: Vec<_> = (pair.matches.iter())
        .map(|&(i, j)| (ray(first, i), ray(second, j)))
        .collect();
    let of_photo = |p: &MatchedPhoto| p.sigma_px / cameras[p.camera].focal;
    let sigma = 0.5 * (of_photo(first) + of_photo(second));
    let longest =
        |p: &MatchedPhoto| f64::from(cameras[p.camera].size[0].max(cameras[p.camera].size[1]));
    let range = longest(second) / second.sigma_px;
    let seed = (pair.photos[0] * 100_003 + pair.photos[1]) as u64;
    two_view_geometry(&rays, sigma, range, seed)
}

/// Cameras before their adjustment, and what the pairs say of them.
#[derive(Clone, Debug)]
pub(super) struct Guess {
    pub cameras: Vec<Intrinsics>,
    /// Whose focal length is none that is stated?
    pub is_guessed: Vec<bool>,
    /// Likelihood of the pairs that judge, nats; 0 where none does.
    pub nats: f64,
}

/// The cameras under each guess of the focal length of those that are marked; those under which the
/// pairs with the most matches are likeliest first. Without a mark the cameras as they are stated
/// come first, and after them the likeliest guess of all that the headers' spread does not cover,
/// where the pairs prefer the mean of the guesses.
pub(super) fn guess_focal(
    photos: &[MatchedPhoto],
    cameras: &[Intrinsics],
    is_guessed: &[bool],
    pairs: &[MatchedPair],
) -> Sharded<Vec<Guess>> {
    let all_stated = !is_guessed.contains(&true);
    let tried_of: Vec<bool> = is_guessed.iter().map(|&g| g || all_stated).collect();
    let judges = judges(photos, pairs, &tried_of);
    let with = |share: f64| -> Guess {
        let focal = |camera: &Intrinsics| share * f64::from(camera.size[0].max(camera.size[1]));
        let under = (cameras.iter().zip(&tried_of)).map(|(camera, &is_tried)| Intrinsics {
            focal: if is_tried {
                focal(camera)
            } else {
                camera.focal
            },
            ..camera.clone()
        });
        Guess {
            cameras: under.collect(),
            is_guessed: tried_of.clone(),
            nats: 0.0,
        }
    };
    let stated = Guess {
        cameras: cameras.to_vec(),
        is_guessed: is_guessed.to_vec(),
        nats: 0.0,
    };
    let mut under: Vec<Guess> = FOCAL_GUESSES.map(with).into();
    if all_stated {
        under.push(stated.clone());
    }
    let tried: Vec<(usize, &MatchedPair)> = (0..under.len())
        .flat_map(|guess| judges.iter().map(move |&pair| (guess, pair)))
        .collect();
    let scores = sharded_map("focal lengths", &tried, 0.6..0.65, |_, &(guess, pair)| {
        geometry(photos, &under[guess].cameras, pair).map_or(0.0, |g| g.score)
    })?;
    if judges.is_empty() {
        return Ok(vec![stated]);
    }
    for ((guess, _), score) in tried.iter().zip(scores) {
        under[*guess].nats += score;
    }
    let as_stated = all_stated.then(|| under.pop()).flatten();
    under.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    Ok(match as_stated {
        Some(as_stated) => with_rival(as_stated, under, cameras),
        None => under,
    })
}

/// The pairs that judge guesses of the focal length of some cameras.
fn judges<'a>(
    photos: &[MatchedPhoto],
    pairs: &'a [MatchedPair],
    is_tried: &[bool],
) -> Vec<&'a MatchedPair> {
    let mut judges: Vec<&MatchedPair> = (pairs.iter())
        .filter(|p| p.photos.iter().any(|&i| is_tried[photos[i].camera]))
        .collect();
    judges.sort_by(|a, b| {
        b.matches
            .len()
            .cmp(&a.matches.len())
            .then(a.photos.cmp(&b.photos))
    });
    // The pairs with the most matches hardly differ in their place: every third says more.
    judges.into_iter().step_by(3).take(JUDGES).collect()
}

/// The cameras as they are stated, and the likeliest of the guesses where the pairs prefer it.
fn with_rival(as_stated: Guess, guesses: Vec<Guess>, cameras: &[Intrinsics]) -> Vec<Guess> {
    // A guess that the header's own spread covers is none: the adjustment gets there.
    let is_rival = |guess: &Guess| {
        let focals = guess.cameras.iter().zip(cameras);
        let mut nats = focals.map(|(c, stated)| stated_focal_nats(c.focal, stated.focal, 0.0));
        nats.any(|nats| nats < 0.0)
    };
    let Some(best) = guesses.into_iter().find(is_rival) else {
        return vec![as_stated];
    };
    // One of so many guesses: the likelihood of any is their mean, of which the best is all.
    let of_any = best.nats - math::ln(FOCAL_GUESSES.len() as f64);
    match of_any > as_stated.nats + STATED_FOCAL_ODDS {
        true => vec![as_stated, best],
        false => vec![as_stated],
    }
}
