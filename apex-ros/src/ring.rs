//! Messages between the thread of Zenoh and that of a subscription.

use std::{
    collections::VecDeque,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
};

/// Messages that wait. There is room for some of them: a new one takes the place of the oldest.
pub struct Ring<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

struct State<T> {
    waiting: VecDeque<T>,
    room: usize,
    /// `true` while the message that was taken out last is in use.
    is_busy: bool,
    is_closed: bool,
}

/// End of a ring at which messages come. When it is dropped, the other end gets no more.
pub struct Entrance<T>(Arc<Ring<T>>);

impl<T> Ring<T> {
    /// Returns a ring with room for this number of messages, at least one, and its entrance.
    pub fn new(room: usize) -> (Arc<Self>, Entrance<T>) {
        let state = State { waiting: VecDeque::new(), room: room.max(1), is_busy: false, is_closed: false };
        let ring = Arc::new(Self { state: Mutex::new(state), changed: Condvar::new() });
        (Arc::clone(&ring), Entrance(ring))
    }

    /// Waits for a message and takes it out. Returns `None` if there will be none. The one before is not in use any
    /// more.
    pub fn take(&self) -> Option<T> {
        let is_empty = |state: &mut State<T>| state.waiting.is_empty() && !state.is_closed;
        let mut state = self.state();
        state.is_busy = false;
        let mut state = self.changed.wait_while(state, is_empty).unwrap_or_else(PoisonError::into_inner);
        let message = state.waiting.pop_front();
        state.is_busy = message.is_some();
        message
    }

    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> Entrance<T> {
    /// Returns `true` if no message waits or is in use: the next one would be the first.
    pub fn is_idle(&self) -> bool {
        let state = self.0.state();
        state.waiting.is_empty() && !state.is_busy
    }

    /// Puts a message in. Returns `true` if it took the place of another one.
    pub fn put(&self, message: T) -> bool {
        let mut state = self.0.state();
        let is_full = state.waiting.len() >= state.room;
        if is_full {
            state.waiting.pop_front();
        }
        state.waiting.push_back(message);
        drop(state);
        self.0.changed.notify_one();
        is_full
    }
}

impl<T> Drop for Entrance<T> {
    fn drop(&mut self) {
        self.0.state().is_closed = true;
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn the_oldest_message_makes_room() {
        let (ring, entrance) = Ring::new(2);
        assert_eq!([1, 2, 3].map(|message| entrance.put(message)), [false, false, true]);
        assert_eq!((ring.take(), ring.take()), (Some(2), Some(3)));
    }

    #[test]
    fn it_is_idle_when_the_last_message_was_used() {
        let (ring, entrance) = Ring::new(2);
        assert!(entrance.is_idle());
        entrance.put(1);
        entrance.put(2);
        assert!(!entrance.is_idle());
        ring.take();
        ring.take();
        assert!(!entrance.is_idle(), "the second one is in use");
        let waits = thread::spawn(move || ring.take());
        while !entrance.is_idle() {
            thread::yield_now();
        }
        drop(entrance);
        assert_eq!(waits.join().ok(), Some(None));
    }

    #[test]
    fn what_waits_is_taken_before_the_end() {
        let (ring, entrance) = Ring::new(0);
        let taken = thread::spawn(move || std::iter::from_fn(|| ring.take()).collect::<Vec<_>>());
        entrance.put(7);
        while !entrance.0.state().waiting.is_empty() {
            thread::yield_now();
        }
        entrance.put(8);
        drop(entrance);
        assert_eq!(taken.join().ok(), Some(vec![7, 8]));
    }
}
