//! Signature of a node: what the catalog has read of a function or struct with `#[node]`.

use super::{
    items::{Default as DefaultValue, Limits},
    tree::Need,
    types::Type,
};
use crate::{index::id, syntax::tree::PortKind, units};
use std::{collections::BTreeMap, path::PathBuf, time::Duration};

id! {
    /// Number of a node signature in [`Catalog::signatures`](super::Catalog::signatures).
    SignatureId
}

/// Signature of a node type, as declared by `#[node]` or by a state machine.
#[derive(Debug, Clone, Default)]
pub struct Signature {
    /// Name of the node type.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// File of the declaration.
    pub file: PathBuf,
    /// Line of its name, from 1.
    pub line: usize,
    /// Path by which generated code reaches it.
    pub path: Vec<String>,
    /// `true` for a function, `false` for a struct.
    pub is_function: bool,
    /// Names of type parameters and constants.
    pub generics: Vec<String>,
    /// Bounds of its type parameters, as written.
    pub bounds: Vec<String>,
    /// `true` if firings depend on earlier ones.
    pub stateful: bool,
    /// Types of its state.
    pub state: Vec<Type>,
    /// Parameters.
    pub params: Vec<ParamSig>,
    /// Ports: inputs, outputs, slots, events, in the order of the signature.
    pub ports: Vec<PortSig>,
    /// Arguments of `process`; `None` if it has none.
    pub process: Option<Vec<ArgSig>>,
    /// Returned value of `process`.
    pub returns: ReturnSig,
    /// Method that is called instead of `process` when a mandatory input holds ⊥.
    pub no_message: Option<String>,
    /// Slots.
    pub slots: Vec<SlotSig>,
    /// Method that is called when the node becomes active.
    pub on_activate: Option<String>,
    /// Method that is called when the node becomes inactive.
    pub on_deactivate: Option<String>,
    /// Method that is called when the program ends.
    pub on_stop: Option<String>,
    /// States and moves of a state machine.
    pub machine: Option<MachineSig>,
    /// `true` if its tokens take activity away instead of passing it on.
    pub deactivates: bool,
    /// `true` if nothing in its tokens comes from outside of the program, also if it has no inputs.
    pub computed: bool,
    /// `true` if all its tokens are in the same frame.
    pub keeps_frame: bool,
    /// Part of the Rust libraries that the node needs, and the reason.
    pub needs: Option<(Need, String)>,
}

/// States and moves of the node type of a state machine.
#[derive(Debug, Clone)]
pub struct MachineSig {
    /// The innermost states, by path. The first one is the initial state.
    pub states: Vec<String>,
    /// The numbers of the events that its `exit`s and `entry`s trigger, which are the arguments of the methods by which
    /// `reset`, `cancel` and `resume` move it to another state.
    pub moved: Vec<usize>,
    /// The times after which it leaves states by itself.
    pub waits: Vec<WaitSig>,
}

/// A time after which a state machine leaves a state by itself.
#[derive(Debug, Clone)]
pub struct WaitSig {
    /// The time since the state was entered.
    pub after: Duration,
    /// The method that is called then.
    pub method: String,
    /// The numbers of the events that it may trigger, which are the arguments of the method.
    pub events: Vec<usize>,
}

impl MachineSig {
    /// Returns `true` if an event may be triggered because of the time that it has been in a state.
    pub fn is_timed(&self, event: usize) -> bool {
        self.waits.iter().any(|wait| wait.events.contains(&event))
    }

    /// All states, also those with states inside, by path, each with the numbers of the innermost states in it.
    pub fn all_states(&self) -> BTreeMap<&str, Vec<usize>> {
        let mut found: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (number, state) in self.states.iter().enumerate() {
            let ends = state.match_indices('.').map(|(end, _)| end).chain([state.len()]);
            ends.for_each(|end| found.entry(&state[..end]).or_default().push(number));
        }
        found
    }
}

/// A slot of a node type.
#[derive(Debug, Clone)]
pub struct SlotSig {
    /// Port, by its number in [`Signature::ports`].
    pub port: usize,
    /// Method that is called.
    pub method: String,
    /// Arguments. The port of the slot stands for the token.
    pub args: Vec<ArgSig>,
    /// `true` for a `Result`: the method may fail.
    pub fallible: bool,
}

impl Signature {
    /// Bounds of each type: `T`, and names of traits without their paths: `Clone`, `'static`.
    pub fn bounds(&self) -> impl Iterator<Item = (&str, impl Iterator<Item = &str>)> {
        let asked = self.bounds.iter().filter_map(|bound| bound.split_once(':'));
        asked.map(|(of, traits)| {
            let traits = traits.split(" + ").map(str::trim);
            (of.trim(), traits.map(|path| path.rsplit_once("::").map_or(path, |(_, name)| name)))
        })
    }

    /// Reason why the unit of a port or parameter is wrong, if one is.
    pub fn wrong_unit(&self) -> Option<String> {
        let unknown = |name: &str, unit: &str| {
            let part = units::parse(unit).err()?;
            Some(format!("there is no unit `{part}`, which its `{name}` has"))
        };
        let of_port = |port: &PortSig| match &port.ty {
            Type::Measured(number, _) if !number.may_be_a_number() => {
                Some(format!("only a number has a unit, but the tokens of its `{}` are of type `{number}`", port.name))
            }
            Type::Measured(_, unit) => unknown(&port.name, unit),
            _ => None,
        };
        let of_param = |param: &ParamSig| unknown(&param.name, param.unit.as_deref()?);
        self.ports.iter().find_map(of_port).or_else(|| self.params.iter().find_map(of_param))
    }

    /// Parameter with the time without tokens after which the node is called with ⊥, by its number.
    pub fn silence(&self) -> Option<usize> {
        self.params.iter().position(|param| param.is_silence)
    }

    /// Returns `true` for an output that `process` writes in place, through an argument.
    pub fn writes_in_place(&self, port: usize) -> bool {
        let is_output = self.ports.get(port).is_some_and(|port| port.kind == PortKind::Output);
        is_output && self.process.as_ref().is_some_and(|args| args.contains(&ArgSig::Port(port)))
    }

    /// The outputs whose tokens `process` returns, with their numbers.
    pub fn returned(&self) -> impl Iterator<Item = (usize, &PortSig)> {
        let outputs = self.ports.iter().enumerate().filter(|(_, port)| port.kind == PortKind::Output);
        outputs.filter(|(port, _)| !self.writes_in_place(*port))
    }

    /// Returns `true` if the tokens of a firing at this port are in an array.
    pub fn is_batched(&self, port: usize) -> bool {
        self.ports[port].rate > 1
    }
}

/// A parameter of a node type.
#[derive(Debug, Clone)]
pub struct ParamSig {
    /// Name.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// Type of the value.
    pub ty: Type,
    /// Unit of plain numbers.
    pub unit: Option<String>,
    /// Value of instances without an argument for it.
    pub default: Option<DefaultValue>,
    /// Its range.
    pub range: Option<Limits>,
    /// `true` for the time without tokens after which the node is called with ⊥.
    pub is_silence: bool,
}

/// A port of a node type.
#[derive(Debug, Clone)]
pub struct PortSig {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: PortKind,
    /// Type of one token.
    pub ty: Type,
    /// Tokens per firing.
    pub rate: usize,
    /// For an input: ⊥ reaches the node as `None`. For an output: it may be ⊥ although the node fired.
    pub optional: bool,
    /// `true` for an array of inputs: any number of connections, each with an input of its own.
    pub any_number: bool,
    /// `true` for an event that reports a failure.
    pub failure: bool,
    /// Number among the ports of its kind: in generated code the token type is `Input<index>`, `Output<index>`,
    /// `Slot<index>` or `Trigger<index>` of the node. All fields of a struct of outputs have the same number.
    pub index: usize,
    /// Field of a `#[derive(Outputs)]` struct: its number and name.
    pub field: Option<(usize, String)>,
    /// `true` if this field is an `Option`.
    pub field_is_option: bool,
    /// Documentation.
    pub docs: String,
}

/// An argument of `process` or of a slot: the port, the context or the parameter that it stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArgSig {
    /// A port, by its number in [`Signature::ports`].
    Port(usize),
    /// `&Ctx`
    Ctx,
    /// A parameter, by number.
    Param(usize),
}

/// Returned value of `process`.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReturnSig {
    /// `true` if there is a value.
    pub value: bool,
    /// `true` for an `Option`.
    pub maybe: bool,
    /// `true` for a `Result`.
    pub fallible: bool,
    /// `true` for a struct of outputs.
    pub several: bool,
}
