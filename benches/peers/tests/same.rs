//! Every peer computes what the hand-written program computes.

use apex_bench::{CASES, tworegion};
use apex_peers::PEERS;

/// Enough for the slowest filter to pass twice.
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
