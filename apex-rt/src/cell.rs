//! Storage for one token between two threads. Its operations never block: each takes a few instructions, independent of
//! the other thread.
#![allow(unsafe_code)]

use crate::sync::{AtomicU8, Ordering, UnsafeCell};

/// The cell is empty: the sender may write.
const FREE: u8 = 0;
/// The cell holds a token: the receiver may read and write.
const FULL: u8 = 1;
/// The receiver took the token, but has not released it.
const TAKEN: u8 = 2;

/// A single-token cell. One thread puts a token in; another takes it out and then releases the cell, which frees it for
/// the next token.
///
/// The old token stays in the cell, so that its storage is reused.
#[derive(Debug)]
pub struct TokenCell<T> {
    state: AtomicU8,
    place: UnsafeCell<T>,
}

// SAFETY: the place is only reached through the two ends, of which there is one each (`ends` borrows the cell for as
// long as they live). The sender reaches it while the state is `FREE`, which only the sender ends; the receiver reaches
// it while the state is `FULL`, which only the receiver ends. Both end their state with `Release` and load it with
// `Acquire`.
unsafe impl<T: Send> Sync for TokenCell<T> {}

/// The sending end of a cell.
#[derive(Debug)]
pub struct CellSender<'a, T>(&'a TokenCell<T>);

/// The receiving end of a cell.
#[derive(Debug)]
pub struct CellReceiver<'a, T>(&'a TokenCell<T>);

impl<T> TokenCell<T> {
    /// Returns a cell without a token. The first token is written over `place`.
    pub fn new(place: T) -> Self {
        Self { state: AtomicU8::new(FREE), place: UnsafeCell::new(place) }
    }

    /// Returns the two ends of the cell.
    pub fn ends(&mut self) -> (CellSender<'_, T>, CellReceiver<'_, T>) {
        (CellSender(self), CellReceiver(self))
    }
}

impl<T> CellSender<'_, T> {
    /// Returns `true` if there is room for a token: the receiver has released the previous one.
    #[inline(always)]
    pub fn is_free(&self) -> bool {
        self.0.state.load(Ordering::Acquire) == FREE
    }

    /// Writes a token over the previous one. Returns `false` if there is no room.
    #[inline(always)]
    pub fn put(&mut self, write: impl FnOnce(&mut T)) -> bool {
        let free = self.is_free();
        if free {
            // SAFETY: see above; the state is `FREE`, and this is the sender.
            self.0.place.with_mut(|place| write(unsafe { &mut *place }));
            self.0.state.store(FULL, Ordering::Release);
        }
        free
    }
}

impl<T> CellReceiver<'_, T> {
    /// Returns `true` if there is a token to take.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.0.state.load(Ordering::Acquire) == FULL
    }

    /// Takes the token, if there is one. There is no room for the next one before [`release`](Self::release).
    #[inline(always)]
    pub fn take<R>(&mut self, read: impl FnOnce(&mut T) -> R) -> Option<R> {
        let full = self.is_full();
        full.then(|| {
            // SAFETY: see above; the state is `FULL`, and this is the receiver.
            let result = self.0.place.with_mut(|place| read(unsafe { &mut *place }));
            self.0.state.store(TAKEN, Ordering::Release);
            result
        })
    }

    /// Releases the cell after [`take`](Self::take).
    #[inline(always)]
    pub fn release(&mut self) {
        // Only the receiver changes the state while it is `TAKEN`.
        if self.0.state.load(Ordering::Relaxed) == TAKEN {
            self.0.state.store(FREE, Ordering::Release);
        }
    }
}
