//! Thread CPU times of the kernels of the library, for images and clouds, beside those of the libraries that a user
//! would take instead, from their Python wheels (`pip install "opencv-python-headless<5" numpy zxing-cpp simplejpeg
//! small_gicp scipy`): the same inputs, one thread each, in turns.
//!
//! ```text
//! cargo build --release -p apex-nodes --example kernels
//! RUSTFLAGS="-C target-cpu=native" cargo build --release -p apex-nodes --example kernels --target-dir target/native
//! target/release/examples/kernels --native target/native/release/examples/kernels
//! ```
//!
//! The second build is optional. Both builds must have the same results.

use std::{env, fs, path::PathBuf, process::ExitCode};

mod inputs;
mod kernels;
mod measure;
mod server;

use measure::median;
use server::{Answer, Server};

const USAGE: &str = "usage: kernels [--native PROGRAM] [--python PROGRAM] [--rounds N] [NAME…]

  --native PROGRAM  this program, built with `-C target-cpu=native`
  --python PROGRAM  Python with opencv-python-headless below 5, zxing-cpp, simplejpeg, small_gicp and scipy [python3]
  --rounds N        rounds, of which the medians are printed [15]
  NAME…             only the kernels whose names begin so";

/// Arguments of the command line.
struct Request {
    native: Option<PathBuf>,
    python: PathBuf,
    rounds: usize,
    names: Vec<String>,
    /// Folder of the inputs: this process answers on its standard output.
    serve: Option<PathBuf>,
}

fn main() -> ExitCode {
    match parse().and_then(|request| run(&request)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::from(2)
        }
    }
}

fn parse() -> Result<Request, String> {
    use lexopt::prelude::*;
    let mut request = Request { native: None, python: "python3".into(), rounds: 15, names: vec![], serve: None };
    let mut parser = lexopt::Parser::from_env();
    while let Some(word) = parser.next().map_err(|e| e.to_string())? {
        let text = |e: lexopt::Error| format!("{e}\n\n{USAGE}");
        match word {
            Long("native") => request.native = Some(parser.value().map_err(text)?.into()),
            Long("python") => request.python = parser.value().map_err(text)?.into(),
            Long("rounds") => request.rounds = parser.value().and_then(|n| n.parse()).map_err(text)?,
            Long("serve") => request.serve = Some(parser.value().map_err(text)?.into()),
            Value(name) => request.names.push(name.to_string_lossy().into_owned()),
            other => return Err(text(other.unexpected())),
        }
    }
    Ok(request)
}

fn run(request: &Request) -> Result<(), String> {
    if let Some(folder) = &request.serve {
        return server::serve(folder);
    }
    let folder = env::temp_dir().join(format!("apex-kernels-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    inputs::write(&folder)?;
    let table = compare(request, &folder);
    drop(fs::remove_dir_all(&folder));
    table
}

/// Prints a row for each kernel.
fn compare(request: &Request, folder: &std::path::Path) -> Result<(), String> {
    let own = env::current_exe().map_err(|e| e.to_string())?;
    let mut ours = Server::of(&own, folder)?;
    let mut native = request.native.as_ref().map(|program| Server::of(program, folder)).transpose()?;
    let mut reference = Server::of_python(&request.python, folder)?;
    println!("| kernel | reference | µs | default | native | goal |");
    println!("|---|---|--:|--:|--:|--:|");
    let wanted = |name: &str| request.names.is_empty() || request.names.iter().any(|start| name.starts_with(start));
    for (name, library, goal) in kernels::ROWS.into_iter().filter(|(name, ..)| wanted(name)) {
        let mut rounds = vec![];
        for _ in 0..request.rounds.max(1) {
            let theirs = reference.ask(name)?;
            let (our, natives) = (ours.ask(name)?, native.as_mut().map(|server| server.ask(name)).transpose()?);
            rounds.push((theirs, our, natives));
        }
        let Some((Some(_), Some(our), natives)) = rounds.first() else {
            println!("| {name} | {library} | skipped: its input is missing | | | |");
            continue;
        };
        if natives.flatten().is_some_and(|native| native.digest != our.digest) {
            return Err(format!("{name}: the results depend on the processor"));
        }
        let time = |answer: Option<Answer>| answer.map_or(f64::NAN, |answer| answer.nanoseconds);
        let theirs = median(rounds.iter().map(|(theirs, ..)| time(*theirs)));
        let default = median(rounds.iter().map(|(theirs, our, _)| time(*our) / time(*theirs)));
        let native = median(rounds.iter().map(|(theirs, _, native)| time(native.flatten()) / time(*theirs)));
        let native = if native.is_nan() { "–".to_owned() } else { format!("{native:.2}") };
        println!("| {name} | {library} | {:.0} | {default:.2} | {native} | {goal} |", theirs / 1e3);
    }
    Ok(())
}
