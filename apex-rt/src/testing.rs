//! Runtime of generated tests: a program in simulated time, tokens for its ports, and expectations.

mod feed;
mod study;
mod timeline;

pub use study::{Study, recorded, serve};
pub use timeline::Timeline;

use crate::{Next, Parameters, Program, Time};
use core::{fmt::Debug, time::Duration};
use feed::{Fed, Feed};
use timeline::Sighting;

/// Time between two reactions of a program that has sources without a period.
const STEP: Duration = Duration::from_millis(1);

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

/// Condition on the state of a program.
type Holds<P> = fn(&P) -> bool;

/// Time limit of an expectation.
#[derive(Debug, Clone, Copy)]
pub enum Until {
    /// Time after the start.
    By(Duration),
    /// Time after the previous statement of the test.
    Within(Duration),
}

impl Until {
    /// The limit in the message of a failure.
    fn text(limit: Option<Self>) -> String {
        match limit {
            Some(Self::By(time)) => format!(" by {}", Time::ZERO + time),
            Some(Self::Within(time)) => format!(" within {time:?}"),
            None => String::new(),
        }
    }
}

/// Subject of a `never` statement.
enum Forbidden<P> {
    /// Tokens that satisfy the check with this number.
    Tokens(usize),
    /// A state.
    State(Holds<P>),
}

/// Part of the past and future that an expectation looks at.
#[derive(Debug, Clone, Copy)]
struct Window {
    start: Time,
    end: Time,
    /// Number of reactions before the window.
    before: u64,
}

/// A running test. An *instant* is all that happens at one time: the reaction that is due then, and one more for each
/// token that is fed, in the order of feeding.
pub struct Test<P> {
    name: &'static str,
    program: P,
    now: Time,
    /// Time of the next reaction that the program asked for.
    wake: Option<Time>,
    /// Time at which a token came to `exit` or `abort`.
    ended: Option<Time>,
    feeds: Vec<Feed<P>>,
    /// Number of `feed` statements until now.
    feed_count: usize,
    /// `true` after a `wait`, until something happens at its end.
    is_waiting: bool,
    nevers: Vec<(Forbidden<P>, &'static str, &'static str)>,
    timeline: Timeline,
    drain: fn(&mut P, &mut Timeline),
    /// Number of reactions.
    reactions: u64,
    /// Number of reactions before the last `feed`.
    fed: u64,
    /// Tokens that later expectations wait for, in the order of their arrival.
    sightings: Vec<Sighting>,
    /// Number of tokens up to the last one that was expected, by probe.
    expected: Vec<u64>,
    /// Time of the last token of all lists.
    last_of_lists: Time,
    /// Time of the last token of all recordings.
    last_of_recordings: Time,
}

impl<P: Program + Parameters + 'static> Test<P> {
    /// Returns the test `name` of `program`; `drain` empties its probes.
    pub fn new(name: &'static str, mut program: P, drain: fn(&mut P, &mut Timeline)) -> Self {
        study::set(&mut program);
        let timeline = Timeline::new(P::INFO.nodes.iter().map(|n| n.name).collect());
        Self {
            name,
            program,
            now: Time::ZERO,
            wake: Some(Time::ZERO),
            ended: None,
            feeds: vec![],
            feed_count: 0,
            is_waiting: false,
            nevers: vec![],
            timeline,
            drain,
            reactions: 0,
            fed: 0,
            sightings: vec![],
            expected: vec![],
            last_of_lists: Time::ZERO,
            last_of_recordings: Time::ZERO,
        }
    }

    /// Returns one run of the study `name` of `program`, with this number of goals; `drain` empties its probes.
    pub fn of_study(name: &'static str, program: P, drain: fn(&mut P, &mut Timeline), goals: usize) -> Self {
        let mut test = Self::new(name, program, drain);
        test.timeline.score(goals);
        test
    }

    /// Runs until all lists have been fed, and ends the test. A recording may be longer than the test.
    ///
    /// # Panics
    /// A token that was due has never been put in.
    pub fn finish(mut self) {
        self.end(self.last_of_lists);
    }

    /// Runs until all feeds that end have ended, and returns the last values of the goals.
    ///
    /// # Panics
    /// A token that was due has never been put in.
    pub fn goals(mut self) -> Vec<f64> {
        self.end(self.last_of_lists.max(self.last_of_recordings));
        self.timeline.goals()
    }

    /// Feeds `tokens` to `port` from now on, one every `period`. A single token with a period is repeated. A token that
    /// finds no room is put in as soon as there is some.
    pub fn feed<T: Clone + 'static>(
        &mut self,
        (port, place): (&'static str, &'static str),
        tokens: impl IntoIterator<Item = T>,
        period: Option<Duration>,
        put: fn(&mut P, T) -> Result<(), T>,
    ) {
        let tokens: Vec<T> = tokens.into_iter().collect();
        let Some(others) = tokens.len().checked_sub(1) else { return };
        if let Some(period) = period {
            let others = u32::try_from(others).unwrap_or(u32::MAX);
            self.last_of_lists = self.last_of_lists.max(self.now + period.saturating_mul(others));
        }
        let (mut at, repeats) = (0, others == 0);
        let feed = move |program: &mut P, due: Time| {
            if put(program, tokens[at].clone()).is_err() {
                return Fed::NoRoom;
            }
            at = if repeats { 0 } else { at + 1 };
            let next = period.filter(|_| repeats || at < tokens.len()).map(|period| due + period);
            next.map_or(Fed::Last, Fed::Next)
        };
        let feed = Feed::new(self.feed_count, (port, place), self.now, feed);
        self.add(if repeats && period.is_some() { feed.open() } else { feed });
    }

    /// Feeds the tokens of a recording, which starts now, to `port` at their times. A token that finds no room is put
    /// in as soon as there is some.
    #[cfg(feature = "record")]
    pub fn feed_at<T: Clone + 'static>(
        &mut self,
        (port, place): (&'static str, &'static str),
        tokens: crate::record::Tokens<T>,
        put: fn(&mut P, T) -> Result<(), T>,
    ) {
        let (start, mut at) = (self.now, 0);
        let tokens = tokens.begun_at(start);
        let Some((first, _)) = tokens.first() else { return };
        if let Some((last, _)) = tokens.last() {
            self.last_of_recordings = self.last_of_recordings.max(start + *last);
        }
        let first = start + *first;
        let feed = move |program: &mut P, _due: Time| {
            if put(program, tokens[at].1.clone()).is_err() {
                return Fed::NoRoom;
            }
            at += 1;
            tokens.get(at).map_or(Fed::Last, |(time, _)| Fed::Next(start + *time))
        };
        self.add(Feed::new(self.feed_count, (port, place), first, feed).open());
    }

    fn add(&mut self, feed: Feed<P>) {
        self.is_waiting = false;
        let before = self.now - Duration::from_nanos(1);
        let replaced = self.feeds.iter().filter(|other| other.is_replaced_by(&feed));
        if let Some((what, place)) = replaced.filter_map(|other| Some((other.left(before, None)?, other.place))).next()
        {
            self.fail(&what, self.now, place);
        }
        self.feeds.retain(|other| !other.is_replaced_by(&feed));
        self.feeds.push(feed);
        self.feed_count += 1;
        self.fed = self.reactions;
    }

    /// Lets `time` pass. The program reacts at its end with the next statement: a token that is fed then is there
    /// before a timeout of that instant.
    pub fn wait(&mut self, time: Duration) {
        let until = self.now + time;
        if !time.is_zero() {
            self.run(until - Duration::from_nanos(1), |_| false);
        }
        self.now = until;
        self.is_waiting = true;
    }

    /// Runs until a token satisfies check `check`, unless one already has that no expectation before has used. Tokens
    /// of the same probe up to this one are then used.
    ///
    /// # Panics
    /// If that does not happen in time. The message has all events until then.
    pub fn expect(&mut self, check: usize, until: Option<Until>, text: &'static str, place: &'static str) {
        let window = self.window(until);
        if !self.run(window.end, |test| test.sighting(check, window).is_some()) {
            let hint = self.hint(check, window);
            self.unexpected(text, until, window, &hint, place);
        }
        if let Some(Sighting { probe, token, .. }) = self.sighting(check, window) {
            self.expected.resize(self.expected.len().max(probe + 1), 0);
            self.expected[probe] = token + 1;
        }
        // Checks are numbered in the order of the statements.
        self.sightings.retain(|sighting| sighting.check > check);
    }

    /// Runs until the state `holds`.
    ///
    /// # Panics
    /// If that does not happen in time. The message has all events until then.
    pub fn expect_state(&mut self, holds: Holds<P>, until: Option<Until>, text: &'static str, place: &'static str) {
        let window = self.window(until);
        let is_past = window.end < self.now;
        if !self.run(window.end, |test| !is_past && holds(&test.program)) {
            let hint = if is_past { ", which is past: a state is looked at now" } else { "" };
            self.unexpected(text, until, window, hint, place);
        }
    }

    /// Declares that no token must satisfy check `check` from now on.
    pub fn never(&mut self, check: usize, text: &'static str, place: &'static str) {
        self.arrive();
        self.nevers.push((Forbidden::Tokens(check), text, place));
    }

    /// Declares that the state must not hold from now on.
    pub fn never_state(&mut self, holds: Holds<P>, text: &'static str, place: &'static str) {
        self.arrive();
        self.nevers.push((Forbidden::State(holds), text, place));
    }

    /// The window of an expectation with this limit. One that counts from the previous step begins at this instant, but
    /// after the reactions before a token was fed: these are not its effect.
    fn window(&self, until: Option<Until>) -> Window {
        let all = Window { start: Time::ZERO, end: self.now, before: 0 };
        match until {
            Some(Until::By(time)) => Window { end: Time::ZERO + time, ..all },
            Some(Until::Within(time)) => Window { start: self.now, end: self.now + time, before: self.fed },
            None => all,
        }
    }

    /// The first token in `window` that satisfies the check and was not expected before.
    fn sighting(&self, check: usize, window: Window) -> Option<Sighting> {
        let fits = |seen: &&Sighting| {
            seen.check == check
                && seen.time >= window.start
                && seen.time <= window.end
                && seen.reaction >= window.before
                && !self.is_used(seen)
        };
        self.sightings.iter().find(fits).copied()
    }

    fn is_used(&self, seen: &Sighting) -> bool {
        self.expected.get(seen.probe).is_some_and(|expected| seen.token < *expected)
    }

    /// The reason why a token that came is not an expected one, for the message of a failure.
    fn hint(&self, check: usize, window: Window) -> String {
        match self.sightings.iter().rfind(|seen| seen.check == check) {
            Some(seen) if self.is_used(seen) => {
                format!(": the one at {} does not count, because an earlier `expect` has used it", seen.time)
            }
            Some(seen) if seen.time > window.end => format!(": it came at {}", seen.time),
            Some(seen) => format!(": it came before, at {}", seen.time),
            None => String::new(),
        }
    }

    fn unexpected(&self, text: &str, until: Option<Until>, window: Window, hint: &str, place: &str) -> ! {
        let what = format!("expected `{text}`{}{hint}", Until::text(until));
        self.fail(&what, window.end.max(self.now), place)
    }

    /// Runs instant by instant until `stop` holds, or up to `end`. Returns `true` if `stop` holds.
    fn run(&mut self, end: Time, stop: impl Fn(&Self) -> bool) -> bool {
        loop {
            self.settle();
            if stop(self) {
                return true;
            }
            let due = self.feeds.iter().map(|feed| feed.due);
            match due.chain(self.wake).filter(|time| *time <= end && *time > self.now).min() {
                Some(time) => self.now = time,
                None => return false,
            }
        }
    }

    /// Ends a `wait` that nothing was fed after: all that is due at its end happens before what is declared next.
    fn arrive(&mut self) {
        if self.is_waiting {
            self.settle();
        }
    }

    /// Lets all happen that is due now. Each token that is fed has a reaction of its own, so that tokens come in the
    /// order of feeding, and one that found no room comes as soon as there is some.
    fn settle(&mut self) {
        self.is_waiting = false;
        if self.put() || self.wake.is_some_and(|time| time <= self.now) {
            self.react();
        }
        while self.put() {
            self.react();
        }
    }

    /// Puts the first token in that is due and finds room. Returns `false` if there is none, or if the program has
    /// ended.
    fn put(&mut self) -> bool {
        if self.ended.is_some() {
            return false;
        }
        self.feeds.sort_by_key(Feed::order);
        let due = self.feeds.iter_mut().take_while(|feed| feed.due <= self.now).enumerate();
        for (number, feed) in due {
            match feed.put(&mut self.program) {
                Fed::NoRoom => continue,
                Fed::Next(_) => {}
                Fed::Last => drop(self.feeds.remove(number)),
            }
            return true;
        }
        false
    }

    /// Executes one reaction, and looks at what it did.
    fn react(&mut self) {
        let next = self.program.react_with(self.now, &mut self.timeline);
        self.ended = matches!(next, Next::Exit(_)).then_some(self.now);
        self.wake = match next {
            Next::Now => Some(self.now + STEP),
            Next::At(time) => Some(time).filter(|time| *time > self.now),
            Next::Input | Next::Exit(_) => None,
        };
        self.timeline.begin(self.now, self.reactions);
        self.reactions += 1;
        (self.drain)(&mut self.program, &mut self.timeline);
        let seen = self.timeline.end();
        let happened = |(what, ..): &&(Forbidden<P>, _, _)| match what {
            Forbidden::Tokens(check) => seen.iter().any(|sighting| sighting.check == *check),
            Forbidden::State(holds) => holds(&self.program),
        };
        if let Some((_, text, place)) = self.nevers.iter().find(happened) {
            self.fail(&format!("`{text}` happened, but never should"), self.now, place);
        }
        self.sightings.extend(seen);
    }

    /// Runs up to `time`, and checks that each token that was due has been put in.
    fn end(&mut self, time: Time) {
        self.run(time.max(self.now), |_| false);
        let mut left = self.feeds.iter().filter_map(|feed| Some((feed.left(self.now, self.ended)?, feed.place)));
        if let Some((what, place)) = left.next() {
            self.fail(&format!("the test ends, but {what}"), self.now, place);
        }
    }

    fn fail(&self, what: &str, time: Time, place: &str) -> ! {
        panic!("test `{}` failed at {time}: {what}\n  --> {place}\n{}", self.name, self.timeline.text().trim_end());
    }
}
