use super::{CurveDrive, Floor, Start, room::lacking};
use crate::{
    map::{DistanceTransform, Grid},
    nav::{
        Clearance,
        clearance::SLACK,
        near::Near,
        outline::{Axes, Part},
    },
    scan::{Point2, Pose2},
};

/// Distance by which a hazard that is near at the start may come nearer, in m.
const GRAZE: f32 = 0.005;
/// Distance from the start up to which hazards that are near there count, in m.
const LEAVES: f32 = 1.5;

/// Floor that a vehicle may drive over, as `SweepStop` judges it.
#[derive(Debug, Clone)]
pub(super) struct Footing {
    transform: DistanceTransform,
    cells: Grid<bool>,
    /// Hazards on ways forward, and backward.
    layers: [Layer; 2],
    /// Rotation and displacement from the frame of the map to that of the floor.
    turn: Pose2,
    start: Point2,
    clearance: Clearance,
}

/// Kind of hazards.
#[derive(Debug, Clone, Default)]
struct Layer {
    /// Distances from the hazards that are not near at the start, in m.
    distances: Grid<f32>,
    /// Those that are.
    near: Near,
}

impl Default for Footing {
    fn default() -> Self {
        Self {
            transform: DistanceTransform::default(),
            cells: Grid::default(),
            layers: Default::default(),
            turn: Pose2::default(),
            start: Point2::default(),
            clearance: Clearance::PATSY,
        }
    }
}

impl Footing {
    /// Finds the hazards on the floor.
    pub fn measure(&mut self, floor: &Floor<'_>, vehicle: &CurveDrive, start: &Start) {
        let [here, there] = floor.start;
        self.turn = there.compose(&Pose2::default().relative_to(&here));
        self.clearance = floor.clearance.widened(SLACK);
        let axes = self.turned(&vehicle.axes(&start.pose, start.trailer));
        self.start = axes[0].position();
        let raster = *floor.map.raster();
        for (is_backward, layer) in [false, true].into_iter().zip(&mut self.layers) {
            let zone = self.clearance.zone(vehicle.shape, is_backward);
            let hazards = self.clearance.hazards(floor.map, vehicle.shape, &axes, is_backward);
            layer.near.find(&zone, &axes, 0.0, hazards);
            self.cells.reset_like(floor.map, false);
            let stance = zone.grown.at(&axes);
            for (place, margin) in self.clearance.hazards(floor.map, vehicle.shape, &axes, is_backward) {
                let cell = raster.cell(place).and_then(|cell| self.cells.get_mut(cell));
                if let Some(cell) = cell.filter(|_| stance.distance(place) >= margin) {
                    *cell = true;
                }
            }
            self.transform.run(&self.cells, |is_hazard| *is_hazard, &mut layer.distances);
        }
    }

    /// Returns `true` if the vehicle keeps its clearance at a place on a way forward or backward.
    pub fn fits(&self, vehicle: &CurveDrive, axes: &Axes, is_backward: bool) -> bool {
        let (axes, zone) = (self.turned(axes), self.clearance.zone(vehicle.shape, is_backward));
        let Layer { distances, near } = &self.layers[usize::from(is_backward)];
        let leaves = (axes[0].position() - self.start).norm_squared() <= LEAVES * LEAVES;
        let beyond = if is_backward { 0.0 } else { f32::INFINITY };
        let is_free =
            |(part, axis): (Part, &Pose2)| lacking(distances, &part, axis, [self.clearance.side, beyond], 0.0) == 0.0;
        zone.grown.parts(&axes).all(is_free) && !(leaves && near.is_met(&zone, &axes, f32::INFINITY, GRAZE))
    }

    /// Poses in the frame of the floor.
    fn turned(&self, axes: &Axes) -> Axes {
        axes.map(|axis| self.turn.compose(&axis))
    }
}
