//! The declarations of a source file as a tree.

use super::View;
use apex_dsl::{
    source::Span,
    syntax::tree::{FsmItem, GraphItem, Ident, NodeBody, StateItem},
};

/// A declaration.
pub struct Symbol {
    /// Declared name.
    pub name: String,
    /// Detail shown behind the name.
    pub detail: String,
    /// Kind of the declaration.
    pub kind: SymbolKind,
    /// The name in the source file.
    pub name_span: Span,
    /// The whole declaration.
    pub extent: Span,
    /// Declarations inside.
    pub children: Vec<Symbol>,
}

/// Kind of a declaration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SymbolKind {
    /// A graph or robot.
    Graph,
    /// A state machine.
    Machine,
    /// A state.
    State,
    /// A test.
    Test,
    /// A parameter.
    Param,
    /// An input, output, slot or event.
    Port,
    /// A node with a name.
    Node,
}

/// The declarations of the first source file, in order.
pub fn outline(view: &View<'_>) -> Vec<Symbol> {
    let tree = &view.texts.files[0].1;
    let graphs = tree.graphs.iter().map(|g| graph(view, g));
    let machines = tree.machines.iter().map(|m| machine(view, m));
    let tests = tree
        .tests
        .iter()
        .map(|t| Symbol { extent: t.extent, ..symbol(&t.name, t.graph.text(), SymbolKind::Test, t.extent) });
    let mut symbols: Vec<Symbol> = graphs.chain(machines).chain(tests).collect();
    symbols.sort_by_key(|s| s.extent);
    symbols
}

fn symbol(name: &Ident, detail: impl Into<String>, kind: SymbolKind, end: Span) -> Symbol {
    let (name, name_span) = (name.text.clone(), name.span);
    Symbol { name, detail: detail.into(), kind, name_span, extent: name_span.to(end), children: vec![] }
}

fn graph(view: &View<'_>, item: &GraphItem) -> Symbol {
    let text = |span: Span| view.sources.text(span).to_owned();
    let params = item.params.iter().map(|p| symbol(&p.name, text(p.ty.span), SymbolKind::Param, p.ty.span));
    let ports = item.ports.iter().map(|p| {
        let (ty, end) = p.ty.as_ref().map_or((String::new(), p.name.span), |ty| (text(ty.span), ty.span));
        symbol(&p.name, format!("{} {ty}", p.kind.word()).trim_end(), SymbolKind::Port, end)
    });
    let nodes = item.nodes.iter().map(|n| match &n.body {
        NodeBody::Instance(instance) => symbol(&n.name, instance.path.text(), SymbolKind::Node, instance.span),
        NodeBody::HandedIn(ty, _) => symbol(&n.name, text(ty.span), SymbolKind::Node, ty.span),
    });
    let children = params.chain(ports).chain(nodes).collect();
    Symbol { children, extent: item.extent, ..symbol(&item.name, item.word(), SymbolKind::Graph, item.extent) }
}

fn machine(view: &View<'_>, item: &FsmItem) -> Symbol {
    let ports = item.ports.iter().map(|p| {
        let (ty, end) = p.ty.as_ref().map_or(("", p.name.span), |ty| (view.sources.text(ty.span), ty.span));
        symbol(&p.name, format!("{} {ty}", p.kind.word()).trim_end(), SymbolKind::Port, end)
    });
    let children = ports.chain(item.states.iter().map(state)).collect();
    Symbol { children, extent: item.extent, ..symbol(&item.name, "fsm", SymbolKind::Machine, item.extent) }
}

fn state(item: &StateItem) -> Symbol {
    let children = item.states.iter().map(state).collect();
    Symbol { children, extent: item.extent, ..symbol(&item.name, "", SymbolKind::State, item.extent) }
}
