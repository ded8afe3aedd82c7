//! The program's commands, and what they say to wrong input.

use std::{
    fs,
    path::PathBuf,
    process::{Command, Stdio},
};

/// Exit code, standard output and standard error.
fn patsy(args: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_patsy")).args(args).output().expect("the program starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn file(name: &str, content: &str) -> String {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, content).expect("a file");
    path.display().to_string()
}

/// As `patsy … | head -0` does.
#[test]
fn a_closed_pipe_is_not_an_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_patsy"))
        .args(["missions", "--minutes", "1", "--people", "0", "--out", &file("piped.svg", "")])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
}

#[test]
fn wrong_arguments_are_named() {
    for (args, part) in [
        (&["fly"][..], "`fly` is not a command; there are `obstacles`, `accuracy`"),
        (&["approach", "--seeds", "0"], "`--seeds` is a whole number from 1"),
        (&["approach", "--jobs", "many"], "not `many`"),
        (&["approach", "--log", "x"], "--help"),
        (&["times", "--jobs", "2"], "--help"),
        (&["missions", "--fault", "camera"], "`camera` is no kind of fault; there are camera-black"),
        (&["missions", "--fault", "lift-jammed", "--faults"], "leave out `--fault` or `--faults`"),
        (&["missions", "--world", "nowhere.toml"], "the world file `nowhere.toml` cannot be read"),
        (&["missions", "--world", "Cargo.toml"], "Cargo.toml:1: `package` is no value of a world; there are `load_in"),
        (&["missions", "--prices", "--faults"], "`--prices` runs without faults"),
        (&["validate"], "`validate` needs `--with`, `--labels` and `--without`"),
        (&["validate", "--folds", "1"], "from 2 to 100"),
        (&["--labels", "x"], "need `--log`"),
        (&["--log", "nowhere.csv"], "nowhere.csv"),
    ] {
        let (code, _, error) = patsy(args);
        assert_eq!(code, Some(2), "{args:?}: {error}");
        assert!(error.starts_with("error: ") && error.contains(part), "{args:?}: {error}");
    }
    let (code, help, _) = patsy(&["approach", "--help"]);
    assert!(code == Some(0) && help.contains("validate"));
}

#[test]
fn recordings_without_labels_or_scans_are_refused() {
    let scans = file("three.csv", "1,1,1.0,1.0,1.0\n2,2,1.0,1.0,1.0\n3,3,1.0,1.0,1.0\n");
    let labels = file("two.csv", "id,x,y,x,y\n1,0,0,1,1\n2,0,0,1,1\n");
    let nothing = file("nothing.csv", "");
    let run = |with: &str, labels: &str, without: &str| {
        let (code, out, error) =
            patsy(&["validate", "--with", with, "--labels", labels, "--without", without, "--folds", "2"]);
        (code, out + &error)
    };
    let (code, text) = run(&scans, &labels, &scans);
    assert!(code == Some(2) && text.contains("scan 3 of"), "{text}");
    let labels = file("three_labels.csv", "id,x,y,x,y\n1,0,0,1,1\n2,0,0,1,1\n3,0,0,1,1\n");
    let (code, text) = run(&scans, &labels, &nothing);
    assert!(code == Some(2) && text.contains("the table is empty"), "{text}");
    let (code, text) = run(&scans, "nowhere.csv", &scans);
    assert!(code == Some(2) && text.contains("nowhere.csv"), "{text}");
}
