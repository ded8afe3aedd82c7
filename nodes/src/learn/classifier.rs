use super::{Activity, BadForest, BadModel, Features, Forest, Model};
use apex_rt::{Out, node};

/// Result of a classification.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Class {
    /// Number of the class.
    pub number: u32,
    /// Probability of the class, from 0 to 1.
    pub confidence: f32,
}

/// Classifies features by a multilayer perceptron (thesis 4.3.2, 4.3.3).
///
/// ⊥ if no class is probable enough, if the number of features is not the number of inputs of the network, or if a
/// feature is not a number. Fails if the model cannot be read.
#[node]
#[derive(Debug, Clone)]
pub struct Classifier {
    /// Bytes of the [`Model`]: a constant such as [`DIGITS`](super::DIGITS), or `include_bytes!` of a file.
    #[param]
    model: &'static [u8],
    /// Minimum confidence.
    #[param(default = 0.5, range = 0.0..=1.0)]
    threshold: f32,
    loaded: Option<Model>,
    activity: Activity,
}

#[node]
impl Classifier {
    fn process(&mut self, features: &Features, class: &mut Out<Class>) -> Result<(), BadModel> {
        let network = match &mut self.loaded {
            Some(model) => &model.network,
            None => &self.loaded.insert(Model::from_bytes(self.model)?).network,
        };
        if features.len() == network.inputs() {
            let probabilities = network.run(features, &mut self.activity);
            let best = probabilities.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            // False for NaN.
            if let Some((number, confidence)) = best.filter(|(_, confidence)| *confidence >= self.threshold) {
                class.set(Class { number: number as u32, confidence });
            }
        }
        Ok(())
    }
}

/// Classifies features by a forest of decision trees into the classes 0 and 1 (thesis 6.8.1).
///
/// ⊥ if neither class is probable enough, if the number of features is not the number of inputs of the forest, or if a
/// feature is not a number. Fails if the model cannot be read.
#[node]
#[derive(Debug, Clone)]
pub struct ForestClassifier {
    /// Bytes of the [`Forest`], for example `include_bytes!` of a file.
    #[param]
    model: &'static [u8],
    /// Minimum confidence.
    #[param(default = 0.5, range = 0.0..=1.0)]
    threshold: f32,
    loaded: Option<Forest<'static>>,
}

#[node]
impl ForestClassifier {
    fn process(&mut self, features: &Features) -> Result<Option<Class>, BadForest> {
        let forest = match self.loaded {
            Some(forest) => forest,
            None => *self.loaded.insert(Forest::from_bytes(self.model)?),
        };
        let class = |p: f32| {
            if p > 0.5 { Class { number: 1, confidence: p } } else { Class { number: 0, confidence: 1.0 - p } }
        };
        Ok(forest.probability(features).map(class).filter(|class| class.confidence >= self.threshold))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learn::{Mlp, TreeNode, forest_bytes},
        math::Random,
    };
    use apex_rt::Construct;

    /// A network that maps input 1 to class 1 and input 0 to class 0.
    fn model() -> &'static [u8] {
        let mut network = Mlp::new(&[1, 2], &mut Random::new(1));
        network.layers_mut()[0].weights = vec![-4.0, 4.0];
        network.layers_mut()[0].bias = vec![2.0, -2.0];
        Model { provenance: String::new(), seed: 1, network }.to_bytes().leak()
    }

    fn classify(model: &'static [u8], features: &[f32]) -> Result<Option<u32>, BadModel> {
        let mut out = Out::new();
        Classifier::construct((model, 0.9)).process(&features.iter().copied().collect(), &mut out)?;
        Ok(out.get().map(|class| class.number))
    }

    #[test]
    fn says_the_class_or_bottom() {
        assert_eq!(classify(model(), &[1.0]), Ok(Some(1)));
        assert_eq!(classify(model(), &[0.0]), Ok(Some(0)));
        for unclear in [&[0.5][..], &[], &[1.0, 1.0], &[f32::NAN]] {
            assert_eq!(classify(model(), unclear), Ok(None), "{unclear:?}");
        }
    }

    #[test]
    fn a_bad_model_is_an_error() {
        assert_eq!(classify(b"nothing", &[1.0]), Err(BadModel::Magic));
    }

    #[test]
    fn a_forest_says_the_class_or_bottom() {
        let split = TreeNode::Split { feature: 0, threshold: 0.0, right: 2 };
        let tree = vec![split, TreeNode::Leaf(0.1), TreeNode::Leaf(0.7)];
        let bytes: &'static [u8] = forest_bytes("", 1, 1, &[tree]).leak();
        let classify = |features: &[f32]| {
            ForestClassifier::construct((bytes, 0.8)).process(&features.iter().copied().collect()).expect("a model")
        };
        assert_eq!(classify(&[-1.0]).map(|class| class.number), Some(0));
        for unclear in [&[1.0][..], &[], &[f32::NAN]] {
            assert_eq!(classify(unclear), None);
        }
        let empty = Features::new();
        assert_eq!(ForestClassifier::construct((&b"no"[..], 0.5)).process(&empty), Err(BadForest::Magic));
    }
}
