//! Maps that several instances of the core do together, without shared memory.
//!
//! In the browser each worker has an instance of its own with the same scene, parameters and earlier results. A
//! map whose items are worth dealing out is written as [`map_shared`]. For each such map of a stage
//!
//! ```text
//! share    every instance of n runs the stage with a Task: at the map it does the items that are dealt to it (one
//!          of every n), keeps them as bytes, and the map returns nothing; what the stage makes of nothing is thrown away
//! run      one instance is given the bytes of all (Known), runs the stage, and takes the items from them
//! ```
//!
//! An item's value does not depend on who computes it and `postcard` keeps every bit of a float, so that the result
//! is that of one instance alone. Where nobody deals, [`map_shared`] is `parallel::map_part`.
//!
//! A stage must therefore take no results for few results, quickly; and a map of the same name may be called several
//! times in a stage only if the later calls do not depend on the earlier ones.
//!
//! Rejected: stages in pieces (plan, shard, merge) as functions of their own. Every stage with such a map would be three functions
//! and a type for what passes between them, and four of these stages have several maps.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::parallel;
use super::progress;

/// Which items of which map an instance does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Task {
    /// The name of the map.
    pub map: String,
    /// Which instance this is ...
    pub index: usize,
    /// ... of how many.
    pub of: usize,
}

/// The results of shared maps: for each map the bytes of all instances, in their order.
#[derive(Clone, Debug, Default)]
pub struct Known {
    maps: BTreeMap<String, Vec<Arc<Vec<Call>>>>,
}

impl Known {
    /// Adds what the next instance, counted from zero, found for a map. False where these are no such bytes.
    pub fn add(&mut self, map: &str, share: &[u8]) -> bool {
        let calls: Option<Vec<Call>> = postcard::from_bytes(share).ok();
        let is_share = calls.is_some();
        let instances = self.maps.entry(map.to_owned()).or_default();
        instances.extend(calls.map(Arc::new));
        is_share
    }

    /// Nothing is known?
    pub fn is_empty(&self) -> bool {
        self.maps.is_empty()
    }

    /// The results of one call of a map in the order of its items; `None` unless they are all there.
    fn results<R: DeserializeOwned>(&self, map: &str, call: usize, items: usize) -> Option<Vec<R>> {
        let instances = self.maps.get(map)?;
        let parts = instances.iter().map(|calls| {
            let call = calls.get(call).filter(|call| call.items == items)?;
            let part: Vec<R> = postcard::from_bytes(&call.results).ok()?;
            Some(part.into_iter())
        });
        let mut parts: Vec<std::vec::IntoIter<R>> = parts.collect::<Option<_>>()?;
        let of = parts.len();
        (0..items)
            .map(|i| parts.get_mut(dealt_to(i, of))?.next())
            .collect()
    }
}

/// Which of the instances does an item. They are dealt to and fro, so that where two kinds of items take turns (the two
/// sides of lines) nobody gets one kind only.
fn dealt_to(item: usize, of: usize) -> usize {
    let of = of.max(1);
    let place = item % of;
    match (item / of).is_multiple_of(2) {
        true => place,
        false => of - 1 - place,
    }
}

/// One call of a map, as one instance did it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Call {
    /// Number of items of the whole call: a check that the instances agree.
    items: usize,
    /// The results of this instance's items.
    results: Vec<u8>,
}

/// What the shared maps on this thread are to do.
#[derive(Default)]
struct Dealing {
    known: Known,
    task: Option<Task>,
    /// How often each map was called.
    called: BTreeMap<String, usize>,
    done: Vec<Call>,
}

thread_local! {
    static DEALING: RefCell<Option<Dealing>> = const { RefCell::new(None) };
}

/// Runs `work` on this thread, whose shared maps take what is known.
pub fn with_known<R>(known: Known, work: impl FnOnce() -> R) -> R {
    dealt(known, None, work).0
}

/// Runs `work` on this thread for the share of one map in it, with what is known of the maps before. What `work`
/// returns is worth nothing.
pub fn share(task: Task, known: Known, work: impl FnOnce()) -> Vec<u8> {
    let done = dealt(known, Some(task), work).1;
    postcard::to_stdvec(&done).expect("bytes can be written to memory")
}

fn dealt<R>(known: Known, task: Option<Task>, work: impl FnOnce() -> R) -> (R, Vec<Call>) {
    let dealing = Dealing {
        known,
        task,
        ..Dealing::default()
    };
    let before = DEALING.replace(Some(dealing));
    let result = work();
    let dealing = DEALING.replace(before);
    (result, dealing.map(|d| d.done).unwrap_or_default())
}

/// `parallel::map_part` that instances may share; `name` is the map's own in its stage. No shared maps inside `f`.
pub fn map_shared<T: Sync, R: Send + Serialize + DeserializeOwned>(
    name: &str,
    items: &[T],
    part: Range<f64>,
    f: impl Fn(usize, &T) -> R + Sync,
) -> Vec<R> {
    match turn(name, items.len()) {
        Turn::Alone => parallel::map_part(items, part, f),
        Turn::Known(results) => {
            if !part.is_empty() {
                progress::reached(part.end);
            }
            results
        }
        Turn::Skipped => Vec::new(),
        Turn::Share(mine) => {
            let results = parallel::map_part(&mine, part, |_, &i| f(i, &items[i]));
            hand_in(items.len(), &results);
            Vec::new()
        }
    }
}

/// Whose turn it is at a call of a map.
enum Turn<R> {
    /// Nobody shares it.
    Alone,
    /// Everybody has done it.
    Known(Vec<R>),
    /// This instance does these items.
    Share(Vec<usize>),
    /// Its results would be thrown away.
    Skipped,
}

fn turn<R: DeserializeOwned>(name: &str, items: usize) -> Turn<R> {
    DEALING.with_borrow_mut(|dealing| {
        let Some(dealing) = dealing else {
            return Turn::Alone;
        };
        let call = dealing.called.entry(name.to_owned()).or_default();
        let this = *call;
        *call += 1;
        if let Some(task) = dealing.task.as_ref().filter(|task| task.map == name) {
            let mine = |i: &usize| dealt_to(*i, task.of) == task.index;
            return Turn::Share((0..items).filter(mine).collect());
        }
        match dealing.known.results(name, this, items) {
            Some(results) => Turn::Known(results),
            // Behind the map of the task nothing matters any more.
            None if dealing.task.is_some() => Turn::Skipped,
            None => Turn::Alone,
        }
    })
}

/// Keeps what this instance found.
fn hand_in<R: Serialize>(items: usize, results: &[R]) {
    let results = postcard::to_stdvec(results).expect("results can be written to memory");
    DEALING.with_borrow_mut(|dealing| {
        if let Some(dealing) = dealing {
            dealing.done.push(Call { items, results });
        }
    });
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Two maps, the second of which works on what the first found.
    fn stage(counted: &AtomicUsize) -> Vec<f64> {
        let count = |x: f64| {
            counted.fetch_add(1, Ordering::Relaxed);
            x
        };
        let items: Vec<u32> = (0..11).collect();
        let halves = map_shared("halves", &items, 0.0..0.5, |i, n| {
            count(f64::from(*n) / 3.0 + i as f64)
        });
        map_shared("roots", &halves, 0.5..1.0, |_, x| count(x.sqrt()))
    }

    fn shared(of: usize) -> (Vec<f64>, usize) {
        let mut known = Known::default();
        for map in ["halves", "roots"] {
            let task = |index| Task {
                map: map.to_owned(),
                index,
                of,
            };
            let counted = AtomicUsize::new(0);
            let shares: Vec<Vec<u8>> = (0..of)
                .map(|k| share(task(k), known.clone(), || drop(stage(&counted))))
                .collect();
            // Nobody does another map than this one.
            assert_eq!(counted.into_inner(), 11);
            assert!(shares.iter().all(|bytes| known.add(map, bytes)));
        }
        let counted = AtomicUsize::new(0);
        let result = with_known(known, || stage(&counted));
        (result, counted.into_inner())
    }

    #[test]
    fn shares_of_many_make_the_result_of_one() {
        let counted = AtomicUsize::new(0);
        let alone = stage(&counted);
        assert_eq!(counted.into_inner(), 22);
        for of in [1, 2, 3, 20] {
            assert_eq!(shared(of), (alone.clone(), 0), "{of} instances");
        }
    }

    #[test]
    fn everybody_gets_items_of_both_kinds() {
        for of in 1..5 {
            let mut dealt = vec![[0; 2]; of];
            (0..8 * of).for_each(|i| dealt[dealt_to(i, of)][i % 2] += 1);
            let is_fair = |[a, b]: &[i32; 2]| a + b == 8 && (of > 2 || a == b);
            assert!(dealt.iter().all(is_fair), "{of} {dealt:?}");
        }
    }

    #[test]
    fn what_does_not_fit_is_computed() {
        let mut known = Known::default();
        assert!(!known.add("halves", &[255; 3]));
        let foreign = share(
            Task {
                map: "halves".to_owned(),
                index: 0,
                of: 1,
            },
            Known::default(),
            || drop(map_shared("halves", &[1.0, 2.0], 0.0..1.0, |_, x| *x)),
        );
        assert!(known.add("halves", &foreign));
        let counted = AtomicUsize::new(0);
        with_known(known, || stage(&counted));
        assert_eq!(counted.into_inner(), 22);
    }
}
