use apex_macros::graph;
use apex_rt::{Info, prelude::*};
use std::fmt::Display;

/// Halves even numbers.
#[node]
pub fn half(x: &i64) -> Result<i64, &'static str> {
    if x % 2 == 0 { Ok(x / 2) } else { Err("this is odd") }
}

graph! {
    use apex_nodes::flow::ActivityGate;

    graph Halves {
        in  x: i64;
        out y: i64;

        node halve = half();
        node gate  = ActivityGate();
        start => gate.activate;
        x     -> halve -> gate;
        gate  => y;
    }
}

/// Writes down what happens.
struct Diary {
    info: &'static Info,
    lines: Vec<String>,
}

impl Observer for Diary {
    fn fired(&mut self, node: usize) {
        self.lines.push(format!("{} fires", self.info.nodes[node].name));
    }
    fn activity(&mut self, node: usize, active: bool) {
        self.lines.push(format!("{} is {}", self.info.nodes[node].name, if active { "active" } else { "inactive" }));
    }
    fn failed(&mut self, node: usize, error: &impl Display) {
        self.lines.push(format!("{} failed: {error}", self.info.nodes[node].name));
    }
}

pub fn main() {
    const INFO: Info = Halves::INFO;
    let mut halves = Halves::new();
    let mut diary = Diary { info: &INFO, lines: vec![] };
    for x in [4, 5] {
        assert_eq!(halves.inputs().x.put(x), Ok(()));
        halves.react_with(Time::ZERO, &mut diary);
    }
    let first = ["gate is active", "halve fires", "gate fires", "gate is inactive"];
    let second = ["halve fires", "halve failed: this is odd"];
    assert_eq!(diary.lines, [&first[..], &second[..]].concat());

    let gate = INFO.nodes.iter().position(|node| node.name == "gate").unwrap();
    assert!(!halves.is_active(gate));
}
