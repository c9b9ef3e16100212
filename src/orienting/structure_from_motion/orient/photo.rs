//! What the chain keeps of a photograph: its features and what its header states, not its pixels.

use serde::{Deserialize, Serialize};

use super::options::OrientOptions;
use crate::orienting::orientation::InputFile;
use crate::orienting::structure_from_motion::features::{Features, detect_features};
use crate::orienting::structure_from_motion::metadata::PhotoMetadata;
use crate::orienting::structure_from_motion::output::{LeftOut, NotJoined};
use crate::photographs::raster::{image_header, load_image};

/// Fewest keypoints of a photograph that is of use.
const FEWEST_KEYPOINTS: usize = 60;

/// A photograph that was read.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Photo {
    pub path: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    pub metadata: PhotoMetadata,
    pub features: Features,
    /// Colours of the keypoints.
    pub colours: Vec<[u8; 3]>,
}

impl Photo {
    /// Pixels of the photograph for one of the size that features were found at.
    pub(super) fn working_pixel(&self, options: &OrientOptions) -> f64 {
        let longest = f64::from(self.size[0].max(self.size[1]));
        (longest / options.features.working_px as f64).max(1.0)
    }
}

/// EXIF orientations of photographs that are stored as in a mirror. A turn by quarters is another
/// matter: the orientation is that of the pixels as they are stored, which show the same.
const MIRRORED: [u8; 4] = [2, 4, 5, 7];

/// Decodes a photograph and finds its features, in the pixels as they are stored.
fn read(file: &InputFile, options: &OrientOptions) -> Result<Photo, NotJoined> {
    let unreadable = |problem: String| NotJoined::Unreadable { problem };
    let decoded = load_image(&file.path, file.content());
    let photograph = decoded.map_err(|e| unreadable(e.to_string()))?;
    let is_mirrored = image_header(&file.path, file.content())
        .is_ok_and(|header| MIRRORED.contains(&header.orientation));
    if is_mirrored {
        return Err(unreadable(
            "stored as in a mirror, as its EXIF orientation says; save it the right way round and \
             without that tag"
                .to_owned(),
        ));
    }
    let size = [photograph.rgb.width(), photograph.rgb.height()];
    let features = detect_features(&photograph.gray, &options.features);
    let keypoints = features.keypoints.len();
    if keypoints < FEWEST_KEYPOINTS {
        return Err(NotJoined::FewFeatures { keypoints });
    }
    let colour = |position: [f64; 2]| {
        let [x, y] = [0, 1].map(|i| (position[i].max(0.0) as u32).min(size[i] - 1));
        photograph.rgb.get_pixel(x, y).0
    };
    Ok(Photo {
        path: file.path.clone(),
        size,
        metadata: PhotoMetadata::read(&file.bytes, size),
        colours: features
            .keypoints
            .iter()
            .map(|k| colour(k.position))
            .collect(),
        features,
    })
}

/// A photograph as it was read, or why it is of no use. Its bytes go from one instance of the core
/// to another.
#[derive(Clone, Debug)]
pub struct ReadPhoto(pub(super) Result<Photo, LeftOut>);

/// The form of [`ReadPhoto`] in bytes: of a photograph that is of no use its path and the number of
/// its keypoints, or why it cannot be decoded.
type Packed<P> = Result<P, (String, Result<usize, String>)>;

impl ReadPhoto {
    /// Reads a photograph.
    pub fn read(file: &InputFile, options: &OrientOptions) -> Self {
        Self(read(file, options).map_err(|reason| LeftOut {
            file: file.path.clone(),
            reason,
        }))
    }

    /// Its path.
    pub fn path(&self) -> &str {
        match &self.0 {
            Ok(photo) => &photo.path,
            Err(left) => &left.file,
        }
    }

    /// Width and height, pixels, where it is of use.
    pub fn size(&self) -> Option<[u32; 2]> {
        self.0.as_ref().ok().map(|p| p.size)
    }

    /// Number of keypoints, where it is of use.
    pub fn keypoints(&self) -> Option<usize> {
        self.0.as_ref().ok().map(|p| p.features.keypoints.len())
    }

    /// Why it is of no use, with what to do.
    pub fn problem(&self) -> Option<String> {
        self.0.as_ref().err().map(|left| left.reason.words())
    }

    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let packed: Packed<&Photo> = self.0.as_ref().map_err(|left| {
            let reason = match &left.reason {
                NotJoined::FewFeatures { keypoints } => Ok(*keypoints),
                other => Err(other.words()),
            };
            (left.file.clone(), reason)
        });
        postcard::to_stdvec(&packed).expect("bytes can be written to memory")
    }

    /// From [`Self::to_bytes`]; `None` where the bytes are something else.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let packed: Packed<Photo> = postcard::from_bytes(bytes).ok()?;
        let read = packed.map_err(|(file, reason)| LeftOut {
            file,
            reason: match reason {
                Ok(keypoints) => NotJoined::FewFeatures { keypoints },
                Err(problem) => NotJoined::Unreadable { problem },
            },
        });
        let is_whole = |Photo {
                            features, colours, ..
                        }: &Photo| {
            let counts = [features.descriptors.len(), colours.len()];
            counts == [features.keypoints.len(); 2]
        };
        read.as_ref().map_or(true, is_whole).then_some(Self(read))
    }
}
