//! The program runs on a machine without its source tree.

#[path = "../../moved.rs"]
mod moved;

#[test]
fn the_program_runs_elsewhere() {
    let (folder, output) = moved::run("rover", env!("CARGO_BIN_EXE_rover"), &["--fast"]);
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{}\n{}", text(&output.stdout), text(&output.stderr));

    std::fs::remove_dir_all(folder).expect("it is ours");
}
