//! Persons around a robot (thesis 6.8): the detection of their legs in laser scans, and their tracking over time.
//!
//! The types have fixed capacities and need no heap. All positions are in one fixed frame, such as that of odometry.

mod choice;
mod detection;
mod hypotheses;
mod kalman;
mod leaf;
mod legs;
mod motion;
mod place;
mod shape;
mod target;
mod tracker;
mod walkers;
mod wheels;

pub use detection::{Detections, MAX_DETECTIONS, MAX_PERSONS, Person, Persons, View};
pub use hypotheses::{Hypotheses, MAX_BRANCHES, Model, Sensor};
pub use leaf::{MAX_DEPTH, MAX_HYPOTHESES};
pub use legs::{Leg, LegDetector, LegPairs, Legs};
pub use motion::Motion;
pub use place::PlaceDetections;
pub use shape::{LEG_FEATURES, leg_features};
pub use target::TrackTarget;
pub use tracker::{PersonTracker, UntimelyDetections};
pub use walkers::HideWalkers;
pub use wheels::DropWheels;

/// Model for [`LegDetector`]. Trained by the example `train_legs` on scans that it simulates.
pub const LEGS: &[u8] = include_bytes!("legs.forest");
