use super::{Twist, path::nearest_on};
use crate::{
    persons::Persons,
    scan::{Point2, Pose2},
};
use apex_rt::{Ctx, Time, node};
use heapless::Vec;
use libm::{fmaxf, fminf};

/// Maximum number of persons beside the robot that are remembered.
const MAX_KEPT: usize = 8;
/// Distance up to which a person is one that is remembered, in m.
const SAME: f32 = 0.5;

/// Slows a robot down near persons (thesis 6.8), the more the nearer they are, also behind and beside it.
///
/// Distances are those from the middle line of the robot: from `front` before its origin to `rear` behind it, or with a
/// `trailer` over both axes to `rear` behind that of the trailer. `persons`, `pose` and `trailer` are in one frame.
/// Without persons or a pose, for example before the first scan, the robot keeps to `min_speed`. It still moves with
/// persons beside it: that it stops before them is the task of a safety field.
#[node]
#[derive(Debug, Clone)]
pub struct PersonCaution {
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
    /// Distance from the origin to the front of the robot.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    front: f32,
    /// Distance from the origin, or from the axis of the trailer, back to the rear.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    rear: f32,
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
        twist: &Twist,
        pose: Option<&Pose2>,
        trailer: Option<&Pose2>,
        persons: Option<&Persons>,
    ) -> Twist {
        let Some((pose, persons)) = pose.zip(persons) else { return twist.slowed_to(self.min_speed) };
        let line = self.middle_line(pose, trailer.unwrap_or(pose));
        self.forget(ctx.now(), persons);
        let is_hidden = self.kept.iter().any(|kept| distance(kept.place, &line) < self.beside);
        let mut speed = if is_hidden { self.min_speed } else { f32::INFINITY };
        for person in persons.iter() {
            let distance = distance(person.position, &line);
            if distance < self.beside {
                // Does not matter if it is full: the robot is slow already.
                let _ = self.kept.push(Kept { place: person.position, seen: ctx.now() });
                speed = fminf(speed, self.min_speed);
            } else {
                // Not for what is not a number.
                let stands = person.velocity.norm() < self.walking && distance >= self.beside;
                let least = if stands { fmaxf(self.min_speed, self.standing_speed) } else { self.min_speed };
                speed = fminf(speed, least + self.gain * fmaxf(distance - self.near, 0.0));
            }
        }
        twist.slowed_to(speed)
    }

    /// Forgets those who are seen again or were seen too long ago.
    fn forget(&mut self, now: Time, persons: &Persons) {
        let memory = self.memory;
        let is_seen = |kept: &Kept| persons.iter().any(|person| (person.position - kept.place).norm() < SAME);
        self.kept.retain(|kept| now.since(kept.seen).as_secs_f32() < memory && !is_seen(kept));
    }

    /// Line from the front of the robot over both axes to the rear.
    fn middle_line(&self, pose: &Pose2, trailer: &Pose2) -> [Point2; 4] {
        let on_axis = |axis: &Pose2, x| axis.to_outer(Point2::new(x, 0.0));
        [on_axis(pose, self.front), pose.position(), trailer.position(), on_axis(trailer, -self.rear)]
    }
}

/// Distance of a point from a line through others.
fn distance(point: Point2, line: &[Point2]) -> f32 {
    let parts = line.windows(2).map(|ends| (point - nearest_on(ends[0], ends[1], point)).norm());
    parts.fold(f32::INFINITY, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{persons::Person, scan::Point2};
    use apex_rt::Construct;

    #[test]
    fn it_is_slow_near_persons() {
        let mut node = PersonCaution::construct((0.5, 0.2, 0.2, 0.0, 0.0, 0.3, 0.4, 0.0, 0.0));
        let (twist, pose) = (Twist::new(1.0, 0.0, 0.5), Pose2::new(1.0, 1.0, 2.0));
        let mut at = |persons: &[(f32, f32)]| {
            let persons: Persons =
                persons.iter().map(|(x, y)| Person { position: Point2::new(*x, *y), ..Person::default() }).collect();
            node.process(&Ctx::new(Time::ZERO), &twist, Some(&pose), None, Some(&persons))
        };
        assert_eq!(at(&[]), twist);
        assert_eq!(at(&[(9.0, 1.0)]), twist);
        let near = at(&[(9.0, 1.0), (1.0, 2.0)]);
        assert!((near.x - 0.4).abs() < 1e-6 && (near.omega - 0.2).abs() < 1e-6, "{near:?}");
        assert!((at(&[(1.1, 1.0)]).x - 0.2).abs() < 1e-6);
        assert!((node.process(&Ctx::new(Time::ZERO), &twist, Some(&pose), None, None).x - 0.2).abs() < 1e-6);
        assert!((node.process(&Ctx::new(Time::ZERO), &twist, None, None, None).x - 0.2).abs() < 1e-6);
    }

    #[test]
    fn persons_beside_the_trailer_are_near() {
        let mut node = PersonCaution::construct((0.5, 0.2, 0.2, 0.0, 0.0, 0.3, 0.4, 0.0, 0.0));
        let (twist, pose, trailer) = (Twist::new(1.0, 0.0, 0.0), Pose2::default(), Pose2::new(-0.7, 0.0, 0.0));
        let persons: Persons =
            core::iter::once(Person { position: Point2::new(-0.6, 0.7), ..Person::default() }).collect();
        let mut speed = |trailer| node.process(&Ctx::new(Time::ZERO), &twist, Some(&pose), trailer, Some(&persons)).x;
        assert!((speed(Some(&trailer)) - 0.28).abs() < 1e-6);
        assert!(speed(None) > 0.36);
    }

    #[test]
    fn persons_who_stand_are_passed_faster_unless_they_are_close() {
        let mut node = PersonCaution::construct((0.5, 0.1, 0.3, 0.2, 0.0, 0.2, 0.4, 0.3, 0.2));
        let mut speed = |x: f32, velocity: f32| {
            let (position, velocity) = (Point2::new(x, 0.0), Point2::new(0.0, velocity));
            let persons: Persons = core::iter::once(Person { position, velocity, ..Person::default() }).collect();
            node.process(
                &Ctx::new(Time::ZERO),
                &Twist::new(1.0, 0.0, 0.0),
                Some(&Pose2::default()),
                None,
                Some(&persons),
            )
            .x
        };
        assert_eq!([speed(0.6, 0.1), speed(0.6, -0.5), speed(0.45, 0.1)], [0.3, 0.1, 0.1]);
        assert_eq!([speed(-0.5, 0.1), speed(-0.35, 0.1)], [0.3, 0.1]);
    }

    #[test]
    fn a_person_whom_the_robot_hides_is_remembered() {
        let mut node = PersonCaution::construct((0.5, 0.1, 0.3, 0.5, 2.0, 0.2, 0.4, 0.0, 0.0));
        let mut speed = |ms, places: &[f32]| {
            let person = |y: &f32| Person { position: Point2::new(0.0, *y), ..Person::default() };
            let persons: Persons = places.iter().map(person).collect();
            let ctx = Ctx::new(Time::from_millis(ms));
            node.process(&ctx, &Twist::new(1.0, 0.0, 0.0), Some(&Pose2::default()), None, Some(&persons)).x
        };
        assert_eq!([speed(0, &[0.4]), speed(1900, &[]), speed(2100, &[])], [0.1, 0.1, 1.0]);
        // One who has stepped aside is seen there, and one who was not close is not remembered.
        assert_eq!([speed(3000, &[0.4]), speed(3100, &[0.5]), speed(3200, &[])], [0.1, 0.3, 1.0]);
    }
}
