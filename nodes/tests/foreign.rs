//! Files that other programs have written, from a folder beside the repository. Without it, the tests are skipped.

use apex_nodes::{
    io::{CsvReader, LogGeometry, PlanOptions, ScanLogReader, read_plan},
    map::{Grid, Occupancy},
    nav::Path,
    scan::{Point2, Pose2, Scan},
};
use apex_rt::{
    Time,
    record::{Codec, tokens},
};
use std::{panic, path::PathBuf};

/// Path of a file, or `None` if there is no such folder.
fn file(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/conformance/files").join(name);
    let exists = path.exists();
    if !exists {
        eprintln!("skipped: {} is missing", path.display());
    }
    exists.then_some(path)
}

/// Tokens of a recording, or the message of the error.
fn read<T: Clone>(name: &str, channel: &str, codec: Option<Codec<T>>) -> Option<Result<Vec<T>, String>> {
    let path = file(name)?;
    let path = path.to_str().expect("a readable path");
    let read = panic::catch_unwind(|| {
        let tokens = tokens("", path, channel, codec).begun_at(Time::ZERO);
        tokens.iter().map(|(_, token)| token.clone()).collect()
    });
    Some(read.map_err(|error| error.downcast::<String>().map_or_else(|_| "?".to_owned(), |text| *text)))
}

#[test]
fn logs_and_tables() {
    let geometry = LogGeometry { angle_min: 0.0, angle_increment: 0.01, range_min: 0.1, range_max: 80.0 };
    for (name, count, beams) in [("robotlaser1.log", 1, 5), ("latin1_param.log", 3, 3)] {
        let Some(path) = file(name) else { return };
        let (mut reader, mut scan) = (ScanLogReader::open(path, geometry).expect("a log"), Scan::default());
        let read = std::iter::from_fn(|| reader.read(&mut scan).expect("a scan")).count();
        assert_eq!((read, scan.ranges.len()), (count, beams), "{name}");
    }
    let (mut reader, mut row) = (CsvReader::open(file("bom.csv").expect("a table"), false).expect("a table"), vec![]);
    assert_eq!((reader.read(&mut row), row.as_slice()), (Ok(true), &[1.0, 2.0, 3.0][..]));
}

#[test]
fn plans() {
    let read = |name| file(name).map(|path| read_plan(path, &PlanOptions::default()).expect(name));
    let Some(plan) = read("paperspace_insert.dxf") else { return };
    assert_eq!(plan.map.bounds(), Some((Point2::new(100.0, 100.0), Point2::new(104.0, 100.0))));
    let plan = read("ellipse_and_mesh.dxf").expect("a plan");
    let length: f32 = plan.map.segments().iter().map(|s| (s.b - s.a).norm()).sum();
    assert!((length - 8.844).abs() < 0.03, "{length}");
    assert_eq!(plan.note().as_deref(), Some("left out: 1 `POLYLINE of a mesh`"));
    assert_eq!(read("insert_array_of_empty_block.dxf").expect("a plan").map.segments().len(), 1);
}

#[test]
fn recordings() {
    let scan = || apex_rt::__codec!(Scan);
    let Some(read_one) = read("scan_1537_beams.mcap", "/scan", scan()) else { return };
    assert!(read_one.expect("scans").iter().all(|scan| scan.ranges.len() == 1537));
    read("scan_no_statistics.mcap", "/scan", scan()).expect("a file").expect("scans");
    let refused = read("scan_json.mcap", "/scan", scan()).expect("a file").map(|_| ()).expect_err("it is JSON");
    assert!(refused.contains("recorded: encoding json"), "{refused}");
    let poses = read("pose_tilted.mcap", "/pose", apex_rt::__codec!(Pose2)).expect("a file").expect("poses");
    for (pose, heading) in poses.iter().zip([0.0, 2.299, 0.0]) {
        assert!((pose.theta - heading).abs() < 1e-3, "{pose:?}");
    }
    let path = read("path_of_nav2.mcap", "/plan", apex_rt::__codec!(Path)).expect("a file").expect("a path");
    assert_eq!(path[0].points.last(), Some(&Point2::new(1.0, 1.0)));
    let empty = read("path_of_nav2.mcap", "/empty", apex_rt::__codec!(Path)).expect("a file").expect("a path");
    assert!(empty[0].points.is_empty());
    let map = || apex_rt::__codec!(Grid<Occupancy>);
    let refused = read("grid_turned_origin.mcap", "/map", map()).expect("a file").map(|_| ()).expect_err("turned");
    assert!(refused.contains("its origin is turned by 90.0°"), "{refused}");
    read("grid_probabilities.mcap", "/map", map()).expect("a file").expect("a map");
    for name in ["scan_zstd.mcap", "scan_unix_time.mcap"] {
        assert!(!read(name, "/scan", scan()).expect("a file").expect(name).is_empty());
    }
}
