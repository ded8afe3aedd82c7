//! Channels of recordings and their messages.

/// Channel of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Name of the channel: that of the port and its node, or the topic in a file of another program.
    pub name: String,
    /// Topic of the channel.
    pub topic: String,
    /// Name of the type of its messages: `sensor_msgs/msg/LaserScan`.
    pub schema: String,
    /// Shape of its tokens: the definition of their message, or the description of their type; `None` if the recording
    /// has none.
    pub shape: Option<String>,
    /// Encoding of its messages: `cdr`, `ros1`, `postcard`.
    pub encoding: String,
}

/// Message of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Number of its channel.
    pub channel: u16,
    /// Time in ns.
    pub time: u64,
    /// Sequence number.
    pub sequence: u32,
    /// Bytes of the message.
    pub data: Vec<u8>,
}
