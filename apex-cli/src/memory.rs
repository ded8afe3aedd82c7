//! `apex explain --memory`: sizes of the parts of a program in bytes. Only rustc knows the sizes of types, so a program
//! that prints them is built and run.

use crate::{
    answer::Answer,
    build::{self, How, Turn},
    made::{self, Made},
    project, run,
};
use apex_dsl::{checked::CheckedProgram, codegen::Piece, passes};
use apex_host::Workspace;
use serde_json::{Value, json};
use std::{
    fmt::Write as _,
    path::Path,
    process::{ExitCode, Stdio},
};

/// A program with the sizes of its parts.
struct Measured<'a> {
    program: &'a CheckedProgram,
    bytes: usize,
    /// Purpose, owner and size in bytes of each part.
    pieces: Vec<(&'static str, String, usize)>,
}

/// Prints the size of each program of a source file, part by part.
pub fn run(file: &Path, answer: &mut Answer) -> Result<ExitCode, String> {
    let mut checked = project::check(file)?;
    let programs: Vec<&CheckedProgram> = checked.programs.iter().filter(|p| !p.is_test()).collect();
    let of_all = passes::memory(programs.iter().copied(), &checked.catalog, &checked.sources, &mut checked.diagnostics);
    answer.messages(&checked.diagnostics, &checked.sources);
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    if programs.is_empty() && !answer.is_json() {
        project::print(&format!("`{}` has no graph whose parameters all have values", file.display()))?;
    }
    let measured = if programs.is_empty() { vec![] } else { measure(file, &programs, of_all)? };
    if measured.is_empty() && !answer.is_json() {
        return Ok(ExitCode::SUCCESS);
    }
    let values = || measured.iter().map(Measured::json).collect::<Vec<Value>>();
    answer.give(|| measured.iter().map(Measured::text).collect(), || json!({ "programs": values() }))?;
    Ok(ExitCode::SUCCESS)
}

/// Builds and runs a program that prints one size per line: for each graph its own size, then those of its parts.
fn measure<'a>(
    file: &Path,
    programs: &[&'a CheckedProgram],
    of_all: Vec<Vec<Piece>>,
) -> Result<Vec<Measured<'a>>, String> {
    let workspace = Workspace::load(&run::package(file)?)?;
    let text = run::absolute(file)?;
    let made = Made {
        workspace: &workspace,
        what: "memory",
        text: &text,
        program: "",
        features: &[],
        tools: &[],
        file: "src/main.rs",
        code: &main_file(made::utf8(&text)?, programs, &of_all),
    };
    let how = How::new(false, false);
    let _turn = Turn::wait(&workspace, how)?;
    let built = build::build(&made.make()?, build::PROGRAM, how)?.program()?;
    let unknown = || format!("rustc rejects the program of `{}`: its sizes are unknown", file.display());
    let built = built.ok_or_else(unknown)?;
    let output = built.command().stderr(Stdio::inherit()).output().map_err(|e| built.not_started(&e))?;
    let said = String::from_utf8_lossy(&output.stdout);
    let mut sizes = said.lines().map_while(|line| line.parse().ok());
    let measured = programs.iter().zip(of_all).map(|(program, pieces)| {
        let mut measured = Measured { program, bytes: sizes.next()?, pieces: vec![] };
        for piece in pieces {
            measured.add(piece.what, piece.of, sizes.next()?);
        }
        Some(measured)
    });
    let measured: Option<Vec<Measured<'_>>> = measured.collect();
    measured.ok_or_else(|| format!("the program of `{}` did not report all sizes", file.display()))
}

/// Code of the program. It contains the graphs, so that it can access their private parts.
fn main_file(file: &str, programs: &[&CheckedProgram], of_all: &[Vec<Piece>]) -> String {
    let mut lines = String::new();
    for (program, pieces) in programs.iter().zip(of_all) {
        let name = &program.graph.name;
        let _ = writeln!(lines, "    println!(\"{{}}\", size_of::<{name}>());");
        for piece in pieces {
            let _ = writeln!(lines, "    println!(\"{{}}\", size::<{name}, _>(|program| &program.{}));", piece.place);
        }
    }
    format!(
        r"#![allow(dead_code)]

apex_macros::graph!({file:?});

fn main() {{
    fn size<P, T>(_: fn(&P) -> &T) -> usize {{
        size_of::<T>()
    }}
{lines}}}
"
    )
}

impl Measured<'_> {
    /// Adds a part; parts with equal purpose and owner become one.
    fn add(&mut self, what: &'static str, of: String, bytes: usize) {
        match self.pieces.iter_mut().find(|piece| (piece.0, &piece.1) == (what, &of)) {
            Some(piece) => piece.2 += bytes,
            None => self.pieces.push((what, of, bytes)),
        }
    }

    /// Number of bytes between the parts, which the compiler inserts for alignment.
    fn padding(&self) -> usize {
        self.bytes.saturating_sub(self.pieces.iter().map(|piece| piece.2).sum())
    }

    fn text(&self) -> String {
        let kind = if self.program.graph.robot { "robot" } else { "graph" };
        let mut text = format!("{kind} {}: {} bytes\n", self.program.graph.name, self.bytes);
        for group in self.pieces.chunk_by(|a, b| a.0 == b.0) {
            let sum: usize = group.iter().map(|piece| piece.2).sum();
            let _ = writeln!(text, "{sum:>8}  {}", group[0].0);
            for (_, of, bytes) in group {
                let _ = writeln!(text, "{bytes:>12}  {of}");
            }
        }
        let _ = writeln!(text, "{:>8}  padding", self.padding());
        text
    }

    fn json(&self) -> Value {
        let pieces: Vec<Value> =
            self.pieces.iter().map(|(what, of, bytes)| json!({ "what": what, "of": of, "bytes": bytes })).collect();
        json!({ "name": self.program.graph.name, "bytes": self.bytes, "pieces": pieces, "padding": self.padding() })
    }
}
