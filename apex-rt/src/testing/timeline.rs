//! Events of a test: a list for the message of a failure, and the tokens that its statements look at.

use crate::{Observer, Time};
use core::fmt::{Debug, Display, Write as _};
use std::collections::BTreeMap;

/// Number of moments that the message of a failed test shows one by one. Of more, the last ones are shown, after a list
/// of what has changed.
const SHOWN: usize = 20;
/// Number of last moments after that list.
const LAST: usize = 5;
/// Number of moments in that list.
const CHANGES: usize = 100;
/// Number of tokens from which on those of a port are counted instead of listed among the changes: those of a stream.
const STREAM: usize = 20;
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
    notes: Vec<Note>,
}

/// Something that happens besides the firing of nodes.
#[derive(Debug, Clone, PartialEq)]
struct Note {
    /// Port of a token.
    port: Option<String>,
    text: String,
}

impl Note {
    fn change(text: String) -> Self {
        Self { port: None, text }
    }
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
        let text = match token.char_indices().nth(LONGEST) {
            Some((end, _)) => format!("{port}: {} …", &token[..end]),
            None => format!("{port}: {token}"),
        };
        self.now.notes.push(Note { port: Some(port.to_owned()), text });
    }

    /// Ends the reaction, and returns its tokens that satisfy checks.
    pub(super) fn end(&mut self) -> Vec<Sighting> {
        let moment = core::mem::take(&mut self.now);
        if moment != Moment::default() {
            self.moments.push((self.reaction.0, moment));
        }
        core::mem::take(&mut self.sightings)
    }

    /// The list of events: all moments, or if these are too many, all changes and the last moments.
    pub(super) fn text(&self) -> String {
        if self.moments.is_empty() {
            return "what happened:\n  nothing\n".to_owned();
        }
        if self.moments.len() <= SHOWN {
            return format!("what happened:\n{}", moments(&self.moments));
        }
        let last = &self.moments[self.moments.len() - LAST..];
        format!("what changed:\n{}the last moments:\n{}", self.changes(), moments(last))
    }

    /// Changes of activity, problems, and tokens of ports that do not send all the time, with the numbers of the other
    /// tokens.
    fn changes(&self) -> String {
        let notes = || self.moments.iter().flat_map(|(_, moment)| &moment.notes);
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for port in notes().filter_map(|note| note.port.as_deref()) {
            *counts.entry(port).or_default() += 1;
        }
        let is_change = |note: &&Note| note.port.as_deref().is_none_or(|port| counts[port] <= STREAM);
        let lines = self.moments.iter().filter_map(|(time, moment)| {
            let notes: Vec<&str> = moment.notes.iter().filter(is_change).map(|note| note.text.as_str()).collect();
            (!notes.is_empty()).then(|| format!("  {time}  {}\n", notes.join("; ")))
        });
        let lines: Vec<String> = lines.collect();
        let mut text = String::new();
        let left_out = lines.len().saturating_sub(CHANGES);
        if left_out > 0 {
            let _ = writeln!(text, "  … {left_out} earlier changes");
        }
        lines[left_out..].iter().for_each(|line| text.push_str(line));
        if lines.is_empty() {
            text.push_str("  nothing\n");
        }
        let streams = counts.iter().filter(|(_, count)| **count > STREAM);
        let streams: Vec<String> = streams.map(|(port, count)| format!("{port}: {count} tokens")).collect();
        if !streams.is_empty() {
            let _ = writeln!(text, "  all the time  {}", streams.join("; "));
        }
        text
    }
}

/// Lines with moments. Nodes that are the same as in the moment before are not named again.
fn moments(shown: &[(Time, Moment)]) -> String {
    let mut text = String::new();
    let mut before: &[&str] = &[];
    for (time, moment) in shown {
        let fired = match moment.fired.as_slice() {
            [] => None,
            names if names.len() > 2 && names == before => Some(format!("the same {} fired", names.len())),
            names => Some(format!("{} fired", names.join(", "))),
        };
        before = &moment.fired;
        let what = fired.as_deref().into_iter().chain(moment.notes.iter().map(|note| note.text.as_str()));
        let _ = writeln!(text, "  {time}  {}", what.collect::<Vec<_>>().join("; "));
    }
    text
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
            now.notes.push(Note::change(format!("{name} is {}", if active { "active" } else { "no longer active" })));
        }
    }
    fn failed(&mut self, node: usize, error: &impl Display) {
        let name = self.names[node];
        if let Some(now) = self.listed() {
            now.notes.push(Note::change(format!("{name} failed: {error}")));
        }
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let name = self.names[node];
        if let Some(now) = self.listed() {
            now.notes.push(Note::change(format!("{name} refused {value:?} for {parameter}")));
        }
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let names = nodes.iter().zip(counts).filter(|(_, count)| **count > 0).map(|(node, _)| self.names[*node]);
        let names: Vec<&str> = names.collect();
        self.now.notes.push(Note::change(format!("endless cycle of {}", names.join(", "))));
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
        let notes: Vec<&str> = timeline.now.notes.iter().map(|note| note.text.as_str()).collect();
        assert_eq!(notes, [format!("name: {shown}"), format!("scan: {shown} …")]);
    }

    /// A program at 100 Hz, whose node `go` becomes active and says so.
    fn long(moments: i64) -> String {
        let mut timeline = Timeline::new(vec!["base", "laser", "go"]);
        for number in 0..moments {
            timeline.begin(Time::from_millis(10 * number), number as u64);
            (0..3).for_each(|node| timeline.fired(node));
            timeline.token("pose", &number.to_string());
            if number == 3 {
                timeline.activity(2, true);
                timeline.token("says", "\"goes\"");
            }
            timeline.end();
        }
        timeline.text()
    }

    #[test]
    fn a_short_test_is_shown_as_it_was() {
        let expected = "what happened:\n  0.000000 s  base, laser, go fired; pose: 0\n\
                        \x20 0.010000 s  the same 3 fired; pose: 1\n";
        assert_eq!(long(2), expected);
        assert_eq!(Timeline::new(vec![]).text(), "what happened:\n  nothing\n");
    }

    #[test]
    fn a_long_test_begins_with_what_has_changed() {
        let expected = "what changed:\n  0.030000 s  go is active; says: \"goes\"\n\
                        \x20 all the time  pose: 1000 tokens\nthe last moments:\n\
                        \x20 9.950000 s  base, laser, go fired; pose: 995\n  9.960000 s  the same 3 fired; pose: 996\n";
        assert!(long(1000).starts_with(expected), "{}", long(1000));
    }

    #[test]
    fn what_changes_all_the_time_is_cut() {
        let mut timeline = Timeline::new(vec!["go"]);
        for number in 0..1000 {
            timeline.begin(Time::from_millis(10 * number), number as u64);
            timeline.activity(0, number % 2 == 0);
            timeline.end();
        }
        let text = timeline.text();
        assert!(text.starts_with("what changed:\n  … 900 earlier changes\n  9.000000 s  go is active\n"), "{text}");
    }
}
