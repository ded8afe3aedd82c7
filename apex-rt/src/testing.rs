//! What generated tests call: a program on simulated time, tokens for its ports, and what is expected of it.

use crate::{Next, Observer, Program, Time};
use core::{
    fmt::{Debug, Display, Write as _},
    time::Duration,
};

/// A program without a pace of its own is called again after so long.
const STEP: Duration = Duration::from_millis(1);
/// So many moments of a failed test are shown.
const SHOWN: usize = 20;
/// So many characters of a token are shown: a laser scan has thousands.
const LONGEST: usize = 120;

/// The tokens that came to a place where a test looks, in one reaction.
#[derive(Debug)]
pub struct Probe<T> {
    tokens: Vec<T>,
}

impl<T> Probe<T> {
    /// Nothing came yet.
    pub const fn new() -> Self {
        Self { tokens: Vec::new() }
    }

    /// A token came.
    pub fn saw(&mut self, token: T) {
        self.tokens.push(token);
    }

    /// Whether a token came for which `test` holds.
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

/// A token as text, also if its type has no `Debug`.
pub struct Shown<'a, T>(pub &'a T);

/// Tokens with `Debug`.
pub trait ByDebug {
    /// The token as text.
    fn shown(&self) -> String;
}

impl<T: Debug> ByDebug for Shown<'_, T> {
    fn shown(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// All other tokens.
pub trait ByType {
    /// The token as text.
    fn shown(&self) -> String;
}

impl<T> ByType for &Shown<'_, T> {
    fn shown(&self) -> String {
        "a token".to_owned()
    }
}

/// What happened at one moment.
#[derive(Debug, Default, Clone, PartialEq)]
struct Moment {
    fired: Vec<&'static str>,
    notes: Vec<String>,
}

/// What happened so far, for the message of a test that fails.
#[derive(Debug)]
pub struct Timeline {
    names: Vec<&'static str>,
    now: Moment,
    moments: Vec<(Time, Moment)>,
}

impl Timeline {
    /// A token came to a place where the test looks.
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
            let _ = writeln!(text, "  … {left_out} moments before");
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
        if !self.now.fired.contains(&name) {
            self.now.fired.push(name);
        }
    }
    fn activity(&mut self, node: usize, active: bool) {
        let name = self.names[node];
        self.now.notes.push(format!("{name} is {}", if active { "active" } else { "no longer active" }));
    }
    fn failed(&mut self, node: usize, error: &impl Display) {
        self.now.notes.push(format!("{} failed: {error}", self.names[node]));
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        self.now.notes.push(format!("{} refused {value:?} for {parameter}", self.names[node]));
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let names = nodes.iter().zip(counts).filter(|(_, count)| **count > 0).map(|(node, _)| self.names[*node]);
        let names: Vec<&str> = names.collect();
        self.now.notes.push(format!("endless loop of {}", names.join(", ")));
    }
}

/// Tokens that a test feeds: puts the next one in, and says when the one after it is due.
type Feed<P> = Box<dyn FnMut(&mut P, Time) -> Option<Time>>;
/// Something that a test looks for.
type Seen<P> = fn(&P) -> bool;

/// Until when something is expected.
#[derive(Debug, Clone, Copy)]
pub enum Until {
    /// So long after the start.
    By(Duration),
    /// So long after the step before.
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
}

impl<P: Program + 'static> Test<P> {
    /// Test `name` of `program`; `drain` empties its probes.
    pub fn new(name: &'static str, program: P, drain: fn(&mut P, &mut Timeline)) -> Self {
        let names = P::INFO.nodes.iter().map(|n| n.name).collect();
        let timeline = Timeline { names, now: Moment::default(), moments: vec![] };
        Self { name, program, now: Time::ZERO, feeds: vec![], nevers: vec![], timeline, drain }
    }

    /// Feeds `tokens` from now on, one every `period`; a single one with a period again and again. A token that
    /// finds no room is put in as soon as there is some.
    pub fn feed<T: Clone + 'static>(
        &mut self,
        tokens: impl IntoIterator<Item = T>,
        period: Option<Duration>,
        put: fn(&mut P, T) -> Result<(), T>,
    ) {
        let tokens: Vec<T> = tokens.into_iter().collect();
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

    /// Feeds each of `tokens` at its time, counted from now. One that finds no room is put in as soon as there is some.
    pub fn feed_at<T: Clone + 'static>(&mut self, tokens: Vec<(Duration, T)>, put: fn(&mut P, T) -> Result<(), T>) {
        let (start, mut at) = (self.now, 0);
        let Some((first, _)) = tokens.first() else { return };
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

    /// Runs until `seen`.
    ///
    /// # Panics
    /// If that does not happen in time: with what happened instead.
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

    /// From now on `seen` must not happen.
    pub fn never(&mut self, seen: Seen<P>, text: &'static str, place: &'static str) {
        self.nevers.push((seen, text, place));
    }

    /// Runs up to `end`, or until `stop`.
    fn run(&mut self, end: Time, stop: Option<Seen<P>>) -> bool {
        loop {
            let next = self.react();
            let met = stop.is_some_and(|stop| stop(&self.program));
            if let Some((_, text, place)) = self.nevers.iter().find(|(seen, ..)| seen(&self.program)).copied() {
                self.close();
                self.fail(&format!("`{text}` was never to happen"), self.now, place);
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

    /// One reaction, with the tokens that are due.
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
        let mut timeline = Timeline { names: Vec::new(), now: Moment::default(), moments: Vec::new() };
        timeline.token("name", &"é".repeat(LONGEST));
        timeline.token("scan", &"é".repeat(10_000));
        let shown = "é".repeat(LONGEST);
        assert_eq!(timeline.now.notes, [format!("name: {shown}"), format!("scan: {shown} …")]);
    }
}
