//! Regions, guards and clusters: what runs together as straight-line code (see the execution semantics).

use super::{Analysis, Asynchronous, Block, Links, Step, fires, is_source, pulled::pulled};
use crate::{
    catalog::Catalog,
    graph::{Connection, Crossing, Flow, Graph, Node, NodeId, NodeKind, ScopeId},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Something that a cluster waits for and that the synchronous schedule does not decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// The timer of a source with `every`.
    Timer(NodeId),
    /// A graph-level input.
    Input(NodeId),
    /// Sources without a pace of their own: once per `react`. They share a guard where they wait for the same things downstream.
    React,
    /// The token on an asynchronous connection into an input.
    Token(usize),
    /// The events of this node are enabled: it can trigger them (R1).
    Events(NodeId),
}

impl Guard {
    /// The guard as text: `input scan`.
    pub fn text(self, graph: &Graph) -> String {
        match self {
            Self::Timer(node) => {
                let modifiers = &graph.nodes[node].modifiers;
                let every = modifiers.every.map(|period| format!("every {period:?}"));
                let after = modifiers.after.map(|time| format!("after {time:?}"));
                let times: Vec<String> = every.into_iter().chain(after).collect();
                format!("timer of {} ({})", graph.path(node), times.join(" "))
            }
            Self::Token(connection) => format!("event {}", graph.end_name(graph.connections[connection].from)),
            Self::Events(node) => format!("events of {} enabled", graph.path(node)),
            Self::Input(node) => format!("input {}", graph.path(node)),
            Self::React => "each reaction".to_owned(),
        }
    }
}

/// Nodes that fire together.
#[derive(Debug)]
pub struct Cluster {
    /// The region.
    pub region: usize,
    /// Its nodes, producers before consumers.
    pub nodes: Vec<NodeId>,
    /// Whether it ever fires: all tokens that it waits for can come.
    pub fires: bool,
    /// All guards that its nodes depend on.
    pub guards: BTreeSet<usize>,
    /// The guards that it tests itself; the others come with the tokens.
    pub own_guards: Vec<usize>,
    /// Clusters that send to it.
    pub upstream: BTreeSet<usize>,
    /// Clusters that it sends to.
    pub downstream: BTreeSet<usize>,
    /// The asynchronous connections that its nodes send on, in the order in which their tokens are emitted.
    pub sends: Vec<usize>,
    /// What a firing does.
    pub block: Block,
}

impl Cluster {
    /// Its nodes in the order in which they fire.
    pub fn schedule(&self) -> Vec<NodeId> {
        let mut order = vec![];
        let mut blocks: Vec<std::slice::Iter<'_, Step>> = vec![self.block.steps.iter()];
        while let Some(steps) = blocks.last_mut() {
            match steps.next() {
                Some(Step::Fire(node)) => order.push(*node),
                Some(Step::Block(inner)) => blocks.push(inner.steps.iter()),
                None => drop(blocks.pop()),
            }
        }
        order
    }

    /// Whether it just runs once per `react`: nothing to wait for, nothing between it and others.
    pub fn is_free(&self, graph: &Graph, analysis: &Analysis) -> bool {
        let holds_back = |c: &usize| {
            analysis.asynchronous.stays[*c] && graph.port(graph.connections[*c].from).kind == PortKind::Output
        };
        self.upstream.is_empty()
            && self.downstream.is_empty()
            && self.own_guards.iter().all(|g| analysis.guards[*g] == Guard::React)
            && !self.sends.iter().any(holds_back)
    }
}

/// More timers and graph-level inputs than one program has; bounds the time and memory for the sets of guards.
const MAX_PACES: usize = 1_000;

/// Reports a program with more of them; `None` then.
pub fn check_paces(graph: &Graph, diagnostics: &mut Diagnostics) -> Option<()> {
    let sets_a_pace = |n: &&Node| matches!(n.kind, NodeKind::Boundary(PortKind::Input)) || n.modifiers.has_pace();
    let Some(node) = graph.nodes.iter().filter(sets_a_pace).nth(MAX_PACES) else { return Some(()) };
    let message = format!("a program has at most {MAX_PACES} inputs and sources with `every`");
    diagnostics.push(Diagnostic::error("too-large", node.span, message));
    None
}

/// The region of each node, numbered in the order of the text. What enters or leaves a nested graph does so
/// together, and belongs to one region.
pub fn regions(graph: &Graph) -> Vec<usize> {
    let mut root: Vec<usize> = (0..graph.nodes.len()).collect();
    let mut join = |a: usize, b: usize| {
        let (a, b) = (find(&mut root, a), find(&mut root, b));
        root[a.max(b)] = a.min(b);
    };
    let mut at_scope: BTreeMap<ScopeId, NodeId> = BTreeMap::new();
    for c in graph.connections.iter().filter(|c| graph.flow(c) != Flow::ToSlot) {
        if graph.is_synchronous(c) {
            join(c.from.node, c.to.node);
        }
        for Crossing::Enter(scope) | Crossing::Leave(scope) in &c.crossings {
            join(*at_scope.entry(*scope).or_insert(c.to.node), c.to.node);
        }
    }
    let mut numbers = BTreeMap::new();
    (0..graph.nodes.len())
        .map(|node| {
            let next = numbers.len();
            *numbers.entry(find(&mut root, node)).or_insert(next)
        })
        .collect()
}

fn find(root: &mut [usize], mut node: usize) -> usize {
    while root[node] != node {
        root[node] = root[root[node]];
        node = root[node];
    }
    node
}

/// Guards, clusters, and the cluster of each node.
pub fn clusters(
    graph: &Graph,
    catalog: &Catalog,
    links: &Links,
    order: &[NodeId],
    regions: &[usize],
    asynchronous: &Asynchronous,
) -> (Vec<Guard>, Vec<Cluster>, Vec<usize>) {
    let mut guards = vec![];
    let mut own: Vec<Vec<usize>> = vec![vec![]; graph.nodes.len()];
    for (id, node) in graph.nodes.iter().enumerate() {
        // The body of an `each` runs when it is called, with all its inputs.
        if graph.is_body || !fires(graph, catalog, links, id) {
            continue;
        }
        let mut add = |guard: Guard| {
            own[id].push(guards.len());
            guards.push(guard);
        };
        match node.kind {
            NodeKind::Boundary(PortKind::Input) => add(Guard::Input(id)),
            _ if is_source(graph, catalog, links, id) && node.modifiers.has_pace() => add(Guard::Timer(id)),
            _ => {}
        }
        for &c in links.inputs[id].iter().filter(|c| graph.flow(&graph.connections[**c]) == Flow::ToInput) {
            add(Guard::Token(c));
        }
        if asynchronous.holding_back(graph, links, id).next().is_some() {
            add(Guard::Events(id));
        }
    }
    let view = View { graph, catalog, links, order, regions, asynchronous };
    let accumulated = add_react_guards(&view, &mut guards, &mut own);
    let mut by_guards: BTreeMap<(usize, &BTreeSet<usize>), Vec<NodeId>> = BTreeMap::new();
    for &node in order.iter().filter(|n| fires(graph, catalog, links, **n)) {
        by_guards.entry((regions[node], &accumulated[node])).or_default().push(node);
    }
    let mut groups: Vec<_> = by_guards.into_iter().collect();
    groups.sort_by_key(|(_, nodes)| nodes.iter().min().copied());
    let mut cluster_of = vec![0; graph.nodes.len()];
    let mut clusters: Vec<Cluster> = vec![];
    for ((region, set), nodes) in groups {
        nodes.iter().for_each(|n| cluster_of[*n] = clusters.len());
        let own_guards: BTreeSet<usize> = nodes.iter().flat_map(|n| own[*n].iter().copied()).collect();
        let (upstream, downstream) = (BTreeSet::new(), BTreeSet::new());
        let own_guards = own_guards.into_iter().collect();
        clusters.push(Cluster {
            region,
            nodes,
            fires: true,
            guards: set.clone(),
            own_guards,
            upstream,
            downstream,
            sends: vec![],
            block: Block::default(),
        });
    }
    join(graph, &cluster_of, &mut clusters);
    (guards, clusters, cluster_of)
}

/// Which cluster sends to which: on its connections, and because the inputs of a nested graph are taken together and its
/// outputs sent together, so that who takes one of them waits for all that send to that side.
fn join(graph: &Graph, cluster_of: &[usize], clusters: &mut [Cluster]) {
    let synchronous: Vec<&Connection> = graph.connections.iter().filter(|c| graph.is_synchronous(c)).collect();
    let mut senders = Sides::new();
    loop {
        let mut changed = false;
        for c in &synchronous {
            pass_sides(&c.crossings, BTreeSet::from([cluster_of[c.from.node]]), &mut senders, &mut changed);
        }
        if !changed {
            break;
        }
    }
    for c in &synchronous {
        let own = BTreeSet::from([cluster_of[c.from.node]]);
        let b = cluster_of[c.to.node];
        let last = c.crossings.last().map_or(&own, |side| &senders[side]);
        for &a in last.iter().filter(|a| **a != b) {
            clusters[a].downstream.insert(b);
            clusters[b].upstream.insert(a);
        }
    }
}

/// For each side of a nested graph what comes to it: clusters, or guards.
type Sides = BTreeMap<Crossing, BTreeSet<usize>>;

/// What comes out behind `crossings` where `tokens` go in: at each side all that comes to it goes on together.
fn pass_sides(
    crossings: &[Crossing],
    mut tokens: BTreeSet<usize>,
    sides: &mut Sides,
    changed: &mut bool,
) -> BTreeSet<usize> {
    for crossing in crossings {
        let side = sides.entry(*crossing).or_default();
        *changed |= !tokens.is_subset(side);
        side.extend(tokens);
        tokens = side.clone();
    }
    tokens
}

/// What the functions below look at.
pub struct View<'a> {
    pub graph: &'a Graph,
    catalog: &'a Catalog,
    pub links: &'a Links,
    order: &'a [NodeId],
    regions: &'a [usize],
    asynchronous: &'a Asynchronous,
}

impl View<'_> {
    /// Whether a node ever fires.
    pub fn fires(&self, node: NodeId) -> bool {
        fires(self.graph, self.catalog, self.links, node)
    }

    /// Whether what a node sends to slots may hold back those that feed it.
    fn sends_what_stays(&self, node: NodeId) -> bool {
        let is_output = |c: &usize| self.graph.port(self.graph.connections[*c].from).kind == PortKind::Output;
        self.links.sends[node].iter().any(|c| is_output(c) && self.asynchronous.stays[*c])
    }
}

/// Adds the guards of what has no pace, if nobody takes its tokens at a pace of his own; all guards that each node depends on.
fn add_react_guards(view: &View<'_>, guards: &mut Vec<Guard>, own: &mut Vec<Vec<usize>>) -> Vec<BTreeSet<usize>> {
    let above = accumulate(view, guards, own);
    let plain = without_pace(view, guards, own);
    let holding = holding(view, &above);
    let mut pulled = pulled(view, &above);
    loop {
        let (mut all, mut with_react) = (guards.clone(), own.clone());
        let is_pulled = |node: &NodeId| pulled.iter().any(|p| p.nodes.contains(node));
        // What shares a guard has to share a cluster: that depends on the guards of its own, too.
        let mut shared: BTreeMap<(usize, &BTreeSet<usize>, &BTreeSet<usize>), usize> = BTreeMap::new();
        for &node in plain.iter().filter(|node| !is_pulled(node)) {
            let guard = *shared.entry((view.regions[node], &above[node], &holding[node])).or_insert_with(|| {
                all.push(Guard::React);
                all.len() - 1
            });
            with_react[node].push(guard);
        }
        let mut accumulated = accumulate(view, &all, &with_react);
        let count = pulled.len();
        pulled.retain(|p| {
            let set = p.guards(&all, &accumulated);
            set.inspect(|set| p.nodes.iter().for_each(|node| accumulated[*node].clone_from(set))).is_some()
        });
        if pulled.len() == count {
            (*guards, *own) = (all, with_react);
            return accumulated;
        }
    }
}

/// All guards upstream and downstream of each node. Sources without a pace fire once per `react`. Two of them may share a cluster
/// only if the same things downstream hold them back; else one would wait for what holds back the other.
fn holding(view: &View<'_>, above: &[BTreeSet<usize>]) -> Vec<BTreeSet<usize>> {
    let mut holding = above.to_vec();
    for &node in view.order.iter().rev() {
        if view.sends_what_stays(node) {
            // No guard of its own, but told apart like one.
            holding[node].insert(usize::MAX - node);
        }
        for &c in &view.links.out_of[node] {
            let next = holding[view.graph.connections[c].to.node].clone();
            holding[node].extend(next);
        }
    }
    holding
}

/// Sources without a pace, and the delays of loops that no source feeds: nothing else would ever start them, or
/// let them rest.
fn without_pace(view: &View<'_>, guards: &[Guard], own: &[Vec<usize>]) -> Vec<NodeId> {
    let View { graph, catalog, links, .. } = *view;
    let paced = |n: NodeId| own[n].iter().any(|g| matches!(guards[*g], Guard::Timer(_) | Guard::Input(_)));
    let sources = (0..graph.nodes.len()).filter(|n| !paced(*n) && is_source(graph, catalog, links, *n));
    let mut plain: Vec<NodeId> = sources.collect();
    let mut started = own.to_vec();
    plain.iter().for_each(|n| started[*n].push(usize::MAX));
    let reached = accumulate(view, guards, &started);
    let delays = (0..graph.nodes.len()).filter(|n| matches!(graph.nodes[*n].kind, NodeKind::Delay(_)));
    let starts = |g: &usize| *g == usize::MAX || !matches!(guards[*g], Guard::Events(_));
    plain.extend(delays.filter(|n| !reached[*n].iter().any(starts)));
    plain.sort_unstable();
    plain
}

/// All guards upstream of each node. Nested graphs take their inputs together and send their outputs
/// together; around a delay the guards go in a circle until nothing changes.
fn accumulate(view: &View<'_>, guards: &[Guard], own: &[Vec<usize>]) -> Vec<BTreeSet<usize>> {
    let View { graph, links, order, .. } = *view;
    let tokens: BTreeMap<usize, usize> = guards
        .iter()
        .enumerate()
        .filter_map(|(g, guard)| if let Guard::Token(c) = guard { Some((*c, g)) } else { None })
        .collect();
    let mut sets: Vec<BTreeSet<usize>> = own.iter().map(|g| g.iter().copied().collect()).collect();
    let mut sides = Sides::new();
    loop {
        let mut changed = false;
        for &node in order {
            let mut set = sets[node].clone();
            for &index in &links.inputs[node] {
                let connection = &graph.connections[index];
                let token = match tokens.get(&index) {
                    Some(guard) => BTreeSet::from([*guard]),
                    None => sets[connection.from.node].clone(),
                };
                set.extend(pass_sides(&connection.crossings, token, &mut sides, &mut changed));
            }
            changed |= set.len() > sets[node].len();
            sets[node] = set;
        }
        if !changed {
            return sets;
        }
    }
}
