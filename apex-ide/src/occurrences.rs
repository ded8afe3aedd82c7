//! Occurrences of names and their meanings, the basis of hover, navigation and renaming.

use super::{Definition, MachineId, NodeType, View};
use apex_dsl::{
    graph::Standard,
    resolve::{GraphId, Resolution},
    source::Span,
    syntax::{
        keywords::{KeywordPosition, words_at},
        tree::{
            Action, Arg, Cause, Endpoint, Expr, ExprKind, File, FsmItem, GraphItem, Ident, Instance, Modifier,
            ModifierKind, NodeBody, PathExpr, PortRef, PortsOf, StateItem, TestItem, TestStep, TypeExpr, TypeKind, Use,
        },
    },
};
use std::collections::BTreeMap;

/// A name in a source file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Occurrence {
    /// Place of the name.
    pub span: Span,
    /// Meaning of the name.
    pub definition: Definition,
    /// `true` for the declaration.
    pub declares: bool,
}

/// The name at `offset` of the first source file. Between two names it is the second one.
pub fn at(occurrences: &[Occurrence], view: &View<'_>, offset: usize) -> Option<Occurrence> {
    let root = view.texts.file_id(0);
    let touches = |s: Span| s.file == root && s.start as usize <= offset && offset <= s.end as usize;
    occurrences.iter().filter(|o| touches(o.span)).max_by_key(|o| o.span.start).cloned()
}

/// All names with a meaning in all source files, in order.
pub fn occurrences(view: &View<'_>) -> Vec<Occurrence> {
    let declared = Declared::new(view);
    let mut found = vec![];
    for (file, (_, tree)) in view.texts.files.iter().enumerate() {
        let mut walker = Walker { view: *view, file, declared: &declared, made: BTreeMap::new(), found: &mut found };
        walker.file(tree);
    }
    found.sort();
    found.dedup();
    found
}

type Names<'a> = BTreeMap<&'a str, Definition>;

/// Names that are declared in source files, as an index for their uses.
struct Declared<'a> {
    /// Ports and nodes of each graph.
    graphs: BTreeMap<GraphId, Names<'a>>,
    /// Ports of each state machine.
    ports: BTreeMap<MachineId, Names<'a>>,
    /// States of each state machine.
    states: BTreeMap<MachineId, Names<'a>>,
    /// Parameters of each graph.
    params: BTreeMap<GraphId, Names<'a>>,
}

impl<'a> Declared<'a> {
    fn new(view: &View<'a>) -> Self {
        let (mut graphs, mut params) = (BTreeMap::new(), BTreeMap::new());
        let (mut ports, mut states) = (BTreeMap::new(), BTreeMap::new());
        for (file, (_, tree)) in view.texts.files.iter().enumerate() {
            for id in view.texts.graph_ids(file) {
                graphs.insert(id, of_graph(view, id));
                params.insert(id, params_of(view, id));
            }
            for (machine, item) in tree.machines.iter().enumerate() {
                let id = MachineId { file, machine };
                let all = item.ports.iter().enumerate();
                let port = |i| Definition::Port(NodeType::Machine(id), i);
                ports.insert(id, first_of_each(all.map(|(i, p)| (&p.name, port(i)))));
                let all = view.states(id).into_iter().enumerate();
                states.insert(id, first_of_each(all.map(|(i, s)| (&s.name, Definition::State(id, i)))));
            }
        }
        Self { graphs, ports, states, params }
    }
}

/// The names in a graph. Those that a variant has from its base mean the same there, also where it exchanges a node.
fn of_graph<'a>(view: &View<'a>, id: GraphId) -> Names<'a> {
    let (item, node) = (view.texts.graph(id), NodeType::Graph(id));
    let mut names = base(view, id).map_or_else(Names::new, |base| of_graph(view, base));
    let ports = item.ports.iter().enumerate().map(|(i, p)| (&p.name, Definition::Port(node, i)));
    let nodes = item.nodes.iter().enumerate().map(|(i, n)| (&n.name, Definition::Instance(id, i)));
    add_first_of_each(&mut names, ports.chain(nodes));
    names
}

fn params_of<'a>(view: &View<'a>, id: GraphId) -> Names<'a> {
    let mut names = base(view, id).map_or_else(Names::new, |base| params_of(view, base));
    let params = view.texts.graph(id).params.iter().enumerate();
    add_first_of_each(&mut names, params.map(|(i, p)| (&p.name, Definition::Param(NodeType::Graph(id), i))));
    names
}

fn base(view: &View<'_>, id: GraphId) -> Option<GraphId> {
    view.texts.variant(id)?.base
}

/// The meaning of each name. Of two declarations the first one counts.
fn first_of_each<'a>(declared: impl Iterator<Item = (&'a Ident, Definition)>) -> Names<'a> {
    let mut names = BTreeMap::new();
    add_first_of_each(&mut names, declared);
    names
}

fn add_first_of_each<'a>(names: &mut Names<'a>, declared: impl Iterator<Item = (&'a Ident, Definition)>) {
    for (name, definition) in declared {
        names.entry(name.text.as_str()).or_insert(definition);
    }
}

struct Walker<'a, 'b> {
    view: View<'a>,
    file: usize,
    declared: &'b Declared<'a>,
    /// Node types of the paths that were looked up in this source file.
    made: BTreeMap<String, Option<NodeType>>,
    found: &'b mut Vec<Occurrence>,
}

impl<'a> Walker<'a, '_> {
    fn declares(&mut self, name: &Ident, definition: Definition) {
        self.found.push(Occurrence { span: name.span, definition, declares: true });
    }

    fn used(&mut self, name: &Ident, definition: Definition) {
        self.found.push(Occurrence { span: name.span, definition, declares: false });
    }

    /// The node type that the path of an instance names.
    fn made(&mut self, path: &PathExpr) -> Option<NodeType> {
        let view = self.view;
        *self.made.entry(path.text()).or_insert_with(|| view.node_type(path))
    }

    /// The node type of a node of a graph, which may be in another source file.
    fn made_of(&mut self, id: GraphId, node: usize) -> Option<NodeType> {
        let body = &self.view.texts.graph(id).nodes[node].body;
        match body {
            NodeBody::Instance(instance) if id.file == self.file => self.made(&instance.path),
            _ => self.view.made_of(id, node).0,
        }
    }

    fn file(&mut self, tree: &'a File) {
        tree.uses.iter().for_each(|u| self.import(u));
        for (graph, item) in tree.graphs.iter().enumerate() {
            self.graph(GraphId { file: self.file, graph }, item);
        }
        for (machine, item) in tree.machines.iter().enumerate() {
            self.machine(MachineId { file: self.file, machine }, item);
        }
        for (i, item) in tree.tests.iter().enumerate() {
            self.declares(&item.name, Definition::Test(self.file, i));
            self.test(item);
        }
    }

    fn import(&mut self, item: &Use) {
        let Some(last) = item.path.last() else { return };
        let meant = match self.view.texts.names(self.file).get(&item.name.text) {
            Some(Resolution::Graph(id)) => Some((Definition::Node(NodeType::Graph(*id)), Some(id.file))),
            Some(Resolution::Machine(signature)) => match self.view.of_signature(*signature) {
                NodeType::Machine(id) => Some((Definition::Node(NodeType::Machine(id)), Some(id.file))),
                _ => None,
            },
            Some(Resolution::Rust(path)) => self.in_rust(path).map(|definition| (definition, None)),
            None => None,
        };
        let Some((definition, text)) = meant else { return };
        self.used(last, definition);
        if item.name.span != last.span {
            self.used(&item.name, definition);
        }
        if let (Some(text), [first, _]) = (text, item.path.as_slice()) {
            self.used(first, Definition::Text(text));
        }
    }

    /// A node or type in Rust.
    fn in_rust(&self, path: &[String]) -> Option<Definition> {
        match self.view.catalog.nodes(path).as_slice() {
            [node, ..] => Some(Definition::Node(NodeType::Rust(*node))),
            [] => self.view.catalog.types(path).first().map(|def| Definition::Type(*def)),
        }
    }

    fn graph(&mut self, id: GraphId, item: &'a GraphItem) {
        let this = NodeType::Graph(id);
        self.declares(&item.name, Definition::Node(this));
        for (i, name) in item.generics.iter().enumerate() {
            self.declares(name, Definition::Generic(id, i));
        }
        if let Some(path) = &item.base
            && let Some(made) = self.made(path)
        {
            path.segments.last().iter().for_each(|name| self.used(name, Definition::Node(made)));
        }
        let declared = self.declared;
        for (i, param) in item.params.iter().enumerate() {
            self.declares_in(id, &declared.params[&id], &param.name, Definition::Param(this, i));
            self.ty(Some(id), &param.ty);
            let range = param.range.iter().flat_map(|r| [&r.low, &r.high]);
            param.default.iter().chain(range).for_each(|expr| self.expr(Some(id), expr));
        }
        for (i, port) in item.ports.iter().enumerate() {
            self.declares_in(id, &declared.graphs[&id], &port.name, Definition::Port(this, i));
            port.ty.iter().for_each(|ty| self.ty(Some(id), ty));
        }
        for (i, node) in item.nodes.iter().enumerate() {
            self.declares_in(id, &declared.graphs[&id], &node.name, Definition::Instance(id, i));
            match &node.body {
                NodeBody::Instance(instance) => self.instance(Some(id), instance),
                NodeBody::HandedIn(ty, modifiers) => {
                    let made = if let TypeKind::Path(path, _) = &ty.kind { self.made(path) } else { None };
                    self.handed_in(id, ty, made);
                    self.modifiers(Some(id), made, modifiers);
                }
            }
        }
        item.chains.iter().flat_map(|c| &c.ends).for_each(|end| self.endpoint(id, end));
        item.claims.iter().flat_map(|c| &c.of).for_each(|of| self.reference(id, of));
        item.records.iter().flat_map(|r| &r.ports).for_each(|port| self.reference(id, port));
    }

    /// A declaration in a graph. In a variant it may exchange what its base declares, and is a use of that then.
    fn declares_in(&mut self, id: GraphId, names: &Names<'a>, name: &Ident, definition: Definition) {
        if self.view.texts.variant(id).is_none() {
            return self.declares(name, definition);
        }
        let Some(definition) = names.get(name.text.as_str()).copied() else { return };
        match definition {
            Definition::Instance(of, _)
            | Definition::Port(NodeType::Graph(of), _)
            | Definition::Param(NodeType::Graph(of), _)
                if of != id =>
            {
                self.used(name, definition);
            }
            _ => self.declares(name, definition),
        }
    }

    fn handed_in(&mut self, id: GraphId, ty: &TypeExpr, made: Option<NodeType>) {
        match (&ty.kind, made) {
            (TypeKind::Path(path, args), Some(made)) => {
                path.segments.last().iter().for_each(|name| self.used(name, Definition::Node(made)));
                args.iter().for_each(|ty| self.ty(Some(id), ty));
            }
            _ => self.ty(Some(id), ty),
        }
    }

    fn endpoint(&mut self, id: GraphId, end: &Endpoint) {
        match end {
            Endpoint::Port(reference, given) => {
                self.reference(id, reference);
                given.iter().for_each(|value| self.expr(Some(id), value));
            }
            Endpoint::All(all) => {
                if let PortsOf::Node(name) = &all.of
                    && let Some(definition) = self.declared.graphs[&id].get(name.text.as_str()).copied()
                {
                    self.used(name, definition);
                }
            }
            Endpoint::Instance(instance) => match instance.as_given() {
                Some((port, value)) if self.declared.graphs[&id].contains_key(port.text().as_str()) => {
                    self.reference(id, &port);
                    self.expr(Some(id), value);
                }
                _ => self.instance(Some(id), instance),
            },
            Endpoint::List(ends, _) => ends.iter().for_each(|end| self.endpoint(id, end)),
        }
    }

    /// A node or port of a graph. A test also refers to nodes inside nested graphs.
    /// Names in `active(…)`: of a node, a nested graph, or a state of a machine, even if a port has the same name.
    fn active(&mut self, graph: GraphId, reference: &PortRef) {
        self.named(graph, reference, true);
    }

    fn reference(&mut self, graph: GraphId, reference: &PortRef) {
        self.named(graph, reference, false);
    }

    fn named(&mut self, graph: GraphId, reference: &PortRef, active: bool) {
        let mut graph = graph;
        let mut parts = reference.parts.as_slice();
        while let [first, rest @ ..] = parts {
            let Some(definition) = self.declared.graphs[&graph].get(first.text.as_str()).copied() else {
                let own = words_at(KeywordPosition::Node).find(|w| w.text == first.text);
                return own.iter().for_each(|w| self.used(first, Definition::Own(w.text)));
            };
            self.used(first, definition);
            let (Definition::Instance(id, node), [port, ..]) = (definition, rest) else { return };
            let made = self.made_of(id, node);
            if let (Some(NodeType::Machine(id)), true) = (made, active) {
                for name in rest {
                    let state = self.declared.states[&id].get(name.text.as_str()).copied();
                    state.iter().for_each(|state| self.used(name, *state));
                }
                return;
            }
            if let Some(definition) = made.and_then(|made| self.port(made, &port.text)) {
                return self.used(port, definition);
            }
            let Some(NodeType::Graph(inside)) = made else { return };
            (graph, parts) = (inside, rest);
        }
    }

    /// The port with this name, which may also be a parameter or a standard port.
    fn port(&self, node: NodeType, name: &str) -> Option<Definition> {
        let declared = match node {
            NodeType::Graph(id) => {
                let is_port = |d: &Definition| matches!(d, Definition::Port(..));
                self.declared.graphs[&id].get(name).copied().filter(is_port)
            }
            NodeType::Machine(id) => self.declared.ports[&id].get(name).copied(),
            NodeType::Rust(id) => {
                let ports = &self.view.catalog.signatures[id].ports;
                ports.iter().position(|p| p.name == name).map(|i| Definition::Port(node, i))
            }
        };
        let is_library = !matches!(node, NodeType::Graph(_));
        let param = || is_library.then(|| self.param(node, name)).flatten();
        let is_there = |s: &Standard| (is_library || s.is_shared()) && s.name() == name;
        let standard = || Standard::ALL.into_iter().find(is_there).map(Definition::Standard);
        declared.or_else(param).or_else(standard)
    }

    fn param(&self, node: NodeType, name: &str) -> Option<Definition> {
        match node {
            NodeType::Graph(id) => self.declared.params[&id].get(name).copied(),
            NodeType::Machine(_) => None,
            NodeType::Rust(id) => {
                let params = &self.view.catalog.signatures[id].params;
                params.iter().position(|p| p.name == name).map(|i| Definition::Param(node, i))
            }
        }
    }

    fn instance(&mut self, around: Option<GraphId>, instance: &Instance) {
        let made = self.made(&instance.path);
        if let (Some(made), Some(name)) = (made, instance.path.segments.last()) {
            self.used(name, Definition::Node(made));
        }
        instance.types.iter().for_each(|ty| self.ty(around, ty));
        self.args(around, made, &instance.args);
        self.modifiers(around, made, &instance.modifiers);
    }

    fn args(&mut self, around: Option<GraphId>, made: Option<NodeType>, args: &[Arg]) {
        for arg in args {
            self.expr(around, &arg.value);
            let param = arg.name.as_ref().zip(made).and_then(|(name, made)| self.param(made, &name.text));
            if let (Some(name), Some(param)) = (&arg.name, param) {
                self.used(name, param);
            }
        }
    }

    fn modifiers(&mut self, around: Option<GraphId>, made: Option<NodeType>, modifiers: &[Modifier]) {
        for modifier in modifiers {
            match &modifier.kind {
                ModifierKind::Every(e)
                | ModifierKind::After(e)
                | ModifierKind::Timeout(e)
                | ModifierKind::Deadline(e) => {
                    self.expr(around, e);
                }
                ModifierKind::Delay(values) => values.iter().for_each(|e| self.expr(around, e)),
                ModifierKind::Each { port: Some(port), .. } => {
                    let definition = made.and_then(|made| self.port(made, &port.text));
                    definition.iter().for_each(|d| self.used(port, *d));
                }
                _ => {}
            }
        }
    }

    fn expr(&mut self, around: Option<GraphId>, expr: &Expr) {
        match &expr.kind {
            ExprKind::Path(path) => self.value(around, path),
            ExprKind::List(items) => items.iter().for_each(|e| self.expr(around, e)),
            ExprKind::Struct(path, fields) => {
                self.named_type(path);
                fields.iter().for_each(|(_, e)| self.expr(around, e));
            }
            ExprKind::Unary(_, e) => self.expr(around, e),
            ExprKind::Binary(_, a, b) => {
                self.expr(around, a);
                self.expr(around, b);
            }
            ExprKind::Number(..) | ExprKind::Text(_) | ExprKind::Bool(_) => {}
        }
    }

    /// A parameter of the surrounding graph.
    fn value(&mut self, around: Option<GraphId>, path: &PathExpr) {
        let (Some(id), [name]) = (around, path.segments.as_slice()) else { return };
        let param = self.declared.params[&id].get(name.text.as_str()).copied();
        param.iter().for_each(|definition| self.used(name, *definition));
    }

    fn named_type(&mut self, path: &PathExpr) {
        let Some(last) = path.segments.last() else { return };
        let full = self.view.texts.full_path(path);
        let definition = self.view.catalog.types(&full).first().map(|def| Definition::Type(*def));
        definition.iter().for_each(|d| self.used(last, *d));
    }

    fn ty(&mut self, around: Option<GraphId>, ty: &TypeExpr) {
        match &ty.kind {
            TypeKind::Path(path, args) => {
                args.iter().for_each(|ty| self.ty(around, ty));
                let Some(last) = path.segments.last() else { return };
                let generics = around.map_or(&[][..], |id| self.view.texts.graph(id).generics.as_slice());
                let generic = generics.iter().position(|g| g.text == last.text);
                if let (Some(id), Some(i), [_]) = (around, generic, path.segments.as_slice()) {
                    return self.used(last, Definition::Generic(id, i));
                }
                self.named_type(path);
            }
            TypeKind::Array(element, _) | TypeKind::Measured(element, _) => self.ty(around, element),
            TypeKind::Tuple(parts) => parts.iter().for_each(|ty| self.ty(around, ty)),
            TypeKind::Const(_) => {}
        }
    }

    fn machine(&mut self, id: MachineId, item: &FsmItem) {
        self.declares(&item.name, Definition::Node(NodeType::Machine(id)));
        for (i, port) in item.ports.iter().enumerate() {
            self.declares(&port.name, Definition::Port(NodeType::Machine(id), i));
            port.ty.iter().for_each(|ty| self.ty(None, ty));
        }
        for (i, state) in self.view.states(id).into_iter().enumerate() {
            self.declares(&state.name, Definition::State(id, i));
            self.state(id, state);
        }
    }

    fn state(&mut self, id: MachineId, state: &StateItem) {
        for transition in &state.transitions {
            match &transition.cause {
                Cause::Slot(slot) => self.machine_port(id, slot),
                Cause::After(time) => self.token(id, time),
            }
            let target = transition.target.as_ref();
            let found = target.and_then(|name| self.declared.states[&id].get(name.text.as_str()).copied());
            if let (Some(name), Some(definition)) = (target, found) {
                self.used(name, definition);
            }
        }
        let actions = state.transitions.iter().flat_map(|t| &t.actions);
        let actions: Vec<&Action> = actions.chain(&state.entry).chain(&state.exit).collect();
        actions.iter().for_each(|action| self.machine_port(id, &action.event));
        // In a guard and in the value of an action, the name of the slot is the token.
        for transition in &state.transitions {
            let values = transition.actions.iter().filter_map(|a| a.value.as_ref());
            transition.guard.iter().chain(values).for_each(|e| self.token(id, e));
        }
    }

    fn token(&mut self, id: MachineId, expr: &Expr) {
        match &expr.kind {
            ExprKind::Path(path) => {
                if let [name] = path.segments.as_slice() {
                    self.machine_port(id, name);
                }
            }
            ExprKind::Unary(_, e) => self.token(id, e),
            ExprKind::Binary(_, a, b) => {
                self.token(id, a);
                self.token(id, b);
            }
            _ => {}
        }
    }

    fn machine_port(&mut self, id: MachineId, name: &Ident) {
        let port = self.declared.ports[&id].get(name.text.as_str()).copied();
        port.iter().for_each(|definition| self.used(name, *definition));
    }

    /// The parameter that a study varies, and the nodes that lead to it.
    fn varied(&mut self, graph: GraphId, of: &PortRef) {
        let Some((last, outer)) = of.parts.split_last() else { return };
        let mut node = NodeType::Graph(graph);
        for name in outer {
            let NodeType::Graph(id) = node else { return };
            let Some(definition) = self.declared.graphs[&id].get(name.text.as_str()).copied() else { return };
            self.used(name, definition);
            let Definition::Instance(id, number) = definition else { return };
            let Some(made) = self.made_of(id, number) else { return };
            node = made;
        }
        let definition = self.param(node, &last.text);
        definition.iter().for_each(|definition| self.used(last, *definition));
    }

    fn required(&mut self, name: &Ident) {
        let tests = &self.view.texts.files[self.file].1.tests;
        let found = tests.iter().position(|test| test.study.is_none() && test.name.text == name.text);
        found.iter().for_each(|test| self.used(name, Definition::Test(self.file, *test)));
    }

    fn test(&mut self, item: &TestItem) {
        let made = self.made(&item.graph);
        if let (Some(made), Some(name)) = (made, item.graph.segments.last()) {
            self.used(name, Definition::Node(made));
        }
        self.args(None, made, &item.args);
        item.replaced.iter().for_each(|(_, instance)| self.instance(None, instance));
        let Some(NodeType::Graph(id)) = made else { return };
        item.replaced.iter().for_each(|(of, _)| self.reference(id, of));
        if let Some(study) = &item.study {
            study.goals.iter().for_each(|goal| self.reference(id, &goal.of));
            study.vary.iter().for_each(|(of, _)| self.varied(id, of));
            study.required.iter().for_each(|name| self.required(name));
        }
        for step in &item.steps {
            match step {
                TestStep::Feed(port, ..) | TestStep::FeedRecorded(port, ..) => {
                    let definition = self.declared.graphs[&id].get(port.text.as_str()).copied();
                    definition.iter().for_each(|d| self.used(port, *d));
                }
                TestStep::Expect(condition, _) | TestStep::Never(condition) if condition.active => {
                    self.active(id, &condition.of);
                }
                TestStep::Expect(condition, _) | TestStep::Never(condition) => self.reference(id, &condition.of),
                TestStep::Wait(_) => {}
            }
        }
    }
}
