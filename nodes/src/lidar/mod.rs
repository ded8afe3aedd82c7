//! Data packets of laser scanners with rings, as they come from the network.
//!
//! A [`VelodynePacket`] is decoded into [`Firing`]s without a heap. With the feature `std`, [`VelodyneTurns`] makes a
//! [`RingCloud`](crate::cloud::RingCloud) of each turn. Its packets come from a socket ([`ReceiveVelodyne`]), from a
//! capture of the network ([`VelodyneCapture`](crate::io::VelodyneCapture)), or from a topic of ROS
//! ([`BagTopic`](crate::io::BagTopic)).

#[cfg(feature = "record")]
mod message;
mod packet;
#[cfg(feature = "std")]
mod packets;
#[cfg(feature = "std")]
mod receive;
#[cfg(feature = "std")]
mod turns;

pub use packet::{Echo, Firing, LASERS, PACKET, PacketError, VelodynePacket, elevation};
#[cfg(feature = "std")]
pub use packets::{MAX_PACKETS, VelodynePackets};
#[cfg(feature = "std")]
pub use receive::{ReceiveError, ReceiveVelodyne};
#[cfg(feature = "std")]
pub use turns::VelodyneTurns;

/// Bytes of a packet, for the tests of readers.
#[cfg(test)]
pub(crate) use packet::tests::bytes as packet_bytes;
