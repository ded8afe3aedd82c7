//! The `impl` block of a node.

use crate::{
    callable::{Arg, Callable, Form, InputForm, callable},
    marks::{METHOD_MARKS, docs, marked},
};
use quote::ToTokens as _;
use syn::{ImplItem, ItemImpl, Type};

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
