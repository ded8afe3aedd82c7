//! One thread for each group.

use super::{
    Group, Parcel, Spawn, Wake,
    idle::{Alarm, Shared},
    settings,
    watch::{Felt, Off, Pulse, watch},
};
use crate::{CellSender, Clock, Info, Next, Observer, Program, Time, WallClock, run::Stopwatch};
use std::{
    panic::resume_unwind,
    sync::{
        OnceLock,
        atomic::{AtomicBool, AtomicU8, Ordering},
    },
    thread::{self, Scope, ScopedJoinHandle, Thread},
    time::{Duration, Instant},
};

/// What sets the pace of threads: the machine's clock, until somebody ends it.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// The clock.
    pub clock: WallClock,
    /// The program ends when this is set.
    pub stopped: Option<&'static AtomicBool>,
}

/// How long a thread stays awake after it has slept for less than this.
const LINGER: Duration = Duration::from_micros(50);

/// How long it may take until [`Pace::stopped`] is noticed.
const NOTICED: Duration = Duration::from_millis(20);

/// What all threads of a program share.
struct Run {
    info: &'static Info,
    sleep: Shared<Sleeping>,
    time: Timing,
    /// The exit code, once a group has one.
    code: AtomicU8,
    /// For each group what it runs.
    pulses: Box<[Pulse]>,
    /// Ends the watch over them.
    off: Off,
    /// There is a core for each group: who stays awake takes it from nobody.
    has_cores: bool,
}

/// How long groups run.
enum Timing {
    /// Until the program ends.
    Paced(Pace),
    /// One reaction, at this time.
    Once(Time),
}

/// A thread, once it runs.
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

/// Runs every thread group of `program` on a thread of its own, the main group on this one, until nothing can happen any
/// more, the pace ends, or a token comes to `exit`. Returns the exit code. `observer` makes an observer for each group.
///
/// While a group has nothing to do its thread sleeps. A panic in one group ends the others after what they are doing, and goes
/// on here.
pub fn drive_on_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    pace: Pace,
    observer: impl Fn(usize) -> O,
) -> u8 {
    run_groups(program, Timing::Paced(pace), observer)
}

/// One reaction of all thread groups of `program` at `now`, each on a thread of its own, until nothing is ready in any of
/// them. Returns the exit code: what [`react_with`](Program::react_with) does with one group after the other.
pub fn react_on_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    now: Time,
    observer: impl Fn(usize) -> O,
) -> u8 {
    run_groups(program, Timing::Once(now), observer)
}

fn run_groups<P: Program, O: Observer + Send>(program: &mut P, time: Timing, observer: impl Fn(usize) -> O) -> u8 {
    let info = const { &P::INFO };
    let groups = info.groups.len().max(1);
    let sleep = Shared::new((0..groups).map(|_| Sleeping::default()));
    let has_cores = thread::available_parallelism().is_ok_and(|cores| cores.get() >= groups);
    let pulses = (0..groups).map(|_| Pulse::default()).collect();
    let run = Run { info, sleep, time, code: AtomicU8::new(0), pulses, off: Off::default(), has_cores };
    let panicked = thread::scope(|scope| {
        let mut spawner = Spawner { scope, run: &run, observer, hung: vec![], threads: vec![] };
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

struct Spawner<'scope, 'env, F> {
    scope: &'scope Scope<'scope, 'env>,
    run: &'env Run,
    observer: F,
    /// The ways to tell groups that a node hangs.
    hung: Vec<(usize, CellSender<'env, Parcel<()>>)>,
    threads: Vec<ScopedJoinHandle<'scope, ()>>,
}

impl<'env, F> Spawner<'_, 'env, F> {
    /// Begins a thread, without which the program cannot run.
    fn thread(&mut self, name: &str, body: impl FnOnce() + Send + 'env) {
        match thread::Builder::new().name(name.to_owned()).spawn_scoped(self.scope, body) {
            Ok(thread) => self.threads.push(thread),
            Err(error) => {
                eprintln!("{}: no thread for `{name}` could be made: {error}", self.run.info.name);
                self.run.end(1);
            }
        }
    }
}

impl<'env, O: Observer + Send + 'env, F: Fn(usize) -> O> Spawn<'env> for Spawner<'_, 'env, F> {
    fn spawn<G: Group + Send + 'env>(&mut self, group: usize, part: G) {
        let (run, observer) = (self.run, (self.observer)(group));
        self.thread(run.info.groups[group].name, move || run.group(group, part, observer));
    }

    fn watch(&mut self, group: usize, hung: CellSender<'env, Parcel<()>>) {
        self.hung.push((group, hung));
    }

    fn stay<G: Group + 'env>(&mut self, group: usize, part: G) {
        let run = self.run;
        if run.is_watched() {
            let (hung, observer) = (std::mem::take(&mut self.hung), (self.observer)(run.info.groups.len()));
            let wake = |group| run.sleep.wake(group);
            self.thread("watch", move || watch(run.info, &run.pulses, &run.off, hung, &wake, observer));
        }
        run.group(group, part, (self.observer)(group));
    }
}

/// Ends the program if its thread panics.
struct EndOnPanic<'a>(&'a Run);

impl Drop for EndOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.end(101);
        }
    }
}

impl Run {
    /// Whether somebody looks for nodes that hang.
    fn is_watched(&self) -> bool {
        matches!(self.time, Timing::Paced(_)) && self.info.groups.iter().any(|g| g.hang.is_some())
    }

    fn end(&self, code: u8) {
        let _ = self.code.compare_exchange(0, code, Ordering::AcqRel, Ordering::Relaxed);
        self.sleep.stop();
        self.off.end();
    }

    /// What the thread of a group does.
    fn group<G: Group, O: Observer>(&self, group: usize, part: G, observer: O) {
        let _guard = EndOnPanic(self);
        let _ = self.sleep.alarm(group).0.set(thread::current());
        let settings = self.info.groups.get(group);
        if let Some(Err(reason)) = settings.map(|group| settings::apply(self.info, group)) {
            eprintln!("{reason}");
            self.end(1);
        }
        let pulse = self.pulses.get(group).filter(|_| settings.is_some_and(|group| group.hang.is_some()));
        let observer = Felt { observer, pulse, info: self.info };
        match self.time {
            Timing::Paced(pace) => self.drive(group, part, observer, pace),
            Timing::Once(now) => self.react(group, part, observer, now),
        }
    }

    fn drive<G: Group, O: Observer>(&self, group: usize, mut part: G, mut observer: O, pace: Pace) {
        let (mut clock, mut short) = (pace.clock, false);
        while !self.sleep.is_stopped() {
            self.sleep.begin(group);
            let now = clock.now();
            let stopwatch = Stopwatch { clock: &mut clock, start: now };
            match part.react_with(now, &mut (&mut observer, stopwatch)) {
                Next::Exit(code) => self.end(code),
                Next::Now => self.look(pace),
                Next::At(time) => self.wait_until(group, pace, time),
                Next::Input => {
                    let since = Instant::now();
                    if !short || !self.lingers(group, since) {
                        self.idle(group, Some(pace));
                    }
                    short = since.elapsed() < LINGER;
                }
            }
        }
    }

    /// Whether group `group` is woken soon. Where tokens go to and fro quickly, falling asleep and waking up would take most of
    /// the time; who slept for long before sleeps at once.
    fn lingers(&self, group: usize, since: Instant) -> bool {
        while self.has_cores && since.elapsed() < LINGER && !self.sleep.is_stopped() {
            if self.sleep.is_woken(group) {
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
            match part.react_part(now, begins, &mut observer) {
                Next::Exit(code) => self.end(code),
                _ => self.idle(group, None),
            }
            begins = false;
        }
    }

    /// Ends the program if somebody wants it.
    fn look(&self, pace: Pace) {
        if pace.stopped.is_some_and(|stopped| stopped.load(Ordering::Relaxed)) {
            self.sleep.stop();
        }
    }

    fn wait_until(&self, group: usize, mut pace: Pace, time: Time) {
        self.look(pace);
        let left = time.since(pace.clock.now());
        if !left.is_zero() && !self.sleep.is_stopped() && self.sleep.may_wait(group) {
            thread::park_timeout(noticed(group, pace).map_or(left, |noticed| left.min(noticed)));
        }
    }

    fn idle(&self, group: usize, pace: Option<Pace>) {
        if !self.sleep.may_idle(group) {
            return;
        }
        while self.sleep.sleeps(group) {
            match pace.and_then(|pace| noticed(group, pace)) {
                Some(noticed) => thread::park_timeout(noticed),
                None => thread::park(),
            }
            pace.into_iter().for_each(|pace| self.look(pace));
        }
    }
}

/// The main group looks from time to time whether somebody wants to end the program.
fn noticed(group: usize, pace: Pace) -> Option<Duration> {
    (group == 0 && pace.stopped.is_some()).then_some(NOTICED)
}
