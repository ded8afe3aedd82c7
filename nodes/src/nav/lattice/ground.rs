use crate::{
    map::{Grid, Occupancy},
    nav::{Clearance, Terrain},
    scan::Pose2,
};

/// Floor that a camera has seen.
#[derive(Debug, Clone, Copy)]
pub struct Floor<'a> {
    /// Map such as that of `HazardMap`. Backward the vehicle drives only where it is free, as no camera looks behind.
    pub map: &'a Grid<Occupancy>,
    /// Pose of the vehicle at the start, in the frame of the terrain and in that of the floor.
    pub start: [Pose2; 2],
    /// Distances that `SweepStop` keeps from hazards.
    pub clearance: Clearance,
}

/// Ground on which a vehicle may drive.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// Map with costs.
    pub terrain: Terrain<'a>,
    /// Floor with its hazards; `None` if it need not be known.
    pub floor: Option<Floor<'a>>,
}
