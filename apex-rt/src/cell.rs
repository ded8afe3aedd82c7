//! Room for one token on its way from one thread to another. Nobody ever waits in it: every operation is a few
//! instructions, whatever the other side does.
#![allow(unsafe_code)]

use crate::sync::{AtomicU8, Ordering, UnsafeCell};

/// The sender may write.
const FREE: u8 = 0;
/// A token lies there: the receiver may read and write.
const FULL: u8 = 1;
/// The receiver took the token, and is not done with it.
const TAKEN: u8 = 2;

/// A single-token cell: one thread puts a token in, another takes it out, and says when it is done with it. Only then
/// there is room for the next one.
///
/// The place is never emptied: what was in it stays, so that its storage is used again.
#[derive(Debug)]
pub struct TokenCell<T> {
    state: AtomicU8,
    place: UnsafeCell<T>,
}

// SAFETY: the place is only reached through the two ends, of which there is one each (`ends` borrows the cell for as long as
// they live). The sender reaches it while the state is `FREE`, which only the sender ends; the receiver while it is `FULL`,
// which only the receiver ends. Both end it with `Release` and find it with `Acquire`.
unsafe impl<T: Send> Sync for TokenCell<T> {}

/// The end where tokens are put in.
#[derive(Debug)]
pub struct CellSender<'a, T>(&'a TokenCell<T>);

/// The end where tokens are taken out.
#[derive(Debug)]
pub struct CellReceiver<'a, T>(&'a TokenCell<T>);

impl<T> TokenCell<T> {
    /// A cell without a token; `place` is what the first one is written over.
    pub fn new(place: T) -> Self {
        Self { state: AtomicU8::new(FREE), place: UnsafeCell::new(place) }
    }

    /// Its two ends.
    pub fn ends(&mut self) -> (CellSender<'_, T>, CellReceiver<'_, T>) {
        (CellSender(self), CellReceiver(self))
    }
}

impl<T> CellSender<'_, T> {
    /// Whether there is room for a token: the receiver is done with the one before.
    #[inline(always)]
    pub fn is_free(&self) -> bool {
        self.0.state.load(Ordering::Acquire) == FREE
    }

    /// Writes a token over what is left of the one before; `false` if there is no room.
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
    /// Whether a token waits to be taken.
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

    /// The receiver is done with the token that it took.
    #[inline(always)]
    pub fn release(&mut self) {
        // Nobody else changes the state while it is `TAKEN`.
        if self.0.state.load(Ordering::Relaxed) == TAKEN {
            self.0.state.store(FREE, Ordering::Release);
        }
    }
}
