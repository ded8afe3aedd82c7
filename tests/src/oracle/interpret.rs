//! Scripted nodes for the interpreter: runs of random graphs without rustc.

use super::{
    judge::{Checked, Record},
    script::{self, Parameters},
};
use apex_dsl::{
    catalog::{Catalog, Signature, Type},
    graph::{self, ConnectionId, NodeId},
    syntax::tree::PortKind,
};
use apex_interpret::{Args, Interpreter, Library, Node, Outcome, Value};
use apex_rt::{Failure, Observer, Time};
use std::{cell::RefCell, rc::Rc};

/// Records of a run.
type Records = Rc<RefCell<Vec<Record>>>;

/// Node whose calls follow a script, of any of the types in [`crate::nodes`].
struct Scripted {
    signature: Signature,
    id: i64,
    parameters: Parameters,
    calls: i64,
    records: Records,
}

impl Scripted {
    /// A call with some tokens: those of a type without a value count as 7, which no scripted node sends.
    fn call(&mut self, tokens: Vec<Option<i64>>) -> i64 {
        self.records.borrow_mut().push(Record::Took(tokens));
        self.calls += 1;
        self.calls - 1
    }

    fn number(token: &Value) -> Option<i64> {
        if let Some(number) = token.downcast_ref::<i64>() {
            return Some(*number);
        }
        match token.downcast_ref::<Vec<Value>>() {
            Some(list) => list.first().and_then(Self::number),
            None => Some(7),
        }
    }

    fn numbers(tokens: &[Option<Value>]) -> Vec<Option<i64>> {
        tokens.iter().map(|token| token.as_ref().and_then(Self::number)).collect()
    }

    fn value(&self, port: &str, call: i64) -> Option<i64> {
        script::sends(self.id, self.parameters, port, call).then(|| script::value(self.id, port, call))
    }

    /// Triggers the events that the script wants.
    fn trigger(&self, call: i64, args: &Args) {
        for (port, declared) in self.signature.ports.iter().enumerate().filter(|(_, p)| p.kind == PortKind::Event) {
            if let Some(value) = self.value(&declared.name, call) {
                args.events.borrow_mut().push((port, Rc::new(value)));
            }
        }
    }
}

impl Node for Scripted {
    fn process(&mut self, args: &Args) -> Outcome {
        if self.signature.name == "pass" {
            return Ok(vec![(1, args.tokens[0].clone())]);
        }
        let call = self.call(Self::numbers(&args.tokens));
        self.trigger(call, args);
        let outputs = self.signature.ports.iter().enumerate().filter(|(_, p)| p.kind == PortKind::Output);
        let sent = outputs.map(|(port, declared)| {
            let value = self.value(&declared.name, call).map(|value| match self.signature.name.as_str() {
                "ScList" => Rc::new(vec![Rc::new(value) as Value; 2]) as Value,
                _ => Rc::new(value) as Value,
            });
            (port, value)
        });
        Ok(sent.collect())
    }

    fn slot(&mut self, _port: usize, args: &Args) -> Result<(), Failure> {
        let tokens = if args.tokens.is_empty() { vec![Some(7)] } else { Self::numbers(&args.tokens) };
        let call = self.call(tokens);
        self.trigger(call, args);
        Ok(())
    }

    fn absent(&mut self) {
        self.call(vec![None]);
    }

    fn param(&mut self, _param: usize) -> Option<Value> {
        None
    }

    fn put_param(&mut self, _param: usize, _value: &Value) {}
}

/// The scripted nodes.
struct Scripts {
    records: Records,
}

impl Library for Scripts {
    fn make(&self, _node: usize, signature: &Signature, library: &graph::Library) -> Option<Box<dyn Node>> {
        let (id, parameters) = super::judge::script(signature, library).unwrap_or_default();
        let records = self.records.clone();
        Some(Box::new(Scripted { signature: signature.clone(), id, parameters, calls: 0, records }))
    }

    fn token(&self, value: Option<&graph::Value>, _ty: &Type) -> Option<Value> {
        // Without a value, it is the initial token of a delay.
        let number = value.map_or(Some(7), super::judge::integer)?;
        Some(Rc::new(number))
    }

    fn items(&self, _end: (usize, usize), list: &Value) -> Vec<Value> {
        list.downcast_ref::<Vec<Value>>().cloned().unwrap_or_default()
    }

    fn list(&self, _end: (usize, usize), items: Vec<Value>) -> Option<Value> {
        Some(Rc::new(items))
    }
}

/// A run of the interpreter.
#[derive(Debug, Default)]
pub struct Interpreted {
    /// Its records.
    pub records: Vec<Record>,
    /// Claims that were broken, in the order in which they were.
    pub broken: Vec<usize>,
}

/// Observer that writes records.
struct Notes {
    records: Records,
    broken: Vec<usize>,
}

impl Observer for Notes {
    fn fired(&mut self, node: usize) {
        self.records.borrow_mut().push(Record::Fired(NodeId::from(node)));
    }
    fn handled(&mut self, connection: usize) {
        self.records.borrow_mut().push(Record::Handled(ConnectionId::from(connection)));
    }
    fn activity(&mut self, node: usize, active: bool) {
        self.records.borrow_mut().push(Record::Activity(NodeId::from(node), active));
    }
    fn claim_failed(&mut self, claim: usize) {
        self.broken.push(claim);
    }
}

/// A run of the interpreter with reactions at these times, in ns.
///
/// # Errors
/// Returns what the interpreter does not know.
pub fn interpret(catalog: &Catalog, checked: &Checked, times: &[i64]) -> Result<Interpreted, String> {
    let records = Records::default();
    let library = Scripts { records: records.clone() };
    let mut program = Interpreter::new(&checked.program, &checked.machines, catalog, &library)?;
    let mut notes = Notes { records: records.clone(), broken: vec![] };
    for now in times {
        records.borrow_mut().push(Record::Begin(*now as u64));
        program.react(Time::from_nanos(*now), &mut notes);
        records.borrow_mut().push(Record::End);
    }
    Ok(Interpreted { records: records.take(), broken: notes.broken })
}
