//! Reader of captures of the network: the classic format of `tcpdump` (pcap).

use super::ReadError;
use std::{
    fs::File,
    io::{BufReader, ErrorKind, Read},
    ops::Range,
    path::{Path, PathBuf},
};

/// Maximum size of a captured frame, in bytes, as `tcpdump` has it.
const LARGEST: u32 = 1 << 18;
/// Link layer of a capture of a network interface.
const ETHERNET: u32 = 1;
/// Bits of the link layer that are not its number.
const FLAGS: u32 = 0xf000_0000;

/// Types of Ethernet frames: IPv4, and those with a tag of a virtual network before the type.
const IPV4: [u8; 2] = [0x08, 0x00];
const TAGGED: [[u8; 2]; 2] = [[0x81, 0x00], [0x88, 0xa8]];
/// Number of UDP among the protocols of IPv4.
const UDP: u8 = 17;

/// Capture that is being read.
#[derive(Debug)]
pub struct Capture {
    path: PathBuf,
    file: BufReader<File>,
    is_big_endian: bool,
    /// Nanoseconds in the fraction of a time.
    fraction: u64,
    /// Bytes that were read.
    at: u64,
    frame: Vec<u8>,
}

impl Capture {
    /// Opens a capture.
    ///
    /// # Errors
    /// If the file cannot be read, or is not a capture of Ethernet.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let file = File::open(path).map_err(|error| ReadError::open(path, error))?;
        let mut capture = Self {
            path: path.into(),
            file: BufReader::new(file),
            is_big_endian: false,
            fraction: 1,
            at: 0,
            frame: vec![],
        };
        let head: Option<[u8; 24]> = capture.take()?;
        let head = head.ok_or_else(|| capture.error("it is not a capture: a pcap file has a head of 24 bytes"))?;
        (capture.is_big_endian, capture.fraction) = kind(&head).map_err(|why| capture.error(why))?;
        match capture.number(&head, 20) & !FLAGS {
            ETHERNET => Ok(capture),
            link => Err(capture.error(&format!(
                "its link layer has the number {link}, and not {ETHERNET}, that of Ethernet: capture a network \
                 interface, `tcpdump -i eth0`, and not all of them"
            ))),
        }
    }

    /// Reads the next UDP datagram to a port: its time in ns, and its content. `None` at the end, or where the file is
    /// cut off.
    ///
    /// # Errors
    /// If the file cannot be read, or is damaged.
    pub fn next(&mut self, port: u16) -> Result<Option<(u64, &[u8])>, ReadError> {
        loop {
            let Some(head) = self.take::<16>()? else { return Ok(None) };
            let [seconds, fraction, length] = [0, 4, 8].map(|at| self.number(&head, at));
            if length > LARGEST {
                let place = self.at - 16;
                let why = format!("it is damaged: the frame at byte {place} has {length} bytes, and at most {LARGEST}");
                return Err(self.error(&why));
            }
            if !self.take_frame(length as usize)? {
                return Ok(None);
            }
            if let Some(content) = datagram(&self.frame, port) {
                let time = u64::from(seconds) * 1_000_000_000 + u64::from(fraction) * self.fraction;
                return Ok(self.frame.get(content).map(|content| (time, content)));
            }
        }
    }

    /// Takes bytes; `None` if there are not as many.
    fn take<const N: usize>(&mut self) -> Result<Option<[u8; N]>, ReadError> {
        let mut bytes = [0; N];
        match self.file.read_exact(&mut bytes) {
            Ok(()) => {
                self.at += N as u64;
                Ok(Some(bytes))
            }
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(None),
            Err(error) => Err(self.error(&error.to_string())),
        }
    }

    /// Takes a frame; `false` if it is cut off.
    fn take_frame(&mut self, length: usize) -> Result<bool, ReadError> {
        self.frame.resize(length, 0);
        match self.file.read_exact(&mut self.frame) {
            Ok(()) => {
                self.at += length as u64;
                Ok(true)
            }
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
            Err(error) => Err(self.error(&error.to_string())),
        }
    }

    fn number(&self, bytes: &[u8], at: usize) -> u32 {
        let bytes = bytes.get(at..).and_then(<[u8]>::first_chunk).copied().unwrap_or_default();
        if self.is_big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }

    pub fn error(&self, message: &str) -> ReadError {
        ReadError::open(&self.path, message)
    }
}

/// Order of the bytes of a capture, and nanoseconds in the fraction of its times.
fn kind(head: &[u8; 24]) -> Result<(bool, u64), &'static str> {
    match head {
        [0xd4, 0xc3, 0xb2, 0xa1, ..] => Ok((false, 1000)),
        [0xa1, 0xb2, 0xc3, 0xd4, ..] => Ok((true, 1000)),
        [0x4d, 0x3c, 0xb2, 0xa1, ..] => Ok((false, 1)),
        [0xa1, 0xb2, 0x3c, 0x4d, ..] => Ok((true, 1)),
        [0x0a, 0x0d, 0x0d, 0x0a, ..] => {
            Err("it is a capture in the newer format pcapng: `editcap -F pcap old.pcapng new.pcap` converts it")
        }
        [0x1f, 0x8b, ..] => Err("it is compressed: `gunzip` unpacks it"),
        _ => Err("it is not a capture: it begins otherwise than a pcap file"),
    }
}

/// Place of the content of a UDP datagram to a port in an Ethernet frame. `None` for other frames, and for parts of
/// datagrams.
fn datagram(frame: &[u8], port: u16) -> Option<Range<usize>> {
    let mut rest = frame.get(12..)?;
    while TAGGED.iter().any(|tag| rest.starts_with(tag)) {
        rest = rest.get(4..)?;
    }
    let packet = rest.strip_prefix(&IPV4)?;
    let [version, _, high, low, _, _, fragment, offset, _, protocol, ..] = packet else { return None };
    let head = usize::from(version & 0xf) * 4;
    let total = usize::from(u16::from_be_bytes([*high, *low]));
    let is_part = fragment & 0x3f != 0 || *offset != 0;
    if version >> 4 != 4 || head < 20 || *protocol != UDP || is_part || total < head + 8 {
        return None;
    }
    let udp = packet.get(head..)?;
    let [_, _, to_high, to_low, high, low, _, _, content @ ..] = udp else { return None };
    let length = usize::from(u16::from_be_bytes([*high, *low])).checked_sub(8)?;
    let is_wanted = u16::from_be_bytes([*to_high, *to_low]) == port && length <= content.len();
    let start = frame.len() - content.len();
    is_wanted.then_some(start..start + length)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::fs;

    /// Ethernet frame with a UDP datagram to a port, followed by what fills it up.
    pub fn frame(port: u16, content: &[u8]) -> Vec<u8> {
        let mut frame = vec![0xff; 12];
        frame.extend(IPV4);
        let length = content.len() as u16;
        frame.extend([0x45, 0]);
        frame.extend((length + 28).to_be_bytes());
        frame.extend([0, 1, 0x40, 0, 64, UDP, 0, 0, 192, 168, 1, 201, 255, 255, 255, 255]);
        frame.extend(port.to_be_bytes());
        frame.extend(port.to_be_bytes());
        frame.extend((length + 8).to_be_bytes());
        frame.extend([0, 0]);
        frame.extend(content);
        frame.extend([0; 4]);
        frame
    }

    /// Capture of frames with their seconds and fractions.
    pub fn capture(is_big_endian: bool, magic: u32, link: u32, frames: &[(u32, u32, Vec<u8>)]) -> Vec<u8> {
        let number = |n: u32| if is_big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let mut bytes: Vec<u8> = [magic, 0x0004_0002, 0, 0, 65_535, link].into_iter().flat_map(number).collect();
        for (seconds, fraction, frame) in frames {
            let length = frame.len() as u32;
            bytes.extend([*seconds, *fraction, length, length].into_iter().flat_map(number));
            bytes.extend(frame);
        }
        bytes
    }

    /// Usual number at the beginning, and the one of times in ns.
    pub const MICROS: u32 = 0xa1b2_c3d4;
    const NANOS: u32 = 0xa1b2_3c4d;

    pub fn file(name: &str, content: &[u8]) -> PathBuf {
        let path = std::env::temp_dir().join(format!("apex-pcap-{}-{name}", std::process::id()));
        fs::write(&path, content).expect("a temporary file");
        path
    }

    fn all(name: &str, content: &[u8]) -> Result<Vec<(u64, Vec<u8>)>, ReadError> {
        let mut capture = Capture::open(&file(name, content))?;
        let mut found = vec![];
        while let Some((time, content)) = capture.next(2368)? {
            found.push((time, content.to_vec()));
        }
        Ok(found)
    }

    #[test]
    fn datagrams_are_read_in_all_orders_of_bytes() {
        let mut tagged = frame(2368, b"tagged");
        tagged.splice(12..12, [0x81, 0x00, 0, 5]);
        let mut part = frame(2368, b"part");
        part[20] = 0x20;
        let mut tcp = frame(2368, b"tcp");
        tcp[23] = 6;
        let mut six = frame(2368, b"six");
        six[12..14].copy_from_slice(&[0x86, 0xdd]);
        let mut long = frame(2368, b"long");
        long[39] = 200;
        let frames = [
            (7, 5, frame(2368, b"first")),
            (7, 6, frame(8308, b"position")),
            (7, 7, vec![1, 2, 3]),
            (7, 8, part),
            (7, 9, tcp),
            (7, 10, six),
            (7, 11, long),
            (8, 12, tagged),
        ];
        for (is_big_endian, magic, unit) in
            [(false, MICROS, 1000), (true, MICROS, 1000), (false, NANOS, 1), (true, NANOS, 1)]
        {
            let found = all("orders.pcap", &capture(is_big_endian, magic, 1, &frames)).expect("a capture");
            let expected =
                [(7_000_000_000 + 5 * unit, b"first".to_vec()), (8_000_000_000 + 12 * unit, b"tagged".to_vec())];
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn other_files_are_refused() {
        let message = |content: &[u8]| all("other.pcap", content).expect_err("not a capture").message;
        let whole = capture(false, MICROS, 1, &[]);
        assert_eq!(message(&whole[..23]), "it is not a capture: a pcap file has a head of 24 bytes");
        assert_eq!(message(&[7; 30]), "it is not a capture: it begins otherwise than a pcap file");
        assert!(message(&capture(false, 0x0a0d_0d0a, 1, &[])).contains("pcapng: `editcap -F pcap"));
        assert!(message(&capture(false, MICROS, 113, &[])).starts_with("its link layer has the number 113, and not 1"));
        assert!(
            all("flags.pcap", &capture(false, MICROS, 0x2400_0000 | 1, &[])).is_err_and(|e| e.message.contains("link"))
        );
        let mut damaged = capture(false, MICROS, 1, &[(0, 0, frame(2368, b"x"))]);
        damaged[24 + 11] = 0x7f;
        assert!(
            message(&damaged).starts_with("it is damaged: the frame at byte 24 has 2130706"),
            "{}",
            message(&damaged)
        );
        assert!(Capture::open(Path::new("/nowhere/at/all.pcap")).is_err());
    }

    #[test]
    fn a_capture_that_is_cut_off_ends_there() {
        let frames = [(7, 5, frame(2368, b"first")), (8, 5, frame(2368, b"second"))];
        let whole = capture(false, MICROS, 1, &frames);
        for length in 24..whole.len() {
            let found = all("cut.pcap", &whole[..length]).expect("a capture");
            assert_eq!(found.len(), usize::from(length >= 24 + 16 + frames[0].2.len()), "{length}");
        }
    }
}
