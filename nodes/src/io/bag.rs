use super::ReadError;
use crate::scan::{Pose2, Scan};
use apex_rt::Time;
use std::{collections::HashMap, fs, path::Path};

/// First line of a bag.
const MAGIC: &[u8] = b"#ROSBAG V2.0\n";
/// Codes of records.
const MESSAGE: u8 = 2;
const CHUNK: u8 = 5;
const CONNECTION: u8 = 7;

/// Recording of ROS 1 (`.bag`, version 2.0, not compressed), read completely.
#[derive(Debug, Clone, Default)]
pub struct Bag {
    /// Topic and type of each connection.
    connections: HashMap<u32, (String, String)>,
    messages: Vec<BagMessage>,
}

/// Message of a [`Bag`].
#[derive(Debug, Clone, PartialEq)]
pub struct BagMessage {
    /// Number of the connection.
    connection: u32,
    /// Time of the recording.
    pub time: Time,
    data: Vec<u8>,
}

impl Bag {
    /// Reads a bag.
    ///
    /// # Errors
    /// If the file cannot be read, or is not a bag, compressed, or cut off.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let bytes = fs::read(path).map_err(|e| ReadError::open(path, e))?;
        let records =
            bytes.strip_prefix(MAGIC).ok_or_else(|| ReadError::open(path, "the file is not a bag of version 2.0"))?;
        let mut bag = Self::default();
        bag.add(records, false).map_err(|message| ReadError::open(path, message))?;
        Ok(bag)
    }

    /// Adds the records of a file or of a chunk.
    fn add(&mut self, mut records: &[u8], is_chunk: bool) -> Result<(), &'static str> {
        const CUT: &str = "the bag is cut off or damaged: repair it with `rosbag reindex`";
        while !records.is_empty() {
            let header = block(&mut records).ok_or(CUT)?;
            let data = block(&mut records).ok_or(CUT)?;
            let number = || Some(u32::from_le_bytes(*field(header, b"conn")?.first_chunk()?));
            match field(header, b"op").and_then(<[u8]>::first) {
                // Chunks of chunks without end would overflow the stack.
                Some(&CHUNK) if is_chunk => return Err("the bag is damaged: a chunk contains another one"),
                Some(&CHUNK) if field(header, b"compression") == Some(b"none") => self.add(data, true)?,
                Some(&CHUNK) => return Err("the bag is compressed: unpack it with `rosbag decompress`"),
                Some(&CONNECTION) => {
                    let text = |name: &[u8], of| Some(String::from_utf8_lossy(field(of, name)?).into_owned());
                    let names = text(b"topic", header).zip(text(b"type", data)).ok_or(CUT)?;
                    self.connections.insert(number().ok_or(CUT)?, names);
                }
                Some(&MESSAGE) => {
                    let time = field(header, b"time").and_then(|mut bytes| time(&mut bytes)).ok_or(CUT)?;
                    self.messages.push(BagMessage { connection: number().ok_or(CUT)?, time, data: data.to_vec() });
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Messages of a topic in the order of the file.
    pub fn messages<'a>(&'a self, topic: &'a str) -> impl Iterator<Item = &'a BagMessage> + 'a {
        let is_wanted = move |message: &&BagMessage| {
            self.connections.get(&message.connection).is_some_and(|(name, _)| name == topic)
        };
        self.messages.iter().filter(is_wanted)
    }

    /// Topics with the types of their messages, sorted.
    pub fn topics(&self) -> Vec<(&str, &str)> {
        let mut topics: Vec<_> =
            self.connections.values().map(|(topic, kind)| (topic.as_str(), kind.as_str())).collect();
        topics.sort_unstable();
        topics.dedup();
        topics
    }
}

impl BagMessage {
    /// Content of a `sensor_msgs/LaserScan`, or `None` if the message is another one, or has too many beams.
    pub fn scan(&self) -> Option<Scan> {
        let mut bytes = &self.data[..];
        let stamp = header(&mut bytes)?;
        let mut numbers = [0.0; 7];
        for number in &mut numbers {
            *number = f32::from_le_bytes(*take(&mut bytes)?);
        }
        let [angle_min, _, angle_increment, _, _, range_min, range_max] = numbers;
        let mut scan = Scan { angle_min, angle_increment, range_min, range_max, stamp, ..Scan::default() };
        for _ in 0..u32::from_le_bytes(*take(&mut bytes)?) {
            scan.ranges.push(f32::from_le_bytes(*take(&mut bytes)?)).ok()?;
        }
        let intensities = u32::from_le_bytes(*take(&mut bytes)?) as usize;
        (bytes.len() == 4 * intensities).then_some(scan)
    }

    /// Time and pose in the plane of a `nav_msgs/Odometry`, or `None` if the message is another one.
    pub fn odometry(&self) -> Option<(Time, Pose2)> {
        let mut bytes = &self.data[..];
        let stamp = header(&mut bytes)?;
        block(&mut bytes)?;
        let mut numbers = [0.0; 7];
        for number in &mut numbers {
            *number = f64::from_le_bytes(*take(&mut bytes)?);
        }
        let [x, y, _, qx, qy, qz, qw] = numbers;
        let theta = (2.0 * (qw * qz + qx * qy)).atan2(1.0 - 2.0 * (qy * qy + qz * qz));
        Some((stamp, Pose2::new(x as f32, y as f32, theta as f32)))
    }
}

/// Takes bytes of a fixed number.
fn take<'a, const N: usize>(bytes: &mut &'a [u8]) -> Option<&'a [u8; N]> {
    let (taken, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(taken)
}

/// Takes bytes whose number precedes them.
fn block<'a>(bytes: &mut &'a [u8]) -> Option<&'a [u8]> {
    let length = u32::from_le_bytes(*take(bytes)?) as usize;
    let (taken, rest) = bytes.split_at_checked(length)?;
    *bytes = rest;
    Some(taken)
}

fn time(bytes: &mut &[u8]) -> Option<Time> {
    let (seconds, nanos) = (u32::from_le_bytes(*take(bytes)?), u32::from_le_bytes(*take(bytes)?));
    Some(Time::from_nanos(i64::from(seconds) * 1_000_000_000 + i64::from(nanos)))
}

/// Takes a `std_msgs/Header` and returns its stamp.
fn header(bytes: &mut &[u8]) -> Option<Time> {
    take::<4>(bytes)?;
    let stamp = time(bytes)?;
    block(bytes)?;
    Some(stamp)
}

/// Value of a field of a record header.
fn field<'a>(mut header: &'a [u8], name: &[u8]) -> Option<&'a [u8]> {
    while !header.is_empty() {
        let field = block(&mut header)?;
        if let Some(value) = field.strip_prefix(name).and_then(|rest| rest.strip_prefix(b"=")) {
            return Some(value);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sized(bytes: &[u8]) -> Vec<u8> {
        [&(bytes.len() as u32).to_le_bytes(), bytes].concat()
    }

    fn record(fields: &[&[u8]], data: &[u8]) -> Vec<u8> {
        let header: Vec<u8> = fields.iter().flat_map(|field| sized(field)).collect();
        [sized(&header), sized(data)].concat()
    }

    fn ros_header() -> Vec<u8> {
        [&[0; 4][..], &5_u32.to_le_bytes(), &500_u32.to_le_bytes(), &sized(b"laser")].concat()
    }

    fn bag(compression: &[u8]) -> Vec<u8> {
        let numbers = [-1.0, 1.0, 0.5, 0.0, 0.0, 0.1, 9.0_f32];
        let ranges = [2_u32.to_le_bytes(), 1.5_f32.to_le_bytes(), 2.5_f32.to_le_bytes(), [0; 4]].concat();
        let scan = [ros_header(), numbers.iter().flat_map(|n| n.to_le_bytes()).collect(), ranges].concat();
        let pose = [1.0, 2.0, 0.0, 0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt()];
        let odometry = [ros_header(), sized(b"base"), pose.iter().flat_map(|n| n.to_le_bytes()).collect()].concat();
        let message = |conn: u8, data: &[u8]| {
            record(&[b"op=\x02", &[b"conn=", &[conn, 0, 0, 0][..]].concat(), b"time=\x01\0\0\0\0\0\0\0"], data)
        };
        let connection = |conn: u8, topic: &str, kind: &str| {
            let topic = format!("topic={topic}");
            let fields: [&[u8]; 3] = [b"op=\x07", &[b"conn=", &[conn, 0, 0, 0][..]].concat(), topic.as_bytes()];
            record(&fields, &sized(format!("type={kind}").as_bytes()))
        };
        let chunk = [
            connection(0, "/scan", "sensor_msgs/LaserScan"),
            connection(1, "/odom", "nav_msgs/Odometry"),
            message(0, &scan),
            message(1, &odometry),
        ]
        .concat();
        let chunk = record(&[b"op=\x05", &[b"compression=", compression].concat()], &chunk);
        [MAGIC, &record(&[b"op=\x03"], b"  "), &chunk].concat()
    }

    fn read(name: &str, bytes: &[u8]) -> Result<Bag, String> {
        let path = std::env::temp_dir().join(format!("apex-bag-{}-{name}", std::process::id()));
        fs::write(&path, bytes).expect("a temporary file");
        Bag::read(path).map_err(|e| e.message)
    }

    #[test]
    fn scans_and_poses_are_read() {
        let bag = read("whole.bag", &bag(b"none")).expect("a bag");
        assert_eq!(bag.topics(), [("/odom", "nav_msgs/Odometry"), ("/scan", "sensor_msgs/LaserScan")]);
        let message = bag.messages("/scan").next().expect("a message");
        let scan = message.scan().expect("a scan");
        assert_eq!((scan.angle_min, scan.range_max, &scan.ranges[..]), (-1.0, 9.0, &[1.5, 2.5][..]));
        assert_eq!((message.time, scan.stamp), (Time::from_secs(1), Time::from_nanos(5_000_000_500)));
        let (_, pose) = bag.messages("/odom").next().and_then(BagMessage::odometry).expect("a pose");
        assert!((pose.theta - core::f32::consts::FRAC_PI_2).abs() < 1e-6 && pose.x == 1.0 && pose.y == 2.0);
        assert!(bag.messages("/odom").next().and_then(BagMessage::scan).is_none(), "it is no scan");
    }

    #[test]
    fn chunks_of_chunks_are_refused() {
        let (head, levels) = (sized(&[sized(b"op=\x05"), sized(b"compression=none")].concat()), 100_000);
        let mut bytes = MAGIC.to_vec();
        for level in (0..levels).rev() {
            bytes.extend_from_slice(&head);
            bytes.extend_from_slice(&((level * (head.len() + 4)) as u32).to_le_bytes());
        }
        assert!(read("nested.bag", &bytes).expect_err("nested").contains("a chunk contains another one"));
    }

    #[test]
    fn what_is_no_bag_is_refused() {
        assert!(read("other.bag", b"#ROSBAG V1.2\n").expect_err("old").contains("not a bag"));
        assert!(read("packed.bag", &bag(b"bz2")).expect_err("packed").contains("compressed"));
        let whole = bag(b"none");
        let first = MAGIC.len() + record(&[b"op=\x03"], b"  ").len();
        for length in (MAGIC.len() + 1..whole.len()).filter(|length| *length != first) {
            assert!(read("cut.bag", &whole[..length]).is_err_and(|m| m.contains("cut off")), "{length}");
        }
    }
}
