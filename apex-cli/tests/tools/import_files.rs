//! Real graph files of CS::APEX are imported without errors, and large ones in a reasonable time.

use crate::common::{Folder, apex, stderr};
use std::{fs, path::Path, process::Output};

/// Real graph files; they are not part of the project.
pub const FILES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/csapex_graphs");

fn import(file: &Path) -> Output {
    apex().arg("import").arg(file).output().unwrap()
}

/// Source file for a graph file.
pub fn text_of(file: &Path) -> String {
    let output = import(file);
    assert_eq!(output.status.code(), Some(0), "{}: {}", file.display(), stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn all_real_graph_files_come_through() {
    let Ok(files) = fs::read_dir(FILES) else {
        eprintln!("skipped: there are no graph files in `{FILES}`");
        return;
    };
    let folder = Folder::new("import-real");
    let mut count = 0;
    for file in files {
        let file = file.unwrap().path();
        let text = folder.file("real.afg", text_of(&file));
        let checked = apex().args(["fmt", "--check"]).arg(&text).output().unwrap();
        assert_eq!((checked.status.code(), checked.stdout.len()), (Some(0), 0), "{}", file.display());
        count += 1;
    }
    assert!(count > 0, "the folder is empty");
}

/// Parameters of all shapes, and ports of CS::APEX itself.
const SHAPES: &str = "
nodes:
  - type: csapex::Filter
    uuid: csapex::Filter_0
    state:
      params:
        field: {type: interval, name: field, int: [160, 1024], min: 0, max: 1024}
        span: {type: interval, name: span, double: [-10, 10.5], min: -10, max: 10}
        switches: {type: value, bool: [true, false]}
        roll: {type: angle, value: 1.5, min: -3, max: 3}
        color: {type: color, values: [255, 0, 7]}
        names: {type: string_list, list: [a, 'b c']}
        none: {type: string_list, list: []}
        endless: {type: range, double: .inf}
        ends: {type: interval, double: [-.inf, 1]}
        made up: {type: dictionary, value: {a: 1}}
        listed: {type: dictionary, list: [{a: 1}]}
        progress: {type: progress}
  - {type: csapex::Count, uuid: count}
connections:
  - {uuid: event_activation, targets: ['csapex::Filter_0:|:slot_2', 'count:|:slot_1'], types: [default, active]}
  - {uuid: event_deactivation, targets: ['csapex::Filter_0:|:slot_3']}
  - {uuid: event_ros_clock_reset, targets: ['csapex::Filter_0:|:slot_2', slot_exit]}
  - {uuid: 'csapex::Filter_0:|:out_0', targets: [slot_exit, slot_save]}
  - {uuid: 'csapex::Filter_0:|:event_3', targets: [slot_abort], types: [active]}
";

const SHAPES_TEXT: &str = "    // `csapex::Filter` is not in the library; uses out_0, slot_2, slot_3, event_3.
    node filter_0 = Filter(
        field = [160, 1024],
        span = [-10.0, 10.5],
        switches = [true, false],
        roll = 1.5,
        color = [255, 0, 7],
        names = [\"a\", \"b c\"],
    );
    // `csapex::Count` is not in the library; uses disable.
    node count    = Count();

    start            -> filter_0.slot_2;
    start            => count.disable;
    // `event_deactivation` of CS::APEX itself has no counterpart here: event_deactivation -> filter_0.slot_3;
    // `event_ros_clock_reset` of CS::APEX itself has no counterpart here: event_ros_clock_reset -> filter_0.slot_2;
    // `event_ros_clock_reset` of CS::APEX itself has no counterpart here: event_ros_clock_reset -> exit;
    filter_0.out_0   -> Signal() -> exit;
    // `slot_save` of CS::APEX itself has no counterpart here: filter_0.out_0 -> slot_save;
    filter_0.event_3 => Signal() => abort;
}
";

#[test]
fn parameters_of_any_shape_and_ports_of_the_program() {
    let folder = Folder::new("import-shapes");
    let file = folder.file("shapes.apex", SHAPES);
    let text = text_of(&file);
    assert_eq!(text.split_once("{\n").expect("a graph").1, SHAPES_TEXT);
    let nodes = folder.0.join("nodes.rs");
    let output = apex().args(["import", "--nodes"]).arg(&nodes).arg(&file).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let nodes = fs::read_to_string(nodes).unwrap();
    for param in
        ["&[-10.0, 10.5])]\n    pub span: &'static [f64]", "&[true, false])]\n    pub switches: &'static [bool]"]
    {
        assert!(nodes.contains(param), "{param}: {nodes}");
    }
    // A port that takes tokens cannot send any, as in CS::APEX.
    for (uuid, target, message) in [
        ("slot_exit", "count:|:slot_0", "`slot_exit` sends nothing"),
        ("event_activation", "event_activation", "`event_activation` takes nothing"),
        ("event_", "count:|:slot_0", "unknown id `event_`"),
        ("\"event_a\\nb\"", "count:|:slot_0", "unknown id `event_a"),
        ("event_of_a_plugin", "event_of_a_plugin", "`event_of_a_plugin` takes nothing"),
        ("slot_of_a_plugin", "count:|:slot_0", "`slot_of_a_plugin` sends nothing"),
    ] {
        let graph = format!(
            "nodes:\n  - {{type: C, uuid: count}}\nconnections:\n  - {{uuid: {uuid}, targets: ['{target}']}}\n"
        );
        let output = import(&folder.file("wrong.apex", graph));
        assert_eq!(output.status.code(), Some(1), "{uuid}");
        assert!(stderr(&output).contains(message), "{message}: {}", stderr(&output));
    }
}

/// An algorithm with quadratic time would take minutes here instead of seconds.
#[test]
fn large_files() {
    let folder = Folder::new("import-large");
    let keys: String = (0..100_000).map(|i| format!("k{i}: 1\n")).collect();
    assert!(text_of(&folder.file("keys.apex", keys + "nodes: []\n")).contains("graph Keys {"));

    // A source file may have four megabytes.
    const MANY: usize = 30_000;
    let params: String = (0..MANY).map(|i| format!("      k{i}: {{int: {i}}},\n")).collect();
    let to_params: String = (0..MANY).map(|i| format!("- {{uuid: 'b:|:out_0', targets: ['a:|:in_k{i}']}}\n")).collect();
    let graph = format!(
        "nodes:\n  - {{type: A, uuid: a, state: {{params: {{\n{params}      }}}}}}\n  - {{type: B, uuid: b}}\nconnections:\n{to_params}"
    );
    assert!(text_of(&folder.file("params.apex", graph)).contains("b.out_0 -> a.k29999;"));

    let nodes: String = (0..MANY).map(|i| format!("- {{type: A, uuid: a{i}, label: n}}\n")).collect();
    let chain: String =
        (1..MANY).map(|i| format!("- {{uuid: 'a{}:|:out_0', targets: ['a{i}:|:in_0']}}\n", i - 1)).collect();
    let file = folder.file("nodes.apex", format!("nodes:\n{nodes}connections:\n{chain}"));
    let skeletons = folder.0.join("nodes.rs");
    let output = apex().args(["import", "--nodes"]).arg(&skeletons).arg(&file).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(String::from_utf8(output.stdout).unwrap().contains("-> n_30000.in_0;"));
}
