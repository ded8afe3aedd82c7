use super::{CurveDrive, Start};
use crate::{
    map::{Cell, DistanceTransform, Grid, Occupancy, Raster},
    nav::{
        Articulated, Terrain,
        outline::{Axes, Part},
    },
    scan::{Point2, Pose2},
};
use libm::{fabsf, fmaxf, fminf, hypotf};

/// Part of the margin that is kept in a fine search.
pub(super) const SQUEEZED: f32 = 0.7;
/// Distance between the checked points of the outline, in m.
const STEP: f32 = 0.1;
/// Distance from the start up to which a vehicle may be as near to something as it is there, in m.
const LEAVES: f32 = 0.8;
/// Error of the raster in what is too near on the way out of a narrow place, in m.
const ROUNDING: f32 = 0.02;
/// Greatest number of sections of a part.
const SECTIONS: usize = 4;

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
    /// Cells where the middle of a load may be, and distances from the nearest of them, in m.
    holds: Grid<bool>,
    from_load: Grid<f32>,
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
    /// vehicle with its load, but for what the load may be above, and there is a place for the middle of the load.
    fn draw_core(&mut self, raster: &Raster, vehicle: &CurveDrive) {
        let margin = SQUEEZED * vehicle.margin - ROUNDING;
        let [half, girth] = [0.5 * vehicle.shape.width, vehicle.girth()].map(|reach| reach + margin);
        self.core.clone_from(&self.open);
        let leash = self.find_places_of_load(vehicle, margin - raster.resolution);
        let distances = self.distances.cells().iter().zip(self.above.cells());
        for (number, (core, (distance, above))) in self.core.cells_mut().iter_mut().zip(distances).enumerate() {
            let place = raster.centre(Cell::new(number % raster.width, number / raster.width));
            let is_left = *distance > 0.0 && (place - self.start).norm_squared() <= LEAVES * LEAVES;
            let is_led = leash.is_none_or(|leash| self.from_load.cells()[number] <= leash);
            let is_core = (*distance >= half && *above >= girth && is_led) || is_left;
            *core = if is_core { Occupancy::Free } else { Occupancy::Occupied };
        }
    }

    /// Measures the distances from the places where a load has room on all sides, and returns the distance up to which
    /// the tractor is from one of them, in m. `None` without a load.
    fn find_places_of_load(&mut self, vehicle: &CurveDrive, margin: f32) -> Option<f32> {
        let [length, width] = vehicle.load;
        let Articulated { hitch, drawbar, .. } = vehicle.shape;
        let reach = 0.5 * fminf(length, width) + margin;
        self.holds.reset_like(&self.above, false);
        for (holds, above) in self.holds.cells_mut().iter_mut().zip(self.above.cells()) {
            *holds = *above >= reach;
        }
        let leash = hitch + fabsf(drawbar - vehicle.shape.lift()) + self.above.raster().resolution;
        (width > 0.0).then(|| {
            self.transform.run(&self.holds, |holds| *holds, &mut self.from_load);
            leash
        })
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
            let most = least(crowded);
            lacking(distances, &part, axis, [vehicle.margin, 0.0], most) <= most
        })
    }

    /// Returns `true` if nothing is within the margin of the vehicle nor beneath it. On a way, what is beneath it has
    /// come past its border.
    pub fn is_free(&self, vehicle: &CurveDrive, axes: &Axes) -> bool {
        let is_bare = |(distances, part, axis): (&Grid<f32>, Part, &Pose2)| {
            let axis = axis.transform();
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
            *sum = lacking(distances, &part, axis, [vehicle.margin, 0.0], f32::INFINITY);
        }
        crowded
    }
}

/// Sum of what points of the border of a part of a vehicle lack of a margin, in m, or of so many that it is more
/// than `most`. `beyond` is the distance of points outside of the grid.
pub(super) fn lacking(distances: &Grid<f32>, part: &Part, axis: &Pose2, [margin, beyond]: [f32; 2], most: f32) -> f32 {
    let axis = axis.transform();
    let distance = |point: Point2| distances.at(axis.to_outer(point)).copied().unwrap_or(beyond);
    let length = part.to - part.from;
    // About as long as wide. Where nothing is near the middle of a section, nothing is near its border.
    let sections = libm::ceilf(0.5 * length / part.half).clamp(1.0, SECTIONS as f32);
    let half = 0.5 * length / sections;
    let reach = hypotf(half, part.half) + distances.raster().resolution + margin;
    let mut is_clear = [true; SECTIONS];
    for (i, is_clear) in is_clear.iter_mut().enumerate().take(sections as usize) {
        *is_clear = distance(Point2::new(part.from + (2.0 * i as f32 + 1.0) * half, 0.0)) >= reach;
    }
    if is_clear == [true; SECTIONS] {
        return 0.0;
    }
    let section = |point: &Point2| (0.5 * (point.x - part.from) / half) as usize;
    let mut sum = 0.0;
    for point in part.border(STEP).filter(|point| !is_clear[section(point).min(sections as usize - 1)]) {
        sum += fmaxf(margin - distance(point), 0.0);
        if sum > most {
            break;
        }
    }
    sum
}

/// Cells whose middles are in a part of a vehicle.
fn cells_about<'a>(raster: &'a Raster, axis: &Pose2, part: &'a Part) -> impl Iterator<Item = Cell> + use<'a> {
    let axis = axis.transform();
    let step = 0.5 * raster.resolution;
    part.points(step).filter_map(move |point| raster.cell(axis.to_outer(point)))
}
