use super::{Grid, Occupancy, Raster};
use crate::math::sets::Sets;
use apex_rt::{Out, node};
use std::ops::Range;

/// Fills small unknown regions with the state of most of the cells around them. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct UnknownRegions {
    runs: Vec<Run>,
    /// Runs of the same region, by their numbers.
    sets: Sets,
    /// Regions, by the number of their first run.
    regions: Vec<Region>,
}

/// Longest part of a row of which all cells are unknown.
#[derive(Debug, Clone)]
struct Run {
    y: usize,
    x: Range<usize>,
    /// Number of its region.
    region: usize,
}

#[derive(Debug, Clone, Default)]
struct Region {
    /// Number of cells.
    area: usize,
    touches_border: bool,
    /// Sides of its cells with which it touches free and occupied cells.
    free: usize,
    occupied: usize,
}

impl UnknownRegions {
    /// Fills regions of unknown cells that are not larger than `largest_area` m² and do not touch the border of the
    /// map. Cells of a region are connected by their sides. The region gets the state of most sides around it; in a
    /// tie, it becomes occupied.
    pub fn close(&mut self, map: &mut Grid<Occupancy>, largest_area: f32) {
        let raster = *map.raster();
        // Casts of NaN give 0; casts of too large numbers saturate.
        let largest = (largest_area / (raster.resolution * raster.resolution) + 1e-3) as usize;
        self.find(map);
        self.measure(&raster);
        let is_small = |region: &Region| region.area <= largest && !region.touches_border;
        for run in &self.runs {
            let region = &mut self.regions[run.region];
            if is_small(region) {
                region.touch(map.cells(), run, raster.width);
            }
        }
        for run in &self.runs {
            let region = &self.regions[run.region];
            if is_small(region) {
                let first = run.y * raster.width;
                map.cells_mut()[first + run.x.start..first + run.x.end].fill(region.filling());
            }
        }
    }

    /// Collects the runs, and joins those that touch.
    fn find(&mut self, map: &Grid<Occupancy>) {
        self.runs.clear();
        self.sets.clear();
        let mut above = 0..0;
        for (y, row) in map.cells().chunks(map.raster().width.max(1)).enumerate() {
            let begin = self.runs.len();
            for x in unknown_runs(row) {
                // Runs that end left of this one touch none of the next ones either.
                above.start += self.runs[above.clone()].iter().take_while(|other| other.x.end <= x.start).count();
                let touching = self.runs[above.clone()].iter().take_while(|other| other.x.start < x.end).count();
                let number = self.runs.len() as u32;
                self.sets.add();
                (above.start..above.start + touching).for_each(|other| self.sets.join(other as u32, number));
                self.runs.push(Run { y, x, region: 0 });
            }
            above = begin..self.runs.len();
        }
    }

    /// Finds the region of each run, and sums up the cells of the regions.
    fn measure(&mut self, raster: &Raster) {
        self.regions.clear();
        self.regions.resize(self.runs.len(), Region::default());
        for (run, number) in self.runs.iter_mut().zip(0..) {
            run.region = self.sets.root(number) as usize;
            let region = &mut self.regions[run.region];
            region.area += run.x.len();
            region.touches_border |=
                run.x.start == 0 || run.x.end == raster.width || run.y == 0 || run.y + 1 == raster.height;
        }
    }
}

impl Region {
    /// Counts the sides of a run that does not touch the border.
    fn touch(&mut self, cells: &[Occupancy], run: &Run, width: usize) {
        let row = |y: usize| &cells[y * width..(y + 1) * width];
        let (above, beside, below) = (row(run.y - 1), row(run.y), row(run.y + 1));
        let ends = [beside[run.x.start - 1], beside[run.x.end]];
        for cell in ends.iter().chain(&above[run.x.clone()]).chain(&below[run.x.clone()]) {
            match cell {
                Occupancy::Free => self.free += 1,
                Occupancy::Occupied | Occupancy::Low => self.occupied += 1,
                Occupancy::Unknown => {}
            }
        }
    }

    fn filling(&self) -> Occupancy {
        if self.free > self.occupied { Occupancy::Free } else { Occupancy::Occupied }
    }
}

/// Runs of unknown cells in a row, from left to right.
fn unknown_runs(row: &[Occupancy]) -> impl Iterator<Item = Range<usize>> {
    let is_unknown = |cell: &Occupancy| *cell == Occupancy::Unknown;
    let mut at = 0;
    std::iter::from_fn(move || {
        let first = at + row[at..].iter().position(is_unknown)?;
        at = row[first..].iter().position(|cell| !is_unknown(cell)).map_or(row.len(), |length| first + length);
        Some(first..at)
    })
}

/// Fills small unknown regions inside a map with the state of most of the cells around them (thesis 4.3.6).
#[node]
#[derive(Debug, Clone)]
pub struct CloseUnknown {
    /// Maximum area of a region that is filled.
    #[param(unit = "m^2", default = 0.25, range = 0.0..=100.0)]
    largest_area: f32,
    regions: UnknownRegions,
}

#[node]
impl CloseUnknown {
    fn process(&mut self, map: &Grid<Occupancy>, closed: &mut Out<Grid<Occupancy>>) {
        let closed = closed.get_mut();
        closed.clone_from(map);
        self.regions.close(closed, self.largest_area);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        map::{Cell, drawn as map},
        math::Random,
    };
    use apex_rt::Construct;

    #[test]
    fn small_unknown_regions_are_filled() {
        let closed = |largest_area| {
            let mut out = Out::new();
            let open = map(&["?.......", "...??.##", "...???#?", "......##", "........"]);
            CloseUnknown::construct((largest_area,)).process(&open, &mut out);
            out.get().expect("a map").clone()
        };
        // The region on the right touches the border.
        assert_eq!(closed(5.0), map(&["?.......", "......##", "......#?", "......##", "........"]));
        assert_eq!(closed(4.9), map(&["?.......", "...??.##", "...???#?", "......##", "........"]));
        assert_eq!(closed(f32::NAN), closed(0.0));
    }

    #[test]
    fn the_inside_of_an_obstacle_is_occupied() {
        let mut pillar = map(&[".....", ".###.", ".#?#.", ".###.", "....."]);
        UnknownRegions::default().close(&mut pillar, 1.0);
        assert_eq!(pillar.get(Cell::new(2, 2)), Some(&Occupancy::Occupied));
    }

    /// Cells at the sides of a cell; `None` outside the map.
    fn sides(map: &Grid<Occupancy>, cell: Cell) -> [Option<Cell>; 4] {
        let at =
            |x: Option<usize>, y: Option<usize>| Some(Cell::new(x?, y?)).filter(|cell| map.raster().contains(*cell));
        let (x, y) = (cell.x, cell.y);
        [
            at(x.checked_sub(1), Some(y)),
            at(Some(x + 1), Some(y)),
            at(Some(x), y.checked_sub(1)),
            at(Some(x), Some(y + 1)),
        ]
    }

    /// State that an unknown cell is to have, by its region, cell by cell.
    fn closed(map: &Grid<Occupancy>, cell: Cell, largest: usize) -> Occupancy {
        let mut region = vec![cell];
        let (mut next, mut balance, mut touches_border) = (0, 0_i32, false);
        while let Some(&cell) = region.get(next) {
            next += 1;
            for side in sides(map, cell) {
                match side.and_then(|side| map.get(side)) {
                    None => touches_border = true,
                    Some(Occupancy::Free) => balance += 1,
                    Some(Occupancy::Unknown) => region.extend(side.filter(|side| !region.contains(side))),
                    Some(_) => balance -= 1,
                }
            }
        }
        match region.len() > largest || touches_border {
            true => Occupancy::Unknown,
            false if balance > 0 => Occupancy::Free,
            false => Occupancy::Occupied,
        }
    }

    #[test]
    fn regions_are_those_that_are_found_cell_by_cell() {
        let mut random = Random::new(7);
        let mut regions = UnknownRegions::default();
        let mut changed = 0;
        for round in 0..300_usize {
            let (width, height) = (1 + round % 13, 1 + round % 7);
            let signs = [&b"?.#"[..], b"???.#", b"?..."][round % 3];
            let sign = |random: &mut Random| char::from(signs[random.below(signs.len() as u64) as usize]);
            let rows: Vec<String> = (0..height).map(|_| (0..width).map(|_| sign(&mut random)).collect()).collect();
            let open = map(&rows.iter().map(String::as_str).collect::<Vec<_>>());
            let (mut found, mut expected) = (open.clone(), open.clone());
            let largest = round % 6;
            regions.close(&mut found, largest as f32);
            for (cell, _) in open.iter().filter(|(_, state)| **state == Occupancy::Unknown) {
                *expected.get_mut(cell).expect("a cell of the map") = closed(&open, cell, largest);
            }
            assert_eq!(found, expected, "{rows:?}, at most {largest}");
            changed += usize::from(found != open);
        }
        assert!(changed > 50, "{changed}");
    }

    #[test]
    fn a_map_without_cells_stays() {
        let mut empty = Grid::EMPTY;
        UnknownRegions::default().close(&mut empty, 1.0);
        assert_eq!(empty, Grid::EMPTY);
    }
}
