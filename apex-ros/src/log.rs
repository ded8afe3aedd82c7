//! Problems of the program and of its topics, until they are published.

use std::{
    collections::VecDeque,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::Instant,
};

/// Problems that wait to be published. The oldest makes room.
#[derive(Clone, Default)]
pub struct Log(Arc<(Mutex<State>, Condvar)>);

#[derive(Default)]
struct State {
    waiting: VecDeque<String>,
    is_closed: bool,
}

/// Most problems that wait.
const ROOM: usize = 100;

impl Log {
    /// Adds a problem. Does not wait. Returns `false` if it will not be published, because the node has ended.
    pub fn add(&self, text: &str) -> bool {
        let mut state = self.state();
        if state.is_closed {
            return false;
        }
        if state.waiting.len() >= ROOM {
            state.waiting.pop_front();
        }
        state.waiting.push_back(text.to_owned());
        drop(state);
        self.0.1.notify_one();
        true
    }

    /// Ends the thread that publishes.
    pub fn close(&self) {
        self.state().is_closed = true;
        self.0.1.notify_all();
    }

    /// Waits for problems until a time. Returns them, or `None` at the end.
    pub fn take(&self, until: Instant) -> Option<VecDeque<String>> {
        let is_idle = |state: &mut State| state.waiting.is_empty() && !state.is_closed;
        let left = until.saturating_duration_since(Instant::now());
        let waited = self.0.1.wait_timeout_while(self.state(), left, is_idle);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let taken = std::mem::take(&mut state.waiting);
        (!state.is_closed).then_some(taken)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_oldest_problem_makes_room() {
        let log = Log::default();
        assert!((0..=ROOM).all(|number| log.add(&number.to_string())));
        let taken = log.take(Instant::now()).expect("problems");
        assert_eq!((taken.len(), taken.front().map(String::as_str)), (ROOM, Some("1")));
        assert_eq!(log.take(Instant::now()).map(|taken| taken.len()), Some(0));
        log.close();
        assert!(log.take(Instant::now() + Duration::from_secs(1)).is_none() && !log.add("late"));
    }
}
