//! Goals of a client, without their way: what came, and what is to be done.

use super::id::Ids;
use apex_messages::action_msgs::{CancelGoalResponse, GoalStatus};
use apex_nodes::action::{End, GoalId, Loss, Order, Report};
use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

/// Time without a server after which a goal is lost.
pub const PATIENCE: Duration = Duration::from_millis(2500);

/// Task for a goal. The identifications are those among all programs, but in reports.
#[derive(Debug, PartialEq)]
pub enum Deed<G, F, R> {
    /// Ask the server to accept it.
    Ask(GoalId, G),
    /// Ask for its result.
    AskResult(GoalId),
    /// Ask the server to call it off.
    Cancel(GoalId),
    /// Report to the program.
    Report(Report<F, R>),
    /// Say that something goes wrong.
    Tell(&'static str),
}

/// Goals of a client that have not ended.
pub struct Goals<G> {
    ids: Ids,
    /// Time that the server has to accept a goal.
    timeout: Duration,
    goals: BTreeMap<GoalId, Goal<G>>,
    /// Time at which the server was there last.
    served: Option<Instant>,
}

/// A goal that was sent.
struct Goal<G> {
    /// Identification in the program.
    id: GoalId,
    /// Goal, as long as it may have to be sent again.
    goal: Option<G>,
    stage: Stage,
    since: Instant,
    /// `true` if a question was answered with nothing, because there was no server, and is asked again.
    is_open: bool,
    /// `true` if the program has called it off, or was told that it is lost: nothing is reported.
    is_left: bool,
    is_told: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Stage {
    /// The server has not answered yet.
    Asked,
    /// The server has accepted it.
    Accepted,
    /// The server was asked to call it off.
    Canceling,
}

impl<G: Clone> Goals<G> {
    /// Returns a client without goals.
    pub fn new(ids: Ids, timeout: Duration, now: Instant) -> Self {
        Self { ids, timeout, goals: BTreeMap::new(), served: Some(now) }
    }

    /// Returns `true` if nothing is under way.
    pub fn are_over(&self) -> bool {
        self.goals.is_empty()
    }

    /// Takes an order of the program.
    pub fn order<F, R>(&mut self, order: Order<G>, now: Instant, out: &mut Vec<Deed<G, F, R>>) {
        match order {
            Order::Send { id, goal, replaces } => {
                replaces.into_iter().for_each(|id| self.call_off(self.ids.of(id), out));
                let outside = self.ids.of(id);
                out.push(Deed::Ask(outside, goal.clone()));
                let stage = Stage::Asked;
                let goal =
                    Goal { id, goal: Some(goal), stage, since: now, is_open: false, is_left: false, is_told: false };
                self.goals.insert(outside, goal);
            }
            Order::Cancel { id } => self.call_off(self.ids.of(id), out),
        }
    }

    /// Calls all goals off: the program has ended.
    pub fn end<F, R>(&mut self, out: &mut Vec<Deed<G, F, R>>) {
        let all: Vec<GoalId> = self.goals.keys().copied().collect();
        all.into_iter().for_each(|id| self.call_off(id, out));
    }

    /// Calls a goal off. One that was not accepted yet is called off when it is.
    fn call_off<F, R>(&mut self, id: GoalId, out: &mut Vec<Deed<G, F, R>>) {
        let Some(goal) = self.goals.get_mut(&id).filter(|goal| !goal.is_left) else { return };
        goal.is_left = true;
        match goal.stage {
            Stage::Accepted => {
                (goal.stage, goal.is_open) = (Stage::Canceling, false);
                out.push(Deed::Cancel(id));
            }
            // It never came to a server.
            Stage::Asked if goal.is_open => drop(self.goals.remove(&id)),
            Stage::Asked | Stage::Canceling => {}
        }
    }

    /// Takes the answer of the server to a goal: `true` if it accepts it, `None` if no server has answered.
    pub fn answer<F, R>(&mut self, id: GoalId, accepted: Option<bool>, now: Instant, out: &mut Vec<Deed<G, F, R>>) {
        let Some(goal) = self.goals.get_mut(&id).filter(|goal| goal.stage == Stage::Asked) else { return };
        match (accepted, goal.is_left) {
            (Some(true), false) => {
                (goal.stage, goal.goal, goal.is_open, goal.since) = (Stage::Accepted, None, false, now);
                out.extend([Deed::Report(Report::Accepted { id: goal.id, replaces: None }), Deed::AskResult(id)]);
            }
            (Some(true), true) => {
                (goal.stage, goal.since) = (Stage::Canceling, now);
                out.push(Deed::Cancel(id));
            }
            (Some(false), false) => {
                let id_here = goal.id;
                self.goals.remove(&id);
                out.push(Deed::Report(Report::Rejected { id: id_here }));
            }
            (None, false) => goal.is_open = true,
            (Some(false) | None, true) => drop(self.goals.remove(&id)),
        }
    }

    /// Takes feedback.
    pub fn feedback<F, R>(&self, id: GoalId, feedback: F, out: &mut Vec<Deed<G, F, R>>) {
        let goal = self.goals.get(&id).filter(|goal| goal.stage == Stage::Accepted);
        out.extend(goal.map(|goal| Deed::Report(Report::Feedback { id: goal.id, feedback })));
    }

    /// Takes a result with its status; `None` if no server has answered.
    pub fn result<F, R>(&mut self, id: GoalId, result: Option<(i8, R)>, out: &mut Vec<Deed<G, F, R>>) {
        let Some(goal) = self.goals.get_mut(&id).filter(|goal| goal.stage == Stage::Accepted) else { return };
        let Some((status, result)) = result else {
            goal.is_open = true;
            return;
        };
        let id_here = goal.id;
        self.goals.remove(&id);
        out.push(Deed::Report(match end(status) {
            Some(end) => Report::Ended { id: id_here, end, result },
            // It does not know the goal. Anything else but success would be as good.
            None => Report::Lost { id: id_here, loss: Loss::Forgotten },
        }));
    }

    /// Takes the answer of the server to a cancel; `None` if no server has answered.
    pub fn canceled<F, R>(&mut self, id: GoalId, code: Option<i8>, out: &mut Vec<Deed<G, F, R>>) {
        let Some(goal) = self.goals.get_mut(&id).filter(|goal| goal.stage == Stage::Canceling) else { return };
        match code {
            None => goal.is_open = true,
            Some(code) => {
                self.goals.remove(&id);
                if code == CancelGoalResponse::ERROR_REJECTED {
                    out.push(Deed::Tell("the server goes on with a goal that was called off: it refuses the cancel"));
                }
            }
        }
    }

    /// Looks at goals that wait. `is_served` is `true` while a server is there.
    pub fn look<F, R>(&mut self, is_served: bool, now: Instant, out: &mut Vec<Deed<G, F, R>>) {
        if is_served {
            self.served = Some(now);
        }
        let is_gone = self.served.is_none_or(|served| now - served >= PATIENCE);
        let mut over = vec![];
        for (&id, goal) in &mut self.goals {
            let waits = now - goal.since;
            let is_asked = goal.stage == Stage::Asked;
            if is_asked && !goal.is_left && !goal.is_told && is_served && waits >= PATIENCE {
                goal.is_told = true;
                out.push(Deed::Tell("the server is there, but has neither accepted nor rejected a goal"));
            }
            // A goal is not lost before it had a chance.
            let loss = match goal.stage {
                _ if is_gone && waits >= PATIENCE && is_asked => Some(Loss::NoServer),
                _ if is_gone && waits >= PATIENCE => Some(Loss::ServerGone),
                Stage::Asked if waits >= self.timeout => Some(Loss::NoAnswer),
                _ => None,
            };
            match loss {
                Some(loss) => {
                    if !goal.is_left {
                        out.push(Deed::Report(Report::Lost { id: goal.id, loss }));
                    }
                    // The server may accept it after all: then it is called off.
                    goal.is_left = true;
                    if goal.is_open || loss != Loss::NoAnswer {
                        over.push(id);
                    }
                }
                None if goal.is_open && is_served => {
                    goal.is_open = false;
                    match (goal.stage, &goal.goal) {
                        (Stage::Asked, Some(wanted)) => out.push(Deed::Ask(id, wanted.clone())),
                        (Stage::Canceling, _) => out.push(Deed::Cancel(id)),
                        _ => out.push(Deed::AskResult(id)),
                    }
                }
                None => {}
            }
        }
        over.iter().for_each(|id| drop(self.goals.remove(id)));
    }
}

/// End that a status means; `None` if it is not one of an end.
fn end(status: i8) -> Option<End> {
    match status {
        GoalStatus::STATUS_SUCCEEDED => Some(End::Succeeded),
        GoalStatus::STATUS_CANCELED => Some(End::Canceled),
        GoalStatus::STATUS_ABORTED => Some(End::Aborted),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Deeds = Vec<Deed<u8, u8, u8>>;

    /// A client with one goal, and its time.
    struct Test {
        goals: Goals<u8>,
        start: Instant,
        now: Instant,
    }

    const ID: GoalId = GoalId(1);
    const HERE: i8 = GoalStatus::STATUS_SUCCEEDED;

    impl Test {
        fn new() -> Self {
            let start = Instant::now();
            Self { goals: Goals::new(Ids::new(1, "/a"), Duration::from_secs(10), start), start, now: start }
        }

        fn outside(&self) -> GoalId {
            self.goals.ids.of(ID)
        }

        fn send(&mut self) -> Deeds {
            self.order(Order::Send { id: ID, goal: 7, replaces: None })
        }

        fn order(&mut self, order: Order<u8>) -> Deeds {
            let mut out = vec![];
            self.goals.order(order, self.now, &mut out);
            out
        }

        fn cancel(&mut self) -> Deeds {
            self.order(Order::Cancel { id: ID })
        }

        fn answer(&mut self, accepted: Option<bool>) -> Deeds {
            let (mut out, id) = (vec![], self.outside());
            self.goals.answer(id, accepted, self.now, &mut out);
            out
        }

        fn result(&mut self, result: Option<(i8, u8)>) -> Deeds {
            let (mut out, id) = (vec![], self.outside());
            self.goals.result(id, result, &mut out);
            out
        }

        fn canceled(&mut self, code: Option<i8>) -> Deeds {
            let (mut out, id) = (vec![], self.outside());
            self.goals.canceled(id, code, &mut out);
            out
        }

        fn feedback(&self) -> Deeds {
            let mut out = vec![];
            self.goals.feedback(self.outside(), 9, &mut out);
            out
        }

        /// Looks every quarter of a second until a time since the start, in ms. Returns when what was to be done.
        fn until(&mut self, ms: u64, is_served: bool) -> Vec<(u64, Deed<u8, u8, u8>)> {
            let mut all = vec![];
            while self.now < self.start + Duration::from_millis(ms) {
                self.now += Duration::from_millis(250);
                let mut out = vec![];
                self.goals.look(is_served, self.now, &mut out);
                let at = (self.now - self.start).as_millis() as u64;
                all.extend(out.into_iter().map(|deed| (at, deed)));
            }
            all
        }
    }

    fn report(report: Report<u8, u8>) -> Deed<u8, u8, u8> {
        Deed::Report(report)
    }

    #[test]
    fn a_goal_is_accepted_and_ends() {
        for (status, end) in [(4, End::Succeeded), (5, End::Canceled), (6, End::Aborted)] {
            let mut test = Test::new();
            let outside = test.outside();
            assert_eq!(test.send(), [Deed::Ask(outside, 7)]);
            assert_eq!(test.feedback(), [], "it was not accepted yet");
            let accepted = report(Report::Accepted { id: ID, replaces: None });
            assert_eq!(test.answer(Some(true)), [accepted, Deed::AskResult(outside)]);
            assert_eq!(test.answer(Some(true)), [], "a server that answers twice");
            assert_eq!(test.answer(Some(false)), []);
            assert_eq!(test.feedback(), [report(Report::Feedback { id: ID, feedback: 9 })]);
            assert_eq!(test.until(60_000, true), [], "a slow server");
            assert_eq!(test.result(Some((status, 3))), [report(Report::Ended { id: ID, end, result: 3 })]);
            assert_eq!((test.result(Some((HERE, 3))), test.feedback()), (vec![], vec![]), "a repeated result");
            assert!(test.goals.are_over());
        }
    }

    #[test]
    fn a_goal_is_rejected() {
        let mut test = Test::new();
        test.send();
        assert_eq!(test.answer(Some(false)), [report(Report::Rejected { id: ID })]);
        assert_eq!(test.answer(Some(true)), []);
    }

    #[test]
    fn statuses_that_are_no_end_are_no_success() {
        for status in [0, 1, 2, 3, 7, -1, i8::MAX] {
            let mut test = Test::new();
            test.send();
            test.answer(Some(true));
            let lost = report(Report::Lost { id: ID, loss: Loss::Forgotten });
            assert_eq!(test.result(Some((status, 3))), [lost]);
        }
    }

    #[test]
    fn a_goal_that_was_accepted_is_called_off() {
        let mut test = Test::new();
        let outside = test.outside();
        test.send();
        test.answer(Some(true));
        assert_eq!((test.cancel(), test.cancel()), (vec![Deed::Cancel(outside)], vec![]));
        assert_eq!((test.result(Some((HERE, 3))), test.feedback()), (vec![], vec![]), "late");
        assert_eq!((test.canceled(Some(0)), test.goals.are_over()), (vec![], true));
    }

    #[test]
    fn a_cancel_before_the_acceptance_comes_after_it() {
        let mut test = Test::new();
        let outside = test.outside();
        test.send();
        assert_eq!(test.cancel(), []);
        assert_eq!(test.until(60_000, true), [], "nothing is told of a goal that was left");
        assert_eq!(test.answer(Some(true)), [Deed::Cancel(outside)]);
        assert_eq!((test.answer(Some(true)), test.result(Some((HERE, 3)))), (vec![], vec![]));
        // The cancel is lost, and sent again.
        assert_eq!(test.canceled(None), []);
        assert_eq!(test.until(60_250, true), [(60_250, Deed::Cancel(outside))]);
        assert!(matches!(test.canceled(Some(1))[..], [Deed::Tell(_)]));
        assert!(test.goals.are_over());
        let mut test = Test::new();
        test.send();
        test.cancel();
        assert_eq!((test.answer(Some(false)), test.goals.are_over()), (vec![], true));
    }

    #[test]
    fn a_goal_without_a_server_is_lost_within_three_seconds() {
        let mut test = Test::new();
        let outside = test.outside();
        test.send();
        test.answer(None);
        assert_eq!(test.until(2250, false), []);
        let lost = report(Report::Lost { id: ID, loss: Loss::NoServer });
        assert_eq!((test.until(2500, false), test.goals.are_over()), (vec![(2500, lost)], true));
        // One that comes in time gets the goal.
        let mut test = Test::new();
        test.send();
        test.answer(None);
        assert_eq!(test.until(1000, false), []);
        assert_eq!(test.until(1250, true), [(1250, Deed::Ask(outside, 7))]);
        assert_eq!(test.answer(Some(true)).len(), 2);
        // A goal that was called off meanwhile is not sent.
        let mut test = Test::new();
        test.send();
        test.answer(None);
        test.cancel();
        assert!(test.goals.are_over());
    }

    #[test]
    fn a_server_that_never_answers_is_told_and_given_up() {
        let mut test = Test::new();
        let outside = test.outside();
        test.send();
        let said = test.until(9750, true);
        assert!(matches!(said[..], [(2500, Deed::Tell(_))]), "{said:?}");
        let lost = report(Report::Lost { id: ID, loss: Loss::NoAnswer });
        assert_eq!(test.until(10_000, true), [(10_000, lost)]);
        assert_eq!(test.until(20_000, true), []);
        // It accepts after all.
        assert_eq!(test.answer(Some(true)), [Deed::Cancel(outside)]);
    }

    #[test]
    fn a_server_that_dies_loses_its_goals() {
        let mut test = Test::new();
        let outside = test.outside();
        test.send();
        test.answer(Some(true));
        test.until(5000, true);
        assert_eq!(test.result(None), []);
        assert_eq!(test.until(7250, false), []);
        let lost = report(Report::Lost { id: ID, loss: Loss::ServerGone });
        assert_eq!((test.until(7500, false), test.goals.are_over()), (vec![(7500, lost)], true));
        // One that was started again does not know the goal.
        let mut test = Test::new();
        test.send();
        test.answer(Some(true));
        test.until(5000, true);
        test.result(None);
        test.until(6000, false);
        assert_eq!(test.until(6250, true), [(6250, Deed::AskResult(outside))]);
        let lost = report(Report::Lost { id: ID, loss: Loss::Forgotten });
        assert_eq!(test.result(Some((0, 0))), [lost]);
    }

    #[test]
    fn a_new_goal_replaces_the_old_one() {
        let mut test = Test::new();
        let (old, new) = (test.outside(), test.goals.ids.of(GoalId(2)));
        test.send();
        test.answer(Some(true));
        let deeds = test.order(Order::Send { id: GoalId(2), goal: 8, replaces: Some(ID) });
        assert_eq!(deeds, [Deed::Cancel(old), Deed::Ask(new, 8)]);
        assert_eq!(test.result(Some((HERE, 3))), []);
        let mut out: Deeds = vec![];
        test.goals.end(&mut out);
        assert_eq!(out, [], "the new goal was not accepted yet");
        test.goals.answer(new, Some(true), test.now, &mut out);
        assert_eq!(out, [Deed::Cancel(new)]);
    }

    /// Anything that can happen, in any order: a goal is reported to be accepted at most once and before its end, ends
    /// at most once, nothing is reported of a goal that was left, and one that was accepted and left is called off.
    #[test]
    fn whatever_comes_a_goal_ends_once_and_is_not_forgotten() {
        let mut random = apex_nodes::math::Random::new(5);
        for _ in 0..5000 {
            let mut test = Test::new();
            let (mut is_left, mut is_over, mut reports, mut accepted, mut cancels) = (false, false, 0, false, 0);
            let mut deeds = test.send();
            for _ in 0..12 {
                for deed in deeds.drain(..) {
                    match deed {
                        Deed::Report(Report::Accepted { .. }) => {
                            assert!(!is_left && !is_over && reports == 0);
                            reports += 1;
                        }
                        Deed::Report(Report::Feedback { .. }) => assert!(!is_left && !is_over && reports == 1),
                        Deed::Report(_) => {
                            assert!(!is_left && !is_over);
                            is_over = true;
                        }
                        Deed::Cancel(_) => {
                            assert!(accepted);
                            cancels += 1;
                        }
                        Deed::Ask(..) => assert!(!is_left),
                        Deed::AskResult(_) | Deed::Tell(_) => {}
                    }
                }
                deeds = match random.below(9) {
                    0 => {
                        is_left |= !is_over;
                        test.cancel()
                    }
                    1 => {
                        accepted |= test.goals.goals.values().any(|goal| goal.stage == Stage::Asked);
                        test.answer(Some(true))
                    }
                    2 => test.answer(None),
                    3 => test.answer(Some(false)),
                    4 => test.result(Some((random.below(8) as i8, 1))),
                    5 => test.result(None),
                    6 => test.feedback(),
                    7 => test.canceled([None, Some(0), Some(2)][random.below(3) as usize]),
                    _ => {
                        let ms = (test.now - test.start).as_millis() as u64 + random.below(5000);
                        test.until(ms, random.below(3) > 0).into_iter().map(|(_, deed)| deed).collect()
                    }
                };
                if is_left && accepted && test.goals.goals.values().any(|goal| goal.stage == Stage::Accepted) {
                    panic!("it was left and goes on");
                }
            }
            assert!(
                !(is_left && reports == 1) || is_over || cancels > 0 || deeds.contains(&Deed::Cancel(test.outside()))
            );
        }
    }
}
