//! One Rust file as the catalog sees it: modules, imports, types and node signatures. This is what is
//! cached between runs, so it holds no syntax tree and knows nothing of other files.

use super::{signature, ty::Ty};
use quote::ToTokens as _;
use serde::{Deserialize, Serialize};
use syn::{Attribute, Item as Syn, UseTree, Visibility, spanned::Spanned};

/// An item that matters.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Item {
    /// Name in its module; empty for an `impl` or a glob import.
    pub name: String,
    /// Whether it is `pub`.
    pub public: bool,
    /// Line of its name, from 1.
    pub line: usize,
    /// Conditions (`#[cfg(…)]`) as tokens.
    pub cfg: Vec<String>,
    /// What it is.
    pub kind: ItemKind,
}

/// What an item is.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum ItemKind {
    /// `mod name;` with its `#[path]`, or `mod name { … }`.
    Module(Option<String>, Option<Vec<Item>>),
    /// `use path as name`.
    Import(Vec<String>),
    /// `use path::*`.
    Glob(Vec<String>),
    /// A struct, enum or union; with its fields if it derives `Outputs`.
    Type(Option<Vec<OutputField>>),
    /// `type name = …`; `None` if it is generic.
    Alias(Option<Ty>),
    /// A function node.
    Function(NodeItem),
    /// A struct node; its methods come with [`ItemKind::Methods`].
    Struct(NodeItem),
    /// `#[node] impl Name`.
    Methods(NodeMethods),
    /// `#![no_std]`; with a condition, the crate can also do without the standard library.
    NoStd {
        /// There is no condition.
        always: bool,
    },
    /// `extern crate name`
    Extern,
    /// A macro call whose tokens hold `#[node]`: its nodes cannot be seen.
    Hidden,
    /// What is wrong with a file that is no Rust: nothing in it can be seen.
    Broken(String),
}

/// A field of a `#[derive(Outputs)]` struct.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct OutputField {
    /// Name of the port.
    pub name: String,
    /// Type of its tokens.
    pub ty: Ty,
    /// `Option<T>`: may be ⊥.
    pub maybe: bool,
    /// Documentation.
    pub docs: String,
}

/// The declaration of a node.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct NodeItem {
    /// Documentation.
    pub docs: String,
    /// Type parameters and constants, in order.
    pub generics: Vec<String>,
    /// Parameters.
    pub params: Vec<ParamItem>,
    /// Whether it has state between firings.
    pub stateful: bool,
    /// The types of its state.
    pub state: Vec<Ty>,
    /// Whether its events take activity away.
    pub deactivates: bool,
    /// The signature of a function node.
    pub process: Option<Process>,
}

/// The methods of a struct node.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct NodeMethods {
    /// Name of the struct.
    pub node: String,
    /// The type arguments as named in the `impl`, in the order of the struct's parameters.
    pub generics: Vec<Ty>,
    /// `process`.
    pub process: Option<Process>,
    /// Slots: name, token, documentation.
    pub slots: Vec<SlotItem>,
    /// Its `#[no_message]` method.
    pub no_message: Option<String>,
    /// Its `#[on_activate]` method.
    pub on_activate: Option<String>,
    /// Its `#[on_deactivate]` method.
    pub on_deactivate: Option<String>,
}

/// A slot.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SlotItem {
    /// Name.
    pub name: String,
    /// Type of its tokens.
    pub ty: Ty,
    /// Documentation.
    pub docs: String,
    /// Arguments in order: the token as an input, events, the context.
    pub args: Vec<ArgItem>,
    /// `Result`: may fail.
    pub fallible: bool,
}

/// The signature of `process`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Process {
    /// Arguments in order.
    pub args: Vec<ArgItem>,
    /// Type and tokens per firing of the returned value.
    pub returns: Option<(Ty, Option<usize>)>,
    /// `Option`: may be ⊥.
    pub maybe: bool,
    /// `Result`: may fail.
    pub fallible: bool,
}

/// An argument of `process`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ArgItem {
    /// Name of the port or parameter.
    pub name: String,
    /// What it is.
    pub kind: ArgKind,
}

/// What an argument is.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum ArgKind {
    /// `&T`, `&[T; N]`
    Input(Ty, Option<usize>),
    /// `Option<&T>`
    Optional(Ty),
    /// `&mut Out<T>`
    Out(Ty, Option<usize>),
    /// `Event<T>`
    Event(Ty),
    /// `&Ctx`
    Ctx,
    /// The parameter with this number.
    Param(usize),
}

/// A parameter.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ParamItem {
    /// Name.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// Type of its value.
    pub ty: Ty,
    /// Unit of plain numbers.
    pub unit: Option<String>,
    /// The value where a text gives none.
    pub default: Option<Default>,
    /// Smallest and largest value, and whether the largest belongs to it.
    pub range: Option<(Option<f64>, Option<f64>, bool)>,
}

/// The default of a parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Default {
    /// A literal.
    Literal(Literal),
    /// An expression that only rustc can evaluate.
    Rust,
}

/// A literal of Rust.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Literal {
    /// A number; the flag says whether it was written as an integer.
    Number(f64, bool),
    /// `true`, `false`
    Bool(bool),
    /// A string
    Text(String),
}

/// Reads the items of one file.
pub fn read(text: &str) -> Vec<Item> {
    match syn::parse_file(text) {
        Ok(file) => file.attrs.iter().filter_map(no_std).chain(items(&file.items)).collect(),
        Err(error) => {
            let kind = ItemKind::Broken(error.to_string());
            vec![entry(String::new(), &Visibility::Inherited, &[], error.span(), kind)]
        }
    }
}

/// `#![no_std]`, `#![cfg_attr(…, no_std)]`
fn no_std(attr: &Attribute) -> Option<Item> {
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
                let content = m.content.as_ref().map(|(_, inner)| items(inner));
                list.push(entry(
                    m.ident.to_string(),
                    &m.vis,
                    &m.attrs,
                    m.ident.span(),
                    ItemKind::Module(path, content),
                ));
            }
            Syn::Use(u) => imports(&u.tree, &mut vec![], &mut |name, kind| {
                list.push(entry(name, &u.vis, &u.attrs, u.span(), kind));
            }),
            Syn::ExternCrate(e) => {
                list.push(entry(e.ident.to_string(), &e.vis, &e.attrs, e.ident.span(), ItemKind::Extern))
            }
            Syn::Struct(s) => structure(s, &mut list),
            Syn::Enum(e) => {
                list.push(entry(e.ident.to_string(), &e.vis, &e.attrs, e.ident.span(), ItemKind::Type(None)))
            }
            Syn::Union(u) => {
                list.push(entry(u.ident.to_string(), &u.vis, &u.attrs, u.ident.span(), ItemKind::Type(None)))
            }
            Syn::Type(t) => {
                let target = t.generics.params.is_empty().then(|| Ty::from_syn(&t.ty));
                list.push(entry(t.ident.to_string(), &t.vis, &t.attrs, t.ident.span(), ItemKind::Alias(target)));
            }
            Syn::Fn(f) if signature::marked(&f.attrs, "node") => {
                if let Ok(callable) = signature::function(f) {
                    let kind = ItemKind::Function(function(f, &callable));
                    list.push(entry(f.sig.ident.to_string(), &f.vis, &f.attrs, f.sig.ident.span(), kind));
                }
            }
            Syn::Impl(i) if signature::marked(&i.attrs, "node") => {
                if let Some(methods) = methods(i) {
                    list.push(entry(
                        String::new(),
                        &Visibility::Inherited,
                        &i.attrs,
                        i.span(),
                        ItemKind::Methods(methods),
                    ));
                }
            }
            Syn::Macro(m) if m.mac.tokens.to_string().replace(' ', "").contains("#[node]") => {
                list.push(entry(String::new(), &Visibility::Inherited, &m.attrs, m.span(), ItemKind::Hidden));
            }
            _ => {}
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
    Item { name, public: matches!(vis, Visibility::Public(_)), line: span.start().line, cfg, kind }
}

fn path_value(attr: &Attribute) -> Option<String> {
    match &attr.meta.require_name_value().ok()?.value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(path), .. }) => Some(path.value()),
        _ => None,
    }
}

fn imports(tree: &UseTree, prefix: &mut Vec<String>, found: &mut impl FnMut(String, ItemKind)) {
    match tree {
        UseTree::Path(path) => {
            prefix.push(path.ident.to_string());
            imports(&path.tree, prefix, found);
            prefix.pop();
        }
        UseTree::Name(name) if name.ident == "self" => {
            found(prefix.last().cloned().unwrap_or_default(), ItemKind::Import(prefix.clone()));
        }
        UseTree::Name(name) => {
            let name = name.ident.to_string();
            let path = prefix.iter().cloned().chain([name.clone()]).collect();
            found(name, ItemKind::Import(path));
        }
        UseTree::Rename(rename) => {
            let path = prefix.iter().cloned().chain([rename.ident.to_string()]).collect();
            found(rename.rename.to_string(), ItemKind::Import(path));
        }
        UseTree::Glob(_) => found(String::new(), ItemKind::Glob(prefix.clone())),
        UseTree::Group(group) => group.items.iter().for_each(|tree| imports(tree, prefix, found)),
    }
}

fn structure(item: &syn::ItemStruct, list: &mut Vec<Item>) {
    let name = item.ident.to_string();
    let span = item.ident.span();
    let derives_outputs = item
        .attrs
        .iter()
        .filter(|a| a.path().is_ident("derive"))
        .any(|a| a.to_token_stream().to_string().split(|c: char| !c.is_alphanumeric()).any(|w| w == "Outputs"));
    let fields = derives_outputs.then(|| item.fields.iter().map(output_field).collect());
    list.push(entry(name.clone(), &item.vis, &item.attrs, span, ItemKind::Type(fields)));
    if !signature::marked(&item.attrs, "node") {
        return;
    }
    let Ok(declared) = signature::params(item) else { return };
    let params = declared
        .iter()
        .map(|(field, decl)| {
            let name = field.ident.as_ref().map(ToString::to_string).unwrap_or_default();
            param(name, signature::docs(&field.attrs), decl)
        })
        .collect();
    let node = NodeItem {
        docs: signature::docs(&item.attrs),
        generics: generics(&item.generics),
        stateful: item.fields.len() > declared.len(),
        state: item
            .fields
            .iter()
            .filter(|field| !declared.iter().any(|(param, _)| param.ident == field.ident))
            .map(|field| Ty::from_syn(&field.ty))
            .collect(),
        deactivates: signature::marked(&item.attrs, signature::DEACTIVATES),
        params,
        process: None,
    };
    list.push(entry(name, &item.vis, &item.attrs, span, ItemKind::Struct(node)));
}

fn output_field(field: &syn::Field) -> OutputField {
    let inner = signature::option_of(&field.ty);
    OutputField {
        name: field.ident.as_ref().map(ToString::to_string).unwrap_or_default(),
        ty: Ty::from_syn(inner.unwrap_or(&field.ty)),
        maybe: inner.is_some(),
        docs: signature::docs(&field.attrs),
    }
}

fn generics(generics: &syn::Generics) -> Vec<String> {
    generics
        .params
        .iter()
        .filter_map(|p| match p {
            syn::GenericParam::Type(t) => Some(t.ident.to_string()),
            syn::GenericParam::Const(c) => Some(c.ident.to_string()),
            syn::GenericParam::Lifetime(_) => None,
        })
        .collect()
}

fn param(name: String, docs: String, decl: &signature::ParamDecl) -> ParamItem {
    let bound = |e: &Option<Box<syn::Expr>>| match e.as_deref().and_then(literal) {
        Some(Literal::Number(value, _)) => Some(value),
        _ => None,
    };
    ParamItem {
        name,
        docs,
        ty: Ty::from_syn(&decl.ty),
        unit: decl.unit.clone(),
        default: decl.default.as_ref().map(|expr| literal(expr).map_or(Default::Rust, Default::Literal)),
        range: decl
            .range
            .as_ref()
            .map(|r| (bound(&r.start), bound(&r.end), matches!(r.limits, syn::RangeLimits::Closed(_)))),
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
        generics: generics(&item.sig.generics),
        params,
        stateful: false,
        state: vec![],
        deactivates: false,
        process: Some(process(callable)),
    }
}

fn methods(item: &syn::ItemImpl) -> Option<NodeMethods> {
    let Ty::Path(path, args) = Ty::from_syn(&item.self_ty) else { return None };
    let methods = signature::methods(item).ok()?;
    let slots = methods
        .slots
        .iter()
        .map(|slot| SlotItem {
            name: slot.name.clone(),
            ty: slot.token.as_ref().map_or_else(Ty::unit, Ty::from_syn),
            docs: slot.docs.clone(),
            args: arguments(&slot.args),
            fallible: slot.fallible,
        })
        .collect();
    Some(NodeMethods {
        node: path.last()?.clone(),
        generics: args,
        process: methods.process.as_ref().map(process),
        slots,
        no_message: methods.no_message,
        on_activate: methods.on_activate,
        on_deactivate: methods.on_deactivate,
    })
}

fn process(callable: &signature::Callable) -> Process {
    let returns = callable.returns.token.as_ref().map(|t| (Ty::from_syn(&t.ty), t.batch));
    let args = arguments(&callable.args);
    Process { args, returns, maybe: callable.returns.maybe, fallible: callable.returns.fallible }
}

fn arguments(args: &[signature::Arg]) -> Vec<ArgItem> {
    use signature::Form;
    let mut params = 0;
    args.iter()
        .map(|arg| {
            let kind = match &arg.form {
                Form::Input(input) if input.optional => ArgKind::Optional(Ty::from_syn(&input.token.ty)),
                Form::Input(input) => ArgKind::Input(Ty::from_syn(&input.token.ty), input.token.batch),
                Form::Out(token) => ArgKind::Out(Ty::from_syn(&token.ty), token.batch),
                Form::Event(ty) => ArgKind::Event(Ty::from_syn(ty)),
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
