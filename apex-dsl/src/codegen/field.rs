//! Fields of the state of a program.

use super::structs::around_text;
use proc_macro2::TokenStream;
use quote::quote;
use syn::Ident;

/// A field of the state of a program.
pub struct StateField {
    /// Purpose of the field.
    pub kind: Kind,
    /// To what of the text it belongs: of a list, each element.
    pub of: Vec<String>,
    /// It is a list.
    pub is_list: bool,
    /// Its name in the struct.
    pub name: Ident,
    ty: TokenStream,
    make: TokenStream,
}

/// Purpose of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Tokens that outlive a firing, or that a node writes in place.
    Token,
    /// Timers of sources, and the times for which nodes have been active.
    Timer,
    /// Activity of nodes and tokens, and enabled nodes.
    Activity,
    /// Times at which the sources of tokens fired.
    Stamp,
    /// Broken claims.
    Claim,
    /// Data of the dispatcher: bits, the queue of slots.
    Dispatcher,
}

impl StateField {
    /// A field of type `ty` that starts as `make`.
    pub fn new(kind: Kind, of: String, name: Ident, ty: TokenStream, make: TokenStream) -> Self {
        Self { kind, of: vec![of], is_list: false, name, ty, make }
    }

    /// A field that has an element for each of `of`.
    pub const fn list(kind: Kind, of: Vec<String>, name: Ident, ty: TokenStream, make: TokenStream) -> Self {
        Self { kind, of, is_list: true, name, ty, make }
    }

    /// The places in the state that it consists of, with what they belong to.
    pub fn places(&self) -> impl Iterator<Item = (String, &str)> {
        let name = format!("{}.{}", if self.is_core() { "core" } else { "state" }, self.name);
        self.of.iter().enumerate().map(move |(index, of)| match self.is_list {
            true => (format!("{name}[{index}]"), of.as_str()),
            false => (name.clone(), of.as_str()),
        })
    }

    /// Returns `true` if it belongs to the core, which the functions of the runtime work on. Tokens do not: they may be
    /// borrowed meanwhile.
    pub fn is_core(&self) -> bool {
        const CORE: [&str; 12] = [
            "active",
            "agenda",
            "carries",
            "dispatcher",
            "enabled",
            "gains",
            "loses",
            "queue",
            "silences",
            "stamps",
            "timeouts",
            "timers",
        ];
        CORE.iter().any(|name| self.name == name)
    }
}

/// A field of a struct: its declaration, and the expression with its initial value.
type Declared = (TokenStream, TokenStream);

/// Fields of a struct of such fields.
pub fn fields<'a>(kept: impl IntoIterator<Item = &'a StateField>) -> Vec<Declared> {
    let inner = around_text();
    let field = |StateField { name, ty, make, .. }: &StateField| (quote!(#inner #name: #ty), quote!(#name: #make));
    kept.into_iter().map(field).collect()
}
