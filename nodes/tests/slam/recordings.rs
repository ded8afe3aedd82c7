//! Recordings of robots in buildings, and the accuracy of a mapper on them.

use apex_nodes::{
    scan::{Point2, Pose2},
    slam::{Mapper, Pose, Settings, heading, pose},
};
use flate2::read::MultiGzDecoder;
use std::{
    collections::BTreeMap,
    fs::File,
    io::Read,
    path::Path,
    time::{Duration, Instant},
};

/// Recording of a robot.
pub struct Recording {
    /// Odometry and the points of each scan, in the frame of the robot.
    pub scans: Vec<(Pose, Vec<Point2>)>,
    /// Reference poses of some of the scans, by their number.
    pub reference: BTreeMap<usize, Pose>,
}

/// The Intel Research Lab with wheel odometry. The reference has about every fourth of the later scans.
pub fn intel(folder: &Path) -> Recording {
    let mut at = Pose::identity();
    let mut scans = Vec::new();
    for line in text(&folder.join("intel_raw_odo_scans.csv.gz")).lines() {
        let row = numbers(line, ',');
        let step = 1_f64.to_radians();
        scans.push((at, points(&row[4..], -90.0 * step, step, 30.0)));
        at *= pose(row[1], row[2], row[3]);
    }
    let reference = text(&folder.join("intel_raw_gt.csv"));
    let rows = reference.lines().skip(1).map(|line| numbers(line, ','));
    Recording { scans, reference: rows.map(|row| (row[0] as usize, pose(row[2], row[3], row[4]))).collect() }
}

/// Building 079 in Freiburg. Its odometry was computed from scan to scan and is accurate; `noise` makes it worse: 1 is
/// a standard deviation of 10 % of the distance and of 0.02 rad per step, and a drift to the left of 1 % of the
/// distance.
pub fn fr079(folder: &Path, noise: f64) -> Recording {
    let (mut scans, mut reference) = (Vec::new(), BTreeMap::new());
    let mut steps = BTreeMap::new();
    let text = text(&folder.join("fr079.log.gz"));
    for line in text.lines() {
        let row = numbers(line, ' ');
        match line.split(' ').next() {
            Some("VERTEX2") => {
                reference.insert(row[1] as usize, pose(row[2], row[3], row[4]));
            }
            Some("ROBOTLASER1") => scans.push((Pose::identity(), points(&row[9..], row[2], row[4], 49.0))),
            Some("EDGE2") if row[2] == row[1] + 1.0 => {
                steps.insert(row[2] as usize, (row[3], row[4], row[5]));
            }
            _ => {}
        }
    }
    let (mut at, mut random) = (Pose::identity(), Random(1));
    for (scan, (x, y, theta)) in steps {
        let way = x.hypot(y);
        let (along, turn) = (random.normal() * 0.1 * way, random.normal() * 0.02 + 0.01 * way);
        at *= pose(x + noise * along, y + noise * 0.01 * way, theta + noise * turn);
        scans[scan].0 = at;
    }
    Recording { scans, reference }
}

/// Plays a recording. Returns the final estimates of the poses of all scans, and the longest computing time of a scan.
pub fn play(recording: &Recording, settings: Settings) -> (Mapper, Vec<Pose>, Duration) {
    let mut mapper = Mapper::new(settings);
    let (mut seen, mut slowest) = (Vec::new(), Duration::ZERO);
    for (odometry, points) in &recording.scans {
        let start = Instant::now();
        if mapper.is_due(odometry) {
            assert_eq!(mapper.add(odometry, points.clone()), None, "scan {} of a drive", seen.len());
        }
        slowest = slowest.max(start.elapsed());
        let last = mapper.graph().poses().len() - 1;
        seen.push((last, mapper.graph().poses()[last].inv_mul(&mapper.locate(odometry))));
    }
    let estimate = seen.iter().map(|(kept, since)| mapper.graph().poses()[*kept] * since).collect();
    (mapper, estimate, slowest)
}

/// Distances of the estimated poses from the reference after the best rigid alignment (Umeyama 1991), in m, ascending.
pub fn errors(estimate: &[Pose], reference: &BTreeMap<usize, Pose>) -> Vec<f64> {
    let place = |p: &Pose| Pose2::new(p.translation.x as f32, p.translation.y as f32, heading(p) as f32).position();
    let pairs: Vec<(Point2, Point2)> = reference.iter().map(|(&i, r)| (place(&estimate[i]), place(r))).collect();
    let share = 1.0 / pairs.len() as f32;
    let add = |(a, b): (Point2, Point2), (c, d): &(Point2, Point2)| (a + c.scaled(share), b + d.scaled(share));
    let mean = pairs.iter().fold(Default::default(), add);
    let dot =
        |(a, b): &(Point2, Point2)| ((*a - mean.0).dot(*b - mean.1), (*a - mean.0).perpendicular().dot(*b - mean.1));
    let (cos, sin) = pairs.iter().map(dot).fold((0.0, 0.0), |(c, s), (x, y)| (c + x, s + y));
    let turn = Pose2::new(mean.1.x, mean.1.y, f32::atan2(sin, cos));
    let mut errors: Vec<f64> = pairs.iter().map(|(a, b)| f64::from((turn.to_outer(*a - mean.0) - *b).norm())).collect();
    errors.sort_by(f64::total_cmp);
    errors
}

/// Text of a file, decompressed if necessary.
fn text(path: &Path) -> String {
    let mut text = String::new();
    let read = File::open(path).and_then(|mut file| {
        if path.extension().is_some_and(|e| e == "gz") {
            MultiGzDecoder::new(file).read_to_string(&mut text)
        } else {
            file.read_to_string(&mut text)
        }
    });
    read.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    text
}

/// Words of a line as numbers. Other words become 0.
fn numbers(line: &str, separator: char) -> Vec<f64> {
    line.split(separator).map(|word| word.trim().parse().unwrap_or(0.0)).collect()
}

/// Points of the ranges below `longest` m.
fn points(ranges: &[f64], first: f64, step: f64, longest: f64) -> Vec<Point2> {
    let point = |(beam, range): (usize, &f64)| {
        let measured = *range > 0.05 && *range < longest;
        measured.then(|| Point2::polar(*range as f32, (first + beam as f64 * step) as f32))
    };
    ranges.iter().enumerate().filter_map(point).collect()
}

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    /// Random number, uniform in (0, 1].
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// Random number, normally distributed with mean 0 and standard deviation 1 (Box and Muller 1958).
    fn normal(&mut self) -> f64 {
        (-2.0 * self.unit().ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }
}
