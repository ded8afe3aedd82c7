use apex_nodes::io::ScanLog;
use apex_rt::prelude::*;
use apex_sim::{experiment::Options, say};
use patsy::{
    experiments::{RECORDED_SCANNER, Report},
    programs::{RecordedCarts, RecordedCartsParts, RecordedPallets, RecordedPalletsParts, Simulated},
};
use std::{path::PathBuf, process::ExitCode};

struct Recording {
    log: PathBuf,
    carts: bool,
    labels: Option<PathBuf>,
    table: PathBuf,
}

/// Searches for containers in simulated rooms, or on recorded scans.
pub fn simulate_or_replay(options: &mut Options) -> Result<ExitCode, String> {
    recording(options)?.map_or_else(simulate, recorded)
}

/// Reads the options. `None` selects the simulation.
fn recording(options: &mut Options) -> Result<Option<Recording>, String> {
    let (mut log, mut carts, mut labels, mut table) = (None, false, None, None);
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "log" => log = Some(options.path()?),
            "labels" => labels = Some(options.path()?),
            "table" => table = Some(options.path()?),
            "container" => match options.text()?.as_str() {
                "pallet" => carts = false,
                "cart" => carts = true,
                _ => return Err("`--container` is `pallet` or `cart`".to_owned()),
            },
            _ => return Err(Options::unknown(&name)),
        }
    }
    match log {
        Some(log) => {
            let table = table.unwrap_or_else(|| "out/patsy/detections.csv".into());
            Ok(Some(Recording { log, carts, labels, table }))
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

fn recorded(recording: Recording) -> Result<ExitCode, String> {
    let log = ScanLog::open(&recording.log, RECORDED_SCANNER).map_err(|e| e.to_string())?;
    let report = Report::new(&recording.table, recording.labels.as_deref())?;
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
    Ok(if recording.carts {
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
