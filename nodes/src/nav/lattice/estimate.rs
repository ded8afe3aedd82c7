use super::{
    CurveDrive,
    drive::{arcs, places},
    ends::Place,
    node::Node,
};
use crate::{
    map::{Cell, Grid, Occupancy, Raster},
    nav::{
        Terrain,
        open::Open,
        payload::dubins::{Curve, arc, shortest},
    },
    scan::Point2,
};
use core::f32::consts::SQRT_2;
use std::collections::BinaryHeap;

/// Side of a state, in m.
const SIDE: f32 = 0.2;
/// Largest number of radii by which the shortest Dubins curve is longer than the straight line.
const LONGER: f32 = 7.4;

/// Estimated distances from the nearest goal, without regard to headings.
#[derive(Debug, Clone, Default)]
pub(super) struct Estimates {
    /// Distance of each coarse cell, in m, with costs.
    cells: Grid<f32>,
    /// Cost of each metre through them, or infinity where nothing leads through.
    metres: Grid<f32>,
    open: BinaryHeap<Open>,
    goals: Vec<Place>,
}

impl Estimates {
    /// Raster of the coarse cells.
    pub fn raster(&self) -> &Raster {
        self.cells.raster()
    }

    /// Estimated distance of a point from the goal, in m: infinite where no way leads to it.
    pub fn at(&self, point: Point2) -> f32 {
        self.cells.at(point).copied().unwrap_or(f32::INFINITY)
    }

    /// Estimated cost of the way from a node to a goal, which ends forward with the heading of the goal.
    pub fn ahead(&self, vehicle: &CurveDrive, node: &Node) -> f32 {
        let least = self.at(node.pose.position());
        if node.back.is_some() {
            return least + Node::TURN;
        }
        let curve = |goal: &Place| {
            let most = goal.cost + (goal.pose.position() - node.pose.position()).norm() + LONGER * vehicle.radius;
            if most <= least { most } else { goal.cost + shortest(&node.pose, &goal.pose, vehicle.radius) }
        };
        let curve = self.goals.iter().map(curve).fold(f32::INFINITY, f32::min);
        // Otherwise, the direction changes twice.
        least.max(if vehicle.backs_up() { curve.min(least + 2.0 * Node::TURN) } else { curve })
    }

    /// Returns `true` if ways to the goal lead through all places of a curve. Most curves lead through a wall, and few
    /// places before it are worth a closer look.
    pub fn leads_along(&self, curve: &Curve) -> bool {
        let mut pose = curve.start;
        arcs(curve).all(|(curvature, length)| {
            let (count, step) = places(length);
            let part = arc(curvature, step);
            (0..count).all(|_| {
                pose = pose.compose(&part);
                self.at(pose.position()).is_finite()
            })
        })
    }

    /// Computes all distances on free cells (Dijkstra 1959). A coarse cell is open if a part of it is.
    pub fn run(&mut self, terrain: &Terrain<'_>, goals: &[Place]) {
        self.goals.clear();
        self.goals.extend_from_slice(goals);
        let fine = terrain.map.raster();
        let part = libm::roundf(SIDE / fine.resolution).max(1.0) as usize;
        let raster = Raster {
            corner: fine.corner,
            resolution: fine.resolution * part as f32,
            width: fine.width.div_ceil(part),
            height: fine.height.div_ceil(part),
        };
        // Coarser than a grid that exists.
        if self.cells.reset(raster, f32::INFINITY).is_err() || self.metres.reset(raster, f32::INFINITY).is_err() {
            return;
        }
        self.measure(terrain, part);
        for goal in goals {
            if let Some(cell) = raster.cell(goal.pose.position()) {
                self.reach(cell, goal.cost);
            }
        }
        while let Some(Open { estimate, node }) = self.open.pop() {
            let at = Cell::new(node as usize % raster.width, node as usize / raster.width);
            if self.cells.get(at).is_none_or(|known| *known < estimate) {
                continue;
            }
            for (dx, dy) in [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)] {
                // A neighbour left of or below 0 wraps to the greatest number, which no raster contains.
                let next = Cell::new(at.x.wrapping_add_signed(dx), at.y.wrapping_add_signed(dy));
                if let Some(metre) = self.metres.get(next) {
                    let length = raster.resolution * if dx != 0 && dy != 0 { SQRT_2 } else { 1.0 };
                    self.reach(next, estimate + length * metre);
                }
            }
        }
    }

    /// Finds the least cost of a metre through the open fine cells of each coarse cell.
    fn measure(&mut self, terrain: &Terrain<'_>, part: usize) {
        for (cell, occupancy) in terrain.map.iter() {
            if let Some(metre) = self.metres.get_mut(Cell::new(cell.x / part, cell.y / part))
                && *occupancy == Occupancy::Free
            {
                *metre = metre.min(1.0 + terrain.cost(cell));
            }
        }
    }

    fn reach(&mut self, cell: Cell, estimate: f32) {
        let width = self.raster().width;
        if let Some(known) = self.cells.get_mut(cell).filter(|known| estimate < **known) {
            *known = estimate;
            self.open.push(Open { estimate, node: (cell.y * width + cell.x) as u32 });
        }
    }
}
