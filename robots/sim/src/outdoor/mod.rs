//! Open country (feature `outdoor`): terrain with slopes, grass, ditches, rocks and trees; a running track through it;
//! a skid-steered base that slips and tips; a scanner with rings; a detector of persons in stereo images; an inertial
//! sensor; and a receiver of satellite navigation.
//!
//! Everything follows from a seed, on every platform. Heights are in m above the plane of the world, in which positions
//! are.

mod base;
mod gnss;
mod imu;
mod people;
mod scanner;
mod stereo;
mod terrain;
mod track;

pub use base::{Attitude, SkidBase, SkidShape};
pub use gnss::{Gnss, GnssErrors};
pub use imu::{Imu, ImuErrors};
pub use people::{Passersby, Runner, Walker};
pub use scanner::{RingScanner, Sample};
pub use stereo::StereoDetector;
pub use terrain::{Ditch, Surface, Terrain, Thing, ThingShape};
pub use track::Track;
