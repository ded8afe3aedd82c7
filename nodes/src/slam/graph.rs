use super::{Edge, Pose, RobustKernel, heading, pose, sparse::BlockMatrix};
use nalgebra::{Matrix3, Vector3};

/// Added to the diagonal, so that unconnected poses do not make the matrix singular.
pub(super) const LEAST_DAMPING: f64 = 1e-9;
/// Maximum number of consecutive steps that do not lower the cost.
const MAX_RISEN: usize = 6;

/// Pose graph: poses in the plane and the measurements between them (Grisetti, Kümmerle, Stachniss, Burgard: A
/// Tutorial on Graph-Based SLAM, 2010).
///
/// ```no_run
/// use apex_nodes::slam::{PoseGraph, RobustKernel};
///
/// let mut graph = PoseGraph::read("building.g2o").expect("a pose graph");
/// // Odometry is trusted. A loop that contradicts the others counts for nothing.
/// graph.set_kernels(|edge| match edge.to == edge.from + 1 {
///     true => RobustKernel::Square,
///     false => RobustKernel::Dcs(1.0),
/// });
/// let result = graph.optimize(100);
/// println!("cost {:.2} after {} steps", result.cost, result.steps);
/// let last = graph.covariance(graph.poses().len() - 1).expect("a connected graph");
/// println!("the last pose is known to {:.2} m along x", last[(0, 0)].sqrt());
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseGraph {
    pub(super) poses: Vec<Pose>,
    pub(super) edges: Vec<Edge>,
}

/// Variables that a step changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Variables {
    All,
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

    /// Sets the robust kernel of each edge, such as of all edges that close a loop.
    pub fn set_kernels(&mut self, kernel: impl Fn(&Edge) -> RobustKernel) {
        for edge in &mut self.edges {
            edge.kernel = kernel(edge);
        }
    }

    /// Sum of ρ(eᵀ Ω e) over all edges, with the error e of an edge, its information Ω and its kernel ρ.
    pub fn cost(&self) -> f64 {
        self.cost_at(&self.poses)
    }

    fn cost_at(&self, poses: &[Pose]) -> f64 {
        self.edges.iter().map(|edge| edge.cost(poses)).sum()
    }

    /// Moves the poses to best agreement with the measurements. Stops when a step changes the cost by less than
    /// 10⁻⁶ of it (or by 10⁻⁹), or after `max_steps` steps. The first pose is fixed.
    ///
    /// Steps are those of Gauss–Newton. The first one leads astray from a wrong start, so the optimization goes on from
    /// the [chordal initialization](Self::initialize_chordal) if that costs less. Stiff measurements turn the path to
    /// the optimum into a narrow bend, so the cost may rise for a few steps. If it does not fall again, damped steps
    /// (Levenberg–Marquardt) continue from the best poses.
    ///
    /// Unconnected poses do not move. If a number is not finite, no pose moves.
    pub fn optimize(&mut self, max_steps: usize) -> Optimized {
        let mut matrix = self.matrix();
        let (mut poses, mut cost) = (self.poses.clone(), self.cost());
        let (mut damping, mut risen) = (LEAST_DAMPING, 0);
        for steps in 0..max_steps {
            let Some(mut moved) = self.step(&poses, &mut matrix, damping, Variables::All) else {
                return Optimized { steps, cost };
            };
            if steps == 0 {
                moved = self.cheapest(&mut matrix, moved, cost);
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

    /// Covariance of x, y (in m) and heading (in rad) of a pose along the axes of the map, if the first pose is known
    /// exactly: the inverse of the information of all measurements at the present poses, which should be the optimum.
    /// `None` if the measurements do not determine the pose.
    pub fn covariance(&self, pose: usize) -> Option<Matrix3<f64>> {
        if !self.part_of_first().contains(&pose) {
            return None;
        }
        let mut matrix = self.matrix();
        self.fill(&self.poses, &mut matrix, Variables::All);
        matrix.damp(LEAST_DAMPING);
        matrix.factorize()?;
        let columns = [0, 1, 2].map(|axis| {
            let mut column = vec![Vector3::zeros(); self.poses.len()];
            column[pose] = Vector3::ith(axis, 1.0);
            matrix.solve(&mut column);
            column[pose]
        });
        let covariance = Matrix3::from_columns(&columns);
        Some((covariance + covariance.transpose()) * if pose == 0 { 0.0 } else { 0.5 })
    }

    /// Poses after the first step, or those of the chordal initialization if they cost less, and clearly less than the
    /// present poses, which may be the same.
    fn cheapest(&self, matrix: &mut BlockMatrix, moved: Vec<Pose>, present: f64) -> Vec<Pose> {
        let bound = self.cost_at(&moved).min(0.99 * present);
        self.chordal(matrix).filter(|poses| self.cost_at(poses) < bound).unwrap_or(moved)
    }

    /// Zero matrix with storage for the blocks of all edges.
    pub(super) fn matrix(&self) -> BlockMatrix {
        BlockMatrix::new(self.poses.len(), self.edges.iter().map(|e| (e.from, e.to)))
    }

    /// Moves the poses from a number on as one.
    pub(super) fn move_from(&mut self, first: usize, by: &Pose) {
        for pose in self.poses.iter_mut().skip(first) {
            *pose = by * *pose;
        }
    }

    /// Removes the poses from a number on, and all edges to them.
    pub(super) fn truncate(&mut self, poses: usize) {
        self.poses.truncate(poses);
        self.edges.retain(|edge| edge.from.max(edge.to) < poses);
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

    /// Poses after one damped Gauss–Newton step from `poses`, or `None` if the step cannot be computed.
    pub(super) fn step(
        &self,
        poses: &[Pose],
        matrix: &mut BlockMatrix,
        damping: f64,
        variables: Variables,
    ) -> Option<Vec<Pose>> {
        if poses.is_empty() {
            return None;
        }
        let mut steps = self.fill(poses, matrix, variables);
        // Not a share of the diagonal: stiff measurements would also hold soft variables.
        matrix.damp(damping);
        matrix.factorize()?;
        matrix.solve(&mut steps);
        Some(poses.iter().zip(&steps).map(|(p, step)| moved(p, step)).collect())
    }

    /// Fills the matrix with the information of all measurements, and returns the negative gradient (half of it) of the
    /// cost. A connected part as a whole can be moved at no cost, so its first pose is held.
    fn fill(&self, poses: &[Pose], matrix: &mut BlockMatrix, variables: Variables) -> Vec<Vector3<f64>> {
        matrix.clear();
        let mut is_held = vec![false; poses.len()];
        for root in self.roots() {
            is_held[root] = true;
            matrix.add_diagonal(root, &Matrix3::identity());
        }
        let mut slope = vec![Vector3::zeros(); poses.len()];
        for edge in self.edges.iter().filter(|edge| edge.from != edge.to) {
            let information = edge.weighted_information(poses);
            let error = information * edge.error(&poses[edge.from], &poses[edge.to]);
            let (mut a, mut b) = edge.jacobians(&poses[edge.from], &poses[edge.to]);
            if variables == Variables::Positions {
                [&mut a, &mut b].into_iter().for_each(|m| m.fill_column(2, 0.0));
            }
            for (pose, jacobian) in [(edge.from, a), (edge.to, b)].iter().filter(|(pose, _)| !is_held[*pose]) {
                matrix.add_diagonal(*pose, &(jacobian.tr_mul(&information) * jacobian));
                slope[*pose] -= jacobian.tr_mul(&error);
            }
            if !is_held[edge.from] && !is_held[edge.to] {
                matrix.add(edge.from, edge.to, &(a.tr_mul(&information) * b));
            }
        }
        slope
    }
}

/// Pose after a step of x, y and heading.
fn moved(from: &Pose, step: &Vector3<f64>) -> Pose {
    pose(from.translation.x + step.x, from.translation.y + step.y, heading(from) + step.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    fn edge(from: usize, to: usize, measured: Pose) -> Edge {
        let information = Matrix3::from_diagonal(&Vector3::new(4.0, 9.0, 100.0));
        Edge { from, to, measured, information, kernel: RobustKernel::Square }
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
