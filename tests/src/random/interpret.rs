//! Random graphs, run by the interpreter of programs.

use super::{
    Case, Trace,
    kinds::{COUNT, Kind, ONE_BASED, OPERATIONS, SINKS, State, Token},
};
use apex_dsl::{
    catalog::{Catalog, Signature, Type},
    checked::CheckedProgram,
    graph,
    machine::Machines,
    syntax::tree::PortKind,
};
use apex_interpret::{Args, Interpreter, Library, Node, Outcome, Value};
use apex_rt::{Failure, Observer, Time};
use std::{cell::RefCell, collections::BTreeMap, rc::Rc};

/// Tapes of the sinks, by their identifiers.
type Tapes = Rc<RefCell<BTreeMap<i64, Vec<Token>>>>;

/// Node of one of the kinds.
struct OfKind {
    kind: &'static Kind,
    signature: Signature,
    parameter: i64,
    state: State,
    tapes: Tapes,
}

impl OfKind {
    fn fire(&mut self, tokens: &[Token]) -> Vec<Token> {
        let sent = (self.kind.fire)(&mut self.state, self.parameter, tokens);
        if self.kind.outputs.is_empty() {
            self.tapes.borrow_mut().entry(self.parameter).or_default().append(&mut self.state.tape);
        }
        sent
    }
}

impl Node for OfKind {
    fn process(&mut self, args: &Args) -> Outcome {
        let number = |token: &Value| token.downcast_ref::<i64>().copied();
        let mut arrived = args.tokens.iter().map(|token| token.as_ref().and_then(number));
        // Some inputs are ports of parameters.
        let tokens = self.kind.inputs.iter().map(|name| {
            match self.signature.params.iter().position(|param| param.name == *name) {
                Some(param) => {
                    args.params.iter().find(|(number, _)| *number == param).and_then(|(_, value)| number(value))
                }
                None => arrived.next().flatten(),
            }
        });
        let tokens: Vec<Token> = tokens.collect();
        let sent = self.fire(&tokens);
        let outputs = self.signature.ports.iter().enumerate().filter(|(_, port)| port.kind == PortKind::Output);
        let place = |name: &str| self.kind.outputs.iter().position(|output| *output == name).unwrap_or(0);
        let results = outputs.map(|(port, declared)| {
            (port, sent.get(place(&declared.name)).copied().flatten().map(|token| Rc::new(token) as Value))
        });
        Ok(results.collect())
    }

    fn slot(&mut self, _port: usize, _args: &Args) -> Result<(), Failure> {
        Ok(())
    }

    fn absent(&mut self) {
        self.fire(&vec![None; self.kind.inputs.len()]);
    }

    fn param(&mut self, _param: usize) -> Option<Value> {
        Some(Rc::new(self.parameter))
    }

    fn put_param(&mut self, _param: usize, _value: &Value) {}
}

/// The kinds of nodes.
struct Kinds {
    tapes: Tapes,
}

impl Library for Kinds {
    fn make(&self, _node: usize, signature: &Signature, library: &graph::Library) -> Option<Box<dyn Node>> {
        let mut kinds = OPERATIONS.iter().chain(SINKS).chain([&COUNT, &ONE_BASED]);
        let kind = kinds.find(|kind| kind.name.split('<').next() == Some(&signature.name))?;
        let parameter = library.params.first().and_then(|value| match value {
            graph::Value::Number(number) => Some(number.value as i64),
            _ => None,
        });
        let (signature, parameter) = (signature.clone(), parameter.unwrap_or(0));
        Some(Box::new(OfKind { kind, signature, parameter, state: State::default(), tapes: self.tapes.clone() }))
    }

    fn token(&self, value: Option<&graph::Value>, _ty: &Type) -> Option<Value> {
        match value {
            Some(graph::Value::Number(number)) => Some(Rc::new(number.value as i64)),
            _ => Some(Rc::new(0_i64)),
        }
    }

    fn items(&self, _end: (usize, usize), _list: &Value) -> Vec<Value> {
        vec![]
    }

    fn list(&self, _end: (usize, usize), items: Vec<Value>) -> Option<Value> {
        Some(Rc::new(items))
    }
}

/// Observer of firings.
#[derive(Default)]
struct Fired(Vec<usize>);

impl Observer for Fired {
    fn fired(&mut self, node: usize) {
        self.0.push(node);
    }
}

impl Case {
    /// Trace of a program of this graph, flat or nested.
    ///
    /// # Errors
    /// Returns what the interpreter does not know.
    pub fn interpret(&self, program: &CheckedProgram, catalog: &Catalog, iterations: usize) -> Result<Trace, String> {
        let (library, machines) = (Kinds { tapes: Tapes::default() }, Machines::new());
        let mut running = Interpreter::new(program, &machines, catalog, &library)?;
        let mut trace = Trace { fired: vec![], tapes: vec![vec![]; self.sinks()] };
        for _ in 0..iterations {
            let mut fired = Fired::default();
            running.react(Time::ZERO, &mut fired);
            let name = |node: usize| program.graph.path(graph::NodeId::from(node)).replace("group.", "");
            let mut names: Vec<String> = fired.0.into_iter().map(name).collect();
            names.sort();
            trace.fired.push(names);
        }
        for (sink, tape) in library.tapes.take() {
            trace.tapes[sink as usize] = tape;
        }
        Ok(trace)
    }
}
