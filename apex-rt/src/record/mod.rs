//! Recordings: everything that enters the deterministic part of a program, in an MCAP file, and what comes of it when it
//! enters again.
//!
//! A program does the same again if it reacts at the same times, its sources send the same tokens, the same tokens are
//! put into its mailboxes, its events are taken out at the same times, its parameters are set as they were, and its
//! deadlines see the same delays. Where it runs on several threads, these also find the same when they look at what is
//! between them. That is what is recorded; and, to be compared, what was chosen besides.

pub mod cdr;
mod message;
mod recorder;
mod replay;
mod report;
mod run;
mod sink;
mod source;
mod tap;
mod threads;
mod tokens;
mod waits;

#[doc(hidden)]
pub use message::{ByMessage, ByNothing, BySerde, Kind};
pub use message::{Codec, Message, Schema};
pub use recorder::{Finished, Recorder, WhenFull};
pub use replay::{Replay, ReplayError};
pub use report::{Compared, Difference, Report};
pub use run::replay;
pub(crate) use run::{RunMode, drive};
pub use tap::Tap;
#[doc(hidden)]
pub use tap::looked;
pub use threads::record_on_threads;
#[doc(hidden)]
pub use tokens::tokens;

/// What passes a channel of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Tokens that are put into an input or a slot of the program.
    Mailbox,
    /// Tokens that an event of the program keeps until they are taken.
    Event,
    /// Tokens that a source sends, of its outputs and of its events.
    Source,
    /// Tokens that the program makes of them and that were chosen, to be compared.
    Chosen,
}

/// A channel of a recording: the tokens of one port.
#[derive(Debug, Clone, Copy)]
pub struct Channel {
    /// The port, with its node: `laser.scan`.
    pub name: &'static str,
    /// The node that it belongs to.
    pub node: usize,
    /// The group of threads that it belongs to.
    pub group: usize,
    /// What passes it.
    pub role: Role,
    /// How its tokens are written; `None` if they cannot be.
    pub schema: Option<Schema>,
    /// Shows a written token; `None` if it cannot be read.
    pub show: fn(&[u8]) -> Option<String>,
}

/// The table of all channels of a program. Generated code may stand in a crate that does not name the standard library.
pub type Channels = std::vec::Vec<Channel>;

/// How tokens of a type are recorded, for generated code.
#[doc(hidden)]
#[macro_export]
macro_rules! __codec {
    ($ty:ty) => {{
        #[allow(unused_imports, reason = "only one of them is right for a type")]
        use $crate::record::{ByMessage as _, ByNothing as _, BySerde as _};
        (&&&$crate::record::Kind::<$ty>::NEW).codec()
    }};
}

/// A row of the table of channels, for generated code.
#[doc(hidden)]
#[macro_export]
macro_rules! __channel {
    ($name:literal, $node:literal, $group:literal, $role:ident, $ty:ty) => {
        $crate::record::Channel {
            name: $name,
            node: $node,
            group: $group,
            role: $crate::record::Role::$role,
            schema: $crate::__codec!($ty).map(|codec| codec.schema),
            show: |bytes| {
                use $crate::testing::{ByDebug as _, ByType as _};
                let token = ($crate::__codec!($ty)?.read)(bytes)?;
                Some((&$crate::testing::Shown(&token)).shown())
            },
        }
    };
}
