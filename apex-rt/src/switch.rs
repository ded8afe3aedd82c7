//! Switch that ends the waits of threads, and the bell on which it is built.

use std::{
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, Thread, ThreadId},
};

/// Flag that stays set until [`Bell::take`], and unparks all listening threads when it is set.
#[derive(Debug, Default)]
pub(crate) struct Bell {
    rung: AtomicBool,
    listening: Mutex<Vec<Thread>>,
}

impl Bell {
    pub const fn new() -> Self {
        Self { rung: AtomicBool::new(false), listening: Mutex::new(Vec::new()) }
    }

    /// Sets the flag. A thread that already listens is unparked. A thread that begins to listen later sees the flag,
    /// because both lock the list.
    pub fn ring(&self) {
        self.rung.store(true, Ordering::Release);
        self.listening().iter().for_each(Thread::unpark);
    }

    #[inline]
    pub fn rings(&self) -> bool {
        self.rung.load(Ordering::Acquire)
    }

    /// Clears the flag. Returns `true` if it was set; everything before the call of [`Bell::ring`] is then visible.
    pub fn take(&self) -> bool {
        self.rung.swap(false, Ordering::AcqRel)
    }

    /// Registers this thread: it is unparked by [`Bell::ring`] as long as the result lives.
    pub fn listen(&self) -> Listens<'_> {
        let current = thread::current();
        let id = current.id();
        self.listening().push(current);
        Listens { bell: self, id }
    }

    fn listening(&self) -> MutexGuard<'_, Vec<Thread>> {
        self.listening.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A listening thread.
pub(crate) struct Listens<'a> {
    bell: &'a Bell,
    id: ThreadId,
}

impl Drop for Listens<'_> {
    fn drop(&mut self) {
        let mut listening = self.bell.listening();
        // A thread may listen twice.
        if let Some(own) = listening.iter().position(|thread| thread.id() == self.id) {
            listening.swap_remove(own);
        }
    }
}

/// A switch that ends programs, even while they wait. The handler of a signal or another thread turns it; it cannot be
/// turned back.
///
/// ```
/// use apex_rt::{Switch, UntilStopped, drive, prelude::*};
/// use std::thread;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() {
/// static STOP: Switch = Switch::new();
/// assert!(!STOP.is_set());
/// thread::spawn(|| STOP.set());
/// assert_eq!(drive(Blink::new(), UntilStopped::new(WallClock::new(), &STOP)), 0);
/// assert!(STOP.is_set());
/// # }
/// ```
#[derive(Debug)]
pub struct Switch(Bell);

impl Switch {
    /// Returns a switch that is not turned.
    pub const fn new() -> Self {
        Self(Bell::new())
    }

    /// Turns the switch: programs with a clock [`UntilStopped`](crate::UntilStopped) end, even while they wait.
    pub fn set(&self) {
        self.0.ring();
    }

    /// Returns `true` if the switch was turned.
    #[inline]
    pub fn is_set(&self) -> bool {
        self.0.rings()
    }

    pub(crate) fn listen(&self) -> Listens<'_> {
        self.0.listen()
    }
}

impl Default for Switch {
    fn default() -> Self {
        Self::new()
    }
}
