use super::{Columns, Labels};
use apex_rt::{Out, node};

/// Mark of an empty place of the table.
const EMPTY: u32 = u32::MAX;

/// Points of a cloud, one for each voxel that had some.
#[derive(Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Voxels {
    /// Side of a voxel, in m.
    pub side: f32,
    /// All voxels with points, in the order in which they were met.
    pub voxels: Vec<Voxel>,
}

/// Voxel with points.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Voxel {
    /// Mean of its points, in m.
    pub mean: [f32; 3],
    /// Number of its points.
    pub count: u32,
    /// Number of the voxel along each axis, counted from the origin.
    pub cell: [i16; 3],
}

/// `clone_from` reuses the allocated storage.
impl Clone for Voxels {
    fn clone(&self) -> Self {
        Self { side: self.side, voxels: self.voxels.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.side = source.side;
        self.voxels.clone_from(&source.voxels);
    }
}

/// Table of voxels by their cells, or by other numbers along the axes, with open addressing.
#[derive(Debug, Clone, Default)]
pub(super) struct VoxelTable {
    places: Vec<u32>,
}

impl VoxelTable {
    /// Empties the table, with room for this number of voxels.
    pub fn reset(&mut self, count: usize) {
        let room = (2 * count.max(8)).next_power_of_two();
        self.places.clear();
        self.places.resize(room, EMPTY);
    }

    /// Place of a cell: that of its voxel, or an empty one.
    fn place(&self, cell: [i16; 3], cell_of: impl Fn(u32) -> [i16; 3]) -> usize {
        let [x, y, z] = cell.map(|c| u32::from(c as u16));
        let hash = (x.wrapping_mul(73_856_093)) ^ (y.wrapping_mul(19_349_663)) ^ (z.wrapping_mul(83_492_791));
        let mask = self.places.len() - 1;
        let mut at = (hash ^ (hash >> 15)) as usize & mask;
        loop {
            let number = self.places[at];
            if number == EMPTY || cell_of(number) == cell {
                return at;
            }
            at = (at + 1) & mask;
        }
    }

    /// Number of the voxel of a cell.
    pub fn find(&self, cell: [i16; 3], cell_of: impl Fn(u32) -> [i16; 3]) -> Option<u32> {
        let number = self.places[self.place(cell, cell_of)];
        (number != EMPTY).then_some(number)
    }

    /// Notes a voxel by its number. Returns the one that had its cell before.
    pub fn put(&mut self, number: u32, cell_of: impl Fn(u32) -> [i16; 3]) -> Option<u32> {
        let place = self.place(cell_of(number), cell_of);
        let before = std::mem::replace(&mut self.places[place], number);
        (before != EMPTY).then_some(before)
    }

    /// Number of the voxel of a cell, which is added if it is not there.
    pub fn find_or_add(&mut self, cell: [i16; 3], voxels: &mut Vec<Voxel>) -> u32 {
        let place = self.place(cell, |number| voxels[number as usize].cell);
        if self.places[place] == EMPTY {
            self.places[place] = voxels.len() as u32;
            voxels.push(Voxel { mean: [0.0; 3], count: 0, cell });
        }
        self.places[place]
    }
}

/// Voxel grid: replaces the points in each cube of the side `voxel` by their mean.
///
/// With `labels`, only hazards count. Points beyond `reach` from the origin, and those that are not measured, are left
/// out. Columns that are not whole, and labels of another size, give ⊥.
///
/// Cost: O(n) for n points. Allocates with the first cloud, and whenever one has more hazards than all before it.
#[node]
#[derive(Debug, Clone)]
pub struct VoxelGrid {
    /// Side of a voxel.
    #[param(unit = "m", default = 0.2, range = 0.01..=10.0)]
    voxel: f32,
    /// Distance up to which points count, along each axis.
    #[param(unit = "m", default = 30.0, range = 0.1..=300.0)]
    reach: f32,
    table: VoxelTable,
}

#[node]
impl VoxelGrid {
    fn process(&mut self, columns: &Columns, labels: Option<&Labels>, voxels: &mut Out<Voxels>) {
        if !columns.is_whole() || labels.is_some_and(|labels| !columns.fits(labels)) {
            return;
        }
        let counts = |i: usize| labels.is_none_or(|labels| labels.labels[i].is_hazard());
        let out = voxels.get_mut();
        // A voxel has a number of 16 bits along each axis.
        let side = self.voxel.max(self.reach / f32::from(i16::MAX));
        out.side = side;
        out.voxels.clear();
        self.table.reset((0..columns.len()).filter(|i| counts(*i)).count());
        for i in (0..columns.len()).filter(|i| counts(*i)) {
            let point = [columns.x[i], columns.y[i], columns.z[i]];
            // False for NaN.
            if !point.iter().all(|c| c.abs() < self.reach) {
                continue;
            }
            let cell = point.map(|c| libm::floorf(c / side) as i16);
            let number = self.table.find_or_add(cell, &mut out.voxels);
            let voxel = &mut out.voxels[number as usize];
            voxel.count += 1;
            for (sum, c) in voxel.mean.iter_mut().zip(point) {
                *sum += c;
            }
        }
        for voxel in &mut out.voxels {
            let count = voxel.count as f32;
            voxel.mean.iter_mut().for_each(|sum| *sum /= count);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Label, columns::tests::dark};
    use apex_rt::Construct;
    use std::collections::BTreeMap;

    fn grid(points: &[[f32; 3]], labels: Option<&Labels>) -> Option<Voxels> {
        let mut out = Out::new();
        VoxelGrid::construct((0.2, 30.0)).process(&dark(1, points), labels, &mut out);
        out.get().cloned()
    }

    #[test]
    fn each_voxel_has_the_mean_of_its_points() {
        let mut random = crate::math::Random::new(3);
        let points: Vec<[f32; 3]> = (0..5000)
            .map(|_| [random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0), random.uniform(-1.0, 2.0)])
            .collect();
        let mut expected: BTreeMap<[i32; 3], ([f64; 3], u32)> = BTreeMap::new();
        for point in &points {
            let cell = point.map(|c| (c / 0.2).floor() as i32);
            let (sum, count) = expected.entry(cell).or_default();
            sum.iter_mut().zip(point).for_each(|(sum, c)| *sum += f64::from(*c));
            *count += 1;
        }
        let found = grid(&points, None).expect("voxels");
        assert_eq!(found.voxels.len(), expected.len());
        for voxel in &found.voxels {
            let (sum, count) = expected[&voxel.cell.map(i32::from)];
            assert_eq!(voxel.count, count);
            let right = sum.map(|s| s / f64::from(count));
            assert!(voxel.mean.iter().zip(right).all(|(a, b)| (f64::from(*a) - b).abs() < 1e-4));
        }
    }

    #[test]
    fn only_hazards_in_reach_count() {
        let points = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [99.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0]];
        let mut labels = Labels { height: 1, labels: vec![Label::Obstacle; 4] };
        labels.labels[0] = Label::Floor;
        let found = grid(&points, Some(&labels)).expect("voxels");
        assert_eq!(found.voxels.iter().map(|v| v.mean).collect::<Vec<_>>(), [[2.0, 0.0, 0.0]]);
        assert!(grid(&points, Some(&Labels::default())).is_none());
        assert_eq!(grid(&[], None).expect("none").voxels, []);
    }
}
