//! Actions: goals for other nodes, and of other nodes, as three services and two topics below the action's name.

mod client;
mod desk;
mod goals;
mod id;
mod server;
mod wire;

pub use client::SendingGoals;
pub use server::ServingGoals;

/// Time between two looks at goals that wait for something.
const LOOK: std::time::Duration = std::time::Duration::from_millis(250);

/// Names of the services and topics of an action.
const SEND_GOAL: &str = "/_action/send_goal";
const CANCEL_GOAL: &str = "/_action/cancel_goal";
const GET_RESULT: &str = "/_action/get_result";
const FEEDBACK: &str = "/_action/feedback";
const STATUS: &str = "/_action/status";

/// Returns the name of the action if this is the service by which it is known: that for its goals.
pub fn action_of(name: &str) -> Option<&str> {
    name.strip_suffix(SEND_GOAL)
}
