//! Keys, tokens and quality of service beside those of `hiroz-protocol`, another implementation.

use apex_nodes::math;
use apex_ros::{Durability, Endpoint, Kind, Qos, Reliability, Token, key};
use hiroz_protocol::{
    EndpointEntity, EndpointKind, KeyExprFormatter, NodeEntity, RmwZenohFormatter, TypeHash, TypeInfo,
    entity::Entity,
    qos::{QosDurability, QosDuration, QosHistory, QosLiveliness, QosProfile, QosReliability},
};
use std::time::Duration;

/// Number of compared entities.
const COUNT: usize = 100_000;

/// Pseudo-random names and numbers.
struct Random(math::Random);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0.below(end)
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u64) as usize]
    }

    /// Words with slashes before them.
    fn name(&mut self, most: u64) -> String {
        (0..self.below(most + 1)).map(|_| format!("/{}", self.word())).collect()
    }

    fn word(&mut self) -> String {
        let first = self.one(b"abcXYZ_") as char;
        let rest = (0..self.below(8)).map(|_| self.one(b"abcXYZ_0123") as char);
        std::iter::once(first).chain(rest).collect()
    }

    fn duration(&mut self) -> (Option<Duration>, QosDuration) {
        if self.below(2) == 0 {
            return (None, QosDuration::INFINITE);
        }
        let sec = self.one(&[0, 1, 10, 9_223_372_036]);
        let nsec = self.one(&[1, 5, 999_999_999, 854_775_806]);
        (Some(Duration::new(sec, nsec as u32)), QosDuration { sec, nsec })
    }

    fn qos(&mut self) -> (Qos, QosProfile) {
        let (is_reliable, is_kept, is_manual) = (self.below(2) == 0, self.below(2) == 0, self.below(4) == 0);
        let depth = (self.below(4) > 0).then(|| self.one(&[1, 5, 10, 42, 1000]));
        let (deadline, lifespan, lease) = (self.duration(), self.duration(), self.duration());
        let ours = Qos {
            reliability: if is_reliable { Reliability::Reliable } else { Reliability::BestEffort },
            durability: if is_kept { Durability::TransientLocal } else { Durability::Volatile },
            depth,
            deadline: deadline.0,
            lifespan: lifespan.0,
            lease: lease.0,
            is_manual,
        };
        let theirs = QosProfile {
            reliability: if is_reliable { QosReliability::Reliable } else { QosReliability::BestEffort },
            durability: if is_kept { QosDurability::TransientLocal } else { QosDurability::Volatile },
            history: depth.map_or(QosHistory::KeepAll, |depth| QosHistory::from_depth(depth as usize)),
            deadline: deadline.1,
            lifespan: lifespan.1,
            liveliness: if is_manual { QosLiveliness::ManualByTopic } else { QosLiveliness::Automatic },
            liveliness_lease_duration: lease.1,
        };
        (ours, theirs)
    }
}

#[test]
fn keys_and_tokens_are_the_same() {
    let mut random = Random(math::Random::new(1));
    for _ in 0..COUNT {
        let kinds = [
            (Kind::Publisher, EndpointKind::Publisher),
            (Kind::Subscription, EndpointKind::Subscription),
            (Kind::Server, EndpointKind::Service),
            (Kind::Client, EndpointKind::Client),
        ];
        let (kind, their_kind) = random.one(&kinds);
        let (qos, their_qos) = random.qos();
        let bytes: [u8; 32] = std::array::from_fn(|_| random.below(256) as u8);
        let (their_hash, session) =
            (TypeHash::new(1, bytes), format!("{:x}", u128::from(random.below(u64::MAX)) << 60 | 1));
        let wire_type = format!("{}::msg::dds_::{}_", random.word(), random.word());
        let (domain, node_id, id) = (random.below(233), random.below(9), random.below(99));
        let (namespace, node, name) = (random.name(2), random.word(), format!("/{}{}", random.word(), random.name(2)));
        let theirs = EndpointEntity {
            id: id as usize,
            node: Some(NodeEntity::new(
                domain as usize,
                session.parse().expect("hexadecimal digits"),
                node_id as usize,
                node.clone(),
                namespace.clone(),
                String::new(),
            )),
            kind: their_kind,
            topic: name.clone(),
            type_info: Some(TypeInfo::new(&wire_type, their_hash)),
            qos: their_qos,
        };
        let zid = theirs.node.as_ref().expect("a node").z_id;
        let hash = theirs.type_info.as_ref().expect("a type").hash.to_rihs_string();
        let ours = Token {
            domain: domain as u32,
            session: zid.to_string(),
            node_id,
            id,
            enclave: String::new(),
            namespace: if namespace.is_empty() { "/".to_owned() } else { namespace },
            node,
            endpoint: Some(Endpoint {
                kind,
                name: name.clone(),
                wire_type: wire_type.clone(),
                hash: hash.clone(),
                qos,
            }),
        };
        let token = RmwZenohFormatter::liveliness_key_expr(&theirs, &zid).expect("a token");
        assert_eq!(ours.to_string(), token.as_str());
        assert_eq!(token.as_str().parse(), Ok(ours.clone()));
        let data = RmwZenohFormatter::topic_key_expr(&theirs).expect("a key");
        assert_eq!(key(domain as u32, &name, &wire_type, &hash), data.as_str());
        let read = RmwZenohFormatter::parse_liveliness(&token.0).expect("their own token");
        let Entity::Endpoint(read) = read else { panic!("{token:?} is not an endpoint") };
        assert_eq!((read.qos, &read.topic), (theirs.qos, &theirs.topic));

        let node = Token { endpoint: None, id: node_id, ..ours };
        let token = RmwZenohFormatter::node_liveliness_key_expr(theirs.node.as_ref().expect("a node"));
        assert_eq!(node.to_string(), token.expect("a token").as_str());
    }
}
