//! Language server for `.afg` source files, which uses the Language Server Protocol.
//!
//! All knowledge of the language is in `apex_dsl::ide`. This crate implements the protocol, with one module per
//! feature.

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
pub use uri::from_path;
