//! Services: requests and responses, as queries of Zenoh and their replies.

use crate::{Attachment, Error, Kind, Qos, Ros, ring::Ring, time::calendar};
use apex_messages::{Message, Service};
use apex_rt::{PortReceiver, PortSender};
use std::{
    marker::PhantomData,
    sync::{
        Arc,
        atomic::{AtomicI64, Ordering},
    },
    time::Duration,
};
use zenoh::{
    Wait as _,
    bytes::ZBytes,
    query::{ConsolidationMode, Querier, Query, QueryTarget},
};

/// Requests that wait at a server. A client whose request makes room for another one gets no response.
const ROOM: usize = 100;

/// A service of this node, before it is offered.
#[must_use = "it is offered with `by` or `through`"]
pub struct Serving<'a, S> {
    ros: &'a Ros,
    name: String,
    is_quiet: bool,
    service: PhantomData<fn() -> S>,
}

/// A service of another node, before it is called.
#[must_use = "it is called with `open` or `through`"]
pub struct Calling<'a, S> {
    ros: &'a Ros,
    name: String,
    timeout: Duration,
    service: PhantomData<fn() -> S>,
}

/// Client of a service. It ends when the node is dropped, or with itself.
pub struct Client<S> {
    querier: Querier<'static>,
    id: [u8; 16],
    number: AtomicI64,
    name: String,
    timeout: Duration,
    service: PhantomData<fn() -> S>,
}

/// Time to wait for a response by default.
const TIMEOUT: Duration = Duration::from_secs(10);

impl Ros {
    /// Begins a service of this node.
    pub fn serve<S: Service>(&self, name: &str) -> Serving<'_, S> {
        Serving { ros: self, name: name.to_owned(), is_quiet: true, service: PhantomData }
    }

    /// Begins a client of a service of another node.
    pub fn call<S: Service>(&self, name: &str) -> Calling<'_, S> {
        Calling { ros: self, name: name.to_owned(), timeout: TIMEOUT, service: PhantomData }
    }
}

impl<S: Service + 'static> Serving<'_, S> {
    /// Answers requests by a function, which is called on a thread of its own.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn by(self, mut answer: impl FnMut(S::Request) -> S::Response + Send + 'static) -> Result<(), Error> {
        self.answer(move |request| Some(answer(request)))
    }

    /// Lets the program answer: requests go into a slot, and an event has the responses, one for each request and in
    /// their order. As long as the program does not answer, other requests wait.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn through(self, slot: PortSender<S::Request>, event: PortReceiver<S::Response>) -> Result<(), Error>
    where
        S::Request: Send,
        S::Response: Send,
    {
        self.answer(move |request| {
            slot.send(request).ok()?;
            event.receive()
        })
    }

    /// Answers requests until `answer` returns `None`.
    fn answer(self, mut answer: impl FnMut(S::Request) -> Option<S::Response> + Send + 'static) -> Result<(), Error> {
        let endpoints = &self.ros.endpoints;
        let declared = endpoints.add(Kind::Server, &self.name, (S::NAME, S::HASH), Qos::DEFAULT, self.is_quiet)?;
        let name = declared.ours.endpoint.name.clone();
        let (ring, entrance) = Ring::new(ROOM);
        let hear = move |query: Query| {
            entrance.put(query);
        };
        let queryable = endpoints.zenoh.declare_queryable(declared.key.clone()).complete(true).callback(hear).wait();
        endpoints.keep(queryable.map_err(Error::zenoh(&format!("`{name}` cannot be served")))?);
        let (tell, key) = (Arc::clone(&endpoints.tell), declared.key);
        endpoints.spawn(&name.clone(), move || {
            while let Some(query) = ring.take() {
                let request = query.payload().map(ZBytes::to_bytes).unwrap_or_default();
                match S::Request::from_bytes(&request) {
                    Ok(request) => match answer(request) {
                        Some(response) => reply(&query, &key, &response),
                        None => break,
                    },
                    Err(reason) => tell(&format!("`{name}`: a request cannot be read: {reason}")),
                }
            }
        })
    }
}

/// Replies with the number and the client of the request. A client that has gone does not get it.
fn reply(query: &Query, key: &str, response: &impl Message) {
    let asked = query.attachment().and_then(|attachment| Attachment::read(&attachment.to_bytes()));
    let (number, sender) = asked.map_or((0, [0; 16]), |asked| (asked.number, asked.sender));
    let attachment = Attachment { number, time: calendar(), sender }.to_bytes();
    drop(query.reply(key, response.to_bytes()).attachment(attachment.to_vec()).wait());
}

impl<S: Service + 'static> Calling<'_, S> {
    /// Waits for a response no longer than this.
    pub fn timeout(self, timeout: Duration) -> Self {
        Self { timeout, ..self }
    }

    /// Returns a client for use in Rust.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn open(self) -> Result<Client<S>, Error> {
        let endpoints = &self.ros.endpoints;
        let declared = endpoints.add(Kind::Client, &self.name, (S::NAME, S::HASH), Qos::DEFAULT, false)?;
        let name = declared.ours.endpoint.name.clone();
        let querier = endpoints
            .zenoh
            .declare_querier(declared.key)
            .target(QueryTarget::AllComplete)
            .consolidation(ConsolidationMode::None)
            .timeout(self.timeout)
            .wait()
            .map_err(Error::zenoh(&format!("`{name}` cannot be called")))?;
        let (id, number, timeout) = (declared.id, AtomicI64::new(1), self.timeout);
        Ok(Client { querier, id, number, name, timeout, service: PhantomData })
    }

    /// Calls the service with the tokens of an event, one after the other, and puts the responses into a slot. A call
    /// without a response is told, and nothing is put in: the program needs a `timeout`.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn through(self, event: PortReceiver<S::Request>, slot: PortSender<S::Response>) -> Result<(), Error>
    where
        S::Request: Send,
        S::Response: Send,
    {
        let ros = self.ros;
        let (client, tell) = (self.open()?, Arc::clone(&ros.endpoints.tell));
        ros.endpoints.spawn(&client.name.clone(), move || {
            while let Some(request) = event.receive() {
                match client.ask(&request).map(|response| slot.send(response)) {
                    Ok(Ok(())) => {}
                    Ok(Err(_)) => break,
                    Err(error) => tell(&error.to_string()),
                }
            }
        })
    }
}

impl<S: Service> Client<S> {
    /// Calls the service and waits for its response.
    ///
    /// # Errors
    /// No node serves it, no response comes in time, or it cannot be read.
    pub fn ask(&self, request: &S::Request) -> Result<S::Response, Error> {
        let (name, seconds) = (&self.name, self.timeout.as_secs_f32());
        let number = self.number.fetch_add(1, Ordering::Relaxed);
        let attachment = Attachment { number, time: calendar(), sender: self.id }.to_bytes();
        let replies = self.querier.get().payload(request.to_bytes()).attachment(attachment.to_vec()).wait();
        let replies = replies.map_err(Error::zenoh(&format!("`{name}` cannot be called")))?;
        let reply = match replies.recv_timeout(self.timeout) {
            Ok(Some(reply)) => reply,
            Ok(None) => return Err(Error::new(format!("`{name}`: no response has come within {seconds} s"))),
            Err(_) => {
                return Err(Error::new(format!("no node serves `{name}`, or its server ended before it answered")));
            }
        };
        let sample = reply.into_result().map_err(|error| {
            let why = String::from_utf8_lossy(&error.payload().to_bytes()).into_owned();
            Error::new(format!("`{name}`: no response has come within {seconds} s: {why}"))
        })?;
        S::Response::from_bytes(&sample.payload().to_bytes())
            .map_err(|reason| Error::new(format!("`{name}`: the response cannot be read: {reason}")))
    }
}
