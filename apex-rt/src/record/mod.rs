//! Recordings: all inputs of the deterministic part of a program in an MCAP file, and the replay of such a file.
//!
//! A program repeats a run if it reacts at the same times, its sources send the same tokens, the same tokens are put
//! into its mailboxes, its events are taken out at the same times, its parameters are set to the same values, and its
//! deadlines see the same delays. If it runs on several threads, these must also find the same tokens in the cells
//! between them. All of this is recorded, and also the tokens of selected ports, for comparison.

mod definition;
mod file;
mod limits;
mod message;
mod mode;
mod recorder;
mod repeat;
mod replay;
mod report;
mod run;
mod shape;
mod sink;
mod tap;
mod threads;
mod tokens;
mod types;
mod waits;

pub use apex_messages::{Foreign, Message, Reason, cdr};
pub use limits::RecordOptions;
#[doc(hidden)]
pub use message::{ByMessage, ByNothing, ByReference, BySerde, Kind, NotRecordable, Recordable};
pub use message::{Codec, Schema};
pub(crate) use mode::RunMode;
pub use recorder::{Finished, Recorder, WhenFull};
pub use replay::{Replay, ReplayError};
pub use report::{Compared, Difference, Report};
pub(crate) use run::drive;
pub use run::replay;
pub use tap::Tap;
#[doc(hidden)]
pub use tap::{looked, sent};
pub use threads::record_on_threads;
#[doc(hidden)]
pub use tokens::{Tokens, tokens};
pub use types::TypeChange;
#[doc(hidden)]
pub use types::other_message;

/// Role of the tokens of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Tokens that are put into an input or a slot of the program.
    Mailbox,
    /// Tokens of an event of the program, which stay in its mailbox until they are taken.
    Event,
    /// Tokens that a source sends over its outputs and events.
    Source,
    /// Tokens of a port in a `record` statement, for comparison.
    Chosen,
    /// Tokens of another port. They are not recorded.
    Port,
}

/// The tokens of one port, as recordings and observers see them.
#[derive(Debug, Clone, Copy)]
pub struct Channel {
    /// Name of the port and its node: `laser.scan`.
    pub name: &'static str,
    /// Node of the port.
    pub node: usize,
    /// Thread group of the port.
    pub group: usize,
    /// Role of its tokens.
    pub role: Role,
    /// Schema of its tokens; `None` if they cannot be recorded.
    pub schema: Option<Schema>,
    /// Returns the shape of its tokens: the definition of their message, or the fields, variants and numbers that serde
    /// reads.
    pub shape: fn() -> String,
    /// Converts a recorded token to readable text; `None` if it cannot be read.
    pub show: fn(&[u8]) -> Option<String>,
}

impl Channel {
    /// Returns a row of the table of channels.
    #[doc(hidden)]
    pub const fn new(name: &'static str, node: usize, group: usize, role: Role, format: Format) -> Self {
        Self { name, node, group, role, schema: format.schema, shape: format.shape, show: format.show }
    }
}

/// Schema of the tokens of a type, and the function that shows a recorded one.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct Format {
    pub schema: Option<Schema>,
    pub shape: fn() -> String,
    pub show: fn(&[u8]) -> Option<String>,
}

/// The table of all channels of a program. The crate of generated code may not name the standard library.
#[doc(hidden)]
pub type Channels = std::vec::Vec<Channel>;

/// Asks a type of tokens for its `codec`, or whether it `is_recordable`, for generated code.
#[doc(hidden)]
#[macro_export]
macro_rules! __kind {
    ($ty:ty, $asked:ident) => {{
        #[allow(unused_imports, reason = "only one of them is right for a type")]
        use $crate::record::{ByMessage as _, ByNothing as _, ByReference as _, BySerde as _};
        (&&&&$crate::record::Kind::<$ty>::NEW).$asked()
    }};
}

/// Returns the codec of a type of tokens.
#[doc(hidden)]
#[macro_export]
macro_rules! __codec {
    ($ty:ty) => {
        $crate::__kind!($ty, codec)
    };
}

/// Defines the functions that return the codec and the format of a type of tokens, for generated code.
#[doc(hidden)]
#[macro_export]
macro_rules! __format {
    ($codec:ident, $format:ident, $ty:ty) => {
        fn $codec() -> ::core::option::Option<$crate::record::Codec<$ty>> {
            $crate::__codec!($ty)
        }
        fn $format() -> $crate::record::Format {
            $crate::record::Format {
                schema: $codec().map(|codec| codec.schema),
                shape: || $codec().map(|codec| (codec.shape)()).unwrap_or_default(),
                show: |bytes| {
                    use $crate::shown::{ByDebug as _, ByType as _};
                    let token = ($codec()?.read)(bytes).ok()?;
                    Some((&$crate::shown::Shown(&token)).shown())
                },
            }
        }
    };
}
