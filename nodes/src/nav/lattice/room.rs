use super::{CurveDrive, SQUEEZED, Start};
use crate::{
    map::{Cell, DistanceTransform, Grid, Occupancy, Raster},
    nav::{
        Terrain,
        outline::{Axes, Part},
    },
    scan::{Point2, Pose2},
};
use libm::{fmaxf, hypotf, sincosf};

/// Distance between the checked points of the outline, in m.
const STEP: f32 = 0.1;
/// Distance from the start up to which a vehicle may be as near to something as it is there, in m.
const LEAVES: f32 = 0.8;
/// Error of the raster in what is too near on the way out of a narrow place, in m.
const ROUNDING: f32 = 0.02;

/// Room for a vehicle on a map.
#[derive(Debug, Clone, Default)]
pub(super) struct Room {
    transform: DistanceTransform,
    open: Grid<Occupancy>,
    /// Distances from the nearest cell that is not open, in m.
    distances: Grid<f32>,
    /// Distances of a load from the nearest cell above which it may not be, in m.
    above: Grid<f32>,
    /// Cells where the middle of the tractor may be.
    core: Grid<Occupancy>,
    start: Point2,
    /// Sums of what points of each part of the vehicle lack of the margin at the start, in m.
    crowded: [f32; 3],
}

impl Room {
    /// Measures the distances on a map. What is beneath the vehicle at the start, or beneath its load, does not count.
    pub fn measure(&mut self, terrain: &Terrain<'_>, vehicle: &CurveDrive, start: &Start) {
        let axes = vehicle.axes(&start.pose, start.trailer);
        self.open.clone_from(terrain.map);
        let raster = *terrain.map.raster();
        for (part, axis) in vehicle.outline().parts(&axes) {
            let grown = part.grown(0.5 * raster.resolution);
            cells_about(&raster, axis, &grown).for_each(|cell| {
                if let Some(open) = self.open.get_mut(cell) {
                    *open = Occupancy::Free;
                }
            });
        }
        let is_open =
            |cell: &Occupancy| *cell == Occupancy::Free || (*cell == Occupancy::Unknown && terrain.unknown_is_open);
        self.transform.run(&self.open, |cell| !is_open(cell), &mut self.distances);
        if self.open.cells().contains(&Occupancy::Low) {
            let is_beneath = |cell: &Occupancy| is_open(cell) || *cell == Occupancy::Low;
            self.transform.run(&self.open, |cell| !is_beneath(cell), &mut self.above);
        } else {
            self.above.clone_from(&self.distances);
        }
        self.start = start.pose.position();
        self.crowded = self.crowding(vehicle, &axes);
        self.draw_core(&raster, vehicle);
    }

    /// Draws where the middle of the tractor may be: nothing is within half of its width, nor within the girth of the
    /// vehicle with its load, but for what the load may be above.
    fn draw_core(&mut self, raster: &Raster, vehicle: &CurveDrive) {
        let margin = SQUEEZED * vehicle.margin - ROUNDING;
        let [half, girth] = [0.5 * vehicle.shape.width, vehicle.girth()].map(|reach| reach + margin);
        self.core.clone_from(&self.open);
        let distances = self.distances.cells().iter().zip(self.above.cells());
        for (number, (core, (distance, above))) in self.core.cells_mut().iter_mut().zip(distances).enumerate() {
            let place = raster.centre(Cell::new(number % raster.width, number / raster.width));
            let is_left = *distance > 0.0 && (place - self.start).norm_squared() <= LEAVES * LEAVES;
            let is_core = (*distance >= half && *above >= girth) || is_left;
            *core = if is_core { Occupancy::Free } else { Occupancy::Occupied };
        }
    }

    /// Map of the cells where the middle of the tractor may be.
    pub const fn core(&self) -> &Grid<Occupancy> {
        &self.core
    }

    /// Returns `true` if nothing is within the margin of the vehicle or, near the start, not more than there.
    pub fn fits(&self, vehicle: &CurveDrive, axes: &Axes) -> bool {
        let leaves = (axes[0].position() - self.start).norm_squared() <= LEAVES * LEAVES;
        let least = |crowded: f32| if leaves { crowded + ROUNDING } else { 0.0 };
        let mut parts = self.parts(vehicle, axes).zip(self.crowded);
        parts.all(|((distances, part, axis), crowded)| {
            lacking(distances, &part, axis, vehicle.margin, 0.0) <= least(crowded)
        })
    }

    /// Returns `true` if nothing is within the margin of the vehicle nor beneath it. On a way, what is beneath it has
    /// come past its border.
    pub fn is_free(&self, vehicle: &CurveDrive, axes: &Axes) -> bool {
        let is_bare = |(distances, part, axis): (&Grid<f32>, Part, &Pose2)| {
            let distance = |point: Point2| distances.at(axis.to_outer(point)).copied().unwrap_or(0.0);
            part.points(STEP).all(|point| distance(point) > 0.75 * STEP)
        };
        self.fits(vehicle, axes) && self.parts(vehicle, axes).all(is_bare)
    }

    /// Parts of the vehicle, each with the distances that count for it and with its axis.
    fn parts<'a>(
        &'a self,
        vehicle: &CurveDrive,
        axes: &'a Axes,
    ) -> impl Iterator<Item = (&'a Grid<f32>, Part, &'a Pose2)> {
        let layers = [&self.distances, &self.distances, &self.above];
        layers.into_iter().zip(vehicle.outline().parts(axes)).map(|(layer, (part, axis))| (layer, part, axis))
    }

    fn crowding(&self, vehicle: &CurveDrive, axes: &Axes) -> [f32; 3] {
        let mut crowded = [0.0; 3];
        for (sum, (distances, part, axis)) in crowded.iter_mut().zip(self.parts(vehicle, axes)) {
            *sum = lacking(distances, &part, axis, vehicle.margin, 0.0);
        }
        crowded
    }
}

/// Sum of what points of the border of a part of a vehicle lack of a margin, in m. `beyond` is the distance of points
/// outside of the grid.
pub(super) fn lacking(distances: &Grid<f32>, part: &Part, axis: &Pose2, margin: f32, beyond: f32) -> f32 {
    let (sin, cos) = sincosf(axis.theta);
    let distance = |p: Point2| {
        let place = Point2::new(axis.x + cos * p.x - sin * p.y, axis.y + sin * p.x + cos * p.y);
        distances.at(place).copied().unwrap_or(beyond)
    };
    let (middle, half) = (0.5 * (part.from + part.to), 0.5 * (part.to - part.from));
    let reach = hypotf(half, part.half) + distances.raster().resolution;
    if distance(Point2::new(middle, 0.0)) >= reach + margin {
        return 0.0;
    }
    part.border(STEP).map(|point| fmaxf(margin - distance(point), 0.0)).sum()
}

/// Cells whose middles are in a part of a vehicle.
fn cells_about<'a>(raster: &'a Raster, axis: &'a Pose2, part: &'a Part) -> impl Iterator<Item = Cell> + 'a {
    let step = 0.5 * raster.resolution;
    part.points(step).filter_map(move |point| raster.cell(axis.to_outer(point)))
}
