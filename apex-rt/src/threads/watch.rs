//! Watchdog: detects nodes that hang.

use super::pulse::Heartbeat;
use crate::{CellSender, Info, Observer, cell_message::CellMessage};
use std::{
    sync::{Condvar, Mutex, MutexGuard, PoisonError, atomic::Ordering},
    time::{Duration, Instant},
};

/// Last observation of a thread.
struct Seen {
    group: usize,
    hang: Duration,
    beats: usize,
    since: Instant,
    told: bool,
}

/// Signal that ends the watchdog, or wakes it.
#[derive(Debug, Default)]
pub struct StopSignal {
    state: Mutex<Watch>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Watch {
    over: bool,
    /// `true` if a group began to react while the watchdog slept.
    stirred: bool,
}

impl StopSignal {
    /// Ends the watchdog.
    pub fn end(&self) {
        self.state().over = true;
        self.changed.notify_all();
    }

    /// Wakes the watchdog, because a group has begun to react.
    pub fn stir(&self) {
        self.state().stirred = true;
        self.changed.notify_all();
    }

    /// Waits for `time`. Returns `true` if the watchdog was ended.
    fn is_over_within(&self, time: Duration) -> bool {
        let waited = self.changed.wait_timeout_while(self.state(), time, |watch| !watch.over);
        waited.unwrap_or_else(PoisonError::into_inner).0.over
    }

    /// Sleeps until the watchdog is woken or ended. Returns `true` if it was ended.
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

/// The threads, as the watchdog accesses them.
pub trait Watched {
    /// Wakes a group, because a token has come for it.
    fn wake(&self, group: usize);
    /// Returns `true` if all threads sleep, so that none can hang before it has woken the watchdog.
    fn may_sleep(&self) -> bool;
}

/// Runs the watchdog until it is ended; it sleeps while all threads do. Each hanging node is reported once to
/// `observer`, and to the other groups in `hung`. If the program is set to end then, the other groups end, and after
/// them the process, because a hanging thread cannot be stopped.
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
                crate::end::exit(i32::from(code), 1);
            }
            for (group, cell) in hung.iter_mut().filter(|(group, _)| *group != thread.group) {
                if cell.put(|parcel| parcel.token = Some(())) {
                    threads.wake(*group);
                }
            }
        }
    }
}
