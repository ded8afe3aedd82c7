//! Clients of actions: goals of the program for other nodes.

use super::{
    CANCEL_GOAL, FEEDBACK, GET_RESULT, LOOK, SEND_GOAL,
    goals::{Deed, Goals},
    id::Ids,
    wire::{FeedbackMessage, GetResult, GoalRequest, ResultRequest, SendGoal},
};
use crate::{Client, Error, Kind, Ros, endpoint::Tell, graph::Graph, token::Endpoint};
use apex_messages::{
    Action, Service,
    action_msgs::{CancelGoal, CancelGoalRequest, GoalInfo},
    unique_identifier_msgs::UUID,
};
use apex_nodes::action::{GoalId, Order, Report};
use apex_rt::{PortReceiver, PortSender};
use std::{
    marker::PhantomData,
    sync::{
        Arc,
        mpsc::{self, Receiver, RecvTimeoutError, Sender},
    },
    time::{Duration, Instant},
};

/// Time that a server has to accept a goal by default.
const TIMEOUT: Duration = Duration::from_secs(10);
/// Longest wait for the answer to a goal or a cancel, as in `rmw_zenoh`.
const LONG: Duration = Duration::from_secs(600);
/// Longest wait for a result: a goal takes as long as it takes.
const ENDLESS: Duration = Duration::from_secs(365 * 24 * 3600);
/// Time in which servers are asked to call goals off when the program has ended.
const LAST: Duration = Duration::from_millis(500);

/// An action of another node, before it gets goals.
#[must_use = "it gets goals with `through`"]
pub struct SendingGoals<'a, A> {
    ros: &'a Ros,
    name: String,
    timeout: Duration,
    action: PhantomData<fn() -> A>,
}

impl Ros {
    /// Begins a client of an action of another node.
    pub fn send_goals<A: Action>(&self, name: &str) -> SendingGoals<'_, A> {
        SendingGoals { ros: self, name: name.to_owned(), timeout: TIMEOUT, action: PhantomData }
    }
}

impl<A: Action + 'static> SendingGoals<'_, A>
where
    A::Goal: Clone + Send,
    A::Feedback: Send,
    A::Result: Send,
{
    /// Takes a goal that the server has not answered for this time as lost.
    pub fn timeout(self, timeout: Duration) -> Self {
        Self { timeout, ..self }
    }

    /// Sends the goals that the program orders, and reports what becomes of them: the ports of an
    /// [`ActionLink`](apex_nodes::action::ActionLink) and an [`ActionClient`](apex_nodes::action::ActionClient). When
    /// the program ends, its goals are called off.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn through(
        self,
        orders: PortReceiver<Order<A::Goal>>,
        reports: PortSender<Report<A::Feedback, A::Result>>,
    ) -> Result<(), Error> {
        let Self { ros, name, timeout, .. } = self;
        let endpoints = &ros.endpoints;
        let full = endpoints.resolve(&name)?;
        // Two clients of one action are two.
        let number = endpoints.count();
        let (sender, happens) = mpsc::channel();
        let of = |part: &str| format!("{full}{part}");
        let goals = ros.call::<SendGoal<A>>(&of(SEND_GOAL)).timeout(LONG).open()?;
        let cancels = ros.call::<CancelGoal>(&of(CANCEL_GOAL)).quiet().timeout(LONG).open()?;
        let results = ros.call::<GetResult<A>>(&of(GET_RESULT)).quiet().timeout(ENDLESS).open()?;
        let feedback = sender.clone();
        ros.subscribe(&of(FEEDBACK)).quiet().each(move |message: FeedbackMessage<A>| {
            // The client has ended.
            drop(feedback.send(Happening::Feedback(message.id, message.feedback)));
        })?;
        let ids = Ids::new(endpoints.seed, (&ros.name(), &full, number));
        let ty = (<SendGoal<A> as Service>::NAME, <SendGoal<A> as Service>::HASH);
        let server = endpoints.endpoint(Kind::Server, &of(SEND_GOAL), ty.0, ty.1, crate::Qos::DEFAULT);
        let worker = Worker {
            goals: Goals::new(ids, timeout, Instant::now()),
            asks: (goals, cancels, results),
            reports,
            sender: sender.clone(),
            server,
            domain: endpoints.domain,
            graph: ros.graph.clone(),
            name: full.clone(),
            tell: Arc::clone(&endpoints.tell),
        };
        endpoints.spawn(&full, move || {
            while let Some(order) = orders.receive() {
                if sender.send(Happening::Order(order)).is_err() {
                    return;
                }
            }
            drop(sender.send(Happening::End));
        })?;
        endpoints.spawn(&full, move || worker.run(&happens))
    }
}

/// Event in the life of a client.
enum Happening<A: Action> {
    Order(Order<A::Goal>),
    Answer(GoalId, Option<bool>),
    Feedback(GoalId, A::Feedback),
    Result(GoalId, Option<(i8, A::Result)>),
    Canceled(GoalId, Option<i8>),
    End,
}

/// Client that carries out what its goals need.
struct Worker<A: Action> {
    goals: Goals<A::Goal>,
    asks: (Client<SendGoal<A>>, Client<CancelGoal>, Client<GetResult<A>>),
    reports: PortSender<Report<A::Feedback, A::Result>>,
    sender: Sender<Happening<A>>,
    /// Server as it has to be.
    server: Endpoint,
    domain: u32,
    graph: Graph,
    name: String,
    tell: Tell,
}

impl<A: Action + 'static> Worker<A>
where
    A::Goal: Clone + Send,
    A::Feedback: Send,
    A::Result: Send,
{
    fn run(mut self, happens: &Receiver<Happening<A>>) {
        let (mut next, mut end) = (Instant::now() + LOOK, None);
        while end.is_none_or(|end| Instant::now() < end && !self.goals.are_over()) {
            let (now, mut deeds) = (Instant::now(), vec![]);
            match happens.recv_timeout(next.saturating_duration_since(now)) {
                Ok(Happening::Order(order)) => self.goals.order(order, Instant::now(), &mut deeds),
                Ok(Happening::Answer(id, accepted)) => self.goals.answer(id, accepted, Instant::now(), &mut deeds),
                Ok(Happening::Feedback(id, feedback)) => self.goals.feedback(id, feedback, &mut deeds),
                Ok(Happening::Result(id, result)) => self.goals.result(id, result, &mut deeds),
                Ok(Happening::Canceled(id, code)) => self.goals.canceled(id, code, &mut deeds),
                Ok(Happening::End) => {
                    end = Some(Instant::now() + LAST);
                    self.goals.end(&mut deeds);
                }
                Err(RecvTimeoutError::Timeout) => {
                    next = Instant::now() + LOOK;
                    let is_served = self.graph.has(self.domain, &self.server);
                    self.goals.look(is_served, Instant::now(), &mut deeds);
                }
                Err(RecvTimeoutError::Disconnected) => break,
            }
            deeds.into_iter().for_each(|deed| self.act(deed));
        }
    }

    fn act(&self, deed: Deed<A::Goal, A::Feedback, A::Result>) {
        let (goals, cancels, results) = &self.asks;
        let sender = self.sender.clone();
        match deed {
            Deed::Ask(id, goal) => goals.begin(&GoalRequest { id, goal }, move |response| {
                drop(sender.send(Happening::Answer(id, response.map(|response| response.accepted))));
            }),
            Deed::AskResult(id) => results.begin(&ResultRequest { id, action: PhantomData }, move |response| {
                let result = response.map(|response| (response.status, response.result));
                drop(sender.send(Happening::Result(id, result)));
            }),
            Deed::Cancel(id) => {
                let goal_id = UUID { uuid: id.0.to_be_bytes() };
                let request = CancelGoalRequest { goal_info: GoalInfo { goal_id, ..GoalInfo::default() } };
                cancels.begin(&request, move |response| {
                    drop(sender.send(Happening::Canceled(id, response.map(|response| response.return_code))));
                });
            }
            // A program that has ended takes nothing.
            Deed::Report(report) => drop(self.reports.send(report)),
            Deed::Tell(text) => (self.tell)(&format!("`{}`: {text}", self.name)),
        }
    }
}
