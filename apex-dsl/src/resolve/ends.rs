//! Ends of connections as written.

use super::table::{Candidate, Symbol};
use crate::{graph::Given, report::Diagnostic, source::Span, syntax::tree::Ident};

/// An end of a connection: one port of `symbol`.
#[derive(Debug, Clone)]
pub struct End {
    /// The meaning of its name, narrowed to a port if one is named.
    pub symbol: Symbol,
    /// The name as text: `node`, `node.port` or a port of the graph.
    pub text: String,
    /// The place of the name.
    pub span: Span,
    /// The value that is given to the port.
    pub given: Option<Box<Given>>,
}

/// A port that is chosen for an end of a connection.
#[derive(Debug, Clone, Copy)]
pub struct Chosen<'a> {
    /// The end as text.
    pub text: &'a str,
    /// The place of the end.
    pub span: Span,
    /// The port.
    pub port: &'a Candidate,
}

impl End {
    /// A port of this end.
    pub fn chosen<'a>(&'a self, port: &'a Candidate) -> Chosen<'a> {
        Chosen { text: &self.text, span: self.span, port }
    }

    /// Name of the node, or of the port of the graph.
    pub fn node(&self) -> &str {
        self.text.split('.').next().unwrap_or(&self.text)
    }
}

/// The error at `span`, where a port of a port is named.
pub fn without_ports(port: &Ident, span: Span) -> Diagnostic {
    let message = format!("`{}` is a port of this graph and has no ports of its own", port.text);
    Diagnostic::error("unknown-port", span, message)
}

/// The ports for which `.*` stands.
#[derive(Debug, Clone)]
pub struct All {
    /// Node or nested graph with the ports; `None` for the graph itself, whose ports are named alone.
    pub node: Option<String>,
    /// The endpoint as text.
    pub text: String,
    /// The place of the endpoint.
    pub span: Span,
    /// The ports, except parameters.
    pub ports: Vec<Candidate>,
}

impl All {
    /// The ports that send tokens.
    pub fn sends(&self) -> impl Iterator<Item = &Candidate> {
        self.ports.iter().filter(|port| port.kind.sends())
    }

    /// The ports that take tokens.
    pub fn takes(&self) -> impl Iterator<Item = &Candidate> {
        self.ports.iter().filter(|port| !port.kind.sends())
    }

    /// Number of ports.
    pub fn count(&self) -> usize {
        self.ports.len()
    }

    /// One of the ports as a graph names it.
    pub fn name(&self, port: &Candidate) -> String {
        match &self.node {
            Some(node) => format!("{node}.{}", port.name),
            None => port.name.clone(),
        }
    }
}
