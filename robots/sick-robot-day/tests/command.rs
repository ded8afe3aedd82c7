//! Tests of the command: rejected arguments, written files, and exit codes.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

/// An empty folder for the test.
fn folder(name: &str) -> PathBuf {
    let folder = env::temp_dir().join(format!("apex-sick-robot-day-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder for temporary files");
    folder
}

/// Exit code, output and messages of the command, run in a folder.
fn run(folder: &Path, args: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_sick-robot-day")).args(args).current_dir(folder).output();
    let output = output.expect("the command");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn help_tells_about_everything() {
    let (code, text, messages) = run(Path::new("."), &["--help"]);
    assert_eq!((code, messages.as_str()), (Some(0), ""));
    for word in ["compete", "bench", "perception", "--seed", "--fault", "--record", "--faults", "--times", "Exit codes"]
    {
        assert!(text.contains(word), "{word}");
    }
    for kind in sick_robot_day::world::contest::FaultKind::ALL {
        assert!(text.contains(kind.name()), "{}", kind.name());
    }
    assert_eq!(run(Path::new("."), &["bench", "-h"]), (code, text, messages));
}

#[test]
fn what_cannot_be_meant_is_refused() {
    let cases: [(&[&str], &str); 14] = [
        (&["dance"], "`dance` is not a command; there are `compete`, `bench`, `perception`, and `--help`"),
        (&["--sed", "1"], "invalid option '--sed'; `--help` lists the options"),
        (&["bench", "--seed", "1"], "invalid option '--seed'; `--help` lists the options"),
        (&["--seed", "-1"], "`--seed` is a whole number from 0, not `-1`"),
        (&["bench", "--seeds", "0"], "`--seeds` is a whole number from 1, not `0`"),
        (&["bench", "--jobs", "0"], "`--jobs` is a whole number from 1 to 1024, not `0`"),
        (&["bench", "--first-seed", "18446744073709551615"], "the last seed is too large"),
        (&["bench", "--times", "--jobs", "2"], "`--times` measures one competition at a time: without `--jobs`"),
        (&["--minutes", "nan"], "`--minutes` is a number above 0, at most 1440, not `nan`"),
        (&["--mission", "bt"], "`--mission` is `afg` or `sdf`, not `bt`"),
        (&["--fault", "laser@1s..2s"], "`laser` is no kind of fault; there are laser-frozen, "),
        (&["--record-images"], "`--record-images` needs `--record`, which says where"),
        (&["bench", "--faults", "--times"], "`--faults`, `--outages` and `--times` are measured one at a time"),
        (&["compete", "--seed"], "missing argument for option '--seed'"),
    ];
    for (args, expected) in cases {
        let (code, text, message) = run(Path::new("."), args);
        assert_eq!((code, text.as_str()), (Some(2), ""), "{args:?}");
        assert!(message.starts_with(&format!("error: {expected}")), "{args:?}: {message}");
    }
}

#[test]
fn a_run_leaves_a_table_and_pictures_and_overwrites_nothing() {
    let folder = folder("compete");
    let short = ["--minutes", "0.02", "--record", "run.mcap"];
    let first = run(&folder, &short);
    let second = run(&folder, &[&short[..], &["--mission", "sdf"]].concat());
    let named = run(&folder, &["--minutes", "0.02", "--out", "out/sick-robot-day"]);
    let exists = |name: &str| folder.join(name).is_file();
    let left =
        ["out/sick-robot-day/map.png", "out/sick-robot-day-2/activity.png", "run.mcap", "run-2.mcap"].map(exists);
    fs::remove_dir_all(&folder).expect("it is ours");

    assert_eq!((first.0, first.2.as_str()), (Some(0), ""), "{}", first.1);
    for part in ["points", "wait", "seed 1; pictures: out/sick-robot-day/*.png", "recorded to run.mcap"] {
        assert!(first.1.contains(part), "no `{part}` in\n{}", first.1);
    }
    assert_eq!(second.0, Some(0), "{}", second.2);
    assert!(second.1.contains("pictures: out/sick-robot-day-2/*.png\nrecorded to run-2.mcap"), "{}", second.1);
    assert_eq!((named.0, named.1.as_str()), (Some(2), ""));
    assert!(named.2.contains("out/sick-robot-day is not empty; name a new or an empty folder"), "{}", named.2);
    assert_eq!(left, [true; 4]);
}

#[test]
fn a_bench_has_a_line_for_each_seed() {
    let (code, text, message) = run(Path::new("."), &["bench", "--seeds", "2", "--minutes", "0.02"]);
    assert_eq!((code, message.as_str()), (Some(0), ""), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    assert!(
        lines[0].contains("points") && lines[1].starts_with("     1 ") && lines[2].starts_with("     2 "),
        "{text}"
    );
    assert!(text.contains("0 (median), 0 to 0"), "{text}");
    let options = ["bench", "--first-seed", "7", "--seeds", "2", "--jobs", "1", "--minutes", "0.02"];
    let (_, text, _) = run(Path::new("."), &options);
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[1].starts_with("     7 ") && lines[2].starts_with("     8 "), "{text}");
    let (code, text, _) = run(Path::new("."), &["bench", "--seeds", "1", "--minutes", "0.02", "--times"]);
    assert_eq!(code, Some(0));
    for part in ["surroundings / localize ", "see / find_sign", "last minute"] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
}

/// As a person does who has seen enough.
#[test]
#[cfg(unix)]
fn an_interrupted_run_completes_its_recording() {
    use std::{process::Stdio, thread, time::Duration};
    let folder = folder("interrupted");
    let recording = folder.join("run.mcap");
    let mut child = Command::new(env!("CARGO_BIN_EXE_sick-robot-day"))
        .args(["--minutes", "60", "--out", "pictures", "--record", "run.mcap"])
        .current_dir(&folder)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command");
    while !recording.metadata().is_ok_and(|file| file.len() > 100_000) {
        assert!(child.try_wait().expect("it can be asked").is_none(), "it ended by itself");
        thread::sleep(Duration::from_millis(20));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("`kill`");
    assert!(sent.success());
    let output = child.wait_with_output().expect("an end");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && said.contains("stopped by a signal after"), "{said}");
    // The magic at the end of a complete file.
    assert!(fs::read(&recording).expect("the recording").ends_with(b"\x89MCAP0\r\n"));
    fs::remove_dir_all(folder).expect("it is still there");
}
