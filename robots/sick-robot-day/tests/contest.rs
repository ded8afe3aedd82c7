//! Tests of the competition: its rules, and the fairness of the rivals.

use apex_nodes::{
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_rt::{Ctx, Out, Time};
use apex_sim::{Random, Simulation as _};
use sick_robot_day::world::{
    Arena, Station,
    contest::{
        Base, Contest, DURATION, Drivers, Fault, FaultKind, FrontCamera, FrontLaser, Hall, Lamp, Obstacle, RADIUS,
        Remote, Report, START, WheelOdometry,
    },
};
use std::{f32::consts::PI, time::Duration};

const fn ms(ms: i64) -> Time {
    Time::from_millis(ms)
}

fn at(time: Time) -> Ctx {
    Ctx::new(time)
}

/// Pose of our robot at a station, with a distance from the wall, a sideways offset and a heading error.
fn before(station: &Station, gap: f32, beside: f32, askew: f32) -> Pose2 {
    station.pose.compose(&Pose2::new(RADIUS + gap, beside, PI + askew))
}

/// Advances the time in steps, with the same command for the motors.
fn drive(contest: &mut Contest, twist: Twist, seconds: f32) {
    let end = contest.now() + Duration::from_secs_f32(seconds);
    while contest.now() < end {
        contest.drive(twist);
        contest.advance(contest.now() + Duration::from_millis(100));
    }
}

fn wait(contest: &mut Contest, seconds: f32) {
    contest.advance(contest.now() + Duration::from_secs_f32(seconds));
}

/// The filling station at the start of our robot. The others do not go there at first.
fn own_station(contest: &Contest) -> Station {
    let start = contest.robots()[0].pose.position();
    let way = |station: &Station| (station.pose.position() - start).norm();
    *contest.arena().filling.iter().min_by(|a, b| way(a).total_cmp(&way(b))).expect("four")
}

#[test]
fn the_start_is_as_the_rules_say() {
    for seed in 0..50 {
        let contest = Contest::new(seed, vec![]);
        let (station, [ours, rivals @ ..]) = (own_station(&contest), contest.robots());
        let degrees = |angle: f32| angle.sin().atan2(angle.cos()).to_degrees();
        assert!((ours.pose.position().norm() - 4.5).abs() < 0.1);
        assert!(degrees(ours.pose.position().angle() - station.pose.theta).abs() < 10.1, "seed {seed}");
        assert!(degrees(ours.pose.theta - ours.pose.position().angle() - PI).abs() < 20.1, "seed {seed}");
        assert!(rivals.iter().all(|rival| (rival.pose.position() - ours.pose.position()).norm() > 4.0));
    }
}

/// Report of a minute of a robot that drives randomly.
fn at_random(seed: u64) -> Report {
    let hall = Hall::new(seed, vec![]).expect("a level camera");
    let Drivers { mut front_laser, mut base, mut lamp, .. } = Drivers::new(&hall);
    let (mut random, mut scan) = (Random::new(seed), Out::new());
    for tick in 0..1500 {
        let ctx = at(ms(40 * tick));
        front_laser.process(&ctx, &mut scan);
        // The command depends on the sensor data.
        let seen = scan.get().expect("a scan").ranges[270].min(1.0);
        let [x, y, omega] = [1.5 * seen - 0.5, 0.8, 2.0].map(|most| random.uniform(-most, most));
        base.drive(&Twist::new(x, y, omega), &ctx);
        lamp.set(&random.chance(0.5), &ctx);
    }
    hall.report()
}

#[test]
fn the_same_seed_and_commands_are_the_same_contest() {
    assert_eq!(at_random(4), at_random(4));
    assert_ne!(at_random(4).trajectory, at_random(5).trajectory);
}

#[test]
fn a_cube_is_put_in_only_where_the_rules_allow_it() {
    // Gap, sideways offset, heading error, lamp, and the expected cube.
    let cases = [
        (0.05, 0.0, 0.0, true, true),
        (0.03, -0.08, 0.3, true, true),
        (0.05, 0.0, 0.0, false, false),
        (0.10, 0.0, 0.0, true, false),
        (0.05, 0.12, 0.0, true, false),
        (0.05, 0.0, -0.4, true, false),
        (0.05, 0.0, PI, true, false),
    ];
    for (gap, beside, askew, lamp, comes) in cases {
        let mut contest = Contest::new(2, vec![]);
        contest.place(before(&own_station(&contest), gap, beside, askew));
        contest.set_lamp(lamp);
        wait(&mut contest, 1.9);
        assert_eq!(contest.robots()[0].cube, None, "no one is so fast");
        wait(&mut contest, 6.2);
        let what = format!("{gap} m, {beside} m, {askew} rad, {lamp}");
        assert_eq!(contest.report().fetches.len(), usize::from(comes), "{what}");
        assert_eq!((contest.robots()[0].cube.is_some(), contest.hopper().cube.is_some()), (comes, comes), "{what}");
        assert!(contest.report().collisions.is_empty(), "{:?}", contest.report().collisions);
    }
}

#[test]
fn a_lamp_that_goes_off_or_a_robot_that_moves_is_not_served() {
    let mut contest = Contest::new(3, vec![]);
    contest.place(before(&own_station(&contest), 0.05, 0.0, 0.0));
    for _ in 0..10 {
        contest.set_lamp(true);
        wait(&mut contest, 1.9);
        contest.set_lamp(false);
        wait(&mut contest, 0.1);
    }
    assert_eq!(contest.report().fetches, []);
    contest.set_lamp(true);
    drive(&mut contest, Twist::new(0.0, 0.0, 0.06), 5.0);
    assert_eq!(contest.report().fetches, []);
}

#[test]
fn how_long_the_operator_takes_differs() {
    let takes = |seed| {
        let mut contest = Contest::new(seed, vec![]);
        contest.place(before(&own_station(&contest), 0.05, 0.0, 0.0));
        contest.set_lamp(true);
        wait(&mut contest, 8.1);
        contest.report().fetches[0]
    };
    let times: Vec<Time> = (0..20).map(takes).collect();
    assert!(times.iter().all(|time| (ms(2000)..=ms(8010)).contains(time)), "{times:?}");
    assert!(times.iter().any(|t| *t < ms(4000)) && times.iter().any(|t| *t > ms(6000)), "{times:?}");
}

#[test]
fn cubes_score_at_the_station_of_their_number_only() {
    for seed in 0..6 {
        for right in [true, false] {
            let mut contest = Contest::new(seed, vec![]);
            contest.place(before(&own_station(&contest), 0.05, 0.0, 0.0));
            contest.set_lamp(true);
            wait(&mut contest, 8.1);
            let number = contest.robots()[0].cube.expect("a cube");
            let station = if right { number } else { 1 + number % 4 };
            contest.place(before(&contest.arena().delivery[station as usize - 1], 0.05, 0.0, 0.0));
            wait(&mut contest, 8.1);
            let report = contest.report();
            let delivery = report.deliveries[0];
            assert_eq!((delivery.station, delivery.cube), (station, number));
            assert_eq!((report.points(), report.penalties()), (usize::from(right), usize::from(!right)));
            assert_eq!((contest.robots()[0].cube, contest.hopper().cube), (None, None));
        }
    }
}

#[test]
fn whoever_drives_against_a_wall_causes_one_collision_and_stops_there() {
    let mut contest = Contest::new(1, vec![]);
    let station = own_station(&contest);
    contest.place(before(&station, 0.3, 0.0, 0.0));
    drive(&mut contest, Twist::new(0.5, 0.0, 0.0), 2.0);
    let gap = station.pose.to_inner(contest.robots()[0].pose.position()).x - RADIUS;
    assert!((0.0..0.001).contains(&gap), "{gap}");
    let [crash] = contest.report().collisions[..] else { panic!("{:?}", contest.report().collisions) };
    assert_eq!((crash.against, crash.caused, crash.suffered), (Obstacle::Island, true, false));
    assert!((crash.place - station.pose.position()).norm() < 0.01);
    drive(&mut contest, Twist::new(-0.3, 0.0, 0.0), 1.0);
    drive(&mut contest, Twist::new(0.5, 0.0, 0.0), 2.0);
    assert_eq!(contest.report().caused(), 2, "again is another one");
}

#[test]
fn whoever_drives_against_a_robot_causes_it() {
    let mut contest = Contest::new(1, vec![]);
    let rival = contest.robots()[1];
    // Before the start the rivals stand still.
    let place = rival.pose.position() + Point2::polar(1.0, 0.5);
    contest.place(Pose2::new(place.x, place.y, 0.5 + PI));
    drive(&mut contest, Twist::new(1.5, 0.0, 0.0), 0.9);
    let [crash] = contest.report().collisions[..] else { panic!("{:?}", contest.report().collisions) };
    assert_eq!((crash.against, crash.caused, crash.suffered), (Obstacle::Robot(1), true, false));
    let [ours, hit, ..] = contest.robots();
    assert_eq!(hit.pose.position(), rival.pose.position(), "nobody is pushed");
    let gap = (ours.pose.position() - hit.pose.position()).norm() - ours.radius - hit.radius;
    assert!((0.0..0.001).contains(&gap), "{gap}");
    assert_eq!((contest.report().caused(), contest.report().suffered()), (1, 0));
    assert_eq!(contest.report().rivals.map(|rival| rival.collisions), [0; 3]);
}

#[test]
fn the_base_keeps_its_limits_and_brakes_without_commands() {
    let mut contest = Contest::new(1, vec![]);
    contest.place(Pose2::new(-4.0, -2.0, 0.0));
    contest.drive(Twist::new(0.0, 0.0, 9.0));
    wait(&mut contest, 0.2);
    let omega = contest.robots()[0].twist.omega;
    assert!((omega - 1.2).abs() < 1e-3, "{omega} rad/s after 0.2 s at 6 rad/s²");
    drive(&mut contest, Twist::new(0.0, 0.0, 9.0), 0.5);
    assert!((contest.robots()[0].twist.omega - 2.5).abs() < 1e-3);
    contest.drive(Twist::new(0.0, 0.0, 2.5));
    wait(&mut contest, 0.25);
    assert!((contest.robots()[0].twist.omega - 2.5).abs() < 1e-3, "the last command is not too old yet");
    wait(&mut contest, 0.6);
    assert_eq!(contest.robots()[0].twist, Twist::ZERO);
    drive(&mut contest, Twist::new(f32::NAN, f32::INFINITY, f32::NAN), 0.5);
    assert_eq!(contest.robots()[0].twist, Twist::ZERO);
}

#[test]
fn a_hall_is_driven_by_its_nodes() {
    let hall = Hall::new(7, vec![]).expect("a level camera");
    let (mut base, mut lamp) = (Base::new(&hall), Lamp::new(&hall));
    lamp.set(&true, &at(ms(0)));
    base.drive(&Twist::new(0.5, 0.0, 0.0), &at(ms(0)));
    hall.advance(ms(300));
    let [ours, ..] = hall.robots();
    assert!(ours.lamp && (ours.twist.x - 0.5).abs() < 1e-3);
    let Report { trajectory, distance, .. } = hall.report();
    assert_eq!(trajectory.iter().map(|(time, _)| *time).collect::<Vec<_>>(), [0, 100, 200, 300].map(ms));
    assert!((0.07..0.15).contains(&distance), "{distance}");
}

mod wired {
    apex_macros::graph! {
        use apex_nodes::{image::{Camera, GrayImage}, nav::Twist, scan::{Pose2, Scan}};
        use sick_robot_day::world::contest::{
            Base, FrontCamera, FrontLaser, HopperCamera, Lamp, RearLaser, Remote, WheelOdometry,
        };

        /// All drivers, without anything behind them.
        graph Wired {
            in  twist: Twist;
            in  on: bool;
            out ahead: Scan;
            out behind: Scan;
            out pose: Pose2;
            out image: GrayImage;
            out camera: Camera;
            out cubes: GrayImage;
            out word: String;

            node front:  FrontLaser;
            node rear:   RearLaser;
            node wheels: WheelOdometry;
            node eye:    FrontCamera;
            node hopper: HopperCamera;
            node remote: Remote;
            node base:   Base;
            node lamp:   Lamp;

            twist -> base.drive;
            on    -> lamp.set;
            front.scan   -> ahead;
            rear.scan    -> behind;
            wheels.pose  -> pose;
            eye.image    -> image;
            eye.camera   -> camera;
            hopper.image -> cubes;
            remote.word  -> word;
        }
    }
}

#[test]
fn all_drivers_work_in_a_compiled_graph() {
    let hall = Hall::new(7, vec![]).expect("a level camera");
    let drivers = Drivers::new(&hall);
    let mut robot = wired::Wired::new(wired::WiredParts {
        front: drivers.front_laser,
        rear: drivers.rear_laser,
        wheels: drivers.wheel_odometry,
        eye: drivers.front_camera,
        hopper: drivers.hopper_camera,
        remote: drivers.remote,
        base: drivers.base,
        lamp: drivers.lamp,
    });
    for tick in 0..=25 {
        assert!(robot.inputs().twist.put(Twist::new(0.3, 0.0, 0.0)).is_ok());
        assert!(robot.inputs().on.put(true).is_ok());
        robot.react(ms(40 * tick));
    }
    let seen = robot.outputs();
    let beams = |scan: &Option<apex_nodes::scan::Scan>| scan.as_ref().map(|scan| (scan.stamp, scan.ranges.len()));
    assert_eq!((beams(&seen.ahead), beams(&seen.behind)), (Some((ms(1000), 541)), Some((ms(1000), 271))));
    assert!(seen.pose.is_some_and(|pose| (0.2..0.4).contains(&pose.x)), "{:?}", seen.pose);
    let size = |image: &Option<apex_nodes::image::GrayImage>| image.as_ref().map(|image| (image.stamp, image.size()));
    assert_eq!(size(&seen.image), Some((ms(1000), (960, 720))));
    assert_eq!(size(&seen.cubes), Some((ms(1000), sick_robot_day::world::HOPPER_SIZE)));
    assert_eq!((seen.camera, seen.word.as_deref()), (Some(sick_robot_day::camera()), Some("go")));
    assert!(hall.robots()[0].lamp);
}

#[test]
fn motors_brake_after_their_command_time_out_if_they_have_one() {
    let way = |timeout: Option<Duration>| {
        let mut contest = Contest::new(1, vec![]);
        contest.set_command_timeout(timeout);
        let start = contest.robots()[0].pose;
        contest.drive(Twist::new(0.2, 0.0, 0.0));
        contest.advance(ms(3000));
        (contest.robots()[0].pose.position() - start.position()).norm()
    };
    assert!(way(Some(Duration::from_millis(300))) < 0.1 && way(None) > 0.5);
}

#[test]
fn the_remote_says_go_once() {
    let hall = Hall::new(1, vec![]).expect("a level camera");
    let (mut remote, mut words) = (Remote::new(&hall), vec![]);
    for tick in 0..15 {
        let mut word = Out::new();
        remote.process(&at(ms(100 * tick)), &mut word);
        words.extend(word.get().cloned());
    }
    assert_eq!((words[..10].iter().all(|word| word == "ready"), &words[10..]), (true, &["go".to_owned()][..]));
}

/// A hall with one fault from 1 s to 2 s.
fn broken(kind: FaultKind) -> Hall {
    Hall::new(1, vec![Fault { kind, from: ms(1000), until: ms(2000) }]).expect("a level camera")
}

#[test]
fn broken_beams_are_broken_for_a_while() {
    let whole = |range: &f32| (0.05..13.0).contains(range);
    let ranges = |laser: &mut FrontLaser, time| {
        let mut scan = Out::new();
        laser.process(&at(ms(time)), &mut scan);
        scan.get().map(|scan| scan.ranges.clone())
    };
    for (kind, is_broken) in [
        (FaultKind::BeamsNan, (|range| range.is_nan()) as fn(&f32) -> bool),
        (FaultKind::BeamsInfinite, |range| *range == f32::INFINITY),
        (FaultKind::BeamsZero, |range| *range == 0.0),
    ] {
        let mut laser = FrontLaser::new(&broken(kind));
        let mut at = |time| ranges(&mut laser, time).expect("a scan");
        let scans = [at(960), at(1000), at(1960), at(2000)];
        assert!(scans[1].len() == 541 && scans[1].iter().all(is_broken), "{kind:?}");
        assert!(scans[2].iter().all(is_broken), "{kind:?}");
        assert!([&scans[0], &scans[3]].iter().all(|s| s.iter().filter(|r| whole(r)).count() > 500), "{kind:?}");
    }
    let mut laser = FrontLaser::new(&broken(FaultKind::BeamsMissing));
    let missing = ranges(&mut laser, 1500).expect("a scan").iter().filter(|range| range.is_infinite()).count();
    assert!((220..330).contains(&missing), "{missing} of 541");
    let mut laser = FrontLaser::new(&broken(FaultKind::LaserFrozen));
    assert_eq!([960, 1000, 1960, 2000].map(|time| ranges(&mut laser, time).is_some()), [true, false, false, true]);
}

#[test]
fn a_broken_camera_is_broken_for_a_while() {
    let shoot = |camera: &mut FrontCamera, time| {
        let (mut image, mut intrinsics) = (Out::new(), Out::new());
        camera.process(&at(ms(time)), &mut image, &mut intrinsics);
        image.get().cloned().expect("an image")
    };
    let is_black = |image: &apex_nodes::image::GrayImage| image.pixels.iter().all(|pixel| *pixel == 0);
    let mut camera = FrontCamera::new(&broken(FaultKind::CameraBlack));
    let images = [960, 1000, 2000].map(|time| shoot(&mut camera, time));
    assert_eq!(images.each_ref().map(is_black), [false, true, false]);
    assert!(images.iter().all(|image| image.size() == (960, 720)));
    let mut camera = FrontCamera::new(&broken(FaultKind::CameraTorn));
    let sizes = [960, 1000, 1200, 2000].map(|time| shoot(&mut camera, time).size());
    assert_eq!(sizes, [(960, 720), (17, 3), (0, 0), (960, 720)]);
}

#[test]
fn stopped_wheels_go_on_where_they_are() {
    let hall = broken(FaultKind::OdometryStopped);
    let (mut wheels, mut base) = (WheelOdometry::new(&hall), Base::new(&hall));
    let mut poses = vec![];
    for tick in 0..60 {
        let mut pose = Out::new();
        base.drive(&Twist::new(0.3, 0.0, 0.0), &at(ms(40 * tick)));
        wheels.process(&at(ms(40 * tick)), &mut pose);
        poses.extend(pose.get().copied());
    }
    assert!(poses[25..50].iter().all(|pose| *pose == poses[24]) && poses[24].x > 0.15);
    assert!(poses[50].x - poses[49].x > 0.2 && poses[51] != poses[50]);
}

/// Plays to the end with our robot at a given place, and checks the rivals. Returns their report.
fn rivals(seed: u64, place: impl Fn(&Arena) -> Pose2) -> Report {
    let mut contest = Contest::new(seed, vec![]);
    contest.place(place(contest.arena()));
    let [ours, ..] = contest.robots();
    while contest.now() < START + DURATION {
        wait(&mut contest, 0.5);
        for rival in &contest.robots()[1..] {
            assert!(contest.arena().is_free(rival.pose.position(), rival.radius - 1e-3), "seed {seed}: {rival:?}");
        }
    }
    assert_eq!(contest.robots()[0].pose.position(), ours.pose.position(), "nobody pushes");
    contest.report().clone()
}

fn assert_fair(seed: u64, report: &Report) {
    assert!(report.collisions.is_empty(), "seed {seed}: {:?}", report.collisions);
    assert!(report.rivals.iter().all(|rival| rival.collisions == 0), "seed {seed}: {:?}", report.rivals);
}

#[test]
fn rivals_deliver_and_cause_no_collisions() {
    for seed in 0..5 {
        let report = rivals(seed, |_| Pose2::new(9.0, 9.0, 0.0));
        assert_fair(seed, &report);
        assert!(report.rivals.iter().all(|rival| rival.points >= 4), "seed {seed}: {:?}", report.rivals);
    }
}

#[test]
fn rivals_give_way_to_a_robot_that_stands() {
    for seed in 0..3 {
        let report = rivals(seed, |_| Pose2::new(2.4, 2.4, 0.0));
        assert_fair(seed, &report);
        assert!(report.rivals.iter().all(|rival| rival.points >= 2), "in the way, seed {seed}: {:?}", report.rivals);
        let report = rivals(seed, |arena| before(&arena.filling[seed as usize], 0.05, 0.0, 0.0));
        assert_fair(seed, &report);
        assert!(report.rivals.iter().all(|rival| rival.points >= 2), "at a station, seed {seed}: {:?}", report.rivals);
    }
}
