use std::sync::atomic::{AtomicBool, Ordering};

/// The one handle of every long call: it hears how far the work is, and may stop it.
///
/// A stopped render returns what it has, valid; a stopped build is an error, since half a hierarchy is none.
/// Called from any thread.
pub trait Progress: Sync {
    /// `done` of `total` units are finished. The unit is the call's own. Never called twice at once; a call that is
    /// still busy makes later ones be left out.
    fn update(&self, done: u64, total: u64) {
        let _ = (done, total);
    }

    /// Whether to stop as soon as possible. Asked often; must be cheap.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody is listening and nobody will stop it.
impl Progress for () {}

/// A switch that stops whatever call it was handed to.
#[derive(Debug, Default)]
pub struct CancelFlag(AtomicBool);

impl CancelFlag {
    /// Asks the work to stop. May be called from any thread and more than once.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Progress for CancelFlag {
    fn cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A source of time, handed in by whoever has one: the library itself reads no clock.
pub trait Clock: Sync {
    /// Seconds since some fixed moment; never decreasing.
    fn seconds(&self) -> f64;
}
