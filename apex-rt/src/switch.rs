//! What ends the wait of a thread: a switch that others turn, and the bell that is behind it.

use std::{
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, Thread, ThreadId},
};

/// Rings until somebody takes note of it, and unparks all threads that listen.
#[derive(Debug, Default)]
pub(crate) struct Bell {
    rung: AtomicBool,
    listening: Mutex<Vec<Thread>>,
}

impl Bell {
    pub const fn new() -> Self {
        Self { rung: AtomicBool::new(false), listening: Mutex::new(Vec::new()) }
    }

    /// Rings. A thread that began to listen before is unparked; one that begins later sees that it rang, because both
    /// lock the list.
    pub fn ring(&self) {
        self.rung.store(true, Ordering::Release);
        self.listening().iter().for_each(Thread::unpark);
    }

    pub fn rings(&self) -> bool {
        self.rung.load(Ordering::Acquire)
    }

    /// Whether it rang since this was asked last. What was done before it was rung is seen then.
    pub fn take(&self) -> bool {
        self.rung.swap(false, Ordering::AcqRel)
    }

    /// This thread is unparked when it rings, as long as the result lives.
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

/// A thread that listens.
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

/// A switch that ends programs, whatever they wait for: it is turned by the handler of a signal or by another thread,
/// and stays as it is.
#[derive(Debug)]
pub struct Switch(Bell);

impl Switch {
    /// A switch that was not turned.
    pub const fn new() -> Self {
        Self(Bell::new())
    }

    /// Turns it: whoever waits with a clock [`UntilStopped`](crate::UntilStopped) wakes up and ends.
    pub fn set(&self) {
        self.0.ring();
    }

    /// Whether it was turned.
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
