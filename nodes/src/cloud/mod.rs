//! Structured point clouds of depth cameras (feature `std`), the detection of obstacles in them (thesis 6.5), and
//! the verification of containers (thesis 6.6.2).
//!
//! A structured cloud has the order of the pixels of its camera: row 0 is the uppermost, column 0 the leftmost. Points
//! are in m, x forward, y left, z up. A pixel without a measurement has NaN as its coordinates.
//!
//! [`MountCloud`] turns a cloud into [`Columns`], the form in which obstacles are searched: column by column, in the
//! frame of the robot. The nodes after it keep the points and send [`Labels`], one for each point. A cloud without
//! points, with a single column, or without any measurement gives labels of the same kind; points and labels of
//! different sizes give ⊥.
//!
//! A scanner with rings sends a [`RingCloud`] for each turn. [`CompensateTurn`] makes [`Columns`] of it, too: a column
//! has the points of all rings in one direction (thesis 8.4.2).

mod bright;
mod classify;
mod cluster;
mod columns;
mod compensate;
mod container;
mod edge;
mod euclid;
mod floor;
mod fresh;
#[cfg(feature = "record")]
mod gather;
mod ground;
mod grow;
mod hazard;
mod label;
#[cfg(feature = "record")]
mod message;
mod near;
mod outline;
mod points;
mod rings;
mod rolling;
mod sides;
mod smooth;
mod upright;
mod voxel;

pub use bright::BrightFilter;
pub use classify::{ColumnClassifier, Probabilities};
pub use cluster::{Cluster, ClusterCloud, Clusters, Member};
pub use columns::{Columns, MountCloud};
pub use compensate::CompensateTurn;
pub use container::VerifyContainer;
pub use edge::EdgeFilter;
pub use euclid::EuclideanClusters;
pub use floor::{FloorFit, FloorSurface};
pub use fresh::FreshCloud;
pub use ground::RingClassifier;
pub use hazard::{Area, Hazard, HazardKind, HazardMap};
pub use label::{Label, Labels};
pub use near::NearFilter;
pub use outline::ObstacleScan;
pub use points::{CloudPoint, MAX_POINTS, PointCloud};
pub use rings::RingCloud;
pub use smooth::SmoothHeights;
pub use upright::UprightClusters;
pub use voxel::{Voxel, VoxelGrid, Voxels};
