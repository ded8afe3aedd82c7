//! The compiled robot on recorded scans of EUR pallets (thesis 6.6.1, with a pallet in place of a cart).
//!
//! The recordings are not part of the project. Without them the test prints a message and passes, unless it runs with
//! `CI=true`.

use apex_nodes::io::ScanLog;
use apex_rt::Time;
use patsy::{
    experiments::{RECORDED_SCANNER, Report},
    programs::{RecordedPallets, RecordedPalletsParts},
};
use std::path::{Path, PathBuf};

/// Folder of the recordings, or `None` (with a message) if it does not exist.
fn recordings() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/container2d");
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", folder.display());
    eprintln!("skipped: {} is missing", folder.display());
    None
}

/// Numbers of labelled scans, of pallets found in their box, and of pallets found elsewhere.
fn play(folder: &Path, class: &str) -> (u64, u64, u64) {
    let table = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{class}.csv"));
    let log = ScanLog::open(folder.join(format!("{class}_scans.csv.gz")), RECORDED_SCANNER).expect("the scans");
    let report = Report::new(&table, Some(&folder.join("class1_boxes_m.csv"))).expect("the labels");
    let mut robot = RecordedPallets::new(RecordedPalletsParts { log, report });
    while !robot.nodes().log.finished() {
        robot.react(Time::ZERO);
    }
    robot.nodes().report.counts()
}

#[test]
fn finds_pallets_and_little_else() {
    let Some(folder) = recordings() else { return };
    let (labelled, found, elsewhere) = play(&folder, "class1");
    let (_, _, false_alarms) = play(&folder, "class2");
    println!("{found} of {labelled} pallets found, {} elsewhere", elsewhere + false_alarms);
    assert_eq!(labelled, 160);
    assert!(found >= 150 && elsewhere + false_alarms <= 2);
}
