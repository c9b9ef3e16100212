//! orientation::formats

pub(crate) mod bundles;
pub(crate) mod colmap;
pub(crate) mod colmap_binary;
pub(crate) mod inpho;
pub(crate) mod json;
mod lens;
pub(crate) mod matrices;
pub(crate) mod micmac;
pub(crate) mod patb;
pub(crate) mod photogrammetric;
pub(crate) mod projection;
mod text;
pub(crate) mod xml;

pub(crate) use text::{Line, data_lines};
