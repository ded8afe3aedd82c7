//! `apex bag`.

use crate::common::{Folder, answer, apex, stderr};
use serde_json::json;
use std::{fs, path::Path, process::Output};

/// Recording of a small program, of 11 ms.
fn small() -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/record/small.mcap")).unwrap()
}

fn bag(folder: &Folder, more: &[&str]) -> Output {
    apex().arg("bag").args(more).arg("small.mcap").current_dir(&folder.0).output().unwrap()
}

#[test]
fn topics_are_listed_with_their_numbers() {
    let folder = Folder::new("bag");
    fs::write(folder.0.join("small.mcap"), small()).unwrap();
    let output = bag(&folder, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let expected = "\
`small.mcap`: 37 messages in 0.011 s, recorded by the program `Small`

topic           type                     messages       rate  longest gap
a.out           std_msgs/msg/Float64           12  1000.0 Hz
apex/elapsed    apex_msgs/msg/Elapsed           0
apex/parameter  apex_msgs/msg/Parameter         1
apex/reaction   apex_msgs/msg/Reaction         12  1000.0 Hz
apex/taken      apex_msgs/msg/Taken             0
mean.out        std_msgs/msg/Float64           12  1000.0 Hz
";
    assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
    let answer = answer(&bag(&folder, &["--format", "json"]), "bag");
    let topic = &answer["result"]["topics"][0];
    assert_eq!(
        (&topic["name"], &topic["messages"], &topic["period_ns"]),
        (&json!("a.out"), &json!(12), &json!(1_000_000))
    );
    assert_eq!((&answer["result"]["program"], &answer["result"]["incomplete"]), (&json!("Small"), &json!(null)));
}

#[test]
fn what_is_incomplete_or_no_recording_is_said() {
    let folder = Folder::new("bag-cut");
    let (path, bytes) = (folder.0.join("small.mcap"), small());
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let output = bag(&folder, &[]);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(
        output.status.code() == Some(1) && said.ends_with("the recording is incomplete: it was cut off\n"),
        "{said}"
    );
    fs::write(&path, "time,x\n").unwrap();
    let output = bag(&folder, &[]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        stderr(&output),
        "error: cannot read `small.mcap`: it is not an MCAP file, or its beginning is damaged\n"
    );
}
