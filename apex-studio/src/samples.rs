//! Robots for tests.

use apex_rt::studio::message::{About, AboutNode};

/// A robot with nodes of these names, and nothing else.
pub fn robot(nodes: &[&str]) -> About {
    About {
        version: 0,
        name: "Robot".into(),
        docs: String::new(),
        files: vec![],
        simulated: false,
        nodes: nodes.iter().map(|name| node(name, "")).collect(),
        connections: vec![],
        groups: vec![],
        claims: vec![],
        channels: vec![],
        params: vec![],
    }
}

/// A node without ports.
pub fn node(name: &str, kind: &str) -> AboutNode {
    AboutNode { name: name.into(), kind: kind.into(), docs: String::new(), file: 0, line: 1, column: 1, ports: vec![] }
}
