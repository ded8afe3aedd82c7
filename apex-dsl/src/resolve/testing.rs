//! `test` and `tune` items: the graph under test with some nodes replaced, and the script.

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

/// Resolves test `item` of the first source file.
pub fn test(
    texts: &SourceSet,
    catalog: &Catalog,
    item: &TestItem,
    sources: &Sources,
    budget: &mut Budget,
    diagnostics: &mut Diagnostics,
) -> Option<(Graph, Script)> {
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
    graph.name = format!("{}Test", crate::graph::camel(&item.name.text));
    graph.robot = false;
    let declared = texts.graph(id).nodes.iter().map(|node| node.name.text.as_str()).collect();
    let mut writer = Writer { graph: &mut graph, declared, scope: &scope, sources, diagnostics };
    writer.check_replaced(item);
    writer.probe_ports();
    let steps = item.steps.iter().filter_map(|step| writer.step(step)).collect();
    let study = study(&mut writer, texts, catalog, item, id);
    let (name, docs) = (item.name.text.clone(), item.docs.clone());
    let script = Script { name, docs, span: item.name.span, steps, study };
    Some((graph, script))
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
