//! Server of an action.

use super::{End, GoalId, Order, Report};
use apex_rt::{Ctx, Event, node};
use core::marker::PhantomData;

/// Goals of other programs, one at a time. The node is active while it waits for a goal. The activity leaves with
/// `goal` for the nodes that carry it out, and comes back with the end: to `succeed`, `reached`, `abort`, `canceled` or
/// `give_up`.
/// A goal that comes while the activity is elsewhere, and no goal is under way, is refused: the robot is busy.
///
/// `stop` is triggered when the client calls its goal off. It takes the activity away from the work, which brings it
/// back: `start => serve.ready; serve.goal => work.begin; serve.stop -> work.cancel; work.cancelled => serve.canceled`.
/// A cancel that does not come from a client aborts the goal.
#[node]
#[derive(Debug, Clone)]
pub struct ActionServer<G, F, R> {
    /// Lets a new goal take the place of the one that is under way, which is then stopped and aborted. Otherwise the
    /// new goal is refused.
    #[param(default = true)]
    preempts: bool,
    current: Option<Current>,
    /// Goal that was accepted and begins when the present one has ended.
    next: Option<(GoalId, G)>,
    _tokens: PhantomData<fn() -> (F, R)>,
}

/// Goal that is under way.
#[derive(Debug, Clone, Copy)]
struct Current {
    id: GoalId,
    /// End of the goal if its work is cancelled.
    stopped: End,
}

#[node]
impl<G: Clone, F: Clone, R: Clone + Default> ActionServer<G, F, R> {
    /// Waits for goals: `start => serve.ready`. A goal that is still under way is aborted.
    #[slot]
    fn ready(&mut self, ctx: &Ctx, goal: Event<G>, reports: Event<Report<F, R>>) {
        self.end(End::Aborted, R::default(), ctx, goal, reports);
    }

    /// Takes an order of a client.
    #[slot]
    fn order(&mut self, order: &Order<G>, ctx: &Ctx, goal: Event<G>, stop: Event<()>, reports: Event<Report<F, R>>) {
        match order {
            Order::Send { id, goal: wanted, .. } if self.current.is_none() && ctx.active() => {
                self.current = Some(Current { id: *id, stopped: End::Aborted });
                goal.emit(wanted.clone());
                reports.emit(Report::Accepted { id: *id, replaces: None });
            }
            Order::Send { id, goal: wanted, replaces } if self.preempts || *replaces == self.id() => {
                let Some(current) = &mut self.current else { return reports.emit(Report::Rejected { id: *id }) };
                if *replaces == Some(current.id) {
                    current.stopped = End::Canceled;
                }
                let waiting = self.next.replace((*id, wanted.clone()));
                stop.emit(());
                reports.emit(Report::Accepted { id: *id, replaces: waiting.map(|(id, _)| id) });
            }
            Order::Send { id, .. } => reports.emit(Report::Rejected { id: *id }),
            Order::Cancel { id } if self.id() == Some(*id) => {
                self.current = Some(Current { id: *id, stopped: End::Canceled });
                stop.emit(());
            }
            Order::Cancel { id } => {
                if self.next.take_if(|(next, _)| next == id).is_some() {
                    reports.emit(Report::Ended { id: *id, end: End::Canceled, result: R::default() });
                }
            }
        }
    }

    /// Tells the client how far its goal is.
    #[slot]
    fn feedback(&mut self, feedback: &F, reports: Event<Report<F, R>>) {
        if let Some(id) = self.id() {
            reports.emit(Report::Feedback { id, feedback: feedback.clone() });
        }
    }

    /// Ends the goal with success.
    #[slot]
    fn succeed(&mut self, result: &R, ctx: &Ctx, goal: Event<G>, reports: Event<Report<F, R>>) {
        self.end(End::Succeeded, result.clone(), ctx, goal, reports);
    }

    /// Ends the goal without success.
    #[slot]
    fn abort(&mut self, result: &R, ctx: &Ctx, goal: Event<G>, reports: Event<Report<F, R>>) {
        self.end(End::Aborted, result.clone(), ctx, goal, reports);
    }

    /// Ends the goal with success and without a result.
    #[slot]
    fn reached(&mut self, ctx: &Ctx, goal: Event<G>, reports: Event<Report<F, R>>) {
        self.end(End::Succeeded, R::default(), ctx, goal, reports);
    }

    /// Ends the goal without success and without a result, and one that waits for its end, too: the robot is to stop.
    #[slot]
    fn give_up(&mut self, reports: Event<Report<F, R>>) {
        let (current, next) = (self.current.take(), self.next.take());
        match (current, next) {
            (None, None) => {}
            (Some(Current { id, .. }), None) | (None, Some((id, _))) => {
                reports.emit(Report::Ended { id, end: End::Aborted, result: R::default() });
            }
            (Some(_), Some(_)) => reports.emit(Report::AllAborted),
        }
    }

    /// Notes that the work was cancelled.
    #[slot]
    fn canceled(&mut self, ctx: &Ctx, goal: Event<G>, reports: Event<Report<F, R>>) {
        let end = self.current.map_or(End::Aborted, |current| current.stopped);
        self.end(end, R::default(), ctx, goal, reports);
    }

    fn id(&self) -> Option<GoalId> {
        self.current.map(|current| current.id)
    }

    /// Ends the present goal, and begins the next one as soon as the activity is there.
    fn end(&mut self, end: End, result: R, ctx: &Ctx, goal: Event<G>, reports: Event<Report<F, R>>) {
        if let Some(Current { id, .. }) = self.current.take() {
            reports.emit(Report::Ended { id, end, result });
        }
        if ctx.active()
            && let Some((id, wanted)) = self.next.take()
        {
            self.current = Some(Current { id, stopped: End::Aborted });
            goal.emit(wanted);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use apex_rt::{Construct, Time, event};
    use std::collections::BTreeMap;

    /// A server, where its activity is, and the state of its goals.
    struct Test {
        server: ActionServer<u64, u8, u8>,
        /// `true` if the server has the activity, otherwise its work has it.
        is_here: bool,
        /// Goals that were sent: `None` if they are under way, or the number of their ends.
        ends: BTreeMap<GoalId, Option<u32>>,
    }

    impl Test {
        /// Calls a slot, and follows the activity and the goals.
        fn call(
            &mut self,
            call: impl FnOnce(
                &mut ActionServer<u64, u8, u8>,
                &Ctx,
                Event<'_, u64>,
                Event<'_, ()>,
                Event<'_, Report<u8, u8>>,
            ),
        ) -> bool {
            let ctx = Ctx::new(Time::ZERO).of_node(self.is_here);
            let (mut goal, mut stop, mut report) = (None, None, None);
            call(&mut self.server, &ctx, event(&mut goal), event(&mut stop), event(&mut report));
            if goal.is_some() {
                assert!(self.is_here, "a goal takes the activity along");
                self.is_here = false;
            }
            match report {
                Some(Report::Accepted { id, replaces }) => {
                    assert_eq!(self.ends.insert(id, Some(0)), Some(None), "it was asked for once");
                    replaces.into_iter().for_each(|id| self.end(id));
                }
                Some(Report::Rejected { id }) => assert_eq!(self.ends.remove(&id), Some(None)),
                Some(Report::Ended { id, .. }) => self.end(id),
                Some(Report::Feedback { id, .. }) => assert_eq!(self.ends.get(&id), Some(&Some(0))),
                Some(Report::AllAborted) => {
                    let open = self.ends.values_mut().flatten().filter(|ends| **ends == 0);
                    open.for_each(|ends| *ends = 1);
                }
                Some(Report::Lost { .. }) => panic!("a server loses nothing"),
                None => {}
            }
            stop.is_some()
        }

        fn end(&mut self, id: GoalId) {
            let ends = self.ends.get_mut(&id).and_then(Option::as_mut).expect("it was accepted");
            *ends += 1;
        }
    }

    /// Any sequence of orders, ends of the work and repeated ends: each goal is accepted or refused at once, an
    /// accepted one has exactly one end, and the goals never outnumber the activity.
    #[test]
    fn each_goal_that_is_accepted_has_one_end() {
        let mut random = Random::new(11);
        for round in 0..2000 {
            let server = ActionServer::construct((round % 2 == 0,));
            let mut test = Test { server, is_here: false, ends: BTreeMap::new() };
            let mut count = 0;
            for _ in 0..40 {
                match random.below(7) {
                    0 | 1 => {
                        count += 1;
                        let id = GoalId(count);
                        test.ends.insert(id, None);
                        let replaces = (random.below(2) == 0).then(|| GoalId(count - 1));
                        let order = Order::Send { id, goal: 7, replaces };
                        test.call(|server, ctx, goal, stop, reports| server.order(&order, ctx, goal, stop, reports));
                        assert_ne!(test.ends.get(&id), Some(&None), "it was answered");
                    }
                    2 => {
                        let order = Order::Cancel { id: GoalId(u128::from(random.below(count as u64 + 2))) };
                        let is_stopped = test.call(|server, ctx, goal, stop, reports| {
                            server.order(&order, ctx, goal, stop, reports);
                        });
                        if is_stopped {
                            test.is_here = true;
                            test.call(|server, ctx, goal, _, reports| server.canceled(ctx, goal, reports));
                        }
                    }
                    // The activity comes back from the work, or from elsewhere.
                    3 => {
                        test.is_here = true;
                        test.call(|server, ctx, goal, _, reports| server.succeed(&1, ctx, goal, reports));
                    }
                    4 => {
                        test.is_here = true;
                        test.call(|server, ctx, goal, _, reports| server.ready(ctx, goal, reports));
                    }
                    5 => drop(test.call(|server, _, _, _, reports| server.give_up(reports))),
                    // A result without activity.
                    _ => drop(test.call(|server, ctx, goal, _, reports| server.abort(&1, ctx, goal, reports))),
                }
                let under_way = test.ends.values().filter(|ends| **ends == Some(0)).count();
                assert!(under_way <= 2 && test.ends.values().all(|ends| ends.is_some_and(|ends| ends <= 1)));
            }
            // The last goals end, too.
            for _ in 0..2 {
                test.is_here = true;
                test.call(|server, ctx, goal, _, reports| server.succeed(&1, ctx, goal, reports));
            }
            assert!(test.ends.values().all(|ends| *ends == Some(1)));
        }
    }
}
