//! The participant of DDS that is the node: its readers and writers, and what the others are told of them.

use crate::{
    known::{Known, Ours},
    listen::Reader,
    name::Topic,
    nodes::{self, Node},
    raw::{Plain, Raw},
};
use apex_ros::{Distribution, Error};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, GUID, QosPolicies, QosPolicyBuilder, RTPSEntity as _, Timestamp,
    TopicKind, no_key::DataWriter,
};
use std::{
    env,
    net::{IpAddr, Ipv4Addr},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// Writer of a topic.
pub type Writer = DataWriter<Raw, Plain>;

/// Largest domain: above, the ports of DDS are used up.
const LAST_DOMAIN: u32 = 232;

/// Participant, with what its endpoints share.
pub struct Participant {
    pub domain: DomainParticipant,
    publisher: rustdds::Publisher,
    subscriber: rustdds::Subscriber,
    ours: Mutex<Ours>,
    info: Writer,
    pub known: Known,
}

impl Participant {
    /// Opens a participant on the networks with these addresses; without any, on all that the environment allows.
    pub fn open(mut networks: Vec<IpAddr>, domain: u32, distribution: Distribution) -> Result<Self, Error> {
        let number = u16::try_from(domain).ok().filter(|_| domain <= LAST_DOMAIN).ok_or_else(|| {
            Error::new(format!(
                "the domain {domain} is too large for DDS: set `ROS_DOMAIN_ID` to at most {LAST_DOMAIN}"
            ))
        })?;
        if networks.is_empty() && is_local() {
            networks.push(Ipv4Addr::LOCALHOST.into());
        }
        let mut builder = DomainParticipantBuilder::new(number);
        if !networks.is_empty() {
            builder = builder.with_only_networks(networks);
        }
        let participant = builder.build().map_err(dds("the participant cannot be opened".to_owned()))?;
        Self::of(participant, domain, nodes::length_of(distribution))
    }

    fn of(participant: DomainParticipant, domain: u32, length: usize) -> Result<Self, Error> {
        let what = || "the participant cannot be opened".to_owned();
        let plain = QosPolicyBuilder::new().build();
        let publisher = participant.create_publisher(&plain).map_err(dds(what()))?;
        let subscriber = participant.create_subscriber(&plain).map_err(dds(what()))?;
        let (name, ty) = (nodes::TOPIC.to_owned(), nodes::TYPE.to_owned());
        let topic = participant.create_topic(name, ty, &nodes::policies(), TopicKind::NoKey).map_err(dds(what()))?;
        let info = publisher.create_datawriter_no_key(&topic, None).map_err(dds(what()))?;
        let ours = Ours { node: Node::default(), program: participant.guid(), length };
        Ok(Self { known: Known::new(domain), domain: participant, publisher, subscriber, ours: Mutex::new(ours), info })
    }

    /// Opens a reader.
    pub fn reader(&self, topic: &Topic, policies: &QosPolicies) -> Result<Reader, Error> {
        let what = || format!("`{}` cannot be read", topic.name);
        let (name, ty) = (topic.name.clone(), topic.ty.clone());
        let topic = self.domain.create_topic(name, ty, policies, TopicKind::NoKey).map_err(dds(what()))?;
        let reader: Reader = self.subscriber.create_simple_datareader_no_key(&topic, None).map_err(dds(what()))?;
        let id = reader.guid();
        self.change(|node| node.readers.push(id));
        Ok(reader)
    }

    /// Opens a writer.
    pub fn writer(&self, topic: &Topic, policies: &QosPolicies) -> Result<Writer, Error> {
        let what = || format!("`{}` cannot be written", topic.name);
        let (name, ty) = (topic.name.clone(), topic.ty.clone());
        let topic = self.domain.create_topic(name, ty, policies, TopicKind::NoKey).map_err(dds(what()))?;
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
    pub fn change(&self, change: impl FnOnce(&mut Node)) {
        let mut ours = self.ours();
        change(&mut ours.node);
        // Only a participant that has ended cannot tell.
        drop(self.info.write(Raw(ours.message().into()), Some(Timestamp::now())));
    }

    fn ours(&self) -> MutexGuard<'_, Ours> {
        self.ours.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns `true` if the environment keeps programs on this machine.
fn is_local() -> bool {
    let is = |name: &str, value: &str| env::var(name).is_ok_and(|it| it == value);
    is("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST") || is("ROS_LOCALHOST_ONLY", "1")
}

/// Returns the error of DDS in doing `what`.
fn dds<E: std::fmt::Display>(what: String) -> impl FnOnce(E) -> Error {
    move |error| Error::new(format!("{what}: DDS: {error}"))
}
