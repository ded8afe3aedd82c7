//! The `apex` command, a thin layer over the compiler.

mod agents;
mod answer;
mod bag;
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
mod sbom;
mod studio;
mod test;
mod texts;
mod times;
mod tune;
mod watch;

use answer::Answer;
use clap::{Parser, Subcommand, ValueEnum};
use std::{path::PathBuf, process::ExitCode};

/// Robot behaviour as text, compiled to a static program.
#[derive(Parser)]
#[command(
    name = "apex",
    version,
    after_help = "Exit codes: 0: success, 1: the file has errors, 2: the command failed."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write AGENTS.md: a short guide to the language and the nodes of a package, for programs that write code.
    #[command(
        after_help = "`apex new` writes the file, too. Run this after changes of nodes; what you add before or behind the written part is kept.\nExit code 1 with --check: the file is not up to date.\n\nExample:\n  apex agents\n  apex agents --check"
    )]
    Agents {
        /// Folder of the package.
        #[arg(default_value = ".", hide_default_value = true)]
        folder: PathBuf,
        /// Change nothing, but say if the file is not up to date.
        #[arg(long)]
        check: bool,
    },
    /// List what is in a recording: topics, types, numbers of messages, rates, gaps.
    #[command(
        after_help = "Reads MCAP files, of Apex and of ROS 2, and bags of ROS 1. A gap is listed if it is three times as long as usual.\nExit code 1: the recording is incomplete.\n\nExample:\n  apex bag bag.mcap\n  apex bag --format json bag.mcap"
    )]
    Bag {
        /// Recording.
        file: PathBuf,
        /// Format of the output.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
    },
    /// Check source files and report their errors.
    #[command(
        after_help = "--fix applies the unambiguous fixes and lists them; other suggestions are only printed.\nExit code 0: no errors remain.\n\nExample:\n  apex check robots/patsy/patsy.afg\n  apex check --format json robot.afg\n  apex check - < robot.afg\n  apex check --fix robot.afg"
    )]
    Check {
        /// Source files, or folders with `.afg` files; `-` is standard input, as a file of the current folder.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// Format of the output.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        /// Apply unambiguous fixes.
        #[arg(long)]
        fix: bool,
    },
    /// Print the script with which a shell completes this command.
    #[command(after_help = "Example:\n  apex completions bash > ~/.local/share/bash-completion/completions/apex")]
    Completions {
        /// Shell.
        shell: clap_complete::Shell,
    },
    /// Write pages about graphs and nodes, with diagrams.
    #[command(
        after_help = "Imported source files get pages, too, and so do the nodes that are used. The pages are self-contained HTML.\nA folder that contains other files is refused. If a source file has errors, nothing is written.\n\nExample:\n  apex doc robot.afg\n  apex doc robots --output pages"
    )]
    Doc {
        /// Source files, or folders with `.afg` files.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// Folder for the pages; by default `apex/doc` in the target folder of the package.
        #[arg(short, long, value_name = "FOLDER")]
        output: Option<PathBuf>,
    },
    /// Format source files.
    #[command(
        after_help = "Files with errors are left unchanged. Exit code 1: a file has errors or, with --check, is not formatted.\n\nExample:\n  apex fmt robots\n  apex fmt --check robots/patsy/patsy.afg\n  apex fmt - < robot.afg"
    )]
    Fmt {
        /// Source files, or folders with `.afg` files; `-` formats standard input to standard output.
        #[arg(required = true, value_name = "FILE")]
        paths: Vec<PathBuf>,
        /// Change nothing, but list the files that would be changed.
        #[arg(long)]
        check: bool,
    },
    /// Print the Rust code that a source file is compiled to.
    #[command(after_help = "Example:\n  apex expand robot.afg\n  apex expand --record robot.afg")]
    Expand {
        /// Print the code for a runtime that can record: with the feature `record` of `apex-rt`.
        #[arg(long)]
        record: bool,
        /// Source file, or `-` for standard input.
        file: PathBuf,
    },
    /// Print the decisions of the compiler about a source file, or the meaning of a diagnostic code.
    #[command(
        after_help = "For a source file: regions, guards, clusters, schedule, rates, pruning, memory, claims. For a code: its page.\n\nExample:\n  apex explain robots/patsy/patsy.afg\n  apex explain --memory robots/firmware/firmware.afg\n  apex explain missing-unit\n  apex explain --list"
    )]
    Explain {
        /// Source file, `-` for standard input, or a code such as `missing-unit`.
        #[arg(required_unless_present = "list", value_name = "FILE | CODE")]
        what: Option<PathBuf>,
        /// Print all codes.
        #[arg(long, conflicts_with_all = ["what", "program", "pnml", "memory", "profile"])]
        list: bool,
        /// Format of the output.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        /// Print the intermediate program instead: conditions, clusters, slots, timers.
        #[arg(long, conflicts_with_all = ["format", "pnml", "memory", "profile"])]
        program: bool,
        /// Print the Petri net of each program instead, as PNML.
        #[arg(long, conflicts_with = "format")]
        pnml: bool,
        /// Print the size of each program in memory instead, by node and buffer. Builds the program.
        #[arg(long, conflicts_with = "pnml")]
        memory: bool,
        /// Print the worst execution times of clusters and the load of threads instead, from a profile of
        /// `apex run --profile`.
        #[arg(long, value_name = "FILE", conflicts_with_all = ["pnml", "memory"])]
        profile: Option<PathBuf>,
    },
    /// Draw a graph or a state machine.
    #[command(
        after_help = "Single lines are `->`, double lines `=>`. Data flows from left to right; slots are at the top, events at the bottom.\nDashed lines are asynchronous, dash-dotted lines hybrid. Nodes that can be active are coloured.\n\nExamples:\n  apex graph robots/patsy/patsy.afg --graph Simulated -o patsy.svg\n  apex graph robots/explorer/planet.afg --new-to robots/patsy/clinic.afg -o new.svg"
    )]
    Graph {
        /// Source file, or `-` for standard input.
        file: PathBuf,
        /// Name of the graph, robot or state machine. By default the only robot, else the only graph that is not part
        /// of another one, else the only state machine.
        #[arg(long, alias = "robot", value_name = "NAME")]
        graph: Option<String>,
        /// Draw only the nodes that can be active, and the paths of activity, as a state diagram.
        #[arg(long)]
        activity: bool,
        /// Levels of nested graphs that are opened: 0 draws them as boxes with their ports, `all` opens everything. By
        /// default, large diagrams are simplified: nested graphs are closed, and chains of nodes drawn as one box.
        #[arg(long, value_name = "N | all")]
        depth: Option<graph::Depth>,
        /// Highlight what the graphs of this file lack: nodes of types that they do not use, and nested graphs that are
        /// not in them. Several files: what all of them lack.
        #[arg(long, value_name = "FILE")]
        new_to: Vec<PathBuf>,
        /// Output file; by default standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// Format of the diagram; by default that of the file extension.
        #[arg(long, value_enum)]
        format: Option<graph::Picture>,
    },
    /// Convert a graph file of CS::APEX to a source file, or messages of ROS 2 to Rust.
    #[command(
        after_help = "Nodes that the library does not have are marked by comments; --nodes writes Rust skeletons for them.\n--msg reads `.msg`, `.srv` and `.action` files, and folders of them. The structs need the crate `apex-messages`, which has\nthe common messages.\n\nExample:\n  apex import robot.apex -o robot.afg --nodes src/nodes.rs\n  apex import --msg my_msgs other_msgs -o src/messages.rs"
    )]
    Import {
        /// Graph file: .apex, or a snippet .apexs; with --msg, definition files or folders with packages.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Read definitions of messages, services and actions of ROS 2, and write Rust structs.
        #[arg(long, conflicts_with = "nodes")]
        msg: bool,
        /// Output file; by default standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// Write skeletons of the node types that the library does not have to this Rust file.
        #[arg(long, value_name = "FILE")]
        nodes: Option<PathBuf>,
    },
    /// Run the language server for editors on standard input and output.
    #[command(after_help = "Editors start the server themselves; docs/editors.md describes their setup.")]
    Lsp,
    /// Create a project that runs immediately.
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
        /// Checkout with the crates of Apex; by default the one that this command was built from.
        #[arg(long, value_name = "FOLDER")]
        path: Option<PathBuf>,
    },
    /// List the nodes that a package can use, or describe one.
    #[command(
        after_help = "Outside of a package, the nodes of the library are listed. A node matches a word in its path, its documentation, or the names of its ports and parameters. If one node has exactly\nthis name, or only one matches, its ports and parameters are listed with types, units, defaults and ranges.\n\nExample:\n  apex nodes\n  apex nodes scan filter\n  apex nodes JumpDistance"
    )]
    Nodes {
        /// List only nodes that match all these words.
        words: Vec<String>,
        /// Folder of the package; by default the current one.
        #[arg(long, value_name = "FOLDER", default_value = ".", hide_default_value = true)]
        package: PathBuf,
        /// Print the full documentation as Markdown.
        #[arg(long, conflicts_with = "format")]
        markdown: bool,
        /// Format of the output.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
    },
    /// Repeat a recorded run and report the differences.
    #[command(
        after_help = "Builds the robot and feeds it the recorded tokens of its sources at the recorded times. The tokens of the ports in its\n`record` statement are compared with the recording.\nExit code 0: no differences, 1: tokens are different or missing (or the file has errors).\n\nExample:\n  apex run robot.afg --record run.mcap\n  apex replay run.mcap robot.afg"
    )]
    Replay {
        /// Recording (MCAP) by `apex run --record` or a `record` statement.
        recording: PathBuf,
        /// Source file.
        file: PathBuf,
        /// Name of the robot or graph, if the file has several.
        #[arg(long)]
        robot: Option<String>,
        /// File (TOML) with parameters that are set before the run, as with `apex run`.
        #[arg(long, value_name = "FILE")]
        params: Option<PathBuf>,
        /// Format of the report.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        #[command(flatten)]
        how: Building,
    },
    /// List the crates of which a program consists: a bill of materials, or the notices of their licences.
    #[command(
        after_help = "The list is in the format CycloneDX (JSON) and has names, versions, licences, checksums and what needs what; crates for tests\nare left out. With the same `Cargo.lock` it is the same. --notices writes what has to be handed on with a program.\n\nExample:\n  apex sbom -o robot.cdx.json\n  apex sbom --notices -o NOTICES"
    )]
    Sbom {
        /// Folder of the package or workspace.
        #[arg(default_value = ".", hide_default_value = true)]
        folder: PathBuf,
        /// Write the licences and copyright of the crates of others, instead of the bill.
        #[arg(long)]
        notices: bool,
        /// Output file; by default standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Run the tests of a source file in simulated time.
    #[command(
        after_help = "The graphs are interpreted. Rustc only compiles the node types that they use, so that after most changes of the file it\nhas nothing to do. With --compiled, the tests are those that `cargo test` runs, too. Crates that `cargo build` has built\nare reused.\nExit code 0: all passed, 1: one failed (or the file has errors), 2: they could not be built.\n\nExample:\n  apex test robot.afg\n  apex test robot.afg wall"
    )]
    Test {
        /// Source file.
        file: PathBuf,
        /// Run only the tests whose names contain this text.
        filter: Option<String>,
        /// Compile the whole graphs with rustc, as `cargo test` does, instead of interpreting them.
        #[arg(long)]
        compiled: bool,
        /// Format of the output.
        #[arg(long, value_enum, default_value_t)]
        format: Format,
        #[command(flatten)]
        how: Building,
    },
    /// Find good values of parameters, as a `tune` item of a source file states.
    #[command(
        after_help = "A `tune` item is a test that is repeated with other values:\n  tune Steady: Cart { vary pilot.gain in 0.1..=10; wait 20s; minimise error.rms; seeds 32; }\nThe program is built once, with optimisation. Every run is written to a journal: after Ctrl-C, --resume continues. The\nresult is the same on any number of cores, and merged from several machines (--shard, --merge).\nExit code 0: better values were found, 1: there are none (or the file has errors), 2: the study could not be run.\n\nExample:\n  apex tune robots/cart/cart.afg Swift --candidates 100\n  apex tune cart.afg Steady --resume --params tuned.toml\n  apex tune cart.afg Steady --searches 8 --shard 1/2 --output part1"
    )]
    Tune(tune::Wanted),
    /// Show a running robot in the terminal: what is active, what fires how often, what fails.
    #[command(
        after_help = "Space halts a robot in simulated time, `.` lets it react once, `q` ends.\n\nExample:\n  apex run --stream 127.0.0.1:7400 robot.afg\n  apex top 127.0.0.1:7400"
    )]
    Top {
        /// Address of the robot: that of `apex run --stream`, or the path of a socket.
        #[arg(value_name = "HOST:PORT")]
        address: String,
    },
    /// Build and run a robot.
    #[command(
        after_help = "If the package has its own program for the file, this program is run with ARGS. Otherwise a program is generated\nthat drives the robot in real time. Only this one takes --params and --save-params: your own program calls\n`apex_rt::params::load_file` and `save_file`.\nThe program is built like with `cargo build`, in the same folder, and crates that are already built are reused.\nExit code: that of the program (0, or 1 after `abort`); 1 if the file has errors, 2 if it could not be built or started.\n\nExample:\n  apex run robot.afg\n  apex run --release --robot Rover robot.afg -- --fast\n  apex run --record run.mcap robot.afg"
    )]
    Run {
        /// Source file.
        file: PathBuf,
        /// Name of the robot or graph, if the file has several.
        #[arg(long)]
        robot: Option<String>,
        /// File (TOML) with parameters that are set before the run; others keep the values of the source file.
        #[arg(long, value_name = "FILE")]
        params: Option<PathBuf>,
        /// File to which all parameters are written at the end of the run, also after Ctrl-C.
        #[arg(long, value_name = "FILE")]
        save_params: Option<PathBuf>,
        /// Build and start the program again after each change of its source files or Rust code; Ctrl-C ends both.
        #[arg(long)]
        watch: bool,
        /// Measure every node: write a trace for Perfetto or Chrome to this file, and print a table at the end of the
        /// run, also after Ctrl-C.
        #[arg(long, value_name = "FILE")]
        profile: Option<PathBuf>,
        /// Record all inputs of the robot, and the ports of its `record` statement, to this file (MCAP). An existing
        /// file is kept, and the new one gets a number.
        #[arg(long, value_name = "FILE", conflicts_with = "profile")]
        record: Option<PathBuf>,
        #[command(flatten)]
        limits: run::Limits,
        /// Open a socket at this address, for `apex studio --connect` on this machine or another one. If other machines
        /// reach it, viewers may only look, unless --stream-access says otherwise. With the environment variable
        /// APEX_STUDIO_TOKEN, only viewers with the same value are admitted.
        #[arg(long, value_name = "HOST:PORT")]
        stream: Option<String>,
        /// Rights of viewers: to look (`read`), or also to set parameters (`write`).
        #[arg(long, value_enum, requires = "stream")]
        stream_access: Option<run::StreamAccess>,
        #[command(flatten)]
        how: Building,
        /// Arguments for the program.
        #[arg(last = true)]
        args: Vec<String>,
    },
    /// Run a robot and open a page on which it can be seen: what is active, fires and fails, values, and parameters.
    #[command(
        after_help = "Prints the address of the page, which has a secret token. The robot is built again after each change of its source files;\nwhile these have errors, the old one continues. In simulated time (--simulated or --replay) it can be halted and run step\nby step.\n\nExample:\n  apex studio --simulated robot.afg\n  apex studio --replay run.mcap robot.afg\n  apex studio --connect 10.0.0.7:7400 robot.afg\n  apex studio --connect 10.0.0.7:7400 --connect 10.0.0.8:7400\n  apex studio target/apex/tune/Swift"
    )]
    Studio {
        /// Source file, or folder of a study of `apex tune`. With --connect, the robot can also be shown without it.
        #[arg(required_unless_present = "connect")]
        file: Option<PathBuf>,
        /// Name of the robot or graph, if the file has several.
        #[arg(long)]
        robot: Option<String>,
        /// Look at a robot that runs already: `apex run --stream HOST:PORT`. Given several times, the page shows one of
        /// them at a time.
        #[arg(long, value_name = "HOST:PORT", conflicts_with_all = ["replay", "simulated", "params", "release", "quiet"])]
        connect: Vec<String>,
        /// Repeat this recording instead of running the robot.
        #[arg(long, value_name = "FILE")]
        replay: Option<PathBuf>,
        /// Simulate the time, for robots whose sources do so.
        #[arg(long)]
        simulated: bool,
        /// Let a second robot get the inputs of the first one, with parameters of its own: the page shows both, and
        /// where they differ. The first one records its run to a temporary file for that. In the second one sources
        /// are not called, but all other nodes run: not for robots whose motors are driven by other nodes.
        #[arg(long, conflicts_with_all = ["connect", "replay"])]
        shadow: bool,
        /// Simulated seconds per second at the beginning.
        #[arg(long, default_value_t = 1.0, value_parser = studio::speed)]
        speed: f64,
        /// File (TOML) with parameters that are set before the run.
        #[arg(long, value_name = "FILE")]
        params: Option<PathBuf>,
        /// Address of the page. Other machines reach it only if it is not a loopback address.
        #[arg(long, value_name = "HOST:PORT", default_value = "127.0.0.1:7410")]
        listen: std::net::SocketAddr,
        /// Origin under which a proxy shows the page, such as `https://robot.example`: the proxy encrypts, and passes
        /// requests on to the address of the page. May be given several times.
        #[arg(long, value_name = "ORIGIN", value_parser = apex_studio::origin)]
        origin: Vec<String>,
        /// Only look: the page can neither set parameters nor halt the robot, asks it for no tokens or times, and
        /// changes no text.
        #[arg(long)]
        read_only: bool,
        #[command(flatten)]
        how: Building,
        /// Arguments for the program.
        #[arg(last = true)]
        args: Vec<String>,
    },
}

/// Options for building a program.
#[derive(clap::Args)]
struct Building {
    /// Build with optimisations, as `cargo build --release`.
    #[arg(long)]
    release: bool,
    /// Print only errors of the build, without the progress of cargo.
    #[arg(short, long)]
    quiet: bool,
    /// Leave the paths of this machine out of the program, for one that is handed on. All crates are compiled for that
    /// once more, beside those that `cargo build` has built.
    #[arg(long)]
    trim_paths: bool,
}

impl Building {
    fn how(&self) -> build::How {
        build::How { trims: self.trim_paths, ..build::How::new(self.release, self.quiet) }
    }
}

/// Format of printed results.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Text for humans.
    #[default]
    Text,
    /// JSON for programs.
    Json,
}

fn main() -> ExitCode {
    let command = Arguments::parse().command;
    let mut answer = command.answer();
    let ended = obey(command, &mut answer);
    project::print_where_to_read_on();
    answer.finish(ended)
}

impl Command {
    /// Empty answer of the command.
    fn answer(&self) -> Answer {
        match self {
            Self::Bag { format, .. } => Answer::new("bag", *format),
            Self::Check { format, .. } => Answer::new("check", *format),
            Self::Explain { format, .. } => Answer::new("explain", *format),
            Self::Nodes { format, .. } => Answer::new("nodes", *format),
            Self::Replay { format, .. } => Answer::new("replay", *format),
            Self::Test { format, .. } => Answer::new("test", *format),
            Self::Tune(wanted) => Answer::new("tune", wanted.format),
            _ => Answer::new("", Format::Text),
        }
    }
}

fn obey(command: Command, answer: &mut Answer) -> Result<ExitCode, String> {
    match command {
        Command::Agents { folder, check } => agents::run(&folder, check),
        Command::Bag { file, .. } => bag::run(&file, answer),
        Command::Check { paths, fix, .. } => check::run(&paths, fix, answer),
        Command::Completions { shell } => completions::run(shell),
        Command::Doc { paths, output } => doc::run(&paths, output.as_deref()),
        Command::Fmt { paths, check } => fmt::run(&paths, check),
        Command::Expand { record, file } => expand::run(&file, record),
        Command::Explain { what, program, pnml, memory, profile, .. } => {
            let shown = match (pnml, memory, profile) {
                _ if program => explain::Shown::Program,
                (true, ..) => explain::Shown::Net,
                (_, true, _) => explain::Shown::Memory,
                (_, _, Some(profile)) => explain::Shown::Times(profile),
                _ => explain::Shown::Decisions,
            };
            explain::run(what.as_deref(), shown, answer)
        }
        Command::Graph { file, graph, activity, depth, new_to, output, format } => {
            graph::run(&file, &graph::Wanted { graph, activity, depth, new_to, output, format })
        }
        Command::Import { files, msg: true, output, .. } => import::msg::run(&files, output.as_deref()),
        Command::Import { files, output, nodes, .. } => match files.as_slice() {
            [file] => import::run(file, output.as_deref(), nodes.as_deref()),
            _ => Err("one graph file at a time: several are read with `--msg` only".to_owned()),
        },
        Command::Lsp => lsp::run(),
        Command::New { folder, template, path } => new::run(&folder, template, path.as_deref()),
        Command::Nodes { words, package, markdown, .. } => nodes::run(&package, &words, markdown, answer),
        Command::Sbom { folder, notices, output } => sbom::run(&folder, notices, output.as_deref()),
        Command::Test { file, filter, compiled, how, .. } => {
            test::run(&file, filter.as_deref(), compiled, how.how(), answer)
        }
        Command::Replay { recording, file, robot, params, how, .. } => {
            let params = run::Params { load: params, save: None };
            let (robot, recording) = (robot.as_deref(), run::Recording::Repeated(&recording));
            let wanted = run::Wanted {
                file: &file,
                robot,
                params: &params,
                profile: None,
                recording,
                limits: run::Limits::default(),
                args: &[],
                watch: false,
                stream: run::Stream::None,
                simulated: false,
                how: how.how(),
            };
            run::run(&wanted, answer)
        }
        Command::Tune(wanted) => tune::run(&wanted, answer),
        Command::Top { address } => studio::top(address),
        Command::Studio {
            file,
            robot,
            connect,
            replay,
            simulated,
            shadow,
            speed,
            params,
            listen,
            origin,
            read_only,
            how,
            args,
        } => {
            let page = studio::Page { listen, origins: origin, read_only, speed };
            match file {
                Some(file) if connect.is_empty() => {
                    let is_study = file.is_dir();
                    let launch =
                        studio::Launch { file, robot, replay, simulated, shadow, params, args, how: how.how() };
                    if is_study { studio::study(&launch, &page) } else { studio::run(launch, &page) }
                }
                file => studio::connect(connect, file, &page),
            }
        }
        Command::Run {
            file,
            robot,
            params,
            save_params,
            watch,
            profile,
            record,
            limits,
            stream,
            stream_access,
            how,
            args,
        } => {
            let params = run::Params { load: params, save: save_params };
            let (robot, profile) = (robot.as_deref(), profile.as_deref());
            let recording = record.as_deref().map_or(run::Recording::Stated, run::Recording::Made);
            let at = |address| run::Stream::At(address, stream_access);
            let (args, stream) = (&args[..], stream.as_deref().map_or(run::Stream::None, at));
            let (file, params, simulated, how) = (&file, &params, false, how.how());
            let wanted =
                run::Wanted { file, robot, params, profile, recording, limits, args, watch, stream, simulated, how };
            if watch { watch::run(&wanted) } else { run::run(&wanted, answer) }
        }
    }
}
