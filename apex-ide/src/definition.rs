//! Definitions that names stand for, and facts from their declarations.

use super::{View, rust::Part};
use apex_dsl::{
    catalog::{DefId, DefaultValue, Literal, ParamSig, SignatureId, Type},
    graph::Standard,
    resolve::{GraphId, Resolution},
    source::Span,
    syntax::tree::{
        Expr, FsmItem, GraphItem, Ident, Instance, NodeBody, PathExpr, PortItem, PortKind, StateItem, TypeKind,
    },
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
};

/// A state machine, by source file and number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct MachineId {
    /// The source file.
    pub file: usize,
    /// Number in the source file.
    pub machine: usize,
}

/// Constructor of an instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum NodeType {
    /// A graph.
    Graph(GraphId),
    /// A state machine.
    Machine(MachineId),
    /// A node in Rust.
    Rust(SignatureId),
}

/// Meaning of a name. Numbers count in the order of the declarations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Definition {
    /// Another source file.
    Text(usize),
    /// A graph, a state machine or a node in Rust.
    Node(NodeType),
    /// A type in Rust.
    Type(DefId),
    /// A type parameter of a graph.
    Generic(GraphId, usize),
    /// A parameter.
    Param(NodeType, usize),
    /// A port.
    Port(NodeType, usize),
    /// A port that every node has.
    Standard(Standard),
    /// A node with a name.
    Instance(GraphId, usize),
    /// `start`, `reset`, `exit`, `abort`.
    Own(&'static str),
    /// A state. Inner states follow the state that contains them.
    State(MachineId, usize),
    /// A test.
    Test(usize, usize),
}

/// Place of a declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// A place in a source file.
    Text(Span),
    /// A part of the declaration of a node or type in a Rust file: the file, the line of the declaration (from 1), the
    /// part.
    Rust(PathBuf, usize, Part),
}

/// Declaration of a port.
pub struct PortFacts {
    /// Name of the port.
    pub name: String,
    /// Kind, seen from outside.
    pub kind: PortKind,
    /// Type of the tokens.
    pub ty: Type,
    /// Frame of the tokens, if the source file says one.
    pub frame: Option<String>,
    /// Tokens per firing.
    pub rate: usize,
    /// `true` for an input that need not be connected.
    pub optional: bool,
    /// `true` for an input that takes any number of connections.
    pub any_number: bool,
    /// Documentation.
    pub docs: String,
    /// Definition of the port.
    pub definition: Definition,
}

impl PortFacts {
    /// The type as text, with the number of tokens per firing and the frame: `[f64; 2]`, `Scan in base`.
    pub fn type_text(&self) -> String {
        let ty = if self.rate > 1 { format!("[{}; {}]", self.ty, self.rate) } else { self.ty.to_string() };
        self.frame.as_ref().map_or_else(|| ty.clone(), |frame| format!("{ty} in {frame}"))
    }

    /// Properties of the port, in words.
    pub fn remarks(&self) -> impl Iterator<Item = &'static str> {
        let optional = self.optional.then_some("optional");
        optional.into_iter().chain(self.any_number.then_some("any number of connections"))
    }
}

/// Declaration of a parameter.
pub struct ParamFacts {
    /// Name of the parameter.
    pub name: String,
    /// Type of the parameter.
    pub ty: String,
    /// Unit, if one is declared.
    pub unit: Option<String>,
    /// Default value.
    pub default: Option<String>,
    /// Range, from the smallest to the largest value.
    pub range: Option<String>,
    /// Documentation.
    pub docs: String,
    /// Definition of the parameter.
    pub definition: Definition,
}

impl ParamFacts {
    /// The unit in which a value is written: the declared one, or seconds for a time.
    pub fn written_in(&self) -> Option<&str> {
        let is_time = self.ty.rsplit("::").next() == Some("Duration");
        self.unit.as_deref().or(is_time.then_some("s"))
    }
}

impl<'a> View<'a> {
    /// A state machine.
    pub fn machine(&self, id: MachineId) -> &'a FsmItem {
        &self.texts.files[id.file].1.machines[id.machine]
    }

    /// The node type that the path of an instance names.
    pub fn node_type(&self, path: &PathExpr) -> Option<NodeType> {
        let file = self.texts.file_of(path.span);
        if let [name] = path.segments.as_slice() {
            match self.texts.names(file).get(&name.text) {
                Some(Resolution::Graph(id)) => return Some(NodeType::Graph(*id)),
                Some(Resolution::Machine(signature)) => return Some(self.of_signature(*signature)),
                _ => {}
            }
        }
        match self.catalog.nodes(&self.texts.full_path(path)).as_slice() {
            [one] => Some(self.of_signature(*one)),
            _ => None,
        }
    }

    /// The node type of a catalog entry. State machines have entries, too.
    pub fn of_signature(&self, signature: SignatureId) -> NodeType {
        match self.texts.machine(signature) {
            Some((file, machine)) => NodeType::Machine(MachineId { file, machine }),
            None => NodeType::Rust(signature),
        }
    }

    /// The node type of a named node, and its instance if it is written as one.
    pub fn made_of(&self, graph: GraphId, node: usize) -> (Option<NodeType>, Option<&'a Instance>) {
        match &self.texts.graph(graph).nodes[node].body {
            NodeBody::Instance(instance) => (self.node_type(&instance.path), Some(instance)),
            NodeBody::HandedIn(ty, _) => match &ty.kind {
                TypeKind::Path(path, _) => (self.node_type(path), None),
                _ => (None, None),
            },
        }
    }

    /// The name of a graph, state machine or node.
    pub fn name_of(&self, node: NodeType) -> &'a str {
        match node {
            NodeType::Graph(id) => &self.texts.graph(id).name.text,
            NodeType::Machine(id) => &self.machine(id).name.text,
            NodeType::Rust(id) => &self.catalog.signatures[id].name,
        }
    }

    /// The documentation of a graph, state machine or node.
    pub fn docs_of(&self, node: NodeType) -> &'a str {
        match node {
            NodeType::Graph(id) => &self.texts.graph(id).docs,
            NodeType::Machine(id) => &self.machine(id).docs,
            NodeType::Rust(id) => &self.catalog.signatures[id].docs,
        }
    }

    /// The ports of a graph, state machine or node, without the standard ports.
    pub fn ports(&self, node: NodeType) -> Vec<PortFacts> {
        match node {
            NodeType::Graph(id) => {
                let item = self.texts.graph(id);
                self.declared_ports(node, &item.ports, &generics(item))
            }
            NodeType::Machine(id) => self.declared_ports(node, &self.machine(id).ports, &[]),
            NodeType::Rust(id) => {
                let ports = self.catalog.signatures[id].ports.iter().enumerate();
                let facts = ports.map(|(i, p)| PortFacts {
                    name: p.name.clone(),
                    kind: p.kind,
                    ty: p.ty.clone(),
                    frame: None,
                    rate: p.rate,
                    optional: p.optional && p.kind == PortKind::Input,
                    any_number: p.any_number,
                    docs: p.docs.clone(),
                    definition: Definition::Port(node, i),
                });
                facts.collect()
            }
        }
    }

    fn declared_ports(&self, node: NodeType, ports: &[PortItem], generics: &[String]) -> Vec<PortFacts> {
        let ty = |port: &PortItem| match &port.ty {
            Some(ty) => self.catalog.type_in_text(&self.texts.ty(ty), generics),
            None => Type::unit(),
        };
        let facts = ports.iter().enumerate().map(|(i, port)| PortFacts {
            name: port.name.text.clone(),
            kind: port.kind,
            ty: ty(port),
            frame: port.frame.as_ref().map(|frame| frame.text.clone()),
            rate: 1,
            optional: false,
            any_number: false,
            docs: port.docs.clone(),
            definition: Definition::Port(node, i),
        });
        facts.collect()
    }

    /// The parameters of a graph or node.
    pub fn params(&self, node: NodeType) -> Vec<ParamFacts> {
        match node {
            NodeType::Machine(_) => vec![],
            NodeType::Rust(id) => {
                let params = self.catalog.signatures[id].params.iter().enumerate();
                params.map(|(i, p)| rust_param(p, Definition::Param(node, i))).collect()
            }
            NodeType::Graph(id) => {
                let text = |expr: &Expr| self.sources.text(expr.span).to_owned();
                let params = self.texts.graph(id).params.iter().enumerate();
                let facts = params.map(|(i, p)| {
                    let dots = |inclusive| if inclusive { "..=" } else { ".." };
                    let range = p.range.as_ref();
                    let ty = self.sources.text(p.ty.span).to_owned();
                    ParamFacts {
                        name: p.name.text.clone(),
                        unit: p.unit.as_ref().map(|u| u.text.clone()),
                        ty,
                        default: p.default.as_ref().map(text),
                        range: range.map(|r| format!("{}{}{}", text(&r.low), dots(r.inclusive), text(&r.high))),
                        docs: p.docs.clone(),
                        definition: Definition::Param(node, i),
                    }
                });
                facts.collect()
            }
        }
    }

    /// A graph and all graphs that contain it, at any depth: none of them can be nested in it.
    pub fn graphs_around(&self, graph: GraphId) -> BTreeSet<GraphId> {
        let mut users = BTreeMap::<GraphId, Vec<GraphId>>::new();
        for (file, (_, tree)) in self.texts.files.iter().enumerate() {
            for (number, item) in tree.graphs.iter().enumerate() {
                let paths =
                    item.instances().into_iter().filter_map(|instance| match instance.path.segments.as_slice() {
                        [name] => self.texts.names(file).get(&name.text),
                        _ => None,
                    });
                for meaning in paths {
                    if let Resolution::Graph(used) = meaning {
                        users.entry(*used).or_default().push(GraphId { file, graph: number });
                    }
                }
            }
        }
        let (mut around, mut open) = (BTreeSet::new(), vec![graph]);
        while let Some(id) = open.pop() {
            if around.insert(id) {
                open.extend(users.get(&id).into_iter().flatten());
            }
        }
        around
    }

    /// All states of a machine with their paths (`fetch.drive`), outer ones before those inside.
    pub fn states_by_path(&self, id: MachineId) -> Vec<(String, &'a StateItem)> {
        let path = |around: &str, state: &'a StateItem| match around {
            "" => (state.name.text.clone(), state),
            _ => (format!("{around}.{}", state.name.text), state),
        };
        let mut open: Vec<_> = self.machine(id).states.iter().rev().map(|state| path("", state)).collect();
        let mut all = vec![];
        while let Some((around, state)) = open.pop() {
            open.extend(state.states.iter().rev().map(|inner| path(&around, inner)));
            all.push((around, state));
        }
        all
    }

    /// All states of a machine, outer ones before those inside.
    pub fn states(&self, id: MachineId) -> Vec<&'a StateItem> {
        self.states_by_path(id).into_iter().map(|(_, state)| state).collect()
    }

    /// The place of a definition.
    pub fn origin(&self, definition: Definition) -> Option<Origin> {
        if let Some(name) = self.declared_name(definition) {
            return Some(Origin::Text(name.span));
        }
        match definition {
            Definition::Text(file) => Some(Origin::Text(Span::new(self.texts.file_id(file), 0, 0))),
            Definition::Node(node @ NodeType::Rust(id)) => self.in_rust(id, Part::Name(self.name_of(node).to_owned())),
            Definition::Param(NodeType::Rust(id), i) => {
                self.in_rust(id, Part::Param(self.catalog.signatures[id].params[i].name.clone()))
            }
            Definition::Port(NodeType::Rust(id), i) => {
                let port = &self.catalog.signatures[id].ports[i];
                self.in_rust(id, Part::Port(port.kind, port.name.clone()))
            }
            Definition::Type(def) => {
                let (file, line) = self.catalog.place(def);
                let path = self.catalog.name(def);
                let name = path.rsplit("::").next().unwrap_or_default().to_owned();
                Some(Origin::Rust(file, line, Part::Name(name)))
            }
            _ => None,
        }
    }

    /// The place of a part of a node's declaration in Rust.
    fn in_rust(&self, id: SignatureId, part: Part) -> Option<Origin> {
        let signature = &self.catalog.signatures[id];
        Some(Origin::Rust(signature.file.clone(), signature.line, part))
    }

    /// The name in a declaration, if it is in a source file.
    pub fn declared_name(&self, definition: Definition) -> Option<&'a Ident> {
        let texts = self.texts;
        match definition {
            Definition::Node(NodeType::Graph(id)) => Some(&texts.graph(id).name),
            Definition::Node(NodeType::Machine(id)) => Some(&self.machine(id).name),
            Definition::Generic(id, i) => Some(&texts.graph(id).generics[i]),
            Definition::Param(NodeType::Graph(id), i) => Some(&texts.graph(id).params[i].name),
            Definition::Port(NodeType::Graph(id), i) => Some(&texts.graph(id).ports[i].name),
            Definition::Port(NodeType::Machine(id), i) => Some(&self.machine(id).ports[i].name),
            Definition::Instance(id, i) => Some(&texts.graph(id).nodes[i].name),
            Definition::State(id, i) => Some(&self.states(id)[i].name),
            Definition::Test(file, i) => Some(&texts.files[file].1.tests[i].name),
            _ => None,
        }
    }
}

/// The names of the type parameters of a graph.
pub fn generics(item: &GraphItem) -> Vec<String> {
    item.generics.iter().map(|g| g.text.clone()).collect()
}

fn rust_param(param: &ParamSig, definition: Definition) -> ParamFacts {
    let default = match &param.default {
        Some(DefaultValue::Literal(Literal::Number(value, _))) => Some(value.to_string()),
        Some(DefaultValue::Literal(Literal::Bool(value))) => Some(value.to_string()),
        Some(DefaultValue::Literal(Literal::Text(text))) => Some(format!("{text:?}")),
        Some(DefaultValue::Rust) => Some("…".to_owned()),
        None => None,
    };
    let bound = |bound: Option<f64>| bound.map(|b| b.to_string()).unwrap_or_default();
    let dots = |inclusive| if inclusive { "..=" } else { ".." };
    ParamFacts {
        name: param.name.clone(),
        unit: param.unit.clone(),
        ty: param.ty.to_string(),
        default,
        range: param.range.map(|(low, high, inclusive)| format!("{}{}{}", bound(low), dots(inclusive), bound(high))),
        docs: param.docs.clone(),
        definition,
    }
}
