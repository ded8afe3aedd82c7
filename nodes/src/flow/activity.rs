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

/// Action that another program, a driver or a person carries out. It is active from `begin` until it is
/// done or has failed. Only activity counts: an order without activity is ignored, and so is a result that comes when
/// the action is not active, for example after it was cancelled.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Action<T> {
    _goal: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Action<T> {
    /// Begins: `started` takes the goal to the one who carries it out.
    #[slot]
    fn begin(&mut self, goal: &T, ctx: &Ctx, started: Event<T>) {
        if ctx.active() {
            started.emit(goal.clone());
        }
    }

    /// Reports success, which triggers `done`.
    #[slot]
    fn succeed(&mut self, ctx: &Ctx, done: Event<()>) {
        if ctx.active() {
            done.emit(());
        }
    }

    /// Reports failure, which triggers `gave_up`.
    #[slot]
    fn fail(&mut self, ctx: &Ctx, #[failure] gave_up: Event<()>) {
        if ctx.active() {
            gave_up.emit(());
        }
    }
}

/// Counts failures of something that is tried several times: the first ones trigger `again`, the last one `give_up`,
/// and the count begins again. Activity that arrives with a failure leaves with the event.
#[node]
#[derive(Debug, Clone)]
pub struct Attempts {
    /// Number of failures after which it is given up.
    #[param(default = 3, range = 1..=1000)]
    limit: u32,
    failures: u32,
}

#[node]
impl Attempts {
    /// Notes a failure.
    #[slot]
    fn failed(&mut self, again: Event<()>, #[failure] give_up: Event<()>) {
        self.failures += 1;
        if self.failures < self.limit {
            again.emit(());
        } else {
            self.failures = 0;
            give_up.emit(());
        }
    }

    /// Notes a success: the count begins again.
    #[slot]
    fn succeeded(&mut self) {
        self.failures = 0;
    }
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
    fn an_action_reports_only_while_it_is_active() {
        let (mut node, mut started, mut done) = (Action::default(), None, None);
        let ctx = Ctx::new(Time::ZERO);
        node.begin(&6, &ctx, apex_rt::event(&mut started));
        assert_eq!(started, None);
        node.begin(&7, &ctx.of_node(true), apex_rt::event(&mut started));
        node.succeed(&ctx, apex_rt::event(&mut done));
        assert_eq!((started, done), (Some(7), None));
        node.succeed(&ctx.of_node(true), apex_rt::event(&mut done));
        node.fail(&ctx, apex_rt::event(&mut None));
        assert_eq!(done, Some(()));
    }

    #[test]
    fn only_failures_in_a_row_count() {
        let mut node = Attempts { limit: 2, failures: 0 };
        let mut fails = || {
            let (mut again, mut give_up) = (None, None);
            node.failed(apex_rt::event(&mut again), apex_rt::event(&mut give_up));
            (again.is_some(), give_up.is_some())
        };
        assert_eq!([fails(), fails(), fails()], [(true, false), (false, true), (true, false)]);
        node.succeeded();
        let (mut again, mut give_up) = (None, None);
        node.failed(apex_rt::event(&mut again), apex_rt::event(&mut give_up));
        assert_eq!((again, give_up), (Some(()), None));
    }

    #[test]
    fn deactivate_passes_tokens_on() {
        let mut token = None;
        Deactivate::default().put(&3, apex_rt::event(&mut token));
        assert_eq!(token, Some(3));
    }
}
