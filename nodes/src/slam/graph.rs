use super::{Pose, heading, pose, sparse::BlockMatrix};
use nalgebra::{Matrix3, Vector2, Vector3};

/// Added to the diagonal, so that unconnected poses do not make the matrix singular.
const LEAST_DAMPING: f64 = 1e-9;
/// Maximum number of consecutive steps that do not lower the cost.
const MAX_RISEN: usize = 6;

/// Edge of a pose graph: the measured pose of one pose relative to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// Number of the pose from which the measurement was taken.
    pub from: usize,
    /// Number of the measured pose.
    pub to: usize,
    /// Measured pose `to` in the frame of the pose `from`.
    pub measured: Pose,
    /// Inverse of the covariance of x, y (in m) and heading (in rad) of the measurement, along the axes of the frame of
    /// the pose `to`.
    pub information: Matrix3<f64>,
}

/// Pose graph: poses in the plane and the measurements between them (Grisetti, Kümmerle, Stachniss, Burgard: A
/// Tutorial on Graph-Based SLAM, 2010).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseGraph {
    poses: Vec<Pose>,
    edges: Vec<Edge>,
}

/// Variables that a step changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    Headings,
    Positions,
}

/// Result of an optimization.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimized {
    /// Number of steps that were tried.
    pub steps: usize,
    /// Final cost: see [`PoseGraph::cost`].
    pub cost: f64,
}

/// Error of an edge to a pose that the graph does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoSuchPose(pub usize);

impl std::fmt::Display for NoSuchPose {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the graph has no pose {}", self.0)
    }
}

impl std::error::Error for NoSuchPose {}

impl Edge {
    /// eᵀ Ω e with the error e and the information Ω: χ² of the measurement if the poses are right.
    pub(super) fn cost(&self, poses: &[Pose]) -> f64 {
        let error = self.error(&poses[self.from], &poses[self.to]);
        error.dot(&(self.information * error))
    }

    /// Deviation of the measurement from the poses, in the frame of the measured pose: x, y and heading.
    fn error(&self, from: &Pose, to: &Pose) -> Vector3<f64> {
        let difference = from.inv_mul(to).inv_mul(&self.measured);
        Vector3::new(difference.translation.x, difference.translation.y, heading(&difference))
    }

    /// Derivatives of the error with respect to x, y and heading of the two poses.
    fn jacobians(&self, from: &Pose, to: &Pose) -> (Matrix3<f64>, Matrix3<f64>) {
        let error = self.error(from, to);
        let back = to.rotation.inverse();
        let turn = back.to_rotation_matrix().into_inner();
        let lever = back * from.rotation * Vector2::new(-self.measured.translation.y, self.measured.translation.x);
        let mut a = Matrix3::identity();
        a.fixed_view_mut::<2, 2>(0, 0).copy_from(&turn);
        a.fixed_view_mut::<2, 1>(0, 2).copy_from(&lever);
        let mut b = -Matrix3::identity();
        b.fixed_view_mut::<2, 2>(0, 0).copy_from(&-turn);
        b.fixed_view_mut::<2, 1>(0, 2).copy_from(&Vector2::new(error.y, -error.x));
        (a, b)
    }
}

impl PoseGraph {
    /// Appends a pose and returns its number.
    pub fn add_pose(&mut self, pose: Pose) -> usize {
        self.poses.push(pose);
        self.poses.len() - 1
    }

    /// Adds a measurement between two poses.
    ///
    /// # Errors
    /// If one of the poses does not exist.
    pub fn add_edge(&mut self, edge: Edge) -> Result<(), NoSuchPose> {
        match [edge.from, edge.to].into_iter().find(|&end| end >= self.poses.len()) {
            Some(end) => Err(NoSuchPose(end)),
            None => {
                self.edges.push(edge);
                Ok(())
            }
        }
    }

    /// Poses, by number.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Measurements between the poses.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Sum of eᵀ Ω e over all edges, with the error e of an edge and its information Ω.
    pub fn cost(&self) -> f64 {
        self.cost_at(&self.poses)
    }

    fn cost_at(&self, poses: &[Pose]) -> f64 {
        self.edges.iter().map(|edge| edge.cost(poses)).sum()
    }

    /// Moves the poses to best agreement with the measurements. Stops when a step changes the cost by less than
    /// 10⁻⁶ of it (or by 10⁻⁹), or after `max_steps` steps. The first pose is fixed.
    ///
    /// Steps are those of Gauss–Newton. Stiff measurements turn the path to the optimum into a narrow bend, so the
    /// cost may rise for a few steps. If it does not fall again, damped steps (Levenberg–Marquardt) continue from the
    /// best poses.
    ///
    /// Unconnected poses do not move. If a number is not finite, no pose moves.
    pub fn optimize(&mut self, max_steps: usize) -> Optimized {
        let mut matrix = BlockMatrix::new(self.poses.len(), self.edges.iter().map(|e| (e.from, e.to)));
        let (mut poses, mut cost) = (self.poses.clone(), self.cost());
        let (mut damping, mut risen) = (LEAST_DAMPING, 0);
        for steps in 0..max_steps {
            let Some(mut moved) = self.step(&poses, &mut matrix, damping, Part::All) else {
                return Optimized { steps, cost };
            };
            if steps == 0 && self.cost_at(&moved) > cost {
                moved = self.headings_first(&mut matrix, damping).unwrap_or(moved);
            }
            let next = self.cost_at(&moved);
            let gain = cost - next;
            if gain > 0.0 {
                self.poses.clone_from(&moved);
                (cost, risen) = (next, 0);
            }
            if !next.is_finite() || gain.abs() <= 1e-6 * cost + 1e-9 {
                return Optimized { steps: steps + 1, cost };
            }
            risen += 1;
            poses = moved;
            if risen > MAX_RISEN {
                (damping, risen) = (damping * 100.0, 0);
                poses.clone_from(&self.poses);
            }
        }
        Optimized { steps: max_steps, cost }
    }

    /// Moves only the last pose, to best agreement with the most recently added edges that end there.
    pub(super) fn settle_last(&mut self) {
        let Some(last) = self.poses.len().checked_sub(1) else { return };
        let (mut curvature, mut gradient) = (Matrix3::zeros(), Vector3::zeros());
        for edge in self.edges.iter().rev().take_while(|edge| edge.to == last) {
            let (from, to) = (&self.poses[edge.from], &self.poses[last]);
            let (_, b) = edge.jacobians(from, to);
            curvature += b.tr_mul(&edge.information) * b;
            gradient -= b.tr_mul(&(edge.information * edge.error(from, to)));
        }
        if let Some(factor) = curvature.cholesky() {
            self.poses[last] = moved(&self.poses[last], &factor.solve(&gradient));
        }
    }

    /// Poses after two steps, one of the headings and one of the positions. The errors are linear in each of them. This
    /// helps with a start so wrong that a step of all variables leads astray (Carlone et al.: A Fast and Accurate
    /// Approximation for Planar Pose Graph Optimization, 2014).
    fn headings_first(&self, matrix: &mut BlockMatrix, damping: f64) -> Option<Vec<Pose>> {
        let turned = self.step(&self.poses, matrix, damping, Part::Headings)?;
        self.step(&turned, matrix, damping, Part::Positions)
    }

    /// Poses after one damped Gauss–Newton step from `poses`, or `None` if the step cannot be computed.
    fn step(&self, poses: &[Pose], matrix: &mut BlockMatrix, damping: f64, part: Part) -> Option<Vec<Pose>> {
        if poses.is_empty() {
            return None;
        }
        matrix.clear();
        let mut gradient = vec![Vector3::zeros(); poses.len()];
        for edge in &self.edges {
            let (from, to) = (&poses[edge.from], &poses[edge.to]);
            let mut information = edge.information;
            let (mut a, mut b) = edge.jacobians(from, to);
            match part {
                Part::All => {}
                Part::Headings => information = Matrix3::from_diagonal(&Vector3::z().scale(information[(2, 2)])),
                Part::Positions => [&mut a, &mut b].into_iter().for_each(|m| m.fill_column(2, 0.0)),
            }
            let error = information * edge.error(from, to);
            let (a_info, b_info) = (a.tr_mul(&information), b.tr_mul(&information));
            matrix.add_diagonal(edge.from, &(a_info * a));
            matrix.add_diagonal(edge.to, &(b_info * b));
            if edge.from != edge.to {
                matrix.add(edge.from, edge.to, &(a_info * b));
            }
            gradient[edge.from] -= a.tr_mul(&error);
            gradient[edge.to] -= b.tr_mul(&error);
        }
        // Not a share of the diagonal: stiff measurements would also hold soft variables.
        matrix.damp(damping);
        // The graph as a whole can be moved at no cost, so its first pose is held.
        matrix.add_diagonal(0, &Matrix3::identity());
        matrix.factorize()?;
        matrix.solve(&mut gradient);
        gradient[0] = Vector3::zeros();
        Some(poses.iter().zip(&gradient).map(|(p, step)| moved(p, step)).collect())
    }
}

/// Pose after a step of x, y and heading.
fn moved(from: &Pose, step: &Vector3<f64>) -> Pose {
    pose(from.translation.x + step.x, from.translation.y + step.y, heading(from) + step.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(from: usize, to: usize, measured: Pose) -> Edge {
        Edge { from, to, measured, information: Matrix3::from_diagonal(&Vector3::new(4.0, 9.0, 100.0)) }
    }

    /// A square with sides of 1 m driven twice, measured exactly, from a wrong start.
    fn square() -> PoseGraph {
        let mut graph = PoseGraph::default();
        let side = pose(1.0, 0.0, std::f64::consts::FRAC_PI_2);
        for i in 0..8 {
            let wrong = 0.1 * f64::from(i);
            graph.add_pose(pose(f64::from(i) * 0.2 - wrong, wrong * wrong, 1.4 * f64::from(i)));
        }
        for i in 1..8 {
            graph.add_edge(edge(i - 1, i, side)).expect("poses");
        }
        graph.add_edge(edge(0, 4, Pose::identity())).expect("poses");
        graph
    }

    #[test]
    fn exact_measurements_are_met() {
        let mut graph = square();
        let result = graph.optimize(50);
        assert!(result.cost < 1e-9 && result.steps < 50, "{result:?}");
        let corner = graph.poses()[6];
        assert!((corner.translation.vector - Vector2::new(1.0, 1.0)).norm() < 1e-6, "{corner}");
        assert_eq!(graph.poses()[0], pose(0.0, 0.0, 0.0));
    }

    #[test]
    fn derivatives_are_those_of_the_error() {
        let (from, to) = (pose(0.3, -1.0, 2.0), pose(1.4, 0.2, -2.9));
        let edge = edge(0, 1, pose(0.2, 0.4, 1.1));
        let (a, b) = edge.jacobians(&from, &to);
        let moved = |p: &Pose, i: usize, h: f64| {
            let d = Vector3::ith(i, h);
            pose(p.translation.x + d.x, p.translation.y + d.y, heading(p) + d.z)
        };
        for i in 0..3 {
            let h = 1e-6;
            let da = (edge.error(&moved(&from, i, h), &to) - edge.error(&moved(&from, i, -h), &to)) / (2.0 * h);
            let db = (edge.error(&from, &moved(&to, i, h)) - edge.error(&from, &moved(&to, i, -h))) / (2.0 * h);
            assert!((a.column(i) - da).norm() < 1e-6 && (b.column(i) - db).norm() < 1e-6, "{i}");
        }
    }

    #[test]
    fn the_last_pose_settles_between_what_was_measured() {
        let mut graph = PoseGraph::default();
        for x in [0.0, 1.0, 2.5] {
            graph.add_pose(pose(x, 0.0, 0.0));
        }
        for (from, to, x) in [(0, 1, 7.0), (0, 2, 2.0), (1, 2, 1.2)] {
            graph.add_edge(edge(from, to, pose(x, 0.0, 0.0))).expect("poses");
        }
        graph.settle_last();
        let x: Vec<f64> = graph.poses().iter().map(|p| p.translation.x).collect();
        assert!(x[..2] == [0.0, 1.0] && (x[2] - 2.1).abs() < 1e-9, "{x:?}");
    }

    #[test]
    fn what_cannot_be_solved_stays_as_it_is() {
        assert_eq!(PoseGraph::default().optimize(5).cost, 0.0);
        let mut graph = square();
        assert_eq!(graph.add_edge(edge(0, 8, Pose::identity())), Err(NoSuchPose(8)));
        graph.add_pose(pose(7.0, 8.0, 0.0));
        graph.optimize(50);
        assert_eq!(graph.poses()[8], pose(7.0, 8.0, 0.0));
        graph.add_edge(edge(0, 8, pose(f64::NAN, 0.0, 0.0))).expect("poses");
        let before = graph.clone();
        graph.optimize(50);
        assert_eq!(graph.poses(), before.poses());
    }
}
