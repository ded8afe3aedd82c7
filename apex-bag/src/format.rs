//! Numbers and names in MCAP files: those of the format, and those that Apex adds.

/// First and last bytes of a file.
pub const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";

/// Kinds of records.
pub mod op {
    /// First record of a file.
    pub const HEADER: u8 = 0x01;
    /// Last record of a file.
    pub const FOOTER: u8 = 0x02;
    /// Type of the messages of channels.
    pub const SCHEMA: u8 = 0x03;
    /// Channel with its topic.
    pub const CHANNEL: u8 = 0x04;
    /// Message of a channel.
    pub const MESSAGE: u8 = 0x05;
    /// Records that may be compressed.
    pub const CHUNK: u8 = 0x06;
    /// Places of the messages in a chunk.
    pub const MESSAGE_INDEX: u8 = 0x07;
    /// Place of a chunk.
    pub const CHUNK_INDEX: u8 = 0x08;
    /// File in the file.
    pub const ATTACHMENT: u8 = 0x09;
    /// Place of an attachment.
    pub const ATTACHMENT_INDEX: u8 = 0x0a;
    /// Numbers of messages.
    pub const STATISTICS: u8 = 0x0b;
    /// Names with texts.
    pub const METADATA: u8 = 0x0c;
    /// Place of metadata.
    pub const METADATA_INDEX: u8 = 0x0d;
    /// Place of a group of records after the data.
    pub const SUMMARY_OFFSET: u8 = 0x0e;
    /// Checksum of the data.
    pub const DATA_END: u8 = 0x0f;
}

/// Name of the compression LZ4 of a chunk.
pub const LZ4: &str = "lz4";
/// Name of the compression Zstandard of a chunk.
pub const ZSTD: &str = "zstd";

/// Key of the name of a channel, in its metadata.
pub const CHANNEL_NAME: &str = "apex/name";
/// Name of the metadata with the numbers of lost messages.
pub const DROPPED: &str = "apex/dropped";
/// Name of the metadata on the recorded program.
pub const PROGRAM: &str = "apex/program";
/// Name of the metadata at the end of a file of a recording that goes on in another one.
pub const GOES_ON: &str = "apex/next";
/// Key of the name of that file.
pub const NEXT: &str = "file";
/// Key of the number of a file in a recording that is divided, in the metadata on the program.
pub const NUMBER: &str = "file";
/// Key of the thread groups that ran in parallel, in the metadata on the program.
pub const THREADS: &str = "threads";
/// Encoding of the schemas of messages.
pub const MESSAGES: &str = "ros2msg";
/// Encoding of the schemas of messages of ROS 1.
pub const MESSAGES_OF_ROS1: &str = "ros1msg";
/// Encoding of the schemas of types that are not messages.
pub const SHAPE: &str = "apex";
