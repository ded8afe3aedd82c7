use crate::math::Random;
use serde::{Deserialize, Serialize};

/// Maximum number of inputs of a network.
pub const MAX_FEATURES: usize = 1024;

/// Input values of a classifier.
pub type Features = heapless::Vec<f32, MAX_FEATURES>;

/// Multilayer perceptron: tanh in the hidden layers and softmax in the last one, so that its outputs are the
/// probabilities of the classes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mlp {
    layers: Vec<Layer>,
}

/// Layer of a network: `outputs = bias + weights · inputs`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Bias by output.
    pub bias: Vec<f32>,
    /// Weights by input, and for each input by output.
    pub weights: Vec<f32>,
}

/// Outputs of all layers of a network for one input. Reused as storage.
#[derive(Debug, Clone, Default)]
pub struct Activity {
    layers: Vec<Vec<f32>>,
}

impl Activity {
    /// Outputs of a layer.
    pub fn layer(&self, layer: usize) -> &[f32] {
        self.layers.get(layer).map_or(&[], Vec::as_slice)
    }
}

impl Layer {
    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.weights.len().checked_div(self.bias.len()).unwrap_or(0)
    }

    /// Random weights of a size that neither weakens nor saturates the signal (Glorot and Bengio 2010).
    fn random(inputs: usize, outputs: usize, random: &mut Random) -> Self {
        let limit = (6.0 / (inputs + outputs) as f32).sqrt();
        let weights = (0..inputs * outputs).map(|_| random.uniform(-limit, limit)).collect();
        Self { bias: vec![0.0; outputs], weights }
    }

    fn apply(&self, inputs: &[f32], outputs: &mut Vec<f32>) {
        outputs.clone_from(&self.bias);
        for (input, weights) in inputs.iter().zip(self.weights.chunks_exact(self.bias.len())) {
            for (output, weight) in outputs.iter_mut().zip(weights) {
                *output += input * weight;
            }
        }
    }
}

impl Mlp {
    /// Creates an untrained network with these numbers of neurons in each layer, inputs first.
    pub fn new(sizes: &[usize], random: &mut Random) -> Self {
        Self { layers: sizes.windows(2).map(|w| Layer::random(w[0], w[1], random)).collect() }
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.layers.first().map_or(0, Layer::inputs)
    }

    /// Number of classes.
    pub fn classes(&self) -> usize {
        self.layers.last().map_or(0, |layer| layer.bias.len())
    }

    /// Layers, from input to output.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Layers for modification. Their sizes must not change.
    pub fn layers_mut(&mut self) -> &mut [Layer] {
        &mut self.layers
    }

    /// Returns `true` if the sizes of all layers are consistent and all weights are finite.
    pub fn is_sound(&self) -> bool {
        let whole = |l: &Layer| l.inputs() > 0 && l.inputs() * l.bias.len() == l.weights.len();
        let finite = |l: &Layer| l.bias.iter().chain(&l.weights).all(|w| w.is_finite());
        let fit = self.layers.windows(2).all(|w| w[0].bias.len() == w[1].inputs());
        fit && !self.layers.is_empty()
            && self.inputs() <= MAX_FEATURES
            && self.layers.iter().all(|l| whole(l) && finite(l))
    }

    /// Probabilities of the classes. Missing inputs count as 0; excess inputs are ignored.
    pub fn run<'a>(&self, inputs: &[f32], activity: &'a mut Activity) -> &'a [f32] {
        activity.layers.resize_with(self.layers.len(), Vec::new);
        for (number, layer) in self.layers.iter().enumerate() {
            let (before, rest) = activity.layers.split_at_mut(number);
            layer.apply(before.last().map_or(inputs, Vec::as_slice), &mut rest[0]);
            if number + 1 < self.layers.len() {
                rest[0].iter_mut().for_each(|x| *x = libm::tanhf(*x));
            } else {
                softmax(&mut rest[0]);
            }
        }
        activity.layers.last().map_or(&[], Vec::as_slice)
    }
}

/// Turns values into probabilities by the softmax function.
fn softmax(values: &mut [f32]) {
    // The largest value is subtracted, so that nothing overflows.
    let largest = values.iter().copied().fold(f32::MIN, f32::max);
    values.iter_mut().for_each(|x| *x = libm::expf(*x - largest));
    let sum: f32 = values.iter().sum();
    values.iter_mut().for_each(|x| *x /= sum);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_are_probabilities() {
        let network = Mlp::new(&[5, 7, 3], &mut Random::new(1));
        assert_eq!((network.inputs(), network.classes(), network.is_sound()), (5, 3, true));
        let mut activity = Activity::default();
        for inputs in [[0.0; 5], [1e30, -1e30, 0.0, 1.0, 2.0]] {
            let outputs = network.run(&inputs, &mut activity);
            assert!((outputs.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{outputs:?}");
        }
        assert_eq!(network.run(&[], &mut activity), network.run(&[0.0; 9], &mut Activity::default()));
    }

    #[test]
    fn a_network_by_hand() {
        let hidden = Layer { bias: vec![0.5, 0.0], weights: vec![1.0, 2.0] };
        let last = Layer { bias: vec![0.0, 0.0], weights: vec![1.0, 0.0, 0.0, 1.0] };
        let network = Mlp { layers: vec![hidden, last] };
        let mut activity = Activity::default();
        let outputs = network.run(&[0.3], &mut activity);
        let (a, b) = (0.8_f32.tanh().exp(), 0.6_f32.tanh().exp());
        assert!((outputs[0] - a / (a + b)).abs() < 1e-6);
        assert!((activity.layer(0)[1] - 0.6_f32.tanh()).abs() < 1e-6 && activity.layer(7).is_empty());
    }

    #[test]
    fn broken_networks_are_not_sound() {
        let layer = |bias: usize, weights: usize| Layer { bias: vec![0.0; bias], weights: vec![0.0; weights] };
        let nan = Layer { bias: vec![f32::NAN], weights: vec![1.0] };
        let broken = [vec![], vec![layer(0, 0)], vec![layer(2, 3)], vec![layer(2, 4), layer(2, 6)], vec![nan]];
        for layers in broken.into_iter().chain([vec![layer(1, MAX_FEATURES + 1)]]) {
            assert!(!Mlp { layers: layers.clone() }.is_sound(), "{layers:?}");
        }
        assert!(Mlp { layers: vec![layer(2, 4), layer(3, 6)] }.is_sound());
        assert!(Mlp { layers: vec![] }.run(&[1.0], &mut Activity::default()).is_empty());
    }
}
