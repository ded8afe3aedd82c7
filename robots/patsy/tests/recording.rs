//! Recording and replay of PATSY's perception.

use apex_macros::graph;
use apex_rt::{
    StdErr, drive_with,
    prelude::*,
    record::{Recorder, Tap, WhenFull, replay},
};
use std::{env, fs};

graph! {
    use apex_nodes::scan::{JumpDistance, RangeFilter, SegmentFilter};
    use patsy::world::SimLaser;

    /// First nodes of the perception.
    robot Sensors {
        node laser = SimLaser(seed = 3, runs = 1) every 40ms;
        node range = RangeFilter(max = 10m);
        node jumps = JumpDistance(gap = 15cm);
        laser.scan -> range -> jumps -> SegmentFilter();
        record "eyes.mcap" {
            range;
            jumps;
        }
    }
}

#[test]
fn scans_are_seen_again_bit_by_bit() {
    let folder = env::temp_dir().join(format!("apex-patsy-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder for temporary files");
    let path = folder.join("eyes.mcap");
    let mut tap = Tap::Record(Recorder::to_file::<Sensors>(&path, WhenFull::Wait).expect("a new file"));
    drive_with(Sensors::new(), SimClock::until(Time::from_secs(8)), &mut tap);
    let Tap::Record(recorder) = tap else { unreachable!("it records") };
    assert!(recorder.finish().expect("room for the file").dropped.is_empty());

    let report = replay(Sensors::new(), &path, StdErr(const { &Sensors::INFO })).expect("a recording");
    fs::remove_dir_all(&folder).expect("it is ours");
    assert!(report.is_same(), "{report}");
    assert!(report.compared.iter().all(|c| c.equal == 200), "{report}");
}
