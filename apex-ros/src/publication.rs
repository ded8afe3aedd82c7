//! Publishers: from the events of a program to topics.

use crate::{
    Error, Kind, Qos, Ros,
    carrier::{Publish, SendError},
    endpoint::Tell,
    time::RosTime,
};
use apex_messages::Message;
use apex_rt::PortReceiver;
use std::{
    marker::PhantomData,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    time::{Duration, Instant},
};

/// A publisher before it begins.
#[must_use = "it begins with `take` or `open`"]
#[derive(Clone)]
pub struct Publishing<'a> {
    ros: &'a Ros,
    topic: String,
    qos: Qos,
    frame: Option<String>,
    is_quiet: bool,
}

/// A publisher of another message than that of the tokens' type, before it begins.
#[must_use = "it begins with `take`"]
pub struct PublishingAs<'a, M>(Publishing<'a>, PhantomData<fn() -> M>);

/// A publisher of the message `M`. It ends when the node is dropped, or with itself.
pub struct Publisher<M> {
    way: Box<dyn Publish>,
    frame: Option<String>,
    time: RosTime,
    topic: String,
    message: PhantomData<fn(M)>,
}

/// Time between two complaints about lost messages.
const PAUSE: Duration = Duration::from_secs(10);

impl Ros {
    /// Begins a publisher of a topic.
    pub fn publish(&self, topic: &str) -> Publishing<'_> {
        Publishing { ros: self, topic: topic.to_owned(), qos: Qos::DEFAULT, frame: None, is_quiet: false }
    }
}

impl<'a> Publishing<'a> {
    /// Offers this quality of service.
    pub fn qos(self, qos: Qos) -> Self {
        Self { qos, ..self }
    }

    /// Does not send messages again that are lost.
    pub fn best_effort(self) -> Self {
        Self { qos: self.qos.best_effort(), ..self }
    }

    /// Keeps this number of messages for subscriptions that come later, if the publisher keeps any.
    pub fn depth(self, depth: u32) -> Self {
        Self { qos: self.qos.depth(depth), ..self }
    }

    /// Keeps the last messages for subscriptions that come later, as `/map` and `/tf_static` need.
    pub fn transient_local(self) -> Self {
        Self { qos: self.qos.transient_local(), ..self }
    }

    /// Writes this frame into all headers: the types of the library do not name their frame.
    pub fn frame(self, frame: &str) -> Self {
        Self { frame: Some(frame.to_owned()), ..self }
    }

    /// Says nothing if no node subscribes: a topic for tools.
    pub fn quiet(self) -> Self {
        Self { is_quiet: true, ..self }
    }

    /// Writes tokens as the message `M` instead of that of their type, for example a twist with a stamp.
    pub fn of<M: Message>(self) -> PublishingAs<'a, M> {
        PublishingAs(self, PhantomData)
    }

    /// Publishes the tokens of an event of the program. Times in their headers become those of ROS.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn take<T: Message + Send + 'static>(self, port: PortReceiver<T>) -> Result<(), Error> {
        self.forward(port, None, Publisher::encode)
    }

    /// Publishes the tokens of an event, and `last` when the program has ended: a twist of zero, say.
    ///
    /// # Errors
    /// The errors of [`Publishing::take`].
    pub fn take_ending_with<T: Message + Send + 'static>(self, port: PortReceiver<T>, last: T) -> Result<(), Error> {
        self.forward(port, Some(last), Publisher::encode)
    }

    /// Returns a publisher for use in Rust.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn open<M: Message>(self) -> Result<Publisher<M>, Error> {
        let Self { ros, topic, qos, frame, is_quiet } = self;
        let endpoints = &ros.endpoints;
        let declared = endpoints.add(Kind::Publisher, &topic, (M::NAME, M::HASH), qos, is_quiet)?;
        let topic = declared.ours.endpoint.name.clone();
        let way = endpoints.carrier.publish(&declared.token)?;
        Ok(Publisher { way, frame, time: endpoints.time.clone(), topic, message: PhantomData })
    }

    /// Publishes the tokens of an event, which `encode` makes messages: small ones on the thread of the program if none
    /// waits before them, the others on a thread of their own.
    fn forward<T: Send + 'static, M: Message + 'static>(
        self,
        port: PortReceiver<T>,
        last: Option<T>,
        encode: fn(&Publisher<M>, &T) -> Vec<u8>,
    ) -> Result<(), Error> {
        let (endpoints, publisher) = (&self.ros.endpoints, self.clone().open::<M>()?);
        let (topic, tell) = (publisher.topic.clone(), endpoints.tell.clone());
        let forwarding = Arc::new(Forwarding {
            publisher,
            encode,
            last: Mutex::new(last),
            size: AtomicUsize::new(usize::MAX),
            tell,
            told: Mutex::default(),
        });
        let (voice, here) = (Arc::clone(&endpoints.voice), Arc::clone(&forwarding));
        voice.at_silence(move || here.say_last());
        let (leave, here) = (Arc::clone(&voice), Arc::clone(&forwarding));
        port.at_once(move |token| {
            let _leave = leave.leave()?;
            (!here.send_at_once(&token)).then_some(token)
        });
        endpoints.spawn(&topic, move || {
            while let Some(token) = port.receive().as_ref() {
                let Some(leave) = voice.leave() else { continue };
                if !forwarding.send(token) {
                    break;
                }
                drop(leave);
            }
            forwarding.say_last();
        })
    }
}

/// Longest message that is sent on the thread of the program, which waits for it, in bytes.
const SMALL: usize = 64 * 1024;

/// Publication of the tokens of an event.
struct Forwarding<T, M> {
    publisher: Publisher<M>,
    encode: fn(&Publisher<M>, &T) -> Vec<u8>,
    /// Token that is sent at the end.
    last: Mutex<Option<T>>,
    /// Size of the last message, in bytes.
    size: AtomicUsize,
    tell: Tell,
    /// Time of the last complaint.
    told: Mutex<Option<Instant>>,
}

impl<T, M: Message> Forwarding<T, M> {
    fn encode(&self, token: &T) -> Vec<u8> {
        let bytes = (self.encode)(&self.publisher, token);
        self.size.store(bytes.len(), Ordering::Relaxed);
        bytes
    }

    /// Sends a token. Returns `false` if no more can be sent.
    fn send(&self, token: &T) -> bool {
        let sent = self.publisher.send_bytes(self.encode(token));
        sent.inspect_err(|error| self.complain(error)).map_or_else(|error| error.is_passing(), |()| true)
    }

    /// Sends a token without a wait, if the last message was small. Returns `false` if it was not sent; what went wrong
    /// shows the next time.
    fn send_at_once(&self, token: &T) -> bool {
        let is_small = self.size.load(Ordering::Relaxed) <= SMALL;
        is_small && self.publisher.way.send_at_once(self.encode(token)).unwrap_or(false)
    }

    /// Says what went wrong; messages that are lost now and then.
    fn complain(&self, error: &Error) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if !error.is_passing() || told.is_none_or(|told| told.elapsed() >= PAUSE) {
            *told = Some(Instant::now());
            (self.tell)(&error.to_string());
        }
    }

    fn say_last(&self) {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let sent = last.as_ref().map(|last| self.publisher.send_bytes(self.encode(last)));
        if let Some(Err(error)) = sent {
            (self.tell)(&error.to_string());
        }
    }
}

impl<M: Message + 'static> PublishingAs<'_, M> {
    /// Publishes the tokens of an event of the program, converted to `M`.
    ///
    /// # Errors
    /// The errors of [`Publishing::take`].
    pub fn take<T: Send + 'static>(self, port: PortReceiver<T>) -> Result<(), Error>
    where
        M: for<'t> From<&'t T>,
    {
        self.0.forward(port, None, |publisher: &Publisher<M>, token| publisher.encode(&token.into()))
    }

    /// Publishes the tokens of an event, converted to `M`, and `last` when the program has ended.
    ///
    /// # Errors
    /// The errors of [`Publishing::take`].
    pub fn take_ending_with<T: Send + 'static>(self, port: PortReceiver<T>, last: T) -> Result<(), Error>
    where
        M: for<'t> From<&'t T>,
    {
        self.0.forward(port, Some(last), |publisher: &Publisher<M>, token| publisher.encode(&token.into()))
    }
}

impl<M: Message> Publisher<M> {
    /// Publishes a message. A header without stamp gets the present time.
    ///
    /// # Errors
    /// The node has ended, or the message is lost.
    pub fn send(&self, message: &M) -> Result<(), Error> {
        self.send_bytes(self.encode(message))
    }

    fn encode(&self, message: &M) -> Vec<u8> {
        self.time.write(message, self.frame.as_deref())
    }

    fn send_bytes(&self, bytes: Vec<u8>) -> Result<(), Error> {
        self.way.send(bytes).map_err(|error| match error {
            SendError::Lost(reason) => Error::passing(format!("`{}`: a message is lost: {reason}", self.topic)),
            SendError::Ended(reason) => Error::new(format!("`{}` cannot be published: {reason}", self.topic)),
        })
    }
}
