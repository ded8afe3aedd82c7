//! Arguments and results of nodes.

use crate::{
    marks::{FAILURE, marked, unit},
    param::{ParamDecl, param},
    types::{is_named, wrapped},
};
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{
    Attribute, Expr, ExprLit, Field, FnArg, GenericParam, Generics, Ident, ItemFn, ItemStruct, Lit, Pat, ReturnType,
    Signature, Type, spanned::Spanned,
};

/// Arguments and returned value of a `process` function or a slot.
pub struct Callable {
    /// The arguments in order, without `self`.
    pub args: Vec<Arg>,
    /// The returned value.
    pub returns: Returns,
    /// Names of the const parameters that stand for a number of inputs. The graph determines their values.
    pub counts: Vec<String>,
}

/// One argument.
pub struct Arg {
    /// Name, which is also that of the port or parameter.
    pub name: String,
    /// Role.
    pub form: Form,
    /// Unit of the tokens: `#[unit("m")]`.
    pub unit: Option<String>,
}

/// Role of an argument.
pub enum Form {
    /// `&T`, `Option<&T>`, `&[T; 4]`, or `[&T; N]` and `[Option<&T>; N]` for any number of inputs.
    Input(InputForm),
    /// `&mut Out<T>` or `&mut Out<[T; N]>`.
    Out(Token),
    /// `Event<T>`, and `true` if it is marked `#[failure]`.
    Event(Type, bool),
    /// `&Ctx`.
    Ctx,
    /// A parameter of a function node.
    Param(Box<ParamDecl>),
}

/// An input argument.
pub struct InputForm {
    /// The token.
    pub token: Token,
    /// `Option<&T>`: ⊥ reaches the node as `None`.
    pub optional: bool,
    /// Const parameter that stands for the number of inputs, if the argument takes any number of them.
    pub count: Option<syn::Ident>,
}

/// The tokens of one firing at a port.
pub struct Token {
    /// The type of one token.
    pub ty: Type,
    /// Number of tokens per firing; `None` is one token, not in an array.
    pub batch: Option<usize>,
}

/// The returned value of `process`.
#[derive(Default)]
pub struct Returns {
    /// The token of the output `out`, unless nothing is returned.
    pub token: Option<Token>,
    /// `Option<…>`: may be ⊥.
    pub maybe: bool,
    /// `Result<…, E>`: may fail.
    pub fallible: bool,
    /// Unit of the tokens: `#[unit("m")]` before the function.
    pub unit: Option<String>,
}

/// The interface of a function node.
pub fn function(item: &ItemFn) -> syn::Result<Callable> {
    let callable = callable(&item.sig, &item.attrs)?;
    let is_silence = |arg: &&Arg| matches!(&arg.form, Form::Param(decl) if decl.is_silence);
    match callable.args.iter().find(is_silence) {
        Some(arg) => {
            let message = format!("only a parameter of a struct can be its `silence`: make `{}` a field", arg.name);
            Err(syn::Error::new(item.sig.ident.span(), message))
        }
        None => Ok(callable),
    }
}

/// The parameters of a struct node, with their names and fields.
pub fn params(item: &ItemStruct) -> syn::Result<Vec<(&Ident, &Field, ParamDecl)>> {
    let mut params: Vec<(&Ident, &Field, ParamDecl)> = Vec::new();
    for field in &item.fields {
        if let Some(decl) = param(&field.attrs, &field.ty)? {
            let Some(name) = &field.ident else {
                return Err(syn::Error::new(field.span(), "a parameter needs a name: use a struct with named fields"));
            };
            if decl.is_silence && params.iter().any(|(.., other)| other.is_silence) {
                return Err(syn::Error::new(
                    field.span(),
                    "a node has one `silence`: that of another parameter is enough",
                ));
            }
            params.push((name, field, decl));
        }
    }
    Ok(params)
}

/// The generics of a function node: those of the function without the numbers of its inputs.
pub fn generics(item: &ItemFn, callable: &Callable) -> Generics {
    let is_count = |param: &GenericParam| matches!(param, GenericParam::Const(c) if callable.counts.contains(&c.ident.to_string()));
    let params = item.sig.generics.params.iter().filter(|param| !is_count(param)).cloned().collect();
    Generics { params, ..item.sig.generics.clone() }
}

pub fn callable(sig: &Signature, attrs: &[Attribute]) -> syn::Result<Callable> {
    if let Some(token) = &sig.asyncness {
        return Err(syn::Error::new(token.span(), "a node runs to completion and cannot be `async`"));
    }
    if let syn::Safety::Unsafe(token) = &sig.safety {
        return Err(syn::Error::new(token.span(), "a node is called by safe code: use `unsafe` only inside it"));
    }
    if let Some(lifetime) = sig.generics.lifetimes().next() {
        return Err(syn::Error::new(lifetime.span(), "a node takes tokens by plain references: remove the lifetime"));
    }
    let mut args = Vec::new();
    for arg in &sig.inputs {
        let FnArg::Typed(arg) = arg else { continue };
        let Pat::Ident(name) = &*arg.pat else {
            return Err(syn::Error::new_spanned(
                &arg.pat,
                "the name of an argument is the name of its port: write a plain name instead of a pattern",
            ));
        };
        let form = match param(&arg.attrs, &arg.ty)? {
            Some(decl) => Form::Param(Box::new(decl)),
            None => match (form(&arg.ty)?, marked(&arg.attrs, FAILURE)) {
                (Form::Event(ty, _), fails) => Form::Event(ty, fails),
                (form, false) => form,
                (_, true) => {
                    return Err(syn::Error::new_spanned(
                        &arg.ty,
                        "only an event can be marked `#[failure]`: `Event<T>`",
                    ));
                }
            },
        };
        let name = name.ident.to_string();
        let name = name.strip_prefix("r#").unwrap_or(&name);
        let unit = unit(&arg.attrs)?;
        if unit.is_some() && matches!(form, Form::Ctx | Form::Param(_)) {
            let message = "only a port has a `#[unit]`; that of a parameter is `#[param(unit = \"m\")]`";
            return Err(syn::Error::new_spanned(&arg.pat, message));
        }
        args.push(Arg { name: name.strip_prefix('_').unwrap_or(name).to_owned(), form, unit });
    }
    let counts = counts(sig, &args)?;
    let returns = Returns { unit: unit(attrs)?, ..returns(&sig.output)? };
    if returns.unit.is_some() && returns.token.is_none() {
        return Err(syn::Error::new(sig.ident.span(), "`#[unit]` before a function is that of the returned value"));
    }
    Ok(Callable { args, returns, counts })
}

/// The const parameters that stand for numbers of inputs. The number is known only where the node is called, so that no
/// type of a port may depend on it.
fn counts(sig: &Signature, args: &[Arg]) -> syn::Result<Vec<String>> {
    let mut counts: Vec<String> = vec![];
    let of = |arg: &Arg| if let Form::Input(input) = &arg.form { input.count.clone() } else { None };
    for count in args.iter().filter_map(of) {
        let name = count.to_string();
        if sig.generics.const_params().all(|param| param.ident != count) {
            let message = format!(
                "an array of references takes any number of inputs, and its length is a const parameter of the function: \
                 `fn {}<const N: usize>(…: [Option<&T>; N])`",
                sig.ident
            );
            return Err(syn::Error::new(count.span(), message));
        }
        let inputs = sig.inputs.iter().map(ToTokens::to_token_stream);
        let types = inputs.chain([sig.output.to_token_stream(), sig.generics.where_clause.to_token_stream()]);
        if types.map(|tokens| mentions(tokens, &name)).sum::<usize>() > 1 {
            let message = format!("`{name}` is the number of connected inputs: no other type can depend on it");
            return Err(syn::Error::new(count.span(), message));
        }
        counts.push(name);
    }
    Ok(counts)
}

/// Number of times that `name` occurs in `tokens`.
fn mentions(tokens: TokenStream, name: &str) -> usize {
    let count = |token| match token {
        TokenTree::Ident(ident) => usize::from(ident == name),
        TokenTree::Group(group) => mentions(group.stream(), name),
        _ => 0,
    };
    tokens.into_iter().map(count).sum()
}

fn form(ty: &Type) -> syn::Result<Form> {
    match ty {
        Type::Reference(reference) if reference.mutability.is_some() => match wrapped(&reference.elem, "Out") {
            Some(inner) => Ok(Form::Out(token(inner)?)),
            None => Err(syn::Error::new_spanned(ty, "`&mut` is only for outputs: `&mut Out<T>`")),
        },
        Type::Reference(reference) if is_named(&reference.elem, "Ctx") => Ok(Form::Ctx),
        Type::Reference(reference) => {
            Ok(Form::Input(InputForm { token: token(&reference.elem)?, optional: false, count: None }))
        }
        _ => {
            if let Some(input) = optional_or_many(ty)? {
                return Ok(Form::Input(input));
            }
            if let Some(inner) = wrapped(ty, "Event") {
                return Ok(Form::Event(inner.clone(), false));
            }
            Err(syn::Error::new_spanned(
                ty,
                "an argument of a node is an input `&T`, `Option<&T>`, `&[T; 4]` or `[Option<&T>; N]`, an output `&mut Out<T>`, an event `Event<T>`, \
                 `&Ctx`, or a parameter marked `#[param]`",
            ))
        }
    }
}

/// `Option<&T>`, `[&T; N]` and `[Option<&T>; N]`.
fn optional_or_many(ty: &Type) -> syn::Result<Option<InputForm>> {
    let (element, length) = match ty {
        Type::Array(array) => (&*array.elem, Some(&array.len)),
        _ => (ty, None),
    };
    let (reference, optional) = match wrapped(element, "Option") {
        Some(inner) => (inner, true),
        None => (element, false),
    };
    let Type::Reference(reference) = reference else { return Ok(None) };
    let count = match length {
        None => None,
        Some(Expr::Path(path)) if path.path.get_ident().is_some() => path.path.get_ident().cloned(),
        Some(length) => {
            let message = "an array of references takes any number of inputs: write its length as a const parameter of \
                           the function, `const N: usize`";
            return Err(syn::Error::new(length.span(), message));
        }
    };
    check_named(&reference.elem)?;
    Ok(Some(InputForm { token: Token { ty: (*reference.elem).clone(), batch: None }, optional, count }))
}

fn token(ty: &Type) -> syn::Result<Token> {
    let Type::Array(array) = ty else {
        return Ok(Token { ty: ty.clone(), batch: None });
    };
    let batch = match &array.len {
        Expr::Lit(ExprLit { lit: Lit::Int(n), .. }) => n.base10_parse::<usize>().ok().filter(|&n| n > 1),
        _ => None,
    };
    match batch {
        Some(n) => Ok(Token { ty: (*array.elem).clone(), batch: Some(n) }),
        None => Err(syn::Error::new(
            array.len.span(),
            "an array at a port means several tokens per firing: write its length as a literal greater than 1 (to pass an array as one token, wrap it in a type)",
        )),
    }
}

fn returns(output: &ReturnType) -> syn::Result<Returns> {
    let ReturnType::Type(_, ty) = output else { return Ok(Returns::default()) };
    let (fallible, ty) = match wrapped(ty, "Result") {
        Some(ok) => (true, ok),
        None => (false, &**ty),
    };
    let (maybe, ty) = match wrapped(ty, "Option") {
        Some(some) => (true, some),
        None => (false, ty),
    };
    // What lives as long as the program is a value as any other.
    let is_static = |reference: &syn::TypeReference| reference.lifetime.as_ref().is_some_and(|l| l.ident == "static");
    if let Type::Reference(reference) = ty
        && !is_static(reference)
    {
        return Err(syn::Error::new_spanned(
            reference,
            "a node sends values: return `T`, or write into a `&mut Out<T>`",
        ));
    }
    check_named(ty)?;
    let is_unit = matches!(ty, Type::Tuple(t) if t.elems.is_empty());
    let token = if is_unit { None } else { Some(token(ty)?) };
    Ok(Returns { token, maybe, fallible, unit: None })
}

/// Checks that a type of tokens has a name, by which generated code keeps the token.
fn check_named(ty: &Type) -> syn::Result<()> {
    match ty {
        Type::ImplTrait(_) => Err(syn::Error::new_spanned(
            ty,
            "a token has a type with a name, and `impl` stands for one without: write the type, or `Box<dyn …>`",
        )),
        _ => Ok(()),
    }
}
