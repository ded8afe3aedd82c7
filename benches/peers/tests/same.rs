//! Every peer computes what the hand-written program computes.

use apex_bench::CASES;
use apex_peers::PEERS;

/// Enough for the slowest filter to pass twice.
const TICKS: u64 = 201;

#[test]
fn checksums_are_equal() {
    for peer in PEERS {
        let case = CASES.iter().find(|case| case.name == peer.graph);
        let case = case.unwrap_or_else(|| panic!("there is no graph `{}`", peer.graph));
        assert_eq!((peer.run)(TICKS).checksum, (case.hand)(TICKS), "{} with {}", peer.graph, peer.name);
    }
}
