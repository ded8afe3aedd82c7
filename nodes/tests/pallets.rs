//! The container search on recorded scans of EUR pallets (thesis 6.6.1, with a pallet in place of a cart).
//!
//! The recordings are not part of the project: without them the test says so and passes, unless it runs with `CI=true`.

use apex_nodes::io::{CsvReader, LogGeometry, ScanLogReader};
use apex_nodes::scan::{Container, ContainerSearch, JumpDistance, RangeFilter, Scan, SegmentFilter};
use apex_rt::{Construct, Out};
use std::{
    collections::HashMap,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// An EUR pallet, 1.2 m × 0.8 m, seen from the short side: nine feet of 14.5 cm × 10 cm (their boxes with 5 cm of
/// tolerance and noise), and the three boards under them, of which a low scanner sees more or less.
const PALLET: &[[f32; 4]] = &[
    [-0.5275, -0.35, 0.2, 0.2],
    [-0.5275, 0.0, 0.2, 0.2],
    [-0.5275, 0.35, 0.2, 0.2],
    [0.0, -0.35, 0.2, 0.2],
    [0.0, 0.0, 0.2, 0.2],
    [0.0, 0.35, 0.2, 0.2],
    [0.5275, -0.35, 0.2, 0.2],
    [0.5275, 0.0, 0.2, 0.2],
    [0.5275, 0.35, 0.2, 0.2],
    [0.0, -0.35, 1.2, 0.15],
    [0.0, 0.0, 1.2, 0.15],
    [0.0, 0.35, 1.2, 0.15],
];

/// The directory of the recordings, or `None` (with a message) if they are not there.
fn recordings() -> Option<PathBuf> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/container2d");
    if directory.is_dir() {
        return Some(directory);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", directory.display());
    eprintln!("skipped: {} is missing", directory.display());
    None
}

/// The nodes from scan to container.
struct Chain {
    filter: RangeFilter,
    jumps: JumpDistance,
    wheels: SegmentFilter,
    search: ContainerSearch,
}

impl Chain {
    fn new() -> Self {
        let view_angle = 55.0_f32.to_radians();
        Self {
            filter: RangeFilter::construct((0.3, 10.0)),
            jumps: JumpDistance::construct((0.05, 1)),
            wheels: SegmentFilter::construct((0.35, 4.5, 1)),
            search: ContainerSearch::construct((
                0.8,   // width
                1.2,   // length
                0.1,   // foot across
                0.145, // foot along
                0.1,   // width_tolerance
                2,     // min_points: a foot that is near has an extent
                15,    // min_inliers
                25,    // max_outliers
                9,     // min_wheels: three boards and six feet
                0,     // max_missing
                0.6,   // clearance: nothing blocks the pockets
                view_angle, PALLET,
            )),
        }
    }

    fn run(&mut self, scan: &Scan) -> Option<Container> {
        let (mut filtered, mut segments, mut wheels) = (Out::new(), Out::new(), Out::new());
        self.filter.process(scan, &mut filtered);
        let filtered = filtered.get()?;
        self.jumps.process(filtered, &mut segments).expect("few enough segments");
        self.wheels.process(segments.get()?, &mut wheels);
        self.search.process(filtered, wheels.get()?)
    }
}

/// Labels by row number: xmin, ymin, xmax, ymax of a hand-drawn box around the pallet, in m.
fn labels(directory: &Path) -> HashMap<u64, [f64; 4]> {
    let mut reader = CsvReader::open(directory.join("class1_boxes_m.csv"), true).expect("the labels");
    let (mut labels, mut row) = (HashMap::new(), Vec::new());
    while reader.read(&mut row).expect("a row") {
        labels.insert(row[0] as u64, [row[1], row[2], row[3], row[4]]);
    }
    labels
}

#[test]
fn finds_pallets_and_little_else() {
    let Some(directory) = recordings() else { return };
    let labels = labels(&directory);
    let geometry = LogGeometry {
        angle_min: (-95.0_f32).to_radians(),
        angle_increment: (190.0_f32 / 761.0).to_radians(),
        range_min: 0.05,
        range_max: 20.0,
    };
    let mut chain = Chain::new();
    let (mut scans, mut found, mut elsewhere, mut busy) = (0, 0, 0, Duration::ZERO);
    for class in ["class1", "class2"] {
        let path = directory.join(format!("{class}_scans.csv.gz"));
        let mut reader = ScanLogReader::open(path, geometry).expect("the scans");
        let mut scan = Scan::default();
        while let Some(entry) = reader.read(&mut scan).expect("a scan") {
            let start = Instant::now();
            let container = chain.run(&scan);
            busy += start.elapsed();
            scans += 1;
            let Some(Container { pose, .. }) = container else { continue };
            let (x, y) = (f64::from(pose.x), f64::from(pose.y));
            let inside =
                labels.get(&entry.id).is_some_and(|b| (b[0]..=b[2]).contains(&x) && (b[1]..=b[3]).contains(&y));
            if inside {
                found += 1;
            } else {
                elsewhere += 1;
            }
        }
    }
    println!("{scans} scans: {found} of {} pallets found, {elsewhere} found elsewhere", labels.len());
    println!("{:?} per scan", busy / scans);
    assert_eq!((scans, labels.len()), (275, 160));
    assert!(found >= 150 && elsewhere <= 2, "{found} found, {elsewhere} elsewhere");
}
