//! Textures for the faces of a model: the best view per face, packed into one atlas.

use crate::ids::ViewId;

/// The texture of one face of a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceTexture {
    /// The view that most of the texture comes from.
    pub view: ViewId,
    /// Per ring of the face and per corner: (u, v) in the atlas, 0 to 1, origin at its top left.
    pub uv: Vec<Vec<[f32; 2]>>,
}

/// A texture atlas and where each face lies in it.
#[derive(Clone, Debug)]
pub struct TexturedModel {
    /// The atlas, RGB.
    pub atlas: image::RgbImage,
    /// Per building and per face of its solid; `None` for a face that no view shows.
    pub faces: Vec<Vec<Option<FaceTexture>>>,
}
