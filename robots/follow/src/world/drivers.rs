use super::{FaultKind, Field, State};
use apex_nodes::{
    cloud::RingCloud,
    frames::Pose3,
    localize::{GeoFix, Inertial},
    nav::Twist,
    persons::{Detections, MAX_DETECTIONS, Person, View},
    scan::Pose2,
};
use apex_rt::{Ctx, Event, Out, Time, node};
use apex_sim::{
    Latency, Random,
    outdoor::{self, GnssErrors, RingScanner, Sample, StereoDetector, Surface},
};
use std::{collections::VecDeque, time::Duration};

/// Duration of a turn.
const TURN: Duration = Duration::from_millis(100);
/// Time between two images, and time until the persons in one are found.
const IMAGES: Duration = Duration::from_millis(200);
const LATENCY: Duration = Duration::from_millis(150);
/// Error of positions while the receiver has the fault of a jump, in m.
const JUMP: f64 = 20.0;

/// Laser scanner with 16 rings on the mast: a source of turns. It sends ⊥ when it fires within a turn.
#[node]
#[derive(Debug)]
pub struct Scanner {
    field: Field,
    scanner: RingScanner,
    random: Random,
    truth: Vec<Surface>,
    due: Time,
}

#[node]
impl Scanner {
    /// Creates the scanner of the robot in a world.
    pub fn new(field: &Field) -> Self {
        let random = field.present().stream(10);
        Self { field: field.clone(), scanner: RingScanner::default(), random, truth: vec![], due: Time::ZERO + TURN }
    }

    fn process(&mut self, ctx: &Ctx, turn: &mut Out<RingCloud>) {
        if ctx.now() < self.due {
            return;
        }
        self.due = ctx.now() + TURN;
        let mut field = self.field.at(ctx.now());
        let samples = field.samples().to_vec();
        let Self { scanner, random, truth, .. } = self;
        scanner.measure(&field.terrain, &samples, field.people(), ctx.now(), random, turn.get_mut(), truth);
    }
}

/// Odometry of the base: a source of the pose by its wheels and its own gyroscope, with the inclination of the robot.
#[node]
#[derive(Debug)]
pub struct Odometry {
    field: Field,
}

#[node]
impl Odometry {
    /// Creates the odometry of the robot in a world.
    pub fn new(field: &Field) -> Self {
        Self { field: field.clone() }
    }

    fn process(&mut self, ctx: &Ctx) -> Pose3 {
        self.field.at(ctx.now()).odometry()
    }
}

/// Wheels: a source of the pose that they sum up. They know nothing of slip.
#[node]
#[derive(Debug)]
pub struct Wheels {
    field: Field,
}

#[node]
impl Wheels {
    /// Creates the wheels of the robot in a world.
    pub fn new(field: &Field) -> Self {
        Self { field: field.clone() }
    }

    fn process(&mut self, ctx: &Ctx) -> Option<Pose2> {
        let field = self.field.at(ctx.now());
        (!field.has_fault(FaultKind::WheelsSilent)).then(|| field.wheels())
    }
}

/// Inertial sensor: a source of the mean angular velocity since the last firing, and of the inclination.
#[node]
#[derive(Debug)]
pub struct Imu {
    field: Field,
    imu: outdoor::Imu,
    last: Option<(Time, Sample)>,
}

#[node]
impl Imu {
    /// Creates the inertial sensor of the robot in a world.
    pub fn new(field: &Field) -> Self {
        Self { field: field.clone(), imu: field.present().imu(), last: None }
    }

    fn process(&mut self, ctx: &Ctx) -> Option<Inertial> {
        let now = ctx.now();
        let mut field = self.field.at(now);
        let after = *field.samples().last()?;
        let (then, before) = self.last.replace((now, after))?;
        let dt = now.since(then).as_secs_f32();
        let measured = (dt > 0.0).then(|| self.imu.measure(&before, &after, dt))?;
        let is_odd = field.has_fault(FaultKind::GyroNan);
        Some(if is_odd { Inertial { angular_velocity: [f64::NAN; 3], ..measured } } else { measured })
    }
}

/// Receiver of satellite navigation: a source of positions, five in a second, each 0.12 s after its measurement. The
/// world's x axis points to the east.
#[node]
#[derive(Debug)]
pub struct Gnss {
    field: Field,
    gnss: outdoor::Gnss,
    waiting: Latency<GeoFix>,
}

#[node]
impl Gnss {
    /// Creates the receiver of the robot in a world.
    pub fn new(field: &Field) -> Self {
        Self { field: field.clone(), gnss: field.present().gnss(), waiting: Latency::default() }
    }

    fn process(&mut self, ctx: &Ctx) -> Option<GeoFix> {
        let now = ctx.now();
        let field = self.field.at(now);
        if let Some(fix) = self.gnss.measure(&field.terrain, field.pose().position(), now) {
            let fix = GeoFix { has_position: fix.has_position && !field.has_fault(FaultKind::GnssSilent), ..fix };
            let fix = if field.has_fault(FaultKind::GnssJump) { jumped(&fix) } else { fix };
            self.waiting.send(now + GnssErrors::NEO_M8.latency, fix);
        }
        self.waiting.receive(now)
    }
}

/// Fix farther to the east.
fn jumped(fix: &GeoFix) -> GeoFix {
    let plane = State::plane();
    let [x, y] = plane.position(fix.latitude.to_radians(), fix.longitude.to_radians());
    let [latitude, longitude] = plane.geodetic([x + JUMP, y]).map(f64::to_degrees);
    GeoFix { latitude, longitude, ..*fix }
}

/// Detector of persons in the images of the stereo camera: a source that triggers an event for each image, when the
/// persons in it have been found. They are in the frame of the robot at the time of the image.
#[node]
#[derive(Debug)]
pub struct Camera {
    field: Field,
    detector: StereoDetector,
    random: Random,
    due: Time,
    waiting: VecDeque<Detections>,
}

#[node]
impl Camera {
    /// Creates the camera of the robot in a world.
    pub fn new(field: &Field) -> Self {
        let random = field.present().stream(11);
        Self {
            field: field.clone(),
            detector: StereoDetector::default(),
            random,
            due: Time::ZERO,
            waiting: VecDeque::new(),
        }
    }

    fn process(&mut self, ctx: &Ctx, persons: Event<Detections>) {
        let now = ctx.now();
        if now >= self.due {
            self.due = now + IMAGES;
            let field = self.field.at(now);
            let [nearest, range] = self.detector.ranges;
            let view = View { pose: Pose2::default(), angle: self.detector.view, nearest, range };
            let pose = field.pose();
            let found = self.detector.detect(&field.terrain, &pose, field.people(), &mut self.random);
            let positions = found.take(MAX_DETECTIONS).collect();
            self.waiting.push_back(Detections { stamp: now, view, positions });
        }
        if self.waiting.front().is_some_and(|image| now >= image.stamp + LATENCY)
            && let Some(image) = self.waiting.pop_front()
        {
            persons.emit(image);
        }
    }
}

/// Motors: a sink. They brake if no twist comes for 0.3 s.
#[node]
#[derive(Debug)]
pub struct Motors {
    field: Field,
}

#[node]
impl Motors {
    /// Creates the motors of the robot in a world.
    pub fn new(field: &Field) -> Self {
        Self { field: field.clone() }
    }

    /// Sets the desired twist.
    #[slot]
    fn drive(&mut self, twist: &Twist, ctx: &Ctx) {
        self.field.at(ctx.now()).drive(*twist);
    }
}

/// Referee: a sink, to which the robot says where it believes the runner and itself to be.
#[node]
#[derive(Debug)]
pub struct Judge {
    field: Field,
}

#[node]
impl Judge {
    /// Creates the referee of a world.
    pub fn new(field: &Field) -> Self {
        Self { field: field.clone() }
    }

    fn process(&mut self, ctx: &Ctx, pose: &Pose2, global: Option<&Pose2>, target: Option<&Person>) {
        let mut field = self.field.at(ctx.now());
        field.judge(target, pose);
        if let Some(global) = global {
            field.locate(global);
        }
    }
}
