//! Reading of the items of a Rust file.

use super::{
    impls::{derived, implemented},
    items::{
        ArgItem, ArgKind, Default, FieldItem, Item, ItemKind, Literal, NodeItem, NodeMethods, OutputField, ParamItem,
        Process, Seen, SlotItem, TypeItem,
    },
    rust::{arguments_of, bounds, generics, is_cfg, numbers_of, path_value, plain, unraw},
    ty::Ty,
};
use apex_signature as signature;
use quote::ToTokens as _;
use syn::{Attribute, Item as Syn, UseTree, Visibility, spanned::Spanned};

/// Reads the items of one file.
pub fn read(text: &str) -> Vec<Item> {
    if let Some(line) = too_deep(text) {
        let kind = ItemKind::Broken(format!("brackets are nested more than {MAX_DEPTH} levels deep"));
        return vec![Item { name: String::new(), seen: Seen::InModule, line, cfg: vec![], kind }];
    }
    match syn::parse_file(text) {
        Ok(file) => file.attrs.iter().filter_map(of_crate).chain(items(&file.items)).collect(),
        Err(error) => {
            let kind = ItemKind::Broken(error.to_string());
            vec![entry(String::new(), &Visibility::Inherited, &[], error.span(), kind)]
        }
    }
}

/// Largest depth of nested brackets: syn calls itself for each level.
const MAX_DEPTH: usize = 128;

/// Line in which brackets nest too deep for syn. `<` may be an operator, so it counts only up to the next `;` or brace.
fn too_deep(text: &str) -> Option<usize> {
    let (mut depth, mut angles) = (0usize, 0usize);
    let mut before = ' ';
    for (line, content) in text.lines().enumerate() {
        for c in content.chars() {
            match c {
                '(' | '[' => depth += 1,
                '{' => (depth, angles) = (depth + 1, 0),
                ')' | ']' => depth = depth.saturating_sub(1),
                '}' => (depth, angles) = (depth.saturating_sub(1), 0),
                ';' => angles = 0,
                '<' => angles += 1,
                '>' if before != '-' && before != '=' => angles = angles.saturating_sub(1),
                _ => {}
            }
            if depth + angles > MAX_DEPTH {
                return Some(line + 1);
            }
            before = c;
        }
    }
    None
}

/// `#![no_std]`, `#![cfg_attr(…, no_std)]`, `#![no_implicit_prelude]`
fn of_crate(attr: &Attribute) -> Option<Item> {
    if attr.path().is_ident("no_implicit_prelude") {
        return Some(entry(String::new(), &Visibility::Inherited, &[], attr.span(), ItemKind::NoPrelude));
    }
    let always = attr.path().is_ident("no_std");
    let conditional = attr.path().is_ident("cfg_attr") && attr.meta.to_token_stream().to_string().contains("no_std");
    let mark = entry(String::new(), &Visibility::Inherited, &[], attr.span(), ItemKind::NoStd { always });
    (always || conditional).then_some(mark)
}

fn items(syntax: &[Syn]) -> Vec<Item> {
    let mut list = Vec::new();
    for item in syntax {
        match item {
            Syn::Mod(m) => {
                let path = m.attrs.iter().find(|a| a.path().is_ident("path")).and_then(path_value);
                let kind = match &m.content {
                    Some((braces, inner)) => ItemKind::Module(items(inner), braces.span.close().end().line),
                    None => ItemKind::ModuleFile(path),
                };
                list.push(entry(m.ident.to_string(), &m.vis, &m.attrs, m.ident.span(), kind));
            }
            Syn::Use(u) => imports(&u.tree, &mut vec![], &mut |name, kind| {
                list.push(entry(name, &u.vis, &u.attrs, u.span(), kind));
            }),
            Syn::ExternCrate(e) => {
                list.push(entry(e.ident.to_string(), &e.vis, &e.attrs, e.ident.span(), ItemKind::Extern))
            }
            Syn::Struct(s) => structure(s, &mut list),
            Syn::Enum(e) => {
                let variants = e.variants.iter().filter(|v| v.fields.is_empty() && v.attrs.iter().all(|a| !is_cfg(a)));
                let values = variants.map(|v| v.ident.to_string()).collect();
                let (arguments, traits) = (arguments_of(&e.generics), derived(&e.attrs));
                let numbers = numbers_of(&e.generics);
                let kind = ItemKind::Type(TypeItem { arguments, numbers, values, traits, ..TypeItem::default() });
                list.push(entry(e.ident.to_string(), &e.vis, &e.attrs, e.ident.span(), kind))
            }
            Syn::Union(u) => {
                let kind = ItemKind::Type(TypeItem {
                    arguments: arguments_of(&u.generics),
                    numbers: numbers_of(&u.generics),
                    ..TypeItem::default()
                });
                list.push(entry(u.ident.to_string(), &u.vis, &u.attrs, u.ident.span(), kind))
            }
            Syn::Const(c) => {
                let kind = ItemKind::Constant(Ty::from_syn(&c.ty));
                list.push(entry(c.ident.to_string(), &c.vis, &c.attrs, c.ident.span(), kind));
            }
            Syn::Static(s) => {
                let kind = ItemKind::Constant(Ty::from_syn(&s.ty));
                list.push(entry(s.ident.to_string(), &s.vis, &s.attrs, s.ident.span(), kind));
            }
            Syn::Type(t) => {
                let target = t.generics.params.is_empty().then(|| Ty::from_syn(&t.ty));
                list.push(entry(t.ident.to_string(), &t.vis, &t.attrs, t.ident.span(), ItemKind::Alias(target)));
            }
            Syn::Fn(f) if signature::is_node(&f.attrs) => {
                let kind = match signature::function(f) {
                    Ok(callable) => ItemKind::Function(function(f, &callable)),
                    Err(error) => ItemKind::Refused(error.to_string()),
                };
                list.push(entry(f.sig.ident.to_string(), &f.vis, &f.attrs, f.sig.ident.span(), kind));
            }
            Syn::Impl(i) => implementation(i, &mut list),
            Syn::Macro(m) => list.push(macro_call(m)),
            _ => {}
        }
    }
    for (name, given) in implemented(syntax) {
        for item in list.iter_mut().filter(|item| item.name == name) {
            if let ItemKind::Type(ty) = &mut item.kind {
                ty.traits.push(given.clone());
            }
        }
    }
    list
}

fn entry(name: String, vis: &Visibility, attrs: &[Attribute], span: proc_macro2::Span, kind: ItemKind) -> Item {
    let cfg = attrs
        .iter()
        .filter(|a| a.path().is_ident("cfg"))
        .filter_map(|a| a.parse_args::<proc_macro2::TokenStream>().ok())
        .map(|tokens| tokens.to_string())
        .collect();
    Item { name: unraw(name), seen: seen(vis), line: span.start().line, cfg, kind }
}

fn seen(vis: &Visibility) -> Seen {
    match vis {
        Visibility::Public(_) => Seen::Everywhere,
        Visibility::Restricted(within) if within.path.is_ident("crate") => Seen::InCrate,
        Visibility::Restricted(within) if within.path.is_ident("self") => Seen::InModule,
        Visibility::Restricted(within) => Seen::Within(within.path.segments.iter().map(|s| plain(&s.ident)).collect()),
        Visibility::Inherited => Seen::InModule,
    }
}

/// Adds the items of an `impl`: the methods of a node, or constants.
fn implementation(item: &syn::ItemImpl, list: &mut Vec<Item>) {
    let plain = |kind| entry(String::new(), &Visibility::Inherited, &item.attrs, item.span(), kind);
    let Ty::Path(path, _) = Ty::from_syn(&item.self_ty) else { return };
    let Some(name) = path.last() else { return };
    if signature::is_node(&item.attrs) {
        match methods(item, name) {
            Ok(methods) => list.push(plain(ItemKind::Methods(methods))),
            Err(error) => list.push(Item { name: name.clone(), ..plain(ItemKind::Refused(error.to_string())) }),
        }
    }
    let constants = item.items.iter().filter_map(|item| match item {
        syn::ImplItem::Const(c) if matches!(c.vis, Visibility::Public(_)) => {
            Some((c.ident.to_string(), Ty::from_syn(&c.ty)))
        }
        _ => None,
    });
    let constants: Vec<(String, Ty)> = constants.collect();
    if item.trait_.is_none() && !constants.is_empty() {
        list.push(plain(ItemKind::Constants(name.clone(), constants)));
    }
}

fn macro_call(call: &syn::ItemMacro) -> Item {
    let is_graph = call.mac.path.segments.last().is_some_and(|s| s.ident == "graph");
    let file = is_graph.then(|| call.mac.parse_body::<syn::LitStr>().ok()).flatten();
    let kind = match file {
        Some(file) => ItemKind::Call(file.value()),
        // A graph makes nodes, but a source file cannot name them.
        None if is_graph => ItemKind::Call(String::new()),
        None => ItemKind::Macro(call.mac.tokens.to_string().replace(' ', "").contains("#[node]")),
    };
    entry(String::new(), &Visibility::Inherited, &call.attrs, call.span(), kind)
}

fn imports(tree: &UseTree, prefix: &mut Vec<String>, found: &mut impl FnMut(String, ItemKind)) {
    match tree {
        UseTree::Path(path) => {
            prefix.push(plain(&path.ident));
            imports(&path.tree, prefix, found);
            prefix.pop();
        }
        UseTree::Name(name) if name.ident == "self" => {
            // Without a path before it, rustc reports it.
            if let Some(name) = prefix.last() {
                found(name.clone(), ItemKind::Import(prefix.clone()));
            }
        }
        UseTree::Name(name) => {
            let name = plain(&name.ident);
            let path = prefix.iter().cloned().chain([name.clone()]).collect();
            found(name, ItemKind::Import(path));
        }
        UseTree::Rename(rename) => {
            let path = prefix.iter().cloned().chain([plain(&rename.ident)]).collect();
            found(plain(&rename.rename), ItemKind::Import(path));
        }
        UseTree::Glob(_) => found(String::new(), ItemKind::Glob(prefix.clone())),
        UseTree::Group(group) => group.items.iter().for_each(|tree| imports(tree, prefix, found)),
    }
}

fn structure(item: &syn::ItemStruct, list: &mut Vec<Item>) {
    let name = item.ident.to_string();
    let span = item.ident.span();
    let traits = derived(&item.attrs);
    let outputs =
        traits.iter().any(|of| of.name == "Outputs").then(|| item.fields.iter().filter_map(output_field).collect());
    let values = if matches!(item.fields, syn::Fields::Unit) { vec![String::new()] } else { vec![] };
    let (arguments, numbers) = (arguments_of(&item.generics), numbers_of(&item.generics));
    let (generics_of, fields) = (generics(&item.generics), fields(item));
    let ty = TypeItem { outputs, arguments, numbers, values, traits, generics: generics_of, fields };
    list.push(entry(name.clone(), &item.vis, &item.attrs, span, ItemKind::Type(ty)));
    if !signature::is_node(&item.attrs) {
        return;
    }
    let declared = match signature::params(item) {
        Ok(declared) => declared,
        Err(error) => {
            return list.push(entry(name, &item.vis, &item.attrs, span, ItemKind::Refused(error.to_string())));
        }
    };
    let params =
        declared.iter().map(|(name, field, decl)| param(plain(name), signature::docs(&field.attrs), decl)).collect();
    let node = NodeItem {
        docs: signature::docs(&item.attrs),
        generics: generics(&item.generics),
        bounds: bounds(&item.generics),
        stateful: item.fields.len() > declared.len(),
        state: item
            .fields
            .iter()
            .filter(|field| !declared.iter().any(|(name, ..)| Some(*name) == field.ident.as_ref()))
            .map(|field| Ty::from_syn(&field.ty))
            .collect(),
        deactivates: signature::marked(&item.attrs, signature::DEACTIVATES),
        computed: signature::marked(&item.attrs, signature::COMPUTED),
        keeps_frame: signature::marked(&item.attrs, signature::KEEPS_FRAME),
        params,
        process: None,
    };
    list.push(entry(name, &item.vis, &item.attrs, span, ItemKind::Struct(node)));
}

/// The fields of a struct that can be written as a value.
fn fields(item: &syn::ItemStruct) -> Option<Vec<FieldItem>> {
    let syn::Fields::Named(named) = &item.fields else { return None };
    let has = |attrs: &[Attribute], name: &str| attrs.iter().any(|attr| attr.path().is_ident(name));
    if has(&item.attrs, "non_exhaustive") || named.named.iter().any(|field| has(&field.attrs, "cfg")) {
        return None;
    }
    let field = |field: &syn::Field| {
        let name = plain(field.ident.as_ref()?);
        Some(FieldItem { name, seen: seen(&field.vis), ty: measured(&field.ty, field) })
    };
    named.named.iter().map(field).collect()
}

/// A port of a struct with `derive(Outputs)`, which reports a field without a name.
fn output_field(field: &syn::Field) -> Option<OutputField> {
    let name = plain(field.ident.as_ref()?);
    let inner = signature::option_of(&field.ty);
    let ty = measured(inner.unwrap_or(&field.ty), field);
    Some(OutputField { name, ty, maybe: inner.is_some(), docs: signature::docs(&field.attrs) })
}

/// A type with the unit of a field. The attribute macros report a wrong one, which is none here.
fn measured(ty: &syn::Type, field: &syn::Field) -> Ty {
    Ty::from_syn(ty).measured(signature::unit(&field.attrs).ok().flatten())
}

fn param(name: String, docs: String, decl: &signature::ParamDecl) -> ParamItem {
    ParamItem {
        name,
        docs,
        ty: Ty::from_syn(&decl.ty),
        unit: decl.unit.clone(),
        default: decl.default.as_ref().map(|expr| literal(expr).map_or(Default::Rust, Default::Literal)),
        range: decl.limits(),
        is_silence: decl.is_silence,
    }
}

fn literal(expr: &syn::Expr) -> Option<Literal> {
    match expr {
        syn::Expr::Lit(lit) => match &lit.lit {
            syn::Lit::Int(n) => n.base10_parse::<f64>().ok().map(|v| Literal::Number(v, true)),
            syn::Lit::Float(n) => n.base10_parse::<f64>().ok().map(|v| Literal::Number(v, false)),
            syn::Lit::Bool(b) => Some(Literal::Bool(b.value)),
            syn::Lit::Str(s) => Some(Literal::Text(s.value())),
            _ => None,
        },
        syn::Expr::Unary(syn::ExprUnary { op: syn::UnOp::Neg(_), expr, .. }) => match literal(expr)? {
            Literal::Number(value, integer) => Some(Literal::Number(-value, integer)),
            _ => None,
        },
        _ => None,
    }
}

fn function(item: &syn::ItemFn, callable: &signature::Callable) -> NodeItem {
    let mut params = Vec::new();
    for arg in &callable.args {
        if let signature::Form::Param(decl) = &arg.form {
            params.push(param(arg.name.clone(), String::new(), decl));
        }
    }
    let docs = signature::docs(&item.attrs);
    NodeItem {
        docs,
        generics: generics(&signature::generics(item, callable)),
        bounds: bounds(&item.sig.generics),
        params,
        stateful: false,
        state: vec![],
        deactivates: false,
        computed: signature::marked(&item.attrs, signature::COMPUTED),
        keeps_frame: signature::marked(&item.attrs, signature::KEEPS_FRAME),
        process: Some(process(callable)),
    }
}

fn methods(item: &syn::ItemImpl, name: &str) -> syn::Result<NodeMethods> {
    let args = if let Ty::Path(_, args) = Ty::from_syn(&item.self_ty) { args } else { vec![] };
    let methods = signature::methods(item)?;
    let slots = methods
        .slots
        .iter()
        .map(|slot| SlotItem {
            name: slot.name.clone(),
            ty: slot.token.as_ref().map_or_else(Ty::unit, Ty::from_syn).measured(slot.unit.clone()),
            docs: slot.docs.clone(),
            args: arguments(&slot.args),
            fallible: slot.fallible,
        })
        .collect();
    Ok(NodeMethods {
        node: name.to_owned(),
        generics: args,
        bounds: bounds(&item.generics),
        process: methods.process.as_ref().map(process),
        slots,
        no_message: methods.no_message,
        on_activate: methods.on_activate,
        on_deactivate: methods.on_deactivate,
        on_stop: methods.on_stop,
    })
}

fn process(callable: &signature::Callable) -> Process {
    let unit = &callable.returns.unit;
    let returns = callable.returns.token.as_ref().map(|t| (Ty::from_syn(&t.ty).measured(unit.clone()), t.batch));
    let args = arguments(&callable.args);
    Process { args, returns, maybe: callable.returns.maybe, fallible: callable.returns.fallible }
}

fn arguments(args: &[signature::Arg]) -> Vec<ArgItem> {
    use signature::Form;
    let mut params = 0;
    args.iter()
        .map(|arg| {
            let token = |ty: &syn::Type| Ty::from_syn(ty).measured(arg.unit.clone());
            let kind = match &arg.form {
                Form::Input(input) if input.count.is_some() => ArgKind::Many(token(&input.token.ty), input.optional),
                Form::Input(input) if input.optional => ArgKind::Optional(token(&input.token.ty)),
                Form::Input(input) => ArgKind::Input(token(&input.token.ty), input.token.batch),
                Form::Out(written) => ArgKind::Out(token(&written.ty), written.batch),
                Form::Event(ty, fails) => ArgKind::Event(token(ty), *fails),
                Form::Ctx => ArgKind::Ctx,
                Form::Param(_) => {
                    params += 1;
                    ArgKind::Param(params - 1)
                }
            };
            ArgItem { name: arg.name.clone(), kind }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cached_item_is_the_same() {
        let text = "#[node] fn n(#[param] a: u8, #[param(default = 1)] b: u8, #[param(default = f())] c: u8) {}";
        let items = read(text);
        let json = serde_json::to_string(&items).unwrap();
        let back: Vec<Item> = serde_json::from_str(&json).unwrap();
        assert_eq!(format!("{items:?}"), format!("{back:?}"));
    }
}
