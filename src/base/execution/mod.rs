//! How work is carried out: in parallel, with progress, divided over instances of the core.

pub mod parallel;
pub mod progress;
pub mod shard;

pub(crate) use parallel::{SILENT, map, map_part, workers};
pub(crate) use progress::{Listener, reached, with_detached_listener, with_listener};
pub(crate) use shard::{MergedShards, Origin, ShardTask, Sharded};
pub(crate) use shard::{run_merged, run_shard, sharded_map};
