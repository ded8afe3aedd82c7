//! Predefined names (`start`, `reset`, …), and the ports that every node and nested graph has.

use super::{
    builder::{Body, Builder},
    table::{Candidate, Owner},
};
use crate::{
    catalog::Type,
    graph::{Node, NodeId, NodeKind, Pin, Port, PortId, ScopeId, Standard, Subject, Wire, WireEnd},
    source::Span,
    syntax::tree::{Ident, PortKind},
};

/// The meaning of a predefined name. Every graph has these names, unless a node of it has the same name.
pub fn own_node(name: &str) -> Option<NodeKind> {
    match name {
        "start" => Some(NodeKind::Start),
        "hung" => Some(NodeKind::Watchdog),
        "set_back" => Some(NodeKind::SetBack),
        "reset" => Some(NodeKind::Reset),
        "exit" => Some(NodeKind::Exit(0)),
        "abort" => Some(NodeKind::Exit(1)),
        _ => None,
    }
}

/// Returns `true` if a predefined name is that of an event.
pub fn is_own_event(name: &str) -> bool {
    own_node(name).is_some_and(|kind| sends(&kind))
}

fn own(kind: &NodeKind) -> bool {
    sends(kind) || matches!(kind, NodeKind::Reset | NodeKind::Exit(_))
}

/// Returns `true` if the predefined node is an event.
fn sends(kind: &NodeKind) -> bool {
    matches!(kind, NodeKind::Start | NodeKind::Watchdog | NodeKind::SetBack)
}

impl Builder<'_> {
    /// The node of a predefined name. Each graph that uses the name has one.
    pub fn own_node(&mut self, body: &Body<'_>, name: &Ident, kind: NodeKind) -> Option<NodeId> {
        let made = self.nodes.position(|n| n.scope == body.scope && n.name == name.text && own(&n.kind));
        match made {
            Some(node) => Some(node),
            None => {
                let side = if sends(&kind) { PortKind::Event } else { PortKind::Slot };
                let ty = if side == PortKind::Event { Type::unit() } else { Type::Unknown("any type".to_owned()) };
                self.node(name, body.scope, kind, vec![Port::new(&name.text, side, ty)], "")
            }
        }
    }

    /// A port that every node has. It is added to the node when it is first used.
    pub fn standard_port(&mut self, owner: Owner, port: &Ident) -> Option<Candidate> {
        let standard = Standard::ALL.into_iter().find(|s| s.name() == port.text && self.has_standard(owner, *s))?;
        let place = match owner {
            Owner::Node(node) => match standard.of_interrupt() {
                Some(number) => WireEnd::Port(PortId { node: self.interrupt_of_node(node, port.span)?, port: number }),
                None => WireEnd::Port(self.standard_end(node, standard)?),
            },
            Owner::Scope(scope) => self.shared_port(scope, standard, port.span),
        };
        let (name, kind, ty) = (port.text.clone(), standard.kind(), standard.ty());
        Some(Candidate { name, kind, ty, place, parameter: false })
    }

    /// Returns `true` if a node or nested graph has this port.
    pub fn has_standard(&self, owner: Owner, standard: Standard) -> bool {
        match owner {
            Owner::Node(node) => matches!(self.nodes[node].kind, NodeKind::Library(_)),
            Owner::Scope(_) => standard.is_shared(),
        }
    }

    fn standard_end(&mut self, node: NodeId, standard: Standard) -> Option<PortId> {
        if !matches!(self.nodes[node].kind, NodeKind::Library(_)) {
            return None;
        }
        let port = self.nodes[node].standard(standard).unwrap_or_else(|| {
            let made = Port::new(standard.name(), standard.kind(), standard.ty());
            self.nodes[node].ports.push(Port { standard: Some(standard), ..made });
            self.nodes[node].ports.len() - 1
        });
        Some(PortId { node, port })
    }

    /// A port of a nested graph that stands for the ports with this name of all nodes in it.
    fn shared_port(&mut self, scope: ScopeId, standard: Standard, span: Span) -> WireEnd {
        let (name, kind) = (standard.name(), standard.kind());
        let is_it = |p: &Pin| p.scope == scope && p.name == name && p.kind == kind && p.standard;
        if let Some(pin) = self.pins.iter().position(is_it) {
            return WireEnd::Pin(pin);
        }
        let docs = String::new();
        let ty = Type::Unknown(String::new());
        self.pins.push(Pin { name: name.to_owned(), kind, ty, frame: None, scope, span, docs, standard: true });
        let place = WireEnd::Pin(self.pins.len() - 1);
        let interrupt = standard.of_interrupt();
        let inner: Vec<WireEnd> = match interrupt {
            Some(port) => {
                let made = self.interrupt(Subject::Scope(scope), "cancel", scope, span);
                made.into_iter().map(|node| WireEnd::Port(PortId { node, port })).collect()
            }
            None => self.shared_inside(scope, standard, span),
        };
        for inner in inner {
            let (from, to) = if kind == PortKind::Slot { (place, inner) } else { (inner, place) };
            // A node that fails may pass its activity on, as may `cancel`; one that is enabled or disabled has no use
            // for any.
            let active = kind == PortKind::Event || interrupt.is_some();
            self.wires.push(Wire { from, to, active, differs: false, given: None, span });
        }
        place
    }

    /// The ports of the nodes and nested graphs in a nested graph for which a port of it stands.
    fn shared_inside(&mut self, scope: ScopeId, standard: Standard, span: Span) -> Vec<WireEnd> {
        let nodes: Vec<NodeId> = self.nodes.ids().filter(|n| self.nodes[*n].scope == scope).collect();
        let nested: Vec<ScopeId> = self.scopes.ids().skip(1).filter(|s| self.scopes[*s].parent == scope).collect();
        let mut inner: Vec<WireEnd> =
            nodes.into_iter().filter_map(|n| Some(WireEnd::Port(self.standard_end(n, standard)?))).collect();
        inner.extend(nested.into_iter().map(|s| self.shared_port(s, standard, span)));
        inner
    }

    /// The node that takes the activity of a node away.
    fn interrupt_of_node(&mut self, node: NodeId, span: Span) -> Option<NodeId> {
        let Node { kind: NodeKind::Library(_), scope, ref name, ref modifiers, .. } = self.nodes[node] else {
            return None;
        };
        let (name, group) = (format!("{name}.cancel"), modifiers.group.clone());
        let made = self.interrupt(Subject::Node(node), &name, scope, span)?;
        self.nodes[made].modifiers.group = group;
        Some(made)
    }

    /// The node that takes the activity of `subject` away. It is made when one of its ports is first used.
    fn interrupt(&mut self, subject: Subject, name: &str, scope: ScopeId, span: Span) -> Option<NodeId> {
        let made = self.nodes.position(|node| node.interrupts() == Some(subject));
        made.or_else(|| {
            let port = |standard: Standard| Port::new(standard.name(), standard.kind(), standard.ty());
            let ports = Standard::OF_INTERRUPT.map(port).to_vec();
            self.node(&Ident { text: name.to_owned(), span }, scope, NodeKind::Interrupt(subject), ports, "")
        })
    }
}
