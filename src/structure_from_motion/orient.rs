//! From photographs to their orientation.

use nalgebra::{Point3, Rotation3, Vector3};

use super::block::{Block, BlockPhoto};
use super::bundle::{BundleOptions, Covariance, adjust, covariance};
use super::features::{FeatureOptions, Features, Keypoint, detect_features};
use super::frame::{StatedPose, to_frame};
use super::incremental::{VerifiedPair, register};
use super::intrinsics::Intrinsics;
use super::matching::candidate_pairs;
use super::metadata::PhotoMetadata;
use super::output::{LeftOut, Names, NotJoined, OrientReport, SparseModel, report, sparse_model};
use super::tracks::{PairMatches, join};
use super::two_view::PairKind;
use super::verification::{MatchedPhoto, guess_focal, match_pairs, verify};
use crate::error::{Error, Result};
use crate::execution::map_part;
use crate::orientation::{Anchor, InputFile, geocentric_of, rotation_from_yaw_pitch_roll};
use crate::raster::{image_format, load_image};

/// How photographs are oriented.
#[derive(Clone, Debug, Default)]
pub struct OrientOptions {
    /// Working size and number of features.
    pub features: FeatureOptions,
    /// Focal length of all photographs, pixels, instead of what their headers state.
    pub focal_px: Option<f64>,
    /// Keep the principal point in the middle of the photographs, also where the block determines
    /// it.
    pub holds_center: bool,
}

/// Oriented photographs.
#[derive(Clone, Debug)]
pub struct Oriented {
    /// Cameras, poses and points.
    pub model: SparseModel,
    /// How good they are.
    pub report: OrientReport,
}

impl Oriented {
    /// COLMAP's text model and the report, by name.
    pub fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut files = self.model.colmap_files();
        files.push((
            "orientation.json".into(),
            self.report.to_json().into_bytes(),
        ));
        files.push(("orientation.log".into(), self.report.to_text().into_bytes()));
        files
    }
}

/// Fewest keypoints of a photograph that is of use.
const FEWEST_KEYPOINTS: usize = 60;

/// Fewest photographs of a block.
const FEWEST_PHOTOS: usize = 3;

/// Standard deviation of a keypoint before it is measured, pixels of the working size.
const KEYPOINT_SIGMA: f64 = 1.0;

/// Scale of a fine keypoint, pixels of the working size.
const FINE_SCALE: f64 = 1.6;

/// Prior standard deviations of k1 and k2: weak blocks keep an ordinary lens, strong ones measure
/// any.
const RADIAL_PRIOR: [f64; 2] = [0.05, 0.03];

/// That of f as a share, where it is stated and where it is guessed.
const STATED_FOCAL_PRIOR: f64 = 0.05;
const GUESSED_FOCAL_PRIOR: f64 = 0.5;

/// The principal point is free where the block determines it to this share of the longer side.
const LEAST_CENTER_SIGMA: f64 = 0.001;

/// Photographs whose rows run one way leave it open: longest mean of the directions of their rows.
const MOST_PARALLEL: f64 = 0.7;

/// Its prior standard deviation, a share of the longer side.
const CENTER_PRIOR: f64 = 0.02;

/// A photograph that was read.
struct Photo<'a> {
    path: &'a str,
    size: [u32; 2],
    metadata: PhotoMetadata,
    features: Features,
    colours: Vec<[u8; 3]>,
}

/// Orients the photographs among the files. Positions in the result are metres where the
/// photographs state theirs, z is up; pixels as in all of this crate.
///
/// # Errors
/// Where fewer than three photographs can be oriented; the message says why.
pub fn orient(files: &[InputFile], options: &OrientOptions) -> Result<Oriented> {
    let mut images: Vec<&InputFile> = (files.iter())
        .filter(|f| image_format(&f.bytes).is_some())
        .collect();
    images.sort_by(|a, b| a.path.cmp(&b.path));
    if images.len() < FEWEST_PHOTOS {
        return Err(refusal(
            format!("{} photographs", images.len()),
            "give three or more that overlap",
        ));
    }
    let (photos, mut left_out) = read(&images, options);
    if photos.len() < FEWEST_PHOTOS {
        return Err(too_few(&left_out));
    }
    let cameras = Cameras::of(&photos, options);
    let (stated, anchor) = stated_poses(&photos);
    let positions: Vec<Option<Point3<f64>>> = stated.iter().map(|s| s.position).collect();
    let features: Vec<Features> = photos.iter().map(|p| p.features.clone()).collect();
    let candidates = candidate_pairs(&features, &positions, 0.4..0.45);
    let matched: Vec<MatchedPhoto> = (photos.iter().zip(&features).enumerate())
        .map(|(i, (photo, features))| MatchedPhoto {
            features,
            camera: cameras.of_photo[i],
            sigma_px: KEYPOINT_SIGMA * working_pixel(photo, options),
        })
        .collect();
    let pairs = match_pairs(&matched, &candidates, 0.45..0.62);
    let mut means = cameras.intrinsics.clone();
    guess_focal(&matched, &mut means, &cameras.is_guessed, &pairs);
    let verified = verify(&matched, &means, &pairs, 0.62..0.7);
    let mut block = block(&photos, &matched, &means, &verified);
    let prior = prior(&cameras.is_guessed, 0.0);
    register(&mut block, &verified, prior);
    let registered = block.registered().len();
    left_out.extend(not_joined(&photos, &block, &verified));
    left_out.sort_by(|a, b| a.file.cmp(&b.file));
    if registered < FEWEST_PHOTOS {
        return Err(unconnected(&verified, &left_out));
    }
    let covariance = calibrate_center(
        &mut block,
        &means,
        &cameras.is_guessed,
        options.holds_center,
    );
    let basis = to_frame(&mut block, &stated, anchor);
    // The covariance belongs to the frame.
    let covariance = covariance.and_then(|options| self::covariance(&block, &means, &options));
    let names = Names {
        paths: photos.iter().map(|p| p.path).collect(),
        colours: photos.iter().map(|p| p.colours.as_slice()).collect(),
        cameras: cameras.names.clone(),
        means: &means,
        is_guessed: &cameras.is_guessed,
        stated: &stated,
    };
    let model = sparse_model(&block, &names);
    let report = report(&block, &names, &basis, covariance.as_ref(), left_out);
    Ok(Oriented { model, report })
}

/// Decodes the photographs and finds their features; those without are left out.
fn read<'a>(images: &[&'a InputFile], options: &OrientOptions) -> (Vec<Photo<'a>>, Vec<LeftOut>) {
    let found = map_part(images, 0.0..0.4, |_, file| {
        let left_out = |reason: NotJoined| LeftOut {
            file: file.path.clone(),
            reason,
        };
        let photograph = load_image(&file.path, &file.bytes).map_err(|e| {
            let problem = e.to_string();
            left_out(NotJoined::Unreadable { problem })
        })?;
        let size = [photograph.rgb.width(), photograph.rgb.height()];
        let features = detect_features(&photograph.gray, &options.features);
        let keypoints = features.keypoints.len();
        if keypoints < FEWEST_KEYPOINTS {
            return Err(left_out(NotJoined::FewFeatures { keypoints }));
        }
        let colour = |position: [f64; 2]| {
            let [x, y] = [0, 1].map(|i| (position[i].max(0.0) as u32).min(size[i] - 1));
            photograph.rgb.get_pixel(x, y).0
        };
        Ok(Photo {
            path: &file.path,
            size,
            metadata: PhotoMetadata::read(&file.bytes, size),
            colours: features
                .keypoints
                .iter()
                .map(|k| colour(k.position))
                .collect(),
            features,
        })
    });
    let (mut photos, mut left_out) = (Vec::new(), Vec::new());
    for one in found {
        match one {
            Ok(photo) => photos.push(photo),
            Err(left) => left_out.push(left),
        }
    }
    (photos, left_out)
}

/// Pixels of a photograph for one of the size that features were found at.
fn working_pixel(photo: &Photo, options: &OrientOptions) -> f64 {
    let longest = f64::from(photo.size[0].max(photo.size[1]));
    (longest / options.features.working_px as f64).max(1.0)
}

/// The cameras that took the photographs.
struct Cameras {
    intrinsics: Vec<Intrinsics>,
    names: Vec<String>,
    is_guessed: Vec<bool>,
    of_photo: Vec<usize>,
}

impl Cameras {
    /// Photographs of one model, size and focal length share a camera.
    fn of(photos: &[Photo], options: &OrientOptions) -> Self {
        let mut cameras = Self {
            intrinsics: Vec::new(),
            names: Vec::new(),
            is_guessed: Vec::new(),
            of_photo: Vec::new(),
        };
        let mut keys: Vec<(&str, [u32; 2], Option<f64>)> = Vec::new();
        for photo in photos {
            let m = &photo.metadata;
            let key = (m.camera.as_str(), photo.size, m.focal_mm);
            let known = keys.iter().position(|k| *k == key);
            cameras.of_photo.push(known.unwrap_or(keys.len()));
            if known.is_none() {
                let focal = options.focal_px.or(m.focal_px);
                let longest = f64::from(photo.size[0].max(photo.size[1]));
                let intrinsics = Intrinsics::new(focal.unwrap_or(longest), photo.size);
                cameras.intrinsics.push(intrinsics);
                cameras.names.push(m.camera.clone());
                cameras.is_guessed.push(focal.is_none());
                keys.push(key);
            }
        }
        cameras
    }
}

/// Stated positions in a frame that touches the Earth, and angles.
fn stated_poses(photos: &[Photo]) -> (Vec<StatedPose>, Option<Anchor>) {
    let geocentric = |photo: &Photo| {
        let [lon, lat, height] = photo.metadata.position?;
        Some(geocentric_of(lon, lat, height))
    };
    let all: Vec<Point3<f64>> = photos.iter().filter_map(geocentric).collect();
    let anchor = (!all.is_empty()).then(|| Anchor::near(&crate::geometry::mean_point(&all)));
    let rotation = |photo: &Photo| -> Option<Rotation3<f64>> {
        let [yaw, pitch, roll] = photo.metadata.yaw_pitch_roll?.map(f64::to_radians);
        let from_below = pitch + std::f64::consts::FRAC_PI_2;
        Some(rotation_from_yaw_pitch_roll(yaw, from_below, roll))
    };
    let stated = (photos.iter())
        .map(|photo| StatedPose {
            position: anchor.and_then(|anchor| Some(anchor.local(&geocentric(photo)?))),
            rotation: rotation(photo),
        })
        .collect();
    (stated, anchor)
}

fn prior(is_guessed: &[bool], center_px: f64) -> [f64; 5] {
    let focal = match is_guessed.contains(&true) {
        true => GUESSED_FOCAL_PRIOR,
        false => STATED_FOCAL_PRIOR,
    };
    let [k1, k2] = RADIAL_PRIOR;
    [focal, k1, k2, center_px, center_px]
}

/// Standard deviation of a keypoint as a multiple of that of a fine one: it grows with the scale.
fn factor(keypoint: &Keypoint, pixel: f64) -> f64 {
    (f64::from(keypoint.scale) / pixel / FINE_SCALE).max(1.0)
}

fn block(
    photos: &[Photo],
    matched: &[MatchedPhoto],
    cameras: &[Intrinsics],
    verified: &[VerifiedPair],
) -> Block {
    let counts: Vec<usize> = photos.iter().map(|p| p.features.keypoints.len()).collect();
    let pairs: Vec<PairMatches> = (verified.iter())
        .map(|pair| PairMatches {
            photos: pair.photos,
            matches: pair.matches.clone(),
        })
        .collect();
    let photo = |m: &MatchedPhoto| BlockPhoto {
        keypoints: m
            .features
            .keypoints
            .iter()
            .map(|k| k.position.into())
            .collect(),
        camera: m.camera,
        sigma_px: m.sigma_px,
        factors: m
            .features
            .keypoints
            .iter()
            .map(|k| factor(k, m.sigma_px))
            .collect(),
        pose: None,
    };
    Block {
        photos: matched.iter().map(photo).collect(),
        cameras: cameras.to_vec(),
        tracks: join(&counts, &pairs),
    }
}

/// Adjusts the principal point too where the block determines it: photographs that are turned
/// against each other, and a small standard deviation. Where all point one way it follows whatever
/// the camera's model lacks (sheffield: 16 px, and larger differences of the poses). Returned is
/// how the block was adjusted in the end.
fn calibrate_center(
    block: &mut Block,
    means: &[Intrinsics],
    is_guessed: &[bool],
    is_held: bool,
) -> Option<BundleOptions> {
    let longest = |c: &Intrinsics| f64::from(c.size[0].max(c.size[1]));
    let most = means.iter().map(longest).fold(0.0, f64::max);
    let options = |center_px: f64| BundleOptions {
        steps: 20,
        least_gain: 1e-8,
        prior: prior(is_guessed, center_px),
    };
    let free = options(CENTER_PRIOR * most);
    let is_determined = |c: &Covariance| {
        c.cameras
            .iter()
            .zip(means)
            .all(|(sigmas, mean)| sigmas[3].max(sigmas[4]) < LEAST_CENTER_SIGMA * longest(mean))
    };
    let rows: Vec<Vector3<f64>> = (block.photos.iter())
        .filter_map(|p| p.pose.as_ref())
        .map(|pose| pose.rotation.inverse() * Vector3::x())
        .collect();
    let mean = rows.iter().fold(Vector3::zeros(), |a, b| a + b) / rows.len() as f64;
    if is_held || mean.norm() > MOST_PARALLEL {
        return Some(options(0.0));
    }
    if covariance(block, means, &free)
        .as_ref()
        .is_some_and(is_determined)
    {
        adjust(block, means, &free);
        return Some(free);
    }
    Some(options(0.0))
}

/// Why the photographs that were read have no orientation.
fn not_joined(photos: &[Photo], block: &Block, verified: &[VerifiedPair]) -> Vec<LeftOut> {
    let reason = |photo: usize| {
        let own = || verified.iter().filter(|p| p.photos.contains(&photo));
        if own().next().is_none() {
            NotJoined::NoOverlap
        } else if own().all(|p| p.geometry.kind == PairKind::Rotation) {
            NotJoined::OnlyTurned
        } else {
            NotJoined::FewPoints {
                partners: own().count(),
            }
        }
    };
    (0..photos.len())
        .filter(|&i| block.photos[i].pose.is_none())
        .map(|i| LeftOut {
            file: photos[i].path.to_owned(),
            reason: reason(i),
        })
        .collect()
}

fn refusal(problem: String, advice: &str) -> Error {
    Error::Scene {
        problem,
        advice: advice.to_owned(),
    }
}

fn too_few(left_out: &[LeftOut]) -> Error {
    let named: Vec<String> = (left_out.iter().take(5))
        .map(|left| format!("{}: {}", left.file, left.reason.words()))
        .collect();
    refusal(
        format!(
            "fewer than three photographs are of use ({})",
            named.join("; ")
        ),
        "give three or more sharp photographs that overlap",
    )
}

/// Why no block arose.
fn unconnected(verified: &[VerifiedPair], left_out: &[LeftOut]) -> Error {
    if verified.is_empty() {
        return refusal(
            "no two photographs show enough of the same".to_owned(),
            "take photographs that overlap by two thirds, of things that do not move",
        );
    }
    if verified
        .iter()
        .all(|p| p.geometry.kind == PairKind::Rotation)
    {
        return refusal(
            "the photographs were taken from one place, the camera only turned: nothing shows depth"
                .to_owned(),
            "move the camera between photographs",
        );
    }
    refusal(
        format!("the {} photographs do not join", left_out.len()),
        "take photographs that overlap by two thirds, so that every place is in three of them; if \
         they do, state the focal length in pixels (--focal)",
    )
}
