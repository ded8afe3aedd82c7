use super::{
    Conditions, Contact, DOCK, Delivery, Fault, FaultKind, PEOPLE, Report, STAIRWELL,
    body::{Body, along},
    report::WEDGED,
    site::{Site, area, furnish_corridors},
    view,
};
use crate::{
    Order, WHEEL_LENGTH,
    world::{Cart, Thing},
};
use apex_nodes::{
    io::ReadError,
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_rt::Time;
use apex_sim::{
    Crowd, Disc, Footprint, HeldTwist, Odometry, OdometryNoise, PoseTrack, Random, Shared, Simulation, World, pushed,
    stream, tof::Space,
};
use std::time::Duration;

/// Duration of a run.
pub const DURATION: Duration = Duration::from_secs(600);

const STEP: Duration = Duration::from_millis(20);
/// Time without a twist after which the motors brake.
const COMMAND_TIMEOUT: Duration = Duration::from_millis(300);
/// Errors of the wheel odometry, as a part of those of a Pioneer 2.
const DRIFT: f32 = 0.3;
/// Distance from the vehicle within which it may touch something, in m.
const TOUCH: f32 = 2.5;
/// Distance up to which the scanner sees, in m.
const SIGHT: f32 = 20.0;
/// Speed from which on a contact is one that the vehicle causes, in m/s.
const CONTACT: f32 = 0.01;
/// Speed from which on a vehicle drives on after a bump, in m/s.
const MOVES: f32 = 0.05;
/// Distance by which a vehicle that is not wedged moves, in m.
const FREE: f32 = 0.3;
/// Longest time that is remembered of the motion of the vehicle, in s.
const PAST: f32 = 0.2;
/// Radius of gyration of a container, in m: that of a block of its size.
const GYRATION: f32 = 0.4;
/// Radius of the parts of a trolley above its wheels, and their distances from its middle, in m.
const TROLLEY: (f32, [f32; 3]) = (0.22, [-0.18, 0.0, 0.18]);
/// Radius of the body of a person above the legs, in m.
const BODY: f32 = 0.18;

/// Options of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Seed of furniture, people, containers, orders and noise.
    pub seed: u64,
    /// Number of people.
    pub people: usize,
    /// Faults of the devices.
    pub faults: Vec<Fault>,
    /// Time without a twist after which the motors brake. Without one they keep the last twist.
    pub command_timeout: Option<Duration>,
    /// Conditions that make the clinic harder.
    pub conditions: Conditions,
}

/// Eight people, no faults, motors that brake after 0.3 s, and kind conditions.
impl Default for Options {
    fn default() -> Self {
        let conditions = Conditions::KIND;
        Self { seed: 1, people: PEOPLE, faults: vec![], command_timeout: Some(COMMAND_TIMEOUT), conditions }
    }
}

/// Simulated clinic that all drivers of the vehicle share.
pub type Clinic = Shared<State>;

/// Simulated clinic of one seed.
#[derive(Debug, Clone)]
pub struct State {
    now: Time,
    seed: u64,
    conditions: Conditions,
    site: Site,
    crowd: Crowd,
    body: Body,
    /// Poses of tractor and trailer.
    past: [PoseTrack; 2],
    odometry: Odometry,
    wheels: Pose2,
    command: HeldTwist,
    faults: Vec<Fault>,
    order: Option<Order>,
    /// Number of the ordered container.
    ordered: Option<usize>,
    /// Poses of the containers as far as people know them: where they were, or where the last order wanted them.
    known: Vec<Pose2>,
    orders: Random,
    report: Report,
    /// People that touch the vehicle, and `true` if it touches something else.
    touching: Vec<usize>,
    bumped: bool,
    /// Place and time from which on the vehicle has been beneath a container without getting away, and `true` if that
    /// has been counted.
    beneath: Option<(Pose2, Time, bool)>,
    /// Surroundings of the vehicle, with the wheels of containers.
    near: World,
    /// All that is seen by the scanner.
    seen: World,
}

/// True state of the clinic at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Time.
    pub now: Time,
    /// Poses of the tractor and of the trailer.
    pub vehicle: [Pose2; 2],
    /// Velocity of the tractor, in its frame.
    pub twist: Twist,
    /// Poses of the containers.
    pub carts: Vec<Pose2>,
    /// Number of the container on the lift.
    pub load: Option<usize>,
    /// Positions of the people.
    pub people: Vec<Pose2>,
    /// Present order.
    pub order: Option<Order>,
}

impl State {
    /// Creates the clinic of a seed.
    ///
    /// # Errors
    /// If the plan of the building cannot be written.
    pub fn new(options: &Options) -> Result<Self, ReadError> {
        let seed = options.seed;
        let mut random = stream(seed, 0);
        let mut site = Site::new(&mut random)?;
        furnish_corridors(&mut site, options.conditions.corridor_furniture, &mut stream(seed, 4));
        let known = site.carts.iter().map(Cart::pose).collect();
        let crowd = Crowd::new(view::walkable(&site.building), options.people, stream(seed, 1).bits());
        let body = Body::new(DOCK);
        let past = [body.tractor.base.pose, body.tractor.trailer_pose()];
        Ok(Self {
            now: Time::ZERO,
            seed,
            conditions: options.conditions,
            site,
            crowd: crowd.with_trolleys(options.conditions.trolleys),
            body,
            past: past.map(|pose| PoseTrack::new(pose, PAST, STEP.as_secs_f32())),
            odometry: Odometry::new(OdometryNoise::PIONEER.times(DRIFT), stream(seed, 2).bits()),
            wheels: Pose2::default(),
            command: HeldTwist::new(options.command_timeout),
            faults: options.faults.clone(),
            order: None,
            ordered: None,
            known,
            orders: stream(seed, 3),
            report: Report::default(),
            touching: vec![],
            bumped: false,
            beneath: None,
            near: World::default(),
            seen: World::default(),
        })
    }

    /// Random numbers for anything outside of the clinic itself, such as the noise of a sensor.
    pub fn stream(&self, number: u64) -> Random {
        stream(self.seed, number)
    }

    /// Sets the twist of the motors.
    pub fn drive(&mut self, twist: Twist) {
        self.command.set(twist, self.now);
    }

    /// Moves the lift up or down.
    pub fn lift(&mut self, up: bool) {
        self.body.lift.is_raised = up;
    }

    /// Position of the lift, from 0 to 1.
    pub fn lift_position(&self) -> f32 {
        self.body.lift.position
    }

    /// Returns `true` while a container is on the lift.
    pub fn is_loaded(&self) -> bool {
        self.body.load.is_some()
    }

    /// Pose of the tractor by wheel odometry.
    pub fn wheels(&self) -> Pose2 {
        self.wheels
    }

    /// Pose of the tractor.
    pub fn pose(&self) -> Pose2 {
        self.body.tractor.base.pose
    }

    /// Pose of the trailer.
    pub fn trailer(&self) -> Pose2 {
        self.body.tractor.trailer_pose()
    }

    /// Poses of tractor and trailer in the last 0.2 s.
    pub const fn past(&self) -> &[PoseTrack; 2] {
        &self.past
    }

    /// Conditions that make the clinic harder.
    pub const fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// Events up to now.
    pub const fn report(&self) -> &Report {
        &self.report
    }

    /// Returns `true` if the vehicle has this fault now.
    pub fn has(&self, kind: FaultKind) -> bool {
        self.faults.iter().any(|fault| fault.is_on(kind, self.now))
    }

    /// Building with its furniture.
    pub const fn building(&self) -> &apex_sim::Building {
        &self.site.building
    }

    /// True state.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            now: self.now,
            vehicle: [self.pose(), self.trailer()],
            twist: self.twist(),
            carts: self.site.carts.iter().map(Cart::pose).collect(),
            load: self.body.load.map(|(number, _)| number),
            people: self.crowd.people().iter().map(|person| person.pose).collect(),
            order: self.order,
        }
    }

    /// Velocity of the tractor, in its frame.
    pub const fn twist(&self) -> Twist {
        self.body.tractor.base.twist
    }

    /// Next order: a random container to a random place that is free. Its place is about that where people believe it
    /// to be. `None` if there is none.
    pub fn next_order(&mut self) -> Option<Order> {
        let carts = &self.site.carts;
        let lifted = self.body.load.map(|(number, _)| number);
        let from: Vec<usize> = (0..carts.len()).filter(|number| Some(*number) != lifted).collect();
        let is_free = |place: &&Pose2| carts.iter().all(|c| (c.pose().position() - place.position()).norm() > 3.0);
        let to: Vec<Pose2> = self.site.places.iter().filter(is_free).copied().collect();
        let pick = |random: &mut Random, count: usize| (random.bits() % count.max(1) as u64) as usize;
        let number = *from.get(pick(&mut self.orders, from.len()))?;
        let cart = *self.known.get(number)?;
        let destination = *to.get(pick(&mut self.orders, to.len()))?;
        let lane = if cart.y < 15.0 { 0.0 } else { core::f32::consts::PI };
        let mut off = |most: f32| self.orders.uniform(-most, most);
        let known = Pose2::new(off(0.2), off(0.08), off(0.02));
        let container = Pose2 { theta: along(cart.theta, lane), ..cart }.compose(&known);
        (self.order, self.ordered) = (Some(Order { container, destination }), Some(number));
        self.order
    }

    /// Notes that the vehicle has done its order, as it says: people look for the container at its destination.
    pub fn confirm(&mut self) {
        if let Some((order, number)) = self.order.zip(self.ordered.take()) {
            self.known[number] = order.destination;
        }
    }

    /// Notes that an order was given back.
    pub fn refuse(&mut self) {
        self.report.refused += 1;
    }

    /// World that the scanner sees.
    pub fn scanned(&mut self) -> &World {
        let here = self.pose().position();
        self.seen.take_near(&self.site.building.world, here, SIGHT);
        self.site.carts.iter().for_each(|cart| cart.add_to(&mut self.seen));
        for person in self.crowd.people() {
            let feet = person.legs().into_iter().chain(person.trolley_wheels());
            feet.for_each(|foot| self.seen.disc(foot.centre, foot.radius));
        }
        for (_, pose) in self.site.things.iter().filter(|(thing, _)| *thing == Thing::Glass) {
            self.seen.disc(pose.position(), 0.035);
        }
        &self.seen
    }

    /// Fills the space that the camera sees.
    pub fn fill(&self, space: &mut Space) {
        let pose = self.pose();
        view::walls(&self.site.building.world, &pose, space);
        let load = self.body.load.map(|(number, _)| number);
        for (number, cart) in self.site.carts.iter().enumerate() {
            let is_lifted = load == Some(number);
            if self.conditions.load_in_view || !is_lifted {
                view::cart(cart, &pose, is_lifted, space);
            }
        }
        for person in self.crowd.people() {
            view::person(person, &pose, space);
            view::trolley(person, &pose, space);
        }
        self.site.things.iter().enumerate().for_each(|(i, (thing, at))| view::thing(*thing, at, i, &pose, space));
        space.dig(STAIRWELL);
    }

    fn step(&mut self) {
        self.now += STEP;
        let dt = STEP.as_secs_f32();
        let areas: Vec<Footprint> = self.body.areas().chain(self.site.carts.iter().map(area)).collect();
        self.crowd.step(dt, &areas);
        self.move_lift(dt);
        let before = self.pose();
        let is_held = self.move_body(dt);
        self.wheels = if is_held && self.conditions.slip > 0.0 {
            self.odometry.slip(&self.command.at(self.now), self.conditions.slip, dt)
        } else {
            self.odometry.measure(&before, &self.pose())
        };
        self.touch_people();
        self.watch_floor();
        self.watch_containers();
        for (past, pose) in self.past.iter_mut().zip([self.body.tractor.base.pose, self.body.tractor.trailer_pose()]) {
            past.push(pose);
        }
        self.report.distance += (self.pose().position() - before.position()).norm();
        if self.now.as_nanos() % 200_000_000 == 0 {
            self.report.trajectory.push((self.now, self.pose()));
        }
    }

    fn move_lift(&mut self, dt: f32) {
        if self.has(FaultKind::LiftJammed) {
            return;
        }
        let before = self.body.lift.position;
        self.body.lift.step(dt);
        let after = self.body.lift.position;
        if before == 0.0 && after > 0.0 {
            self.body.catch(&self.site.carts);
            match self.body.load {
                // It does not stand where it was set down.
                Some((number, _)) => {
                    self.report.deliveries.retain(|other| other.left.is_some() || other.container != number);
                }
                None => self.report.empty_lifts.push(self.now),
            }
            self.look_around();
        }
        if before > 0.0
            && after == 0.0
            && let Some((number, _)) = self.body.load.take()
        {
            self.set_down(number);
        }
    }

    /// Collects what the vehicle may touch: not its load.
    fn look_around(&mut self) {
        self.near.take_near(&self.site.building.world, self.body.tractor.base.pose.position(), TOUCH);
        let load = self.body.load.map(|(number, _)| number);
        let others = self.site.carts.iter().enumerate().filter(|(number, _)| Some(*number) != load);
        others.for_each(|(_, cart)| cart.add_to(&mut self.near));
    }

    fn set_down(&mut self, number: usize) {
        let Some(destination) = self.order.map(|order| order.destination) else { return };
        let destination = Some(destination).filter(|_| self.ordered == Some(number));
        let (offset, turn) = (f32::INFINITY, 0.0);
        let mut delivery = Delivery { at: self.now, container: number, destination, offset, turn, left: None };
        delivery.stands_at(&self.site.carts[number].pose());
        self.report.deliveries.push(delivery);
    }

    /// Notices when the vehicle has left a container, and when it is wedged beneath one.
    fn watch_containers(&mut self) {
        let load = self.body.load.map(|(number, _)| number);
        let outline = self.body.outline();
        let is_above = |number: usize| outline.iter().any(|p| area(&self.site.carts[number]).distance(*p) <= 0.0);
        for delivery in self.report.deliveries.iter_mut().filter(|delivery| delivery.left.is_none()) {
            if load.is_none() && !is_above(delivery.container) {
                delivery.left = Some(self.now);
                // It may have been pushed away meanwhile.
                delivery.stands_at(&self.site.carts[delivery.container].pose());
            }
        }
        let here = self.body.tractor.base.pose;
        let is_beneath = (0..self.site.carts.len()).any(|number| Some(number) != load && is_above(number));
        let since = self.beneath.filter(|(at, ..)| (at.position() - here.position()).norm() < FREE);
        self.beneath = is_beneath.then(|| since.unwrap_or((here, self.now, false)));
        if let Some((_, since, is_counted @ false)) = &mut self.beneath
            && self.now.since(*since) >= WEDGED
        {
            *is_counted = true;
            self.report.wedges.push(self.now);
        }
    }

    /// Drives for `dt` s. Returns `true` if something held the vehicle.
    fn move_body(&mut self, dt: f32) -> bool {
        if !self.report.falls.is_empty() {
            return false;
        }
        let command = self.command.at(self.now);
        if self.now.as_nanos() % 100_000_000 == 0 {
            self.look_around();
        }
        let before = self.body.clone();
        let inside = self.body.drive(&command, dt, &self.near);
        let touches = inside.is_some();
        if touches && !self.bumped {
            self.report.bumps.push(self.now);
        }
        // A bump has ended when the vehicle drives again.
        self.bumped = touches || (self.bumped && self.body.speed() < MOVES);
        if let Some(((number, _), pose)) = self.body.load.zip(self.body.load_pose()) {
            self.site.carts[number].move_to(pose);
        }
        if let Some(inside) = inside.filter(|_| !self.conditions.container_roll.is_zero()) {
            self.bump(&before, &inside, dt);
        }
        touches
    }

    /// Lets the containers roll that the vehicle, from `before`, would be `inside` after `dt` s.
    fn bump(&mut self, before: &Body, inside: &Body, dt: f32) {
        let load = self.body.load.map(|(number, _)| number);
        for number in (0..self.site.carts.len()).filter(|number| Some(*number) != load) {
            let cart = &self.site.carts[number];
            let Some((at, way)) = push(cart, before, inside) else { continue };
            let way = way.scaled(self.conditions.container_roll.as_secs_f32() / dt);
            let pose = pushed(&cart.pose(), at, way, GYRATION);
            let mut around = World::default();
            around.take_near(&self.site.building.world, pose.position(), TOUCH);
            let others = self.site.carts.iter().enumerate().filter(|(other, _)| *other != number);
            others.for_each(|(_, other)| other.add_to(&mut around));
            if area(&Cart::new(pose, [0.0; 4])).clearance(&around) > 0.0 {
                self.site.carts[number].move_to(pose);
            }
        }
        self.look_around();
    }

    /// Counts contacts of people with the vehicle that drives, and pushes them out of its way.
    fn touch_people(&mut self) {
        let areas: Vec<Footprint> = self.body.areas().collect();
        let is_loaded = self.body.load.is_some();
        for person in 0..self.crowd.people().len() {
            let one = &self.crowd.people()[person];
            let trunk = Disc { centre: one.pose.position(), radius: BODY };
            // What is above the legs meets only a load.
            let (radius, places) = TROLLEY;
            let baskets = one.trolley().into_iter().flat_map(|trolley| {
                places.map(|x| Disc { centre: trolley.pose.to_outer(Point2::new(x, 0.0)), radius })
            });
            let above = [trunk].into_iter().chain(baskets).filter(|_| is_loaded);
            let parts = one.legs().into_iter().chain(above).chain(one.trolley_wheels());
            let overlap = |disc: &Disc| {
                let depth = areas.iter().map(|area| area.distance(disc.centre)).fold(f32::INFINITY, f32::min);
                disc.radius - depth
            };
            let deepest = parts.map(|disc| overlap(&disc)).fold(f32::NEG_INFINITY, f32::max);
            if deepest <= 0.0 {
                self.touching.retain(|other| *other != person || deepest > -0.05);
                continue;
            }
            if self.body.speed() > CONTACT && !self.touching.contains(&person) {
                self.touching.push(person);
                let contact = Contact { at: self.now, person, pose: self.pose() };
                self.report.contacts.push(contact);
            }
            let here = self.crowd.people()[person].pose.position();
            let middle = (self.pose().position() + self.trailer().position()).scaled(0.5);
            let away = here - middle;
            self.crowd.shove(person, away.scaled(deepest.min(0.05) / away.norm().max(1e-3)));
        }
    }

    /// Notices small things under the vehicle, and falls.
    fn watch_floor(&mut self) {
        let wheels = self.body.wheels();
        if self.report.falls.is_empty() && wheels.iter().any(|wheel| STAIRWELL.contains(wheel.x, wheel.y)) {
            self.report.falls.push(self.now);
        }
        let parts = self.body.tractor.footprints();
        let is_under = |place: Point2| parts.iter().any(|part| part.distance(place) <= 0.0);
        let Self { site, report, now, .. } = self;
        site.things.retain(|(thing, pose)| {
            let is_hit = is_under(pose.position());
            if is_hit {
                report.run_over.push((*now, *thing));
            }
            !is_hit
        });
    }
}

/// Point at which a vehicle meets a wheel of a container, and its way there from `before`. `None` if it does not.
fn push(cart: &Cart, before: &Body, inside: &Body) -> Option<(Point2, Point2)> {
    before.areas().zip(inside.areas()).find_map(|(from, to)| {
        let wheel = cart.wheels().map(|(wheel, _)| wheel).find(|wheel| to.distance(*wheel) <= 0.5 * WHEEL_LENGTH)?;
        let at = to.nearest(wheel);
        Some((at, at - from.pose.to_outer(to.pose.to_inner(at))))
    })
}

impl Simulation for State {
    fn advance(&mut self, now: Time) {
        while self.now + STEP <= now {
            self.step();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::math::normalize_angle;

    /// Clinic without people in which the vehicle stands behind a container, beside its middle.
    fn behind_a_container(conditions: Conditions) -> State {
        let mut state = State::new(&Options { people: 0, conditions, ..Options::default() }).expect("a plan");
        let cart = state.site.carts[0].pose();
        state.body = Body::new(cart.compose(&Pose2::new(-1.2, 0.15, 0.0)));
        state
    }

    /// Drives against it: by how much it turned, and how far the vehicle and its wheels went.
    fn drive_against_a_container(conditions: Conditions) -> (f32, f32, f32) {
        let mut state = behind_a_container(conditions);
        let (cart, start) = (state.site.carts[0].pose(), state.pose());
        for step in 1..=150 {
            state.drive(Twist::new(0.4, 0.0, 0.0));
            state.advance(Time::from_millis(20 * step));
        }
        assert!(!state.report().bumps.is_empty());
        let turn = normalize_angle(&(state.site.carts[0].pose().theta - cart.theta));
        (turn, (state.pose().position() - start.position()).norm(), state.wheels().position().norm())
    }

    #[test]
    fn a_container_that_is_bumped_turns() {
        let kind = drive_against_a_container(Conditions::KIND);
        let rolls = Conditions { container_roll: Duration::from_millis(200), ..Conditions::KIND };
        let rolling = drive_against_a_container(rolls);
        assert!(kind.0.abs() < 1e-5, "it stands like a wall: {kind:?}");
        // The left side is pushed forward.
        assert!(rolling.0 < -0.05 && rolling.1 > kind.1, "{kind:?} {rolling:?}");
    }

    #[test]
    fn wheels_slip_before_what_holds_the_vehicle() {
        let kind = drive_against_a_container(Conditions::KIND);
        let slips = drive_against_a_container(Conditions { slip: 0.5, ..Conditions::KIND });
        assert_eq!(slips.1, kind.1);
        assert!((kind.2 - kind.1).abs() < 0.05 && slips.2 > slips.1 + 0.2, "{kind:?} {slips:?}");
    }

    #[test]
    fn the_camera_sees_the_load_if_it_is_in_view() {
        let solids = |load_in_view, is_lifted: bool| {
            let mut state = behind_a_container(Conditions { load_in_view, ..Conditions::KIND });
            state.body.load = is_lifted.then_some((0, Pose2::default()));
            let mut space = Space::new(apex_sim::tof::Floor::default());
            state.fill(&mut space);
            space.solids().len()
        };
        assert_eq!(solids(true, true), solids(true, false));
        // A body and four wheels.
        assert_eq!(solids(false, true) + 5, solids(false, false));
    }

    #[test]
    fn scanners_see_the_wheels_of_a_trolley() {
        let discs = |trolleys| {
            let conditions = Conditions { trolleys, ..Conditions::KIND };
            let mut state = State::new(&Options { people: 1, conditions, ..Options::default() }).expect("a plan");
            state.scanned().discs().len()
        };
        assert_eq!(discs(0) + 4, discs(1));
    }
}
