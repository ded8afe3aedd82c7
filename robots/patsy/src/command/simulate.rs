use super::args::{path, unknown};
use apex_nodes::io::ScanLog;
use apex_rt::prelude::*;
use apex_sim::say;
use lexopt::{Parser, prelude::Long};
use patsy::{
    RECORDED_SCANNER, Report,
    programs::{RecordedCarts, RecordedCartsParts, RecordedPallets, RecordedPalletsParts, Simulated},
};
use std::{path::PathBuf, process::ExitCode};

struct Options {
    log: PathBuf,
    carts: bool,
    labels: Option<PathBuf>,
    table: PathBuf,
}

/// Searches for containers in simulated rooms, or on recorded scans.
pub fn simulate_or_replay(parser: &mut Parser) -> Result<ExitCode, String> {
    options(parser)?.map_or_else(simulate, recorded)
}

/// Reads the options. `None` selects the simulation.
fn options(parser: &mut Parser) -> Result<Option<Options>, String> {
    let (mut log, mut carts, mut labels, mut table) = (None, false, None, None);
    while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
        match argument {
            Long("log") => log = Some(path(parser)?),
            Long("labels") => labels = Some(path(parser)?),
            Long("table") => table = Some(path(parser)?),
            Long("container") => match path(parser)?.to_str() {
                Some("pallet") => carts = false,
                Some("cart") => carts = true,
                _ => return Err("`--container` is `pallet` or `cart`".to_owned()),
            },
            other => return Err(unknown(other)),
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

fn simulate() -> Result<ExitCode, String> {
    let mut robot = Simulated::new();
    let mut clock = SimClock::until(Time::MAX);
    let mut watch = Watch::new(const { &Simulated::INFO });
    while !robot.nodes().laser.finished() {
        let next = robot.react_with(clock.now(), &mut watch);
        watch.advance(&mut clock, next);
    }
    let nodes = robot.nodes();
    say(&format!("{}\n{}\nseed 1; pictures: out/patsy/*.svg\n", nodes.evaluate, nodes.referee))?;
    Ok(watch.code())
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
            say(&format!("{}\npictures: out/patsy/*.svg\n", robot.nodes().report))?;
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
