//! Reasons for silence, in words: why nothing comes, and why no node listens.

use crate::{
    Carrier, Durability, Kind, NO_HASH, Reliability, Rules, Token, action::action_of, graph::Graph, token::Endpoint,
};
use std::{
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

/// Time between two looks.
const LOOK: Duration = Duration::from_millis(250);
/// Time after which a reason is said that still holds.
pub const PATIENCE: Duration = Duration::from_millis(2500);
/// Time without messages from which on a topic with regular messages is silent.
const SILENT: Duration = Duration::from_millis(2500);

/// An endpoint of the program, and what it has heard.
pub struct Ours {
    /// The endpoint.
    pub endpoint: Endpoint,
    /// Number of messages that came.
    pub heard: AtomicU64,
    /// Messages that were dropped, because the program took none meanwhile.
    pub dropped: AtomicU64,
    /// `true` if nothing is to be said about it, as no node has to listen.
    pub is_quiet: bool,
    /// Part that is wanted and that no message has had so far.
    missing: Mutex<Option<String>>,
}

impl Ours {
    /// Returns an endpoint that has heard nothing yet.
    pub fn new(endpoint: Endpoint, is_quiet: bool) -> Self {
        Self { endpoint, heard: AtomicU64::new(0), dropped: AtomicU64::new(0), is_quiet, missing: Mutex::default() }
    }

    /// Part that is wanted and that no message has had so far.
    pub fn missing(&self) -> MutexGuard<'_, Option<String>> {
        self.missing.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Kind of the endpoints that an endpoint needs on the other side, and the word for it.
const fn other_side(kind: Kind) -> (Kind, &'static str) {
    match kind {
        Kind::Publisher => (Kind::Subscription, "subscribes to"),
        Kind::Subscription => (Kind::Publisher, "publishes"),
        Kind::Server => (Kind::Client, "calls"),
        Kind::Client => (Kind::Server, "serves"),
    }
}

/// Returns the reason why an endpoint of `domain` meets none of the `others`, those of the other side; `None` if it
/// meets one.
pub fn reason(domain: u32, rules: Rules, ours: &Endpoint, others: &[Token]) -> Option<String> {
    let (_, does) = other_side(ours.kind);
    let name = shown(&ours.name);
    let endpoints = || others.iter().filter_map(|token| Some((token, token.endpoint.as_ref()?)));
    let here = || endpoints().filter(|(token, it)| token.domain == domain && it.name == ours.name);
    let fit: Vec<_> = here().filter(|(_, it)| it.wire_type == ours.wire_type && it.hash == ours.hash).collect();
    if !fit.is_empty() {
        let unfit = |(token, it): &(&Token, &Endpoint)| rules.quality.then(|| quality(token, ours, it))?;
        let reasons: Option<Vec<String>> = fit.iter().map(unfit).collect();
        return reasons.and_then(|reasons| reasons.into_iter().next());
    }
    if let Some((token, it)) = here().find(|(_, it)| it.wire_type == ours.wire_type) {
        let node = node(token);
        return Some(match (it.hash.as_str(), ours.hash.as_str()) {
            (NO_HASH, _) => format!(
                "`{node}` {does} `{name}` as a program of Humble, whose types have no hash: set `ROS_DISTRO=humble`"
            ),
            (_, NO_HASH) => format!(
                "`{node}` {does} `{name}` with a hash of its type, and this program is one of Humble: set `ROS_DISTRO` \
                 to the distribution there"
            ),
            (theirs, here) => format!(
                "`{node}` {does} `{name}` with another definition of `{}` (`{}`, here `{}`): both need the same version \
                 of the package",
                ours.type_name(),
                short(theirs),
                short(here)
            ),
        });
    }
    if let Some((token, it)) = here().next() {
        let (node, theirs, here) = (node(token), it.type_name(), ours.type_name());
        return Some(format!("`{node}` {does} `{name}` as `{theirs}`, and this program has `{here}` there"));
    }
    if let Some((token, _)) = endpoints().find(|(_, it)| it.name == ours.name && it.wire_type == ours.wire_type) {
        let other = token.domain;
        return Some(format!(
            "no node {does} `{name}` in domain {domain}, but `{}` does in domain {other}: set `ROS_DOMAIN_ID={other}`",
            node(token)
        ));
    }
    let elsewhere = endpoints().find(|(token, it)| token.domain == domain && it.wire_type == ours.wire_type);
    Some(match elsewhere {
        Some((_, it)) => format!(
            "no node {does} `{name}`; `{other}` has its type: if you mean that, start with \
             `--ros-args -r {name}:={other}`",
            other = shown(&it.name)
        ),
        None => format!("no node {does} `{name}`"),
    })
}

/// Returns the reason for which the quality of service of two endpoints does not fit; `None` if it does.
fn quality(token: &Token, ours: &Endpoint, theirs: &Endpoint) -> Option<String> {
    let (offer, request) = match ours.kind {
        Kind::Publisher => (ours, theirs),
        Kind::Subscription => (theirs, ours),
        Kind::Server | Kind::Client => return None,
    };
    let (node, name) = (node(token), shown(&ours.name));
    let is_reliable = |it: &Endpoint| it.qos.reliability == Reliability::Reliable;
    let is_kept = |it: &Endpoint| it.qos.durability == Durability::TransientLocal;
    let said = |theirs: &str, here: &str, fix: &str| {
        let does = other_side(ours.kind).1;
        Some(format!("`{node}` {does} `{name}` {theirs}, and this program {here}: {fix}"))
    };
    match ours.kind {
        Kind::Subscription if is_reliable(request) && !is_reliable(offer) => {
            said("as best effort", "asks for reliable messages", "subscribe with `.best_effort()`")
        }
        Kind::Subscription if is_kept(request) && !is_kept(offer) => {
            said("without keeping messages", "asks for those before", "subscribe without `.transient_local()`")
        }
        _ if is_reliable(request) && !is_reliable(offer) => {
            said("as reliable", "publishes as best effort", "publish without `.best_effort()`")
        }
        _ if is_kept(request) && !is_kept(offer) => {
            said("with the messages before", "keeps none", "publish with `.transient_local()`")
        }
        _ => None,
    }
}

/// Name in messages: an action is known by the service for its goals.
fn shown(name: &str) -> &str {
    action_of(name).unwrap_or(name)
}

/// Full name of the node of a token.
fn node(token: &Token) -> String {
    format!("{}/{}", token.namespace.trim_end_matches('/'), token.node)
}

/// Beginning of a hash.
fn short(hash: &str) -> String {
    hash.chars().take(15).collect::<String>() + "…"
}

/// Reason for the silence of an endpoint, and since when it holds.
#[derive(Default)]
struct Known {
    reason: Option<String>,
    since: Option<Instant>,
    /// `true` if the reason was said.
    is_said: bool,
}

impl Known {
    /// Takes note of the present reason, which holds since that time or an earlier look. Returns what is to be said: a
    /// reason that holds for a while, or `fine` after a reason that was said.
    fn note(
        &mut self,
        reason: Option<(String, Instant)>,
        fine: impl FnOnce() -> String,
        now: Instant,
    ) -> Option<String> {
        let (reason, since) = reason.unzip();
        if reason != self.reason {
            let was_said = std::mem::take(&mut self.is_said);
            (self.reason, self.since) = (reason, since);
            if self.reason.is_none() {
                return was_said.then(fine);
            }
        }
        let lasts = self.since.is_some_and(|since| now - since >= PATIENCE);
        if self.is_said || !lasts {
            return None;
        }
        self.is_said = self.reason.is_some();
        self.reason.clone()
    }
}

/// Number of messages from which on a topic counts as one with regular messages.
const REGULAR: u64 = 10;
/// Number of usual times between two messages without a message, from which on a topic is silent.
const MISSED: u32 = 3;

/// Pace of the messages of a topic.
#[derive(Default)]
struct Pace {
    /// Number of messages at the last look.
    heard: u64,
    /// The same at the first look with messages, and its time.
    first: Option<(u64, Instant)>,
    /// Time at which the number changed last.
    last: Option<Instant>,
}

impl Pace {
    /// Returns since when a topic with regular messages has been silent, and the time in which one should have come.
    fn silence(&mut self, heard: u64, now: Instant) -> Option<(Instant, Duration)> {
        if heard != self.heard {
            (self.heard, self.last) = (heard, Some(now));
            self.first.get_or_insert((heard, now));
        }
        let ((before, first), last) = self.first.zip(self.last)?;
        let usual = (last - first) / u32::try_from(heard - before).unwrap_or(u32::MAX).max(1);
        let limit = SILENT.max(usual * MISSED);
        (heard >= REGULAR && now - last >= limit).then_some((last, limit))
    }
}

/// State of an endpoint at the last look.
#[derive(Default)]
struct Look {
    /// Why it meets no other one.
    others: Known,
    /// Why nothing comes from those that it meets.
    messages: Known,
    pace: Pace,
}

/// The endpoints of a program, which are looked at now and then.
#[derive(Default)]
pub struct Watch {
    ours: Mutex<Vec<Arc<Ours>>>,
    is_over: AtomicBool,
    changed: (Mutex<()>, Condvar),
}

/// Parts of the session that a watch needs.
pub struct Situation {
    /// Domain of the program.
    pub domain: u32,
    /// Identification of the session.
    pub session: String,
    /// All tokens.
    pub graph: Graph,
    /// Parts that have to fit.
    pub rules: Rules,
}

impl Watch {
    /// Returns all endpoints.
    pub fn all(&self) -> Vec<Arc<Ours>> {
        self.ours.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Adds an endpoint.
    pub fn add(&self, ours: Arc<Ours>) {
        self.ours.lock().unwrap_or_else(PoisonError::into_inner).push(ours);
    }

    /// Ends the watch.
    pub fn end(&self) {
        self.is_over.store(true, Ordering::Release);
        self.changed.1.notify_all();
    }

    /// Looks at the endpoints until the end of the watch.
    pub fn run(&self, at: &Situation, carrier: &dyn Carrier, tell: &(dyn Fn(&str) + Send + Sync)) {
        let (mut way, mut looks) = (Known::default(), Vec::new());
        while !self.is_over.load(Ordering::Acquire) {
            let (obstacle, now) = (carrier.obstacle(), Instant::now());
            let is_connected = obstacle.is_none();
            let obstacle = obstacle.map(|obstacle| (obstacle, now));
            way.note(obstacle, || carrier.way_is_clear(), now).iter().for_each(|text| tell(text));
            let ours = self.all();
            looks.resize_with(ours.len(), Look::default);
            for (ours, look) in ours.iter().zip(&mut looks).filter(|(ours, _)| !ours.is_quiet) {
                let said = look.at(ours, at, (is_connected, carrier.doubt()), now);
                said.iter().flatten().for_each(|text| tell(text));
            }
            let guard = self.changed.0.lock().unwrap_or_else(PoisonError::into_inner);
            drop(self.changed.1.wait_timeout(guard, LOOK));
        }
    }
}

impl Look {
    /// Looks at an endpoint. Returns what is to be said: of the others, and of their messages.
    fn at(
        &mut self,
        ours: &Ours,
        at: &Situation,
        (is_connected, doubt): (bool, Option<&str>),
        now: Instant,
    ) -> [Option<String>; 2] {
        let endpoint = &ours.endpoint;
        let ((kind, does), name) = (other_side(endpoint.kind), shown(&endpoint.name));
        let heard = ours.heard.load(Ordering::Relaxed);
        let silence = self.pace.silence(heard, now);
        let others = at.graph.others(kind, &at.session);
        // Behind an obstacle nothing is known about the others, and that has been said.
        let is_known = is_connected || !others.is_empty();
        let reason = reason(at.domain, at.rules, endpoint, &others).filter(|_| is_known);
        let is_met = reason.is_none() && is_known;
        let because = doubt.map(|doubt| format!(": {doubt}")).unwrap_or_default();
        let reason = reason.map(|reason| (format!("{reason}{because}"), now));
        let others_said = self.others.note(reason, || format!("a node {does} `{name}` now"), now);
        if !is_met {
            self.messages = Known::default();
            return [others_said, None];
        }
        let is_subscription = endpoint.kind == Kind::Subscription;
        let unheard = || (format!("a node publishes `{name}`, and no message has come so far{because}"), now);
        let silent = |(last, limit): (Instant, Duration)| {
            (
                format!("no message of `{name}` has come for {:.1} s, and its publisher is there", limit.as_secs_f32()),
                last,
            )
        };
        let missing =
            || ours.missing().as_ref().map(|part| (format!("no message of `{name}` has `{part}` so far"), now));
        let reason = if heard == 0 { is_subscription.then(unheard) } else { silence.map(silent).or_else(missing) };
        let said = self.messages.note(reason, || format!("what was missing of `{name}` comes now"), now);
        [others_said, said]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Qos, wire_type};

    fn endpoint(kind: Kind, name: &str, ty: &str, hash: &str) -> Endpoint {
        let (name, hash) = (name.to_owned(), hash.to_owned());
        Endpoint { kind, name, wire_type: wire_type(ty), hash, qos: Qos::DEFAULT }
    }

    /// Token of a publisher `/lidar`.
    fn publisher(domain: u32, name: &str, ty: &str, hash: &str) -> Token {
        Token {
            domain,
            session: "ab".to_owned(),
            node_id: 0,
            id: 1,
            enclave: String::new(),
            namespace: "/".to_owned(),
            node: "lidar".to_owned(),
            endpoint: Some(endpoint(Kind::Publisher, name, ty, hash)),
        }
    }

    const ZENOH: Rules = Rules { hashes: true, quality: false };
    const SCAN: &str = "sensor_msgs/msg/LaserScan";

    #[test]
    fn each_silence_has_its_reason() {
        let ours = endpoint(Kind::Subscription, "/scan", SCAN, "RIHS01_64c191398013");
        let why = |others: &[Token]| reason(0, ZENOH, &ours, others).unwrap_or_default();
        assert_eq!(why(&[publisher(0, "/scan", SCAN, "RIHS01_64c191398013")]), "");
        for (others, expected) in [
            (vec![], "no node publishes `/scan`"),
            (
                vec![publisher(0, "/front", SCAN, "RIHS01_64c191398013")],
                "no node publishes `/scan`; `/front` has its type: if you mean that, start with \
                 `--ros-args -r /scan:=/front`",
            ),
            (
                vec![publisher(5, "/scan", SCAN, "RIHS01_64c191398013")],
                "no node publishes `/scan` in domain 0, but `/lidar` does in domain 5: set `ROS_DOMAIN_ID=5`",
            ),
            (
                vec![publisher(0, "/scan", "sensor_msgs/msg/PointCloud2", "RIHS01_00")],
                "`/lidar` publishes `/scan` as `sensor_msgs/msg/PointCloud2`, and this program has \
                 `sensor_msgs/msg/LaserScan` there",
            ),
            (
                vec![publisher(0, "/scan", SCAN, NO_HASH)],
                "`/lidar` publishes `/scan` as a program of Humble, whose types have no hash: set `ROS_DISTRO=humble`",
            ),
            (
                vec![publisher(0, "/scan", SCAN, "RIHS01_0123456789abcdef")],
                "`/lidar` publishes `/scan` with another definition of `sensor_msgs/msg/LaserScan` (`RIHS01_01234567…`, \
                 here `RIHS01_64c19139…`): both need the same version of the package",
            ),
        ] {
            assert_eq!(why(&others), expected);
        }
        let humble = endpoint(Kind::Subscription, "/scan", SCAN, NO_HASH);
        let why = reason(0, ZENOH, &humble, &[publisher(0, "/scan", SCAN, "RIHS01_64c191398013")]);
        assert!(why.is_some_and(|why| why.contains("this program is one of Humble")));
    }

    #[test]
    fn quality_has_to_fit_where_it_is_compared() {
        let with = |kind, qos| Endpoint { qos, ..endpoint(kind, "/scan", SCAN, NO_HASH) };
        let token = |kind, qos| Token { endpoint: Some(with(kind, qos)), ..publisher(0, "/scan", SCAN, NO_HASH) };
        let dds = Rules { hashes: false, quality: true };
        let (reliable, best) = (Qos::DEFAULT, Qos::DEFAULT.best_effort());
        let (hears, sends) = (Kind::Subscription, Kind::Publisher);
        let why =
            |ours, mine, theirs, other| reason(0, dds, &with(ours, mine), &[token(theirs, other)]).unwrap_or_default();
        assert_eq!(why(hears, best, sends, reliable), "");
        assert_eq!(
            why(hears, reliable, sends, best),
            "`/lidar` publishes `/scan` as best effort, and this program asks for reliable messages: subscribe with \
             `.best_effort()`"
        );
        assert_eq!(
            why(hears, reliable.transient_local(), sends, reliable),
            "`/lidar` publishes `/scan` without keeping messages, and this program asks for those before: subscribe \
             without `.transient_local()`"
        );
        assert!(why(sends, best, hears, reliable).ends_with("publish without `.best_effort()`"));
        assert!(why(sends, reliable, hears, reliable.transient_local()).ends_with("publish with `.transient_local()`"));
        let ours = with(hears, reliable);
        let two = [token(sends, best), token(sends, reliable)];
        assert_eq!(reason(0, dds, &ours, &two), None, "one of them is heard");
        assert_eq!(reason(0, ZENOH, &ours, &two[..1]), None, "Zenoh compares nothing");
    }

    #[test]
    fn a_reason_is_said_once_when_it_lasts() {
        let (mut known, start) = (Known::default(), Instant::now());
        let mut note = |reason: Option<&str>, ms: u64| {
            let now = start + Duration::from_millis(ms);
            known.note(reason.map(|reason| (reason.to_owned(), now)), || "fine".to_owned(), now)
        };
        let said: Vec<_> =
            (0..4000).step_by(250).filter_map(|ms| note(Some("why"), ms).map(|text| (ms, text))).collect();
        assert_eq!(said, [(2500, "why".to_owned())]);
        assert_eq!((note(None, 5000), note(None, 9000)), (Some("fine".to_owned()), None));
        assert_eq!((note(Some("why"), 9250), note(None, 9500)), (None, None), "it did not last");
    }

    #[test]
    fn only_regular_messages_can_fall_silent() {
        let (mut pace, start) = (Pace::default(), Instant::now());
        let mut silence = |heard, ms| pace.silence(heard, start + Duration::from_millis(ms)).is_some();
        assert!(!silence(1, 0) && !silence(1, 60_000), "one message is not regular");
        let (mut pace, mut known) = (Pace::default(), Known::default());
        let mut said = |heard, ms| {
            let now = start + Duration::from_millis(ms);
            let silence = pace.silence(heard, now).map(|(last, _)| ("silent".to_owned(), last));
            known.note(silence, || "fine".to_owned(), now)
        };
        assert!((0..20).all(|k| said(k, k * 100).is_none()));
        assert_eq!((said(19, 4250), said(19, 4500)), (None, Some("silent".to_owned())), "2.5 s after the last one");
        assert_eq!((said(19, 9000), said(20, 9250)), (None, Some("fine".to_owned())));
    }

    #[test]
    fn a_slow_topic_is_silent_after_three_of_its_periods() {
        let (mut pace, start) = (Pace::default(), Instant::now());
        let mut silence = |heard, s| pace.silence(heard, start + Duration::from_secs(s)).is_some();
        assert!((1..=20).all(|k| !silence(k, 5 * k) && !silence(k, 5 * k + 4)), "one message in 5 s");
        assert!(!silence(20, 114) && silence(20, 115));
    }
}
