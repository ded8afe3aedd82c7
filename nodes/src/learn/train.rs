use super::{Activity, Layer, Mlp};
use crate::math::Random;

/// Training example.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// Input values, as many as the network has inputs.
    pub input: Vec<f32>,
    /// Number of the class.
    pub class: usize,
}

/// Trains a network by gradient descent in mini-batches, with step sizes adapted to past gradients (Adam; Kingma and Ba
/// 2015). The loss is the cross-entropy.
#[derive(Debug, Clone)]
pub struct Trainer {
    /// Learning rate; 0.001 is common.
    pub rate: f32,
    /// Number of examples per step.
    pub batch: usize,
    /// Weight decay: the share of each weight that is subtracted, multiplied by the learning rate, in each step
    /// (Loshchilov and Hutter 2019).
    pub decay: f32,
    random: Random,
    steps: i32,
    /// Gradient, its mean, and the mean of its square, by layer.
    layers: Vec<[Layer; 3]>,
    activity: Activity,
    /// Derivatives of the loss with respect to the inputs of the neurons of a layer, and of those of the previous
    /// layer.
    errors: [Vec<f32>; 2],
}

impl Trainer {
    /// Creates a trainer for networks with the layer sizes of this one.
    pub fn new(network: &Mlp, seed: u64) -> Self {
        let zero = |layer: &Layer| Layer { bias: vec![0.0; layer.bias.len()], weights: vec![0.0; layer.weights.len()] };
        Self {
            rate: 1e-3,
            batch: 32,
            decay: 0.0,
            random: Random::new(seed),
            steps: 0,
            layers: network.layers().iter().map(|l| [zero(l), zero(l), zero(l)]).collect(),
            activity: Activity::default(),
            errors: Default::default(),
        }
    }

    /// Trains on all examples once, in random order, and returns the mean loss. Examples of classes that the network
    /// does not have are skipped.
    pub fn epoch(&mut self, network: &mut Mlp, examples: &[Example]) -> f32 {
        let mut order: Vec<usize> = (0..examples.len()).filter(|&i| examples[i].class < network.classes()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, (self.random.bits() % (i as u64 + 1)) as usize);
        }
        let mut loss = 0.0;
        for batch in order.chunks(self.batch.max(1)) {
            loss += batch.iter().map(|&i| self.show(network, &examples[i])).sum::<f32>();
            self.step(network, batch.len());
        }
        loss / order.len().max(1) as f32
    }

    /// Adds the gradient of one example and returns its loss.
    fn show(&mut self, network: &Mlp, example: &Example) -> f32 {
        let outputs = network.run(&example.input, &mut self.activity);
        let loss = -outputs[example.class].max(f32::MIN_POSITIVE).ln();
        let [errors, before] = &mut self.errors;
        errors.clear();
        errors.extend_from_slice(outputs);
        errors[example.class] -= 1.0;
        for (number, layer) in network.layers().iter().enumerate().rev() {
            let inputs = if number == 0 { &example.input[..] } else { self.activity.layer(number - 1) };
            let gradient = &mut self.layers[number][0];
            add(&mut gradient.bias, errors, 1.0);
            for (input, weights) in inputs.iter().zip(gradient.weights.chunks_exact_mut(errors.len())) {
                if *input != 0.0 {
                    add(weights, errors, *input);
                }
            }
            if number > 0 {
                before.clear();
                let rows = layer.weights.chunks_exact(errors.len());
                // The derivative of tanh is 1 − tanh².
                before.extend(inputs.iter().zip(rows).map(|(x, weights)| (1.0 - x * x) * dot(weights, errors)));
                std::mem::swap(errors, before);
            }
        }
        loss
    }

    /// Moves the weights against the mean gradient of a batch and resets the gradient.
    fn step(&mut self, network: &mut Mlp, batch: usize) {
        const MEAN: f32 = 0.9;
        const SQUARE: f32 = 0.999;
        self.steps = self.steps.saturating_add(1);
        // Both means start at 0; this corrects their bias in the first steps.
        let rate = self.rate * (1.0 - SQUARE.powi(self.steps)).sqrt() / (1.0 - MEAN.powi(self.steps));
        let (share, keep) = (1.0 / batch as f32, 1.0 - self.rate * self.decay);
        let update = |values: &mut [f32], gradient: &mut [f32], mean: &mut [f32], square: &mut [f32], keep: f32| {
            for i in 0..values.len() {
                let g = std::mem::take(&mut gradient[i]) * share;
                mean[i] = MEAN * mean[i] + (1.0 - MEAN) * g;
                square[i] = SQUARE * square[i] + (1.0 - SQUARE) * g * g;
                values[i] = keep * values[i] - rate * mean[i] / (square[i].sqrt() + 1e-8);
            }
        };
        for (layer, [gradient, mean, square]) in network.layers_mut().iter_mut().zip(&mut self.layers) {
            update(&mut layer.bias, &mut gradient.bias, &mut mean.bias, &mut square.bias, 1.0);
            update(&mut layer.weights, &mut gradient.weights, &mut mean.weights, &mut square.weights, keep);
        }
    }
}

/// `sum += values · factor`.
fn add(sum: &mut [f32], values: &[f32], factor: f32) {
    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points in a disc and in the ring around it.
    fn rings(count: usize, seed: u64) -> Vec<Example> {
        let mut random = Random::new(seed);
        let mut point = || {
            let (x, y) = (random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
            Example { input: vec![x, y], class: usize::from(x.hypot(y) > 0.7) }
        };
        (0..count).map(|_| point()).collect()
    }

    fn train(examples: &[Example], seed: u64) -> Mlp {
        let mut network = Mlp::new(&[2, 16, 2], &mut Random::new(seed));
        let mut trainer = Trainer { rate: 0.02, ..Trainer::new(&network, seed) };
        (0..60).for_each(|_| {
            trainer.epoch(&mut network, examples);
        });
        network
    }

    #[test]
    fn learns_what_no_line_separates() {
        let network = train(&rings(500, 1), 1);
        let mut activity = Activity::default();
        let unseen = rings(500, 2);
        let right = |e: &&Example| network.run(&e.input, &mut activity)[e.class] > 0.5;
        let right = unseen.iter().filter(right).count();
        assert!(right > 475, "{right} of 500");
    }

    #[test]
    fn the_same_seed_gives_the_same_network() {
        let examples = rings(50, 3);
        assert_eq!(train(&examples, 5), train(&examples, 5));
        assert_ne!(train(&examples, 5), train(&examples, 6));
    }

    #[test]
    fn the_gradient_is_that_of_the_loss() {
        let mut network = Mlp::new(&[3, 4, 2], &mut Random::new(4));
        let example = Example { input: vec![0.3, -0.8, 0.5], class: 1 };
        let mut trainer = Trainer::new(&network, 0);
        trainer.show(&network, &example);
        for layer in 0..2 {
            for weight in 0..network.layers()[layer].weights.len() {
                let mut loss_at = |step: f32| {
                    network.layers_mut()[layer].weights[weight] += step;
                    let loss = -network.run(&example.input, &mut Activity::default())[1].ln();
                    network.layers_mut()[layer].weights[weight] -= step;
                    loss
                };
                let numeric = (loss_at(1e-2) - loss_at(-1e-2)) / 2e-2;
                let gradient = trainer.layers[layer][0].weights[weight];
                assert!((numeric - gradient).abs() < 1e-3, "{layer} {weight}: {numeric} {gradient}");
            }
        }
    }

    #[test]
    fn odd_examples_do_no_harm() {
        let mut network = Mlp::new(&[2, 2], &mut Random::new(4));
        let mut trainer = Trainer::new(&network, 0);
        let odd = [Example { input: vec![], class: 0 }, Example { input: vec![1.0; 9], class: 1 }];
        assert!(trainer.epoch(&mut network, &odd).is_finite() && network.is_sound());
        assert_eq!(trainer.epoch(&mut network, &[Example { input: vec![], class: 2 }]), 0.0);
    }
}
