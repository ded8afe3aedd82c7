//! Carriers of the messages of a node. The rest of the crate is the same over Zenoh and over others.

use crate::{Distribution, Endpoint, Error, Graph, Token};
use std::{any::Any, borrow::Cow, sync::Arc, time::Duration};
#[cfg(feature = "zenoh")]
use zenoh::bytes::ZBytes;

/// Something that ends when it is dropped: a subscription, a server, a token.
pub type Kept = Box<dyn Any + Send>;
/// Function that opens a carrier for a domain and a distribution.
pub type OpenCarrier = Box<dyn FnOnce(u32, Distribution) -> Result<Arc<dyn Carrier>, Error>>;
/// Function that gets the messages of a topic.
pub type Hear = Box<dyn Fn(Payload) + Send + Sync>;
/// Function that gets the requests of a service, with the way back.
pub type HearRequest = Box<dyn Fn(Payload, Box<dyn Answer>) + Send + Sync>;
/// Function that gets the responses to a request, or the reasons why there is none. It is dropped when no more come.
pub type HearResponse = Box<dyn Fn(Result<Payload, String>) + Send + Sync>;

/// Carrier of the messages of a node: Zenoh, or DDS. Messages are in CDR, with its head.
///
/// The token of an endpoint has all that is known of it: node, name, type, hash and quality.
pub trait Carrier: Send + Sync {
    /// Identification of this program in tokens.
    fn session(&self) -> String;

    /// Shows a node or an endpoint to others.
    ///
    /// # Errors
    /// It cannot be shown.
    fn show(&self, token: &Token) -> Result<Kept, Error>;

    /// Keeps a graph of the others up to date.
    ///
    /// # Errors
    /// The others cannot be looked for.
    fn look(&self, graph: Graph) -> Result<Kept, Error>;

    /// Opens a publisher.
    ///
    /// # Errors
    /// It cannot be opened.
    fn publish(&self, token: &Token) -> Result<Box<dyn Publish>, Error>;

    /// Opens a subscription.
    ///
    /// # Errors
    /// It cannot be opened.
    fn subscribe(&self, token: &Token, hear: Hear) -> Result<Kept, Error>;

    /// Offers a service.
    ///
    /// # Errors
    /// It cannot be offered.
    fn serve(&self, token: &Token, hear: HearRequest) -> Result<Kept, Error>;

    /// Opens a client, which waits for responses no longer than `timeout`.
    ///
    /// # Errors
    /// It cannot be opened.
    fn call(&self, token: &Token, timeout: Duration) -> Result<Box<dyn Ask>, Error>;

    /// Returns what has to fit so that two endpoints meet.
    fn rules(&self) -> Rules;

    /// Returns the reason in words for which no other program can be met; `None` if there is none.
    fn obstacle(&self) -> Option<String>;

    /// Returns the reason in words for which others may not be met; `None` if there is none.
    fn doubt(&self) -> Option<&'static str> {
        None
    }

    /// Returns the words for an obstacle that has gone.
    fn way_is_clear(&self) -> String;

    /// Ends everything.
    fn close(&self);
}

/// Parts that have to fit so that two endpoints of the same name and type meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rules {
    /// Hashes of types.
    pub hashes: bool,
    /// Quality of service.
    pub quality: bool,
}

/// Publisher of a topic.
pub trait Publish: Send + Sync {
    /// Sends a message.
    ///
    /// # Errors
    /// It cannot be sent.
    fn send(&self, message: Vec<u8>) -> Result<(), SendError>;

    /// Sends a message if that takes no wait for others. Returns `false` if it was not sent.
    ///
    /// # Errors
    /// It cannot be sent.
    fn send_at_once(&self, message: Vec<u8>) -> Result<bool, SendError>;
}

/// Reason why a message was not sent, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SendError {
    /// This one is lost; the next one may be sent.
    Lost(String),
    /// No more can be sent.
    Ended(String),
}

/// Way back for the response to a request.
pub trait Answer: Send {
    /// Answers. A client that has gone does not get it.
    fn answer(self: Box<Self>, response: Vec<u8>);
}

/// Client of a service.
pub trait Ask: Send + Sync {
    /// Sends a request. `hear` is dropped when no more responses come; at once if no node serves it.
    ///
    /// # Errors
    /// It cannot be sent, for the reason in words.
    fn ask(&self, request: Vec<u8>, hear: HearResponse) -> Result<(), String>;
}

/// Bytes of a message. Copies share them.
#[derive(Clone)]
pub struct Payload(Bytes);

#[derive(Clone)]
enum Bytes {
    Whole(Arc<Vec<u8>>),
    #[cfg(feature = "zenoh")]
    Zenoh(ZBytes),
}

impl Payload {
    /// Number of bytes.
    pub fn size(&self) -> usize {
        match &self.0 {
            Bytes::Whole(bytes) => bytes.len(),
            #[cfg(feature = "zenoh")]
            Bytes::Zenoh(bytes) => bytes.len(),
        }
    }

    /// Returns the bytes. They are copied only if the carrier has them in several parts.
    pub fn bytes(&self) -> Cow<'_, [u8]> {
        match &self.0 {
            Bytes::Whole(bytes) => Cow::Borrowed(bytes),
            #[cfg(feature = "zenoh")]
            Bytes::Zenoh(bytes) => bytes.to_bytes(),
        }
    }
}

impl From<Vec<u8>> for Payload {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Bytes::Whole(Arc::new(bytes)))
    }
}

#[cfg(feature = "zenoh")]
impl From<ZBytes> for Payload {
    fn from(bytes: ZBytes) -> Self {
        Self(Bytes::Zenoh(bytes))
    }
}

/// Returns the endpoint of a token, which a token of an endpoint has.
///
/// # Errors
/// It is the token of a node.
pub fn endpoint_of(token: &Token) -> Result<&Endpoint, Error> {
    token.endpoint.as_ref().ok_or_else(|| Error::new(format!("`{token}` is the token of a node")))
}
