use crate::obstacles::Thing;
use apex_nodes::scan::Pose2;
use apex_rt::Time;

/// Events of the vehicle in the clinic.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Containers that were set down, at their destination or elsewhere.
    pub deliveries: Vec<Delivery>,
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
    /// Distance of the container from the destination of the order, in m.
    pub offset: f32,
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

/// Greatest distance of a delivered container from its destination, in m.
const NEAR: f32 = 0.5;

impl Delivery {
    /// Returns `true` if the container is at its destination.
    pub fn is_right(&self) -> bool {
        self.offset <= NEAR
    }
}

impl Report {
    /// Number of containers that were brought to their destination.
    pub fn delivered(&self) -> usize {
        self.deliveries.iter().filter(|delivery| delivery.is_right()).count()
    }
}
