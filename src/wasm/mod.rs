//! The browser's door to the library.
//!
//! Invariant: `wasm_bindgen`, `js_sys` and `web_sys` are named in this folder only, and there is no
//! geometry in it: a method parses, calls one stage, converts. Elsewhere `tsify` derives the types
//! of records for the package's `.d.ts`, which costs nothing in the wasm. That file is the one
//! declaration of what the page may call and what it gets: the types of the worker's calls follow
//! from it.

mod convert;
mod figures;
mod results;
mod session;
mod sharding;
mod tiles;
mod types;

pub use figures::Picture;
pub use results::ViewImage;
pub use session::Session;
