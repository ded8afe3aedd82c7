//! Effect of Ctrl-C on a driven program: this test starts itself as another process, which hangs.
#![cfg(unix)]

use crate::process::{again, read_until, send};
use apex_macros::graph;
use apex_rt::{Ports, UntilStopped, drive, drive_from, prelude::*};
use std::{io::Write as _, thread};

/// Output of the other process when it hangs.
const HANGS: &str = "it hangs";
/// Output of the other process after the first signal, while it still hangs.
const ASKED: &str = "it was asked";

/// Hangs until the process is killed.
#[node]
#[derive(Default)]
pub struct Never;

#[node]
impl Never {
    fn process(&mut self) {
        say(HANGS);
        loop {
            thread::park();
        }
    }
}

graph! {
    use crate::signals::Never;

    graph Hung {
        node never = Never() every 1ms;
        node other = Never() after 1h on other;
    }
}

fn say(what: &str) {
    let mut out = std::io::stdout();
    writeln!(out, "{what}").and_then(|()| out.flush()).expect("somebody listens");
}

#[test]
#[ignore = "it hangs: `a_second_signal_ends_a_program_that_hangs` runs it as a process"]
fn hangs() {
    let clock = UntilStopped::ctrl_c(WallClock::new()).expect("the signals are free");
    // The group `other` sleeps for an hour, and ends after the first signal, which `Drop` reports.
    let ends = thread::spawn(move || {
        let _ = drive(OnlyOther::new(), clock);
        say(ASKED);
    });
    drive(Hung::new(), clock);
    let _ = ends.join();
}

graph! {
    use apex_nodes::flow::tick;

    graph OnlyOther {
        node later = tick() after 1h;
    }
}

#[test]
fn a_second_signal_ends_a_program_that_hangs() {
    let (mut child, mut lines) = again("signals::hangs", &[]);
    read_until(&mut lines, |line| line.ends_with(HANGS));
    send(&child, "INT");
    read_until(&mut lines, |line| line.ends_with(ASKED));
    send(&child, "INT");
    let status = child.0.wait().expect("it ends");
    assert_eq!(status.code(), Some(130));
}

/// Says that it got something.
#[node]
#[derive(Default)]
pub struct Hears;

#[node]
impl Hears {
    #[slot]
    fn put(&mut self, _number: &f64) {
        say(HEARD);
    }
}

/// Output of the other process when it begins to wait, and when it has ended.
const HEARD: &str = "it waits";
const ENDED: &str = "it has ended";

graph! {
    use crate::signals::Hears;

    graph Waiting {
        slot number: f64;
        node hears = Hears();
        number -> hears.put;
    }
}

#[test]
#[ignore = "it waits: `a_signal_ends_a_program_that_waits_for_input` runs it as a process"]
fn waits() {
    let mut ports = Ports::<Waiting>::new();
    let sender = ports.input(|inputs| &mut inputs.number);
    assert!(sender.send(1.0).is_ok());
    drive_from(Waiting::new(), WallClock::new(), ports);
    say(ENDED);
    drop(sender);
}

#[test]
fn a_signal_ends_a_program_that_waits_for_input() {
    let (mut child, mut lines) = again("signals::waits", &[]);
    read_until(&mut lines, |line| line.ends_with(HEARD));
    send(&child, "INT");
    read_until(&mut lines, |line| line.ends_with(ENDED));
    assert!(child.0.wait().expect("it ends").success());
}
