//! Consistency of the filter: in a simulation with the errors that it assumes, its own are as large as it says.

use super::{
    filter::{BIAS, Matrix, SCALE, STATES, State, Step, THETA, expected_position, jacobian, moved, position_jacobian},
    gyro::Turned,
    past::wrapped,
    *,
};
use crate::{
    math::Random,
    scan::{Point2, Pose2, PoseChange},
};
use apex_rt::Time;
use core::f32::consts::{FRAC_PI_2, PI};

/// Period of the wheels, and number of measurements of the gyroscope in one.
const PERIOD: f64 = 0.05;
const RATES: usize = 5;

/// Robot with sensors whose errors are those of settings.
struct World {
    settings: FusionSettings,
    random: Random,
    now: Time,
    /// True pose, in the frame of the fixes.
    pose: [f64; 3],
    wheels: [f64; 3],
    bias: f64,
    scale: f64,
    slow: [f64; 2],
    has_gyro: bool,
    /// Error that is added to fixes; they are missing if it is NaN.
    jump: f64,
    fixes: u32,
}

impl World {
    fn new(settings: FusionSettings, seed: u64, pose: [f64; 3]) -> Self {
        let mut random = Random::new(seed);
        let mut normal = |sigma: f32| f64::from(sigma) * random.standard_normal();
        let (bias, scale) = (normal(settings.bias_spread), 1.0 + normal(settings.scale_spread));
        let slow = [normal(settings.wander), normal(settings.wander)];
        Self {
            settings,
            random,
            now: Time::ZERO,
            pose,
            wheels: [0.0; 3],
            bias,
            scale,
            slow,
            has_gyro: true,
            jump: 0.0,
            fixes: 0,
        }
    }

    fn normal(&mut self, sigma: f64) -> f64 {
        sigma * self.random.standard_normal()
    }

    fn wheels(&self) -> Pose2 {
        let [x, y, theta] = self.wheels;
        Pose2::new(x as f32, y as f32, theta as f32)
    }

    /// Drives for a period of the wheels, and measures. Returns what the filter made of a fix.
    fn step(&mut self, filter: &mut PoseFilter, speed: f64, rate: f64) -> Option<(FixUse, Option<PoseChange>)> {
        let settings = self.settings;
        for _ in 0..RATES {
            let dt = PERIOD / RATES as f64;
            self.now += core::time::Duration::from_secs_f64(dt);
            let noise = f64::from(settings.gyro_noise) / dt.sqrt();
            let measured = rate + self.bias + self.normal(noise);
            if self.has_gyro {
                filter.turn(self.now, &Inertial::level(measured));
            }
            let walk = self.normal(f64::from(settings.bias_walk) * dt.sqrt());
            self.bias += walk;
        }
        // The wheels measure the step without its errors, and turn the pose that they sum up.
        let (way, turn) = (speed * PERIOD, rate * PERIOD);
        move_by(&mut self.wheels, [way, 0.0], turn + if self.has_gyro { 0.3 * turn } else { 0.0 });
        let slip = f64::from(settings.motion.slip) * (way.abs() + 0.3 * turn.abs()).sqrt();
        let skid = f64::from(settings.motion.skid) * turn.abs().sqrt();
        let veer = f64::from(settings.motion.veer) * way.abs().sqrt();
        let heading = if self.has_gyro { 0.0 } else { self.normal((skid * skid + veer * veer).sqrt()) };
        let step = [self.scale * way + self.normal(slip), self.normal(slip)];
        move_by(&mut self.pose, step, turn + heading);
        filter.drive(self.now, &self.wheels());
        let remembered = (-PERIOD / f64::from(settings.wander_time)).exp();
        for i in 0..2 {
            let change = self.normal(f64::from(settings.wander) * (1.0 - remembered * remembered).sqrt());
            self.slow[i] = remembered * self.slow[i] + change;
        }
        self.fixes += 1;
        (self.fixes.is_multiple_of(4) && self.jump.is_finite()).then(|| filter.fix(&self.fix()))
    }

    /// Fix at this time.
    fn fix(&mut self) -> PositionFix {
        let noise = f64::from(self.settings.fix_noise);
        let error = [0, 1].map(|i| self.slow[i] + self.normal(noise) + self.jump);
        let position = Point2::new((self.pose[0] + error[0]) as f32, (self.pose[1] + error[1]) as f32);
        PositionFix { stamp: self.now, position, variance: 0.0 }
    }

    /// Drives along curves to both sides for so many seconds.
    fn drive(&mut self, filter: &mut PoseFilter, seconds: f64) -> Vec<(FixUse, Option<PoseChange>)> {
        let steps = (seconds / PERIOD) as usize;
        let rate = |i: usize| 0.4 * (0.01 * i as f64).sin();
        (0..steps).filter_map(|i| self.step(filter, 1.5, rate(i))).collect()
    }

    /// Distance of the estimate from the true position, in m.
    fn error(&self, filter: &PoseFilter) -> f64 {
        (filter.state[0] - self.pose[0]).hypot(filter.state[1] - self.pose[1])
    }

    /// Squared error of the pose, normalised by its covariance.
    fn nees(&self, filter: &PoseFilter) -> f64 {
        let [x, y, theta] = self.pose.map(|part| part as f32);
        filter.estimate().normalized_error(&Pose2::new(x, y, theta)).expect("a covariance")
    }
}

fn move_by(pose: &mut [f64; 3], [x, y]: [f64; 2], turn: f64) {
    let (sin, cos) = (pose[2] + 0.5 * turn).sin_cos();
    *pose = [pose[0] + x * cos - y * sin, pose[1] + x * sin + y * cos, wrapped(pose[2] + turn)];
}

/// Filter of a robot that knows its pose in the world.
fn known(settings: FusionSettings, seed: u64) -> (World, PoseFilter) {
    let mut world = World::new(settings, seed, [5.0, -3.0, 2.0]);
    let mut filter = PoseFilter::new(settings);
    let spread = [world.normal(0.5), world.normal(0.5), world.normal(0.1)];
    let start: [f64; 3] = core::array::from_fn(|i| world.pose[i] + spread[i]);
    filter.begin(&Pose2::new(start[0] as f32, start[1] as f32, start[2] as f32), (0.5, 0.1));
    filter.drive(world.now, &world.wheels());
    filter.turn(world.now, &Inertial::level(world.bias));
    (world, filter)
}

/// Least eigenvalue of a covariance relative to the largest one, and its asymmetry.
fn is_covariance(p: &Matrix) -> bool {
    let values = p.symmetric_eigenvalues();
    values.min() > -1e-12 * values.max() && (p - p.transpose()).abs().max() == 0.0
}

#[test]
fn derivatives_are_those_of_differences() {
    let state = State::from([3.0, -2.0, 2.8, 0.01, 1.04, 0.7, -0.3]);
    let turned = Turned { angle: 0.3, covered: 0.7 };
    let step = Step { time: 1.0, way: [1.4, -0.2], turned, wheels: 0.15 };
    let arm = [-0.4, 0.9];
    let (f, h, d) = (jacobian(&state, &step), position_jacobian(&state, arm), 1e-6);
    for j in 0..STATES {
        let mut sides = [state; 2];
        (sides[0][j], sides[1][j]) = (state[j] - d, state[j] + d);
        let along = (moved(&sides[1], &step) - moved(&sides[0], &step)) / (2.0 * d);
        let seen = (expected_position(&sides[1], arm) - expected_position(&sides[0], arm)) / (2.0 * d);
        assert!((along - f.column(j)).abs().max() < 1e-8, "state {j}: {along} and {}", f.column(j));
        assert!((seen - h.column(j)).abs().max() < 1e-8, "state {j}: {seen} and {}", h.column(j));
    }
}

/// Mean of the normalised squared errors of many runs, each with its own sensors (Bar-Shalom, Li, Kirubarajan 2001,
/// 5.4.2): the sum of 100 runs with 3 degrees of freedom is between 232 and 377 with a probability of 99.8 %.
fn mean_nees(settings: FusionSettings, prepare: fn(&mut World), seconds: f64) -> f64 {
    let sum: f64 = (0..100)
        .map(|seed| {
            let (mut world, mut filter) = known(settings, 1000 + seed);
            prepare(&mut world);
            world.drive(&mut filter, seconds);
            assert!(is_covariance(&filter.covariance));
            world.nees(&filter)
        })
        .sum();
    sum / 100.0
}

#[test]
fn errors_are_as_large_as_they_are_said_to_be() {
    let settings = FusionSettings { gate: 1e3, ..FusionSettings::default() };
    let silent = |world: &mut World| world.jump = f64::NAN;
    let blind = |world: &mut World| (world.has_gyro, world.jump) = (false, f64::NAN);
    for (name, nees) in [
        ("all sensors", mean_nees(settings, |_| (), 60.0)),
        ("wheels and gyroscope", mean_nees(settings, silent, 30.0)),
        ("wheels", mean_nees(settings, blind, 10.0)),
        ("wheels and satellites", mean_nees(settings, |world| world.has_gyro = false, 30.0)),
    ] {
        assert!((2.32..=3.77).contains(&nees), "{name}: {nees}");
    }
}

#[test]
fn refused_fixes_are_few_and_their_errors_are_those_of_two_numbers() {
    let (mut used, mut refused, mut sum) = (0, 0, 0.0);
    for seed in 0..20 {
        let (mut world, mut filter) = known(FusionSettings::default(), seed);
        for (fix, _) in world.drive(&mut filter, 60.0) {
            match fix {
                FixUse::Used(error) => (used, sum) = (used + 1, sum + error),
                FixUse::Refused(_) => refused += 1,
                _ => panic!("{fix:?}"),
            }
        }
    }
    let (share, mean) = (f64::from(refused) / f64::from(used + refused), sum / f64::from(used));
    assert!(share < 0.02 && (1.8..2.1).contains(&mean), "{share} {mean}");
}

#[test]
fn a_jump_of_fixes_is_refused_and_a_lasting_one_is_believed() {
    let settings = FusionSettings { patience: 5.0, ..FusionSettings::default() };
    let (mut world, mut filter) = known(settings, 3);
    world.drive(&mut filter, 60.0);
    let before = world.error(&filter);
    world.jump = 25.0;
    let fixes = world.drive(&mut filter, 4.0);
    assert!(fixes.iter().all(|(fix, change)| matches!(fix, FixUse::Refused(_)) && change.is_none()), "{fixes:?}");
    assert!(world.error(&filter) < before + 1.0, "{before} {}", world.error(&filter));
    world.jump = 0.0;
    assert!(world.drive(&mut filter, 1.0).iter().any(|(fix, _)| matches!(fix, FixUse::Used(_))));
    // Someone has carried it away.
    (world.pose[0], world.pose[1], world.pose[2]) = (200.0, 300.0, -1.0);
    let changes: Vec<PoseChange> =
        world.drive(&mut filter, 40.0).into_iter().filter_map(|(_, change)| change).collect();
    assert_eq!(changes, [PoseChange::Lost, PoseChange::Localized]);
    assert!(world.error(&filter) < 5.0, "{}", world.error(&filter));
}

#[test]
fn the_heading_follows_from_the_motion() {
    let settings = FusionSettings::default();
    let mut nees = 0.0;
    for seed in 0..50 {
        let mut world = World::new(settings, 70 + seed, [100.0, 50.0, 0.1 * seed as f64 - 2.5]);
        let mut filter = PoseFilter::new(settings);
        let fixes = world.drive(&mut filter, 60.0);
        let changes: Vec<PoseChange> = fixes.into_iter().filter_map(|(_, change)| change).collect();
        assert_eq!(changes, [PoseChange::Localized], "seed {seed}");
        let turn = wrapped(filter.state[THETA] - world.pose[2]);
        assert!(turn.abs() < 0.3 && world.error(&filter) < 6.0, "seed {seed}: {turn} {}", world.error(&filter));
        nees += world.nees(&filter) / 50.0;
    }
    assert!((2.0..4.5).contains(&nees), "{nees}");
}

#[test]
fn without_fixes_the_error_grows_as_it_is_said_to() {
    let (mut world, mut filter) = known(FusionSettings::default(), 9);
    world.drive(&mut filter, 120.0);
    let deviations = [0, 1, 2].map(|_| {
        let deviation = filter.estimate().deviation();
        world.jump = f64::NAN;
        world.drive(&mut filter, 60.0);
        deviation
    });
    assert!(deviations[0] < deviations[1] && deviations[1] < deviations[2], "{deviations:?}");
    let error = world.error(&filter);
    assert!(error < 3.0 * f64::from(filter.estimate().deviation()), "{error}");
}

#[test]
fn odometry_does_not_jump() {
    let (mut world, mut filter) = known(FusionSettings::default(), 4);
    let (mut before, mut longest) = (filter.odometry(), [0.0_f32; 2]);
    for i in 0..2000 {
        let pose = filter.estimate().pose;
        world.jump = if i % 50 < 25 { 2.0 } else { 0.0 };
        world.step(&mut filter, 1.5, 0.1);
        let (odometry, after) = (filter.odometry(), filter.estimate().pose);
        let steps = [(odometry, before), (after, pose)].map(|(a, b)| (a.position() - b.position()).norm());
        longest = [longest[0].max(steps[0]), longest[1].max(steps[1])];
        before = odometry;
    }
    assert!(longest[0] < 0.1 && longest[1] > longest[0], "{longest:?}");
}

#[test]
fn a_robot_that_stands_learns_the_bias_and_does_not_turn() {
    let settings = FusionSettings { bias_spread: 0.02, ..FusionSettings::default() };
    let (mut world, mut filter) = known(settings, 5);
    world.jump = f64::NAN;
    for _ in 0..400 {
        world.step(&mut filter, 0.0, 0.0);
    }
    assert!((filter.state[BIAS] - world.bias).abs() < 1e-3, "{} {}", filter.state[BIAS], world.bias);
    let before = filter.state[THETA];
    let certain = filter.covariance[(THETA, THETA)];
    for _ in 0..1200 {
        world.step(&mut filter, 0.0, 0.0);
    }
    // One measurement in a thousand is taken for a turn.
    let grown = filter.covariance[(THETA, THETA)] - certain;
    assert!((filter.state[THETA] - before).abs() < 3e-3 && grown < 1e-6, "{grown}");
    // Something turns it, although its wheels stand.
    let wheels = world.wheels();
    for i in 1..=20 {
        world.now += core::time::Duration::from_millis(50);
        filter.turn(world.now, &Inertial::level(0.5));
        filter.drive(world.now, &wheels);
        assert!((filter.state[BIAS] - world.bias).abs() < 2e-3, "{i}");
    }
    assert!((filter.state[THETA] - before - 0.5).abs() < 0.03, "{}", filter.state[THETA] - before);
}

#[test]
fn the_length_of_a_metre_is_learned() {
    let (mut world, mut filter) = known(FusionSettings::default(), 6);
    world.scale = 0.93;
    world.drive(&mut filter, 400.0);
    assert!((filter.state[SCALE] - 0.93).abs() < 0.01, "{}", filter.state[SCALE]);
}

#[test]
fn fixes_count_for_their_time_and_the_place_of_the_antenna() {
    let antenna = Point2::new(-0.3, 0.2);
    let settings = FusionSettings { antenna, wander: 0.0, fix_noise: 0.01, ..FusionSettings::default() };
    let mut filter = PoseFilter::new(settings);
    filter.begin(&Pose2::default(), (1.0, 0.3));
    let at = |ms: i64| {
        let s = 1e-3 * ms as f32;
        Pose2::new(2.0 * s.sin(), 2.0 - 2.0 * s.cos(), s)
    };
    for ms in (0..20_000).step_by(50) {
        let now = Time::from_millis(ms);
        filter.turn(now, &Inertial::level(1.0));
        let p = at(ms);
        filter.drive(now, &Pose2::new(p.x, p.y, crate::scan::wrap_angle(p.theta)));
        if ms % 200 == 0 && ms >= 1000 {
            let stamp = Time::from_millis(ms - 330);
            let fix = PositionFix { stamp, position: at(ms - 330).to_outer(antenna), variance: 0.0 };
            assert!(matches!(filter.fix(&fix).0, FixUse::Used(error) if error < 4.0), "{ms}");
        }
    }
    let (pose, end) = (filter.estimate().pose, at(19_950));
    assert!((pose.position() - end.position()).norm() < 0.02, "{pose:?} {end:?}");
    for stamp in [Time::from_secs(10), Time::from_secs(21)] {
        let fix = PositionFix { stamp, ..PositionFix::default() };
        assert_eq!(filter.fix(&fix), (FixUse::Unusable, None), "too old, and of the future");
    }
}

#[test]
fn odd_measurements_do_no_harm() {
    let (mut world, mut filter) = known(FusionSettings::default(), 8);
    world.drive(&mut filter, 30.0);
    let before = filter.clone();
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30] {
        assert!(!filter.drive(world.now + core::time::Duration::from_millis(50), &Pose2::new(odd, 0.0, 0.0)));
        assert!(!filter.drive(world.now + core::time::Duration::from_millis(50), &Pose2::new(0.0, 0.0, odd)));
        filter.turn(world.now + core::time::Duration::from_millis(5), &Inertial::level(f64::from(odd)));
        let fix = PositionFix { stamp: world.now, position: Point2::new(0.0, odd), variance: 0.0 };
        assert_eq!(filter.fix(&fix), (FixUse::Unusable, None));
        assert_eq!(filter.begin(&Pose2::new(0.0, odd, 0.0), (1.0, 1.0)), None);
    }
    for variance in [f32::NAN, f32::INFINITY, -1.0, 0.0] {
        let fix = PositionFix { variance, ..world.fix() };
        assert!(matches!(filter.fix(&fix).0, FixUse::Used(_)), "{variance}");
    }
    assert!(!filter.drive(world.now, &world.wheels()), "at the same time");
    assert!(!filter.drive(Time::ZERO, &world.wheels()), "in the past");
    assert_eq!(filter.odometry(), before.odometry());
    assert!(filter.state.iter().all(|value| value.is_finite()) && is_covariance(&filter.covariance));
    // A pause of a week, and wheels that jump: the robot may be anywhere.
    for jump in [0.0, 5e4, -5e4, 0.0] {
        world.now += core::time::Duration::from_secs(if jump == 0.0 { 604_800 } else { 1 });
        assert!(filter.drive(world.now, &Pose2::new(jump, jump, PI)));
    }
    assert!(filter.state.iter().all(|value| value.is_finite()) && is_covariance(&filter.covariance));
    let unsure = filter.estimate().deviation();
    assert!(unsure > 5.0, "{unsure}");
    let fix = PositionFix { stamp: world.now, position: Point2::new(9.0, 9.0), variance: 0.0 };
    filter.fix(&fix);
    assert!(filter.state.iter().all(|value| value.is_finite()));
}

#[test]
fn a_gap_of_the_wheels_is_driven_later() {
    let settings = FusionSettings::default();
    let mut filter = PoseFilter::new(settings);
    let ms = Time::from_millis;
    filter.drive(ms(0), &Pose2::default());
    for t in (0..=2000).step_by(10) {
        filter.turn(ms(t), &Inertial::level(0.5 * f64::from(FRAC_PI_2)));
    }
    filter.drive(ms(2000), &Pose2::new(1.0, 0.0, 0.0));
    let pose = filter.odometry();
    assert!((pose.theta - FRAC_PI_2).abs() < 1e-3, "the turn is that of the gyroscope: {pose:?}");
    assert!((pose.position().norm() - 1.0).abs() < 1e-3 && (pose.x - pose.y).abs() < 1e-3, "{pose:?}");
}

#[test]
fn the_same_measurements_give_the_same_pose() {
    let run = || {
        let (mut world, mut filter) = known(FusionSettings::default(), 11);
        world.drive(&mut filter, 20.0);
        (filter.state, filter.covariance)
    };
    assert_eq!(run(), run());
}
