//! Publishers: from the events of a program to topics.

use crate::{
    Error, Kind, Qos, Ros,
    carrier::{Publish, SendError},
    time::RosTime,
};
use apex_messages::Message;
use apex_rt::PortReceiver;
use std::{
    marker::PhantomData,
    sync::{Arc, Mutex, PoisonError},
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
        self.forward(port, None, |publisher, token| publisher.send(token))
    }

    /// Publishes the tokens of an event, and `last` when the program has ended: a twist of zero, say.
    ///
    /// # Errors
    /// The errors of [`Publishing::take`].
    pub fn take_ending_with<T: Message + Send + 'static>(self, port: PortReceiver<T>, last: T) -> Result<(), Error> {
        self.forward(port, Some(last), |publisher, token| publisher.send(token))
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

    /// Publishes the tokens of an event by `send`, on a thread of its own.
    fn forward<T: Send + 'static, M: Message + 'static>(
        self,
        port: PortReceiver<T>,
        last: Option<T>,
        send: fn(&Publisher<M>, &T) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let ros = self.ros;
        let (publisher, tell) = (Arc::new(self.open::<M>()?), ros.endpoints.tell.clone());
        let (last, voice) = (Arc::new(Mutex::new(last)), Arc::clone(&ros.endpoints.voice));
        let say_last = {
            let (publisher, tell) = (Arc::clone(&publisher), ros.endpoints.tell.clone());
            move || {
                let last = last.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(Err(error)) = last.as_ref().map(|last| send(&publisher, last)) {
                    tell(&error.to_string());
                }
            }
        };
        voice.at_silence(say_last.clone());
        let mut told: Option<Instant> = None;
        ros.endpoints.spawn(&publisher.topic.clone(), move || {
            while let Some(token) = port.receive().as_ref() {
                let Some(leave) = voice.leave() else { continue };
                if let Err(error) = send(&publisher, token) {
                    // Messages that are lost are told now and then.
                    if !error.is_passing() || told.is_none_or(|told| told.elapsed() >= PAUSE) {
                        told = Some(Instant::now());
                        tell(&error.to_string());
                    }
                    if !error.is_passing() {
                        break;
                    }
                }
                drop(leave);
            }
            say_last();
        })
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
        self.0.forward(port, None, |publisher: &Publisher<M>, token| publisher.send(&token.into()))
    }

    /// Publishes the tokens of an event, converted to `M`, and `last` when the program has ended.
    ///
    /// # Errors
    /// The errors of [`Publishing::take`].
    pub fn take_ending_with<T: Send + 'static>(self, port: PortReceiver<T>, last: T) -> Result<(), Error>
    where
        M: for<'t> From<&'t T>,
    {
        self.0.forward(port, Some(last), |publisher: &Publisher<M>, token| publisher.send(&token.into()))
    }
}

impl<M: Message> Publisher<M> {
    /// Publishes a message. A header without stamp gets the present time.
    ///
    /// # Errors
    /// The node has ended, or the message is lost.
    pub fn send(&self, message: &M) -> Result<(), Error> {
        let bytes = self.time.write(message, self.frame.as_deref());
        self.way.send(bytes).map_err(|error| match error {
            SendError::Lost(reason) => Error::passing(format!("`{}`: a message is lost: {reason}", self.topic)),
            SendError::Ended(reason) => Error::new(format!("`{}` cannot be published: {reason}", self.topic)),
        })
    }
}
