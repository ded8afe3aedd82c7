//! Knowledge of the other programs: endpoints by the discovery of DDS, and the nodes that have them.

use crate::{
    name,
    nodes::{self, Node},
    qos::qos,
};
use apex_ros::{Endpoint, Graph, NO_HASH, Token};
use rustdds::{DomainParticipantStatusEvent as Event, EndpointDescription, GUID};
use std::{
    collections::{HashMap, HashSet},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

/// Name of a node that has not told its own.
const UNNAMED: &str = "unnamed";
/// Most endpoints that are kept: a network that makes up more of them cannot use up the memory.
const MOST: usize = 100_000;

/// Knowledge that the threads of a carrier share.
#[derive(Clone)]
pub struct Known(Arc<Shared>);

struct Shared {
    domain: u32,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    endpoints: HashMap<GUID, Endpoint>,
    /// Namespace and name of the node of an endpoint.
    nodes: HashMap<GUID, (String, String)>,
    /// Endpoints of the nodes of each program.
    programs: HashMap<GUID, Vec<GUID>>,
    /// Endpoints of others that exchange messages with an endpoint of this program.
    matched: HashMap<GUID, HashSet<GUID>>,
    graph: Option<Graph>,
}

impl Known {
    pub fn new(domain: u32) -> Self {
        Self(Arc::new(Shared { domain, state: Mutex::default(), changed: Condvar::new() }))
    }

    /// Keeps this graph up to date from now on.
    pub fn tell(&self, graph: Graph) {
        let mut state = self.state();
        let all: Vec<GUID> = state.endpoints.keys().copied().collect();
        state.graph = Some(graph);
        all.into_iter().for_each(|id| self.show(&state, id));
    }

    /// Takes note of an event of the discovery.
    pub fn note(&self, event: Event) {
        match event {
            Event::ReaderDetected { reader } => self.add(&reader, false),
            Event::WriterDetected { writer } => self.add(&writer, true),
            Event::ReaderLost { guid, .. } | Event::WriterLost { guid, .. } => self.remove(|id| id == guid),
            Event::ParticipantLost { id, .. } => self.remove(|endpoint| endpoint.prefix == id),
            Event::RemoteReaderMatched { local_writer: ours, remote_reader: theirs }
            | Event::RemoteWriterMatched { local_reader: ours, remote_writer: theirs } => {
                self.state().matched.entry(ours).or_default().insert(theirs);
                self.0.changed.notify_all();
            }
            _ => {}
        }
    }

    /// Takes note of the nodes of a program.
    pub fn name(&self, program: GUID, nodes: Vec<Node>) {
        let mut state = self.state();
        for id in state.programs.remove(&program).unwrap_or_default() {
            state.nodes.remove(&id);
        }
        let mut ids = vec![];
        for Node { namespace, name, readers, writers } in nodes {
            for id in readers.into_iter().chain(writers) {
                state.nodes.insert(id, (namespace.clone(), name.clone()));
                ids.push(id);
            }
        }
        ids.iter().for_each(|id| self.show(&state, *id));
        if !ids.is_empty() && state.programs.len() < MOST {
            state.programs.insert(program, ids);
        }
    }

    /// Waits until both endpoints of a client exchange messages with a server. Returns `false` if there is none, or it
    /// does not do so in time. RustDDS does not carry requests within a program.
    pub fn is_served(&self, server: &Endpoint, writer: GUID, reader: GUID, patience: Duration) -> bool {
        let start = Instant::now();
        let mut state = self.state();
        loop {
            let meets = |id: &GUID| state.matched.get(id).is_some_and(|others| !others.is_empty());
            if meets(&writer) && meets(&reader) {
                return true;
            }
            let left = patience.saturating_sub(start.elapsed());
            if left.is_zero() || !state.endpoints.values().any(|it| is_same(it, server)) {
                return false;
            }
            state = self.0.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn add(&self, found: &EndpointDescription, is_writer: bool) {
        let Some((kind, name, wire_type)) = name::endpoint(&found.topic_name, &found.type_name, is_writer) else {
            return;
        };
        let endpoint = Endpoint { kind, name, wire_type, hash: NO_HASH.to_owned(), qos: qos(&found.qos, is_writer) };
        let mut state = self.state();
        if state.endpoints.len() < MOST {
            state.endpoints.insert(found.guid, endpoint);
            self.show(&state, found.guid);
        }
    }

    fn remove(&self, is_gone: impl Fn(GUID) -> bool) {
        let mut state = self.state();
        let gone: Vec<GUID> = state.endpoints.keys().copied().filter(|id| is_gone(*id)).collect();
        for id in gone {
            state.endpoints.remove(&id);
            state.nodes.remove(&id);
            state.graph.iter().for_each(|graph| graph.remove(&key(id)));
        }
        state.matched.values_mut().for_each(|others| others.retain(|id| !is_gone(*id)));
    }

    /// Puts an endpoint into the graph, under the name of its node.
    fn show(&self, state: &State, id: GUID) {
        let (Some(graph), Some(endpoint)) = (&state.graph, state.endpoints.get(&id)) else { return };
        let unnamed = || ("/".to_owned(), UNNAMED.to_owned());
        let (namespace, node) = state.nodes.get(&id).cloned().unwrap_or_else(unnamed);
        let token = Token {
            domain: self.0.domain,
            session: session(id),
            node_id: 0,
            id: 0,
            enclave: String::new(),
            namespace,
            node,
            endpoint: Some(endpoint.clone()),
        };
        graph.add(&key(id), token);
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns `true` if two endpoints have the same kind, name and type.
fn is_same(a: &Endpoint, b: &Endpoint) -> bool {
    (a.kind, &a.name, &a.wire_type) == (b.kind, &b.name, &b.wire_type)
}

/// Identification of the program of an endpoint: the first twelve bytes.
pub fn session(id: GUID) -> String {
    id.to_bytes()[..12].iter().map(|byte| format!("{byte:02x}")).collect()
}

fn key(id: GUID) -> String {
    id.to_bytes().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The nodes of this program, which are told to the others with each change.
pub struct Ours {
    pub node: Node,
    pub program: GUID,
    /// Number of bytes of an identification.
    pub length: usize,
}

impl Ours {
    /// The message that tells them.
    pub fn message(&self) -> Vec<u8> {
        let is_named = !self.node.name.is_empty();
        nodes::write(self.program, if is_named { std::slice::from_ref(&self.node) } else { &[] }, self.length)
    }
}
