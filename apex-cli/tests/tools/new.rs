use crate::{
    TARGET, builds, cargo,
    common::{Folder, apex, lock, stderr},
    moved,
    steady::steadily,
};
use std::{
    fs,
    io::{BufRead as _, BufReader},
    net::UdpSocket,
    path::Path,
    process::{Child, Command, Output, Stdio},
    time::Duration,
};

/// Runs a command in a folder, without network.
pub fn run_in(folder: &Path, command: &mut Command, arguments: &[&str]) -> (Option<i32>, String, String) {
    let command = command.args(arguments).current_dir(folder);
    command.env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true");
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    (output.status.code(), text, stderr(&output))
}

fn make(arguments: &[&str], folder: &Path) -> Output {
    apex().arg("new").args(arguments).arg(folder).output().unwrap()
}

/// Makes a project and checks what all templates have in common: no placeholder is left, source files and Rust code are
/// formatted and without errors, its source file `text` is valid, and `cargo test` passes without a warning. Returns
/// the output of `cargo test`.
fn tried(project: &Path, arguments: &[&str], text: &str) -> String {
    let made = make(arguments, project);
    assert_eq!((made.status.code(), stderr(&made)), (Some(0), String::new()));
    lock(project);
    for file in files(project) {
        let text = fs::read_to_string(&file).unwrap();
        for hole in ["{name}", "{crate}", "{checkout}", "{runtime}", "{nodes}", "{sim}"] {
            assert!(!text.contains(hole), "{}: {text}", file.display());
        }
    }
    for arguments in [&["fmt", "--check", "."][..], &["check", text]] {
        assert_eq!(run_in(project, &mut apex(), arguments), (Some(0), String::new(), String::new()));
    }
    let (code, output, errors) = run_in(project, &mut cargo(), &["test"]);
    assert!(code == Some(0) && !errors.contains("warning"), "{output}{errors}");
    let (code, _, errors) = run_in(project, &mut cargo(), &["fmt", "--check"]);
    assert_eq!(code, Some(0), "{errors}");
    output
}

fn files(folder: &Path) -> Vec<std::path::PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

#[test]
fn a_library_of_nodes_is_right_and_is_tested() {
    let _guard = builds();
    let folder = Folder::new("new-node");
    let project = folder.0.join("my-nodes");
    let tested = tried(&project, &["--template", "node"], "tests.afg");
    assert!(tested.contains("tests_afg::what_stays_above_is_reported_once ... ok"), "{tested}");
    assert!(tested.contains("what_bounces_is_held_back ... ok"), "{tested}");
    let (code, listed, errors) = run_in(&project, &mut apex(), &["nodes", "my_nodes"]);
    assert_eq!(code, Some(0), "{errors}");
    assert!(listed.starts_with("my_nodes\n  Debounce  Passes a value on when it has changed"), "{listed}");
}

#[test]
fn firmware_is_right_is_tested_and_runs_here() {
    let _guard = builds();
    let folder = Folder::new("new-firmware");
    let project = folder.0.join("my-cart");
    let tested = tried(&project, &["--template", "firmware"], "firmware.afg");
    assert!(tested.contains("firmware_afg::starts_and_stops ... ok"), "{tested}");
    let (code, output, errors) = run_in(&project, &mut cargo(), &["run", "--quiet"]);
    assert_eq!(code, Some(0), "{errors}");
    // The same as without the standard library: see `robots/firmware/tests/bare.rs`.
    assert!(output.starts_with("0 ms: 0 mm/s\n500 ms: starts\n500 ms: 0 mm/s\n1000 ms: 423 mm/s\n"), "{output}");
    // And the same where neither the project nor Apex is.
    drop(folder);
    let (folder, moved) = moved::run("my-cart", &format!("{TARGET}/debug/my-cart"), &[]);
    assert_eq!((moved.status.code(), stderr(&moved).as_str()), (Some(0), ""));
    assert_eq!(String::from_utf8(moved.stdout).unwrap(), output);
    fs::remove_dir_all(folder).unwrap();
}

/// A process that is killed at the end.
struct Started(Child);

impl Drop for Started {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts a command, with its standard output and standard error piped.
fn started(mut command: Command) -> Started {
    Started(command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap())
}

/// Position in m and speed in m/s that the drivers print: `x = 0.50 m, 0.20 m/s`.
fn moved_to(line: &str) -> (f64, f64) {
    let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    (numbers[0], numbers[1])
}

#[test]
fn a_mission_and_its_drivers_talk_over_udp() {
    let _guard = builds();
    let folder = Folder::new("new-bridge");
    let project = folder.0.join("my-bridge");
    let tested = tried(&project, &["--template", "bridge"], "robot.afg");
    assert!(tested.contains("robot_afg::stops_without_odometry ... ok"), "{tested}");
    if Command::new("python3").arg("--version").output().is_err() {
        eprintln!("skipped: there is no python3");
        return;
    }
    // Other tests may use the addresses of the template.
    let free = [0, 1].map(|_| UdpSocket::bind("127.0.0.1:0").unwrap());
    let [mission, drivers] = free.map(|socket| socket.local_addr().unwrap());
    for file in ["robot.afg", "drivers.py"] {
        let text = fs::read_to_string(project.join(file)).unwrap();
        let text = text.replace("7500", &mission.port().to_string()).replace("7501", &drivers.port().to_string());
        fs::write(project.join(file), text).unwrap();
    }
    let (code, _, errors) = run_in(&project, &mut cargo(), &["build", "--quiet"]);
    assert_eq!((code, errors.as_str()), (Some(0), ""));
    let robot = || started(Command::new(format!("{TARGET}/debug/my-bridge")));
    let mut python = Command::new("python3");
    python.arg(project.join("drivers.py"));
    let mut base = started(python);
    let mut lines = BufReader::new(base.0.stdout.take().unwrap()).lines().map(|line| moved_to(&line.unwrap()));
    // Waits for at most 20 s until the base says this.
    let until = |lines: &mut dyn Iterator<Item = (f64, f64)>, is: fn(f64, f64) -> bool| {
        lines.take(400).find(|(x, speed)| is(*x, *speed)).expect("the base moves as expected")
    };

    // There and back, within the distance of the mission.
    let mut first = robot();
    until(&mut lines, |x, speed| x > 0.2 && speed > 0.0);
    until(&mut lines, |x, speed| x > 0.9 && x < 1.3 && speed < 0.0);

    // What is not a datagram is counted and said.
    let stranger = UdpSocket::bind("127.0.0.1:0").unwrap();
    for datagram in [&b"odometry 1 2"[..], b"\xff\xfe", b""] {
        stranger.send_to(datagram, mission).unwrap();
    }
    let said = BufReader::new(first.0.stderr.take().unwrap()).lines().map(Result::unwrap);
    let counted = said.take(10).find(|line| line.contains("bad datagrams, the last one: ")).unwrap();
    assert!(["1", "2", "3"].contains(&counted.split(' ').next().unwrap()), "{counted}");

    // A mission that is killed says nothing more: the drivers stop by themselves.
    drop(first);
    let (stopped, _) = until(&mut lines, |_, speed| speed == 0.0);
    let (still, speed) = lines.nth(10).unwrap();
    assert_eq!((still, speed), (stopped, 0.0));

    // Drivers that are killed: the mission says that the base has to stop.
    let second = robot();
    until(&mut lines, |_, speed| speed > 0.0);
    drop((base, lines));
    let listener = UdpSocket::bind(drivers).unwrap();
    listener.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
    let mut bytes = [0; 100];
    let mut last = String::new();
    while last != "twist 0 0 0" {
        let length = steadily(|| listener.recv(&mut bytes)).expect("a twist of zero comes before 2 s of silence");
        last = String::from_utf8(bytes[..length].to_vec()).unwrap();
    }
    drop(second);
}

#[test]
fn what_a_template_is_stands_in_the_help() {
    let output = apex().args(["new", "--help"]).output().unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    for part in ["- robot:", "- node:", "- firmware:", "- bridge:", "a base and a laser scanner", "[default: robot]"] {
        assert!(help.contains(part), "{part}: {help}");
    }
}

/// The lines are off, and cargo reads them when they are on: with the flag of `native`, it prints what that is.
#[test]
fn a_robot_may_use_the_whole_processor() {
    let folder = Folder::new("new-native");
    let project = folder.0.join("robot");
    assert_eq!(make(&[], &project).status.code(), Some(0));
    let file = project.join(".cargo/config.toml");
    let off = fs::read_to_string(&file).unwrap();
    assert!(off.lines().all(|line| line.starts_with('#')), "{off}");
    let settings: Vec<&str> = off.lines().skip_while(|line| *line != "# [build]").collect();
    let on: String = settings.iter().map(|line| format!("{}\n", &line[2..])).collect();
    fs::write(&file, &on).unwrap();
    // What cargo prints with its settings is on trial in its stable versions, too.
    let cfg = ["-Zunstable-options", "rustc", "--print", "cfg"];
    let (code, native, errors) = run_in(&project, cargo().env("RUSTC_BOOTSTRAP", "1"), &cfg);
    assert_eq!((code, errors.as_str()), (Some(0), ""));
    let mut direct = Command::new("rustc");
    direct.env("RUSTC_BOOTSTRAP", "1").args(["--print", "cfg", "-Ctarget-cpu=native"]);
    let features = |text: &str| text.lines().filter(|line| line.starts_with("target_feature")).count();
    let direct = String::from_utf8(direct.output().unwrap().stdout).unwrap();
    assert_eq!(features(&native), features(&direct), "{on}");
}

#[test]
fn what_is_there_is_not_overwritten() {
    let folder = Folder::new("new-there");
    let file = folder.file("robot", "mine");
    let output = make(&[], &file);
    assert_eq!((output.status.code(), fs::read_to_string(&file).unwrap().as_str()), (Some(2), "mine"));
    assert!(stderr(&output).starts_with("error: cannot create a project in `"), "{}", stderr(&output));

    fs::create_dir(folder.0.join("full")).unwrap();
    folder.file("full/notes.txt", "mine");
    let output = make(&[], &folder.0.join("full"));
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert!(stderr(&output).ends_with("is not empty: choose another name\n"), "{}", stderr(&output));
    assert_eq!(fs::read_dir(folder.0.join("full")).unwrap().count(), 1);

    fs::create_dir(folder.0.join("empty")).unwrap();
    assert_eq!(make(&[], &folder.0.join("empty")).status.code(), Some(0));
}

#[test]
fn names_that_no_package_can_have_are_refused() {
    let folder = Folder::new("new-names");
    for (name, message) in [
        ("My Robot", "only the letters `a` to `z`, digits, `-` and `_` are allowed; try `my-robot`"),
        ("7of9", "it must begin with a letter; try `of9`"),
        ("match", "it is reserved by Rust or cargo; try `match-robot`"),
        ("con", "Windows does not allow files of this name; try `con-robot`"),
        ("heapless", "it is the name of a crate that Apex needs; try `heapless-robot`"),
        ("apex-rt", "names that begin with `apex` are reserved for Apex itself; try `my-apex-rt`"),
    ] {
        let output = make(&[], &folder.0.join(name));
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        assert_eq!(stderr(&output), format!("error: `{name}` cannot be the name of a package: {message}\n"));
    }
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0);
}

#[test]
fn the_crates_come_from_the_checkout_that_is_named() {
    let folder = Folder::new("new-path");
    let checkout = folder.0.join("the \"checkout\"");
    for name in ["apex-rt", "nodes", "robots/sim"] {
        fs::create_dir_all(checkout.join(name)).unwrap();
        fs::write(checkout.join(name).join("Cargo.toml"), "").unwrap();
    }
    let output = make(&["--path", checkout.to_str().unwrap()], &folder.0.join("robot"));
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let manifest = fs::read_to_string(folder.0.join("robot/Cargo.toml")).unwrap();
    assert!(manifest.contains(r#"the \"checkout\"/apex-rt" }"#), "{manifest}");
    assert!(manifest.contains(r#"the \"checkout\"/robots/sim" }"#), "{manifest}");

    let output = make(&["--path", folder.0.to_str().unwrap()], &folder.0.join("other"));
    assert_eq!((output.status.code(), folder.0.join("other").exists()), (Some(2), false));
    assert!(stderr(&output).contains("is not a checkout of Apex"), "{}", stderr(&output));
}
