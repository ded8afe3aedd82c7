//! Data shared by threads, in every order of accesses (loom): the sources of the runtime are compiled here with the
//! atomics of the model checker.
#![allow(dead_code, unsafe_code, missing_docs, reason = "the runtime uses and documents it")]

mod sync {
    pub use loom::sync::atomic::{AtomicBool, AtomicU8, AtomicUsize, Ordering};

    #[derive(Debug)]
    pub struct UnsafeCell<T>(loom::cell::UnsafeCell<T>);

    impl<T> UnsafeCell<T> {
        pub fn new(value: T) -> Self {
            Self(loom::cell::UnsafeCell::new(value))
        }

        pub fn with_mut<R>(&self, look: impl FnOnce(*mut T) -> R) -> R {
            self.0.with_mut(look)
        }
    }
}

#[path = "../../apex-rt/src/cell.rs"]
mod cell;
#[path = "../../apex-rt/src/threads/idle.rs"]
mod idle;

use cell::{CellReceiver, CellSender, TokenCell};
use idle::{Alarm, Shared};
use loom::{
    sync::{
        Arc, Notify,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

/// A cell whose ends may go to threads of the model, which need it forever.
fn ends() -> (CellSender<'static, u32>, CellReceiver<'static, u32>) {
    Box::leak(Box::new(TokenCell::new(0))).ends()
}

#[test]
fn a_cell_gives_every_token_once_and_in_order() {
    loom::model(|| {
        let (mut sender, mut receiver) = ends();
        let sends = thread::spawn(move || {
            for token in 1..=2 {
                while !sender.put(|place| *place = token) {
                    thread::yield_now();
                }
            }
        });
        for expected in 1..=2 {
            let token = loop {
                if let Some(token) = receiver.take(std::mem::take) {
                    break token;
                }
                thread::yield_now();
            };
            assert_eq!(token, expected);
            receiver.release();
        }
        sends.join().expect("it does not panic");
    });
}

#[test]
fn there_is_no_room_before_the_receiver_is_done() {
    loom::model(|| {
        let (mut sender, mut receiver) = ends();
        assert!(sender.put(|place| *place = 1));
        let takes = thread::spawn(move || {
            let token = receiver.take(|place| *place);
            receiver.release();
            token
        });
        if sender.put(|place| *place = 2) {
            assert_eq!(takes.join().expect("it does not panic"), Some(1));
        } else {
            takes.join().expect("it does not panic");
            assert!(sender.is_free());
        }
    });
}

/// A wake-up call for a thread of the model.
#[derive(Default)]
struct Bell(Notify);

impl Alarm for Bell {
    fn ring(&self) {
        self.0.notify();
    }
}

fn shared(groups: usize) -> Arc<Shared<Bell>> {
    Arc::new(Shared::new((0..groups).map(|_| Bell(Notify::new()))))
}

/// Body of a group's thread: calls `work` until nothing is left to do, and then sleeps. `work` returns `true` if it
/// must be called again at once.
fn group(shared: &Shared<Bell>, number: usize, mut work: impl FnMut(&Shared<Bell>)) {
    while !shared.is_stopped() {
        shared.begin(number);
        work(shared);
        if shared.may_idle(number) {
            while shared.sleeps(number) {
                shared.alarm(number).0.wait();
            }
        }
    }
}

#[test]
fn all_groups_stop_when_nothing_can_happen_and_not_before() {
    let mut builder = loom::model::Builder::new();
    // All orders would take hours; errors of this kind need only a few preemptions.
    builder.preemption_bound = Some(2);
    builder.check(|| {
        let (mut sender, mut receiver) = ends();
        let shared = shared(2);
        let other = shared.clone();
        let sends = thread::spawn(move || {
            let mut left = 2;
            group(&other, 0, |shared| {
                if left > 0 && sender.put(|place| *place = left) {
                    left -= 1;
                    shared.wake(1);
                }
            });
            left
        });
        let mut taken = vec![];
        group(&shared, 1, |shared| {
            if let Some(token) = receiver.take(|place| *place) {
                taken.push(token);
                receiver.release();
                shared.wake(0);
            }
        });
        assert_eq!(sends.join().expect("it does not panic"), 0, "everything was sent");
        assert_eq!(taken, [2, 1], "everything was taken");
    });
}

#[test]
fn a_group_that_stops_the_program_stops_those_that_sleep() {
    loom::model(|| {
        let shared = shared(2);
        let other = shared.clone();
        let sleeps = thread::spawn(move || group(&other, 1, |_| {}));
        shared.begin(0);
        shared.stop();
        sleeps.join().expect("it does not panic");
    });
}

#[test]
fn who_may_wait_was_not_woken_before() {
    loom::model(|| {
        let shared = shared(2);
        let other = shared.clone();
        shared.begin(0);
        let wakes = thread::spawn(move || other.wake(0));
        if shared.may_wait(0) {
            // This thread was not notified yet, so its alarm will ring.
            shared.alarm(0).0.wait();
        }
        wakes.join().expect("it does not panic");
    });
}

/// An alarm that can ring as soon as its thread has begun, as for an operating-system thread.
struct Late {
    began: AtomicBool,
    bell: Notify,
}

impl Alarm for Late {
    fn ring(&self) {
        if self.began.load(Ordering::Acquire) {
            self.bell.notify();
        }
    }
}

fn late(groups: usize) -> Arc<Shared<Late>> {
    let alarm = || Late { began: AtomicBool::new(false), bell: Notify::new() };
    Arc::new(Shared::new((0..groups).map(|_| alarm())))
}

#[test]
fn a_program_that_stops_while_a_thread_begins_stops_that_too() {
    loom::model(|| {
        let shared = late(2);
        let other = shared.clone();
        let begins = thread::spawn(move || {
            other.alarm(1).began.store(true, Ordering::Release);
            while !other.is_stopped() {
                other.begin(1);
                if other.may_idle(1) {
                    while other.sleeps(1) {
                        other.alarm(1).bell.wait();
                    }
                }
            }
        });
        shared.begin(0);
        shared.stop();
        begins.join().expect("it does not panic");
    });
}

#[test]
fn who_watches_sees_a_group_that_hangs() {
    loom::model(|| {
        let (shared, stirred, seen) = (shared(1), Arc::new(Notify::new()), Arc::new(Notify::new()));
        assert!(shared.may_wait(0), "it sleeps at first");
        let (other, stirs, hangs) = (shared.clone(), stirred.clone(), seen.clone());
        let group = thread::spawn(move || {
            other.begin(0);
            if other.wakes_watch() {
                stirs.notify();
            }
            // It hangs until the watchdog detects it.
            hangs.wait();
        });
        while shared.may_watch_sleep() {
            stirred.wait();
        }
        seen.notify();
        group.join().expect("it does not panic");
    });
}
