//! Recordings with reference poses.

use apex_messages::{Message, cdr::Reader, nav_msgs::Odometry};
use apex_nodes::{
    io::CsvReader,
    scan::{Pose2, Scan},
};
use apex_sim::Random;
use flate2::read::MultiGzDecoder;
use std::{
    collections::BTreeMap,
    fs::File,
    io::{BufRead, BufReader, Read},
    path::Path,
};

/// Scan of a recording.
pub struct Record {
    pub odometry: Pose2,
    pub scan: Scan,
    /// Reference pose of the robot.
    pub truth: Pose2,
    /// `true` if the scan is not one of those that the map was made from.
    pub is_scored: bool,
}

/// Pose of the scanner of the robot in tables and bags.
const MOUNT: Pose2 = Pose2::new(0.135, 0.0, 0.0);

pub struct Recording {
    pub records: Vec<Record>,
    /// Pose of the scanner in the frame of the robot.
    pub mount: Pose2,
}

/// Reads a recording: a table of scans with poses (`.csv`), a graph of poses with scans (`.log`), or a bag.
pub fn read(path: &Path) -> Result<Recording, String> {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    let recording = match name.strip_suffix(".gz").unwrap_or(name).rsplit_once('.').map(|(_, ending)| ending) {
        Some("csv") => table(path),
        Some("log") => graph(path),
        Some("bag") => bag(path),
        _ => Err("a recording ends in .csv, .log or .bag".to_owned()),
    }
    .map_err(|e| format!("{}: {e}", path.display()))?;
    if recording.records.is_empty() {
        return Err(format!("{}: no scan with a reference pose", path.display()));
    }
    Ok(recording)
}

/// Rows of number, time, odometry, reference pose, angle of the first beam, angle between beams, ranges. The map of
/// these recordings was made from every fifth scan.
fn table(path: &Path) -> Result<Recording, String> {
    let mut reader = CsvReader::open(path, false).map_err(|e| e.message)?;
    let (mut row, mut records) = (Vec::new(), Vec::new());
    while reader.read(&mut row).map_err(|e| e.message)? {
        if row.len() < 11 {
            return Err(format!("row {}: {} numbers", records.len() + 1, row.len()));
        }
        let pose = |i: usize| Pose2::new(row[i] as f32, row[i + 1] as f32, row[i + 2] as f32);
        let mut scan = Scan {
            angle_min: row[8] as f32,
            angle_increment: row[9] as f32,
            range_min: 0.05,
            range_max: 30.0,
            ..Scan::default()
        };
        let ranges = row[10..].iter().map(|range| *range as f32);
        scan.ranges.try_extend(ranges).map_err(|e| format!("row {}: {e}", records.len() + 1))?;
        records.push(Record { odometry: pose(2), scan, truth: pose(5), is_scored: !(row[0] as u64).is_multiple_of(5) });
    }
    Ok(Recording { records, mount: MOUNT })
}

/// `VERTEX2` with the scan that follows it, and the steps between them (`EDGE2`) as odometry, with errors: a standard
/// deviation of 5 % of the distance and of 0.02 rad, and a drift to the left. The maps were made from the even ones.
fn graph(path: &Path) -> Result<Recording, String> {
    let file = File::open(path).map_err(|e| e.to_string())?;
    let packed = path.extension().is_some_and(|e| e == "gz");
    let reader: Box<dyn Read> = if packed { Box::new(MultiGzDecoder::new(file)) } else { Box::new(file) };
    let (mut vertices, mut steps) = (Vec::new(), BTreeMap::new());
    let mut at = Pose2::default();
    for line in BufReader::new(reader).lines() {
        let line = line.map_err(|e| e.to_string())?;
        let row: Vec<f32> = line.split_whitespace().map(|word| word.parse().unwrap_or(0.0)).collect();
        match line.split_whitespace().next() {
            Some("VERTEX2") if row.len() >= 5 => at = Pose2::new(row[2], row[3], row[4]),
            Some("ROBOTLASER1") if row.len() >= 9 => {
                let (angle_min, angle_increment) = (row[2], row[4]);
                let mut scan = Scan { angle_min, angle_increment, range_min: 0.05, range_max: 40.0, ..Scan::default() };
                let ranges = row[9..].iter().copied().take(row[8] as usize);
                scan.ranges.try_extend(ranges).map_err(|e| format!("scan {}: {e}", vertices.len() + 1))?;
                vertices.push((at, scan));
            }
            Some("EDGE2") if row.len() >= 6 && row[2] == row[1] + 1.0 => {
                steps.entry(row[2] as usize).or_insert(Pose2::new(row[3], row[4], row[5]));
            }
            _ => {}
        }
    }
    let (mut odometry, mut random) = (Pose2::default(), Random::new(1));
    let records = vertices.into_iter().enumerate().map(|(i, (truth, scan))| {
        if let Some(step) = steps.get(&i) {
            let way = step.position().norm();
            let error = Pose2::new(random.normal(0.05 * way), 0.01 * way, random.normal(0.02) + 0.01 * way);
            odometry = odometry.compose(&step.compose(&error));
        }
        Record { odometry, scan, truth, is_scored: i % 2 == 1 }
    });
    Ok(Recording { records: records.collect(), mount: Pose2::default() })
}

/// Bag of the simulator Stage: `/odom`, `/base_scan` and `/base_pose_ground_truth`, by the same stamps. A beam without
/// an echo has the maximum range.
fn bag(path: &Path) -> Result<Recording, String> {
    let at = |error: std::io::Error| format!("{}: {error}", path.display());
    let mut bag = apex_bag::Ros1::open(path).map_err(at)?;
    let (mut scans, mut odometry, mut truth) = (vec![], BTreeMap::new(), BTreeMap::new());
    while let Some(message) = bag.next_message().map_err(at)? {
        let mut reader = Reader::ros1(&message.data);
        let poses = match &*bag.channels[&message.channel].topic {
            "/base_scan" => {
                scans.push(Scan::read(&mut reader)?);
                continue;
            }
            "/odom" => &mut odometry,
            "/base_pose_ground_truth" => &mut truth,
            _ => continue,
        };
        let Odometry { header, pose, .. } = Odometry::read(&mut reader)?;
        poses.insert(header.stamp.as_nanos(), Pose2::from(&pose.pose));
    }
    if let Some(cut) = bag.cut {
        return Err(format!("{}: {cut}", path.display()));
    }
    let record = |scan: Scan| {
        let (odometry, truth) = (*odometry.get(&scan.stamp.as_nanos())?, *truth.get(&scan.stamp.as_nanos())?);
        let scan = Scan { range_max: scan.range_max - 0.01, ..scan };
        Some(Record { odometry, scan, truth, is_scored: true })
    };
    Ok(Recording { records: scans.into_iter().filter_map(record).collect(), mount: MOUNT })
}
