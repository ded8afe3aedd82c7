//! Tests of a program that is interpreted.

use crate::{
    Interpreter, Library as _, Value, code::names, compiled::Compiled, condition, glue::Recorded, source::Source,
};
use apex_dsl::{
    checked::CheckedProgram,
    graph::{self, Condition, Graph, NodeId, Subject},
    script::{Observed, Script, Seen, Step, Until, What},
};
use apex_rt::{
    Next, Time,
    testing::{self, Course, Tested, Timeline},
};
use std::{collections::BTreeMap, path::Path, time::Duration};

/// Runs a test of a source file. The paths in messages are relative to `root`.
///
/// # Errors
/// Returns what the interpreter does not know.
///
/// # Panics
/// The test fails.
pub fn run(
    program: &CheckedProgram,
    script: &Script,
    library: &Compiled<'_>,
    source: &Source,
    root: &Path,
) -> Result<(), String> {
    let running = Interpreter::new(program, &source.checked.texts.machines, library.catalog, library)?;
    let graph = &program.graph;
    let text = source.sources.get(graph.span.file).path.display().to_string();
    let nodes = names(graph, library.catalog).into_iter().map(forever).collect();
    let (probes, test) = (probes(graph, script), &*script.name);
    let mut subject = Tried { test, running, graph, probes, library, feeds: vec![], states: vec![] };
    let mut course = Course::new(forever(script.name.clone()), nodes);
    let place = |span| forever(source.place(span, root));
    for (number, step) in script.steps.iter().enumerate() {
        match step {
            Step::Feed { port, values, every, span } => {
                subject.feed(&mut course, *port, values, *every, place(*span))?
            }
            Step::FeedRecorded { port, file, channel, span } => {
                subject.feed_recorded(&mut course, *port, (&text, file, channel), place(*span))?;
            }
            Step::Wait(time) => course.wait(&mut subject, *time),
            Step::Expect(seen, until) => {
                let (text, place) = (forever(seen.text.clone()), place(seen.span));
                let until = until.map(|until| match until {
                    Until::By(time) => testing::Until::By(time),
                    Until::Within(time) => testing::Until::Within(time),
                });
                match subject.state(seen) {
                    Some(state) => course.expect_state(&mut subject, state, until, text, place),
                    None => course.expect(&mut subject, number, until, text, place),
                }
            }
            Step::Never(seen) => {
                let (text, place) = (forever(seen.text.clone()), place(seen.span));
                match subject.state(seen) {
                    Some(state) => course.never_state(&mut subject, state, text, place),
                    None => course.never(&mut subject, number, text, place),
                }
            }
        }
    }
    let end = course.last_of_lists;
    course.end(&mut subject, end);
    Ok(())
}

/// A text that lives as long as the process, as all texts of a compiled test do: it runs only once.
fn forever(text: String) -> &'static str {
    text.leak()
}

/// Message for a port whose tokens are not among the pieces: a fault of the interpreter.
fn unknown(port: &str) -> String {
    format!("a token for `{port}` is not known")
}

/// A check of tokens: the step that makes it, and the condition.
type Check<'a> = (usize, &'a Observed, Option<&'a Condition>);

/// A probe, with the checks of each field of its tokens.
struct Probe<'a> {
    node: NodeId,
    /// Name of the port.
    name: &'a str,
    /// It is inside of the graph, and only other tests look at it.
    is_other: bool,
    checks: Vec<Vec<Check<'a>>>,
}

/// The probes of a graph, with the checks of a test.
fn probes<'a>(graph: &'a Graph, script: &'a Script) -> Vec<Probe<'a>> {
    let nodes = graph.nodes.iter_enumerated().filter(|(_, node)| node.kind.is_probe());
    let probe = |(id, node): (NodeId, &'a graph::Node)| {
        let mut checks: BTreeMap<&[String], Vec<Check<'a>>> = BTreeMap::new();
        for (step, s) in script.steps.iter().enumerate() {
            if let Step::Expect(seen, _) | Step::Never(seen) = s
                && let What::Token(of, condition) = &seen.what
                && of.probe == id
            {
                checks.entry(&of.fields).or_default().push((step, of, condition.as_ref()));
            }
        }
        let inside = node.name.strip_prefix("probe ");
        let is_other = checks.is_empty() && inside.is_some();
        let name = inside.unwrap_or(&node.name);
        Probe { node: id, name, is_other, checks: checks.into_values().collect() }
    };
    nodes.map(probe).collect()
}

/// The program of a test.
struct Tried<'a, 'l> {
    /// Name of the test.
    test: &'a str,
    running: Interpreter<'a>,
    graph: &'a Graph,
    probes: Vec<Probe<'a>>,
    library: &'l Compiled<'l>,
    /// The port and the tokens of each `feed` statement.
    feeds: Vec<(NodeId, Vec<Value>)>,
    /// The states that the test looks at.
    states: Vec<&'a What>,
}

impl<'a> Tried<'a, '_> {
    fn feed(
        &mut self,
        course: &mut Course,
        port: NodeId,
        values: &[graph::Value],
        every: Option<Duration>,
        place: &'static str,
    ) -> Result<(), String> {
        if values.is_empty() {
            return Ok(());
        }
        let node = &self.graph.nodes[port];
        let token = |value| self.library.token(Some(value), &node.ports[0].ty);
        let tokens: Option<Vec<Value>> = values.iter().map(token).collect();
        self.feeds.push((port, tokens.ok_or_else(|| unknown(&node.name))?));
        course.feed((forever(node.name.clone()), place), values.len(), every);
        Ok(())
    }

    /// Feeds a channel of a recording to a port of the program in the source file `text`.
    fn feed_recorded(
        &mut self,
        course: &mut Course,
        port: NodeId,
        (text, file, channel): (&str, &str, &str),
        place: &'static str,
    ) -> Result<(), String> {
        let node = &self.graph.nodes[port];
        let frame = node.ports[0].frame.as_ref().map(|frame| forever(frame.text.clone()));
        let tokens = self.library.recorded(port, Recorded { text, file, channel, frame, begun: course.now });
        let tokens = tokens.ok_or_else(|| unknown(&node.name))?;
        if !tokens.is_empty() {
            let (times, tokens) = tokens.into_iter().unzip();
            self.feeds.push((port, tokens));
            course.feed_at((forever(node.name.clone()), place), times);
        }
        Ok(())
    }

    /// The number of an observed state; `None` if tokens are observed.
    fn state(&mut self, seen: &'a Seen) -> Option<usize> {
        if let What::Token(..) = seen.what {
            return None;
        }
        self.states.push(&seen.what);
        Some(self.states.len() - 1)
    }

    /// Returns `true` if a token meets a check.
    fn meets(&self, (step, of, condition): Check<'_>, token: &Value) -> bool {
        let Some(condition) = condition else { return true };
        let checked = self.library.check(self.test, step, token);
        checked.unwrap_or_else(|| condition::holds(condition, token, &of.ty))
    }
}

impl Tested for Tried<'_, '_> {
    fn react(&mut self, now: Time, timeline: &mut Timeline) -> Next {
        self.running.react(now, timeline)
    }

    fn drain(&mut self, timeline: &mut Timeline) {
        let mut number = 0;
        for probe in &self.probes {
            let tokens = self.running.take_seen(probe.node);
            if probe.is_other {
                continue;
            }
            for token in tokens {
                for (group, checks) in (number..).zip(&probe.checks) {
                    timeline.arrives(group);
                    let met = checks.iter().filter(|check| self.meets(**check, &token));
                    met.for_each(|(step, ..)| timeline.meets(*step));
                }
                timeline.token(probe.name, &self.library.shown(probe.node, &token));
            }
            number += probe.checks.len();
        }
    }

    fn put(&mut self, feed: usize, token: usize) -> bool {
        let (port, tokens) = &self.feeds[feed];
        self.running.put_at(*port, tokens[token].clone())
    }

    fn holds(&self, state: usize) -> bool {
        match self.states[state] {
            What::Active(Subject::Node(node)) => self.running.is_active(*node),
            What::Active(Subject::Scope(scope)) => self.running.is_graph_active(*scope),
            What::InState(machine, states) => self.running.state_of(*machine).is_some_and(|now| states.contains(&now)),
            What::Token(..) => false,
        }
    }
}
