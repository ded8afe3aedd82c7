//! Services: requests and responses.

use crate::{
    Error, Kind, Payload, Qos, Ros,
    carrier::{Answer, Ask},
    endpoint::Tell,
    ring::Ring,
    time::RosTime,
};
use apex_messages::Service;
use apex_rt::{PortReceiver, PortSender};
use std::{
    marker::PhantomData,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    time::Duration,
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
    is_quiet: bool,
    service: PhantomData<fn() -> S>,
}

/// Client of a service. It ends when the node is dropped, or with itself.
pub struct Client<S> {
    way: Box<dyn Ask>,
    name: String,
    timeout: Duration,
    time: RosTime,
    tell: Tell,
    /// `true` if it was told that a response cannot be read.
    told: Arc<AtomicBool>,
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
        Calling { ros: self, name: name.to_owned(), timeout: TIMEOUT, is_quiet: false, service: PhantomData }
    }
}

impl<S: Service + 'static> Serving<'_, S>
where
    S::Request: Send,
{
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
        let (ring, entrance) = Ring::new(ROOM);
        let hear = move |request: S::Request, asked: Asked<S>| {
            entrance.put((request, asked));
        };
        listen(self.ros, &self.name, self.is_quiet, hear)?;
        endpoints.spawn(&self.name, move || {
            while let Some((request, asked)) = ring.take() {
                match answer(request) {
                    Some(response) => asked.answer(&response),
                    None => break,
                }
            }
        })
    }
}

/// Offers a service, and passes its requests to `hear` on a thread of the carrier. Those that cannot be read are told.
pub fn listen<S: Service + 'static>(
    ros: &Ros,
    name: &str,
    is_quiet: bool,
    hear: impl Fn(S::Request, Asked<S>) + Send + Sync + 'static,
) -> Result<(), Error> {
    let endpoints = &ros.endpoints;
    let declared = endpoints.add(Kind::Server, name, (S::NAME, S::HASH), Qos::DEFAULT, is_quiet)?;
    let name = declared.ours.endpoint.name.clone();
    let (tell, time) = (Arc::clone(&endpoints.tell), endpoints.time.clone());
    let hear = move |request: Payload, back: Box<dyn Answer>| match time.read(&request.bytes()) {
        Ok(request) => hear(request, Asked { back, time: time.clone(), service: PhantomData }),
        Err(reason) => tell(&format!("`{name}`: a request cannot be read: {reason}")),
    };
    endpoints.keep(endpoints.carrier.serve(&declared.token, Box::new(hear))?);
    Ok(())
}

/// Request that waits for its response.
pub struct Asked<S> {
    back: Box<dyn Answer>,
    time: RosTime,
    service: PhantomData<fn() -> S>,
}

impl<S: Service> Asked<S> {
    /// Answers. A client that has gone does not get it.
    pub fn answer(self, response: &S::Response) {
        self.back.answer(self.time.write(response, None));
    }
}

impl<S: Service + 'static> Calling<'_, S> {
    /// Waits for a response no longer than this.
    pub fn timeout(self, timeout: Duration) -> Self {
        Self { timeout, ..self }
    }

    /// Says nothing if no node serves it.
    pub(crate) fn quiet(self) -> Self {
        Self { is_quiet: true, ..self }
    }

    /// Returns a client for use in Rust.
    ///
    /// # Errors
    /// The name is not one of ROS.
    pub fn open(self) -> Result<Client<S>, Error> {
        let endpoints = &self.ros.endpoints;
        let declared = endpoints.add(Kind::Client, &self.name, (S::NAME, S::HASH), Qos::DEFAULT, self.is_quiet)?;
        let name = declared.ours.endpoint.name.clone();
        let way = endpoints.carrier.call(&declared.token, self.timeout)?;
        let (timeout, time, tell) = (self.timeout, endpoints.time.clone(), Arc::clone(&endpoints.tell));
        Ok(Client { way, name, timeout, time, tell, told: Arc::default(), service: PhantomData })
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
        let (sender, responses) = mpsc::channel();
        let hear = move |response| drop(sender.send(response));
        let asked = self.way.ask(self.time.write(request, None), Box::new(hear));
        asked.map_err(|reason| Error::new(format!("`{name}` cannot be called: {reason}")))?;
        match responses.recv_timeout(self.timeout) {
            Ok(Ok(response)) => self.response(&response.bytes()),
            Ok(Err(why)) => Err(Error::new(format!("`{name}`: no response has come within {seconds} s: {why}"))),
            Err(RecvTimeoutError::Timeout) => {
                Err(Error::new(format!("`{name}`: no response has come within {seconds} s")))
            }
            Err(RecvTimeoutError::Disconnected) => {
                Err(Error::new(format!("no node serves `{name}`, or its server ended before it answered")))
            }
        }
    }

    /// Calls the service. `then` gets the first response on a thread of the carrier, or `None` if there will be none.
    pub(crate) fn begin(&self, request: &S::Request, then: impl FnOnce(Option<S::Response>) + Send + 'static)
    where
        S: 'static,
    {
        let (once, name) = (Once(Mutex::new(Some(then)), PhantomData), self.name.clone());
        let (time, tell, told) = (self.time.clone(), Arc::clone(&self.tell), Arc::clone(&self.told));
        let hear = move |response: Result<Payload, String>| {
            let Ok(response) = response else { return };
            match time.read(&response.bytes()) {
                Ok(response) => once.call(Some(response)),
                Err(_) if told.swap(true, Ordering::Relaxed) => {}
                Err(reason) => tell(&format!("`{name}`: a response cannot be read: {reason}")),
            }
        };
        // A carrier that is closed drops the function, which calls `then`.
        drop(self.way.ask(self.time.write(request, None), Box::new(hear)));
    }

    fn response(&self, bytes: &[u8]) -> Result<S::Response, Error> {
        let name = &self.name;
        self.time.read(bytes).map_err(|reason| Error::new(format!("`{name}`: the response cannot be read: {reason}")))
    }
}

/// Function that is called once: with a response, or without one at the end.
struct Once<T, F: FnOnce(Option<T>)>(Mutex<Option<F>>, PhantomData<fn(T)>);

impl<T, F: FnOnce(Option<T>)> Once<T, F> {
    fn call(&self, response: Option<T>) {
        let then = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(then) = then {
            then(response);
        }
    }
}

impl<T, F: FnOnce(Option<T>)> Drop for Once<T, F> {
    fn drop(&mut self) {
        self.call(None);
    }
}
