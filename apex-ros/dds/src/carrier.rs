//! A participant of DDS as the carrier of a node.

use crate::{
    Vendor,
    call::Client,
    known::{Known, Ours, session},
    listen::{Listening, Reader},
    name::{self, Topic},
    nodes::{self, Node},
    qos::{policies, policies_of_publisher},
    raw::{Plain, Raw},
    serve,
};
use apex_ros::{
    Ask, Carrier, Distribution, Error, Graph, Hear, HearRequest, Kept, Payload, Publish, Rules, SendError, Token,
    endpoint_of,
};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, GUID, QosPolicies, QosPolicyBuilder, RTPSEntity as _,
    StatusEvented as _, Timestamp, TopicKind, dds::WriteError, no_key::DataWriter,
};
use std::{
    env,
    net::{IpAddr, Ipv4Addr},
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

/// Writer of a topic.
pub type Writer = DataWriter<Raw, Plain>;

/// Largest domain: above, the ports of DDS are used up.
const LAST_DOMAIN: u32 = 232;
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
        Ok(Arc::new(Participant::open(self, domain, distribution)?))
    }
}

/// Returns `true` if the environment keeps programs on this machine.
fn is_local() -> bool {
    let is = |name: &str, value: &str| env::var(name).is_ok_and(|it| it == value);
    is("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST") || is("ROS_LOCALHOST_ONLY", "1")
}

/// Returns the error of DDS in doing `what`.
pub fn dds<E: std::fmt::Display>(what: String) -> impl FnOnce(E) -> Error {
    move |error| Error::new(format!("{what}: DDS: {error}"))
}

/// Participant, with what its endpoints share.
struct Participant {
    inner: Arc<Inner>,
    vendor: Option<Vendor>,
    /// Threads that follow the others.
    looking: Mutex<Vec<Kept>>,
    is_over: Arc<AtomicBool>,
}

/// Parts of a participant that its endpoints need.
pub struct Inner {
    participant: DomainParticipant,
    publisher: rustdds::Publisher,
    subscriber: rustdds::Subscriber,
    ours: Mutex<Ours>,
    info: Writer,
    pub known: Known,
}

impl Participant {
    fn open(settings: Dds, domain: u32, distribution: Distribution) -> Result<Self, Error> {
        let number = u16::try_from(domain).ok().filter(|_| domain <= LAST_DOMAIN).ok_or_else(|| {
            Error::new(format!(
                "the domain {domain} is too large for DDS: set `ROS_DOMAIN_ID` to at most {LAST_DOMAIN}"
            ))
        })?;
        let mut networks = settings.networks;
        if networks.is_empty() && is_local() {
            networks.push(Ipv4Addr::LOCALHOST.into());
        }
        let mut builder = DomainParticipantBuilder::new(number);
        if !networks.is_empty() {
            builder = builder.with_only_networks(networks);
        }
        let participant = builder.build().map_err(dds("the participant cannot be opened".to_owned()))?;
        let inner = Arc::new(Inner::new(participant, domain, nodes::length_of(distribution))?);
        Ok(Self { inner, vendor: settings.vendor, looking: Mutex::default(), is_over: Arc::default() })
    }

    /// The vendor, without which there are no services.
    fn vendor(&self) -> Result<Vendor, Error> {
        self.vendor.map_or_else(Vendor::of_environment, Ok)
    }

    /// Follows the discovery of DDS.
    fn follow(&self) -> Result<(), Error> {
        let (inner, is_over) = (Arc::clone(&self.inner), Arc::clone(&self.is_over));
        let events = inner.participant.status_listener();
        let follow = move || {
            while !is_over.load(Ordering::Acquire) {
                while let Some(event) = events.try_recv_status() {
                    inner.known.note(event);
                }
                thread::sleep(LOOK);
            }
        };
        let thread = thread::Builder::new().name("dds-discovery".to_owned()).spawn(follow);
        thread.map(drop).map_err(|error| Error::new(format!("the thread `dds-discovery` cannot be started: {error}")))
    }
}

impl Inner {
    fn new(participant: DomainParticipant, domain: u32, length: usize) -> Result<Self, Error> {
        let what = || "the participant cannot be opened".to_owned();
        let plain = QosPolicyBuilder::new().build();
        let publisher = participant.create_publisher(&plain).map_err(dds(what()))?;
        let subscriber = participant.create_subscriber(&plain).map_err(dds(what()))?;
        let (name, ty) = (nodes::TOPIC.to_owned(), nodes::TYPE.to_owned());
        let topic = participant.create_topic(name, ty, &nodes::policies(), TopicKind::NoKey).map_err(dds(what()))?;
        let info = publisher.create_datawriter_no_key(&topic, None).map_err(dds(what()))?;
        let ours = Ours { node: Node::default(), program: participant.guid(), length };
        Ok(Self { participant, publisher, subscriber, ours: Mutex::new(ours), info, known: Known::new(domain) })
    }

    /// Opens a reader.
    pub fn reader(&self, topic: &Topic, policies: &QosPolicies) -> Result<Reader, Error> {
        let what = || format!("`{}` cannot be read", topic.name);
        let (name, ty) = (topic.name.clone(), topic.ty.clone());
        let topic = self.participant.create_topic(name, ty, policies, TopicKind::NoKey).map_err(dds(what()))?;
        let reader: Reader = self.subscriber.create_simple_datareader_no_key(&topic, None).map_err(dds(what()))?;
        let id = reader.guid();
        self.change(|node| node.readers.push(id));
        Ok(reader)
    }

    /// Opens a writer.
    pub fn writer(&self, topic: &Topic, policies: &QosPolicies) -> Result<Writer, Error> {
        let what = || format!("`{}` cannot be written", topic.name);
        let (name, ty) = (topic.name.clone(), topic.ty.clone());
        let topic = self.participant.create_topic(name, ty, policies, TopicKind::NoKey).map_err(dds(what()))?;
        let writer: Writer = self.publisher.create_datawriter_no_key(&topic, None).map_err(dds(what()))?;
        let id = writer.guid();
        self.change(|node| node.writers.push(id));
        Ok(writer)
    }

    /// Takes an endpoint that has ended from the node.
    pub fn remove(&self, id: GUID) {
        self.change(|node| {
            node.readers.retain(|it| *it != id);
            node.writers.retain(|it| *it != id);
        });
    }

    /// Changes the node, and tells the others.
    fn change(&self, change: impl FnOnce(&mut Node)) {
        let mut ours = self.ours();
        change(&mut ours.node);
        // Only a participant that has ended cannot tell.
        drop(self.info.write(Raw(ours.message().into()), Some(Timestamp::now())));
    }

    fn ours(&self) -> MutexGuard<'_, Ours> {
        self.ours.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Carrier for Participant {
    fn session(&self) -> String {
        session(self.inner.participant.guid())
    }

    fn show(&self, token: &Token) -> Result<Kept, Error> {
        // Endpoints are shown when they are opened.
        if token.endpoint.is_none() {
            let (namespace, name) = (token.namespace.clone(), token.node.clone());
            self.inner.change(|node| (node.namespace, node.name) = (namespace, name));
        }
        Ok(Box::new(()))
    }

    fn look(&self, graph: Graph) -> Result<Kept, Error> {
        self.inner.known.tell(graph);
        self.follow()?;
        let topic = Topic { name: nodes::TOPIC.to_owned(), ty: nodes::TYPE.to_owned() };
        let (reader, known) = (self.inner.reader(&topic, &nodes::policies())?, self.inner.known.clone());
        let hear = move |sample: crate::listen::Sample| {
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
        let writer = self.inner.writer(&name::data(endpoint), &policies_of_publisher(&endpoint.qos))?;
        Ok(Box::new(Publisher { writer, inner: Arc::clone(&self.inner) }))
    }

    fn subscribe(&self, token: &Token, hear: Hear) -> Result<Kept, Error> {
        let endpoint = endpoint_of(token)?;
        let reader = self.inner.reader(&name::data(endpoint), &policies(&endpoint.qos))?;
        let id = reader.guid();
        let hear = move |sample: crate::listen::Sample| hear(payload(sample.into_value()));
        let listening = Listening::start(&endpoint.name, reader, hear, || {})?;
        Ok(Box::new(Ends { ids: vec![id], inner: Arc::clone(&self.inner), _listening: listening }))
    }

    fn serve(&self, token: &Token, hear: HearRequest) -> Result<Kept, Error> {
        let endpoint = endpoint_of(token)?;
        let (vendor, [requests, responses]) = (self.vendor()?, name::service(endpoint));
        let policies = policies(&endpoint.qos);
        let (reader, writer) = (self.inner.reader(&requests, &policies)?, self.inner.writer(&responses, &policies)?);
        let ids = vec![reader.guid(), writer.guid()];
        let listening = serve::start(&endpoint.name, vendor, reader, writer, hear)?;
        Ok(Box::new(Ends { ids, inner: Arc::clone(&self.inner), _listening: listening }))
    }

    fn call(&self, token: &Token, timeout: Duration) -> Result<Box<dyn Ask>, Error> {
        let endpoint = endpoint_of(token)?;
        Ok(Box::new(Client::open(&self.inner, endpoint, self.vendor()?, timeout)?))
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
        self.inner.change(|node| *node = Node::default());
    }
}

impl Drop for Participant {
    fn drop(&mut self) {
        self.close();
    }
}

/// Payload of a message.
pub fn payload(raw: Raw) -> Payload {
    Vec::from(raw.0).into()
}

/// Reads messages, until it is dropped.
struct Ends {
    ids: Vec<GUID>,
    inner: Arc<Inner>,
    _listening: Listening,
}

impl Drop for Ends {
    fn drop(&mut self) {
        self.ids.iter().for_each(|id| self.inner.remove(*id));
    }
}

struct Publisher {
    writer: Writer,
    inner: Arc<Inner>,
}

impl Publish for Publisher {
    fn send(&self, message: Vec<u8>) -> Result<(), SendError> {
        self.writer.write(Raw(message.into()), Some(Timestamp::now())).map_err(|error| match error {
            WriteError::WouldBlock { .. } => SendError::Lost("a subscription takes none at present".to_owned()),
            error => SendError::Ended(format!("DDS: {error}")),
        })
    }
}

impl Drop for Publisher {
    fn drop(&mut self) {
        // The last message, a twist of zero say, is to arrive.
        drop(self.writer.wait_for_acknowledgments(FAREWELL));
        self.inner.remove(self.writer.guid());
    }
}
