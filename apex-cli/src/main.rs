//! The `apex` command: thin shells around the compiler.

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
    /// Check texts and say what is wrong with them.
    #[command(
        after_help = "--fix makes the changes of which there is no doubt, and says which; those that are guesses are shown as ever.\nExit code 0: no error is left.\n\nExample:\n  apex check robots/patsy/patsy.afg\n  apex check --format json robot.afg\n  apex check --fix robot.afg"
    )]
    Check {
        /// The texts; of a folder all `.afg` below it.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// How to say it.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        /// Mend what can be mended without doubt.
        #[arg(long)]
        fix: bool,
    },
    /// Print what a shell needs to complete this command.
    #[command(after_help = "Example:\n  apex completions bash > ~/.local/share/bash-completion/completions/apex")]
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Write pages about graphs and nodes, with diagrams.
    #[command(
        after_help = "Texts that are imported get pages too, and so do the nodes that are used. The pages are HTML and need nothing else.\nA folder with other things in it is refused. If a text has errors, nothing is written.\n\nExample:\n  apex doc robot.afg\n  apex doc robots --output pages"
    )]
    Doc {
        /// The texts; of a folder all `.afg` below it.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// The folder to write to; without it, `apex/doc` below the target folder of the package.
        #[arg(short, long, value_name = "FOLDER")]
        output: Option<PathBuf>,
    },
    /// Bring texts into the one style of the language.
    #[command(
        after_help = "Texts with errors are left alone. Exit code 1: one has errors, or would be changed by what --check leaves undone.\n\nExample:\n  apex fmt robots\n  apex fmt --check robots/patsy/patsy.afg\n  apex fmt - < robot.afg"
    )]
    Fmt {
        /// The texts; of a folder all `.afg` below it; `-` for standard input, formatted to standard output.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// Change nothing; say which texts would be changed.
        #[arg(long)]
        check: bool,
    },
    /// Print the Rust that a text is compiled to.
    Expand {
        /// The text.
        file: PathBuf,
    },
    /// Print what the compiler has decided about a text, or what the code of a message means.
    #[command(
        after_help = "Of a text: regions, guards, clusters, schedule, rates, pruning, memory, claims. Of a code: its page.\n\nExample:\n  apex explain robots/patsy/patsy.afg\n  apex explain --memory robots/firmware/firmware.afg\n  apex explain missing-unit\n  apex explain --list"
    )]
    Explain {
        /// The text, or a code such as `missing-unit`.
        #[arg(required_unless_present = "list", value_name = "FILE | CODE")]
        what: Option<PathBuf>,
        /// Print all codes.
        #[arg(long, exclusive = true)]
        list: bool,
        /// How to say it.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        /// Print the program that Rust is generated from instead: conditions, clusters, slots, timers.
        #[arg(long, conflicts_with_all = ["format", "pnml", "memory", "profile"])]
        program: bool,
        /// Print the Petri net of each program instead, as PNML.
        #[arg(long, conflicts_with = "format")]
        pnml: bool,
        /// Print how many bytes each program has in memory instead, by node and by buffer. Builds it.
        #[arg(long, conflicts_with = "pnml")]
        memory: bool,
        /// Print how long clusters take at worst and how busy each thread is instead, from a profile that `apex run --profile` made.
        #[arg(long, value_name = "FILE", conflicts_with_all = ["pnml", "memory"])]
        profile: Option<PathBuf>,
    },
    /// Draw a graph or a state machine.
    #[command(
        after_help = "Single lines are `->`, double ones `=>`. Data goes from left to right; slots are at the top, events at the bottom.\nDashed lines are asynchronous, dash-dotted ones lead from the one to the other. Coloured: where activity can be.\n\nExample:\n  apex graph robots/patsy/patsy.afg --graph Simulated -o patsy.svg"
    )]
    Graph {
        /// The text.
        file: PathBuf,
        /// Which graph, robot or state machine. Without it: the only robot, else the only graph that is not part of another one, else
        /// the only state machine.
        #[arg(long, alias = "robot", value_name = "NAME")]
        graph: Option<String>,
        /// Only where activity can be, and where it goes, as a state diagram.
        #[arg(long)]
        activity: bool,
        /// Opens nested graphs only so deep: 0 draws them as boxes with their ports, `all` opens everything. Without it, large
        /// pictures have nested graphs closed, and chains of nodes as one box, until they can be read.
        #[arg(long, value_name = "N | all")]
        depth: Option<graph::Depth>,
        /// The file to write; without it, standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// What to write; without it, what the name of the file says.
        #[arg(long, value_enum)]
        format: Option<graph::Picture>,
    },
    /// Turn a graph file of CS::APEX into a text.
    #[command(
        after_help = "What the library does not have stands in the text with a comment; --nodes writes Rust for it, to be filled in.\n\nExample:\n  apex import robot.apex -o robot.afg --nodes src/nodes.rs"
    )]
    Import {
        /// The graph file: .apex, or a snippet .apexs.
        file: PathBuf,
        /// Where the text is written, if not to standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// Writes skeletons of the node types that the library does not have into this Rust file.
        #[arg(long, value_name = "FILE")]
        nodes: Option<PathBuf>,
    },
    /// Serve an editor: the language server, on standard input and output.
    #[command(after_help = "Editors start it themselves; docs/editors.md says how to set them up.")]
    Lsp,
    /// Make a project that works at once.
    #[command(
        after_help = "Example:\n  apex new my-robot\n  cd my-robot\n  apex check robot.afg\n  apex test robot.afg\n  cargo run"
    )]
    New {
        /// The folder of the project; its name is that of the package.
        #[arg(value_name = "NAME")]
        folder: PathBuf,
        /// The kind of project.
        #[arg(long, value_enum, default_value_t)]
        template: new::Template,
        /// The checkout that the crates of Apex are taken from, if not the one that this command was built from.
        #[arg(long, value_name = "FOLDER")]
        path: Option<PathBuf>,
    },
    /// List the nodes that a package can use, or describe one.
    #[command(
        after_help = "A node has to do with a word that stands in its path, its documentation, or a port or parameter of it. If one is named\nexactly so, or only one is left, its ports and parameters are listed with types, units, defaults and ranges.\n\nExample:\n  apex nodes\n  apex nodes scan filter\n  apex nodes JumpDistance"
    )]
    Nodes {
        /// Only nodes that have to do with all of these words.
        words: Vec<String>,
        /// The folder of the package, if not the current one.
        #[arg(long, value_name = "FOLDER", default_value = ".", hide_default_value = true)]
        package: PathBuf,
        /// Print all about them as a page in Markdown.
        #[arg(long)]
        markdown: bool,
    },
    /// Repeat a recorded run, and say what comes out differently.
    #[command(
        after_help = "The robot is built, and takes what its sources sent, at the times at which they did. What it makes of that is compared with\nthe recording, token by token, for the ports that its `record` statement names.\nExit code 0: all the same, 1: something was different or is missing (or the text has errors).\n\nExample:\n  apex run robot.afg --record run.mcap\n  apex replay run.mcap robot.afg"
    )]
    Replay {
        /// The recording (MCAP), by `apex run --record` or a `record` statement.
        recording: PathBuf,
        /// The text.
        file: PathBuf,
        /// Which robot or graph, if the text has several.
        #[arg(long)]
        robot: Option<String>,
        /// Sets parameters from this file (TOML) before the run, as `apex run` does.
        #[arg(long, value_name = "FILE")]
        params: Option<PathBuf>,
        #[command(flatten)]
        how: Building,
    },
    /// Run the tests of a text on simulated time.
    #[command(
        after_help = "If the package of the text compiles it with `graph!(\"…\")`, those are the tests, and `cargo test` runs them too. Otherwise\na package is made for them, below the target folder. Either way what `cargo build` has built is not built again.\nExit code 0: all passed, 1: one failed (or the text has errors), 2: they could not be built.\n\nExample:\n  apex test robot.afg\n  apex test robot.afg wall"
    )]
    Test {
        /// The text.
        file: PathBuf,
        /// Only the tests whose names contain this.
        filter: Option<String>,
        #[command(flatten)]
        how: Building,
    },
    /// Build and run a robot.
    #[command(
        after_help = "If the package of the text has a program of its own, that is run, with ARGS. Otherwise a program is made\nthat drives the robot by the machine's clock. Only that one takes --params and --save-params: a program of your\nown calls `apex_rt::params::load_file` and `save_file`.\nIt is built as `cargo build` does it, in the same folder, and what is there already is not built again.\nExit code: that of the program (0, or 1 after `abort`); 1 if the text has errors, 2 if it could not be built or started.\n\nExample:\n  apex run robot.afg\n  apex run --release --robot Rover robot.afg -- --fast\n  apex run --record run.mcap robot.afg"
    )]
    Run {
        /// The text.
        file: PathBuf,
        /// Which robot or graph, if the text has several.
        #[arg(long)]
        robot: Option<String>,
        /// Sets parameters from this file (TOML) before the robot runs; others keep what the text says.
        #[arg(long, value_name = "FILE")]
        params: Option<PathBuf>,
        /// Writes all parameters into this file when the run ends, also by Ctrl-C.
        #[arg(long, value_name = "FILE")]
        save_params: Option<PathBuf>,
        /// Builds and starts it anew whenever its text or the Rust beside it changes; Ctrl-C ends both.
        #[arg(long)]
        watch: bool,
        /// Measures every node: writes a trace for Perfetto or Chrome into this file, and a table when the run ends, also by Ctrl-C.
        #[arg(long, value_name = "FILE")]
        profile: Option<PathBuf>,
        /// Records everything that enters the robot, and what its `record` statement names, in this file (MCAP); a file that is
        /// there is kept, and the next one has a number.
        #[arg(long, value_name = "FILE", conflicts_with = "profile")]
        record: Option<PathBuf>,
        #[command(flatten)]
        how: Building,
        /// Arguments for the program.
        #[arg(last = true)]
        args: Vec<String>,
    },
}

/// How a program is built.
#[derive(clap::Args)]
struct Building {
    /// Build it optimised, as `cargo build --release` does.
    #[arg(long)]
    release: bool,
    /// Say nothing about building but what is wrong; without it there is cargo's progress, or a line for each crate.
    #[arg(short, long)]
    quiet: bool,
}

impl Building {
    fn how(&self) -> build::How {
        build::How::new(self.release, self.quiet)
    }
}

/// How results are printed.
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
        Command::Explain { what, format, program, pnml, memory, profile, .. } => {
            let shown = match (pnml, memory, profile) {
                _ if program => explain::Shown::Program,
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
