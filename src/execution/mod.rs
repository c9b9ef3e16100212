//! execution

pub mod parallel;
pub mod progress;
pub mod shard;

pub(crate) use parallel::{SILENT, map, map_part};
pub(crate) use progress::{Listener, reached, silent};
pub(crate) use shard::{Known, Task, map_shared, share, with_known};
