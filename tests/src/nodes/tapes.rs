//! Sinks that all write to the same tape, so that a program may have any number of them.

use apex_rt::prelude::*;
use std::cell::RefCell;

thread_local! {
    static TAPE: RefCell<Vec<(i64, Option<i64>)>> = const { RefCell::new(Vec::new()) };
}

fn write(id: i64, value: Option<i64>) {
    TAPE.with_borrow_mut(|tape| tape.push((id, value)));
}

/// Takes all entries that were written on this thread.
pub fn take_tape() -> Vec<(i64, Option<i64>)> {
    TAPE.take()
}

/// Writes values to the tape.
#[node]
pub fn tape(x: &i64, #[param] id: i64) {
    write(id, Some(*x));
}

/// Writes values and absent values to the tape.
#[node]
pub fn tape_all(x: Option<&i64>, #[param] id: i64) {
    write(id, x.copied());
}

/// Writes values and notifications of ⊥ to the tape.
#[node]
pub struct TapeKeen {
    /// Identifier of the sink.
    #[param]
    id: i64,
}

#[node]
impl TapeKeen {
    fn process(&mut self, x: &i64) {
        write(self.id, Some(*x));
    }
    #[no_message]
    fn nothing(&mut self) {
        write(self.id, None);
    }
}
