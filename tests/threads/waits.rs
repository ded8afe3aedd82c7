//! Programs that wait for other threads: they sleep, are woken, and end when no thread can wake them any more.

use apex_macros::graph;
use apex_rt::{PortReceiver, PortSender, Ports, Switch, UntilStopped, drive, drive_from, prelude::*};
use std::{cell::Cell, thread};

/// Passes tokens on by an event.
#[node]
#[derive(Default)]
pub struct Echo;

#[node]
impl Echo {
    #[slot]
    fn say(&mut self, word: &i64, said: Event<i64>) {
        said.emit(10 * word);
    }
}

/// Plays forever, and turns the switch after a while.
#[node]
#[derive(Default)]
pub struct Tired {
    balls: usize,
}

/// Turned by [`Tired`].
static ENOUGH: Switch = Switch::new();

#[node]
impl Tired {
    #[slot]
    fn ball(&mut self, _ball: &i64, back: Event<i64>) {
        self.balls += 1;
        if self.balls == 100 {
            ENOUGH.set();
        }
        back.emit(0);
    }
}

graph! {
    use crate::{real::{Once, Player}, waits::{Echo, Tired}};

    /// Returns every token.
    graph Answers {
        slot  question: i64;
        slot  end;
        event answer: i64;
        node echo = Echo();
        question  -> echo.say;
        echo.said -> answer;
        end       -> exit;
    }

    /// The same through another thread.
    graph Far {
        slot  question: i64;
        slot  end;
        event answer: i64;
        node near = Echo();
        node far  = Echo() on other;
        question  -> far.say;
        far.said  -> near.say;
        near.said -> answer;
        end       -> exit;
    }

    /// An endless match between two threads that are never idle.
    graph Endless {
        node home  = Tired();
        node away  = Player(limit = 9223372036854775807) on other;
        node first = Once();
        start     -> first.s;
        first.e   -> home.ball;
        home.back -> away.ball;
        away.back -> home.ball;
    }
}

/// Asks three times, each time after the previous answer, then drops the ends.
fn ask(questions: PortSender<i64>, answers: PortReceiver<i64>) -> Vec<i64> {
    let ask = |question| {
        questions.send(question).expect("the program waits as long as it can be asked");
        answers.receive().expect("an answer")
    };
    [1, 2, 3].map(ask).to_vec()
}

/// The machine's clock, which counts the waits without a time limit.
#[derive(Clone, Copy)]
struct Counted<'a> {
    clock: WallClock,
    waits: &'a Cell<u32>,
}

impl Clock for Counted<'_> {
    fn now(&mut self) -> Time {
        self.clock.now()
    }
    fn wait_until(&mut self, time: Time) -> bool {
        self.clock.wait_until(time)
    }
    fn wait(&mut self, until: Option<Time>, woken: &dyn Fn() -> bool) -> bool {
        assert_eq!(until, None, "nothing but a token from outside is waited for");
        self.waits.set(self.waits.get() + 1);
        self.clock.wait(until, woken)
    }
}

#[test]
fn a_program_waits_for_input_as_long_as_somebody_can_give_it() {
    let (mut ports, waits) = (Ports::<Answers>::new(), Cell::new(0));
    let questions = ports.input(|inputs| &mut inputs.question);
    let answers = ports.event(|events| &mut events.answer);
    let asks = thread::spawn(|| ask(questions, answers));
    assert_eq!(drive_from(Answers::new(), Counted { clock: WallClock::new(), waits: &waits }, ports), 0);
    assert_eq!(asks.join().expect("it does not panic"), [10, 20, 30]);
    // Each question wakes it, each answer that is taken may, and the end of both does. On a busy machine all may have
    // come before it waits.
    assert!(waits.get() <= 9, "it waited {} times", waits.get());
}

#[test]
fn a_program_on_threads_waits_too() {
    for _ in 0..20 {
        let mut ports = Ports::<Far>::new();
        let questions = ports.input(|inputs| &mut inputs.question);
        let answers = ports.event(|events| &mut events.answer);
        let asks = thread::spawn(|| ask(questions, answers));
        assert_eq!(drive_from(Far::new(), WallClock::new(), ports), 0);
        assert_eq!(asks.join().expect("it does not panic"), [100, 200, 300]);
    }
}

#[test]
fn a_token_that_is_not_taken_is_given_back() {
    let mut ports = Ports::<Answers>::new();
    let questions = ports.input(|inputs| &mut inputs.question);
    let end = ports.input(|inputs| &mut inputs.end);
    let answers = ports.event(|events| &mut events.answer);
    assert_eq!((questions.put(1), questions.put(2)), (Ok(()), Err(2)), "nobody drives it yet");
    let other = questions.clone();
    let asks = thread::spawn(move || {
        // The answers are not taken: one is in this end, one in the program, and then questions are held back.
        let given: Vec<i64> = (2..).take_while(|question| other.send(*question).is_ok() && *question < 4).collect();
        assert_eq!(end.put(()), Ok(()));
        given
    });
    assert_eq!(drive_from(Answers::new(), WallClock::new(), ports), 0);
    assert_eq!(asks.join().expect("it does not panic"), [2, 3]);
    assert_eq!((answers.receive(), answers.take()), (Some(10), None), "what came out before the end");
    assert_eq!((questions.put(5), questions.send(6)), (Err(5), Err(6)), "it has ended");
}

#[test]
fn nobody_waits_where_nobody_can_come() {
    // Without ports, without ends of ports, and in simulated time, which stands still.
    assert_eq!(drive(Answers::new(), WallClock::new()), 0);
    let mut ports = Ports::<Far>::new();
    drop(ports.input(|inputs| &mut inputs.question));
    assert_eq!(drive_from(Far::new(), WallClock::new(), ports), 0);
    let mut ports = Ports::<Answers>::new();
    let questions = ports.input(|inputs| &mut inputs.question);
    let answers = ports.event(|events| &mut events.answer);
    assert_eq!(questions.put(4), Ok(()));
    assert_eq!(drive_from(Answers::new(), SimClock::until(Time::MAX), ports), 0);
    assert_eq!(answers.take(), Some(40), "what was there is taken");
}

#[test]
fn the_switch_ends_a_program_that_waits_for_input() {
    static SWITCH: Switch = Switch::new();
    let (mut near, mut far) = (Ports::<Answers>::new(), Ports::<Far>::new());
    let _near = near.input(|inputs| &mut inputs.question);
    let _far = far.input(|inputs| &mut inputs.question);
    let turns = thread::spawn(|| SWITCH.set());
    assert_eq!(drive_from(Answers::new(), UntilStopped::new(WallClock::new(), &SWITCH), near), 0);
    assert_eq!(drive_from(Far::new(), UntilStopped::new(WallClock::new(), &SWITCH), far), 0);
    turns.join().expect("it does not panic");
}

#[test]
fn the_switch_ends_groups_that_wake_each_other_for_ever() {
    let clock = UntilStopped::new(WallClock::new(), &ENOUGH);
    assert_eq!(drive(Endless::new(), clock), 0);
}
