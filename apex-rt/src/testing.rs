//! Runtime of generated tests: a program in simulated time, tokens for its ports, and expectations.

mod study;

pub use study::{Study, recorded, serve};

use crate::{Next, Observer, Parameters, Program, Time};
use core::{
    fmt::{Debug, Display, Write as _},
    ops::Deref,
    time::Duration,
};

/// Time between two reactions of a program that has sources without a period.
const STEP: Duration = Duration::from_millis(1);
/// Number of moments in the message of a failed test.
const SHOWN: usize = 20;
/// Number of characters of a token in that message: a laser scan has thousands.
const LONGEST: usize = 120;

/// Tokens at a place that a test observes, in one reaction.
#[derive(Debug)]
pub struct Probe<T> {
    tokens: Vec<T>,
}

impl<T> Probe<T> {
    /// Returns a probe without tokens.
    pub const fn new() -> Self {
        Self { tokens: Vec::new() }
    }

    /// Adds a token.
    pub fn saw(&mut self, token: T) {
        self.tokens.push(token);
    }

    /// Returns `true` if `test` holds for one of the tokens.
    pub fn any(&self, test: impl Fn(&T) -> bool) -> bool {
        self.tokens.iter().any(test)
    }

    /// Takes all tokens out.
    pub fn take(&mut self) -> Vec<T> {
        core::mem::take(&mut self.tokens)
    }
}

impl<T> Default for Probe<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Wrapper that shows a token as text, even if its type has no `Debug`.
pub struct Shown<'a, T>(pub &'a T);

/// Text of tokens with `Debug`.
pub trait ByDebug {
    /// Returns the token as text.
    fn shown(&self) -> String;
}

impl<T: Debug> ByDebug for Shown<'_, T> {
    fn shown(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// Text of all other tokens.
pub trait ByType {
    /// Returns the token as text.
    fn shown(&self) -> String;
}

impl<T> ByType for &Shown<'_, T> {
    fn shown(&self) -> String {
        "a token".to_owned()
    }
}

/// Events of one point in time.
#[derive(Debug, Default, Clone, PartialEq)]
struct Moment {
    fired: Vec<&'static str>,
    notes: Vec<String>,
}

/// Events of a test until now, for the message of a failure.
#[derive(Debug)]
pub struct Timeline {
    names: Vec<&'static str>,
    now: Moment,
    moments: Vec<(Time, Moment)>,
    /// Last values of the goals of a study, NaN before the first one. A study needs no list of events.
    goals: Option<Vec<f64>>,
}

impl Timeline {
    /// Takes the value of a goal of a study.
    pub fn goal(&mut self, number: usize, value: f64) {
        if let Some(goal) = self.goals.as_mut().and_then(|goals| goals.get_mut(number)) {
            *goal = value;
        }
    }

    /// The list of what happens now; none in a study.
    fn listed(&mut self) -> Option<&mut Moment> {
        self.goals.is_none().then_some(&mut self.now)
    }

    /// Adds a token at a place that the test observes.
    pub fn token(&mut self, port: &str, token: &str) {
        match token.char_indices().nth(LONGEST) {
            Some((end, _)) => self.now.notes.push(format!("{port}: {} …", &token[..end])),
            None => self.now.notes.push(format!("{port}: {token}")),
        }
    }

    fn end(&mut self, time: Time) {
        let moment = core::mem::take(&mut self.now);
        if moment != Moment::default() {
            self.moments.push((time, moment));
        }
    }

    fn text(&self) -> String {
        let mut text = String::new();
        let left_out = self.moments.len().saturating_sub(SHOWN);
        if left_out > 0 {
            let _ = writeln!(text, "  … {left_out} earlier moments");
        }
        for (time, moment) in &self.moments[left_out..] {
            let fired = match moment.fired.as_slice() {
                [] => None,
                names => Some(format!("{} fired", names.join(", "))),
            };
            let what: Vec<String> = fired.into_iter().chain(moment.notes.iter().cloned()).collect();
            let _ = writeln!(text, "  {time}  {}", what.join("; "));
        }
        if text.is_empty() { "  nothing\n".to_owned() } else { text }
    }
}

impl Observer for Timeline {
    fn fired(&mut self, node: usize) {
        let name = self.names[node];
        if let Some(now) = self.listed().filter(|now| !now.fired.contains(&name)) {
            now.fired.push(name);
        }
    }
    fn activity(&mut self, node: usize, active: bool) {
        let name = self.names[node];
        if let Some(now) = self.listed() {
            now.notes.push(format!("{name} is {}", if active { "active" } else { "no longer active" }));
        }
    }
    fn failed(&mut self, node: usize, error: &impl Display) {
        let name = self.names[node];
        if let Some(now) = self.listed() {
            now.notes.push(format!("{name} failed: {error}"));
        }
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let name = self.names[node];
        if let Some(now) = self.listed() {
            now.notes.push(format!("{name} refused {value:?} for {parameter}"));
        }
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let names = nodes.iter().zip(counts).filter(|(_, count)| **count > 0).map(|(node, _)| self.names[*node]);
        let names: Vec<&str> = names.collect();
        self.now.notes.push(format!("endless cycle of {}", names.join(", ")));
    }
}

/// Function that puts the next token of a test in, and returns the time of the one after it.
type Feed<P> = Box<dyn FnMut(&mut P, Time) -> Option<Time>>;
/// Condition that a test checks.
type Seen<P> = fn(&P) -> bool;

/// Time limit of an expectation.
#[derive(Debug, Clone, Copy)]
pub enum Until {
    /// Time after the start.
    By(Duration),
    /// Time after the previous statement of the test.
    Within(Duration),
}

/// A running test.
pub struct Test<P> {
    name: &'static str,
    program: P,
    now: Time,
    feeds: Vec<(Time, Feed<P>)>,
    nevers: Vec<(Seen<P>, &'static str, &'static str)>,
    timeline: Timeline,
    drain: fn(&mut P, &mut Timeline),
    /// Time of the last token of the feeds that end.
    last: Time,
}

impl<P: Program + Parameters + 'static> Test<P> {
    /// Returns the test `name` of `program`; `drain` empties its probes.
    pub fn new(name: &'static str, mut program: P, drain: fn(&mut P, &mut Timeline)) -> Self {
        study::set(&mut program);
        let names = P::INFO.nodes.iter().map(|n| n.name).collect();
        let timeline = Timeline { names, now: Moment::default(), moments: vec![], goals: None };
        let (now, last) = (Time::ZERO, Time::ZERO);
        Self { name, program, now, feeds: vec![], nevers: vec![], timeline, drain, last }
    }

    /// Returns one run of the study `name` of `program`, with this number of goals; `drain` empties its probes.
    pub fn of_study(name: &'static str, program: P, drain: fn(&mut P, &mut Timeline), goals: usize) -> Self {
        let mut test = Self::new(name, program, drain);
        test.timeline.goals = Some(vec![f64::NAN; goals]);
        test
    }

    /// Runs until all feeds that end have ended, and returns the last values of the goals.
    pub fn goals(mut self) -> Vec<f64> {
        self.run(self.last.max(self.now), None);
        self.timeline.goals.unwrap_or_default()
    }

    /// Feeds `tokens` from now on, one every `period`. A single token with a period is repeated. A token that finds no
    /// room is put in as soon as there is some.
    pub fn feed<T: Clone + 'static>(
        &mut self,
        tokens: impl IntoIterator<Item = T>,
        period: Option<Duration>,
        put: fn(&mut P, T) -> Result<(), T>,
    ) {
        let tokens: Vec<T> = tokens.into_iter().collect();
        if let (Some(period), Some(others)) = (period, tokens.len().checked_sub(1)) {
            let others = u32::try_from(others).unwrap_or(u32::MAX);
            self.last = self.last.max(self.now + period.saturating_mul(others));
        }
        let mut at = 0;
        let feed = move |program: &mut P, due: Time| {
            if put(program, tokens[at].clone()).is_err() {
                return Some(due);
            }
            let repeats = tokens.len() == 1;
            at = if repeats { 0 } else { at + 1 };
            period.filter(|_| repeats || at < tokens.len()).map(|period| due + period)
        };
        self.feeds.push((self.now, Box::new(feed)));
    }

    /// Feeds each of `tokens` at its time after now. A token that finds no room is put in as soon as there is some.
    pub fn feed_at<T: Clone + 'static>(
        &mut self,
        tokens: impl Deref<Target = [(Duration, T)]> + 'static,
        put: fn(&mut P, T) -> Result<(), T>,
    ) {
        let (start, mut at) = (self.now, 0);
        let Some((first, _)) = tokens.first() else { return };
        if let Some((last, _)) = tokens.last() {
            self.last = self.last.max(start + *last);
        }
        let first = start + *first;
        let feed = move |program: &mut P, due: Time| {
            if put(program, tokens[at].1.clone()).is_err() {
                return Some(due);
            }
            at += 1;
            tokens.get(at).map(|(time, _)| start + *time)
        };
        self.feeds.push((first, Box::new(feed)));
    }

    /// Lets `time` pass.
    pub fn wait(&mut self, time: Duration) {
        let until = self.now + time;
        self.run(until, None);
        self.now = until;
    }

    /// Runs until `seen` holds.
    ///
    /// # Panics
    /// If that does not happen in time. The message has all events until then.
    pub fn expect(&mut self, seen: Seen<P>, until: Option<Until>, text: &'static str, place: &'static str) {
        let end = match until {
            Some(Until::By(time)) => Time::ZERO + time,
            Some(Until::Within(time)) => self.now + time,
            None => self.now,
        };
        if !self.run(end, Some(seen)) {
            let limit = match until {
                Some(Until::By(_)) => format!(" by {end}"),
                Some(Until::Within(time)) => format!(" within {time:?}"),
                None => String::new(),
            };
            self.fail(&format!("expected `{text}`{limit}"), end, place);
        }
    }

    /// Declares that `seen` must not hold from now on.
    pub fn never(&mut self, seen: Seen<P>, text: &'static str, place: &'static str) {
        self.nevers.push((seen, text, place));
    }

    /// Runs until `stop` holds, or up to `end`. Returns `true` if `stop` holds.
    fn run(&mut self, end: Time, stop: Option<Seen<P>>) -> bool {
        loop {
            let next = self.react();
            let met = stop.is_some_and(|stop| stop(&self.program));
            if let Some((_, text, place)) = self.nevers.iter().find(|(seen, ..)| seen(&self.program)).copied() {
                self.close();
                self.fail(&format!("`{text}` happened, but never should"), self.now, place);
            }
            self.close();
            if met {
                return true;
            }
            let due = self.feeds.iter().map(|(due, _)| *due).filter(|due| *due > self.now);
            let wake = match next {
                Next::Now => Some(self.now + STEP),
                Next::At(time) => Some(time),
                Next::Input | Next::Exit(_) => None,
            };
            match due.chain(wake).min().filter(|time| *time <= end && *time > self.now) {
                Some(time) => self.now = time,
                None => return false,
            }
        }
    }

    /// Executes one reaction, after feeding the tokens that are due.
    fn react(&mut self) -> Next {
        for (due, feed) in core::mem::take(&mut self.feeds) {
            let mut feed = feed;
            let next = if due <= self.now { feed(&mut self.program, due) } else { Some(due) };
            if let Some(next) = next {
                self.feeds.push((next, feed));
            }
        }
        self.program.react_with(self.now, &mut self.timeline)
    }

    fn close(&mut self) {
        (self.drain)(&mut self.program, &mut self.timeline);
        self.timeline.end(self.now);
    }

    fn fail(&self, what: &str, time: Time, place: &str) -> ! {
        panic!(
            "test `{}` failed at {time}: {what}\n  --> {place}\nwhat happened:\n{}",
            self.name,
            self.timeline.text().trim_end()
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_tokens_are_cut() {
        let mut timeline = Timeline { names: vec![], now: Moment::default(), moments: vec![], goals: None };
        timeline.token("name", &"é".repeat(LONGEST));
        timeline.token("scan", &"é".repeat(10_000));
        let shown = "é".repeat(LONGEST);
        assert_eq!(timeline.now.notes, [format!("name: {shown}"), format!("scan: {shown} …")]);
    }
}
