use super::{PlanOptions, ReadError, read_plan};
use crate::{
    map::{Grid, Occupancy, Raster, TooManyCells, VectorMap},
    scan::Point2,
};
use apex_rt::{Out, node};
use core::fmt;

/// Distance that the map reaches beyond the plan, in m.
const MARGIN: f32 = 1.0;

/// Draws a plan as a grid map, on which a path can be planned: cells of walls are occupied, all others free.
///
/// # Errors
/// If the map would have too many cells.
pub fn draw_plan(plan: &VectorMap, resolution: f32, map: &mut Grid<Occupancy>) -> Result<(), TooManyCells> {
    let corners: Vec<Point2> = plan.bounds().into_iter().flat_map(|(low, high)| [low, high]).collect();
    let raster = Raster::around(corners, MARGIN, resolution);
    map.reset(raster, Occupancy::Free)?;
    for segment in plan.segments() {
        let (Some(a), Some(b)) = (raster.cell(segment.a), raster.cell(segment.b)) else { continue };
        for cell in Raster::line(a, b) {
            if let Some(place) = map.get_mut(cell) {
                *place = Occupancy::Occupied;
            }
        }
    }
    Ok(())
}

/// Error of a [`PlanMap`] without a map.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanMapError {
    /// The plan cannot be read.
    Plan(ReadError),
    /// The plan is too large for its resolution.
    Size(TooManyCells),
}

impl fmt::Display for PlanMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::Size(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for PlanMapError {}

/// Grid map of a plan (see [`draw_plan`]): a source, which sends it in each firing.
///
/// Fails once if there is no valid plan, and then sends ⊥.
#[node]
#[derive(Debug, Clone)]
pub struct PlanMap {
    /// File of the plan (see [`read_plan`]).
    #[param]
    plan: &'static str,
    /// Layers of a DXF file with walls, separated by commas; empty for all.
    #[param(default = "")]
    layers: &'static str,
    /// Length of a unit of the plan.
    #[param(unit = "m", default = 1.0, range = 0.0001..=10_000.0)]
    scale: f64,
    /// Side of a cell.
    #[param(unit = "m", default = 0.1, range = 0.01..=10.0)]
    resolution: f32,
    drawn: Option<Grid<Occupancy>>,
    failed: bool,
}

#[node]
impl PlanMap {
    fn process(&mut self, map: &mut Out<Grid<Occupancy>>) -> Result<(), PlanMapError> {
        if self.failed {
            return Ok(());
        }
        let drawn = match self.drawn.take() {
            Some(drawn) => drawn,
            None => self.draw().inspect_err(|_| self.failed = true)?,
        };
        map.get_mut().clone_from(&drawn);
        self.drawn = Some(drawn);
        Ok(())
    }

    fn draw(&self) -> Result<Grid<Occupancy>, PlanMapError> {
        let plan =
            read_plan(self.plan, &PlanOptions::of_layers(self.layers, self.scale)).map_err(PlanMapError::Plan)?;
        let mut map = Grid::default();
        plan.warn(self.plan);
        draw_plan(&plan.map, self.resolution, &mut map).map_err(PlanMapError::Size)?;
        Ok(map)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn walls_are_occupied() {
        let path = std::env::temp_dir().join(format!("apex-plan-map-{}.csv", std::process::id()));
        std::fs::write(&path, "0,0,4000,0\n4000,0,4000,3000\n").expect("a temporary file");
        let path: &'static str = path.to_str().expect("a readable path").to_owned().leak();
        let mut out = Out::new();
        PlanMap::construct((path, "", 0.001, 0.1)).process(&mut out).expect("a plan");
        let map = out.get().expect("a map");
        for (x, y, cell) in
            [(2.05, 0.05, Occupancy::Occupied), (4.0, 2.0, Occupancy::Occupied), (2.0, 1.0, Occupancy::Free)]
        {
            assert_eq!(map.at(Point2::new(x, y)), Some(&cell), "{x} {y}");
        }
        let mut fine = PlanMap::construct((path, "", 1.0, 0.01));
        assert!(matches!(fine.process(&mut Out::new()), Err(PlanMapError::Size(_))));
        assert!(fine.process(&mut Out::new()).is_ok());
    }

    #[test]
    fn a_missing_plan_fails_once() {
        let mut node = PlanMap::construct(("/nowhere/plan.csv", "", 1.0, 0.1));
        let mut out = Out::new();
        assert!(node.process(&mut out).is_err_and(|e| e.to_string().starts_with("/nowhere/plan.csv: ")));
        assert!(node.process(&mut out).is_ok() && out.get().is_none());
    }
}
