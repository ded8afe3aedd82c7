//! Nodes and tokens, as the interpreter sees them.

use apex_dsl::{
    catalog::{Signature, Type},
    graph,
};
use apex_rt::{Ctx, Failure};
use std::{any::Any, cell::RefCell, rc::Rc, time::Duration};

/// A token. Copies share it. The tokens of a firing at a port with a rate are a `Vec<Value>`.
pub type Value = Rc<dyn Any>;

/// Result of a call: the tokens at the outputs, by the numbers of their ports in the signature.
pub type Outcome = Result<Vec<(usize, Option<Value>)>, Failure>;

/// A node.
pub trait Node {
    /// Calls `process`.
    ///
    /// # Errors
    /// Returns the failure of the node.
    fn process(&mut self, args: &Args) -> Outcome;

    /// Calls the method of a slot, by its port in the signature.
    ///
    /// # Errors
    /// Returns the failure of the node.
    fn slot(&mut self, port: usize, args: &Args) -> Result<(), Failure>;

    /// Calls the method for ⊥ at a mandatory input.
    fn absent(&mut self) {}

    /// Calls the method that is called when the node becomes active, or inactive.
    fn turned(&mut self, _active: bool) {}

    /// Returns the value of a parameter.
    fn param(&mut self, param: usize) -> Option<Value>;

    /// Accepts a value of a parameter.
    ///
    /// # Errors
    /// Returns the name of the parameter and the value as text, if it is out of range.
    fn accepts(&self, _param: usize, _value: &Value) -> Result<(), (&'static str, String)> {
        Ok(())
    }

    /// Sets a parameter to a value that it accepts.
    fn put_param(&mut self, param: usize, value: &Value);

    /// Returns the time without tokens after which the node is called with ⊥.
    fn silence(&mut self) -> Duration {
        Duration::MAX
    }
}

/// Arguments of a call.
pub struct Args {
    /// Context of the call.
    pub ctx: Ctx,
    /// Tokens, in the order of the arguments. An input of any number of tokens has one for each connection.
    pub tokens: Vec<Option<Value>>,
    /// Values of parameters that have arrived at inputs, with their numbers.
    pub params: Vec<(usize, Value)>,
    /// Events that were triggered, by the numbers of their ports, with their tokens: also those before a panic.
    pub events: RefCell<Vec<(usize, Value)>>,
}

/// Knowledge of node types and token types. Nodes have their numbers among all nodes of the program.
pub trait Library {
    /// Makes a node; `None` if its type is not known.
    fn make(&self, node: usize, signature: &Signature, library: &graph::Library) -> Option<Box<dyn Node>>;

    /// Returns a token of a type: the constant of the text, or the default of the type.
    fn token(&self, value: Option<&graph::Value>, ty: &Type) -> Option<Value>;

    /// Returns the elements of a list that comes to a port of an `each`.
    fn items(&self, end: (usize, usize), list: &Value) -> Vec<Value>;

    /// Returns the list of some elements, for an output of an `each`.
    fn list(&self, end: (usize, usize), items: Vec<Value>) -> Option<Value>;
}
