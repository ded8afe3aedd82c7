//! The runtime of Apex: everything that a compiled graph calls.
//!
//! `no_std`, without a heap, and without `unsafe` except in the cell between two threads. The feature `std` adds a wall
//! clock, a runner that sleeps between reactions, and messages on standard error.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(feature = "alloc")]
extern crate alloc;

pub mod bytes;
mod cell;
mod clock;
mod ctx;
mod dispatch;
#[cfg(feature = "std")]
mod end;
mod event;
mod failure;
mod info;
#[cfg(any(feature = "profile", feature = "record"))]
mod instruments;
mod list;
mod mailbox;
mod node;
mod observer;
mod out;
mod parallel;
pub mod params;
#[cfg(feature = "std")]
mod ports;
#[cfg(feature = "profile")]
pub mod profile;
mod queue;
#[cfg(feature = "record")]
pub mod record;
#[cfg(feature = "std")]
mod remote;
#[cfg(feature = "std")]
mod requests;
mod run;
#[cfg(feature = "std")]
mod shadow;
#[cfg(feature = "std")]
mod stop;
#[cfg(feature = "viewer")]
pub mod studio;
#[cfg(feature = "std")]
mod switch;
mod sync;
#[cfg(feature = "std")]
#[doc(hidden)]
pub mod testing;
pub mod threads;
mod time;
mod timer;
mod token;
#[cfg(feature = "std")]
mod watchdog;
mod wired;
mod witness;

pub use apex_attributes::{Outputs, Units, node};

pub use cell::{CellReceiver, CellSender, TokenCell};
#[cfg(feature = "std")]
pub use clock::WallClock;
pub use clock::{Clock, SimClock};
pub use ctx::Ctx;
pub use dispatch::{Bits, Cluster, Conditions, Dispatcher, Missing};
pub use event::Event;
#[doc(hidden)]
pub use event::event;
pub use failure::{Explains, Failure, contain, contain_fallible, explains};
pub use info::{ConnectionInfo, GroupInfo, Info, KindInfo, NodeInfo, Place, PortInfo, PortKind};
pub use list::List;
pub use mailbox::Mailbox;
#[doc(hidden)]
pub use mailbox::{Arrival, first_arrival, untaken};
pub use node::{Construct, Field, Fresh, Input, Output, Param, ParamField, Slot, Trigger};
#[doc(hidden)]
pub use node::{Params, construct};
pub use observer::Observer;
#[doc(hidden)]
pub use observer::turned;
#[cfg(feature = "std")]
pub use observer::{StdErr, listen_to_problems, tell_viewers};
pub use out::Out;
pub use parallel::par_map;
pub use params::Parameters;
#[cfg(feature = "std")]
pub use ports::{PortReceiver, PortSender, Ports};
pub use queue::{Queue, Steps};
#[cfg(feature = "std")]
pub use remote::RemoteParams;
#[cfg(feature = "std")]
pub use run::drive_from;
pub use run::{Next, Program, drive, drive_with, run};
#[cfg(feature = "std")]
pub use shadow::is_shadow;
#[cfg(feature = "std")]
pub use stop::UntilStopped;
#[cfg(feature = "std")]
pub use switch::Switch;
pub use time::Time;
#[doc(hidden)]
pub use timer::endured;
pub use timer::{Agenda, ProgramTime, Silence, Timeout, Timer};
pub use token::{Delay, checked_param, gather, sent, set_param, spread, store};
#[doc(hidden)]
pub use wired::{Wired, rows};

/// The items that most users of Apex need besides `apex_macros::graph`.
pub mod prelude {
    pub use crate::{
        Clock, Ctx, Event, Failure, Mailbox, Next, Observer, Out, Outputs, Parameters, Program, SimClock, Time, Units,
        node, run,
    };
    #[cfg(feature = "std")]
    pub use crate::{StdErr, WallClock};
}

/// Generated code for programs that can be recorded, or else the code for all others.
#[cfg(feature = "record")]
#[doc(hidden)]
#[macro_export]
macro_rules! __if_record {
    ({ $($recordable:tt)* } { $($plain:tt)* }) => { $($recordable)* };
}

/// Generated code for programs that can be recorded, or else the code for all others.
#[cfg(not(feature = "record"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __if_record {
    ({ $($recordable:tt)* } { $($plain:tt)* }) => { $($plain)* };
}
