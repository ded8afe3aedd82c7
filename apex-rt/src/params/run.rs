//! What `apex run --params FILE --save-params FILE` does.

use super::{Parameters, load_file, save_file};
use crate::{Clock, Program, Time};
use std::{
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

/// Drives `program` as [`run`](crate::run()) does, with parameters from the file `load`; at the end they are written into
/// the file `save`.
///
/// # Errors
/// The first file cannot be loaded, and nothing is run; or the second cannot be written.
pub fn run_with_files<P: Program + Parameters, C: Clock>(
    mut program: P,
    clock: C,
    load: Option<&Path>,
    save: Option<&Path>,
) -> Result<(), String> {
    if let Some(path) = load {
        load_file(&mut program, path).map_err(|error| error.to_string())?;
    }
    crate::run(&mut program, clock);
    match save {
        Some(path) => {
            save_file(&mut program, path).map_err(|error| format!("cannot write `{}`: {error}", path.display()))
        }
        None => Ok(()),
    }
}

/// A clock that ends when a switch is set, by the handler of a signal or by another thread.
#[derive(Debug, Clone, Copy)]
pub struct UntilStopped<C> {
    clock: C,
    stopped: &'static AtomicBool,
}

/// How long it may take until the switch is noticed.
const NOTICED: Duration = Duration::from_millis(20);

impl<C: Clock> UntilStopped<C> {
    /// `clock` until `stopped` is true.
    pub const fn new(clock: C, stopped: &'static AtomicBool) -> Self {
        Self { clock, stopped }
    }
}

impl<C: Clock> Clock for UntilStopped<C> {
    fn now(&mut self) -> Time {
        self.clock.now()
    }

    fn wait_until(&mut self, time: Time) -> bool {
        loop {
            if self.stopped.load(Ordering::Relaxed) {
                return false;
            }
            let soon = self.clock.now() + NOTICED;
            if time <= soon {
                return self.clock.wait_until(time) && !self.stopped.load(Ordering::Relaxed);
            }
            if !self.clock.wait_until(soon) {
                return false;
            }
        }
    }
}
