//! Completion: the texts that may be written at a place.

use super::{
    Definition, NodeType, PortFacts, View,
    context::{Context, Named, PortId, Quantity, context},
    definition::generics,
    hover::{describe, param, port, standard_docs},
};
use apex_dsl::{
    catalog::{Match, Type},
    graph::Standard,
    resolve::{GraphId, Resolution, is_own_event},
    source::Span,
    syntax::{
        keywords::{KeywordPosition, words_at},
        tree::{Ident, ModifierKind, PathExpr, PortKind},
    },
    units::{self, Dimension},
};
use std::collections::BTreeSet;

/// A proposed text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// Label in the list, inserted if there is no snippet.
    pub label: String,
    /// Kind of the proposed item.
    pub kind: CompletionKind,
    /// Detail shown behind the label.
    pub detail: String,
    /// Documentation, as Markdown.
    pub docs: String,
    /// Inserted text, with `$1` for the position of the cursor.
    pub snippet: Option<String>,
    /// Import that has to be added.
    pub import: Option<String>,
    /// `true` if its tokens certainly have the expected type; `false` if only rustc can decide that.
    pub sure: bool,
}

/// Kind of a completion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CompletionKind {
    /// A node with a name, or a state.
    Name,
    /// A port.
    Port,
    /// A parameter.
    Param,
    /// A value.
    Value,
    /// A unit.
    Unit,
    /// A node type, a graph, a state machine.
    NodeType,
    /// A type of tokens.
    Type,
    /// A crate, a module or a source file.
    Module,
    /// A keyword.
    Keyword,
}

impl Completion {
    fn new(label: impl Into<String>, kind: CompletionKind, detail: impl Into<String>, docs: impl Into<String>) -> Self {
        let (label, detail, docs) = (label.into(), detail.into(), docs.into());
        Self { label, kind, detail, docs, snippet: None, import: None, sure: false }
    }
}

/// `*` behind a dot.
fn each_port() -> Completion {
    let docs = "Connects each port with the port of the same name at the other end, which is followed by `.*`, too.";
    Completion::new("*", CompletionKind::Port, "each port, by name", docs)
}

/// The source files beside the first one: their names, and the names of their graphs and state machines.
pub type Siblings<'a> = dyn Fn() -> Vec<(String, Vec<String>)> + 'a;

/// The completions at `offset` of `text`, and the beginning of the word that they replace. `text` is the first source
/// file of the view, possibly in a slightly newer version.
pub fn complete(view: &View<'_>, text: &str, offset: usize, siblings: &Siblings<'_>) -> (usize, Vec<Completion>) {
    let (context, start) = context(text, offset);
    let completer = Completer { view: *view, graph: graph_at(view, offset), offset };
    (start, completer.at(context, siblings))
}

/// The graph of the first source file around `offset`.
fn graph_at(view: &View<'_>, offset: usize) -> Option<GraphId> {
    let around = |s: Span| s.start as usize <= offset && offset <= s.end as usize;
    let graph = view.texts.files[0].1.graphs.iter().position(|g| around(g.extent))?;
    Some(GraphId { file: 0, graph })
}

struct Completer<'a> {
    view: View<'a>,
    graph: Option<GraphId>,
    offset: usize,
}

impl Completer<'_> {
    fn at(&self, context: Context, siblings: &Siblings<'_>) -> Vec<Completion> {
        match context {
            Context::Nothing => vec![],
            Context::Item => words(KeywordPosition::Item),
            Context::Import(path) => self.importable(&path, siblings),
            Context::Path(path) => self.in_module(&path),
            Context::Type => self.types(),
            Context::Statement => {
                let names = self.names(self.graph, Named::Sends, None);
                words(KeywordPosition::Graph)
                    .into_iter()
                    .chain(names)
                    .chain(self.node_types(true, None, None))
                    .collect()
            }
            Context::Constructor(handed_in) => self.node_types(!handed_in, None, None),
            Context::Name(Named::Tested | Named::Fed, _) => {
                self.tested_names(matches!(context, Context::Name(Named::Fed, _)))
            }
            Context::Name(named, other) => self.ends(named, other.as_ref()),
            Context::Port(of, named, other) => self.ports_of(&of, named, other.as_ref()),
            Context::Argument(of, given) => self.arguments(&of, &given),
            Context::Value(of, name) => self.values(&of, &name),
            Context::Time | Context::Expression => self.parameters(),
            Context::Unit(quantity) => self.units(quantity),
            Context::Modifier => words(KeywordPosition::Modifier),
            Context::List(of) => self.lists(&of),
            Context::Claim => words(KeywordPosition::Claim),
            Context::Machine(in_state) => {
                let is_meant = |w: &Completion| in_state != matches!(w.label.as_str(), "slot" | "event");
                words(KeywordPosition::Machine).into_iter().filter(|w| is_meant(w) || w.label == "state").collect()
            }
            Context::State | Context::MachineSlot | Context::MachineEvent => self.machine_names(&context),
            Context::Test => words(KeywordPosition::Test),
            Context::Tune => words(KeywordPosition::Tune).into_iter().chain(words(KeywordPosition::Test)).collect(),
            Context::Varied(of) => self.varied(&of),
            Context::Required => self.required(),
            Context::Tested => self.node_types(false, None, None),
            Context::Words(words) => {
                words.iter().map(|w| Completion::new(*w, CompletionKind::Keyword, "", "")).collect()
            }
        }
    }

    // Names and ports

    /// The possible ends of a connection.
    fn ends(&self, named: Named, other: Option<&PortId>) -> Vec<Completion> {
        let graph = match named {
            Named::Node => self.graph.or_else(|| self.tested()),
            _ => self.graph,
        };
        let mut found = self.names(graph, named, other);
        if named != Named::Node {
            found.extend(self.node_types(true, Some(named), other));
        }
        found
    }

    /// The ports of a graph, and the nodes in it that have a fitting port.
    fn names(&self, graph: Option<GraphId>, named: Named, other: Option<&PortId>) -> Vec<Completion> {
        let Some(id) = graph else { return vec![] };
        let item = self.view.texts.graph(id);
        let types = other.and_then(|end| self.types_of(id, end, opposite(named)));
        let mut found = vec![];
        for facts in self.view.ports(NodeType::Graph(id)).iter().filter(|_| named != Named::Node) {
            if fits(facts.kind.seen_from_inside(), &facts.ty, named, types.as_deref()) {
                let docs = describe(&self.view, facts.definition);
                let sure = is_sure(&facts.ty, types.as_deref());
                found
                    .push(Completion { sure, ..Completion::new(&facts.name, CompletionKind::Port, port(facts), docs) });
            }
        }
        for (i, node) in item.nodes.iter().enumerate() {
            found.extend(self.node(id, i, &node.name.text, named, types.as_deref()));
        }
        let slots = words_at(KeywordPosition::Node).filter(|w| is_own_event(w.text) == (named == Named::Sends));
        let own =
            slots.filter(|_| named != Named::Node).map(|w| Completion::new(w.text, CompletionKind::Name, "", w.docs));
        found.into_iter().chain(own).collect()
    }

    /// A node: its name if only one of its ports fits, otherwise each fitting port.
    fn node(&self, id: GraphId, i: usize, name: &str, named: Named, types: Option<&[Type]>) -> Vec<Completion> {
        let (made, _) = self.view.made_of(id, i);
        let docs = || describe(&self.view, Definition::Instance(id, i));
        let detail = made.map_or("", |made| self.view.name_of(made));
        if named == Named::Node || made.is_none() {
            return vec![Completion::new(name, CompletionKind::Name, detail, docs())];
        }
        let fitting = self.fitting(id, i, named, types);
        let item = |label: String, kind, p: &PortFacts, docs| {
            let sure = is_sure(&p.ty, types);
            Completion { sure, ..Completion::new(label, kind, port(p), docs) }
        };
        let dotted = |p: &PortFacts| format!("{name}.{}", p.name);
        let mut found = match fitting.as_slice() {
            [one] => vec![item(name.to_owned(), CompletionKind::Name, one, docs())],
            several => several.iter().map(|p| item(dotted(p), CompletionKind::Port, p, p.docs.clone())).collect(),
        };
        // Parameters follow the ports, and only those with the same type, because nearly every node has some.
        let params = made.map(|made| self.parameter_ports(made, named)).unwrap_or_default();
        let agreeing = params.iter().filter(|p| is_sure(&p.ty, types));
        found.extend(agreeing.map(|p| item(dotted(p), CompletionKind::Param, p, p.docs.clone())));
        found
    }

    /// The parameters of a node in Rust, as the ports that they become in a connection.
    fn parameter_ports(&self, node: NodeType, named: Named) -> Vec<PortFacts> {
        let kind = match named {
            Named::Takes => PortKind::Input,
            Named::Sends => PortKind::Output,
            Named::Tested | Named::Fed | Named::Node => return vec![],
        };
        let NodeType::Rust(id) = node else { return vec![] };
        let signature = &self.view.catalog.signatures[id];
        // A port hides a parameter of the same name.
        let is_hidden = |name: &str| signature.ports.iter().any(|p| p.name == name && p.kind.sends() == kind.sends());
        let params = signature.params.iter().enumerate().filter(|(_, p)| !is_hidden(&p.name));
        let facts = params.map(|(i, p)| PortFacts {
            name: p.name.clone(),
            kind,
            ty: p.ty.clone(),
            frame: None,
            rate: 1,
            optional: true,
            any_number: false,
            docs: p.docs.clone(),
            definition: Definition::Param(node, i),
        });
        facts.collect()
    }

    /// The ports of a node that fit an end of a connection.
    fn fitting(&self, id: GraphId, i: usize, named: Named, types: Option<&[Type]>) -> Vec<PortFacts> {
        let (made, instance) = self.view.made_of(id, i);
        let modifiers = instance.map_or(&[][..], |i| i.modifiers.as_slice());
        // The connections decide if the list or its element is meant.
        let each = modifiers.iter().any(|m| matches!(m.kind, ModifierKind::Each { .. }));
        let ports = made.map(|made| self.view.ports(made)).unwrap_or_default();
        ports.into_iter().filter(|p| fits(p.kind, &p.ty, named, types.filter(|_| !each))).collect()
    }

    /// The types of the tokens at an end; `None` if they are not known.
    fn types_of(&self, id: GraphId, end: &PortId, named: Named) -> Option<Vec<Type>> {
        let of = |ports: Vec<PortFacts>, name: Option<&String>| -> Vec<Type> {
            let ports = ports.into_iter().filter(|p| name.is_none_or(|n| p.name == *n));
            ports.filter(|p| fits(p.kind, &p.ty, named, None)).map(|p| p.ty).collect()
        };
        let types = match end {
            PortId::InPlace(path) => of(self.view.ports(self.node_type(path)?), None),
            PortId::Reference(parts) => {
                let (name, port) = (parts.first()?, parts.get(1));
                let own = self.view.ports(NodeType::Graph(id)).into_iter().find(|p| p.name == *name);
                match own {
                    Some(own) => vec![own.ty],
                    None => of(self.fitting(id, self.position(id, name)?, named, None), port),
                }
            }
        };
        (!types.is_empty()).then_some(types)
    }

    fn position(&self, id: GraphId, name: &str) -> Option<usize> {
        self.view.texts.graph(id).nodes.iter().position(|n| n.name.text == name)
    }

    fn node_type(&self, path: &[String]) -> Option<NodeType> {
        let span = Span::new(self.view.texts.file_id(0), self.offset, self.offset);
        let segments = path.iter().map(|text| Ident { text: text.clone(), span }).collect();
        self.view.node_type(&PathExpr { segments, span })
    }

    /// The ports that may follow `node.`.
    fn ports_of(&self, of: &PortId, named: Named, other: Option<&PortId>) -> Vec<Completion> {
        let graph = if named == Named::Tested { self.tested().or(self.graph) } else { self.graph };
        let (Some(mut id), PortId::Reference(parts)) = (graph, of) else { return vec![] };
        let Some((name, outer)) = parts.split_last() else { return vec![] };
        let is_own = outer.is_empty() && matches!(name.as_str(), "in" | "out");
        if is_own || other.is_some_and(PortId::is_each_port) {
            return vec![each_port()];
        }
        for name in outer {
            let made = self.position(id, name).and_then(|i| self.view.made_of(id, i).0);
            let Some(NodeType::Graph(inside)) = made else { return vec![] };
            id = inside;
        }
        let Some(i) = self.position(id, name) else { return vec![] };
        let types = other.and_then(|end| self.types_of(id, end, opposite(named)));
        let mut found: Vec<Completion> = self
            .fitting(id, i, named, types.as_deref())
            .iter()
            .map(|p| Completion::new(&p.name, CompletionKind::Port, port(p), p.docs.clone()))
            .collect();
        let made = self.view.made_of(id, i).0;
        let params = made.map(|made| self.parameter_ports(made, named)).unwrap_or_default();
        let fitting = params.iter().filter(|p| fits(p.kind, &p.ty, named, types.as_deref()));
        found.extend(fitting.map(|p| Completion::new(&p.name, CompletionKind::Param, port(p), p.docs.clone())));
        match made {
            Some(NodeType::Graph(inside)) if named == Named::Tested => {
                found.extend(self.names(Some(inside), Named::Node, None))
            }
            Some(NodeType::Machine(machine)) if named == Named::Tested => {
                let docs = "In `active(…)`: the machine is in this state.";
                let states = self.view.states_by_path(machine).into_iter();
                found.extend(states.map(|(path, _)| Completion::new(path, CompletionKind::Name, "", docs)));
            }
            Some(NodeType::Graph(_)) => found.extend(standard_ports(named, types.as_deref(), Standard::is_shared)),
            Some(_) => found.extend(standard_ports(named, types.as_deref(), |_| true)),
            None => {}
        }
        if outer.is_empty() && named == Named::Sends {
            found.push(each_port());
        }
        found
    }

    /// The inputs of a node that may be the list of an `each`.
    fn lists(&self, of: &[String]) -> Vec<Completion> {
        let ports = self.node_type(of).map(|node| self.view.ports(node)).unwrap_or_default();
        let inputs = ports.iter().filter(|p| p.kind == PortKind::Input);
        inputs.map(|p| Completion::new(&p.name, CompletionKind::Port, port(p), p.docs.clone())).collect()
    }

    /// The graph that the surrounding test runs.
    fn tested(&self) -> Option<GraphId> {
        let around = |s: Span| s.start as usize <= self.offset && self.offset <= s.end as usize;
        let test = self.view.texts.files[0].1.tests.iter().find(|t| around(t.extent))?;
        match self.view.node_type(&test.graph)? {
            NodeType::Graph(id) => Some(id),
            _ => None,
        }
    }

    fn tested_names(&self, fed: bool) -> Vec<Completion> {
        let Some(id) = self.tested() else { return vec![] };
        let takes = |p: &&PortFacts| !fed || matches!(p.kind, PortKind::Input | PortKind::Slot);
        let ports = self.view.ports(NodeType::Graph(id));
        let ports =
            ports.iter().filter(takes).map(|p| Completion::new(&p.name, CompletionKind::Port, port(p), p.docs.clone()));
        let mut found: Vec<Completion> = ports.collect();
        if !fed {
            found.extend(self.names(Some(id), Named::Node, None));
            let docs = "True if a node or nested graph is active, or a machine in a state.";
            let active = Completion::new("active", CompletionKind::Keyword, "", docs);
            found.push(Completion { snippet: Some("active($1)".to_owned()), ..active });
        }
        found
    }

    /// The parameters of the tuned graph, and its nodes; or the parameters of one of its nodes.
    fn varied(&self, of: &[String]) -> Vec<Completion> {
        let Some(mut id) = self.tested() else { return vec![] };
        let mut node = NodeType::Graph(id);
        for name in of {
            let Some(made) = self.position(id, name).and_then(|i| self.view.made_of(id, i).0) else { return vec![] };
            node = made;
            if let NodeType::Graph(inside) = made {
                id = inside;
            }
        }
        let nodes = if let NodeType::Graph(id) = node { self.names(Some(id), Named::Node, None) } else { vec![] };
        let params = self.view.params(node).into_iter();
        let params = params.map(|p| Completion::new(&p.name, CompletionKind::Param, param(&p), p.docs));
        params.chain(nodes).collect()
    }

    /// The tests of the text, and `never`.
    fn required(&self) -> Vec<Completion> {
        let tests = self.view.texts.files[0].1.tests.iter().filter(|test| test.study.is_none());
        let tests = tests.map(|t| Completion::new(&t.name.text, CompletionKind::Name, "test", t.docs.clone()));
        let never = Completion::new("never", CompletionKind::Keyword, "", "What must not happen in any run.");
        tests.chain([never]).collect()
    }

    fn machine_names(&self, context: &Context) -> Vec<Completion> {
        let around = |s: Span| s.start as usize <= self.offset && self.offset <= s.end as usize;
        let machines = &self.view.texts.files[0].1.machines;
        let Some(machine) = machines.iter().position(|m| around(m.extent)) else { return vec![] };
        let id = super::MachineId { file: 0, machine };
        if *context == Context::State {
            let states = self.view.states(id).into_iter();
            return states
                .map(|s| Completion::new(&s.name.text, CompletionKind::Name, "state", s.docs.clone()))
                .collect();
        }
        let kind = if *context == Context::MachineSlot { PortKind::Slot } else { PortKind::Event };
        let ports = self.view.ports(NodeType::Machine(id));
        let ports = ports.iter().filter(|p| p.kind == kind);
        ports.map(|p| Completion::new(&p.name, CompletionKind::Port, port(p), p.docs.clone())).collect()
    }

    // Arguments and values

    fn arguments(&self, of: &[String], given: &[String]) -> Vec<Completion> {
        let params = self.node_type(of).map(|node| self.view.params(node)).unwrap_or_default();
        let open = params.iter().filter(|p| !given.contains(&p.name));
        let found = open.map(|p| {
            let docs = describe(&self.view, p.definition);
            let item = Completion::new(&p.name, CompletionKind::Param, param(p), docs);
            Completion { snippet: Some(format!("{} = $1", p.name)), ..item }
        });
        found.collect()
    }

    fn values(&self, of: &[String], name: &str) -> Vec<Completion> {
        let params = self.node_type(of).map(|node| self.view.params(node)).unwrap_or_default();
        let wanted = params.iter().find(|p| p.name == name);
        let mut found = self.parameters();
        if let Some(default) = wanted.and_then(|p| p.default.as_ref()).filter(|d| *d != "…") {
            let unit =
                wanted.and_then(|p| p.written_in()).filter(|_| default.bytes().all(|b| !b.is_ascii_alphabetic()));
            let text = format!("{default}{}", unit.unwrap_or_default());
            found.push(Completion::new(text, CompletionKind::Value, "the default", ""));
        }
        if wanted.is_none_or(|p| p.ty == "bool") {
            found.extend(words(KeywordPosition::Value));
        }
        found
    }

    /// The parameters of the surrounding graph.
    fn parameters(&self) -> Vec<Completion> {
        let params = self.graph.map(|id| self.view.params(NodeType::Graph(id))).unwrap_or_default();
        let found = params
            .iter()
            .map(|p| Completion::new(&p.name, CompletionKind::Param, param(p), describe(&self.view, p.definition)));
        found.collect()
    }

    fn units(&self, quantity: Quantity) -> Vec<Completion> {
        let wanted = match quantity {
            Quantity::Any => None,
            Quantity::Time => Some("s".to_owned()),
            Quantity::Argument(of, name) => {
                let params = self.node_type(&of).map(|node| self.view.params(node));
                match params.unwrap_or_default().into_iter().find(|p| p.name == name) {
                    Some(param) if param.written_in().is_none() => return vec![],
                    found => found.and_then(|p| p.written_in().map(str::to_owned)),
                }
            }
        };
        let found = match wanted {
            Some(unit) => units_like(&unit),
            None => units::names().map(str::to_owned).collect(),
        };
        found.into_iter().map(|unit| Completion::new(&unit, CompletionKind::Unit, noun(&unit), "")).collect()
    }

    // Node types and types

    /// The possible constructors of an instance: first those with a name here, then those that can be imported.
    fn node_types(&self, with_args: bool, named: Option<Named>, other: Option<&PortId>) -> Vec<Completion> {
        let types =
            self.graph.zip(other).zip(named).and_then(|((id, end), named)| self.types_of(id, end, opposite(named)));
        let is_meant = |node: NodeType| {
            let Some(named) = named else { return true };
            self.view.ports(node).iter().any(|p| fits(p.kind, &p.ty, named, types.as_deref()))
        };
        let around = self.graph.map(|id| self.view.graphs_around(id)).unwrap_or_default();
        let is_recursive = |node: NodeType| matches!(node, NodeType::Graph(id) if around.contains(&id));
        let (mut found, mut known) = (vec![], BTreeSet::new());
        for (name, meaning) in self.view.texts.names(0) {
            let node = match meaning {
                Resolution::Graph(id) => Some(NodeType::Graph(*id)),
                Resolution::Machine(signature) => Some(self.view.of_signature(*signature)),
                Resolution::Rust(path) => self.view.catalog.nodes(path).first().map(|id| NodeType::Rust(*id)),
            };
            known.insert(name.as_str());
            let Some(node) = node.filter(|n| is_meant(*n) && !is_recursive(*n)) else { continue };
            found.push(self.node_type_item(name, node, with_args, None));
        }
        for (id, signature) in self.view.catalog.rust_nodes() {
            let node = NodeType::Rust(id);
            if signature.path.is_empty() || known.contains(signature.name.as_str()) || !is_meant(node) {
                continue;
            }
            let path = self.view.catalog.written(&signature.path);
            let is_own = path.first().is_some_and(|p| p == "crate");
            let import = (!is_own).then(|| format!("use {};\n", path.join("::")));
            found.push(self.node_type_item(&signature.name, node, with_args, import));
        }
        found
    }

    fn node_type_item(&self, name: &str, node: NodeType, with_args: bool, import: Option<String>) -> Completion {
        let required = self.view.params(node).into_iter().filter(|p| p.default.is_none());
        let args: Vec<String> = required.enumerate().map(|(i, p)| format!("{} = ${}", p.name, i + 1)).collect();
        let first_line = self.view.docs_of(node).lines().next().unwrap_or_default();
        let docs = describe(&self.view, Definition::Node(node));
        let item = Completion::new(name, CompletionKind::NodeType, first_line, docs);
        Completion { snippet: with_args.then(|| format!("{name}({})$0", args.join(", "))), import, ..item }
    }

    fn types(&self) -> Vec<Completion> {
        let plain = "f32 f64 bool u8 u16 u32 u64 i8 i16 i32 i64 Duration Time Vec Option".split(' ');
        let plain = plain.map(|name| Completion::new(name, CompletionKind::Type, "", ""));
        let imported = self.view.texts.names(0).iter().filter_map(|(name, meaning)| match meaning {
            Resolution::Rust(path) if !self.view.catalog.types(path).is_empty() => Some(name.clone()),
            _ => None,
        });
        let own = self.graph.map(|id| generics(self.view.texts.graph(id))).unwrap_or_default();
        let named = imported.chain(own).map(|name| Completion::new(name, CompletionKind::Type, "", ""));
        named.chain(plain).collect()
    }

    fn importable(&self, path: &[String], siblings: &Siblings<'_>) -> Vec<Completion> {
        let module = |name: &str| Completion::new(name, CompletionKind::Module, "", "");
        match path {
            [] => {
                let crates = self.view.catalog.crate_names().into_iter().chain(["crate"]).map(module);
                let texts = siblings().into_iter().map(|(name, _)| {
                    let detail = format!("{name}.afg");
                    Completion::new(name, CompletionKind::Module, detail, "")
                });
                crates.chain(texts).collect()
            }
            [text] if !self.view.catalog.is_crate(text) => {
                let graphs = siblings().into_iter().filter(|(name, _)| name == text).flat_map(|(_, graphs)| graphs);
                graphs.map(|name| Completion::new(name, CompletionKind::NodeType, "", "")).collect()
            }
            _ => self.in_module(path),
        }
    }

    /// The contents of a Rust module.
    fn in_module(&self, path: &[String]) -> Vec<Completion> {
        let names: BTreeSet<&str> = self.view.catalog.names_in(path).into_iter().collect();
        let item = |name: &str| {
            let full: Vec<String> = path.iter().cloned().chain([name.to_owned()]).collect();
            if let [node, ..] = self.view.catalog.nodes(&full).as_slice() {
                return self.node_type_item(name, NodeType::Rust(*node), false, None);
            }
            let kind =
                if self.view.catalog.types(&full).is_empty() { CompletionKind::Module } else { CompletionKind::Type };
            Completion::new(name, kind, "", "")
        };
        names.into_iter().map(item).collect()
    }
}

fn opposite(named: Named) -> Named {
    if named == Named::Takes { Named::Sends } else { Named::Takes }
}

/// Returns `true` if a port fits an end of a connection, with tokens of one of these types.
fn fits(kind: PortKind, ty: &Type, named: Named, types: Option<&[Type]>) -> bool {
    let side = match named {
        Named::Sends => kind.sends(),
        Named::Takes => !kind.sends(),
        _ => true,
    };
    side && types.is_none_or(|types| types.iter().any(|t| t.compare(ty) != Match::Different))
}

/// Returns `true` if tokens of this type certainly have one of these types.
fn is_sure(ty: &Type, types: Option<&[Type]>) -> bool {
    types.is_some_and(|types| types.iter().any(|t| t.compare(ty) == Match::Same))
}

/// The standard ports of a node.
fn standard_ports(
    named: Named,
    types: Option<&[Type]>,
    has: impl Fn(Standard) -> bool,
) -> impl Iterator<Item = Completion> {
    let fitting = Standard::ALL.into_iter().filter(move |s| has(*s) && fits(s.kind(), &s.ty(), named, types));
    fitting.map(|s| {
        let detail = format!("{} {}: {}", s.kind().word(), s.name(), s.ty());
        Completion::new(s.name(), CompletionKind::Port, detail, standard_docs(s))
    })
}

fn words(place: KeywordPosition) -> Vec<Completion> {
    words_at(place).map(|w| Completion::new(w.text, CompletionKind::Keyword, "", w.docs)).collect()
}

fn dimension(unit: &str) -> Option<Dimension> {
    units::parse(unit).ok().map(|u| u.dimension)
}

fn noun(unit: &str) -> &'static str {
    dimension(unit).map_or("", Dimension::noun)
}

/// The units with the same dimension. For a quotient, also the quotients of units like its parts.
fn units_like(unit: &str) -> Vec<String> {
    let Some(wanted) = dimension(unit) else { return vec![] };
    let mut found: Vec<String> = units::names().filter(|n| dimension(n) == Some(wanted)).map(str::to_owned).collect();
    if let Some((above, below)) = unit.split_once('/') {
        let like = |part: &str| -> Vec<&'static str> {
            let part = dimension(part);
            units::names().filter(|n| part.is_some() && dimension(n) == part).collect()
        };
        let pairs = like(above).into_iter().flat_map(|a| like(below).into_iter().map(move |b| format!("{a}/{b}")));
        found.extend(pairs);
    }
    if !found.iter().any(|u| u == unit) {
        found.insert(0, unit.to_owned());
    }
    found
}
