//! Execution of the thread groups, each on a thread of its own.

use super::{
    CellMessage, Group, Spawn, Wake,
    idle::{Alarm, Shared},
    pulse::{Heartbeat, WatchdogObserver},
    settings,
    watch::{StopSignal, Watched, watch},
};
use crate::{
    CellSender, Clock, Info, Next, Observer, Ports, Program, Switch, Time,
    clock::Pace,
    end::{Driven, is_asked},
    ports::Ways,
    react::{Lateness, Untaken},
    requests::ServedRequests,
};
use std::{
    panic::resume_unwind,
    sync::{
        OnceLock,
        atomic::{AtomicU8, Ordering},
    },
    thread::{self, Scope, ScopedJoinHandle, Thread},
    time::{Duration, Instant},
};

/// Longest busy wait of a thread. A thread only waits busily if its last sleep was shorter than this.
const LINGER: Duration = Duration::from_micros(50);

/// State that all threads of a program share.
struct Run {
    info: &'static Info,
    sleep: Shared<Sleeping>,
    time: Timing,
    /// The first exit code of a group that is not 0.
    code: AtomicU8,
    /// The pulse of each group, for the watchdog.
    pulses: Box<[Heartbeat]>,
    /// Ends the watchdog.
    off: StopSignal,
    /// `true` if there is a core for each group, so that busy waiting takes none from other groups.
    has_cores: bool,
    /// Requests for parameters, of which no group has seen any.
    requests: ServedRequests,
}

/// Duration of the run of all groups.
enum Timing {
    /// Until the program ends.
    Paced(Pace),
    /// One reaction, at this time.
    Once(Time),
}

/// The thread of a group; empty until it runs.
#[derive(Default)]
struct Sleeping(OnceLock<Thread>);

impl Alarm for Sleeping {
    fn ring(&self) {
        if let Some(thread) = self.0.get() {
            thread.unpark();
        }
    }
}

impl Wake for Run {
    fn wake(&self, group: usize) {
        self.sleep.wake(group);
    }
}

impl Watched for Run {
    fn wake(&self, group: usize) {
        self.sleep.wake(group);
    }

    fn may_sleep(&self) -> bool {
        self.sleep.may_watch_sleep()
    }
}

/// Runs every thread group of `program` on a thread of its own, the main group on this one. Ends when nothing can
/// happen any more, when the switch of `pace` is turned, or when a token comes to `exit` or `abort`. Returns the exit
/// code. `observer` returns an observer for each group.
///
/// The thread of a group sleeps while there is nothing to do. A panic in one group ends the other groups after their
/// current reaction, and is then continued on this thread.
///
/// ```
/// use apex_macros::graph;
/// use apex_rt::{prelude::*, threads::drive_on_threads};
///
/// graph! {
///     use apex_nodes::flow::{Relay, tick};
///
///     robot Short {
///         node clock = tick() every 1ms on sensors;
///         node relay = Relay();
///         node done  = tick() after 20ms;
///         clock -> relay.put;
///         done  -> exit;
///     }
/// }
///
/// # fn main() {
/// let pace = WallClock::new().pace().expect("it is the machine's clock");
/// // An observer for each of the two groups.
/// assert_eq!(drive_on_threads(&mut Short::new(), pace, |_group| ()), 0);
/// # }
/// ```
pub fn drive_on_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    pace: Pace,
    observer: impl Fn(usize) -> O,
) -> u8 {
    drive_from_threads(program, pace, Ports::<P>::new().0, observer)
}

/// Runs the thread groups as [`drive_on_threads`] does, with ports for other threads.
pub(crate) fn drive_from_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    pace: Pace,
    ways: Ways<P::Inputs, P::Events>,
    observer: impl Fn(usize) -> O,
) -> u8 {
    run_groups(program, Timing::Paced(pace), ways, observer)
}

/// Executes one reaction of all thread groups of `program` at `now`, each on a thread of its own, until nothing is
/// ready in any of them. Returns the exit code. [`react_with`](Program::react_with) does the same with one group after
/// the other.
///
/// ```
/// use apex_macros::graph;
/// use apex_rt::{prelude::*, threads::react_on_threads};
///
/// graph! {
///     use apex_nodes::flow::{Relay, tick};
///
///     robot Short {
///         node clock = tick() every 1ms on sensors;
///         node relay = Relay();
///         node done  = tick() after 20ms;
///         clock -> relay.put;
///         done  -> exit;
///     }
/// }
///
/// # fn main() {
/// let mut short = Short::new();
/// assert_eq!(react_on_threads(&mut short, Time::ZERO, |_group| ()), 0);
/// assert_eq!(react_on_threads(&mut short, Time::from_millis(20), |_group| ()), 0);
/// # }
/// ```
pub fn react_on_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    now: Time,
    observer: impl Fn(usize) -> O,
) -> u8 {
    run_groups(program, Timing::Once(now), Ports::<P>::new().0, observer)
}

fn run_groups<P: Program, O: Observer + Send>(
    program: &mut P,
    time: Timing,
    ways: Ways<P::Inputs, P::Events>,
    observer: impl Fn(usize) -> O,
) -> u8 {
    let info = const { &P::INFO };
    let groups = info.groups.len().max(1);
    let sleep = Shared::new((0..groups).map(|_| Sleeping::default()));
    let has_cores = thread::available_parallelism().is_ok_and(|cores| cores.get() >= groups);
    let pulses = (0..groups).map(|_| Heartbeat::default()).collect();
    let (code, off, requests) = (AtomicU8::new(0), StopSignal::default(), ways.requests.clone());
    let run = Run { info, sleep, time, code, pulses, off, has_cores, requests };
    let panicked = thread::scope(|scope| {
        let mut spawner = Spawner { scope, run: &run, observer, ways: Some(ways), hung: vec![], threads: vec![] };
        program.on_threads(&run, &mut spawner);
        run.off.end();
        let ends = spawner.threads.into_iter().map(ScopedJoinHandle::join);
        ends.fold(None, |first, end| first.or(end.err()))
    });
    if let Some(panic) = panicked {
        resume_unwind(panic);
    }
    run.code.load(Ordering::Acquire)
}

struct Spawner<'scope, 'env, F, W> {
    scope: &'scope Scope<'scope, 'env>,
    run: &'env Run,
    observer: F,
    /// The ports of the main group, until it starts.
    ways: Option<W>,
    /// Cells that report hanging nodes to groups.
    hung: Vec<(usize, CellSender<'env, CellMessage<()>>)>,
    threads: Vec<ScopedJoinHandle<'scope, ()>>,
}

impl<'env, F, W> Spawner<'_, 'env, F, W> {
    /// Starts a thread. A failure ends the program.
    fn thread(&mut self, name: &str, body: impl FnOnce() + Send + 'env) {
        match thread::Builder::new().name(name.to_owned()).spawn_scoped(self.scope, body) {
            Ok(thread) => self.threads.push(thread),
            Err(error) => {
                eprintln!("{}: cannot create a thread for `{name}`: {error}", self.run.info.name);
                self.run.end(1);
            }
        }
    }
}

impl<'env, O, F, I, E> Spawn<'env, I, E> for Spawner<'_, 'env, F, Ways<I, E>>
where
    O: Observer + Send + 'env,
    F: Fn(usize) -> O,
{
    fn spawn<G: Group + Send + 'env>(&mut self, group: usize, part: G) {
        let (run, observer) = (self.run, (self.observer)(group));
        self.thread(run.info.groups[group].name, move || run.group(group, part, observer, None));
    }

    fn watch(&mut self, group: usize, hung: CellSender<'env, CellMessage<()>>) {
        self.hung.push((group, hung));
    }

    fn stay<G: Group<Inputs = I, Events = E> + 'env>(&mut self, group: usize, part: G) {
        let run = self.run;
        if run.is_watched() {
            let (hung, observer) = (std::mem::take(&mut self.hung), (self.observer)(run.info.groups.len()));
            self.thread("watch", move || watch(run.info, &run.pulses, &run.off, hung, run, observer));
        }
        run.group(group, part, (self.observer)(group), self.ways.take());
    }
}

/// Guard that ends the program if its thread panics.
struct EndOnPanic<'a>(&'a Run);

impl Drop for EndOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.end(101);
        }
    }
}

impl Run {
    /// Returns `true` if a watchdog looks for hanging nodes.
    fn is_watched(&self) -> bool {
        matches!(self.time, Timing::Paced(_)) && self.info.groups.iter().any(|g| g.hang.is_some())
    }

    fn end(&self, code: u8) {
        let _ = self.code.compare_exchange(0, code, Ordering::AcqRel, Ordering::Relaxed);
        self.sleep.stop();
        self.off.end();
    }

    /// Runs a group on the current thread. The main group has the ports of the program, `ways`.
    fn group<G: Group, O: Observer>(
        &self,
        group: usize,
        part: G,
        observer: O,
        ways: Option<Ways<G::Inputs, G::Events>>,
    ) {
        let _guard = EndOnPanic(self);
        let _ = self.sleep.alarm(group).0.set(thread::current());
        let settings = self.info.groups.get(group);
        if let Some(Err(reason)) = settings.map(|group| settings::apply(self.info, group)) {
            eprintln!("{reason}");
            self.end(1);
        }
        let pulse = self.pulses.get(group).filter(|_| settings.is_some_and(|group| group.hang.is_some()));
        let observer = WatchdogObserver { observer, pulse, info: self.info };
        match self.time {
            Timing::Paced(pace) => {
                let part = Driven::new(part, true);
                let _stops = pace.stopped.map(Switch::listen);
                let bell = ways.as_ref().map(Ways::bell);
                let _listens = (bell.as_ref().map(|bell| bell.listen()), self.requests.shared.listen());
                let requests = self.requests.clone();
                self.drive(Member { group, pace, ways, held: false, requests }, part, observer);
            }
            Timing::Once(now) => self.react(group, part, observer, now),
        }
    }

    fn drive<G: Group, O: Observer>(
        &self,
        mut member: Member<G::Inputs, G::Events>,
        mut driven: Driven<G>,
        mut observer: O,
    ) {
        let (mut clock, mut short) = (member.pace.clock, false);
        let (is_watched, mut lateness, mut untaken) = (self.is_watched(), Lateness::default(), Untaken::default());
        member.exchange(&mut driven.program, &self.sleep);
        while !self.is_over(member.pace) {
            self.sleep.begin(member.group);
            if is_watched && self.sleep.wakes_watch() {
                self.off.stir();
            }
            let now = clock.now();
            let next = driven.react(now, &mut observer, &mut || clock.now().since(now));
            let part = &mut driven.program;
            lateness.look(next, now, &mut observer, || clock.now().since(now));
            member.requests.serve(part);
            let came = member.exchange(part, &self.sleep);
            let looks = untaken.look(part, now, &mut observer);
            match next.or(looks.map_or(Next::Input, Next::At)) {
                Next::Exit(code) => self.end(code),
                _ if came => {}
                Next::Now => {}
                Next::At(time) => self.wait_until(&member, time),
                Next::Input => {
                    let since = Instant::now();
                    if !short || !self.lingers(&member, since) {
                        self.idle(member.group, &|| member.rings() || self.is_over(member.pace));
                    }
                    short = since.elapsed() < LINGER;
                }
            }
        }
    }

    /// Returns `true` if the program ends. Stops all groups if the switch is turned.
    fn is_over(&self, pace: Pace) -> bool {
        if !self.sleep.is_stopped() && (is_asked() || pace.stopped.is_some_and(Switch::is_set)) {
            self.sleep.stop();
        }
        self.sleep.is_stopped()
    }

    /// Waits busily for a short time; returns `true` if the group was woken meanwhile. Where tokens are exchanged
    /// quickly, falling asleep and waking up would take most of the time.
    fn lingers<I, E>(&self, member: &Member<I, E>, since: Instant) -> bool {
        while self.has_cores && since.elapsed() < LINGER {
            if self.sleep.is_woken(member.group) || member.rings() || self.is_over(member.pace) {
                return true;
            }
            std::hint::spin_loop();
        }
        false
    }

    fn react<G: Group, O: Observer>(&self, group: usize, mut part: G, mut observer: O, now: Time) {
        let mut begins = true;
        while !self.sleep.is_stopped() {
            self.sleep.begin(group);
            observer.before_reaction(now, &mut part);
            let next = part.react_part(now, begins, &mut observer);
            observer.after_reaction(next);
            match next {
                Next::Exit(code) => self.end(code),
                _ => self.idle(group, &|| false),
            }
            begins = false;
        }
    }

    fn wait_until<I, E>(&self, member: &Member<I, E>, time: Time) {
        let mut clock = member.pace.clock;
        let left = time.since(clock.now());
        if !left.is_zero() && !self.is_over(member.pace) && !member.rings() && self.sleep.may_wait(member.group) {
            thread::park_timeout(left);
        }
    }

    /// Sleeps until the group is woken, by another group or because `ends` returns `true`.
    fn idle(&self, group: usize, ends: &dyn Fn() -> bool) {
        if !self.sleep.may_idle(group) {
            return;
        }
        while self.sleep.sleeps(group) {
            if ends() {
                self.sleep.wake(group);
            } else {
                thread::park();
            }
        }
    }
}

/// The group that runs on this thread.
struct Member<I, E> {
    group: usize,
    pace: Pace,
    /// The ports of the program, in the main group.
    ways: Option<Ways<I, E>>,
    /// `true` if other threads may still use the ports, which keeps the program from ending.
    held: bool,
    /// Requests for the parameters of the group.
    requests: ServedRequests,
}

impl<I, E> Member<I, E> {
    /// Moves tokens through the ports. Returns `true` if there were any.
    fn exchange<G: Group<Inputs = I, Events = E>>(&mut self, part: &mut G, sleep: &Shared<Sleeping>) -> bool {
        let Some(ways) = &mut self.ways else { return false };
        let came = ways.pass(part.mailboxes());
        match (self.held, ways.is_open()) {
            (false, true) => sleep.hold(),
            (true, false) => sleep.release(),
            _ => {}
        }
        self.held = ways.is_open();
        came
    }

    /// Returns `true` if there may be tokens to move, or there are requests to serve.
    fn rings(&self) -> bool {
        self.requests.are_new() || self.ways.as_ref().is_some_and(Ways::rings)
    }
}
