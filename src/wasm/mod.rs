//! The browser's door to the library.
//!
//! Invariant: `wasm_bindgen`, `js_sys` and `web_sys` are named in this folder only, and there is no
//! geometry in it: a method parses, calls one stage, converts. Elsewhere `tsify` derives the types
//! of records for the package's `.d.ts`, which costs nothing in the wasm. That file is the one
//! declaration of what the page may call and what it gets: the types of the worker's calls follow
//! from it.
//!
//! There are two modules: [`Session`] reconstructs, and stands in the one that every visit fetches;
//! `Orienter` orients photographs, and stands in the one that is built without the feature
//! `reconstruction`.

#[cfg(feature = "reconstruction")]
mod arrays;
mod convert;
#[cfg(feature = "reconstruction")]
mod corrections;
#[cfg(feature = "reconstruction")]
mod figures;
#[cfg(feature = "reconstruction")]
mod files;
mod memory;
#[cfg(not(feature = "reconstruction"))]
mod orienter;
#[cfg(feature = "reconstruction")]
mod results;
#[cfg(feature = "reconstruction")]
mod session;
#[cfg(feature = "reconstruction")]
mod sharding;
#[cfg(feature = "reconstruction")]
mod tiles;
mod types;

#[cfg(feature = "reconstruction")]
pub use figures::Picture;
#[cfg(not(feature = "reconstruction"))]
pub use orienter::Orienter;
#[cfg(feature = "reconstruction")]
pub use results::ViewImage;
#[cfg(feature = "reconstruction")]
pub use session::Session;
