//! Times of tokens.

use apex_rt::{Ctx, Event, Time, node};
use core::marker::PhantomData;

/// Sends the time at which a token arrives, in s since the start of the program: the time of an event. The difference
/// of two such times is the time between the events.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Stamp<T> {
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T> Stamp<T> {
    /// Triggers the event with the present time.
    #[slot]
    fn put(&mut self, _value: &T, ctx: &Ctx, #[unit("s")] time: Event<f64>) {
        time.emit(ctx.now().as_secs_f64());
    }
}

/// Watches over an input: reports when no value has come for the time `after`, and when values come back. The time
/// begins with the first reaction. Values pass on. ⊥ does not count: an input whose sender works, but has nothing to
/// say, is silent, too.
///
/// For tokens of events, connect them to the input. To stop a robot whose sensor fails, nothing is needed: nodes that
/// drive do it themselves.
#[node]
#[derive(Debug, Clone)]
pub struct Silence<T> {
    /// Time without a value after which the input is silent.
    #[param(unit = "s", default = 1.0, range = 0.01..=86_400.0, silence)]
    after: f32,
    /// Time of the last value, or else of the first reaction.
    last: Option<Time>,
    is_silent: bool,
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Silence<T> {
    fn process(&mut self, value: Option<&T>, ctx: &Ctx, silent: Event<()>, back: Event<()>) -> Option<T> {
        match value {
            Some(_) => {
                self.last = Some(ctx.now());
                if core::mem::take(&mut self.is_silent) {
                    back.emit(());
                }
            }
            None => {
                let last = *self.last.get_or_insert(ctx.now());
                if !self.is_silent && ctx.now().since(last).as_secs_f32() >= self.after {
                    self.is_silent = true;
                    silent.emit(());
                }
            }
        }
        value.cloned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn a_stamp_is_the_time_of_its_token() {
        let mut time = None;
        Stamp::default().put(&'x', &Ctx::new(Time::from_millis(2500)), apex_rt::event(&mut time));
        assert_eq!(time, Some(2.5));
    }

    /// Events of a watched input at these times, in ms: `s`ilent, `b`ack.
    fn said(node: &mut Silence<u8>, inputs: &[(i64, bool)]) -> String {
        let mut said = String::new();
        for (ms, comes) in inputs {
            let (mut silent, mut back) = (None, None);
            let ctx = Ctx::new(Time::from_millis(*ms));
            let value = comes.then_some(7);
            let sent = node.process(value.as_ref(), &ctx, apex_rt::event(&mut silent), apex_rt::event(&mut back));
            assert_eq!(sent, value);
            said.push(match (silent, back) {
                (None, None) => '-',
                (Some(()), None) => 's',
                (None, Some(())) => 'b',
                (Some(()), Some(())) => '!',
            });
        }
        said
    }

    #[test]
    fn silence_begins_once_and_ends_once() {
        let mut node = Silence::construct((0.5,));
        let inputs = [(0, true), (400, false), (500, false), (1000, false), (1100, true), (1200, true), (1700, false)];
        assert_eq!(said(&mut node, &inputs), "--s-b-s");
    }

    #[test]
    fn an_input_that_never_comes_is_silent() {
        let mut node = Silence::construct((0.5,));
        assert_eq!(said(&mut node, &[(2000, false), (2400, false), (2500, false), (2600, true)]), "--sb");
    }
}
