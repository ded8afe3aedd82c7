//! The `apex` command, a thin layer over the compiler.

mod build;
mod calls;
mod check;
mod completions;
mod doc;
mod expand;
mod explain;
mod fix;
mod fmt;
mod graph;
mod import;
mod lsp;
mod made;
mod memory;
mod new;
mod nodes;
mod project;
mod replace;
mod run;
mod test;
mod texts;
mod times;
mod watch;

use clap::{Parser, Subcommand, ValueEnum};
use std::{path::PathBuf, process::ExitCode};

/// Robot behaviour as text, compiled to a static program.
#[derive(Parser)]
#[command(
    name = "apex",
    version,
    after_help = "Exit codes: 0 fine, 1 the text has errors, 2 the command could not be carried out."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Check source files and report errors.
    #[command(
        after_help = "--fix makes the changes of which there is no doubt, and says which; those that are guesses are shown as ever.\nExit code 0: no error is left.\n\nExample:\n  apex check robots/patsy/patsy.afg\n  apex check --format json robot.afg\n  apex check --fix robot.afg"
    )]
    Check {
        /// Source files; a folder stands for all `.afg` files below it.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// Format of the output.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        /// Apply unambiguous fixes.
        #[arg(long)]
        fix: bool,
    },
    /// Print the completion script of a shell.
    #[command(after_help = "Example:\n  apex completions bash > ~/.local/share/bash-completion/completions/apex")]
    Completions {
        /// Shell.
        shell: clap_complete::Shell,
    },
    /// Write pages about graphs and nodes, with diagrams.
    #[command(
        after_help = "Texts that are imported get pages too, and so do the nodes that are used. The pages are HTML and need nothing else.\nA folder with other things in it is refused. If a text has errors, nothing is written.\n\nExample:\n  apex doc robot.afg\n  apex doc robots --output pages"
    )]
    Doc {
        /// Source files; a folder stands for all `.afg` files below it.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// Folder for the pages [default: `apex/doc` in the target folder of the package].
        #[arg(short, long, value_name = "FOLDER")]
        output: Option<PathBuf>,
    },
    /// Format source files in the style of the language.
    #[command(
        after_help = "Texts with errors are left alone. Exit code 1: one has errors, or would be changed by what --check leaves undone.\n\nExample:\n  apex fmt robots\n  apex fmt --check robots/patsy/patsy.afg\n  apex fmt - < robot.afg"
    )]
    Fmt {
        /// Source files; a folder stands for all `.afg` files below it, `-` for standard input, which is formatted to
        /// standard output.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// Change no file; show the first difference of each file.
        #[arg(long)]
        check: bool,
    },
    /// Print the Rust code to which a source file is compiled.
    Expand {
        /// Source file.
        file: PathBuf,
    },
    /// Print the decisions of the compiler about a source file, or the explanation of an error code.
    #[command(
        after_help = "Of a text: regions, guards, clusters, schedule, rates, pruning, memory, claims. Of a code: its page.\n\nExample:\n  apex explain robots/patsy/patsy.afg\n  apex explain --memory robots/firmware/firmware.afg\n  apex explain missing-unit\n  apex explain --list"
    )]
    Explain {
        /// Source file, or a code such as `missing-unit`.
        #[arg(required_unless_present = "list", value_name = "FILE | CODE")]
        what: Option<PathBuf>,
        /// Print all codes.
        #[arg(long, exclusive = true)]
        list: bool,
        /// Format of the output.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        /// Print the Petri net of each program instead, as PNML.
        #[arg(long, conflicts_with = "format")]
        pnml: bool,
        /// Print the memory of each program in bytes instead, by node and by buffer. Builds the program.
        #[arg(long, conflicts_with = "pnml")]
        memory: bool,
        /// Print the longest times of clusters and the load of each thread instead, from a profile of `apex run
        /// --profile`.
        #[arg(long, value_name = "FILE", conflicts_with_all = ["pnml", "memory"])]
        profile: Option<PathBuf>,
    },
    /// Draw a graph or a state machine.
    #[command(
        after_help = "Single lines are `->`, double ones `=>`. Data goes from left to right; slots are at the top, events at the bottom.\nDashed lines are asynchronous, dash-dotted ones lead from the one to the other. Coloured: where activity can be.\n\nExample:\n  apex graph robots/patsy/patsy.afg --graph Simulated -o patsy.svg"
    )]
    Graph {
        /// Source file.
        file: PathBuf,
        /// Name of the graph, robot or state machine. Without it: the only robot, else the only graph that is not part
        /// of another one, else the only other graph, else the only state machine.
        #[arg(long, alias = "robot", value_name = "NAME")]
        graph: Option<String>,
        /// Draw only the nodes that can be active and the paths of activity, as a state diagram.
        #[arg(long)]
        activity: bool,
        /// Open nested graphs to this depth: 0 draws them as boxes with their ports, `all` opens everything. Without
        /// it, nested graphs are closed and chains of nodes are drawn as one box in large pictures, until they are
        /// readable.
        #[arg(long, value_name = "N | all")]
        depth: Option<graph::Depth>,
        /// File to write [default: standard output].
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// Format of the picture [default: according to the name of the file].
        #[arg(long, value_enum)]
        format: Option<graph::Picture>,
    },
    /// Convert a graph file of CS::APEX to a source file.
    #[command(
        after_help = "What the library does not have stands in the text with a comment; --nodes writes Rust for it, to be filled in.\n\nExample:\n  apex import robot.apex -o robot.afg --nodes src/nodes.rs"
    )]
    Import {
        /// Graph file: .apex, or a snippet .apexs.
        file: PathBuf,
        /// Source file to write [default: standard output].
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// Write skeletons of the node types that the library lacks to this Rust file.
        #[arg(long, value_name = "FILE")]
        nodes: Option<PathBuf>,
    },
    /// Start the language server for an editor, on standard input and output.
    #[command(after_help = "Editors start it themselves; docs/editors.md says how to set them up.")]
    Lsp,
    /// Create a project that works at once.
    #[command(
        after_help = "Example:\n  apex new my-robot\n  cd my-robot\n  apex check robot.afg\n  apex test robot.afg\n  cargo run"
    )]
    New {
        /// Folder of the project; its name becomes that of the package.
        #[arg(value_name = "NAME")]
        folder: PathBuf,
        /// Kind of project.
        #[arg(long, value_enum, default_value_t)]
        template: new::Template,
        /// Checkout that contains the crates of Apex [default: the checkout from which this command was built].
        #[arg(long, value_name = "FOLDER")]
        path: Option<PathBuf>,
    },
    /// List the nodes that a package can use, or describe one.
    #[command(
        after_help = "A node has to do with a word that stands in its path, its documentation, or a port or parameter of it. If one is named\nexactly so, or only one is left, its ports and parameters are listed with types, units, defaults and ranges.\n\nExample:\n  apex nodes\n  apex nodes scan filter\n  apex nodes JumpDistance"
    )]
    Nodes {
        /// Words that a node must match.
        words: Vec<String>,
        /// Folder of the package [default: the current folder].
        #[arg(long, value_name = "FOLDER", default_value = ".", hide_default_value = true)]
        package: PathBuf,
        /// Print the full descriptions as a page in Markdown.
        #[arg(long)]
        markdown: bool,
    },
    /// Repeat a recorded run and report the differences.
    #[command(
        after_help = "The robot is built, and takes what its sources sent, at the times at which they did. What it makes of that is compared with\nthe recording, token by token, for the ports that its `record` statement names.\nExit code 0: all the same, 1: something was different or is missing (or the text has errors).\n\nExample:\n  apex run robot.afg --record run.mcap\n  apex replay run.mcap robot.afg"
    )]
    Replay {
        /// Recording (MCAP) from `apex run --record` or a `record` statement.
        recording: PathBuf,
        /// Source file.
        file: PathBuf,
        /// Name of the robot or graph, if the source file has several.
        #[arg(long)]
        robot: Option<String>,
        /// Set parameters from this file (TOML) before the run, as `apex run` does.
        #[arg(long, value_name = "FILE")]
        params: Option<PathBuf>,
        #[command(flatten)]
        how: Building,
    },
    /// Run the tests of a source file in simulated time.
    #[command(
        after_help = "If the package of the text compiles it with `graph!(\"…\")`, those are the tests, and `cargo test` runs them too. Otherwise\na package is made for them, below the target folder. Either way what `cargo build` has built is not built again.\nExit code 0: all passed, 1: one failed (or the text has errors), 2: they could not be built.\n\nExample:\n  apex test robot.afg\n  apex test robot.afg wall"
    )]
    Test {
        /// Source file.
        file: PathBuf,
        /// Text that the names of the tests must contain.
        filter: Option<String>,
        #[command(flatten)]
        how: Building,
    },
    /// Build and run a robot.
    #[command(
        after_help = "If the package of the text has a program of its own, that is run, with ARGS. Otherwise a program is made\nthat drives the robot by the machine's clock. Only that one takes --params and --save-params: a program of your\nown calls `apex_rt::params::load_file` and `save_file`.\nIt is built as `cargo build` does it, in the same folder, and what is there already is not built again.\nExit code: that of the program (0, or 1 after `abort`); 1 if the text has errors, 2 if it could not be built or started.\n\nExample:\n  apex run robot.afg\n  apex run --release --robot Rover robot.afg -- --fast\n  apex run --record run.mcap robot.afg"
    )]
    Run {
        /// Source file.
        file: PathBuf,
        /// Name of the robot or graph, if the source file has several.
        #[arg(long)]
        robot: Option<String>,
        /// Set parameters from this file (TOML) before the robot runs; all others keep their values from the source
        /// file.
        #[arg(long, value_name = "FILE")]
        params: Option<PathBuf>,
        /// Write all parameters to this file when the run ends, also by Ctrl-C.
        #[arg(long, value_name = "FILE")]
        save_params: Option<PathBuf>,
        /// Build and start the robot again whenever its source file or Rust code changes, until Ctrl-C.
        #[arg(long)]
        watch: bool,
        /// Measure every node: write a trace for Perfetto or Chrome to this file, and print a table when the run ends,
        /// also by Ctrl-C.
        #[arg(long, value_name = "FILE")]
        profile: Option<PathBuf>,
        /// Record everything that enters the robot, and the ports of its `record` statement, to this file (MCAP). An
        /// existing file is kept; the new one gets a number.
        #[arg(long, value_name = "FILE", conflicts_with = "profile")]
        record: Option<PathBuf>,
        #[command(flatten)]
        how: Building,
        /// Arguments for the program.
        #[arg(last = true)]
        args: Vec<String>,
    },
}

/// Options of a build.
#[derive(clap::Args)]
struct Building {
    /// Build with optimisations, as `cargo build --release` does.
    #[arg(long)]
    release: bool,
    /// Print only the errors of the build, instead of cargo's progress or a line for each crate.
    #[arg(short, long)]
    quiet: bool,
}

impl Building {
    fn how(&self) -> build::How {
        build::How::new(self.release, self.quiet)
    }
}

/// Format of results.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people.
    #[default]
    Text,
    /// For programs.
    Json,
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Check { paths, format, fix } => check::run(&paths, format, fix),
        Command::Completions { shell } => completions::run(shell),
        Command::Doc { paths, output } => doc::run(&paths, output.as_deref()),
        Command::Fmt { paths, check } => fmt::run(&paths, check),
        Command::Expand { file } => expand::run(&file),
        Command::Explain { what, format, pnml, memory, profile, .. } => {
            let shown = match (pnml, memory, profile) {
                (true, ..) => explain::Shown::Net,
                (_, true, _) => explain::Shown::Memory,
                (_, _, Some(profile)) => explain::Shown::Times(profile),
                _ => explain::Shown::Decisions,
            };
            explain::run(what.as_deref(), format, shown)
        }
        Command::Graph { file, graph, activity, depth, output, format } => {
            graph::run(&file, &graph::Wanted { graph, activity, depth, output, format })
        }
        Command::Import { file, output, nodes } => import::run(&file, output.as_deref(), nodes.as_deref()),
        Command::Lsp => lsp::run(),
        Command::New { folder, template, path } => new::run(&folder, template, path.as_deref()),
        Command::Nodes { words, package, markdown } => nodes::run(&package, &words, markdown),
        Command::Test { file, filter, how } => test::run(&file, filter.as_deref(), how.how()),
        Command::Replay { recording, file, robot, params, how } => {
            let params = run::Params { load: params, save: None };
            let (robot, recording) = (robot.as_deref(), run::Recording::Repeated(&recording));
            run::run(&run::Wanted {
                file: &file,
                robot,
                params: &params,
                profile: None,
                recording,
                args: &[],
                watch: false,
                how: how.how(),
            })
        }
        Command::Run { file, robot, params, save_params, watch, profile, record, how, args } => {
            let params = run::Params { load: params, save: save_params };
            let (robot, profile) = (robot.as_deref(), profile.as_deref());
            let recording = record.as_deref().map_or(run::Recording::Stated, run::Recording::Made);
            let how = how.how();
            let wanted =
                run::Wanted { file: &file, robot, params: &params, profile, recording, args: &args, watch, how };
            if watch { watch::run(&wanted) } else { run::run(&wanted) }
        }
    };
    project::print_where_to_read_on();
    match result {
        Ok(code) => code,
        Err(message) => {
            project::print_error(&format!("error: {message}"));
            ExitCode::from(2)
        }
    }
}
