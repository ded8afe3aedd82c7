//! Events of a test: a list for the message of a failure, and the tokens that its statements look at.

use crate::{Observer, Time};
use core::fmt::{Debug, Display, Write as _};

/// Number of moments in the message of a failed test.
const SHOWN: usize = 20;
/// Number of characters of a token in that message: a laser scan has thousands.
const LONGEST: usize = 120;

/// A token that satisfies a check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// Number of the check, in the order of the statements.
    pub check: usize,
    /// Number of the probe.
    pub probe: usize,
    /// Number of tokens of the probe before this one.
    pub token: u64,
    /// Time of the reaction.
    pub time: Time,
    /// Number of reactions before this one.
    pub reaction: u64,
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
    /// Time of this reaction, and the number of reactions before it.
    reaction: (Time, u64),
    /// Number of tokens, by probe.
    tokens: Vec<u64>,
    /// Probe of the last token.
    probe: usize,
    /// Tokens of this reaction that satisfy checks.
    sightings: Vec<Sighting>,
}

impl Timeline {
    /// Returns the timeline of a program with nodes of these names.
    pub(super) fn new(names: Vec<&'static str>) -> Self {
        Self {
            names,
            now: Moment::default(),
            moments: vec![],
            goals: None,
            reaction: (Time::ZERO, 0),
            tokens: vec![],
            probe: 0,
            sightings: vec![],
        }
    }

    /// Makes it the timeline of a study with this number of goals.
    pub(super) fn score(&mut self, goals: usize) {
        self.goals = Some(vec![f64::NAN; goals]);
    }

    /// The last values of the goals.
    pub(super) fn goals(self) -> Vec<f64> {
        self.goals.unwrap_or_default()
    }

    /// Begins to look at the tokens of a reaction at `time`, after so many others.
    pub(super) fn begin(&mut self, time: Time, reactions: u64) {
        self.reaction = (time, reactions);
    }

    /// Takes note of the next token of a probe.
    pub fn arrives(&mut self, probe: usize) {
        self.tokens.resize(self.tokens.len().max(probe + 1), 0);
        self.tokens[probe] += 1;
        self.probe = probe;
    }

    /// Takes note that the last token satisfies a check.
    pub fn meets(&mut self, check: usize) {
        let (probe, (time, reaction)) = (self.probe, self.reaction);
        let token = self.tokens[probe] - 1;
        self.sightings.push(Sighting { check, probe, token, time, reaction });
    }

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

    /// Ends the reaction, and returns its tokens that satisfy checks.
    pub(super) fn end(&mut self) -> Vec<Sighting> {
        let moment = core::mem::take(&mut self.now);
        if moment != Moment::default() {
            self.moments.push((self.reaction.0, moment));
        }
        core::mem::take(&mut self.sightings)
    }

    /// The list of events.
    pub(super) fn text(&self) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_tokens_are_cut() {
        let mut timeline = Timeline::new(vec![]);
        timeline.token("name", &"é".repeat(LONGEST));
        timeline.token("scan", &"é".repeat(10_000));
        let shown = "é".repeat(LONGEST);
        assert_eq!(timeline.now.notes, [format!("name: {shown}"), format!("scan: {shown} …")]);
    }
}
