//! How far a stage has come: for a bar or a page, never for the result.
//!
//! Stages are functions from values to values and know of no listener. Whoever runs one lends a [`Listener`] to
//! the thread for that time ([`heard`]); the long loops of the stage say which part of its work they are
//! (`parallel::map_part`, [`reached`]). Without a listener that costs nothing.
//!
//! Rejected: a callback as an argument of every stage. It would run through twenty signatures and their tests for the
//! sake of something that has no influence on what they return.

use std::cell::RefCell;
use std::sync::Arc;

/// Hears fractions of a stage's work, 0 to 1, never falling; perhaps from other threads.
pub type Listener = Arc<dyn Fn(f64) + Send + Sync>;

thread_local! {
    static LISTENER: RefCell<Option<Listener>> = const { RefCell::new(None) };
}

/// Nobody listens.
pub fn silent() -> Listener {
    Arc::new(|_| ())
}

/// Runs `work` on this thread; `listener` hears what it says by [`reached`].
pub fn heard<R>(listener: Listener, work: impl FnOnce() -> R) -> R {
    let _restored = Restored(LISTENER.replace(Some(listener)));
    work()
}

/// Says that the stage on this thread has done this fraction of its work.
pub fn reached(fraction: f64) {
    if let Some(listener) = LISTENER.with_borrow(Option::clone) {
        listener(fraction);
    }
}

/// Runs `work` without a listener of its own, and hands it to the work instead: a map counts its items,
/// whatever maps they run inside.
pub(crate) fn counted<R>(work: impl FnOnce(Option<&Listener>) -> R) -> R {
    let listener = LISTENER.take();
    let _restored = Restored(listener.clone());
    work(listener.as_ref())
}

/// Puts the thread's listener back, also when a panic passes.
struct Restored(Option<Listener>);

impl Drop for Restored {
    fn drop(&mut self) {
        LISTENER.set(self.0.take());
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::sync::Mutex;

    use super::*;

    /// What a listener hears while `work` runs.
    pub(crate) fn fractions(work: impl FnOnce()) -> Vec<f64> {
        let heard_so_far = Arc::new(Mutex::new(Vec::new()));
        let ear = Arc::clone(&heard_so_far);
        heard(
            Arc::new(move |f| ear.lock().expect("no panic").push(f)),
            work,
        );
        heard_so_far.lock().expect("no panic").clone()
    }

    #[test]
    fn a_listener_hears_its_own_work_only() {
        let inner = RefCell::new(Vec::new());
        let outer = fractions(|| {
            reached(0.1);
            inner.replace(fractions(|| reached(0.7)));
            reached(0.2);
        });
        reached(0.9);
        assert_eq!((outer, inner.into_inner()), (vec![0.1, 0.2], vec![0.7]));
    }
}
