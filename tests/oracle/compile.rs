//! Compiles source files into one program and runs it.

use apex_tests::Libraries;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::LazyLock,
    thread,
};

/// A source file with the name of its program.
pub struct Program {
    /// Name of the program.
    pub name: String,
    /// Content of the source file.
    pub text: String,
}

/// Minimum number of programs in a crate, because linking a crate takes time.
const LEAST: usize = 20;

const MAIN: &str = r##"use apex_rt::{prelude::*, record::{Recorder, Tap, WhenFull, replay}};
use apex_tests::oracle::{note, run_unevenly, take_notes};

GRAPHS

#[derive(Clone)]
struct Notes;

impl Observer for Notes {
    fn fired(&mut self, node: usize) {
        note(format_args!("F {node}"));
    }
    fn handled(&mut self, connection: usize) {
        note(format_args!("H {connection}"));
    }
    fn activity(&mut self, node: usize, active: bool) {
        note(format_args!("A {node} {}", u8::from(active)));
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        note(format_args!("endless: {nodes:?} {counts:?}"));
    }
}

const REACTIONS: i64 = 10;

fn time(reaction: i64) -> Time {
    Time::from_nanos(reaction * 1_000_000)
}

fn observe<P: Program>(new: fn() -> P, how: &str) {
    match how {
        WAYS
        _ => unreachable!("it was not asked for"),
    }
}

fn in_turn<P: Program>(new: fn() -> P) {
    once(new(), |program, now| drop(program.react_with(now, &mut Notes)));
}

fn on_threads<P: Program>(new: fn() -> P) {
    once(new(), |program, now| drop(apex_rt::threads::react_on_threads(program, now, |_| Notes)));
}

fn once<P: Program>(mut program: P, react: impl Fn(&mut P, Time)) {
    for reaction in 0..REACTIONS {
        let now = time(reaction);
        note(format_args!("R {}", now.as_nanos()));
        react(&mut program, now);
        note(format_args!("E"));
    }
    println!("{}# end", take_notes());
}

/// Records a run and replays it: the same nodes fire, the same slots are served.
fn again<P: Program>(new: fn() -> P) {
    let steps = || take_notes().lines().filter(|line| !line.starts_with('T')).map(str::to_owned).collect::<Vec<_>>();
    let path = std::env::temp_dir().join(format!("apex-oracle-{}-{}.mcap", std::process::id(), P::INFO.name));
    let mut tap = Tap::Record(Recorder::to_file::<P>(&path, WhenFull::Wait).expect("a new file"));
    let mut program = new();
    for reaction in 0..REACTIONS {
        program.react_with(time(reaction), &mut (Notes, &mut tap));
    }
    let Tap::Record(recorder) = tap else { unreachable!("it records") };
    recorder.finish().expect("room for the file");
    let first = steps();
    let report = replay(new(), &path, Notes);
    let second = steps();
    let _ = std::fs::remove_file(&path);
    match report {
        Ok(report) if !report.is_same() || !report.is_whole() => println!("the replay differs: {report}"),
        Ok(_) => {}
        Err(error) => println!("it cannot be replayed: {error}"),
    }
    compare(&first, &second);
    println!("# end");
}

/// Runs a program in time, and with reactions that are late.
fn late<P: Program>(new: fn() -> P) {
    let steps = |reactions: &[i64]| {
        let mut program = new();
        reactions.iter().for_each(|reaction| drop(program.react_with(time(*reaction), &mut Notes)));
        take_notes().lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let in_time = steps(&(0..REACTIONS).collect::<Vec<_>>());
    for reactions in [&[0, REACTIONS - 1][..], &[0, 2, 3, 7, REACTIONS - 1]] {
        compare(&in_time, &steps(reactions));
    }
    println!("# end");
}

/// Says where a second run differs from a first one.
fn compare(first: &[String], second: &[String]) {
    if first != second {
        let same = first.iter().zip(second).take_while(|(a, b)| a == b).count();
        println!("step {same} of {}: {:?} was {:?}", first.len(), second.get(same), first.get(same));
    }
}

fn main() {
    let how = std::env::args().nth(1).unwrap_or_default();
    if how == "on_threads" {
        run_unevenly();
    }
    RUNS
}
"##;

/// Execution of a program with several thread groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// The groups in sequence, on one thread.
    InTurn,
    /// Each group on a thread of its own.
    OnThreads,
    /// The groups in sequence, recorded and replayed. The record is the difference between both runs.
    Again,
    /// In time, and with late reactions. The record is the difference between the runs.
    Late,
}

impl How {
    /// Name of the function that runs a program so.
    fn function(self) -> &'static str {
        match self {
            How::InTurn => "in_turn",
            How::OnThreads => "on_threads",
            How::Again => "again",
            How::Late => "late",
        }
    }
}

/// Programs that are compiled together.
struct Part<'a> {
    programs: &'a [Program],
    /// Ways in which they are run: rustc makes code of each program for each of them.
    ways: &'a [How],
    file: PathBuf,
}

/// Runs programs. Returns, for each way to run them, the record of each program.
///
/// # Errors
/// Fails if they cannot be compiled, or if one of them does not end.
pub fn run(folder: &str, programs: &[Program], ways: &[How]) -> Result<Vec<Vec<String>>, String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    // Other tests wait while one compiles the libraries.
    static LIBRARIES: LazyLock<Libraries> = LazyLock::new(|| Libraries::ask(Path::new(env!("CARGO_TARGET_TMPDIR"))));
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let parts = thread::available_parallelism().map_or(1, usize::from);
    let size = programs.len().div_ceil(parts).max(LEAST);
    let run = |(number, programs): (usize, &[Program])| {
        let part = Part { programs, ways, file: folder.join(format!("part{number}")) };
        part.compile(&LIBRARIES)?;
        ways.iter().map(|how| part.run(*how)).collect::<Result<Vec<_>, String>>()
    };
    let ran: Vec<Result<_, String>> = thread::scope(|scope| {
        let running: Vec<_> = programs.chunks(size).enumerate().map(|part| scope.spawn(move || run(part))).collect();
        running.into_iter().map(|part| part.join().expect("no part panics")).collect()
    });
    let mut records = vec![vec![]; ways.len()];
    for part in ran {
        records.iter_mut().zip(part?).for_each(|(all, of_part)| all.extend(of_part));
    }
    Ok(records)
}

impl Part<'_> {
    fn compile(&self, libraries: &Libraries) -> Result<(), String> {
        let (mut graphs, mut runs) = (String::new(), String::new());
        for Program { name, text } in self.programs {
            let file = self.file.with_file_name(name).with_extension("afg");
            write(&file, text)?;
            let module = name.to_lowercase();
            graphs.push_str(&format!(
                "mod {module} {{\n    use apex_rt::prelude::*;\n    apex_macros::graph!({file:?});\n}}\n"
            ));
            runs.push_str(&format!("observe({module}::{name}::new, &how);\n    "));
        }
        let ways: String =
            self.ways.iter().map(|how| how.function()).map(|f| format!("{f:?} => {f}(new),\n        ")).collect();
        let source = self.file.with_extension("rs");
        write(&source, &MAIN.replace("GRAPHS", &graphs).replace("WAYS", &ways).replace("RUNS", &runs))?;
        // The graphs have access to the crates of this test.
        let mut rustc = libraries.rustc(Path::new(env!("CARGO_MANIFEST_DIR")), "oracle");
        rustc.args(["-C", "codegen-units=1", "--cap-lints", "allow", "-o"]).args([&self.file, &source]);
        let built = rustc.output().map_err(|e| format!("cannot run rustc: {e}"))?;
        match built.status.success() {
            true => Ok(()),
            false => Err(format!("it does not compile:\n{}", String::from_utf8_lossy(&built.stderr))),
        }
    }

    /// The record of each program.
    fn run(&self, how: How) -> Result<Vec<String>, String> {
        let ran = Command::new(&self.file)
            .arg(how.function())
            .output()
            .map_err(|e| format!("cannot run the program: {e}"))?;
        let text = String::from_utf8_lossy(&ran.stdout);
        let records: Vec<String> = text.split_inclusive("# end\n").map(|t| t.replace("# end\n", "")).collect();
        if ran.status.success() && records.len() == self.programs.len() {
            return Ok(records);
        }
        let at = text.matches("# end\n").count().min(self.programs.len() - 1);
        let (name, said) = (&self.programs[at].name, String::from_utf8_lossy(&ran.stderr));
        Err(format!("it does not run to its end ({name}.afg, {how:?}): {said}"))
    }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|e| format!("cannot write `{}`: {e}", path.display()))
}
