//! The two passes of the search for lines.

use std::ops::Range;

use crate::base::execution::SILENT;

/// One pass of the search through the segments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    First,
    Second,
}

impl Pass {
    /// The name under which instances share a map. Only maps of the first pass are shared, because
    /// the second pass depends on the results of all instances.
    pub(super) fn map_name(self, name: &'static str) -> &'static str {
        match self {
            Self::First => name,
            Self::Second => "of the second pass",
        }
    }

    /// The part of the stage's progress that a map covers: the second pass is short and reports
    /// none.
    pub(super) fn progress_part(self, part: Range<f64>) -> Range<f64> {
        match self {
            Self::First => part,
            Self::Second => SILENT,
        }
    }
}
