use crate::world::Thing;
use apex_nodes::{math::normalize_angle, scan::Pose2};
use apex_rt::Time;
use std::time::Duration;

/// Events of the vehicle in the clinic.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Containers that were set down, at their destination or elsewhere. One that is lifted again before the vehicle
    /// has left it does not count.
    pub deliveries: Vec<Delivery>,
    /// Times at which the lift began to rise beneath nothing.
    pub empty_lifts: Vec<Time>,
    /// Times at which the vehicle had been beneath a container that it does not carry for [`WEDGED`] and had moved by
    /// less than 0.3 m.
    pub wedges: Vec<Time>,
    /// Contacts with people while the vehicle drove.
    pub contacts: Vec<Contact>,
    /// Times at which the vehicle fell down the stairs: at most one, as it stays there.
    pub falls: Vec<Time>,
    /// Small things that the vehicle drove over, and when.
    pub run_over: Vec<(Time, Thing)>,
    /// Times at which the vehicle drove against walls, furniture or containers.
    pub bumps: Vec<Time>,
    /// Number of orders that were given back.
    pub refused: usize,
    /// Distance that the vehicle drove, in m.
    pub distance: f32,
    /// Poses of the tractor, every 200 ms.
    pub trajectory: Vec<(Time, Pose2)>,
}

/// Container that was set down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delivery {
    /// Time.
    pub at: Time,
    /// Number of the container.
    pub container: usize,
    /// Destination of the order; `None` if another container was ordered.
    pub destination: Option<Pose2>,
    /// Distance of the container from its destination when it was set down, and then when the vehicle had left it, in
    /// m; infinite without one.
    pub offset: f32,
    /// Angle between the container and its destination, in rad, at most a quarter of a turn: its ends are alike.
    pub turn: f32,
    /// Time at which no part of the vehicle was beneath it any more.
    pub left: Option<Time>,
}

/// Contact with a person.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Time at which it began.
    pub at: Time,
    /// Number of the person.
    pub person: usize,
    /// Pose of the tractor.
    pub pose: Pose2,
}

/// Greatest distance of a delivered container from its destination, in m, and greatest angle, in rad.
const NEAR: [f32; 2] = [0.3, 10.0 * core::f32::consts::PI / 180.0];
/// Time for which a vehicle stands beneath a container before it counts as wedged.
pub const WEDGED: Duration = Duration::from_secs(20);

impl Delivery {
    /// Notes the pose of the container.
    pub(super) fn stands_at(&mut self, pose: &Pose2) {
        let Some(destination) = &self.destination else { return };
        let off = pose.relative_to(destination);
        (self.offset, self.turn) = (off.position().norm(), 0.5 * normalize_angle(&(2.0 * off.theta)));
    }

    /// Returns `true` if the container stands at its destination and the vehicle got away from it.
    pub fn is_right(&self) -> bool {
        self.offset <= NEAR[0] && self.turn.abs() <= NEAR[1] && self.left.is_some()
    }
}

impl Report {
    /// Number of containers that were brought to their destination.
    pub fn delivered(&self) -> usize {
        self.deliveries.iter().filter(|delivery| delivery.is_right()).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_pushed_away_before_the_vehicle_has_left_it_is_not_delivered() {
        let destination = Some(Pose2::new(3.0, 4.0, 0.1));
        let mut delivery = Delivery {
            at: Time::ZERO,
            container: 0,
            destination,
            offset: f32::INFINITY,
            turn: 0.0,
            left: Some(Time::ZERO),
        };
        delivery.stands_at(&Pose2::new(3.0, 4.2, 0.1 - core::f32::consts::PI));
        assert!(delivery.is_right() && (delivery.offset - 0.2).abs() < 1e-5, "its ends are alike");
        delivery.stands_at(&Pose2::new(3.0, 4.2, 0.4));
        assert!(!delivery.is_right());
    }

    #[test]
    fn only_what_stands_right_and_was_left_is_delivered() {
        let right = Delivery {
            at: Time::ZERO,
            container: 0,
            destination: None,
            offset: 0.2,
            turn: -0.1,
            left: Some(Time::from_secs(9)),
        };
        let wrong = [
            Delivery { offset: 0.31, ..right },
            Delivery { turn: 0.2, ..right },
            Delivery { left: None, ..right },
            Delivery { offset: f32::INFINITY, ..right },
        ];
        assert!(right.is_right() && !wrong.iter().any(Delivery::is_right));
        let mut deliveries = wrong.to_vec();
        deliveries.push(right);
        assert_eq!(Report { deliveries, ..Report::default() }.delivered(), 1);
    }
}
