//! Every peer computes the same result as the hand-written program.

use apex_bench::{CASES, tworegion};
use apex_peers::PEERS;

/// Number of ticks in which the slowest filter passes a value twice.
const TICKS: u64 = 201;

#[test]
fn checksums_are_equal() {
    for peer in PEERS {
        let hand = match CASES.iter().find(|case| case.name == peer.graph) {
            Some(case) => case.hand,
            None if peer.graph == "tworegion" => tworegion::hand,
            None => panic!("there is no graph `{}`", peer.graph),
        };
        assert_eq!((peer.run)(TICKS).checksum, hand(TICKS), "{} with {}", peer.graph, peer.name);
    }
}
