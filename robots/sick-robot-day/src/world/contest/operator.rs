use super::body::Body;
use crate::world::{Arena, Station};
use apex_nodes::{math::normalize_angle, scan::Pose2};
use apex_rt::Time;
use apex_sim::Random;
use std::{f32::consts::PI, time::Duration};

/// Maximum distances of a robot at a station from the wall and sideways from the target, in m, and maximum heading
/// error, in rad.
const GAP: f32 = 0.08;
const BESIDE: f32 = 0.1;
const ASKEW: f32 = PI / 9.0;

/// Human operator who serves a robot that shows its lamp at a station: puts a cube in, or takes it out.
#[derive(Debug, Clone)]
pub(super) struct Operator {
    random: Random,
    /// Station in service, and the time when the service is finished.
    due: Option<(usize, Time)>,
}

impl Operator {
    pub const fn new(random: Random) -> Self {
        Self { random, due: None }
    }

    /// Station at which the service of the robot is finished now. The duration is drawn when the operator notices the
    /// lamp.
    pub fn watch(&mut self, body: &Body, arena: &Arena, now: Time) -> Option<usize> {
        let Some(station) = asks(body, arena) else {
            self.due = None;
            return None;
        };
        let (at, time) = match self.due {
            Some(due) if due.0 == station => due,
            _ => (station, now + Duration::from_secs_f32(self.random.uniform(2.0, 8.0))),
        };
        self.due = (now < time).then_some((at, time));
        (now >= time).then_some(at)
    }
}

/// Station at which a robot requests service and can be served.
fn asks(body: &Body, arena: &Arena) -> Option<usize> {
    if !body.lamp || !body.stands() {
        return None;
    }
    let full = body.cube.is_some();
    arena.stations().position(|station| station.number.is_some() == full && is_at(&body.pose(), body.radius, station))
}

/// Returns `true` if a robot is correctly positioned at a station: near enough, in front of its target, and straight.
fn is_at(robot: &Pose2, radius: f32, station: &Station) -> bool {
    let place = station.pose.to_inner(robot.position());
    let askew = normalize_angle(&(robot.theta - station.pose.theta - PI));
    place.x > 0.0 && place.x - radius <= GAP && place.y.abs() <= BESIDE && askew.abs() <= ASKEW
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::scan::Point2;

    #[test]
    fn a_robot_stands_right_only_near_before_and_straight() {
        let station = Station { pose: Pose2::new(1.0, 2.0, 0.5), number: None };
        let at = |gap: f32, beside: f32, askew: f32| {
            let place = station.pose.to_outer(Point2::new(0.3 + gap, beside));
            is_at(&Pose2::new(place.x, place.y, 0.5 + PI + askew), 0.3, &station)
        };
        assert!(at(0.05, 0.0, 0.0) && at(0.07, 0.09, 0.3) && at(0.01, -0.09, -0.3));
        assert!(!at(0.09, 0.0, 0.0) && !at(0.05, 0.11, 0.0) && !at(0.05, -0.11, 0.0));
        assert!(!at(0.05, 0.0, 0.4) && !at(0.05, 0.0, -0.4) && !at(0.05, 0.0, PI));
    }
}
