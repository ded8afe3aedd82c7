//! Tokens as messages: types with a ROS 2 message, and the encoding of all others.

use super::shape::shape;
use crate::{Failure, Time};
use apex_messages::{
    Foreign, Message, Reason, builtin_interfaces,
    cdr::{Reader, Writer},
    std_msgs,
};
use core::{any::type_name, marker::PhantomData};
use serde::{Serialize, de::DeserializeOwned};
use std::{borrow::Cow, iter};

/// Line between the definitions of messages.
const LINE: &str = "================================================================================";

/// Reason for bytes that serde cannot read.
const WRONG: Reason = Cow::Borrowed("bytes are missing, or are those of another type");
/// Reason for bytes after a token.
const LEFT_OVER: Reason = Cow::Borrowed("bytes are left over");

/// Schema of a channel: type and encoding of its tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schema {
    /// Name of the message, or of the Rust type.
    pub name: &'static str,
    /// Definition of the message; that of its header may be missing. Empty for a Rust type.
    pub definition: &'static str,
    /// Encoding: `cdr` or `postcard`.
    pub encoding: &'static str,
}

impl Schema {
    /// Returns the definition of the message with that of its header, as other programs need it.
    pub(crate) fn complete_definition(&self) -> String {
        let lacks_header =
            self.definition.starts_with("std_msgs/Header ") && !self.definition.contains("MSG: std_msgs/Header");
        if !lacks_header {
            return self.definition.to_owned();
        }
        format!("{}\n{LINE}\nMSG: std_msgs/Header\n{}", self.definition, std_msgs::Header::DEFINITION)
    }
}

/// Functions that write and read the tokens of a type.
pub struct Codec<T> {
    /// Schema of the channel.
    pub schema: Schema,
    /// Appends a token to the bytes; `false` if it cannot be written.
    pub write: fn(&T, &mut Vec<u8>) -> bool,
    /// Reads a token. Fails with the reason if the bytes are not one, or more than one.
    pub read: fn(&[u8]) -> Result<T, Reason>,
    /// Reads a token like `read`, with the stamps of headers counted from a zero in ns ([`Reader::since`]).
    pub read_since: fn(&[u8], i64) -> Result<T, Reason>,
    /// Returns the shape of the type: the definition of the message, or all that serde reads.
    pub shape: fn() -> String,
    /// Returns the messages that hold a token of the type, its own first; none for types that are not messages.
    pub messages: fn() -> Vec<Foreign<T>>,
}

impl<T> Clone for Codec<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Codec<T> {}

/// A type of tokens, with which generated code selects its codec. A call of `codec` on `&&&&Kind` is
/// [`ByReference::codec`] if the type is a reference, [`ByMessage::codec`] if it is a [`Message`],
/// [`BySerde::codec`] if it has the traits of serde, and [`ByNothing::codec`] otherwise, because rustc tries the type
/// with more references first.
pub struct Kind<T>(PhantomData<T>);

impl<T> Kind<T> {
    /// Value for the type.
    pub const NEW: Self = Self(PhantomData);
}

/// Answer of a [`Kind`] whose tokens can be recorded.
pub struct Recordable;

/// Answer of a [`Kind`] whose tokens cannot be recorded.
pub struct NotRecordable<T>(PhantomData<T>);

/// References, which cannot be read back from a file.
pub trait ByReference<T> {
    /// Returns that they cannot be recorded.
    fn is_recordable(&self) -> NotRecordable<T> {
        NotRecordable(PhantomData)
    }

    /// Returns `None`. Without this, serde would be asked whether it reads references of every lifetime.
    fn codec(&self) -> Option<Codec<T>> {
        None
    }
}

impl<U: ?Sized> ByReference<&'static U> for &&&Kind<&'static U> {}

/// Codec of types that are messages.
pub trait ByMessage<T> {
    /// Returns that they can be recorded.
    fn is_recordable(&self) -> Recordable {
        Recordable
    }

    /// Returns the codec.
    fn codec(&self) -> Option<Codec<T>>;
}

impl<T: Message> ByMessage<T> for &&Kind<T> {
    fn codec(&self) -> Option<Codec<T>> {
        Some(Codec {
            schema: message::<T>(),
            write: |token, bytes| {
                token.write(&mut Writer::new(bytes));
                true
            },
            read: |bytes| read_message(bytes, 0),
            read_since: read_message,
            shape: || message::<T>().complete_definition(),
            messages: || iter::once(Foreign::itself()).chain(T::others()).collect(),
        })
    }
}

fn read_message<T: Message>(bytes: &[u8], zero: i64) -> Result<T, Reason> {
    let mut message = Reader::new(bytes)?.since(zero);
    let token = T::read(&mut message)?;
    let is_whole = message.left() == 0 || message.left() == unread(&token)?;
    if is_whole { Ok(token) } else { Err(LEFT_OVER) }
}

/// Number of bytes at the end of a token that its type writes and does not read, such as fields that are always zero.
fn unread<T: Message>(token: &T) -> Result<usize, Reason> {
    let mut bytes = vec![];
    token.write(&mut Writer::new(&mut bytes));
    let mut message = Reader::new(&bytes)?;
    T::read(&mut message)?;
    Ok(message.left())
}

fn message<T: Message>() -> Schema {
    Schema { name: T::NAME, definition: T::DEFINITION, encoding: "cdr" }
}

/// Codec of types with the traits of serde.
pub trait BySerde<T> {
    /// Returns that they can be recorded.
    fn is_recordable(&self) -> Recordable {
        Recordable
    }

    /// Returns the codec.
    fn codec(&self) -> Option<Codec<T>>;
}

impl<T: Serialize + DeserializeOwned> BySerde<T> for &Kind<T> {
    fn codec(&self) -> Option<Codec<T>> {
        Some(Codec {
            schema: Schema { name: type_name::<T>(), definition: "", encoding: "postcard" },
            write: |token, bytes| postcard::to_io(token, &mut *bytes).is_ok(),
            read: read_by_serde,
            read_since: |bytes, _| read_by_serde(bytes),
            shape: shape::<T>,
            messages: Vec::new,
        })
    }
}

fn read_by_serde<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, Reason> {
    let (token, rest) = postcard::take_from_bytes(bytes).map_err(|_| WRONG)?;
    if rest.is_empty() { Ok(token) } else { Err(LEFT_OVER) }
}

/// Codec of all other types: none.
pub trait ByNothing<T> {
    /// Returns that they cannot be recorded.
    fn is_recordable(&self) -> NotRecordable<T> {
        NotRecordable(PhantomData)
    }

    /// Returns `None`.
    fn codec(&self) -> Option<Codec<T>>;
}

impl<T> ByNothing<T> for Kind<T> {
    fn codec(&self) -> Option<Codec<T>> {
        None
    }
}

impl Message for Failure {
    const NAME: &'static str = String::NAME;
    const DEFINITION: &'static str = String::DEFINITION;
    const HASH: &'static str = String::HASH;
    fn write(&self, message: &mut Writer<'_>) {
        message.text(self.text());
    }
    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.text().map(|text| Self::new(&text))
    }
}

impl From<Time> for builtin_interfaces::Time {
    fn from(time: Time) -> Self {
        Self::from_nanos(time.as_nanos())
    }
}

impl From<builtin_interfaces::Time> for Time {
    fn from(time: builtin_interfaces::Time) -> Self {
        Self::from_nanos(time.as_nanos())
    }
}

impl Message for Time {
    const NAME: &'static str = "apex_msgs/msg/Time";
    const DEFINITION: &'static str = "int64 nanoseconds";
    fn write(&self, message: &mut Writer<'_>) {
        message.i64(self.as_nanos());
    }
    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.i64().map(Self::from_nanos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::fmt::Debug;

    /// Writes and reads a token.
    fn again<T>(codec: Option<Codec<T>>, token: &T) -> (Schema, Option<T>) {
        let (codec, mut bytes) = (codec.expect("it can be recorded"), vec![]);
        assert!((codec.write)(token, &mut bytes));
        assert!((0..bytes.len()).all(|cut| { (codec.read)(&bytes[..cut]).is_err() || codec.schema.encoding != "cdr" }));
        (codec.schema, (codec.read)(&bytes).ok())
    }

    fn same<T: Message + PartialEq + Debug>(token: T) {
        let (schema, read) = again(crate::__codec!(T), &token);
        assert_eq!((schema.encoding, read), ("cdr", Some(token)));
    }

    #[test]
    fn messages_come_back() {
        same(-1.5_f64);
        same(f32::MIN_POSITIVE);
        same(i64::MIN);
        same(u8::MAX);
        same(true);
        same(());
        same("zwölf".to_owned());
        same(String::new());
        same(Failure::new(&"no more paper"));
        same(Time::from_nanos(-1));
    }

    #[test]
    fn nan_keeps_its_bits() {
        let odd = f32::from_bits(0x7fc0_1234);
        let (_, read) = again(crate::__codec!(f32), &odd);
        assert_eq!(read.map(f32::to_bits), Some(odd.to_bits()));
        let (schema, read) = again(crate::__codec!(Vec<f32>), &vec![odd, -0.0]);
        let bits = read.map(|list| list.into_iter().map(f32::to_bits).collect::<Vec<_>>());
        assert_eq!((schema.encoding, bits), ("postcard", Some(vec![odd.to_bits(), (-0.0_f32).to_bits()])));
    }

    #[test]
    fn bytes_that_are_left_over_are_an_error() {
        fn longer<T>(codec: Option<Codec<T>>, token: &T) -> Option<Reason> {
            let (codec, mut bytes) = (codec.expect("it can be recorded"), vec![]);
            (codec.write)(token, &mut bytes);
            bytes.push(0);
            (codec.read)(&bytes).err()
        }
        assert_eq!(longer(crate::__codec!(f64), &1.0), Some(LEFT_OVER));
        assert_eq!(longer(crate::__codec!(String), &"one".to_owned()), Some(LEFT_OVER));
        assert_eq!(longer(crate::__codec!(Vec<u8>), &vec![1]), Some(LEFT_OVER));
        assert_eq!(longer(crate::__codec!((u8, f32)), &(1, 1.0)), Some(LEFT_OVER));
    }

    /// A number whose message also has a frame, which it does not keep, and a part that it does not read.
    #[derive(Debug, PartialEq)]
    struct Framed(f64);

    impl Message for Framed {
        const NAME: &'static str = "framed";
        const DEFINITION: &'static str = "string frame\nfloat64 data\nfloat64 variance";
        fn write(&self, message: &mut Writer<'_>) {
            message.text("robot");
            message.f64(self.0);
            message.f64(0.0);
        }
        fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
            message.text()?;
            message.f64().map(Self)
        }
    }

    #[test]
    fn messages_of_other_programs_may_differ_where_nothing_is_kept() {
        let codec = crate::__codec!(Framed).expect("a message");
        let write = |frame: &str, rest: &[f64]| {
            let mut bytes = vec![];
            let mut message = Writer::new(&mut bytes);
            message.text(frame);
            message.f64(2.5);
            rest.iter().for_each(|number| message.f64(*number));
            bytes
        };
        assert_eq!((codec.read)(&write("robot", &[0.0])), Ok(Framed(2.5)));
        assert_eq!((codec.read)(&write("base_link_of_another_robot", &[1.0])), Ok(Framed(2.5)));
        assert_eq!((codec.read)(&write("robot", &[])), Ok(Framed(2.5)), "an earlier version of the message");
        assert_eq!((codec.read)(&write("robot", &[0.0, 0.0])), Err(LEFT_OVER));
    }

    #[test]
    fn the_reason_tells_what_is_wrong_with_a_message() {
        let codec = crate::__codec!(f64).expect("a message");
        let number = 1.5_f64.to_le_bytes();
        let read = |prefix: &[u8], rest: &[u8]| (codec.read)(&[prefix, rest].concat());
        assert_eq!(read(&[0, 1, 0, 0], &number), Ok(1.5));
        assert_eq!(read(&[0, 0, 0, 0], &1.5_f64.to_be_bytes()), Ok(1.5));
        assert_eq!(read(&[0, 1, 0, 3], &[&number[..], &[0; 3]].concat()), Ok(1.5), "padding as RTPS allows it");
        for (prefix, rest, reason) in [
            (&[0, 1, 0, 0][..], &number[..7], "bytes are missing"),
            (&[0, 1, 0, 3], &[], "bytes are missing"),
            (&[0, 1], &[], "bytes are missing"),
            (&[0, 7, 0, 0], &number, "it is encoded in a version of CDR that is not supported"),
            (b"{\"da", &number, "it does not begin as CDR"),
        ] {
            assert_eq!(read(prefix, rest), Err(reason.into()), "{prefix:?}");
        }
        let text = crate::__codec!(String).expect("a message");
        let read = |bytes: &[u8]| (text.read)(&[&[0, 1, 0, 0, bytes.len() as u8, 0, 0, 0], bytes].concat());
        assert_eq!(read(b"a"), Err("a text does not end with a zero byte".into()));
        assert_eq!(read(b"\xe4\0"), Err("a text is not UTF-8".into()));
    }

    #[test]
    fn a_type_that_nobody_knows_has_no_codec() {
        struct Opaque;
        assert!(crate::__codec!(Opaque).is_none());
        let _ = Opaque;
    }
}
