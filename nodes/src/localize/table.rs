use super::shadow::{Shadow, Square, Wedge};
use crate::{
    map::{LineSegment, VectorMap, nearest_hit},
    scan::Point2,
};
use core::{
    f32::consts::{PI, TAU},
    fmt,
    sync::atomic::{AtomicUsize, Ordering},
};
use rayon::prelude::*;

/// Maximum number of pairs of cell and sector.
const MAX_LISTS: usize = 1 << 26;
/// Number of cells along the side of a block. Segments are selected for blocks first, then for their cells.
const BLOCK: usize = 8;
/// Minimum share of the directions in which the middle of a cell sees a wall, for a cell inside of the building.
const ENCLOSED: f32 = 0.75;

/// Settings of a [`VisibilityTable`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableSettings {
    /// Side of a cell, in m.
    pub cell: f32,
    /// Number of sectors of the heading, at least 4.
    pub sectors: u16,
    /// Maximum distance of the segments that are looked up, in m.
    pub reach: f32,
}

/// Cells of 0.5 m, sectors of 10°, and a reach of 30 m.
impl Default for TableSettings {
    fn default() -> Self {
        Self { cell: 0.5, sectors: 36, reach: 30.0 }
    }
}

/// Error of a table that is not built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableError {
    /// A map without segments.
    Empty,
    /// Too many cells and sectors.
    TooLarge,
    /// A setting out of range.
    Settings,
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Empty => "the map has no segment",
            Self::TooLarge => "the table would have too many cells: make them larger, or remove what lies far outside",
            Self::Settings => "a table needs cells of at least 5 cm, 4 to 720 sectors and a reach of at least 1 m",
        })
    }
}

impl core::error::Error for TableError {}

/// Look-up table of the segments that may be visible from a cell of the plane in a sector of directions (thesis 6.9).
/// It answers at which distance a beam hits the map without a search through all segments.
#[derive(Debug, Clone, PartialEq)]
pub struct VisibilityTable {
    pub(super) settings: TableSettings,
    pub(super) segments: Vec<LineSegment>,
    /// Lower left corner of the first cell, in m.
    pub(super) corner: Point2,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Beginning of the list of each sector of each cell, and the end of the last one.
    pub(super) starts: Vec<u32>,
    /// Indices of segments, one list after the other.
    pub(super) visible: Vec<u32>,
    /// Cells inside of the building.
    pub(super) inside: Vec<u32>,
}

/// Cell of a [`VisibilityTable`]: the part of the table for one position.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    table: &'a VisibilityTable,
    first: usize,
    origin: Point2,
}

impl VisibilityTable {
    /// Builds the table on all processors. `progress` is called with the finished share from 0 to 1, by any thread.
    ///
    /// # Errors
    /// If the map has no segment, a setting is out of range, or the table would be too large.
    pub fn build(map: &VectorMap, settings: TableSettings, progress: impl Fn(f32) + Sync) -> Result<Self, TableError> {
        let mut table = Self::empty(map, settings)?;
        let blocks = (table.width.div_ceil(BLOCK), table.height.div_ceil(BLOCK));
        let done = AtomicUsize::new(0);
        let rows: Vec<Vec<Vec<Vec<u32>>>> = (0..blocks.1)
            .into_par_iter()
            .map(|y| {
                let row = (0..blocks.0).map(|x| table.block(x, y)).collect();
                progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f32 / blocks.1 as f32);
                row
            })
            .collect();
        table.collect(&rows)?;
        Ok(table)
    }

    pub(super) fn empty(map: &VectorMap, settings: TableSettings) -> Result<Self, TableError> {
        let TableSettings { cell, sectors, reach } = settings;
        if !(cell >= 0.05 && cell.is_finite() && (4..=720).contains(&sectors) && reach >= 1.0 && reach.is_finite()) {
            return Err(TableError::Settings);
        }
        let (low, high) = map.bounds().ok_or(TableError::Empty)?;
        // A margin of one cell, for poses just outside of the walls.
        let corner = low - Point2::new(cell, cell);
        let cells = |extent: f32| (extent / cell).ceil() as usize + 2;
        let (width, height) = (cells(high.x - low.x), cells(high.y - low.y));
        if width.saturating_mul(height).saturating_mul(usize::from(sectors)) > MAX_LISTS {
            return Err(TableError::TooLarge);
        }
        let segments = map.segments().to_vec();
        let (starts, visible, inside) = Default::default();
        Ok(Self { settings, segments, corner, width, height, starts, visible, inside })
    }

    /// Lists of all cells of a block: for each cell the length of each list, and then their entries.
    fn block(&self, x: usize, y: usize) -> Vec<Vec<u32>> {
        let place = |x: usize, y: usize| self.corner + Point2::new(x as f32, y as f32).scaled(self.settings.cell);
        let (x, y) = (x * BLOCK, y * BLOCK);
        let all: Vec<u32> = (0..self.segments.len() as u32).collect();
        let near = self.unhidden(&Square::new(place(x, y), BLOCK as f32 * self.settings.cell), &all);
        let cells =
            (y..(y + BLOCK).min(self.height)).flat_map(|y| (x..(x + BLOCK).min(self.width)).map(move |x| (x, y)));
        cells
            .map(|(x, y)| {
                let square = Square::new(place(x, y), self.settings.cell);
                self.lists(&square, &self.unhidden(&square, &near))
            })
            .collect()
    }

    /// Segments within reach that are not hidden behind a nearer one, from the nearest on.
    fn unhidden(&self, square: &Square, from: &[u32]) -> Vec<u32> {
        let distance = |&index: &u32| (square.distance(&self.segments[index as usize]), index);
        let mut near: Vec<(f32, u32)> = from.iter().map(distance).filter(|(d, _)| *d <= self.settings.reach).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut kept, mut shadows) = (Vec::new(), Vec::<Shadow>::new());
        for (_, index) in near {
            let segment = &self.segments[index as usize];
            if !shadows.iter().any(|shadow| shadow.hides(segment)) {
                kept.push(index);
                shadows.extend(Shadow::new(square, segment));
            }
        }
        kept
    }

    fn lists(&self, square: &Square, seen: &[u32]) -> Vec<u32> {
        let sectors = usize::from(self.settings.sectors);
        let shadows: Vec<Option<Shadow>> =
            seen.iter().map(|&index| Shadow::new(square, &self.segments[index as usize])).collect();
        let (mut lengths, mut entries) = (Vec::with_capacity(sectors), Vec::new());
        let mut parts = Vec::new();
        for sector in 0..sectors {
            let angle = |sector: usize| sector as f32 * (TAU / sectors as f32) - PI;
            let wedge = Wedge::new(square, angle(sector), angle(sector + 1));
            parts.clear();
            parts.extend(seen.iter().zip(&shadows).filter_map(|(&index, shadow)| {
                wedge.clip(&self.segments[index as usize]).map(|part| (index, part, shadow))
            }));
            let before = entries.len();
            let hidden = |part: &LineSegment| parts.iter().any(|(_, _, s)| s.is_some_and(|s| s.hides(part)));
            entries.extend(parts.iter().filter(|(_, part, _)| !hidden(part)).map(|(index, ..)| *index));
            lengths.push((entries.len() - before) as u32);
        }
        lengths.extend(entries);
        lengths
    }

    /// Puts the lists of all blocks in the order of cells.
    fn collect(&mut self, rows: &[Vec<Vec<Vec<u32>>>]) -> Result<(), TableError> {
        let sectors = usize::from(self.settings.sectors);
        self.starts.push(0);
        for (x, y) in (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y))) {
            let columns = (self.width - x / BLOCK * BLOCK).min(BLOCK);
            let (lengths, entries) = rows[y / BLOCK][x / BLOCK][y % BLOCK * columns + x % BLOCK].split_at(sectors);
            let mut end = self.visible.len();
            u32::try_from(end + entries.len()).map_err(|_| TableError::TooLarge)?;
            for length in lengths {
                end += *length as usize;
                self.starts.push(end as u32);
            }
            self.visible.extend(entries);
        }
        let inside = (0..self.width * self.height).filter(|&cell| self.is_inside(cell));
        self.inside = inside.map(|cell| cell as u32).collect();
        Ok(())
    }

    /// Returns `true` if walls surround the middle of a cell.
    fn is_inside(&self, cell: usize) -> bool {
        let half = 0.5 * self.settings.cell;
        let Some(view) = self.view(self.place(cell) + Point2::new(half, half)) else { return false };
        let sectors = self.settings.sectors;
        let angle = |sector: u16| (f32::from(sector) + 0.5) * TAU / f32::from(sectors) - PI;
        let hits = |&sector: &u16| view.range(Point2::polar(1.0, angle(sector)), angle(sector)).is_finite();
        (0..sectors).filter(hits).count() as f32 >= ENCLOSED * f32::from(sectors)
    }

    /// Settings of the table.
    pub const fn settings(&self) -> &TableSettings {
        &self.settings
    }

    /// Segments of the map.
    pub fn segments(&self) -> &[LineSegment] {
        &self.segments
    }

    /// Number of columns and rows of cells.
    pub const fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Mean number of segments per cell and sector.
    pub fn mean_length(&self) -> f32 {
        self.visible.len() as f32 / (self.starts.len() - 1).max(1) as f32
    }

    /// Lower left corners of the cells inside of the building, in m: those that are surrounded by walls within reach.
    pub fn inside(&self) -> impl ExactSizeIterator<Item = Point2> + '_ {
        self.inside.iter().map(|&cell| self.place(cell as usize))
    }

    /// Lower left corner of the `index`-th cell inside of the building.
    pub(super) fn inside_at(&self, index: usize) -> Option<Point2> {
        self.inside.get(index).map(|&cell| self.place(cell as usize))
    }

    fn place(&self, cell: usize) -> Point2 {
        self.corner + Point2::new((cell % self.width) as f32, (cell / self.width) as f32).scaled(self.settings.cell)
    }

    /// Part of the table for beams that begin at `origin`, or `None` outside of the table.
    #[inline]
    pub fn view(&self, origin: Point2) -> Option<View<'_>> {
        let at = (origin - self.corner).scaled(1.0 / self.settings.cell);
        // Not true for NaN.
        if !(at.x >= 0.0 && at.y >= 0.0 && at.x < self.width as f32 && at.y < self.height as f32) {
            return None;
        }
        let cell = at.y as usize * self.width + at.x as usize;
        Some(View { table: self, first: cell * usize::from(self.settings.sectors), origin })
    }
}

impl View<'_> {
    /// Distance to the map in a direction, given both as unit vector and as angle in [−2π, 2π] rad; infinite without a
    /// segment within reach.
    #[inline]
    pub fn range(&self, direction: Point2, angle: f32) -> f32 {
        self.range_in(self.sector(angle), direction)
    }

    /// Sector of an angle in [−2π, 2π] rad.
    #[inline]
    pub(super) fn sector(&self, angle: f32) -> i32 {
        // Between 0.5 and 2.5: its integer part is a conversion, without a call of `floor`.
        let share = (angle + 3.0 * PI) * (1.0 / TAU);
        ((share - share as i32 as f32) * f32::from(self.table.settings.sectors)) as i32
    }

    /// Distance to the map in a direction of a sector.
    #[inline]
    pub(super) fn range_in(&self, sector: i32, direction: Point2) -> f32 {
        let last = usize::from(self.table.settings.sectors) - 1;
        let list = self.first + (sector as usize).min(last);
        let Some(&[from, to]) = self.table.starts.get(list..list + 2).and_then(|bounds| bounds.first_chunk()) else {
            return f32::INFINITY;
        };
        let visible = self.table.visible.get(from as usize..to as usize).unwrap_or_default();
        let segments = visible.iter().filter_map(|index| self.table.segments.get(*index as usize));
        nearest_hit(segments, self.origin, direction)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::math::Random;

    /// A map of random walls in a square room of 20 m.
    pub fn maze(seed: u64, walls: usize) -> VectorMap {
        let mut random = Random::new(seed);
        let mut map = VectorMap::default();
        let corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(|(x, y)| Point2::new(x, y));
        for i in 0..4 {
            map.add(corners[i], corners[(i + 1) % 4]).expect("a wall");
        }
        for _ in 0..walls {
            let a = Point2::new(random.uniform(0.0, 20.0), random.uniform(0.0, 20.0));
            let along = Point2::polar(random.uniform(0.1, 4.0), random.uniform(-PI, PI));
            map.add(a, a + along).expect("a wall");
        }
        map
    }

    #[test]
    fn ranges_are_those_of_all_segments() {
        for (seed, walls, sectors) in [(1, 0, 4), (2, 20, 36), (3, 200, 36), (4, 60, 7)] {
            let map = maze(seed, walls);
            let settings = TableSettings { sectors, ..TableSettings::default() };
            let table = VisibilityTable::build(&map, settings, |_| ()).expect("a table");
            assert!(table.mean_length() < map.segments().len() as f32 / 3.0 + 3.0, "{}", table.mean_length());
            let mut random = Random::new(seed + 10);
            for _ in 0..3000 {
                let origin = Point2::new(random.uniform(0.01, 19.99), random.uniform(0.01, 19.99));
                let angle = random.uniform(-2.0 * PI, 2.0 * PI);
                let direction = Point2::polar(1.0, angle);
                let all = map.segments().iter().filter_map(|s| s.hit(origin, direction)).fold(f32::INFINITY, f32::min);
                let looked_up = table.view(origin).expect("inside").range(direction, angle);
                // A beam may slip between two walls that meet.
                assert!((all - looked_up).abs() < 1e-3, "{origin:?} {angle}: {all} m, table {looked_up} m");
            }
        }
    }

    #[test]
    fn cells_are_inside_if_walls_surround_them() {
        let table = VisibilityTable::build(&maze(1, 0), TableSettings::default(), |_| ()).expect("a table");
        assert!((1590..=1610).contains(&table.inside().len()), "{}", table.inside().len());
        assert!(table.view(Point2::new(-3.0, 1.0)).is_none() && table.view(Point2::new(f32::NAN, 1.0)).is_none());
    }

    #[test]
    fn impossible_tables_are_refused() {
        let build = |map: &VectorMap, settings| VisibilityTable::build(map, settings, |_| ()).expect_err("no table");
        let standard = TableSettings::default();
        assert_eq!(build(&VectorMap::default(), standard), TableError::Empty);
        let mut far = maze(1, 0);
        far.add(Point2::default(), Point2::new(9e4, 9e4)).expect("a wall");
        assert_eq!(build(&far, standard), TableError::TooLarge);
        for settings in [
            TableSettings { cell: 0.0, ..standard },
            TableSettings { cell: f32::NAN, ..standard },
            TableSettings { sectors: 3, ..standard },
            TableSettings { reach: f32::INFINITY, ..standard },
        ] {
            assert_eq!(build(&far, settings), TableError::Settings);
        }
    }

    #[test]
    fn progress_ends_at_one() {
        let most = std::sync::Mutex::new(0.0_f32);
        let report = |share: f32| {
            let mut most = most.lock().expect("no panic");
            *most = most.max(share);
        };
        VisibilityTable::build(&maze(1, 3), TableSettings::default(), report).expect("a table");
        assert_eq!(*most.lock().expect("no panic"), 1.0);
    }
}
