use super::Field;
use apex_nodes::{
    cloud::RingCloud,
    frames::Pose3,
    nav::Twist,
    persons::{Detections, MAX_DETECTIONS, Person, View},
    scan::Pose2,
};
use apex_rt::{Ctx, Event, Out, Time, node};
use apex_sim::{
    Random,
    outdoor::{RingScanner, StereoDetector, Surface},
};
use std::{collections::VecDeque, time::Duration};

/// Duration of a turn.
const TURN: Duration = Duration::from_millis(100);
/// Time between two images, and time until the persons in one are found.
const IMAGES: Duration = Duration::from_millis(200);
const LATENCY: Duration = Duration::from_millis(150);

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

/// Wheels and inertial sensor: a source of the pose in the frame of odometry, with the inclination of the robot.
#[node]
#[derive(Debug)]
pub struct Wheels {
    field: Field,
}

#[node]
impl Wheels {
    /// Creates the odometry of the robot in a world.
    pub fn new(field: &Field) -> Self {
        Self { field: field.clone() }
    }

    fn process(&mut self, ctx: &Ctx) -> Pose3 {
        self.field.at(ctx.now()).odometry()
    }
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

/// Referee: a sink, to which the robot says where it believes the runner to be.
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

    fn process(&mut self, ctx: &Ctx, pose: &Pose2, target: Option<&Person>) {
        self.field.at(ctx.now()).judge(target, pose);
    }
}
