//! Trains the digit classifier of the library on digits that it draws itself, and writes the model:
//!
//! ```text
//! cargo run --release -p apex-nodes --features image,learn --example train_digits -- FILE [SEED]
//! ```

use apex_nodes::{
    image::{GrayImage, Region},
    learn::{Activity, Example, Features, GLYPH_SIDE, Mlp, Model, Trainer, glyph_features},
    math::Random,
};
use apex_rt::Out;
use std::{env, fs, process::ExitCode};

mod pen;

const EPOCHS: u32 = 20;
const DIGITS_PER_EPOCH: usize = 6000;
const HIDDEN: usize = 80;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (path, seed) = match &arguments[..] {
        [path] => (path, Ok(1)),
        [path, seed] => (path, seed.parse()),
        _ => {
            eprintln!("usage: train_digits FILE [SEED]");
            return ExitCode::from(2);
        }
    };
    let Ok(seed) = seed else {
        eprintln!("the seed is a whole number, not `{}`", arguments[1]);
        return ExitCode::from(2);
    };
    let model = train(seed);
    if let Err(e) = fs::write(path, model.to_bytes()) {
        eprintln!("{path} cannot be written: {e}");
        return ExitCode::from(2);
    }
    ExitCode::SUCCESS
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
