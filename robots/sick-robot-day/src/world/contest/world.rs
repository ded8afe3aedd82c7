use super::{
    Collision, Delivery, Fault, FaultKind, Obstacle, RIVALS, Report, START,
    body::{self, Bodies, Body},
    operator::Operator,
    referee::{Crash, Referee},
    rival::Rival,
    rules::ROBOTS,
};
use crate::world::{Arena, Cube, Hopper, hall_light};
use apex_nodes::{
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_rt::Time;
use apex_sim::{
    HeldTwist, Light, Limits, Look, Odometry, OdometryNoise, Omnidirectional, Pillar, Random, Simulation, stream,
};
use std::{f32::consts::PI, time::Duration};

/// Radius of our robot, in m.
pub const RADIUS: f32 = 0.3;

const STEP: Duration = Duration::from_millis(10);

/// Time without a twist after which motors brake.
const COMMAND_TIMEOUT: Duration = Duration::from_millis(300);

const LIMITS: Limits = Limits { speed: 1.5, acceleration: 2.0, turn: 2.5, turn_acceleration: 6.0 };

/// Distance of all starts from the middle, in m.
const START_DISTANCE: f32 = 4.5;

/// Simulated competition of one seed.
#[derive(Debug, Clone)]
pub struct Contest {
    seed: u64,
    now: Time,
    arena: Arena,
    light: Light,
    bodies: Bodies,
    rivals: [Rival; RIVALS],
    /// Index of the first rival in the scene; the others follow it.
    pillar: usize,
    operators: [Operator; ROBOTS],
    /// Random numbers for the cubes.
    cubes: Random,
    referee: Referee,
    hopper: Hopper,
    odometry: Odometry,
    wheels: Pose2,
    command: HeldTwist,
    faults: Vec<Fault>,
    report: Report,
}

/// True state of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot {
    /// Pose in the arena.
    pub pose: Pose2,
    /// Velocity in the frame of the robot.
    pub twist: Twist,
    /// Radius, in m.
    pub radius: f32,
    /// `true` if the lamp is on.
    pub lamp: bool,
    /// Number of the cube in the hopper.
    pub cube: Option<u32>,
}

impl Contest {
    /// Creates the competition of a seed with these faults of our robot.
    pub fn new(seed: u64, faults: Vec<Fault>) -> Self {
        let mut arena = Arena::new(seed);
        let mut random = stream(seed, 0);
        let light = hall_light(&mut random);
        let bodies = line_up(&arena, &mut random);
        let pillar = add_rivals(&mut arena, &bodies, &mut random);
        let hopper =
            Hopper { pattern: true, cube: None, light: hall_light(&mut random), noise: random.uniform(1.0, 3.0) };
        let mut contest = Self {
            seed,
            now: Time::ZERO,
            arena,
            light,
            bodies,
            rivals: std::array::from_fn(|i| Rival::new(stream(seed, 10 + i as u64), START)),
            pillar,
            operators: std::array::from_fn(|i| Operator::new(stream(seed, 20 + i as u64))),
            cubes: stream(seed, 1),
            referee: Referee::default(),
            hopper,
            odometry: Odometry::new(OdometryNoise::PIONEER, stream(seed, 2).bits()),
            wheels: Pose2::default(),
            command: HeldTwist::new(Some(COMMAND_TIMEOUT)),
            faults,
            report: Report::default(),
        };
        contest.note();
        contest
    }

    /// Time of the simulation.
    pub const fn now(&self) -> Time {
        self.now
    }

    /// Sets the twist of our motors. They brake if they receive none for the command time-out.
    pub const fn drive(&mut self, twist: Twist) {
        self.command.set(twist, self.now);
    }

    /// Sets the command time-out of our motors, which is 0.3 s at first. Without one they keep the last twist.
    pub const fn set_command_timeout(&mut self, timeout: Option<Duration>) {
        self.command.timeout = timeout;
    }

    /// Switches our lamp.
    pub const fn set_lamp(&mut self, on: bool) {
        self.bodies[0].lamp = on;
    }

    /// Moves our robot to another place, where it stands still. Its odometry does not change.
    pub const fn place(&mut self, pose: Pose2) {
        self.bodies[0].base.pose = pose;
        self.bodies[0].base.twist = Twist::ZERO;
    }

    /// Arena with the rivals at their present places.
    pub const fn arena(&self) -> &Arena {
        &self.arena
    }

    /// Lighting of the arena.
    pub const fn light(&self) -> &Light {
        &self.light
    }

    /// Hopper of our robot.
    pub const fn hopper(&self) -> &Hopper {
        &self.hopper
    }

    /// Pose of our robot by wheel odometry.
    pub const fn wheels(&self) -> Pose2 {
        self.wheels
    }

    /// True states of all robots, ours first.
    pub fn robots(&self) -> [Robot; ROBOTS] {
        self.bodies.each_ref().map(|body| Robot {
            pose: body.pose(),
            twist: body.base.twist,
            radius: body.radius,
            lamp: body.lamp,
            cube: body.cube.map(|cube| cube.number),
        })
    }

    /// Events up to now.
    pub const fn report(&self) -> &Report {
        &self.report
    }

    /// Returns `true` if our robot has this fault now.
    pub fn has(&self, kind: FaultKind) -> bool {
        self.faults.iter().any(|fault| fault.is_on(kind, self.now))
    }

    /// Random numbers for anything outside the competition itself, such as the noise of a sensor.
    pub(super) const fn stream(&self, number: u64) -> Random {
        stream(self.seed, number)
    }

    fn step(&mut self) {
        self.now += STEP;
        let commands = self.commands();
        let before = self.bodies[0].pose();
        let mut touches = vec![];
        for (who, command) in commands.iter().enumerate() {
            body::advance(who, command, STEP.as_secs_f32(), &self.arena, &mut self.bodies, &mut touches);
        }
        let crashes = touches.iter().filter_map(|touch| self.referee.judge(touch)).collect::<Vec<_>>();
        crashes.iter().for_each(|crash| self.record(crash));
        self.referee.release(&self.arena, &self.bodies);
        self.wheels = self.odometry.measure(&before, &self.bodies[0].pose());
        self.report.distance += (self.bodies[0].position() - before.position()).norm();
        for who in 0..ROBOTS {
            let served = self.operators[who].watch(&self.bodies[who], &self.arena, self.now);
            served.into_iter().for_each(|station| self.serve(who, station));
        }
        self.show();
        self.note();
    }

    /// Commands of all robots: ours as received, those of the others as chosen by their drivers 20 times per second.
    fn commands(&mut self) -> [Twist; ROBOTS] {
        if self.now.as_nanos() % 50_000_000 == 0 {
            for (rival, who) in self.rivals.iter_mut().zip(1..) {
                rival.decide(who, &self.bodies, &self.arena, self.now);
                self.bodies[who].lamp = rival.lamp;
            }
        }
        let ours = self.command.at(self.now);
        std::array::from_fn(|who| match who {
            0 => ours,
            _ => self.rivals[who - 1].command(who, &self.bodies),
        })
    }

    /// Service at a station: puts a cube in at a filling station, or takes it out at a delivery station.
    fn serve(&mut self, who: usize, station: usize) {
        let sign = self.arena.stations().nth(station).and_then(|station| station.number);
        let cube = self.bodies[who].cube.take();
        match (sign, cube) {
            (Some(station), Some(Cube { number: cube, .. })) => {
                let delivery = Delivery { at: self.now, station, cube };
                match who.checked_sub(1) {
                    None => self.report.deliveries.push(delivery),
                    Some(rival) => self.report.rivals[rival].points += u32::from(delivery.is_right()),
                }
            }
            _ => {
                self.bodies[who].cube = Some(Cube::random(&mut self.cubes));
                if who == 0 {
                    self.report.fetches.push(self.now);
                }
            }
        }
        self.hopper.cube = self.bodies[0].cube;
    }

    fn record(&mut self, crash: &Crash) {
        let Crash { touch, caused } = crash;
        let (at, place) = (self.now, touch.place);
        let mut blame = |who: usize, caused: bool| {
            if let Some(rival) = who.checked_sub(1) {
                self.report.rivals[rival].collisions += u32::from(caused);
            }
        };
        blame(touch.who, caused[0]);
        if let Obstacle::Robot(other) = touch.against {
            blame(other, caused[1]);
        }
        let [mover, other] = *caused;
        let ours = match touch.against {
            against if touch.who == 0 => Collision { at, place, against, caused: mover, suffered: other },
            Obstacle::Robot(0) => {
                Collision { at, place, against: Obstacle::Robot(touch.who), caused: other, suffered: mover }
            }
            _ => return,
        };
        self.report.collisions.push(ours);
    }

    /// Moves the rivals in world and scene to their present places.
    fn show(&mut self) {
        let rivals = &self.bodies[1..];
        let discs = self.arena.world.discs_mut().iter_mut().zip(rivals);
        discs.for_each(|(disc, body)| disc.centre = body.position());
        let pillars = self.arena.scene.pillars_mut().iter_mut().skip(self.pillar).zip(rivals);
        pillars.for_each(|(pillar, body)| pillar.centre = body.position());
    }

    fn note(&mut self) {
        if self.now.as_nanos() % 100_000_000 == 0 {
            self.report.trajectory.push((self.now, self.bodies[0].pose()));
        }
    }
}

impl Simulation for Contest {
    fn advance(&mut self, now: Time) {
        while self.now + STEP <= now {
            self.step();
        }
    }
}

/// Robots at the start: each in front of another filling station, ours roughly facing the middle.
fn line_up(arena: &Arena, random: &mut Random) -> Bodies {
    let first = random.bits() as usize % arena.filling.len();
    std::array::from_fn(|who| {
        let station = &arena.filling[(first + who) % arena.filling.len()];
        let place = Point2::polar(START_DISTANCE, station.pose.theta + random.uniform(-PI / 18.0, PI / 18.0));
        let theta = place.angle() + PI + random.uniform(-PI / 9.0, PI / 9.0);
        let pose = Pose2::default().compose(&Pose2::new(place.x, place.y, theta));
        let radius = if who == 0 { RADIUS } else { random.uniform(0.25, 0.3) };
        let base = Omnidirectional { pose, twist: Twist::ZERO, limits: LIMITS };
        Body { base, radius, lamp: false, cube: None }
    })
}

/// Adds the rivals to world and scene. Returns the index of the first one in the scene.
fn add_rivals(arena: &mut Arena, bodies: &Bodies, random: &mut Random) -> usize {
    let first = arena.scene.pillars_mut().len();
    for body in &bodies[1..] {
        let (centre, radius) = (body.position(), body.radius);
        arena.world.disc(centre, radius);
        let brightness = if random.chance(0.5) { random.uniform(20.0, 60.0) } else { random.uniform(150.0, 220.0) };
        let (top, look) = (random.uniform(0.42, 0.48), Look::Plain(brightness as u8));
        arena.scene.pillar(Pillar { centre, radius, top, look });
    }
    first
}
