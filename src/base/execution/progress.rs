//! Progress of a stage, for a progress bar.
//!
//! Stages are functions from values to values without a callback among their arguments, which
//! would run through twenty signatures without influence on any result. The caller sets a
//! [`Listener`] for the thread while a stage runs ([`with_listener`]); the long loops of the stage
//! report which fraction of its work they have done (`parallel::map_part`, [`reached`]). Without a
//! listener that costs nothing.
//!
//! Invariant: progress never influences a result.

use std::cell::RefCell;
use std::sync::Arc;

/// Receives the done fraction of a stage's work, 0 to 1 and never falling, from any thread.
pub type Listener = Arc<dyn Fn(f64) + Send + Sync>;

thread_local! {
    static LISTENER: RefCell<Option<Listener>> = const { RefCell::new(None) };
}

/// A listener that ignores all reports.
pub fn silent() -> Listener {
    Arc::new(|_| ())
}

/// Runs `work` on this thread; `listener` receives what it reports by [`reached`].
pub fn with_listener<R>(listener: Listener, work: impl FnOnce() -> R) -> R {
    let _restored = Restored(LISTENER.replace(Some(listener)));
    work()
}

/// Reports that the stage on this thread has done this fraction of its work.
pub fn reached(fraction: f64) {
    if let Some(listener) = LISTENER.with_borrow(Option::clone) {
        listener(fraction);
    }
}

/// Runs `work` with the thread's listener removed and passed as an argument, so that a map reports
/// its items but the maps inside them report nothing.
pub(crate) fn with_detached_listener<R>(work: impl FnOnce(Option<&Listener>) -> R) -> R {
    let listener = LISTENER.take();
    let _restored = Restored(listener.clone());
    work(listener.as_ref())
}

/// Restores the thread's listener, also during a panic.
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

    /// The fractions that a listener receives while `work` runs.
    pub(crate) fn fractions(work: impl FnOnce()) -> Vec<f64> {
        let received = Arc::new(Mutex::new(Vec::new()));
        let sink = Arc::clone(&received);
        with_listener(
            Arc::new(move |f| sink.lock().expect("no panic").push(f)),
            work,
        );
        received.lock().expect("no panic").clone()
    }

    #[test]
    fn a_listener_receives_its_own_work_only() {
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
