//! The instance's memory: room ahead of what is needed.

use std::hint::black_box;

/// Bytes that [`grow_ahead`] has free; they cost address space until they are written.
const FREE_BYTES: usize = 64 << 20;

/// Lets the memory grow by many pages at once. Browsers take a fifth of a millisecond to grow it,
/// which the allocator asks for page by page: half a second of a stage that needs 200 MB.
pub(super) fn grow_ahead() {
    let mut room: Vec<u8> = Vec::new();
    // Where there is no more, the stage may still do with what there is.
    let _ = room.try_reserve_exact(FREE_BYTES);
    black_box(&room);
}
