//! A graph file of CS::APEX that runs, with its nodes written in Rust and a test in the language.

use crate::{
    TARGET, builds,
    common::{Folder, apex, package, stderr},
    import_files::{FILES, text_of},
};
use std::{fs, path::Path};

/// Nodes of `follow_person`, written by hand. Tokens are numbers: a goal, a path and a distance.
const NODES: &str = r#"//! Nodes of a robot that follows a person.
use apex_rt::prelude::*;

/// Plans a path to a goal.
#[node]
pub struct PlanPath {
    #[param(default = String::new())]
    algorithm: String,
    #[param(default = 1.0)]
    max_search_duration: f64,
    #[param(default = true)]
    grow_obstacles: bool,
    #[param(default = String::new())]
    planner_topic: String,
    #[param(default = 0.5)]
    grow_obstacles_radius: f64,
}

#[node]
impl PlanPath {
    fn process(&mut self, in_0: &f64, out_0: &mut Out<f64>) {
        out_0.set(*in_0);
    }
}

/// Drives along a path.
#[node]
pub struct FollowPath {
    #[param(default = 0.5)]
    target_velocity: f64,
    #[param(default = String::new())]
    init_mode: String,
    #[param(default = String::new())]
    follower_topic: String,
}

#[node]
impl FollowPath {
    fn process(&mut self, in_0: &f64) {
        let _ = in_0;
    }
}

/// Passes a token on after a delay.
#[node]
pub struct Delay {
    #[param(default = 0.8)]
    delay: f64,
    #[param(default = false)]
    blocking: bool,
}

#[node]
impl Delay {
    #[slot]
    fn begin(&mut self) {}
}

/// Distance of a person.
#[node]
pub struct ExtractMeasures {
    #[param(default = 0.0)]
    dx: f64,
    #[param(default = 0.0)]
    dy: f64,
    #[param(default = 0.0)]
    dz: f64,
    #[param(default = 0.0)]
    norm: f64,
    #[param(default = 0.0)]
    roll: f64,
    #[param(default = 0.0)]
    pitch: f64,
    #[param(default = 0.0)]
    yaw: f64,
    #[param(default = true)]
    yaw_cap: bool,
}

#[node]
impl ExtractMeasures {
    fn process(&mut self, in_0: &f64, out_norm: &mut Out<f64>) {
        out_norm.set(in_0.abs());
    }
}

/// Sends a token to one of two outputs.
#[node]
pub struct Switch {
    #[param(default = true)]
    predicate: bool,
}

#[node]
impl Switch {
    fn process(&mut self, in_0: &f64, out_0: &mut Out<f64>, out_1: &mut Out<f64>) {
        if self.predicate { out_0.set(*in_0) } else { out_1.set(*in_0) }
    }
}

/// Compares a value with a threshold.
#[node]
pub struct Threshold {
    #[param(default = 0.0)]
    threshold: f64,
    #[param(default = [0.0, 100.0])]
    interval: [f64; 2],
}

#[node]
impl Threshold {
    fn process(&mut self, in_0: &f64, out_0: &mut Out<bool>) {
        let (low, high) = (self.interval[0], self.interval[1]);
        out_0.set(*in_0 > self.threshold && (low..=high).contains(in_0));
    }
}
"#;

/// A distant person is followed, a near one is not.
const TESTS: &str = "
test follows_from_afar: FollowForward {
    feed in_1 = 13.5;
    wait 10ms;
    feed in_0 = 2.5;
    expect out_0 == 2.5 within 10ms;
    feed in_1 = 1.5;
    wait 10ms;
    never out_0;
    feed in_0 = 3.5;
    expect event_1 == 3.5 within 10ms;
}
";

/// Runs a graph file with the nodes above as a test.
fn follows(folder: &Folder, file: &Path) {
    package(folder, NODES);
    let nodes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../nodes");
    let manifest = fs::read_to_string(folder.0.join("Cargo.toml")).unwrap();
    folder.file("Cargo.toml", format!("{manifest}apex-nodes = {{ path = {nodes:?} }}\n"));
    let text = text_of(file);
    // Types of ports, which the graph file does not contain.
    let typed =
        text.replace("use crate::Message;\n", "").replace("event_0: Message", "event_0").replace(": Message", ": f64");
    // The graph file does not contain the source of the tokens of the outer graph, which is left out.
    let (head, rest) = typed.split_once("graph FollowPerson {").unwrap();
    let (_, follow) = rest.split_once("}\n").unwrap();
    let text = folder.file("follow.afg", format!("{head}{follow}{TESTS}"));
    let _guard = builds();
    let mut command = apex();
    let output = command.args(["test", "--quiet"]).arg(&text).env("CARGO_TARGET_DIR", TARGET).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}{}", stderr(&output));
    assert!(said.contains("1 passed"), "{said}");
}

#[test]
fn follow_person_runs() {
    let file = Path::new(FILES).join("schoenbuch_snippets_follow_person.apexs");
    if !file.exists() {
        eprintln!("skipped: there is no `{}`", file.display());
        return;
    }
    follows(&Folder::new("import-follow"), &file);
}

/// A smaller graph of the same kind, with an interval.
const PERSON: &str = "
name: Follow Person
yaml:
  nodes:
    - type: csapex::Graph
      uuid: csapex::Graph_3
      label: Follow Forward
      state: {params: {input count: {type: value, int: 2}, event names: {type: string_list, list: [error, near]}}}
      subgraph:
        nodes:
          - {type: csapex::PlanPath, uuid: plan, state: {params: {algorithm: {type: value, string: forward}}}}
          - {type: csapex::ExtractMeasures, uuid: measures, state: {params: {yaw: {type: angle, value: 0.15}}}}
          - {type: csapex::Switch, uuid: switch, state: {params: {predicate: {type: value, bool: true}}}}
          - type: csapex::Threshold
            uuid: threshold
            state:
              params:
                threshold: {type: value, double: 3.5}
                interval: {type: interval, double: [0, 50], min: 0, max: 50}
        connections:
          - {uuid: relayout_0, targets: ['switch:|:in_0'], types: [active]}
          - {uuid: relayout_1, targets: ['measures:|:in_0'], types: [default]}
          - {uuid: 'measures:|:out_norm', targets: ['threshold:|:in_0'], types: [default]}
          - {uuid: 'threshold:|:out_0', targets: ['switch:|:in_predicate'], types: [default]}
          - {uuid: 'switch:|:out_0', targets: ['plan:|:in_0'], types: [active]}
          - {uuid: 'switch:|:out_1', targets: [relayslot_1], types: [active]}
          - {uuid: 'plan:|:out_0', targets: [relayin_0], types: [active]}
          - {uuid: 'plan:|:event_1', targets: [relayslot_0], types: [active]}
  connections: []
";

#[test]
fn a_graph_that_follows_a_person_runs() {
    let folder = Folder::new("import-person");
    let file = folder.file("person.apexs", PERSON);
    follows(&folder, &file);
}
