//! State of a program that is interpreted.

use crate::{Library, Node, Value, code::Code, conditions::Conditions, delay::Delay, machine::Running};
use apex_dsl::{
    analyse::ClusterId,
    graph::{ConnectionId, NodeId, NodeKind, PortId},
    machine::Machines,
    program::{Flag, Spot},
};
use apex_rt::{ProgramTime, Time, Timeout, Timer};
use std::{
    collections::{BTreeMap, BTreeSet, VecDeque},
    rc::Rc,
    time::Duration,
};

/// Everything that a program remembers.
pub struct State<'a> {
    /// Nodes of the catalog.
    pub nodes: BTreeMap<NodeId, Box<dyn Node>>,
    /// State machines.
    pub machines: BTreeMap<NodeId, Running<'a>>,
    /// Tokens that outlive a firing.
    pub tokens: BTreeMap<PortId, Value>,
    /// Values that slots get in place of tokens.
    pub given: BTreeMap<ConnectionId, Value>,
    /// Tokens that delays hold.
    pub held: BTreeMap<NodeId, Delay<Value>>,
    /// Activity of these tokens.
    pub held_activity: BTreeMap<NodeId, Delay<()>>,
    /// Flags that are set.
    pub flags: BTreeSet<Flag>,
    /// Nodes that `cancel` remembers for `resume`.
    pub remembered: BTreeMap<NodeId, BTreeSet<NodeId>>,
    /// Conditions of the dispatcher.
    pub conditions: Conditions,
    /// Slots with waiting tokens.
    pub queue: VecDeque<usize>,
    /// Timers of sources.
    pub timers: Vec<Timer>,
    /// Timeouts of nodes.
    pub timeouts: Vec<Timeout>,
    /// Silences of guards.
    pub silences: Vec<Timeout>,
    /// Stamps of connections.
    pub stamps: Vec<Time>,
    /// Stamps of clusters.
    pub cluster_stamps: BTreeMap<ClusterId, Time>,
    /// Time of the program.
    pub time: ProgramTime,
    /// Lead of the time when the event of a node was last triggered.
    pub told_ahead: BTreeMap<NodeId, i64>,
    /// Cells whose tokens are not done with.
    pub holding: BTreeSet<usize>,
    /// Claims that are broken now.
    pub broken: BTreeSet<usize>,
    /// Steps that are left in the reaction.
    pub steps: u32,
    /// `true` after `start`.
    pub started: bool,
    /// Code with which the program ends.
    pub exit: Option<u8>,
    /// Tokens that were put into inputs and slots of the program, in the order of their numbers.
    pub inputs: BTreeMap<NodeId, (u64, Value)>,
    /// Tokens that probes have seen.
    pub probes: BTreeMap<NodeId, Vec<Value>>,
    /// Tokens at outputs of the program.
    pub outputs: BTreeMap<NodeId, Value>,
    /// Events of the program that wait to be taken.
    pub events: BTreeMap<NodeId, Value>,
    /// State of the bodies of `each`.
    pub bodies: BTreeMap<NodeId, State<'a>>,
}

/// Timer or timeout without an end.
const NEVER: i64 = i64::MAX;

fn nanos(time: Option<Duration>, absent: i64) -> i64 {
    time.map_or(absent, |time| i64::try_from(time.as_nanos()).unwrap_or(NEVER))
}

impl<'a> State<'a> {
    /// State before the first reaction.
    pub fn new(code: &Code<'a>, machines: &'a Machines, library: &'a dyn Library) -> Result<Self, String> {
        let (graph, wiring, lower) = (code.graph(), &code.program.wiring, code.program.lower);
        let (mut nodes, mut running) = (BTreeMap::new(), BTreeMap::new());
        let (mut held, mut held_activity) = (BTreeMap::new(), BTreeMap::new());
        for (node, n) in graph.nodes.iter_enumerated() {
            match &n.kind {
                NodeKind::Library(made) => match machines.get(&made.signature) {
                    Some(machine) => drop(running.insert(node, Running::new(machine, library)?)),
                    None => {
                        let signature = &lower.catalog.signatures[made.signature];
                        let boxed = library.make(code.numbers.own[node], signature, made);
                        nodes.insert(node, boxed.ok_or_else(|| format!("`{}` is not known", signature.name))?);
                    }
                },
                NodeKind::Delay(initial) => {
                    let ty = &graph.port(PortId { node, port: 1 }).ty;
                    let first = |value: &Option<_>| {
                        let token = library.token(value.as_ref(), ty);
                        token.map(Some).ok_or_else(|| format!("the first token of `{}` is not known", graph.path(node)))
                    };
                    held.insert(node, Delay::new(initial.iter().map(first).collect::<Result<_, _>>()?));
                    held_activity.insert(node, Delay::new(vec![None; initial.len()]));
                }
                _ => {}
            }
        }
        let given = graph.connections.iter_enumerated().filter_map(|(id, c)| Some((id, c.to, c.given.as_ref()?)));
        let given = given.map(|(id, to, given)| {
            let token = library.token(Some(&given.value), &graph.port(to).ty);
            Ok((id, token.ok_or_else(|| format!("the value in `{}` is not known", graph.connection_text(id)))?))
        });
        let timers = wiring.timers.iter().map(|(node, _)| {
            let modifiers = &graph.nodes[*node].modifiers;
            Timer::new(nanos(modifiers.after, 0), nanos(modifiers.every, NEVER))
        });
        let enabled = graph.nodes.ids().filter(|node| graph.nodes[*node].can_be_disabled()).map(Flag::Enabled);
        let bodies = code.bodies.iter().map(|(node, body)| Ok((*node, Self::new(body, machines, library)?)));
        Ok(Self {
            nodes,
            machines: running,
            tokens: BTreeMap::new(),
            given: given.collect::<Result<_, String>>()?,
            held,
            held_activity,
            flags: enabled.collect(),
            remembered: BTreeMap::new(),
            conditions: Conditions::new(wiring.bits.count(), &wiring.bits.initial()),
            queue: VecDeque::new(),
            timers: timers.collect(),
            timeouts: vec![Timeout::new(); wiring.timeouts.len()],
            silences: vec![Timeout::new(); wiring.silences.len()],
            stamps: vec![Time::ZERO; lower.analysis.stamps.connections.len()],
            cluster_stamps: BTreeMap::new(),
            time: ProgramTime::new(),
            told_ahead: BTreeMap::new(),
            holding: BTreeSet::new(),
            broken: BTreeSet::new(),
            steps: u32::MAX,
            started: false,
            exit: None,
            inputs: BTreeMap::new(),
            probes: BTreeMap::new(),
            outputs: BTreeMap::new(),
            events: BTreeMap::new(),
            bodies: bodies.collect::<Result<_, String>>()?,
        })
    }

    /// Returns `true` if a place has activity.
    pub fn has(&self, spot: Spot) -> bool {
        match spot {
            Spot::Flag(flag) => self.flags.contains(&flag),
            Spot::Held(delay) => self.held_activity.get(&delay).is_some_and(Delay::holds_any),
        }
    }

    /// Puts a token into an input or slot of the program. Returns `false` if one waits there.
    pub fn put(&mut self, port: NodeId, token: Value) -> bool {
        if self.inputs.contains_key(&port) {
            return false;
        }
        let arrival = self.inputs.values().map(|(arrival, _)| arrival + 1).max().unwrap_or(0);
        self.inputs.insert(port, (arrival, token));
        true
    }

    /// Clears a flag. Returns `true` if it was set.
    pub fn take(&mut self, flag: Flag) -> bool {
        self.flags.remove(&flag)
    }

    /// Triggers an event without a value.
    pub fn trigger(&mut self, event: PortId) {
        self.tokens.insert(event, Rc::new(()));
    }

    /// Sets or clears a flag.
    pub fn set(&mut self, flag: Flag, value: bool) {
        if value {
            self.flags.insert(flag)
        } else {
            self.flags.remove(&flag)
        };
    }
}
