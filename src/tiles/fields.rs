//! What the bytes of a part hold beyond what its types write by themselves.

/// Candidates with the windows of their facets, which the page is not sent.
pub(super) mod candidates {
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::base::evidence::{Candidates, JudgedFacet, WindowCounts};

    pub(crate) fn serialize<S: Serializer>(all: &Candidates, to: S) -> Result<S::Ok, S::Error> {
        let windows: Vec<&WindowCounts> = (all.facets.iter().chain(&all.rectangles))
            .map(|facet| &facet.windows)
            .collect();
        (all, windows).serialize(to)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Candidates, D::Error> {
        let (mut all, windows) = <(Candidates, Vec<WindowCounts>)>::deserialize(from)?;
        let facets: Vec<&mut JudgedFacet> =
            (all.facets.iter_mut().chain(&mut all.rectangles)).collect();
        if facets.len() != windows.len() {
            return Err(D::Error::custom("each facet has its windows"));
        }
        for (facet, windows) in facets.into_iter().zip(windows) {
            facet.windows = windows;
        }
        Ok(all)
    }
}

/// Textures with the pixels of their atlas.
pub(super) mod textured {
    use image::RgbImage;
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::results::texture::{FaceTexture, TexturedModel};

    pub(crate) fn serialize<S: Serializer>(all: &TexturedModel, to: S) -> Result<S::Ok, S::Error> {
        (all.atlas.dimensions(), all.atlas.as_raw(), &all.faces).serialize(to)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<TexturedModel, D::Error> {
        type Fields = ((u32, u32), Vec<u8>, Vec<Vec<FaceTexture>>);
        let ((width, height), pixels, faces) = Fields::deserialize(from)?;
        let atlas = RgbImage::from_raw(width, height, pixels)
            .ok_or_else(|| D::Error::custom("an atlas has all its pixels"))?;
        Ok(TexturedModel { atlas, faces })
    }
}
