//! The syntax tree: the contents of a source file with positions, before names are resolved.

mod expr;
mod machine;
mod script;

use crate::source::Span;

pub use expr::{Expr, ExprKind, TypeExpr, TypeKind};
pub use machine::{Action, Cause, FsmItem, Return, StateItem, Transition};
pub use script::{Condition, GoalItem, Limit, StudyItem, TestItem, TestStep};

/// An identifier with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ident {
    /// The identifier.
    pub text: String,
    /// Place in the source file.
    pub span: Span,
}

/// A source file.
#[derive(Debug, Default)]
pub struct File {
    /// `//!` lines.
    pub docs: String,
    /// Imports.
    pub uses: Vec<Use>,
    /// Offset at which an import can be added: before the first item.
    pub imports_at: Option<usize>,
    /// Graphs and robots.
    pub graphs: Vec<GraphItem>,
    /// State machines.
    pub machines: Vec<FsmItem>,
    /// Tests.
    pub tests: Vec<TestItem>,
    /// Comments that are not documentation, for the formatter.
    pub comments: Vec<Span>,
    /// `true` if some part could not be parsed.
    pub broken: bool,
    /// `true` if a whole item could not be parsed, so that names of graphs and imports may be missing.
    pub broken_items: bool,
}

/// One imported name: groups are flattened.
#[derive(Debug)]
pub struct Use {
    /// The segments of the path.
    pub path: Vec<Ident>,
    /// Name in this file.
    pub name: Ident,
}

/// `graph` or `robot`.
#[derive(Debug, Clone)]
pub struct GraphItem {
    /// `///` lines.
    pub docs: String,
    /// `true` for a `robot`.
    pub robot: bool,
    /// `true` for `pub`: the graph is a program even if another graph contains it.
    pub is_public: bool,
    /// Name of the graph.
    pub name: Ident,
    /// Type parameters.
    pub generics: Vec<Ident>,
    /// Parameters.
    pub params: Vec<ParamItem>,
    /// The graph that this one is a variant of.
    pub base: Option<PathExpr>,
    /// Ports.
    pub ports: Vec<PortItem>,
    /// Nodes with a name.
    pub nodes: Vec<NodeItem>,
    /// Connections.
    pub chains: Vec<Chain>,
    /// Claims.
    pub claims: Vec<Claim>,
    /// Settings of threads.
    pub threads: Vec<ThreadItem>,
    /// `record` statements. A correct program has at most one.
    pub records: Vec<RecordItem>,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// A parameter of a graph.
#[derive(Debug, Clone)]
pub struct ParamItem {
    /// `///` lines.
    pub docs: String,
    /// Name of the parameter.
    pub name: Ident,
    /// Type of the parameter.
    pub ty: TypeExpr,
    /// The unit in brackets behind the type.
    pub unit: Option<Ident>,
    /// Default value.
    pub default: Option<Expr>,
    /// Legal values.
    pub range: Option<RangeExpr>,
}

/// `low..high` or `low..=high`.
#[derive(Debug, Clone)]
pub struct RangeExpr {
    /// Smallest value.
    pub low: Expr,
    /// Largest value.
    pub high: Expr,
    /// `true` if `high` is included.
    pub inclusive: bool,
}

/// Kind of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PortKind {
    /// Synchronous, takes tokens.
    Input,
    /// Synchronous, sends tokens.
    Output,
    /// Asynchronous, takes tokens.
    Slot,
    /// Asynchronous, sends tokens.
    Event,
}

impl PortKind {
    /// Returns `true` if tokens leave a node at this port.
    pub fn sends(self) -> bool {
        matches!(self, Self::Output | Self::Event)
    }

    /// Returns `true` if the port takes part in synchronous data flow.
    pub fn is_synchronous(self) -> bool {
        matches!(self, Self::Input | Self::Output)
    }

    /// The kind of a graph's port as seen from inside: a port that takes tokens outside sends them inside, and vice
    /// versa.
    pub fn seen_from_inside(self) -> Self {
        match self {
            Self::Input => Self::Output,
            Self::Output => Self::Input,
            Self::Slot => Self::Event,
            Self::Event => Self::Slot,
        }
    }

    /// Indefinite article of the word.
    pub fn article(self) -> &'static str {
        if self == Self::Slot { "a" } else { "an" }
    }

    /// Keyword of its declaration.
    pub fn keyword(self) -> &'static str {
        match self {
            Self::Input => "in",
            Self::Output => "out",
            Self::Slot => "slot",
            Self::Event => "event",
        }
    }

    /// Name of the kind.
    pub fn word(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Output => "output",
            Self::Slot => "slot",
            Self::Event => "event",
        }
    }
}

/// A port of a graph.
#[derive(Debug, Clone)]
pub struct PortItem {
    /// `///` lines.
    pub docs: String,
    /// `in`, `out`, `slot` or `event`.
    pub kind: PortKind,
    /// Name of the port.
    pub name: Ident,
    /// Type of the tokens; `()` if none is written.
    pub ty: Option<TypeExpr>,
    /// Frame of the tokens.
    pub frame: Option<Ident>,
}

/// `node name = …;`
#[derive(Debug, Clone)]
pub struct NodeItem {
    /// `///` lines.
    pub docs: String,
    /// Name of the node.
    pub name: Ident,
    /// Construction of the node.
    pub body: NodeBody,
}

/// Construction of a node.
#[derive(Debug, Clone)]
pub enum NodeBody {
    /// `= Type(…)`
    Instance(Instance),
    /// `: Type`: made in Rust and passed to the constructor.
    HandedIn(TypeExpr, Vec<Modifier>),
}

/// `Type<…>(name = value, …) modifiers`
#[derive(Debug, Clone)]
pub struct Instance {
    /// Node or graph.
    pub path: PathExpr,
    /// Type arguments.
    pub types: Vec<TypeExpr>,
    /// Arguments.
    pub args: Vec<Arg>,
    /// Modifiers.
    pub modifiers: Vec<Modifier>,
    /// The whole instance.
    pub span: Span,
}

/// `a::b::c`
#[derive(Debug, Clone)]
pub struct PathExpr {
    /// The segments.
    pub segments: Vec<Ident>,
    /// The whole path.
    pub span: Span,
}

impl PathExpr {
    /// The segments with `::` between them.
    pub fn text(&self) -> String {
        self.segments.iter().map(|s| s.text.as_str()).collect::<Vec<_>>().join("::")
    }
}

/// `name = value`
#[derive(Debug, Clone)]
pub struct Arg {
    /// The parameter; `None` is an error that is reported where the arguments are checked.
    pub name: Option<Ident>,
    /// The value.
    pub value: Expr,
}

/// A modifier of an instance.
#[derive(Debug, Clone)]
pub struct Modifier {
    /// Kind of the modifier.
    pub kind: ModifierKind,
    /// The whole modifier.
    pub span: Span,
}

/// Kind of a modifier.
#[derive(Debug, Clone)]
pub enum ModifierKind {
    /// `every 20ms`
    Every(Expr),
    /// `after 500ms`
    After(Expr),
    /// `timeout 5s`
    Timeout(Expr),
    /// `deadline 10ms`
    Deadline(Expr),
    /// `on GROUP`
    On(Ident),
    /// `each`, `each par`, `each(port)`
    Each {
        /// `true` if the elements run in parallel.
        parallel: bool,
        /// The input with the list, if it is written.
        port: Option<Ident>,
    },
    /// `delay`, `delay 0`, `delay [0, 0]`
    Delay(Option<Expr>),
    /// `pipelined`
    Pipelined,
    /// `skip`
    Skip,
    /// `essential`
    Essential,
    /// `restart`
    Restart,
}

impl Modifier {
    /// The thread group of `on`.
    pub fn group(&self) -> Option<String> {
        if let ModifierKind::On(group) = &self.kind { Some(group.text.clone()) } else { None }
    }
}

impl Instance {
    /// The parts of `port(value)`, which an instance is if its name is that of a port.
    pub fn as_given(&self) -> Option<(PortRef, &Expr)> {
        match (self.path.segments.as_slice(), self.args.as_slice()) {
            ([port], [Arg { name: None, value }]) if self.types.is_empty() && self.modifiers.is_empty() => {
                Some((PortRef { parts: vec![port.clone()], span: port.span }, value))
            }
            _ => None,
        }
    }
}

impl GraphItem {
    /// All ends of its connections. Lists are resolved into their elements.
    pub fn ends(&self) -> Vec<&Endpoint> {
        fn add<'a>(end: &'a Endpoint, found: &mut Vec<&'a Endpoint>) {
            match end {
                Endpoint::List(ends, _) => ends.iter().for_each(|end| add(end, found)),
                Endpoint::Port(..) | Endpoint::All(_) | Endpoint::Instance(_) => found.push(end),
            }
        }
        let mut found = vec![];
        self.chains.iter().flat_map(|chain| &chain.ends).for_each(|end| add(end, &mut found));
        found
    }

    /// All ports and nodes that its connections and claims refer to.
    pub fn references(&self) -> Vec<&PortRef> {
        let of_chains = self.ends().into_iter().filter_map(|end| match end {
            Endpoint::Port(reference, _) => Some(reference),
            _ => None,
        });
        of_chains.chain(self.claims.iter().flat_map(|claim| &claim.of)).collect()
    }

    /// The words with which it begins.
    pub fn word(&self) -> &'static str {
        match (self.robot, self.is_public) {
            (true, _) => "robot",
            (false, true) => "pub graph",
            (false, false) => "graph",
        }
    }

    /// The names of nodes and ports with which its ends and claims begin.
    pub fn names(&self) -> Vec<&Ident> {
        let before_all = self.ends().into_iter().filter_map(|end| match end {
            Endpoint::All(AllPorts { of: PortsOf::Node(name), .. }) => Some(name),
            _ => None,
        });
        self.references().into_iter().filter_map(|reference| reference.parts.first()).chain(before_all).collect()
    }

    /// The thread groups that its instances name.
    pub fn groups(&self) -> Vec<&Ident> {
        let of_nodes = self.nodes.iter().map(|node| match &node.body {
            NodeBody::Instance(instance) => &instance.modifiers,
            NodeBody::HandedIn(_, modifiers) => modifiers,
        });
        let in_place = self.ends().into_iter().filter_map(|end| match end {
            Endpoint::Instance(instance) => Some(&instance.modifiers),
            _ => None,
        });
        let named = of_nodes.chain(in_place).flatten().filter_map(|modifier| match &modifier.kind {
            ModifierKind::On(group) => Some(group),
            _ => None,
        });
        named.collect()
    }

    /// All instances in the graph.
    pub fn instances(&self) -> Vec<&Instance> {
        let of_nodes = self.nodes.iter().filter_map(|node| match &node.body {
            NodeBody::Instance(instance) => Some(instance),
            NodeBody::HandedIn(..) => None,
        });
        let in_place = self.ends().into_iter().filter_map(|end| match end {
            Endpoint::Instance(instance) => Some(&**instance),
            _ => None,
        });
        of_nodes.chain(in_place).collect()
    }
}

impl File {
    /// The extents of its graphs, machines and tests.
    pub fn extents(&self) -> impl Iterator<Item = Span> + '_ {
        let graphs = self.graphs.iter().map(|graph| graph.extent);
        let machines = self.machines.iter().map(|machine| machine.extent);
        graphs.chain(machines).chain(self.tests.iter().map(|test| test.extent))
    }

    /// Returns `true` if the file declares nothing.
    pub fn is_empty(&self) -> bool {
        self.graphs.is_empty() && self.machines.is_empty() && self.tests.is_empty()
    }
}

/// `a -> b => c;`
#[derive(Debug, Clone)]
pub struct Chain {
    /// The ends, in order.
    pub ends: Vec<Endpoint>,
    /// Arrows; arrow `i` is between ends `i` and `i + 1`.
    pub arrows: Vec<Arrow>,
}

impl Chain {
    /// From its first end to its last one.
    pub fn span(&self) -> Span {
        let (first, last) = (self.ends[0].span(), self.ends[self.ends.len() - 1].span());
        first.to(last)
    }
}

/// `->` or `=>`
#[derive(Debug, Clone, Copy)]
pub struct Arrow {
    /// `true` for `=>`, on which activity passes.
    pub active: bool,
    /// Place in the source file.
    pub span: Span,
}

/// One end of a connection.
#[derive(Debug, Clone)]
pub enum Endpoint {
    /// `node`, `node.port` or the name of a port of the graph; and the value in `node.port(value)`.
    Port(PortRef, Option<Box<Expr>>),
    /// `in.*`, `out.*`, `node.*`
    All(AllPorts),
    /// A node written in place.
    Instance(Box<Instance>),
    /// `[a, b]`
    List(Vec<Endpoint>, Span),
}

impl Endpoint {
    /// The whole endpoint.
    pub fn span(&self) -> Span {
        match self {
            Self::Port(reference, given) => {
                given.as_ref().map_or(reference.span, |value| reference.span.to(value.span))
            }
            Self::All(all) => all.span,
            Self::Instance(instance) => instance.span,
            Self::List(_, span) => *span,
        }
    }
}

/// `in.*`, `out.*`, `node.*`: each port, for a connection with the port of the same name at the other end.
#[derive(Debug, Clone)]
pub struct AllPorts {
    /// Owner of the ports.
    pub of: PortsOf,
    /// The whole endpoint.
    pub span: Span,
}

/// Owner of the ports for which `.*` stands.
#[derive(Debug, Clone)]
pub enum PortsOf {
    /// The graph itself: its inputs and slots.
    In,
    /// The graph itself: its outputs and events.
    Out,
    /// A node or nested graph.
    Node(Ident),
}

/// `node`, `node.port`
#[derive(Debug, Clone)]
pub struct PortRef {
    /// The parts between the dots.
    pub parts: Vec<Ident>,
    /// The whole reference.
    pub span: Span,
}

impl PortRef {
    /// The parts with dots between them.
    pub fn text(&self) -> String {
        self.parts.iter().map(|p| p.text.as_str()).collect::<Vec<_>>().join(".")
    }
}

/// `claim exclusive(a, b);`
#[derive(Debug, Clone)]
pub struct Claim {
    /// Kind of the claim.
    pub kind: Ident,
    /// Names that the claim is about.
    pub of: Vec<PortRef>,
    /// The whole claim without the `;`.
    pub span: Span,
}

/// `thread vision { cores = [1]; priority = 80 }`
#[derive(Debug, Clone)]
pub struct ThreadItem {
    /// The thread group.
    pub name: Ident,
    /// Names and values of the settings.
    pub settings: Vec<(Ident, Expr)>,
}

/// `record "run.mcap"(limit = 1GB) { laser.scan; }`
#[derive(Debug, Clone)]
pub struct RecordItem {
    /// The file.
    pub file: String,
    /// Limits, and if the file is compressed.
    pub options: Vec<Arg>,
    /// The ports.
    pub ports: Vec<PortRef>,
    /// The keyword and the file.
    pub span: Span,
}
