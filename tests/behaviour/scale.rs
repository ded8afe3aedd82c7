//! Large programs: deep chains of filters, more conditions than a machine word has bits.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{react, simulate};

graph!("scale.afg");

#[test]
fn filters_in_a_deep_chain() {
    let mut program = Deep::new();
    let log = react(&mut program, 100);
    let even: Vec<i64> = (0..100).filter(|i| i % 2 == 0).collect();
    assert_eq!(program.nodes().k.seen, even);
    assert_eq!(program.nodes().near.seen, even);
    assert_eq!(program.nodes().all.seen.len(), 100);
    for depth in 1..30 {
        assert_eq!(log.count(&format!("f{depth}")), 50, "f{depth}");
    }
}

#[test]
fn filters_that_each_drop_something() {
    let mut program = Stairs::new();
    let log = react(&mut program, 40);
    for depth in 0..30 {
        // `Throttle(n = 1)` drops nothing, `fails_at` one value each.
        assert_eq!(log.count(&format!("f{depth}")), 40 - depth, "f{depth}");
        assert_eq!(log.count(&format!("j{depth}")), 40 - depth - 1, "j{depth}");
    }
    assert_eq!(program.nodes().k.seen, (30..40).collect::<Vec<_>>());
    assert_eq!(log.failed.len(), 30);
}

#[test]
fn more_timers_than_bits_in_a_word() {
    let mut program = Timers::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(100));
    for i in 0..70 {
        // 1 ms, 2 ms, …
        assert_eq!(log.count(&format!("s{i}")), 99 / (i + 1) + 1, "s{i}");
    }
    assert_eq!(program.nodes().k69.seen, [0, 1]);
}

#[test]
fn more_connections_between_clusters_than_bits_in_a_word() {
    let mut program = Joins::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(100));
    // The slowest source, every 20 ms, determines the rate of all.
    assert_eq!(program.nodes().k.seen, (0..5).map(|i| 40 * i).collect::<Vec<_>>());
    for i in 0..40 {
        let count = log.count(&format!("s{i}"));
        assert!((5..=6).contains(&count), "s{i} fired {count} times");
    }
}
