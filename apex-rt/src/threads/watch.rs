//! Watches over threads: which node each of them is running, and since when.

use super::CellMessage;
use crate::{CellSender, Info, Observer};
use std::{
    sync::{
        Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    time::{Duration, Instant},
};

/// What a thread says of itself: the node that it runs, and how many it has run. Whoever watches reads it from time to time; the
/// thread never waits, nor looks at a clock.
#[derive(Debug, Default)]
pub struct Heartbeat {
    /// The number of the node, from 1; 0 between nodes.
    node: AtomicUsize,
    beats: AtomicUsize,
}

/// An observer that keeps the pulse of its thread.
pub struct WatchdogObserver<'a, O> {
    /// The observer that is told all of it.
    pub observer: O,
    /// The pulse, if the thread is watched.
    pub pulse: Option<&'a Heartbeat>,
    /// Who takes the token on each connection.
    pub info: &'static Info,
}

impl<O> WatchdogObserver<'_, O> {
    /// The thread runs a node, by its number from 1, or none (0).
    #[inline(always)]
    pub(crate) fn runs(&self, node: usize) {
        if let Some(pulse) = self.pulse {
            pulse.beats.store(pulse.beats.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
            pulse.node.store(node, Ordering::Relaxed);
        }
    }
}

/// One thread, as it was seen last.
struct Seen {
    group: usize,
    hang: Duration,
    beats: usize,
    since: Instant,
    told: bool,
}

/// Ends the watch, or wakes it.
#[derive(Debug, Default)]
pub struct StopSignal {
    state: Mutex<Watch>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Watch {
    over: bool,
    /// A thread began to work while the watch slept.
    stirred: bool,
}

impl StopSignal {
    /// The watch is over.
    pub fn end(&self) {
        self.state().over = true;
        self.changed.notify_all();
    }

    /// There is something to watch again.
    pub fn stir(&self) {
        self.state().stirred = true;
        self.changed.notify_all();
    }

    /// Whether it is over within `time`.
    fn is_over_within(&self, time: Duration) -> bool {
        let waited = self.changed.wait_timeout_while(self.state(), time, |watch| !watch.over);
        waited.unwrap_or_else(PoisonError::into_inner).0.over
    }

    /// Sleeps until there is something to watch; whether the watch is over.
    fn is_over_when_stirred(&self) -> bool {
        let waited = self.changed.wait_while(self.state(), |watch| !watch.over && !watch.stirred);
        let mut watch = waited.unwrap_or_else(PoisonError::into_inner);
        watch.stirred = false;
        watch.over
    }

    fn state(&self) -> MutexGuard<'_, Watch> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What the watch does with the threads: it wakes the one of a group, and asks whether it may sleep until one of them
/// begins.
pub trait Watched {
    /// Something has come for a group.
    fn wake(&self, group: usize);
    /// Whether all threads sleep, so that none can hang before it has stirred the watch.
    fn may_sleep(&self) -> bool;
}

/// Looks at the threads that are to be watched until the watch is over, and sleeps while all of them do. A node that
/// hangs is told to `observer` once, and to the groups that want to know; where the text says so, the process ends
/// then, because a thread that hangs cannot be ended.
pub fn watch<O: Observer>(
    info: &'static Info,
    pulses: &[Heartbeat],
    off: &StopSignal,
    mut hung: Vec<(usize, CellSender<'_, CellMessage<()>>)>,
    threads: &impl Watched,
    mut observer: O,
) {
    let start = Instant::now();
    let groups = info.groups.iter().enumerate().filter_map(|(group, g)| Some((group, g.hang?)));
    let mut seen: Vec<Seen> =
        groups.map(|(group, hang)| Seen { group, hang, beats: 0, since: start, told: false }).collect();
    let Some(shortest) = seen.iter().map(|s| s.hang).min() else { return };
    let pause = (shortest / 4).clamp(Duration::from_millis(1), Duration::from_secs(1));
    let is_over = || (threads.may_sleep() && off.is_over_when_stirred()) || off.is_over_within(pause);
    while !is_over() {
        for thread in &mut seen {
            let pulse = &pulses[thread.group];
            let (node, beats) = (pulse.node.load(Ordering::Relaxed), pulse.beats.load(Ordering::Relaxed));
            if node == 0 || beats != thread.beats {
                (thread.beats, thread.since, thread.told) = (beats, Instant::now(), false);
                continue;
            }
            let running = thread.since.elapsed();
            if thread.told || running < thread.hang {
                continue;
            }
            thread.told = true;
            observer.hung(node - 1, running);
            if let Some(code) = info.end_if_hung {
                std::process::exit(i32::from(code));
            }
            for (group, cell) in hung.iter_mut().filter(|(group, _)| *group != thread.group) {
                if cell.put(|parcel| parcel.token = Some(())) {
                    threads.wake(*group);
                }
            }
        }
    }
}
