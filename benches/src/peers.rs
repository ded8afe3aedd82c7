//! Comparison of other frameworks with the compiled and the hand-written programs. In every round each of them runs
//! once.

mod cost;
mod plot;
mod program;
mod row;
mod table;

use crate::measure::{Round, median, ticks_in, timed};
use apex_bench::{CASES, Run, graphs::stamped, tworegion};
use program::Program;
use row::{Other, Row};
use std::{
    fs,
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    process::ExitCode,
    time::Duration,
};

/// Approximate time of each participant in a round.
const ROUND: Duration = Duration::from_millis(2);

/// Subjects and outputs of a comparison.
#[derive(clap::Args)]
pub struct Arguments {
    /// Run only the graphs whose names begin with one of these.
    graphs: Vec<String>,
    /// Run a fifth of the rounds.
    #[arg(long)]
    quick: bool,
    /// Write the tables as Markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Draw the ratios as an SVG file.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

/// A graph with its programs in this executable.
struct Graph {
    name: &'static str,
    hand: Run,
    apex: Option<Run>,
    stamped: Option<Run>,
}

/// Measures and prints all comparisons.
pub fn run(arguments: &Arguments) -> Result<ExitCode, String> {
    let (mut programs, missing) = program::all();
    let chosen = |name: &str| arguments.graphs.is_empty() || arguments.graphs.iter().any(|g| name.starts_with(g));
    let has = |name: &str| programs.iter().any(|program| program.peers_of(name).next().is_some());
    let graphs: Vec<Graph> = all_graphs().into_iter().filter(|g| has(g.name) && chosen(g.name)).collect();
    let rounds = if arguments.quick { 21 } else { 101 };
    let mut rows = vec![];
    for (i, graph) in graphs.iter().enumerate() {
        progress(&format!("{} ({} of {})", graph.name, i + 1, graphs.len()));
        rows.push(race(graph, &mut programs, rounds)?);
    }
    drop(programs);
    progress("instructions, allocations, sizes");
    let costs = cost::all(graphs.iter().map(|g| g.name))?;
    progress("");
    print!("{}", table::text(&rows, &costs, &missing));
    let write = |path: &Option<PathBuf>, text: String| path.as_ref().map_or(Ok(()), |path| write(path, text));
    write(&arguments.markdown, table::markdown(&rows, &costs, &missing))?;
    write(&arguments.svg, plot::svg(&rows))?;
    let all_equal = rows.iter().flat_map(|row| &row.others).all(|other| other.equal);
    Ok(ExitCode::from(u8::from(!all_equal)))
}

fn write(path: &Path, text: String) -> Result<(), String> {
    fs::write(path, text).map_err(|e| format!("cannot write `{}`: {e}", path.display()))
}

/// Prints the current activity in one line, on terminals only.
fn progress(what: &str) {
    if io::stderr().is_terminal() {
        eprint!("\r\x1b[K{what}");
    }
}

/// All graphs that a framework may have.
fn all_graphs() -> Vec<Graph> {
    const STAMPED: [(&str, Run); 6] = [
        ("chain3", stamped::chain3),
        ("chain10", stamped::chain10),
        ("chain100", stamped::chain100),
        ("diamond8", stamped::diamond8),
        ("bot100", stamped::bot100),
        ("throttle", stamped::throttle),
    ];
    let stamped = |name| STAMPED.iter().find(|(graph, _)| *graph == name).map(|(_, run)| *run);
    let mut graphs: Vec<Graph> = CASES
        .iter()
        .map(|case| Graph { name: case.name, hand: case.hand, apex: Some(case.apex), stamped: stamped(case.name) })
        .collect();
    // `apex-bench threads` measures the compiled one, whose regions wait for each other.
    graphs.push(Graph { name: "tworegion", hand: tworegion::hand, apex: None, stamped: None });
    graphs
}

/// Executable of a participant.
enum Place {
    /// In this executable.
    Here(Run),
    /// In the executable with this index.
    There(usize),
}

/// A participant of every round.
struct Runner {
    name: String,
    place: Place,
    ticks: u64,
    /// Checksum of the hand-written program after the same number of ticks.
    expected: u64,
    ratios: Vec<f64>,
    equal: bool,
}

impl Runner {
    fn new(name: &str, place: Place, graph: &Graph, programs: &mut [Program]) -> Result<Self, String> {
        let (name, ratios) = (name.to_owned(), vec![]);
        let mut runner = Self { name, place, ticks: 0, expected: 0, ratios, equal: true };
        let ticks = ticks_in(ROUND, |ticks| {
            runner.ticks = ticks;
            runner.run(graph, programs)
        })?;
        runner.ticks = ticks;
        runner.expected = (graph.hand)(ticks);
        Ok(runner)
    }

    fn run(&self, graph: &Graph, programs: &mut [Program]) -> Result<Round, String> {
        match self.place {
            Place::Here(run) => Ok(timed(run, self.ticks)),
            Place::There(program) => programs[program].run(graph.name, &self.name, self.ticks),
        }
    }
}

fn runners(graph: &Graph, programs: &mut [Program]) -> Result<Vec<Runner>, String> {
    let here = [("apex", graph.apex), ("apex-stamped", graph.stamped)];
    let here = here.into_iter().filter_map(|(name, run)| Some((name.to_owned(), Place::Here(run?))));
    let there = programs
        .iter()
        .enumerate()
        .flat_map(|(i, program)| program.peers_of(graph.name).map(move |peer| (peer.to_owned(), Place::There(i))));
    let all: Vec<_> = here.chain(there).collect();
    all.into_iter().map(|(name, place)| Runner::new(&name, place, graph, programs)).collect()
}

/// All rounds of a graph. The first participant changes from round to round.
fn race(graph: &Graph, programs: &mut [Program], rounds: usize) -> Result<Row, String> {
    let mut runners = runners(graph, programs)?;
    let ticks = ticks_in(ROUND, |ticks| Ok::<_, String>(timed(graph.hand, ticks)))?;
    let mut hand = vec![];
    for round in 0..rounds {
        let hand_ns = timed(graph.hand, ticks).ns;
        hand.push(hand_ns);
        let first = round % runners.len();
        runners.rotate_left(first);
        for runner in &mut runners {
            let Round { ns, checksum } = runner.run(graph, programs)?;
            runner.ratios.push(ns / hand_ns);
            runner.equal &= checksum == runner.expected;
        }
    }
    let other = |mut r: Runner| Other { name: r.name, ratio: median(&mut r.ratios), equal: r.equal };
    let mut others: Vec<Other> = runners.into_iter().map(other).collect();
    others.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    Ok(Row { graph: graph.name, hand_ns: median(&mut hand), others })
}
