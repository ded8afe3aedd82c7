//! Checkpoints of a robot in a process of its own.

use crate::{socket, stream::Viewer};
use apex_rt::studio::message::{Command, Report};
use std::{
    fs,
    path::PathBuf,
    process::{Child, Stdio},
    thread,
    time::{Duration, Instant},
};

/// A robot in a process of its own.
pub struct Own {
    process: Child,
    pub path: PathBuf,
}

impl Own {
    /// Starts the robot with a socket of this name. Each reaction takes `pause` in ms. `kind` is `thread`, `slow` or
    /// nothing.
    pub fn start(name: &str, pause: u32, kind: Option<&str>) -> Self {
        let path = socket(name);
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_apex-test-robot"));
        command.arg(&path).arg(pause.to_string()).args(kind);
        Self { process: command.stdout(Stdio::null()).spawn().expect("it starts"), path }
    }

    /// Numbers of all processes of this robot, without those that have ended.
    pub fn processes(&self) -> Vec<String> {
        let own = |process: &fs::DirEntry| {
            let line = fs::read(process.path().join("cmdline")).unwrap_or_default();
            String::from_utf8_lossy(&line).split('\0').nth(1) == self.path.to_str()
        };
        let all = fs::read_dir("/proc").expect("Linux").flatten();
        all.filter(own).map(|process| process.file_name().to_string_lossy().into_owned()).collect()
    }

    /// Number of children of the first process whose end was not taken note of.
    fn zombies(&self) -> usize {
        let parent = self.process.id().to_string();
        let all = fs::read_dir("/proc").expect("Linux").flatten();
        let stats = all.filter_map(|process| fs::read_to_string(process.path().join("stat")).ok());
        let states = stats.filter_map(|stat| {
            let (_, rest) = stat.rsplit_once(") ")?;
            let mut words = rest.split(' ');
            Some((words.next()?.to_owned(), words.next()?.to_owned()))
        });
        states.filter(|(state, of)| state == "Z" && *of == parent).count()
    }
}

impl Drop for Own {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        // What follows from the end of the first process takes a moment.
        let start = Instant::now();
        while !self.processes().is_empty() && !thread::panicking() {
            assert!(start.elapsed() < Duration::from_secs(20), "left over: {:?}", self.processes());
            thread::sleep(Duration::from_millis(20));
        }
        let _ = fs::remove_file(&self.path);
    }
}

/// A viewer of a robot that has just been started, or of one at a checkpoint, with its number of reactions so far.
fn meet(robot: &Own) -> (Viewer, u64) {
    let start = Instant::now();
    let mut viewer = loop {
        match Viewer::connect(robot.path.to_str().expect("UTF-8")) {
            Ok(viewer) => break viewer,
            Err(error) => assert!(start.elapsed() < Duration::from_secs(20), "{error}"),
        }
        thread::sleep(Duration::from_millis(20));
    };
    viewer.about();
    let halted = viewer.until(|report| matches!(report, Report::Pace { .. })).pop();
    let Some(Report::Pace { paused: true, reactions, .. }) = halted else { panic!("{halted:?}") };
    viewer.tell(&Command::Keep(true));
    (viewer, reactions)
}

/// Runs up to a number of reactions. Returns what happens, and the last list of checkpoints.
fn run_to(viewer: &mut Viewer, goal: u64) -> (Vec<Report>, Vec<u64>) {
    viewer.tell(&Command::RunTo { reactions: goal });
    let is_there =
        |report: &Report| matches!(report, Report::Pace { paused: true, reactions, .. } if *reactions == goal);
    let (mut happened, mut checkpoints) = (vec![], vec![]);
    for report in viewer.until(is_there) {
        match report {
            Report::Checkpoints(all) => checkpoints = all,
            Report::Pace { .. } | Report::Alive(_) => {}
            other => happened.push(other),
        }
    }
    // The last messages may come after the state.
    viewer.tell(&Command::Params);
    for report in viewer.until(|report| matches!(report, Report::Param { .. })) {
        match report {
            Report::Checkpoints(all) => checkpoints = all,
            Report::Pace { .. } | Report::Param { .. } | Report::Alive(_) => {}
            other => happened.push(other),
        }
    }
    (happened, checkpoints)
}

/// Lets the robot go back to a checkpoint: the process that the viewer sees ends.
fn go_back(viewer: &mut Viewer, reactions: u64) {
    viewer.tell(&Command::GoBack { reactions });
    while let Some(report) = viewer.next() {
        assert!(!matches!(report, Report::NoCheckpoints(_)), "{report:?}");
    }
}

/// The part after a number of reactions.
fn after(happened: &[Report], reactions: usize) -> &[Report] {
    let begins = happened.iter().enumerate().filter(|(_, report)| matches!(report, Report::Reaction { .. }));
    let at = begins.map(|(at, _)| at).nth(reactions).unwrap_or(happened.len());
    &happened[at..]
}

#[test]
fn a_robot_goes_back_to_checkpoints_and_does_the_same_again() {
    let robot = Own::start("checkpoints", 3, None);
    let (mut viewer, begin) = meet(&robot);
    assert_eq!(begin, 0);
    // How soon there are some depends on the machine: those that take long to make are rare.
    let (mut happened, mut checkpoints, mut end) = (vec![], vec![], 0);
    while checkpoints.len() < 4 && end < 6000 {
        end += 600;
        let (more, all) = run_to(&mut viewer, end);
        happened.extend(more);
        checkpoints = all;
    }
    assert!(checkpoints.len() >= 4 && checkpoints[0] == 0 && checkpoints.is_sorted(), "{checkpoints:?}");
    assert_eq!(robot.processes().len(), checkpoints.len() + 1);
    // Again and again to the past of the past.
    for goal in [end - 1, 400, 401, 1] {
        go_back(&mut viewer, goal);
        let (next, reactions) = meet(&robot);
        assert!(reactions <= goal, "{reactions} for {goal}");
        viewer = next;
        let (again, _) = run_to(&mut viewer, end);
        let was = after(&happened, usize::try_from(reactions).expect("a small number"));
        assert!(again == was, "{reactions}: {} and {}", again.len(), was.len());
        assert_eq!(robot.zombies(), 0);
    }
    // Before the first checkpoint of this process there is nothing: the robot stays.
    viewer.set("times.factor", "7").expect("a value in its range");
}

#[test]
fn checkpoints_are_limited_and_grow_rare_with_their_age() {
    let robot = Own::start("limited", 40, None);
    let (mut viewer, _) = meet(&robot);
    // How many there are after some reactions depends on the machine: those that take long to make are rare.
    let is_limited = |checkpoints: &[u64]| {
        let distances: Vec<u64> = checkpoints.windows(2).map(|two| two[1] - two[0]).collect();
        checkpoints.len() == 32 && distances[..8].iter().sum::<u64>() > distances[23..].iter().sum()
    };
    let mut checkpoints = vec![];
    for goal in (1..=10).map(|round| 350 * round) {
        checkpoints = run_to(&mut viewer, goal).1;
        assert!(checkpoints.len() <= 32 && checkpoints.is_sorted(), "{checkpoints:?}");
        assert_eq!(robot.processes().len(), checkpoints.len() + 1);
        assert_eq!(robot.zombies(), 0);
        if is_limited(&checkpoints) {
            break;
        }
    }
    assert!(is_limited(&checkpoints), "{checkpoints:?}");
}

#[test]
fn a_program_with_threads_of_its_own_says_so() {
    let robot = Own::start("threads", 0, Some("thread"));
    let (mut viewer, _) = meet(&robot);
    viewer.tell(&Command::RunTo { reactions: 10 });
    let why = viewer.until(|report| matches!(report, Report::NoCheckpoints(_))).pop();
    assert_eq!(why, Some(Report::NoCheckpoints("the program has threads of its own (`of-its-own`)".to_owned())));
    assert_eq!(robot.processes().len(), 1);
}

#[test]
fn all_processes_end_with_the_last_one_that_runs() {
    let mut robot = Own::start("over", 3, None);
    let (mut viewer, _) = meet(&robot);
    run_to(&mut viewer, 300);
    go_back(&mut viewer, 200);
    let (_viewer, _) = meet(&robot);
    let first = robot.process.id().to_string();
    let newest = robot
        .processes()
        .into_iter()
        .filter(|process| *process != first)
        .max_by_key(|process| process.parse::<u32>().expect("a number"));
    assert!(std::process::Command::new("kill").args(["-9", &newest.expect("it was copied")]).status().is_ok());
    assert!(robot.process.wait().expect("it ends").success());
}

#[test]
fn nothing_of_a_robot_is_left_when_its_first_process_has_ended() {
    // Not at some time afterwards: the next robot waits at the same address for viewers.
    for round in 0..5 {
        let mut robot = Own::start("left", 3, None);
        let (mut viewer, _) = meet(&robot);
        run_to(&mut viewer, 200);
        go_back(&mut viewer, 100 + round);
        let (_viewer, _) = meet(&robot);
        let first = robot.process.id().to_string();
        assert!(std::process::Command::new("kill").arg(first).status().is_ok());
        robot.process.wait().expect("it ends");
        assert_eq!(robot.processes(), Vec::<String>::new());
    }
}

#[test]
fn checkpoints_end_before_a_run_that_is_over() {
    let mut robot = Own::start("run-over", 2, Some("slow"));
    let (mut viewer, _) = meet(&robot);
    viewer.tell(&Command::Run { speed: f64::INFINITY });
    let happened = viewer.until(|report| *report == Report::Ended);
    assert!(happened.iter().any(|report| matches!(report, Report::Checkpoints(all) if all.len() > 1)));
    robot.process.wait().expect("it ends");
    assert_eq!(robot.processes(), Vec::<String>::new());
}
