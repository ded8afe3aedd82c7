//! `test` and `tune` items: the graph under test with some nodes replaced, and the scripts. Tests of the same program
//! share it: it is built, checked and compiled once, however many they are.

use super::{
    args,
    budget::Budget,
    builder::Builder,
    instance::Purpose,
    names::{Constructor, GraphId, SourceSet},
    scope::{RustNames, Scope},
    study::study,
    writer::Writer,
};
use crate::{
    catalog::Catalog,
    graph::{Graph, Value},
    report::{Diagnostic, Diagnostics},
    script::Script,
    source::Sources,
    syntax::tree::TestItem,
};
use std::collections::BTreeMap;

/// The test items of a file, those of one program together. Their order in the file does not matter.
pub fn by_program<'a>(items: &'a [TestItem], sources: &Sources) -> Vec<Vec<&'a TestItem>> {
    let mut found: BTreeMap<(String, Option<&str>), Vec<&TestItem>> = BTreeMap::new();
    for item in items {
        // A study sets parameters of its program, which its runs share.
        let study = item.study.is_some().then_some(item.name.text.as_str());
        found.entry((program_of(item, sources), study)).or_default().push(item);
    }
    found.into_values().collect()
}

/// The program that a test runs, as text: the graph with its arguments and its replaced nodes.
fn program_of(item: &TestItem, sources: &Sources) -> String {
    let arguments = item.args.iter().map(|arg| {
        let name = arg.name.as_ref().map_or("", |name| name.text.as_str());
        format!("{name} = {}", sources.text(arg.value.span))
    });
    let replaced = item.replaced.iter().map(|(of, by)| format!("{} = {}", of.text(), sources.text(by.span)));
    let parts = std::iter::once(item.graph.text()).chain(arguments).chain(replaced);
    parts.collect::<Vec<_>>().join("; ")
}

/// Gives a program of tests a name that none of the `others` has: that of its graph, with a number if need be.
pub fn name_apart(graph: &mut Graph, others: &[(Graph, Vec<Script>)]) {
    let (name, mut number) = (graph.name.clone(), 1);
    while others.iter().any(|(other, _)| other.name == graph.name) {
        number += 1;
        graph.name = format!("{name}_{number}");
    }
}

/// Resolves tests of the first source file that run the same program: the program, and their scripts.
pub fn tests(
    texts: &SourceSet,
    catalog: &Catalog,
    items: &[&TestItem],
    sources: &Sources,
    budget: &mut Budget,
    diagnostics: &mut Diagnostics,
) -> Option<(Graph, Vec<Script>)> {
    let item = *items.first()?;
    // Probes are made when they are first used.
    let mut by_name = items.to_vec();
    by_name.sort_by_key(|item| &item.name.text);
    let id = match texts.made(&item.graph, catalog) {
        Ok(Constructor::Graph(id)) => id,
        Ok(Constructor::Node(_)) => {
            let message = format!("`{}` is a node, but a {} runs a graph", item.graph.text(), item.word());
            let note = "write a graph around it, with ports for what the test feeds and expects";
            diagnostics.push(Diagnostic::error("unknown-graph", item.graph.span, message).note(note));
            return None;
        }
        Err(error) => {
            error.into_iter().for_each(|error| diagnostics.push(*error));
            return None;
        }
    };
    if let Some(generic) = texts.graph(id).generics.first() {
        let message = format!(
            "`{}` has the type parameter `{}`, but a {} needs a graph whose types are known",
            item.graph.text(),
            generic.text,
            item.word()
        );
        let note = "write a graph around it, with ports that have types";
        diagnostics.push(Diagnostic::error("unknown-graph", item.graph.span, message).note(note));
        return None;
    }
    let scope = Scope { params: &BTreeMap::new(), rust: RustNames { texts, catalog } };
    let values = arguments(texts, catalog, item, id, &scope, diagnostics);
    let mut builder = Builder::new(texts, catalog, diagnostics, vec![], budget);
    builder.replaced = item.replaced.iter().map(|(of, instance)| (of.text(), instance)).collect();
    let mut graph = builder.top(id, Purpose::Test(values))?;
    graph.robot = false;
    let declared = texts.graph(id).nodes.iter().map(|node| node.name.text.as_str()).collect();
    let mut writer = Writer { graph: &mut graph, declared, scope: &scope, sources, diagnostics };
    writer.check_replaced(item);
    writer.probe_ports();
    let script = |item: &&TestItem| {
        let steps = item.steps.iter().filter_map(|step| writer.step(step)).collect();
        let study = study(&mut writer, texts, catalog, item, id);
        Script { name: item.name.text.clone(), docs: item.docs.clone(), span: item.name.span, steps, study }
    };
    let scripts = by_name.iter().map(script).collect();
    Some((graph, scripts))
}

fn arguments(
    texts: &SourceSet,
    catalog: &Catalog,
    item: &TestItem,
    id: GraphId,
    scope: &Scope<'_>,
    diagnostics: &mut Diagnostics,
) -> BTreeMap<String, Value> {
    let graph = texts.graph(id);
    let params: Vec<_> = graph.params.iter().map(|p| (p, catalog.type_in_text(&texts.ty(&p.ty), &[]))).collect();
    args::of_graph(&graph.name, &params, Some((&item.args, scope)), scope.rust, item.span, diagnostics)
}
