//! Planning for vehicles that drive in curves.

mod drive;
mod ends;
mod estimate;
mod footing;
mod ground;
mod node;
mod planner;
mod room;
mod search;
mod states;
mod vehicle;
mod way;

pub use ends::{Goal, Start};
pub use ground::{Floor, Ground};
pub use planner::CurvePlanner;
pub use search::CurveSearch;
pub use vehicle::CurveDrive;
pub use way::{Section, Way};
