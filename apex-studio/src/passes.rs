//! Times at which activity has passed over connections.

use crate::kinds::is_inserted;
use apex_rt::studio::message::About;

/// Maximum number of relays one behind the other.
const MAX_RELAYS: usize = 64;

/// A way of activity between two nodes.
struct Way {
    from: u32,
    to: u32,
    /// Its connections: several if nodes of the compiler lie between.
    connections: Vec<u32>,
}

/// Times at which activity has passed over connections.
#[derive(Default)]
pub struct Passes {
    ways: Vec<Way>,
    /// Ways from and to each node.
    of: Vec<Vec<usize>>,
    /// Time in ns of the last time for each connection.
    times: Vec<Option<i64>>,
}

impl Passes {
    pub fn new(about: &About) -> Self {
        let ways = ways(about);
        let mut of = vec![vec![]; about.nodes.len()];
        for (at, way) in ways.iter().enumerate() {
            for node in [way.from, way.to] {
                of.get_mut(node as usize).into_iter().for_each(|of: &mut Vec<usize>| of.push(at));
            }
        }
        Self { ways, of, times: vec![None; about.connections.len()] }
    }

    /// A node has become active or inactive at a time in ns. `state` tells whether a node is active, and since when: a
    /// token takes activity along if one node loses it when another one gets it.
    pub fn change(&mut self, node: u32, now: i64, state: impl Fn(u32) -> (bool, i64)) {
        for at in self.of.get(node as usize).into_iter().flatten() {
            let way = &self.ways[*at];
            if state(way.from) == (false, now) && state(way.to) == (true, now) {
                way.connections.iter().for_each(|connection| self.times[*connection as usize] = Some(now));
            }
        }
    }

    /// Forgets what has happened after a time in ns.
    pub fn take_back(&mut self, now: i64) {
        self.times.iter_mut().for_each(|time| *time = time.filter(|time| *time <= now));
    }

    /// The last time for each connection.
    pub fn times(&self) -> &[Option<i64>] {
        &self.times
    }
}

fn ways(about: &About) -> Vec<Way> {
    let kind = |node: u32| about.nodes.get(node as usize).map_or("", |node| &node.kind);
    let mut found = vec![];
    for (first, c) in (0..).zip(&about.connections).filter(|(_, c)| c.activity && !is_inserted(kind(c.from))) {
        let mut open = vec![(c, vec![first])];
        while let Some((last, connections)) = open.pop() {
            if !is_inserted(kind(last.to)) {
                found.push(Way { from: c.from, to: last.to, connections });
            } else if connections.len() < MAX_RELAYS {
                let next = (0..).zip(&about.connections).filter(|(_, next)| next.from == last.to);
                open.extend(next.map(|(at, next)| (next, [&connections[..], &[at]].concat())));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{node, robot};
    use apex_rt::studio::message::AboutConnection;

    #[test]
    fn activity_passes_when_one_node_loses_it_and_another_one_gets_it() {
        let connection = |from, to, activity| AboutConnection {
            from,
            output: "done".to_owned(),
            to,
            input: "begin".to_owned(),
            activity,
        };
        let mut about = robot(&["a", "b", "c"]);
        about.nodes.push(node("r", "relay"));
        about.connections = vec![connection(0, 3, true), connection(3, 1, true), connection(1, 2, false)];
        let mut passes = Passes::new(&about);
        let states = [(false, 5), (true, 5), (true, 5), (false, 0)];
        let state = |node: u32| states[node as usize];
        passes.change(2, 5, state);
        assert_eq!(passes.times(), [None, None, None]);
        passes.change(0, 5, state);
        assert_eq!(passes.times(), [Some(5), Some(5), None]);
        passes.take_back(4);
        assert_eq!(passes.times(), [None, None, None]);
    }
}
