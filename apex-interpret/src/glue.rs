//! Parts of the pieces of Rust that `apex test` compiles for the interpreter (`apex_dsl::codegen::boxed`).

pub use crate::node::{Args, Node, Outcome, Value};
pub use apex_rt::shown::{ByDebug, ByType, Shown};

use apex_rt::{Failure, List, Time};
use std::{cell::RefCell, rc::Rc, time::Duration};

/// A piece of Rust.
pub enum Piece {
    /// Makes a node of the values of its parameters; `None` if one is of another type.
    Node(fn(Vec<Value>) -> Option<Box<dyn Node>>),
    /// Makes a value.
    Value(fn() -> Value),
    /// Checks a token.
    Check(fn(&Value) -> bool),
    /// Returns the tokens of a recording with their times since its beginning. Panics if it cannot be read.
    Recorded(fn(Recorded<'_>) -> Vec<(Duration, Value)>),
    /// Returns a token as text.
    Show(fn(&Value) -> Option<String>),
    /// Returns the elements of a list.
    Items(fn(&Value) -> Vec<Value>),
    /// Collects elements in a list.
    List(fn(Vec<Value>) -> Option<Value>),
}

/// Tokens of a recording.
pub struct Recorded<'a> {
    /// Path of the source file.
    pub text: &'a str,
    /// Path of the recording, relative to the folder of the source file.
    pub file: &'a str,
    /// Name of the channel.
    pub channel: &'a str,
    /// Frame of the port.
    pub frame: Option<&'static str>,
    /// Time at which the recording begins.
    pub begun: Time,
}

/// A value of any type.
pub fn value<T: 'static>(value: T) -> Value {
    Rc::new(value)
}

/// The next of some values, which nothing else has.
pub fn owned<T: 'static>(values: &mut impl Iterator<Item = Value>) -> Option<T> {
    Rc::try_unwrap(values.next()?.downcast().ok()?).ok()
}

/// The failure of a node at which a token of another type arrived.
pub fn missing() -> Failure {
    Failure::new(&"a token is missing: this is a fault of the interpreter")
}

/// The token of an input, if there is one.
///
/// # Errors
/// It is of another type.
pub fn token<T: 'static>(token: &Option<Value>) -> Result<Option<&T>, Failure> {
    token.as_ref().map(|token| token.downcast_ref().ok_or_else(missing)).transpose()
}

/// The tokens of an input with a rate.
///
/// # Errors
/// They are of another type, or not as many.
pub fn batch<T: Clone + 'static, const N: usize>(tokens: &Option<Value>) -> Result<Option<[T; N]>, Failure> {
    let Some(tokens) = token::<Vec<Value>>(tokens)? else { return Ok(None) };
    let tokens: Option<Vec<T>> = tokens.iter().map(|token| token.downcast_ref().cloned()).collect();
    tokens.and_then(|tokens| tokens.try_into().ok()).map(Some).ok_or_else(missing)
}

/// The tokens of an output with a rate.
pub fn batched<T: 'static, const N: usize>(tokens: [T; N]) -> Value {
    Rc::new(tokens.into_iter().map(value).collect::<Vec<Value>>())
}

/// The place of an event: what is in it when the call has ended is triggered, also if it has ended with a panic.
pub struct Event<'a, T: 'static> {
    port: usize,
    triggered: &'a RefCell<Vec<(usize, Value)>>,
    /// The token.
    pub token: Option<T>,
}

impl<'a, T> Event<'a, T> {
    /// An empty place for the event at this port.
    pub fn new(port: usize, args: &'a Args) -> Self {
        Self { port, triggered: &args.events, token: None }
    }
}

impl<T> Drop for Event<'_, T> {
    fn drop(&mut self) {
        if let Some(token) = self.token.take() {
            self.triggered.borrow_mut().push((self.port, value(token)));
        }
    }
}

/// The value of a function's parameter: the one that has arrived, or the one of the text.
///
/// # Errors
/// It is of another type.
pub fn param<T: Clone + 'static>(params: &[Value], arrived: &[(usize, Value)], param: usize) -> Result<T, Failure> {
    let arrived = arrived.iter().find(|(number, _)| *number == param).map(|(_, value)| value);
    arrived.unwrap_or(&params[param]).downcast_ref().cloned().ok_or_else(missing)
}

/// The elements of a list.
pub fn items<L: List<Item: Clone + 'static> + 'static>(list: &Value) -> Vec<Value> {
    list.downcast_ref::<L>().map_or(vec![], |list| list.items().iter().cloned().map(value).collect())
}

/// The list of some elements.
pub fn collected<L: List<Item: Clone + 'static> + Default + 'static>(items: Vec<Value>) -> Option<Value> {
    let mut list = L::default();
    let items: Option<Vec<L::Item>> = items.iter().map(|item| item.downcast_ref().cloned()).collect();
    list.append(items?.into_iter());
    Some(value(list))
}
