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

/// All drivers of a robot in a hall. A driver that is made without a hall gets it as a token, and is silent before.
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
    /// Hall, and random numbers of the measurements and of the faults.
    place: Option<(Hall, Random, Random)>,
    last: Scan,
}

#[node]
impl FrontLaser {
    /// Creates the scanner of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        let contest = hall.contest();
        Self { place: Some((hall.clone(), contest.stream(30), contest.stream(31))), last: Scan::default() }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>) {
        let Some((hall, random, faults)) = &mut self.place else { return };
        let contest = hall.at(ctx.now());
        if contest.has(FaultKind::LaserFrozen) {
            return;
        }
        let token = scan.get_mut();
        if contest.has(FaultKind::LaserRepeated) {
            token.clone_from(&self.last);
            return;
        }
        token.stamp = ctx.now();
        LASER.measure(&contest.arena().world, &contest.robots()[0].pose, random, token);
        self.last.clone_from(token);
        let spoilers = FaultKind::OF_BEAMS.into_iter().filter(|kind| contest.has(*kind));
        spoilers.for_each(|kind| kind.spoil(token, faults));
    }
}

/// Rear scanner, a TiM551: a source of scans over 270° in the frame of the scanner, which is at the origin of the
/// robot and faces backwards. Its mount is (0, 0, π).
#[node]
#[derive(Debug)]
pub struct RearLaser {
    place: Option<(Hall, Random)>,
}

#[node]
impl RearLaser {
    /// Creates the scanner of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { place: Some((hall.clone(), hall.contest().stream(32))) }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>) {
        let Some((hall, random)) = &mut self.place else { return };
        let contest = hall.at(ctx.now());
        if contest.has(FaultKind::RearFrozen) {
            return;
        }
        let pose = contest.robots()[0].pose.compose(&Pose2::new(0.0, 0.0, PI));
        let token = scan.get_mut();
        token.stamp = ctx.now();
        Laser::TIM551.measure(&contest.arena().world, &pose, random, token);
    }
}

/// Wheel odometry: a source of the pose according to the wheels. It starts at the origin of a frame of its own and
/// drifts.
#[node]
#[derive(Debug)]
pub struct WheelOdometry {
    place: Option<Hall>,
    last: Pose2,
}

#[node]
impl WheelOdometry {
    /// Creates the wheel odometry of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { place: Some(hall.clone()), last: Pose2::default() }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    fn process(&mut self, ctx: &Ctx, pose: &mut Out<Pose2>) {
        let Some(hall) = &self.place else { return };
        let contest = hall.at(ctx.now());
        if contest.has(FaultKind::OdometrySilent) {
            return;
        }
        if !contest.has(FaultKind::OdometryStopped) {
            self.last = contest.wheels();
        }
        pose.set(if contest.has(FaultKind::OdometryNan) { Pose2 { x: f32::NAN, ..self.last } } else { self.last });
    }
}

/// Front camera: a source of images of 960×720 pixels, and of the [`camera`](crate::camera) that took them.
#[node]
#[derive(Debug)]
pub struct FrontCamera {
    place: Option<(Hall, CameraSim, Random)>,
    /// `true` if the last torn image had pixels.
    torn: bool,
}

#[node]
impl FrontCamera {
    /// Creates the camera of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        let random = hall.contest().stream(33);
        Self { place: Some((hall.clone(), hall.camera(), random)), torn: false }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    fn process(&mut self, ctx: &Ctx, image: &mut Out<GrayImage>, camera: &mut Out<Camera>) {
        let Some((hall, simulated, random)) = &mut self.place else { return };
        let contest = hall.at(ctx.now());
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
            simulated.take(scene, &robot.pose, &robot.twist, contest.light(), ctx.now(), random, token);
        }
    }
}

/// Camera above the hopper: a source of images.
#[node]
#[derive(Debug)]
pub struct HopperCamera {
    place: Option<(Hall, Random)>,
}

#[node]
impl HopperCamera {
    /// Creates the camera of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { place: Some((hall.clone(), hall.contest().stream(34))) }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    fn process(&mut self, ctx: &Ctx, image: &mut Out<GrayImage>) {
        let Some((hall, random)) = &mut self.place else { return };
        let photo = hall.at(ctx.now()).hopper().photo(random);
        image.set(GrayImage { stamp: ctx.now(), ..photo });
    }
}

/// Remote control of the referee: a source of words, "ready" until the start, then "go" once, and ⊥ from then on.
#[node]
#[derive(Debug)]
pub struct Remote {
    place: Option<Hall>,
    gone: bool,
}

#[node]
impl Remote {
    /// Creates the remote control in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { place: Some(hall.clone()), gone: false }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    fn process(&mut self, ctx: &Ctx, word: &mut Out<String>) {
        let Some(hall) = &self.place else { return };
        hall.advance(ctx.now());
        if self.gone {
            return;
        }
        self.gone = ctx.now() >= START;
        word.set(if self.gone { "go" } else { "ready" }.to_owned());
    }
}

/// Motors: a sink. They brake if they receive no twist for 0.3 s, unless the hall has no command time-out.
#[node]
#[derive(Debug)]
pub struct Base {
    place: Option<Hall>,
}

#[node]
impl Base {
    /// Creates the motors of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { place: Some(hall.clone()) }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    /// Sets the desired twist, which the motors follow within their limits.
    #[slot]
    fn drive(&mut self, twist: &Twist, ctx: &Ctx) {
        if let Some(hall) = &self.place {
            hall.drive(ctx.now(), *twist);
        }
    }
}

/// Green lamp that asks the operators to put in a cube or to take it out: a sink.
#[node]
#[derive(Debug)]
pub struct Lamp {
    place: Option<Hall>,
}

#[node]
impl Lamp {
    /// Creates the lamp of our robot in `hall`.
    pub fn new(hall: &Hall) -> Self {
        Self { place: Some(hall.clone()) }
    }

    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        *self = Self::new(hall);
    }

    /// Switches the lamp on or off.
    #[slot]
    fn set(&mut self, on: &bool, ctx: &Ctx) {
        if let Some(hall) = &self.place {
            hall.set_lamp(ctx.now(), *on);
        }
    }
}
