//! Structs of Rust as values.

use apex_macros::graph;
use apex_nodes::scan::{Point2, Pose2};
use apex_rt::prelude::*;
use apex_tests::react;
use std::time::Duration;

graph!("structs.afg");

pub const FAR: f32 = 9.5;

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Goal {
    pub pose: Pose2,
    pub name: &'static str,
    pub(crate) tries: u8,
    pub wait: Duration,
    pub is_open: bool,
    pub corners: [Point2; 2],
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stamped<T> {
    pub value: T,
    pub stamp: u64,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Way {}

#[node]
pub fn begin(#[param] pose: Pose2) -> Pose2 {
    pose
}

#[node]
pub fn named(goal: &Goal) -> String {
    format!("{} {}", goal.name, goal.tries)
}

#[test]
fn structs_are_arguments_defaults_and_initial_tokens() {
    let mut program = Places::new();
    let turned = Pose2 { x: 1.0, y: -0.2, theta: std::f32::consts::FRAC_PI_2 };
    react(&mut program, 1);
    let outputs = program.outputs();
    assert_eq!(outputs.first, Some(turned));
    assert_eq!(outputs.late, Some(Pose2::default()));
    assert_eq!(outputs.word.as_deref(), Some("dock 3"));
    let way = outputs.way.clone().unwrap();
    assert_eq!(way.pose, Pose2 { x: FAR, y: 2.0, ..turned });
    assert_eq!((way.wait, way.is_open), (Duration::from_millis(1500), true));
    assert_eq!(way.corners, [Point2 { x: 1.0, y: 1.0 }, Point2 { x: 2.0, y: 2.0 }]);
    react(&mut program, 1);
    assert_eq!(program.outputs().late.map(|pose| pose.x), Some(3.0));
}
