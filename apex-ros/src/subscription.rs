//! Subscriptions: from topics to the ports of a program.

use crate::{
    Error, Kind, Payload, Qos, Ros,
    endpoint::{Declared, Tell},
    ring::{Entrance, Ring},
    silence::Ours,
    time::RosTime,
};
use apex_messages::{Foreign, Message, Reason, cdr::Reader};
use apex_rt::PortSender;
use std::{
    sync::{Arc, Mutex, PoisonError, atomic::Ordering},
    time::{Duration, Instant},
};

/// A subscription before it begins.
#[must_use = "it begins with `feed` or `each`"]
pub struct Subscribing<'a> {
    ros: &'a Ros,
    topic: String,
    qos: Qos,
    /// Name of the message, if it is not that of the token's type.
    message: Option<&'static str>,
    part: String,
    frame: Option<String>,
    is_quiet: bool,
}

/// A subscription. It ends when the node is dropped.
pub struct Subscription(Arc<Ours>);

impl Subscription {
    /// Number of messages that have come.
    pub fn heard(&self) -> u64 {
        self.0.heard.load(Ordering::Relaxed)
    }

    /// Number of messages that made room for newer ones, because the program had not taken them yet.
    pub fn dropped(&self) -> u64 {
        self.0.dropped.load(Ordering::Relaxed)
    }
}

/// Most bytes after a message, which some writers add to align it.
const PADDING: usize = 3;

impl Ros {
    /// Begins a subscription of a topic. Names are those of ROS: `scan` is in the namespace of the node, `~/scan` below
    /// the node, `/scan` absolute; remappings hold.
    pub fn subscribe(&self, topic: &str) -> Subscribing<'_> {
        let (topic, qos, part) = (topic.to_owned(), Qos::DEFAULT, String::new());
        Subscribing { ros: self, topic, qos, message: None, part, frame: None, is_quiet: false }
    }
}

impl Subscribing<'_> {
    /// Asks for this quality of service.
    pub fn qos(self, qos: Qos) -> Self {
        Self { qos, ..self }
    }

    /// Takes messages that are not sent again when they are lost, as sensors publish them.
    pub fn best_effort(self) -> Self {
        Self { qos: self.qos.best_effort(), ..self }
    }

    /// Keeps this number of messages until the program takes them. A new message takes the place of the oldest.
    pub fn depth(self, depth: u32) -> Self {
        Self { qos: self.qos.depth(depth), ..self }
    }

    /// Takes the last messages from before the subscription, too: of `/map`, `/tf_static`.
    pub fn transient_local(self) -> Self {
        Self { qos: self.qos.transient_local(), ..self }
    }

    /// Says nothing if no node publishes: a topic that may be there or not.
    pub fn quiet(self) -> Self {
        Self { is_quiet: true, ..self }
    }

    /// Reads tokens from the message `M` instead of that of their type, for example a pose from odometry.
    pub fn of<M: Message>(self) -> Self {
        Self { message: Some(M::NAME), ..self }
    }

    /// Takes this part of the message: the transform `odom -> base_link` of `/tf`.
    pub fn part(self, part: &str) -> Self {
        Self { part: part.to_owned(), ..self }
    }

    /// Takes messages in this frame only, by their header. Another one is told, and its message is left out.
    pub fn in_frame(self, frame: &str) -> Self {
        Self { frame: Some(frame.to_owned()), ..self }
    }

    /// Puts the messages into a port of the program, as its tokens. The stamps of their headers become times of the
    /// program.
    ///
    /// # Errors
    /// The name is not one of ROS, or the type is not read from this message.
    pub fn feed<T: Message + Send + 'static>(self, port: PortSender<T>) -> Result<Subscription, Error> {
        let port = Arc::new(port);
        let at_once = Arc::clone(&port);
        self.take(move |token| port.send(token).is_ok(), Some(move |token| at_once.put(token).is_ok()))
    }

    /// Calls `act` with each message, on a thread of its own.
    ///
    /// # Errors
    /// The errors of [`Subscribing::feed`].
    pub fn each<T: Message + 'static>(self, mut act: impl FnMut(T) + Send + 'static) -> Result<Subscription, Error> {
        let act = move |token| {
            act(token);
            true
        };
        self.take(act, None::<fn(T) -> bool>)
    }

    /// Calls `act` with each token until it returns `false`. If nothing waits, a small message goes to `at_once` on the
    /// thread of the carrier: this saves the way through another thread. A token that it refuses is left to `act`.
    fn take<T: Message + 'static>(
        self,
        mut act: impl FnMut(T) -> bool + Send + 'static,
        at_once: Option<impl Fn(T) -> bool + Send + Sync + 'static>,
    ) -> Result<Subscription, Error> {
        let form: Foreign<T> = self.form()?;
        let Self { ros, topic, qos, part, frame, is_quiet, .. } = self;
        let endpoints = &ros.endpoints;
        let declared = endpoints.add(Kind::Subscription, &topic, (form.name, form.hash), qos, is_quiet)?;
        *declared.ours.missing() = (!part.is_empty()).then(|| part.clone());
        let (ring, entrance) = Ring::new(qos.kept());
        // The time of the simulation does not wait for itself.
        let is_clock = form.name == "rosgraph_msgs/msg/Clock";
        let complaints = Complaints::new(&declared, Arc::clone(&endpoints.tell));
        let reading = Reading {
            form,
            part,
            frame,
            ours: Arc::clone(&declared.ours),
            time: endpoints.time.clone(),
            is_clock,
            complaints: Mutex::new(complaints),
        };
        let reading = Arc::new(reading);
        let here = Arc::clone(&reading);
        // Two publishers may come at once, on two threads.
        let turn = Mutex::new(());
        let first = move |payload: &Payload, entrance: &Entrance<Payload>| {
            let Some(at_once) = at_once.as_ref().filter(|_| payload.size() <= SMALL && here.is_ready()) else {
                return false;
            };
            let Ok(_turn) = turn.try_lock() else { return false };
            entrance.is_idle() && here.read(payload).is_some_and(|token| token.is_none_or(at_once))
        };
        listen(ros, &declared, entrance, first)?;
        endpoints.spawn(&declared.ours.endpoint.name, move || {
            while let Some(payload) = ring.take() {
                let Some(token) = reading.read(&payload) else { break };
                if !token.is_none_or(&mut act) {
                    break;
                }
            }
        })?;
        Ok(Subscription(declared.ours))
    }

    /// The message from which tokens are read.
    fn form<T: Message>(&self) -> Result<Foreign<T>, Error> {
        let Some(wanted) = self.message else { return Ok(Foreign::itself()) };
        let mut forms: Vec<Foreign<T>> = T::others();
        forms.insert(0, Foreign::itself());
        let names: Vec<&str> = forms.iter().map(|form| form.name).collect();
        match names.iter().position(|name| *name == wanted) {
            Some(at) => Ok(forms.swap_remove(at)),
            None => Err(Error::new(format!(
                "`{}`: `{}` is not read from `{wanted}`, but from `{}`",
                self.topic,
                std::any::type_name::<T>(),
                names.join("`, `")
            ))),
        }
    }
}

/// Longest message that is read on the thread of the carrier, on which those of other topics wait, in bytes.
const SMALL: usize = 64 * 1024;

/// Reads the tokens of a subscription.
struct Reading<T> {
    form: Foreign<T>,
    part: String,
    frame: Option<String>,
    ours: Arc<Ours>,
    time: RosTime,
    /// `true` for `/clock`.
    is_clock: bool,
    complaints: Mutex<Complaints>,
}

impl<T> Reading<T> {
    /// Returns `true` if a token can be read without waiting for a time.
    fn is_ready(&self) -> bool {
        self.is_clock || self.time.is_known()
    }

    /// Reads a token. There is none if the message does not have the part, or cannot be read, which is told. Returns
    /// `None` if the node ends.
    fn read(&self, payload: &Payload) -> Option<Option<T>> {
        let zero = if self.is_clock { 0 } else { self.time.zero()? };
        let token = self.token(payload, zero).unwrap_or_else(|reason| {
            self.complaints.lock().unwrap_or_else(PoisonError::into_inner).add(&reason);
            None
        });
        Some(token)
    }

    /// Reads a token; `None` if the message does not have the part.
    fn token(&self, payload: &Payload, zero: i64) -> Result<Option<T>, Reason> {
        let bytes = payload.bytes();
        let mut reader = Reader::new(&bytes)?.since(zero);
        if let Some(frame) = &self.frame {
            reader = reader.in_frame(frame);
        }
        let Some(token) = (self.form.read)(&mut reader, &self.part)? else { return Ok(None) };
        if !self.part.is_empty() {
            *self.ours.missing() = None;
        }
        reader.check_frame()?;
        if reader.left() > PADDING { Err("bytes are left over".into()) } else { Ok(Some(token)) }
    }
}

/// Lets the messages of a topic into a ring, but for those that `first` takes.
fn listen(
    ros: &Ros,
    declared: &Declared,
    entrance: Entrance<Payload>,
    first: impl Fn(&Payload, &Entrance<Payload>) -> bool + Send + Sync + 'static,
) -> Result<(), Error> {
    let ours = Arc::clone(&declared.ours);
    let hear = move |payload: Payload| {
        ours.heard.fetch_add(1, Ordering::Relaxed);
        if !first(&payload, &entrance) && entrance.put(payload) {
            ours.dropped.fetch_add(1, Ordering::Relaxed);
        }
    };
    let endpoints = &ros.endpoints;
    endpoints.keep(endpoints.carrier.subscribe(&declared.token, Box::new(hear))?);
    Ok(())
}

/// Messages that could not be read, which are told now and then.
struct Complaints {
    topic: String,
    tell: Tell,
    count: u64,
    told: Option<Instant>,
}

/// Time between two complaints.
const PAUSE: Duration = Duration::from_secs(10);

impl Complaints {
    fn new(declared: &Declared, tell: Tell) -> Self {
        Self { topic: declared.ours.endpoint.name.clone(), tell, count: 0, told: None }
    }

    fn add(&mut self, reason: &str) {
        self.count += 1;
        if self.told.is_none_or(|told| told.elapsed() >= PAUSE) {
            self.told = Some(Instant::now());
            let (topic, count) = (&self.topic, self.count);
            (self.tell)(&format!("`{topic}`: a message cannot be read: {reason} ({count} of them so far)"));
        }
    }
}
