//! Follows `docs/debugging.md`: makes the robot with the mistake, sees the symptom, asks why, goes back, tries a
//! parameter, mends the text and makes a test, and compares everything with the page.

use crate::{
    TARGET, builds,
    common::{Folder, apex, lock, stderr},
    studio::{Page, Studio},
};
use serde_json::{Value, json};
use std::{fmt::Write as _, fs, path::Path, process::Command};

/// The blocks of the page, without their language.
fn blocks() -> Vec<String> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/debugging.md");
    let page = fs::read_to_string(page).unwrap();
    let fenced = page.split("\n```").skip(1).step_by(2);
    fenced.map(|block| block.split_once('\n').unwrap().1.to_owned()).collect()
}

/// The block of the page that begins with these words.
fn block(begin: &str) -> String {
    let found = blocks().into_iter().find(|block| block.starts_with(begin));
    found.unwrap_or_else(|| panic!("no block begins with `{begin}`"))
}

fn run(command: &mut Command) -> String {
    let output = command.env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true").output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// The first lines of a run of the robot, as fast as possible.
fn first_lines(folder: &Path, count: usize) -> String {
    let mut cargo = crate::cargo();
    let said = run(cargo.args(["run", "--quiet", "--", "--fast"]).current_dir(folder));
    said.lines().take(count).collect::<Vec<_>>().join("\n")
}

/// An answer of the studio, as the page shows it.
fn why(page: &mut Page, about: &Value, node: &str, at: f64) -> String {
    let nodes = about["about"]["nodes"].as_array().unwrap();
    let number = nodes.iter().position(|one| one["name"] == node).unwrap();
    page.ask(&json!({ "why": { "node": number, "at": at } }));
    let lines = page.until("why", |_| true);
    lines.as_array().unwrap().iter().fold(String::new(), |mut all, line| {
        let (depth, text) = (line["depth"].as_u64().unwrap() as usize, line["text"].as_str().unwrap());
        let _ = writeln!(all, "{}{text}", "  ".repeat(depth));
        all
    })
}

/// Number of times that a node was active between two times in s.
fn times_active(page: &mut Page, about: &Value, node: &str, from: f64, to: f64) -> usize {
    page.ask(&json!({ "lanes": { "from": from, "to": to, "columns": 1000, "also": [] } }));
    let lanes = page.until("lanes", |_| true);
    let nodes = about["about"]["nodes"].as_array().unwrap();
    let is_meant = |lane: &&Value| nodes[lane["node"].as_u64().unwrap() as usize]["name"] == node;
    lanes["lanes"].as_array().unwrap().iter().find(is_meant).unwrap()["spans"].as_array().unwrap().len()
}

fn halted_after(page: &mut Page, from: f64, to: f64) -> f64 {
    let is_there = |tick: &Value| {
        tick["run"] == "running" && tick["paused"] == true && (from..to).contains(&tick["now"].as_f64().unwrap())
    };
    page.until("tick", is_there)["now"].as_f64().unwrap()
}

#[test]
fn the_page_on_debugging_can_be_followed() {
    let _guard = builds();
    let folder = Folder::new("debugging");
    // Not `rover`, like that of the tour: cargo would take the packages for the same.
    let rover = folder.0.join("lost-rover");
    run(apex().args(["new", "lost-rover"]).current_dir(&folder.0));
    lock(&rover);
    let file = rover.join("robot.afg");
    let right = fs::read_to_string(&file).unwrap();
    let (mistake, mended) = (block("    seen     -> wide -> drive.free"), block("    seen     -> free -> drive.free"));
    let wrong = right.replace(&mended, &mistake);
    assert!(right != wrong);
    fs::write(&file, &wrong).unwrap();
    // The compiler has nothing against it, and the test fails without saying why.
    assert_eq!(run(apex().args(["check", "robot.afg"]).current_dir(&rover)), "");
    let symptom = block("$ cargo run --quiet -- --fast | head");
    let (_, symptom) = symptom.split_once('\n').unwrap();
    assert_eq!(first_lines(&rover, symptom.lines().count()), symptom);

    let studio = Studio::open_in(&rover, &["--simulated", "--speed", "8", "robot.afg"]);
    let mut page = Page::open(&studio.address);
    let about = page.until("about", |_| true);
    // The condition halts it where it begins.
    page.ask(&json!({ "break": "active(sim.mission.turn)" }));
    let now = halted_after(&mut page, 10.0, 11.0);
    assert_eq!(format!("{now:.2}"), "10.30");
    page.ask(&json!({ "break": "" }));
    page.ask(&json!({ "run": { "speed": 8 } }));
    page.until_time(12.5);
    page.ask(&json!("pause"));
    halted_after(&mut page, 12.5, 44.0);
    let count = times_active(&mut page, &about, "sim.mission.turn", 10.0, 12.0);
    assert_eq!(count, 32);
    let asked = block("`sim.mission.turn` is not active since");
    let answer = why(&mut page, &about, "sim.mission.turn", 10.52);
    assert!(answer.starts_with(&format!("{asked}\n")), "{answer}");

    // Back, another parameter, and on.
    page.ask(&json!({ "goto": 10.0 }));
    halted_after(&mut page, 9.9, 10.06);
    page.ask(&json!({ "set": { "name": "sim.mission.drive.near", "value": "0.4" } }));
    page.until_value("sim.mission.drive.near", "0.4");
    page.ask(&json!({ "run": { "speed": 8 } }));
    page.until_time(12.1);
    assert_eq!(times_active(&mut page, &about, "sim.mission.turn", 10.0, 12.0), 23);
    let differs = page.differs().unwrap();
    assert_eq!(format!("{differs:.2}"), "10.30");
    page.ask(&json!("pause"));

    // The text is mended: the robot does the same again up to here, without the mistake.
    let file_number = about["about"]["files"].as_array().unwrap().iter();
    let number = file_number.take_while(|name| !name.as_str().unwrap().ends_with("robot.afg")).count();
    page.ask(&json!({ "keep": { "file": number, "text": right, "over": false } }));
    let about = page.until("about", |_| true);
    halted_after(&mut page, 12.0, 44.0);
    assert_eq!(times_active(&mut page, &about, "sim.mission.turn", 10.0, 12.0), 1);
    the_moment_becomes_a_test(&studio, &rover, &wrong);
}

/// The mended robot begins again, and what it does at the wall is written as a test.
fn the_moment_becomes_a_test(studio: &Studio, rover: &Path, wrong: &str) {
    let mut page = Page::open(&studio.address);
    page.until("about", |_| true);
    page.ask(&json!("restart"));
    page.until("about", |_| true);
    page.until_time(12.5);
    page.ask(&json!({ "test": [10.5, 12] }));
    assert_eq!(page.until("test", |_| true)["Err"], Value::Null);
    assert_eq!(fs::read_to_string(rover.join("robot_moment.afg")).unwrap().trim_end(), block("//! A moment in a run"));
    run(apex().args(["test", "robot_moment.afg"]).current_dir(rover));
    // With the mistake it fails.
    fs::write(rover.join("robot.afg"), wrong).unwrap();
    let mut test = apex();
    test.args(["test", "robot_moment.afg"]).current_dir(rover);
    let output = test.env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true").output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &stderr(&output);
    assert!(!output.status.success() && said.contains("moment"), "{said}");
}
