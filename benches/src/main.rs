//! `cargo run --release -p apex-bench`: compiled graphs against hand-written Rust.

mod compile;
mod instructions;
mod measure;
mod on_threads;
mod peers;
mod report;

use apex_bench::CASES;
use clap::{Parser, Subcommand};
use report::Report;
use std::{fs, path::PathBuf, process::ExitCode, time::Duration};

/// Compare compiled graphs with the same work written by hand.
#[derive(Parser)]
#[command(
    name = "apex-bench",
    after_help = "Exit codes: 0 all checksums are equal, 1 some are not, 2 something could not be measured.\n\
                  A missed goal is no failure: times depend on what else the machine does."
)]
struct Arguments {
    /// Run only the graphs whose names begin with one of these.
    graphs: Vec<String>,
    /// Run a fifth of the rounds.
    #[arg(long)]
    quick: bool,
    /// Write the results as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the table as Markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Count instructions per tick (with valgrind): the same on every run.
    Instructions,
    /// Measure the costs of compilation: `apex check`, a rebuild after an edit, large graphs of one kind.
    Compile,
    /// Also measure other frameworks, which are built from `benches/peers`.
    Peers(peers::Arguments),
    /// Measure programs on two threads: their speedup, and the time that a token takes to the other thread.
    Threads {
        /// Run a fifth of the rounds.
        #[arg(long)]
        quick: bool,
    },
    /// Run ticks of one program of a graph (counted by `instructions`).
    #[command(hide = true)]
    Ticks { graph: String, side: instructions::Side, ticks: u64 },
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.command {
        None => times(&arguments),
        Some(Command::Instructions) => instructions::run(),
        Some(Command::Compile) => compile::run(),
        Some(Command::Peers(arguments)) => peers::run(arguments),
        Some(Command::Threads { quick }) => on_threads::run(*quick),
        Some(Command::Ticks { graph, side, ticks }) => instructions::ticks(graph, *side, *ticks),
    };
    result.unwrap_or_else(|message| {
        eprintln!("error: {message}");
        ExitCode::from(2)
    })
}

fn times(arguments: &Arguments) -> Result<ExitCode, String> {
    let effort = measure::Effort { rounds: if arguments.quick { 21 } else { 101 }, round: Duration::from_millis(2) };
    let chosen =
        |name: &str| arguments.graphs.is_empty() || arguments.graphs.iter().any(|g| name.starts_with(g.as_str()));
    let rows: Vec<_> = CASES.iter().filter(|c| chosen(c.name)).map(|case| measure::compare(case, effort)).collect();
    if rows.is_empty() {
        let names: Vec<_> = CASES.iter().map(|c| c.name).collect();
        return Err(format!("no graph has such a name; there are {}", names.join(", ")));
    }
    let report = Report::new(rows, report::skipped(effort));
    print!("{}", report.text());
    let write = |path: &Option<PathBuf>, text: String| match path {
        Some(path) => fs::write(path, text).map_err(|e| format!("cannot write `{}`: {e}", path.display())),
        None => Ok(()),
    };
    write(&arguments.json, report.json()?)?;
    write(&arguments.markdown, report.markdown())?;
    Ok(ExitCode::from(u8::from(!report.all_equal())))
}
