//! Sleep of thread groups. When all of them are idle, nothing can happen any more.

use crate::sync::{AtomicBool, AtomicU8, AtomicUsize, Ordering};

/// The group reacts.
const RUNNING: u8 = 0;
/// The group was woken: there is something to react to.
const WOKEN: u8 = 1;
/// The group sleeps until some time, or until it is woken.
const WAITING: u8 = 2;
/// The group sleeps until it is woken.
const IDLE: u8 = 3;

/// Sleep states of all groups.
#[derive(Debug)]
pub struct Shared<T> {
    groups: Box<[Sleeper<T>]>,
    /// Number of groups that are not idle.
    busy: AtomicUsize,
    stopped: AtomicBool,
    /// `true` if the watchdog sleeps until a group begins to react.
    watch_sleeps: AtomicBool,
}

#[derive(Debug)]
struct Sleeper<T> {
    state: AtomicU8,
    thread: T,
}

/// A thread that can sleep and be woken by other threads.
pub trait Alarm {
    /// Ends the sleep of the thread. If it does not sleep, its next sleep ends at once.
    fn ring(&self);
}

impl<T: Alarm> Shared<T> {
    /// Returns the state in which all groups run.
    pub fn new(threads: impl IntoIterator<Item = T>) -> Self {
        let group = |thread| Sleeper { state: AtomicU8::new(RUNNING), thread };
        let groups: Box<[Sleeper<T>]> = threads.into_iter().map(group).collect();
        let (busy, stopped) = (AtomicUsize::new(groups.len()), AtomicBool::new(false));
        Self { groups, busy, stopped, watch_sleeps: AtomicBool::new(false) }
    }

    /// Returns the alarm of a group.
    pub fn alarm(&self, group: usize) -> &T {
        &self.groups[group].thread
    }

    /// Wakes group `group`, because there is something to react to.
    pub fn wake(&self, group: usize) {
        let Sleeper { state, thread } = &self.groups[group];
        let mut seen = state.load(Ordering::Acquire);
        loop {
            // The group counts as busy before it can notice that it is woken. Otherwise it could be idle again before
            // it is counted, as the last one, and stop the program.
            if seen == IDLE {
                self.busy.fetch_add(1, Ordering::AcqRel);
            }
            match state.compare_exchange(seen, WOKEN, Ordering::AcqRel, Ordering::Acquire) {
                Ok(WAITING | IDLE) => return thread.ring(),
                Ok(_) => return,
                Err(now) => {
                    if seen == IDLE {
                        self.leave();
                    }
                    seen = now;
                }
            }
        }
    }

    /// Decrements the number of busy groups. If it was the last one, the program stops.
    fn leave(&self) {
        if self.busy.fetch_sub(1, Ordering::AcqRel) == 1 {
            self.stop();
        }
    }

    /// Called before group `group` reacts: the reaction sees everything that happened before it was woken.
    pub fn begin(&self, group: usize) {
        self.groups[group].state.swap(RUNNING, Ordering::AcqRel);
    }

    /// Returns `true` if group `group` may sleep until some time: it was not woken since it began to react.
    pub fn may_wait(&self, group: usize) -> bool {
        self.change(group, RUNNING, WAITING)
    }

    /// Returns `true` if group `group` may sleep until it is woken: it was not woken since it began to react. If all
    /// other groups already sleep so, the program stops.
    pub fn may_idle(&self, group: usize) -> bool {
        let idle = self.change(group, RUNNING, IDLE);
        if idle {
            self.leave();
        }
        idle
    }

    /// Returns `true` if group `group` was woken since it began to react.
    pub fn is_woken(&self, group: usize) -> bool {
        self.groups[group].state.load(Ordering::Acquire) == WOKEN
    }

    /// Returns `true` if group `group` still sleeps and the program has not stopped.
    pub fn sleeps(&self, group: usize) -> bool {
        self.groups[group].state.load(Ordering::Acquire) == IDLE && !self.is_stopped()
    }

    fn change(&self, group: usize, from: u8, to: u8) -> bool {
        self.groups[group].state.compare_exchange(from, to, Ordering::AcqRel, Ordering::Acquire).is_ok()
    }

    /// Ends all groups after their current reaction.
    ///
    /// A thread sets its alarm, then changes its state when it begins to react, and then checks if the program ends.
    /// Here, `stopped` is written, then the state is changed, and then the alarm is rung. The one that changes the
    /// state last sees everything that the other wrote before.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Release);
        for Sleeper { state, thread } in &self.groups {
            state.swap(WOKEN, Ordering::AcqRel);
            thread.ring();
        }
    }

    /// Counts another thread that can wake a group as a busy group. Only a busy group may call this.
    pub fn hold(&self) {
        self.busy.fetch_add(1, Ordering::AcqRel);
    }

    /// Ends the effect of [`hold`](Self::hold).
    pub fn release(&self) {
        self.leave();
    }

    /// Returns `true` if the watchdog may sleep until a group begins to react: all groups sleep.
    ///
    /// A group that begins to react changes its state, and then checks if it has to wake the watchdog. The one that
    /// changes `watch_sleeps` last sees everything that the other did before.
    pub fn may_watch_sleep(&self) -> bool {
        self.watch_sleeps.swap(true, Ordering::AcqRel);
        let all = self.groups.iter().all(|group| matches!(group.state.load(Ordering::Acquire), WAITING | IDLE));
        if !all {
            self.watch_sleeps.store(false, Ordering::Release);
        }
        all
    }

    /// Returns `true` if a group that begins to react has to wake the watchdog.
    pub fn wakes_watch(&self) -> bool {
        self.watch_sleeps.swap(false, Ordering::AcqRel)
    }

    /// Returns `true` if the program ends.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Acquire)
    }
}
