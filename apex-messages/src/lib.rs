//! The common messages of ROS 2 as Rust structs, with their encoding (CDR), definitions and hashes.
//!
//! Every package is a module: [`geometry_msgs`], [`sensor_msgs`] and so on. The modules are written by
//! `apex import --msg` from the field lists in the folder `definitions`, those of ROS 2 Humble to Kilted. The command
//! writes the messages of other packages in the same form. A struct is a [`Message`], and so is a type that a program
//! converts: recordings keep both.
//!
//! The crate has no dependencies, and needs the heap but not the standard library.
#![no_std]

extern crate alloc;
// Written code names this crate as others do.
extern crate self as apex_messages;

pub mod cdr;
mod conversion;
mod message;
mod numbers;
#[rustfmt::skip]
#[allow(missing_docs, clippy::all, clippy::pedantic)]
mod packages;

pub use cdr::Reason;
pub use message::{Action, Foreign, Known, Message, Others, Service};
pub use packages::*;
