//! The Petri net of a graph: everything that the graph may do, independently of the decisions of the compiler.
//!
//! The net is built from the checked graph alone, without analysis and code generation, so that it can judge them:
//! [`Replay`] decides if the net permits what a compiled program did.
//!
//! Each node takes its tokens in one transition and sends in another; a lock excludes its slots in between. A
//! connection has a place for its token and one that is marked while it is free. A notification frees the connection:
//! notifications travel against the tokens as soon as everything downstream has finished. A slot notifies at once. Each
//! boundary of a nested graph behaves like a node between the surroundings and the inside.

mod build;
mod bypass;
mod clocks;
mod demand_driven;
mod expected;
mod lent;
mod pnml;
mod replay;
mod route;
mod state;
mod token;

use apex_dsl::{
    graph::{self, ConnectionId, Crossing, Graph, NodeId, PortId},
    index::{IdVec, id},
};
use std::fmt;

pub use build::net;
pub use pnml::pnml;
pub use replay::{Replay, Wrong, undecided};
pub use route::Side;
pub use state::{Call, Preview, Script, State, unsupported};
pub use token::{Origin, Token};

id! {
    /// Number of a place in [`Net::places`].
    PlaceId
}

id! {
    /// Number of a transition in [`Net::transitions`].
    TransitionId
}

/// A Petri net. All arcs have weight one.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Net {
    /// Name of the graph.
    pub name: String,
    /// Places.
    pub places: IdVec<PlaceId, Place>,
    /// Transitions.
    pub transitions: IdVec<TransitionId, Transition>,
}

/// A place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Name of the place.
    pub name: String,
    /// Initial number of tokens.
    pub initial: usize,
}

/// A transition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transition {
    /// Name of the transition.
    pub name: String,
    /// Meaning of the transition.
    pub kind: TransitionKind,
    /// Places from which it takes a token.
    pub takes: Vec<PlaceId>,
    /// Places to which it gives a token.
    pub gives: Vec<PlaceId>,
}

/// Meaning of a transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TransitionKind {
    /// A node takes one token from each input.
    Take(NodeId),
    /// A node sends one token on each synchronous connection.
    Send(NodeId),
    /// Everything downstream of a node has finished: the node may fire again, and its inputs are free.
    Notify(NodeId),
    /// A port that sends only values sends one, or an event is triggered.
    Trigger(PortId),
    /// A port that sends only values sends none, or an event is not triggered.
    Suppress(PortId),
    /// The slot at the end of this connection takes the token on it.
    Handle(ConnectionId),
    /// The slots of a node have finished.
    Handled(NodeId),
    /// All tokens at a boundary of a nested graph cross it together.
    Pass(Side),
    /// Everything downstream of a boundary of a nested graph has finished.
    NotifySide(Side),
    /// All delays of a loop, of which this node is the first, or a delay on no loop, send their oldest tokens.
    Release(NodeId),
    /// A delay takes a token.
    Hold(NodeId),
    /// Everything that the delays of a loop sent for the token on this leg into the loop has finished.
    Return(usize),
    /// `start` begins the activity of the program.
    Start(NodeId),
    /// The time of a node's `timeout` is over: its event is triggered, with the activity of the node.
    TimeOut(NodeId),
}

/// Reason why a graph has no net.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoNet(pub String);

impl fmt::Display for NoNet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Net {
    /// The transition with this meaning.
    pub fn find(&self, kind: TransitionKind) -> Option<TransitionId> {
        self.transitions.position(|t| t.kind == kind)
    }

    /// The place where a delay holds tokens: the last one that the transition gives to with which it takes them.
    fn held(&self, hold: TransitionId) -> Option<PlaceId> {
        self.transitions[hold].gives.last().copied()
    }
}

/// The place of the token of a leg: a net begins with two places for each leg.
fn token_on(segment: usize) -> PlaceId {
    PlaceId::from(2 * segment)
}

/// The place that is marked while a leg is free.
fn free_for(segment: usize) -> PlaceId {
    PlaceId::from(2 * segment + 1)
}

/// A connection as written in a source file.
fn connection_name(graph: &Graph, connection: ConnectionId) -> String {
    let c = &graph.connections[connection];
    format!("{} -> {}", graph.end_name(c.from), graph.end_name(c.to))
}

fn side_name(graph: &Graph, side: Side) -> String {
    let (scope, word) = match (side.crossing, side.is_first) {
        (Crossing::Enter(scope), _) => (scope, "in"),
        (Crossing::Leave(scope), false) => (scope, "out"),
        (Crossing::Leave(scope), true) => (scope, "out, first"),
    };
    graph::path(&graph.scopes, scope, Some(word))
}
