//! The services and messages of any action: its goal, result and feedback with what every action adds to them.
//!
//! `apex import --msg` writes these types for each action, too. Here they are generic.

use apex_messages::{
    Action, Message, Reason, Service,
    builtin_interfaces::Time,
    cdr::{Reader, Writer},
};
use apex_nodes::action::GoalId;
use std::marker::PhantomData;

/// The service `send_goal` of an action.
pub struct SendGoal<A>(PhantomData<fn() -> A>);
/// The service `get_result` of an action.
pub struct GetResult<A>(PhantomData<fn() -> A>);

impl<A: Action> Service for SendGoal<A> {
    const NAME: &'static str = <A::SendGoal as Service>::NAME;
    const HASH: &'static str = <A::SendGoal as Service>::HASH;
    type Request = GoalRequest<A>;
    type Response = GoalResponse<A>;
}

impl<A: Action> Service for GetResult<A> {
    const NAME: &'static str = <A::GetResult as Service>::NAME;
    const HASH: &'static str = <A::GetResult as Service>::HASH;
    type Request = ResultRequest<A>;
    type Response = ResultResponse<A>;
}

/// Request for a goal.
pub struct GoalRequest<A: Action> {
    pub id: GoalId,
    pub goal: A::Goal,
}

/// Answer to a goal.
pub struct GoalResponse<A> {
    pub accepted: bool,
    pub stamp: Time,
    pub action: PhantomData<fn() -> A>,
}

/// Question for the result of a goal.
pub struct ResultRequest<A> {
    pub id: GoalId,
    pub action: PhantomData<fn() -> A>,
}

/// Result of a goal, with its status.
pub struct ResultResponse<A: Action> {
    pub status: i8,
    pub result: A::Result,
}

/// Feedback of a goal.
pub struct FeedbackMessage<A: Action> {
    pub id: GoalId,
    pub feedback: A::Feedback,
}

/// Makes a struct the message of the same fields that is written for each action.
macro_rules! message {
    ($name:ident as $message:ty, $write:expr, $read:expr) => {
        impl<A: Action> Message for $name<A> {
            const NAME: &'static str = <$message as Message>::NAME;
            const DEFINITION: &'static str = <$message as Message>::DEFINITION;
            const HASH: &'static str = <$message as Message>::HASH;

            fn write(&self, to: &mut Writer<'_>) {
                let write: fn(&Self, &mut Writer<'_>) = $write;
                write(self, to);
            }

            fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
                let read: fn(&mut Reader<'_>) -> Result<Self, Reason> = $read;
                read(from)
            }
        }
    };
}

fn write_id(id: GoalId, to: &mut Writer<'_>) {
    to.numbers(&id.0.to_be_bytes());
}

fn read_id(from: &mut Reader<'_>) -> Result<GoalId, Reason> {
    from.array().map(|bytes| GoalId(u128::from_be_bytes(bytes)))
}

message!(
    GoalRequest as <A::SendGoal as Service>::Request,
    |request, to| {
        write_id(request.id, to);
        request.goal.write(to);
    },
    |from| Ok(Self { id: read_id(from)?, goal: Message::read(from)? })
);
message!(
    GoalResponse as <A::SendGoal as Service>::Response,
    |response, to| {
        to.number(response.accepted);
        response.stamp.write(to);
    },
    |from| Ok(Self { accepted: from.number()?, stamp: Message::read(from)?, action: PhantomData })
);
message!(ResultRequest as <A::GetResult as Service>::Request, |request, to| write_id(request.id, to), |from| Ok(
    Self { id: read_id(from)?, action: PhantomData }
));
message!(
    ResultResponse as <A::GetResult as Service>::Response,
    |response, to| {
        to.number(response.status);
        response.result.write(to);
    },
    |from| Ok(Self { status: from.number()?, result: Message::read(from)? })
);
message!(
    FeedbackMessage as A::FeedbackMessage,
    |message, to| {
        write_id(message.id, to);
        message.feedback.write(to);
    },
    |from| Ok(Self { id: read_id(from)?, feedback: Message::read(from)? })
);

#[cfg(test)]
mod tests {
    use super::*;
    use apex_messages::{
        example_interfaces::{
            Fibonacci, FibonacciFeedback, FibonacciFeedbackMessage, FibonacciGetResultRequest,
            FibonacciGetResultResponse, FibonacciGoal, FibonacciResult, FibonacciSendGoalRequest,
            FibonacciSendGoalResponse,
        },
        unique_identifier_msgs::UUID,
    };

    /// Checks that a message of an action has the bytes of the one that was written for it, and comes back.
    fn same<M: Message>(generic: &M, written: &impl Message) {
        assert_eq!(generic.to_bytes(), written.to_bytes());
        assert_eq!(M::from_bytes(&generic.to_bytes()).map(|again| again.to_bytes()), Ok(generic.to_bytes()));
    }

    #[test]
    fn messages_are_those_that_are_written_for_the_action() {
        let id = GoalId(0x0102_0304_0506_0708_090a_0b0c_0d0e_0f10);
        let goal_id = UUID { uuid: std::array::from_fn(|i| i as u8 + 1) };
        let sequence = vec![1, -2, 3];
        let goal = FibonacciGoal { order: 7 };
        same(
            &GoalRequest::<Fibonacci> { id, goal: goal.clone() },
            &FibonacciSendGoalRequest { goal_id: goal_id.clone(), goal },
        );
        let stamp = Time { sec: 5, nanosec: 6 };
        for accepted in [true, false] {
            same(
                &GoalResponse::<Fibonacci> { accepted, stamp: stamp.clone(), action: PhantomData },
                &FibonacciSendGoalResponse { accepted, stamp: stamp.clone() },
            );
        }
        same(
            &ResultRequest::<Fibonacci> { id, action: PhantomData },
            &FibonacciGetResultRequest { goal_id: goal_id.clone() },
        );
        let result = FibonacciResult { sequence: sequence.clone() };
        same(
            &ResultResponse::<Fibonacci> { status: 4, result: result.clone() },
            &FibonacciGetResultResponse { status: 4, result },
        );
        let feedback = FibonacciFeedback { sequence };
        same(
            &FeedbackMessage::<Fibonacci> { id, feedback: feedback.clone() },
            &FibonacciFeedbackMessage { goal_id, feedback },
        );
        assert_eq!(<GoalRequest<Fibonacci> as Message>::NAME, "example_interfaces/action/Fibonacci_SendGoal_Request");
    }
}
