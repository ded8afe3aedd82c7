use super::Mlp;
use core::fmt;
use serde::{Deserialize, Serialize};

/// First bytes of each model file: its type and the version of its format.
const MAGIC: &[u8] = b"apex-mlp 1\n";

/// Trained network with its provenance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Training data and program of the training.
    pub provenance: String,
    /// Seed of the training.
    pub seed: u64,
    /// Trained network.
    pub network: Mlp,
}

/// Error of bytes that are not a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BadModel {
    /// The bytes do not begin like a model.
    Magic,
    /// The bytes end too early, or are damaged.
    Content,
    /// The sizes of the layers are inconsistent, or a weight is not finite.
    Network,
}

impl fmt::Display for BadModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Magic => "this is no model: it does not begin with `apex-mlp 1`",
            Self::Content => "the model is damaged: it ends too early or holds what is no network",
            Self::Network => "the model is damaged: its layers do not fit to each other, or a weight is not finite",
        })
    }
}

impl std::error::Error for BadModel {}

impl Model {
    /// Serializes the model to the bytes of a file.
    pub fn to_bytes(&self) -> Vec<u8> {
        // Writing to a `Vec` cannot fail.
        postcard::to_extend(self, MAGIC.to_vec()).unwrap_or_default()
    }

    /// Reads a model written by [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// If the bytes are not a valid model.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BadModel> {
        let content = bytes.strip_prefix(MAGIC).ok_or(BadModel::Magic)?;
        let (model, rest) = postcard::take_from_bytes::<Self>(content).map_err(|_| BadModel::Content)?;
        match () {
            () if !rest.is_empty() => Err(BadModel::Content),
            () if !model.network.is_sound() => Err(BadModel::Network),
            () => Ok(model),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn models_come_back_and_damaged_ones_do_not() {
        let network = Mlp::new(&[4, 3, 2], &mut Random::new(1));
        let model = Model { provenance: "a test".into(), seed: 1, network };
        let bytes = model.to_bytes();
        assert_eq!(Model::from_bytes(&bytes), Ok(model.clone()));
        assert!((0..bytes.len()).all(|len| Model::from_bytes(&bytes[..len]).is_err()));
        assert_eq!(Model::from_bytes(b"GIF89a"), Err(BadModel::Magic));
        assert_eq!(Model::from_bytes(&[&bytes[..], &[0]].concat()), Err(BadModel::Content));
        let mut odd = model;
        odd.network.layers_mut()[0].bias.pop();
        assert_eq!(Model::from_bytes(&odd.to_bytes()), Err(BadModel::Network));
    }
}
