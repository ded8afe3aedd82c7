//! Random inputs for everything that reads files, for a given time. See `--help`.
//!
//! Each target runs in a process of its own, so that a stack overflow or a process killed because of its memory is
//! detected, too. An input depends only on the seed, the target and its number.

mod args;
mod bags;
mod catalog;
mod mutate;
mod readers;
mod recordings;
mod texts;
mod worker;

use args::{Args, HELP};
use std::{
    env, fs,
    process::{Command, ExitCode},
};
use worker::Target;

/// Constructor of a target.
pub type Make = fn() -> Box<dyn Target>;

/// All targets, by name.
pub const TARGETS: [(&str, Make); 16] = [
    ("texts", texts::texts),
    ("catalog", catalog::catalog),
    ("recordings", recordings::recordings),
    ("messages", readers::messages),
    ("g2o", readers::g2o),
    ("csv", readers::csv),
    ("scans", readers::scans),
    ("bags", bags::bags),
    ("clouds", readers::clouds),
    ("packets", readers::packets),
    ("captures", readers::captures),
    ("maps", readers::maps),
    ("plans", readers::plans),
    ("models", readers::models),
    ("params", readers::params),
    ("journals", readers::journals),
];

fn main() -> ExitCode {
    let args = match Args::parse(env::args().skip(1)) {
        Ok(Some(args)) => args,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(message) => {
            eprintln!("error: {message}\n{HELP}");
            return ExitCode::from(2);
        }
    };
    match (args.worker, &args.target) {
        (true, Some(name)) => worker::run(name, &args),
        _ => all(&args),
    }
}

/// Runs each target in a process of its own, for its share of the time.
fn all(args: &Args) -> ExitCode {
    let targets: Vec<&str> = TARGETS
        .iter()
        .map(|(name, _)| *name)
        .filter(|name| args.target.as_deref().is_none_or(|t| t == *name))
        .collect();
    let seconds = args.seconds.div_ceil(targets.len() as u64);
    let mut failed = vec![];
    for name in &targets {
        if !one(args, name, seconds) {
            failed.push(*name);
        }
    }
    match failed.is_empty() {
        true => ExitCode::SUCCESS,
        false => {
            eprintln!("failed: {}; the inputs stand in `{}`", failed.join(", "), args.out.display());
            ExitCode::FAILURE
        }
    }
}

/// Runs one target. Returns `true` if it passed, otherwise keeps the input at which its process ended.
fn one(args: &Args, name: &str, seconds: u64) -> bool {
    let program = env::current_exe().expect("a running program has a file");
    let mut command = Command::new(program);
    command.args(["--worker", "--target", name, "--seconds", &seconds.to_string(), "--seed", &args.seed.to_string()]);
    command.args(["--from", &args.from.to_string(), "--out"]).arg(&args.out);
    if let Some(count) = args.count {
        command.args(["--count", &count.to_string()]);
    }
    let status = command.status().expect("the program can be started again");
    if status.success() {
        return true;
    }
    let last = worker::last(name);
    if let Some(number) = last {
        let file = args.out.join(format!("{name}-{}-{number}", args.seed));
        let input = worker::made(name, args.seed, number);
        let kept = fs::create_dir_all(&args.out).and_then(|()| fs::write(&file, input));
        kept.unwrap_or_else(|e| eprintln!("cannot write `{}`: {e}", file.display()));
        eprintln!("{name}: {status}; again: --target {name} --seed {} --from {number} --count 1", args.seed);
    }
    let _ = fs::remove_file(worker::progress(name));
    false
}
