//! Zenoh as `rmw_zenoh` uses it: tokens, keys, attachments, caches.

use crate::{
    Attachment, Carrier, Error, Graph, Qos, Reliability, Token,
    carrier::{Answer, Ask, Hear, HearRequest, HearResponse, Kept, Publish, Rules, SendError, endpoint_of},
    name::key,
    session::{self, Opened},
    time::calendar,
    token::SPACE,
};
use std::{
    collections::hash_map::DefaultHasher,
    hash::{Hash as _, Hasher as _},
    sync::{
        Arc,
        atomic::{AtomicI64, Ordering},
    },
    time::Duration,
};
use zenoh::{
    Session, Wait as _,
    bytes::ZBytes,
    pubsub::Publisher as Plain,
    qos::{CongestionControl, Reliability as Marker},
    query::{ConsolidationMode, Querier, Query, QueryTarget, Reply},
    sample::{Sample, SampleKind},
};
use zenoh_ext::{
    AdvancedPublisher, AdvancedPublisherBuilderExt as _, AdvancedSubscriberBuilderExt as _, CacheConfig, HistoryConfig,
    MissDetectionConfig, RecoveryConfig,
};

/// Session of Zenoh.
pub struct Zenoh {
    session: Session,
    /// Address of the router, for messages.
    router: String,
    /// Reason why others may not be met.
    doubt: Option<&'static str>,
}

/// Time between two signs of the last message's number, by which its loss is noticed.
const HEARTBEAT: Duration = Duration::from_millis(500);

impl Zenoh {
    /// Opens a session with the router at `router`, or with that of the environment. `tell` hears of a long wait.
    ///
    /// # Errors
    /// A setting is not one of Zenoh, or the session cannot be opened.
    pub fn open(router: Option<&str>, tell: &(dyn Fn(&str) + Send + Sync)) -> Result<Self, Error> {
        let Opened { session, router, doubt } = session::open(router, tell)?;
        Ok(Self { session, router, doubt })
    }
}

impl Carrier for Zenoh {
    fn session(&self) -> String {
        self.session.zid().to_string()
    }

    fn show(&self, token: &Token) -> Result<Kept, Error> {
        let declared = self.session.liveliness().declare_token(token.to_string()).wait();
        keep(declared.map_err(Error::zenoh(&format!("the token `{token}` cannot be declared"))))
    }

    fn look(&self, graph: Graph) -> Result<Kept, Error> {
        let change = move |sample: Sample| {
            let key = sample.key_expr().as_str();
            match (sample.kind(), key.parse()) {
                (SampleKind::Put, Ok(token)) => graph.add(key, token),
                (SampleKind::Delete, _) => graph.remove(key),
                // A text that is not a token is left out.
                (SampleKind::Put, Err(_)) => {}
            }
        };
        let all = self.session.liveliness().declare_subscriber(format!("{SPACE}/**")).history(true).callback(change);
        keep(all.wait().map_err(Error::zenoh("the others cannot be looked for")))
    }

    fn publish(&self, token: &Token) -> Result<Box<dyn Publish>, Error> {
        let endpoint = endpoint_of(token)?;
        let way = self.way(&key_of(token)?, endpoint.qos);
        let way = way.map_err(Error::zenoh(&format!("`{}` cannot be published", endpoint.name)))?;
        let (blocks, number) = (blocks(endpoint.qos), AtomicI64::new(1));
        Ok(Box::new(Publisher { way, blocks, id: identification(token), number }))
    }

    fn subscribe(&self, token: &Token, hear: Hear) -> Result<Kept, Error> {
        let (endpoint, hear) = (endpoint_of(token)?, move |sample: Sample| hear(sample.payload().clone().into()));
        let what = format!("`{}` cannot be subscribed", endpoint.name);
        let subscriber = self.session.declare_subscriber(key_of(token)?).callback(hear);
        if !endpoint.qos.is_kept_for_later() {
            return keep(subscriber.wait().map_err(Error::zenoh(&what)));
        }
        let history = HistoryConfig::default().detect_late_publishers().max_samples(endpoint.qos.kept());
        let mut subscriber = subscriber.history(history);
        if endpoint.qos.reliability == Reliability::Reliable {
            subscriber = subscriber.recovery(RecoveryConfig::default().heartbeat());
        }
        keep(subscriber.wait().map_err(Error::zenoh(&what)))
    }

    fn serve(&self, token: &Token, hear: HearRequest) -> Result<Kept, Error> {
        let (name, key) = (&endpoint_of(token)?.name, key_of(token)?);
        let back: Arc<str> = key.as_str().into();
        let hear = move |query: Query| {
            let request = query.payload().cloned().unwrap_or_default();
            hear(request.into(), Box::new(Asked { query, key: Arc::clone(&back) }));
        };
        let queryable = self.session.declare_queryable(key).complete(true).callback(hear).wait();
        keep(queryable.map_err(Error::zenoh(&format!("`{name}` cannot be served"))))
    }

    fn call(&self, token: &Token, timeout: Duration) -> Result<Box<dyn Ask>, Error> {
        let querier = self
            .session
            .declare_querier(key_of(token)?)
            .target(QueryTarget::AllComplete)
            .consolidation(ConsolidationMode::None)
            .timeout(timeout)
            .wait()
            .map_err(Error::zenoh(&format!("`{}` cannot be called", endpoint_of(token)?.name)))?;
        Ok(Box::new(Client { querier, id: identification(token), number: AtomicI64::new(1) }))
    }

    fn rules(&self) -> Rules {
        Rules { hashes: true, quality: false }
    }

    fn obstacle(&self) -> Option<String> {
        self.session.info().routers_zid().wait().next().is_none().then(|| session::no_router(&self.router))
    }

    fn doubt(&self) -> Option<&'static str> {
        self.doubt
    }

    fn way_is_clear(&self) -> String {
        session::a_router(&self.router)
    }

    fn close(&self) {
        // A session that is closed already is as good.
        drop(self.session.close().wait());
    }
}

fn keep<T: Send + 'static>(it: Result<T, Error>) -> Result<Kept, Error> {
    it.map(|it| Box::new(it) as Kept)
}

/// Key of the data of an endpoint.
fn key_of(token: &Token) -> Result<String, Error> {
    let endpoint = endpoint_of(token)?;
    Ok(key(token.domain, &endpoint.name, &endpoint.wire_type, &endpoint.hash))
}

/// Identification of an endpoint in attachments: 16 bytes that depend on its token.
fn identification(token: &Token) -> [u8; 16] {
    let half = |salt: u8| {
        let mut hasher = DefaultHasher::new();
        (salt, token.to_string()).hash(&mut hasher);
        hasher.finish().to_le_bytes()
    };
    let mut id = [0; 16];
    id[..8].copy_from_slice(&half(0));
    id[8..].copy_from_slice(&half(1));
    id
}

/// Returns `true` if a publisher waits for room, and drops nothing.
fn blocks(qos: Qos) -> bool {
    qos.reliability == Reliability::Reliable && qos.depth.is_none()
}

/// Publisher of Zenoh, with or without a cache for subscriptions that come later.
enum Way {
    Plain(Plain<'static>),
    Kept(AdvancedPublisher<'static>),
}

impl Zenoh {
    /// Declares the publisher of Zenoh.
    fn way(&self, key: &str, qos: Qos) -> zenoh::Result<Way> {
        let is_reliable = qos.reliability == Reliability::Reliable;
        let publisher = self
            .session
            .declare_publisher(key.to_owned())
            .congestion_control(if blocks(qos) { CongestionControl::Block } else { CongestionControl::Drop })
            .reliability(if is_reliable { Marker::Reliable } else { Marker::BestEffort });
        if !qos.is_kept_for_later() {
            return publisher.wait().map(Way::Plain);
        }
        let mut publisher = publisher.cache(CacheConfig::default().max_samples(qos.kept())).publisher_detection();
        if is_reliable {
            publisher = publisher.sample_miss_detection(MissDetectionConfig::default().sporadic_heartbeat(HEARTBEAT));
        }
        publisher.wait().map(Way::Kept)
    }
}

struct Publisher {
    way: Way,
    /// `true` if it waits for room.
    blocks: bool,
    id: [u8; 16],
    number: AtomicI64,
}

impl Publish for Publisher {
    fn send(&self, message: Vec<u8>) -> Result<(), SendError> {
        let number = self.number.fetch_add(1, Ordering::Relaxed);
        let attachment = Attachment { number, time: calendar(), sender: self.id }.to_bytes();
        let (payload, attachment) = (ZBytes::from(message), ZBytes::from(attachment.to_vec()));
        let sent = match &self.way {
            Way::Plain(publisher) => publisher.put(payload).attachment(attachment).wait(),
            Way::Kept(publisher) => publisher.put(payload).attachment(attachment).wait(),
        };
        sent.map_err(|error| SendError::Ended(format!("Zenoh: {error}")))
    }

    fn send_at_once(&self, message: Vec<u8>) -> Result<bool, SendError> {
        if self.blocks { Ok(false) } else { self.send(message).map(|()| true) }
    }
}

/// Request that waits for its response.
struct Asked {
    query: Query,
    key: Arc<str>,
}

impl Answer for Asked {
    /// Answers with the number and the client of the request.
    fn answer(self: Box<Self>, response: Vec<u8>) {
        let asked = self.query.attachment().and_then(|attachment| Attachment::read(&attachment.to_bytes()));
        let (number, sender) = asked.map_or((0, [0; 16]), |asked| (asked.number, asked.sender));
        let attachment = Attachment { number, time: calendar(), sender }.to_bytes();
        drop(self.query.reply(&*self.key, response).attachment(attachment.to_vec()).wait());
    }
}

struct Client {
    querier: Querier<'static>,
    id: [u8; 16],
    number: AtomicI64,
}

impl Ask for Client {
    fn ask(&self, request: Vec<u8>, hear: HearResponse) -> Result<(), String> {
        let number = self.number.fetch_add(1, Ordering::Relaxed);
        let attachment = Attachment { number, time: calendar(), sender: self.id }.to_bytes();
        let hear = move |reply: Reply| {
            hear(match reply.into_result() {
                Ok(sample) => Ok(sample.payload().clone().into()),
                Err(error) => Err(String::from_utf8_lossy(&error.payload().to_bytes()).into_owned()),
            });
        };
        // A session that is closed drops the function.
        let asked = self.querier.get().payload(request).attachment(attachment.to_vec()).callback(hear).wait();
        asked.map_err(|error| format!("Zenoh: {error}"))
    }
}
