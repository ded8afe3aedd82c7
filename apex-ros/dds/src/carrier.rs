//! A participant of DDS as the carrier of a node.

use crate::{
    Vendor,
    call::Client,
    known::session,
    listen::{Listening, Sample},
    name::{self, Topic},
    nodes::{self, Node},
    participant::{Participant, Writer},
    qos::{policies, policies_of_publisher},
    raw::Raw,
    serve,
};
use apex_ros::{
    Ask, Carrier, Distribution, Error, Graph, Hear, HearRequest, Kept, Publish, Rules, SendError, Token, endpoint_of,
};
use rustdds::{GUID, RTPSEntity as _, StatusEvented as _, Timestamp, dds::WriteError};
use std::{
    net::IpAddr,
    pin::pin,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    task::{Context, Poll, Waker},
    thread,
    time::Duration,
};

/// Time between two looks at the discovery.
const LOOK: Duration = Duration::from_millis(10);
/// Longest wait for the last message of a publisher to arrive.
const FAREWELL: Duration = Duration::from_millis(300);

/// Settings of the carrier.
#[derive(Debug, Clone, Default)]
pub struct Dds {
    vendor: Option<Vendor>,
    networks: Vec<IpAddr>,
}

/// Opens the carrier with the settings of the environment: `RMW_IMPLEMENTATION`, and `ROS_AUTOMATIC_DISCOVERY_RANGE` or
/// `ROS_LOCALHOST_ONLY`.
///
/// # Errors
/// The domain is too large, or the participant cannot be opened.
pub fn open(domain: u32, distribution: Distribution) -> Result<Arc<dyn Carrier>, Error> {
    Dds::default().open(domain, distribution)
}

impl Dds {
    /// Settings of the environment.
    pub fn new() -> Self {
        Self::default()
    }

    /// Calls and offers services as this implementation does.
    #[must_use]
    pub fn vendor(self, vendor: Vendor) -> Self {
        Self { vendor: Some(vendor), ..self }
    }

    /// Uses the networks with these addresses of this machine alone.
    #[must_use]
    pub fn networks(self, addresses: impl IntoIterator<Item = IpAddr>) -> Self {
        Self { networks: addresses.into_iter().collect(), ..self }
    }

    /// Opens the carrier: `Ros::node("rover").over(|domain, distribution| settings.open(domain, distribution))`.
    ///
    /// # Errors
    /// The domain is too large, or the participant cannot be opened.
    pub fn open(self, domain: u32, distribution: Distribution) -> Result<Arc<dyn Carrier>, Error> {
        let participant = Arc::new(Participant::open(self.networks, domain, distribution)?);
        Ok(Arc::new(OverDds { participant, vendor: self.vendor, looking: Mutex::default(), is_over: Arc::default() }))
    }
}

/// A participant as a carrier.
struct OverDds {
    participant: Arc<Participant>,
    vendor: Option<Vendor>,
    /// Threads that follow the others.
    looking: Mutex<Vec<Kept>>,
    is_over: Arc<AtomicBool>,
}

impl OverDds {
    /// The vendor, without which there are no services.
    fn vendor(&self) -> Result<Vendor, Error> {
        self.vendor.map_or_else(Vendor::of_environment, Ok)
    }

    /// Follows the discovery of DDS.
    fn follow(&self) -> Result<(), Error> {
        let (participant, is_over) = (Arc::clone(&self.participant), Arc::clone(&self.is_over));
        let events = participant.domain.status_listener();
        let follow = move || {
            while !is_over.load(Ordering::Acquire) {
                while let Some(event) = events.try_recv_status() {
                    participant.known.note(event);
                }
                thread::sleep(LOOK);
            }
        };
        let thread = thread::Builder::new().name("dds-discovery".to_owned()).spawn(follow);
        thread.map(drop).map_err(|error| Error::new(format!("the thread `dds-discovery` cannot be started: {error}")))
    }
}

impl Carrier for OverDds {
    fn session(&self) -> String {
        session(self.participant.domain.guid())
    }

    fn show(&self, token: &Token) -> Result<Kept, Error> {
        // Endpoints are shown when they are opened.
        if token.endpoint.is_none() {
            let (namespace, name) = (token.namespace.clone(), token.node.clone());
            self.participant.change(|node| (node.namespace, node.name) = (namespace, name));
        }
        Ok(Box::new(()))
    }

    fn look(&self, graph: Graph) -> Result<Kept, Error> {
        self.participant.known.tell(graph);
        self.follow()?;
        let topic = Topic { name: nodes::TOPIC.to_owned(), ty: nodes::TYPE.to_owned() };
        let (reader, known) = (self.participant.reader(&topic, &nodes::policies())?, self.participant.known.clone());
        let hear = move |sample: Sample| {
            // What is not a message of this topic says nothing about nodes.
            if let Ok((program, nodes)) = nodes::read(&sample.into_value().0) {
                known.name(program, nodes);
            }
        };
        let listening = Listening::start("dds-nodes", reader, hear, || {})?;
        self.looking.lock().unwrap_or_else(PoisonError::into_inner).push(Box::new(listening));
        Ok(Box::new(()))
    }

    fn publish(&self, token: &Token) -> Result<Box<dyn Publish>, Error> {
        let endpoint = endpoint_of(token)?;
        let writer = self.participant.writer(&name::data(endpoint), &policies_of_publisher(&endpoint.qos))?;
        Ok(Box::new(Publisher { writer, participant: Arc::clone(&self.participant) }))
    }

    fn subscribe(&self, token: &Token, hear: Hear) -> Result<Kept, Error> {
        let endpoint = endpoint_of(token)?;
        let reader = self.participant.reader(&name::data(endpoint), &policies(&endpoint.qos))?;
        let id = reader.guid();
        let hear = move |sample: Sample| hear(sample.into_value().into());
        let listening = Listening::start(&endpoint.name, reader, hear, || {})?;
        Ok(Box::new(Ends { ids: vec![id], participant: Arc::clone(&self.participant), _listening: listening }))
    }

    fn serve(&self, token: &Token, hear: HearRequest) -> Result<Kept, Error> {
        let endpoint = endpoint_of(token)?;
        let (vendor, [requests, responses]) = (self.vendor()?, name::service(endpoint));
        let policies = policies(&endpoint.qos);
        let (reader, writer) =
            (self.participant.reader(&requests, &policies)?, self.participant.writer(&responses, &policies)?);
        let ids = vec![reader.guid(), writer.guid()];
        let listening = serve::start(&endpoint.name, vendor, reader, writer, hear)?;
        Ok(Box::new(Ends { ids, participant: Arc::clone(&self.participant), _listening: listening }))
    }

    fn call(&self, token: &Token, timeout: Duration) -> Result<Box<dyn Ask>, Error> {
        let endpoint = endpoint_of(token)?;
        Ok(Box::new(Client::open(&self.participant, endpoint, self.vendor()?, timeout)?))
    }

    fn rules(&self) -> Rules {
        Rules { hashes: false, quality: true }
    }

    fn obstacle(&self) -> Option<String> {
        None
    }

    fn way_is_clear(&self) -> String {
        "others can be met".to_owned()
    }

    fn close(&self) {
        self.is_over.store(true, Ordering::Release);
        self.looking.lock().unwrap_or_else(PoisonError::into_inner).clear();
        self.participant.change(|node| *node = Node::default());
    }
}

impl Drop for OverDds {
    fn drop(&mut self) {
        self.close();
    }
}

/// Reads messages, until it is dropped.
struct Ends {
    ids: Vec<GUID>,
    participant: Arc<Participant>,
    _listening: Listening,
}

impl Drop for Ends {
    fn drop(&mut self) {
        self.ids.iter().for_each(|id| self.participant.remove(*id));
    }
}

struct Publisher {
    writer: Writer,
    participant: Arc<Participant>,
}

impl Publish for Publisher {
    fn send(&self, message: Vec<u8>) -> Result<(), SendError> {
        self.writer.write(Raw(message.into()), Some(Timestamp::now())).map_err(unsent)
    }

    fn send_at_once(&self, message: Vec<u8>) -> Result<bool, SendError> {
        // The first look at whether there is room, without the wait for it.
        let write = pin!(self.writer.async_write(Raw(message.into()), Some(Timestamp::now())));
        match write.poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(sent) => sent.map(|()| true).map_err(unsent),
            Poll::Pending => Ok(false),
        }
    }
}

/// Reason why a message was not written.
fn unsent(error: WriteError<Raw>) -> SendError {
    match error {
        WriteError::WouldBlock { .. } => SendError::Lost("a subscription takes none at present".to_owned()),
        error => SendError::Ended(format!("DDS: {error}")),
    }
}

impl Drop for Publisher {
    fn drop(&mut self) {
        // The last message, a twist of zero say, is to arrive.
        drop(self.writer.wait_for_acknowledgments(FAREWELL));
        self.participant.remove(self.writer.guid());
    }
}
