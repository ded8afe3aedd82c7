//! Numbers of the parts of a graph.

use crate::index::id;

id! {
    /// Number of a node in [`Graph::nodes`](super::Graph::nodes).
    NodeId
}

id! {
    /// Number of a connection in [`Graph::connections`](super::Graph::connections).
    ConnectionId
}

id! {
    /// Number of a scope in [`Graph::scopes`](super::Graph::scopes).
    ScopeId
}

impl ScopeId {
    /// The graph itself.
    pub const TOP: Self = Self(0);
}
