//! Trains the forest that detects legs in laser scans, on simulated scans or on recordings:
//!
//! ```text
//! cargo run --release -p apex-nodes --features learn --example train_legs -- [RECORDING…] [--out FILE] [--seed N]
//! ```
//!
//! Without recordings, the scans are simulated, and the model is measured on further ones. With recordings of one
//! scanner, the table has the area under the ROC curve by cross-validation over blocks of time, and that of the model
//! of the library, which has not seen them.

use crate::recording::{Labelled, read};
use apex_nodes::{
    learn::{Example, Forest, ForestTrainer},
    math::Random,
    persons::{LEGS, leg_features},
    scan::{JumpDistance, Segments},
};
use apex_rt::{Construct, Out};
use std::{fs, process::ExitCode};

mod recording;
mod simulation;

const HELP: &str = "\
Trains the forest that detects legs in laser scans.

Usage: train_legs [RECORDING…] [--out FILE] [--seed N]

  RECORDING   labelled scans of one scanner, also packed (.gz): lines of `angle,range,label` after a line `# name` for
              each scan, or lines of `number,first angle,increment,x y;x y;…,ranges…` with the positions of the legs.
              Without recordings, scans are simulated
  --out FILE  where the model is written, trained on all scans
  --seed N    seed of the simulation and of the training (default 1)
";

/// Segments of a scan: the same settings as for detection.
const GAP: f32 = 0.1;
const MAX_GAP_BEAMS: usize = 2;
const MIN_POINTS: u16 = 3;
const MAX_SIZE: f32 = 0.5;

/// Blocks of time in the cross-validation, and scans next to a block that are left out.
const BLOCKS: usize = 5;
const MARGIN: usize = 5;

/// Simulated scans for training, and further ones for the measurement.
const SIMULATED: usize = 3000;
const MEASURED: usize = 1000;

struct Options {
    recordings: Vec<String>,
    out: Option<String>,
    seed: u64,
}

fn main() -> ExitCode {
    match options().and_then(|options| options.map_or(Ok(()), |options| run(&options))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// Reads the options. `None` if only the help was asked for.
fn options() -> Result<Option<Options>, String> {
    use lexopt::prelude::*;
    let mut parser = lexopt::Parser::from_env();
    let mut options = Options { recordings: Vec::new(), out: None, seed: 1 };
    while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
        match argument {
            Long("help") | Short('h') => {
                print!("{HELP}");
                return Ok(None);
            }
            Long("seed") => {
                let text = parser.value().map_err(|e| e.to_string())?;
                let seed = text.to_str().and_then(|text| text.parse().ok());
                options.seed = seed.ok_or_else(|| format!("the seed is a whole number, not `{}`", text.display()))?;
            }
            Long("out") => {
                options.out = Some(parser.value().map_err(|e| e.to_string())?.to_string_lossy().into_owned())
            }
            Value(file) => options.recordings.push(file.to_string_lossy().into_owned()),
            other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
        }
    }
    Ok(Some(options))
}

fn run(options: &Options) -> Result<(), String> {
    let (examples, provenance) =
        if options.recordings.is_empty() { simulated(options.seed) } else { recorded(options)? };
    if let Some(out) = &options.out {
        let model = trainer(options.seed).random_forest(&examples, &provenance);
        fs::write(out, model).map_err(|e| format!("{out} cannot be written: {e}"))?;
    }
    Ok(())
}

const fn trainer(seed: u64) -> ForestTrainer {
    ForestTrainer { trees: 60, depth: 9, min_leaf: 4, features: 4, seed }
}

/// Examples of simulated scans, after the measurement of a model on further ones.
fn simulated(seed: u64) -> (Vec<Example>, String) {
    let mut random = Random::new(seed);
    let mut scans = |count: usize| (0..count).flat_map(|_| examples(&simulation::scan(&mut random))).collect();
    let (seen, unseen): (Vec<Example>, Vec<Example>) = (scans(SIMULATED), scans(MEASURED));
    let model = trainer(seed).random_forest(&seen, "");
    println!("{:<12} {:>9} {:>7} {:>6}", "scans", "segments", "legs", "AUC");
    println!("{:<12} {} {:>6.3}", "simulated", counts(&unseen), auc(&model, &unseen));
    (seen, format!("simulated by the example train_legs: {SIMULATED} scans"))
}

/// Examples of all recordings, after the cross-validation.
fn recorded(options: &Options) -> Result<(Vec<Example>, String), String> {
    let files: Vec<Vec<Vec<Example>>> = options
        .recordings
        .iter()
        .map(|file| Ok(read(file)?.iter().map(examples).collect()))
        .collect::<Result<_, String>>()?;
    let all: Vec<Example> = files.iter().flatten().flatten().cloned().collect();
    let mut scored: Vec<(f32, bool)> = Vec::new();
    for block in 0..BLOCKS {
        let (mut seen, mut unseen) = (Vec::new(), Vec::new());
        for scans in &files {
            let (begin, end) = (block * scans.len() / BLOCKS, (block + 1) * scans.len() / BLOCKS);
            for (at, examples) in scans.iter().enumerate() {
                if (begin..end).contains(&at) {
                    unseen.extend_from_slice(examples);
                } else if at + MARGIN < begin || at >= end + MARGIN {
                    seen.extend_from_slice(examples);
                }
            }
        }
        scored.extend(scores(&trainer(options.seed).random_forest(&seen, ""), &unseen));
    }
    println!("{:<36} {:>9} {:>7} {:>6}", "model", "segments", "legs", "AUC");
    println!("{:<36} {} {:>6.3}", format!("cross-validated over {BLOCKS} blocks"), counts(&all), area(scored));
    println!("{:<36} {} {:>6.3}", "of the library (simulated scans)", counts(&all), auc(LEGS, &all));
    println!("seed {}", options.seed);
    let names: Vec<&str> = options.recordings.iter().map(|f| f.rsplit('/').next().unwrap_or(f)).collect();
    Ok((all, format!("trained by the example train_legs on {}", names.join(", "))))
}

fn counts(examples: &[Example]) -> String {
    format!("{:>9} {:>7}", examples.len(), examples.iter().filter(|e| e.class == 1).count())
}

/// Features and classes of all segments that the detector would classify.
fn examples(labelled: &Labelled) -> Vec<Example> {
    let mut out = Out::new();
    // A scan in more segments than a list holds gives no examples.
    if JumpDistance::construct((GAP, MAX_GAP_BEAMS)).process(&labelled.scan, &mut out).is_err() {
        return Vec::new();
    }
    let none = Segments::new();
    let segments = out.get().unwrap_or(&none);
    let usable = segments.iter().enumerate().filter(|(_, s)| s.points >= MIN_POINTS && s.size() <= MAX_SIZE);
    let example = |(at, segment)| {
        let input = leg_features(&labelled.scan, segments, at)?.to_vec();
        Some(Example { input, class: usize::from(labelled.is_leg(segment)) })
    };
    usable.filter_map(example).collect()
}

/// Probability of each example, and whether it is a leg.
fn scores(model: &[u8], examples: &[Example]) -> Vec<(f32, bool)> {
    let Ok(forest) = Forest::from_bytes(model) else { return Vec::new() };
    examples.iter().filter_map(|e| Some((forest.probability(&e.input)?, e.class == 1))).collect()
}

fn auc(model: &[u8], examples: &[Example]) -> f64 {
    area(scores(model, examples))
}

/// Area under the ROC curve: the probability that a leg has a higher score than another segment; equal ones count half.
fn area(mut scored: Vec<(f32, bool)>) -> f64 {
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut below, mut sum) = (0.0, 0.0);
    for equal in scored.chunk_by(|a, b| a.0 == b.0) {
        let legs = equal.iter().filter(|(_, is_leg)| *is_leg).count() as f64;
        let others = equal.len() as f64 - legs;
        sum += legs * (below + 0.5 * others);
        below += others;
    }
    sum / (below * (scored.len() as f64 - below)).max(1.0)
}
