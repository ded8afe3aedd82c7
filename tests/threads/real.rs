//! Programs on real threads: no token is lost, they end cleanly, and waiting threads sleep.

use crate::groups::{Enough, Hangs, Match, Panics, Strict, There, Warned};
use apex_macros::graph;
use apex_rt::{prelude::*, threads};
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

/// Returns every ball, up to a number of balls.
#[node]
pub struct Player {
    /// Maximum number of balls.
    #[param]
    limit: i64,
    /// Received balls.
    pub seen: Vec<i64>,
}

#[node]
impl Player {
    #[slot]
    fn ball(&mut self, ball: &i64, back: Event<i64>) {
        self.seen.push(*ball);
        if *ball < self.limit {
            back.emit(ball + 1);
        }
    }
}

/// Starts a match.
#[node]
#[derive(Default)]
pub struct Once;

#[node]
impl Once {
    #[slot]
    fn s(&mut self, e: Event<i64>) {
        e.emit(0);
    }
}

/// Checks that tokens arrive in order, and reports the last one.
#[node]
pub struct Stop {
    /// Number of tokens.
    #[param]
    after: i64,
    next: i64,
}

#[node]
impl Stop {
    fn process(&mut self, x: &i64, enough: Event<()>) {
        assert_eq!(*x, 2 * self.next, "tokens come in order, and none is lost");
        self.next += 1;
        if self.next == self.after {
            enough.emit(());
        }
    }
}

/// Panics at the third token.
#[node]
#[derive(Default)]
pub struct Bad {
    count: usize,
}

#[node]
impl Bad {
    fn process(&mut self, _x: &i64) {
        self.count += 1;
        assert!(self.count < 3, "on purpose");
    }
}

/// Hangs for a while at the third token.
#[node]
#[derive(Default)]
pub struct Stuck {
    count: usize,
}

#[node]
impl Stuck {
    fn process(&mut self, _x: &i64) {
        self.count += 1;
        if self.count == 3 {
            let end = Instant::now() + Duration::from_secs(10);
            while Instant::now() < end && !HEARD.load(Ordering::Acquire) {
                thread::sleep(Duration::from_millis(1));
            }
        }
    }
}

static HEARD: AtomicBool = AtomicBool::new(false);

/// Takes reports of hanging nodes.
#[node]
#[derive(Default)]
pub struct Safe;

#[node]
impl Safe {
    #[slot]
    fn stop(&mut self, stopped: Event<()>) {
        HEARD.store(true, Ordering::Release);
        stopped.emit(());
    }
}

/// Records hanging nodes.
#[derive(Clone, Copy)]
struct Hears<'a>(&'a Mutex<Vec<usize>>);

impl Observer for Hears<'_> {
    fn hung(&mut self, node: usize, running: Duration) {
        assert!(running >= Duration::from_millis(20));
        self.0.lock().expect("nobody panics").push(node);
    }
}

#[test]
fn a_node_that_hangs_is_told_by_name_and_to_a_slot_of_another_thread() {
    let names = Mutex::new(vec![]);
    let pace = WallClock::new().pace().expect("it is the machine's clock");
    let start = Instant::now();
    assert_eq!(threads::drive_on_threads(&mut Hangs::new(), pace, |_| Hears(&names)), 0);
    assert!(start.elapsed() < Duration::from_secs(9), "the slot was called while the node was hanging");
    let names = names.into_inner().expect("nobody panics");
    assert_eq!(names.iter().map(|node| Hangs::INFO.nodes[*node].name).collect::<Vec<_>>(), ["stuck"]);
}

fn drive<P: Program>(program: &mut P) -> u8 {
    let pace = WallClock::new().pace().expect("it is the machine's clock");
    threads::drive_on_threads(program, pace, |_| ())
}

#[test]
fn a_match_between_two_threads_ends_by_itself() {
    let mut program = Match::new();
    assert_eq!(drive(&mut program), 0);
    let (home, away) = (&program.nodes().home.seen, &program.nodes().away.seen);
    assert!(home.iter().copied().eq((0..=2000).step_by(2)));
    assert!(away.iter().copied().eq((1..2000).step_by(2)));
}

#[test]
fn a_token_at_exit_ends_all_threads() {
    for _ in 0..20 {
        assert_eq!(drive(&mut Enough::new()), 0);
    }
}

#[test]
fn rights_that_are_missing_end_the_program_only_if_it_says_so() {
    assert_eq!(drive(&mut Strict::new()), 1);
    assert_eq!(drive(&mut Warned::new()), 0);
}

#[test]
fn a_panic_in_one_group_ends_the_others_and_goes_on() {
    let panicked = catch_unwind(AssertUnwindSafe(|| drive(&mut Panics::new())));
    let message = panicked.expect_err("it panics");
    assert_eq!(message.downcast_ref::<&str>(), Some(&"on purpose"));
}

#[test]
fn somebody_else_can_end_the_program_while_it_sleeps() {
    static STOPPED: apex_rt::Switch = apex_rt::Switch::new();
    let ends = thread::spawn(|| {
        thread::sleep(Duration::from_millis(60));
        STOPPED.set();
    });
    let mut program = There::new();
    let clock = apex_rt::UntilStopped::new(WallClock::new(), &STOPPED);
    assert_eq!(threads::drive_on_threads(&mut program, clock.pace().expect("it is the machine's"), |_| ()), 0);
    ends.join().expect("it does nothing dangerous");
    assert!(!program.nodes().k.seen.is_empty());
}

#[test]
fn the_main_group_takes_the_threads_down_when_driven_by_run() {
    let start = Instant::now();
    apex_rt::run(Match::new(), WallClock::new());
    assert!(start.elapsed() < Duration::from_secs(60));
}

/// Takes much longer than its period.
#[node]
pub fn takes_long() {
    thread::sleep(Duration::from_millis(20));
}

graph! {
    use crate::real::takes_long;

    graph Overloaded {
        node slow = takes_long() every 1ms;
    }
}

/// Observer that counts reactions and what is said of them; the program ends when it is behind.
struct Behind<'a> {
    ends: &'static apex_rt::Switch,
    reactions: &'a std::cell::Cell<u32>,
    told: &'a std::cell::Cell<u32>,
}

impl Observer for Behind<'_> {
    fn after_reaction(&mut self, _next: Next) {
        self.reactions.set(self.reactions.get() + 1);
    }
    fn behind(&mut self, behind: Duration, reaction: Duration) {
        assert!(behind >= Duration::from_secs(1) && reaction >= Duration::from_millis(20), "{behind:?} {reaction:?}");
        self.told.set(self.told.get() + 1);
        let ends = self.ends;
        // From outside, while it is still behind.
        thread::spawn(move || {
            thread::sleep(Duration::from_millis(200));
            ends.set();
        });
    }
}

#[test]
fn a_program_that_is_too_slow_says_so_once_and_can_be_ended() {
    static ENDS: apex_rt::Switch = apex_rt::Switch::new();
    let (reactions, told) = Default::default();
    let clock = apex_rt::UntilStopped::new(WallClock::new(), &ENDS);
    apex_rt::drive_with(Overloaded::new(), clock, Behind { ends: &ENDS, reactions: &reactions, told: &told });
    // One instant in a reaction, however late it is.
    assert!(told.get() == 1 && reactions.get() > 40, "{} {}", told.get(), reactions.get());
}
