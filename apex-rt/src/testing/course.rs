//! Course of a test: what it feeds, expects and forbids, whatever the type of its program. It is compiled once for all
//! tests.

use super::{
    feed::{Feed, Times},
    timeline::{Sighting, Timeline},
};
use crate::{Next, Time};
use core::time::Duration;

/// Time between two reactions of a program that has sources without a period.
const STEP: Duration = Duration::from_millis(1);

/// Program of a test.
pub trait Tested {
    /// Executes a reaction.
    fn react(&mut self, now: Time, timeline: &mut Timeline) -> Next;

    /// Empties the probes.
    fn drain(&mut self, timeline: &mut Timeline);

    /// Puts token `token` of `feed` statement `feed` in. Returns `false` if there is no room for it.
    fn put(&mut self, feed: usize, token: usize) -> bool;

    /// Returns `true` if state `state` holds, by its number among those that the test looks at.
    fn holds(&self, state: usize) -> bool;
}

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
enum Forbidden {
    /// Tokens that satisfy the check with this number.
    Tokens(usize),
    /// A state, by its number.
    State(usize),
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
pub struct Course {
    name: &'static str,
    /// Time of this instant.
    pub now: Time,
    /// Time of the next reaction that the program asked for.
    wake: Option<Time>,
    /// Time at which a token came to `exit` or `abort`.
    ended: Option<Time>,
    feeds: Vec<Feed>,
    /// Number of `feed` statements until now.
    feed_count: usize,
    /// `true` after a `wait`, until something happens at its end.
    is_waiting: bool,
    nevers: Vec<(Forbidden, &'static str, &'static str)>,
    /// Events until now.
    pub timeline: Timeline,
    /// Number of reactions.
    reactions: u64,
    /// Number of reactions before the last `feed`.
    fed: u64,
    /// Tokens that later expectations wait for, in the order of their arrival.
    sightings: Vec<Sighting>,
    /// Number of tokens up to the last one that was expected, by probe.
    expected: Vec<u64>,
    /// Time of the last token of all lists.
    pub last_of_lists: Time,
    /// Time of the last token of all recordings.
    pub last_of_recordings: Time,
}

impl Course {
    /// Returns the beginning of the test `name` of a program with nodes of these names.
    pub fn new(name: &'static str, nodes: Vec<&'static str>) -> Self {
        Self {
            name,
            now: Time::ZERO,
            wake: Some(Time::ZERO),
            ended: None,
            feeds: vec![],
            feed_count: 0,
            is_waiting: false,
            nevers: vec![],
            timeline: Timeline::new(nodes),
            reactions: 0,
            fed: 0,
            sightings: vec![],
            expected: vec![],
            last_of_lists: Time::ZERO,
            last_of_recordings: Time::ZERO,
        }
    }

    /// Feeds a number of tokens from now on.
    pub fn feed(&mut self, port: (&'static str, &'static str), tokens: usize, period: Option<Duration>) {
        if let Some(period) = period {
            let others = u32::try_from(tokens - 1).unwrap_or(u32::MAX);
            self.last_of_lists = self.last_of_lists.max(self.now + period.saturating_mul(others));
        }
        self.add(Feed::new(self.feed_count, port, self.now, Times::Every { tokens, period }));
    }

    /// Feeds the tokens of a recording, which starts now, at their times. There is at least one.
    pub fn feed_at(&mut self, port: (&'static str, &'static str), times: Vec<Duration>) {
        let start = self.now;
        let (first, last) = (start + times[0], start + times[times.len() - 1]);
        self.last_of_recordings = self.last_of_recordings.max(last);
        self.add(Feed::new(self.feed_count, port, first, Times::At(start, times)));
    }

    fn add(&mut self, feed: Feed) {
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
    pub fn wait(&mut self, tested: &mut dyn Tested, time: Duration) {
        let until = self.now + time;
        if !time.is_zero() {
            self.run(tested, until - Duration::from_nanos(1), &|_, _| false);
        }
        self.now = until;
        self.is_waiting = true;
    }

    /// Runs until a token satisfies check `check`, unless one already has that no expectation before has used. Tokens
    /// of the same probe up to this one are then used.
    ///
    /// # Panics
    /// If that does not happen in time. The message has all events until then.
    pub fn expect(&mut self, tested: &mut dyn Tested, check: usize, until: Option<Until>, text: &str, place: &str) {
        let window = self.window(until);
        if !self.run(tested, window.end, &|course, _| course.sighting(check, window).is_some()) {
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

    /// Runs until a state holds.
    ///
    /// # Panics
    /// If that does not happen in time. The message has all events until then.
    pub fn expect_state(
        &mut self,
        tested: &mut dyn Tested,
        state: usize,
        until: Option<Until>,
        text: &str,
        place: &str,
    ) {
        let window = self.window(until);
        let is_past = window.end < self.now;
        if !self.run(tested, window.end, &|_, tested| !is_past && tested.holds(state)) {
            let hint = if is_past { ", which is past: a state is looked at now" } else { "" };
            self.unexpected(text, until, window, hint, place);
        }
    }

    /// Declares that no token must satisfy check `check` from now on.
    pub fn never(&mut self, tested: &mut dyn Tested, check: usize, text: &'static str, place: &'static str) {
        self.arrive(tested);
        self.nevers.push((Forbidden::Tokens(check), text, place));
    }

    /// Declares that the state must not hold from now on.
    pub fn never_state(&mut self, tested: &mut dyn Tested, state: usize, text: &'static str, place: &'static str) {
        self.arrive(tested);
        self.nevers.push((Forbidden::State(state), text, place));
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
    fn run(&mut self, tested: &mut dyn Tested, end: Time, stop: &dyn Fn(&Self, &dyn Tested) -> bool) -> bool {
        loop {
            self.settle(tested);
            if stop(self, tested) {
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
    fn arrive(&mut self, tested: &mut dyn Tested) {
        if self.is_waiting {
            self.settle(tested);
        }
    }

    /// Lets all happen that is due now. Each token that is fed has a reaction of its own, so that tokens come in the
    /// order of feeding, and one that found no room comes as soon as there is some.
    fn settle(&mut self, tested: &mut dyn Tested) {
        self.is_waiting = false;
        if self.put(tested) || self.wake.is_some_and(|time| time <= self.now) {
            self.react(tested);
        }
        while self.put(tested) {
            self.react(tested);
        }
    }

    /// Puts the first token in that is due and finds room. Returns `false` if there is none, or if the program has
    /// ended.
    fn put(&mut self, tested: &mut dyn Tested) -> bool {
        if self.ended.is_some() {
            return false;
        }
        self.feeds.sort_by_key(Feed::order);
        let mut due = self.feeds.iter_mut().take_while(|feed| feed.due <= self.now);
        let Some(at) = due.position(|feed| tested.put(feed.number, feed.next())) else { return false };
        if !self.feeds[at].is_put() {
            self.feeds.remove(at);
        }
        true
    }

    /// Executes one reaction, and looks at what it did.
    fn react(&mut self, tested: &mut dyn Tested) {
        let next = tested.react(self.now, &mut self.timeline);
        self.ended = matches!(next, Next::Exit(_)).then_some(self.now);
        self.wake = match next {
            Next::Now => Some(self.now + STEP),
            Next::At(time) => Some(time).filter(|time| *time > self.now),
            Next::Input | Next::Exit(_) => None,
        };
        self.timeline.begin(self.now, self.reactions);
        self.reactions += 1;
        tested.drain(&mut self.timeline);
        let seen = self.timeline.end();
        let happened = |(what, ..): &&(Forbidden, _, _)| match what {
            Forbidden::Tokens(check) => seen.iter().any(|sighting| sighting.check == *check),
            Forbidden::State(state) => tested.holds(*state),
        };
        if let Some((_, text, place)) = self.nevers.iter().find(happened) {
            self.fail(&format!("`{text}` happened, but never should"), self.now, place);
        }
        self.sightings.extend(seen);
    }

    /// Runs up to `time`, and checks that each token that was due has been put in.
    pub fn end(&mut self, tested: &mut dyn Tested, time: Time) {
        self.run(tested, time.max(self.now), &|_, _| false);
        let mut left = self.feeds.iter().filter_map(|feed| Some((feed.left(self.now, self.ended)?, feed.place)));
        if let Some((what, place)) = left.next() {
            self.fail(&format!("the test ends, but {what}"), self.now, place);
        }
    }

    fn fail(&self, what: &str, time: Time, place: &str) -> ! {
        panic!("test `{}` failed at {time}: {what}\n  --> {place}\n{}", self.name, self.timeline.text().trim_end());
    }
}
