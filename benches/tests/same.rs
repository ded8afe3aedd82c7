//! Both sides of every graph compute the same, and the compiled one allocates nothing once it is warm.

use apex_bench::{CASES, allocations, graphs, hand};

/// Enough for the slowest filter to pass twice.
const TICKS: u64 = 201;

#[test]
fn checksums_are_equal() {
    for case in &CASES {
        let ticks = if case.name == "image" { 9 } else { TICKS };
        assert_eq!((case.apex)(ticks), (case.hand)(ticks), "{}", case.name);
    }
}

/// The same that programs in other languages and frameworks compute.
#[test]
fn mixed1000_computes_what_everybody_computes() {
    const CHECKSUM: u64 = 16_515_020_817_037_896_410;
    for run in [graphs::mixed1000, hand::mixed1000, hand::mixed1000_clock] {
        assert_eq!(run(100_000), CHECKSUM);
    }
}

#[test]
fn checksums_depend_on_every_tick() {
    for case in CASES.iter().filter(|case| !case.name.starts_with("silent") && case.name != "image") {
        let period = if case.name == "bot100" { 100 } else { 10 };
        assert_ne!((case.apex)(period), (case.apex)(2 * period), "{}", case.name);
    }
}

#[test]
fn ticks_allocate_nothing_when_warm() {
    for case in &CASES {
        // The frames of the camera are all seen, and all storage is as large as it gets.
        let warm = if case.name == "image" { 16 } else { TICKS };
        // What all runs share (the frames) is made by whichever is the first.
        (case.apex)(1);
        assert_eq!(allocations(case.apex, warm), allocations(case.apex, warm + 8), "{}", case.name);
    }
}
