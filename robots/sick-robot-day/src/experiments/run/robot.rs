use crate::{
    experiments::KnowledgeLog,
    programs::{Competition, CompetitionParts, SdfCompetition, SdfCompetitionParts},
    world::contest::{Drivers, Hall},
};
use apex_rt::Program;

/// Robot that takes part in the competition.
pub trait Robot: Program {
    /// Names of the nodes that send images.
    const CAMERAS: [&'static str; 2];

    /// Creates the robot in a hall.
    fn in_hall(hall: &Hall) -> Self;

    /// Knowledge of the robot.
    fn knowledge_log(&self) -> &KnowledgeLog;
}

/// The robots differ in their missions only.
macro_rules! robot {
    ($robot:ident, $parts:ident) => {
        impl Robot for $robot {
            const CAMERAS: [&'static str; 2] = ["eye", "basket"];

            fn in_hall(hall: &Hall) -> Self {
                let drivers = Drivers::new(hall);
                Self::new($parts {
                    front: drivers.front_laser,
                    rear: drivers.rear_laser,
                    wheels: drivers.wheel_odometry,
                    eye: drivers.front_camera,
                    basket: drivers.hopper_camera,
                    remote: drivers.remote,
                    base: drivers.base,
                    lamp: drivers.lamp,
                })
            }

            fn knowledge_log(&self) -> &KnowledgeLog {
                &self.nodes().knowledge_log
            }
        }
    };
}

robot!(Competition, CompetitionParts);
robot!(SdfCompetition, SdfCompetitionParts);
