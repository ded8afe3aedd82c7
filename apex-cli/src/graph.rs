//! `apex graph`.

use crate::project;
use apex_diagram::{MAX_ITEMS, diagram, dot, states, svg};
use apex_dsl::passes::Program;
use clap::ValueEnum;
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// What a picture is written as.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Picture {
    /// For browsers and documents.
    Svg,
    /// For Graphviz.
    Dot,
}

/// What is drawn, and where to.
pub struct Wanted {
    /// The graph, if the text has several.
    pub graph: Option<String>,
    /// The activity alone.
    pub activity: bool,
    /// The file; standard output if there is none.
    pub output: Option<PathBuf>,
    /// What it is written as, if the name of the file does not say so.
    pub format: Option<Picture>,
}

/// Draws a graph of a text.
pub fn run(file: &Path, wanted: &Wanted) -> Result<ExitCode, String> {
    let format = format(wanted)?;
    let checked = project::check(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let program = choose(&checked.programs, wanted.graph.as_deref())?;
    let mut item = diagram(&program.graph, &checked.catalog);
    if wanted.activity {
        item = states(&item).ok_or_else(|| {
            format!("no activity comes to a node of `{}`: it has no `=>` and no state machine", program.graph.name)
        })?;
    }
    if item.count() > MAX_ITEMS {
        let name = &program.graph.name;
        return Err(format!(
            "a picture of `{name}` would have {} boxes, more than {MAX_ITEMS}: draw the graphs in it one by one",
            item.count()
        ));
    }
    let text = match format {
        Picture::Svg => svg(&item),
        Picture::Dot => dot(&item),
    };
    match &wanted.output {
        Some(path) => fs::write(path, text).map_err(|e| format!("cannot write `{}`: {e}", path.display()))?,
        None => project::print(text.trim_end()),
    }
    Ok(ExitCode::SUCCESS)
}

/// What the command line says, or else the name of the file.
fn format(wanted: &Wanted) -> Result<Picture, String> {
    let path = match (wanted.format, &wanted.output) {
        (Some(format), _) => return Ok(format),
        (None, None) => return Ok(Picture::Svg),
        (None, Some(path)) => path,
    };
    match path.extension().and_then(|e| e.to_str()) {
        Some("svg") => Ok(Picture::Svg),
        Some("dot" | "gv") => Ok(Picture::Dot),
        _ => Err(format!("`{}` ends neither in .svg nor in .dot: say which with `--format`", path.display())),
    }
}

/// The named graph, the only robot, or the last graph.
fn choose<'a>(programs: &'a [Program], name: Option<&str>) -> Result<&'a Program, String> {
    let programs: Vec<&Program> = programs.iter().filter(|p| p.script.is_none()).collect();
    let robots: Vec<&&Program> = programs.iter().filter(|p| p.graph.robot).collect();
    let chosen = match (name, robots.as_slice()) {
        (Some(name), _) => programs.iter().find(|p| p.graph.name == name),
        (None, [only]) => Some(*only),
        (None, _) => programs.last(),
    };
    let names: Vec<String> = programs.iter().map(|p| format!("`{}`", p.graph.name)).collect();
    chosen.copied().ok_or_else(|| match name {
        Some(name) => format!("there is no graph `{name}` to draw; there are {}", names.join(", ")),
        None => "there is no graph to draw: parameters of the graphs have no value".to_owned(),
    })
}
