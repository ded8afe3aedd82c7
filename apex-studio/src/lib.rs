//! `apex studio`: a page on which one sees a robot think, and one of a study that searches its parameters.
//!
//! The robot streams what it does ([`apex_rt::studio`]). This program connects to it, keeps the history, and serves the
//! page to browsers on this machine. It holds no state that a robot needs: it may come and go.

mod condition;
mod connections;
mod detail;
mod drawn;
mod editor;
mod foxglove;
mod journey;
mod kinds;
mod lane;
mod language;
mod live;
mod messages;
mod moment;
mod outbox;
mod passes;
mod picture;
mod pulse;
mod robot;
#[cfg(test)]
mod samples;
mod server;
mod session;
mod shadow;
mod site;
mod source;
mod steps;
mod store;
mod studio;
mod study;
mod tokens;
mod top;
mod waits;
mod why;
mod words;
mod worker;

pub use robot::{Remote, Robot};
pub use shadow::{Recorded, Shadow};
pub use site::origin;
pub use source::{ParamChange, Replayed, Source};
pub use studio::{Addresses, Seat, Studio};
pub use study::Study;
pub use top::top;
