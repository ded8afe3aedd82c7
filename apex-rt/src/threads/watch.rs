//! Watches over threads: which node each of them is running, and since when.

use super::Parcel;
use crate::{CellSender, Info, Observer};
use std::{
    sync::{
        Condvar, Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    time::{Duration, Instant},
};

/// What a thread says of itself: the node that it runs, and how many it has run. Whoever watches reads it from time to time; the
/// thread never waits, nor looks at a clock.
#[derive(Debug, Default)]
pub struct Pulse {
    /// The number of the node, from 1; 0 between nodes.
    node: AtomicUsize,
    beats: AtomicUsize,
}

/// An observer that keeps the pulse of its thread.
pub struct Felt<'a, O> {
    /// The observer that is told all of it.
    pub observer: O,
    /// The pulse, if the thread is watched.
    pub pulse: Option<&'a Pulse>,
    /// Who takes the token on each connection.
    pub info: &'static Info,
}

impl<O> Felt<'_, O> {
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

/// Ends the watch.
#[derive(Debug, Default)]
pub struct Off {
    over: Mutex<bool>,
    changed: Condvar,
}

impl Off {
    /// The watch is over.
    pub fn end(&self) {
        *self.over.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.changed.notify_all();
    }

    /// Whether it is over within `time`.
    fn is_over_within(&self, time: Duration) -> bool {
        let over = self.over.lock().unwrap_or_else(PoisonError::into_inner);
        let (over, _) =
            self.changed.wait_timeout_while(over, time, |over| !*over).unwrap_or_else(PoisonError::into_inner);
        *over
    }
}

/// Looks at the threads that are to be watched until the watch is over. A node that hangs is told to `observer` once, and to the
/// groups that want to know; where the text says so, the process ends then, because a thread that hangs cannot be ended.
pub fn watch<O: Observer>(
    info: &'static Info,
    pulses: &[Pulse],
    off: &Off,
    mut hung: Vec<(usize, CellSender<'_, Parcel<()>>)>,
    wake: &dyn Fn(usize),
    mut observer: O,
) {
    let start = Instant::now();
    let groups = info.groups.iter().enumerate().filter_map(|(group, g)| Some((group, g.hang?)));
    let mut seen: Vec<Seen> =
        groups.map(|(group, hang)| Seen { group, hang, beats: 0, since: start, told: false }).collect();
    let Some(shortest) = seen.iter().map(|s| s.hang).min() else { return };
    let pause = (shortest / 4).clamp(Duration::from_millis(1), Duration::from_secs(1));
    while !off.is_over_within(pause) {
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
                    wake(*group);
                }
            }
        }
    }
}
