//! Trains the network that detects a cube in the hopper, on images that it renders itself, and writes the model:
//!
//! ```text
//! cargo run --release -p sick-robot-day --example train_cube -- FILE [SEED]
//! ```

use apex_nodes::{
    learn::{Example, Mlp, Model, PATCH_SIDE, Trainer, patch_features},
    math::Random,
};
use apex_rt::Out;
use sick_robot_day::world::Hopper;
use std::{env, fs, process::ExitCode};

const EPOCHS: u32 = 40;
const IMAGES: usize = 3000;
const HIDDEN: usize = 16;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (path, seed) = match &arguments[..] {
        [path] => (path, Ok(1)),
        [path, seed] => (path, seed.parse()),
        _ => {
            eprintln!("usage: train_cube FILE [SEED]");
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

/// Trains a network on all images in each epoch, with a decreasing learning rate.
fn train(seed: u64) -> Model {
    // Measurements use other seeds: small numbers.
    let mut random = Random::new(!seed);
    let examples: Vec<Example> = (0..IMAGES).filter_map(|i| example(i % 2, &mut random)).collect();
    let mut network = Mlp::new(&[PATCH_SIDE * PATCH_SIDE, HIDDEN, 2], &mut random);
    let mut trainer = Trainer::new(&network, seed);
    trainer.decay = 0.01;
    println!("{:>6} {:>8}", "epoch", "loss");
    for epoch in 0..EPOCHS {
        trainer.rate = 2e-3 * 0.05_f32.powf(epoch as f32 / EPOCHS as f32);
        println!("{:>6} {:>8.4}", epoch + 1, trainer.epoch(&mut network, &examples));
    }
    let provenance = format!("rendered by the example train_cube: {EPOCHS} epochs of {IMAGES} images");
    Model { provenance, seed, network }
}

/// An image of the hopper with its pattern; class 1 has a cube.
fn example(class: usize, random: &mut Random) -> Option<Example> {
    let image = Hopper::random(true, class == 1, random).photo(random);
    let mut features = Out::new();
    patch_features(&image, &mut features);
    Some(Example { input: features.get()?.to_vec(), class })
}
