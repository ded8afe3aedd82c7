//! Packets of a real VLP-16 against the cloud that another program made of them, and a cloud of KITTI.
//!
//! The files are those of `../shared/data/lidar3d`. Without them, the tests are skipped; with `CI=true` they fail.

use apex_macros::graph;
use apex_messages::sensor_msgs::{PointCloud2, PointField};
use apex_nodes::{
    cloud::{CloudPoint, Label, RingClassifier, RingCloud},
    io::{BagTopic, read_cloud, read_kitti},
    lidar::{Echo, Firing, LASERS, VelodynePackets, VelodyneTurns, elevation},
};
use apex_rt::{Construct, prelude::*};
use std::{
    collections::HashMap,
    f32::consts::PI,
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

graph! {
    use apex_nodes::{cloud::RingCloud, io::{BagTopic, VelodyneCapture}, lidar::{VelodynePackets, VelodyneTurns}};

    /// Turns from a recording, and from a capture of the network with the same packets.
    graph Play {
        out   recorded: RingCloud;
        out   captured: RingCloud;

        node bag      = BagTopic<VelodynePackets>(file = "", topic = "/velodyne_packets") every 1ms;
        node capture  = VelodyneCapture(file = "") every 1ms;
        node of_bag   = VelodyneTurns();
        node of_other = VelodyneTurns();

        bag     -> of_bag -> recorded;
        capture -> of_other -> captured;
    }
}

/// Distance below which the other program drops points, in m, and ends of its turn, in degrees.
const NEAREST: f32 = 0.5;
const ENDS: [f32; 2] = [0.3, 359.0];
/// Unit of distances, in m.
const UNIT: f32 = 0.002;

/// File of the data, or `None` (with a message) if it does not exist.
fn file(name: &str) -> Option<PathBuf> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/lidar3d").join(name);
    if file.is_file() {
        return Some(file);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", file.display());
    eprintln!("skipped: {} is missing", file.display());
    None
}

/// Tokens of the recording.
fn recorded() -> Option<Vec<VelodynePackets>> {
    let recording = file("1673400471837873222_0.db3")?;
    let name = recording.to_string_lossy().into_owned();
    let mut bag = BagTopic::<VelodynePackets>::construct((name, "/velodyne_packets", false, "velodyne"));
    let (mut tokens, mut done) = (vec![], None);
    for now in (0..).map(|second| Ctx::new(Time::from_secs(second))) {
        let token = bag.process(&now, apex_rt::event(&mut done)).expect("a message");
        match (token, done) {
            (Some(token), _) => tokens.push(token),
            (None, Some(())) => break,
            (None, None) => {}
        }
    }
    Some(tokens)
}

/// Turns of packets, cut in a direction.
fn turns(packets: &[VelodynePackets], cut: f32) -> Vec<RingCloud> {
    let mut node = VelodyneTurns::construct((cut, false, NEAREST));
    let one = |packets| {
        let mut out = Out::new();
        node.process(packets, &mut out);
        out.get().cloned()
    };
    packets.iter().map(Some).chain([None, None]).filter_map(one).collect()
}

/// Return in the packets: its direction, those of its block and of the next one, in degrees, and if it is the only one.
#[derive(Clone, Copy)]
struct Return {
    azimuth: f32,
    blocks: [f32; 2],
    is_other: bool,
}

/// Ring from below, distance in units, and reflectivity.
type Key = (usize, u32, u8);

/// Returns of the last whole turn that begins forward.
fn last_turn(packets: &[VelodynePackets]) -> HashMap<Key, Vec<Return>> {
    let mut turns: Vec<Vec<(Firing, [f32; 2])>> = vec![vec![]];
    for packet in packets.iter().flat_map(|packets| &packets.packets) {
        let firings: Vec<Firing> = packet.firings().collect();
        for (i, firing) in firings.iter().enumerate() {
            let block = firings[i / 2 * 2].azimuth.to_degrees();
            let next = firings.get(i / 2 * 2 + 2).map_or(block, |firing| firing.azimuth.to_degrees());
            let last = turns.last().and_then(|turn| turn.last());
            if last.is_some_and(|(last, _)| last.azimuth > firing.azimuth + PI) {
                turns.push(vec![]);
            }
            turns.last_mut().expect("a turn").push((*firing, [block, next]));
        }
    }
    let mut found: HashMap<Key, Vec<Return>> = HashMap::new();
    for (firing, blocks) in &turns[turns.len() - 2] {
        for laser in 0..LASERS {
            let ring = (elevation(laser).to_degrees().round() as i32 + 15) as usize / 2;
            let azimuth = firing.azimuth_of(laser).to_degrees() % 360.0;
            let mut add = |echo: Echo, is_other| {
                let key = (ring, (echo.distance / UNIT).round() as u32, echo.reflectivity);
                found.entry(key).or_default().push(Return { azimuth, blocks: *blocks, is_other });
            };
            let [last, other] = [firing.last[laser], firing.other[laser]];
            let is_near = |echo: Echo| echo.distance < NEAREST;
            if !is_near(last) {
                add(last, false);
            }
            if last != other && !is_near(other) {
                add(other, true);
            }
        }
    }
    found
}

/// Point of the other program.
struct Reference {
    place: [f32; 3],
    key: Key,
    /// Direction, in degrees.
    azimuth: f32,
    /// Sine of the elevation, which the field `elevation` has.
    sine: f32,
}

/// Points of the other program with all of their fields, of 32 bytes each.
fn reference(file: &Path) -> Vec<Reference> {
    let bytes = fs::read(file).expect("the file");
    let head = b"DATA binary\n";
    let start = bytes.windows(head.len()).position(|part| part == head).expect("a header") + head.len();
    let point = |point: &[u8]| {
        let number = |at: usize| f32::from_le_bytes(*point[at..].first_chunk().expect("a number"));
        let distance = (number(24) / UNIT).round() as u32;
        Reference {
            place: [0, 4, 8].map(number),
            key: (usize::from(point[14]), distance, point[12]),
            azimuth: number(16).to_degrees(),
            sine: number(20),
        }
    };
    bytes[start..].chunks_exact(32).map(point).collect()
}

fn apart(a: f32, b: f32) -> f32 {
    ((a - b + 540.0) % 360.0 - 180.0).abs()
}

#[test]
fn returns_are_those_of_another_program() {
    let (Some(packets), Some(file)) = (recorded(), file("1673400472138016708.pcd")) else { return };
    assert_eq!(packets.iter().map(|token| token.packets.len()).collect::<Vec<_>>(), [151, 151, 151, 150]);
    let mut ours = last_turn(&packets);
    let theirs = reference(&file);
    let (mut interpolated, mut of_block, mut of_next, mut worst) = (0, 0, 0, 0.0_f32);
    for point in &theirs {
        let candidates = ours.get_mut(&point.key).expect("a return of this ring, distance and reflectivity");
        let distance = |found: &Return| {
            let Return { azimuth, blocks: [block, next], .. } = found;
            [azimuth, block, next].map(|direction| apart(*direction, point.azimuth)).into_iter().fold(360.0, f32::min)
        };
        let nearest =
            (0..candidates.len()).min_by(|a, b| distance(&candidates[*a]).total_cmp(&distance(&candidates[*b])));
        let found = candidates.swap_remove(nearest.expect("a return that is not taken"));
        let [block, next] = found.blocks.map(|block| apart(block, point.azimuth));
        let error = apart(found.azimuth, point.azimuth);
        let elevation = (2.0 * point.key.0 as f32 - 15.0).to_radians();
        assert!((point.sine - elevation.sin()).abs() < 1e-5, "{}", point.sine);
        // The other program does not interpolate in the last blocks of a packet, and gives to the second one of two
        // returns, which come at the same time, the direction of the next block.
        if error <= 0.01 {
            (interpolated, worst) = (interpolated + 1, worst.max(error));
        } else if block < 0.005 && found.blocks[0] == found.blocks[1] {
            of_block += 1;
        } else {
            assert!(next < 0.005 && found.is_other, "{error}° {next}°");
            of_next += 1;
        }
    }
    let left: Vec<f32> = ours.values().flatten().map(|left| left.azimuth).collect();
    println!(
        "{} points: {interpolated} within {worst:.4}°, {of_block} and {of_next} in the direction of a block; {} more",
        theirs.len(),
        left.len()
    );
    assert_eq!((theirs.len(), interpolated + of_block + of_next), (14_831, 14_831));
    assert!(interpolated > 12_200 && of_next < 200);
    // Its turn begins and ends at another column.
    assert!(left.len() <= 50 && left.iter().all(|azimuth| *azimuth < ENDS[0] || *azimuth > ENDS[1]), "{left:?}");
}

#[test]
fn points_of_a_turn_are_those_of_another_program() {
    let (Some(packets), Some(file)) = (recorded(), file("1673400472138016708.pcd")) else { return };
    let turns = turns(&packets, 0.0);
    assert_eq!(turns.len(), 3, "the first one has not its beginning");
    for turn in &turns {
        assert!(turn.rings() == LASERS && (1805..=1812).contains(&turn.columns()), "{}", turn.columns());
        assert!(turn.times().is_sorted() && (turn.times()[0] + 0.1).abs() < 1e-3, "{}", turn.times()[0]);
    }
    // Of the points of the other program that are interpolated, nearly all are in the turn.
    let turn = &turns[2];
    let mut points: HashMap<(usize, u32), Vec<CloudPoint>> = HashMap::new();
    for (i, point) in turn.points().iter().enumerate().filter(|(_, point)| point.is_measured()) {
        let range = [point.x, point.y, point.z].iter().map(|c| c * c).sum::<f32>().sqrt();
        let ring = LASERS - 1 - i % LASERS;
        points.entry((ring, (range / UNIT).round() as u32)).or_default().push(*point);
    }
    let theirs = reference(&file);
    let near = |point: &Reference| {
        let [x, y, z] = point.place;
        let is_near = |p: &CloudPoint| {
            // 0.01° of the distance, and 2 mm.
            let most = 0.002 + point.key.1 as f32 * UNIT * 0.01_f32.to_radians();
            (p.x - x).abs() < most && (p.y - y).abs() < most && (p.z - z).abs() < 0.002
        };
        points.get(&(point.key.0, point.key.1)).is_some_and(|points| points.iter().any(is_near))
    };
    let found = theirs.iter().filter(|point| near(point)).count();
    let measured = points.values().map(Vec::len).sum::<usize>();
    println!("{found} of {} points are among the {measured} of the turn", theirs.len());
    assert!(found > 12_000);
    // The reader of the project reads the same file.
    let cloud = read_cloud(&file).expect("a cloud").cloud;
    assert!(cloud.points().iter().zip(&theirs).all(|(a, b)| [a.x, a.y, a.z] == b.place));
}

/// Message of points with these fields: names, places in a point and kinds.
fn message(fields: &[(&str, u32, u8)], point_step: u32, data: Vec<u8>) -> PointCloud2 {
    let field = |(name, offset, datatype): &(&str, u32, u8)| PointField {
        name: (*name).to_owned(),
        offset: *offset,
        datatype: *datatype,
        count: 1,
    };
    let (width, row_step) = (data.len() as u32 / point_step, data.len() as u32);
    let fields = fields.iter().map(field).collect();
    PointCloud2 { height: 1, width, fields, point_step, row_step, data, ..PointCloud2::default() }
}

/// The points of the other program as a message.
fn their_message(file: &Path) -> PointCloud2 {
    let bytes = fs::read(file).expect("the file");
    let head = b"DATA binary\n";
    let start = bytes.windows(head.len()).position(|part| part == head).expect("a header") + head.len();
    let fields = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 2), ("channel", 14, 4)];
    message(&fields, 32, bytes[start..].to_vec())
}

/// A turn as drivers send it: what is measured, firing by firing, with rings counted from below.
fn our_message(turn: &RingCloud) -> PointCloud2 {
    let mut data = vec![];
    for (i, point) in turn.points().iter().enumerate().filter(|(_, point)| point.is_measured()) {
        [point.x, point.y, point.z, point.intensity].iter().for_each(|number| data.extend(number.to_le_bytes()));
        data.extend(((LASERS - 1 - i % LASERS) as u16).to_le_bytes());
        data.extend(turn.times()[i / LASERS].to_le_bytes());
    }
    let fields = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4), ("time", 18, 7)];
    message(&fields, 22, data)
}

fn measured(turn: &RingCloud) -> usize {
    turn.points().iter().filter(|point| point.is_measured()).count()
}

/// Number of points that are taken for ground.
fn ground(turn: &RingCloud) -> f32 {
    classify(turn, 0.5).iter().filter(|label| **label == Label::Floor).count() as f32
}

#[test]
fn turns_are_made_of_points_in_any_order() {
    let (Some(packets), Some(file)) = (recorded(), file("1673400472138016708.pcd")) else { return };
    for turn in turns(&packets, PI) {
        let made = RingCloud::try_from(our_message(&turn)).expect("a turn");
        println!("{} of {} points, {} of {} columns", measured(&made), measured(&turn), made.columns(), turn.columns());
        println!("{} points of the ground, {} before", ground(&made), ground(&turn));
        assert!(made.columns().abs_diff(turn.columns()) <= 3 && measured(&made) * 100 > measured(&turn) * 99);
        assert!(made.times().is_sorted() && (made.times()[0] + 0.1).abs() < 1e-3, "{:?}", made.times()[0]);
        assert!((ground(&made) - ground(&turn)).abs() < 0.02 * ground(&turn));
    }
    // The other program does not interpolate all directions, so that some columns have two points of a ring.
    let made = RingCloud::try_from(their_message(&file)).expect("a turn");
    let whole = &turns(&packets, 0.0)[2];
    println!("{} of 14831 points, {} columns", measured(&made), made.columns());
    println!("{} points of the ground, {} in the turn of the packets", ground(&made), ground(whole));
    assert!((1800..=1820).contains(&made.columns()) && measured(&made) > 12_900 && made.times()[7] == 0.0);
    assert!((ground(&made) - ground(whole)).abs() < 0.05 * ground(whole));
}

/// Capture of the network with packets at their times.
fn capture(packets: &[VelodynePackets]) -> Vec<u8> {
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_be_bytes()).collect::<Vec<u8>>();
    let mut bytes = words(&[0xa1b2_3c4d, 0x0002_0004, 0, 0, 65_535, 1]);
    for packet in packets.iter().flat_map(|token| &token.packets) {
        let (time, size) = (packet.stamp.as_nanos() + 1_000_000_000, packet.bytes().len() as u16);
        let frame = u32::from(size) + 42;
        bytes.extend(words(&[(time / 1_000_000_000) as u32, (time % 1_000_000_000) as u32, frame, frame]));
        bytes.extend([[0xff; 12].as_slice(), &[0x08, 0x00, 0x45, 0], &(size + 28).to_be_bytes()].concat());
        bytes.extend([0, 1, 0x40, 0, 64, 17, 0, 0, 192, 168, 1, 201, 255, 255, 255, 255, 9, 64, 9, 64]);
        bytes.extend([&(size + 8).to_be_bytes(), [0, 0].as_slice(), packet.bytes()].concat());
    }
    bytes
}

#[test]
fn a_program_runs_on_a_recording_and_on_a_capture() {
    let (Some(packets), Some(recording)) = (recorded(), file("1673400471837873222_0.db3")) else { return };
    let path = std::env::temp_dir().join(format!("apex-lidar-{}.pcap", std::process::id()));
    fs::write(&path, capture(&packets)).expect("a temporary file");
    let mut program = Play::new();
    for (name, file) in [("bag.file", &recording), ("capture.file", &path)] {
        program.set_param(name, file.to_string_lossy().into_owned()).expect("a parameter");
    }
    let (mut recorded, mut captured) = (vec![], vec![]);
    for millis in 0..600 {
        program.react(Time::from_millis(millis));
        let out = program.outputs();
        recorded.extend(out.recorded.clone());
        captured.extend(out.captured.clone());
    }
    let _ = fs::remove_file(&path);
    assert_eq!((recorded.len(), captured.len()), (3, 3));
    for (a, b) in recorded.iter().zip(&captured) {
        let same = |a: &CloudPoint, b: &CloudPoint| a == b || !a.is_measured() && !b.is_measured();
        assert!(a.points().len() == b.points().len() && a.points().iter().zip(b.points()).all(|(a, b)| same(a, b)));
    }
    // Times of the recording count from its first message, those of the capture from its first packet.
    let apart: Vec<Duration> = recorded.iter().zip(&captured).map(|(a, b)| b.stamp.since(a.stamp)).collect();
    assert!(apart.iter().all(|time| *time == apart[0]), "{apart:?}");
}

/// Labels of the points of a turn, of a scanner at a height above the ground, in m, that stands.
fn classify(turn: &RingCloud, height: f32) -> Vec<Label> {
    let mut columns =
        apex_nodes::cloud::Columns { height: turn.rings(), origin: [0.0, 0.0, height], ..Default::default() };
    for point in turn.points() {
        columns.x.push(point.x);
        columns.y.push(point.y);
        columns.z.push(point.z + height);
        columns.intensity.push(point.intensity);
    }
    let mut out = Out::new();
    RingClassifier::construct((0.13, 0.08, 0.4, 0.9, 1.6, 0.1, 2.5, 0.11)).process(&columns, &mut out);
    out.get().expect("labels").labels.clone()
}

#[test]
fn turns_of_a_scanner_that_stands_look_alike() {
    let Some(packets) = recorded() else { return };
    let shares: Vec<f32> = turns(&packets, PI)
        .iter()
        .map(|turn| {
            let labels = classify(turn, 0.5);
            let count = |wanted: Label| labels.iter().filter(|label| **label == wanted).count() as f32;
            let measured = labels.len() as f32 - count(Label::Missing);
            println!(
                "{} points: ground {}, obstacles {}, overhanging {}, below {}",
                measured,
                count(Label::Floor),
                count(Label::Obstacle),
                count(Label::Overhanging),
                count(Label::Below)
            );
            count(Label::Floor) / measured
        })
        .collect();
    println!("share of ground: {shares:?}");
    assert!(shares.len() >= 3);
    assert!(shares.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 0.05), "{shares:?}");
}

#[test]
fn a_cloud_of_kitti_is_read() {
    let Some(file) = file("000000.bin") else { return };
    let cloud = read_kitti(&file).expect("a cloud");
    assert_eq!(cloud.size(), (124_668, 1));
    assert!(cloud.points().iter().all(|p| p.is_measured() && (0.0..=1.0).contains(&p.intensity)));
    // The scanner is 1.73 m above the road.
    let road = cloud.points().iter().filter(|p| (4.0..10.0).contains(&p.x) && p.y.abs() < 2.0);
    let mut heights: Vec<f32> = road.map(|p| p.z).collect();
    heights.sort_by(f32::total_cmp);
    let median = heights[heights.len() / 2];
    println!("{} points of the road, {median} m below the scanner", heights.len());
    assert!((median + 1.73).abs() < 0.1, "{median}");
}
