use crate::map::{DistanceTransform, Grid, Occupancy};
use apex_rt::{Out, node};

/// Writes costs that fall linearly from `highest` at distance 0 to 0 at `reach` m (thesis 4.3.6). `distances` are those
/// to the nearest obstacle, in m.
pub fn write_costs(distances: &Grid<f32>, highest: f32, reach: f32, costs: &mut Grid<f32>) {
    costs.reset_like(distances, 0.0);
    for (cost, distance) in costs.cells_mut().iter_mut().zip(distances.cells()) {
        // The comparison also avoids the division by a reach of 0.
        *cost = if *distance < reach { highest * (1.0 - distance / reach) } else { 0.0 };
    }
}

/// Costs that keep paths away from obstacles: highest at obstacles, falling linearly to 0 at a distance (thesis 4.3.6,
/// *m_c*).
///
/// A cost is added to each metre through a cell: with a cost of 2, a metre counts as much as three metres without
/// costs.
#[node]
#[derive(Debug, Clone)]
pub struct CostMap {
    /// Cost at obstacles.
    #[param(default = 4.0, range = 0.0..=1000.0)]
    highest: f32,
    /// Distance from obstacles beyond which there are no costs.
    #[param(unit = "m", default = 2.5, range = 0.0..=100.0)]
    reach: f32,
    transform: DistanceTransform,
    distances: Grid<f32>,
}

#[node]
impl CostMap {
    fn process(&mut self, map: &Grid<Occupancy>, costs: &mut Out<Grid<f32>>) {
        self.transform.run(map, |cell| cell.is_obstacle(), &mut self.distances);
        write_costs(&self.distances, self.highest, self.reach, costs.get_mut());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_rt::Construct;

    #[test]
    fn costs_fall_with_the_distance() {
        let raster = Raster { width: 5, height: 1, ..Raster::default() };
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        let costs = |map: &Grid<Occupancy>, reach| {
            let mut out = Out::new();
            CostMap::construct((10.0, reach)).process(map, &mut out);
            out.get().expect("costs").cells().to_vec()
        };
        assert_eq!(costs(&map, 2.5), [0.0; 5]);
        map.cells_mut()[0] = Occupancy::Occupied;
        assert_eq!(costs(&map, 4.0), [10.0, 7.5, 5.0, 2.5, 0.0]);
        assert_eq!(costs(&map, 0.0), [0.0; 5]);
    }
}
