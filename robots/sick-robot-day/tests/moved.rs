//! The program runs on a machine without its source tree.

#[path = "../../moved.rs"]
mod moved;

#[test]
fn the_program_runs_elsewhere() {
    let (folder, output) = moved::run("sick-robot-day", env!("CARGO_BIN_EXE_sick-robot-day"), &["--minutes", "0.1"]);
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{}\n{}", text(&output.stdout), text(&output.stderr));
    assert!(folder.join("out/sick-robot-day").is_dir(), "the pictures");
    std::fs::remove_dir_all(folder).expect("it is ours");
}
