use crate::{
    Arrival, Clock, Info, Observer, Parameters, Time,
    threads::{SingleGroup, Spawn, Wake},
};
#[cfg(feature = "std")]
use crate::{
    Ports,
    end::{Driven, is_asked},
};
use core::time::Duration;
#[cfg(feature = "std")]
use std::sync::Arc;

/// Time of a program's next reaction.
///
/// ```
/// use apex_rt::prelude::*;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() {
/// let (mut blink, mut now) = (Blink::new(), Time::ZERO);
/// // A loop of your own. A robot would sleep until `time`.
/// while let Next::At(time) = blink.react(now)
///     && time <= Time::from_secs(1)
/// {
///     now = time;
/// }
/// assert_eq!(now, Time::from_secs(1));
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Next {
    /// At once: a source without a period is to fire again.
    Now,
    /// At this time, or when a token is put into a mailbox.
    At(Time),
    /// Only when a token is put into a mailbox.
    Input,
    /// Never: a token came to `exit` (0) or `abort` (1).
    Exit(u8),
}

impl Next {
    /// Returns the earlier of two times. An exit comes first.
    ///
    /// ```
    /// use apex_rt::prelude::*;
    ///
    /// let (early, late) = (Next::At(Time::from_secs(1)), Next::At(Time::from_secs(2)));
    /// assert_eq!([late.or(early), late.or(Next::Input), late.or(Next::Now)], [early, late, Next::Now]);
    /// ```
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Exit(code), _) | (_, Self::Exit(code)) => Self::Exit(code),
            (Self::Now, _) | (_, Self::Now) => Self::Now,
            (Self::At(a), Self::At(b)) => Self::At(if a < b { a } else { b }),
            (Self::At(t), Self::Input) | (Self::Input, Self::At(t)) => Self::At(t),
            (Self::Input, Self::Input) => Self::Input,
        }
    }

    /// Returns `true` for a time that is not after `time`.
    #[doc(hidden)]
    #[inline(always)]
    pub fn is_at_most(self, time: Time) -> bool {
        matches!(self, Self::At(at) if at <= time)
    }
}

/// A compiled graph. `graph!` generates a struct that implements this trait. The struct itself has the functions `new`,
/// `react`, `inputs`, `outputs`, `events` and `nodes`.
///
/// ```
/// use apex_rt::prelude::*;
/// use std::time::Duration;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// /// Returns the shortest period of the sources of a program.
/// fn period<P: Program>(_program: &P) -> Option<Duration> {
///     P::INFO.nodes.iter().filter_map(|node| node.every).min()
/// }
///
/// # fn main() {
/// let mut blink = Blink::new();
/// assert_eq!(period(&blink), Some(Duration::from_millis(20)));
/// // With an observer; `react` is the same without one.
/// assert_eq!(blink.react_with(Time::ZERO, &mut ()), Next::At(Time::from_millis(20)));
/// # }
/// ```
pub trait Program: Parameters {
    /// Static description of the graph.
    const INFO: Info;

    /// Mailboxes of the graph-level inputs and slots.
    type Inputs;

    /// Mailboxes of the events.
    type Events;

    /// Reacts at `now`: runs until nothing is ready. Returns the time of the next reaction.
    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next;

    /// Returns the mailboxes, for use between two reactions.
    fn mailboxes(&mut self) -> (&mut Self::Inputs, &mut Self::Events);

    /// Returns the event of the program whose token has been waiting the longest, by its name, and the number of the
    /// token.
    #[doc(hidden)]
    fn untaken(&self) -> Option<(&'static str, Arrival)> {
        None
    }

    /// File for recordings of the program, from its `record` statement.
    #[cfg(feature = "record")]
    const RECORD: Option<&'static str> = None;

    /// Returns the channels that can be recorded.
    #[cfg(feature = "record")]
    fn channels() -> std::vec::Vec<crate::record::Channel> {
        std::vec::Vec::new()
    }

    /// Calls `found` with each connection (by index) whose event is missing at a node that has other tokens. If nothing
    /// else can happen, that is a deadlock.
    fn waiting(&self, found: impl FnMut(usize)) {
        let _ = found;
    }

    /// Calls the `#[on_stop]` methods of all nodes, because the program has ended: a driver stops its motors there.
    fn stop(&mut self) {}

    /// Returns `true` if node `node` is active (thesis eq. 7.1).
    fn is_active(&self, node: usize) -> bool {
        let _ = node;
        false
    }

    /// Passes the thread groups of a program to `spawn`, the main group last. `wake` is called when a group has to
    /// react.
    #[doc(hidden)]
    fn on_threads<'a, W, S>(&'a mut self, wake: W, spawn: &mut S)
    where
        W: Wake + Copy + Send + 'a,
        S: Spawn<'a, Self::Inputs, Self::Events>,
        Self: Sized,
    {
        let _ = wake;
        spawn.stay(0, SingleGroup(self));
    }

    /// Returns `true` if nested graph `graph`, by its index in [`Info::graphs`], is active: one of its nodes is active,
    /// or activity is on its way between two of them.
    fn is_graph_active(&self, graph: usize) -> bool {
        let _ = graph;
        false
    }
}

impl<P: Program> Program for &mut P {
    const INFO: Info = P::INFO;
    type Inputs = P::Inputs;
    type Events = P::Events;

    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next {
        (**self).react_with(now, observer)
    }

    fn mailboxes(&mut self) -> (&mut Self::Inputs, &mut Self::Events) {
        (**self).mailboxes()
    }

    fn untaken(&self) -> Option<(&'static str, Arrival)> {
        (**self).untaken()
    }

    fn on_threads<'a, W, S>(&'a mut self, wake: W, spawn: &mut S)
    where
        W: Wake + Copy + Send + 'a,
        S: Spawn<'a, Self::Inputs, Self::Events>,
    {
        (**self).on_threads(wake, spawn);
    }

    fn waiting(&self, found: impl FnMut(usize)) {
        (**self).waiting(found);
    }

    fn stop(&mut self) {
        (**self).stop();
    }

    #[cfg(feature = "record")]
    const RECORD: Option<&'static str> = P::RECORD;

    #[cfg(feature = "record")]
    fn channels() -> std::vec::Vec<crate::record::Channel> {
        P::channels()
    }

    fn is_active(&self, node: usize) -> bool {
        (**self).is_active(node)
    }

    fn is_graph_active(&self, graph: usize) -> bool {
        (**self).is_graph_active(graph)
    }
}

/// Executes a reaction, and tells the observer before and after it. `elapsed` returns the duration of the reaction so
/// far. Also returns `true` if a deadline was missed.
pub(crate) fn react<P: Program, O: Observer>(
    program: &mut P,
    now: Time,
    observer: &mut O,
    elapsed: &mut dyn FnMut() -> Duration,
) -> (Next, bool) {
    react_timed(program, now, observer, Stopwatch { elapsed, is_late: false, ends_early: true })
}

/// Repeats a reaction, which `ends_early` as the recorded one did.
#[cfg(feature = "record")]
pub(crate) fn react_again<P: Program>(program: &mut P, now: Time, observer: &mut impl Observer, ends_early: bool) {
    let elapsed = &mut || Duration::ZERO;
    react_timed(program, now, observer, Stopwatch { elapsed, is_late: false, ends_early });
}

fn react_timed<P: Program, O: Observer>(
    program: &mut P,
    now: Time,
    observer: &mut O,
    stopwatch: Stopwatch<'_>,
) -> (Next, bool) {
    observer.before_reaction(now, program);
    let mut observers = (&mut *observer, stopwatch);
    let next = program.react_with(now, &mut observers);
    let (observer, Stopwatch { is_late, .. }) = observers;
    observer.after_reaction(next);
    (next, is_late)
}

/// Observer that measures the duration of a reaction, and mostly ends a late one after each instant: tokens and
/// requests of other threads are served before the next. Its type does not depend on the clock, and that of all runs
/// with one type of observer is the same: the program is compiled once for them.
struct Stopwatch<'a> {
    elapsed: &'a mut dyn FnMut() -> Duration,
    /// `true` if a deadline was missed.
    is_late: bool,
    ends_early: bool,
}

impl Observer for Stopwatch<'_> {
    fn ends_early(&mut self) -> bool {
        self.ends_early
    }

    fn elapsed(&mut self) -> Duration {
        (self.elapsed)()
    }

    fn late(&mut self, _node: usize, _age: Duration) {
        self.is_late = true;
    }
}

/// Lateness of a program, which is reported once until it has caught up.
#[derive(Debug, Default)]
pub(crate) struct Lateness {
    is_told: bool,
}

/// Lateness from which on it is reported.
const TOLD_FROM: Duration = Duration::from_secs(1);

impl Lateness {
    /// Looks at a reaction that began at `now`. `elapsed` returns its duration.
    #[inline]
    pub fn look<O: Observer>(&mut self, next: Next, now: Time, observer: &mut O, elapsed: impl FnOnce() -> Duration) {
        match next {
            Next::At(due) if due <= now => {
                let behind = now.since(due);
                if behind >= TOLD_FROM && !self.is_told {
                    self.is_told = true;
                    observer.behind(behind, elapsed());
                }
            }
            _ => self.is_told = false,
        }
    }
}

/// Watch over the events of a program: what triggers an event is held back until its token was taken, so that a program
/// whose events are not taken comes to a standstill.
#[derive(Debug, Default)]
pub(crate) struct Untaken {
    /// The token that waits, and since when.
    waits: Option<(Arrival, Time)>,
    /// The event that was reported last.
    told: Option<&'static str>,
}

/// Time from which on an event that is not taken is reported.
const UNTAKEN_FROM: Duration = Duration::from_secs(1);

impl Untaken {
    /// Looks at the events after a reaction at `now`. Returns when to look again, at the latest.
    #[inline]
    pub fn look<P: Program, O: Observer>(&mut self, program: &P, now: Time, observer: &mut O) -> Option<Time> {
        let Some((event, token)) = program.untaken().filter(|(event, _)| self.told != Some(*event)) else {
            self.waits = None;
            return None;
        };
        let since = self.waits.filter(|(waits, _)| *waits == token).map_or(now, |(_, since)| since);
        self.waits = Some((token, since));
        if now.since(since) < UNTAKEN_FROM {
            return Some(since + UNTAKEN_FROM);
        }
        self.told = Some(event);
        observer.untaken(event, now.since(since));
        None
    }
}

/// Environment of a running program besides its clock. `()` is an empty one.
pub(crate) trait Outside<P> {
    /// Moves tokens into the program and out of it. Returns `true` if there were any.
    fn exchange(&mut self, program: &mut P) -> bool;

    /// Serves requests for the program's parameters.
    fn serve(&mut self, program: &mut P);

    /// Returns `true` if a program that only waits for input may still get some.
    fn is_open(&self) -> bool;

    /// Waits until `until`, forever if that is `None`, or until there are tokens to be moved. Returns `false` if the
    /// clock ends before.
    fn wait<C: Clock>(&mut self, clock: &mut C, until: Option<Time>) -> bool;
}

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

impl<P> Outside<P> for () {
    fn exchange(&mut self, _program: &mut P) -> bool {
        false
    }

    fn serve(&mut self, _program: &mut P) {}

    fn is_open(&self) -> bool {
        false
    }

    fn wait<C: Clock>(&mut self, clock: &mut C, until: Option<Time>) -> bool {
        #[cfg(feature = "std")]
        return clock.wait(until, &is_asked);
        #[cfg(not(feature = "std"))]
        until.is_some_and(|time| clock.wait_until(time))
    }
}

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
    return crate::instruments::drive(program, clock, Ports::new());
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

/// Drives a program that nothing but its clock concerns, without instruments.
#[cfg(all(feature = "std", not(any(feature = "profile", feature = "record"))))]
fn drive_alone<P: Program, C: Clock>(mut program: P, clock: C) -> u8 {
    let messages = || crate::StdErr(const { &P::INFO });
    match pace_of_threads::<P, C>(&clock) {
        Some(pace) => crate::threads::drive_on_threads(&mut program, pace, |_| messages()),
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
    return crate::instruments::drive(program, clock, ports);
    #[cfg(not(any(feature = "profile", feature = "record")))]
    drive_groups(program, clock, ports, |_| crate::StdErr(const { &P::INFO }))
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
        Some(pace) => crate::threads::drive_from_threads(&mut program, pace, ports.0, observer),
        None => drive_ports(program, clock, &mut observer(0), ports),
    }
}

/// Returns the timing of the program's threads, if it runs on threads of its own.
#[cfg(feature = "std")]
pub(crate) fn pace_of_threads<P: Program, C: Clock>(clock: &C) -> Option<crate::threads::Pace> {
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
pub fn drive_with<P: Program, C: Clock, O: Observer>(program: P, clock: C, mut observer: O) -> u8 {
    drive_beside(program, clock, &mut observer, ())
}

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

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    /// A program that records its calls.
    struct Asked(std::vec::Vec<&'static str>);

    impl Parameters for Asked {}

    impl Program for Asked {
        const INFO: Info = Info {
            name: "Asked",
            docs: "",
            files: &[],
            nodes: &[],
            kinds: &[],
            graphs: &[],
            connections: &[],
            clusters: &[],
            groups: &[],
            end_if_hung: None,
            claims: &[],
        };
        type Inputs = u8;
        type Events = u16;

        fn react_with<O: Observer>(&mut self, _now: Time, _observer: &mut O) -> Next {
            self.0.push("react_with");
            Next::Exit(3)
        }
        fn mailboxes(&mut self) -> (&mut u8, &mut u16) {
            std::unreachable!("nobody drives it with ports")
        }
        fn waiting(&self, mut found: impl FnMut(usize)) {
            found(7);
        }
        fn is_active(&self, node: usize) -> bool {
            node == 5
        }
        fn is_graph_active(&self, graph: usize) -> bool {
            graph == 6
        }
        #[cfg(feature = "record")]
        const RECORD: Option<&'static str> = Some("a.mcap");
    }

    /// Calls all methods of a program that have a default.
    fn ask<P: Program>(program: &P) {
        let mut found = std::vec![];
        program.waiting(|connection| found.push(connection));
        assert_eq!(found, [7]);
        assert!(program.is_active(5) && program.is_graph_active(6));
        #[cfg(feature = "record")]
        assert_eq!(P::RECORD, Some("a.mcap"));
    }

    #[test]
    fn a_borrowed_program_answers_as_the_program_does() {
        let mut program = Asked(std::vec![]);
        ask(&program);
        ask(&&mut program);
        assert_eq!(drive_with(&mut program, crate::SimClock::until(Time::MAX), ()), 3);
        assert_eq!(program.0, ["react_with"]);
    }
}
