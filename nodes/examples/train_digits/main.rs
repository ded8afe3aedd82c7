//! Trains the digit classifier of the library on digits that it draws itself, and writes the model:
//!
//! ```text
//! cargo run --release -p apex-nodes --features gzip,image,learn --example train_digits -- FILE [SEED]
//! ```
//!
//! With `--check MODEL IMAGES LABELS SVG`, it measures a model on packed files of printed digits in the format of
//! MNIST, and draws a reliability diagram.

use apex_nodes::{
    image::{GrayImage, Region},
    learn::{Activity, Example, Features, GLYPH_SIDE, Mlp, Model, Trainer, glyph_features},
    math::Random,
};
use apex_rt::Out;
use std::{env, fs, process::ExitCode};

mod check;
mod forms;
mod pen;
mod reliability;

const EPOCHS: u32 = 20;
const DIGITS_PER_EPOCH: usize = 6000;
const HIDDEN: usize = 80;

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
    let mut network = Mlp::new(&[GLYPH_SIDE * GLYPH_SIDE, HIDDEN, 10], &mut random);
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
    let provenance = format!("drawn by the example train_digits: {EPOCHS} epochs of {DIGITS_PER_EPOCH} digits");
    Model { provenance, seed, network }
}

fn examples(count: usize, random: &mut Random) -> Vec<Example> {
    let example = |i: usize| {
        let input = features(&pen::draw(i % 10, random))?;
        Some(Example { input: input.to_vec(), class: i % 10 })
    };
    (0..count).filter_map(example).collect()
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
