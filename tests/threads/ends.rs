//! The end of a process: each cause, in real processes. This test starts itself again for that.
#![cfg(unix)]

use crate::{
    process::{Killed, again, read_until, send},
    steady::steadily,
};
use apex_macros::graph;
use apex_rt::prelude::*;
use std::{io::Write as _, thread, time::Duration};

/// Environment variable with the name of the program that the other process runs.
const PROGRAM: &str = "APEX_TEST_ENDS";

/// A driver that says when it begins and when it stops.
#[node]
#[derive(Default)]
pub struct Base {
    /// Name of its thread group.
    #[param]
    name: String,
    begun: bool,
}

#[node]
impl Base {
    fn process(&mut self) {
        if !std::mem::replace(&mut self.begun, true) {
            say(&format!("{} drives", self.name));
        }
    }

    #[on_stop]
    fn halt(&mut self) {
        say(&format!("{} stops", self.name));
    }
}

/// A driver whose stop fails.
#[node]
#[derive(Default)]
pub struct Clumsy;

#[node]
impl Clumsy {
    fn process(&mut self) {}

    #[on_stop]
    fn halt(&mut self) {
        panic!("it cannot stop");
    }
}

/// Panics.
#[node]
pub fn breaks() {
    panic!("it breaks");
}

/// Never returns.
#[node]
pub fn hangs() {
    say("what hangs drives");
    loop {
        thread::park();
    }
}

graph! {
    use apex_nodes::flow::tick;
    use crate::ends::{Base, Clumsy, breaks, hangs};

    /// Two groups that drive.
    robot Steady {
        node near = Base(name = "near") every 10ms;
        node odd  = Clumsy() every 10ms;
        node far  = Base(name = "far") every 10ms on other;
    }

    /// A single group.
    robot Alone {
        node near = Base(name = "near") every 10ms;
    }

    robot Exits = Steady {
        node end = tick() after 100ms;
        end -> exit;
    }

    robot Aborts = Steady {
        node end = tick() after 100ms;
        end -> abort;
    }

    robot Breaks = Steady {
        node end = breaks() after 100ms;
    }

    robot BreaksFar = Steady {
        node end = breaks() after 100ms on other;
    }

    robot BreaksAlone = Alone {
        node end = breaks() after 100ms;
    }

    /// Nothing watches inside of the process.
    robot HangsFar = Steady {
        node end = hangs() after 100ms on other;
    }

    robot Hangs = Steady {
        thread other { hang = 100ms }
        node end = hangs() after 100ms on other;
        hung -> abort;
    }
}

fn say(what: &str) {
    let mut out = std::io::stdout();
    writeln!(out, "{what}").and_then(|()| out.flush()).expect("somebody listens");
}

#[test]
#[ignore = "the other tests run it as a process"]
fn other_process() {
    let clock = WallClock::new();
    match std::env::var(PROGRAM).expect("the other tests set it").as_str() {
        "Steady" => run(Steady::new(), clock),
        "Alone" => run(Alone::new(), clock),
        "Exits" => run(Exits::new(), clock),
        "Aborts" => run(Aborts::new(), clock),
        "Breaks" => run(Breaks::new(), clock),
        "BreaksFar" => run(BreaksFar::new(), clock),
        "BreaksAlone" => run(BreaksAlone::new(), clock),
        "Hangs" => run(Hangs::new(), clock),
        "HangsFar" => run(HangsFar::new(), clock),
        "HangsAlone" => run(HangsAlone::new(), clock),
        "MissesDeadlines" => run(MissesDeadlines::new(), clock),
        other => panic!("there is no program `{other}`"),
    }
}

/// Runs a program in another process, sends it `signal` when it drives, and returns the groups that have stopped and
/// the exit code.
fn end_of(program: &str, groups: &[&str], signal: Option<&str>) -> (Vec<String>, Option<i32>) {
    let (mut child, mut lines) = again("ends::other_process", &[(PROGRAM, program)]);
    for _ in groups {
        read_until(&mut lines, |line| line.ends_with("drives"));
    }
    if let Some(signal) = signal {
        send(&child, signal);
    }
    let stopped = lines.map_while(Result::ok).filter_map(|line| Some(line.strip_suffix(" stops")?.to_owned()));
    let mut stopped: Vec<String> = stopped.collect();
    stopped.sort();
    let Killed(child) = &mut child;
    (stopped, child.wait().expect("it ends").code())
}

#[test]
fn signals_let_all_groups_stop() {
    for signal in ["INT", "TERM", "HUP"] {
        let both = ["near", "far"];
        assert_eq!(end_of("Steady", &both, Some(signal)), (vec!["far".into(), "near".into()], Some(0)), "{signal}");
        assert_eq!(end_of("Alone", &["near"], Some(signal)), (vec!["near".into()], Some(0)), "{signal}");
    }
}

#[test]
fn all_groups_stop_however_a_program_ends_by_itself() {
    // The harness of tests turns a panic into code 101; so does a `main`.
    for (program, code) in [("Exits", 0), ("Aborts", 1), ("Breaks", 101), ("BreaksFar", 101)] {
        let end = end_of(program, &["near", "far"], None);
        assert_eq!(end, (vec!["far".into(), "near".into()], Some(code)), "{program}");
    }
    assert_eq!(end_of("BreaksAlone", &["near"], None), (vec!["near".into()], Some(101)));
}

#[test]
fn all_groups_but_a_hanging_one_stop() {
    let begun = std::time::Instant::now();
    assert_eq!(end_of("Hangs", &["near", "far", "what hangs"], None), (vec!["near".into()], Some(1)));
    assert_eq!(end_of("HangsFar", &["near", "far", "what hangs"], Some("TERM")), (vec!["near".into()], Some(130)));
    assert!(begun.elapsed() < Duration::from_secs(30), "it does not wait for what hangs");
}

#[test]
fn the_recording_of_a_program_that_hangs_is_finished() {
    for (program, signal) in [("Hangs", None), ("HangsFar", Some("TERM"))] {
        let path = std::env::temp_dir().join(format!("apex-ends-{program}-{}.mcap", std::process::id()));
        let file = path.to_str().expect("UTF-8");
        let (mut child, mut lines) = again("ends::other_process", &[(PROGRAM, program), ("APEX_RECORD", file)]);
        read_until(&mut lines, |line| line == "what hangs drives");
        if let Some(signal) = signal {
            send(&child, signal);
        }
        let status = child.0.wait().expect("it ends");
        let bytes = std::fs::read(&path).expect("it was recorded");
        let _ = std::fs::remove_file(&path);
        assert!(!status.success() && bytes.ends_with(b"\x89MCAP0\r\n"), "{program}: {status}, {} bytes", bytes.len());
    }
}

graph! {
    use apex_nodes::flow::tick;
    use crate::ends::{Base, hangs, slow};

    /// Hangs after half a second, and nothing watches inside of the process.
    robot HangsAlone {
        node near = Base(name = "near") every 10ms;
        node end  = hangs() after 500ms;
    }

    /// Misses its deadline at the end.
    robot MissesDeadlines {
        node near = Base(name = "near") every 10ms;
        node slow = slow() after 500ms every 20ms deadline 5ms;
    }
}

/// Takes longer than its deadline.
#[node]
pub fn slow() {
    thread::sleep(Duration::from_millis(10));
}

/// Runs `program` in another process with a watchdog that waits for 200 ms, and returns what that is told: until it is
/// told nothing for a second, or that the program ends.
#[cfg(target_os = "linux")]
fn told(program: &str, interrupted: bool) -> Vec<String> {
    use std::os::unix::net::UnixDatagram;
    let path = std::env::temp_dir().join(format!("apex-watchdog-{program}-{}", std::process::id()));
    let _ = std::fs::remove_file(&path);
    let socket = UnixDatagram::bind(&path).expect("a folder for temporary files");
    socket.set_read_timeout(Some(Duration::from_secs(30))).expect("a time");
    let name = path.to_str().expect("UTF-8");
    let (child, _lines) =
        again("ends::other_process", &[(PROGRAM, program), ("NOTIFY_SOCKET", name), ("WATCHDOG_USEC", "200000")]);
    let (mut told, mut buffer) = (vec![], [0; 64]);
    while let Ok(length) = steadily(|| socket.recv(&mut buffer)) {
        let text = String::from_utf8_lossy(&buffer[..length]).into_owned();
        if told.len() == 3 {
            socket.set_read_timeout(Some(Duration::from_secs(1))).expect("a time");
            if interrupted {
                send(&child, "TERM");
            }
        }
        told.push(text);
        // If it were fed forever, this would not end.
        if told.len() > 200 || told.last().is_some_and(|text| text == "STOPPING=1") {
            break;
        }
    }
    let _ = std::fs::remove_file(&path);
    told
}

#[cfg(target_os = "linux")]
#[test]
fn a_watchdog_is_fed_while_all_groups_are_well() {
    let well = told("Steady", true);
    assert_eq!(
        (well.first().map(String::as_str), well.last().map(String::as_str)),
        (Some("READY=1"), Some("STOPPING=1"))
    );
    assert!(well[1..well.len() - 1].iter().all(|text| text == "WATCHDOG=1"), "{well:?}");
    // It is not fed any more, although the process lives.
    for program in ["HangsAlone", "MissesDeadlines"] {
        let told = told(program, false);
        assert!(
            (4..100).contains(&told.len()) && told[1..].iter().all(|text| text == "WATCHDOG=1"),
            "{program}: {told:?}"
        );
    }
}
