use apex_rt::prelude::*;
use std::{
    fmt::{Debug, Display},
    time::Duration,
};

/// Events during the reactions of a program.
#[derive(Debug, Default)]
pub struct Log {
    names: Vec<&'static str>,
    takers: Vec<usize>,
    claims: &'static [&'static str],
    /// Names of the nodes that fired, in order.
    pub fired: Vec<&'static str>,
    /// Names of the nodes whose slots were called, in order.
    pub handled: Vec<&'static str>,
    /// Nodes that became active (`true`) or inactive (`false`).
    pub activity: Vec<(&'static str, bool)>,
    /// Nodes in an endless loop, with the number of their steps.
    pub endless: Vec<(&'static str, u32)>,
    /// Nodes that failed, with their messages.
    pub failed: Vec<(&'static str, String)>,
    /// Nodes that missed their deadline, with the milliseconds since their source fired.
    pub late: Vec<(&'static str, u128)>,
    /// Simulated duration of every reaction.
    pub elapsed: Duration,
    /// Claims that did not hold, in order.
    pub broken: Vec<&'static str>,
    /// Nodes that rejected a value: node, parameter, value.
    pub refused: Vec<(&'static str, &'static str, String)>,
}

impl Log {
    /// An empty log for `P`.
    pub fn of<P: Program>(_: &P) -> Self {
        let names = P::INFO.nodes.iter().map(|n| n.name).collect();
        Self {
            names,
            takers: P::INFO.connections.iter().map(|c| c.to).collect(),
            claims: P::INFO.claims,
            ..Self::default()
        }
    }

    /// Number of firings of `node`.
    pub fn count(&self, node: &str) -> usize {
        self.fired.iter().filter(|n| **n == node).count()
    }

    /// Order of firings in one line.
    pub fn order(&self) -> String {
        self.fired.join(" ")
    }
}

impl Observer for Log {
    fn fired(&mut self, node: usize) {
        self.fired.push(self.names[node]);
    }
    fn handled(&mut self, connection: usize) {
        self.handled.push(self.names[self.takers[connection]]);
    }
    fn activity(&mut self, node: usize, active: bool) {
        self.activity.push((self.names[node], active));
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let took_part = nodes.iter().zip(counts).filter(|(_, count)| **count > 0);
        self.endless.extend(took_part.map(|(node, count)| (self.names[*node], *count)));
    }
    fn claim_failed(&mut self, claim: usize) {
        self.broken.push(self.claims[claim]);
    }
    fn failed(&mut self, node: usize, error: &impl Display) {
        self.failed.push((self.names[node], error.to_string()));
    }
    fn late(&mut self, node: usize, age: Duration) {
        self.late.push((self.names[node], age.as_millis()));
    }
    fn elapsed(&mut self) -> Duration {
        self.elapsed
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        self.refused.push((self.names[node], parameter, format!("{value:?}")));
    }
}

/// Runs `times` reactions of `program` at time zero. Returns the log.
pub fn react<P: Program>(program: &mut P, times: usize) -> Log {
    let mut log = Log::of(program);
    for _ in 0..times {
        program.react_with(Time::ZERO, &mut log);
    }
    log
}

/// Names of the active nodes of `program`.
pub fn active<P: Program>(program: &P) -> String {
    let nodes = P::INFO.nodes.iter().enumerate().filter(|(node, _)| program.is_active(*node));
    nodes.map(|(_, node)| node.name).collect::<Vec<_>>().join(" ")
}

/// Names of the active nodes after each of `N` iterations.
pub fn active_after_each<P: Program, const N: usize>(program: &mut P) -> [String; N] {
    [(); N].map(|()| {
        react(program, 1);
        active(program)
    })
}

/// Runs `program` on a simulated clock from `start` to `end` (exclusive). Returns the log.
pub fn simulate<P: Program>(program: &mut P, start: Time, end: Time) -> Log {
    let mut log = Log::of(program);
    let mut now = start;
    while now < end {
        now = match program.react_with(now, &mut log) {
            Next::At(time) => time,
            Next::Now => now + std::time::Duration::from_millis(1),
            Next::Input | Next::Exit(_) => break,
        };
    }
    log
}
