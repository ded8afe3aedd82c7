//! Runtime of generated tests: a program in simulated time, tokens for its ports, and expectations.

mod course;
mod feed;
mod study;
mod timeline;

pub use course::{Course, Tested, Until};
pub use study::{Study, recorded, serve};
pub use timeline::Timeline;

use crate::{Next, Program, Time};
use core::time::Duration;

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

/// A running test of a program.
pub struct Test<P> {
    subject: Subject<P>,
    course: Course,
}

/// The program of a test.
struct Subject<P> {
    program: P,
    drain: fn(&mut P, &mut Timeline),
    /// Tokens of each `feed` statement: they are put in by their numbers.
    tokens: Vec<Put<P>>,
    /// States that the test looks at.
    states: Vec<fn(&P) -> bool>,
}

/// Function that puts a token in. It returns `false` if there is no room for it.
type Put<P> = Box<dyn FnMut(&mut P, usize) -> bool>;

impl<P: Program> Tested for Subject<P> {
    fn react(&mut self, now: Time, timeline: &mut Timeline) -> Next {
        self.program.react_with(now, timeline)
    }

    fn drain(&mut self, timeline: &mut Timeline) {
        (self.drain)(&mut self.program, timeline);
    }

    fn put(&mut self, feed: usize, token: usize) -> bool {
        self.tokens[feed](&mut self.program, token)
    }

    fn holds(&self, state: usize) -> bool {
        self.states[state](&self.program)
    }
}

impl<P: Program + 'static> Test<P> {
    /// Returns the test `name` of `program`; `drain` empties its probes.
    pub fn new(name: &'static str, mut program: P, drain: fn(&mut P, &mut Timeline)) -> Self {
        study::set(&mut |visitor| program.visit_params(visitor));
        let subject = Subject { program, drain, tokens: vec![], states: vec![] };
        Self { subject, course: Course::new(name, const { &P::INFO }.nodes.iter().map(|node| node.name).collect()) }
    }

    /// Returns one run of the study `name` of `program`, with this number of goals; `drain` empties its probes.
    pub fn of_study(name: &'static str, program: P, drain: fn(&mut P, &mut Timeline), goals: usize) -> Self {
        let mut test = Self::new(name, program, drain);
        test.course.timeline.score(goals);
        test
    }

    /// Runs until all lists have been fed, and ends the test. A recording may be longer than the test.
    ///
    /// # Panics
    /// A token that was due has never been put in.
    pub fn finish(mut self) {
        let end = self.course.last_of_lists;
        self.course.end(&mut self.subject, end);
    }

    /// Runs until all feeds that end have ended, and returns the last values of the goals.
    ///
    /// # Panics
    /// A token that was due has never been put in.
    pub fn goals(mut self) -> Vec<f64> {
        let end = self.course.last_of_lists.max(self.course.last_of_recordings);
        self.course.end(&mut self.subject, end);
        self.course.timeline.goals()
    }

    /// Feeds `tokens` to `port` from now on, one every `period`. A single token with a period is repeated. A token that
    /// finds no room is put in as soon as there is some.
    pub fn feed<T: Clone + 'static>(
        &mut self,
        port: (&'static str, &'static str),
        tokens: &[T],
        period: Option<Duration>,
        put: fn(&mut P, T) -> Result<(), T>,
    ) {
        if tokens.is_empty() {
            return;
        }
        self.course.feed(port, tokens.len(), period);
        let tokens = tokens.to_vec();
        self.subject.tokens.push(Box::new(move |program, at| put(program, tokens[at].clone()).is_ok()));
    }

    /// Feeds the tokens of a recording, which starts now, to `port` at their times. A token that finds no room is put
    /// in as soon as there is some.
    #[cfg(feature = "record")]
    pub fn feed_at<T: Clone + 'static>(
        &mut self,
        port: (&'static str, &'static str),
        tokens: crate::record::Tokens<T>,
        put: fn(&mut P, T) -> Result<(), T>,
    ) {
        let tokens = tokens.begun_at(self.course.now);
        if tokens.is_empty() {
            return;
        }
        self.course.feed_at(port, tokens.iter().map(|(time, _)| *time).collect());
        self.subject.tokens.push(Box::new(move |program, at| put(program, tokens[at].1.clone()).is_ok()));
    }

    /// Lets `time` pass. The program reacts at its end with the next statement: a token that is fed then is there
    /// before a timeout of that instant.
    pub fn wait(&mut self, time: Duration) {
        self.course.wait(&mut self.subject, time);
    }

    /// Runs until a token satisfies check `check`, unless one already has that no expectation before has used. Tokens
    /// of the same probe up to this one are then used.
    ///
    /// # Panics
    /// If that does not happen in time. The message has all events until then.
    pub fn expect(&mut self, check: usize, until: Option<Until>, text: &'static str, place: &'static str) {
        self.course.expect(&mut self.subject, check, until, text, place);
    }

    /// Runs until the state `holds`.
    ///
    /// # Panics
    /// If that does not happen in time. The message has all events until then.
    pub fn expect_state(
        &mut self,
        holds: fn(&P) -> bool,
        until: Option<Until>,
        text: &'static str,
        place: &'static str,
    ) {
        let state = self.state(holds);
        self.course.expect_state(&mut self.subject, state, until, text, place);
    }

    /// Declares that no token must satisfy check `check` from now on.
    pub fn never(&mut self, check: usize, text: &'static str, place: &'static str) {
        self.course.never(&mut self.subject, check, text, place);
    }

    /// Declares that the state must not hold from now on.
    pub fn never_state(&mut self, holds: fn(&P) -> bool, text: &'static str, place: &'static str) {
        let state = self.state(holds);
        self.course.never_state(&mut self.subject, state, text, place);
    }

    /// Returns the number of a state that the test looks at.
    fn state(&mut self, holds: fn(&P) -> bool) -> usize {
        self.subject.states.push(holds);
        self.subject.states.len() - 1
    }
}
