//! The Rust module of a text: each state machine, program and test has a module of its own in it, so that names of the
//! text meet neither each other nor those of the Rust around the call of `graph!`.

use super::{machine, names::item, programs::program, tokens::ident};
use crate::{
    catalog::Catalog,
    checked::CheckedProgram,
    graph::{Graph, Library, NodeKind},
    machine::{Machine, Machines},
    report::Diagnostics,
    source::{FileId, Sources, Span},
};
use proc_macro2::{Group, Literal, TokenStream, TokenTree};
use quote::{format_ident, quote};
use std::path::Path;
use syn::Ident;

/// A name by which Rust reaches something of a text.
struct Export {
    /// The module.
    module: Ident,
    /// The item in it.
    item: Ident,
    /// The name in the Rust around.
    name: String,
}

/// Rust for the text that was read first: its machines, programs and tests, and their names.
pub fn text(
    programs: &[CheckedProgram],
    machines: &Machines,
    catalog: &Catalog,
    sources: &Sources,
    place: &dyn Fn(Span) -> proc_macro2::Span,
    recordable: bool,
    diagnostics: &mut Diagnostics,
) -> TokenStream {
    let machines: Vec<&Machine> = machines.values().collect();
    let modules = machines.iter().map(|m| module(&ident(&m.module), &m.name, machine::item(m, catalog)));
    let programs_of = programs.iter().map(|p| {
        let code = program(p, catalog, sources, place, recordable, diagnostics);
        if p.is_test() { code } else { module(&graph_module(&p.graph.name), &p.graph.name, code) }
    });
    let graphs = programs.iter().filter(|p| !p.is_test()).map(|p| &p.graph);
    let own = machines.iter().filter(|m| m.is_own);
    let names = graphs.flat_map(exports).chain(own.flat_map(|m| machine_exports(m)));
    let source = sources.get(FileId(0));
    let around = ident(&module_name(&source.path, source.origin.0 + 1));
    let uses = names.map(|Export { module, item, name }| {
        let name = ident(&name);
        let alias = (item != name).then(|| quote!(as #name));
        quote! { #[allow(unused_imports)] pub use #around::#module::#item #alias; }
    });
    quote! {
        #[doc(hidden)]
        #[allow(unused, deprecated, clippy::all, missing_docs, private_interfaces, non_snake_case, non_camel_case_types, unreachable_pub, unnameable_types)]
        pub mod #around { use ::core::prelude::rust_2024::*; #(#modules)* #(#programs_of)* }
        #(#uses)*
    }
}

/// A module that sees what every module sees, also where the crate around it does not. The runtime is called `rt` in
/// it, and types that every module sees need no path, unless something of the text has such a name.
pub fn module(name: &Ident, graph: &str, items: TokenStream) -> TokenStream {
    let short = Short { except: graph };
    let alias = short.may_be_called(RUNTIME).then(|| quote! { use ::apex_rt as rt; });
    let items = short.code(items);
    quote! { pub mod #name { use ::core::prelude::rust_2024::*; use ::apex_rt::{Observer as _, Wired as _}; #alias #items } }
}

/// Name of the runtime in the module of a program.
const RUNTIME: &str = "rt";

/// Paths that are left out before a name: every module sees what is called so.
const SEEN: [[&str; 2]; 2] = [["core", "option"], ["core", "primitive"]];

/// Shorter code with the same meaning.
struct Short<'a> {
    /// A name that means something else.
    except: &'a str,
}

impl Short<'_> {
    fn may_be_called(&self, name: &str) -> bool {
        self.except != name
    }

    /// `rt` instead of `::apex_rt`, `f32` instead of `::core::primitive::f32`, and numbers without the suffix `usize`,
    /// which the types around them say.
    fn code(&self, code: TokenStream) -> TokenStream {
        let mut short: Vec<TokenTree> = vec![];
        for token in code {
            match token {
                TokenTree::Group(group) => {
                    let (delimiter, span, stream) = (group.delimiter(), group.span(), group.stream());
                    // The tokens are moved, as nothing else holds them.
                    drop(group);
                    let mut inner = Group::new(delimiter, self.code(stream));
                    inner.set_span(span);
                    short.push(inner.into());
                }
                TokenTree::Ident(name) => {
                    let name = self.name(name, &mut short);
                    short.push(name.into());
                }
                TokenTree::Literal(literal) => short.push(plain(literal).into()),
                token => short.push(token),
            }
        }
        short.into_iter().collect()
    }

    /// A name after `before`, from which a path is removed that it does not need.
    fn name(&self, name: Ident, before: &mut Vec<TokenTree>) -> Ident {
        if name == "apex_rt" && self.may_be_called(RUNTIME) && begins_path(before) {
            before.truncate(before.len() - 2);
            return Ident::new(RUNTIME, name.span());
        }
        // `::core::option::` are eight tokens.
        let Some(path) = before.len().checked_sub(8) else { return name };
        let is_seen = SEEN.iter().any(|modules| is_path(&before[path..], modules));
        if is_seen && begins_path(&before[..path + 2]) && self.may_be_called(&name.to_string()) {
            before.truncate(path);
        }
        name
    }
}

/// Returns `true` if these tokens are `::first::second::`.
fn is_path(tokens: &[TokenTree], modules: &[&str; 2]) -> bool {
    let is = |at: usize, module: &str| matches!(&tokens[at], TokenTree::Ident(name) if name == module);
    is(2, modules[0]) && is(5, modules[1]) && [0, 3, 6].iter().all(|at| is_colons(&tokens[*at..at + 2]))
}

/// A number of type `usize` without its suffix.
fn plain(literal: Literal) -> Literal {
    let number = literal.to_string().strip_suffix("usize").and_then(|digits| digits.parse().ok());
    let Some(number) = number else { return literal };
    let mut plain = Literal::usize_unsuffixed(number);
    plain.set_span(literal.span());
    plain
}

/// Returns `true` if a path begins here: `::` without a name before it.
fn begins_path(tokens: &[TokenTree]) -> bool {
    let goes_on = |name: &Ident| !["as", "dyn", "impl", "in", "mut", "return", "use"].iter().any(|word| name == word);
    let Some(before) = tokens.len().checked_sub(2) else { return false };
    let after_name = matches!(tokens[..before].last(), Some(TokenTree::Ident(name)) if goes_on(name));
    is_colons(&tokens[before..]) && !after_name
}

fn is_colons(tokens: &[TokenTree]) -> bool {
    tokens.iter().all(|token| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ':'))
}

/// The names that a program has in Rust.
fn exports(graph: &Graph) -> Vec<Export> {
    let is_handed_in = |kind: &NodeKind| matches!(kind, NodeKind::Library(Library { handed_in: true, .. }));
    let export = |item, name| Export { module: graph_module(&graph.name), item, name };
    let program = export(ident(&graph.name), graph.name.clone());
    let has_parts = graph.nodes.iter().any(|n| is_handed_in(&n.kind));
    let parts = has_parts.then(|| export(item(graph, None, "Parts"), format!("{}Parts", graph.name)));
    [Some(program), parts].into_iter().flatten().collect()
}

/// The names that a state machine has in Rust.
fn machine_exports(machine: &Machine) -> [Export; 2] {
    let export = |item, name| Export { module: ident(&machine.module), item, name };
    let (name, states) = (ident(&machine.name), machine::states_name(machine));
    [export(name, machine.name.clone()), export(states, format!("{}State", machine.name))]
}

fn graph_module(name: &str) -> Ident {
    format_ident!("graph_{name}")
}

/// The module of a text in Rust: `mission_afg` for `mission.afg`; a text inside a call of `graph!` has the line of the
/// call.
pub fn module_name(path: &Path, line: usize) -> String {
    let is_file = path.extension().is_some_and(|e| e == "afg");
    let name = match path.file_stem() {
        Some(stem) if is_file => stem.to_string_lossy().into_owned(),
        _ => format!("graph_in_line_{line}"),
    };
    let name: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let digit = if name.starts_with(|c: char| c.is_ascii_digit()) { "_" } else { "" };
    if is_file { format!("{digit}{name}_afg") } else { name }
}
