//! `each`: order, length, filters, broadcast, nesting, state.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::react;

graph!("each.afg");

#[test]
fn sub_05_a_product_for_each_element() {
    let mut program = Products::new();
    react(&mut program, 23);
    let expected: Vec<Vec<i64>> = (0..23).map(|i| (0..8).map(|j| j * i * i).collect()).collect();
    assert_eq!(program.nodes().k.seen, expected);
}

#[test]
fn the_list_is_found_by_its_type() {
    let mut program = Found::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [[0, 0, 0], [1, 2, 3], [2, 4, 6]]);
}

#[test]
fn sub_06_lists_keep_their_length_and_filters_leave_no_holes() {
    let mut program = Lengths::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [vec![2, 4, 6], vec![8], vec![], vec![10, 12]]);
    assert_eq!(program.nodes().evens.seen, [vec![20], vec![40], vec![], vec![60]]);
}

#[test]
fn other_inputs_are_repeated() {
    let mut program = Broadcast::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [vec![1, 5], vec![7]], "without a limit there is no list at all");
}

#[test]
fn each_output_is_collected_on_its_own() {
    let mut program = TwoOutputs::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().halves.seen, [vec![1, 2], vec![], vec![4]]);
    assert_eq!(program.nodes().odds.seen, [vec![true, false, true, false], vec![], vec![false]]);
    assert_eq!(program.nodes().again.seen, program.nodes().halves.seen);
}

#[test]
fn each_in_each() {
    let mut program = Nested::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().rows.seen, [vec![vec![0, 10, 20], vec![0]], vec![]]);
    assert_eq!(program.nodes().sums.seen, [vec![30, 0], vec![]]);
}

#[test]
fn a_body_has_one_state() {
    let mut program = Stateful::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [vec![1, 2], vec![], vec![3]]);
}

#[test]
fn a_source_in_the_body_fires_for_each_element() {
    let mut program = Mixed::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [vec![42, 44], vec![56]]);
}

/// Runs `check` on `count` threads.
fn on_threads(count: usize, check: impl FnOnce() + Send) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads can be started");
    pool.install(check);
}

#[test]
fn in_parallel_is_as_one_after_the_other() {
    for threads in [1, 2, 7] {
        on_threads(threads, || {
            let mut program = Parallel::new();
            react(&mut program, 6);
            assert_eq!(program.nodes().alls.seen, [vec![], vec![212], vec![306, 312, 318], vec![], vec![506, 506]]);
            assert_eq!(program.nodes().alls.seen, program.nodes().ones.seen);
            assert_eq!(program.nodes().all_rows.seen[2][5], [0, 30]);
            assert_eq!(program.nodes().all_rows.seen, program.nodes().one_rows.seen);
        });
    }
}

#[test]
fn long_lists_keep_their_order() {
    for threads in [1, 2, 7] {
        on_threads(threads, || {
            let mut program = ParallelLong::new();
            react(&mut program, 3);
            assert_eq!(program.nodes().alls.seen.last().map(Vec::len), Some(1000));
            assert_eq!(program.nodes().alls.seen, program.nodes().ones.seen);
            let evens = program.nodes().evens.seen.last().expect("three lists came");
            assert!(evens.iter().all(|x| x % 2 == 0) && evens.is_sorted());
        });
    }
}

#[test]
fn parameters_reach_all_threads() {
    let mut program = ParallelLong::new();
    react(&mut program, 2);
    program.set_param("all.k", 70i64).expect("it is a parameter");
    react(&mut program, 1);
    let (ones, alls) = (&program.nodes().ones.seen[2], &program.nodes().alls.seen[2]);
    assert!(ones.iter().zip(alls).all(|(one, all)| one * 10 == *all));
}

#[test]
fn each_par_in_each_par() {
    let mut program = ParallelNested::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [vec![2, 6], vec![6]]);
}

#[test]
fn what_is_repeated_may_be_missing() {
    let mut program = Repeated::new();
    react(&mut program, 3);
    let expected = [vec![0, 0, 0], vec![100, 101, 102], vec![2, 4, 6]];
    assert_eq!(program.nodes().k.seen, expected);
    assert_eq!(program.nodes().b.seen, expected);
}
