//! A robot that explores an unknown field and charges its battery at a base station (thesis 8.3), in simulation: the
//! robot as `planet.afg`, its [world], and [experiments] with it.

pub mod experiments;
pub mod world;

/// The robot of `planet.afg`.
pub mod robot {
    apex_macros::graph!("planet.afg");
}

/// Drawing of a small field, for tests.
pub const YARD: &str = include_str!("../yard.txt");

/// The mission in a drawn field, with the tests of `yard.afg`.
#[cfg(test)]
mod yard {
    apex_macros::graph!("yard.afg");
}

#[cfg(test)]
mod tests {
    use super::robot::Explorer;
    use apex_rt::Program;
    use apex_sim::experiment::instances_of;

    /// Most instances of nodes are those of the library: only the drivers and the referee are the robot's.
    #[test]
    fn most_nodes_are_reused() {
        let info = &<Explorer as Program>::INFO;
        let own = ["Scanner", "Wheels", "Charge", "ColorEye", "Motors", "Judge"];
        let ours = instances_of(info, &own);
        assert_eq!(ours, own.len());
        let share = 1.0 - ours as f32 / info.nodes.len() as f32;
        assert!(share >= 0.6, "{share} of {}", info.nodes.len());
        println!("{} of {} instances are those of the library", info.nodes.len() - ours, info.nodes.len());
    }
}
