use super::RIVALS;
use apex_nodes::scan::{Point2, Pose2};
use apex_rt::Time;

/// Events of our robot in a competition.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Times at which cubes were put into our hopper.
    pub fetches: Vec<Time>,
    /// Cubes that were taken out of our hopper.
    pub deliveries: Vec<Delivery>,
    /// Collisions of our robot.
    pub collisions: Vec<Collision>,
    /// Poses of our robot, every 100 ms.
    pub trajectory: Vec<(Time, Pose2)>,
    /// Distance that our robot drove, in m.
    pub distance: f32,
    /// Results of the rivals.
    pub rivals: [Rivalry; RIVALS],
}

/// Delivery of a cube, taken out of our hopper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Delivery {
    /// Time of the delivery.
    pub at: Time,
    /// Number of the station, 1 to 4.
    pub station: u32,
    /// Number on the cube, 1 to 4.
    pub cube: u32,
}

/// Collision of our robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// Start of the collision.
    pub at: Time,
    /// Point of contact, in the frame of the arena.
    pub place: Point2,
    /// Obstacle of the collision.
    pub against: Obstacle,
    /// `true` if our robot caused it; always with a wall.
    pub caused: bool,
    /// `true` if the other robot caused it. Both may be true.
    pub suffered: bool,
}

/// Obstacle in a collision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Obstacle {
    /// Outer wall.
    Border,
    /// Wall of the filling stations.
    Island,
    /// Robot, by number: ours is 0, the rivals are 1 to 3.
    Robot(usize),
}

/// Result of a rival.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rivalry {
    /// Number of cubes delivered to the right station.
    pub points: u32,
    /// Number of collisions that the rival caused.
    pub collisions: u32,
}

impl Report {
    /// Number of cubes delivered to the station of their number.
    pub fn points(&self) -> usize {
        self.deliveries.iter().filter(|delivery| delivery.is_right()).count()
    }

    /// Number of cubes delivered to another station.
    pub fn penalties(&self) -> usize {
        self.deliveries.len() - self.points()
    }

    /// Number of collisions that our robot caused.
    pub fn caused(&self) -> usize {
        self.collisions.iter().filter(|collision| collision.caused).count()
    }

    /// Number of collisions that our robot did not cause.
    pub fn suffered(&self) -> usize {
        self.collisions.len() - self.caused()
    }
}

impl Delivery {
    /// Returns `true` if the station was that of the cube.
    pub const fn is_right(&self) -> bool {
        self.station == self.cube
    }
}
