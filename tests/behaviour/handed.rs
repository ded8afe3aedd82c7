//! Nodes and tokens that come from Rust.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{nodes::Held, react};

/// A type without a default.
struct File;

/// Sends its initial values. It has no default, so graphs cannot make it.
#[node]
pub struct Tape {
    left: Vec<i64>,
    #[expect(dead_code)]
    file: File,
    #[param(default = 1)]
    gain: i64,
}

#[node]
impl Tape {
    fn process(&mut self) -> Option<i64> {
        self.left.pop().map(|v| v * self.gain)
    }
}

graph! {
    graph Replay {
        node tape: Tape;
        node paced: Tape every 10ms;
        node kept: Held<i64>;
        node k = Snk();
        node kp = Snk();
        tape -> [kept, k];
        paced -> kp;
    }

    graph Inner {
        out y: i64;
        node tape: Tape;
        tape -> y;
    }

    graph Outer {
        node a = Inner();
        node k = Snk();
        a -> k;
    }
}

fn tape(values: &[i64], gain: i64) -> Tape {
    Tape { left: values.iter().rev().copied().collect(), file: File, gain }
}

#[test]
fn nodes_are_handed_in() {
    let (left, paced) = (tape(&[1, 2, 3], 10), tape(&[4, 5], 1));
    let mut program = Replay::new(ReplayParts { tape: left, paced, kept: Held { seen: vec![-1] } });
    let log = react(&mut program, 3);
    assert_eq!(program.nodes().kept.seen, [-1, 10, 20, 30]);
    assert_eq!(program.nodes().k.seen, [10, 20, 30]);
    assert_eq!((program.nodes().kp.seen.as_slice(), log.count("paced")), (&[4][..], 1));
}

#[test]
fn nodes_of_nested_graphs_are_handed_in() {
    let mut program = Outer::new(OuterParts { a_tape: tape(&[1, 2], 3) });
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [3, 6]);
}
