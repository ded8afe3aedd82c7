//! Evaluation of the obstacle detection (thesis 6.5, `obstacles.afg`) on simulated and recorded clouds (6.10.1).

mod bench;
mod figure;
mod lookout;
mod plane;
mod range;
mod rated;
mod recorded;
mod roc;
mod times;

pub use bench::{Method, SceneScores, Summary, labelled_scores};
pub use figure::SceneFigure;
pub use lookout::{LookoutTable, Outcome, drive_on};
pub use plane::Plane;
pub use range::{RANGES, RangeClass, RangeTable, Trial};
pub use rated::{RateDetection, Rating, SceneTof};
pub use recorded::{Levelled, RecordedTable, level, recorded_labels};
pub use roc::Scores;
pub use times::StepTimes;
