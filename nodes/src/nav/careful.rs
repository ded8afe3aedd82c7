use super::{
    Articulated, Twist,
    latest::both_fresh,
    outline::{Axes, Outline},
    twist::Command,
};
use crate::{
    persons::{Person, Persons},
    scan::{Point2, Pose2},
};
use apex_rt::{Ctx, Time, node};
use heapless::Vec;
use libm::{fmaxf, fminf};

/// Maximum number of persons beside the robot that are remembered.
const MAX_KEPT: usize = 8;
/// Distance up to which a person is one that is remembered, in m.
const SAME: f32 = 0.5;
/// Distance for which the motion of the robot is predicted, in m.
const STEP: f32 = 0.1;
/// Number of times within the horizon at which places are compared.
const TIMES: u8 = 10;
/// Distance by which a person who is too near may come nearer, in m: less than the error of a prediction.
const GRAZE: f32 = 0.01;
/// Distance within which legs may touch the vehicle, also if it drives away, in m.
const TOUCH: f32 = 0.19;
/// Share of this distance by which persons are farther away then, if the robot drives away from them.
const LEFT: f32 = 0.5;

/// Slows a tractor with a trailer down near persons (thesis 6.8), the more the nearer they are, also behind and beside
/// it.
///
/// With a `horizon` it looks ahead: persons and vehicle go on at their velocities. A speed at which none of them comes
/// within `keep`, and `spread` more for each second, or nearer than now, is not too fast. So persons who walk away, or
/// past the vehicle, do not count.
///
/// Distances are those of the middle of a person from the outline of the vehicle with its load. `persons`, `pose` of
/// the tractor and `trailer` are in one frame. Without them, for example before the first scan, the robot keeps to
/// `min_speed`. It stops if the last twist is older than `max_age`. Persons who stand do not count if the robot drives
/// away from them. It still moves with persons beside it: that it stops before them is the task of a
/// [`TrailerField`](super::TrailerField).
#[node]
#[derive(Debug, Clone)]
pub struct PersonCaution {
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Length of the load, whose middle is above that of the straight vehicle.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_length: f32,
    /// Width of the load; 0 for none.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_width: f32,
    /// Distance up to which the speed is `min_speed`.
    #[param(unit = "m", default = 0.7, range = 0.0..=100.0)]
    near: f32,
    /// Speed at this distance.
    #[param(unit = "m/s", default = 0.15, range = 0.0..=10.0)]
    min_speed: f32,
    /// Speed at this distance if the person stands, at least `min_speed`. Table legs look like the legs of a person who
    /// stands.
    #[param(unit = "m/s", default = 0.15, range = 0.0..=10.0)]
    standing_speed: f32,
    /// Distance up to which the speed is `min_speed` whether the person stands or walks: who stands may take a step.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    beside: f32,
    /// Distance within which the robot stops for who walks, and backward also for who stands, unless it drives away: a
    /// touch is then none of its own.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    halt: f32,
    /// Time for which a person within `beside` still counts after the last detection: the robot or its load often hides
    /// those who stand next to it.
    #[param(unit = "s", default = 0.0, range = 0.0..=60.0)]
    memory: f32,
    /// Velocity from which on a person walks.
    #[param(unit = "m/s", default = 0.3, range = 0.0..=10.0)]
    walking: f32,
    /// Additional speed per metre of distance beyond `near`.
    #[param(unit = "1/s", default = 0.3, range = 0.0..=100.0)]
    gain: f32,
    /// Time that is looked ahead; 0 if only distances count.
    #[param(unit = "s", default = 0.0, range = 0.0..=10.0)]
    horizon: f32,
    /// Distance that is kept from persons within this time.
    #[param(unit = "m", default = 0.4, range = 0.0..=10.0)]
    keep: f32,
    /// Growth of this distance with time: who walks does not keep a velocity.
    #[param(unit = "m/s", default = 0.05, range = 0.0..=10.0)]
    spread: f32,
    /// Maximum age of a twist, and of persons and poses by the time at which they were computed.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    command: Command,
    kept: Vec<Kept, MAX_KEPT>,
}

/// Place of a person who was close to the robot, and when.
#[derive(Debug, Clone, Copy)]
struct Kept {
    place: Point2,
    seen: Time,
}

#[node]
impl PersonCaution {
    fn process(
        &mut self,
        ctx: &Ctx,
        twist: Option<&Twist>,
        pose: Option<&Pose2>,
        trailer: Option<&Pose2>,
        persons: Option<&Persons>,
    ) -> Option<Twist> {
        let twist = self.command.update(ctx, twist, self.max_age);
        let axes = both_fresh(ctx, [pose, trailer], self.max_age);
        let speed = match axes.zip(persons) {
            Some(((base, trailer), persons)) => self.speed(ctx.now(), &twist, [*base, *trailer], persons),
            None => self.min_speed,
        };
        self.command.send(twist.slowed_to(speed))
    }

    /// Highest speed of a vehicle whose axes are at `now`.
    fn speed(&mut self, time: Time, twist: &Twist, now: Axes, persons: &Persons) -> f32 {
        let outline = Outline::new(self.vehicle, [self.load_length, self.load_width]);
        let next = self.vehicle.places(&now, twist, STEP).next().unwrap_or(now);
        let is_left = |place| outline.distance(&next, place) > outline.distance(&now, place) + LEFT * STEP;
        self.forget(time, persons);
        let hidden = self.kept.iter().map(|kept| Person { position: kept.place, ..Person::default() });
        let speed = |person: &Person| self.speed_beside(twist, &outline, &now, person, is_left(person.position));
        let beside = |person: &Person| outline.distance(&now, person.position) < self.beside;
        let least = persons
            .iter()
            .map(speed)
            .chain(hidden.filter(beside).map(|person| speed(&person)))
            .fold(f32::INFINITY, fminf);
        for person in persons.iter().filter(|person| beside(person)) {
            // Does not matter if it is full: the robot is slow already.
            let _ = self.kept.push(Kept { place: person.position, seen: time });
        }
        least
    }

    /// Highest speed because of a person, from whom the robot drives away or not.
    fn speed_beside(&self, twist: &Twist, outline: &Outline, now: &Axes, person: &Person, is_left: bool) -> f32 {
        let (distance, stands) = (outline.distance(now, person.position), self.stands(person));
        if stands && is_left {
            return f32::INFINITY;
        }
        // Who stands behind or beside a vehicle that backs up may take a step, too.
        let halt = if stands { fminf(self.beside, self.halt) } else { self.halt };
        let counts = !stands || twist.x < 0.0;
        if counts && distance < if is_left { fminf(TOUCH, halt) } else { halt } {
            return 0.0;
        }
        let predicted = if distance < self.beside { 0.0 } else { self.foreseen(twist, outline, now, person) };
        fmaxf(self.speed_at(distance, person), predicted)
    }

    /// Highest speed up to that of a twist at which a person is not too near within the horizon; 0 if there is none.
    fn foreseen(&self, twist: &Twist, outline: &Outline, now: &Axes, person: &Person) -> f32 {
        let (speed, time) = (twist.velocity().norm(), self.horizon / f32::from(TIMES));
        let before = outline.distance(now, person.position);
        let is_free = |share: f32| {
            let times = (1..=TIMES).map(|k| f32::from(k) * time);
            let places = self.vehicle.places(now, twist, share * speed * time);
            times.zip(places).all(|(t, axes)| {
                let distance = outline.distance(&axes, person.position + person.velocity.scaled(t));
                distance >= fminf(self.keep + self.spread * t, before - GRAZE)
            })
        };
        let shares = [1.0, 0.75, 0.5, 0.25].into_iter().filter(|_| self.horizon > 0.0);
        shares.filter(|share| is_free(*share)).fold(0.0, fmaxf) * speed
    }

    /// Highest speed at a distance from a person.
    fn speed_at(&self, distance: f32, person: &Person) -> f32 {
        let is_passed = self.stands(person) && distance >= self.beside;
        let least = if is_passed { fmaxf(self.min_speed, self.standing_speed) } else { self.min_speed };
        least + self.gain * fmaxf(distance - self.near, 0.0)
    }

    /// Returns `false` for what is not a number.
    fn stands(&self, person: &Person) -> bool {
        person.velocity.norm() < self.walking
    }

    /// Forgets those who are seen again or were seen too long ago.
    fn forget(&mut self, now: Time, persons: &Persons) {
        let memory = self.memory;
        let is_seen = |kept: &Kept| persons.iter().any(|person| (person.position - kept.place).norm() < SAME);
        self.kept.retain(|kept| now.since(kept.seen).as_secs_f32() < memory && !is_seen(kept));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    const LOAD: [f32; 2] = [1.2, 0.7];

    /// At most 0.1 m/s within 0.5 m, 0.3 m/s beside those who stand but not within 0.2 m, and 0.4 m/s more at each
    /// further metre.
    fn node([length, width]: [f32; 2]) -> PersonCaution {
        PersonCaution::construct((
            Articulated::PATSY,
            length,
            width,
            0.5,
            0.1,
            0.3,
            0.2,
            0.0,
            2.0,
            0.2,
            0.4,
            0.0,
            0.4,
            0.05,
            0.5,
        ))
    }

    /// Person at a place in the frame of the tractor, who walks at `velocity` m/s.
    type At = (f32, f32, f32);

    /// Twist that is left of one at a time in ms. The vehicle is straight.
    fn fire(node: &mut PersonCaution, ms: i64, twist: Twist, persons: &[At]) -> Twist {
        let base = Pose2::new(1.0, 1.0, 2.0);
        let trailer = Articulated::PATSY.trailer(&base, base.theta);
        let person = |&(x, y, velocity): &At| {
            let (position, velocity) = (base.to_outer(Point2::new(x, y)), Point2::new(0.0, velocity));
            Person { position, velocity, ..Person::default() }
        };
        let persons: Persons = persons.iter().map(person).collect();
        let ctx = Ctx::new(Time::from_millis(ms));
        node.process(&ctx, Some(&twist), Some(&base), Some(&trailer), Some(&persons)).expect("a command")
    }

    fn speed(load: [f32; 2], twist: f32, person: At) -> f32 {
        fire(&mut node(load), 0, Twist::new(twist, 0.0, 0.0), &[person]).x
    }

    fn assert_near(a: f32, b: f32) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }

    #[test]
    fn it_is_slow_near_persons() {
        let twist = Twist::new(1.0, 0.0, 0.5);
        let at = |persons: &[At]| fire(&mut node([0.0; 2]), 0, twist, persons);
        assert_eq!([at(&[]), at(&[(9.0, 0.0, 1.0)])], [twist; 2]);
        let near = at(&[(9.0, 0.0, 1.0), (1.25, 0.0, 1.0)]);
        assert_near(near.x, 0.3);
        assert_near(near.omega, 0.15);
        assert_near(at(&[(0.6, 0.0, 1.0)]).x, 0.1);
    }

    #[test]
    fn without_persons_or_a_pose_it_is_slow() {
        let (twist, at, none) = (Twist::new(1.0, 0.0, 0.0), Pose2::default(), Persons::default());
        let fire = |base, trailer, persons| {
            let limited = node(LOAD).process(&Ctx::new(Time::ZERO), Some(&twist), base, trailer, persons);
            limited.expect("a command").x
        };
        assert_eq!(fire(Some(&at), Some(&at), Some(&none)), 1.0);
        assert_eq!(fire(None, Some(&at), Some(&none)), 0.1);
        assert_eq!(fire(Some(&at), None, Some(&none)), 0.1);
        let nan = Pose2 { x: f32::NAN, ..at };
        assert_eq!(fire(Some(&nan), Some(&at), Some(&none)), 0.1);
        assert_eq!(fire(Some(&at), Some(&at), None), 0.1);
    }

    #[test]
    fn distances_are_from_the_outline() {
        assert_near(speed([0.0; 2], 1.0, (-0.7, 0.8, 1.0)), 0.14);
        assert_near(speed(LOAD, 1.0, (-0.7, 0.95, 1.0)), 0.14);
        // The corner of the load is nearer than the tractor.
        assert_near(speed(LOAD, 1.0, (0.625, 0.75, 1.0)), 0.1);
        assert_near(speed([0.0; 2], 1.0, (-1.4, 0.0, 1.0)), 0.14);
    }

    #[test]
    fn persons_who_stand_are_passed_faster_unless_they_are_close() {
        let speed = |x: f32, velocity: f32| speed([0.0; 2], 1.0, (x, 0.0, velocity));
        assert_eq!([speed(0.6, 0.1), speed(0.6, -0.5), speed(0.4, 0.1)], [0.3, 0.1, 0.1]);
    }

    #[test]
    fn it_halts_for_who_walks_close_to_it() {
        let speed = |twist: f32, x: f32, velocity: f32| {
            let mut node = PersonCaution { halt: 0.3, ..node([0.0; 2]) };
            fire(&mut node, 0, Twist::new(twist, 0.0, 0.0), &[(x, 0.0, velocity)]).x
        };
        assert_eq!([speed(1.0, 0.5, 1.0), speed(1.0, 0.5, 0.1), speed(1.0, 0.6, 1.0)], [0.0, 0.3, 0.1]);
        assert_eq!([speed(-1.0, 0.5, 1.0), speed(1.0, -1.0, 1.0), speed(-1.0, -1.0, 1.0)], [-0.1, 0.1, 0.0]);
    }

    /// A vehicle that backs up beside a person who stands was touched when the person took a step.
    #[test]
    fn a_vehicle_that_backs_up_halts_for_who_stands_beside_it() {
        let speed = |twist: f32, place: (f32, f32), velocity: f32| {
            let mut node = PersonCaution { halt: 0.4, beside: 0.3, ..node([0.0; 2]) };
            fire(&mut node, 0, Twist::new(twist, 0.0, 0.0), &[(place.0, place.1, velocity)]).x
        };
        assert_eq!([speed(-0.3, (-0.3, 0.47), 0.0), speed(-0.3, (-1.05, 0.0), 0.0)], [0.0; 2]);
        assert_eq!([speed(0.3, (-0.3, 0.47), 0.0), speed(-0.3, (-0.3, 0.55), 0.0)], [0.1, -0.3]);
        // The robot drives away from it.
        assert_eq!(speed(-0.3, (0.5, 0.0), 0.0), -0.3);
        // Who walks may touch it then, too.
        assert_eq!([speed(0.3, (-0.95, 0.0), 1.0), speed(0.3, (-1.05, 0.0), 1.0)], [0.0, 0.1]);
    }

    #[test]
    fn the_robot_leaves_those_who_stand() {
        assert_eq!([speed([0.0; 2], -1.0, (0.4, 0.0, 0.1)), speed([0.0; 2], 1.0, (-1.0, 0.0, 0.1))], [-1.0, 1.0]);
        assert_eq!([speed([0.0; 2], -1.0, (0.4, 0.0, 0.5)), speed([0.0; 2], 1.0, (-1.0, 0.0, 0.5))], [-0.1, 0.1]);
        assert_eq!(speed([0.0; 2], -1.0, (-1.0, 0.0, 0.1)), -0.1);
    }

    #[test]
    fn a_person_whom_the_robot_hides_is_remembered() {
        let mut node = node([0.0; 2]);
        let mut speed = |ms, places: &[f32]| {
            let persons: std::vec::Vec<At> = places.iter().map(|y| (-0.3, *y, 0.0)).collect();
            fire(&mut node, ms, Twist::new(1.0, 0.0, 0.0), &persons).x
        };
        assert_eq!([speed(0, &[0.35]), speed(1900, &[]), speed(2100, &[])], [0.1, 0.1, 1.0]);
        // One who has stepped aside is seen there, and one who was not close is not remembered.
        assert_eq!([speed(3000, &[0.35]), speed(3100, &[0.45]), speed(3200, &[])], [0.1, 0.3, 1.0]);
    }

    #[test]
    fn only_those_who_come_near_count_if_it_looks_ahead() {
        let speed = |twist: f32, place: Point2, velocity: Point2| {
            let mut node = PersonCaution { horizon: 2.5, ..node(LOAD) };
            let (base, twist) = (Pose2::default(), Twist::new(twist, 0.0, 0.0));
            let trailer = Articulated::PATSY.trailer(&base, 0.0);
            let persons: Persons = [Person { position: place, velocity, ..Person::default() }].into_iter().collect();
            let ctx = Ctx::new(Time::ZERO);
            node.process(&ctx, Some(&twist), Some(&base), Some(&trailer), Some(&persons)).expect("a command").x
        };
        let p = Point2::new;
        // Away behind, away ahead, and past it in a corridor.
        assert_eq!(speed(0.7, p(-1.5, 0.0), p(-1.0, 0.0)), 0.7);
        assert_eq!(speed(0.7, p(0.9, 0.0), p(1.0, 0.0)), 0.7);
        assert_eq!(speed(0.7, p(1.5, 0.95), p(-1.2, 0.0)), 0.7);
        // Towards it, across its way, and beside it.
        assert!(speed(0.7, p(1.2, 0.0), p(-1.0, 0.0)) < 0.3);
        assert!(speed(0.7, p(1.2, 1.2), p(0.0, -0.8)) < 0.5);
        assert!(speed(0.7, p(-0.3, 0.5), p(-0.5, 0.0)) < 0.2);
    }
}
