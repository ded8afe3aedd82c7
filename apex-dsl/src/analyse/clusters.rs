//! Regions, guards and clusters: the division of a graph into parts that become straight-line code.
//!
//! The order of the nodes in a region is known at compile time, but not when they fire. That depends on *guards*: a
//! timer, an input of the program, the token of an event, room for an event, the next reaction. A node depends on its
//! own guards and on those of all nodes upstream. The nodes of a region with the same guards fire together: they form
//! a *cluster*. Example:
//!
//! ```text
//! scan (every 100ms) -> filter -> fuse.scan        scan, filter: guard 1
//! odometry (every 20ms) -> fuse.pose               odometry: guard 2; fuse: guards 1, 2
//! ```
//!
//! The clusters are {scan, filter}, {odometry} and {fuse}. The last one tests no guard itself. It waits for a token of
//! each of the other two.
//!
//! Clusters are as large as possible, but no node may wait for a condition that the firing rules do not require. This
//! is why sources without a period are also grouped by what holds them back (`holding`).

use super::{
    asynchronous::Asynchronous,
    cluster::{Block, Cluster, ClusterId, Guard, tokens},
    demand_driven::demand_driven,
    firing::{fires, is_source},
    holding::{Holding, Ways},
    links::Links,
    view::View,
};
use crate::{
    catalog::Catalog,
    graph::{Connection, ConnectionId, Crossing, Flow, Graph, Node, NodeId, NodeKind, ScopeId},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of timers and inputs of a program. It bounds the time and memory for the sets of guards.
const MAX_PACES: usize = 1_000;

/// Reports a program with more than [`MAX_PACES`] timers and inputs, and returns `None` then.
pub fn check_paces(graph: &Graph, diagnostics: &mut Diagnostics) -> Option<()> {
    let sets_a_pace = |n: &&Node| matches!(n.kind, NodeKind::Boundary(PortKind::Input)) || n.modifiers.has_pace();
    let Some(node) = graph.nodes.iter().filter(sets_a_pace).nth(MAX_PACES) else { return Some(()) };
    let message = format!("a program has at most {MAX_PACES} inputs and sources with `every` or `after`");
    diagnostics.push(Diagnostic::error("too-large", node.span, message));
    None
}

/// Region of each node, numbered in the order of the source file. All connections to inputs that cross the boundaries
/// of a nested graph end in one region, as it takes its inputs together and sends its outputs together.
pub fn regions(graph: &Graph) -> IdVec<NodeId, usize> {
    // Union-find: the representative of a region is its first node.
    let mut root: IdVec<NodeId, NodeId> = graph.nodes.ids().collect();
    let mut join = |a: NodeId, b: NodeId| {
        let (a, b) = (find(&mut root, a), find(&mut root, b));
        root[a.max(b)] = a.min(b);
    };
    for (source, paces) in &graph.paced {
        paces.iter().for_each(|pace| join(*source, *pace));
    }
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
    graph
        .nodes
        .ids()
        .map(|node| {
            let next = numbers.len();
            *numbers.entry(find(&mut root, node)).or_insert(next)
        })
        .collect()
}

/// Representative of a node's region. Shortens the path to it (path halving).
fn find(root: &mut IdVec<NodeId, NodeId>, mut node: NodeId) -> NodeId {
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
    regions: &IdVec<NodeId, usize>,
    asynchronous: &Asynchronous,
) -> (Vec<Guard>, IdVec<ClusterId, Cluster>, IdVec<NodeId, ClusterId>) {
    let mut guards = vec![];
    let mut own: IdVec<NodeId, Vec<usize>> = IdVec::from_elem(vec![], graph.nodes.len());
    for (id, node) in graph.nodes.iter_enumerated() {
        // The body of an `each` has none of these guards: it runs when it is called, with all its inputs.
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
    // The dispatcher tests clusters in the order of the source file.
    groups.sort_by_key(|(_, nodes)| nodes.iter().min().copied());
    let mut cluster_of = IdVec::from_elem(ClusterId::from(0), graph.nodes.len());
    let mut clusters: IdVec<ClusterId, Cluster> = IdVec::default();
    for ((region, set), nodes) in groups {
        nodes.iter().for_each(|n| cluster_of[*n] = ClusterId::from(clusters.len()));
        // A set, as several nodes can share a React guard.
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
    debug_assert_eq!(
        clusters.iter().map(|cluster| cluster.own_guards.len()).sum::<usize>(),
        clusters.iter().flat_map(|cluster| &cluster.own_guards).collect::<BTreeSet<_>>().len(),
        "a guard that one cluster takes is missed by another one"
    );
    join(graph, &cluster_of, &mut clusters);
    (guards, clusters, cluster_of)
}

/// Finds the clusters upstream and downstream of each cluster. A nested graph takes its inputs together and sends its
/// outputs together, so a consumer behind a boundary waits for all clusters that send to the boundary.
fn join(graph: &Graph, cluster_of: &IdVec<NodeId, ClusterId>, clusters: &mut IdVec<ClusterId, Cluster>) {
    let synchronous: Vec<&Connection> = graph.connections.iter().filter(|c| graph.is_synchronous(c)).collect();
    // Boundaries also feed other boundaries, in any order: repeat until nothing is added.
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
        last.iter().for_each(|a| waits(clusters, b, *a));
    }
    for (source, paces) in &graph.paced {
        paces.iter().for_each(|pace| waits(clusters, cluster_of[*source], cluster_of[*pace]));
    }
}

/// Notes that a cluster waits for another one.
fn waits(clusters: &mut IdVec<ClusterId, Cluster>, cluster: ClusterId, upstream: ClusterId) {
    if cluster != upstream {
        clusters[upstream].downstream.insert(cluster);
        clusters[cluster].upstream.insert(upstream);
    }
}

/// For each boundary of a nested graph, the clusters or guards of all tokens that arrive there.
type Sides<T> = BTreeMap<Crossing, BTreeSet<T>>;

/// Passes `tokens` (clusters or guards) through the boundaries `crossings`, and returns what leaves the last one. At
/// each boundary all that arrives there goes on together. `changed` is set if a boundary gets something new.
fn pass_sides<T: Copy + Ord>(
    crossings: &[Crossing],
    mut tokens: BTreeSet<T>,
    sides: &mut Sides<T>,
    changed: &mut bool,
) -> BTreeSet<T> {
    for crossing in crossings {
        let side = sides.entry(*crossing).or_default();
        *changed |= !tokens.is_subset(side);
        side.extend(tokens);
        tokens = side.clone();
    }
    tokens
}

/// Adds a [`Guard::React`] to each source without a period that does not fire together with its consumers. Returns the
/// accumulated guards of each node.
///
/// The two kinds depend on each other. A new guard also reaches the consumers downstream, so that those of a pulled
/// group may no longer have guards in common. The group is dropped then, its sources get guards of their own, and the
/// next round begins. The same holds for nodes that share a new guard, of which another one reaches only some: a loop
/// of delays may feed another one. They are parted then. As groups are only dropped and parted, the rounds end.
fn add_react_guards(
    view: &View<'_>,
    guards: &mut Vec<Guard>,
    own: &mut IdVec<NodeId, Vec<usize>>,
) -> IdVec<NodeId, BTreeSet<usize>> {
    let above = accumulate(view, guards, own);
    let plain = without_pace(view, guards, own);
    let stays = view.graph.nodes.ids().filter(|node| view.sends_what_stays(*node));
    let ways = Ways::new(view.graph, view.links, guards, own, stays);
    let mut demand_driven = demand_driven(view, &above);
    let mut parts: BTreeMap<NodeId, usize> = plain.iter().map(|node| (*node, 0)).collect();
    loop {
        let (mut all, mut with_react) = (guards.clone(), own.clone());
        let is_pulled = |node: &NodeId| demand_driven.iter().any(|p| p.nodes.contains(node));
        // A shared guard is taken by one firing, so all nodes that share it must end up in one cluster. That depends on
        // their other guards, too.
        let mut shared: BTreeMap<Alike<'_>, usize> = BTreeMap::new();
        let sharing: Vec<NodeId> = plain.iter().copied().filter(|node| !is_pulled(node)).collect();
        // Pulled nodes wait for what their consumers wait for.
        let sets = demand_driven.iter().filter_map(|group| Some((group, group.guards(guards, &above)?)));
        let pulled = sets.flat_map(|(group, set)| group.nodes.iter().map(move |node| (*node, set.clone()))).collect();
        let holding = |node: &NodeId| (*node, ways.holding(*node, &pulled));
        let holding: BTreeMap<NodeId, Holding> = sharing.iter().map(holding).collect();
        for &node in &sharing {
            let key = (view.regions[node], &above[node], &holding[&node], parts[&node]);
            let guard = *shared.entry(key).or_insert_with(|| {
                all.push(Guard::React);
                all.len() - 1
            });
            with_react[node].push(guard);
        }
        let mut accumulated = accumulate(view, &all, &with_react);
        let count = demand_driven.len();
        demand_driven.retain(|p| {
            let set = p.guards(&all, &accumulated);
            set.inspect(|set| p.nodes.iter().for_each(|node| accumulated[*node].clone_from(set))).is_some()
        });
        let mut found: BTreeMap<(&[usize], &BTreeSet<usize>), usize> = BTreeMap::new();
        for &node in &sharing {
            let number = found.len();
            let number = *found.entry((&with_react[node], &accumulated[node])).or_insert(number);
            parts.insert(node, number);
        }
        if demand_driven.len() == count && found.len() == shared.len() {
            (*guards, *own) = (all, with_react);
            return accumulated;
        }
    }
}

/// Properties that nodes with a common guard share: their region, their other guards, what holds them back, and the
/// part that they are in.
type Alike<'a> = (usize, &'a BTreeSet<usize>, &'a Holding, usize);

/// Nodes that fire once per reaction: sources without a period, and delays on loops that nothing feeds. Without a guard
/// such a loop would not have a condition to wait for, and would fire without end.
fn without_pace(view: &View<'_>, guards: &[Guard], own: &IdVec<NodeId, Vec<usize>>) -> Vec<NodeId> {
    let View { graph, catalog, links, .. } = *view;
    let has_pace = |n: NodeId| own[n].iter().any(|g| matches!(guards[*g], Guard::Timer(_) | Guard::Input(_)));
    let paced = |n: NodeId| has_pace(n) || graph.paced.contains_key(&n);
    let sources = graph.nodes.ids().filter(|n| !paced(*n) && is_source(graph, catalog, links, *n));
    let mut plain: Vec<NodeId> = sources.collect();
    // A further guard flows downstream from these sources. Delays that neither it nor another guard reaches are on
    // loops that nothing feeds. Room for events does not count: it does not begin anything.
    let (mut guards, mut started) = (guards.to_vec(), own.clone());
    plain.iter().for_each(|n| started[*n].push(guards.len()));
    guards.push(Guard::React);
    let reached = accumulate(view, &guards, &started);
    let delays = graph.nodes.ids().filter(|n| matches!(graph.nodes[*n].kind, NodeKind::Delay(_)));
    let starts = |g: &usize| !matches!(guards[*g], Guard::Events(_));
    plain.extend(delays.filter(|n| !reached[*n].iter().any(starts)));
    plain.sort_unstable();
    plain
}

/// Guards of each node: its own, and those of all nodes upstream. The guards of all tokens that arrive at a boundary go
/// on together. A token of an event brings its own guard and not those of its sender. Guards also travel around loops
/// with delays: all nodes are visited until nothing changes.
fn accumulate(view: &View<'_>, guards: &[Guard], own: &IdVec<NodeId, Vec<usize>>) -> IdVec<NodeId, BTreeSet<usize>> {
    let View { graph, links, order, .. } = *view;
    let tokens: BTreeMap<ConnectionId, usize> = tokens(guards).collect();
    let mut sets: IdVec<NodeId, BTreeSet<usize>> = own.iter().map(|g| g.iter().copied().collect()).collect();
    let mut sides = Sides::new();
    loop {
        let mut changed = false;
        for &node in order {
            let mut set = std::mem::take(&mut sets[node]);
            let before = set.len();
            graph.paced.get(&node).into_iter().flatten().for_each(|pace| set.extend(&sets[*pace]));
            for &index in &links.inputs[node] {
                let connection = &graph.connections[index];
                // The token of an event does not bring the guards of the event's node, which fires on its own.
                let token = match tokens.get(&index) {
                    Some(guard) => BTreeSet::from([*guard]),
                    None if connection.crossings.is_empty() => {
                        set.extend(&sets[connection.from.node]);
                        continue;
                    }
                    None => sets[connection.from.node].clone(),
                };
                set.extend(pass_sides(&connection.crossings, token, &mut sides, &mut changed));
            }
            changed |= set.len() > before;
            sets[node] = set;
        }
        if !changed {
            return sets;
        }
    }
}
