//! Programs whose groups run side by side, each on a thread of its own.
//!
//! Only cells carry anything from one group to another, and a group looks at its cells at certain points alone. So what it
//! does follows, besides from what enters it, from what these looks find: that is recorded, and in a replay a group that
//! found something waits until it is there.

use super::{
    Finished, Recorder, Replay, ReplayError, Report, Tap, recorder, run, source::Source, waits::ReplayBarrier,
};
use crate::{
    CellSender, Observer, Ports, Program,
    ports::Ways,
    threads::{CellMessage, Group, Pace, Spawn, Wake, drive_from_threads},
};
use std::{
    io, mem,
    panic::resume_unwind,
    path::Path,
    sync::Arc,
    thread::{Scope, ScopedJoinHandle, scope},
};

/// As [`drive_on_threads`](crate::threads::drive_on_threads), and records the run in the file `path`, or, if that is
/// there already, in one with a number. Returns the exit code besides.
///
/// # Errors
/// The file cannot be written, or a source sends tokens that cannot be recorded.
pub fn record_on_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    pace: Pace,
    path: &Path,
    observer: impl Fn(usize) -> O,
) -> io::Result<(u8, Finished)> {
    record_from_threads(program, pace, Ports::<P>::new().0, path, observer)
}

/// The same, with ways into the program and out of it for other threads.
pub(super) fn record_from_threads<P: Program, O: Observer + Send>(
    program: &mut P,
    pace: Pace,
    ways: Ways<P::Inputs, P::Events>,
    path: &Path,
    observer: impl Fn(usize) -> O,
) -> io::Result<(u8, Finished)> {
    // A single group is recorded as ever; it may have settings that need a thread.
    let several = P::INFO.groups.len() > 1;
    let groups = if several { const { P::INFO.groups } } else { &[] };
    let mut tap = Tap::Record(Recorder::of_threads::<P>(path, groups)?);
    if several {
        program.share_params(&mut tap);
    }
    let Tap::Record(recorder) = tap else { unreachable!("it was made so") };
    let tap = |group| Tap::Record(recorder.beside(several.then_some(group)));
    let code = drive_from_threads(program, pace, ways, |group| (observer(group), tap(group)));
    Ok((code, recorder.finish()?))
}

/// The groups that ran side by side when `path` was recorded, if there were several.
pub(super) fn recorded_threads(path: &Path) -> Result<Option<String>, ReplayError> {
    let at = |error| ReplayError::File(path.to_owned(), error);
    let mut source = Source::open(path).map_err(at)?;
    source.next().map_err(at)?;
    Ok(source.threads)
}

/// Replays a recording of the groups `recorded`, each on a thread of its own.
pub(super) fn replay_on_threads<P: Program, O: Observer + Send + Clone>(
    program: &mut P,
    path: &Path,
    recorded: &str,
    observer: &O,
) -> Result<Report, ReplayError> {
    let groups = const { P::INFO.groups };
    if recorder::names(groups) != recorded {
        let (path, recorded) = (path.to_owned(), recorded.to_owned());
        return Err(ReplayError::OtherThreads { path, recorded, wanted: recorder::names(groups) });
    }
    let waits = Arc::new(ReplayBarrier::new(groups.len()));
    let open = |group| Replay::of_group::<P>(path, group, Arc::clone(&waits)).map(Tap::Replay);
    let mut taps = (0..groups.len()).map(open).collect::<Result<Vec<Tap>, ReplayError>>()?;
    if let Some(main) = taps.first_mut() {
        program.share_params(main);
    }
    let reports = scope(|scope| {
        let taps = taps.into_iter().map(Some).collect();
        let mut repeat = Repeat { scope, observer, waits: &waits, taps, hung: vec![], threads: vec![], main: None };
        program.on_threads(Nobody, &mut repeat);
        let others =
            repeat.threads.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
        repeat.main.into_iter().chain(others).collect::<io::Result<Vec<Report>>>()
    });
    let reports = reports.map_err(|error| ReplayError::File(path.to_owned(), error))?;
    run::something(Report::of_groups(reports, &P::channels()), path)
}

/// Groups look for themselves whether something has come.
#[derive(Clone, Copy)]
struct Nobody;

impl Wake for Nobody {
    fn wake(&self, _group: usize) {}
}

/// The way to tell a group that a node hangs.
type Hung<'a> = CellSender<'a, CellMessage<()>>;

/// Repeats what each group did.
struct Repeat<'scope, 'env, O> {
    scope: &'scope Scope<'scope, 'env>,
    observer: &'env O,
    waits: &'env ReplayBarrier,
    /// What each group did, until it begins.
    taps: Vec<Option<Tap>>,
    hung: Vec<(usize, Hung<'env>)>,
    threads: Vec<ScopedJoinHandle<'scope, io::Result<Report>>>,
    main: Option<io::Result<Report>>,
}

impl<'env, O: Observer + Send + Clone> Repeat<'_, 'env, O> {
    /// What a group is repeated with.
    fn part<G: Group>(&mut self, group: usize, part: G) -> Option<Part<'env, G, O>> {
        let tap = self.taps.get_mut(group)?.take()?;
        let all = mem::take(&mut self.hung);
        let (own, others) = all.into_iter().partition(|(of, _)| *of == group);
        self.hung = others;
        Some(Part { group, part, tap, hung: own, observer: self.observer.clone(), waits: self.waits })
    }
}

impl<'env, O: Observer + Send + Clone + 'env, I, E> Spawn<'env, I, E> for Repeat<'_, 'env, O> {
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
    tap: Tap,
    hung: Vec<(usize, Hung<'a>)>,
    observer: O,
    waits: &'a ReplayBarrier,
}

impl<G: Group, O: Observer> Part<'_, G, O> {
    fn repeat(mut self) -> io::Result<Report> {
        let mut ends = Ends { waits: self.waits, group: self.group, cut: false };
        loop {
            let Tap::Replay(replay) = &mut self.tap else { unreachable!("it was made so") };
            let Some(now) = replay.next_reaction()? else { break };
            // When a node was seen to hang is recorded with the looks: it may be told at any time.
            for (_, hung) in &mut self.hung {
                hung.put(|parcel| parcel.token = Some(()));
            }
            self.part.react_with(now, &mut (&mut self.observer, &mut self.tap));
        }
        let Tap::Replay(replay) = self.tap else { unreachable!("it was made so") };
        let report = replay.finish();
        ends.cut = report.cut.is_some();
        Ok(report)
    }
}

/// Tells the others that a group has ended, in whatever way.
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
