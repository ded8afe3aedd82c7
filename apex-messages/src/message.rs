//! Messages, services and actions.

use crate::cdr::{Reader, Reason, Writer};
use alloc::{vec, vec::Vec};

/// A type that is encoded as a message of ROS 2: one of the messages themselves, or one that is converted to a message
/// and back.
///
/// Recordings keep such tokens as messages, so that other programs can read them. Implement it for your own types that
/// should be visible in Foxglove or Python. Reading must give exactly the written value, bit by bit: replays depend on
/// it.
pub trait Message: Sized {
    /// Name of the message: `sensor_msgs/msg/LaserScan`.
    const NAME: &'static str;
    /// Definition of the message as in a `.msg` file, and those of the messages in it after lines of `=`. The
    /// definition of `std_msgs/Header` may be left out.
    const DEFINITION: &'static str;
    /// Hash of the type, `RIHS01_…`, by which programs of ROS 2 find out that they mean the same; empty if it is not
    /// known.
    const HASH: &'static str = "";

    /// Writes the fields in the order of the definition.
    fn write(&self, message: &mut Writer<'_>);

    /// Reads the fields.
    ///
    /// # Errors
    /// The fields are not a value of this type: the reason.
    fn read(message: &mut Reader<'_>) -> Result<Self, Reason>;

    /// Returns the other messages that hold such a value, which tests read from the recordings of other programs, such
    /// as `nav_msgs/msg/Odometry` for a pose.
    fn others() -> Vec<Foreign<Self>> {
        vec![]
    }

    /// Returns the message as bytes.
    fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = vec![];
        self.write(&mut Writer::new(&mut bytes));
        bytes
    }

    /// Reads a message from its bytes.
    ///
    /// # Errors
    /// The bytes are not a value of this type: the reason.
    fn from_bytes(bytes: &[u8]) -> Result<Self, Reason> {
        Self::read(&mut Reader::new(bytes)?)
    }
}

/// Message of other programs that holds a value of a type.
pub struct Foreign<T> {
    /// Name of the message: `nav_msgs/msg/Odometry`.
    pub name: &'static str,
    /// Definition of the message.
    pub definition: &'static str,
    /// Hash of its type.
    pub hash: &'static str,
    /// Reads a value, which may be one of several in the message: the part of this name is wanted, or the only one if
    /// the name is empty. `None` if the message does not have this part.
    pub read: fn(&mut Reader<'_>, part: &str) -> Result<Option<T>, Reason>,
}

impl<T: Message> Foreign<T> {
    /// Returns the message that consists of the value.
    pub fn itself() -> Self {
        Self::of::<T>(|message, _| T::read(message).map(Some))
    }
}

impl<T> Foreign<T> {
    /// Returns the message `M` with the function that reads a value in it.
    pub fn of<M: Message>(read: fn(&mut Reader<'_>, part: &str) -> Result<Option<T>, Reason>) -> Self {
        Self { name: M::NAME, definition: M::DEFINITION, hash: M::HASH, read }
    }
}

/// Makes a type a [`Message`] by conversions: `From<&T>` for a message, and `TryFrom` that message, with [`Reason`] as
/// its error. After `outside =` stands the conversion for other programs, if it is another one: recordings have to give
/// back each bit. After `others =` stand the [`Foreign`] messages.
#[macro_export]
macro_rules! converted {
    ($({$parameter:ident: $bound:path})? $ty:ty as $message:path $(, outside = $outside:expr)? $(, others = $others:expr)?) => {
        impl $(<$parameter: $bound>)? $crate::Message for $ty {
            const NAME: &'static str = <$message as $crate::Message>::NAME;
            const DEFINITION: &'static str = <$message as $crate::Message>::DEFINITION;
            const HASH: &'static str = <$message as $crate::Message>::HASH;

            fn write(&self, message: &mut $crate::cdr::Writer<'_>) {
                $(
                    if message.is_for_others() {
                        let outside: fn(&Self) -> $message = $outside;
                        return $crate::Message::write(&outside(self), message);
                    }
                )?
                $crate::Message::write(&<$message>::from(self), message);
            }

            fn read(message: &mut $crate::cdr::Reader<'_>) -> ::core::result::Result<Self, $crate::Reason> {
                <Self as ::core::convert::TryFrom<$message>>::try_from($crate::Message::read(message)?)
            }

            $(fn others() -> $crate::Others<Self> {
                $others
            })?
        }
    };
}

/// Messages of other programs that hold a value of a type.
pub type Others<T> = Vec<Foreign<T>>;

/// A message by its name, without its type.
#[derive(Debug, Clone, Copy)]
pub struct Known {
    /// Name: `sensor_msgs/msg/LaserScan`.
    pub name: &'static str,
    /// Definition with those of the messages in it.
    pub definition: &'static str,
    /// Hash of the type.
    pub hash: &'static str,
    /// Reads a message, and writes it again in the same order of bytes.
    pub again: fn(&[u8]) -> Result<Vec<u8>, Reason>,
}

impl Known {
    /// Returns the message `M`.
    pub const fn of<M: Message>() -> Self {
        Self { name: M::NAME, definition: M::DEFINITION, hash: M::HASH, again: again::<M> }
    }
}

fn again<M: Message>(bytes: &[u8]) -> Result<Vec<u8>, Reason> {
    let mut reader = Reader::new(bytes)?;
    let (order, mut again) = (reader.order(), vec![]);
    M::read(&mut reader)?.write(&mut Writer::in_order(order, &mut again));
    Ok(again)
}

/// A service of ROS 2.
pub trait Service {
    /// Name of the service: `std_srvs/srv/SetBool`.
    const NAME: &'static str;
    /// Hash of its type.
    const HASH: &'static str;
    /// Message of clients.
    type Request: Message;
    /// Answer to it.
    type Response: Message;
}

/// An action of ROS 2: two services, and messages on its way. Its other parts are the same for all actions.
pub trait Action {
    /// Name of the action: `nav2_msgs/action/Spin`.
    const NAME: &'static str;
    /// Hash of its type.
    const HASH: &'static str;
    /// Aim of a run.
    type Goal: Message;
    /// End of a run.
    type Result: Message;
    /// Message during a run.
    type Feedback: Message;
    /// Service that begins a run.
    type SendGoal: Service;
    /// Service that waits for its end.
    type GetResult: Service;
    /// Feedback, with the identification of the run.
    type FeedbackMessage: Message;
}
