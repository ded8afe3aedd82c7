use super::{Example, Mlp};
use crate::math::Random;

/// Number of passes over all examples.
const PASSES: usize = 200;

/// Trains a linear support vector machine for the classes 0 and 1, by coordinate descent on its dual (Hsieh et al.
/// 2008).
///
/// `costs` are the costs of an error for an example of either class; larger ones fit the examples more closely. The
/// result is a network of one layer, whose outputs are the probabilities of the classes: 0.5 at the separating plane,
/// and 0.88 at the margin. Examples with another number of inputs than the first one, or with inputs that are not
/// numbers, are skipped.
pub fn train_svm(examples: &[Example], costs: [f32; 2], seed: u64) -> Mlp {
    let inputs = examples.first().map_or(0, |example| example.input.len());
    let sound = |e: &&Example| e.class < 2 && e.input.len() == inputs && e.input.iter().all(|x| x.is_finite());
    let examples: Vec<&Example> = examples.iter().filter(sound).collect();
    let mut random = Random::new(seed);
    // The bias is the weight of a further input of 1.
    let mut weights = vec![0.0_f32; inputs + 1];
    let mut duals = vec![0.0_f32; examples.len()];
    let mut order: Vec<usize> = (0..examples.len()).collect();
    for _ in 0..PASSES {
        for i in (1..order.len()).rev() {
            order.swap(i, (random.bits() % (i as u64 + 1)) as usize);
        }
        let mut largest = 0.0_f32;
        for &i in &order {
            let (input, sign) = (&examples[i].input, if examples[i].class == 1 { 1.0 } else { -1.0 });
            let margin = sign * (dot(&weights, input) + weights[inputs]);
            let square = 1.0 + dot(input, input);
            let new = (duals[i] - (margin - 1.0) / square).clamp(0.0, costs[examples[i].class]);
            let step = sign * (new - duals[i]);
            duals[i] = new;
            if step != 0.0 {
                weights.iter_mut().zip(input.iter().chain(&[1.0])).for_each(|(w, x)| *w += step * x);
                largest = largest.max(step.abs());
            }
        }
        if largest < 1e-5 {
            break;
        }
    }
    plane(&weights, inputs)
}

/// Network whose outputs depend on the distance from a plane.
fn plane(weights: &[f32], inputs: usize) -> Mlp {
    let mut network = Mlp::new(&[inputs, 2], &mut Random::new(0));
    let layer = &mut network.layers_mut()[0];
    layer.bias = vec![-weights[inputs], weights[inputs]];
    layer.weights = weights[..inputs].iter().flat_map(|w| [-w, *w]).collect();
    network
}

/// Scalar product of as many numbers as both have.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::Activity;

    #[test]
    fn the_widest_margin_is_found() {
        let example = |x: f32, y: f32, class: usize| Example { input: vec![x, y], class };
        let examples = [
            example(1.0, 0.0, 1),
            example(1.0, 5.0, 1),
            example(-1.0, 0.0, 0),
            example(-1.0, -9.0, 0),
            example(-3.0, 2.0, 0),
        ];
        let network = train_svm(&examples, [100.0; 2], 1);
        let layer = &network.layers()[0];
        assert!((layer.weights[1] - 1.0).abs() < 0.02 && layer.weights[3].abs() < 0.02, "{layer:?}");
        assert!(layer.bias[1].abs() < 0.02, "{layer:?}");
        let probability = network.run(&[1.0, 0.0], &mut Activity::default())[1];
        assert!((probability - 0.88).abs() < 0.01, "{probability}");
    }

    #[test]
    fn odd_examples_do_no_harm() {
        let odd = |input: Vec<f32>, class: usize| Example { input, class };
        for list in [vec![], vec![odd(vec![1.0], 0), odd(vec![f32::NAN], 1), odd(vec![], 1), odd(vec![1.0], 7)]] {
            let network = train_svm(&list, [1.0; 2], 1);
            assert!(network.layers()[0].weights.iter().all(|w| w.is_finite()), "{list:?}");
        }
    }
}
