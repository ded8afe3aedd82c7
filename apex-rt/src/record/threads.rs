//! Recording and replay of programs whose thread groups run in parallel.
//!
//! Groups exchange tokens only through cells, and a group checks its cells only at certain points. Its behaviour thus
//! follows from its inputs and from the results of these checks. The results are recorded; in a replay, a group whose
//! check found something waits until it is there.

use super::{
    Finished, RecordOptions, Recorder, Replay, ReplayError, Report, Tap, recorder,
    repeat::{repeat, something},
    replay,
    waits::ReplayBarrier,
};
use crate::{
    CellSender, Observer, Ports, Program,
    ports::Ways,
    threads::{CellMessage, Group, Pace, Spawn, Wake, WatchdogObserver, drive_from_threads},
};
use std::{
    io, mem,
    panic::resume_unwind,
    path::Path,
    sync::Arc,
    thread::{Scope, ScopedJoinHandle, scope},
};

/// Drives a program as [`drive_on_threads`](crate::threads::drive_on_threads) does, and records the run in the file
/// `path`. If that exists, a number is added to its name. Also returns the exit code.
///
/// ```
/// use apex_macros::graph;
/// use apex_rt::{prelude::*, record::record_on_threads};
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
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let file = std::env::temp_dir().join(format!("apex-threads-{}.mcap", std::process::id()));
/// let pace = WallClock::new().pace().expect("it is the machine's clock");
/// let (code, finished) = record_on_threads(&mut Short::new(), pace, &file, |_group| ())?;
/// assert_eq!((code, finished.path), (0, file.clone()));
/// # std::fs::remove_file(file)?;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The file cannot be written, or a source sends tokens that cannot be recorded.
pub fn record_on_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    pace: Pace,
    path: &Path,
    observer: impl Fn(usize) -> O,
) -> io::Result<(u8, Finished)> {
    let (ways, options) = (Ports::<P>::new().0, RecordOptions::default());
    record_from_threads(program, pace, ways, (path, options), |group, tap| (observer(group), tap))
}

/// Records a program as [`record_on_threads`] does, with ports for other threads.
pub(super) fn record_from_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    pace: Pace,
    ways: Ways<P::Inputs, P::Events>,
    (path, options): (&Path, RecordOptions),
    observer: impl Fn(usize, Tap) -> O,
) -> io::Result<(u8, Finished)> {
    // A single group is recorded like a program without groups; it may have settings that need a thread.
    let several = P::INFO.groups.len() > 1;
    let groups = if several { const { P::INFO.groups } } else { &[] };
    let recorder = Recorder::of_threads::<P>(path, groups, options)?;
    let tap = |group| Tap::Record(recorder.beside(several.then_some(group)));
    let code = drive_from_threads(program, pace, ways, |group| observer(group, tap(group)));
    Ok((code, recorder.finish()?))
}

/// Returns the groups that ran in parallel when `path` was recorded, if there were several.
pub(super) fn recorded_threads(path: &Path) -> Result<Option<String>, ReplayError> {
    let at = |error| ReplayError::File(path.to_owned(), error);
    let mut source = replay::open(path)?;
    source.next_message().map_err(at)?;
    Ok(source.threads)
}

/// Replays a recording of the groups `recorded`, each on a thread of its own with the observer that `observer` returns.
pub(super) fn replay_on_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    path: &Path,
    recorded: &str,
    observer: impl Fn(usize, Tap) -> O,
) -> Result<Report, ReplayError> {
    let groups = const { P::INFO.groups };
    if recorder::names(groups) != recorded {
        let (path, recorded) = (path.to_owned(), recorded.to_owned());
        return Err(ReplayError::OtherThreads { path, recorded, wanted: recorder::names(groups) });
    }
    let waits = Arc::new(ReplayBarrier::new(groups.len()));
    let open = |group| Replay::of_group::<P>(path, group, Arc::clone(&waits)).map(Tap::Replay);
    let taps = (0..groups.len()).map(open).collect::<Result<Vec<Tap>, ReplayError>>()?;
    let info = const { &P::INFO };
    // Nothing watches over a replay, but its observers are of the same type as those of a run.
    let watched = |(group, tap)| WatchdogObserver { observer: observer(group, tap), pulse: None, info };
    let reports = scope(|scope| {
        let observers = taps.into_iter().enumerate().map(watched).map(Some).collect();
        let mut repeat = Repeat { scope, waits: &waits, observers, hung: vec![], threads: vec![], main: None };
        program.on_threads(Nobody, &mut repeat);
        let others =
            repeat.threads.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
        repeat.main.into_iter().chain(others).collect::<io::Result<Vec<Report>>>()
    });
    let reports = reports.map_err(|error| ReplayError::File(path.to_owned(), error))?;
    something(Report::of_groups(reports, &P::channels()), path)
}

/// Wake that does nothing: in a replay, groups check for themselves if something has come.
#[derive(Clone, Copy)]
struct Nobody;

impl Wake for Nobody {
    fn wake(&self, _group: usize) {}
}

/// Cell that reports a hanging node to a group.
type Hung<'a> = CellSender<'a, CellMessage<()>>;

/// Runner that repeats the recorded run of each group.
struct Repeat<'scope, 'env, O> {
    scope: &'scope Scope<'scope, 'env>,
    waits: &'env ReplayBarrier,
    /// Observer of each group, with its recording, until the group starts.
    observers: Vec<Option<O>>,
    hung: Vec<(usize, Hung<'env>)>,
    threads: Vec<ScopedJoinHandle<'scope, io::Result<Report>>>,
    main: Option<io::Result<Report>>,
}

impl<'env, O: Observer> Repeat<'_, 'env, O> {
    /// Returns the parts of the repetition of a group.
    fn part<G: Group>(&mut self, group: usize, part: G) -> Option<Part<'env, G, O>> {
        let observer = self.observers.get_mut(group)?.take()?;
        let all = mem::take(&mut self.hung);
        let (own, others) = all.into_iter().partition(|(of, _)| *of == group);
        self.hung = others;
        Some(Part { group, part, hung: own, observer, waits: self.waits })
    }
}

impl<'env, O: Observer + Send + 'env, I, E> Spawn<'env, I, E> for Repeat<'_, 'env, O> {
    fn spawn<G: Group + Send + 'env>(&mut self, group: usize, part: G) {
        if let Some(part) = self.part(group, part) {
            self.threads.push(self.scope.spawn(move || part.repeat()));
        }
    }

    fn watch(&mut self, group: usize, hung: Hung<'env>) {
        self.hung.push((group, hung));
    }

    fn stay<G: Group<Inputs = I, Events = E> + 'env>(&mut self, group: usize, part: G) {
        self.main = self.part(group, part).map(Part::repeat);
    }
}

struct Part<'a, G, O> {
    group: usize,
    part: G,
    hung: Vec<(usize, Hung<'a>)>,
    observer: O,
    waits: &'a ReplayBarrier,
}

impl<G: Group, O: Observer> Part<'_, G, O> {
    fn repeat(mut self) -> io::Result<Report> {
        let mut ends = Ends { waits: self.waits, group: self.group, cut: false };
        // The time at which a hanging node was noticed is recorded by the checks of cells, so that the report may come
        // early.
        let report_hung = || {
            for (_, hung) in &mut self.hung {
                hung.put(|parcel| parcel.token = Some(()));
            }
        };
        let report = repeat(&mut self.part, &mut self.observer, report_hung)?;
        ends.cut = report.cut.is_some();
        Ok(report)
    }
}

/// Guard that reports the end of a group to the others, even after a panic.
struct Ends<'a> {
    waits: &'a ReplayBarrier,
    group: usize,
    cut: bool,
}

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.waits.end(self.group, self.cut);
    }
}
