//! Goals at a server, without their way: what came, and what is to be done.

use apex_messages::{
    action_msgs::{
        CancelGoalRequest, CancelGoalResponse as Code, CancelGoalResponse, GoalInfo, GoalStatus, GoalStatusArray,
    },
    builtin_interfaces::Time,
    unique_identifier_msgs::UUID,
};
use apex_nodes::action::{End, GoalId, Order, Report};
use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

/// Time for which results are kept, as in the libraries of ROS.
const KEPT: Duration = Duration::from_secs(15 * 60);
/// Most results that are kept. The oldest makes room.
const ROOM: usize = 200;

/// Task at a server. The questions are those that were passed in.
pub enum Deed<G, F, R, Q: Questions> {
    /// Pass an order to the program.
    Order(Order<G>),
    /// Answer a request for a goal.
    Answer(Q::Goal, bool, Time),
    /// Answer a request for a result.
    Result(Q::Result, i8, R),
    /// Publish feedback.
    Feedback(GoalId, F),
    /// Publish the states of all goals.
    Status(GoalStatusArray),
}

/// Types of the questions that wait for answers.
pub trait Questions {
    /// Request for a goal.
    type Goal;
    /// Request for a result.
    type Result;
}

/// Goals at a server.
pub struct Desk<R, Q: Questions> {
    /// Requests that the program has not answered yet.
    asked: BTreeMap<GoalId, Q::Goal>,
    /// Goals in the order in which they were accepted.
    goals: Vec<Goal<R, Q>>,
}

/// A goal that was accepted.
struct Goal<R, Q: Questions> {
    id: GoalId,
    /// Time of the acceptance.
    stamp: Time,
    status: i8,
    /// Result of a goal that has ended, and the time of its end.
    ended: Option<(R, Instant)>,
    /// Requests for the result.
    waiting: Vec<Q::Result>,
}

impl<R, Q: Questions> Goal<R, Q> {
    fn info(&self) -> GoalInfo {
        GoalInfo { goal_id: UUID { uuid: self.id.0.to_be_bytes() }, stamp: self.stamp.clone() }
    }
}

impl<R: Clone + Default, Q: Questions> Desk<R, Q> {
    /// Returns a server without goals.
    pub fn new() -> Self {
        Self { asked: BTreeMap::new(), goals: vec![] }
    }

    /// Takes a request for a goal. One that is known already is refused.
    pub fn goal<G, F>(&mut self, id: GoalId, goal: G, question: Q::Goal, out: &mut Vec<Deed<G, F, R, Q>>) {
        if self.asked.contains_key(&id) || self.goals.iter().any(|goal| goal.id == id) {
            return out.push(Deed::Answer(question, false, Time::default()));
        }
        self.asked.insert(id, question);
        out.push(Deed::Order(Order::Send { id, goal, replaces: None }));
    }

    /// Takes a request to call goals off, and returns the answer: one goal, all of them, or those that were accepted
    /// until a time.
    pub fn cancel<G, F>(&mut self, request: &CancelGoalRequest, out: &mut Vec<Deed<G, F, R, Q>>) -> CancelGoalResponse {
        let GoalInfo { goal_id, stamp } = &request.goal_info;
        let (id, until) = (GoalId(u128::from_be_bytes(goal_id.uuid)), stamp.as_nanos());
        let is_meant = |goal: &Goal<R, Q>| match (id.0, until) {
            (0, 0) => true,
            (_, 0) => goal.id == id,
            _ => goal.id == id || goal.stamp.as_nanos() <= until,
        };
        let mut response = CancelGoalResponse::default();
        for goal in self.goals.iter_mut().filter(|goal| goal.ended.is_none() && is_meant(goal)) {
            response.goals_canceling.push(goal.info());
            if goal.status != GoalStatus::STATUS_CANCELING {
                goal.status = GoalStatus::STATUS_CANCELING;
                out.push(Deed::Order(Order::Cancel { id: goal.id }));
            }
        }
        if !response.goals_canceling.is_empty() {
            out.push(Deed::Status(self.status()));
        } else if id.0 != 0 {
            let is_known = self.goals.iter().any(|goal| goal.id == id);
            response.return_code = if is_known { Code::ERROR_GOAL_TERMINATED } else { Code::ERROR_UNKNOWN_GOAL_ID };
        }
        response
    }

    /// Takes a request for a result. It is answered when there is one. A goal that is not known has no status.
    pub fn result<G, F>(&mut self, id: GoalId, question: Q::Result, out: &mut Vec<Deed<G, F, R, Q>>) {
        match self.goals.iter_mut().find(|goal| goal.id == id) {
            Some(Goal { ended: Some((result, _)), status, .. }) => {
                out.push(Deed::Result(question, *status, result.clone()));
            }
            Some(goal) => goal.waiting.push(question),
            None => out.push(Deed::Result(question, GoalStatus::STATUS_UNKNOWN, R::default())),
        }
    }

    /// Takes a report of the program.
    pub fn report<G, F>(&mut self, report: Report<F, R>, stamp: Time, now: Instant, out: &mut Vec<Deed<G, F, R, Q>>) {
        match report {
            Report::Accepted { id, replaces } => {
                replaces.into_iter().for_each(|id| self.end(id, End::Aborted, R::default(), now, out));
                let Some(question) = self.asked.remove(&id) else { return };
                out.push(Deed::Answer(question, true, stamp.clone()));
                let status = GoalStatus::STATUS_ACCEPTED;
                self.goals.push(Goal { id, stamp, status, ended: None, waiting: vec![] });
                self.begin();
                out.push(Deed::Status(self.status()));
            }
            Report::Rejected { id } => {
                let question = self.asked.remove(&id);
                out.extend(question.map(|question| Deed::Answer(question, false, stamp)));
            }
            Report::Feedback { id, feedback } => {
                if self.goals.iter().any(|goal| goal.id == id && goal.ended.is_none()) {
                    out.push(Deed::Feedback(id, feedback));
                }
            }
            Report::Ended { id, end, result } => {
                self.end(id, end, result, now, out);
                self.begin();
                out.push(Deed::Status(self.status()));
            }
            Report::AllAborted => self.abort_all(now, out),
            Report::Lost { id, .. } => self.end(id, End::Aborted, R::default(), now, out),
        }
    }

    /// Ends all goals: the program has ended.
    pub fn close<G, F>(&mut self, now: Instant, out: &mut Vec<Deed<G, F, R, Q>>) {
        let asked = std::mem::take(&mut self.asked).into_values();
        out.extend(asked.map(|question| Deed::Answer(question, false, Time::default())));
        self.abort_all(now, out);
    }

    /// Ends all goals that were accepted.
    fn abort_all<G, F>(&mut self, now: Instant, out: &mut Vec<Deed<G, F, R, Q>>) {
        let all: Vec<GoalId> = self.goals.iter().map(|goal| goal.id).collect();
        all.into_iter().for_each(|id| self.end(id, End::Aborted, R::default(), now, out));
        out.push(Deed::Status(self.status()));
    }

    /// Forgets old results.
    pub fn forget(&mut self, now: Instant) {
        let ended = self.goals.iter().filter(|goal| goal.ended.is_some()).count();
        let mut surplus = ended.saturating_sub(ROOM);
        self.goals.retain(|goal| {
            let Some((_, at)) = &goal.ended else { return true };
            let is_old = surplus > 0 || now.saturating_duration_since(*at) >= KEPT;
            surplus = surplus.saturating_sub(1);
            !is_old
        });
    }

    /// Ends a goal, unless it has ended. Answers the requests for its result.
    fn end<G, F>(&mut self, id: GoalId, end: End, result: R, now: Instant, out: &mut Vec<Deed<G, F, R, Q>>) {
        let Some(goal) = self.goals.iter_mut().find(|goal| goal.id == id && goal.ended.is_none()) else { return };
        goal.status = match end {
            End::Succeeded => GoalStatus::STATUS_SUCCEEDED,
            End::Canceled => GoalStatus::STATUS_CANCELED,
            End::Aborted => GoalStatus::STATUS_ABORTED,
        };
        let status = goal.status;
        out.extend(goal.waiting.drain(..).map(|question| Deed::Result(question, status, result.clone())));
        goal.ended = Some((result, now));
    }

    /// The first goal that has not ended is the one that is carried out.
    fn begin(&mut self) {
        let first = self.goals.iter_mut().find(|goal| goal.ended.is_none());
        if let Some(goal) = first.filter(|goal| goal.status == GoalStatus::STATUS_ACCEPTED) {
            goal.status = GoalStatus::STATUS_EXECUTING;
        }
    }

    fn status(&self) -> GoalStatusArray {
        let status = |goal: &Goal<R, Q>| GoalStatus { goal_info: goal.info(), status: goal.status };
        GoalStatusArray { status_list: self.goals.iter().map(status).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Questions by numbers.
    struct Numbers;

    impl Questions for Numbers {
        type Goal = u32;
        type Result = u32;
    }

    type Deeds = Vec<Deed<u8, u8, u8, Numbers>>;

    struct Test {
        desk: Desk<u8, Numbers>,
        now: Instant,
        second: i32,
    }

    /// Deeds in words.
    fn words(deeds: Deeds) -> Vec<String> {
        let one = |deed| match deed {
            Deed::Order(Order::Send { id, goal, .. }) => format!("send {} {goal}", id.0),
            Deed::Order(Order::Cancel { id }) => format!("cancel {}", id.0),
            Deed::Answer(question, accepted, _) => format!("answer {question} {accepted}"),
            Deed::Result(question, status, result) => format!("result {question} {status} {result}"),
            Deed::Feedback(id, feedback) => format!("feedback {} {feedback}", id.0),
            Deed::Status(array) => {
                let all: Vec<_> = array.status_list.iter().map(|status| status.status.to_string()).collect();
                format!("status {}", all.join(" "))
            }
        };
        deeds.into_iter().map(one).collect()
    }

    impl Test {
        fn new() -> Self {
            Self { desk: Desk::new(), now: Instant::now(), second: 0 }
        }

        fn goal(&mut self, id: u128, question: u32) -> Vec<String> {
            let mut out = vec![];
            self.desk.goal(GoalId(id), 7, question, &mut out);
            words(out)
        }

        fn report(&mut self, report: Report<u8, u8>) -> Vec<String> {
            self.second += 1;
            let (mut out, stamp): (Deeds, _) = (vec![], Time { sec: self.second, nanosec: 0 });
            self.desk.report(report, stamp, self.now, &mut out);
            words(out)
        }

        fn accept(&mut self, id: u128) -> Vec<String> {
            self.report(Report::Accepted { id: GoalId(id), replaces: None })
        }

        fn end(&mut self, id: u128, end: End) -> Vec<String> {
            self.report(Report::Ended { id: GoalId(id), end, result: 3 })
        }

        fn result(&mut self, id: u128, question: u32) -> Vec<String> {
            let mut out: Deeds = vec![];
            self.desk.result(GoalId(id), question, &mut out);
            words(out)
        }

        /// Code and goals of a cancel, and what is done.
        fn cancel(&mut self, id: u128, sec: i32) -> (i8, Vec<u8>, Vec<String>) {
            let goal_info = GoalInfo { goal_id: UUID { uuid: id.to_be_bytes() }, stamp: Time { sec, nanosec: 0 } };
            let mut out: Deeds = vec![];
            let response = self.desk.cancel(&CancelGoalRequest { goal_info }, &mut out);
            let ids = response.goals_canceling.iter().map(|info| info.goal_id.uuid[15]).collect();
            (response.return_code, ids, words(out))
        }
    }

    #[test]
    fn every_question_for_a_result_is_answered_early_or_late() {
        let mut test = Test::new();
        assert_eq!(test.goal(1, 10), ["send 1 7"]);
        assert_eq!(test.accept(1), ["answer 10 true", "status 2"]);
        assert_eq!((test.result(1, 20), test.result(1, 21)), (vec![], vec![]));
        assert_eq!(test.report(Report::Feedback { id: GoalId(1), feedback: 9 }), ["feedback 1 9"]);
        assert_eq!(test.end(1, End::Succeeded), ["result 20 4 3", "result 21 4 3", "status 4"]);
        assert_eq!(test.result(1, 22), ["result 22 4 3"]);
        assert_eq!(test.end(1, End::Aborted), ["status 4"], "it has ended");
        assert_eq!(test.report(Report::Feedback { id: GoalId(1), feedback: 9 }).len(), 0);
        assert_eq!(test.result(5, 23), ["result 23 0 0"], "it is not known");
        test.desk.forget(test.now + KEPT);
        assert_eq!(test.result(1, 24), ["result 24 0 0"]);
    }

    #[test]
    fn goals_are_refused() {
        let mut test = Test::new();
        test.goal(1, 10);
        assert_eq!(test.goal(1, 11), ["answer 11 false"], "the same identification");
        assert_eq!(test.report(Report::Rejected { id: GoalId(1) }), ["answer 10 false"]);
        assert_eq!(test.report(Report::Rejected { id: GoalId(1) }).len(), 0);
        assert_eq!(test.accept(1).len(), 0);
    }

    #[test]
    fn a_waiting_goal_begins_when_the_other_one_has_ended() {
        let mut test = Test::new();
        test.goal(1, 10);
        test.accept(1);
        test.goal(2, 11);
        assert_eq!(test.accept(2), ["answer 11 true", "status 2 1"]);
        test.goal(3, 12);
        let replaced = test.report(Report::Accepted { id: GoalId(3), replaces: Some(GoalId(2)) });
        assert_eq!(replaced, ["answer 12 true", "status 2 6 1"]);
        assert_eq!(test.end(1, End::Aborted), ["status 6 6 2"]);
    }

    #[test]
    fn cancels_mean_one_goal_or_all_or_the_older_ones() {
        let mut test = Test::new();
        assert_eq!(test.cancel(1, 0), (2, vec![], vec![]), "not known");
        assert_eq!(test.cancel(0, 0), (0, vec![], vec![]));
        for id in 1..=3 {
            test.goal(id, id as u32);
            test.accept(id);
        }
        let canceling = |ids: &[u8], deeds: &[&str]| {
            (0, ids.to_vec(), deeds.iter().map(|deed| (*deed).to_owned()).collect::<Vec<_>>())
        };
        assert_eq!(test.cancel(2, 0), canceling(&[2], &["cancel 2", "status 2 3 1"]));
        assert_eq!(test.cancel(2, 0), canceling(&[2], &["status 2 3 1"]), "it is on its way");
        assert_eq!(test.cancel(0, 2), canceling(&[1, 2], &["cancel 1", "status 3 3 1"]));
        assert_eq!(test.cancel(3, 1), canceling(&[1, 3], &["cancel 3", "status 3 3 3"]));
        assert_eq!(test.end(1, End::Canceled), ["status 5 3 3"]);
        assert_eq!(test.cancel(1, 0), (3, vec![], vec![]), "it has ended");
        assert_eq!(test.cancel(0, 0).1, [2, 3]);
        // A goal may be reached before its cancel is noticed.
        assert_eq!(test.end(2, End::Succeeded), ["status 5 4 3"]);
    }

    #[test]
    fn the_end_of_the_program_ends_all_goals() {
        let mut test = Test::new();
        test.goal(1, 10);
        test.accept(1);
        test.result(1, 20);
        test.goal(2, 11);
        let mut out: Deeds = vec![];
        test.desk.close(test.now, &mut out);
        assert_eq!(words(out), ["answer 11 false", "result 20 6 0", "status 6"]);
    }

    #[test]
    fn a_program_aborts_all_its_goals() {
        let mut test = Test::new();
        for id in 1..=3 {
            test.goal(id, id as u32);
        }
        test.accept(1);
        test.accept(2);
        assert_eq!(test.report(Report::AllAborted), ["status 6 6"]);
        assert_eq!(test.accept(3), ["answer 3 true", "status 6 6 2"], "it had not answered yet");
    }

    #[test]
    fn few_results_are_kept() {
        let mut test = Test::new();
        for id in 1..=ROOM as u128 + 5 {
            test.goal(id, 0);
            test.accept(id);
            test.end(id, End::Succeeded);
        }
        test.desk.forget(test.now);
        assert_eq!((test.result(5, 1), test.result(6, 1)), (vec!["result 1 0 0".into()], vec!["result 1 4 3".into()]));
    }
}
