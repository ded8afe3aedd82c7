//! Nodes that wait for others: a node fires when all of its inputs have a token. While only some have one, it waits for
//! those that the others come from.

use crate::kinds::is_silent;
use apex_rt::studio::message::{About, PortRole};

/// Tokens that wait at inputs.
#[derive(Default)]
pub struct Waits {
    /// Connections to inputs, by the channel that they begin at.
    from: Vec<Vec<u32>>,
    /// Connections to the inputs of each node.
    to: Vec<Vec<u32>>,
    /// `true` for each connection that has brought a token since the node at its end fired.
    came: Vec<bool>,
}

impl Waits {
    pub fn new(about: &About) -> Self {
        let mut to = vec![vec![]; about.nodes.len()];
        let mut from = vec![vec![]; about.channels.len()];
        for (at, connection) in (0..).zip(&about.connections) {
            let (Some(source), Some(target)) =
                (about.nodes.get(connection.from as usize), about.nodes.get(connection.to as usize))
            else {
                continue;
            };
            let is_input =
                |(name, role, _): &(String, PortRole, String)| *name == connection.input && *role == PortRole::Input;
            if !target.ports.iter().any(is_input) || is_silent(&source.kind) {
                continue;
            }
            let begins = about.channels.iter().position(|channel| {
                let port = channel.name.strip_prefix(&source.name).and_then(|rest| rest.strip_prefix('.'));
                channel.node == connection.from && port == Some(&connection.output)
            });
            // Without its channel it is not known what comes over a connection.
            if let Some(channel) = begins {
                from[channel].push(at);
                to[connection.to as usize].push(at);
            }
        }
        Self { from, to, came: vec![false; about.connections.len()] }
    }

    /// A token is sent over a channel.
    pub fn sent(&mut self, channel: u32) {
        for connection in self.from.get(channel as usize).into_iter().flatten() {
            self.came[*connection as usize] = true;
        }
    }

    /// A node fires, and takes its tokens.
    pub fn fired(&mut self, node: u32) {
        for connection in self.to.get(node as usize).into_iter().flatten() {
            self.came[*connection as usize] = false;
        }
    }

    /// Connections over which no token has come yet, to nodes that have tokens at other inputs.
    pub fn awaited(&self) -> Vec<u32> {
        let came = |connection: &&u32| self.came[**connection as usize];
        let waits = self.to.iter().filter(|to| to.len() > 1 && to.iter().any(|c| came(&c)));
        waits.flat_map(|to| to.iter().filter(|c| !came(c)).copied()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{node, robot};
    use apex_rt::studio::message::{AboutChannel, AboutConnection, AboutNode};

    #[test]
    fn a_node_waits_for_the_inputs_without_a_token() {
        let node = |name: &str, ports: &[(&str, PortRole)]| AboutNode {
            ports: ports.iter().map(|(name, role)| ((*name).into(), *role, String::new())).collect(),
            ..node(name, "")
        };
        let out = [("out", PortRole::Output)];
        let connection = |from, input: &str| AboutConnection {
            from,
            output: "out".into(),
            to: 2,
            input: input.into(),
            activity: false,
        };
        let channel = |name: &str, node| AboutChannel { name: name.into(), node, schema: None };
        let mut about = robot(&[]);
        about.nodes = vec![
            node("a", &out),
            node("b", &out),
            node("join", &[("x", PortRole::Input), ("y", PortRole::Input), ("go", PortRole::Slot)]),
        ];
        about.connections = vec![connection(0, "x"), connection(1, "y"), connection(1, "go")];
        about.channels = vec![channel("a.out", 0), channel("b.out", 1)];
        let mut waits = Waits::new(&about);
        assert!(waits.awaited().is_empty());
        waits.sent(0);
        assert_eq!(waits.awaited(), [1]);
        waits.sent(1);
        assert!(waits.awaited().is_empty());
        waits.fired(2);
        waits.sent(1);
        assert_eq!(waits.awaited(), [0]);
        // Numbers of a hostile robot.
        waits.sent(99);
        waits.fired(99);
    }
}
