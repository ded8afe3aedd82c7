//! Places of ports and parameters in the Rust source of a node. The catalog knows only the line of the node; its parts
//! are searched on demand.

use apex_dsl::syntax::tree::PortKind;
use apex_signature::marked;
use proc_macro2::Span;
use std::ops::Range;
use syn::{
    FnArg, ImplItem, ImplItemFn, Item, ItemImpl, ItemStruct, Pat, ReturnType, Signature, Type, spanned::Spanned as _,
};

/// A part of a declaration in Rust.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Part {
    /// The name of a node or type.
    Name(String),
    /// The argument, method or returned type that a port stands for.
    Port(PortKind, String),
    /// The field or argument that a parameter stands for.
    Param(String),
}

/// The bytes of a `part` of the declaration in `line` (from 1) of a Rust file. The beginning of the line if the part is
/// not found, because the file may have changed since the catalog was read.
pub fn place_in_rust(text: &str, line: usize, part: &Part) -> Range<usize> {
    let start = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum::<usize>();
    let in_line = |name: &str| {
        let at = start + text[start..].lines().next()?.find(name)?;
        Some(at..at + name.len())
    };
    let found = match part {
        Part::Name(name) => in_line(name),
        Part::Port(..) | Part::Param(_) => parsed(text, line, part),
    };
    found.filter(|range| text.get(range.clone()).is_some()).unwrap_or(start..start)
}

fn parsed(text: &str, line: usize, part: &Part) -> Option<Range<usize>> {
    let found = in_items(&syn::parse_file(text).ok()?.items, line, part).map(|span| span.byte_range());
    // proc_macro2 would keep the text of every parsed file for its spans.
    proc_macro2::extra::invalidate_current_thread_spans();
    found
}

fn in_items(items: &[Item], line: usize, part: &Part) -> Option<Span> {
    let is_here = |span: Span| span.start().line == line;
    items.iter().find_map(|item| match item {
        Item::Mod(module) => in_items(&module.content.as_ref()?.1, line, part),
        Item::Fn(function_node) if is_here(function_node.sig.ident.span()) => match part {
            Part::Port(kind, name) => in_call(&function_node.sig, *kind, name),
            Part::Param(name) => argument(&function_node.sig, name),
            Part::Name(_) => None,
        },
        Item::Struct(node) if is_here(node.ident.span()) => in_struct(node, items, part),
        _ => None,
    })
}

/// A part of a struct node: a field, or a part of one of its `impl` blocks in the same module.
fn in_struct(node: &ItemStruct, module: &[Item], part: &Part) -> Option<Span> {
    let is_its = |block: &&ItemImpl| {
        let named =
            |ty: &Type| matches!(ty, Type::Path(p) if p.path.segments.last().is_some_and(|s| s.ident == node.ident));
        marked(&block.attrs, "node") && named(&block.self_ty)
    };
    match part {
        Part::Param(name) => {
            let mut names = node.fields.iter().filter_map(|field| field.ident.as_ref());
            names.find(|ident| *ident == name).map(|ident| ident.span())
        }
        Part::Port(kind, name) => {
            let blocks = module.iter().filter_map(|item| if let Item::Impl(block) = item { Some(block) } else { None });
            blocks.filter(is_its).find_map(|block| in_impl(block, *kind, name))
        }
        Part::Name(_) => None,
    }
}

fn in_impl(block: &ItemImpl, kind: PortKind, name: &str) -> Option<Span> {
    let functions =
        || block.items.iter().filter_map(|i| if let ImplItem::Fn(method) = i { Some(method) } else { None });
    let is_slot = |attrs: &[syn::Attribute]| marked(attrs, "slot");
    if kind == PortKind::Slot {
        let slot = functions().find(|m| is_slot(&m.attrs) && m.sig.ident == name);
        return slot.map(|m| m.sig.ident.span());
    }
    let called = |m: &&ImplItemFn| m.sig.ident == "process" || is_slot(&m.attrs);
    functions().filter(called).find_map(|m| in_call(&m.sig, kind, name))
}

/// The argument of a port, or the type that is returned.
fn in_call(signature: &Signature, kind: PortKind, name: &str) -> Option<Span> {
    let returned = || match &signature.output {
        ReturnType::Type(_, ty) if kind == PortKind::Output => Some(ty.span()),
        _ => None,
    };
    argument(signature, name).or_else(returned)
}

fn argument(signature: &Signature, name: &str) -> Option<Span> {
    signature.inputs.iter().find_map(|input| match input {
        FnArg::Typed(typed) => match &*typed.pat {
            // A leading `_` marks an argument that the node does not read.
            Pat::Ident(ident) if ident.ident == name || ident.ident == format!("_{name}") => Some(ident.ident.span()),
            _ => None,
        },
        FnArg::Receiver(_) => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "mod inner {
    #[node]
    pub struct Ü {
        #[param(unit = \"m\")]
        gap: f64,
    }
    impl Ü { fn process(&mut self, scan: &u8) {} }
    #[node]
    impl Ü {
        pub fn process(&mut self, scan: &Scan, _rest: Option<&u8>, far: &mut Out<u8>) -> Option<u16> { None }
        #[slot]
        fn go(&mut self, x: &u8, done: Event<()>) {}
        fn scan(&self) {}
    }
}
#[node]
fn add(a: &u64, #[param] b: u64) -> u64 { a + b }
";

    #[test]
    fn ports_and_parameters() {
        let at = |line, part| {
            let range = place_in_rust(SOURCE, line, &part);
            let before = &SOURCE[..range.start];
            (&SOURCE[range], before.matches('\n').count() + 1)
        };
        let port = |kind, name: &str| Part::Port(kind, name.to_owned());
        assert_eq!(at(3, Part::Param("gap".to_owned())), ("gap", 5));
        assert_eq!(at(3, port(PortKind::Input, "scan")), ("scan", 10));
        assert_eq!(at(3, port(PortKind::Input, "rest")), ("_rest", 10));
        assert_eq!(at(3, port(PortKind::Output, "far")), ("far", 10));
        assert_eq!(at(3, port(PortKind::Output, "out")), ("Option<u16>", 10));
        assert_eq!(at(3, port(PortKind::Slot, "go")), ("go", 12));
        assert_eq!(at(3, port(PortKind::Event, "done")), ("done", 12));
        assert_eq!(at(3, Part::Name("Ü".to_owned())), ("Ü", 3));
        assert_eq!(at(17, port(PortKind::Input, "a")), ("a", 17));
        assert_eq!(at(17, Part::Param("b".to_owned())), ("b", 17));
        assert_eq!(at(17, port(PortKind::Output, "out")), ("u64", 17));
        // The file has changed: the line, or its end.
        assert_eq!(at(1, port(PortKind::Input, "a")), ("", 1));
        assert_eq!(at(99, Part::Param("a".to_owned())), ("", 18));
    }
}
