//! Nodes that depend on activity (thesis 7.1.2). All other nodes only pass it on.

use apex_rt::{Ctx, Event, Time, node};
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

/// Action that another program, a driver or a person carries out. It is active from `begin` until it is done or has
/// failed. Only activity counts: an order without activity is ignored, also while another one is under way, and so is a
/// result that comes when the action is not active, for example after it was cancelled, or when its order has one.
///
/// An order that is called off (by `cancel` or a `timeout`) may still be answered, when the next order is already under
/// way. Orders have numbers (`number`, from 1 on): a result with a number, at `succeeded` or `failed_order`, counts
/// only for the order of that number. A result without a number, at `succeed` or `fail`, is taken for that of the order
/// that was called off if that one has no result yet, and the next order began less than `late` ago.
#[node]
#[derive(Debug, Clone)]
pub struct Action<T> {
    /// Time after the beginning of an order in which a result without a number belongs to the order that was called off
    /// before: less than an order takes. 0 if an order that is called off is never answered.
    #[param(unit = "s", default = 1.0, range = 0.0..=3600.0)]
    late: f32,
    /// Number of the last order, and the time when it began.
    order: u64,
    begun: Time,
    is_under_way: bool,
    /// `true` if the last order has its result: another one for it is a repetition.
    has_ended: bool,
    /// Number of orders that were called off and have no result yet.
    owed: u32,
    /// `true` if a result was dropped since the last order began.
    has_dropped: bool,
    _goal: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Action<T> {
    /// Begins: `started` takes the goal to the one who carries it out, and `number` the number of the order.
    #[slot]
    fn begin(&mut self, goal: &T, ctx: &Ctx, started: Event<T>, number: Event<u64>) {
        if ctx.active() && !self.is_under_way {
            self.order += 1;
            self.begun = ctx.now();
            self.is_under_way = true;
            (self.has_ended, self.has_dropped) = (false, false);
            started.emit(goal.clone());
            number.emit(self.order);
        }
    }

    /// Reports success, which triggers `done`.
    #[slot]
    fn succeed(&mut self, ctx: &Ctx, done: Event<()>) {
        if self.ends(ctx) {
            done.emit(());
        }
    }

    /// Reports failure, which triggers `gave_up`.
    #[slot]
    fn fail(&mut self, ctx: &Ctx, #[failure] gave_up: Event<()>) {
        if self.ends(ctx) {
            gave_up.emit(());
        }
    }

    /// Reports success of the order with this number, which triggers `done`.
    #[slot]
    fn succeeded(&mut self, order: &u64, ctx: &Ctx, done: Event<()>) {
        if self.ends_order(*order, ctx) {
            done.emit(());
        }
    }

    /// Reports failure of the order with this number, which triggers `gave_up`.
    #[slot]
    fn failed_order(&mut self, order: &u64, ctx: &Ctx, #[failure] gave_up: Event<()>) {
        if self.ends_order(*order, ctx) {
            gave_up.emit(());
        }
    }

    /// Notes that the order was called off, unless it has ended.
    #[on_deactivate]
    fn call_off(&mut self) {
        if core::mem::take(&mut self.is_under_way) {
            // What was dropped may have been the result of this order.
            self.owed += u32::from(!self.has_dropped);
        }
    }

    /// Takes a result without a number, and returns `true` if it ends the order.
    fn ends(&mut self, ctx: &Ctx) -> bool {
        let is_late = !ctx.active() || self.is_under_way && ctx.now().since(self.begun).as_secs_f32() < self.late;
        if is_late && self.owed > 0 {
            self.owed -= 1;
            self.has_dropped = self.is_under_way;
            return false;
        }
        self.end(ctx)
    }

    /// Takes a result with a number, and returns `true` if it ends the order.
    fn ends_order(&mut self, order: u64, ctx: &Ctx) -> bool {
        if order != self.order {
            self.owed = self.owed.saturating_sub(1);
            return false;
        }
        self.end(ctx)
    }

    /// Ends the order if the node is active, once. What is still owed will not come any more.
    fn end(&mut self, ctx: &Ctx) -> bool {
        let ends = ctx.active() && !self.has_ended && self.order > 0;
        if ends {
            (self.is_under_way, self.has_ended) = (false, true);
            self.owed = 0;
        }
        ends
    }
}

/// Counts failures of something that is tried several times: the first ones trigger `again`, the last one `give_up`,
/// and the count begins again. Activity that arrives with a failure leaves with the event.
///
/// A job that may be interrupted goes through `begin`, so that it begins with all attempts each time:
/// `begin => tries.begin; [tries.begun, tries.again] => action.begin; action.gave_up => tries.failed`.
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
    /// Begins a job with all attempts, whatever became of the last one: triggers `begun`, with which the activity
    /// leaves.
    #[slot]
    fn begin(&mut self, begun: Event<()>) {
        self.failures = 0;
        begun.emit(());
    }

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
    use apex_rt::Construct;

    #[test]
    fn the_gate_is_open_while_it_is_active() {
        let ctx = Ctx::new(Time::ZERO);
        let mut node = ActivityGate::default();
        node.activate();
        assert_eq!(node.process(&ctx, &1), None, "that is for the graph to say");
        assert_eq!(node.process(&ctx.of_node(true), &2), Some(2));
    }

    /// An action with the times and activity that its slots see.
    struct Test(Action<u32>, i64);

    impl Test {
        fn new(late: f32) -> Self {
            Self(Action::construct((late,)), 0)
        }

        fn ctx(&self, active: bool) -> Ctx {
            Ctx::new(Time::from_millis(self.1)).of_node(active)
        }

        /// Number of the order that began.
        fn begin(&mut self, active: bool) -> Option<u64> {
            let (ctx, mut started, mut number) = (self.ctx(active), None, None);
            self.0.begin(&7, &ctx, apex_rt::event(&mut started), apex_rt::event(&mut number));
            assert_eq!(started.is_some(), number.is_some());
            number
        }

        fn succeed(&mut self, active: bool) -> bool {
            let (ctx, mut done) = (self.ctx(active), None);
            self.0.succeed(&ctx, apex_rt::event(&mut done));
            if done.is_some() {
                // The activity leaves with the event.
                self.0.call_off();
            }
            done.is_some()
        }
    }

    #[test]
    fn an_action_reports_only_while_it_is_active() {
        let mut test = Test::new(1.0);
        assert_eq!(test.begin(false), None);
        assert_eq!(test.begin(true), Some(1));
        assert_eq!(test.begin(true), None, "the first order is under way");
        assert!(!test.succeed(false) && test.succeed(true));
        assert_eq!(test.begin(true), Some(2));
        let (ctx, mut gave_up) = (test.ctx(true), None);
        test.0.fail(&ctx, apex_rt::event(&mut gave_up));
        assert!(gave_up.is_some());
    }

    #[test]
    fn a_late_result_does_not_end_the_next_order() {
        let mut test = Test::new(1.0);
        test.begin(true);
        test.0.call_off();
        test.begin(true);
        test.1 = 500;
        assert!(!test.succeed(true), "it is that of the first order");
        assert!(test.succeed(true), "it is that of the second one");
        // A result while no order is under way is that of the last one.
        test.begin(true);
        test.0.call_off();
        assert!(!test.succeed(false));
        test.begin(true);
        assert!(test.succeed(true));
    }

    #[test]
    fn an_order_that_is_never_answered_does_not_cost_others_their_result() {
        let mut test = Test::new(1.0);
        test.begin(true);
        test.0.call_off();
        test.begin(true);
        test.1 = 1000;
        assert!(test.succeed(true), "a result of the first order would have come earlier");
        // Orders that are answered at once, after one that was lost: at most one result is taken for that of another.
        test.begin(true);
        test.0.call_off();
        test.begin(true);
        assert!(!test.succeed(true));
        test.0.call_off();
        test.begin(true);
        assert!(test.succeed(true));
        let mut test = Test::new(0.0);
        test.begin(true);
        test.0.call_off();
        test.begin(true);
        assert!(test.succeed(true));
    }

    #[test]
    fn a_result_with_a_number_counts_for_that_order() {
        let mut test = Test::new(1.0);
        let succeed = |test: &mut Test, order: u64| {
            let (ctx, mut done) = (test.ctx(true), None);
            test.0.succeeded(&order, &ctx, apex_rt::event(&mut done));
            done.is_some()
        };
        test.begin(true);
        test.0.call_off();
        test.begin(true);
        assert!(!succeed(&mut test, 1) && succeed(&mut test, 2));
        test.begin(true);
        test.0.call_off();
        test.begin(true);
        let (ctx, mut gave_up) = (test.ctx(true), None);
        test.0.failed_order(&4, &ctx, apex_rt::event(&mut gave_up));
        assert!(gave_up.is_some(), "though the third order has no result");
    }

    /// Any sequence of orders, interruptions and results with numbers, which come late, early, repeated, or with and
    /// without activity: a result ends its own order only, while that one has the activity, and once.
    #[test]
    fn a_numbered_result_ends_its_own_order_once() {
        let mut random = crate::math::Random::new(5);
        for round in 0..4000 {
            // The activity may stay at the node when its order has ended: `done ->`.
            let (mut test, stays) = (Test::new(1.0), round % 2 == 0);
            let (mut last, mut is_over, mut is_active) = (0, true, false);
            for _ in 0..30 {
                test.1 += random.below(700) as i64;
                match random.below(4) {
                    0 => {
                        is_active = true;
                        let begins = test.begin(true);
                        assert_eq!(begins.is_some(), is_over, "an order begins when none is under way");
                        last = begins.unwrap_or(last);
                        is_over = false;
                    }
                    1 if is_active => {
                        test.0.call_off();
                        (is_active, is_over) = (false, true);
                    }
                    _ => {
                        let (ctx, order, succeeds) =
                            (test.ctx(is_active), random.below(last + 2), random.below(2) == 0);
                        let (mut done, mut gave_up) = (None, None);
                        match succeeds {
                            true => test.0.succeeded(&order, &ctx, apex_rt::event(&mut done)),
                            false => test.0.failed_order(&order, &ctx, apex_rt::event(&mut gave_up)),
                        }
                        let ends = done.is_some() || gave_up.is_some();
                        assert_eq!(ends, is_active && !is_over && order == last, "order {order} of {last}");
                        is_over |= ends;
                        if ends && !stays {
                            test.0.call_off();
                            is_active = false;
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_repeated_result_does_not_end_it_again() {
        let mut test = Test::new(1.0);
        test.begin(true);
        let mut results = || {
            let (ctx, mut done) = (test.ctx(true), None);
            test.0.succeed(&ctx, apex_rt::event(&mut done));
            done.is_some()
        };
        // The activity stays: `done ->`.
        assert_eq!([results(), results()], [true, false]);
    }

    #[test]
    fn an_order_that_is_resumed_can_end() {
        let mut test = Test::new(1.0);
        test.begin(true);
        test.0.call_off();
        // `resume` gives the activity back.
        assert!(test.succeed(true));
    }

    /// Notes a failure; returns `true` if it was the last one.
    fn fails_next(node: &mut Attempts) -> bool {
        let (mut again, mut give_up) = (None, None);
        node.failed(apex_rt::event(&mut again), apex_rt::event(&mut give_up));
        give_up.is_some()
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
        assert!(!fails_next(&mut node));
        let mut begun = None;
        node.begin(apex_rt::event(&mut begun));
        assert!(begun.is_some() && !fails_next(&mut node));
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
