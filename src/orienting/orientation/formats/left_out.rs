//! Images whose camera cannot be read, while those of other images can.
//!
//! A file may hold more cameras than the scene has images: a lens of an unknown model does harm
//! only where nothing else is left.

use crate::base::error::{Error, Result, listed};
use crate::orienting::orientation::image_orientation::Orientation;

/// Images that are left out, with the reason of the first.
#[derive(Default)]
pub(crate) struct LeftOut {
    first: Option<Error>,
    images: Vec<String>,
}

impl LeftOut {
    /// Leaves an image out.
    pub(crate) fn add(&mut self, image: &str, reason: &Error) {
        self.first.get_or_insert_with(|| reason.clone());
        self.images.push(image.to_owned());
    }

    /// What was read, with a warning that names the others; their refusal where nothing was read.
    pub(crate) fn finish(
        self,
        found: Vec<Orientation>,
        warnings: &mut Vec<String>,
    ) -> Result<Vec<Orientation>> {
        match self.first {
            None => Ok(found),
            Some(reason) if found.is_empty() => Err(reason),
            Some(reason) => {
                warnings.push(format!("{reason}; left out: {}", listed(&self.images)));
                Ok(found)
            }
        }
    }
}
