//! Obstacle detection in the clouds of a time-of-flight camera (thesis 6.5), and its evaluation on simulated and
//! recorded clouds (6.10.1). The graph is `obstacles.afg`.

mod bench;
mod command;
mod detector;
mod figure;
mod lookout;
mod plane;
mod range;
mod rated;
mod recorded;
mod roc;
mod scene;
mod sim_tof;
mod thing;
mod times;

pub use bench::{Method, SceneScores, Summary, labelled_scores};
pub use command::run;
pub use detector::{Detector, Weights};
pub use figure::SceneFigure;
pub use lookout::{LookoutTable, Outcome, drive_on};
pub use plane::Plane;
pub use range::{RANGES, RangeClass, RangeTable, Trial};
pub use rated::{RateDetection, Rating, SceneTof};
pub use recorded::{Levelled, RecordedTable, level, recorded_labels};
pub use roc::Scores;
pub use scene::{Scene, labelled_scene};
pub use sim_tof::SimTof;
pub use thing::Thing;
pub use times::StepTimes;

/// Compiled graphs of `obstacles.afg`.
pub mod programs {
    apex_macros::graph!("obstacles.afg");
}

/// Compiled graph of `lookout.afg`.
mod lookout_programs {
    apex_macros::graph!("lookout.afg");
}
