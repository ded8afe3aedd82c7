//! Profiles: the durations of all firings and calls of slots, as a table by node and as a trace for Perfetto and Chrome
//! (`ui.perfetto.dev`, `chrome://tracing`). The trace shows active nodes in another colour.

mod run;

pub(crate) use run::drive;

use crate::{Info, Next, Observer, Parameters, Time};
use hdrhistogram::Histogram;
use std::{
    fmt::Write as _,
    fs::File,
    io::{self, BufWriter, Write},
    path::Path,
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};

/// Maximum number of calls in the trace. The table counts all calls.
pub const MAX_TRACED: u64 = 1_000_000;

/// Measured times of a program.
///
/// ```
/// use apex_rt::{Info, drive_with, prelude::*, profile::Profile};
/// use std::sync::Mutex;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let trace = std::env::temp_dir().join(format!("apex-profile-{}.json", std::process::id()));
/// const INFO: Info = Blink::INFO;
/// let mut profile = Mutex::new(Profile::to_file(&INFO, &trace)?);
/// drive_with(Blink::new(), SimClock::until(Time::from_secs(1)), Profile::of_group(&profile, 0));
/// let profile = profile.get_mut().expect("no thread has panicked");
/// profile.finish()?;
/// assert!(profile.table().lines().any(|line| line.starts_with("clock")));
/// # std::fs::remove_file(trace)?;
/// # Ok(())
/// # }
/// ```
pub struct Profile {
    info: &'static Info,
    start: Instant,
    /// Calls in progress of each thread group, innermost last: an `each` contains the calls of its body.
    running: Vec<Vec<Call>>,
    /// The reactions of each thread group.
    reactions: Vec<Reactions>,
    /// `true` for each active node.
    active: Vec<bool>,
    /// Durations of each node's calls, in ns; `None` before the first call.
    calls: Vec<Option<Histogram<u64>>>,
    /// Total duration of each node's calls in ns, without the calls inside them.
    own: Vec<u64>,
    traced: u64,
    trace: BufWriter<File>,
    /// The first error of the file.
    error: Option<io::Error>,
}

/// A call in progress.
struct Call {
    node: usize,
    start: Instant,
    /// Duration of the calls inside this one, in ns.
    inner: u64,
}

/// Reactions of a thread group.
#[derive(Default)]
struct Reactions {
    /// Beginning of the present one.
    begun: Option<Instant>,
    /// Node that has taken longest in the present one, in ns without the calls inside of its own.
    slowest: Option<(u64, usize)>,
    /// The longest one, and the node that took longest in it.
    longest: Option<(Duration, Option<(u64, usize)>)>,
    /// Source with the shortest period.
    fastest: Option<(Duration, usize)>,
}

/// Observer that measures one thread group.
pub struct Measures<'a> {
    profile: &'a Mutex<Profile>,
    group: usize,
}

impl Profile {
    /// Returns a profile whose trace is written to `path`.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn to_file(info: &'static Info, path: &Path) -> io::Result<Self> {
        let mut trace = BufWriter::new(File::create(path)?);
        write!(trace, "[{{\"ph\":\"M\",\"pid\":1,\"name\":\"process_name\",\"args\":{{\"name\":\"{}\"}}}}", info.name)?;
        for (group, g) in info.groups.iter().enumerate() {
            let (tid, name) = (group + 1, g.name);
            write!(
                trace,
                ",\n{{\"ph\":\"M\",\"pid\":1,\"tid\":{tid},\"name\":\"thread_name\",\"args\":{{\"name\":\"{name}\"}}}}"
            )?;
        }
        let nodes = info.nodes.len();
        Ok(Self {
            info,
            start: Instant::now(),
            running: (0..info.groups.len().max(1)).map(|_| vec![]).collect(),
            active: vec![false; nodes],
            calls: (0..nodes).map(|_| None).collect(),
            own: vec![0; nodes],
            reactions: (0..info.groups.len().max(1)).map(|_| Reactions::default()).collect(),
            traced: 0,
            trace,
            error: None,
        })
    }

    /// Returns the observer of a thread group.
    pub fn of_group(profile: &Mutex<Self>, group: usize) -> Measures<'_> {
        Measures { profile, group }
    }

    fn begin(&mut self, group: usize, node: usize) {
        if let Some(reactions) = self.reactions.get_mut(group) {
            let fastest = self.info.nodes[node].every.map(|every| (every, node));
            reactions.fastest = reactions.fastest.into_iter().chain(fastest).min();
        }
        if let Some(calls) = self.running.get_mut(group) {
            calls.push(Call { node, start: Instant::now(), inner: 0 });
        }
    }

    fn end(&mut self, group: usize, node: usize, end: Instant) {
        let Some(Call { node: running, start, inner }) = self.running.get_mut(group).and_then(Vec::pop) else { return };
        debug_assert_eq!(running, node, "calls end in the order in which they begin");
        let took = nanos(end - start);
        self.own[node] += took.saturating_sub(inner);
        let reactions = &mut self.reactions[group];
        reactions.slowest = reactions.slowest.max(Some((took.saturating_sub(inner), node)));
        if let Some(outer) = self.running[group].last_mut() {
            outer.inner += took;
        }
        // Three significant digits for all durations: the histogram grows with the longest call.
        let calls = self.calls[node].get_or_insert_with(|| Histogram::new(3).expect("three digits are allowed"));
        calls.saturating_record(took);
        self.traced += 1;
        if self.traced <= MAX_TRACED && self.error.is_none() {
            self.error = self.write(group, node, start, took).err();
        }
    }

    fn write(&mut self, group: usize, node: usize, start: Instant, took: u64) -> io::Result<()> {
        let (name, active) = (self.info.nodes[node].name, self.active[node]);
        let (at, took) = (nanos(start - self.start) as f64 / 1e3, took as f64 / 1e3);
        let tid = group + 1;
        let colour = if active { ",\"cname\":\"thread_state_running\"" } else { "" };
        write!(
            self.trace,
            ",\n{{\"ph\":\"X\",\"pid\":1,\"tid\":{tid},\"name\":\"{name}\",\"ts\":{at:.3},\"dur\":{took:.3},\"args\":{{\"active\":{active}}}{colour}}}"
        )
    }

    fn begin_reaction(&mut self, group: usize) {
        if let Some(reactions) = self.reactions.get_mut(group) {
            (reactions.begun, reactions.slowest) = (Some(Instant::now()), None);
        }
    }

    fn end_reaction(&mut self, group: usize) {
        if let Some(reactions) = self.reactions.get_mut(group)
            && let Some(begun) = reactions.begun.take()
        {
            reactions.longest = reactions.longest.max(Some((begun.elapsed(), reactions.slowest)));
        }
    }

    /// Returns a warning for each thread group with a reaction that took longer than the shortest period of its
    /// sources, which then fire late.
    pub fn warnings(&self) -> Vec<String> {
        let warning = |(group, reactions): (usize, &Reactions)| {
            let ((longest, slowest), (every, source)) = (reactions.longest?, reactions.fastest?);
            if longest <= every {
                return None;
            }
            let name = |node: usize| self.info.nodes[node].name;
            let thread = self.info.groups.get(group).map_or(String::new(), |group| format!(" of `{}`", group.name));
            let most =
                slowest.map(|(own, node)| format!(", {:.1?} of it in `{}`", Duration::from_nanos(own), name(node)));
            Some(format!(
                "a reaction{thread} took {longest:.1?}{}, but `{}` fires every {every:?}: move slow nodes to a thread group of their own (`on slow`)",
                most.unwrap_or_default(),
                name(source)
            ))
        };
        self.reactions.iter().enumerate().filter_map(warning).collect()
    }

    /// Completes the trace.
    ///
    /// # Errors
    /// The file could not be written.
    pub fn finish(&mut self) -> io::Result<()> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        self.trace.write_all(b"]\n")?;
        self.trace.flush()
    }

    /// Returns `true` if there were more calls than the [`MAX_TRACED`] of the trace.
    pub fn is_cut(&self) -> bool {
        self.traced > MAX_TRACED
    }

    /// Returns a table with a line for each node that ran, sorted by its share of the time: number of calls, mean,
    /// median, 99 % quantile, maximum, and share of the time of all nodes. The times of an `each` include its body; its
    /// share does not.
    pub fn table(&self) -> String {
        let total: u64 = self.own.iter().sum();
        let mut rows: Vec<(usize, &Histogram<u64>)> =
            self.calls.iter().enumerate().filter_map(|(node, calls)| Some((node, calls.as_ref()?))).collect();
        rows.sort_by_key(|(node, _)| (std::cmp::Reverse(self.own[*node]), *node));
        let width = rows.iter().map(|(node, _)| self.info.nodes[*node].name.chars().count()).max().unwrap_or(0).max(4);
        let mut text = format!(
            "{:width$}{:>12}{:>12}{:>12}{:>12}{:>12}{:>9}\n",
            "node", "count", "mean", "p50", "p99", "max", "share"
        );
        for (node, calls) in rows {
            let share = 100.0 * self.own[node] as f64 / total.max(1) as f64;
            let time = |ns: u64| format!("{:.2?}", Duration::from_nanos(ns));
            let _ = writeln!(
                text,
                "{:width$}{:>12}{:>12}{:>12}{:>12}{:>12}{share:>7.1} %",
                self.info.nodes[node].name,
                calls.len(),
                time(calls.mean() as u64),
                time(calls.value_at_quantile(0.5)),
                time(calls.value_at_quantile(0.99)),
                time(calls.max()),
            );
        }
        text
    }
}

fn nanos(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}

impl Measures<'_> {
    fn with(&self, look: impl FnOnce(&mut Profile)) {
        look(&mut self.profile.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl Observer for Measures<'_> {
    fn fired(&mut self, node: usize) {
        self.with(|profile| profile.begin(self.group, node));
    }
    fn handled(&mut self, connection: usize) {
        self.with(|profile| profile.begin(self.group, profile.info.connections[connection].to));
    }
    fn finished(&mut self, node: usize) {
        let end = Instant::now();
        self.with(|profile| profile.end(self.group, node, end));
    }
    fn activity(&mut self, node: usize, active: bool) {
        self.with(|profile| profile.active[node] = active);
    }
    fn before_reaction(&mut self, _now: Time, _params: &mut impl Parameters) {
        self.with(|profile| profile.begin_reaction(self.group));
    }
    fn after_reaction(&mut self, _next: Next) {
        self.with(|profile| profile.end_reaction(self.group));
    }
}

impl Observer for Option<Measures<'_>> {
    fn fired(&mut self, node: usize) {
        if let Some(measures) = self {
            measures.fired(node);
        }
    }
    fn handled(&mut self, connection: usize) {
        if let Some(measures) = self {
            measures.handled(connection);
        }
    }
    fn finished(&mut self, node: usize) {
        if let Some(measures) = self {
            measures.finished(node);
        }
    }
    fn activity(&mut self, node: usize, active: bool) {
        if let Some(measures) = self {
            measures.activity(node, active);
        }
    }
    fn before_reaction(&mut self, now: Time, params: &mut impl Parameters) {
        if let Some(measures) = self {
            measures.before_reaction(now, params);
        }
    }
    fn after_reaction(&mut self, next: Next) {
        if let Some(measures) = self {
            measures.after_reaction(next);
        }
    }
}
