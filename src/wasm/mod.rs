//! The browser's door to the library.
//!
//! Invariant: `wasm_bindgen`, `js_sys` and `web_sys` are named in this folder only, and there is no
//! geometry in it: a method parses, calls one stage, converts.

mod convert;
mod figures;
mod results;
mod session;
mod sharing;
mod tiles;

pub use figures::Picture;
pub use results::ViewImage;
pub use session::Session;
