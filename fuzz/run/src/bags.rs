//! Recordings of other programs: bags of ROS 1, and MCAP files of ROS 2.

use crate::{
    readers::{file, reader},
    worker::Target,
};
use apex_bag::{Contents, Recording, message};
use apex_messages::{Message as _, cdr};
use apex_nodes::scan::Scan;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::{fs, io::Write as _};

/// The target with recordings of other programs.
pub fn bags() -> Box<dyn Target> {
    let mut recordings = vec![ros1()];
    recordings.extend([mcap("", plain), mcap("lz4", lz4), mcap("zstd", zstd)]);
    reader(recordings, &[], |input| {
        let file = file("bag", input);
        if let Ok(mut bag) = Recording::open(&file) {
            while let Ok(Some(found)) = bag.next_message() {
                let bytes = message(&found.data).unwrap_or_default();
                let _ = Scan::read(&mut cdr::Reader::ros1(&bytes));
                let _ = Scan::from_bytes(&bytes);
            }
        }
        let _ = Contents::read(&file);
        let _ = fs::remove_file(file);
    })
}

/// Bytes after their number.
fn sized(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_le_bytes(), bytes].concat()
}

/// A bag of ROS 1 with a scan.
fn ros1() -> Vec<u8> {
    let record = |fields: &[&[u8]], data: &[u8]| {
        let header: Vec<u8> = fields.iter().flat_map(|field| sized(field)).collect();
        [sized(&header), sized(data)].concat()
    };
    let connection = record(&[b"op=\x07", b"conn=\0\0\0\0", b"topic=/scan"], &sized(b"type=sensor_msgs/LaserScan"));
    let scan = [&[0; 12][..], &sized(b"laser"), &[0; 28], &2_u32.to_le_bytes(), &[0; 12]].concat();
    let message = record(&[b"op=\x02", b"conn=\0\0\0\0", b"time=\x01\0\0\0\0\0\0\0"], &scan);
    let chunk = record(&[b"op=\x05", b"compression=none", b"size=\x9e\0\0\0"], &[connection, message].concat());
    [b"#ROSBAG V2.0\n", &record(&[b"op=\x03", b"index_pos=\0\0\0\0\0\0\0\0"], b"  ")[..], &chunk].concat()
}

/// An MCAP file with three scans in a chunk, which is packed in the format `name`.
fn mcap(name: &str, pack: fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let record = |kind: u8, body: &[u8]| [&[kind][..], &(body.len() as u64).to_le_bytes(), body].concat();
    let text = |text: &str| sized(text.as_bytes());
    let id = 1_u16.to_le_bytes();
    let schema = [&id[..], &text(Scan::NAME), &text("ros2msg"), &text(Scan::DEFINITION)].concat();
    let channel = [&id[..], &id, &text("/scan"), &text("cdr"), &[0; 4]].concat();
    let scan = Scan { ranges: [1.0, 2.0, f32::NAN].into_iter().collect(), ..Scan::default() }.to_bytes();
    let message = |second: u64| {
        let time = (second * 1_000_000_000).to_le_bytes();
        record(5, &[&id[..], &[0; 4], &time, &time, &scan].concat())
    };
    let records = [record(3, &schema), record(4, &channel), message(1), message(2), message(3)].concat();
    let packed = pack(&records);
    let sizes = [[0; 8], [0; 8], (records.len() as u64).to_le_bytes()].concat();
    let chunk = [&sizes[..], &[0; 4], &text(name), &(packed.len() as u64).to_le_bytes(), &packed].concat();
    let header = [text("ros2"), text("a test")].concat();
    [b"\x89MCAP0\r\n", &record(1, &header)[..], &record(6, &chunk)].concat()
}

fn plain(bytes: &[u8]) -> Vec<u8> {
    bytes.to_vec()
}

fn lz4(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = lz4_flex::frame::FrameEncoder::new(vec![]);
    encoder.write_all(bytes).expect("room");
    encoder.finish().expect("room")
}

fn zstd(bytes: &[u8]) -> Vec<u8> {
    compress_to_vec(bytes, CompressionLevel::Fastest)
}
