//! Parameters of the scan matching of `slam`, tuned on a recording: `scan_matching FOLDER [--candidates N] [--seed N]
//! [--jobs N] [--length ROWS] [--no-racing] [--journal FILE] [--out FOLDER]`.
//!
//! A run plays a part of the recording of the Intel Research Lab and costs the root mean square of the distances from
//! the reference poses after the best rigid alignment, in m. The parts before row 1700 are the seeds of the study;
//! those from row 1700 on are held out. A part begins every 120 rows; longer parts overlap.

#[path = "../../nodes/tests/slam/recordings.rs"]
#[allow(dead_code)]
mod recordings;

use apex_nodes::slam::{Settings, Window};
use apex_tune::{Axis, Goal, Journal, Method, Objective, Parameter, Report, Scale, Study, Summary, Timed};
use recordings::{Recording, errors, intel, play};
use std::{error::Error, path::PathBuf, time::Instant};

/// Rows from the beginning of a part to that of the next one, and rows of a part if nothing else is given.
const STEP: usize = 120;
/// Rows that are tuned on: from the first reference to the split.
const FIRST: usize = 709;
const SPLIT: usize = 1700;

/// Parts of the recording, by seed.
struct Matching {
    parts: Vec<Recording>,
}

impl Matching {
    /// Cuts a recording. Returns the number of the first part behind the split, too.
    fn new(whole: &Recording, length: usize) -> (Self, u64) {
        let starts = |rows: std::ops::Range<usize>| rows.step_by(STEP);
        let training: Vec<usize> = starts(FIRST..SPLIT - length + 1).collect();
        let held_out = starts(SPLIT..whole.scans.len() - length + 1);
        let split = training.len() as u64;
        let starts = training.into_iter().chain(held_out);
        let parts = starts.map(|start| cut(whole, start..start + length)).collect();
        (Self { parts }, split)
    }
}

fn cut(whole: &Recording, rows: std::ops::Range<usize>) -> Recording {
    let reference = whole.reference.range(rows.clone()).map(|(row, pose)| (row - rows.start, *pose)).collect();
    Recording { scans: whole.scans[rows].to_vec(), reference }
}

fn settings(values: &[f64]) -> Settings {
    Settings {
        travel: values[0],
        turn: values[1],
        correlation_sigma: values[2],
        window_scans: values[3] as usize,
        window: Window { distance: values[4], angle: values[5] },
        least_response: values[6],
        ..Settings::default()
    }
}

impl Objective for Matching {
    fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String> {
        let part = &self.parts[seed as usize];
        Ok(vec![rms(&errors(&play(part, settings(values)).1, &part.reference))])
    }
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64).sqrt()
}

fn parameters() -> Vec<Parameter> {
    let d = Settings::default();
    let (linear, log) = (Scale::Linear, Scale::Logarithmic);
    let parameter = |name: &str, unit: &str, range: [f64; 2], scale, integer, default| Parameter {
        name: name.to_owned(),
        unit: unit.to_owned(),
        shown_in: None,
        axis: Axis::new(range[0], range[1], scale, integer).expect("a range"),
        default,
        targets: vec![],
        single: true,
    };
    vec![
        parameter("travel", "m", [0.1, 0.6], log, false, d.travel),
        parameter("turn", "rad", [0.1, 0.6], log, false, d.turn),
        parameter("correlation_sigma", "m", [0.015, 0.2], log, false, d.correlation_sigma),
        parameter("window_scans", "", [5.0, 60.0], log, true, d.window_scans as f64),
        parameter("window.distance", "m", [0.15, 0.8], log, false, d.window.distance),
        parameter("window.angle", "rad", [0.1, 0.6], log, false, d.window.angle),
        parameter("least_response", "", [0.1, 0.6], linear, false, d.least_response),
    ]
}

/// Command line.
struct Arguments {
    folder: PathBuf,
    journal: Option<PathBuf>,
    out: Option<PathBuf>,
    candidates: u64,
    seed: u64,
    jobs: usize,
    /// Rows of a part.
    length: usize,
    racing: bool,
}

fn arguments() -> Result<Arguments, String> {
    let mut words = std::env::args().skip(1);
    let folder = words.next().ok_or("usage: scan_matching FOLDER [OPTIONS]")?.into();
    let mut a =
        Arguments { folder, journal: None, out: None, candidates: 150, seed: 1, jobs: 1, length: STEP, racing: true };
    while let Some(name) = words.next() {
        if name == "--no-racing" {
            a.racing = false;
            continue;
        }
        let value = words.next().ok_or_else(|| format!("`{name}` needs a value"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("`{name} {value}`: not a number"));
        match name.as_str() {
            "--candidates" => a.candidates = number()?,
            "--seed" => a.seed = number()?,
            "--jobs" => a.jobs = number()?.max(1) as usize,
            "--length" => a.length = number()?.clamp(1, (SPLIT - FIRST) as u64) as usize,
            "--journal" => a.journal = Some(value.into()),
            "--out" => a.out = Some(value.into()),
            _ => return Err(format!("unknown option `{name}`")),
        }
    }
    Ok(a)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    let whole = intel(&arguments.folder);
    let (matching, split) = Matching::new(&whole, arguments.length);
    let study = Study {
        name: "scan matching".to_owned(),
        objective: 0,
        parameters: parameters(),
        method: Method::DifferentialEvolution,
        goals: vec![Goal {
            name: "error".to_owned(),
            unit: "m".to_owned(),
            maximise: false,
            summary: Summary::Mean,
            least: 0.0,
        }],
        seeds: (0..split).collect(),
        held_out: (split..matching.parts.len() as u64).collect(),
        searches: 1,
        candidates: arguments.candidates,
        seed: arguments.seed,
        racing: arguments.racing,
    };
    let mut journal = match &arguments.journal {
        Some(file) => Journal::open(file, &study)?,
        None => Journal::in_memory(),
    };
    println!("{} runs are known", journal.len());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs).build()?;
    let (timed, start) = (Timed::new(&matching), Instant::now());
    let found = pool.install(|| {
        study.run(&timed, &mut journal, (0, 1), &mut |progress| {
            let left = start.elapsed().mul_f64(study.candidates as f64 / progress.candidates as f64 - 1.0);
            let best = progress.best.as_ref().map_or(f64::NAN, |best| best.fitness);
            println!("{} candidates, best {best:.4} m, {left:.0?} left", progress.candidates);
        })
    })?;
    let report = pool.install(|| Report::new(&study, found, &timed, &mut journal))?.ok_or("all candidates failed")?;
    println!("{}\n{}", report.markdown(), pool.install(|| timed.cost()));
    whole_rows(&whole, &study.defaults(), report.values());
    if let Some(out) = &arguments.out {
        report.write(out)?;
    }
    Ok(())
}

/// Prints the errors when all rows before the split, and all behind it, are mapped at once.
fn whole_rows(whole: &Recording, defaults: &[f64], tuned: &[f64]) {
    println!("median and largest error of a map of all rows, m");
    for (name, rows) in [("before the split", 0..SPLIT), ("behind it", SPLIT..whole.scans.len())] {
        let part = cut(whole, rows);
        let errors = [defaults, tuned].map(|values| errors(&play(&part, settings(values)).1, &part.reference));
        let figures = errors.map(|e| format!("{:.3} {:.3}", e[e.len() / 2], e[e.len() - 1]));
        println!("{name}: defaults {}, tuned {}", figures[0], figures[1]);
    }
}
