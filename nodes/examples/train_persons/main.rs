//! Trains and compares classifiers of persons in images (thesis 6.8.1, table 6.4):
//!
//! ```text
//! cargo run --release -p apex-nodes --features image,learn --example train_persons -- FOLDER BOXES.csv [--out FILE]
//! ```
//!
//! The folder has images with their frame number in the name. The table of boxes has the columns frame, person, centre
//! (u, v), width and height, in pixels. Other regions of the images, of the same sizes, are the class without a person.
//! Each of the eight variants is measured by cross-validation over blocks of time. Its threshold is chosen on a block
//! that is used neither for training nor for the measurement.

use crate::{
    crops::{Crop, Descriptor, crops},
    variants::{Method, train},
};
use std::{fs, process::ExitCode, sync::atomic::AtomicUsize, sync::atomic::Ordering, thread};

mod crops;
mod variants;

const HELP: &str = "\
Trains and compares classifiers of persons in images.

Usage: train_persons FOLDER BOXES.csv [--out FILE --variant NAME] [--seed N] [--jobs N]

  FOLDER          images with their frame number as the only number in the name
  BOXES.csv       boxes of persons: frame, person, centre u, centre v, width, height, in pixels
  --out FILE      where the model of a variant is written, trained on all images; without the table
  --variant NAME  variant of the model: hog or acf, with svm, forest, boosted or mlp; for example hog-svm
  --seed N        seed of the other regions and of the training (default 1)
  --jobs N        number of threads (default 1); the table does not depend on it
";

/// Blocks of time in the cross-validation, and images next to a block that are left out.
const BLOCKS: usize = 6;
const MARGIN: usize = 1;

/// Share of regions without a person that may be above the threshold, when it is chosen.
const ALLOWED: f64 = 0.01;

struct Options {
    folder: String,
    boxes: String,
    out: Option<String>,
    variant: (Descriptor, Method),
    seed: u64,
    jobs: usize,
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
    let (mut files, mut out, mut variant) = (Vec::new(), None, None);
    let (mut seed, mut jobs) = (1, 1);
    let text = |parser: &mut lexopt::Parser| {
        parser.value().map(|text| text.to_string_lossy().into_owned()).map_err(|e| e.to_string())
    };
    let number = |text: String| text.parse::<u64>().map_err(|_| format!("a whole number is needed, not `{text}`"));
    while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
        match argument {
            Long("help") | Short('h') => {
                print!("{HELP}");
                return Ok(None);
            }
            Long("seed") => seed = number(text(&mut parser)?)?,
            Long("jobs") => jobs = number(text(&mut parser)?)?.max(1) as usize,
            Long("out") => out = Some(text(&mut parser)?),
            Long("variant") => variant = Some(named(&text(&mut parser)?)?),
            Value(file) => files.push(file.to_string_lossy().into_owned()),
            other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
        }
    }
    let [folder, boxes] = <[String; 2]>::try_from(files).map_err(|_| "a folder and a table of boxes are needed")?;
    if out.is_none() && variant.is_some() {
        return Err("`--variant` needs `--out`: the table has all variants".to_owned());
    }
    let variant = variant.unwrap_or((Descriptor::Hog, Method::Svm));
    Ok(Some(Options { folder, boxes, out, variant, seed, jobs }))
}

fn variants() -> impl Iterator<Item = (Descriptor, Method)> {
    [Descriptor::Acf, Descriptor::Hog].into_iter().flat_map(|d| Method::ALL.map(|method| (d, method)))
}

fn named(name: &str) -> Result<(Descriptor, Method), String> {
    let all: Vec<String> = variants().map(|(d, m)| format!("{}-{}", d.name(), m.name())).collect();
    let at = all.iter().position(|other| other == name);
    let variant = at.and_then(|at| variants().nth(at));
    variant.ok_or_else(|| format!("`{name}` is not a variant: they are {}", all.join(", ")))
}

fn run(options: &Options) -> Result<(), String> {
    let images = crops(&options.folder, &options.boxes, options.seed)?;
    let persons = images.iter().flatten().filter(|crop| crop.is_person && !crop.is_mirrored).count();
    let others = images.iter().flatten().filter(|crop| !crop.is_person && !crop.is_mirrored).count();
    if let Some(out) = &options.out {
        let all: Vec<&Crop> = images.iter().flatten().collect();
        let (descriptor, method) = options.variant;
        let provenance = format!("trained by the example train_persons on {} images", images.len());
        let model = train(descriptor, method, &all, options.seed).to_bytes(&provenance, options.seed);
        return fs::write(out, model).map_err(|e| format!("{out} cannot be written: {e}"));
    }
    let results = measure_all(&images, options);
    println!("{:<6} {:<8} {:>8} {:>8} {:>7}", "", "", "TPR (%)", "FPR (%)", "AUC");
    for ((descriptor, method), result) in variants().zip(results) {
        println!(
            "{:<6} {:<8} {:>8.1} {:>8.2} {:>7.4}",
            descriptor.name(),
            method.name(),
            100.0 * result.hits as f64 / persons.max(1) as f64,
            100.0 * result.alarms as f64 / others.max(1) as f64,
            result.area(),
        );
    }
    println!(
        "{persons} persons and {others} other regions in {} images, {BLOCKS} blocks, seed {}",
        images.len(),
        options.seed
    );
    Ok(())
}

/// Result of a variant.
#[derive(Default)]
struct Measured {
    hits: usize,
    alarms: usize,
    /// Score of each region relative to the threshold, and whether it is a person.
    scored: Vec<(f32, bool)>,
}

impl Measured {
    fn area(&self) -> f64 {
        let mut sorted = self.scored.clone();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let (mut others, mut sum) = (0.0, 0.0);
        for (_, is_person) in &sorted {
            if *is_person {
                sum += others;
            } else {
                others += 1.0;
            }
        }
        sum / (others * (sorted.len() as f64 - others)).max(1.0)
    }
}

/// Cross-validation of all variants, on several threads.
fn measure_all(images: &[Vec<Crop>], options: &Options) -> Vec<Measured> {
    let tasks: Vec<((Descriptor, Method), usize)> =
        variants().flat_map(|variant| (0..BLOCKS).map(move |block| (variant, block))).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some(((descriptor, method), block)) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
            done.push((*descriptor, *method, *block, measure(*descriptor, *method, images, *block, options.seed)));
        }
        done
    };
    let mut done: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..options.jobs).map(|_| scope.spawn(work)).collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap_or_default()).collect()
    });
    done.sort_by_key(|(descriptor, method, block, _)| (*descriptor, *method, *block));
    let sum = |variant: (Descriptor, Method)| {
        let parts = done.iter().filter(|(descriptor, method, ..)| (*descriptor, *method) == variant);
        parts.fold(Measured::default(), |mut sum, (.., part)| {
            sum.hits += part.hits;
            sum.alarms += part.alarms;
            sum.scored.extend_from_slice(&part.scored);
            sum
        })
    };
    variants().map(sum).collect()
}

/// Trains on all blocks but two: the next one gives the threshold, and `block` is measured.
fn measure(descriptor: Descriptor, method: Method, images: &[Vec<Crop>], block: usize, seed: u64) -> Measured {
    let ends = |block: usize| (block * images.len() / BLOCKS, (block + 1) * images.len() / BLOCKS);
    let (measured, other) = (ends(block), ends((block + 1) % BLOCKS));
    let near = |at: usize, (begin, end): (usize, usize), margin| at + margin >= begin && at < end + margin;
    let seen: Vec<&Crop> = (0..images.len())
        .filter(|at| !near(*at, measured, MARGIN) && !near(*at, other, MARGIN))
        .flat_map(|at| &images[at])
        .collect();
    let model = train(descriptor, method, &seen, seed);
    let scores = |(begin, end): (usize, usize)| -> Vec<(f32, bool)> {
        let crops = images[begin..end].iter().flatten().filter(|crop| !crop.is_mirrored);
        crops.map(|crop| (model.probability(descriptor.of(crop)), crop.is_person)).collect()
    };
    let threshold = threshold(&scores(other));
    let scored: Vec<(f32, bool)> =
        scores(measured).into_iter().map(|(p, is_person)| (logit(p) - logit(threshold), is_person)).collect();
    let above = |class: bool| scored.iter().filter(|(score, is_person)| *score > 0.0 && *is_person == class).count();
    Measured { hits: above(true), alarms: above(false), scored }
}

/// Smallest threshold with few enough regions without a person above it.
fn threshold(scored: &[(f32, bool)]) -> f32 {
    let mut others: Vec<f32> = scored.iter().filter(|(_, is_person)| !is_person).map(|(p, _)| *p).collect();
    others.sort_by(|a, b| b.total_cmp(a));
    others.get((others.len() as f64 * ALLOWED) as usize).copied().unwrap_or(0.5)
}

/// Logarithm of the odds of a probability, so that scores of several blocks can be compared.
fn logit(probability: f32) -> f32 {
    let p = probability.clamp(1e-7, 1.0 - 1e-7);
    (p / (1.0 - p)).ln()
}
