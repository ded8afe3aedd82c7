//! `--format json`: every command answers in the form of docs/json.md.

use crate::{
    TARGET, builds,
    common::{Folder, answer, apex, package},
    tune,
};
use serde_json::{Value, json};

const NODES: &str = "\
use apex_rt::prelude::*;
/// Multiplies.
#[node]
pub fn scaled(x: &u64, #[param(default = 2, range = 0..=9)] by: u64) -> u64 { x * by }
/// Counts.
#[node]
#[derive(Default)]
pub struct Count { n: u64 }
#[node]
impl Count {
    fn process(&mut self) -> u64 { self.n += 1; println!(\"{}\", self.n); self.n }
}
#[node]
pub fn swallow(_x: &u64) {}
#[node]
pub fn tick() {}
";

const TEXT: &str = "\
robot Counter {
    node count = Count() every 10ms;
    node end   = tick() after 55ms;
    node twice = scaled();

    count -> twice -> swallow();
    end.processed -> exit;

    record \"counter.mcap\" {
        twice;
    }
}

graph Twice {
    in  x: u64;
    out y: u64;

    x -> scaled() -> y;
}

test doubles: Twice {
    feed x = 2;
    expect y == 4 within 1ms;
}

test triples: Twice {
    feed x = 2;
    expect y == 6 within 1ms;
}
";

/// Runs a command in the folder, and returns its exit code and its answer.
fn ask(folder: &Folder, arguments: &[&str]) -> (Option<i32>, Value) {
    let mut command = apex();
    command.args(arguments).args(["--format", "json"]).current_dir(&folder.0).env("CARGO_TARGET_DIR", TARGET);
    let output = command.output().unwrap();
    (output.status.code(), answer(&output, arguments[0]))
}

#[test]
fn every_command_answers_in_one_form() {
    let _guard = builds();
    let folder = Folder::new("json");
    package(&folder, NODES);
    folder.file("robot.afg", TEXT);
    folder.file("wrong.afg", "graph A {\n    node a = Nothing();\n}\n");

    let (code, checked) = ask(&folder, &["check", "robot.afg"]);
    assert_eq!((code, &checked["result"]), (Some(0), &json!({ "files": ["robot.afg"] })));
    let (code, explained) = ask(&folder, &["explain", "robot.afg"]);
    assert_eq!(code, Some(0));
    assert!(explained["result"]["programs"].as_array().unwrap().iter().any(|program| program["name"] == "Counter"));
    let (code, page) = ask(&folder, &["explain", "missing-unit"]);
    assert_eq!((code, &page["result"]["code"]), (Some(0), &json!("missing-unit")));
    let (code, list) = ask(&folder, &["explain", "--list"]);
    assert!(code == Some(0) && list["result"]["codes"].as_array().unwrap().len() > 50);

    let (code, nodes) = ask(&folder, &["nodes", "scaled"]);
    let node = &nodes["result"]["nodes"][0];
    assert_eq!((code, &node["name"], &node["docs"]), (Some(0), &json!("scaled"), &json!("Multiplies.")));
    assert_eq!((&node["ports"][0]["name"], &node["ports"][0]["type"]), (&json!("x"), &json!("u64")));
    assert_eq!((&node["params"][0]["default"], &node["params"][0]["range"]), (&json!("2"), &json!("0..=9")));

    let (code, tested) = ask(&folder, &["test", "robot.afg"]);
    let result = &tested["result"];
    assert_eq!((code, &result["passed"], &result["failed"]), (Some(1), &json!(1), &json!(1)));
    let outputs = result["tests"].as_array().unwrap().iter().map(|test| (&test["name"], &test["passed"]));
    assert!(outputs.eq([(&json!("doubles"), &json!(true)), (&json!("triples"), &json!(false))]), "{result:#}");
    assert!(result["tests"][1]["output"].as_str().unwrap().contains('6'), "{result:#}");

    // For humans, the line behind the output says where to look.
    let output = apex().args(["test", "robot.afg"]).current_dir(&folder.0).env("CARGO_TARGET_DIR", TARGET).output();
    let said = String::from_utf8(output.unwrap().stdout).unwrap();
    let hint = "to see `Twice`, without the steps of `triples`: apex studio --simulated --robot Twice robot.afg\n";
    assert!(said.contains("\nwhat happened:\n") && said.ends_with(hint), "{said}");

    let mut run = apex();
    run.args(["run", "robot.afg"]).current_dir(&folder.0).env("CARGO_TARGET_DIR", TARGET);
    assert!(run.output().unwrap().status.success());
    let replay = ["replay", "counter.mcap", "robot.afg"];
    let (code, same) = ask(&folder, &replay);
    assert_eq!((code, &same["result"]["same"], &same["result"]["whole"]), (Some(0), &json!(true), &json!(true)));
    folder.file("robot.afg", TEXT.replace("twice = scaled()", "twice = scaled(by = 3)"));
    let (code, other) = ask(&folder, &replay);
    let port = &other["result"]["ports"][0];
    assert_eq!((code, &other["result"]["same"], &port["name"]), (Some(1), &json!(false), &json!("twice.out")));
    assert_eq!((&port["first"]["recorded"], &port["first"]["replayed"]), (&json!("2"), &json!("3")));

    // Errors of the source file and of the command are parts of the answer.
    for command in [&["check"][..], &["explain"], &["test"], &["tune"], &["replay", "counter.mcap"]] {
        let (code, wrong) = ask(&folder, &[command, &["wrong.afg"]].concat());
        assert_eq!((code, &wrong["messages"][0]["code"]), (Some(1), &json!("unknown-node")), "{command:?}");
        let (code, missing) = ask(&folder, &[command, &["missing.afg"]].concat());
        assert!(code == Some(2) && missing["error"].as_str().unwrap().contains("there is no such file"));
    }
    assert_eq!(ask(&folder, &["nodes", "nowhere"]).0, Some(2));
}

#[test]
fn a_study_has_its_values() {
    let _guard = builds();
    let folder = tune::cart("json-tune");
    let arguments = ["tune", "cart.afg", "Swift", "--debug", "--candidates", "24", "--output", "study"];
    let (code, answer) = ask(&folder, &arguments);
    let result = &answer["result"];
    assert_eq!((code, &result["study"], &result["better"]), (Some(0), &json!("Swift"), &json!(true)));
    let parameter = &result["parameters"][0];
    let range = [&parameter["low"], &parameter["tuned"], &parameter["high"]].map(|value| value.as_f64().unwrap());
    assert!(range.is_sorted(), "{result:#}");
    assert!(result["goals"][0]["tuned"].as_f64() < result["goals"][0]["defaults"].as_f64(), "{result:#}");
}
