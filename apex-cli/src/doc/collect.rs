//! Collects the contents of the pages from checked source files.

use super::book::{Claim, Files, Item, Key, Picture, State, Test, Text, Use};
use apex_diagram::{MAX_ITEMS, chart, diagram, folded, folded_states, svg};
use apex_dsl::{
    catalog::SignatureId,
    checked::CheckedProgram,
    claims::Verdict,
    graph::Graph,
    resolve::GraphId,
    source::Span,
    syntax::tree::{Arg, Endpoint, GraphItem, Instance, Modifier, NodeBody, PathExpr, StateItem, TypeKind},
};
use apex_ide::{Definition, MachineId, NodeType, Origin, View, declaration};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// A source file that was checked without errors.
pub struct Checked<'a> {
    /// The source file, which is the first, and all that it imports.
    pub view: View<'a>,
    /// Its programs.
    pub programs: &'a [CheckedProgram],
    /// Its other graphs.
    pub parts: &'a [Graph],
    /// Locations of all files.
    pub files: &'a Files,
    /// Folder of the workspace, and the package that `crate` stands for.
    pub package: Option<(&'a Path, &'a str)>,
}

impl Checked<'_> {
    /// Contents of the page of the source file. Rust nodes that it uses are added to `nodes`.
    pub fn text(&self, nodes: &mut BTreeMap<Key, Item>) -> Text {
        let tree = &self.view.texts.files[0].1;
        let graphs = tree.graphs.iter().enumerate();
        let graphs = graphs.map(|(graph, item)| (item.extent, self.graph(GraphId { file: 0, graph }, nodes)));
        let mut items: Vec<(Span, Item)> = graphs.collect();
        let machines = tree.machines.iter().enumerate();
        items.extend(machines.map(|(machine, item)| (item.extent, self.machine(MachineId { file: 0, machine }))));
        items.sort_by_key(|(extent, _)| *extent);
        let file = self.file(self.view.texts.file_id(0));
        Text {
            path: self.files.shown(&file),
            key: Key { file, line: 0, name: String::new() },
            docs: tree.docs.clone(),
            items: items.into_iter().map(|(_, item)| item).collect(),
            tests: self.tests(),
        }
    }

    fn file(&self, id: apex_dsl::source::FileId) -> PathBuf {
        self.files.real(&self.view.sources.get(id).path)
    }

    fn source(&self, span: Span) -> String {
        self.view.sources.text(span).to_owned()
    }

    /// Properties that all kinds of items have.
    fn item(&self, node: NodeType, word: &'static str) -> Item {
        let key = self.key(node);
        let shown = self.files.shown(&key.file);
        Item {
            word,
            place: Some(format!("{shown}:{}", key.line)),
            module: shown,
            import: None,
            docs: self.view.docs_of(node).to_owned(),
            signature: None,
            params: self.view.params(node),
            ports: self.view.ports(node),
            pictures: vec![],
            nodes: vec![],
            states: vec![],
            claims: vec![],
            code: None,
            key,
        }
    }

    fn key(&self, node: NodeType) -> Key {
        let name = self.view.name_of(node).to_owned();
        match self.view.origin(Definition::Node(node)) {
            Some(Origin::Text(span)) => {
                let line = self.view.sources.line_column(span.file, span.start).0;
                Key { file: self.file(span.file), line, name }
            }
            Some(Origin::Rust(file, line, _)) => {
                let file = self.package.map_or_else(|| file.clone(), |(root, _)| root.join(&file));
                Key { file, line, name }
            }
            None => Key { file: PathBuf::new(), line: 0, name },
        }
    }

    fn graph(&self, id: GraphId, nodes: &mut BTreeMap<Key, Item>) -> Item {
        let item = self.view.texts.graph(id);
        let programs = self.programs.iter().filter(|p| !p.is_test()).map(|p| &p.graph);
        let graph = programs.chain(self.parts).find(|graph| graph.span == item.name.span);
        let written = self.written(item);
        for node in written.iter().filter_map(|written| self.made_of(written)) {
            if let NodeType::Rust(signature) = node {
                nodes.entry(self.key(node)).or_insert_with(|| self.rust(signature));
            }
        }
        Item {
            pictures: graph.map(|graph| self.pictures(graph)).unwrap_or_default(),
            nodes: written.iter().map(|written| self.used(written)).collect(),
            claims: item.claims.iter().map(|claim| self.claim(claim.span)).collect(),
            code: Some(self.source(item.extent)),
            ..self.item(NodeType::Graph(id), if item.robot { "robot" } else { "graph" })
        }
    }

    fn pictures(&self, graph: &Graph) -> Vec<Picture> {
        let whole = diagram(graph, &self.view.texts.machines, self.view.catalog);
        let activity = folded_states(&whole).map(|(item, _)| picture("Activity", &item));
        [picture("Diagram", &folded(whole).0)].into_iter().chain(activity).collect()
    }

    fn machine(&self, id: MachineId) -> Item {
        let item = self.view.machine(id);
        let known = self.view.texts.machine_named(id.file, &item.name.text);
        let mut states = vec![];
        item.states.iter().for_each(|state| add_state(state, "", &mut states));
        Item {
            pictures: known.map(|known| picture("Diagram", &chart(known))).into_iter().collect(),
            states,
            code: Some(self.source(item.extent)),
            ..self.item(NodeType::Machine(id), "fsm")
        }
    }

    fn rust(&self, id: SignatureId) -> Item {
        let signature = &self.view.catalog.signatures[id];
        let written = self.view.catalog.written(&signature.path);
        let path: Vec<&str> = written.iter().map(String::as_str).collect();
        let package = self.package.map_or_else(String::new, |(_, name)| name.replace('-', "_"));
        let module: Vec<&str> = match path.split_last() {
            Some((_, ["crate", inner @ ..])) => [package.as_str()].into_iter().chain(inner.iter().copied()).collect(),
            Some((_, module)) => module.to_vec(),
            None => vec![&package],
        };
        let node = self.view.of_signature(id);
        // The path of a file outside of the workspace differs between machines.
        let place = signature.file.is_relative().then(|| format!("{}:{}", signature.file.display(), signature.line));
        Item {
            module: module.join("::"),
            import: (!path.is_empty()).then(|| path.join("::")),
            place: place.map(|place| place.replace('\\', "/")),
            signature: Some(declaration(&self.view, node).trim_end().to_owned()),
            ..self.item(node, "node")
        }
    }

    /// The nodes of a graph: those with a name, then those that are written in connections.
    fn written<'b>(&self, item: &'b GraphItem) -> Vec<Written<'b>> {
        let named = item.nodes.iter().map(|node| {
            let written = match &node.body {
                NodeBody::Instance(instance) => self.instance(instance),
                NodeBody::HandedIn(ty, modifiers) => Written {
                    path: if let TypeKind::Path(path, _) = &ty.kind { Some(path) } else { None },
                    ty: self.source(ty.span),
                    modifiers,
                    handed_in: true,
                    ..Written::default()
                },
            };
            Written { name: Some(&node.name.text), docs: &node.docs, ..written }
        });
        let mut in_place = vec![];
        item.chains.iter().flat_map(|chain| &chain.ends).for_each(|end| instances(end, &mut in_place));
        named.chain(in_place.into_iter().map(|instance| self.instance(instance))).collect()
    }

    fn instance<'b>(&self, instance: &'b Instance) -> Written<'b> {
        let types: Vec<String> = instance.types.iter().map(|ty| self.source(ty.span)).collect();
        let types = if types.is_empty() { String::new() } else { format!("<{}>", types.join(", ")) };
        Written {
            path: Some(&instance.path),
            ty: instance.path.text() + &types,
            args: &instance.args,
            modifiers: &instance.modifiers,
            ..Written::default()
        }
    }

    fn made_of(&self, written: &Written<'_>) -> Option<NodeType> {
        self.view.node_type(written.path?)
    }

    fn used(&self, written: &Written<'_>) -> Use {
        let argument = |arg: &Arg| arg.name.as_ref().map_or(arg.value.span, |name| name.span.to(arg.value.span));
        let given = written.args.iter().map(argument).chain(written.modifiers.iter().map(|m| m.span));
        Use {
            name: written.name.map(str::to_owned),
            ty: written.ty.clone(),
            of: self.made_of(written).map(|node| self.key(node)),
            handed_in: written.handed_in,
            given: given.map(|span| one_line(self.view.sources.text(span))).collect(),
            docs: written.docs.to_owned(),
        }
    }

    fn claim(&self, span: Span) -> Claim {
        let of_program = |program: &CheckedProgram| {
            let claims = program.graph.claims.iter().zip(&program.claims.verdicts);
            claims.filter(|(claim, _)| claim.span == span).map(|(_, verdict)| *verdict).collect::<Vec<_>>()
        };
        // A claim is checked in every program that contains its graph; the first verdict other than `Holds` is shown.
        let verdicts: Vec<Verdict> = self.programs.iter().flat_map(of_program).collect();
        let verdict = verdicts.iter().find(|verdict| **verdict != Verdict::Holds).or(verdicts.first());
        Claim { text: one_line(self.view.sources.text(span)), verdict: verdict.map(|verdict| verdict.words()) }
    }

    fn tests(&self) -> Vec<Test> {
        let tests = self.view.texts.files[0].1.tests.iter().map(|test| Test {
            name: test.name.text.clone(),
            graph: test.graph.text(),
            of: self.view.node_type(&test.graph).map(|node| self.key(node)),
            docs: test.docs.clone(),
            code: self.source(test.extent),
        });
        tests.collect()
    }
}

/// A node of a graph, as written.
#[derive(Default)]
struct Written<'a> {
    name: Option<&'a str>,
    docs: &'a str,
    ty: String,
    path: Option<&'a PathExpr>,
    args: &'a [Arg],
    modifiers: &'a [Modifier],
    handed_in: bool,
}

fn picture(title: &'static str, item: &apex_diagram::Item) -> Picture {
    let count = item.count();
    Picture { title, svg: if count > MAX_ITEMS { Err(count) } else { Ok(svg(item)) } }
}

/// Adds a state and the states in it; `around` contains the names of the enclosing states, each with a dot.
fn add_state(state: &StateItem, around: &str, found: &mut Vec<State>) {
    let path = format!("{around}{}", state.name.text);
    found.push(State { path: path.clone(), docs: state.docs.clone() });
    state.states.iter().for_each(|inner| add_state(inner, &format!("{path}."), found));
}

/// Adds the nodes that are written at this end of a connection.
fn instances<'a>(end: &'a Endpoint, found: &mut Vec<&'a Instance>) {
    match end {
        Endpoint::Instance(instance) => found.push(instance),
        Endpoint::List(ends, _) => ends.iter().for_each(|end| instances(end, found)),
        Endpoint::Port(..) | Endpoint::All(_) => {}
    }
}

/// Joins lines.
fn one_line(text: &str) -> String {
    text.lines().map(str::trim).collect::<Vec<_>>().join(" ")
}
