//! The robot of the tests in a process of its own: `apex-test-robot SOCKET [PAUSE [thread | slow]]`. Each reaction
//! takes `PAUSE` in ms; with `thread` the program has a thread of its own, with `slow` another period. Without
//! arguments the runtime drives it as the environment variables ask.
#![allow(missing_docs, reason = "a program of tests")]

use apex_macros::graph;
use apex_rt::{
    Next,
    prelude::*,
    studio::{StreamedTime, Studio},
};
use std::{env, thread, time::Duration};

graph!("studio/counts.afg");

fn main() {
    let args: Vec<String> = env::args().skip(1).collect();
    if args.is_empty() {
        return run(Counts::new(), SimClock::until(Time::from_secs(3600)));
    }
    let pause = Duration::from_millis(args.get(1).map_or(0, |pause| pause.parse().expect("a number")));
    match args.get(2).map(String::as_str) {
        Some("thread") => {
            let thread = thread::Builder::new().name("of-its-own".to_owned());
            thread.spawn(|| thread::sleep(Duration::MAX)).expect("room for a thread");
            drive(Counts::new(), &args[0], pause);
        }
        Some(_) => drive(SlowCounts::new(), &args[0], pause),
        None => drive(Counts::new(), &args[0], pause),
    }
}

fn drive<P: Program>(mut program: P, socket: &str, pause: Duration) {
    let studio = Studio::open::<P>(socket, StreamedTime::Waiting).expect("a new socket");
    let mut clock = SimClock::until(Time::from_secs(60));
    let mut stream = studio.stream(0);
    loop {
        let now = clock.now();
        stream.before_reaction(now, &mut program);
        let next = program.react_with(now, &mut stream);
        thread::sleep(pause);
        if !matches!(next, Next::At(time) if clock.wait_until(time)) {
            return;
        }
    }
}
