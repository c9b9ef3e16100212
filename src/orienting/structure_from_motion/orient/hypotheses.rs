//! Focal lengths that nothing states, or that the pairs contradict: the block is registered from
//! several, and the likeliest stays.
//!
//! Few photographs from one height hardly tell a longer lens from a greater distance: the pairs may
//! prefer a wrong guess, and the adjustment ends near the guess it began with. The cost of the
//! adjusted blocks tells them apart (three photographs of a rendered scene: 31 % off before, 1 %
//! after).

use super::adjustment::{block, prior};
use super::photo::Photo;
use crate::base::execution::with_detached_listener;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::bundle::truncated_cost;
use crate::orienting::structure_from_motion::incremental::{OnGrowth, VerifiedPair, register};
use crate::orienting::structure_from_motion::intrinsics::stated_focal_nats;
use crate::orienting::structure_from_motion::verification::{Guess, MatchedPhoto};

/// Cameras before their adjustment, and the pairs as they are under them.
pub(super) struct Hypothesis {
    pub guess: Guess,
    pub verified: Vec<VerifiedPair>,
}

/// Photographs of a block that cannot be left to calibrate its camera from any guess.
const SMALL_BLOCK_PHOTOS: usize = 5;

/// Guesses that a small block is registered from.
const GUESSES: usize = 3;

/// How many guesses of the focal length a block of so many photographs is registered from: one that
/// is stated has a rival only where the pairs prefer that.
pub(super) fn guesses(photos: usize, is_guessed: &[bool]) -> usize {
    match (is_guessed.contains(&true), photos <= SMALL_BLOCK_PHOTOS) {
        (false, _) => 2,
        (true, true) => GUESSES,
        (true, false) => 1,
    }
}

/// Registers the photographs under each hypothesis; the block that explains their keypoints best,
/// and the place of its hypothesis. More photographs in the block come before less cost.
/// `on_growth` sees the first one grow.
pub(super) fn register_likeliest(
    photos: &[Photo],
    matched: &[MatchedPhoto],
    hypotheses: &[Hypothesis],
    on_growth: OnGrowth,
) -> (Block, usize) {
    // The same observations for all, so that their costs can be compared.
    let verified: Vec<&VerifiedPair> = hypotheses.iter().flat_map(|h| &h.verified).collect();
    let mut blocks: Vec<Block> = Vec::new();
    for Hypothesis {
        guess,
        verified: own,
    } in hypotheses
    {
        let mut block = block(photos, matched, &guess.cameras, &verified);
        let prior = prior(&guess.is_guessed, 0.0);
        match blocks.is_empty() {
            true => register(&mut block, own, prior, on_growth),
            // The fraction done would jump back.
            false => with_detached_listener(|_| register(&mut block, own, prior, &mut |_| ())),
        }
        blocks.push(block);
    }
    let sigma = |b: &Block| b.photos.first().map_or(0.0, |p| p.sigma_px);
    let finest = blocks.iter().map(sigma).fold(f64::INFINITY, f64::min);
    let mut best: Option<(usize, f64, usize)> = None;
    for (place, block) in blocks.iter().enumerate() {
        let registered = block.registered().len();
        let cost = match hypotheses.len() {
            1 => 0.0,
            _ => {
                let of_rays = truncated_cost(block, sigma(block) / finest);
                of_rays - 2.0 * nats_of_cameras(block, &hypotheses[place].guess)
            }
        };
        let is_better = best.is_none_or(|(most, least, _)| {
            registered > most || (registered == most && cost < least)
        });
        if is_better {
            best = Some((registered, cost, place));
        }
    }
    let place = best.map_or(0, |(_, _, place)| place);
    (blocks.swap_remove(place), place)
}

/// What the adjusted focal lengths say for those that are stated, nats against any others.
fn nats_of_cameras(block: &Block, guess: &Guess) -> f64 {
    let cameras = block.cameras.iter().zip(&guess.cameras);
    (cameras.zip(&guess.is_guessed))
        .filter(|(_, is_guessed)| !**is_guessed)
        .map(|((found, stated), _)| stated_focal_nats(found.focal, stated.focal, 0.0))
        .sum()
}
