//! Process of one target: generates inputs, runs them, and watches time and memory.

use crate::{TARGETS, args::Args, mutate::Dice};
use std::{
    env, fs,
    fs::File,
    os::unix::fs::FileExt,
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
    process::{self, ExitCode},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering::Relaxed},
    },
    thread,
    time::{Duration, Instant},
};

/// Time of the processor that an input may take: far more than any input takes, to detect loops without end. Other
/// processes on the machine do not count.
const LIMIT: Duration = Duration::from_secs(20);
/// Time by the clock that an input may take, to detect waits without end.
const WAIT: Duration = Duration::from_secs(600);
/// Maximum memory of the process, in bytes.
const MEMORY: u64 = 2 << 30;
/// Maximum number of panics that are kept.
const SHOWN: usize = 20;

/// A reader of inputs.
pub trait Target {
    /// Generates an input.
    fn make(&mut self, dice: &mut Dice) -> Vec<u8>;

    /// Reads an input.
    fn run(&mut self, input: &[u8]);
}

fn target(name: &str) -> Box<dyn Target> {
    let (_, make) = TARGETS.iter().find(|(n, _)| *n == name).expect("the command line knows the targets");
    make()
}

fn dice(name: &str, seed: u64, number: u64) -> Dice {
    let hash = name.bytes().fold(seed, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3));
    Dice::new(hash.wrapping_add(number.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
}

/// Input with this number.
pub fn made(name: &str, seed: u64, number: u64) -> Vec<u8> {
    target(name).make(&mut dice(name, seed, number))
}

/// File in which a worker writes the number of its current input.
pub fn progress(name: &str) -> PathBuf {
    env::temp_dir().join(format!("apex-fuzz-{name}"))
}

/// Number of the input at which a worker ended.
pub fn last(name: &str) -> Option<u64> {
    let bytes = fs::read(progress(name)).ok()?;
    Some(u64::from_le_bytes(bytes.try_into().ok()?))
}

/// Runs a target until the time is over.
pub fn run(name: &str, args: &Args) -> ExitCode {
    let current = Arc::new(AtomicU64::new(u64::MAX));
    watch(name.to_owned(), current.clone());
    let file = File::create(progress(name)).expect("a folder for temporary files");
    let mut target = target(name);
    let start = Instant::now();
    let end = start + Duration::from_secs(args.seconds);
    let (mut number, mut failed) = (args.from, 0);
    while Instant::now() < end && args.count.is_none_or(|count| number < args.from + count) {
        let input = target.make(&mut dice(name, args.seed, number));
        file.write_all_at(&number.to_le_bytes(), 0).expect("room for eight bytes");
        current.store(number, Relaxed);
        let ran = catch_unwind(AssertUnwindSafe(|| target.run(&input)));
        current.store(u64::MAX, Relaxed);
        if ran.is_err() {
            failed += 1;
            keep(args, name, number, &input);
            // After a panic, the state of the target may be inconsistent.
            target = self::target(name);
        }
        number += 1;
        if failed == SHOWN {
            break;
        }
    }
    drop(file);
    let _ = fs::remove_file(progress(name));
    let seconds = start.elapsed().as_secs_f64();
    let count = number - args.from;
    let (rate, most) = (count as f64 / seconds, most_memory() >> 20);
    println!("{name}: {count} inputs in {seconds:.1} s ({rate:.0} per second), {failed} failed; at most {most} MiB");
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn keep(args: &Args, name: &str, number: u64, input: &[u8]) {
    let path = args.out.join(format!("{name}-{}-{number}", args.seed));
    let kept = fs::create_dir_all(&args.out).and_then(|()| fs::write(&path, input));
    kept.unwrap_or_else(|e| eprintln!("cannot write `{}`: {e}", path.display()));
    eprintln!("{name}: input {number} panics; again: --target {name} --seed {} --from {number} --count 1", args.seed);
}

/// Ends the process if an input takes too long, or too much memory.
fn watch(name: String, current: Arc<AtomicU64>) {
    thread::spawn(move || {
        let (mut input, mut since, mut used) = (u64::MAX, Instant::now(), Duration::ZERO);
        loop {
            thread::sleep(Duration::from_millis(50));
            let now = current.load(Relaxed);
            if now != input || now == u64::MAX {
                (input, since, used) = (now, Instant::now(), processor_time());
            }
            if processor_time().saturating_sub(used) > LIMIT || since.elapsed() > WAIT {
                eprintln!("{name}: input {input} takes more than {LIMIT:?} of the processor, or {WAIT:?} in all");
                process::exit(1);
            }
            let memory = memory();
            if memory > MEMORY {
                eprintln!("{name}: input {input} takes {memory} bytes");
                process::exit(1);
            }
        }
    });
}

/// Time of the processor that this process has used, or zero if the system does not provide it.
fn processor_time() -> Duration {
    // The name of the program, in parentheses, may contain spaces.
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
    let ticks: u64 = fields.filter_map(|ticks| ticks.parse::<u64>().ok()).sum();
    Duration::from_millis(10 * ticks)
}

/// Memory of the process in bytes, or 0 if the system does not provide it.
fn memory() -> u64 {
    let text = fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: Option<u64> = text.split_whitespace().nth(1).and_then(|pages| pages.parse().ok());
    pages.unwrap_or(0) * 4096
}

/// Most memory that the process has had, in bytes, or 0 if the system does not provide it.
fn most_memory() -> u64 {
    let text = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes: Option<u64> = line.and_then(|line| line.split_whitespace().next()).and_then(|n| n.parse().ok());
    kibibytes.unwrap_or(0) * 1024
}
