//! Interface of a node, read from Rust syntax. `#[node]` and the catalog of the compiler share this crate, so that a
//! signature has the same meaning for both.

pub mod fraction;
mod param;
pub mod units;

pub use param::ParamDecl;

use param::param;
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{
    Attribute, Expr, ExprLit, Field, FnArg, GenericArgument, GenericParam, Generics, ImplItem, ItemFn, ItemImpl,
    ItemStruct, Lit, Pat, PathArguments, ReturnType, Signature, Type, spanned::Spanned,
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

/// The methods of an `#[node] impl` that matter to graphs.
#[derive(Default)]
pub struct Methods {
    /// `process`.
    pub process: Option<Callable>,
    /// Methods marked `#[slot]`: name, documentation, token (`()` if none is taken).
    pub slots: Vec<Slot>,
    /// The method marked `#[no_message]`: called instead of `process` when a mandatory input holds ⊥.
    pub no_message: Option<String>,
    /// The method marked `#[on_activate]`: called when the node becomes active.
    pub on_activate: Option<String>,
    /// The method marked `#[on_deactivate]`: called when the node is no longer active.
    pub on_deactivate: Option<String>,
    /// The method marked `#[on_stop]`: called when the program ends, for whatever reason.
    pub on_stop: Option<String>,
}

/// A method marked `#[slot]`.
pub struct Slot {
    /// Name of the port.
    pub name: String,
    /// Type of the token; `None` for a slot that takes no value.
    pub token: Option<Type>,
    /// Unit of the token.
    pub unit: Option<String>,
    /// Documentation.
    pub docs: String,
    /// All arguments in order: the token, events and the context.
    pub args: Vec<Arg>,
    /// `Result<(), E>`: may fail.
    pub fallible: bool,
}

/// Names of the attributes that mark methods of a node.
pub const METHOD_MARKS: [&str; 5] = ["slot", "no_message", "on_activate", "on_deactivate", "on_stop"];
/// The attribute that marks an event of failure.
pub const FAILURE: &str = "failure";
/// The attribute with the unit of the tokens of a port.
pub const UNIT: &str = "unit";
/// The attribute that marks a struct whose events take activity away instead of passing it on.
pub const DEACTIVATES: &str = "deactivates";
/// The attribute that marks a node that sends its tokens in the frame of those that it takes.
pub const KEEPS_FRAME: &str = "keeps_frame";
/// The attribute that marks a node whose tokens follow from its slots, its parameters and the time: nothing in them
/// comes from outside of the program, although it may fire without inputs.
pub const COMPUTED: &str = "computed";

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

/// The parameters of a struct node, by field.
pub fn params(item: &ItemStruct) -> syn::Result<Vec<(&Field, ParamDecl)>> {
    let mut params: Vec<(&Field, ParamDecl)> = Vec::new();
    for field in &item.fields {
        if let Some(decl) = param(&field.attrs, &field.ty)? {
            if field.ident.is_none() {
                return Err(syn::Error::new(field.span(), "a parameter needs a name: use a struct with named fields"));
            }
            if decl.is_silence && params.iter().any(|(_, other)| other.is_silence) {
                return Err(syn::Error::new(
                    field.span(),
                    "a node has one `silence`: that of another parameter is enough",
                ));
            }
            params.push((field, decl));
        }
    }
    Ok(params)
}

/// The methods of a struct node.
pub fn methods(item: &ItemImpl) -> syn::Result<Methods> {
    let mut methods = Methods::default();
    for item in &item.items {
        let ImplItem::Fn(method) = item else { continue };
        if method.sig.ident == "process" {
            methods.process = Some(callable(&method.sig, &method.attrs)?);
        } else if marked(&method.attrs, "slot") {
            methods.slots.push(slot(method)?);
        } else if let Some(mark) = METHOD_MARKS.iter().find(|mark| marked(&method.attrs, mark)) {
            check_hook(&method.sig, mark)?;
            let place = match *mark {
                "on_activate" => &mut methods.on_activate,
                "on_deactivate" => &mut methods.on_deactivate,
                "on_stop" => &mut methods.on_stop,
                _ => &mut methods.no_message,
            };
            if let Some(other) = place {
                let message = format!("a node has one `#[{mark}]` method, and `{other}` is it already");
                return Err(syn::Error::new_spanned(&method.sig.ident, message));
            }
            *place = Some(method.sig.ident.to_string());
        }
    }
    let mut known: Vec<(&str, String)> = vec![];
    for (name, ty) in methods.events() {
        let text = ty.to_token_stream().to_string();
        if known.iter().any(|(other, token)| *other == name && *token != text) {
            return Err(syn::Error::new_spanned(
                ty,
                format!("the event `{name}` has different types in different methods"),
            ));
        }
        known.push((name, text));
    }
    Ok(methods)
}

impl Methods {
    /// The events of all methods with the types of their tokens; one that several methods may trigger comes
    /// several times.
    pub fn events(&self) -> impl Iterator<Item = (&str, &Type)> {
        let args = self.process.iter().flat_map(|p| &p.args).chain(self.slots.iter().flat_map(|s| &s.args));
        args.filter_map(|arg| if let Form::Event(ty, _) = &arg.form { Some((arg.name.as_str(), ty)) } else { None })
    }
}

/// The generics of a function node: those of the function without the numbers of its inputs.
pub fn generics(item: &ItemFn, callable: &Callable) -> Generics {
    let is_count = |param: &GenericParam| matches!(param, GenericParam::Const(c) if callable.counts.contains(&c.ident.to_string()));
    let params = item.sig.generics.params.iter().filter(|param| !is_count(param)).cloned().collect();
    Generics { params, ..item.sig.generics.clone() }
}

/// Returns `true` if `attrs` contain `#[node]`, also by its path.
pub fn is_node(attrs: &[Attribute]) -> bool {
    attrs.iter().any(|a| {
        let segments = &a.path().segments;
        segments.last().is_some_and(|s| s.ident == "node") && (segments.len() == 1 || segments[0].ident == "apex_rt")
    })
}

/// Returns `true` if `attrs` contain `#[name]`.
pub fn marked(attrs: &[Attribute], name: &str) -> bool {
    attrs.iter().any(|a| a.path().is_ident(name))
}

/// The text of the `///` comments.
pub fn docs(attrs: &[Attribute]) -> String {
    let lines: Vec<String> = attrs
        .iter()
        .filter(|a| a.path().is_ident("doc"))
        .filter_map(|a| match &a.meta {
            syn::Meta::NameValue(nv) => match &nv.value {
                Expr::Lit(ExprLit { lit: Lit::Str(s), .. }) => Some(unindented(&s.value())),
                _ => None,
            },
            _ => None,
        })
        .collect();
    lines.join("\n")
}

/// Without the blank that all lines begin with; further ones mean something in Markdown.
fn unindented(line: &str) -> String {
    line.strip_prefix(' ').unwrap_or(line).trim_end().to_owned()
}

/// Checks a method that is called at a certain moment: nothing goes into it, and what it would return has no way out.
fn check_hook(sig: &syn::Signature, mark: &str) -> syn::Result<()> {
    if sig.inputs.len() != 1 || sig.receiver().is_none() {
        let message = format!("a `#[{mark}]` method takes `&mut self` and nothing else");
        return Err(syn::Error::new_spanned(&sig.inputs, message));
    }
    let returns_nothing = match &sig.output {
        syn::ReturnType::Default => true,
        syn::ReturnType::Type(_, ty) => matches!(&**ty, Type::Tuple(tuple) if tuple.elems.is_empty()),
    };
    if returns_nothing {
        return Ok(());
    }
    let instead = match mark {
        "no_message" => "to send something for ⊥, take the input as `Option<&T>` in `process`",
        _ => "keep it in a field, and send it in `process`",
    };
    let message = format!("a `#[{mark}]` method returns nothing: its value would be dropped; {instead}");
    Err(syn::Error::new_spanned(&sig.output, message))
}

fn slot(method: &syn::ImplItemFn) -> syn::Result<Slot> {
    let callable = callable(&method.sig, &method.attrs)?;
    if callable.returns.token.is_some() {
        return Err(syn::Error::new_spanned(
            &method.sig.output,
            "a slot returns nothing (or `Result<(), E>` if it may fail); send its result over an event",
        ));
    }
    let (mut token, mut unit) = (None, None);
    for (arg, syntax) in callable.args.iter().zip(method.sig.inputs.iter().skip(1)) {
        match &arg.form {
            Form::Input(InputForm { token: taken, optional: false, count: None })
                if token.is_none() && taken.batch.is_none() =>
            {
                token = Some(taken.ty.clone());
                unit.clone_from(&arg.unit);
            }
            Form::Event(..) | Form::Ctx => {}
            _ => {
                return Err(syn::Error::new_spanned(
                    syntax,
                    "a slot takes at most one token `&T`, besides events and `&Ctx`",
                ));
            }
        }
    }
    let fallible = callable.returns.fallible;
    let name = method.sig.ident.to_string();
    let name = name.strip_prefix("r#").unwrap_or(&name).to_owned();
    Ok(Slot { name, token, unit, docs: docs(&method.attrs), args: callable.args, fallible })
}

fn callable(sig: &Signature, attrs: &[Attribute]) -> syn::Result<Callable> {
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

/// The error type `E` of a function that returns `Result<T, E>`.
pub fn error_type(output: &ReturnType) -> Option<&Type> {
    let ReturnType::Type(_, ty) = output else { return None };
    argument(ty, "Result", 1)
}

/// `T` of `Name<T, …>`.
fn wrapped<'a>(ty: &'a Type, name: &str) -> Option<&'a Type> {
    argument(ty, name, 0)
}

/// An argument of `Name<T, E, …>`, by its place.
fn argument<'a>(ty: &'a Type, name: &str, place: usize) -> Option<&'a Type> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last().filter(|last| last.ident == name)?;
    let PathArguments::AngleBracketed(args) = &last.arguments else { return None };
    match args.args.iter().nth(place)? {
        GenericArgument::Type(inner) => Some(inner),
        _ => None,
    }
}

fn is_named(ty: &Type, name: &str) -> bool {
    matches!(ty, Type::Path(path) if path.path.segments.last().is_some_and(|s| s.ident == name))
}

/// The unit in `#[unit("m")]`.
pub fn unit(attrs: &[Attribute]) -> syn::Result<Option<String>> {
    let unit = attrs.iter().find(|a| a.path().is_ident(UNIT));
    unit.map(|attr| attr.parse_args::<syn::LitStr>().map(|unit| unit.value())).transpose()
}

/// `T` of `Option<T>`.
pub fn option_of(ty: &Type) -> Option<&Type> {
    wrapped(ty, "Option")
}
