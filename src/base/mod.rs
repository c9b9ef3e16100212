//! What every group stands on: numbers with the same bits everywhere, names of things, geometry,
//! parallel maps, parameters, and the one model of evidence.
//!
//! ```text
//! math          elementary functions with the same bits on every target
//! least_squares sums of squared residuals, robust, and the steps that minimise them
//! ids           newtypes of views, segments, lines, facets
//! geometry      points, segments, planes, polygons
//! line_linker   are two lines the same one
//! plan_index    boxes in plan
//! json          parameters and options from JSON
//! execution     parallel maps, shards, progress
//! evidence      what speaks for a line, a facet, a window, in nats; fitted tables
//! params        what a person may change, by stage
//! agreement     what a check of the orientation reports
//! error         refusals
//! labelling     the labelling of least energy, by alpha-expansion
//! ```

pub mod agreement;
pub(crate) mod error;
pub mod evidence;
pub mod execution;
pub mod geometry;
pub mod ids;
pub(crate) mod json;
pub(crate) mod labelling;
pub(crate) mod least_squares;
pub(crate) mod line_linker;
pub(crate) mod math;
pub mod params;
pub(crate) mod plan_index;
