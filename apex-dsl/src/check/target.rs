//! Nodes that need more than the target offers: the crate that contains the program may lack a heap or the standard
//! library.

use crate::{
    catalog::{Catalog, Need},
    graph::{Graph, NodeKind},
    report::{Diagnostic, Diagnostics},
};

/// Reports nodes whose needs the crate does not meet.
pub fn check_target(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    let Some(lacks) = catalog.lacks() else { return };
    for node in &graph.nodes {
        let NodeKind::Library(library) = &node.kind else { continue };
        let signature = &catalog.signatures[library.signature];
        let Some((need, why)) = signature.needs.as_ref().filter(|(need, _)| *need >= lacks) else { continue };
        let (needs, without, remedy) = match need {
            Need::Heap => (
                "a heap",
                "`#![no_std]` without `extern crate alloc`",
                "use a node with collections of fixed size, such as those of `heapless`",
            ),
            Need::Std => (
                "the standard library",
                "`#![no_std]`",
                "use a node whose crate is `#![no_std]`, or do its work outside of the program and feed in the result",
            ),
        };
        let message = format!("`{}` needs {needs}, but this crate is {without}", node.name);
        let declared =
            format!("`{}` is declared at {}:{}; {why}", signature.name, signature.file.display(), signature.line);
        diagnostics.push(Diagnostic::error("target", node.span, message).note(declared).note(remedy));
    }
}
