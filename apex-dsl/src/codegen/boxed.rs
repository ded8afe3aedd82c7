//! Boxed nodes for the interpreter: the Rust that it needs of a source file. Connections and numbers are not part of
//! it, so that after most changes of a source file rustc has nothing to do.

mod node;
mod types;

use super::{bugs::Bugs, condition, generator::Generator, names::Names, test::part_of_token, tokens::constant};
use crate::{
    catalog::{Catalog, Type},
    checked::CheckedProgram,
    graph::{Condition, Graph, Library, NodeId, NodeKind, PortId, Value},
    machine::{Machine, Machines, Slot, Token},
    report::Diagnostics,
    script::{Observed, Script, Step, What},
    source::Sources,
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::{BTreeMap, BTreeSet};
use types::{constant_type, is_inferred, token_type};

/// Number of a piece of Rust: a hash of its text.
pub type Key = u64;

/// Needs of the interpreter for a program.
#[derive(Debug, Default)]
pub struct Boxed {
    /// The pieces of Rust: expressions of the type `apex_interpret::glue::Piece`.
    pub pieces: BTreeMap<Key, TokenStream>,
    /// The nodes of the catalog, by their numbers among all nodes.
    pub nodes: BTreeMap<usize, BoxedNode>,
    /// The lists that an `each` takes and sends, by its number and the port.
    pub lists: BTreeMap<(usize, usize), Key>,
    /// The pieces that show the tokens at probes.
    pub shown: BTreeMap<NodeId, Key>,
    /// The pieces that read the tokens of ports from recordings.
    pub recorded: BTreeMap<NodeId, Key>,
    /// The checks of tokens that only Rust can make, by test and step.
    pub checks: BTreeMap<(String, usize), Key>,
}

/// A node of the catalog.
#[derive(Debug)]
pub struct BoxedNode {
    /// The piece that makes it.
    pub made: Key,
    /// The values of its parameters.
    pub params: Vec<Constant>,
}

/// A value.
#[derive(Debug)]
pub enum Constant {
    /// A number, a truth value, a text or a time, which need no Rust.
    Plain(Value, Type),
    /// A value that only Rust can make.
    Piece(Key),
}

/// Returns what the interpreter needs of `program`.
///
/// # Errors
/// Returns the reason why the program can only be compiled.
pub fn boxed(
    program: &CheckedProgram,
    machines: &Machines,
    catalog: &Catalog,
    sources: &Sources,
) -> Result<Boxed, String> {
    let graph = &program.graph;
    let (bugs, place) = (Bugs::new(graph.span), |_| proc_macro2::Span::call_site());
    let names = Names::new(graph, catalog, &mut BTreeSet::new());
    let mut collector =
        Collector { generator: Generator::new(catalog, sources, &names, &bugs, &place), boxed: Boxed::default() };
    collector.graph(graph)?;
    program.scripts.iter().try_for_each(|script| collector.script(graph, script))?;
    machines.values().try_for_each(|machine| collector.machine(machine))?;
    let boxed = collector.boxed;
    let mut faults = Diagnostics::default();
    bugs.report(&mut faults);
    if faults.has_errors() { Err("the compiler is at fault".to_owned()) } else { Ok(boxed) }
}

/// A value of a type, or the default of that type, with the piece that it needs.
///
/// # Errors
/// Returns that the type is not known.
pub fn constant_of(value: Option<&Value>, ty: &Type, catalog: &Catalog) -> Result<(Constant, TokenStream), String> {
    if let Some(value) = value.filter(|value| is_plain(value, ty)) {
        return Ok((Constant::Plain(value.clone(), ty.clone()), quote!()));
    }
    let value = value.unwrap_or(&Value::RustDefault);
    let piece = value_piece(&constant_type(value, ty, catalog)?, &constant(value, ty));
    Ok((Constant::Piece(key(&piece)), piece))
}

/// The piece with a value.
fn value_piece(ty: &TokenStream, value: &TokenStream) -> TokenStream {
    quote!(Piece::Value(|| value::<#ty>(#value)))
}

/// Returns `true` if a value needs no Rust.
fn is_plain(value: &Value, ty: &Type) -> bool {
    let primitive = match ty.without_unit() {
        Type::Primitive(name) => name.as_str(),
        _ => "",
    };
    match value {
        Value::Number(_) => !["", "bool", "char", "str"].contains(&primitive),
        Value::Bool(_) => primitive == "bool",
        Value::Text(_) => matches!(ty, Type::Named(name, _) if name == "String"),
        Value::Duration(_) => ty.is_time() || matches!(ty, Type::Named(..)) && ty.name() == "Duration",
        Value::Unit => ty.is_unit(),
        Value::List(_) | Value::Path(..) | Value::Struct(_) | Value::RustDefault => false,
    }
}

/// The piece that reads tokens of a type from a recording.
fn recorded(ty: &TokenStream) -> TokenStream {
    quote!(Piece::Recorded(|Recorded { text, file, channel, frame, begun }| {
        let tokens = ::apex_rt::record::tokens::<#ty>(text, file, channel, ::apex_rt::__codec!(#ty));
        let tokens = match frame {
            Some(frame) => tokens.in_frame(frame),
            None => tokens,
        };
        tokens.begun_at(begun).iter().map(|(time, token)| (*time, value(token.clone()))).collect()
    }))
}

/// A hash of the text of some Rust (FNV-1a).
fn key(piece: &TokenStream) -> Key {
    piece
        .to_string()
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Collects what the graph of a program, or the body of an `each`, needs.
struct Collector<'a> {
    generator: Generator<'a>,
    boxed: Boxed,
}

impl Collector<'_> {
    /// Adds a piece.
    fn add(&mut self, piece: TokenStream) -> Key {
        let key = key(&piece);
        self.boxed.pieces.insert(key, piece);
        key
    }

    /// Adds a value of a type.
    fn add_constant(&mut self, value: Option<&Value>, ty: &Type) -> Result<Constant, String> {
        let (constant, piece) = constant_of(value, ty, self.generator.catalog)?;
        if matches!(constant, Constant::Piece(_)) {
            self.add(piece);
        }
        Ok(constant)
    }

    fn graph(&mut self, graph: &Graph) -> Result<(), String> {
        for (id, node) in graph.nodes.iter_enumerated() {
            match &node.kind {
                NodeKind::Library(library) => self.node(graph, id, library)?,
                NodeKind::Delay(initial) => {
                    let ty = &graph.port(PortId { node: id, port: 1 }).ty;
                    for value in initial {
                        self.add_constant(value.as_ref(), ty)?;
                    }
                }
                NodeKind::Each(each) => {
                    self.lists(graph, id)?;
                    let mut inner = Collector {
                        generator: self.generator.inside(graph, id),
                        boxed: std::mem::take(&mut self.boxed),
                    };
                    let collected = inner.graph(&each.body);
                    self.boxed = inner.boxed;
                    collected?;
                }
                NodeKind::Probe => {
                    let ty = token_type(&self.generator, graph, PortId { node: id, port: 0 })?;
                    let shown = quote!(Piece::Show(|token| {
                        token.downcast_ref::<#ty>().map(|token| (&Shown(token)).shown())
                    }));
                    let key = self.add(shown);
                    self.boxed.shown.insert(id, key);
                }
                _ => {}
            }
        }
        graph.connections.iter().try_for_each(|connection| match &connection.given {
            Some(given) => self.add_constant(Some(&given.value), &graph.port(connection.to).ty).map(drop),
            None => Ok(()),
        })
    }

    fn node(&mut self, graph: &Graph, id: NodeId, library: &Library) -> Result<(), String> {
        let signature = &self.generator.catalog.signatures[library.signature];
        if signature.machine.is_some() {
            return Ok(());
        }
        let node_type = self.generator.node_type(graph, library);
        if is_inferred(&node_type) {
            return Err(format!("only rustc knows the type of `{}`", graph.path(id)));
        }
        let mut params = vec![];
        for (param, value) in library.params.iter().enumerate() {
            let ty = self.generator.param_type(library, param);
            params.push(if is_plain(value, &ty) {
                Constant::Plain(value.clone(), ty)
            } else {
                let value = self.generator.param_value(graph, library, param);
                let ty = quote!(<#node_type as ::apex_rt::Param<#param>>::Value);
                Constant::Piece(self.add(value_piece(&ty, &value)))
            });
        }
        let made = node::Adapter::new(&self.generator, graph, id, signature, node_type).piece()?;
        let made = self.add(made);
        self.boxed.nodes.insert(self.generator.index(id), BoxedNode { made, params });
        Ok(())
    }

    /// The lists of an `each`: one comes in, and some go out.
    fn lists(&mut self, graph: &Graph, id: NodeId) -> Result<(), String> {
        let NodeKind::Each(each) = &graph.nodes[id].kind else { return Ok(()) };
        let number = self.generator.index(id);
        for (port, p) in graph.nodes[id].ports.iter().enumerate() {
            let list = match p.kind {
                PortKind::Input if each.list == Some(port) => graph.incoming(PortId { node: id, port }).map(|c| c.from),
                PortKind::Output => Some(PortId { node: id, port }),
                _ => None,
            };
            let Some(list) = list else { continue };
            let ty = token_type(&self.generator, graph, list)?;
            let piece = match p.kind {
                PortKind::Output => quote!(Piece::List(collected::<#ty>)),
                _ => quote!(Piece::Items(items::<#ty>)),
            };
            let key = self.add(piece);
            self.boxed.lists.insert((number, port), key);
        }
        Ok(())
    }

    fn script(&mut self, graph: &Graph, script: &Script) -> Result<(), String> {
        for (number, step) in script.steps.iter().enumerate() {
            match step {
                Step::Feed { port, values, .. } => {
                    let ty = &graph.nodes[*port].ports[0].ty;
                    values.iter().try_for_each(|value| self.add_constant(Some(value), ty).map(drop))?;
                }
                Step::FeedRecorded { port, .. } => {
                    let ty = token_type(&self.generator, graph, PortId { node: *port, port: 0 })?;
                    let key = self.add(recorded(&ty));
                    self.boxed.recorded.insert(*port, key);
                }
                Step::Wait(_) => {}
                Step::Expect(seen, _) | Step::Never(seen) => {
                    if let What::Token(of, Some(condition)) = &seen.what
                        && (!of.fields.is_empty() || !can_compute(condition, &of.ty))
                    {
                        let piece = self.check(graph, of, &condition::holds(condition, &of.ty))?;
                        let key = self.add(piece);
                        self.boxed.checks.insert((script.name.clone(), number), key);
                    }
                }
            }
        }
        Ok(())
    }

    /// The check of a token at a probe.
    fn check(&self, graph: &Graph, of: &Observed, holds: &TokenStream) -> Result<TokenStream, String> {
        let ty = token_type(&self.generator, graph, PortId { node: of.probe, port: 0 })?;
        let part = part_of_token(of);
        Ok(quote!(Piece::Check(|token| {
            token.downcast_ref::<#ty>().is_some_and(|token| { let token = #part; #holds })
        })))
    }

    /// The constants of the events of a state machine.
    fn machine(&mut self, machine: &Machine) -> Result<(), String> {
        compute_guards(machine)?;
        let arms = machine.all_slots().flat_map(|slot| &slot.arms);
        let sendings = machine.entries.iter().chain(&machine.exits).flatten().chain(arms.flat_map(|arm| &arm.sends));
        for sending in sendings {
            if let Token::Value(value) = &sending.token {
                self.add_constant(Some(value), &machine.events[sending.event].1)?;
            }
        }
        Ok(())
    }
}

/// Checks that the interpreter can compute the guards of a state machine.
///
/// # Errors
/// Returns the type of tokens that one of them compares.
pub fn compute_guards(machine: &Machine) -> Result<(), String> {
    let is_beyond =
        |slot: &&Slot| slot.arms.iter().filter_map(|arm| arm.guard.as_ref()).any(|guard| !can_compute(guard, &slot.ty));
    match machine.all_slots().find(is_beyond) {
        Some(slot) => Err(format!("a guard of `{}` compares tokens of type `{}`", machine.name, slot.ty)),
        None => Ok(()),
    }
}

/// Returns `true` if the interpreter can compute a condition on tokens of a type: of numbers, truth values and times,
/// without constants of Rust.
pub fn can_compute(condition: &Condition, ty: &Type) -> bool {
    let can_compare =
        ty.is_integer() || ty.is_time() || matches!(ty.without_unit().name(), "f32" | "f64" | "bool" | "Duration");
    can_compare && !names_constant(condition)
}

fn names_constant(condition: &Condition) -> bool {
    match condition {
        Condition::Token => false,
        Condition::Constant(value) => matches!(value, Value::Path(..)),
        Condition::Unary(_, inner) => names_constant(inner),
        Condition::Binary(a, _, b) => names_constant(a) || names_constant(b),
    }
}
