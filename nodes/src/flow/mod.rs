//! Routing and timing of tokens: branching, filtering, counting and buffering (thesis 3.6), signals and activity (7.1).
//!
//! Nodes without state are functions, the others are structs.

mod activity;
mod batch;
mod buffer;
mod event;
mod inbox;
mod pace;
mod priority;
mod route;
mod time;

pub use activity::{Action, ActivityGate, Attempts, Deactivate, Wait};
pub use batch::{Collect, Delay, MAX_BATCH};
pub use buffer::{Hold, Latch, Latest, constant};
pub use event::{Await, Counter, Debounce, Relay, Signal, Toggle, either, emit, equals, tick};
pub use inbox::{Inbox, MAX_JOBS};
pub use pace::{Changed, Count, Edge, Throttle};
pub use priority::PriorityInbox;
pub use route::{Branches, gate, merge, select, switch};
pub use time::{Silence, Stamp};
