//! A skid-steered robot that follows a runner outdoors at running speed (thesis 8.4), in simulation: the robot as
//! `follow.afg`, its [world], and [experiments] with it.

pub mod experiments;
pub mod world;

use apex_nodes::{
    map::{Grid, Occupancy, Raster},
    nav::Twist,
    persons::Person,
    scan::Point2,
};
use apex_rt::node;

/// Person seven metres ahead, for tests.
pub const AHEAD: Person = person_at(7.0);
/// Person whose place is not a number, for tests.
pub const NOWHERE: Person = person_at(f32::NAN);

const fn person_at(x: f32) -> Person {
    Person { id: 1, position: Point2::new(x, 0.0), velocity: Point2::new(0.0, 0.0), deviation: 0.1, presence: 1.0 }
}

/// The robot of `follow.afg`.
pub mod robot {
    apex_macros::graph!("follow.afg");
}

/// Perception on its own: `perceive.afg`.
pub mod perception {
    apex_macros::graph!("perceive.afg");
}

/// Position of a person.
#[node]
pub fn place_of(person: &Person) -> Point2 {
    person.position
}

/// Twists that lead forward.
#[node]
pub fn forward(twist: &Twist) -> Option<Twist> {
    Some(*twist).filter(|twist| twist.x > 0.0)
}

/// Map of open ground of 24 m by 24 m around the origin, for tests.
#[node]
pub fn meadow() -> Grid<Occupancy> {
    let raster = Raster { corner: Point2::new(-12.0, -12.0), resolution: 0.2, width: 120, height: 120 };
    Grid::new(raster, Occupancy::Free).unwrap_or_default()
}

/// Following on its own, with the tests of `follow_person.afg`.
#[cfg(test)]
mod follow_person {
    apex_macros::graph!("follow_person.afg");
}

#[cfg(test)]
mod tests {
    use super::robot::Summit;
    use apex_rt::Program;
    use apex_sim::experiment::instances_of;

    /// Most instances of nodes are those of the library: only the drivers, the referee and two conversions are the
    /// robot's.
    #[test]
    fn most_nodes_are_reused() {
        let info = &<Summit as Program>::INFO;
        let own = ["Scanner", "Odometry", "Wheels", "Imu", "Gnss", "Camera", "Motors", "Judge", "place_of", "forward"];
        let ours = instances_of(info, &own);
        // Each of the three instances of `FollowPerson` has a `forward`.
        assert_eq!(ours, own.len() + 2);
        let share = 1.0 - ours as f32 / info.nodes.len() as f32;
        assert!(share >= 0.6, "{share} of {}", info.nodes.len());
        println!("{} of {} instances are those of the library", info.nodes.len() - ours, info.nodes.len());
    }
}
