//! Measurement of a model on digits that it was not trained on.

use super::{
    features,
    forms::{self, Digit},
    pen,
    reliability::{Reliability, diagram},
};
use apex_nodes::{
    image::GrayImage,
    learn::{Activity, Mlp, Model},
    math::Random,
};
use flate2::read::GzDecoder;
use std::{fs, io::Read};

/// Number of drawn digits.
const DRAWN: usize = 20_000;

/// Class of what is not a whole digit, if the model has one.
const NO_DIGIT: usize = 10;

/// Thresholds that are compared.
const THRESHOLDS: [f32; 5] = [0.5, 0.9, 0.97, 0.99, 0.995];

/// Images with their classes.
type Examples = Vec<(GrayImage, usize)>;

/// Prints how a model does on drawn digits and on printed digits: alone, on forms, and cut off. Writes the diagram.
///
/// # Errors
/// If a file cannot be read or written.
pub fn check(model: &str, images: &str, labels: &str, path: &str) -> Result<(), String> {
    let bytes = fs::read(model).map_err(|e| format!("{model} cannot be read: {e}"))?;
    let network = Model::from_bytes(&bytes).map_err(|e| format!("{model}: {e}"))?.network;
    let digits = forms::digits(&unpacked(images)?, &unpacked(labels)?);
    let mut random = Random::new(2);
    let printed: Vec<(&Digit, usize)> = digits.iter().map(|(digit, class)| (digit, *class)).collect();
    // A part of a 1 is a 1.
    let parts = printed.iter().filter(|(_, class)| *class != 1);
    let drawn = (0..DRAWN).map(|i| (pen::draw(i % 10, &mut random), i % 10)).collect();
    let sets: [(&str, &str, Examples); 4] = [
        ("drawn like the training", "#888", drawn),
        ("printed", "#06c", printed.iter().map(|(digit, class)| ((*digit).clone().into(), *class)).collect()),
        ("on forms", "#c60", printed.iter().map(|(d, class)| (forms::framed(d, &mut random), *class)).collect()),
        ("cut off", "#093", parts.map(|(d, _)| (forms::cut(d, &mut random), NO_DIGIT)).collect()),
    ];
    let curves = sets.map(|(name, colour, examples)| (name, colour, measure(name, &network, &examples)));
    let curves: Vec<(&str, &str, &Reliability)> = curves.iter().map(|(n, c, curve)| (*n, *c, curve)).collect();
    fs::write(path, diagram(&curves)).map_err(|e| format!("{path} cannot be written: {e}"))
}

fn unpacked(path: &str) -> Result<Vec<u8>, String> {
    let mut bytes = vec![];
    let read = fs::File::open(path).and_then(|file| GzDecoder::new(file).read_to_end(&mut bytes));
    read.map(|_| bytes).map_err(|e| format!("{path} cannot be read: {e}"))
}

/// Prints results at each threshold, and those at each confidence.
fn measure(name: &str, network: &Mlp, examples: &[(GrayImage, usize)]) -> Reliability {
    let (mut activity, mut reliability, mut results) = (Activity::default(), Reliability::default(), vec![]);
    for (image, class) in examples {
        let Some(input) = features(image) else { continue };
        let outputs = network.run(&input, &mut activity);
        let best = (0..outputs.len()).max_by(|a, b| outputs[*a].total_cmp(&outputs[*b])).unwrap_or(NO_DIGIT);
        reliability.add(outputs[best], best == *class);
        results.push((outputs[best], best, *class));
    }
    println!(
        "\n{name}: {} images\n{:>9} {:>12} {:>12} {:>12}",
        examples.len(),
        "threshold",
        "right",
        "wrong",
        "rejected"
    );
    for threshold in THRESHOLDS {
        let said = results.iter().filter(|(sure, best, _)| *sure >= threshold && *best != NO_DIGIT);
        let right = said.clone().filter(|(_, best, class)| best == class).count();
        let wrong = said.count() - right;
        let share = |count: usize| 100.0 * count as f32 / examples.len().max(1) as f32;
        let rest = share(examples.len() - right - wrong);
        println!("{threshold:>9} {:>11.2}% {:>11.2}% {rest:>11.2}%", share(right), share(wrong));
    }
    println!("{reliability}");
    reliability
}
