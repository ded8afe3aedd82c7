//! Failures: a node that fails sends nothing, and all others continue.

use apex_macros::graph;
use apex_tests::react;

graph! {
    /// LC-1
    graph Failing {
        node s = Count(end = 5);
        node f = fails_at(at = 1);
        node k = Snk();
        s -> f -> k;
    }

    /// A failure on one path to a join: the join does not fire, the other path is not affected.
    graph FailingDiamond {
        node s = Count(end = 9);
        node f = odd_fails();
        node k = Pair();
        node all = Essential();
        node other = Snk();
        s -> f -> [k.x, all];
        s -> [k.y, other];
    }
}

#[test]
fn lc_01_a_failure_sends_nothing_and_the_graph_goes_on() {
    let mut program = Failing::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [0, 2, 3, 4]);
    assert_eq!(log.failed, [("f", "no 1".to_owned())]);
    assert_eq!(log.count("f"), 5, "it fires again after its failure");
}

#[test]
fn lc_01_a_failure_on_one_way_to_a_join() {
    let mut program = FailingDiamond::new();
    let log = react(&mut program, 9);
    assert_eq!(program.nodes().k.seen, [(0, 0), (4, 4), (8, 8)]);
    assert_eq!(program.nodes().all.seen.len(), 9);
    assert_eq!(program.nodes().other.seen, (0..9).collect::<Vec<_>>());
    assert_eq!(log.failed.len(), 4);
}
