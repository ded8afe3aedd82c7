//! The language server: what editors ask about `.afg` texts, over the Language Server Protocol.
//!
//! Everything that knows the language is in `apex_dsl::ide`; here is the protocol, one module per feature.

mod analysis;
mod capabilities;
mod documents;
mod features;
mod frames;
mod places;
mod position;
mod project;
mod queue;
mod serve;
mod server;
mod stdio;
mod uri;

pub use serve::{PATIENCE, serve};
pub use stdio::stdio;
