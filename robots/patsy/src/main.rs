//! Runs PATSY in search of containers: in a simulated room, or on recorded scans.

use apex_nodes::io::ScanLog;
use apex_rt::prelude::*;
use patsy::{
    RECORDED_SCANNER, Report,
    programs::{RecordedCarts, RecordedCartsParts, RecordedPallets, RecordedPalletsParts, Simulated},
};
use std::{path::PathBuf, process::ExitCode};

const HELP: &str = "\
PATSY looks for containers in laser scans and draws what it sees.

Usage: patsy [--log FILE [--container pallet|cart] [--labels FILE] [--table FILE]]
       patsy obstacles [OPTIONS]

Without arguments it plays 5000 scans in simulated rooms and measures itself.

  --log FILE        scans from a recording: .csv (number, source number, ranges in m) or CARMEN .log, also packed (.gz)
  --container KIND  what to look for in a recording: pallet (default) or cart
  --labels FILE     boxes that the containers lie in: number, x_min, y_min, x_max, y_max in m
  --table FILE      where the detections are written (default out/patsy/detections.csv)
  --help            this text

`obstacles` measures the detection of obstacles with a time-of-flight camera; `patsy obstacles --help` lists its options.

Pictures are written to out/patsy. Exit codes: 0 fine, 1 some scans could not be read, 2 nothing could be done.
";

struct Options {
    log: PathBuf,
    carts: bool,
    labels: Option<PathBuf>,
    table: PathBuf,
}

fn main() -> ExitCode {
    let mut args = std::env::args_os().skip(1).peekable();
    let done = if args.next_if(|arg| arg == "obstacles").is_some() {
        patsy::obstacles::run(args)
    } else {
        options().and_then(|options| options.map_or_else(|| Ok(simulate()), recorded))
    };
    match done {
        Ok(code) => code,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// Reads the options. `None` selects the simulation.
fn options() -> Result<Option<Options>, String> {
    use lexopt::prelude::*;
    let mut parser = lexopt::Parser::from_env();
    let (mut log, mut carts, mut labels, mut table) = (None, false, None, None);
    while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
        match argument {
            Long("help") | Short('h') => {
                print!("{HELP}");
                std::process::exit(0);
            }
            Long("log") => log = Some(value(&mut parser)?),
            Long("labels") => labels = Some(value(&mut parser)?),
            Long("table") => table = Some(value(&mut parser)?),
            Long("container") => match value(&mut parser)?.to_str() {
                Some("pallet") => carts = false,
                Some("cart") => carts = true,
                _ => return Err("`--container` is `pallet` or `cart`".to_owned()),
            },
            other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
        }
    }
    match log {
        Some(log) => {
            Ok(Some(Options { log, carts, labels, table: table.unwrap_or_else(|| "out/patsy/detections.csv".into()) }))
        }
        None if carts || labels.is_some() || table.is_some() => Err("these options need `--log`".to_owned()),
        None => Ok(None),
    }
}

fn value(parser: &mut lexopt::Parser) -> Result<PathBuf, String> {
    parser.value().map(PathBuf::from).map_err(|e| e.to_string())
}

fn simulate() -> ExitCode {
    let mut robot = Simulated::new();
    let mut clock = SimClock::until(Time::MAX);
    let mut watch = Watch::new(const { &Simulated::INFO });
    while !robot.nodes().laser.finished() {
        let next = robot.react_with(clock.now(), &mut watch);
        watch.advance(&mut clock, next);
    }
    println!("{}", robot.nodes().evaluate);
    println!("{}", robot.nodes().drive);
    println!("seed 1; pictures: out/patsy/*.svg");
    watch.code()
}

fn recorded(options: Options) -> Result<ExitCode, String> {
    let log = ScanLog::open(&options.log, RECORDED_SCANNER).map_err(|e| e.to_string())?;
    let report = Report::new(&options.table, options.labels.as_deref())?;
    let mut clock = SimClock::until(Time::MAX);
    // The two programs differ in type, but are driven in the same way.
    macro_rules! play {
        ($robot:expr, $program:ty) => {{
            let (mut robot, mut watch) = ($robot, Watch::new(const { &<$program>::INFO }));
            while !robot.nodes().log.finished() {
                let next = robot.react_with(clock.now(), &mut watch);
                watch.advance(&mut clock, next);
            }
            println!("{}", robot.nodes().report);
            println!("pictures: out/patsy/*.svg");
            watch.code()
        }};
    }
    Ok(if options.carts {
        play!(RecordedCarts::new(RecordedCartsParts { log, report }), RecordedCarts)
    } else {
        play!(RecordedPallets::new(RecordedPalletsParts { log, report }), RecordedPallets)
    })
}

/// Reports failures and remembers whether there were any.
struct Watch {
    messages: StdErr,
    failed: bool,
}

impl Watch {
    fn new(info: &'static apex_rt::Info) -> Self {
        Self { messages: StdErr(info), failed: false }
    }

    fn advance(&self, clock: &mut SimClock, next: Next) {
        let time = if let Next::At(time) = next { time } else { clock.now() };
        clock.wait_until(time);
    }

    fn code(&self) -> ExitCode {
        if self.failed { ExitCode::from(1) } else { ExitCode::SUCCESS }
    }
}

impl Observer for Watch {
    fn failed(&mut self, node: usize, error: &impl std::fmt::Display) {
        self.failed = true;
        self.messages.failed(node, error);
    }
}
