//! Executables with graphs in other frameworks. First an executable writes a line `graph peer` for each of its peers,
//! and an empty line. To each line `graph peer ticks` it answers `nanoseconds checksum`.

use crate::measure::Round;
use std::{
    env,
    io::{self, BufRead, BufReader, IsTerminal, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
};

/// A process that waits for requests.
pub struct Program {
    child: Child,
    /// Standard input; closing it ends the process.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    /// Pairs of graph and peer.
    peers: Vec<(String, String)>,
}

/// All executables that can be built here, and a message for each of the others.
pub fn all() -> (Vec<Program>, Vec<String>) {
    let (mut programs, mut missing) = (vec![], vec![]);
    for (peers, program) in [("all peers in Rust", rust()), ("tbb-1", tbb())] {
        match program {
            Ok(program) => programs.push(program),
            Err(why) => missing.push(format!("{peers}: {why}")),
        }
    }
    (programs, missing)
}

/// Starts the executable with the peers in Rust.
fn rust() -> Result<Program, String> {
    let quiet = if io::stderr().is_terminal() { None } else { Some("--quiet") };
    let mut command = Command::new(env!("CARGO"));
    command.args(["run", "--release", "--manifest-path"]).arg(folder().join("Cargo.toml"));
    command.arg("--target-dir").arg(build_folder()?).args(quiet);
    Program::start(&mut command).map_err(|why| format!("{why}; does `cargo build` in benches/peers succeed?"))
}

/// Starts the executable with oneTBB.
fn tbb() -> Result<Program, String> {
    const HEADER: &str = "tbb/flow_graph.h";
    let compiler = || Command::new("c++");
    let preprocessed = compiler().args(["-E", "-x", "c++", "-include", HEADER, "/dev/null"]).output();
    let found = preprocessed.map_err(|e| format!("cannot run the C++ compiler `c++`: {e}"))?.status.success();
    if !found {
        return Err(format!("`c++` does not find <{HEADER}>; Debian has it in libtbb-dev: apt-get install libtbb-dev"));
    }
    let program = build_folder()?.join("tbb");
    let mut compile = compiler();
    compile.args(["-O2", "-std=c++17", "-o"]).arg(&program).arg(folder().join("cpp/tbb.cpp")).arg("-ltbb");
    match compile.status() {
        Ok(status) if status.success() => Program::start(&mut Command::new(program)),
        _ => Err("`c++` cannot compile benches/peers/cpp/tbb.cpp".to_owned()),
    }
}

/// Folder with the sources of the executables.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("peers")
}

/// Target folder of the executables: beside the profiles of this package's own build.
fn build_folder() -> Result<PathBuf, String> {
    let own = env::current_exe().map_err(|e| e.to_string())?;
    let target = own.ancestors().nth(2).ok_or("this program is in no folder of a build")?;
    let folder = target.join("peers");
    std::fs::create_dir_all(&folder).map_err(|e| format!("cannot make `{}`: {e}", folder.display()))?;
    Ok(folder)
}

impl Program {
    fn start(command: &mut Command) -> Result<Self, String> {
        let name = command.get_program().to_string_lossy().into_owned();
        let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = child.map_err(|e| format!("cannot run `{name}`: {e}"))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(format!("`{name}` cannot be talked to"));
        };
        let mut program = Self { child, input: Some(input), output: BufReader::new(output), peers: vec![] };
        loop {
            let line = program.line()?;
            let Some((graph, peer)) = line.split_once(' ') else { return Ok(program) };
            program.peers.push((graph.to_owned(), peer.to_owned()));
        }
    }

    /// Names of the peers that have `graph`.
    pub fn peers_of(&self, graph: &str) -> impl Iterator<Item = &str> {
        self.peers.iter().filter(move |(name, _)| name == graph).map(|(_, peer)| peer.as_str())
    }

    /// Runs ticks of a graph from the beginning.
    pub fn run(&mut self, graph: &str, peer: &str, ticks: u64) -> Result<Round, String> {
        let failed = |why: &str| format!("`{peer}` did not run {ticks} ticks of `{graph}`: {why}");
        let input = self.input.as_mut().ok_or("the program was told to end")?;
        writeln!(input, "{graph} {peer} {ticks}").map_err(|e| failed(&e.to_string()))?;
        let line = self.line().map_err(|why| failed(&why))?;
        let answer =
            line.split_once(' ').and_then(|(ns, checksum)| Some((ns.parse::<f64>().ok()?, checksum.parse().ok()?)));
        let (ns, checksum) = answer.ok_or_else(|| failed(&format!("it answered `{line}`")))?;
        Ok(Round { ns: ns / ticks as f64, checksum })
    }

    fn line(&mut self) -> Result<String, String> {
        let mut line = String::new();
        match self.output.read_line(&mut line) {
            Ok(0) => Err("it ended".to_owned()),
            Ok(_) => Ok(line.trim_end().to_owned()),
            Err(e) => Err(e.to_string()),
        }
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        self.input = None;
        let _ = self.child.wait();
    }
}
