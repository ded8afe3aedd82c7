//! The end of a process that drives programs: one path for all causes.
//!
//! Signals, a hanging node and the end of a program lead here. Each thread group leaves its loop after its present
//! reaction and calls the `#[on_stop]` methods of its nodes ([`Program::stop`]). A group that hangs cannot: the process
//! ends without it, after a time limit.

use crate::{
    Next, Observer, Program, Switch, Time,
    react::react,
    switch::Listens,
    watchdog::{self, Health},
};
use std::{
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::Duration,
};

/// Time that thread groups have to end before the process does.
const LIMIT: Duration = Duration::from_secs(1);

/// Switch that ends all programs of the process.
pub(crate) static ASKED: Switch = Switch::new();

/// Number of thread groups that are driven.
static DRIVEN: Mutex<usize> = Mutex::new(0);
/// Notified when a thread group has ended.
static ENDED: Condvar = Condvar::new();

fn driven() -> MutexGuard<'static, usize> {
    DRIVEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns `true` if all programs of the process are to end.
#[inline(always)]
pub(crate) fn is_asked() -> bool {
    ASKED.is_set()
}

/// A driven thread group or program. Its nodes stop when it is dropped, also while a panic unwinds.
pub(crate) struct Driven<P: Program> {
    /// The program.
    pub program: P,
    /// Counts for a watchdog outside of the process.
    health: Option<Arc<Health>>,
    /// Unparks the thread when the process is to end.
    _listens: Listens<'static>,
}

impl<P: Program> Driven<P> {
    /// Begins to drive a program on this thread. In `real` time a watchdog outside of the process is fed.
    pub fn new(program: P, real: bool) -> Self {
        *driven() += 1;
        let health = if real { watchdog::register() } else { None };
        Self { program, health, _listens: ASKED.listen() }
    }

    /// Executes a reaction, and tells the observer before and after it. `elapsed` returns the duration of the reaction
    /// so far.
    #[inline]
    pub fn react<O: Observer>(&mut self, now: Time, observer: &mut O, elapsed: &mut dyn FnMut() -> Duration) -> Next {
        let health = self.health.as_deref();
        health.inspect(|health| health.begin());
        let (next, is_late) = react(&mut self.program, now, observer, elapsed);
        health.inspect(|health| health.end(is_late));
        next
    }
}

impl<P: Program> Drop for Driven<P> {
    fn drop(&mut self) {
        self.program.stop();
        if self.health.take().is_some() {
            watchdog::leave();
        }
        *driven() -= 1;
        ENDED.notify_all();
    }
}

/// Ends the process with `code` as soon as all thread groups but `hanging` ones have ended, after a time limit at the
/// latest.
pub(crate) fn exit(code: i32, hanging: usize) -> ! {
    ASKED.set();
    have_ended(hanging, LIMIT);
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    unfinished.drain(..).for_each(|finish| finish());
    std::process::exit(code)
}

/// Functions that finish what a process must not leave unfinished.
static UNFINISHED: Mutex<Vec<Box<dyn Fn() + Send>>> = Mutex::new(vec![]);

/// Lets [`exit`] call `finish`, which has to be bounded in time, before the process ends: whatever the function refers
/// to may have been finished before.
#[cfg(feature = "record")]
pub(crate) fn finish_at_exit(finish: impl Fn() + Send + 'static) {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).push(Box::new(finish));
}

/// Waits until all thread groups but `hanging` ones have ended. Returns `false` if they did not within `limit`.
fn have_ended(hanging: usize, limit: Duration) -> bool {
    let waits = |driven: &mut usize| *driven > hanging;
    let waited = ENDED.wait_timeout_while(driven(), limit, waits).unwrap_or_else(PoisonError::into_inner);
    !waited.1.timed_out()
}

/// Lets the signals that end a process (SIGINT, SIGTERM, SIGHUP) end its programs, unless they have another handler.
pub(crate) fn on_signals() {
    #[cfg(feature = "ctrl-c")]
    let _ = handle_signals();
}

/// Installs the handler of the signals.
///
/// # Errors
/// The signals cannot be handled, or already have another handler.
#[cfg(feature = "ctrl-c")]
pub(crate) fn handle_signals() -> Result<(), std::string::String> {
    use std::{string::ToString as _, sync::OnceLock};
    static HANDLED: OnceLock<Result<(), std::string::String>> = OnceLock::new();
    HANDLED.get_or_init(|| ctrlc::set_handler(signalled).map_err(|error| error.to_string())).clone()
}

/// Time that a node may take to return after a signal.
#[cfg(feature = "ctrl-c")]
const PATIENCE: Duration = Duration::from_secs(3);

/// Exit code after a second signal, and if a node hangs: that of Ctrl-C in shells.
#[cfg(feature = "ctrl-c")]
const INTERRUPTED: i32 = 130;

#[cfg(feature = "ctrl-c")]
fn signalled() {
    if is_asked() {
        eprintln!("ended before all nodes have stopped: it was asked to stop a second time");
        exit(INTERRUPTED, 0);
    }
    ASKED.set();
    // The handler has to be free for a second signal.
    let waits = std::thread::Builder::new().name("apex-end".to_owned()).spawn(|| {
        if !have_ended(0, PATIENCE) {
            eprintln!("ended before all nodes have stopped: one of them hangs");
            let hanging = *driven();
            exit(INTERRUPTED, hanging);
        }
    });
    if let Err(error) = waits {
        eprintln!("a node that hangs will not be noticed: {error}");
    }
}
