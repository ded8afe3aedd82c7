//! The loop that drives a program on one thread.

use crate::{
    Clock, Next, Observer, Program,
    outside::Outside,
    react::{Lateness, Untaken},
};
#[cfg(feature = "std")]
use crate::{
    Ports,
    end::{Driven, is_asked},
    threads::{Pace, drive_from_threads},
};
#[cfg(not(feature = "std"))]
use crate::{Time, react::react};
#[cfg(not(feature = "std"))]
use core::time::Duration;
#[cfg(feature = "std")]
use std::sync::Arc;

/// A driven program. Its nodes stop when it is dropped.
#[cfg(not(feature = "std"))]
struct Driven<P: Program> {
    program: P,
}

#[cfg(not(feature = "std"))]
impl<P: Program> Driven<P> {
    fn new(program: P, _real: bool) -> Self {
        Self { program }
    }

    fn react<O: Observer>(&mut self, now: Time, observer: &mut O, elapsed: &mut dyn FnMut() -> Duration) -> Next {
        react(&mut self.program, now, observer, elapsed).0
    }
}

#[cfg(not(feature = "std"))]
impl<P: Program> Drop for Driven<P> {
    fn drop(&mut self) {
        self.program.stop();
    }
}

/// Returns `true` if all programs of the process are to end: without an operating system, never.
#[cfg(not(feature = "std"))]
const fn is_asked() -> bool {
    false
}

/// Drives a program with an observer for each of its thread groups: on threads if there are groups and the clock is the
/// machine's, else in turn.
#[cfg(feature = "std")]
pub(crate) fn drive_groups<P: Program, C: Clock, O: Observer + Send>(
    mut program: P,
    clock: C,
    ports: Ports<P>,
    observer: impl Fn(usize) -> O,
) -> u8 {
    match pace_of_threads::<P, C>(&clock) {
        Some(pace) => drive_from_threads(&mut program, pace, ports.0, observer),
        None => drive_ports(program, clock, &mut observer(0), ports),
    }
}

/// Returns the timing of the program's threads, if it runs on threads of its own.
#[cfg(feature = "std")]
pub(crate) fn pace_of_threads<P: Program, C: Clock>(clock: &C) -> Option<Pace> {
    clock.pace().filter(|_| !P::INFO.groups.is_empty())
}

/// Drives a program with ports on this thread.
#[cfg(feature = "std")]
pub(crate) fn drive_ports<P: Program, C: Clock, O: Observer>(
    program: P,
    clock: C,
    observer: &mut O,
    ports: Ports<P>,
) -> u8 {
    let (bell, requests) = (ports.0.bell(), Arc::clone(&ports.0.requests.shared));
    let _listens = (bell.listen(), requests.listen());
    drive_beside(program, clock, observer, ports.0)
}

/// Drives a program as [`drive`] does, with an observer. Nothing is then written to standard error, unless
/// [`StdErr`](crate::StdErr) is a part of the observer.
///
/// ```
/// use apex_rt::{Info, drive_with, prelude::*};
///
/// apex_macros::graph!("examples/blink.afg");
///
/// /// Counts the firings of each node.
/// struct Firings([u32; Blink::INFO.nodes.len()]);
///
/// impl Observer for Firings {
///     fn fired(&mut self, node: usize) {
///         self.0[node] += 1;
///     }
/// }
///
/// # fn main() {
/// const INFO: Info = Blink::INFO;
/// let mut firings = Firings([0, 0]);
/// drive_with(Blink::new(), SimClock::until(Time::from_secs(1)), (StdErr(&INFO), &mut firings));
/// assert_eq!(firings.0, [50, 0]);
/// # }
/// ```
#[inline]
pub fn drive_with<P: Program, C: Clock, O: Observer>(program: P, clock: C, mut observer: O) -> u8 {
    drive_beside(program, clock, &mut observer, ())
}

#[inline]
fn drive_beside<P: Program, C: Clock, O: Observer, W: Outside<P>>(
    program: P,
    mut clock: C,
    observer: &mut O,
    mut outside: W,
) -> u8 {
    let mut driven = Driven::new(program, !C::SIMULATED);
    outside.exchange(&mut driven.program);
    let (mut lateness, mut untaken) = (Lateness::default(), Untaken::default());
    loop {
        let now = clock.now();
        let next = driven.react(now, observer, &mut || clock.now().since(now));
        let program = &mut driven.program;
        lateness.look(next, now, observer, || clock.now().since(now));
        outside.serve(program);
        let came = outside.exchange(program);
        let looks = untaken.look(program, now, observer);
        let until = match next {
            Next::Exit(code) => return code,
            _ if came && !is_asked() => continue,
            // The time of a simulated clock does not pass while a program makes up for what is late.
            Next::At(time) if C::SIMULATED && time <= now && !is_asked() => continue,
            Next::Now => Some(now),
            Next::At(time) => Some(looks.map_or(time, |looks| looks.min(time))),
            Next::Input if C::SIMULATED || !outside.is_open() => {
                program.waiting(|connection| observer.waits(connection));
                return 0;
            }
            Next::Input => looks,
        };
        if !outside.wait(&mut clock, until) || is_asked() {
            return 0;
        }
    }
}
