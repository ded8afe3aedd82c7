//! Nodes that depend on activity (thesis 7.1.2). All other nodes only pass it on.

use apex_rt::{Ctx, Event, node};
use core::marker::PhantomData;

/// Forwards a value while the node is active; ⊥ otherwise. If an active connection (`=>`) starts at the output,
/// exactly one value is forwarded: the activity leaves with it (thesis fig. 8.1b).
#[node]
#[derive(Debug, Clone, Default)]
pub struct ActivityGate<T> {
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> ActivityGate<T> {
    fn process(&mut self, ctx: &Ctx, value: &T) -> Option<T> {
        ctx.active().then(|| value.clone())
    }

    /// Receives activity with a token, without any other effect.
    #[slot]
    fn activate(&mut self) {}
}

/// Passes every token on and deactivates the node that receives it over `=>` (thesis eq. 7.3 with the modifier −1).
#[node]
#[deactivates]
#[derive(Debug, Clone, Default)]
pub struct Deactivate<T> {
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Deactivate<T> {
    /// Triggers the event with this token.
    #[slot]
    fn put(&mut self, value: &T, signal: Event<T>) {
        signal.emit(value.clone());
    }
}

/// Receives activity and keeps it: a state without action. With `timeout 3s` it is a pause that ends with the event
/// `timeout`.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Wait<T> {
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T> Wait<T> {
    /// Receives activity with a token, without any other effect.
    #[slot]
    fn activate(&mut self, _value: &T) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Time;

    #[test]
    fn the_gate_is_open_while_it_is_active() {
        let ctx = Ctx::new(Time::ZERO);
        let mut node = ActivityGate::default();
        node.activate();
        assert_eq!(node.process(&ctx, &1), None, "that is for the graph to say");
        assert_eq!(node.process(&ctx.of_node(true), &2), Some(2));
    }

    #[test]
    fn deactivate_passes_tokens_on() {
        let mut token = None;
        Deactivate::default().put(&3, apex_rt::event(&mut token));
        assert_eq!(token, Some(3));
    }
}
