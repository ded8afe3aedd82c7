//! Numbers and texts of Rust as the messages of `std_msgs`.

use crate::{
    Foreign, Message, Reason,
    cdr::{Reader, Writer},
    std_msgs,
};
use alloc::{borrow::ToOwned as _, string::String, vec, vec::Vec};

macro_rules! numbers {
    ($($ty:ident $message:ident ($($other:ident)*))*) => { $(
        // A number is also read from messages of numbers that it holds exactly.
        impl Message for $ty {
            const NAME: &'static str = std_msgs::$message::NAME;
            const DEFINITION: &'static str = std_msgs::$message::DEFINITION;
            const HASH: &'static str = std_msgs::$message::HASH;
            fn write(&self, message: &mut Writer<'_>) {
                message.number(*self);
            }
            fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
                message.number()
            }
            fn others() -> Vec<Foreign<Self>> {
                vec![$(Foreign::of::<$other>(|message, _| message.$other().map(|number| Some(number.into())))),*]
            }
        }
    )* };
}
numbers! {
    f64 Float64 (f32 i32 i16 i8 u32 u16 u8)
    f32 Float32 (i16 i8 u16 u8)
    i64 Int64 (i32 i16 i8 u32 u16 u8)
    i32 Int32 (i16 i8 u16 u8)
    i16 Int16 (i8 u8)
    i8 Int8 ()
    u64 UInt64 (u32 u16 u8)
    u32 UInt32 (u16 u8)
    u16 UInt16 (u8)
    u8 UInt8 ()
    bool Bool ()
}

impl Message for () {
    const NAME: &'static str = std_msgs::Empty::NAME;
    const DEFINITION: &'static str = std_msgs::Empty::DEFINITION;
    const HASH: &'static str = std_msgs::Empty::HASH;
    fn write(&self, message: &mut Writer<'_>) {
        // An empty ROS message still has one byte.
        message.u8(0);
    }
    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.empty()
    }
}

impl Message for String {
    const NAME: &'static str = std_msgs::String::NAME;
    const DEFINITION: &'static str = std_msgs::String::DEFINITION;
    const HASH: &'static str = std_msgs::String::HASH;
    fn write(&self, message: &mut Writer<'_>) {
        message.text(self);
    }
    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.text().map(str::to_owned)
    }
}
