use super::{ReadError, pcap::Capture};
use crate::lidar::{MAX_PACKETS, VelodynePacket, VelodynePackets};
use apex_rt::{Ctx, Event, Out, Time, node};
use std::path::Path;

/// Plays the data packets of a VLP-16 in a capture of the network (`.pcap`, as `tcpdump -w` writes it, of Ethernet,
/// IPv4 and UDP): a source, which sends those whose time has come, counted from the first one, and ⊥ if there are
/// none. After the last one it triggers `done`, or with `repeat` begins again at the time of that firing.
///
/// Give it a period of a few milliseconds: `every 5ms`. The file is read while it is played. The stamps are the times
/// of the capture, counted from the first packet, after the time at which the node began.
///
/// Fails if the file cannot be read, is damaged, or has no such packet, and at a datagram to the port that is not one,
/// which is left out. A file that was cut off ends there.
#[node]
#[derive(Debug)]
pub struct VelodyneCapture {
    /// Path of the file.
    #[param]
    file: String,
    /// Port to which the scanner sends.
    #[param(default = 2368)]
    port: u16,
    /// Plays the file again and again.
    #[param(default = false)]
    repeat: bool,
    state: State,
}

/// Progress of the node.
#[derive(Debug, Default)]
enum State {
    #[default]
    Closed,
    Playing(Box<Player>),
    /// With the last packet sent, or after an error.
    Ended,
}

/// Capture that is being played.
#[derive(Debug)]
struct Player {
    capture: Capture,
    /// Time at which it began.
    begun: Time,
    /// Time of the first packet, in ns.
    start: Option<u64>,
    /// Next packet, or the error of a datagram that is not one.
    next: Option<Result<VelodynePacket, ReadError>>,
}

#[node]
impl VelodyneCapture {
    fn process(&mut self, ctx: &Ctx, packets: &mut Out<VelodynePackets>, done: Event<()>) -> Result<(), ReadError> {
        if let State::Closed = self.state {
            // Not opened again in each firing, if it cannot be.
            self.state = State::Ended;
            self.state = State::Playing(Box::new(Player::open(Path::new(&self.file), ctx.now())?));
        }
        let State::Playing(player) = &mut self.state else { return Ok(()) };
        let list = &mut packets.get_mut().packets;
        list.clear();
        let result = player.read(self.port, ctx.now(), list);
        let is_empty = list.is_empty();
        if is_empty {
            packets.clear();
        }
        match result {
            Err(error) => {
                self.state = State::Ended;
                Err(error)
            }
            // The end, or an error, has a firing of its own.
            Ok(_) if !is_empty => Ok(()),
            Ok(true) => {
                let end = player.end(self.port);
                self.state = if self.repeat && end.is_ok() { State::Closed } else { State::Ended };
                done.emit(());
                end
            }
            Ok(false) => player.next.take_if(|next| next.is_err()).map_or(Ok(()), |next| next.map(drop)),
        }
    }
}

impl Player {
    fn open(file: &Path, begun: Time) -> Result<Self, ReadError> {
        Ok(Self { capture: Capture::open(file)?, begun, start: None, next: None })
    }

    /// Adds the packets whose time has come, up to a datagram that is not one. Returns `true` at the end of the file.
    fn read(&mut self, port: u16, now: Time, packets: &mut Vec<VelodynePacket>) -> Result<bool, ReadError> {
        while packets.len() < MAX_PACKETS {
            if self.next.is_none() {
                self.next = self.read_next(port)?;
            }
            match &self.next {
                None => return Ok(true),
                Some(Ok(packet)) if packet.stamp <= now => packets.push(*packet),
                Some(_) => return Ok(false),
            }
            self.next = None;
        }
        Ok(false)
    }

    /// Returns an error if the capture had no packet.
    fn end(&self, port: u16) -> Result<(), ReadError> {
        let none = || self.capture.error(&format!("it has no data packet of a VLP-16 to port {port}"));
        self.start.map(drop).ok_or_else(none)
    }

    fn read_next(&mut self, port: u16) -> Result<Option<Result<VelodynePacket, ReadError>>, ReadError> {
        let Some((time, bytes)) = self.capture.next(port)? else { return Ok(None) };
        let after = time.saturating_sub(self.start.unwrap_or(time));
        let stamp = self.begun.as_nanos().saturating_add(i64::try_from(after).unwrap_or(i64::MAX));
        let packet = VelodynePacket::new(Time::from_nanos(stamp), bytes);
        if packet.is_ok() {
            self.start.get_or_insert(time);
        }
        Ok(Some(packet.map_err(|error| self.capture.error(&error.to_string()))))
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::pcap::tests::{MICROS, capture, file, frame},
        *,
    };
    use crate::lidar::packet_bytes;
    use apex_rt::{Construct, event};

    fn packet(number: u32) -> Vec<u8> {
        packet_bytes((0x37, 1_000 * number), |block| 40 * block as u16, |_, _, _| (500, number as u8))
    }

    fn node(name: &str, bytes: &[u8], repeat: bool) -> VelodyneCapture {
        VelodyneCapture::construct((file(name, bytes).to_string_lossy().into_owned(), 2368, repeat))
    }

    /// Stamps in ms, error, and end of a firing.
    fn fire(node: &mut VelodyneCapture, millis: i64) -> (Vec<i64>, Option<String>, bool) {
        let (mut out, mut done) = (Out::new(), None);
        let result = node.process(&Ctx::new(Time::from_millis(millis)), &mut out, event(&mut done));
        let packets = out.get().map_or(&[][..], |packets: &VelodynePackets| &packets.packets);
        let stamps = packets.iter().map(|packet| packet.stamp.as_nanos() / 1_000_000).collect();
        (stamps, result.err().map(|error| error.message), done.is_some())
    }

    fn frames() -> Vec<(u32, u32, Vec<u8>)> {
        let at = |millis: u32, bytes: Vec<u8>| (50, 1000 * millis, frame(2368, &bytes));
        vec![at(0, packet(0)), at(2, packet(1)), at(4, vec![1; 512]), at(6, packet(2)), at(20, packet(3))]
    }

    #[test]
    fn packets_come_at_their_times() {
        let mut node = node("times.pcap", &capture(false, MICROS, 1, &frames()), false);
        assert_eq!(fire(&mut node, 100), (vec![100], None, false));
        assert_eq!(fire(&mut node, 101), (vec![], None, false));
        assert_eq!(fire(&mut node, 110), (vec![102], None, false), "up to the one that is not a packet");
        let (stamps, error, _) = fire(&mut node, 111);
        assert!(stamps.is_empty() && error.is_some_and(|error| error.starts_with("a packet has 512 bytes")));
        assert_eq!(fire(&mut node, 112), (vec![106], None, false));
        assert_eq!(fire(&mut node, 120), (vec![120], None, false));
        assert_eq!(fire(&mut node, 121), (vec![], None, true));
        assert_eq!(fire(&mut node, 122), (vec![], None, false));
    }

    #[test]
    fn a_capture_is_repeated() {
        let mut node = node("again.pcap", &capture(false, MICROS, 1, &frames()[..2]), true);
        assert_eq!(fire(&mut node, 100).0, [100]);
        assert_eq!(fire(&mut node, 150).0, [102]);
        assert_eq!(fire(&mut node, 160), (vec![], None, true));
        assert_eq!(fire(&mut node, 170).0, [170]);
    }

    #[test]
    fn a_capture_without_packets_is_an_error() {
        let mut node = node("none.pcap", &capture(false, MICROS, 1, &[(1, 1, frame(8308, &[7; 512]))]), true);
        let (_, error, is_done) = fire(&mut node, 0);
        assert!(is_done && error.is_some_and(|error| error == "it has no data packet of a VLP-16 to port 2368"));
        assert_eq!(fire(&mut node, 1), (vec![], None, false));
    }
}
