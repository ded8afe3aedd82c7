//! Silence of a node that is not active: the events of its program are not published.

use std::sync::{Mutex, PoisonError, RwLock, RwLockReadGuard};

/// Leave to publish the events of a program.
#[derive(Default)]
pub struct Voice {
    is_silent: RwLock<bool>,
    /// Functions that send the last tokens.
    last_words: Mutex<Vec<Box<dyn Fn() + Send>>>,
}

impl Voice {
    /// Returns leave to publish one token; `None` if the node is silent.
    pub fn leave(&self) -> Option<RwLockReadGuard<'_, bool>> {
        let is_silent = self.is_silent.read().unwrap_or_else(PoisonError::into_inner);
        (!*is_silent).then_some(is_silent)
    }

    /// Calls `say` when the node falls silent.
    pub fn at_silence(&self, say: impl Fn() + Send + 'static) {
        self.last_words.lock().unwrap_or_else(PoisonError::into_inner).push(Box::new(say));
    }

    /// Lets the node publish, or not. Nothing comes after its last words.
    pub fn set_silent(&self, is_silent: bool) {
        let was_silent =
            std::mem::replace(&mut *self.is_silent.write().unwrap_or_else(PoisonError::into_inner), is_silent);
        if is_silent && !was_silent {
            self.last_words.lock().unwrap_or_else(PoisonError::into_inner).iter().for_each(|say| say());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{
        Arc,
        atomic::{AtomicU32, Ordering},
    };

    #[test]
    fn last_words_are_said_once() {
        let (voice, said) = (Voice::default(), Arc::new(AtomicU32::new(0)));
        let count = Arc::clone(&said);
        voice.at_silence(move || {
            count.fetch_add(1, Ordering::Relaxed);
        });
        assert!(voice.leave().is_some());
        for silent in [true, true, false, true] {
            voice.set_silent(silent);
        }
        assert_eq!((said.load(Ordering::Relaxed), voice.leave().is_some()), (2, false));
    }
}
