//! Servers: requests with what names them, and the way back.

use crate::{
    Vendor,
    listen::{Listening, Reader, Sample},
    participant::Writer,
    raw::{HEAD, Raw},
};
use apex_ros::{Answer, Error, HearRequest};
use rustdds::{
    SampleIdentity, SequenceNumber, Timestamp, WriteOptionsBuilder,
    bytes::{Bytes, BytesMut},
};
use std::sync::Arc;

/// Length of the name of a request in the messages of Cyclone DDS.
pub const NAME: usize = 16;

/// Name of a request, which its response has, too.
enum Name {
    /// Bytes at the beginning of the messages.
    Within([u8; NAME]),
    /// Identity beside them.
    Beside(SampleIdentity),
}

/// Passes requests to `hear`.
pub fn start(
    name: &str,
    vendor: Vendor,
    reader: Reader,
    writer: Writer,
    hear: HearRequest,
) -> Result<Listening, Error> {
    let writer = Arc::new(writer);
    let take = move |sample: Sample| {
        let back = Arc::clone(&writer);
        let (name, request) = match vendor {
            Vendor::Fast => (Name::Beside(identity(&sample)), sample.into_value().0),
            // A message without a name is not a request of Cyclone DDS.
            Vendor::Cyclone => match split(&sample.into_value().0) {
                Some((name, request)) => (Name::Within(name), request),
                None => return,
            },
        };
        hear(Raw(request).into(), Box::new(Asked { name, writer: back }));
    };
    Listening::start(name, reader, take, || {})
}

/// Identity of a request beside the message. Fast DDS may leave the number to the message itself.
fn identity(sample: &Sample) -> SampleIdentity {
    let itself = SampleIdentity { writer_guid: sample.writer_guid(), sequence_number: sample.sequence_number };
    match sample.related_sample_identity() {
        Some(related) if related.sequence_number == SequenceNumber::UNKNOWN => {
            SampleIdentity { sequence_number: sample.sequence_number, ..related }
        }
        Some(related) => related,
        None => itself,
    }
}

/// Takes the name out of a message.
pub fn split(message: &Bytes) -> Option<([u8; NAME], Bytes)> {
    let name = message.get(HEAD..HEAD + NAME)?.try_into().ok()?;
    let mut rest = BytesMut::from(&message[..HEAD]);
    rest.extend_from_slice(&message[HEAD + NAME..]);
    Some((name, rest.freeze()))
}

/// Puts a name into a message. Its length is a multiple of all alignments.
pub fn join(name: [u8; NAME], message: &[u8]) -> Bytes {
    let head = HEAD.min(message.len());
    [&message[..head], &name, &message[head..]].concat().into()
}

struct Asked {
    name: Name,
    writer: Arc<Writer>,
}

impl Answer for Asked {
    fn answer(self: Box<Self>, response: Vec<u8>) {
        let options = WriteOptionsBuilder::new().source_timestamp(Timestamp::now());
        let (message, options) = match self.name {
            Name::Within(name) => (join(name, &response), options),
            Name::Beside(request) => (response.into(), options.related_sample_identity(request)),
        };
        // A client that has gone does not get it.
        drop(self.writer.write_with_options(Raw(message), options.build()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_between_head_and_body() {
        let name = std::array::from_fn(|i| i as u8);
        let message = join(name, &[0, 1, 0, 0, 7, 8]);
        assert_eq!((message[4], message[19], &message[20..]), (0, 15, &[7, 8][..]));
        assert_eq!(split(&message), Some((name, Bytes::from_static(&[0, 1, 0, 0, 7, 8]))));
        assert!((0..20).all(|end| split(&message.slice(..end)).is_none()));
    }
}
