//! Pulse of a thread, which the watchdog reads.

use crate::{Info, Next, Observer, Parameters, Time, observer::pass_on_others};
use core::{
    fmt::{Debug, Display},
    sync::atomic::{AtomicUsize, Ordering},
    time::Duration,
};

/// Pulse of a thread: the node that it runs, and the number of nodes that it has begun and finished. The watchdog reads
/// it periodically, so that the thread never waits nor reads a clock.
#[derive(Debug, Default)]
pub struct Heartbeat {
    /// Number of the node, from 1; 0 between nodes.
    pub(super) node: AtomicUsize,
    pub(super) beats: AtomicUsize,
}

/// Observer that updates the pulse of its thread.
pub struct WatchdogObserver<'a, O> {
    /// Observer to which all calls are passed on.
    pub observer: O,
    /// The pulse, if the thread is watched.
    pub pulse: Option<&'a Heartbeat>,
    /// Description of the program, for the node at the end of each connection.
    pub info: &'static Info,
}

impl<O> WatchdogObserver<'_, O> {
    /// Sets the node that the thread runs, by its number from 1; 0 for none.
    #[inline(always)]
    pub(crate) fn runs(&self, node: usize) {
        if let Some(pulse) = self.pulse {
            pulse.beats.store(pulse.beats.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
            pulse.node.store(node, Ordering::Relaxed);
        }
    }
}

impl<O: Observer> Observer for WatchdogObserver<'_, O> {
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        self.runs(node + 1);
        self.observer.fired(node);
    }
    #[inline(always)]
    fn handled(&mut self, connection: usize) {
        self.runs(self.info.connections[connection].to + 1);
        self.observer.handled(connection);
    }
    #[inline(always)]
    fn finished(&mut self, node: usize) {
        self.runs(0);
        self.observer.finished(node);
    }
    pass_on_others!(self, self.observer);
}
