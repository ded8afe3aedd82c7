//! The syntax tree: what stands in a text, with positions, before any name means anything.

use crate::source::Span;

/// A word with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ident {
    /// The word.
    pub text: String,
    /// Its place.
    pub span: Span,
}

/// A text.
#[derive(Debug, Default)]
pub struct File {
    /// `//!` lines.
    pub docs: String,
    /// Imports.
    pub uses: Vec<Use>,
    /// Where one more import can stand: before the first item.
    pub imports_at: Option<usize>,
    /// Graphs and robots.
    pub graphs: Vec<GraphItem>,
    /// State machines.
    pub machines: Vec<FsmItem>,
    /// Tests.
    pub tests: Vec<TestItem>,
    /// Comments that are not documentation, for the formatter.
    pub comments: Vec<Span>,
    /// Whether something in it could not be read.
    pub broken: bool,
    /// Whether that is a whole item, so that names of graphs and imports may be missing.
    pub broken_items: bool,
}

/// One imported name: groups are flattened.
#[derive(Debug)]
pub struct Use {
    /// The segments of the path.
    pub path: Vec<Ident>,
    /// The name it has here.
    pub name: Ident,
}

/// `graph` or `robot`.
#[derive(Debug)]
pub struct GraphItem {
    /// `///` lines.
    pub docs: String,
    /// Whether it is a `robot`.
    pub robot: bool,
    /// Its name.
    pub name: Ident,
    /// Type parameters.
    pub generics: Vec<Ident>,
    /// Parameters.
    pub params: Vec<ParamItem>,
    /// Ports.
    pub ports: Vec<PortItem>,
    /// Nodes with a name.
    pub nodes: Vec<NodeItem>,
    /// Connections.
    pub chains: Vec<Chain>,
    /// Claims.
    pub claims: Vec<Claim>,
    /// What is said about threads.
    pub threads: Vec<ThreadItem>,
    /// `record` statements, of which one is right.
    pub records: Vec<RecordItem>,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// A parameter of a graph.
#[derive(Debug)]
pub struct ParamItem {
    /// `///` lines.
    pub docs: String,
    /// Its name.
    pub name: Ident,
    /// Its type.
    pub ty: TypeExpr,
    /// The unit in brackets behind the type.
    pub unit: Option<Ident>,
    /// Value where none is given.
    pub default: Option<Expr>,
    /// Legal values.
    pub range: Option<RangeExpr>,
}

/// `low..high` or `low..=high`.
#[derive(Debug)]
pub struct RangeExpr {
    /// Smallest value.
    pub low: Expr,
    /// Largest value.
    pub high: Expr,
    /// Whether `high` belongs to it.
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
    /// Whether tokens leave a node here.
    pub fn sends(self) -> bool {
        matches!(self, Self::Output | Self::Event)
    }

    /// Whether it takes part in synchronous data flow.
    pub fn is_synchronous(self) -> bool {
        matches!(self, Self::Input | Self::Output)
    }

    /// What a port of a graph is seen from inside: what takes tokens there sends them on, and the other way round.
    pub fn seen_from_inside(self) -> Self {
        match self {
            Self::Input => Self::Output,
            Self::Output => Self::Input,
            Self::Slot => Self::Event,
            Self::Event => Self::Slot,
        }
    }

    /// What stands before its word.
    pub fn article(self) -> &'static str {
        if self == Self::Slot { "a" } else { "an" }
    }

    /// The word for it.
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
#[derive(Debug)]
pub struct PortItem {
    /// `///` lines.
    pub docs: String,
    /// `in`, `out`, `slot` or `event`.
    pub kind: PortKind,
    /// Its name.
    pub name: Ident,
    /// Type of its tokens; `()` if none is given.
    pub ty: Option<TypeExpr>,
}

/// `node name = …;`
#[derive(Debug)]
pub struct NodeItem {
    /// `///` lines.
    pub docs: String,
    /// Its name.
    pub name: Ident,
    /// What it is made of.
    pub body: NodeBody,
}

/// What a node is made of.
#[derive(Debug)]
pub enum NodeBody {
    /// `= Type(…)`
    Instance(Instance),
    /// `: Type` — made in Rust and handed in.
    HandedIn(TypeExpr, Vec<Modifier>),
}

/// `Type<…>(name = value, …) modifiers`
#[derive(Debug)]
pub struct Instance {
    /// Node or graph.
    pub path: PathExpr,
    /// Type arguments.
    pub types: Vec<TypeExpr>,
    /// Arguments.
    pub args: Vec<Arg>,
    /// Modifiers.
    pub modifiers: Vec<Modifier>,
    /// Everything of it.
    pub span: Span,
}

/// `a::b::c`
#[derive(Debug, Clone)]
pub struct PathExpr {
    /// The segments.
    pub segments: Vec<Ident>,
    /// All of it.
    pub span: Span,
}

impl PathExpr {
    /// The segments with `::` between them.
    pub fn text(&self) -> String {
        self.segments.iter().map(|s| s.text.as_str()).collect::<Vec<_>>().join("::")
    }
}

/// `name = value`
#[derive(Debug)]
pub struct Arg {
    /// The parameter; `None` is an error that is reported where the arguments are checked.
    pub name: Option<Ident>,
    /// The value.
    pub value: Expr,
}

/// A word behind an instance.
#[derive(Debug)]
pub struct Modifier {
    /// Which.
    pub kind: ModifierKind,
    /// All of it.
    pub span: Span,
}

/// A word behind an instance.
#[derive(Debug)]
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
        /// Elements in parallel.
        parallel: bool,
        /// The list input, where it is not plain.
        port: Option<Ident>,
    },
    /// `delay`, `delay 0`, `delay [0, 0]`
    Delay(Option<Expr>),
    /// `pipelined`
    Pipelined,
    /// `essential`
    Essential,
    /// `restart`
    Restart,
}

impl Modifier {
    /// The thread group that it names.
    pub fn group(&self) -> Option<String> {
        if let ModifierKind::On(group) = &self.kind { Some(group.text.clone()) } else { None }
    }
}

impl GraphItem {
    /// All ends of its connections, those in lists one by one.
    pub fn ends(&self) -> Vec<&Endpoint> {
        fn add<'a>(end: &'a Endpoint, found: &mut Vec<&'a Endpoint>) {
            match end {
                Endpoint::List(ends, _) => ends.iter().for_each(|end| add(end, found)),
                Endpoint::Port(_) | Endpoint::Instance(_) => found.push(end),
            }
        }
        let mut found = vec![];
        self.chains.iter().flat_map(|chain| &chain.ends).for_each(|end| add(end, &mut found));
        found
    }

    /// All ports and nodes that its connections and claims name.
    pub fn references(&self) -> Vec<&PortRef> {
        let of_chains = self.ends().into_iter().filter_map(|end| match end {
            Endpoint::Port(reference) => Some(reference),
            _ => None,
        });
        of_chains.chain(self.claims.iter().flat_map(|claim| &claim.of)).collect()
    }

    /// The thread groups that stand behind its instances.
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

    /// All instances in it.
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
    /// The places of its graphs, machines and tests.
    pub fn extents(&self) -> impl Iterator<Item = Span> + '_ {
        let graphs = self.graphs.iter().map(|graph| graph.extent);
        let machines = self.machines.iter().map(|machine| machine.extent);
        graphs.chain(machines).chain(self.tests.iter().map(|test| test.extent))
    }

    /// Whether it declares nothing.
    pub fn is_empty(&self) -> bool {
        self.graphs.is_empty() && self.machines.is_empty() && self.tests.is_empty()
    }
}

/// `fsm Name { … }`
#[derive(Debug)]
pub struct FsmItem {
    /// Documentation.
    pub docs: String,
    /// Its name.
    pub name: Ident,
    /// Its slots and events.
    pub ports: Vec<PortItem>,
    /// Its states; it begins in the first.
    pub states: Vec<StateItem>,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// `state name { … }`
#[derive(Debug)]
pub struct StateItem {
    /// Documentation.
    pub docs: String,
    /// Its name.
    pub name: Ident,
    /// What is triggered when it is entered.
    pub entry: Vec<Action>,
    /// What is triggered when it is left.
    pub exit: Vec<Action>,
    /// What it does about tokens, in order.
    pub transitions: Vec<Transition>,
    /// States inside; whoever enters it enters the first of them.
    pub states: Vec<StateItem>,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// `on slot if guard => state -> event, event(value);`
#[derive(Debug)]
pub struct Transition {
    /// The slot whose token causes it.
    pub slot: Ident,
    /// What must hold.
    pub guard: Option<Expr>,
    /// Where it leads; nowhere if the state stays the same.
    pub target: Option<Ident>,
    /// What is triggered.
    pub actions: Vec<Action>,
}

/// `event`, `event(value)`
#[derive(Debug)]
pub struct Action {
    /// The event.
    pub event: Ident,
    /// The token; without it the token that came.
    pub value: Option<Expr>,
}

/// `test name: Graph(argument = value) { … }`
#[derive(Debug)]
pub struct TestItem {
    /// Documentation.
    pub docs: String,
    /// Its name.
    pub name: Ident,
    /// The graph that is tested.
    pub graph: PathExpr,
    /// Values for its parameters.
    pub args: Vec<Arg>,
    /// Nodes that others stand for.
    pub replaced: Vec<(PortRef, Instance)>,
    /// What is done and expected, in order.
    pub steps: Vec<TestStep>,
    /// From its name to its graph.
    pub span: Span,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// A statement of a test.
#[derive(Debug)]
pub enum TestStep {
    /// `feed port = value every 10ms;`
    Feed(Ident, Option<Expr>, Option<Expr>),
    /// `feed port = recording("run.mcap", "laser.scan");`
    FeedRecorded(Ident, String, String),
    /// `wait 50ms;`
    Wait(Expr),
    /// `expect condition within 50ms;`, `expect condition by 2s;`
    Expect(Condition, Option<(Limit, Expr)>),
    /// `never condition;`
    Never(Condition),
}

/// Until when something is expected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Counted from the start.
    By,
    /// Counted from the expectation before.
    Within,
}

/// What a test looks at.
#[derive(Debug)]
pub struct Condition {
    /// A port, or what is to be active.
    pub of: PortRef,
    /// `active(…)`
    pub active: bool,
    /// How the token is compared with what.
    pub compare: Option<(&'static str, Expr)>,
    /// All of it.
    pub span: Span,
}

/// `a -> b => c;`
#[derive(Debug)]
pub struct Chain {
    /// What is connected.
    pub ends: Vec<Endpoint>,
    /// Arrow `i` stands between ends `i` and `i + 1`.
    pub arrows: Vec<Arrow>,
}

/// `->` or `=>`
#[derive(Debug, Clone, Copy)]
pub struct Arrow {
    /// `=>`: lets activity pass.
    pub active: bool,
    /// Its place.
    pub span: Span,
}

/// One end of a connection.
#[derive(Debug)]
pub enum Endpoint {
    /// `node`, `node.port` or the name of a port of the graph.
    Port(PortRef),
    /// A node written in place.
    Instance(Box<Instance>),
    /// `[a, b]`
    List(Vec<Endpoint>, Span),
}

/// `node`, `node.port`
#[derive(Debug)]
pub struct PortRef {
    /// The parts between the dots.
    pub parts: Vec<Ident>,
    /// All of it.
    pub span: Span,
}

impl PortRef {
    /// The parts with dots between them.
    pub fn text(&self) -> String {
        self.parts.iter().map(|p| p.text.as_str()).collect::<Vec<_>>().join(".")
    }
}

/// `claim exclusive(a, b);`
#[derive(Debug)]
pub struct Claim {
    /// What is claimed.
    pub kind: Ident,
    /// Of what.
    pub of: Vec<PortRef>,
    /// All of it, without the `;`.
    pub span: Span,
}

/// `thread vision { cores = [1]; priority = 80 }`
#[derive(Debug)]
pub struct ThreadItem {
    /// The thread group.
    pub name: Ident,
    /// What is set.
    pub settings: Vec<(Ident, Expr)>,
}

/// `record "run.mcap" { laser.scan; }`
#[derive(Debug)]
pub struct RecordItem {
    /// The file.
    pub file: String,
    /// The ports.
    pub ports: Vec<PortRef>,
    /// The word and the file.
    pub span: Span,
}

/// A type as written.
#[derive(Debug, Clone)]
pub struct TypeExpr {
    /// What it is.
    pub kind: TypeKind,
    /// Its place.
    pub span: Span,
}

/// A type as written.
#[derive(Debug, Clone)]
pub enum TypeKind {
    /// `a::B<C>`
    Path(PathExpr, Vec<TypeExpr>),
    /// `[T; N]`; without `N` a list of any length.
    Array(Box<TypeExpr>, Option<String>),
    /// `(A, B)`
    Tuple(Vec<TypeExpr>),
    /// A number as a type argument.
    Const(String),
}

/// A constant expression.
#[derive(Debug, Clone)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Its place.
    pub span: Span,
}

/// A constant expression.
#[derive(Debug, Clone)]
pub enum ExprKind {
    /// Digits and the unit behind them.
    Number(String, Option<String>),
    /// A string, escapes resolved.
    Text(String),
    /// `true`, `false`
    Bool(bool),
    /// A parameter, or a constant in Rust.
    Path(PathExpr),
    /// `[a, b]`
    List(Vec<Expr>),
    /// `-a`, `!a`
    Unary(&'static str, Box<Expr>),
    /// `a + b`
    Binary(&'static str, Box<Expr>, Box<Expr>),
}
