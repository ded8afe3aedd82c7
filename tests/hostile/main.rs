//! Hostile source files: each ends in diagnostics or in a program, soon, on a thread with the default stack size.
//! Small ones are in `corpus/`, large ones are made here.

#[path = "../errors/compile.rs"]
mod compile;
mod large;
mod random;

use apex_dsl::report::{json, render};
use compile::{catalog, compile};
use std::{
    fs,
    path::Path,
    sync::mpsc,
    thread,
    time::{Duration, Instant},
};

/// Time limit: far more than any source file takes, also in a debug build on a busy machine, to detect hangs.
const GUARD: Duration = Duration::from_secs(120);

/// Compiles the source files in sequence and renders all diagnostics. Gives up if one hangs.
fn run(texts: Vec<(String, String)>) {
    let (sender, receiver) = mpsc::channel();
    let worker = thread::spawn(move || {
        let mut catalog = catalog();
        for (name, text) in texts {
            let start = Instant::now();
            let _ = sender.send(name.clone());
            let compiled = compile(Path::new("hostile.afg"), &text, &mut catalog);
            let mut length = 0;
            for diagnostic in compiled.diagnostics.sorted() {
                length += render(diagnostic, &compiled.sources, false).len();
                json(diagnostic, &compiled.sources);
            }
            assert!(length < 3_000_000, "{name}: {length} bytes of messages");
            let took = start.elapsed();
            if took > Duration::from_secs(1) {
                println!("{name}: {took:?}");
            }
        }
    });
    let mut current = String::new();
    loop {
        match receiver.recv_timeout(GUARD) {
            Ok(name) => current = name,
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
            Err(mpsc::RecvTimeoutError::Timeout) => panic!("`{current}` takes more than {GUARD:?}"),
        }
    }
    assert!(worker.join().is_ok(), "`{current}` made the compiler panic");
}

#[test]
fn corpus() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("hostile/corpus");
    let mut texts = vec![];
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let bytes = fs::read(&path).unwrap();
        texts.push((path.display().to_string(), String::from_utf8_lossy(&bytes).into_owned()));
    }
    texts.sort();
    assert!(!texts.is_empty());
    run(texts);
}

#[test]
fn large_texts() {
    let (some, others): (Vec<_>, Vec<_>) = large::texts().into_iter().enumerate().partition(|(i, _)| i % 2 == 0);
    let half = |texts: Vec<(usize, (String, String))>| run(texts.into_iter().map(|(_, text)| text).collect());
    thread::scope(|scope| {
        scope.spawn(|| half(some));
        half(others);
    });
}

#[test]
fn random_texts() {
    run(random::texts(0..300));
}

/// A loop for long runs: `APEX_SOAK=minutes cargo test --release --test hostile soak -- --nocapture`.
#[test]
fn soak() {
    let Some(minutes) = std::env::var("APEX_SOAK").ok().and_then(|m| m.parse::<u64>().ok()) else { return };
    let (start, mut seed) = (Instant::now(), 1000);
    while start.elapsed() < Duration::from_secs(60 * minutes) {
        run(random::texts(seed..seed + 500));
        seed += 500;
        println!("{seed} seeds");
    }
}
