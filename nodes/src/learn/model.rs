use super::Mlp;
use core::fmt;
use serde::{Deserialize, Serialize};

/// What each file of a model begins with: what it is, and the version of its format.
const MAGIC: &[u8] = b"apex-mlp 1\n";

/// A trained network, and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// What it was trained on, and by which program.
    pub provenance: String,
    /// The seed of that training.
    pub seed: u64,
    /// The network.
    pub network: Mlp,
}

/// Bytes that are no model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BadModel {
    /// They do not begin as a model does.
    Magic,
    /// They end too early, or are damaged.
    Content,
    /// The layers do not fit to each other, or a weight is no finite number.
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
    /// The model as the bytes of a file.
    pub fn to_bytes(&self) -> Vec<u8> {
        // A `Vec` takes all that there is.
        postcard::to_extend(self, MAGIC.to_vec()).unwrap_or_default()
    }

    /// Reads what [`to_bytes`](Self::to_bytes) wrote.
    ///
    /// # Errors
    /// If the bytes are anything else.
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
