//! Functions that drive a program, with all that the environment variables ask for.

#[cfg(not(any(feature = "profile", feature = "record")))]
use crate::drive_with;
#[cfg(any(feature = "profile", feature = "record"))]
use crate::instruments::{Instruments, Measured, Streams, Tapped};
#[cfg(feature = "record")]
use crate::record::RunMode;
use crate::{Clock, Program};
#[cfg(feature = "std")]
use crate::{Ports, StdErr, drive::drive_groups};
#[cfg(all(feature = "std", not(any(feature = "profile", feature = "record"))))]
use crate::{drive::pace_of_threads, threads::drive_on_threads};

/// Drives `program` by `clock` until nothing can happen any more: no source will fire again, the clock ends, or a token
/// comes to `exit` or `abort`. Returns the exit code: 1 after `abort`, else 0.
///
/// No other thread can put a token into the program meanwhile, so that a program that only waits for input has ended.
/// Use [`drive_from`] for programs that get tokens from other threads.
///
/// Each thread group of a program runs on a thread of its own if the clock is the machine's ([`Clock::pace`]). In
/// simulated time the groups run in turn, so that the result is always the same.
///
/// With the feature `profile` and a file in the environment variable `APEX_PROFILE`, the trace of a
/// [`Profile`](crate::profile::Profile) is written to that file, and its table to standard error; Ctrl-C then ends the
/// program. With the feature `record`, the run is recorded in the file in the environment variable `APEX_RECORD`, or
/// else in that of the program's `record` statement. If `APEX_REPLAY` names a recording, that is replayed instead.
///
/// By the machine's clock, the signals that end a process (SIGINT, SIGTERM, SIGHUP) end the program after its present
/// reaction, unless they have another handler; a second signal ends the process within a second. However the driving
/// ends, the `#[on_stop]` methods of all nodes are called.
///
/// ```
/// use apex_macros::graph;
/// use apex_rt::{drive, prelude::*};
///
/// graph! {
///     use apex_nodes::flow::tick;
///
///     robot EggTimer {
///         node done = tick() after 4min;
///         done -> exit;
///     }
/// }
///
/// # fn main() {
/// // Four minutes of simulated time, at once. `WallClock::new()` would take four minutes.
/// assert_eq!(drive(EggTimer::new(), SimClock::until(Time::MAX)), 0);
/// # }
/// ```
pub fn drive<P: Program, C: Clock>(program: P, clock: C) -> u8 {
    #[cfg(feature = "std")]
    on_signals(&clock);
    #[cfg(any(feature = "profile", feature = "record"))]
    return drive_as_asked(program, clock, Ports::new());
    #[cfg(not(any(feature = "profile", feature = "record")))]
    drive_alone(program, clock)
}

/// Lets signals end a program that the machine's clock drives. One in simulated time may be part of a test, which ends
/// with its process.
#[cfg(feature = "std")]
fn on_signals<C: Clock>(clock: &C) {
    if clock.pace().is_some() {
        crate::end::on_signals();
    }
}

/// Drives a program with the instruments for which the environment variables ask.
#[cfg(any(feature = "profile", feature = "record"))]
fn drive_as_asked<P: Program, C: Clock>(program: P, clock: C, ports: Ports<P>) -> u8 {
    let streams = match Streams::of(C::SIMULATED, &ports) {
        Ok(streams) => streams,
        Err(error) => {
            eprintln!("error: cannot open the socket in `APEX_STUDIO`: {error}");
            return 2;
        }
    };
    #[cfg(feature = "profile")]
    if let Some(path) = std::env::var_os("APEX_PROFILE") {
        return crate::profile::drive(program, clock, ports, path.as_ref(), &streams);
    }
    #[cfg(feature = "record")]
    if let Some(mode) = RunMode::of::<P>() {
        return crate::record::drive(program, clock, ports, &mode, &streams);
    }
    drive_groups(program, clock, ports, |group| -> Instruments<'_> {
        (StdErr(const { &P::INFO }), (Measured::default(), (Tapped::default(), streams.of_group(group))))
    })
}

/// Drives a program that nothing but its clock concerns, without instruments.
#[cfg(all(feature = "std", not(any(feature = "profile", feature = "record"))))]
fn drive_alone<P: Program, C: Clock>(mut program: P, clock: C) -> u8 {
    let messages = || StdErr(const { &P::INFO });
    match pace_of_threads::<P, C>(&clock) {
        Some(pace) => drive_on_threads(&mut program, pace, |_| messages()),
        None => drive_with(program, clock, messages()),
    }
}

#[cfg(not(feature = "std"))]
fn drive_alone<P: Program, C: Clock>(program: P, clock: C) -> u8 {
    drive_with(program, clock, ())
}

/// Drives a program as [`drive`] does, with `ports` through which other threads put tokens in and take events out.
/// While one of the senders of `ports` exists, a program that waits for input sleeps; each token wakes it.
///
/// In simulated time a program that only waits for input ends nevertheless: its time does not advance, so that tokens
/// of other threads would come at no defined time.
///
/// ```
/// use apex_rt::{Ports, drive_from, prelude::*};
/// use std::thread;
///
/// apex_macros::graph!("examples/count.afg");
///
/// # fn main() {
/// let mut ports = Ports::<Count>::new();
/// let ticks = ports.input(|inputs| &mut inputs.tick);
/// let counts = ports.event(|events| &mut events.count);
/// // It sleeps until a token comes, and ends when `ticks` is dropped.
/// let robot = thread::spawn(|| drive_from(Count::new(), WallClock::new(), ports));
/// assert_eq!(ticks.send(()), Ok(()));
/// assert_eq!(counts.receive(), Some(1));
/// drop(ticks);
/// assert_eq!(robot.join().expect("it does not panic"), 0);
/// # }
/// ```
#[cfg(feature = "std")]
pub fn drive_from<P: Program, C: Clock>(program: P, clock: C, ports: Ports<P>) -> u8 {
    on_signals(&clock);
    #[cfg(any(feature = "profile", feature = "record"))]
    return drive_as_asked(program, clock, ports);
    #[cfg(not(any(feature = "profile", feature = "record")))]
    drive_groups(program, clock, ports, |_| StdErr(const { &P::INFO }))
}

/// Drives a program as [`drive`] does, for the end of `main`: after `abort` the process exits with code 1.
///
/// The signals that end a process (SIGINT, SIGTERM, SIGHUP) end the program, as its clock does.
///
/// ```
/// use apex_rt::prelude::*;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// fn main() {
///     run(Blink::new(), SimClock::until(Time::from_secs(60)));
/// }
/// ```
pub fn run<P: Program, C: Clock>(program: P, clock: C) {
    #[cfg(feature = "std")]
    crate::end::on_signals();
    let code = drive(program, clock);
    #[cfg(feature = "std")]
    if code != 0 {
        std::process::exit(i32::from(code));
    }
    #[cfg(not(feature = "std"))]
    let _ = code;
}
