//! An interval of a run as a `test` item: what became active in it, what stayed active, and what never was.

use crate::{kinds::is_silent, lane::Lane, live::Live, source::Replayed, words::is_name};
use apex_rt::studio::message::{About, AboutNode};
use std::fmt::Write as _;

/// Maximum number of lines of a test.
const MAX_LINES: usize = 300;

/// Returns a test of the whole run up to `to`, with expectations from `from` on. Times are in ns. The ports of the
/// graph are fed from the recording that the robot repeats.
///
/// # Errors
/// The language has no words for what happened, or nothing happened.
pub fn test(live: &Live, from: i64, to: i64, replayed: Option<&Replayed>) -> Result<String, String> {
    let about = live.about.as_deref().ok_or("there is no robot yet")?;
    if !about.simulated {
        return Err("a robot in real time cannot be repeated: record it, and mark the moment in the replay".to_owned());
    }
    if !is_name(&about.name) {
        return Err("the robot has a name that the language does not have".to_owned());
    }
    let (from, to) = (from.max(0), to.min(live.now));
    if from >= to {
        return Err("mark an interval in the past".to_owned());
    }
    let reactions = live.reactions_until(to);
    if let Some((_, name, _)) = live.sets.iter().find(|(at, ..)| *at < reactions) {
        return Err(format!(
            "`{name}` was set while the robot ran, and a test cannot do that: write it into the source"
        ));
    }
    let lanes = live.exact_lanes(from, to).ok_or("the interval is too long, or too long ago: mark a shorter one")?;
    let mut moment = Moment { about, live, lanes: &lanes, now: from, text: String::new(), lines: 0 };
    moment.feeds(replayed)?;
    moment.begin(from, to);
    moment.middle(from, to);
    moment.end(from, to);
    if moment.lines == 0 {
        return Err("no node was active or inactive in this interval".to_owned());
    }
    let Moment { text, .. } = moment;
    let head = format!("/// From {} s to {} s, as it was seen in `apex studio`.", from as f64 / 1e9, to as f64 / 1e9);
    Ok(format!("{head}\ntest moment: {} {{\n{text}}}\n", about.name))
}

struct Moment<'a> {
    about: &'a About,
    live: &'a Live,
    /// Exact lanes in the interval.
    lanes: &'a [Lane],
    /// Time of the test after its last line.
    now: i64,
    text: String,
    lines: usize,
}

impl<'a> Moment<'a> {
    fn line(&mut self, line: &str) {
        // Writing to a `String` cannot fail.
        let _ = writeln!(self.text, "    {line}");
    }

    fn expectation(&mut self, line: &str) {
        if self.lines < MAX_LINES {
            self.line(line);
        }
        self.lines += 1;
    }

    /// Nodes that were active and that a test can name, with their lanes.
    fn nodes(&self) -> impl Iterator<Item = (&'a AboutNode, &'a Lane)> + use<'a> {
        let nodes = self.about.nodes.iter().zip(self.live.lanes()).zip(self.lanes);
        nodes.filter(|((node, whole), _)| whole.was_active() && has_name(node)).map(|((node, _), lane)| (node, lane))
    }

    /// The tokens of a recording for all ports that got some.
    fn feeds(&mut self, replayed: Option<&Replayed>) -> Result<(), String> {
        let Some(Replayed { file, channels, .. }) = replayed else { return Ok(()) };
        let is_port = |node: &&AboutNode| matches!(node.kind.as_str(), "input" | "slot") && is_name(&node.name);
        let ports = self.about.nodes.iter().filter(is_port);
        let fed: Vec<&str> =
            ports.map(|node| node.name.as_str()).filter(|name| channels.iter().any(|c| c == name)).collect();
        if fed.is_empty() {
            return Err("the recorded sources are nodes of the robot, and a test can only feed the ports of a graph: \
                        let the sources be ports"
                .to_owned());
        }
        for port in fed {
            self.line(&format!("feed {port} = recording({file:?}, {port:?});"));
        }
        Ok(())
    }

    /// The state at the beginning.
    fn begin(&mut self, from: i64, to: i64) {
        if from > 0 {
            self.line(&format!("wait {};", duration(from)));
        }
        for (node, lane) in self.nodes() {
            if lane.is_active_at(from) {
                self.expectation(&format!("expect active({});", node.name));
            }
        }
        for (node, lane) in self.nodes() {
            if !lane.is_active_at(from) && lane.spans_in(from, to).next().is_none() {
                self.expectation(&format!("never active({});", node.name));
            }
        }
    }

    /// Expects the nodes that become active, in sequence.
    fn middle(&mut self, from: i64, to: i64) {
        let begins = self.nodes().flat_map(|(node, lane)| {
            let own = lane.spans_in(from, to).filter(move |(begin, _)| *begin > from);
            own.map(move |(begin, _)| (begin, node, lane))
        });
        let mut begins: Vec<_> = begins.collect();
        begins.sort_by_key(|(begin, ..)| *begin);
        for (begin, node, lane) in begins {
            // An expectation is met as soon as it holds.
            if begin > self.now && lane.is_active_at(self.now) {
                continue;
            }
            // What ends in the same reaction cannot be seen between two.
            if lane.is_active_at(begin) {
                self.expectation(&format!("expect active({}) by {};", node.name, duration(begin)));
                self.now = self.now.max(begin);
            }
        }
    }

    /// The state at the end, and what does not happen any more before it.
    fn end(&mut self, from: i64, to: i64) {
        let now = self.now;
        for (node, lane) in self.nodes() {
            let rests = |since: i64| !lane.is_active_at(since) && lane.spans_in(since, to).next().is_none();
            if to > now && rests(now) && !rests(from) {
                self.expectation(&format!("never active({});", node.name));
            }
        }
        if to > self.now {
            self.line(&format!("wait {};", duration(to - self.now)));
        }
        for (node, lane) in self.nodes() {
            if lane.is_active_at(to) {
                self.expectation(&format!("expect active({});", node.name));
            }
        }
    }
}

/// `true` if the source has a name for a node: the compiler gives the others that of their type, with a number.
fn has_name(node: &AboutNode) -> bool {
    let own = node.name.rsplit('.').next().unwrap_or_default();
    let is_numbered = own.rsplit_once('_').is_some_and(|(word, number)| {
        let ty = node.kind.rsplit("::").next().unwrap_or_default().to_lowercase();
        number.parse::<u32>().is_ok() && word.replace('_', "") == ty.replace('_', "")
    });
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
    !is_silent(&node.kind) && !is_numbered && node.name.chars().all(is_word)
}

/// A time in the largest unit in which it is whole.
fn duration(nanos: i64) -> String {
    let units = [(1_000_000_000, "s"), (1_000_000, "ms"), (1000, "us")];
    let whole = units.into_iter().find(|(unit, _)| nanos % unit == 0);
    whole.map_or_else(|| format!("{nanos}ns"), |(unit, name)| format!("{}{name}", nanos / unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_written_without_loss() {
        let all = [0, 12_000_000_000, 12_340_000_000, 1_500, 7].map(duration);
        assert_eq!(all, ["0s", "12s", "12340ms", "1500ns", "7ns"]);
    }
}
