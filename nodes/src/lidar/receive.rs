use super::{MAX_PACKETS, PACKET, PacketError, VelodynePacket, VelodynePackets, packet::since};
use apex_rt::{Ctx, Out, Time, node};
use std::{
    fmt,
    io::{self, ErrorKind},
    net::UdpSocket,
};

/// Time within which the packets of a firing have come, in ns: older ones lay in a queue.
const RECENT: u64 = 1_000_000_000;

/// Error of a socket that is to receive packets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReceiveError {
    /// Address of the socket.
    pub address: String,
    /// Description of the error.
    pub message: String,
}

impl fmt::Display for ReceiveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.address, self.message)
    }
}

impl std::error::Error for ReceiveError {}

/// Receives the data packets of a VLP-16 from the network: a source, which sends those that have come since its last
/// firing, and ⊥ if there are none. It never waits. The scanner sends to the port 2368 unless it is set otherwise.
///
/// Give it a period of a few milliseconds: `every 5ms`. A scanner sends a packet every 1.3 ms, or every 0.7 ms with two
/// returns. The newest packet has the time of the firing as its stamp, the others have earlier ones by the clock of the
/// scanner.
///
/// Fails if the address cannot be listened to, and tries again in the next firing. Other datagrams are left out; it
/// fails if only such have come.
#[node]
#[derive(Debug, Default)]
pub struct ReceiveVelodyne {
    /// Address and port to listen at.
    #[param(default = "0.0.0.0:2368")]
    listen: &'static str,
    socket: Option<UdpSocket>,
}

#[node]
impl ReceiveVelodyne {
    fn process(&mut self, ctx: &Ctx, packets: &mut Out<VelodynePackets>) -> Result<(), ReceiveError> {
        let list = &mut packets.get_mut().packets;
        list.clear();
        let result = self.receive(ctx.now(), list);
        set_stamps(list, ctx.now());
        if list.is_empty() {
            packets.clear();
        }
        result.map_err(|message| ReceiveError { address: self.listen.to_owned(), message })
    }

    /// Reads what has come.
    fn receive(&mut self, now: Time, packets: &mut Vec<VelodynePacket>) -> Result<(), String> {
        // Longer datagrams are seen as such.
        let (mut bytes, mut other) = ([0; PACKET + 1], None);
        for _ in 0..MAX_PACKETS {
            let socket = self.socket().map_err(|error| format!("it cannot be listened to: {error}"))?;
            match socket.recv(&mut bytes).map(|length| VelodynePacket::new(now, &bytes[..length])) {
                Ok(Ok(packet)) => packets.push(packet),
                Ok(Err(error)) => other = Some(error),
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                // A message of the network about an earlier datagram.
                Err(_) => {}
            }
        }
        let only = other.filter(|_| packets.is_empty());
        only.map_or(Ok(()), |error: PacketError| Err(error.to_string()))
    }

    /// The socket, which is opened when it is first needed.
    fn socket(&mut self) -> io::Result<&UdpSocket> {
        if self.socket.is_none() {
            let socket = UdpSocket::bind(self.listen)?;
            socket.set_nonblocking(true)?;
            self.socket = Some(socket);
        }
        self.socket.as_ref().ok_or_else(|| ErrorKind::NotConnected.into())
    }
}

/// Sets the stamps of packets of which the last has just come.
fn set_stamps(packets: &mut [VelodynePacket], now: Time) {
    let Some(last) = packets.last().map(VelodynePacket::nanos) else { return };
    for packet in packets {
        let age = Some(since(packet.nanos(), last)).filter(|age| *age < RECENT).unwrap_or(0);
        packet.stamp = Time::from_nanos(now.as_nanos().saturating_sub(age as i64));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lidar::packet::tests::bytes;
    use apex_rt::Construct;
    use std::{thread, time::Duration};

    /// Node that listens at a free port, and a socket that sends to it.
    fn pair() -> (ReceiveVelodyne, UdpSocket) {
        let free = UdpSocket::bind("127.0.0.1:0").and_then(|socket| socket.local_addr()).expect("a free port");
        let socket = UdpSocket::bind("127.0.0.1:0").expect("another one");
        socket.connect(free).expect("an address");
        (ReceiveVelodyne::construct((free.to_string().leak() as &str,)), socket)
    }

    fn fire(node: &mut ReceiveVelodyne, millis: i64) -> (Option<VelodynePackets>, Option<String>) {
        let mut out = Out::new();
        let result = node.process(&Ctx::new(Time::from_millis(millis)), &mut out);
        (out.get().cloned(), result.err().map(|error| error.to_string()))
    }

    #[test]
    fn packets_come_with_their_times_and_others_are_left_out() {
        let (mut node, socket) = pair();
        assert_eq!(fire(&mut node, 1), (None, None));
        let packet = |micros| bytes((0x38, micros), |block| 40 * block as u16, |_, _, _| (500, 1));
        for bytes in [packet(1_000), vec![1, 2, 3], packet(2_327), vec![0; 3000]] {
            socket.send(&bytes).expect("sent");
        }
        thread::sleep(Duration::from_millis(50));
        let (packets, error) = fire(&mut node, 20);
        let stamps: Vec<i64> = packets.expect("packets").packets.iter().map(|p| p.stamp.as_nanos()).collect();
        assert_eq!((stamps, error), (vec![20_000_000 - 1_327_000, 20_000_000], None));
        socket.send(&[7; 512]).expect("sent");
        thread::sleep(Duration::from_millis(50));
        let (packets, error) = fire(&mut node, 30);
        let error = error.expect("an error");
        assert!(packets.is_none() && error.ends_with("a packet has 512 bytes, and a data packet of a VLP-16 1206"));
    }

    #[test]
    fn stamps_go_on_when_the_clock_of_the_scanner_begins_again() {
        let packet = |micros| bytes((0x38, micros), |block| 40 * block as u16, |_, _, _| (500, 1));
        let mut packets =
            [3_599_999_500, 827].map(|micros| VelodynePacket::new(Time::ZERO, &packet(micros)).expect("a packet"));
        set_stamps(&mut packets, Time::from_millis(20));
        assert_eq!(packets.map(|packet| packet.stamp.as_nanos()), [20_000_000 - 1_327_000, 20_000_000]);
    }

    #[test]
    fn an_address_that_is_taken_is_an_error() {
        let taken = UdpSocket::bind("127.0.0.1:0").expect("a port");
        let address = taken.local_addr().expect("an address").to_string();
        let mut node = ReceiveVelodyne::construct((address.clone().leak() as &str,));
        let error = fire(&mut node, 1).1.expect("an error");
        assert!(error.starts_with(&format!("{address}: it cannot be listened to: ")), "{error}");
        drop(taken);
        assert_eq!(fire(&mut node, 2), (None, None));
    }
}
