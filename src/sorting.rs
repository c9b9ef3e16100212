//! Stable sorting, compiled once.
//!
//! The standard library's sorts are compiled anew for every type and every order, about 7 kB of
//! wasm each; with some hundred of them they were a fifth of the page's download. Here the order of
//! the indices is sorted, by one sort for all. That costs an indirect call a comparison: not for
//! the innermost loops.

use std::cmp::Ordering;

/// As the slice's own `sort_by`.
pub(crate) fn sort_by<T>(items: &mut [T], mut compare: impl FnMut(&T, &T) -> Ordering) {
    let view: &[T] = items;
    let mut order: Vec<u32> = (0..view.len() as u32).collect();
    sort_indices(&mut order, &mut |a, b| {
        compare(&view[a as usize], &view[b as usize])
    });
    arrange(items, order);
}

/// As the slice's own `sort_by_key`.
pub(crate) fn sort_by_key<T, K: Ord>(items: &mut [T], mut key: impl FnMut(&T) -> K) {
    sort_by(items, |a, b| key(a).cmp(&key(b)));
}

/// The only sort that is compiled.
#[inline(never)]
fn sort_indices(order: &mut [u32], compare: &mut dyn FnMut(u32, u32) -> Ordering) {
    order.sort_by(|&a, &b| compare(a, b));
}

/// Puts item `order[k]` at place `k`.
fn arrange<T>(items: &mut [T], mut order: Vec<u32>) {
    for start in 0..order.len() {
        let mut at = start;
        loop {
            let from = order[at] as usize;
            // What is in its place names itself.
            order[at] = at as u32;
            if from == start || from == at {
                break;
            }
            items.swap(at, from);
            at = from;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sorts_as_the_standard_library_does(items in prop::collection::vec((0u8..9, 0u32..1000), 0..80)) {
            let (mut own, mut standard) = (items.clone(), items);
            sort_by(&mut own, |a, b| b.0.cmp(&a.0));
            standard.sort_by_key(|b| std::cmp::Reverse(b.0));
            prop_assert_eq!(&own, &standard);
            sort_by_key(&mut own, |a| a.1);
            standard.sort_by_key(|a| a.1);
            prop_assert_eq!(own, standard);
        }
    }
}
