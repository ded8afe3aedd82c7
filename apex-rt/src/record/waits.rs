//! Waits between thread groups in a replay, with detection of waits that cannot end.

use std::{
    hint,
    sync::{Mutex, MutexGuard, PoisonError},
    thread,
    time::Duration,
};

/// Number of checks before a group sleeps.
const SPINS: u32 = 100;
/// Sleep between two checks.
const PAUSE: Duration = Duration::from_micros(50);

/// State that the groups of a replay share.
#[derive(Debug)]
pub struct ReplayBarrier(Mutex<State>);

#[derive(Debug)]
struct State {
    groups: Vec<Group>,
    /// Number of changes of `groups`.
    changes: u64,
    /// `true` if a group has ended where the recording is cut off.
    cut: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Group {
    Runs,
    /// The group waits, and its last check in vain came after so many changes.
    ReplayBarrier(u64),
    Ended,
}

/// Result of a wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WaitOutcome {
    /// The awaited token is there, as recorded.
    Found,
    /// The awaited token cannot come any more: this run differs from the recorded one.
    Missed,
    /// The awaited token would come from a part of the run that is cut off in the recording.
    Cut,
}

impl ReplayBarrier {
    /// Returns the state in which `groups` groups run.
    pub fn new(groups: usize) -> Self {
        Self(Mutex::new(State { groups: vec![Group::Runs; groups], changes: 0, cut: false }))
    }

    /// Waits in group `group` until `finds` returns `true`, or until that cannot happen any more.
    pub fn wait(&self, group: usize, finds: &dyn Fn() -> bool) -> WaitOutcome {
        for _ in 0..SPINS {
            if finds() {
                return WaitOutcome::Found;
            }
            hint::spin_loop();
        }
        let mut seen = self.state().change(group, Group::ReplayBarrier(0));
        loop {
            if finds() {
                self.state().change(group, Group::Runs);
                return WaitOutcome::Found;
            }
            let mut state = self.state();
            // Other groups may have changed something after this group looked: then `seen` is not the last change.
            state.groups[group] = Group::ReplayBarrier(seen);
            if state.gives_up(group) {
                state.change(group, Group::Runs);
                return if state.cut { WaitOutcome::Cut } else { WaitOutcome::Missed };
            }
            seen = state.changes;
            drop(state);
            thread::sleep(PAUSE);
        }
    }

    /// Reports that group `group` has ended, and if that is because the recording is `cut` off.
    pub fn end(&self, group: usize, cut: bool) {
        let mut state = self.state();
        state.cut |= cut;
        state.change(group, Group::Ended);
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn change(&mut self, group: usize, to: Group) -> u64 {
        self.changes += 1;
        self.groups[group] = to;
        self.changes
    }

    /// Returns `true` if all groups have ended or have checked in vain since the last change, and `group` is the first
    /// of those that wait. The group that gives up is thus the same each time.
    fn gives_up(&self, group: usize) -> bool {
        let stuck = |g: &Group| matches!(*g, Group::Ended) || *g == Group::ReplayBarrier(self.changes);
        let first = self.groups.iter().position(|g| matches!(g, Group::ReplayBarrier(_)));
        first == Some(group) && self.groups.iter().all(stuck)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

    #[test]
    fn one_that_waits_for_another_finds_what_comes() {
        let (waits, there) = (ReplayBarrier::new(2), AtomicBool::new(false));
        thread::scope(|scope| {
            let waiting = scope.spawn(|| waits.wait(0, &|| there.load(Ordering::Acquire)));
            thread::sleep(Duration::from_millis(20));
            there.store(true, Ordering::Release);
            waits.end(1, false);
            assert_eq!(waiting.join().ok(), Some(WaitOutcome::Found));
        });
    }

    #[test]
    fn the_first_of_those_that_wait_in_vain_gives_up_and_others_may_go_on() {
        let (waits, there) = (ReplayBarrier::new(3), AtomicBool::new(false));
        thread::scope(|scope| {
            let second = scope.spawn(|| waits.wait(1, &|| there.load(Ordering::Acquire)));
            let first = scope.spawn(|| {
                let waited = waits.wait(0, &|| false);
                there.store(true, Ordering::Release);
                waits.end(0, false);
                waited
            });
            thread::sleep(Duration::from_millis(20));
            assert!(!first.is_finished(), "the last group still runs");
            waits.end(2, false);
            assert_eq!(first.join().ok(), Some(WaitOutcome::Missed));
            assert_eq!(second.join().ok(), Some(WaitOutcome::Found));
        });
    }

    #[test]
    fn what_would_come_after_a_cut_is_told_apart() {
        let waits = ReplayBarrier::new(2);
        waits.end(1, true);
        assert_eq!(waits.wait(0, &|| false), WaitOutcome::Cut);
    }
}
