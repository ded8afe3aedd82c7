use super::{Columns, Labels};
use crate::math::sets::Sets;
use apex_rt::{Out, node};

/// Maximum number of voxels along a side of the grid, which bounds its memory.
const MAX_VOXELS: f32 = 250.0;
/// Index of a cluster that is not there, or not yet.
const NONE: u32 = u32::MAX;

/// Group of points that are close to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cluster {
    /// Number of points.
    pub points: usize,
    /// Smallest coordinates, in m.
    pub min: [f32; 3],
    /// Largest coordinates, in m.
    pub max: [f32; 3],
}

/// Clusters of the obstacles in [`Columns`].
#[derive(Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Clusters {
    /// All clusters.
    pub clusters: Vec<Cluster>,
    /// Points that belong to a cluster, in the order of the columns.
    pub members: Vec<Member>,
    /// Number of points of the columns, with and without a cluster.
    pub points: usize,
}

/// Point of a cluster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Member {
    /// Index of the point in the columns.
    pub point: u32,
    /// Index of its cluster.
    pub cluster: u32,
}

/// `clone_from` reuses the allocated storage.
impl Clone for Clusters {
    fn clone(&self) -> Self {
        Self { clusters: self.clusters.clone(), members: self.members.clone(), points: self.points }
    }

    fn clone_from(&mut self, source: &Self) {
        self.clusters.clone_from(&source.clusters);
        self.members.clone_from(&source.members);
        self.points = source.points;
    }
}

/// Euclidean clustering of the points that are hazards, on a grid of voxels (thesis 6.6.2, after Trevor et al. 2013).
///
/// Points in the same voxel, or in voxels that touch, belong together. Clusters that are too small or too large are
/// dropped. The grid reaches `reach` m ahead and half of it to both sides, and from 0.5 m below the floor to 2 m above
/// it; points elsewhere have no cluster. It has at most 250 voxels along a side: in a longer grid they are larger.
/// Columns and labels of different sizes give ⊥.
///
/// Cost: O(n) for n points. Allocates with the first cloud, and whenever one is larger than all before it.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct ClusterCloud {
    /// Side of a voxel.
    #[param(unit = "m", default = 0.05, range = 0.01..=1.0)]
    voxel: f32,
    /// Length of the grid.
    #[param(unit = "m", default = 5.0, range = 0.1..=20.0)]
    reach: f32,
    /// Minimum number of points of a cluster.
    #[param(default = 20, range = 1..=1_000_000)]
    min_points: usize,
    /// Maximum size of a cluster along each axis.
    #[param(unit = "m", default = 3.0, range = 0.01..=100.0)]
    max_size: f32,
    grid: Grid,
}

/// Grid of voxels with a union-find structure over those that contain points.
#[derive(Debug, Clone, Default)]
struct Grid {
    size: [usize; 3],
    /// Number of voxels along each side that may have points.
    limits: [f32; 3],
    /// Number of the voxel among those with points, plus 1, for each cell; 0 without points.
    cells: Vec<u32>,
    /// Cells with points.
    used: Vec<usize>,
    /// Voxels with points that touch each other.
    sets: Sets,
    /// Index of the cluster of each voxel with points.
    indices: Vec<u32>,
}

/// Lowest point of the grid, and its height, in m.
const HEIGHTS: [f32; 2] = [-0.5, 2.5];

#[node]
impl ClusterCloud {
    fn process(&mut self, columns: &Columns, labels: &Labels, clusters: &mut Out<Clusters>) {
        if !columns.fits(labels) {
            return;
        }
        let Self { voxel, reach, .. } = *self;
        let scale = 1.0 / voxel.max(reach.max(HEIGHTS[1]) / MAX_VOXELS);
        self.grid.reset([reach, reach, HEIGHTS[1]].map(|side| (side * scale) as usize + 1));
        let out = clusters.get_mut();
        out.points = columns.len();
        out.members.clear();
        for (i, _) in labels.labels.iter().enumerate().filter(|(_, label)| label.is_hazard()) {
            let place = [columns.x[i], columns.y[i] + 0.5 * reach, columns.z[i] - HEIGHTS[0]];
            if let Some(cluster) = self.grid.add(place.map(|v| v * scale)) {
                out.members.push(Member { point: i as u32, cluster });
            }
        }
        self.grid.join();
        self.collect(columns, out);
    }

    /// Replaces the numbers of voxels by those of clusters, and drops clusters of the wrong size with their points.
    fn collect(&mut self, columns: &Columns, out: &mut Clusters) {
        let Clusters { clusters, members, .. } = out;
        let Grid { sets, indices, .. } = &mut self.grid;
        clusters.clear();
        indices.clear();
        indices.resize(sets.len(), NONE);
        for Member { point, cluster } in members.iter_mut() {
            let i = *point as usize;
            let point = [columns.x[i], columns.y[i], columns.z[i]];
            let index = &mut indices[sets.root(*cluster) as usize];
            if *index == NONE {
                *index = clusters.len() as u32;
                clusters.push(Cluster::at(point));
            }
            *cluster = *index;
            clusters[*index as usize].add(point, 1);
        }
        // New indices of the clusters that are kept.
        indices.clear();
        let mut kept = 0;
        for cluster in clusters.iter() {
            let is_kept = cluster.points >= self.min_points && cluster.size() <= self.max_size;
            indices.push(if is_kept { kept } else { NONE });
            kept += u32::from(is_kept);
        }
        if kept as usize == clusters.len() {
            return;
        }
        members.retain_mut(|member| {
            member.cluster = indices[member.cluster as usize];
            member.cluster != NONE
        });
        let mut number = 0;
        clusters.retain(|_| {
            number += 1;
            indices[number - 1] != NONE
        });
    }
}

impl Cluster {
    /// Cluster around a point, without any points yet.
    pub(super) fn at(point: [f32; 3]) -> Self {
        Self { points: 0, min: point, max: point }
    }

    /// Adds some points at a place.
    pub(super) fn add(&mut self, point: [f32; 3], count: usize) {
        self.points += count;
        for ((min, max), value) in self.min.iter_mut().zip(&mut self.max).zip(point) {
            *min = min.min(value);
            *max = max.max(value);
        }
    }

    /// Largest extent along an axis, in m.
    fn size(&self) -> f32 {
        self.min.iter().zip(&self.max).map(|(min, max)| max - min).fold(0.0, f32::max)
    }
}

impl Grid {
    fn reset(&mut self, size: [usize; 3]) {
        self.limits = size.map(|side| side as f32);
        // A border of empty voxels, so that each one inside has 26 neighbours.
        let size = size.map(|side| side + 2);
        if self.size == size {
            self.used.iter().for_each(|cell| self.cells[*cell] = 0);
        } else {
            self.size = size;
            self.cells.clear();
            self.cells.resize(size.iter().product(), 0);
        }
        self.used.clear();
        self.sets.clear();
    }

    /// Number of the voxel of a point, in voxels, or `None` outside of the grid. The outermost voxels stay empty.
    fn add(&mut self, place: [f32; 3]) -> Option<u32> {
        // Also false for NaN.
        let is_inside = |k: usize| 0.0 <= place[k] && place[k] < self.limits[k];
        if !(is_inside(0) && is_inside(1) && is_inside(2)) {
            return None;
        }
        let [x, y, z] = place.map(|value| value as u32 as usize + 1);
        let cell = (x * self.size[1] + y) * self.size[2] + z;
        if self.cells[cell] == 0 {
            self.sets.add();
            self.used.push(cell);
            self.cells[cell] = self.used.len() as u32;
        }
        Some(self.cells[cell] - 1)
    }

    /// Joins voxels that touch.
    fn join(&mut self) {
        let [_, columns, layers] = self.size;
        let offset = |i: usize| (i / 9 * columns + i / 3 % 3) * layers + i % 3;
        // Of the 26 neighbours, those before the middle; the others have this voxel before theirs.
        for number in 0..self.used.len() {
            let first = self.used[number] - offset(13);
            for neighbour in 0..13 {
                let other = self.cells[first + offset(neighbour)];
                if other != 0 {
                    self.sets.join(number as u32, other - 1);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Label, columns::tests::dark};
    use apex_rt::Construct;

    fn columns(points: &[[f32; 3]]) -> (Columns, Labels) {
        (dark(1, points), Labels { height: 1, labels: vec![Label::Obstacle; points.len()] })
    }

    fn clusters(points: &[[f32; 3]], min_points: usize, max_size: f32) -> Clusters {
        let (columns, labels) = columns(points);
        let mut out = Out::new();
        ClusterCloud::construct((0.05, 5.0, min_points, max_size)).process(&columns, &labels, &mut out);
        out.get().cloned().expect("clusters")
    }

    #[test]
    fn points_in_a_row_belong_together_and_distant_ones_do_not() {
        let row = |y: f32| (0..20).map(move |i| [1.0 + 0.04 * i as f32, y, 0.3]);
        let points: Vec<[f32; 3]> = row(0.0).chain(row(1.0)).chain([[3.0, 0.0, 0.3]]).collect();
        let found = clusters(&points, 2, 3.0);
        assert_eq!(found.clusters.iter().map(|c| c.points).collect::<Vec<_>>(), [20, 20]);
        let of: Vec<u32> = found.members.iter().map(|member| member.cluster).collect();
        assert_eq!((of, found.points), ([[0; 20], [1; 20]].concat(), 41));
        assert_eq!((found.clusters[0].min, found.clusters[0].max[0]), ([1.0, 0.0, 0.3], 1.0 + 0.04 * 19.0));
        assert_eq!(clusters(&points, 2, 0.5).clusters, []);
    }

    #[test]
    fn a_ring_is_one_cluster() {
        let ring: Vec<[f32; 3]> = (0..200)
            .map(|i| {
                let (sin, cos) = libm::sincosf(i as f32 * 0.0314);
                [2.0 + cos, sin, 0.5]
            })
            .collect();
        assert_eq!(clusters(&ring, 1, 3.0).clusters.len(), 1);
    }

    #[test]
    fn only_hazards_within_the_grid_have_clusters() {
        let outside = [[f32::NAN, 0.0, 0.0], [-0.1, 0.0, 0.0], [9.0, 0.0, 0.0], [1.0, 3.0, 0.0], [1.0, 0.0, 5.0]];
        assert_eq!(clusters(&outside, 1, 3.0).clusters, []);
        let (columns, mut labels) = columns(&[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
        labels.labels[1] = Label::Floor;
        let mut out = Out::new();
        let mut node = ClusterCloud::construct((0.05, 5.0, 1, 3.0));
        node.process(&columns, &labels, &mut out);
        let found = out.get().expect("clusters").clone();
        assert_eq!(found.members, [Member { point: 0, cluster: 0 }]);
        // Another cloud leaves nothing of the last one.
        node.process(&columns, &labels, &mut out);
        assert_eq!(out.get(), Some(&found));
    }

    #[test]
    fn clouds_without_points_and_of_other_sizes() {
        assert_eq!(clusters(&[], 1, 3.0), Clusters::default());
        let (columns, _) = columns(&[[1.0, 0.0, 0.0]]);
        let mut out = Out::new();
        ClusterCloud::construct((0.05, 5.0, 1, 3.0)).process(&columns, &Labels::default(), &mut out);
        assert!(out.get().is_none());
    }
}
