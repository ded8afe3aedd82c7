//! `apex graph`.

use crate::{
    project::{self, Checked},
    replace::{self, is_same},
};
use apex_diagram::{Folding, Item, MAX_ITEMS, News, chart, diagram, dot, folded, folded_states, mark_new, states, svg};
use apex_dsl::{graph::Graph, machine::Machine, report::nearest};
use clap::ValueEnum;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    str::FromStr,
};

/// Format of a picture.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Picture {
    /// For browsers and documents.
    Svg,
    /// For Graphviz.
    Dot,
}

/// Depth to which nested graphs are opened.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// All levels.
    All,
    /// This number of levels.
    Levels(usize),
}

impl FromStr for Depth {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "all" => Ok(Self::All),
            number => number.parse().map(Self::Levels).map_err(|_| "a whole number, or `all`".to_owned()),
        }
    }
}

/// Subject, format and target of a picture.
pub struct Wanted {
    /// Name of the graph or state machine.
    pub graph: Option<String>,
    /// `true` to draw the activity only.
    pub activity: bool,
    /// Depth to which nested graphs are opened. Without it, as deep as the picture stays readable.
    pub depth: Option<Depth>,
    /// Files beside which new nodes are highlighted.
    pub new_to: Vec<PathBuf>,
    /// Output file, or `None` for standard output.
    pub output: Option<PathBuf>,
    /// Format. Without it, the extension of the file decides.
    pub format: Option<Picture>,
}

/// Draws a graph or a state machine of a source file.
pub fn run(file: &Path, wanted: &Wanted) -> Result<ExitCode, String> {
    let format = format(wanted)?;
    let checked = project::check_text(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let item = match choose(&checked, file, wanted.graph.as_deref())? {
        Drawn::Graph(graph) => {
            let mut item = diagram(graph, &checked.texts.machines, &checked.catalog);
            if !highlight(&mut item, &wanted.new_to)? {
                return Ok(ExitCode::from(1));
            }
            picture(item, wanted)?
        }
        Drawn::Machine(machine) if !wanted.new_to.is_empty() => {
            return Err(format!("`{}` is a state machine, which has no nodes: `--new-to` is for graphs", machine.name));
        }
        Drawn::Machine(machine) => chart(machine),
    };
    if item.count() > MAX_ITEMS {
        return Err(format!(
            "the diagram of `{}` would have {} boxes, more than {MAX_ITEMS}: close nested graphs with `--depth 0`, or draw them one by one",
            item.name,
            item.count()
        ));
    }
    let text = match format {
        Picture::Svg => svg(&item),
        Picture::Dot => dot(&item),
    };
    match &wanted.output {
        Some(path) if is_same(path, file) => {
            return Err(format!(
                "the diagram would overwrite its source file `{}`: choose another file",
                path.display()
            ));
        }
        Some(path) => replace::write(path, &text)?,
        None => project::print(text.trim_end())?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Diagram of a graph, or of its activity, with nested graphs opened to the given depth.
fn picture(item: Item, wanted: &Wanted) -> Result<Item, String> {
    let name = item.name.clone();
    let whole = |item: Item| if wanted.activity { states(&item) } else { Some(item) };
    let drawn = match wanted.depth {
        Some(Depth::All) => whole(item),
        // Depth 0 closes the nested graphs; the graph itself is always open.
        Some(Depth::Levels(depth)) => whole(item.closed(depth.saturating_add(1))),
        None => {
            let folded = if wanted.activity { folded_states(&item) } else { Some(folded(item)) };
            folded.map(|(item, folding)| {
                say_what_is_folded(&name, &folding);
                item
            })
        }
    };
    drawn.ok_or_else(|| format!("no activity reaches a node of `{name}`: it has no `=>` and no state machine"))
}

/// Highlights what the graphs of other files lack, and says how much that is. Returns `false` if one of the files has
/// errors, which are printed.
fn highlight(item: &mut Item, files: &[PathBuf]) -> Result<bool, String> {
    if files.is_empty() {
        return Ok(true);
    }
    let mut others = vec![];
    for file in files {
        let checked = project::check(file)?;
        if checked.diagnostics.has_errors() {
            checked.print_diagnostics();
            return Ok(false);
        }
        let drawn = |graph| diagram(graph, &checked.texts.machines, &checked.catalog);
        others.extend(graphs(&checked).map(drawn));
    }
    let News { new, all } = mark_new(item, &others);
    let names: Vec<String> = files.iter().map(|file| format!("`{}`", file.display())).collect();
    let lacks = if names.len() == 1 { "does not use" } else { "do not use" };
    project::print_error(&format!("note: {new} of {all} nodes are of types that {} {lacks}", names.join(", ")));
    Ok(true)
}

fn say_what_is_folded(name: &str, folding: &Folding) {
    let depth = folding.depth.map(|depth| format!("nested graphs are closed (`--depth {depth}`)"));
    let chains = (folding.chains > 0).then(|| format!("{} chains of nodes are drawn as one box each", folding.chains));
    let said: Vec<String> = depth.into_iter().chain(chains).collect();
    if !said.is_empty() {
        let said = said.join(", ");
        project::print_error(&format!(
            "note: `{name}` is too large to be readable as a whole: {said}; `--depth all` opens all"
        ));
    }
}

/// Format from the command line, or else from the name of the file.
fn format(wanted: &Wanted) -> Result<Picture, String> {
    let path = match (wanted.format, &wanted.output) {
        (Some(format), _) => return Ok(format),
        (None, None) => return Ok(Picture::Svg),
        (None, Some(path)) => path,
    };
    match path.extension().and_then(|e| e.to_str()) {
        Some("svg") => Ok(Picture::Svg),
        Some("dot" | "gv") => Ok(Picture::Dot),
        _ => Err(format!("`{}` ends neither in .svg nor in .dot: choose the format with `--format`", path.display())),
    }
}

/// A graph or state machine that can be drawn.
#[derive(Clone, Copy)]
enum Drawn<'a> {
    Graph(&'a Graph),
    Machine(&'a Machine),
}

impl Drawn<'_> {
    fn name(&self) -> &str {
        match self {
            Self::Graph(graph) => &graph.name,
            Self::Machine(machine) => &machine.name,
        }
    }

    fn word(&self) -> &'static str {
        match self {
            Self::Graph(graph) if graph.robot => "robot",
            Self::Graph(_) => "graph",
            Self::Machine(_) => "fsm",
        }
    }
}

/// The programs without the tests.
fn programs(checked: &Checked) -> impl Iterator<Item = &Graph> {
    checked.programs.iter().filter(|program| !program.is_test()).map(|program| &program.graph)
}

/// All graphs that can be drawn.
fn graphs(checked: &Checked) -> impl Iterator<Item = &Graph> {
    checked.parts.iter().chain(programs(checked))
}

/// The named graph or state machine. Without a name: the only robot, else the only graph that is not part of another
/// one, else the only other graph, else the only state machine.
fn choose<'a>(checked: &'a Checked, file: &Path, name: Option<&str>) -> Result<Drawn<'a>, String> {
    let machines = || checked.machines().into_iter().map(Drawn::Machine);
    let all: Vec<Drawn<'_>> = graphs(checked).map(Drawn::Graph).chain(machines()).collect();
    if let Some(name) = name {
        let found = all.iter().find(|drawn| drawn.name() == name);
        return found.copied().ok_or_else(|| unknown(name, &all));
    }
    let robots = graphs(checked).filter(|graph| graph.robot).map(Drawn::Graph).collect::<Vec<_>>();
    let parts = checked.parts.iter().map(Drawn::Graph).collect();
    let kinds = [robots, programs(checked).map(Drawn::Graph).collect(), parts, machines().collect()];
    match kinds.iter().find(|kind| !kind.is_empty()).map(Vec::as_slice) {
        Some([only]) => Ok(*only),
        Some(_) => {
            Err(format!("`{}` has several graphs: choose one with `--graph NAME`; {}", file.display(), list(&all)))
        }
        None => Err("there is no graph to draw".to_owned()),
    }
}

fn unknown(name: &str, all: &[Drawn<'_>]) -> String {
    match nearest(name, all.iter().map(Drawn::name)) {
        Some(near) => format!("there is no graph `{name}` to draw; did you mean `{near}`?"),
        None if all.is_empty() => "there is no graph to draw".to_owned(),
        None => format!("there is no graph `{name}` to draw; {}", list(all)),
    }
}

fn list(all: &[Drawn<'_>]) -> String {
    let named: Vec<String> = all.iter().map(|drawn| format!("{} `{}`", drawn.word(), drawn.name())).collect();
    format!("there are {}", named.join(", "))
}
