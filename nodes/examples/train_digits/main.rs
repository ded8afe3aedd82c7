//! Trains the digit classifier of the library on digits that it draws itself, and writes the model:
//!
//! ```text
//! cargo run --release -p apex-nodes --features gzip,image,learn --example train_digits -- FILE [SEED]
//! ```
//!
//! With `--check MODEL IMAGES LABELS SVG`, it measures a model on packed files of printed digits in the format of MNIST,
//! and draws a reliability diagram.

use apex_nodes::{
    image::{GrayImage, Region},
    learn::{Activity, Example, Features, GLYPH_SIDE, Mlp, Model, Trainer, glyph_features},
    math::Random,
};
use apex_rt::Out;
use std::{env, fs, process::ExitCode};

mod check;
mod clutter;
mod forms;
mod pen;
mod reliability;

const EPOCHS: u32 = 24;
const DIGITS_PER_EPOCH: usize = 12_000;
const HIDDEN: usize = 120;
/// Share of examples without a whole digit.
const REJECTED: f32 = 0.3;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match &arguments[..] {
        ["--check", model, images, labels, diagram] => check::check(model, images, labels, diagram),
        [path] if !path.starts_with('-') => write(path, 1),
        [path, seed] => match seed.parse() {
            Ok(seed) => write(path, seed),
            Err(_) => Err(format!("the seed is a whole number, not `{seed}`")),
        },
        _ => Err("usage: train_digits FILE [SEED]\n       train_digits --check MODEL IMAGES LABELS SVG".to_owned()),
    };
    let Err(why) = done else { return ExitCode::SUCCESS };
    eprintln!("{why}");
    ExitCode::from(2)
}

/// Trains a model and writes it to a file.
fn write(path: &str, seed: u64) -> Result<(), String> {
    fs::write(path, train(seed).to_bytes()).map_err(|e| format!("{path} cannot be written: {e}"))
}

/// Trains a network on new digits in each epoch, with a decreasing learning rate.
fn train(seed: u64) -> Model {
    let mut random = Random::new(seed);
    let mut network = Mlp::new(&[GLYPH_SIDE * GLYPH_SIDE, HIDDEN, clutter::NO_DIGIT + 1], &mut random);
    let mut trainer = Trainer::new(&network, seed);
    trainer.decay = 0.01;
    println!("{:>6} {:>8} {:>8}", "epoch", "loss", "right");
    for epoch in 0..EPOCHS {
        trainer.rate = 2e-3 * 0.05_f32.powf(epoch as f32 / EPOCHS as f32);
        let examples = examples(DIGITS_PER_EPOCH, &mut random);
        // Measured before training on these digits: the network has not seen them.
        let right = share_right(&network, &examples);
        let loss = trainer.epoch(&mut network, &examples);
        println!("{:>6} {loss:>8.4} {:>7.2}%", epoch + 1, 100.0 * right);
    }
    let heat = calibrate(&mut network, &examples(4 * DIGITS_PER_EPOCH, &mut random));
    println!("temperature {heat:.3}");
    let provenance = format!("drawn by the example train_digits: {EPOCHS} epochs of {DIGITS_PER_EPOCH} digits");
    Model { provenance, seed, network }
}

fn examples(count: usize, random: &mut Random) -> Vec<Example> {
    let example = |i: usize| {
        let class = if random.chance(REJECTED) { clutter::NO_DIGIT } else { i % 10 };
        let input = features(&clutter::draw(class, random))?;
        Some(Example { input: input.to_vec(), class })
    };
    (0..count).filter_map(example).collect()
}

/// Makes the outputs of a network probabilities that are as right as often as they say, on examples that it was not
/// trained on: divides the inputs of the softmax by the temperature of the least loss (Guo et al. 2017), and returns it.
fn calibrate(network: &mut Mlp, examples: &[Example]) -> f32 {
    let mut activity = Activity::default();
    let outputs: Vec<(Vec<f32>, usize)> =
        examples.iter().map(|e| (network.run(&e.input, &mut activity).to_vec(), e.class)).collect();
    let loss = |heat: f32| -> f64 {
        let of = |(outputs, class): &(Vec<f32>, usize)| {
            let warm = |p: f32| f64::from(p.max(f32::MIN_POSITIVE)).powf(f64::from(1.0 / heat));
            -(warm(outputs[*class]) / outputs.iter().map(|p| warm(*p)).sum::<f64>()).ln()
        };
        outputs.iter().map(of).sum()
    };
    let heats = (0..80).map(|i| 0.5 * 1.03_f32.powi(i));
    let best = heats.min_by(|a, b| loss(*a).total_cmp(&loss(*b))).unwrap_or(1.0);
    if let Some(last) = network.layers_mut().last_mut() {
        last.bias.iter_mut().chain(&mut last.weights).for_each(|weight| *weight /= best);
    }
    best
}

/// Glyph of a whole image.
fn features(image: &GrayImage) -> Option<Features> {
    let (width, height) = image.size();
    let mut out = Out::new();
    glyph_features(image, &Region { width, height, ..Region::default() }, &mut out);
    out.get().cloned()
}

fn share_right(network: &Mlp, examples: &[Example]) -> f32 {
    let mut activity = Activity::default();
    let best = |outputs: &[f32]| (0..outputs.len()).max_by(|a, b| outputs[*a].total_cmp(&outputs[*b]));
    let right = examples.iter().filter(|e| best(network.run(&e.input, &mut activity)) == Some(e.class));
    right.count() as f32 / examples.len().max(1) as f32
}
