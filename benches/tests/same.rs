//! Both programs of every graph have equal checksums, and the compiled one allocates nothing after warm-up.

use apex_bench::{CASES, allocations, graphs, hand};

/// Number of ticks in which the slowest filter passes a value twice.
const TICKS: u64 = 201;

#[test]
fn checksums_are_equal() {
    for case in &CASES {
        let ticks = if case.name == "image" { 9 } else { TICKS };
        assert_eq!((case.apex)(ticks), (case.hand)(ticks), "{}", case.name);
    }
}

/// The checksum of programs in other languages and frameworks.
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
        // After warm-up, all frames of the camera have been used, and all storage has its final size.
        let warm = if case.name == "image" { 16 } else { TICKS };
        // The first run creates the data that all runs share (the frames).
        (case.apex)(1);
        assert_eq!(allocations(case.apex, warm), allocations(case.apex, warm + 8), "{}", case.name);
    }
}
