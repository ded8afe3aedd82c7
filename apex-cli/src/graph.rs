//! `apex graph`.

use crate::{
    project::{self, Checked},
    replace::{self, is_same},
};
use apex_diagram::{MAX_ITEMS, diagram, dot, states, svg};
use apex_dsl::{graph::Graph, report::nearest};
use clap::ValueEnum;
use std::{
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
    /// How deep nested graphs are opened.
    pub depth: Option<usize>,
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
    let graph = choose(&checked, wanted.graph.as_deref())?;
    let mut item = diagram(graph, &checked.catalog);
    if let Some(depth) = wanted.depth {
        // The graph itself is always open.
        item = item.closed(depth.saturating_add(1));
    }
    if wanted.activity {
        item = states(&item).ok_or_else(|| {
            format!("no activity comes to a node of `{}`: it has no `=>` and no state machine", graph.name)
        })?;
    }
    if item.count() > MAX_ITEMS {
        return Err(format!(
            "a picture of `{}` would have {} boxes, more than {MAX_ITEMS}: close those in it with `--depth 0`, or draw them one by one",
            graph.name,
            item.count()
        ));
    }
    let text = match format {
        Picture::Svg => svg(&item),
        Picture::Dot => dot(&item),
    };
    match &wanted.output {
        Some(path) if is_same(path, file) => {
            return Err(format!("the picture would overwrite its text `{}`: name another file", path.display()));
        }
        Some(path) => replace::write(path, &text)?,
        None => project::print(text.trim_end())?,
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

/// The named graph, the only robot, or the last graph that stands in no other one.
fn choose<'a>(checked: &'a Checked, name: Option<&str>) -> Result<&'a Graph, String> {
    let programs = checked.programs.iter().filter(|p| p.script.is_none()).map(|p| &p.graph);
    let graphs: Vec<&Graph> = checked.parts.iter().chain(programs).collect();
    let robots: Vec<&&Graph> = graphs.iter().filter(|graph| graph.robot).collect();
    let chosen = match (name, robots.as_slice()) {
        (Some(name), _) => graphs.iter().find(|graph| graph.name == name),
        (None, [only]) => Some(*only),
        (None, _) => graphs.last(),
    };
    chosen.copied().ok_or_else(|| {
        let Some(name) = name else { return "there is no graph to draw".to_owned() };
        let names = || graphs.iter().map(|graph| graph.name.as_str());
        match nearest(name, names()) {
            Some(near) => format!("there is no graph `{name}` to draw; did you mean `{near}`?"),
            None => {
                let known: Vec<String> = names().map(|name| format!("`{name}`")).collect();
                format!("there is no graph `{name}` to draw; there are {}", known.join(", "))
            }
        }
    })
}
