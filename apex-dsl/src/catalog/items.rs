//! Items of one Rust file that matter to the catalog: modules, imports, types and node signatures. They are cached
//! between runs, and so contain no syntax trees and do not depend on other files.

use super::{impls::TraitOf, ty::Ty};
use serde::{Deserialize, Serialize};

/// Smallest and largest value of a parameter, and `true` if the largest is included.
pub type Limits = (Option<f64>, Option<f64>, bool);

/// An item that matters to the catalog.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Item {
    /// Name in its module; empty for an `impl` or a glob import.
    pub name: String,
    /// Visibility.
    pub seen: Seen,
    /// Line of its name, from 1.
    pub line: usize,
    /// Conditions (`#[cfg(…)]`) as tokens.
    pub cfg: Vec<String>,
    /// Kind of the item.
    pub kind: ItemKind,
}

/// Visibility of an item.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Seen {
    /// `pub`
    Everywhere,
    /// `pub(crate)`
    InCrate,
    /// `pub(super)`, `pub(in path)`
    Within(Vec<String>),
    /// Private: visible in its own module and those inside.
    InModule,
}

/// Kind of an item.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum ItemKind {
    /// `mod name;` with its `#[path]`.
    ModuleFile(Option<String>),
    /// `mod name { … }` with its items and its last line.
    Module(Vec<Item>, usize),
    /// `use path as name`.
    Import(Vec<String>),
    /// `use path::*`.
    Glob(Vec<String>),
    /// A struct, enum or union.
    Type(TypeItem),
    /// `type name = …`; `None` if it is generic.
    Alias(Option<Ty>),
    /// `const` or `static`, of this type.
    Constant(Ty),
    /// The constants in an `impl` of this type.
    Constants(String, Vec<(String, Ty)>),
    /// A function node.
    Function(NodeItem),
    /// A struct node; its methods come with [`ItemKind::Methods`].
    Struct(NodeItem),
    /// `#[node] impl Name`.
    Methods(NodeMethods),
    /// `#![no_implicit_prelude]`
    NoPrelude,
    /// `#![no_std]`, possibly with a condition.
    NoStd {
        /// `true` without a condition.
        always: bool,
    },
    /// `extern crate name`
    Extern,
    /// An item that is marked `#[node]` but is not a node, and the reason.
    Refused(String),
    /// `graph!("…")`; empty if the graph is in the call.
    Call(String),
    /// A macro call, whose items the scan does not see. `true` if its tokens contain `#[node]`.
    Macro(bool),
    /// The error of a file that cannot be parsed. None of its items are known.
    Broken(String),
}

/// A struct, enum or union.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct TypeItem {
    /// Its fields, if it derives `Outputs`.
    pub outputs: Option<Vec<OutputField>>,
    /// Smallest and largest number of type arguments.
    pub arguments: (usize, usize),
    /// Positions of the type arguments that are numbers.
    pub numbers: Vec<usize>,
    /// Variants without fields of an enum. A struct without fields counts as a variant with an empty name.
    pub values: Vec<String>,
    /// Its traits, as far as they are derived or implemented beside it.
    pub traits: Vec<TraitOf>,
    /// Names of its type parameters and constants.
    pub generics: Vec<String>,
    /// The fields of a struct, if source files can write it as a value: all of them have names, and exist always.
    pub fields: Option<Vec<FieldItem>>,
}

/// A field of a struct.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FieldItem {
    /// Name.
    pub name: String,
    /// Visibility.
    pub seen: Seen,
    /// Type, with the unit of `#[unit("m")]`.
    pub ty: Ty,
}

/// A field of a `#[derive(Outputs)]` struct.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct OutputField {
    /// Name of the port.
    pub name: String,
    /// Type of its tokens.
    pub ty: Ty,
    /// `true` for `Option<T>`: the token may be ⊥.
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
    /// `true` if the node has state.
    pub stateful: bool,
    /// Types of its state.
    pub state: Vec<Ty>,
    /// Bounds of its type parameters, as written: `T: Add<Output = T>`.
    pub bounds: Vec<String>,
    /// `true` if its tokens take activity away.
    pub deactivates: bool,
    /// `true` if nothing in its tokens comes from outside.
    pub computed: bool,
    /// `true` if all its tokens are in the same frame.
    pub keeps_frame: bool,
    /// The signature of a function node.
    pub process: Option<Process>,
}

/// The methods of a struct node.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct NodeMethods {
    /// Name of the struct.
    pub node: String,
    /// Type arguments as named in the `impl`, in the order of the struct's parameters.
    pub generics: Vec<Ty>,
    /// Bounds of the type parameters of the `impl`.
    pub bounds: Vec<String>,
    /// `process`.
    pub process: Option<Process>,
    /// Slots.
    pub slots: Vec<SlotItem>,
    /// `#[no_message]` method.
    pub no_message: Option<String>,
    /// `#[on_activate]` method.
    pub on_activate: Option<String>,
    /// `#[on_deactivate]` method.
    pub on_deactivate: Option<String>,
    /// `#[on_stop]` method.
    pub on_stop: Option<String>,
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
    /// `true` for a `Result`: the method may fail.
    pub fallible: bool,
}

/// The signature of `process`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Process {
    /// Arguments in order.
    pub args: Vec<ArgItem>,
    /// Type and tokens per firing of the returned value.
    pub returns: Option<(Ty, Option<usize>)>,
    /// `true` for an `Option`: the value may be ⊥.
    pub maybe: bool,
    /// `true` for a `Result`: `process` may fail.
    pub fallible: bool,
}

/// An argument of `process` or of a slot.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ArgItem {
    /// Name of the port or parameter.
    pub name: String,
    /// Kind of the argument.
    pub kind: ArgKind,
}

/// Kind of an argument.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum ArgKind {
    /// `&T`, `&[T; N]`
    Input(Ty, Option<usize>),
    /// `Option<&T>`
    Optional(Ty),
    /// `[&T; N]`, `[Option<&T>; N]`: any number of inputs, and `true` if they are optional.
    Many(Ty, bool),
    /// `&mut Out<T>`
    Out(Ty, Option<usize>),
    /// `Event<T>`, and `true` if it reports a failure.
    Event(Ty, bool),
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
    /// Value of instances without an argument for it.
    pub default: Option<Default>,
    /// Its range.
    pub range: Option<Limits>,
    /// `true` for the time without tokens after which the node is called with ⊥.
    pub is_silence: bool,
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
    /// A number, and `true` if it was written as an integer.
    Number(f64, bool),
    /// `true`, `false`
    Bool(bool),
    /// A string
    Text(String),
}
