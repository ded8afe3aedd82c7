//! The Petri net of a graph: what the graph may do, whatever the compiler makes of it.
//!
//! It is built from the checked graph alone and knows nothing of analysis and code generation, so that it can judge
//! them: [`Replay`] says whether what a compiled program did is something that the net may do, too.
//!
//! Each node takes its tokens in one transition and sends in another; a lock keeps its slots out in between. A connection has
//! a place for its token and one that says that it is free. It becomes free again by a notification, which travels
//! against the tokens as soon as everything behind it has finished; a slot notifies at once. A nested graph stands between its surroundings
//! and its inside like a node of its own at each side.

mod build;
mod early;
mod patience;
mod pnml;
mod replay;
mod route;
mod state;

use crate::graph::{self, Crossing, End, Graph, NodeId};
use std::fmt;

pub use build::net;
pub use pnml::pnml;
pub use replay::{Replay, Wrong};
pub use state::{Call, Origin, Preview, Script, State, Token, unsupported};

/// A place, by number in [`Net::places`].
pub type PlaceId = usize;
/// A transition, by number in [`Net::transitions`].
pub type TransitionId = usize;

/// A Petri net. All arcs have weight one.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Net {
    /// The graph that it belongs to.
    pub name: String,
    /// Places.
    pub places: Vec<Place>,
    /// Transitions.
    pub transitions: Vec<Transition>,
}

/// A place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// Tokens in the beginning.
    pub initial: usize,
}

/// A transition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transition {
    /// Its name.
    pub name: String,
    /// What it stands for.
    pub meaning: Meaning,
    /// Places that it takes a token from.
    pub takes: Vec<PlaceId>,
    /// Places that it gives a token to.
    pub gives: Vec<PlaceId>,
}

/// What a transition stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Meaning {
    /// A node takes one token from each input.
    Take(NodeId),
    /// It sends one token to each output.
    Send(NodeId),
    /// Everything behind a node has finished: it may fire again, and what feeds it is told.
    Notify(NodeId),
    /// A port that sends only values sends one, or an event is triggered.
    Trigger(End),
    /// It does not.
    Hush(End),
    /// The slot at the end of this connection takes the token on it.
    Handle(usize),
    /// The slots of a node have nothing to do any more.
    Handled(NodeId),
    /// All tokens at a side of a nested graph pass it together.
    Pass(Crossing),
    /// Everything behind a side of a nested graph has finished.
    NotifySide(Crossing),
    /// The delays on a loop, this one being the first, send the tokens that they have held longest.
    Release(NodeId),
    /// A delay inside a loop takes a token.
    Hold(NodeId),
    /// What delays sent for the token on a leg into their loop has finished, too.
    Return(usize),
    /// The activity of the program begins.
    Start(NodeId),
}

/// Why a graph has no net.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoNet(pub String);

impl fmt::Display for NoNet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Net {
    /// The transition that stands for `meaning`.
    pub fn find(&self, meaning: Meaning) -> Option<TransitionId> {
        self.transitions.iter().position(|t| t.meaning == meaning)
    }
}

/// A connection as a person would write it.
fn connection_name(graph: &Graph, connection: usize) -> String {
    let c = &graph.connections[connection];
    format!("{} -> {}", graph.end_name(c.from), graph.end_name(c.to))
}

fn side_name(graph: &Graph, side: Crossing) -> String {
    let (scope, word) = match side {
        Crossing::Enter(scope) => (scope, "in"),
        Crossing::Leave(scope) => (scope, "out"),
    };
    graph::path(&graph.scopes, scope, Some(word))
}
