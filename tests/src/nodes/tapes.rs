//! Sinks of which a program may have any number: they all write on one tape.

use apex_rt::prelude::*;
use std::cell::RefCell;

thread_local! {
    static TAPE: RefCell<Vec<(i64, Option<i64>)>> = const { RefCell::new(Vec::new()) };
}

fn write(id: i64, value: Option<i64>) {
    TAPE.with_borrow_mut(|tape| tape.push((id, value)));
}

/// What was written on this thread since it was asked last.
pub fn take_tape() -> Vec<(i64, Option<i64>)> {
    TAPE.take()
}

/// Writes values.
#[node]
pub fn tape(x: &i64, #[param] id: i64) {
    write(id, Some(*x));
}

/// Writes values and the lack of one.
#[node]
pub fn tape_all(x: Option<&i64>, #[param] id: i64) {
    write(id, x.copied());
}

/// Writes values and the lack of one.
#[node]
pub struct TapeKeen {
    /// What it writes besides.
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
