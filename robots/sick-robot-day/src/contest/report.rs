use super::RIVALS;
use apex_nodes::scan::{Point2, Pose2};
use apex_rt::Time;

/// What happened to our robot so far.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Cubes that were put into our hopper: when.
    pub fetches: Vec<Time>,
    /// Cubes that were taken out of our hopper.
    pub deliveries: Vec<Delivery>,
    /// Collisions of ours.
    pub collisions: Vec<Collision>,
    /// Where our robot was, every 100 ms.
    pub trajectory: Vec<(Time, Pose2)>,
    /// How far our robot drove, in m.
    pub distance: f32,
    /// How well the others did.
    pub rivals: [Rivalry; RIVALS],
}

/// A cube that was taken out of our hopper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Delivery {
    /// When.
    pub at: Time,
    /// The number of the station, 1 to 4.
    pub station: u32,
    /// The number on the cube, 1 to 4.
    pub cube: u32,
}

/// A collision of our robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// When it began.
    pub at: Time,
    /// Where they touched, in the frame of the arena.
    pub place: Point2,
    /// What our robot collided with.
    pub against: Obstacle,
    /// Whether our robot drove into it; always with a wall.
    pub caused: bool,
    /// Whether it drove into our robot. Both may be.
    pub suffered: bool,
}

/// What a robot can collide with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Obstacle {
    /// The outer wall.
    Border,
    /// The wall of the filling stations.
    Island,
    /// Another robot: ours is 0, the rivals are 1 to 3.
    Robot(usize),
}

/// What a rival achieved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rivalry {
    /// Cubes that it delivered to the right station.
    pub points: u32,
    /// Collisions that it caused.
    pub collisions: u32,
}

impl Report {
    /// Cubes delivered to the station of their number.
    pub fn points(&self) -> usize {
        self.deliveries.iter().filter(|delivery| delivery.is_right()).count()
    }

    /// Cubes delivered to another station.
    pub fn penalties(&self) -> usize {
        self.deliveries.len() - self.points()
    }

    /// Collisions that our robot caused.
    pub fn caused(&self) -> usize {
        self.collisions.iter().filter(|collision| collision.caused).count()
    }

    /// Collisions that our robot did not cause.
    pub fn suffered(&self) -> usize {
        self.collisions.len() - self.caused()
    }
}

impl Delivery {
    /// Whether it was the station of the cube.
    pub const fn is_right(&self) -> bool {
        self.station == self.cube
    }
}
