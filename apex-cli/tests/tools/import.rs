use crate::{
    TARGET, builds,
    common::{Folder, apex, package, stderr},
};
use std::{fs, path::Path, process::Output};

fn import(file: &Path, more: &[&str]) -> Output {
    apex().arg("import").arg(file).args(more).output().unwrap()
}

/// Output for a graph file.
fn text_of(folder: &Folder, graph: &str) -> String {
    let output = import(&folder.file("my robot.apex", graph), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// Nodes with parameters of every kind, a nested graph with all four kinds of relays, activity, threads, a note.
const ROBOT: &str = r#"#!/opt/csapex
threads:
  groups:
    - id: 2
      name: slow things
  assignments:
    - uuid: ~
      id: 1
    - uuid: csapex::Camera_0
      id: 2
    - uuid: csapex::Graph_0:|:csapex::Trees_0
      id: 2
nodes:
  - type: csapex::Camera
    uuid: csapex::Camera_0
    label: csapex::Camera_0
    pos: [227, -97]
    enabled: true
    state:
      persistent_params: []
      params:
        frame rate: {type: range, name: frame rate, double: 15, min: 1, max: 60}
        device: {type: path, name: device, value: /dev/video0}
        gain: {type: value, name: gain, int: -3}
        flip: {type: value, name: flip, bool: true}
        mode: {type: set, name: mode, txt: "fast \"one\"", int: 2}
        color: {type: color, name: color, values: [255, 0, 0]}
        labels: {type: string_list, name: labels, list: [a, b]}
        nothing: {type: string_list, name: nothing, list: []}
        ~cache/clear: {type: trigger, name: ~cache/clear}
  - type: csapex::Graph
    uuid: csapex::Graph_0
    label: Find things
    state:
      params:
        input count: {type: value, int: 1}
    subgraph:
      nodes:
        - type: csapex::Trees
          uuid: csapex::Trees_0
        - {type: csapex::Trees, uuid: csapex::Trees_1, label: second, enabled: false}
      connections:
        - {uuid: relayout_0, targets: ["csapex::Trees_0:|:in_0", "csapex::Trees_1:|:in_0"], types: [default, default]}
        - {uuid: "csapex::Trees_0:|:out_0", targets: [relayin_0, "csapex::Trees_1:|:in_1"]}
        - {uuid: relayevent_0, targets: ["csapex::Trees_0:|:slot_2"], types: [active]}
        - {uuid: "csapex::Trees_0:|:event_3", targets: [relayslot_0], types: [active]}
  - {type: csapex::Latch, uuid: csapex::Latch_0}
  - {type: csapex::CountMessages, uuid: csapex::CountMessages_0}
  - type: csapex::Note
    uuid: csapex::Note_0
    state: {params: {text: {type: value, string: "first line\nsecond line"}}}
connections:
  - uuid: csapex::Camera_0:|:out_0
    targets: [csapex::Graph_0:|:in_0, csapex::CountMessages_0:|:in_0]
    types: [default, default]
  - uuid: csapex::Camera_0:|:event_4
    targets: [csapex::Graph_0:|:slot_2, csapex::Graph_0:|:slot_0]
    types: [active, default]
  - uuid: csapex::Graph_0:|:event_3
    targets: [csapex::Camera_0:|:slot_1, csapex::Latch_0:|:slot_2]
    types: [active, default]
  - uuid: csapex::Latch_0:|:event_2
    targets: [csapex::CountMessages_0:|:slot_2]
  - uuid: csapex::Graph_0:|:out_0
    targets: [csapex::Camera_0:|:in_gain]
fulcrums: []
"#;

const TEXT: &str = r#"//! Imported from a graph of CS::APEX.
use apex_nodes::flow::Count;
use apex_nodes::flow::Latch;
use apex_nodes::flow::Signal;
// The file does not contain the types of the ports of graphs: add them here.
use crate::nodes::Message;

graph MyRobot {
    // `csapex::Camera` is not in the library; uses out_0, disable, event_4, gain.
    node camera_0         = Camera(
        frame_rate = 15.0,
        device = "/dev/video0",
        gain = -3,
        flip = true,
        mode = "fast \"one\"",
        color = [255, 0, 0],
        labels = ["a", "b"],
    ) on slow_things;
    node find_things      = FindThings();
    node latch_0          = Latch();
    node count_messages_0 = Count();
    // first line
    // second line

    camera_0.out_0      -> find_things.in_0;
    camera_0.out_0      -> count_messages_0.value;
    camera_0.event_4    => find_things.slot_0;
    camera_0.event_4    -> Signal() -> find_things.enable;
    find_things.event_0 => Signal() => camera_0.disable;
    find_things.event_0 -> latch_0.set;
    latch_0.processed   -> count_messages_0.reset;
    find_things.out_0   -> camera_0.gain;
}

graph FindThings {
    in    in_0: Message;
    out   out_0: Message;
    slot  slot_0: Message;
    event event_0: Message;

    // `csapex::Trees` is not in the library; uses in_0, out_0, slot_2, event_3.
    node trees_0 = Trees() on slow_things;
    // It was disabled.
    // `csapex::Trees` is not in the library; uses in_0, in_1.
    node second  = Trees();

    in_0            -> trees_0.in_0;
    in_0            -> second.in_0;
    trees_0.out_0   -> out_0;
    trees_0.out_0   -> second.in_1;
    slot_0          => trees_0.slot_2;
    trees_0.event_3 => event_0;
}
"#;

#[test]
fn a_graph_becomes_a_text_in_the_style() {
    let folder = Folder::new("import");
    let file = folder.file("my robot.apex", ROBOT);
    let text = folder.0.join("robot.afg");
    fs::create_dir(folder.0.join("src")).unwrap();
    let nodes = folder.0.join("src/nodes.rs");
    let output = import(&file, &["-o", text.to_str().unwrap(), "--nodes", nodes.to_str().unwrap()]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(0), 0));
    assert_eq!(stderr(&output), "note: not in the library: csapex::Camera, csapex::Trees\n");
    assert_eq!(fs::read_to_string(&text).unwrap(), TEXT);
    let checked = apex().args(["fmt", "--check"]).arg(&text).output().unwrap();
    assert_eq!((checked.status.code(), checked.stdout.len()), (Some(0), 0));

    // Existing files are not overwritten.
    let output = import(&file, &["--nodes", nodes.to_str().unwrap()]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert!(stderr(&output).ends_with("already exists: remove it first, or choose another name\n"));
    assert_eq!(text_of(&folder, ROBOT), TEXT.replace("crate::nodes::", "crate::"));
}

/// A snippet with unknown nodes only: with the skeletons, its source file has no errors, and it runs.
#[test]
fn with_the_skeletons_the_text_is_right_and_runs() {
    let folder = Folder::new("import-nodes");
    package(&folder, "pub mod nodes;\n");
    let snippet = r"name: Two trees
description: a snippet
tags: []
yaml:
  nodes:
    - {type: csapex::Camera, uuid: camera, label: camera, state: {params: {
        device: {type: path, value: /dev/video0}, rate: {type: value, double: 15}, labels: {list: [a, b]}}}}
    - {type: csapex::Graph, uuid: csapex::Graph_0, label: Classify, subgraph: {
        nodes: [{type: csapex::Trees, uuid: trees}],
        connections: [
          {uuid: relayout_0, targets: ['trees:|:in_0']}, {uuid: 'trees:|:out_0', targets: [relayin_0]},
          {uuid: relayevent_0, targets: ['trees:|:slot_2'], types: [active]},
          {uuid: 'trees:|:event_3', targets: [relayslot_0], types: [active]}]}}
    - {type: csapex::Screen, uuid: screen}
    - {type: csapex::Button, uuid: button}
  connections:
    - {uuid: 'camera:|:out_0', targets: ['csapex::Graph_0:|:in_0', 'screen:|:in_1']}
    - {uuid: 'csapex::Graph_0:|:out_0', targets: ['screen:|:in_0']}
    - {uuid: 'button:|:event_3', targets: ['csapex::Graph_0:|:slot_2', 'screen:|:slot_2'], types: [active, default]}
    - {uuid: 'csapex::Graph_0:|:event_3', targets: ['button:|:slot_2'], types: [active]}
";
    let file = folder.file("two.apexs", snippet);
    let (text, nodes) = (folder.0.join("two.afg"), folder.0.join("src/nodes.rs"));
    let output = import(&file, &["-o", text.to_str().unwrap(), "--nodes", nodes.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let written = fs::read_to_string(&text).unwrap();
    assert!(written.contains("graph TwoTrees {"), "{written}");
    let checked = apex().arg("check").arg(&text).output().unwrap();
    // The graph file does not contain the start of activity: there are warnings, but no errors.
    assert!(checked.status.code() == Some(0) && !stderr(&checked).contains("error"), "{}{written}", stderr(&checked));
    // The camera would send tokens forever: another node ends the run.
    let runs = written.replace("graph TwoTrees {", "graph TwoTrees {\n    once() -> exit;\n");
    fs::write(&text, runs).unwrap();
    package(&folder, "use apex_rt::prelude::*;\npub mod nodes;\n#[node]\npub fn once() -> u8 { 1 }\n");
    let _guard = builds();
    let mut command = apex();
    command.args(["run", "--robot", "TwoTrees"]).arg(&text).env("CARGO_TARGET_DIR", TARGET);
    let ran = command.output().unwrap();
    let nodes = fs::read_to_string(&nodes).unwrap();
    assert_eq!(ran.status.code(), Some(0), "{}\n{nodes}", stderr(&ran));
    assert!(!stderr(&ran).contains("unused"), "{}", stderr(&ran));
}

#[test]
fn wrong_files_are_refused_with_the_line() {
    let folder = Folder::new("import-wrong");
    let node = "nodes:\n  - {type: A, uuid: a}\n  - {type: B, uuid: b}\nconnections:\n";
    let connection = |line: &str| format!("{node}  - {line}\n");
    let deep = |n: usize| "{nodes: [{type: G, uuid: g, subgraph: ".repeat(n) + "{nodes: []}" + &"}]}".repeat(n);
    for (graph, message) in [
        ("nodes: [\n".to_owned(), "2: this is not YAML: "),
        (String::new(), "1: the file is empty"),
        ("just words\n".to_owned(), "1: a graph must be a map with the key `nodes`"),
        ("connections: []\n".to_owned(), "1: a graph has no `nodes`"),
        ("nodes:\n  - type: A\n".to_owned(), "2: a node has no `uuid`"),
        ("nodes:\n  - uuid: a\n".to_owned(), "2: a node has no `type`"),
        ("nodes: 5\n".to_owned(), "1: `nodes` must be a list"),
        ("nodes: []\nnodes: []\n".to_owned(), "2: the key `nodes` occurs twice"),
        ("nodes: []\n---\nnodes: []\n".to_owned(), "4: a second document begins here"),
        (
            "nodes:\n  - {type: A, uuid: a}\n  - {type: B, uuid: a}\n".to_owned(),
            "3: the node `a` occurs twice, first in line 2",
        ),
        (
            "nodes:\n  - {type: A, uuid: a, state: {params: {x: {int: many}}}}\n".to_owned(),
            "2: this is not a whole number",
        ),
        ("nodes: &all\n  - {type: A, uuid: a, subgraph: {nodes: *all}}\n".to_owned(), "2: aliases (`*name`)"),
        (connection("{targets: []}"), "5: a connection has no `uuid`"),
        (connection("{uuid: 'a:|:out_0'}"), "5: a connection has no `targets`"),
        (
            connection("{uuid: 'c:|:out_0', targets: []}"),
            "5: unknown id `c:|:out_0`: there is no node `c` in this graph",
        ),
        (connection("{uuid: 'a:|:port', targets: []}"), "5: unknown id `a:|:port`: `port` is not a port"),
        (connection("{uuid: 'a:|:slot_x', targets: []}"), "5: unknown id `a:|:slot_x`: `slot_x` is not a port"),
        (connection("{uuid: relay_0, targets: []}"), "5: unknown id `relay_0`: it is not a port such as"),
        (connection("{uuid: 'a:|:in_0', targets: []}"), "5: `a:|:in_0` sends nothing"),
        (connection("{uuid: 'a:|:out_0', targets: ['b:|:out_0']}"), "5: `b:|:out_0` takes nothing"),
        (
            connection("{uuid: 'a:|:out_0', targets: ['b:|:in_0'], types: [x]}"),
            "5: the type `x` is neither `default` nor `active`",
        ),
        (
            connection("{uuid: 'a:|:out_0', targets: ['b:|:in_0'], types: [active, active]}"),
            "5: there are 1 `targets`, but 2 `types`",
        ),
        (deep(66), "1: graphs are nested more than 64 levels deep"),
        ("[".repeat(100_000), "1: "),
        ("- ".repeat(100_000), "1: "),
    ] {
        let file = folder.file("wrong.apex", &graph);
        let text = folder.0.join("wrong.afg");
        let output = import(&file, &["-o", text.to_str().unwrap()]);
        let (said, start) = (stderr(&output), format!("error: {}:{message}", file.display()));
        assert!(said.starts_with(&start), "{said}\ninstead of\n{start}");
        assert_eq!((output.status.code(), output.stdout.len(), text.exists()), (Some(1), 0, false));
    }
}

#[test]
fn what_cannot_be_read_is_two() {
    let folder = Folder::new("import-unreadable");
    let large = folder.0.join("large.apex");
    fs::File::create(&large).unwrap().set_len((16 << 20) + 1).unwrap();
    for (file, reason) in [
        (folder.0.join("missing.apex"), "missing.apex`: there is no such file"),
        (large, "at most 16777216 are read"),
        (folder.file("latin1.apex", b"nodes: \xfc"), "byte 7 is not UTF-8"),
    ] {
        let output = import(&file, &[]);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
}

#[test]
fn a_text_and_its_nodes_are_two_files() {
    let folder = Folder::new("import-one-file");
    let one = folder.0.join("one.rs").display().to_string();
    let output = import(&folder.file("a.apex", "nodes: []\n"), &["-o", &one, "--nodes", &one]);
    assert_eq!((output.status.code(), Path::new(&one).exists()), (Some(2), false));
    assert!(stderr(&output).contains("need separate files"), "{}", stderr(&output));
}
