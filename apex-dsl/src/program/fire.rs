//! Lowering of firings: which tokens a node takes, and where its results go.

use super::{Lowering, Plan, is_buffer};
use crate::{
    analyse::handles_absence,
    catalog::{ArgSig, Signature},
    graph::{NodeId, NodeKind, PortId, Standard},
    syntax::tree::PortKind,
};
use std::time::Duration;

/// Firing of a node.
#[derive(Debug)]
pub enum Fire {
    /// Calls a node of the catalog.
    Call(Box<Call>),
    /// Runs the body of an `each` for each element of a list.
    Each(Option<Deadline>),
    /// Puts a token into a delay.
    Hold,
    /// Puts a token out of the program.
    Output,
    /// Passes a token on.
    Relay,
    /// Shows a token to a test.
    See,
    /// Nothing: the tokens of the node were taken first.
    Nothing,
}

/// Call of `process`.
#[derive(Debug)]
pub struct Call {
    /// The node can be disabled, and then only sends ⊥.
    pub is_gated: bool,
    /// Parameters that are set before, with the inputs at which their tokens arrive.
    pub sets: Vec<(usize, PortId)>,
    /// The arguments; `None` if the node takes nothing but parameters.
    pub args: Option<Vec<Arg>>,
    /// Arguments whose ranges are checked before, with the inputs at which their tokens arrive. Without one in range,
    /// the node is not called.
    pub checks: Vec<(usize, PortId)>,
    /// The mandatory inputs of a node that has a method for ⊥, which is called if one of them has no token.
    pub mandatory: Option<Vec<PortId>>,
    /// Results, with the outputs that they go to.
    pub results: Vec<CallResult>,
    /// Outputs of parameters.
    pub param_outputs: Vec<ParamOutput>,
    /// Outputs that the node writes in place.
    pub buffers: Vec<PortId>,
    /// The event `processed`, if it is connected.
    pub processed: Option<PortId>,
    /// Consequence of a failure.
    pub failing: Failing,
    /// Consequence of being late.
    pub deadline: Option<Deadline>,
}

/// Call of the method of a slot.
#[derive(Debug)]
pub struct SlotCall {
    /// The arguments.
    pub args: Vec<Arg>,
    /// Consequence of a failure.
    pub failing: Failing,
    /// Consequence of being late.
    pub deadline: Option<Deadline>,
}

/// Argument of a call.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are called what they are")]
pub enum Arg {
    /// The context.
    Context,
    /// The token at an input; `optional` if it may be ⊥.
    Token { input: PortId, optional: bool },
    /// The tokens at any number of inputs.
    Tokens { inputs: Vec<PortId>, optional: bool },
    /// The token of a slot.
    OfSlot,
    /// The place of an output.
    Buffer(PortId),
    /// An event; `sent` if it is connected.
    Event { event: PortId, sent: bool },
    /// The value that the text gives a parameter.
    Param(usize),
    /// The value of a parameter of a function that has arrived at an input.
    Arrived { param: usize, input: PortId },
    /// The value of a parameter that was checked before.
    Checked(usize),
}

/// Output of a parameter: its value in this firing.
#[derive(Debug)]
pub struct ParamOutput {
    /// The parameter.
    pub param: usize,
    /// The input at which the value of a function's parameter has arrived.
    pub arrived: Option<PortId>,
    /// The output.
    pub output: PortId,
}

/// Result of a call.
#[derive(Debug)]
pub struct CallResult {
    /// The output.
    pub output: PortId,
    /// The field of a struct of results, and whether it is an `Option`.
    pub field: Option<(String, bool)>,
    /// The output may be ⊥.
    pub is_optional: bool,
}

/// Consequence of a failed call.
#[derive(Debug, Clone, Copy)]
pub enum Failing {
    /// It cannot, but by a panic.
    Never,
    /// It is reported.
    Reported,
    /// It is contained and reported, and so is a panic.
    Contained {
        /// The node returns a `Result`.
        fallible: bool,
        /// The event `failed`, if it is connected.
        event: Option<PortId>,
        /// The node is made again.
        restart: bool,
    },
}

/// Longest time from the firing of a source to the end of a call.
#[derive(Debug, Clone, Copy)]
pub struct Deadline {
    /// The time.
    pub time: Duration,
    /// The event `late`, if it is connected.
    pub event: Option<PortId>,
}

impl Lowering<'_> {
    /// Firing of a node.
    pub fn fire(&self, node: NodeId, plan: &Plan) -> Fire {
        let graph = self.lower.graph;
        match &graph.nodes[node].kind {
            NodeKind::Library(library) => {
                Fire::Call(Box::new(self.call(node, &self.lower.catalog.signatures[library.signature], plan)))
            }
            NodeKind::Each(_) => Fire::Each(self.deadline(node)),
            NodeKind::Delay(_) => Fire::Hold,
            NodeKind::Boundary(PortKind::Output) if !graph.is_body => Fire::Output,
            NodeKind::Relay => Fire::Relay,
            NodeKind::Probe => Fire::See,
            _ => Fire::Nothing,
        }
    }

    fn call(&self, node: NodeId, signature: &Signature, plan: &Plan) -> Call {
        let (graph, lower) = (self.lower.graph, self.lower);
        let params = 0..signature.params.len();
        let sources: Vec<(usize, PortId)> =
            params.filter_map(|param| Some((param, lower.param_source(node, param)?))).collect();
        let has_range = |param: usize| signature.params[param].range.is_some();
        let checks = sources.iter().copied().filter(|(param, _)| signature.is_function && has_range(*param));
        let args = signature.process.as_deref();
        let ends = || (0..graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let param_outputs = ends().filter(|end| graph.port(*end).kind == PortKind::Output && plan.is_used(*end));
        let param_output = |output: PortId| {
            let param = graph.port(output).parameter?;
            let arrived = lower.param_source(node, param).filter(|_| signature.is_function);
            Some(ParamOutput { param, arrived, output })
        };
        Call {
            is_gated: graph.nodes[node].can_be_disabled(),
            sets: if signature.is_function { vec![] } else { sources.clone() },
            args: args.map(|args| args.iter().map(|arg| self.arg(node, signature, *arg)).collect()),
            checks: checks.collect(),
            mandatory: handles_absence(graph, lower.catalog, node).then(|| self.mandatory(node, signature)),
            results: results(node, signature, plan),
            param_outputs: param_outputs.filter_map(param_output).collect(),
            buffers: ends().filter(|end| is_buffer(graph, lower.catalog, *end)).collect(),
            processed: lower.standard_event(node, Standard::Processed),
            failing: self.failing(node, signature.returns.fallible),
            deadline: self.deadline(node),
        }
    }

    /// The mandatory inputs of a node to which something is connected.
    fn mandatory(&self, node: NodeId, signature: &Signature) -> Vec<PortId> {
        let ports = signature.ports.iter().enumerate().filter(|(_, p)| p.kind == PortKind::Input && !p.optional);
        let inputs = ports.flat_map(|(port, _)| self.lower.graph.nodes[node].elements(port));
        inputs.map(|port| PortId { node, port }).filter(|to| self.lower.incoming(*to).is_some()).collect()
    }

    /// Consequence of a failed call of a node, which is `fallible`.
    pub fn failing(&self, node: NodeId, fallible: bool) -> Failing {
        let n = &self.lower.graph.nodes[node];
        match n.is_contained() {
            false if fallible => Failing::Reported,
            false => Failing::Never,
            true => {
                let event = self.lower.standard_event(node, Standard::Failed);
                // What Rust has made is not made again, and functions are not made.
                let is_made = match &n.kind {
                    NodeKind::Library(library) => {
                        !library.handed_in && !self.lower.catalog.signatures[library.signature].is_function
                    }
                    _ => false,
                };
                Failing::Contained { fallible, event, restart: n.modifiers.restart && is_made }
            }
        }
    }

    /// The `deadline` of a node.
    pub fn deadline(&self, node: NodeId) -> Option<Deadline> {
        let event = self.lower.standard_event(node, Standard::Late);
        self.lower.graph.nodes[node].modifiers.deadline.map(|time| Deadline { time, event })
    }

    fn arg(&self, node: NodeId, signature: &Signature, arg: ArgSig) -> Arg {
        match arg {
            ArgSig::Ctx => Arg::Context,
            ArgSig::Port(port) => {
                let (end, p) = (PortId { node, port }, &signature.ports[port]);
                match p.kind {
                    PortKind::Output => Arg::Buffer(end),
                    PortKind::Input if p.any_number => {
                        let inputs = self.lower.graph.nodes[node].elements(port).map(|port| PortId { node, port });
                        Arg::Tokens { inputs: inputs.collect(), optional: p.optional }
                    }
                    PortKind::Input => Arg::Token { input: end, optional: p.optional },
                    PortKind::Event | PortKind::Slot => self.event_arg(end),
                }
            }
            ArgSig::Param(param) => match self.lower.param_source(node, param) {
                Some(_) if signature.params[param].range.is_some() => Arg::Checked(param),
                Some(input) => Arg::Arrived { param, input },
                None => Arg::Param(param),
            },
        }
    }

    /// Call of the method of a slot; `None` if there is none.
    pub fn slot_call(&self, slot: PortId) -> Option<SlotCall> {
        let signature = self.lower.signature(slot.node)?;
        let method = signature.slots.iter().find(|method| method.port == slot.port)?;
        let args = method.args.iter().map(|arg| match *arg {
            ArgSig::Port(port) if port == slot.port => Arg::OfSlot,
            ArgSig::Port(port) => self.event_arg(PortId { node: slot.node, port }),
            ArgSig::Ctx | ArgSig::Param(_) => Arg::Context,
        });
        let failing = self.failing(slot.node, method.fallible);
        Some(SlotCall { args: args.collect(), failing, deadline: self.deadline(slot.node) })
    }

    /// The call of a machine after a time in a state.
    pub fn wait_call(&self, node: NodeId, wait: usize) -> SlotCall {
        let events = &self.lower.waits(node)[wait].events;
        let args = events.iter().map(|port| self.event_arg(PortId { node, port: *port })).collect();
        SlotCall { args, failing: self.failing(node, false), deadline: self.deadline(node) }
    }

    fn event_arg(&self, event: PortId) -> Arg {
        Arg::Event { event, sent: self.lower.is_sent_event(event) }
    }
}

/// Results of a call that something uses.
fn results(node: NodeId, signature: &Signature, plan: &Plan) -> Vec<CallResult> {
    let results = signature.returned().map(|(port, p)| CallResult {
        output: PortId { node, port },
        field: p.field.as_ref().map(|(_, name)| (name.clone(), p.field_is_option)),
        is_optional: p.optional,
    });
    results.filter(|result| plan.is_used(result.output)).collect()
}
