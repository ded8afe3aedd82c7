use apex_rt::prelude::*;
use std::fmt::{Debug, Display};

/// What happened while a program reacted.
#[derive(Debug, Default)]
pub struct Log {
    names: Vec<&'static str>,
    /// The names of the nodes that fired, in order.
    pub fired: Vec<&'static str>,
    /// Nodes that failed, with what they said.
    pub failed: Vec<(&'static str, String)>,
    /// Nodes that refused a value: node, parameter, value.
    pub refused: Vec<(&'static str, &'static str, String)>,
}

impl Log {
    /// An empty log for `P`.
    pub fn of<P: Program>(_: &P) -> Self {
        Self { names: P::INFO.nodes.iter().map(|n| n.name).collect(), ..Self::default() }
    }

    /// How often `node` fired.
    pub fn count(&self, node: &str) -> usize {
        self.fired.iter().filter(|n| **n == node).count()
    }

    /// The order of firings, in one line.
    pub fn order(&self) -> String {
        self.fired.join(" ")
    }
}

impl Observer for Log {
    fn fired(&mut self, node: usize) {
        self.fired.push(self.names[node]);
    }
    fn failed(&mut self, node: usize, error: &impl Display) {
        self.failed.push((self.names[node], error.to_string()));
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        self.refused.push((self.names[node], parameter, format!("{value:?}")));
    }
}

/// Lets `program` react `times` times at time zero, and says what happened.
pub fn react<P: Program>(program: &mut P, times: usize) -> Log {
    let mut log = Log::of(program);
    for _ in 0..times {
        program.react_with(Time::ZERO, &mut log);
    }
    log
}

/// Runs `program` on a simulated clock from `start` to `end` (exclusive), and says what happened.
pub fn simulate<P: Program>(program: &mut P, start: Time, end: Time) -> Log {
    let mut log = Log::of(program);
    let mut now = start;
    while now < end {
        now = match program.react_with(now, &mut log) {
            Next::At(time) => time,
            Next::Now => now + std::time::Duration::from_millis(1),
            Next::Input => break,
        };
    }
    log
}
