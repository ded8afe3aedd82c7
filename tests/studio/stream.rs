//! The stream of a program, as a viewer gets it.

use crate::{drive, open, socket};
use apex_rt::studio::{
    StreamedTime, connect,
    message::{self, About, Command, Report, Test},
};
use std::{
    fs,
    io::{self, Write as _},
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
    let studio = open(name, time);
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
        assert_eq!(viewer.next(), Some(Report::Pace { paused: true, speed: f64::INFINITY, reactions: 0 }));
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
