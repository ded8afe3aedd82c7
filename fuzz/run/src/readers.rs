//! File readers of the library.

use crate::{
    mutate::{Dice, bytes, words},
    worker::Target,
};
use apex_macros::graph;
use apex_nodes::{
    cloud::PointCloud,
    io::{
        CsvReader, LogGeometry, PlanOptions, ScanLogReader, VelodyneCapture, read_cloud, read_kitti, read_map,
        read_plan,
    },
    learn::{Mlp, Model},
    lidar::{PACKET, VelodynePacket, VelodynePackets, VelodyneTurns},
    map::{Grid, Occupancy, Raster},
    math::Random,
    nav,
    scan::{Point2, Pose2, Scan},
    slam::PoseGraph,
};
use apex_rt::{__codec, Construct, Ctx, Out, Time, event, params, record::Codec};
use apex_tune::{Axis, Follower, Goal, Journal, Method, Objective, Parameter, Scale, Study, Summary};
use std::{env, fmt::Write as _, fs, path::PathBuf, process};

graph! {
    use apex_nodes::{flow::Throttle, math::LowPass, scan::{JumpDistance, MedianFilter, Scan, SegmentFilter, Segments}};

    /// Parameters of several types.
    graph Tuned {
        in  scan: Scan;
        in  x: f64;
        out segments: Segments;
        out y: f64;
        node smooth = MedianFilter(reach = 2);
        node split  = JumpDistance(gap = 10cm);
        node small  = SegmentFilter(max_size = 20cm);
        node slow   = Throttle(n = 3);
        node low    = LowPass(weight = 0.5);
        scan -> smooth -> split -> small -> segments;
        x -> slow -> low.x;
        low -> y;
    }
}

/// A reader, and texts whose words are mutated.
struct Reader {
    texts: Vec<Vec<u8>>,
    words: &'static [&'static str],
    read: fn(&[u8]),
}

impl Target for Reader {
    fn make(&mut self, dice: &mut Dice) -> Vec<u8> {
        let whole = dice.of(&self.texts).clone();
        match std::str::from_utf8(&whole) {
            Ok(text) if dice.below(3) > 0 => words(text, self.words, dice).into_bytes(),
            _ => bytes(&whole, dice),
        }
    }

    fn run(&mut self, input: &[u8]) {
        (self.read)(input);
    }
}

/// A file with this content, for readers that need one.
pub fn file(ending: &str, input: &[u8]) -> PathBuf {
    let file = env::temp_dir().join(format!("apex-fuzz-{}.{ending}", process::id()));
    fs::write(&file, input).expect("room for the file");
    file
}

/// A target that gives texts, mutated, to `read`.
pub fn reader(texts: Vec<Vec<u8>>, words: &'static [&'static str], read: fn(&[u8])) -> Box<dyn Target> {
    Box::new(Reader { texts, words, read })
}

/// The target with messages of other programs.
pub fn messages() -> Box<dyn Target> {
    fn written<T>(codec: Option<Codec<T>>, token: &T) -> Vec<u8> {
        let mut bytes = vec![];
        (codec.expect("a message").write)(token, &mut bytes);
        bytes
    }
    /// Checks that a token that was read can be written and read again.
    fn again<T>(codec: Option<Codec<T>>, bytes: &[u8]) {
        let codec = codec.expect("a message");
        if let Ok(token) = (codec.read)(bytes) {
            let mut bytes = vec![];
            assert!((codec.write)(&token, &mut bytes) && (codec.read)(&bytes).is_ok());
        }
    }
    let scan = Scan { angle_increment: 0.1, ranges: [1.0, 2.0, f32::NAN].into_iter().collect(), ..Scan::default() };
    let path = nav::Path { points: vec![Point2::new(1.0, 2.0); 3], heading: 0.5 };
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 3, height: 2 };
    let mut cloud = PointCloud::default();
    cloud.reset(Time::ZERO, (2, 2));
    let texts = vec![
        written(__codec!(Scan), &scan),
        written(__codec!(nav::Path), &path),
        written(__codec!(Pose2), &Pose2::new(1.0, 2.0, 3.0)),
        written(__codec!(Grid<Occupancy>), &Grid::new(raster, Occupancy::Free).expect("small")),
        written(__codec!(Grid<f32>), &Grid::new(raster, 0.5).expect("small")),
        written(__codec!(PointCloud), &cloud),
        written(__codec!(VelodynePackets), &turning(3)),
        written(__codec!(String), &"a text".to_owned()),
    ];
    reader(texts, &[], |input| {
        again(__codec!(Scan), input);
        again(__codec!(nav::Path), input);
        again(__codec!(Pose2), input);
        again(__codec!(Grid<Occupancy>), input);
        again(__codec!(Grid<f32>), input);
        again(__codec!(PointCloud), input);
        again(__codec!(VelodynePackets), input);
        again(__codec!(String), input);
    })
}

/// The target with pose graphs.
pub fn g2o() -> Box<dyn Target> {
    let mut text = "# a square\nFIX 0\n".to_owned();
    for i in 0..8 {
        let _ = writeln!(text, "VERTEX_SE2 {i} {i}.5 -{i}e-1 0.{i}");
    }
    for i in 0..8 {
        let _ = writeln!(text, "EDGE_SE2 {i} {} 1 0 1.57 100 0 0 100 0 500", (i + 1) % 8);
    }
    reader(vec![text.into_bytes()], &["VERTEX_SE2", "EDGE_SE2", "FIX", "0", "1", "1e300", "-1e-300"], |input| {
        let file = file("g2o", input);
        if let Ok(mut graph) = PoseGraph::read(&file) {
            // Every graph that could be read can be optimized.
            let _ = graph.optimize(3);
        }
        let _ = fs::remove_file(file);
    })
}

/// The target with tables of numbers.
pub fn csv() -> Box<dyn Target> {
    let text = "a,b,c\n1,2.5,-3e3\n,,\n 4 , NaN ,inf\n";
    reader(vec![text.as_bytes().to_vec(), vec![b','; 3000]], &["1e309", ",", "\n", ",,", "nan"], |input| {
        for ending in ["csv", "csv.gz"] {
            let file = file(ending, input);
            if let Ok(mut reader) = CsvReader::open(&file, input.len() % 2 == 0) {
                let mut row = vec![];
                while reader.read(&mut row).unwrap_or(true) && row.len() < 100_000 && !row.is_empty() {}
            }
            let _ = fs::remove_file(file);
        }
    })
}

/// The target with logs of laser scans.
pub fn scans() -> Box<dyn Target> {
    let table = "7,1,0.5,1.25,3,20,0\n8,1,0.5,NaN,,inf,-1\n".as_bytes().to_vec();
    let log = "PARAM x 1\nFLASER 5 1.0 2.0 3.0 81.91 0.5 1 2 0.5 1 2 0.5 976052857.9 host 0.25\nODOM 1 2\n"
        .as_bytes()
        .to_vec();
    let current = "RAWLASER1 0 -1.57 3.14 0.5 81.9 0.01 0 3 1 2 99 0 1.5 host 0.25\n\
                   ROBOTLASER1 0 -1.57 3.14 0.5 81.9 0.01 0 2 1 2 2 7 8 1 2 3 1 2 3 0 0 0.3 0.3 1e6 1.5 host 0.25\n"
        .as_bytes()
        .to_vec();
    let words = &["FLASER", "ROBOTLASER1", "RAWLASER1", "0", "99999999", "-1", ",", "\n", "\r", "1e39"];
    reader(vec![table, log, current], words, |input| {
        let geometry = LogGeometry { angle_min: -1.57, angle_increment: 0.01, range_min: 0.1, range_max: 30.0 };
        for ending in ["csv", "log"] {
            let file = file(ending, input);
            if let Ok(mut reader) = ScanLogReader::open(&file, geometry) {
                let mut scan = Scan::default();
                for _ in 0..1000 {
                    if matches!(reader.read(&mut scan), Ok(None)) {
                        break;
                    }
                }
            }
            let _ = fs::remove_file(file);
        }
    })
}

/// The target with point clouds.
pub fn clouds() -> Box<dyn Target> {
    let header = "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\n";
    let text = format!("{header}POINTS 3\nDATA ascii\n1 2 3 0\nnan nan nan 1\n4 5 6 2\n").into_bytes();
    let binary = [format!("{header}DATA binary\n").as_bytes(), &[64; 48]].concat();

    // A literal and a copy of it, which is as long as the rest.
    let compressed =
        [format!("{header}DATA binary_compressed\n").as_bytes(), &[5, 0, 0, 0, 48, 0, 0, 0, 0, 64, 0xe0, 38, 0]]
            .concat();
    let words = &["ascii", "binary", "binary_compressed", "FIELDS", "WIDTH", "0", "16777216", "F", "U", "I", "8"];
    reader(vec![text, binary, compressed], words, |input| {
        let file = file("pcd", input);
        if let Ok(read) = read_cloud(&file) {
            let (width, height) = read.cloud.size();
            assert_eq!(read.cloud.points().len(), width * height);
        }
        let _ = fs::remove_file(file);
    })
}

/// Packets of a scanner that turns.
fn turning(count: usize) -> VelodynePackets {
    let packet = |number: usize| {
        let mut bytes = vec![number as u8; PACKET];
        for block in 0..12 {
            let azimuth = (480 * number + 40 * block) as u16 % 36_000;
            bytes[100 * block..][..4].copy_from_slice(&[0xff, 0xee, azimuth as u8, (azimuth >> 8) as u8]);
        }
        bytes[1200..].copy_from_slice(&[0, number as u8, 0, 0, [0x37, 0x38, 0x39][number % 3], 0x22]);
        VelodynePacket::new(Time::from_millis(number as i64), &bytes).expect("a packet")
    };
    VelodynePackets { packets: (0..count).map(packet).collect() }
}

/// The target with packets of a scanner: many of them in sequence, without what tells where they begin.
pub fn packets() -> Box<dyn Target> {
    let bytes: Vec<u8> = turning(200).packets.iter().flat_map(|packet| *packet.bytes()).collect();
    reader(vec![bytes], &[], |input| {
        let packets = input.chunks(PACKET).filter_map(|bytes| VelodynePacket::new(Time::ZERO, bytes).ok()).collect();
        let mut node = VelodyneTurns::construct((1.0, input.len() % 2 == 0, 0.5));
        let packets = VelodynePackets { packets };
        for token in [Some(&packets), None, Some(&packets), None] {
            let mut out = Out::new();
            node.process(token, &mut out);
            if let Some(turn) = out.get() {
                assert_eq!(turn.points().len(), turn.rings() * turn.columns());
            }
        }
    })
}

/// The target with captures of the network, and with clouds of KITTI.
pub fn captures() -> Box<dyn Target> {
    let number = |n: u32| n.to_le_bytes();
    let mut capture: Vec<u8> = [0xa1b2_c3d4, 0x0004_0002, 0, 0, 65_535, 1].into_iter().flat_map(number).collect();
    for packet in turning(4).packets {
        let length = PACKET as u16;
        capture.extend([7, packet.stamp.as_nanos() as u32 / 1000, 42 + PACKET as u32, 0].into_iter().flat_map(number));
        capture.extend([[0xff; 12].as_slice(), &[0x08, 0x00, 0x45, 0], &(length + 28).to_be_bytes()].concat());
        capture.extend([0, 1, 0x40, 0, 64, 17, 0, 0, 192, 168, 1, 201, 255, 255, 255, 255]);
        capture.extend([9, 64, 9, 64]);
        capture.extend((length + 8).to_be_bytes());
        capture.extend([0, 0]);
        capture.extend(packet.bytes());
    }
    reader(vec![capture, vec![64; 160]], &[], |input| {
        let file = file("pcap", input);
        let _ = read_kitti(&file);
        let mut node = VelodyneCapture::construct((file.to_string_lossy().into_owned(), 2368, input.len() % 2 == 0));
        for second in 0..20 {
            let mut out = Out::new();
            let _ = node.process(&Ctx::new(Time::from_secs(100 * second)), &mut out, event(&mut None));
        }
        let _ = fs::remove_file(file);
    })
}

/// The target with maps of pixels.
pub fn maps() -> Box<dyn Target> {
    let (text, binary) = ("P2\n# text\n3 2\n255\n254 205 0\n0 100 255\n", b"P5 3 2 65535 abcdefghijkl".to_vec());
    reader(vec![text.as_bytes().to_vec(), binary], &["P2", "P5", "#", "0", "65535", "99999999", "-1"], |input| {
        let file = file("pgm", input);
        let _ = read_map(&file, 0.05);
        let _ = fs::remove_file(file);
    })
}

/// The target with plans.
pub fn plans() -> Box<dyn Target> {
    let spline = "0\nSPLINE\n71\n2\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n\
                  10\n0\n20\n0\n30\n0\n10\n1\n20\n1\n30\n0\n10\n2\n20\n0\n30\n0\n";
    let text = format!(
        "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nb\n10\n1\n20\n0\n{spline}0\nENDBLK\n0\nENDSEC\n\
         0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nw\n10\n0\n20\n0\n11\n1\n21\n1\n0\nINSERT\n2\nb\n70\n3\n71\n3\n\
         0\nELLIPSE\n10\n2\n20\n0\n11\n2\n21\n0\n40\n0.5\n0\nARC\n40\n2\n51\n90\n210\n1\n220\n0\n230\n0\n\
         0\nENDSEC\n0\nEOF\n"
    );
    let words = &["0", "-1", "1e300", "32767", "SPLINE", "INSERT", "ELLIPSE", "40", "67", "70", "71", "210", "230"];
    reader(vec![text.into_bytes(), b"0,0,1,1\n1,1,2,0\n".to_vec()], words, |input| {
        for ending in ["dxf", "csv"] {
            let file = file(ending, input);
            let _ = read_plan(&file, &PlanOptions::default());
            let _ = fs::remove_file(file);
        }
    })
}

/// The target with models.
pub fn models() -> Box<dyn Target> {
    let model = |sizes: &[usize]| {
        let network = Mlp::new(sizes, &mut Random::new(1));
        Model { provenance: "a test".into(), seed: 1, network }.to_bytes()
    };
    reader(vec![model(&[4, 3, 2]), model(&[1, 1]), model(&[20, 10, 10, 5])], &[], |input| {
        if let Ok(model) = Model::from_bytes(input) {
            assert_eq!(Model::from_bytes(&model.to_bytes()).ok().map(|m| m.to_bytes()), Some(model.to_bytes()));
        }
    })
}

/// The target with parameters.
pub fn params() -> Box<dyn Target> {
    let text = params::save(&mut Tuned::new());
    let more = format!("{text}\n[nope]\nx = [1, [2]]\ny = 1979-05-27\n\"smooth\".reach = 0x10\n");
    reader(
        vec![text.into_bytes(), more.into_bytes()],
        &["[smooth]", "reach", "=", "1e400", "-1", "[[", "inline = {", "true"],
        |input| {
            let mut program = Tuned::new();
            let text = String::from_utf8_lossy(input);
            match params::load(&mut program, &text) {
                Ok(()) => {
                    let saved = params::save(&mut program);
                    assert!(params::load(&mut program, &saved).is_ok(), "what was saved cannot be loaded:\n{saved}");
                }
                Err(error) => drop(error.to_string()),
            }
        },
    )
}

/// A study with two goals.
fn study(method: Method) -> Study {
    let axis = Axis::new(0.1, 20.0, Scale::Logarithmic, false).expect("a range");
    let parameter = |name: &str| Parameter {
        name: name.to_owned(),
        unit: "m".to_owned(),
        shown_in: None,
        axis,
        default: 1.0,
        targets: vec![format!("node.{name}")],
        single: true,
    };
    let goal = |name: &str, maximise| {
        let (name, unit, summary, least) = (name.to_owned(), String::new(), Summary::Quantile(0.9), f64::NEG_INFINITY);
        Goal { name, unit, maximise, summary, least }
    };
    Study {
        name: "Fuzzed".to_owned(),
        objective: 1,
        parameters: vec![parameter("x"), parameter("y")],
        method,
        goals: vec![goal("a", false), goal("b", true)],
        seeds: vec![0, 1, 2],
        held_out: vec![3],
        searches: 3,
        candidates: 30,
        seed: 1,
        racing: true,
    }
}

/// Objective that fails for some seeds.
struct Sum;

impl Objective for Sum {
    fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String> {
        let sum: f64 = values.iter().sum();
        Ok(vec![if seed == 2 && sum > 20.0 { f64::NAN } else { sum }, sum * seed as f64])
    }
}

/// The target with journals of studies.
pub fn journals() -> Box<dyn Target> {
    let text = |method| {
        let (study, file) = (study(method), file("journal", &[]));
        let mut journal = Journal::open(&file, &study).expect("a new journal");
        study.run(&Sum, &mut journal, (0, 1), &mut |_| ()).expect("a study");
        let text = fs::read(&file).expect("the journal");
        let _ = fs::remove_file(file);
        text
    };
    let texts = vec![text(Method::DifferentialEvolution), text(Method::CmaEs)];
    reader(texts, &["0", "-1", "1e308", "NaN", "inf", "-inf", ",", "\n", "18446744073709551615", "null"], |input| {
        let file = file("journal", input);
        let mut follower = Follower::new(file.clone());
        while let Ok(true) = follower.read() {}
        if let Some(seen) = follower.seen() {
            let candidates = seen.trails().flat_map(|(_, trail)| trail.candidates());
            candidates.for_each(|candidate| drop(seen.study().params(&candidate.values)));
            drop((seen.best(), seen.defaults(), seen.range(0)));
        }
        let _ = fs::remove_file(file);
    })
}
