use super::{Clinic, DOCK, FaultKind, State};
use crate::Order;
use apex_nodes::{
    cloud::{CloudPoint, PointCloud},
    nav::Twist,
    scan::{Pose2, Scan},
};
use apex_rt::{Ctx, Event, Out, Time, node};
use apex_sim::{
    Laser, Latency, Random,
    tof::{Distortion, Floor, Space, TofCamera, TofFrame},
};
use core::f32::consts::PI;
use std::time::Duration;

/// All drivers of the vehicle in a clinic.
#[derive(Debug)]
pub struct Drivers {
    /// Laser scanner.
    pub scanner: Scanner,
    /// Laser scanner that looks backward.
    pub rear: RearScanner,
    /// Wheels and hitch.
    pub wheels: Wheels,
    /// Time-of-flight camera.
    pub camera: Camera,
    /// Motors.
    pub motors: Motors,
    /// Lift.
    pub lift: LiftDrive,
    /// Orders.
    pub dispatch: Dispatch,
}

impl Drivers {
    /// Creates the drivers of the vehicle in `clinic`.
    pub fn new(clinic: &Clinic) -> Self {
        Self {
            scanner: Scanner::new(clinic),
            rear: RearScanner::new(clinic),
            wheels: Wheels::new(clinic),
            camera: Camera::new(clinic),
            motors: Motors::new(clinic),
            lift: LiftDrive::new(clinic),
            dispatch: Dispatch::new(clinic),
        }
    }
}

/// Safety scanner: a source of scans over 270° at the axis of the tractor, 6 cm above the floor.
#[node]
#[derive(Debug)]
pub struct Scanner {
    clinic: Clinic,
    random: Random,
    sent: Latency<Scan>,
}

#[node]
impl Scanner {
    /// Creates the scanner of the vehicle in `clinic`.
    pub fn new(clinic: &Clinic) -> Self {
        Self { random: clinic.present().stream(30), clinic: clinic.clone(), sent: Latency::default() }
    }

    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>) {
        let mut clinic = self.clinic.at(ctx.now());
        if !clinic.has(FaultKind::ScannerFrozen) {
            let tractor = clinic.past()[0].clone();
            let mut turn = turn(&mut clinic, ctx.now(), |age| tractor.before(age), &mut self.random);
            for (kind, range) in [(FaultKind::ScannerNan, f32::NAN), (FaultKind::ScannerInfinite, f32::INFINITY)] {
                if clinic.has(kind) {
                    turn.ranges.fill(range);
                }
            }
            self.sent.send(ctx.now() + clinic.conditions().scan_latency, turn);
        }
        if let Some(arrived) = self.sent.receive(ctx.now()) {
            scan.set(arrived);
        }
    }
}

/// Safety scanner on the trailer: a source of scans over 270° at its axis, 6 cm above the floor.
#[node]
#[derive(Debug)]
pub struct RearScanner {
    clinic: Clinic,
    random: Random,
    sent: Latency<Scan>,
}

#[node]
impl RearScanner {
    /// Creates the scanner on the trailer of the vehicle in `clinic`.
    pub fn new(clinic: &Clinic) -> Self {
        Self { random: clinic.present().stream(32), clinic: clinic.clone(), sent: Latency::default() }
    }

    /// Sends scans whose x axis points backward.
    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>) {
        let mut clinic = self.clinic.at(ctx.now());
        if !clinic.has(FaultKind::RearFrozen) {
            let trailer = clinic.past()[1].clone();
            let pose = |age| trailer.before(age).compose(&Pose2::new(0.0, 0.0, PI));
            let mut turn = turn(&mut clinic, ctx.now(), pose, &mut self.random);
            if clinic.has(FaultKind::RearNan) {
                turn.ranges.fill(f32::NAN);
            }
            self.sent.send(ctx.now() + clinic.conditions().scan_latency, turn);
        }
        if let Some(arrived) = self.sent.receive(ctx.now()) {
            scan.set(arrived);
        }
    }
}

/// Scan of a turn that ends now. `pose` gives the pose of the scanner at an age in s.
fn turn(clinic: &mut State, now: Time, pose: impl Fn(f32) -> Pose2, random: &mut Random) -> Scan {
    let laser = Laser { turn: clinic.conditions().scan_turn.as_secs_f32(), ..Laser::S300 };
    let sweep = laser.sweep_time();
    let mut scan = Scan { stamp: now - Duration::from_secs_f32(sweep), ..Scan::default() };
    laser.sweep(clinic.scanned(), |time| pose(sweep - time), random, &mut scan);
    scan
}

/// Wheel odometry and the angle of the hitch: a source.
#[node]
#[derive(Debug)]
pub struct Wheels {
    clinic: Clinic,
    last: Pose2,
}

#[node]
impl Wheels {
    /// Creates the odometry of the vehicle in `clinic`.
    pub fn new(clinic: &Clinic) -> Self {
        Self { clinic: clinic.clone(), last: Pose2::default() }
    }

    /// Sends the poses of the axes of tractor and trailer, in the frame of odometry, and the place where the vehicle
    /// begins on the plan.
    fn process(&mut self, ctx: &Ctx, odometry: &mut Out<Pose2>, trailer: &mut Out<Pose2>, dock: &mut Out<Pose2>) {
        let clinic = self.clinic.at(ctx.now());
        if !clinic.has(FaultKind::OdometryStopped) {
            self.last = clinic.wheels();
        }
        if ctx.now() == Time::ZERO {
            dock.set(DOCK);
        }
        if clinic.has(FaultKind::OdometrySilent) {
            return;
        }
        let is_nan = clinic.has(FaultKind::OdometryNan);
        let pose = if is_nan { Pose2 { x: f32::NAN, ..self.last } } else { self.last };
        odometry.set(pose);
        trailer.set(pose.compose(&clinic.trailer().relative_to(&clinic.pose())));
    }
}

/// Time between two clouds.
const CLOUDS: Duration = Duration::from_millis(240);

/// Time-of-flight camera, 10 cm above the axis of the tractor: a source of clouds every 240 ms. It sends ⊥ when it
/// fires in between, so that scans and odometry, with which clouds are compared, are not as rare as clouds.
#[node]
#[derive(Debug)]
pub struct Camera {
    clinic: Clinic,
    camera: TofCamera,
    random: Random,
    space: Space,
    frame: TofFrame,
    /// Time of the next cloud.
    due: Time,
}

#[node]
impl Camera {
    /// Creates the camera of the vehicle in `clinic`, with static errors of its own.
    pub fn new(clinic: &Clinic) -> Self {
        let mut random = clinic.present().stream(31);
        let camera = TofCamera { rays: 2, distortion: Distortion::random(&mut random), ..TofCamera::default() };
        let space = Space::new(Floor { variation: 0.1, ..Floor::default() });
        Self { clinic: clinic.clone(), camera, random, space, frame: TofFrame::default(), due: Time::ZERO }
    }

    fn process(&mut self, ctx: &Ctx, cloud: &mut Out<PointCloud>) {
        if ctx.now() < self.due {
            return;
        }
        self.due = ctx.now() + CLOUDS;
        let clinic = self.clinic.at(ctx.now());
        if clinic.has(FaultKind::CameraFrozen) {
            cloud.get_mut().clone_from(&self.frame.cloud);
            return;
        }
        self.space.clear();
        clinic.fill(&mut self.space);
        self.camera.take(&self.space, &clinic.pose(), ctx.now(), &mut self.random, &mut self.frame);
        let token = cloud.get_mut();
        token.clone_from(&self.frame.cloud);
        if clinic.has(FaultKind::CameraBlack) {
            token.points_mut().fill(CloudPoint::MISSING);
        }
        if clinic.has(FaultKind::CameraNan) {
            token.points_mut().fill(CloudPoint { intensity: f32::NAN, ..CloudPoint::MISSING });
        }
    }
}

/// Motors: a sink. They brake if they receive no twist for the command time-out of the clinic.
#[node]
#[derive(Debug)]
pub struct Motors {
    clinic: Clinic,
}

#[node]
impl Motors {
    /// Creates the motors of the vehicle in `clinic`.
    pub fn new(clinic: &Clinic) -> Self {
        Self { clinic: clinic.clone() }
    }

    /// Sets the desired twist, which the motors follow within their limits.
    #[slot]
    fn drive(&mut self, twist: &Twist, ctx: &Ctx) {
        self.clinic.at(ctx.now()).drive(*twist);
    }
}

/// Drive of the lift: a source with slots.
#[node]
#[derive(Debug)]
pub struct LiftDrive {
    clinic: Clinic,
    /// End that the lift has been told to move to, until it is there.
    target: Option<bool>,
}

#[node]
impl LiftDrive {
    /// Creates the lift of the vehicle in `clinic`.
    pub fn new(clinic: &Clinic) -> Self {
        Self { clinic: clinic.clone(), target: None }
    }

    /// Sends `true` while a container presses the switch on the lift. `done` comes when the lift arrives at the end
    /// that it was told to move to.
    fn process(&mut self, ctx: &Ctx, is_loaded: &mut Out<bool>, done: Event<()>) {
        let clinic = self.clinic.at(ctx.now());
        let position = clinic.lift_position();
        is_loaded.set(clinic.is_loaded());
        let end = self.target.map(|up| if up { 1.0 } else { 0.0 });
        if end == Some(position) {
            self.target = None;
            done.emit(());
        }
    }

    /// Moves the lift up.
    #[slot]
    fn raise(&mut self, ctx: &Ctx) {
        self.go(ctx, true);
    }

    /// Moves the lift down.
    #[slot]
    fn lower(&mut self, ctx: &Ctx) {
        self.go(ctx, false);
    }

    fn go(&mut self, ctx: &Ctx, up: bool) {
        self.target = Some(up);
        self.clinic.at(ctx.now()).lift(up);
    }
}

/// Orders of the people who work in the clinic.
#[node]
#[derive(Debug)]
pub struct Dispatch {
    clinic: Clinic,
}

#[node]
impl Dispatch {
    /// Creates the orders of `clinic`.
    pub fn new(clinic: &Clinic) -> Self {
        Self { clinic: clinic.clone() }
    }

    /// Sends the next order. With `true` the last one is done: people then believe that the container is at its
    /// destination. With `false` it is given back.
    #[slot]
    fn ask(&mut self, is_done: &bool, order: Event<Order>) {
        let mut clinic = self.clinic.present();
        if *is_done {
            clinic.confirm();
        } else {
            clinic.refuse();
        }
        if let Some(next) = clinic.next_order() {
            order.emit(next);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::clinic::{Conditions, Options};

    /// Times in ms of the first three scans of a scanner that fires every 80 ms: of their arrival, and of their stamps.
    fn scans(latency_ms: u64) -> Vec<(i64, i64)> {
        let conditions = Conditions { scan_latency: Duration::from_millis(latency_ms), ..Conditions::KIND };
        let state = State::new(&Options { people: 0, conditions, ..Options::default() }).expect("a plan");
        let mut scanner = Scanner::new(&Clinic::new(state));
        let fire = |ms: i64| {
            let mut scan = Out::new();
            scanner.process(&Ctx::new(Time::from_millis(ms)), &mut scan);
            scan.get().map(|scan| (ms, scan.stamp.as_nanos() / 1_000_000))
        };
        (0..=4).map(|period| 80 * period).filter_map(fire).take(3).collect()
    }

    #[test]
    fn a_scan_arrives_after_its_stamp_by_the_latency() {
        assert_eq!(scans(0), [(0, 0), (80, 80), (160, 160)]);
        assert_eq!(scans(80), [(80, 0), (160, 80), (240, 160)]);
        assert_eq!(scans(100), [(160, 0), (240, 80), (320, 160)]);
    }

    /// The same world, seen by a vehicle that turns: a turn of the mirror that takes time bends the scan.
    #[test]
    fn the_scan_of_a_vehicle_that_turns_is_bent() {
        let ranges = |turn_ms: u64, omega: f32| {
            let conditions = Conditions { scan_turn: Duration::from_millis(turn_ms), ..Conditions::KIND };
            let state = State::new(&Options { people: 0, conditions, ..Options::default() }).expect("a plan");
            let clinic = Clinic::new(state);
            clinic.present().drive(Twist::new(0.0, 0.0, omega));
            let mut scan = Out::new();
            Scanner::new(&clinic).process(&Ctx::new(Time::from_millis(240)), &mut scan);
            scan.get().expect("a scan").ranges.clone()
        };
        assert_eq!(ranges(0, 0.0), ranges(40, 0.0));
        assert_ne!(ranges(0, 1.0), ranges(40, 1.0));
    }
}
