//! Pose graphs: starts, robust kernels and covariances.

use crate::recording;
use apex_nodes::slam::{Edge, Pose, PoseGraph, RobustKernel, heading, pose};
use nalgebra::{Matrix3, Vector3};

/// SplitMix64 with the sum of twelve uniform numbers, which is nearly normal.
struct Random(u64);

impl Random {
    fn normal(&mut self) -> f64 {
        let uniform = |_| {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(uniform).sum::<f64>() - 6.0
    }
}

/// Standard deviations of x, y and heading of a measurement.
const SIGMA: [f64; 3] = [0.03, 0.02, 0.03];

fn edge(from: usize, to: usize, measured: Pose) -> Edge {
    let information = Matrix3::from_diagonal(&Vector3::from(SIGMA.map(|sigma| sigma.powi(-2))));
    Edge { from, to, measured, information, kernel: RobustKernel::Square }
}

/// True pose on a way that goes back and forth over 20 rows of 20 m, with 1 m between them.
fn truth(step: usize) -> Pose {
    let (row, column) = (step / 20, step % 20);
    let is_back = row % 2 == 1;
    let x = if is_back { 19 - column } else { column };
    pose(x as f64, row as f64, if is_back { std::f64::consts::PI } else { 0.0 })
}

/// Noisy measurements from pose to pose and to the row before, with all poses at the origin.
fn field(random: &mut Random) -> PoseGraph {
    let mut graph = PoseGraph::default();
    (0..400).for_each(|_| _ = graph.add_pose(Pose::identity()));
    let mut add = |from: usize, to: usize| {
        let [x, y, theta] = SIGMA.map(|sigma| sigma * random.normal());
        let measured = truth(from).inv_mul(&truth(to)) * pose(x, y, theta);
        graph.add_edge(edge(from, to, measured)).expect("poses");
    };
    (1..400).for_each(|to| add(to - 1, to));
    for to in (20..400).step_by(7) {
        add((to / 20) * 40 - 1 - to, to);
    }
    graph
}

/// Largest distance of a pose from the truth, in m.
fn error(graph: &PoseGraph) -> f64 {
    let error = |(step, pose): (usize, &Pose)| (pose.translation.vector - truth(step).translation.vector).norm();
    graph.poses().iter().enumerate().map(error).fold(0.0, f64::max)
}

#[test]
fn every_start_leads_to_the_same_optimum() {
    let graph = field(&mut Random(1));
    let optimized = |initialize: fn(&mut PoseGraph)| {
        let mut graph = graph.clone();
        initialize(&mut graph);
        (graph.cost(), graph.optimize(50).cost, error(&graph))
    };
    let (present, from_present, near) = optimized(|_| ());
    let (tree, from_tree, _) = optimized(PoseGraph::initialize_from_tree);
    let (chordal, from_chordal, _) = optimized(PoseGraph::initialize_chordal);
    assert!(chordal < 0.1 * tree && tree < present, "{chordal} {tree} {present}");
    for cost in [from_present, from_tree] {
        assert!((cost / from_chordal - 1.0).abs() < 1e-5, "{cost} {from_chordal}");
    }
    // χ² has 3 degrees of freedom for each measurement, less 3 for each pose but the first.
    let freedom = 3.0 * (graph.edges().len() as f64 - 399.0);
    assert!((from_chordal / freedom - 1.0).abs() < 0.4 && near < 4.0, "{from_chordal} of {freedom}, {near} m");
}

#[test]
fn robust_kernels_ignore_false_loops() {
    let mut graph = field(&mut Random(2));
    let clean = optimized(&graph);
    graph.initialize_from_tree();
    for (from, to) in [(5, 250), (60, 333), (120, 390), (18, 200)] {
        graph.add_edge(edge(from, to, pose(0.1, 0.0, 0.0))).expect("poses");
    }
    let error = |kernel: RobustKernel| {
        let mut graph = graph.clone();
        graph.set_kernels(|edge| if edge.to == edge.from + 1 { RobustKernel::Square } else { kernel });
        optimized(&graph)
    };
    let square = error(RobustKernel::Square);
    assert!(square > 4.0 * clean, "{square} m, without false loops {clean} m");
    for kernel in [RobustKernel::Cauchy(1.0), RobustKernel::Dcs(1.0)] {
        assert!(error(kernel) < 1.2 * clean, "{kernel:?}: {} m, without false loops {clean} m", error(kernel));
    }
}

/// Largest error after the optimization of a graph, in m.
fn optimized(graph: &PoseGraph) -> f64 {
    let mut graph = graph.clone();
    graph.optimize(100);
    error(&graph)
}

#[test]
fn an_outlier_pulls_less_than_the_others() {
    let settled = |kernel: RobustKernel| {
        let mut graph = PoseGraph::default();
        [0.0, 1.0].into_iter().for_each(|x| _ = graph.add_pose(pose(x, 0.0, 0.0)));
        for x in [1.0, 1.02, 9.0] {
            graph.add_edge(Edge { kernel, ..edge(0, 1, pose(x, 0.0, 0.0)) }).expect("poses");
        }
        graph.optimize(100);
        graph.poses()[1].translation.x
    };
    for (kernel, x) in [
        (RobustKernel::Square, 11.02 / 3.0),
        // The pull of the outlier is that of an error of one standard deviation.
        (RobustKernel::Huber(1.0), 1.01 + 0.5 * SIGMA[0]),
        // Φ against 266 standard deviations: a share of 10⁻⁹ of 8 m.
        (RobustKernel::Dcs(1.0), 1.01),
    ] {
        assert!((settled(kernel) - x).abs() < 1e-5, "{kernel:?}: {}", settled(kernel));
    }
    assert!((1.01..1.011).contains(&settled(RobustKernel::Cauchy(1.0))));
}

#[test]
fn covariances_are_those_of_the_poses_in_many_trials() {
    // A triangle and a pose that hangs on it; one more pose is not connected.
    let truth = [pose(0.0, 0.0, 0.5), pose(2.0, 0.0, 1.0), pose(2.0, 1.5, -2.0), pose(4.0, 2.0, 0.0)];
    let mut random = Random(3);
    let mut trial = |noise: f64| {
        let mut graph = PoseGraph::default();
        truth.iter().for_each(|pose| _ = graph.add_pose(*pose));
        for (from, to) in [(0, 1), (1, 2), (2, 0), (2, 3)] {
            let [x, y, theta] = SIGMA.map(|sigma| noise * sigma * random.normal());
            let measured = truth[from].inv_mul(&truth[to]) * pose(x, y, theta);
            graph.add_edge(edge(from, to, measured)).expect("poses");
        }
        graph.optimize(20);
        graph
    };
    let mut exact = trial(0.0);
    exact.add_pose(pose(9.0, 9.0, 0.0));
    let mut spread = [Matrix3::zeros(); 4];
    for _ in 0..4000 {
        let graph = trial(1.0);
        for ((sum, found), truth) in spread.iter_mut().zip(graph.poses()).zip(&truth) {
            let off = found.translation.vector - truth.translation.vector;
            let off = Vector3::new(off.x, off.y, heading(&(truth.inverse() * found)));
            *sum += off * off.transpose() / 4000.0;
        }
    }
    for (pose, spread) in spread.iter().enumerate() {
        let covariance = exact.covariance(pose).expect("a connected pose");
        let size = covariance.norm();
        assert!((covariance - spread).norm() <= 0.1 * size, "pose {pose}: {covariance}, in trials {spread}");
    }
    assert_eq!([exact.covariance(0), exact.covariance(4), exact.covariance(5)], [Some(Matrix3::zeros()), None, None]);
}

/// Cost of the optimum of the graph of the Intel Research Lab, as g2o computes it.
const INTEL: f64 = 215.8302;

/// The graph of the Intel Research Lab, with and without its vertices.
#[test]
fn a_known_graph_is_optimized_as_well_as_it_can_be() {
    let (Some(raw), Some(optimum)) = (recording("input_INTEL.g2o"), recording("input_INTEL_optimized.g2o")) else {
        return;
    };
    let text = std::fs::read_to_string(&raw).expect("the graph");
    let bare: String = text.lines().filter(|line| !line.starts_with("VERTEX")).flat_map(|line| [line, "\n"]).collect();
    let file = std::env::temp_dir().join(format!("apex-bare-{}.g2o", std::process::id()));
    std::fs::write(&file, bare).expect("a temporary file");
    let optimum = PoseGraph::read(optimum).expect("its optimum");
    for path in [&raw, &file] {
        let mut graph = PoseGraph::read(path).expect("the graph");
        let (before, after) = (graph.cost(), graph.optimize(50));
        assert!(before > 2.0 * INTEL && (after.cost / INTEL - 1.0).abs() < 1e-5, "{before} {after:?}");
        let far = |(a, b): (&Pose, &Pose)| (a.translation.vector - b.translation.vector).norm();
        let worst = graph.poses().iter().zip(optimum.poses()).map(far).fold(0.0, f64::max);
        assert!(worst < 0.05, "{worst} m");
    }
    std::fs::remove_file(file).expect("the file");
}
