//! The stream of a program, as a viewer gets it.

use crate::{Counts, drive, open, socket};
use apex_rt::studio::{
    StreamedTime, connect,
    message::{self, About, Command, Report, Test},
};
use std::{
    fs,
    io::{self, Read as _, Write as _},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

/// A viewer of a program that runs on another thread.
pub struct Viewer {
    pub from: Box<dyn io::Read + Send>,
    to: Box<dyn io::Write + Send>,
}

impl Viewer {
    pub fn connect(address: &str) -> io::Result<Self> {
        connect(address).map(|(from, to)| Self { from, to })
    }

    pub fn tell(&mut self, command: &Command) {
        let mut bytes = vec![];
        message::write(command, &mut bytes);
        self.to.write_all(&bytes).expect("the robot listens");
    }

    /// The next message, `None` after the last one.
    pub fn next(&mut self) -> Option<Report> {
        message::read(&mut self.from).expect("messages are well-formed")
    }

    /// Messages until the one that `last` accepts, which is included.
    pub fn until(&mut self, last: impl Fn(&Report) -> bool) -> Vec<Report> {
        let mut all = vec![];
        while let Some(report) = self.next() {
            let found = last(&report);
            all.push(report);
            if found {
                return all;
            }
        }
        panic!("the stream ended: {:?}", all.last_chunk::<5>())
    }

    pub fn about(&mut self) -> About {
        match self.next() {
            Some(Report::About(about)) => about,
            other => panic!("{other:?} instead of a description"),
        }
    }

    pub fn set(&mut self, name: &str, value: &str) -> Result<String, String> {
        self.tell(&Command::Set { name: name.to_owned(), value: value.to_owned() });
        match self.until(|report| matches!(report, Report::Param { .. })).pop() {
            Some(Report::Param { name: of, value, .. }) if of == name => value,
            other => panic!("{other:?} is about something else"),
        }
    }
}

/// Runs the program for 10 s of simulated time, while `view` looks at it.
fn streamed<T>(name: &str, time: StreamedTime, view: impl FnOnce(Viewer) -> T) -> T {
    let studio = open::<Counts>(name, time);
    let address = studio.address().to_owned();
    let running = thread::spawn(move || drive(&studio, 10));
    let (from, to) = connect(&address).expect("the robot listens");
    let seen = view(Viewer { from, to });
    running.join().expect("the program runs to its end");
    assert!(!fs::exists(address).expect("a readable folder"), "the socket is removed");
    seen
}

#[test]
fn a_viewer_sees_every_firing_of_a_waiting_program() {
    streamed("all", StreamedTime::Waiting, |mut viewer| {
        let about = viewer.about();
        assert_eq!((about.name.as_str(), about.version, about.simulated), ("Counts", message::VERSION, true));
        let node = |name: &str| about.nodes.iter().position(|node| node.name == name).expect("a node") as u32;
        assert_eq!(viewer.next(), Some(Report::Active(vec![])));
        assert_eq!(viewer.next(), Some(Report::Pace { paused: true, speed: f64::INFINITY, reactions: 0, ways: 0 }));
        viewer.tell(&Command::Run { speed: f64::INFINITY });
        let all = viewer.until(|report| *report == Report::Ended);
        let count = |wanted: &Report| all.iter().filter(|report| *report == wanted).count();
        assert_eq!(count(&Report::Fired(node("count"))), 1000);
        assert_eq!(count(&Report::Activity { node: node("gated.gate"), active: true }), 1);
        assert_eq!(count(&Report::Failed { node: node("times"), error: "three <b>".to_owned() }), 1);
        assert_eq!(all.iter().filter(|report| matches!(report, Report::Lost(_))).count(), 0);
        assert!(all.contains(&Report::Reaction { group: 0, now: 20_000_000 }));
        assert_eq!(viewer.next(), None);
    });
}

#[test]
fn a_halted_program_goes_step_by_step_and_takes_parameters() {
    streamed("steps", StreamedTime::Waiting, |mut viewer| {
        let about = viewer.about();
        let channel = about.channels.iter().position(|channel| channel.name == "times.out").expect("a channel") as u32;
        viewer.tell(&Command::Watch { channel, every: 1 });
        viewer.tell(&Command::Step);
        let reaction = |report: &Report| matches!(report, Report::Reaction { .. });
        assert_eq!(viewer.until(reaction).pop(), Some(Report::Reaction { group: 0, now: 0 }));
        assert_eq!(viewer.set("times.factor", "5"), Ok("5".to_owned()));
        let error = viewer.set("times.factor", "12").expect_err("it is out of range");
        assert!(error.contains("times.factor") && error.contains("0..=9"), "{error}");
        assert!(viewer.set("times.faktor", "1").expect_err("no such parameter").contains("times.factor"));
        viewer.tell(&Command::Step);
        let value = viewer.until(|report| matches!(report, Report::Value { now: 10_000_000, .. })).pop();
        assert_eq!(
            value,
            Some(Report::Value {
                channel,
                now: 10_000_000,
                text: "10".to_owned(),
                bytes: vec![0, 1, 0, 0, 10, 0, 0, 0, 0, 0, 0, 0]
            })
        );
        viewer.tell(&Command::Params);
        let all = viewer.until(|report| matches!(report, Report::Param { .. }));
        let five = Report::Param { name: "times.factor".to_owned(), value: Ok("5".to_owned()), reactions: None };
        assert_eq!(all.last(), Some(&five));
    });
}

#[test]
fn a_program_continues_when_its_viewer_leaves_or_talks_nonsense() {
    streamed("leaves", StreamedTime::Waiting, |mut viewer| drop(viewer.about()));
    streamed("nonsense", StreamedTime::Waiting, |mut viewer| {
        viewer.to.write_all(&[0xff; 64]).expect("the robot listens");
        while let Ok(Some(_)) = message::read::<Report>(&mut viewer.from) {}
    });
}

#[test]
fn several_viewers_see_the_same() {
    streamed("both", StreamedTime::Waiting, |mut first| {
        let (from, to) = connect(socket("both").to_str().expect("UTF-8")).expect("room for another viewer");
        let mut second = Viewer { from, to };
        assert_eq!(first.about(), second.about());
        second.tell(&Command::Run { speed: f64::INFINITY });
        let fired = |all: Vec<Report>| all.into_iter().filter(|report| matches!(report, Report::Fired(_))).count();
        let ended = |report: &Report| *report == Report::Ended;
        assert_eq!(fired(first.until(ended)), fired(second.until(ended)));
    });
}

#[test]
fn a_program_without_viewers_runs_on() {
    streamed("alone", StreamedTime::Simulated, drop);
}

#[test]
fn a_program_halts_at_a_reaction_and_where_a_condition_becomes_true() {
    streamed("goals", StreamedTime::Waiting, |mut viewer| {
        let about = viewer.about();
        let gate = about.nodes.iter().position(|node| node.name == "gated.gate").expect("a node") as u32;
        let halted = |report: &Report| matches!(report, Report::Pace { paused: true, .. });
        viewer.until(halted);
        let halt = |viewer: &mut Viewer| match viewer.until(halted).pop() {
            Some(Report::Pace { reactions, .. }) => reactions,
            other => panic!("{other:?}"),
        };
        // After the reaction in which the gate becomes active.
        viewer.tell(&Command::Break(vec![Test::Active(vec![gate, 99]), Test::Not, Test::Not]));
        viewer.tell(&Command::Run { speed: f64::INFINITY });
        halt(&mut viewer);
        viewer.tell(&Command::Pause);
        let now = halt(&mut viewer);
        viewer.tell(&Command::RunTo { reactions: 500 });
        assert_eq!((halt(&mut viewer), now < 500), (500, true));
        viewer.tell(&Command::RunTo { reactions: 3 });
        assert_eq!(halt(&mut viewer), 500);
        viewer.tell(&Command::Step);
        assert_eq!(halt(&mut viewer), 501);
    });
}

/// A program in real time whose reactions are few, so that values wait for it.
fn slow(name: &str) -> (apex_rt::studio::Studio, String) {
    let studio = open::<Counts>(name, StreamedTime::Real);
    let address = studio.address().to_owned();
    (studio, address)
}

#[test]
fn a_value_that_no_type_needs_is_refused_before_it_is_read() {
    streamed("long", StreamedTime::Waiting, |mut viewer| {
        viewer.about();
        let error = viewer.set("times.factor", &format!("[{}1]", "1,".repeat(1_000_000))).expect_err("2 MB");
        assert!(error.contains("times.factor") && error.contains("at most 64 bytes"), "{error}");
        assert_eq!(viewer.set("times.factor", "5"), Ok("5".to_owned()));
    });
}

#[test]
fn a_flood_of_values_is_dropped_and_its_sender_is_told() {
    // Nothing serves the values.
    let (studio, address) = slow("flood");
    let (mut viewer, mut other) = (Viewer::connect(&address).unwrap(), Viewer::connect(&address).unwrap());
    for _ in 0..1000 {
        viewer.tell(&Command::Set { name: "times.factor".to_owned(), value: "3".to_owned() });
    }
    let is_last = |report: &Report| matches!(report, Report::Param { value: Err(error), .. } if error.contains("was dropped") && error.contains("(936 "));
    let dropped = viewer.until(is_last).iter().filter(|report| matches!(report, Report::Param { .. })).count();
    assert_eq!(dropped, 1000 - 64);
    // Others have room of their own, and are told of nothing.
    other.tell(&Command::Set { name: "times.factor".to_owned(), value: "4".to_owned() });
    let is_told = Arc::new(AtomicBool::new(false));
    let ends = Arc::clone(&is_told);
    let runs = thread::spawn(move || {
        let (mut program, mut stream) = (crate::Counts::new(), studio.stream(0));
        for ms in (0..).take_while(|_| !ends.load(Ordering::Relaxed)) {
            apex_rt::Observer::before_reaction(&mut stream, apex_rt::Time::from_millis(ms), &mut program);
            thread::sleep(std::time::Duration::from_millis(1));
        }
    });
    let (name, value) = ("times.factor".to_owned(), Ok("4".to_owned()));
    let told =
        other.until(|report| *report == Report::Param { name: name.clone(), value: value.clone(), reactions: Some(0) });
    assert!(!told.iter().any(|report| matches!(report, Report::Param { value: Err(_), .. })), "{told:?}");
    is_told.store(true, Ordering::Relaxed);
    runs.join().expect("it does not panic");
}

#[test]
fn questions_for_all_parameters_take_no_room_from_others() {
    // Nothing serves them.
    let (_studio, address) = slow("questions");
    let (mut viewer, mut other) = (Viewer::connect(&address).unwrap(), Viewer::connect(&address).unwrap());
    for _ in 0..5000 {
        viewer.tell(&Command::Params);
    }
    viewer.until(|report| matches!(report, Report::Alive(_)));
    other.tell(&Command::Set { name: "times.factor".to_owned(), value: "4".to_owned() });
    let told = other.until(|report| matches!(report, Report::Alive(_)));
    assert!(!told.iter().any(|report| matches!(report, Report::Param { .. })), "{told:?}");
}

#[test]
fn viewers_that_say_nothing_make_room_for_others() {
    let (_studio, address) = slow("idle");
    let mut talking = Viewer::connect(&address).unwrap();
    let mut idle: Vec<Viewer> = (0..15).map(|_| Viewer::connect(&address).unwrap()).collect();
    idle.iter_mut().for_each(|viewer| drop(viewer.about()));
    // All of them have said something not long ago, or have just come.
    let mut early = Viewer::connect(&address).unwrap();
    let told = early.next();
    assert!(matches!(&told, Some(Report::Dismissed(why)) if why.contains("16 viewers")), "{told:?}");
    for _ in 0..5 {
        thread::sleep(std::time::Duration::from_millis(700));
        talking.tell(&Command::Alive);
    }
    let mut late = Viewer::connect(&address).unwrap();
    late.about();
    let leaves = |report: &Report| matches!(report, Report::Dismissed(why) if why.contains("said nothing"));
    idle[0].until(leaves);
    // The others go when they have had time enough to say something.
    idle.last_mut().expect("15 of them").until(|report| matches!(report, Report::Dismissed(_)));
    talking.tell(&Command::Params);
    talking.until(|report| matches!(report, Report::Alive(_)));
}

#[test]
fn a_robot_says_that_it_is_there_and_if_it_reacts() {
    let (studio, address) = slow("beats");
    let mut viewer = Viewer::connect(&address).unwrap();
    viewer.about();
    let mut beat = || match viewer.until(|report| matches!(report, Report::Alive(_))).pop() {
        Some(Report::Alive(groups)) => groups,
        other => panic!("{other:?}"),
    };
    assert_eq!(beat(), [(0, false)]);
    let (mut program, mut stream) = (crate::Counts::new(), studio.stream(0));
    for ms in 0..3 {
        apex_rt::Observer::before_reaction(&mut stream, apex_rt::Time::from_millis(ms), &mut program);
        apex_rt::Observer::after_reaction(&mut stream, apex_rt::Next::Now);
    }
    assert_eq!(beat(), [(3, false)]);
    apex_rt::Observer::before_reaction(&mut stream, apex_rt::Time::from_millis(3), &mut program);
    assert_eq!((beat(), beat()), (vec![(4, true)], vec![(4, true)]));
}

#[test]
fn many_small_messages_do_not_keep_others_waiting() {
    let (_studio, address) = slow("small");
    let mut flood = vec![];
    message::write(&Command::Alive, &mut flood);
    let flood = flood.repeat(400_000);
    let Viewer { mut from, mut to } = Viewer::connect(&address).unwrap();
    let reads = thread::spawn(move || while from.read(&mut [0; 1 << 16]).is_ok_and(|count| count > 0) {});
    let writes = thread::spawn(move || to.write_all(&flood).map(|()| to));
    let mut viewer = Viewer::connect(&address).unwrap();
    viewer.about();
    viewer.until(|report| matches!(report, Report::Alive(_)));
    let to = writes.join().expect("it does not panic").expect("the robot reads them in time");
    drop((to, viewer, _studio));
    reads.join().expect("it ends with the robot");
}

#[cfg(unix)]
#[test]
fn only_the_user_of_the_robot_reaches_its_socket() {
    use std::os::unix::fs::PermissionsExt as _;
    let (_studio, address) = slow("rights");
    assert_eq!(fs::metadata(address).expect("a socket").permissions().mode() & 0o777, 0o600);
}

/// A robot in a process of its own, which runs as environment variables say.
pub struct Robot {
    process: std::process::Child,
    pub address: String,
}

impl Robot {
    /// Starts it with a socket of this name.
    pub fn start(name: &str, variables: &[(&str, &str)]) -> Self {
        let address = socket(name).to_str().expect("UTF-8").to_owned();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_apex-test-robot"));
        command.env("APEX_STUDIO", &address).env("APEX_STUDIO_WAIT", "1").envs(variables.iter().copied());
        command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped());
        let process = command.spawn().expect("it starts");
        Self { process, address }
    }

    /// Connects a viewer as soon as there is a socket.
    fn viewer(&self) -> Viewer {
        let connected = (0..500).find_map(|_| {
            thread::sleep(std::time::Duration::from_millis(20));
            Viewer::connect(&self.address).ok()
        });
        connected.expect("it has a socket")
    }

    /// Ends it. Returns what it has written to standard error.
    fn end(&mut self) -> String {
        let mut said = String::new();
        let _ = self.process.kill();
        self.process.stderr.take().expect("it is read").read_to_string(&mut said).expect("UTF-8");
        let _ = self.process.wait();
        said
    }

    /// Sends a signal to it.
    #[cfg(unix)]
    pub fn signal(&self, name: &str) {
        let id = self.process.id().to_string();
        assert!(std::process::Command::new("kill").args([name, &id]).status().expect("there is `kill`").success());
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = fs::remove_file(&self.address);
    }
}

#[test]
fn the_robot_notes_who_has_set_what() {
    let mut robot = Robot::start("notes", &[]);
    let mut viewer = robot.viewer();
    viewer.about();
    for value in ["3", "4", "5"] {
        assert_eq!(viewer.set("times.factor", value), Ok(value.to_owned()));
    }
    // A note a second, with the last value.
    thread::sleep(std::time::Duration::from_millis(1500));
    let said = robot.end();
    let notes: Vec<&str> = said.lines().filter(|line| line.starts_with("viewer ")).collect();
    assert!(notes.last().is_some_and(|note| note.contains("has set `times.factor` to 5")), "{said}");
    assert!(notes.len() <= 2, "{said}");
}

#[test]
fn viewers_of_a_robot_that_is_not_for_them_only_look() {
    let robot = Robot::start("looks", &[("APEX_STUDIO_ACCESS", "read")]);
    let mut viewer = robot.viewer();
    assert_eq!(viewer.next(), Some(Report::ReadOnly));
    viewer.about();
    assert!(viewer.set("times.factor", "5").expect_err("it may only look").contains("may only look"));
    // Nothing lets it run.
    viewer.tell(&Command::Run { speed: f64::INFINITY });
    viewer.tell(&Command::Step);
    viewer.tell(&Command::Params);
    let told = viewer.until(|report| matches!(report, Report::Alive(_)));
    assert!(!told.iter().any(|report| matches!(report, Report::Reaction { .. })), "{told:?}");
    let two = Report::Param { name: "times.factor".to_owned(), value: Ok("2".to_owned()), reactions: None };
    assert!(told.contains(&two), "{told:?}");
}

#[test]
fn a_robot_with_a_token_tells_others_nothing() {
    let robot = Robot::start("token", &[("APEX_STUDIO_TOKEN", "open sesame")]);
    for first in [Command::Params, Command::Token("open barley".to_owned())] {
        let mut viewer = robot.viewer();
        viewer.tell(&first);
        let told = viewer.next();
        assert!(matches!(&told, Some(Report::Dismissed(why)) if why.contains("APEX_STUDIO_TOKEN")), "{told:?}");
        assert_eq!(viewer.next(), None);
    }
    let mut viewer = robot.viewer();
    viewer.tell(&Command::Token("open sesame".to_owned()));
    viewer.about();
    assert_eq!(viewer.set("times.factor", "5"), Ok("5".to_owned()));
}
