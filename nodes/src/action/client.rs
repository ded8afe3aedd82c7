//! Client of an action.

use super::{End, GoalId, Loss, Order, Report};
use apex_rt::{Ctx, Event, node};
use core::marker::PhantomData;

/// Types of the tokens of a client.
type Tokens<G, F, R> = PhantomData<fn() -> (G, F, R)>;

/// Goal that another program carries out. The node is active while its goal is under way: activity that comes with a
/// goal to `begin` sends it, and whatever takes the activity away calls it off. A goal that comes without activity is
/// ignored. Each end of a goal is an event, with which the activity leaves; `result` comes with the ends of goals that
/// were accepted, `loss` with `lost`.
///
/// Only reports of the goal that is under way count. Late and repeated reports of earlier goals do nothing. A goal that
/// is called off before it was accepted is called off as soon as it is.
///
/// The node says what it wants at `order`; an [`ActionLink`] sends that, and calls off what was left:
/// `go.order -> link.send; go.deactivated -> link.left; reports -> [link.report, go.report]; link -> orders`.
///
/// Activity that `resume` gives back has no goal. Send the goal again: `task.cancelled => …; again => go.begin`.
#[node]
#[derive(Debug, Clone)]
pub struct ActionClient<G, F, R> {
    /// Number that makes the identifications of this client's goals differ from those of others at the same server.
    /// They count on from it, so that each run has the same ones.
    #[param(default = 0)]
    seed: u64,
    /// Number of goals so far.
    count: u64,
    under_way: Option<GoalId>,
    _tokens: Tokens<G, F, R>,
}

#[node]
impl<G: Clone, F: Clone, R: Clone> ActionClient<G, F, R> {
    /// Begins: sends the goal. A goal that is under way is called off.
    #[slot]
    fn begin(&mut self, goal: &G, ctx: &Ctx, order: Event<Order<G>>) {
        if !ctx.active() {
            return;
        }
        self.count += 1;
        let id = GoalId(u128::from(self.seed) << 64 | u128::from(self.count));
        let replaces = self.under_way.replace(id);
        order.emit(Order::Send { id, goal: goal.clone(), replaces });
    }

    /// Takes a report of the server.
    #[slot]
    #[allow(clippy::too_many_arguments, reason = "each end is an event of its own")]
    fn report(
        &mut self,
        report: &Report<F, R>,
        accepted: Event<()>,
        feedback: Event<F>,
        result: Event<R>,
        succeeded: Event<()>,
        #[failure] aborted: Event<()>,
        #[failure] canceled: Event<()>,
        #[failure] rejected: Event<()>,
        #[failure] lost: Event<()>,
        loss: Event<Loss>,
    ) {
        let Some(goal) = self.under_way else { return };
        if report.ends(goal) {
            self.under_way = None;
        } else if report.id() != Some(goal) {
            return;
        }
        match report {
            Report::Accepted { id, .. } if *id == goal => accepted.emit(()),
            Report::Accepted { .. } | Report::AllAborted => aborted.emit(()),
            Report::Rejected { .. } => rejected.emit(()),
            Report::Feedback { feedback: message, .. } => feedback.emit(message.clone()),
            Report::Ended { end, result: of_goal, .. } => {
                result.emit(of_goal.clone());
                match end {
                    End::Succeeded => succeeded.emit(()),
                    End::Canceled => canceled.emit(()),
                    End::Aborted => aborted.emit(()),
                }
            }
            Report::Lost { loss: reason, .. } => {
                loss.emit(*reason);
                lost.emit(());
            }
        }
    }

    /// Lets go of the goal.
    #[on_deactivate]
    fn let_go(&mut self) {
        self.under_way = None;
    }
}

/// Way from an [`ActionClient`] to the server: sends its orders, and calls a goal off that the client has left before
/// its end.
#[node]
#[derive(Debug, Clone, Default)]
pub struct ActionLink<G, F, R> {
    under_way: Option<GoalId>,
    _tokens: Tokens<G, F, R>,
}

#[node]
impl<G: Clone, F, R> ActionLink<G, F, R> {
    /// Sends an order of the client.
    #[slot]
    fn send(&mut self, order: &Order<G>, orders: Event<Order<G>>) {
        if let Order::Send { id, .. } = order {
            self.under_way = Some(*id);
        }
        orders.emit(order.clone());
    }

    /// Notes that the client is not active any more, and calls its goal off.
    #[slot]
    fn left(&mut self, orders: Event<Order<G>>) {
        if let Some(id) = self.under_way.take() {
            orders.emit(Order::Cancel { id });
        }
    }

    /// Notes the end of a goal.
    #[slot]
    fn report(&mut self, report: &Report<F, R>) {
        self.under_way = self.under_way.filter(|goal| !report.ends(*goal));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use apex_rt::{Construct, Time, event};

    /// Events of a call of `report`: accepted, feedback, and the end of the goal by its number in the list of events.
    fn report(client: &mut ActionClient<u8, u8, u8>, token: &Report<u8, u8>) -> (bool, Option<u8>, Option<usize>) {
        let (mut accepted, mut feedback, mut result, mut succeeded, mut aborted) = (None, None, None, None, None);
        let (mut canceled, mut rejected, mut lost, mut loss) = (None, None, None, None);
        client.report(
            token,
            event(&mut accepted),
            event(&mut feedback),
            event(&mut result),
            event(&mut succeeded),
            event(&mut aborted),
            event(&mut canceled),
            event(&mut rejected),
            event(&mut lost),
            event(&mut loss),
        );
        let ends = [succeeded.is_some(), aborted.is_some(), canceled.is_some(), rejected.is_some(), lost.is_some()];
        assert!(ends.iter().filter(|end| **end).count() <= 1);
        let is_end = matches!(token, Report::Ended { .. }) && ends.contains(&true);
        assert_eq!((result.is_some(), loss.is_some()), (is_end, lost.is_some()));
        (accepted.is_some(), feedback, ends.iter().position(|end| *end))
    }

    /// Any sequence of beginnings, cancels and reports of any goal, in any order and repeated: each goal has at most
    /// one end, and a report of another goal than the present one does nothing.
    #[test]
    fn only_reports_of_the_present_goal_count() {
        let mut random = Random::new(5);
        for _ in 0..2000 {
            let mut client = ActionClient::<u8, u8, u8>::construct((3,));
            let (mut count, mut present) = (0_u64, None);
            let id = |number: u64| GoalId(3 << 64 | u128::from(number));
            for _ in 0..30 {
                match random.below(4) {
                    0 => {
                        let (ctx, mut order) = (Ctx::new(Time::ZERO).of_node(true), None);
                        client.begin(&7, &ctx, event(&mut order));
                        count += 1;
                        let replaces = present.replace(count).map(id);
                        assert_eq!(order, Some(Order::Send { id: id(count), goal: 7, replaces }));
                    }
                    1 => {
                        client.let_go();
                        present = None;
                    }
                    _ => {
                        let number = random.below(count + 2);
                        let is_present = present == Some(number);
                        let goal = id(number);
                        let which = random.below(8);
                        let token = match which {
                            0 => Report::Accepted { id: goal, replaces: None },
                            1 => Report::Feedback { id: goal, feedback: 9 },
                            2 => Report::Ended { id: goal, end: End::Succeeded, result: 1 },
                            3 => Report::Ended { id: goal, end: End::Aborted, result: 1 },
                            4 => Report::Ended { id: goal, end: End::Canceled, result: 1 },
                            5 => Report::Rejected { id: goal },
                            7 => Report::AllAborted,
                            _ => Report::Lost { id: goal, loss: Loss::NoServer },
                        };
                        let (accepted, feedback, end) = report(&mut client, &token);
                        assert_eq!(accepted, is_present && which == 0);
                        assert_eq!(feedback, (is_present && which == 1).then_some(9));
                        let expected = match which {
                            7 => present.map(|_| 1),
                            _ => which.checked_sub(2).map(|end| end as usize).filter(|_| is_present),
                        };
                        assert_eq!(end, expected);
                        present = present.filter(|_| end.is_none());
                    }
                }
            }
        }
    }

    #[test]
    fn a_goal_without_activity_is_ignored() {
        let (ctx, mut order) = (Ctx::new(Time::ZERO).of_node(false), None);
        ActionClient::<u8, u8, u8>::construct((0,)).begin(&7, &ctx, event(&mut order));
        assert_eq!(order, None);
    }

    #[test]
    fn what_was_left_before_its_end_is_called_off_once() {
        let mut link = ActionLink::<u8, u8, u8>::default();
        let id = GoalId(1);
        let left = |link: &mut ActionLink<u8, u8, u8>| {
            let mut orders = None;
            link.left(event(&mut orders));
            orders
        };
        let send = |link: &mut ActionLink<u8, u8, u8>| {
            let (order, mut orders) = (Order::Send { id, goal: 7, replaces: None }, None);
            link.send(&order, event(&mut orders));
            assert_eq!(orders, Some(order));
        };
        assert_eq!(left(&mut link), None);
        send(&mut link);
        assert_eq!((left(&mut link), left(&mut link)), (Some(Order::Cancel { id }), None));
        send(&mut link);
        link.report(&Report::Accepted { id, replaces: None });
        link.report(&Report::Ended { id: GoalId(0), end: End::Succeeded, result: 0 });
        assert_eq!(left(&mut link), Some(Order::Cancel { id }));
        send(&mut link);
        link.report(&Report::Ended { id, end: End::Succeeded, result: 0 });
        assert_eq!(left(&mut link), None);
    }
}
