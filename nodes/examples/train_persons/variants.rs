use crate::crops::{Crop, Descriptor};
use apex_nodes::{
    learn::{Activity, Example, Forest, ForestTrainer, Mlp, Model, Trainer, train_svm},
    math::Random,
};

/// Method of classification.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    Svm,
    Forest,
    Boosted,
    Mlp,
}

impl Method {
    pub const ALL: [Self; 4] = [Self::Svm, Self::Forest, Self::Boosted, Self::Mlp];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Svm => "svm",
            Self::Forest => "forest",
            Self::Boosted => "boosted",
            Self::Mlp => "mlp",
        }
    }
}

/// Trained classifier.
pub enum Trained {
    Network(Mlp),
    Forest(Vec<u8>),
}

impl Trained {
    /// Probability of a person.
    pub fn probability(&self, features: &[f32]) -> f32 {
        match self {
            Self::Network(network) => network.run(features, &mut Activity::default()).get(1).copied().unwrap_or(0.0),
            Self::Forest(bytes) => {
                Forest::from_bytes(bytes).ok().and_then(|forest| forest.probability(features)).unwrap_or(0.0)
            }
        }
    }

    /// Bytes of the model, for a `Classifier` or a `ForestClassifier`.
    pub fn to_bytes(&self, provenance: &str, seed: u64) -> Vec<u8> {
        match self {
            Self::Network(network) => {
                Model { provenance: provenance.to_owned(), seed, network: network.clone() }.to_bytes()
            }
            Self::Forest(bytes) => bytes.clone(),
        }
    }
}

/// Trains a variant.
pub fn train(descriptor: Descriptor, method: Method, crops: &[&Crop], seed: u64) -> Trained {
    let example = |crop: &&Crop| Example { input: descriptor.of(crop).to_vec(), class: usize::from(crop.is_person) };
    let examples: Vec<Example> = crops.iter().map(example).collect();
    let provenance = format!("trained by the example train_persons on {} regions", crops.len());
    match method {
        Method::Svm => Trained::Network(train_svm(&examples, [0.02, 0.1], seed)),
        Method::Forest => {
            let trainer = ForestTrainer { trees: 150, depth: 14, min_leaf: 2, features: 30, seed };
            Trained::Forest(trainer.random_forest(&examples, &provenance))
        }
        Method::Boosted => {
            let trainer = ForestTrainer { trees: 150, depth: 2, min_leaf: 4, features: 60, seed };
            Trained::Forest(trainer.boosted(&examples, &provenance))
        }
        Method::Mlp => Trained::Network(network(&examples, seed)),
    }
}

/// Trains a network with one hidden layer. Persons are shown more often, as there are fewer of them.
fn network(examples: &[Example], seed: u64) -> Mlp {
    const EPOCHS: u32 = 15;
    const REPETITIONS: usize = 3;
    let inputs = examples.first().map_or(0, |example| example.input.len());
    let mut network = Mlp::new(&[inputs, 24, 2], &mut Random::new(seed));
    let mut trainer = Trainer::new(&network, seed);
    trainer.decay = 0.5;
    let again = examples.iter().filter(|e| e.class == 1).flat_map(|e| std::iter::repeat_n(e, REPETITIONS - 1));
    let shown: Vec<Example> = examples.iter().chain(again).cloned().collect();
    for epoch in 0..EPOCHS {
        trainer.rate = 1e-3 * 0.1_f32.powf(epoch as f32 / EPOCHS as f32);
        trainer.epoch(&mut network, &shown);
    }
    network
}
