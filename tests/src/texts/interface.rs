//! Nodes and graphs as seen by a source file.

use super::{types::Type, values::Param};

/// A node type as seen by a source file.
#[derive(Debug, Clone)]
pub struct Node {
    /// Name in the source file.
    pub name: String,
    /// Type arguments that are allowed.
    pub generic: Option<String>,
    /// Inputs that must be connected.
    pub inputs: Vec<Port>,
    /// Outputs.
    pub outputs: Vec<Port>,
    /// Slots.
    pub slots: Vec<Port>,
    /// Events.
    pub events: Vec<Port>,
    /// Parameters.
    pub params: Vec<(String, &'static Param)>,
}

/// A graph as seen from outside.
#[derive(Debug, Clone)]
pub struct Interface {
    /// The graph as a node type.
    pub node: Node,
    /// Nodes.
    pub named: Vec<(String, Node)>,
    /// Nodes that can be active.
    pub active: Vec<String>,
}

/// A port with its type.
#[derive(Debug, Clone)]
pub struct Port {
    /// Name.
    pub name: String,
    /// Type of the tokens.
    pub ty: &'static Type,
}

/// A port with this name and type.
pub fn port(name: &str, ty: &'static Type) -> Port {
    Port { name: name.trim_start_matches("r#").to_owned(), ty }
}

impl Node {
    /// `true` if its first input or slot takes this type.
    pub fn takes(&self, ty: &Type) -> bool {
        self.inputs.iter().chain(&self.slots).next().is_some_and(|p| p.ty == ty)
    }
}
