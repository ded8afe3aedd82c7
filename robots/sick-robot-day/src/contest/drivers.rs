use super::{FaultKind, Hall, START};
use crate::LASER;
use apex_nodes::{
    image::{Camera, GrayImage},
    nav::Twist,
    scan::{Pose2, Scan},
};
use apex_rt::{Ctx, Out, node};
use apex_sim::{CameraSim, Laser, Random};
use std::f32::consts::PI;

/// All drivers of a robot in a hall.
#[derive(Debug)]
pub struct Drivers {
    /// Scanner at the front.
    pub front_laser: FrontLaser,
    /// Scanner at the rear.
    pub rear_laser: RearLaser,
    /// Wheel odometry.
    pub wheel_odometry: WheelOdometry,
    /// Camera at the front.
    pub front_camera: FrontCamera,
    /// Camera above the hopper.
    pub hopper_camera: HopperCamera,
    /// Remote control.
    pub remote: Remote,
    /// Motors.
    pub base: Base,
    /// Green lamp.
    pub lamp: Lamp,
}

impl Drivers {
    /// Creates the drivers of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self {
            front_laser: FrontLaser::new(hall),
            rear_laser: RearLaser::new(hall),
            wheel_odometry: WheelOdometry::new(hall),
            front_camera: FrontCamera::new(hall),
            hopper_camera: HopperCamera::new(hall),
            remote: Remote::new(hall),
            base: Base::new(hall),
            lamp: Lamp::new(hall),
        }
    }
}

/// Front scanner, an LMS100: a source of scans over 270° at the origin of the robot, centred about its x axis.
#[node]
#[derive(Debug)]
pub struct FrontLaser {
    hall: Hall,
    random: Random,
    faults: Random,
}

#[node]
impl FrontLaser {
    /// Creates the scanner of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        let contest = hall.contest();
        Self { random: contest.stream(30), faults: contest.stream(31), hall: hall.clone() }
    }

    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>) {
        let contest = self.hall.at(ctx.now());
        if contest.has(FaultKind::LaserFrozen) {
            return;
        }
        let token = scan.get_mut();
        token.stamp = ctx.now();
        LASER.measure(&contest.arena().world, &contest.robots()[0].pose, &mut self.random, token);
        let spoilers = FaultKind::OF_BEAMS.into_iter().filter(|kind| contest.has(*kind));
        spoilers.for_each(|kind| kind.spoil(token, &mut self.faults));
    }
}

/// Rear scanner, a TiM551: a source of scans over 270° in the frame of the scanner, which is at the origin of the
/// robot and faces backwards. Its mount is (0, 0, π).
#[node]
#[derive(Debug)]
pub struct RearLaser {
    hall: Hall,
    random: Random,
}

#[node]
impl RearLaser {
    /// Creates the scanner of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { random: hall.contest().stream(32), hall: hall.clone() }
    }

    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>) {
        let contest = self.hall.at(ctx.now());
        let pose = contest.robots()[0].pose.compose(&Pose2::new(0.0, 0.0, PI));
        let token = scan.get_mut();
        token.stamp = ctx.now();
        Laser::TIM551.measure(&contest.arena().world, &pose, &mut self.random, token);
    }
}

/// Wheel odometry: a source of the pose according to the wheels. It starts at the origin of a frame of its own and
/// drifts.
#[node]
#[derive(Debug)]
pub struct WheelOdometry {
    hall: Hall,
    last: Pose2,
}

#[node]
impl WheelOdometry {
    /// Creates the wheel odometry of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { hall: hall.clone(), last: Pose2::default() }
    }

    fn process(&mut self, ctx: &Ctx, pose: &mut Out<Pose2>) {
        let contest = self.hall.at(ctx.now());
        if !contest.has(FaultKind::OdometryStopped) {
            self.last = contest.wheels();
        }
        pose.set(self.last);
    }
}

/// Front camera: a source of images of 960×720 pixels, and of the [`camera`](crate::camera) that took them.
#[node]
#[derive(Debug)]
pub struct FrontCamera {
    hall: Hall,
    camera: CameraSim,
    random: Random,
    /// `true` if the last torn image had pixels.
    torn: bool,
}

#[node]
impl FrontCamera {
    /// Creates the camera of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        let random = hall.contest().stream(33);
        Self { hall: hall.clone(), camera: hall.camera(), random, torn: false }
    }

    fn process(&mut self, ctx: &Ctx, image: &mut Out<GrayImage>, camera: &mut Out<Camera>) {
        let contest = self.hall.at(ctx.now());
        let intrinsics = crate::camera();
        camera.set(intrinsics);
        let token = image.get_mut();
        if contest.has(FaultKind::CameraTorn) {
            self.torn = !self.torn;
            token.reset(ctx.now(), if self.torn { (17, 3) } else { (0, 0) });
        } else if contest.has(FaultKind::CameraBlack) {
            token.reset(ctx.now(), (intrinsics.width, intrinsics.height));
        } else {
            let (robot, scene) = (contest.robots()[0], &contest.arena().scene);
            let Self { camera, random, .. } = self;
            camera.take(scene, &robot.pose, &robot.twist, contest.light(), ctx.now(), random, token);
        }
    }
}

/// Camera above the hopper: a source of images.
#[node]
#[derive(Debug)]
pub struct HopperCamera {
    hall: Hall,
    random: Random,
}

#[node]
impl HopperCamera {
    /// Creates the camera of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { random: hall.contest().stream(34), hall: hall.clone() }
    }

    fn process(&mut self, ctx: &Ctx, image: &mut Out<GrayImage>) {
        let photo = self.hall.at(ctx.now()).hopper().photo(&mut self.random);
        image.set(GrayImage { stamp: ctx.now(), ..photo });
    }
}

/// Remote control of the referee: a source of words, "ready" until the start, then "go" once, and ⊥ from then on.
#[node]
#[derive(Debug)]
pub struct Remote {
    hall: Hall,
    gone: bool,
}

#[node]
impl Remote {
    /// Creates the remote control in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { hall: hall.clone(), gone: false }
    }

    fn process(&mut self, ctx: &Ctx, word: &mut Out<String>) {
        self.hall.advance(ctx.now());
        if self.gone {
            return;
        }
        self.gone = ctx.now() >= START;
        word.set(if self.gone { "go" } else { "ready" }.to_owned());
    }
}

/// Motors: a sink. They brake if they receive no twist for 0.3 s.
#[node]
#[derive(Debug)]
pub struct Base {
    hall: Hall,
}

#[node]
impl Base {
    /// Creates the motors of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { hall: hall.clone() }
    }

    /// Sets the desired twist, which the motors follow within their limits.
    #[slot]
    fn drive(&mut self, twist: &Twist, ctx: &Ctx) {
        self.hall.drive(ctx.now(), *twist);
    }
}

/// Green lamp that asks the operators to put in a cube or to take it out: a sink.
#[node]
#[derive(Debug)]
pub struct Lamp {
    hall: Hall,
}

#[node]
impl Lamp {
    /// Creates the lamp of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { hall: hall.clone() }
    }

    /// Switches the lamp on or off.
    #[slot]
    fn set(&mut self, on: &bool, ctx: &Ctx) {
        self.hall.set_lamp(ctx.now(), *on);
    }
}
