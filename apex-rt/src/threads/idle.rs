//! Which groups sleep, and when all of them do: then nothing can happen any more.

use crate::sync::{AtomicBool, AtomicU8, AtomicUsize, Ordering};

/// It reacts.
const RUNNING: u8 = 0;
/// It was told that there is something to look at.
const WOKEN: u8 = 1;
/// It sleeps until some time, or until it is woken.
const WAITING: u8 = 2;
/// It sleeps until it is woken.
const IDLE: u8 = 3;

/// What all groups know of each other.
#[derive(Debug)]
pub struct Shared<T> {
    groups: Box<[Sleeper<T>]>,
    /// How many groups are not idle.
    busy: AtomicUsize,
    stopped: AtomicBool,
    /// Who watches over the groups sleeps until one of them begins.
    watch_sleeps: AtomicBool,
}

#[derive(Debug)]
struct Sleeper<T> {
    state: AtomicU8,
    thread: T,
}

/// How a thread sleeps, and is woken by others.
pub trait Alarm {
    /// Ends the sleep of the thread, or lets its next one end at once.
    fn ring(&self);
}

impl<T: Alarm> Shared<T> {
    /// All groups run.
    pub fn new(threads: impl IntoIterator<Item = T>) -> Self {
        let group = |thread| Sleeper { state: AtomicU8::new(RUNNING), thread };
        let groups: Box<[Sleeper<T>]> = threads.into_iter().map(group).collect();
        let (busy, stopped) = (AtomicUsize::new(groups.len()), AtomicBool::new(false));
        Self { groups, busy, stopped, watch_sleeps: AtomicBool::new(false) }
    }

    /// The alarm of a group.
    pub fn alarm(&self, group: usize) -> &T {
        &self.groups[group].thread
    }

    /// Group `group` has something to look at.
    pub fn wake(&self, group: usize) {
        let Sleeper { state, thread } = &self.groups[group];
        let mut seen = state.load(Ordering::Acquire);
        loop {
            // It counts as busy before it can know that it is: else it could be idle again before that, and be the last.
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

    /// One group fewer is busy. If it was the last one, the program stops.
    fn leave(&self) {
        if self.busy.fetch_sub(1, Ordering::AcqRel) == 1 {
            self.stop();
        }
    }

    /// Group `group` is about to react: it will see everything that it was told of.
    pub fn begin(&self, group: usize) {
        self.groups[group].state.swap(RUNNING, Ordering::AcqRel);
    }

    /// Whether group `group` may sleep until some time: it was not told of anything since it began.
    pub fn may_wait(&self, group: usize) -> bool {
        self.change(group, RUNNING, WAITING)
    }

    /// Whether group `group` may sleep until it is woken. If all others do so already, the program stops.
    pub fn may_idle(&self, group: usize) -> bool {
        let idle = self.change(group, RUNNING, IDLE);
        if idle {
            self.leave();
        }
        idle
    }

    /// Whether group `group` was told of something since it began.
    pub fn is_woken(&self, group: usize) -> bool {
        self.groups[group].state.load(Ordering::Acquire) == WOKEN
    }

    /// Whether group `group` still sleeps.
    pub fn sleeps(&self, group: usize) -> bool {
        self.groups[group].state.load(Ordering::Acquire) == IDLE && !self.is_stopped()
    }

    fn change(&self, group: usize, from: u8, to: u8) -> bool {
        self.groups[group].state.compare_exchange(from, to, Ordering::AcqRel, Ordering::Acquire).is_ok()
    }

    /// Ends all groups, as soon as they have finished what they do.
    ///
    /// A thread sets its alarm, changes its state to begin, and looks then whether the program ends. Here the end is
    /// written, the state changed, and then the alarm rung: whichever changes the state last has seen what the other
    /// wrote before.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Release);
        for Sleeper { state, thread } in &self.groups {
            state.swap(WOKEN, Ordering::AcqRel);
            thread.ring();
        }
    }

    /// Somebody else than the groups can wake one of them: that counts as a group that is not idle. Only a group that
    /// is busy may say so.
    pub fn hold(&self) {
        self.busy.fetch_add(1, Ordering::AcqRel);
    }

    /// It cannot any more.
    pub fn release(&self) {
        self.leave();
    }

    /// Whether who watches over the groups may sleep until one of them begins: all sleep.
    ///
    /// A group that begins changes its state, and then looks whether it has to wake the watch. Whichever of the two
    /// changes `watch_sleeps` last has seen what the other did before.
    pub fn may_watch_sleep(&self) -> bool {
        self.watch_sleeps.swap(true, Ordering::AcqRel);
        let all = self.groups.iter().all(|group| matches!(group.state.load(Ordering::Acquire), WAITING | IDLE));
        if !all {
            self.watch_sleeps.store(false, Ordering::Release);
        }
        all
    }

    /// Whether a group that began has to wake who watches over it.
    pub fn wakes_watch(&self) -> bool {
        self.watch_sleeps.swap(false, Ordering::AcqRel)
    }

    /// Whether the program ends.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Acquire)
    }
}
