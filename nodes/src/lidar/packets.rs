use super::VelodynePacket;
use apex_rt::Time;

/// Maximum number of packets of a token: those of about a second.
pub const MAX_PACKETS: usize = 2048;

/// Packets of a VLP-16 in the order in which they came: a datagram, or all of a turn.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct VelodynePackets {
    /// Packets; at most [`MAX_PACKETS`] come through a recording.
    pub packets: Vec<VelodynePacket>,
}

impl VelodynePackets {
    /// Time of the last packet; zero if there is none.
    pub fn stamp(&self) -> Time {
        self.packets.last().map_or(Time::ZERO, |packet| packet.stamp)
    }
}

/// `clone_from` reuses the allocated storage.
impl Clone for VelodynePackets {
    fn clone(&self) -> Self {
        Self { packets: self.packets.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.packets.clone_from(&source.packets);
    }
}
