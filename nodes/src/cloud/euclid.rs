use super::{
    Cluster,
    voxel::{VoxelTable, Voxels},
};
use crate::math::sets::Sets;
use apex_rt::{Out, node};

/// Mark of a cluster that has no number yet.
const NONE: u32 = u32::MAX;

/// Euclidean clusters of voxels: those whose means are at most `gap` from each other belong together, and so do all
/// that are joined by such pairs (Rusu 2009).
///
/// Rings that are far away are far from each other, so that parts of one thing have a gap between them: along z, the
/// gap may be longer by `spread` for each metre of distance from the origin. A cluster has at least `min_points`
/// points. The sizes of clusters are those of the means of their voxels. They are in the order of their first voxels.
///
/// Cost: O(n) for n voxels, times the number of voxels in the columns within a gap. Allocates with the first cloud, and
/// whenever one is larger than all before it.
#[node]
#[derive(Debug, Clone)]
pub struct EuclideanClusters {
    /// Largest distance between neighbours.
    #[param(unit = "m", default = 0.3, range = 0.01..=10.0)]
    gap: f32,
    /// Additional distance along z, per distance from the origin.
    #[param(default = 0.04, range = 0.0..=1.0)]
    spread: f32,
    /// Minimum number of points of a cluster.
    #[param(default = 4, range = 1..=1_000_000)]
    min_points: u32,
    /// Voxels by their columns along z: the last one of each.
    columns: VoxelTable,
    /// The voxel before each one in its column.
    previous: Vec<Option<u32>>,
    sets: Sets,
    numbers: Vec<u32>,
}

#[node]
impl EuclideanClusters {
    fn process(&mut self, voxels: &Voxels, clusters: &mut Out<Vec<Cluster>>) {
        let out = clusters.get_mut();
        out.clear();
        self.columns.reset(voxels.voxels.len());
        self.previous.clear();
        self.sets.clear();
        for i in 0..voxels.voxels.len() as u32 {
            self.sets.add();
            self.join(voxels, i);
            self.previous.push(self.columns.put(i, |number| column_of(voxels, number)));
        }
        self.numbers.clear();
        self.numbers.resize(self.sets.len(), NONE);
        for (i, voxel) in voxels.voxels.iter().enumerate() {
            let root = self.sets.root(i as u32) as usize;
            let number = &mut self.numbers[root];
            if *number == NONE {
                *number = out.len() as u32;
                out.push(Cluster::at(voxel.mean));
            }
            out[*number as usize].add(voxel.mean, voxel.count as usize);
        }
        out.retain(|cluster| cluster.points >= self.min_points as usize);
    }

    /// Joins a voxel with those before it that are near.
    fn join(&mut self, voxels: &Voxels, i: u32) {
        let voxel = &voxels.voxels[i as usize];
        let range = libm::sqrtf(voxel.mean.iter().map(|c| c * c).sum());
        let up = self.gap + self.spread * range;
        let level = (libm::ceilf(self.gap / voxels.side) as i16).clamp(1, 40);
        let [x, y, _] = voxel.cell;
        for dx in -level..=level {
            for dy in -level..=level {
                let column = [x.saturating_add(dx), y.saturating_add(dy), 0];
                let mut next = self.columns.find(column, |number| column_of(voxels, number));
                while let Some(other) = next {
                    let mean = &voxels.voxels[other as usize].mean;
                    let d: [f32; 3] =
                        std::array::from_fn(|k| (voxel.mean[k] - mean[k]) / if k == 2 { up } else { self.gap });
                    if d.iter().map(|c| c * c).sum::<f32>() <= 1.0 {
                        self.sets.join(i, other);
                    }
                    next = self.previous[other as usize];
                }
            }
        }
    }
}

/// Column of a voxel along z.
fn column_of(voxels: &Voxels, number: u32) -> [i16; 3] {
    let [x, y, _] = voxels.voxels[number as usize].cell;
    [x, y, 0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{VoxelGrid, columns::tests::dark};
    use apex_rt::Construct;

    fn clusters(points: &[[f32; 3]], gap: f32, spread: f32) -> Vec<Cluster> {
        let (mut voxels, mut out) = (Out::new(), Out::new());
        VoxelGrid::construct((0.1, 30.0)).process(&dark(1, points), None, &mut voxels);
        let mut node = EuclideanClusters::construct((gap, spread, 3));
        node.process(voxels.get().expect("voxels"), &mut out);
        out.get().cloned().expect("clusters")
    }

    /// Clusters of points by comparing each with each other.
    fn slowly(points: &[[f32; 3]], gap: f32) -> usize {
        let mut group: Vec<usize> = (0..points.len()).collect();
        for i in 0..points.len() {
            for j in 0..i {
                let d: f32 = (0..3).map(|k| (points[i][k] - points[j][k]).powi(2)).sum();
                if d.sqrt() <= gap && group[i] != group[j] {
                    let (a, b) = (group[i], group[j]);
                    group.iter_mut().filter(|g| **g == a).for_each(|g| *g = b);
                }
            }
        }
        group
            .iter()
            .filter(|g| group.iter().filter(|h| h == g).count() >= 3)
            .collect::<std::collections::BTreeSet<_>>()
            .len()
    }

    #[test]
    fn clusters_are_those_of_all_pairs() {
        let mut random = crate::math::Random::new(9);
        // Middles of different voxels, so that the means are the points.
        let cells: std::collections::BTreeSet<[u64; 3]> =
            (0..400).map(|_| std::array::from_fn(|_| random.below(25))).collect();
        let points: Vec<[f32; 3]> = cells.into_iter().map(|cell| cell.map(|c| (c as f32 - 11.5) * 0.1)).collect();
        let found = clusters(&points, 0.18, 0.0);
        assert!(found.len() > 5, "{}", found.len());
        assert_eq!(found.len(), slowly(&points, 0.18));
    }

    #[test]
    fn distant_rings_belong_together() {
        // A person 15 m away, whom four rings meet, 0.5 m above each other.
        let person: Vec<[f32; 3]> =
            (0..4).flat_map(|ring| (0..5).map(move |i| [15.0, 0.1 * i as f32, 0.5 * ring as f32])).collect();
        assert_eq!(clusters(&person, 0.3, 0.04).len(), 1);
        assert_eq!(clusters(&person, 0.3, 0.0).len(), 4);
        assert_eq!(clusters(&[], 0.3, 0.0), []);
    }
}
