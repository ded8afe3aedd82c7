//! Messages as bytes: they are encoded and decoded elsewhere.

use apex_ros::Payload;
use rustdds::{
    RepresentationIdentifier,
    bytes::Bytes,
    no_key::{Decode, DefaultDecoder, DeserializerAdapter, SerializerAdapter},
};
use std::convert::Infallible;

/// Message in CDR, with its head of four bytes.
pub struct Raw(pub Bytes);

/// Length of the head.
pub const HEAD: usize = 4;

/// Adapter that leaves messages as they are.
pub struct Plain;

/// Decoder of [`Plain`].
#[derive(Clone)]
pub struct Whole;

impl From<Raw> for Payload {
    fn from(raw: Raw) -> Self {
        Vec::from(raw.0).into()
    }
}

const ENCODINGS: [RepresentationIdentifier; 2] = [RepresentationIdentifier::CDR_LE, RepresentationIdentifier::CDR_BE];

impl SerializerAdapter<Raw> for Plain {
    type Error = Infallible;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(value: &Raw) -> Result<Bytes, Infallible> {
        Ok(value.0.slice(HEAD.min(value.0.len())..))
    }
}

impl DeserializerAdapter<Raw> for Plain {
    type Error = Infallible;
    type Decoded = Raw;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &ENCODINGS
    }

    fn transform_decoded(decoded: Raw) -> Raw {
        decoded
    }
}

impl DefaultDecoder<Raw> for Plain {
    type Decoder = Whole;
    const DECODER: Whole = Whole;
}

impl Decode<'_, Raw> for Whole {
    type Error = Infallible;

    fn decode_bytes(self, bytes: &[u8], encoding: RepresentationIdentifier) -> Result<Raw, Infallible> {
        let mut whole = Vec::with_capacity(HEAD + bytes.len());
        whole.extend(encoding.to_bytes());
        whole.extend([0, 0]);
        whole.extend(bytes);
        Ok(Raw(whole.into()))
    }
}
