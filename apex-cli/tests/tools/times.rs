use crate::common::{Folder, answer, apex, package, stderr};
use std::{path::Path, process::Output};

const NODES: &str = r"//! Nodes.
use apex_rt::prelude::*;

/// Sends one.
#[node]
pub fn one() -> u32 {
    1
}

/// Takes tokens.
#[node]
#[derive(Default)]
pub struct Ear;

#[node]
impl Ear {
    #[slot]
    fn hear(&mut self, _value: &u32) {}
}
";

const TEXT: &str = "\
use crate::{Ear, one};

robot Talk {
    node a   = one() every 1ms;
    node ear = Ear() on other;
    a -> ear.hear;
}
";

const PROFILE: &str = r#"[{"ph":"M","pid":1,"name":"process_name","args":{"name":"Talk"}},
{"ph":"X","pid":1,"tid":1,"name":"a","ts":0.000,"dur":100.000},
{"ph":"X","pid":1,"tid":2,"name":"ear","ts":500.000,"dur":20.000},
{"ph":"X","pid":1,"tid":1,"name":"a","ts":600.000,"dur":400.000}]
"#;

fn explain(profile: &Path, text: &Path, format: &str) -> Output {
    apex().args(["explain", "--format", format, "--profile"]).arg(profile).arg(text).output().unwrap()
}

#[test]
fn worst_times_and_busy_threads_come_from_the_profile() {
    let folder = Folder::new("times");
    package(&folder, NODES);
    let (text, profile) = (folder.file("talk.afg", TEXT), folder.file("talk.json", PROFILE));
    let output = explain(&profile, &text, "text");
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    for line in [
        "Talk: 1.0 ms measured",
        "thread main: 50.0 % of the time at work",
        "cluster 0: at worst 400.0 µs (a)",
        "thread other: 2.0 % of the time at work",
        "slots of ear: at worst 20.0 µs a call",
    ] {
        assert!(said.lines().any(|l| l.trim() == line), "{line}: {said}");
    }
    let json = answer(&explain(&profile, &text, "json"), "explain");
    assert_eq!(json["result"]["threads"][0]["clusters"][0]["worst_us"], 400.0);
}

#[test]
fn what_is_no_profile_of_the_text_is_refused() {
    let folder = Folder::new("times-wrong");
    package(&folder, NODES);
    let text = folder.file("talk.afg", TEXT);
    let other = folder.file("other.json", PROFILE.replace("Talk", "Other"));
    for (profile, message) in [
        (other.as_path(), "the profile is of `Other`"),
        (text.as_path(), "it was not written by `apex run --profile`"),
        (Path::new("/dev/null"), "it is not a file"),
        (Path::new("nowhere.json"), "cannot read `nowhere.json`"),
    ] {
        let output = explain(profile, &text, "text");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{message}");
        assert!(stderr(&output).contains(message), "{message}: {}", stderr(&output));
    }
}
