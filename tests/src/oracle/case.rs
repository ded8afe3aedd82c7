//! A random graph before it is written as a source file.

/// The event of a node with a `timeout`.
pub const TIMEOUT: &str = "timeout";

/// A type of scripted node with its ports. A `?` marks an optional input.
#[derive(Debug, PartialEq, Eq)]
pub struct NodeType {
    /// Name in Rust.
    pub name: &'static str,
    /// Inputs.
    pub inputs: &'static [&'static str],
    /// Outputs.
    pub outputs: &'static [&'static str],
    /// Slots.
    pub slots: &'static [&'static str],
    /// Events.
    pub events: &'static [&'static str],
}

const fn ty(
    name: &'static str,
    inputs: &'static [&'static str],
    outputs: &'static [&'static str],
    slots: &'static [&'static str],
    events: &'static [&'static str],
) -> NodeType {
    NodeType { name, inputs, outputs, slots, events }
}

/// All types of scripted nodes, sources first, and a node that runs once per element of a list.
pub const NODE_TYPES: &[NodeType] = &[
    ty("ScSource", &[], &["out"], &[], &[]),
    ty("ScSourceE", &[], &["out"], &["s"], &["e"]),
    ty("ScTicker", &[], &[], &[], &["e"]),
    ty("ScPass", &["x"], &["out"], &[], &[]),
    ty("ScSplit", &["x"], &["a", "b"], &[], &[]),
    ty("ScJoin", &["x", "y"], &["out"], &[], &[]),
    ty("ScMaybe", &["x", "y?"], &["out"], &[], &[]),
    ty("ScEvent", &["x"], &["out"], &[], &["e"]),
    ty("ScFull", &["x", "y"], &["out"], &["s", "t"], &["e", "f"]),
    ty("ScSink", &["x"], &[], &[], &[]),
    ty("ScSinkS", &["x"], &[], &["s"], &["e"]),
    ty("ScKeen", &["x"], &[], &[], &[]),
    ty("ScHandler", &[], &[], &["s", "t"], &["e", "f"]),
    ty("ScStop", &[], &[], &["s"], &["e"]),
    ty("ScKick", &[], &[], &["s"], &["e"]),
    ty("ScTock", &["x"], &["out"], &[], &["e"]),
    ty("ScList", &["x"], &["out"], &[], &[]),
    ty("pass", &["x"], &["out"], &[], &[]),
    ty("ScListSink", &["x"], &[], &[], &[]),
];

/// Type with this name.
pub fn node_type(name: &str) -> &'static NodeType {
    NODE_TYPES.iter().find(|t| t.name == name).unwrap_or(&NODE_TYPES[0])
}

/// A node of a random graph.
#[derive(Debug, Clone)]
pub struct Instance {
    /// Identifier, which is kept when other nodes are removed.
    pub id: usize,
    /// Type.
    pub ty: &'static NodeType,
    /// Mode, see [`super::sends`].
    pub mode: i64,
    /// Index of the nested graph; 0 is the graph itself.
    pub group: usize,
    /// Number of tokens by which its outputs are delayed.
    pub delay: usize,
    /// Periods of `every` and `after` in ms, for sources.
    pub every: Option<(usize, usize)>,
    /// Time of `timeout` in ms.
    pub timeout: Option<usize>,
    /// `true` for `start => …`.
    pub starts: bool,
    /// Thread; 0 is the main one.
    pub thread: usize,
}

/// A connection between two nodes, given by their identifiers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Sending node and port.
    pub from: (usize, &'static str),
    /// Receiving node and port.
    pub to: (usize, &'static str),
    /// `true` for `=>`.
    pub active: bool,
    /// `true` if it passes slots and events of nested graphs instead of inputs and outputs.
    pub relayed: bool,
    /// `true` if its slot gets a value in place of the tokens.
    pub given: bool,
}

/// Something whose activity can be cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// The node with this identifier.
    Node(usize),
    /// The nested graph with this index.
    Group(usize),
}

/// Connections to `cancel` and `resume`, and from `cancelled`. All nodes are beside the target.
#[derive(Debug, Clone)]
pub struct Cancel {
    /// The node or nested graph.
    pub of: Target,
    /// Port that cancels it, and `true` for `=>`.
    pub by: ((usize, &'static str), bool),
    /// Port that gives the activity back, and `true` for `=>`.
    pub back: Option<((usize, &'static str), bool)>,
    /// Node that is told of it, and `true` for `=>`.
    pub tells: Option<(usize, bool)>,
}

/// A random graph.
#[derive(Debug, Clone)]
pub struct Case {
    /// Seed of the scripts of the nodes.
    pub seed: u64,
    /// Number of calls in which a node triggers events.
    pub limit: usize,
    /// Nodes.
    pub nodes: Vec<Instance>,
    /// Connections.
    pub links: Vec<Link>,
    /// For each nested graph, the index of the enclosing one; the first is the graph itself.
    pub groups: Vec<usize>,
    /// Connections that cancel and resume.
    pub cancels: Vec<Cancel>,
    /// Ports whose tokens reset the program, and `true` for `=>`.
    pub resets: Vec<((usize, &'static str), bool)>,
    /// `true` if no source makes up for what it has missed, which makes a difference in late reactions.
    pub skips: bool,
}

impl Case {
    /// Node with this identifier.
    pub fn node(&self, id: usize) -> Option<&Instance> {
        self.nodes.iter().find(|n| n.id == id)
    }

    /// All graphs that are a little smaller, the smallest first: without some nodes, a node, a connection, a nested
    /// graph, activity, or a delay.
    pub fn smaller(&self) -> Vec<Self> {
        let mut found = vec![];
        let mut add = |change: &dyn Fn(&mut Self)| {
            let mut case = self.clone();
            change(&mut case);
            case.clean();
            found.push(case);
        };
        let mut size = self.nodes.len() / 2;
        while size > 1 {
            for start in (0..self.nodes.len()).step_by(size) {
                let end = (start + size).min(self.nodes.len());
                add(&|c| drop(c.nodes.drain(start..end)));
            }
            size /= 2;
        }
        for n in (0..self.nodes.len()).rev() {
            add(&|c| {
                c.nodes.remove(n);
            });
        }
        for l in 0..self.links.len() {
            add(&|c| {
                c.links.remove(l);
            });
            if self.links[l].active {
                add(&|c| c.links[l].active = false);
            }
            if self.links[l].given {
                add(&|c| c.links[l].given = false);
            }
            if self.links[l].relayed {
                add(&|c| c.links[l].relayed = false);
            }
        }
        for i in 0..self.cancels.len() {
            add(&|c| {
                c.cancels.remove(i);
            });
            if self.cancels[i].back.is_some() {
                add(&|c| c.cancels[i].back = None);
            }
            if self.cancels[i].tells.is_some() {
                add(&|c| c.cancels[i].tells = None);
            }
        }
        for i in 0..self.resets.len() {
            add(&|c| {
                c.resets.remove(i);
            });
        }
        for g in 1..self.groups.len() {
            if self.nodes.iter().any(|n| n.group == g) {
                add(&|c| c.nodes.iter_mut().filter(|n| n.group == g).for_each(|n| n.group = self.groups[g]));
            }
        }
        for n in 0..self.nodes.len() {
            if self.nodes[n].thread > 0 {
                add(&|c| c.nodes[n].thread = 0);
            }
            if self.nodes[n].starts {
                add(&|c| c.nodes[n].starts = false);
            }
            if self.nodes[n].timeout.is_some() {
                add(&|c| {
                    c.nodes[n].timeout = None;
                    let id = c.nodes[n].id;
                    c.links.retain(|link| link.from != (id, TIMEOUT));
                    c.cancels.retain(|cancel| cancel.by.0 != (id, TIMEOUT));
                    c.resets.retain(|(by, _)| *by != (id, TIMEOUT));
                });
            }
            if self.nodes[n].every.is_some() {
                add(&|c| c.nodes[n].every = None);
            }
            if self.nodes[n].mode != super::ALWAYS {
                add(&|c| c.nodes[n].mode = super::ALWAYS);
            }
        }
        found
    }

    /// Removes connections without an end, then nodes with unconnected mandatory inputs.
    pub fn clean(&mut self) {
        loop {
            let ids: Vec<usize> = self.nodes.iter().map(|n| n.id).collect();
            self.links.retain(|l| ids.contains(&l.from.0) && ids.contains(&l.to.0));
            let count = self.nodes.len();
            let links = &self.links;
            self.nodes.retain(|n| {
                let fed = |input: &str| links.iter().any(|l| l.to.0 == n.id && l.to.1 == input);
                n.ty.inputs.iter().filter(|i| !i.ends_with('?')).all(|i| fed(i))
            });
            if self.nodes.len() == count {
                break;
            }
        }
        let Self { nodes, groups, cancels, resets, .. } = self;
        let group = |id: usize| nodes.iter().find(|n| n.id == id).map(|n| n.group);
        resets.retain(|((id, _), _)| group(*id) == Some(0));
        let is_used = |wanted: usize| nodes.iter().any(|n| around(groups, n.group).contains(&wanted));
        cancels.retain_mut(|cancel| {
            let body = match cancel.of {
                Target::Node(id) => group(id),
                Target::Group(of) => is_used(of).then(|| groups[of]),
            };
            let is_beside = |id: usize| body.is_some() && group(id) == body;
            cancel.back = cancel.back.filter(|((id, _), _)| is_beside(*id));
            cancel.tells = cancel.tells.filter(|(id, _)| is_beside(*id));
            is_beside(cancel.by.0.0)
        });
    }
}

/// A nested graph and all around it, innermost first, without the graph itself. `groups` are the enclosing ones.
pub fn around(groups: &[usize], mut group: usize) -> Vec<usize> {
    let mut found = vec![];
    while group != 0 {
        found.push(group);
        group = groups[group];
    }
    found
}
