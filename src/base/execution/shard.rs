//! Maps that several instances of the core do together, without shared memory.
//!
//! In the browser each worker has an instance of its own with the same scene, parameters and
//! earlier results. A map whose items are worth dividing is written as [`sharded_map`]. For each
//! such map of a stage
//!
//! ```text
//! run_shard   each of n instances runs the stage up to that map with a ShardTask, does every
//!             n-th item there, keeps them as bytes, and leaves the stage
//! run_merged  one instance is given the bytes of all (MergedShards), runs the stage, and takes
//!             the items from them
//! ```
//!
//! An item's value does not depend on who computes it and `postcard` keeps every bit of a float, so
//! that the result is that of one instance alone. Without a task and without shards [`sharded_map`]
//! is `parallel::map_part`.
//!
//! Invariant: a stage never goes on with a part of a map. An instance that does its shard has no
//! result to hand on: it gets [`ShardDone`], which the stage passes up with `?`. Several calls of
//! one map in a stage, none of which depends on another, are all made before the first `?`.
//!
//! Invariant: nobody takes a shard that was made for something else. Every shard says which of how
//! many instances made it, and of what ([`Origin`]); a map whose shards are not exactly those of
//! all instances, once each and of this run, is computed whole. The results of items are dealt by
//! position, so that a shard too many would give items the results of others.
//!
//! Rejected: stages in pieces (plan, shard, merge) as functions of their own. Every stage with such
//! a map would be three functions and a type for what passes between them, and four of these stages
//! have several maps.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::parallel;
use super::progress;

/// What a stage with sharded maps returns: its result, or that this instance was to do a shard
/// only.
pub type Sharded<R> = Result<R, ShardDone>;

/// The instance has done its shard of the map that it was run for; nobody needs the rest of the
/// stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardDone(());

/// What a shard is made of, in short: equal for runs of one scene and the same parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin(u64);

impl Origin {
    /// Of what is written in these bytes (FNV-1a).
    pub fn of(bytes: &[u8]) -> Self {
        let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        });
        Self(hash)
    }
}

/// Which items of which map an instance does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardTask {
    map: &'static str,
    /// The maps of the stage behind it: a stage that comes to one of them did not call the map of
    /// the task.
    later: &'static [&'static str],
    index: usize,
    of: usize,
}

impl ShardTask {
    /// The task of instance `index` of so many at one of the maps of a stage, which are in the
    /// order in which they are called; `None` where the stage has no such map, or there are not so
    /// many instances.
    pub fn new(maps: &'static [&'static str], map: &str, index: usize, of: usize) -> Option<Self> {
        let step = maps.iter().position(|one| *one == map)?;
        (index < of).then(|| Self {
            map: maps[step],
            later: &maps[step + 1..],
            index,
            of,
        })
    }
}

/// The results of sharded maps: for each map the bytes of all instances, in their order.
#[derive(Clone, Debug, Default)]
pub struct MergedShards {
    maps: BTreeMap<String, Vec<Arc<Shard>>>,
}

impl MergedShards {
    /// Adds the shard of the next instance, counted from zero, of a map. False where it is no
    /// such shard, and none of the map are kept then.
    pub fn merge(&mut self, map: &str, shard: &[u8]) -> bool {
        let instances = self.maps.entry(map.to_owned()).or_default();
        let shard: Option<Shard> = postcard::from_bytes(shard).ok();
        let next = shard.filter(|shard| {
            let is_next = shard.index == instances.len() && shard.index < shard.of;
            is_next && (instances.first()).is_none_or(|first| first.is_beside(shard))
        });
        let fits = next.is_some();
        match next {
            Some(shard) => instances.push(Arc::new(shard)),
            None => instances.clear(),
        }
        fits
    }

    /// The results of one call of a map in the order of its items; `None` unless they are all
    /// there, and made of the same.
    fn results<R: DeserializeOwned>(
        &self,
        map: &str,
        origin: Origin,
        call: usize,
        items: usize,
    ) -> Option<Vec<R>> {
        let instances = self.maps.get(map)?;
        let of = instances.len();
        let parts = instances.iter().map(|shard| {
            let is_whole = shard.of == of && shard.origin == origin;
            let calls = is_whole.then_some(&shard.calls)?;
            let call = calls.get(call).filter(|call| call.items == items)?;
            let part: Vec<R> = postcard::from_bytes(&call.results).ok()?;
            Some(part.into_iter())
        });
        let mut parts: Vec<std::vec::IntoIter<R>> = parts.collect::<Option<_>>()?;
        (0..items)
            .map(|i| parts.get_mut(instance_of(i, of))?.next())
            .collect()
    }
}

/// Which of the instances does an item. They run to and fro over the items, so that where two kinds
/// of items take turns (the two sides of lines) nobody gets one kind only.
fn instance_of(item: usize, of: usize) -> usize {
    let of = of.max(1);
    let place = item % of;
    match (item / of).is_multiple_of(2) {
        true => place,
        false => of - 1 - place,
    }
}

/// What one instance did of a map.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Shard {
    /// Which instance.
    index: usize,
    /// Of how many.
    of: usize,
    origin: Origin,
    calls: Vec<CallShard>,
}

impl Shard {
    /// Are these two of the same dealing?
    fn is_beside(&self, other: &Self) -> bool {
        self.of == other.of && self.origin == other.origin
    }
}

/// One call of a map, as one instance did it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct CallShard {
    /// Number of items of the whole call: a check that the instances agree.
    items: usize,
    /// The results of this instance's items.
    results: Vec<u8>,
}

/// What the sharded maps on this thread are to do.
#[derive(Default)]
struct Sharding {
    origin: Origin,
    merged: MergedShards,
    task: Option<ShardTask>,
    /// How often each map was called.
    called: BTreeMap<String, usize>,
    done: Vec<CallShard>,
}

thread_local! {
    static SHARDING: RefCell<Option<Sharding>> = const { RefCell::new(None) };
}

/// Runs a stage on this thread, whose maps take the merged results where there are any of this
/// origin.
pub fn run_merged<R>(
    origin: Origin,
    merged: MergedShards,
    stage: impl FnOnce() -> Sharded<R>,
) -> R {
    let sharding = Sharding {
        origin,
        merged,
        ..Sharding::default()
    };
    let (result, _) = sharded(sharding, stage);
    result.expect("a map ends a stage only where there is a task")
}

/// Runs a stage on this thread up to the map of the task, with the merged results of the maps
/// before it; the shard of the task. No calls are in it where the stage does not come to that map.
pub fn run_shard<R>(
    task: ShardTask,
    origin: Origin,
    merged: MergedShards,
    stage: impl FnOnce() -> Sharded<R>,
) -> Vec<u8> {
    let (index, of) = (task.index, task.of);
    let sharding = Sharding {
        origin,
        merged,
        task: Some(task),
        ..Sharding::default()
    };
    let (_, calls) = sharded(sharding, stage);
    let shard = Shard {
        index,
        of,
        origin,
        calls,
    };
    postcard::to_stdvec(&shard).expect("bytes can be written to memory")
}

fn sharded<R>(sharding: Sharding, stage: impl FnOnce() -> R) -> (R, Vec<CallShard>) {
    let before = SHARDING.replace(Some(sharding));
    let result = stage();
    let sharding = SHARDING.replace(before);
    (result, sharding.map(|s| s.done).unwrap_or_default())
}

/// `parallel::map_part` that instances may divide; `name` is the map's own in its stage. No sharded
/// maps inside `f`.
pub fn sharded_map<T: Sync, R: Send + Serialize + DeserializeOwned>(
    name: &str,
    items: &[T],
    part: Range<f64>,
    f: impl Fn(usize, &T) -> R + Sync,
) -> Sharded<Vec<R>> {
    match role(name, items.len()) {
        Role::Whole => Ok(parallel::map_part(items, part, f)),
        Role::Merged(results) => {
            if !part.is_empty() {
                progress::reached(part.end);
            }
            Ok(results)
        }
        Role::Shard(own) => {
            let results = parallel::map_part(&own, part, |_, &i| f(i, &items[i]));
            keep(items.len(), &results);
            Err(ShardDone(()))
        }
        Role::Behind => Err(ShardDone(())),
    }
}

/// What an instance is to do at a call of a map.
enum Role<R> {
    /// All items.
    Whole,
    /// Nothing: all instances together have done it.
    Merged(Vec<R>),
    /// These items.
    Shard(Vec<usize>),
    /// Nothing: the map lies behind that of the task.
    Behind,
}

fn role<R: DeserializeOwned>(name: &str, items: usize) -> Role<R> {
    SHARDING.with_borrow_mut(|sharding| {
        let Some(sharding) = sharding else {
            return Role::Whole;
        };
        let calls = sharding.called.entry(name.to_owned()).or_default();
        let call = *calls;
        *calls += 1;
        if let Some(task) = &sharding.task {
            if task.map == name {
                let own = |i: &usize| instance_of(*i, task.of) == task.index;
                return Role::Shard((0..items).filter(own).collect());
            }
            if task.later.contains(&name) {
                return Role::Behind;
            }
        }
        match sharding.merged.results(name, sharding.origin, call, items) {
            Some(results) => Role::Merged(results),
            None => Role::Whole,
        }
    })
}

/// Keeps what this instance found.
fn keep<R: Serialize>(items: usize, results: &[R]) {
    let results = postcard::to_stdvec(results).expect("results can be written to memory");
    SHARDING.with_borrow_mut(|sharding| {
        if let Some(sharding) = sharding {
            sharding.done.push(CallShard { items, results });
        }
    });
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    const MAPS: &[&str] = &["halves", "roots"];
    const HERE: Origin = Origin(1);

    /// Two maps, the second of which is called twice and works on what the first found. An empty
    /// list of items would be out of bounds.
    fn stage(counted: &AtomicUsize) -> Sharded<Vec<f64>> {
        let count = |x: f64| {
            counted.fetch_add(1, Ordering::Relaxed);
            x
        };
        let items: Vec<u32> = (0..11).collect();
        let halves = sharded_map("halves", &items, 0.0..0.5, |i, n| {
            count(f64::from(*n) / 3.0 + i as f64)
        })?;
        let (first, others) = (&halves[..4], &halves[4..]);
        let first = sharded_map("roots", first, 0.5..0.7, |_, x| count(x.sqrt()));
        let others = sharded_map("roots", others, 0.7..1.0, |_, x| count(x.sqrt()));
        Ok([first?, others?].concat())
    }

    fn divided(of: usize) -> (Vec<f64>, usize) {
        let mut merged = MergedShards::default();
        for map in MAPS {
            let counted = AtomicUsize::new(0);
            let shards: Vec<Vec<u8>> = (0..of)
                .map(|k| ShardTask::new(MAPS, map, k, of).unwrap())
                .map(|task| run_shard(task, HERE, merged.clone(), || stage(&counted)))
                .collect();
            // Nobody does another map than this one.
            assert_eq!(counted.into_inner(), 11);
            assert!(shards.iter().all(|bytes| merged.merge(map, bytes)));
        }
        let counted = AtomicUsize::new(0);
        let result = run_merged(HERE, merged, || stage(&counted));
        (result, counted.into_inner())
    }

    #[test]
    fn shards_of_many_make_the_result_of_one() {
        let counted = AtomicUsize::new(0);
        let whole = stage(&counted).unwrap();
        assert_eq!(counted.into_inner(), 22);
        for of in [1, 2, 3, 20] {
            assert_eq!(divided(of), (whole.clone(), 0), "{of} instances");
        }
    }

    #[test]
    fn a_stage_ends_at_its_shard_or_where_it_has_passed_the_map() {
        let task = |map| ShardTask::new(&["heights", "halves", "roots"], map, 0, 2).unwrap();
        let mut went_on = false;
        let mut run = |task| {
            let counted = AtomicUsize::new(0);
            run_shard(task, HERE, MergedShards::default(), || {
                let result = stage(&counted);
                went_on |= result.is_ok();
                result
            });
            counted.into_inner()
        };
        // Of items 0 to 10, dealt to and fro: 0, 3, 4, 7 and 8.
        assert_eq!(run(task("halves")), 5);
        assert_eq!(run(task("heights")), 0, "a map that this run does not need");
        assert!(!went_on);
        assert_eq!(ShardTask::new(MAPS, "thirds", 0, 1), None);
        assert_eq!(ShardTask::new(MAPS, "roots", 1, 1), None);
    }

    #[test]
    fn everybody_gets_items_of_both_kinds() {
        for of in 1..5 {
            let mut dealt = vec![[0; 2]; of];
            (0..8 * of).for_each(|i| dealt[instance_of(i, of)][i % 2] += 1);
            let is_fair = |[a, b]: &[i32; 2]| a + b == 8 && (of > 2 || a == b);
            assert!(dealt.iter().all(is_fair), "{of} {dealt:?}");
        }
    }

    #[test]
    fn what_does_not_fit_is_computed() {
        let mut merged = MergedShards::default();
        assert!(!merged.merge("halves", &[255; 3]));
        let task = ShardTask::new(MAPS, "halves", 0, 1).unwrap();
        let foreign = run_shard(task, HERE, MergedShards::default(), || {
            sharded_map("halves", &[1.0, 2.0], 0.0..1.0, |_, x| *x)
        });
        assert!(merged.merge("halves", &foreign));
        let counted = AtomicUsize::new(0);
        run_merged(HERE, merged, || stage(&counted));
        assert_eq!(counted.into_inner(), 22);
    }

    /// The shards of map "halves" by so many instances.
    fn halves(of: usize, origin: Origin) -> Vec<Vec<u8>> {
        let tasks = (0..of).map(|k| ShardTask::new(MAPS, "halves", k, of).unwrap());
        let counted = AtomicUsize::new(0);
        let none = MergedShards::default;
        tasks
            .map(|task| run_shard(task, origin, none(), || stage(&counted)))
            .collect()
    }

    #[test]
    fn shards_that_came_twice_give_no_item_the_result_of_another() {
        let whole = stage(&AtomicUsize::new(0)).unwrap();
        let dealt = halves(2, HERE);
        let elsewhere = halves(2, Origin::of(b"another scene"));
        let of_three = halves(3, HERE);
        let mixtures: [&[&Vec<u8>]; 6] = [
            &[&dealt[0], &dealt[1], &dealt[0], &dealt[1]],
            &[&dealt[0], &dealt[0], &dealt[1], &dealt[1]],
            &[&dealt[1], &dealt[0]],
            &[&dealt[0]],
            &[&dealt[0], &of_three[1]],
            &[&elsewhere[0], &elsewhere[1]],
        ];
        for (k, mixture) in mixtures.into_iter().enumerate() {
            let mut merged = MergedShards::default();
            for shard in mixture {
                merged.merge("halves", shard);
            }
            let counted = AtomicUsize::new(0);
            let result = run_merged(HERE, merged, || stage(&counted));
            assert_eq!(result, whole, "mixture {k}");
        }
    }

    #[test]
    fn a_shard_that_is_not_the_next_is_refused() {
        let dealt = halves(2, HERE);
        let mut merged = MergedShards::default();
        assert!(merged.merge("halves", &dealt[0]));
        assert!(!merged.merge("halves", &dealt[0]), "the same again");
        assert!(!merged.merge("halves", &dealt[1]), "not the first");
        assert!(merged.merge("halves", &dealt[0]));
        assert!(!merged.merge("halves", &halves(2, Origin::of(b"another scene"))[1]));
    }
}
