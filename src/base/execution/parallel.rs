//! Maps over lines, views and facets: rayon natively, sequential in wasm.
//!
//! The results come back in the order of the items, so that parallel work never changes the output.

use std::ops::Range;
use std::sync::Mutex;

use super::progress;

/// `f(index, item)` for every item, results in the order of the items.
#[cfg(not(target_arch = "wasm32"))]
pub fn map<T: Sync, R: Send>(items: &[T], f: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    use rayon::prelude::*;
    items
        .par_iter()
        .enumerate()
        .map(|(i, item)| f(i, item))
        .collect()
}

/// `f(index, item)` for every item, results in the order of the items.
#[cfg(target_arch = "wasm32")]
pub fn map<T: Sync, R: Send>(items: &[T], f: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    items
        .iter()
        .enumerate()
        .map(|(i, item)| f(i, item))
        .collect()
}

/// How many items of a [`map`] are worked on at a time.
#[cfg(not(target_arch = "wasm32"))]
pub fn workers() -> usize {
    rayon::current_num_threads()
}

/// How many items of a [`map`] are worked on at a time.
#[cfg(target_arch = "wasm32")]
pub fn workers() -> usize {
    1
}

/// The progress of a map that reports none.
pub const SILENT: Range<f64> = 0.0..0.0;

/// [`map`] as the part of a stage's work from fraction `part.start` to `part.end`: the stage's
/// listener is called after every item, unless the part is [`SILENT`].
pub fn map_part<T: Sync, R: Send>(
    items: &[T],
    part: Range<f64>,
    f: impl Fn(usize, &T) -> R + Sync,
) -> Vec<R> {
    if part.is_empty() {
        return map(items, f);
    }
    let results = progress::with_detached_listener(|listener| {
        let Some(listener) = listener else {
            return map(items, f);
        };
        let step = (part.end - part.start) / items.len() as f64;
        let done = Mutex::new(0u32);
        map(items, |i, item| {
            let result = f(i, item);
            // Called under the lock, so that fractions never fall.
            let mut done = done.lock().expect("a listener does not panic");
            *done += 1;
            listener(part.start + step * f64::from(*done));
            result
        })
    });
    progress::reached(part.end);
    results
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::execution::progress::tests::fractions;

    #[test]
    fn a_part_reports_rising_fractions_and_changes_no_result() {
        let items: Vec<u32> = (0..100).collect();
        // Maps inside a map report nothing.
        let work =
            |i: usize, item: &u32| map_part(&[1u32, 2], 0.0..1.0, |_, n| n * item)[1] + i as u32;
        let mut results = Vec::new();
        let reported = fractions(|| results = map_part(&items, 0.2..0.7, work));
        assert_eq!(results, map(&items, work));
        assert_eq!(reported.len(), 101);
        assert!(reported.is_sorted() && reported[0] > 0.2 && reported[0] < 0.21);
        assert_eq!(reported[100], 0.7);
        assert_eq!(
            fractions(|| drop(map_part(&[0u8; 0], 0.0..0.5, |_, _| 0))),
            [0.5]
        );
    }
}
