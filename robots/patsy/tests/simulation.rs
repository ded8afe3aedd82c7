//! The rates of experiment 1 (thesis 6.10.2, table 6.2) in simulation, with the nodes wired by hand.

use apex_nodes::{
    io::ScanPicture,
    scan::{ContainerSearch, JumpDistance, RangeFilter, SegmentFilter},
};
use apex_rt::{Construct, Ctx, Event, Out, Time};
use core::f32::consts::PI;
use patsy::{Evaluate, LENGTH, SimLaser, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH};

/// Plays the simulation; with a directory, pictures of some scans are written there.
fn play(seed: u64, runs: u32, pictures: Option<&'static str>) -> Evaluate {
    let mut laser = SimLaser::construct((seed, runs, 50, 1.5 * PI, PI / 360.0, 0.01, 0.005));
    let mut filter = RangeFilter::construct((0.05, 10.0));
    let mut jumps = JumpDistance::construct((0.15, 1));
    let mut wheels = SegmentFilter::construct((0.2, 5.0, 1));
    let mut search = ContainerSearch::construct((
        WIDTH,
        LENGTH,
        WHEEL_WIDTH,
        WHEEL_LENGTH,
        0.15, // width_tolerance
        1,    // min_points
        4,    // min_inliers
        3,    // max_outliers
        3,    // min_wheels
        0,    // max_missing
        0.0,  // clearance
        PI,   // max_view_angle
        WHEEL_BOXES,
    ));
    let mut evaluate = Evaluate::construct((0.3, 0.35));
    let mut picture = pictures.map(|directory| ScanPicture::construct((directory, "PATSY", 97, 100, 6.0, WHEEL_BOXES)));
    let (mut scan, mut truth, mut pose) = (Out::new(), Out::new(), Out::new());
    let (mut filtered, mut segments, mut candidates) = (Out::new(), Out::new(), Out::new());
    let mut busy = std::time::Duration::ZERO;
    for i in 0.. {
        pose.clear();
        laser.process(&Ctx::new(Time::from_millis(40 * i)), &mut scan, &mut truth, &mut pose, Event::unconnected());
        if laser.finished() {
            println!("{:?} per scan", busy / i as u32);
            break;
        }
        let start = std::time::Instant::now();
        filter.process(scan.get().expect("a scan"), &mut filtered);
        let filtered = filtered.get().expect("a scan");
        jumps.process(filtered, &mut segments).expect("few segments");
        wheels.process(segments.get().expect("segments"), &mut candidates);
        let candidates = candidates.get().expect("segments");
        let found = search.process(filtered, candidates);
        busy += start.elapsed();
        if let Some(picture) = &mut picture {
            picture.process(filtered, candidates, found.as_ref(), pose.get()).expect("a picture");
        }
        evaluate.process(truth.get().expect("a truth"), found.as_ref());
    }
    evaluate
}

#[test]
fn finds_nearly_all_carts_and_hardly_anything_else() {
    let evaluate = play(1, 20, None);
    println!("{evaluate}");
    let all = evaluate.combined();
    assert_eq!(all.scans, 5 * 20 * 50);
    assert!(all.true_rate() >= Some(0.95), "{evaluate}");
    assert!(all.false_rate() <= Some(0.01), "{evaluate}");
}
