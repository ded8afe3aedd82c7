//! ROS 2 message of the packets: `velodyne_msgs/msg/VelodyneScan`, as the drivers of ROS record it.

use super::{MAX_PACKETS, PACKET, VelodynePacket, VelodynePackets};
use crate::scan::message::FRAME;
use apex_messages::{
    Message, Reason, builtin_interfaces,
    cdr::{Reader, Writer},
    std_msgs::Header,
};
use apex_rt::Time;

/// Writes a stamp as other programs need it, if the message is for them.
fn write_stamp(stamp: Time, message: &mut Writer<'_>) {
    let stamp = message.outgoing(&Header::new(stamp, "")).stamp.clone();
    stamp.write(message);
}

/// Reads a packet. Its stamp counts as those of headers do.
fn read_packet(message: &mut Reader<'_>) -> Result<VelodynePacket, Reason> {
    let stamp = builtin_interfaces::Time::read(message)?;
    let stamp = message.incoming(Header { stamp, ..Header::default() }).stamp;
    VelodynePacket::new(stamp.into(), message.bytes(PACKET)?).map_err(|error| error.to_string().into())
}

impl Message for VelodynePackets {
    const NAME: &'static str = "velodyne_msgs/msg/VelodyneScan";
    const DEFINITION: &'static str = "std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets\n\
        ================================================================================\n\
        MSG: velodyne_msgs/VelodynePacket\nbuiltin_interfaces/Time stamp\nuint8[1206] data\n\
        ================================================================================\n\
        MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
        ================================================================================\n\
        MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
    const HASH: &'static str = "RIHS01_4e4edd7152e8bd604311d8b2e68e4c1b0771c8ce72700de79f6d1418aa242b3c";

    fn write(&self, message: &mut Writer<'_>) {
        Header::new(self.stamp(), FRAME).write(message);
        message.length(self.packets.len());
        for packet in &self.packets {
            write_stamp(packet.stamp, message);
            message.numbers(packet.bytes());
        }
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        Header::read(message)?;
        Ok(Self { packets: message.list_of(MAX_PACKETS, read_packet)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        lidar::packet::tests::bytes as packet,
        scan::message::tests::{again, bytes, reason},
    };
    use apex_messages::cdr::Outside;

    /// A token with two packets.
    fn packets(stamp: i64) -> VelodynePackets {
        let whole = packet((0x38, 5), |block| 40 * block as u16, |block, _, laser| (block as u16, laser as u8));
        let at = |stamp| VelodynePacket::new(Time::from_nanos(stamp), &whole).expect("a packet");
        VelodynePackets { packets: vec![at(stamp), at(stamp + 1_327_104)] }
    }

    #[test]
    fn packets_come_back_and_parts_of_them_do_not() {
        assert_eq!(again(&bytes(&VelodynePackets::default())), Some(VelodynePackets::default()));
        for stamp in [-7, 5_000_000_000] {
            let whole = bytes(&packets(stamp));
            assert_eq!(again(&whole), Some(packets(stamp)));
            assert!((0..whole.len()).all(|len| again::<VelodynePackets>(&whole[..len]).is_none()));
        }
    }

    #[test]
    fn times_of_other_programs_are_those_of_this_one() {
        let mut bytes = vec![];
        let outside = Outside { zero: 1_000, now: 0, frame: Some("velodyne") };
        packets(77).write(&mut Writer::new(&mut bytes).for_others(outside));
        let read = |zero| VelodynePackets::read(&mut Reader::new(&bytes).expect("CDR").since(zero)).expect("packets");
        assert_eq!((read(0), read(1_000)), (packets(1_077), packets(77)));
        let mut reader = Reader::new(&bytes).expect("CDR").in_frame("velodyne");
        assert!(VelodynePackets::read(&mut reader).is_ok() && reader.check_frame().is_ok());
    }

    #[test]
    fn packets_of_other_scanners_are_refused() {
        let mut whole = bytes(&packets(0));
        *whole.last_mut().expect("bytes") = 0x21;
        let why = reason::<VelodynePackets>(&whole).expect_err("an HDL-32E");
        assert!(why.starts_with("byte 1205 of a packet is 0x21"), "{why}");
        let mut many = bytes(&VelodynePackets::default());
        let end = many.len();
        many[end - 4..].copy_from_slice(&(MAX_PACKETS as u32 + 1).to_le_bytes());
        assert_eq!(reason::<VelodynePackets>(&many).expect_err("many"), "a list or a text of at most 2048 has 2049");
    }
}
