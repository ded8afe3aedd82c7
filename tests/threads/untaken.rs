//! Events of a program that are not taken: what triggers them is held back, which is said.

use apex_macros::graph;
use apex_rt::{Ports, drive_from, drive_with, prelude::*};
use std::time::Duration;

/// Triggers an event each time.
#[node]
pub fn pulse(beat: Event<()>) {
    beat.emit(());
}

graph! {
    use crate::{untaken::pulse, waits::Echo};
    use apex_nodes::flow::tick;

    graph Heart {
        event beat;
        event quiet;
        node heart = pulse() every 100ms;
        node never = tick() after 1h;
        heart.beat -> beat;
        never -> quiet;
    }

    /// The same, whose event comes from another thread.
    graph Distant {
        slot  question: i64;
        event answer: i64;
        node near = Echo();
        node far  = Echo() on other;
        question  -> far.say;
        far.said  -> near.say;
        near.said -> answer;
    }

    graph Near {
        slot  question: i64;
        event answer: i64;
        node near = Echo();
        question  -> near.say;
        near.said -> answer;
    }
}

/// Events that were reported.
#[derive(Default)]
struct Said(Vec<(&'static str, Duration)>);

impl Observer for Said {
    fn untaken(&mut self, event: &'static str, waits: Duration) {
        self.0.push((event, waits));
    }
}

#[test]
fn an_event_that_is_not_taken_is_told_once_after_a_second() {
    let mut said = Said::default();
    drive_with(Heart::new(), SimClock::until(Time::from_secs(10)), &mut said);
    assert_eq!(said.0, [("beat", Duration::from_secs(1))]);
}

/// Puts in two questions whose answers are not taken: one is in the end of the receiver, one in the program.
fn ask<P: Program + 'static>(
    program: P,
    question: fn(&mut P::Inputs) -> &mut apex_rt::Mailbox<i64>,
    answer: fn(&mut P::Events) -> &mut apex_rt::Mailbox<i64>,
) {
    let mut ports = Ports::<P>::new();
    let (questions, _answers) = (ports.input(question), ports.event(answer));
    let asks = std::thread::spawn(move || [1, 2].map(|n| questions.send(n)).map(|sent| sent.is_ok()));
    drive_from(program, WallClock::new(), ports);
    assert_eq!(asks.join().expect("it does not panic"), [true; 2]);
}

#[cfg(unix)]
mod real {
    use super::{Distant, Heart, Near, ask};
    use crate::process::{again, read_until};
    use apex_rt::{PortReceiver, Ports, drive_from, prelude::*};

    /// Simulated clock that takes an event before the time passes.
    struct Takes(SimClock, PortReceiver<()>);

    impl Clock for Takes {
        const SIMULATED: bool = true;

        fn now(&mut self) -> Time {
            self.0.now()
        }
        fn wait_until(&mut self, time: Time) -> bool {
            self.1.take().expect("the heart beats");
            self.0.wait_until(time)
        }
    }

    #[test]
    #[ignore = "it waits forever: `a_program_that_sleeps_tells_it_too` runs it as a process"]
    fn near() {
        ask(Near::new(), |i| &mut i.question, |e| &mut e.answer);
    }

    #[test]
    #[ignore = "it waits forever: `a_program_that_sleeps_tells_it_too` runs it as a process"]
    fn distant() {
        ask(Distant::new(), |i| &mut i.question, |e| &mut e.answer);
    }

    #[test]
    fn a_program_that_sleeps_tells_it_too() {
        for (test, program) in [("untaken::real::near", "Near"), ("untaken::real::distant", "Distant")] {
            let (_child, mut lines) = again(test, &[]);
            let told = format!("{program}: nobody takes the event `answer`: its token has waited for 1.0s, ");
            read_until(&mut lines, |line| line.contains(&told));
        }
    }

    #[test]
    #[ignore = "`an_event_that_is_taken_is_not_told` runs it as a process"]
    fn taken() {
        let mut ports = Ports::<Heart>::new();
        let beats = ports.event(|events| &mut events.beat);
        drive_from(Heart::new(), Takes(SimClock::until(Time::from_secs(10)), beats), ports);
    }

    #[test]
    fn an_event_that_is_taken_is_not_told() {
        let (_child, lines) = again("untaken::real::taken", &[]);
        let lines: Vec<String> = lines.map(|line| line.expect("it writes text")).collect();
        assert!(lines.iter().any(|line| line.contains("1 passed")), "{lines:?}");
        assert!(!lines.iter().any(|line| line.contains("nobody takes")), "{lines:?}");
    }
}
