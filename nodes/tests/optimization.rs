//! `optimization.afg`: optimizers within the flow.

use apex_macros::graph;
use apex_nodes::optim::Candidate;
use apex_rt::prelude::*;

graph!("optimization.afg");

/// Fitness of the step response of a cart of 1 kg that a spring (N/m) and a damper (N s/m) pull to its goal 1 m away:
/// the integral of the distance from the goal, in m s, and of a share of the squared force, over 5 s.
#[node]
pub fn step_response(
    #[param(default = 1.0, range = 0.0..=1000.0)] stiffness: f64,
    #[param(default = 1.0, range = 0.0..=1000.0)] damping: f64,
) -> f64 {
    let (mut position, mut speed, mut fitness) = (0.0, 0.0, 0.0);
    let step = 0.005;
    for _ in 0..1000 {
        let force = stiffness * (1.0 - position) - damping * speed;
        speed += step * force;
        position += step * speed;
        fitness += step * (f64::abs(1.0 - position) + 1e-3 * force * force);
    }
    fitness
}

/// Best candidate of a run.
macro_rules! run {
    ($graph:ident) => {{
        let mut graph = $graph::new();
        graph.inputs().begin.put(()).expect("an empty mailbox");
        graph.react(Time::ZERO);
        graph.events().best.take()
    }};
}

#[test]
fn both_optimizers_find_the_same_gains() {
    let best: [Candidate; 2] =
        [run!(TuneController).expect("the best gains"), run!(TuneControllerByCmaEs).expect("the best gains")];
    let fitness = best.each_ref().map(|c| step_response(c[0], c[1]));
    println!("{best:?} {fitness:?}");
    for (candidate, fitness) in best.iter().zip(fitness) {
        assert!((fitness - 0.337_349).abs() < 1e-5);
        for factor in [0.97, 1.03] {
            assert!(fitness < step_response(factor * candidate[0], candidate[1]));
            assert!(fitness < step_response(candidate[0], factor * candidate[1]));
        }
    }
}
