//! Chooses the weights of the obstacle detection on simulated scenes: by random search, with the area under the ROC
//! curve as the objective (thesis 6.10.1 uses an evolutionary algorithm).
//!
//! `cargo run --release -p patsy --example tune_obstacles -- 1001 30`: first seed and number of scenes. The scenes are
//! split into three parts; each part is measured with the weights that were chosen on the other two.

use apex_nodes::cloud::Label;
use apex_sim::in_order;
use apex_sim::{
    Random,
    tof::{TofFrame, Truth},
};
use patsy::obstacles::{Detector, Scores, Weights, labelled_scene};

/// Number of random weights, and of attempts to improve the best ones.
const ROUNDS: (usize, usize) = (60, 240);
const PARTS: usize = 3;

fn main() -> Result<(), String> {
    let mut args = std::env::args().skip(1).map(|arg| arg.parse::<u64>().map_err(|e| format!("`{arg}`: {e}")));
    let first = args.next().unwrap_or(Ok(1001))?;
    let seeds: Vec<u64> = (first..first + args.next().unwrap_or(Ok(30))?).collect();
    let frames = in_order(&seeds, None, |seed| labelled_scene(*seed).take(), |_| {}).map_err(|e| e.to_string())?;
    // The part that is left out; none for the final choice. Then the same with the thesis's weights, of which only
    // κ_max and I_max are free.
    let jobs: Vec<(Option<usize>, bool)> =
        (0..=PARTS).map(|part| ((part < PARTS).then_some(part), false)).chain([(None, true)]).collect();
    let chosen = in_order(&jobs, None, |(part, thesis)| choose(&frames, *part, *thesis), |_| {});
    for ((part, thesis), chosen) in jobs.iter().zip(chosen.map_err(|e| e.to_string())?) {
        let (weights, value) = chosen?;
        let name = if *thesis { "thesis" } else { "free" };
        match part {
            Some(part) => {
                let other = objective(&mut Detector::default(), &weights, &of(&frames, |i| i % PARTS == *part))?;
                println!("{name}, without part {part}: {value:.5} on the others, {other:.5} on it");
            }
            None => println!("{name}, all: {value:.5}\n{weights:#?}\n{}", thresholds(&weights, &frames)?),
        }
    }
    Ok(())
}

fn of(frames: &[TofFrame], is_in: impl Fn(usize) -> bool) -> Vec<&TofFrame> {
    frames.iter().enumerate().filter(|(i, _)| is_in(*i)).map(|(_, frame)| frame).collect()
}

fn choose(frames: &[TofFrame], left_out: Option<usize>, thesis: bool) -> Result<(Weights, f64), String> {
    let frames = of(frames, |i| left_out.is_none_or(|part| i % PARTS != part));
    let (mut detector, mut random) = (Detector::default(), Random::new(7));
    let mut best = (Weights::THESIS, 0.0);
    for round in 0..ROUNDS.0 + ROUNDS.1 {
        let weights = if round < ROUNDS.0 { anywhere(&mut random) } else { nearby(&best.0, &mut random) };
        let weights = if thesis { of_thesis(&weights) } else { weights };
        let value = objective(&mut detector, &weights, &frames)?;
        if value > best.1 {
            best = (weights, value);
        }
    }
    Ok(best)
}

fn of_thesis(weights: &Weights) -> Weights {
    let Weights { max_curvature, max_intensity, .. } = *weights;
    Weights { max_curvature, max_intensity, ..Weights::THESIS }
}

/// Weights in their whole ranges, most of them uniform in the logarithm. The sum of the scores' weights is 1, as only
/// their ratio matters.
fn anywhere(random: &mut Random) -> Weights {
    let mut log = |low: f32, high: f32| random.uniform(low.ln(), high.ln()).exp();
    let weights = Weights {
        alpha: log(0.02, 1.0),
        beta: log(0.005, 1.0),
        gamma: log(0.1, 3.0),
        step: log(0.001, 0.1),
        min_height: log(0.002, 0.02),
        max_curvature: log(0.1, 3.0),
        max_intensity: log(5.0, 1024.0),
        max_elevation: log(0.01, 0.2),
        threshold: 0.5,
        ..Weights::THESIS
    };
    normal(weights)
}

fn nearby(best: &Weights, random: &mut Random) -> Weights {
    let mut vary = |value: f32, low: f32, high: f32| {
        if random.chance(0.4) { (value * random.normal(0.3).exp()).clamp(low, high) } else { value }
    };
    normal(Weights {
        alpha: vary(best.alpha, 0.001, 10.0),
        beta: vary(best.beta, 0.001, 10.0),
        gamma: vary(best.gamma, 0.001, 10.0),
        step: vary(best.step, 0.0005, 0.2),
        min_height: vary(best.min_height, 0.001, 0.05),
        max_curvature: vary(best.max_curvature, 0.05, 3.1),
        max_intensity: vary(best.max_intensity, 2.0, 2000.0),
        max_elevation: vary(best.max_elevation, 0.002, 1.0),
        ..*best
    })
}

fn normal(weights: Weights) -> Weights {
    let sum = weights.alpha + weights.beta + weights.gamma;
    Weights { alpha: weights.alpha / sum, beta: weights.beta / sum, gamma: weights.gamma / sum, ..weights }
}

/// Mean of the areas of all obstacles against all others and of small obstacles against the floor.
fn objective(detector: &mut Detector, weights: &Weights, frames: &[&TofFrame]) -> Result<f64, String> {
    detector.set(weights)?;
    let (mut all, mut small) = (Scores::default(), Scores::default());
    for frame in frames {
        each(detector, frame, |truth, probability| {
            if truth != Truth::Unlabelled {
                all.push(!matches!(truth, Truth::Floor | Truth::Artefact), probability);
            }
            if matches!(truth, Truth::Floor | Truth::Small) {
                small.push(truth == Truth::Small, probability);
            }
        });
    }
    Ok(0.5 * (all.auc().unwrap_or_default() + small.auc().unwrap_or_default()))
}

fn each(detector: &mut Detector, frame: &TofFrame, mut take: impl FnMut(Truth, f32)) {
    let (width, height) = frame.cloud.size();
    let Some((_, labels, probabilities)) = detector.detect(&frame.cloud) else { return };
    for (i, truth) in frame.truth.iter().enumerate() {
        let at = i % width * height + i / width;
        if labels.labels[at] != Label::Missing {
            take(*truth, probabilities[at]);
        }
    }
}

/// Rates of small obstacles and of floor for some thresholds.
fn thresholds(weights: &Weights, frames: &[TofFrame]) -> Result<String, String> {
    let mut detector = Detector::default();
    detector.set(weights)?;
    let mut scores = Scores::default();
    for frame in frames {
        each(&mut detector, frame, |truth, probability| {
            if matches!(truth, Truth::Floor | Truth::Small) {
                scores.push(truth == Truth::Small, probability);
            }
        });
    }
    let mut floor = scores.negative.clone();
    floor.sort_unstable_by(|a, b| b.total_cmp(a));
    let line = |rate: f64| {
        let threshold = floor[(rate * floor.len() as f64) as usize];
        let [small, _] = scores.rates(threshold);
        format!("threshold {threshold:.3}: {:.1} % of small, {:.2} % of floor\n", 100.0 * small, 100.0 * rate)
    };
    Ok([0.001, 0.002, 0.005, 0.01, 0.02, 0.05].map(line).concat())
}
