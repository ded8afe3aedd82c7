//! Translation of a graph into a net: one component for each node, connection and boundary of a nested graph.

use super::{
    Net, NoNet, Place, PlaceId, Transition, TransitionKind, clocks, connection_name,
    route::{self, Loop, Segment, SegmentEnd, Side},
    side_name,
};
use apex_dsl::{
    catalog::Catalog,
    graph::{ConnectionId, Crossing, Flow, Graph, NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// The net of a checked graph. The body of an `each` belongs to its node.
///
/// # Errors
/// Fails if a port of the graph takes or sends several tokens per firing.
pub fn net(graph: &Graph, catalog: &Catalog) -> Result<Net, NoNet> {
    for (node, n) in graph.nodes.iter_enumerated() {
        if let Some(port) = n.ports.iter().find(|p| p.rate != 1) {
            let port = format!("{}.{}", graph.path(node), port.name);
            return Err(NoNet(format!("`{port}` has several tokens per firing, which nets do not support yet")));
        }
    }
    let mut builder = Builder::new(graph);
    for node in graph.nodes.ids() {
        builder.node(node, catalog);
    }
    let sides =
        builder.segments.iter().filter_map(|l| if let SegmentEnd::Side(side) = l.to { Some(side) } else { None });
    let sides: BTreeSet<Side> = sides.collect();
    sides.into_iter().for_each(|side| builder.side(side));
    builder.loops.clone().iter().for_each(|on_loop| builder.iteration(on_loop));
    builder.returning();
    Ok(builder.net)
}

/// Places of one leg of a connection.
struct LegPlaces {
    token: PlaceId,
    free: PlaceId,
    /// Copy of each token on the leg for the loop that it leads into.
    echo: Option<PlaceId>,
    /// Marked when the end of the leg has finished. The leg is free only when the delays of the loop have finished,
    /// too. Only for a leg into a loop.
    done: Option<PlaceId>,
}

/// Places of a delay.
struct DelayPlaces {
    held: PlaceId,
    room: PlaceId,
    enabled: PlaceId,
    waiting: PlaceId,
    /// Ports that send only values, marked while it is undecided if they send one.
    undecided: Vec<PlaceId>,
}

struct Builder<'a> {
    graph: &'a Graph,
    net: Net,
    segments: Vec<Segment>,
    places: Vec<LegPlaces>,
    loops: Vec<Loop>,
    /// Places of the delays.
    delays: BTreeMap<NodeId, DelayPlaces>,
    /// For each delay and each leg into its loop: everything that the delay sent for a token on the leg has
    /// finished.
    returns: BTreeMap<(NodeId, usize), PlaceId>,
    /// For the first delay of each loop and each output of a nested graph that its tokens pass: they have.
    ahead: BTreeMap<(NodeId, Crossing), PlaceId>,
    /// For each `start`: marked until it has begun.
    starts: BTreeMap<NodeId, PlaceId>,
    from: BTreeMap<SegmentEnd, Vec<usize>>,
    to: BTreeMap<SegmentEnd, Vec<usize>>,
}

impl<'a> Builder<'a> {
    fn new(graph: &'a Graph) -> Self {
        let segments = route::segments(graph);
        let mut net = Net { name: graph.name.clone(), ..Net::default() };
        let mut place = |name: String, initial| net.places.push(Place { name, initial });
        let mut places = vec![];
        for (i, segment) in segments.iter().enumerate() {
            let mut name = connection_name(graph, segment.connection);
            let first = segments.iter().position(|l| l.connection == segment.connection).unwrap_or(i);
            if i > first || matches!(segment.to, SegmentEnd::Side(..)) {
                name = format!("{name} (part {})", i - first + 1);
            }
            places.push(LegPlaces {
                token: place(format!("token on {name}"), 0),
                free: place(format!("{name} is free"), 1),
                echo: None,
                done: None,
            });
        }
        // `Bypass` and `State` rely on this order: two places for each leg, then the copies for legs into loops.
        let loops = route::loops(graph, &segments);
        let entries = || loops.iter().flat_map(|on_loop| on_loop.entries.iter().map(move |entry| (on_loop, *entry)));
        for (on_loop, entry) in entries() {
            let segment = connection_name(graph, segments[entry].connection);
            places[entry].echo = Some(place(format!("{} has seen {segment}", names(graph, &on_loop.delays)), 0));
        }
        let mut starts = BTreeMap::new();
        for (node, n) in graph.nodes.iter_enumerated() {
            if matches!(n.kind, NodeKind::Start) {
                starts.insert(node, place(format!("{} is due", graph.path(node)), 1));
            }
        }
        let mut ahead = BTreeMap::new();
        for on_loop in &loops {
            for side in &on_loop.ahead {
                let name =
                    format!("{} has passed {}", names(graph, &on_loop.delays), side_name(graph, Side::whole(*side)));
                ahead.insert((on_loop.delays[0], *side), place(name, 0));
            }
        }
        let mut returns = BTreeMap::new();
        for (on_loop, entry) in entries() {
            let segment = connection_name(graph, segments[entry].connection);
            places[entry].done = Some(place(format!("{segment} is done"), 0));
            for &delay in &on_loop.delays {
                let name = format!("{} has finished for {segment}", graph.path(delay));
                returns.insert((delay, entry), place(name, 0));
            }
        }
        let (mut from, mut to) = (BTreeMap::<_, Vec<_>>::new(), BTreeMap::<_, Vec<_>>::new());
        for (i, segment) in segments.iter().enumerate() {
            from.entry(segment.from).or_default().push(i);
            to.entry(segment.to).or_default().push(i);
        }
        Self { graph, net, segments, places, loops, delays: BTreeMap::new(), returns, ahead, starts, from, to }
    }

    fn place(&mut self, name: String, initial: usize) -> PlaceId {
        self.net.places.push(Place { name, initial })
    }

    fn transition(&mut self, name: String, kind: TransitionKind, takes: Vec<PlaceId>, gives: Vec<PlaceId>) {
        self.net.transitions.push(Transition { name, kind, takes, gives });
    }

    fn legs_from(&self, stop: SegmentEnd) -> Vec<usize> {
        self.from.get(&stop).cloned().unwrap_or_default()
    }

    /// Legs to the inputs of a node, or to a boundary.
    fn legs_into(&self, stop: SegmentEnd) -> Vec<usize> {
        let segments = self.to.get(&stop).into_iter().flatten().copied();
        segments.filter(|l| self.flow(*l) != Flow::ToSlot).collect()
    }

    fn flow(&self, segment: usize) -> Flow {
        self.graph.flow(&self.graph.connections[self.segments[segment].connection])
    }

    fn tokens(&self, segments: &[usize]) -> Vec<PlaceId> {
        segments.iter().map(|l| self.places[*l].token).collect()
    }

    /// Places that get a token when tokens are sent on `segments`.
    fn sent(&self, segments: &[usize]) -> Vec<PlaceId> {
        segments.iter().flat_map(|l| [self.places[*l].token].into_iter().chain(self.places[*l].echo)).collect()
    }

    fn free(&self, segments: &[usize]) -> Vec<PlaceId> {
        segments.iter().map(|l| self.places[*l].free).collect()
    }

    /// Places that get a token when the ends of `segments` have finished.
    fn finished(&self, segments: &[usize]) -> Vec<PlaceId> {
        segments.iter().map(|l| self.places[*l].done.unwrap_or(self.places[*l].free)).collect()
    }

    /// Frees the legs into loops: each one when its end has finished, and with it everything that the delays of the
    /// loop sent for its token.
    fn returning(&mut self) {
        for segment in 0..self.segments.len() {
            let Some(done) = self.places[segment].done else { continue };
            let mut takes = vec![done];
            takes.extend(self.returns.iter().filter(|((_, entry), _)| *entry == segment).map(|(_, place)| *place));
            let name = format!("{} is notified", connection_name(self.graph, self.segments[segment].connection));
            self.transition(name, TransitionKind::Return(segment), takes, vec![self.places[segment].free]);
        }
    }

    /// Places of the free legs that a node awaits before it counts as finished: all except the legs of its events.
    fn awaited(&self, segments: &[usize]) -> Vec<PlaceId> {
        let own = segments.iter().copied().filter(|l| !route::from_event(self.graph, self.segments[*l].connection));
        self.free(&own.collect::<Vec<_>>())
    }

    fn node(&mut self, node: NodeId, catalog: &Catalog) {
        let name = self.graph.path(node);
        match &self.graph.nodes[node].kind {
            NodeKind::Start => return self.start(node, name),
            NodeKind::Delay(initial) => return self.delay(node, &name, initial.len()),
            _ => {}
        }
        // `process` and the slots of a node take the lock while they run, so that they exclude one another.
        let lock = self.place(format!("{name} is unlocked"), 1);
        let ports = self.undecided(node, &name);
        if has_process(self.graph, catalog, node) {
            self.process(node, &name, lock, &ports);
        }
        self.slots(node, &name, lock, &ports);
        self.time_out(node, &name, lock);
    }

    /// Adds the transition that triggers the `timeout` of a node. Like a slot it needs the legs of all its events.
    fn time_out(&mut self, node: NodeId, name: &str, lock: PlaceId) {
        let Some(port) = clocks::port(self.graph, node) else { return };
        let (sent, kept): (Vec<usize>, Vec<usize>) = self
            .legs_of_events(node)
            .into_iter()
            .partition(|leg| self.graph.connections[self.segments[*leg].connection].from.port == port);
        let (mut takes, mut gives) = (vec![lock], vec![lock]);
        takes.extend(self.free(&sent));
        takes.extend(self.free(&kept));
        gives.extend(self.sent(&sent));
        gives.extend(self.free(&kept));
        self.transition(format!("{name} is timed out"), TransitionKind::TimeOut(node), takes, gives);
    }

    /// Legs of the events of a node.
    fn legs_of_events(&self, node: NodeId) -> Vec<usize> {
        let mut legs = self.legs_from(SegmentEnd::Node(node));
        legs.retain(|leg| route::from_event(self.graph, self.segments[*leg].connection));
        legs
    }

    /// Places of the ports that send only values, marked while it is undecided if the port sends one. Adds the
    /// transitions that decide it.
    fn undecided(&mut self, node: NodeId, name: &str) -> Vec<(usize, PlaceId)> {
        let mut ports = vec![];
        for port in 0..self.graph.nodes[node].ports.len() {
            let end = PortId { node, port };
            let connections: BTreeSet<ConnectionId> = route::value_connections(self.graph, end).collect();
            if connections.is_empty() {
                continue;
            }
            let segments = self.legs_from(SegmentEnd::Node(node));
            let segments: Vec<usize> =
                segments.into_iter().filter(|l| connections.contains(&self.segments[*l].connection)).collect();
            let port_name = format!("{name}.{}", self.graph.port(end).name);
            let place = self.place(format!("{port_name} is undecided"), 0);
            self.transition(
                format!("{port_name} sends"),
                TransitionKind::Trigger(end),
                vec![place],
                self.sent(&segments),
            );
            self.transition(
                format!("{port_name} is silent"),
                TransitionKind::Suppress(end),
                vec![place],
                self.free(&segments),
            );
            ports.push((port, place));
        }
        ports
    }

    fn process(&mut self, node: NodeId, name: &str, lock: PlaceId, ports: &[(usize, PlaceId)]) {
        let (inputs, out) = (self.legs_into(SegmentEnd::Node(node)), self.legs_from(SegmentEnd::Node(node)));
        let enabled = self.place(format!("{name} is enabled"), 1);
        let running = self.place(format!("{name} is running"), 0);
        let waiting = self.place(format!("{name} waits for notifications"), 0);
        // A node fires only if all its outgoing legs are free. `process` sends later, but then it must not block.
        let mut takes = self.tokens(&inputs);
        takes.extend([enabled, lock]);
        takes.extend(self.free(&out));
        self.transition(format!("{name} takes"), TransitionKind::Take(node), takes, vec![running]);
        let synchronous: Vec<usize> = out.iter().copied().filter(|l| self.flow(*l) == Flow::Synchronous).collect();
        let mut gives = vec![lock, waiting];
        gives.extend(self.sent(&synchronous));
        gives.extend(ports.iter().map(|(_, place)| *place));
        self.transition(format!("{name} sends"), TransitionKind::Send(node), vec![running], gives);
        // A leg that is both taken and given is only tested: it must be free, and remains so.
        let awaited = if self.graph.nodes[node].modifiers.pipelined { vec![] } else { self.awaited(&out) };
        let (mut takes, mut gives) = (vec![waiting], vec![enabled]);
        takes.extend(&awaited);
        gives.extend(&awaited);
        gives.extend(self.finished(&inputs));
        self.transition(format!("{name} is notified"), TransitionKind::Notify(node), takes, gives);
    }

    /// Adds the slots of a node. A slot takes the token of each connection to it as soon as the node is unlocked and
    /// the legs of all its events are free. The connection is free at once.
    fn slots(&mut self, node: NodeId, name: &str, lock: PlaceId, ports: &[(usize, PlaceId)]) {
        let incoming = self.to.get(&SegmentEnd::Node(node)).cloned().unwrap_or_default();
        let incoming: Vec<usize> = incoming.into_iter().filter(|l| self.flow(*l) == Flow::ToSlot).collect();
        if incoming.is_empty() {
            return;
        }
        let events = self.legs_of_events(node);
        let called = self.place(format!("{name} is in a slot"), 0);
        for segment in incoming {
            let connection = self.segments[segment].connection;
            let mut takes = vec![self.places[segment].token, lock];
            takes.extend(self.free(&events));
            let mut gives = vec![called, self.places[segment].free];
            // After a reset every `start` is due again.
            if matches!(self.graph.nodes[node].kind, NodeKind::Reset) {
                gives.extend(self.starts.values());
            }
            let slot = self.graph.end_name(self.graph.connections[connection].to);
            let from = self.graph.end_name(self.graph.connections[connection].from);
            self.transition(format!("{slot} handles {from}"), TransitionKind::Handle(connection), takes, gives);
        }
        // A slot can trigger events, but outputs are only sent by `process`.
        let mut gives = vec![lock];
        let is_event = |port: usize| self.graph.port(PortId { node, port }).kind == PortKind::Event;
        gives.extend(ports.iter().filter(|(port, _)| is_event(*port)).map(|(_, place)| *place));
        self.transition(format!("{name} has handled"), TransitionKind::Handled(node), vec![called], gives);
    }

    fn start(&mut self, node: NodeId, name: String) {
        let segments = self.legs_from(SegmentEnd::Node(node));
        let mut takes = vec![self.starts[&node]];
        takes.extend(self.free(&segments));
        self.transition(name, TransitionKind::Start(node), takes, self.sent(&segments));
    }

    /// Adds a delay. It takes like a sink and sends like a source: on a loop, the nodes that it would wait for need its
    /// tokens, and elsewhere the nodes behind it need not wait for the nodes before it.
    fn delay(&mut self, node: NodeId, name: &str, initial: usize) {
        let (inputs, out) = (self.legs_into(SegmentEnd::Node(node)), self.legs_from(SegmentEnd::Node(node)));
        let undecided = self.undecided(node, name).into_iter().map(|(_, place)| place).collect();
        let held = self.place(format!("{name} holds"), initial);
        let room = self.place(format!("{name} has room"), 1);
        let enabled = self.place(format!("{name} is enabled"), 1);
        let waiting = self.place(format!("{name} waits for notifications"), 0);
        let mut takes = self.tokens(&inputs);
        takes.push(room);
        // `State` relies on `held` being the last place.
        let mut gives = self.finished(&inputs);
        gives.push(held);
        self.transition(format!("{name} takes"), TransitionKind::Hold(node), takes, gives);
        let awaited = self.awaited(&out);
        let (mut takes, mut gives) = (vec![waiting], vec![enabled]);
        takes.extend(&awaited);
        gives.extend(&awaited);
        gives.extend(self.returns.iter().filter(|((delay, _), _)| *delay == node).map(|(_, place)| *place));
        self.transition(format!("{name} is notified"), TransitionKind::Notify(node), takes, gives);
        self.delays.insert(node, DelayPlaces { held, room, enabled, waiting, undecided });
    }

    /// Adds the transition with which the delays of a loop send, once for each iteration of the nodes that feed the
    /// loop.
    fn iteration(&mut self, on_loop: &Loop) {
        let Loop { delays, entries, events, ahead } = on_loop;
        let out: Vec<usize> = delays.iter().flat_map(|delay| self.legs_from(SegmentEnd::Node(*delay))).collect();
        let synchronous: Vec<usize> = out.iter().copied().filter(|l| self.flow(*l) == Flow::Synchronous).collect();
        let own = || delays.iter().map(|delay| &self.delays[delay]);
        // `State` relies on the places where the delays hold tokens being the first.
        let mut takes: Vec<PlaceId> = own().map(|delay| delay.held).collect();
        takes.extend(own().map(|delay| delay.enabled));
        // The copies (`echo`) announce an iteration before the nodes at the ends of the entries fire, as they may need
        // the tokens of the delays to do so.
        takes.extend(entries.iter().filter_map(|entry| self.places[*entry].echo));
        takes.extend(self.free(&out));
        // The legs of events on the loop are only tested, because they are sent later in the iteration.
        let events = self.free(events);
        takes.extend(&events);
        let mut gives: Vec<PlaceId> = own().flat_map(|delay| [delay.room, delay.waiting]).collect();
        gives.extend(events);
        gives.extend(self.sent(&synchronous));
        gives.extend(own().flat_map(|delay| &delay.undecided));
        gives.extend(ahead.iter().map(|side| self.ahead[&(delays[0], *side)]));
        let verb = if delays.len() == 1 { "sends" } else { "send" };
        let name = format!("{} {verb}", names(self.graph, delays));
        self.transition(name, TransitionKind::Release(delays[0]), takes, gives);
    }

    /// Adds a boundary of a nested graph. It takes a token from each leg that ends there and sends one on each leg that
    /// begins there, after the delays of a loop have sent theirs ahead.
    fn side(&mut self, side: Side) {
        let name = side_name(self.graph, side);
        let (incoming, outgoing) = (self.legs_into(SegmentEnd::Side(side)), self.legs_from(SegmentEnd::Side(side)));
        let enabled = self.place(format!("{name} is enabled"), 1);
        let waiting = self.place(format!("{name} waits for notifications"), 0);
        let mut takes = self.tokens(&incoming);
        takes.push(enabled);
        takes.extend(self.free(&outgoing));
        takes.extend(self.ahead.iter().filter(|((_, of), _)| Side::whole(*of) == side).map(|(_, place)| *place));
        let mut gives = self.sent(&outgoing);
        gives.push(waiting);
        self.transition(format!("{name} passes"), TransitionKind::Pass(side), takes, gives);
        let awaited = self.free(&outgoing);
        let (mut takes, mut gives) = (vec![waiting], vec![enabled]);
        takes.extend(&awaited);
        gives.extend(&awaited);
        gives.extend(self.finished(&incoming));
        self.transition(format!("{name} is notified"), TransitionKind::NotifySide(side), takes, gives);
    }
}

/// Names of nodes, separated by commas.
fn names(graph: &Graph, nodes: &[NodeId]) -> String {
    nodes.iter().map(|node| graph.path(*node)).collect::<Vec<_>>().join(", ")
}

/// Returns `true` if a node takes inputs or sends outputs, as `process` does.
pub fn has_process(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => {
            let signature = &catalog.signatures[library.signature];
            signature.is_function || signature.process.is_some()
        }
        NodeKind::Each(_) | NodeKind::Delay(_) | NodeKind::Relay => true,
        NodeKind::Boundary(kind) => *kind != PortKind::Event,
        NodeKind::Probe => graph.nodes[node].ports.iter().any(|p| p.kind == PortKind::Input),
        NodeKind::Start
        | NodeKind::Watchdog
        | NodeKind::SetBack
        | NodeKind::Exit(_)
        | NodeKind::Reset
        | NodeKind::Interrupt(_)
        | NodeKind::Sender(_)
        | NodeKind::Receiver(_) => false,
    }
}
