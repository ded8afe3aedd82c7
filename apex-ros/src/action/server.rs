//! Servers of actions: goals of other nodes for the program.

use super::{
    CANCEL_GOAL, FEEDBACK, GET_RESULT, SEND_GOAL, STATUS,
    desk::{Deed, Desk, Questions},
    wire::{FeedbackMessage, GetResult, GoalResponse, ResultResponse, SendGoal},
};
use crate::{
    Error, Publisher, Ros,
    service::{Asked, listen},
    time::RosTime,
};
use apex_messages::{
    Action,
    action_msgs::{CancelGoal, CancelGoalRequest, GoalStatusArray},
    builtin_interfaces::Time,
};
use apex_nodes::action::{GoalId, Order, Report};
use apex_rt::{PortReceiver, PortSender};
use std::{
    marker::PhantomData,
    sync::mpsc::{self, Receiver},
    time::Instant,
};

/// An action of this node, before it is offered.
#[must_use = "it is offered with `through`"]
pub struct ServingGoals<'a, A> {
    ros: &'a Ros,
    name: String,
    action: PhantomData<fn() -> A>,
}

impl Ros {
    /// Begins an action of this node.
    pub fn serve_goals<A: Action>(&self, name: &str) -> ServingGoals<'_, A> {
        ServingGoals { ros: self, name: name.to_owned(), action: PhantomData }
    }
}

impl<A: Action + 'static> ServingGoals<'_, A>
where
    A::Goal: Send,
    A::Feedback: Send,
    A::Result: Clone + Default + Send,
{
    /// Lets the program carry goals out: the ports of an [`ActionServer`](apex_nodes::action::ActionServer). When the
    /// program ends, its goals are aborted.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn through(
        self,
        orders: PortSender<Order<A::Goal>>,
        reports: PortReceiver<Report<A::Feedback, A::Result>>,
    ) -> Result<(), Error> {
        let Self { ros, name, .. } = self;
        let endpoints = &ros.endpoints;
        let full = endpoints.resolve(&name)?;
        let of = |part: &str| format!("{full}{part}");
        let (sender, happens) = mpsc::channel();
        // Whoever waits for the status of a goal may come late.
        let status = ros.publish(&of(STATUS)).transient_local().depth(1).quiet().open()?;
        let feedback = ros.publish(&of(FEEDBACK)).quiet().open()?;
        let time = endpoints.time.clone();
        let worker = Worker { desk: Desk::new(), orders, feedback, status, time };
        // The worker has ended if a message cannot be sent to it.
        let to = sender.clone();
        listen::<GetResult<A>>(ros, &of(GET_RESULT), true, move |request, asked| {
            drop(to.send(Happening::Result(request.id, asked)));
        })?;
        let to = sender.clone();
        listen::<CancelGoal>(ros, &of(CANCEL_GOAL), true, move |request, asked| {
            drop(to.send(Happening::Cancel(request, asked)));
        })?;
        // The last one: by it, others find the action.
        let to = sender.clone();
        listen::<SendGoal<A>>(ros, &of(SEND_GOAL), true, move |request, asked| {
            drop(to.send(Happening::Goal(request.id, request.goal, asked)));
        })?;
        endpoints.spawn(&full, move || {
            while let Some(report) = reports.receive() {
                if sender.send(Happening::Report(report)).is_err() {
                    return;
                }
            }
            drop(sender.send(Happening::End));
        })?;
        endpoints.spawn(&full, move || worker.run(&happens))
    }
}

/// Event in the life of a server.
enum Happening<A: Action> {
    Goal(GoalId, A::Goal, Asked<SendGoal<A>>),
    Cancel(CancelGoalRequest, Asked<CancelGoal>),
    Result(GoalId, Asked<GetResult<A>>),
    Report(Report<A::Feedback, A::Result>),
    End,
}

impl<A: Action> Questions for PhantomData<A> {
    type Goal = Asked<SendGoal<A>>;
    type Result = Asked<GetResult<A>>;
}

/// Server that carries out what its goals need.
struct Worker<A: Action> {
    desk: Desk<A::Result, PhantomData<A>>,
    orders: PortSender<Order<A::Goal>>,
    feedback: Publisher<FeedbackMessage<A>>,
    status: Publisher<GoalStatusArray>,
    time: RosTime,
}

impl<A: Action> Worker<A>
where
    A::Result: Clone + Default,
{
    fn run(mut self, happens: &Receiver<Happening<A>>) {
        while let Ok(happening) = happens.recv() {
            let (now, mut deeds, is_end) = (Instant::now(), vec![], matches!(happening, Happening::End));
            match happening {
                Happening::Goal(id, goal, asked) => self.desk.goal(id, goal, asked, &mut deeds),
                Happening::Cancel(request, asked) => asked.answer(&self.desk.cancel(&request, &mut deeds)),
                Happening::Result(id, asked) => self.desk.result(id, asked, &mut deeds),
                Happening::Report(report) => {
                    self.desk.report(report, Time::from_nanos(self.time.now()), now, &mut deeds);
                }
                Happening::End => self.desk.close(now, &mut deeds),
            }
            self.desk.forget(now);
            deeds.into_iter().for_each(|deed| self.act(deed));
            if is_end {
                break;
            }
        }
    }

    fn act(&self, deed: Deed<A::Goal, A::Feedback, A::Result, PhantomData<A>>) {
        match deed {
            // A program that has ended takes nothing, and its last goals are aborted.
            Deed::Order(order) => drop(self.orders.send(order)),
            Deed::Answer(asked, accepted, stamp) => {
                asked.answer(&GoalResponse { accepted, stamp, action: PhantomData });
            }
            Deed::Result(asked, status, result) => asked.answer(&ResultResponse { status, result }),
            // A node that ends cannot tell.
            Deed::Feedback(id, feedback) => drop(self.feedback.send(&FeedbackMessage { id, feedback })),
            Deed::Status(status) => drop(self.status.send(&status)),
        }
    }
}
