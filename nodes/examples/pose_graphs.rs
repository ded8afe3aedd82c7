//! Optimizes pose graphs in the formats of g2o and TORO: `pose_graphs FILE…` prints the cost (χ²) of the poses in the
//! file and after the optimization of these and of other starts, with the number of steps and the computing time.

use apex_nodes::slam::PoseGraph;
use std::{path::PathBuf, time::Instant};

/// Maximum number of steps.
const STEPS: usize = 100;

fn main() {
    let files: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    if files.is_empty() {
        eprintln!("usage: pose_graphs FILE…");
        std::process::exit(2);
    }
    println!(
        "{:20}{:>8}{:>8}  {:8}{:>14}{:>14}{:>7}{:>9}",
        "file", "poses", "edges", "start", "cost", "optimized", "steps", "ms"
    );
    for file in files {
        let graph = PoseGraph::read(&file).unwrap_or_else(|e| {
            eprintln!("{e}");
            std::process::exit(1);
        });
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        optimize(&name, "file", &graph, |_| ());
        optimize(&name, "tree", &graph, PoseGraph::initialize_from_tree);
        optimize(&name, "chordal", &graph, PoseGraph::initialize_chordal);
    }
}

/// Optimizes a graph from a start and prints a row.
fn optimize(name: &str, start: &str, graph: &PoseGraph, initialize: impl Fn(&mut PoseGraph)) {
    let mut graph = graph.clone();
    let clock = Instant::now();
    initialize(&mut graph);
    let before = graph.cost();
    let result = graph.optimize(STEPS);
    let time = 1e3 * clock.elapsed().as_secs_f64();
    let (poses, edges) = (graph.poses().len(), graph.edges().len());
    println!("{name:20}{poses:8}{edges:8}  {start:8}{before:14.2}{:14.4}{:7}{time:9.1}", result.cost, result.steps);
}
