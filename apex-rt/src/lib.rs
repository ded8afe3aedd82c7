//! The runtime of Apex: what nodes are written with, and what drives a compiled graph.
//!
//! A program is a graph that `graph!` has compiled, or a [`Program`] of another kind. It reacts when it is called, and
//! [`run`] and [`drive`] call it by a [`Clock`]:
//!
//! ```
//! use apex_macros::graph;
//! use apex_rt::prelude::*;
//!
//! graph! {
//!     use apex_nodes::math::scale;
//!
//!     graph Double {
//!         in  x: f64;
//!         out y: f64;
//!
//!         x -> scale(factor = 2) -> y;
//!     }
//! }
//!
//! # fn main() {
//! let mut double = Double::new();
//! assert_eq!(double.inputs().x.put(21.0), Ok(()));
//! double.react(Time::ZERO);
//! assert_eq!(double.outputs().y, Some(42.0));
//! # }
//! ```
//!
//! `no_std`, without a heap, and without `unsafe` except in the cell between two threads. The feature `std` adds a wall
//! clock, a runner that sleeps between reactions, and messages on standard error.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(feature = "alloc")]
extern crate alloc;

pub mod bytes;
mod cell;
mod cell_message;
mod clock;
mod ctx;
mod dispatch;
mod drive;
#[cfg(feature = "std")]
mod end;
mod event;
mod failure;
mod info;
#[cfg(any(feature = "profile", feature = "record"))]
mod instruments;
mod list;
mod mailbox;
mod next;
mod node;
mod observer;
mod out;
mod outside;
mod parallel;
pub mod params;
#[cfg(feature = "std")]
mod ports;
#[cfg(feature = "profile")]
pub mod profile;
mod program;
mod queue;
mod react;
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
#[doc(hidden)]
pub mod shown;
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

/// Derives the outputs of a node from the fields of a struct.
///
/// ```
/// use apex_rt::prelude::*;
///
/// /// Values by their sign.
/// #[derive(Outputs)]
/// pub struct BySign {
///     pub positive: Option<f64>,
///     pub negative: Option<f64>,
/// }
///
/// #[node]
/// pub fn by_sign(x: &f64) -> BySign {
///     BySign { positive: (*x > 0.0).then_some(*x), negative: (*x < 0.0).then_some(*x) }
/// }
///
/// let outputs = by_sign(&3.0);
/// assert_eq!((outputs.positive, outputs.negative), (Some(3.0), None));
/// ```
pub use apex_attributes::Outputs;
/// Derives the units of numbers from the fields of a struct.
///
/// ```
/// use apex_rt::prelude::*;
///
/// /// A source file writes `Point { x: 1m, y: 20cm }`.
/// #[derive(Units)]
/// pub struct Point {
///     #[unit("m")]
///     pub x: f64,
///     #[unit("m")]
///     pub y: f64,
/// }
///
/// #[node]
/// pub fn distance(point: &Point) -> f64 {
///     point.x.hypot(point.y)
/// }
///
/// assert_eq!(distance(&Point { x: 3.0, y: 4.0 }), 5.0);
/// ```
pub use apex_attributes::Units;
/// Turns plain Rust into a node: arguments become ports, and marked fields become parameters.
///
/// ```
/// use apex_rt::prelude::*;
///
/// /// Passes on what is above a level.
/// #[node]
/// pub struct Above {
///     /// Largest value that does not pass.
///     #[param(unit = "m", default = 0.5, range = 0.0..=1.0)]
///     level: f64,
///     passed: u32,
/// }
///
/// #[node]
/// impl Above {
///     fn process(&mut self, x: &f64) -> Option<f64> {
///         let passes = *x > self.level;
///         self.passed += u32::from(passes);
///         passes.then_some(*x)
///     }
/// }
///
/// // A test can call it without a graph.
/// let mut above = Above { level: 0.5, passed: 0 };
/// assert_eq!([above.process(&0.4), above.process(&0.6)], [None, Some(0.6)]);
/// assert_eq!(above.passed, 1);
/// ```
pub use apex_attributes::node;

#[cfg(feature = "std")]
pub use clock::WallClock;
pub use clock::{Clock, SimClock};
pub use ctx::Ctx;
pub use drive::drive_with;
pub use event::{Event, event};
pub use failure::Failure;
pub use info::{ConnectionInfo, GroupInfo, Info, KindInfo, NodeInfo, Place, PortInfo, PortKind};
pub use list::List;
pub use mailbox::Mailbox;
pub use next::Next;
pub use observer::Observer;
#[cfg(feature = "std")]
pub use observer::{StdErr, listen_to_problems, tell_viewers};
pub use out::Out;
pub use params::Parameters;
#[cfg(feature = "std")]
pub use ports::{PortReceiver, PortSender, Ports};
pub use program::Program;
#[cfg(feature = "std")]
pub use remote::RemoteParams;
#[cfg(feature = "std")]
pub use run::drive_from;
pub use run::{drive, run};
#[cfg(feature = "std")]
pub use shadow::is_shadow;
#[cfg(feature = "std")]
pub use stop::UntilStopped;
#[cfg(feature = "std")]
pub use switch::Switch;
pub use time::Time;

// What generated code calls.
#[doc(hidden)]
pub use cell::{CellReceiver, CellSender, TokenCell};
#[doc(hidden)]
pub use dispatch::{Bits, Cluster, Conditions, Dispatcher, Missing};
#[doc(hidden)]
pub use failure::{Explains, contain, contain_fallible, explains};
#[doc(hidden)]
pub use mailbox::{Arrival, first_arrival, untaken};
#[doc(hidden)]
pub use node::{Construct, Field, Fresh, Input, Output, Param, ParamField, Params, Slot, Trigger, construct};
#[doc(hidden)]
pub use observer::turned;
#[doc(hidden)]
pub use parallel::par_map;
#[doc(hidden)]
pub use queue::{Queue, Steps};
#[doc(hidden)]
pub use timer::{Agenda, ProgramTime, Silence, Timeout, Timer, endured};
#[doc(hidden)]
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
