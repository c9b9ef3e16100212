//! The chain step by step, for callers that read photographs one after the other, show how far it
//! is, or divide the work between instances of the core.

use nalgebra::{Point2, Point3};
use serde::Serialize;

use super::adjustment::calibrate_center;
use super::cameras::{Cameras, Stated, stated_of};
use super::hypotheses::{Hypothesis, guesses, register_likeliest};
use super::options::{OrientOptions, Oriented};
use super::photo::{Photo, ReadPhoto};
use super::refusals::{contradicted_focal, not_joined, too_few, unconnected, undetermined_focal};
use super::snapshot::Snapshot;
use crate::base::error::{Error, Result};
use crate::base::execution::Listener;
use crate::base::execution::{
    MergedShards, Origin, ShardTask, Sharded, run_merged, run_shard, with_listener,
};
use crate::orienting::orientation::InputFile;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::bundle::covariance;
use crate::orienting::structure_from_motion::features::Features;
use crate::orienting::structure_from_motion::frame::{FrameBasis, NOTHING_STATED, to_frame};
use crate::orienting::structure_from_motion::ground_control::{
    Beside, GeoList, GroundControl, to_control,
};
use crate::orienting::structure_from_motion::incremental::VerifiedPair;
use crate::orienting::structure_from_motion::intrinsics::Intrinsics;
use crate::orienting::structure_from_motion::matching::candidate_pairs;
use crate::orienting::structure_from_motion::output::{
    LeftOut, Names, PlanCoverage, report, sparse_model,
};
use crate::orienting::structure_from_motion::two_view::PairKind;
use crate::orienting::structure_from_motion::verification::{
    Guess, MatchedPhoto, guess_focal, match_pairs, verify,
};
use crate::photographs::camera::FEWEST_VIEWS;

/// Standard deviation of a keypoint before it is measured, pixels of the working size.
const KEYPOINT_SIGMA: f64 = 1.0;

/// The maps that instances may divide, in their order.
const MAPS: &[&str] = &["overlaps", "matches", "focal lengths", "pairs"];

/// A pair of photographs whose matches agree with one geometry.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PairSummary {
    /// Path of the first photograph.
    pub first: String,
    /// That of the second.
    pub second: String,
    /// Which geometry explains the matches best.
    #[cfg_attr(
        target_arch = "wasm32",
        tsify(type = "\"general\" | \"planar\" | \"rotation\"")
    )]
    pub kind: PairKind,
    /// Matches that agree with it.
    pub matches: usize,
    /// Median angle between their rays, degrees.
    pub angle_deg: f64,
}

/// Is shown the block whenever it has grown.
pub type OnBlock<'a> = &'a mut dyn FnMut(Snapshot);

/// What the pairs of the photographs say.
struct Connected {
    cameras: Cameras,
    stated: Stated,
    /// One, or several where the focal length is guessed; the likeliest by the pairs first.
    hypotheses: Vec<Hypothesis>,
}

/// Photographs on their way to an orientation: [`add`](Self::add) each,
/// [`connect`](Self::connect), [`orient`](Self::orient).
#[derive(Default)]
pub struct OrientChain {
    options: OrientOptions,
    /// By path.
    photos: Vec<Photo>,
    left_out: Vec<LeftOut>,
    connected: Option<Connected>,
    control: Option<GroundControl>,
    places: Option<GeoList>,
}

impl OrientChain {
    /// Without photographs yet.
    pub fn new(options: OrientOptions) -> Self {
        Self {
            options,
            ..Self::default()
        }
    }

    /// Takes the lists among files: ground control points, which give the frame of what
    /// [`orient`](Self::orient) returns, and places of photographs, which count instead of those in
    /// their headers. Others stay as they were.
    ///
    /// # Errors
    /// Where one of them cannot be read; the message names the line.
    pub fn set_lists(&mut self, files: &[InputFile]) -> Result<()> {
        self.control = GroundControl::among(files)?.or(self.control.take());
        if let Some(places) = GeoList::among(files)? {
            self.connected = None;
            self.places = Some(places);
        }
        Ok(())
    }

    /// How photographs are to be read.
    pub fn options(&self) -> &OrientOptions {
        &self.options
    }

    /// Takes a photograph in; one of the same path is replaced.
    pub fn add(&mut self, photo: ReadPhoto) {
        self.connected = None;
        self.photos.retain(|p| p.path != photo.path());
        self.left_out.retain(|p| p.file != photo.path());
        match photo.0 {
            Ok(photo) => {
                let place = self.photos.partition_point(|p| p.path < photo.path);
                self.photos.insert(place, photo);
            }
            Err(left) => self.left_out.push(left),
        }
    }

    /// Refuses fewer photographs than a block has.
    ///
    /// # Errors
    /// Where there are fewer than three.
    pub(super) fn has_enough(&self, images: usize) -> Result<()> {
        if images < FEWEST_VIEWS {
            return Err(Error::scene(
                format!("{images} photographs"),
                "give three or more that overlap",
            ));
        }
        Ok(())
    }

    /// The maps that instances with the same photographs may divide between them before
    /// [`connect`](Self::connect), in their order.
    pub fn shard_maps() -> &'static [&'static str] {
        MAPS
    }

    /// The shard of instance `index` of so many of a map, with the merged shards of the maps before
    /// it; empty where there is no such map.
    pub fn run_shard(
        &self,
        map: &str,
        [index, of]: [usize; 2],
        merged: MergedShards,
        listener: &Listener,
    ) -> Vec<u8> {
        let Some(task) = ShardTask::new(MAPS, map, index, of) else {
            return Vec::new();
        };
        with_listener(listener.clone(), || {
            run_shard(task, self.origin(), merged, || self.connected())
        })
    }

    /// Finds the pairs that show the same, and their geometry; with the merged shards of the maps
    /// where instances have divided them.
    ///
    /// # Errors
    /// Where fewer than three photographs are of use.
    pub fn connect(&mut self, merged: MergedShards) -> Result<()> {
        self.has_enough(self.photos.len() + self.left_out.len())?;
        if self.photos.len() < FEWEST_VIEWS {
            self.left_out.sort_by(|a, b| a.file.cmp(&b.file));
            return Err(too_few(&self.left_out));
        }
        self.connected = Some(run_merged(self.origin(), merged, || self.connected()));
        Ok(())
    }

    /// What shards are made of: paths and numbers of keypoints tell photographs apart.
    fn origin(&self) -> Origin {
        let named = self.photos.iter().flat_map(|p| {
            let keypoints = p.features.keypoints.len() as u32;
            (p.path.bytes()).chain(keypoints.to_le_bytes())
        });
        Origin::of(&named.collect::<Vec<u8>>())
    }

    fn connected(&self) -> Sharded<Connected> {
        let cameras = Cameras::of(&self.photos, &self.options);
        let stated = stated_of(&self.photos, self.places.as_ref());
        let positions: Vec<Option<Point3<f64>>> = stated.poses.iter().map(|s| s.position).collect();
        let features: Vec<&Features> = self.photos.iter().map(|p| &p.features).collect();
        let candidates = candidate_pairs(&features, &positions, 0.4..0.45)?;
        let matched = self.matched(&cameras);
        let pairs = match_pairs(&matched, &candidates, 0.45..0.6)?;
        let guessed = &cameras.is_guessed;
        let mut under = guess_focal(&matched, &cameras.intrinsics, guessed, &pairs)?;
        under.truncate(guesses(self.photos.len(), guessed));
        let of_guesses: Vec<&[Intrinsics]> = under.iter().map(|g| &g.cameras[..]).collect();
        let verified = verify(&matched, &of_guesses, &pairs, 0.65..0.7)?;
        let hypotheses = under.into_iter().zip(verified);
        Ok(Connected {
            cameras,
            stated,
            hypotheses: hypotheses
                .map(|(guess, verified)| Hypothesis { guess, verified })
                .collect(),
        })
    }

    fn matched(&self, cameras: &Cameras) -> Vec<MatchedPhoto<'_>> {
        (self.photos.iter().enumerate())
            .map(|(i, photo)| MatchedPhoto {
                features: &photo.features,
                camera: cameras.of_photo[i],
                sigma_px: KEYPOINT_SIGMA * photo.working_pixel(&self.options),
            })
            .collect()
    }

    /// The connected pairs, those with the most matches first.
    pub fn pairs(&self) -> Vec<PairSummary> {
        let path = |i: usize| self.photos[i].path.clone();
        (self.ranked().iter())
            .map(|pair| PairSummary {
                first: path(pair.photos[0]),
                second: path(pair.photos[1]),
                kind: pair.geometry.kind,
                matches: pair.matches.len(),
                angle_deg: pair.geometry.angle.to_degrees(),
            })
            .collect()
    }

    /// Matches of a pair by its place in [`pairs`](Self::pairs): keypoints of both photographs,
    /// pixels.
    pub fn pair_matches(&self, place: usize) -> Vec<[Point2<f64>; 2]> {
        let ranked = self.ranked();
        let Some(pair) = ranked.get(place) else {
            return Vec::new();
        };
        let [first, second] = pair.photos.map(|p| &self.photos[p].features.keypoints);
        (pair.matches.iter())
            .map(|&(i, j)| [first[i].position.into(), second[j].position.into()])
            .collect()
    }

    fn ranked(&self) -> Vec<&VerifiedPair> {
        let first = self.connected.iter().filter_map(|c| c.hypotheses.first());
        let mut ranked: Vec<&VerifiedPair> = first.flat_map(|h| &h.verified).collect();
        ranked.sort_by(|a, b| {
            let by_matches = b.matches.len().cmp(&a.matches.len());
            by_matches.then(a.photos.cmp(&b.photos))
        });
        ranked
    }

    /// Registers and adjusts the connected photographs and brings them into their frame; `on_block`
    /// sees the block grow.
    ///
    /// # Errors
    /// Where fewer than three photographs join; the message says why.
    pub fn orient(&self, mut on_block: Option<OnBlock>) -> Result<Oriented> {
        let unknown = || {
            let photographs = self.photos.len() + self.left_out.len();
            let problem = format!("the pairs of the {photographs} photographs are not known yet");
            Error::scene(problem, "find them first")
        };
        let connected = self.connected.as_ref().ok_or_else(unknown)?;
        let Connected {
            cameras,
            stated,
            hypotheses,
        } = connected;
        let mut show = |block: &Block| {
            if let Some(on_block) = &mut on_block {
                on_block(Snapshot::of(block, &self.photos, stated));
            }
        };
        let (mut block, place) =
            register_likeliest(&self.photos, &self.matched(cameras), hypotheses, &mut show);
        let Hypothesis { guess, verified } = &hypotheses[place];
        let Guess {
            cameras: means,
            is_guessed,
            ..
        } = guess;
        let registered = block.registered().len();
        let mut left_out = self.left_out.clone();
        left_out.extend(not_joined(&self.photos, &block, verified));
        left_out.sort_by(|a, b| a.file.cmp(&b.file));
        if registered < FEWEST_VIEWS {
            let guesses: Vec<&Guess> = hypotheses.iter().map(|h| &h.guess).collect();
            return Err(
                contradicted_focal(&guesses).unwrap_or_else(|| unconnected(verified, &left_out))
            );
        }
        let is_held = self.options.holds_center;
        let adjusted = calibrate_center(&mut block, means, is_guessed, is_held);
        let paths: Vec<&str> = self.photos.iter().map(|p| p.path.as_str()).collect();
        let (basis, notes) = self.to_its_frame(&mut block, &paths, stated);
        // The covariance belongs to the frame.
        let covariance = adjusted.and_then(|options| covariance(&block, means, &options));
        let before = cameras.or_guessed(means);
        if place > 0 && !cameras.is_guessed.contains(&true) {
            undetermined_focal(&block.cameras, &before, covariance.as_ref())?;
        }
        let names = Names {
            paths,
            colours: self.photos.iter().map(|p| p.colours.as_slice()).collect(),
            cameras: cameras.names.clone(),
            means: &before,
            is_guessed: &cameras.is_guessed,
            stated: &stated.poses,
        };
        let model = sparse_model(&block, &names, &basis);
        let mut report = report(&block, &names, &basis, covariance.as_ref(), left_out);
        // That nothing is stated is no fault of it.
        let (nothing, doubts): (Vec<_>, Vec<_>) =
            notes.into_iter().partition(|note| note == NOTHING_STATED);
        report.frame += &nothing
            .iter()
            .map(|note| format!("; {note}"))
            .collect::<String>();
        report.warnings.extend(doubts);
        report.coverage = PlanCoverage::of(&model, report.anchor.as_ref());
        Ok(Oriented { model, report })
    }

    /// Brings a block into the frame of the ground control, or else of what the headers state; with
    /// what is doubtful of them.
    fn to_its_frame(
        &self,
        block: &mut Block,
        paths: &[&str],
        stated: &Stated,
    ) -> (FrameBasis, Vec<String>) {
        let applies_fix = self.options.applies_fix;
        let mut notes = stated.notes.clone();
        if let Some(control) = &self.control {
            let beside = Beside {
                paths,
                stated: &stated.poses,
                anchor: stated.anchor,
                applies_fix,
            };
            let (basis, words) = to_control(block, control, &beside);
            notes.extend(words);
            if let Some(basis) = basis {
                return (basis, notes);
            }
        }
        let (basis, words) = to_frame(block, &stated.poses, stated.anchor, applies_fix, paths);
        notes.extend(words);
        (basis, notes)
    }
}
