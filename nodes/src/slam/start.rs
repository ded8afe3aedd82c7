//! Start poses of the optimization of a pose graph, from its measurements alone.

use super::{
    Pose, PoseGraph,
    graph::{LEAST_DAMPING, Variables},
    heading, pose,
    sparse::BlockMatrix,
};
use nalgebra::{Matrix2, Matrix3, Vector3};
use std::collections::VecDeque;

impl PoseGraph {
    /// Moves the poses to where the measurements along a spanning tree put them. The tree is breadth-first: there are
    /// as few measurements as possible between a pose and the first one. The first pose of each connected part stays.
    pub fn initialize_from_tree(&mut self) {
        for (pose, edge) in self.spanning_tree() {
            let Some(edge) = edge.map(|edge| &self.edges[edge]) else { continue };
            self.poses[pose] = if edge.to == pose {
                self.poses[edge.from] * edge.measured
            } else {
                self.poses[edge.to] * edge.measured.inverse()
            };
        }
    }

    /// Moves the poses to a start near the optimum that does not depend on the present poses, except for the first one
    /// of each connected part, which stays.
    ///
    /// The headings come first, by linear least squares on rotation matrices (chordal initialization: Carlone, Tron,
    /// Daniilidis, Dellaert: Initialization Techniques for 3D SLAM, 2015), then the positions, in which the errors are
    /// linear if headings are given. Robust kernels have no effect. If a number is not finite, no pose moves.
    pub fn initialize_chordal(&mut self) {
        if let Some(poses) = self.chordal(&mut self.matrix()) {
            self.poses = poses;
        }
    }

    /// Poses of the chordal initialization, or `None` if they cannot be computed.
    pub(super) fn chordal(&self, matrix: &mut BlockMatrix) -> Option<Vec<Pose>> {
        let turned = self.chordal_headings(matrix)?;
        self.step(&turned, matrix, LEAST_DAMPING, Variables::Positions)
    }

    /// Present poses with the headings of the chordal initialization: minimizes Σ ω |r_to − R r_from|² over the first
    /// columns r of their rotation matrices, with measured rotations R and their information ω.
    fn chordal_headings(&self, matrix: &mut BlockMatrix) -> Option<Vec<Pose>> {
        matrix.clear();
        let mut columns = vec![Vector3::zeros(); self.poses.len()];
        for edge in self.edges.iter().filter(|edge| edge.from != edge.to) {
            let weight = edge.information[(2, 2)];
            let rotation = edge.measured.rotation.to_rotation_matrix().into_inner();
            let square = block(&(Matrix2::identity() * weight));
            matrix.add_diagonal(edge.from, &square);
            matrix.add_diagonal(edge.to, &square);
            matrix.add(edge.to, edge.from, &block(&(rotation * -weight)));
        }
        // One column of each connected part is held. The weight of this only scales all columns of the part.
        let roots = self.roots();
        for &root in &roots {
            matrix.add_diagonal(root, &Matrix3::identity());
            let rotation = self.poses[root].rotation;
            columns[root] = Vector3::new(rotation.re, rotation.im, 0.0);
        }
        for pose in 0..self.poses.len() {
            // The blocks are larger than the columns.
            matrix.add_diagonal(pose, &Matrix3::from_diagonal(&Vector3::z()));
        }
        matrix.factorize()?;
        matrix.solve(&mut columns);
        let mut poses: Vec<Pose> = self.poses.iter().zip(&columns).map(|(pose, column)| turned(pose, column)).collect();
        // Without the rounding of their columns.
        roots.into_iter().for_each(|root| poses[root] = self.poses[root]);
        Some(poses)
    }

    /// First pose of each connected part.
    pub(super) fn roots(&self) -> Vec<usize> {
        self.spanning_tree().into_iter().filter(|(_, edge)| edge.is_none()).map(|(pose, _)| pose).collect()
    }

    /// Poses that measurements connect with the first one, and itself.
    pub(super) fn part_of_first(&self) -> Vec<usize> {
        let mut tree = self.spanning_tree().into_iter();
        let first = tree.next();
        first.into_iter().chain(tree.take_while(|(_, edge)| edge.is_some())).map(|(pose, _)| pose).collect()
    }

    /// Breadth-first spanning tree: each pose after the one that it is measured from, with the number of the edge
    /// between the two, or with `None` for the first pose of a connected part.
    fn spanning_tree(&self) -> Vec<(usize, Option<usize>)> {
        let mut edges = vec![Vec::new(); self.poses.len()];
        for (number, edge) in self.edges.iter().enumerate() {
            edges[edge.from].push((number, edge.to));
            edges[edge.to].push((number, edge.from));
        }
        let mut reached = vec![false; self.poses.len()];
        let (mut tree, mut open) = (Vec::with_capacity(self.poses.len()), VecDeque::new());
        for root in 0..self.poses.len() {
            if std::mem::replace(&mut reached[root], true) {
                continue;
            }
            open.push_back((root, None));
            while let Some((pose, edge)) = open.pop_front() {
                tree.push((pose, edge));
                for &(edge, next) in &edges[pose] {
                    if !std::mem::replace(&mut reached[next], true) {
                        open.push_back((next, Some(edge)));
                    }
                }
            }
        }
        tree
    }
}

/// Block of the matrix of all poses with these entries for two of its three variables.
fn block(entries: &Matrix2<f64>) -> Matrix3<f64> {
    let mut block = Matrix3::zeros();
    block.fixed_view_mut::<2, 2>(0, 0).copy_from(entries);
    block
}

/// The pose with the heading of the column of a rotation matrix, of any length.
fn turned(from: &Pose, column: &Vector3<f64>) -> Pose {
    let theta = if column.norm() > 0.0 { column.y.atan2(column.x) } else { heading(from) };
    pose(from.translation.x, from.translation.y, theta)
}
