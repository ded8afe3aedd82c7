//! The topic `transition_event`, whose message has another form since Lyrical.

use super::machine::{Arrow, state};
use crate::{Distribution, Error, Publisher, Ros, time::RosTime};
use apex_messages::{
    Message, Reason,
    builtin_interfaces::Time,
    cdr::{Reader, Writer},
    lifecycle_msgs::{State, Transition, TransitionEvent},
};

/// Publisher of transitions.
pub struct Events {
    publisher: Form,
    time: RosTime,
}

enum Form {
    Older(Publisher<TransitionEvent>),
    Later(Publisher<LaterEvent>),
}

impl Events {
    pub fn open(ros: &Ros) -> Result<Self, Error> {
        let topic = || ros.publish("~/transition_event").quiet();
        let publisher = match ros.endpoints.distribution {
            Distribution::Lyrical | Distribution::Rolling => Form::Later(topic().open()?),
            _ => Form::Older(topic().open()?),
        };
        Ok(Self { publisher, time: ros.endpoints.time.clone() })
    }

    pub fn send(&self, arrow: Arrow) {
        let now = self.time.now();
        let (transition, start_state, goal_state) = (arrow.message(), state(arrow.from), state(arrow.to));
        // A node that ends cannot tell.
        drop(match &self.publisher {
            Form::Older(publisher) => {
                let timestamp = now.try_into().unwrap_or_default();
                publisher.send(&TransitionEvent { timestamp, transition, start_state, goal_state })
            }
            Form::Later(publisher) => {
                publisher.send(&LaterEvent { stamp: Time::from_nanos(now), transition, start_state, goal_state })
            }
        });
    }
}

/// `lifecycle_msgs/msg/TransitionEvent` since Lyrical.
#[derive(Debug, Clone, PartialEq)]
pub struct LaterEvent {
    pub stamp: Time,
    pub transition: Transition,
    pub start_state: State,
    pub goal_state: State,
}

impl Message for LaterEvent {
    const NAME: &'static str = TransitionEvent::NAME;
    const DEFINITION: &'static str = "builtin_interfaces/Time stamp\nlifecycle_msgs/Transition transition\n\
                                      lifecycle_msgs/State start_state\nlifecycle_msgs/State goal_state";
    const HASH: &'static str = "RIHS01_78b19e2be41a797fc009c96bda68944182edabec7852cccd928a40bc06f6f9d7";

    fn write(&self, to: &mut Writer<'_>) {
        self.stamp.write(to);
        self.transition.write(to);
        self.start_state.write(to);
        self.goal_state.write(to);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
        Ok(Self {
            stamp: Message::read(from)?,
            transition: Message::read(from)?,
            start_state: Message::read(from)?,
            goal_state: Message::read(from)?,
        })
    }
}
