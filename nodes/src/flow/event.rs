//! Signals: emitters from flow to events (thesis 3.6.3), and nodes from events to events.

use apex_rt::{Ctx, Event, Time, node};
use core::marker::PhantomData;

/// Triggers an event with every input value: an emitter (thesis 3.6.3).
#[node]
pub fn emit<T: Clone>(value: &T, signal: Event<T>) {
    signal.emit(value.clone());
}

/// Triggers `equal` if its two inputs are equal, and `unequal` otherwise (thesis fig. 8.1a, *streq*).
#[node]
pub fn equals<T: PartialEq>(a: &T, b: &T, equal: Event<()>, unequal: Event<()>) {
    if a == b { equal.emit(()) } else { unequal.emit(()) }
}

/// Triggers `yes` if the value is `true`, and `no` otherwise.
#[node]
pub fn either(value: &bool, yes: Event<()>, no: Event<()>) {
    if *value { yes.emit(()) } else { no.emit(()) }
}

/// Triggers its event in every firing: a clock with `every`, an alarm with `after`.
#[node]
#[computed]
pub fn tick(signal: Event<()>) {
    signal.emit(());
}

/// Passes every token on. While its event is in flight, the slot takes no other token (thesis fig. 7.4, *v_b*).
#[node]
#[derive(Debug, Clone, Default)]
pub struct Relay<T> {
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Relay<T> {
    /// Triggers the event with this token.
    #[slot]
    fn put(&mut self, value: &T, signal: Event<T>) {
        signal.emit(value.clone());
    }
}

/// Passes a token on if it is active, and drops all others: a state that waits for something to happen. Activity comes
/// in at `enable` and leaves with the token. What came before is old, and does not count: to keep it, use
/// [`Inbox`](super::Inbox).
#[node]
#[derive(Debug, Clone, Default)]
pub struct Await<T> {
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Await<T> {
    /// Triggers the event with this token if the node is active.
    #[slot]
    fn put(&mut self, value: &T, ctx: &Ctx, signal: Event<T>) {
        if ctx.active() {
            signal.emit(value.clone());
        }
    }
}

/// Triggers an event for every token, without the token's value.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Signal<T> {
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T> Signal<T> {
    /// Triggers the event.
    #[slot]
    fn put(&mut self, _value: &T, signal: Event<()>) {
        signal.emit(());
    }
}

/// Counts tokens and sends the count after each one. Saturates at the maximum of `u64`.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Counter<T> {
    count: u64,
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T> Counter<T> {
    /// Adds one to the count.
    #[slot]
    fn put(&mut self, _value: &T, count: Event<u64>) {
        self.count = self.count.saturating_add(1);
        count.emit(self.count);
    }

    /// Resets the count to zero.
    #[slot]
    fn reset(&mut self) {
        self.count = 0;
    }
}

/// Triggers `on` and `off` alternately, `on` first: for example to `enable` and `disable` a node with one button.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Toggle {
    is_on: bool,
}

#[node]
impl Toggle {
    /// Switches over and triggers the event of the new state.
    #[slot]
    fn flip(&mut self, on: Event<()>, off: Event<()>) {
        self.is_on = !self.is_on;
        if self.is_on { on.emit(()) } else { off.emit(()) }
    }
}

/// Passes a token on unless another one came less than `quiet` before: contacts that bounce, and buttons that are
/// pressed twice.
#[node]
#[derive(Debug, Clone)]
pub struct Debounce<T> {
    /// Time without tokens after which one passes.
    #[param(unit = "s", default = 0.05, range = 0.0..=3600.0)]
    quiet: f32,
    last: Option<Time>,
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Debounce<T> {
    /// Triggers the event with this token if it is the first one for a while.
    #[slot]
    fn put(&mut self, value: &T, ctx: &Ctx, signal: Event<T>) {
        let last = self.last.replace(ctx.now());
        if last.is_none_or(|last| ctx.now().since(last).as_secs_f32() >= self.quiet) {
            signal.emit(value.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn debounce_waits_for_silence() {
        let mut node = Debounce::construct((0.1,));
        let passed = [0, 50, 149, 249, 300, 1000]
            .map(|ms| triggered(|signal| node.put(&ms, &Ctx::new(Time::from_millis(ms)), signal)));
        assert_eq!(passed, [Some(0), None, None, Some(249), None, Some(1000)]);
    }

    /// Token with which `call` triggers its event.
    fn triggered<T>(call: impl FnOnce(Event<'_, T>)) -> Option<T> {
        let mut token = None;
        call(apex_rt::event(&mut token));
        token
    }

    #[test]
    fn emit_triggers_with_each_value() {
        assert_eq!(triggered(|signal| emit(&"now", signal)), Some("now"));
    }

    #[test]
    fn equals_triggers_one_of_two() {
        let both = |a, b| {
            let (mut equal, mut unequal) = (None, None);
            equals(&a, &b, apex_rt::event(&mut equal), apex_rt::event(&mut unequal));
            (equal.is_some(), unequal.is_some())
        };
        assert_eq!((both("start", "start"), both("start", "stop")), ((true, false), (false, true)));
    }

    #[test]
    fn either_triggers_one_of_two() {
        let both = |value| {
            let (mut yes, mut no) = (None, None);
            either(&value, apex_rt::event(&mut yes), apex_rt::event(&mut no));
            (yes.is_some(), no.is_some())
        };
        assert_eq!((both(true), both(false)), ((true, false), (false, true)));
    }

    #[test]
    fn tick_always_triggers() {
        assert_eq!(triggered(tick), Some(()));
    }

    #[test]
    fn relay_keeps_the_value_and_signal_does_not() {
        assert_eq!(triggered(|signal| Relay::default().put(&4, signal)), Some(4));
        assert_eq!(triggered(|signal| Signal::default().put(&4, signal)), Some(()));
    }

    #[test]
    fn await_drops_what_comes_without_activity() {
        let ctx = Ctx::new(Time::ZERO);
        let mut node = Await::default();
        assert_eq!(triggered(|signal| node.put(&4, &ctx.of_node(false), signal)), None);
        assert_eq!(triggered(|signal| node.put(&5, &ctx.of_node(true), signal)), Some(5));
    }

    #[test]
    fn counter_counts_until_it_is_reset() {
        let mut node = Counter::default();
        assert_eq!([(); 2].map(|()| triggered(|count| node.put(&'x', count))), [Some(1), Some(2)]);
        node.reset();
        assert_eq!(triggered(|count| node.put(&'x', count)), Some(1));
    }

    #[test]
    fn toggle_alternates() {
        let mut node = Toggle::default();
        let turns = [(); 3].map(|()| {
            let (mut on, mut off) = (None, None);
            node.flip(apex_rt::event(&mut on), apex_rt::event(&mut off));
            (on.is_some(), off.is_some())
        });
        assert_eq!(turns, [(true, false), (false, true), (true, false)]);
    }
}
