//! Liveliness tokens, by which the programs of ROS 2 find one another over Zenoh.

use crate::{
    Qos,
    name::{mangle, type_of_wire, unmangle},
};
use std::{fmt, str::FromStr};

/// Beginning of all tokens.
pub const SPACE: &str = "@ros2_lv";

/// A node, or a publisher, subscription, server or client of a node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Token {
    /// Domain (`ROS_DOMAIN_ID`).
    pub domain: u32,
    /// Identification of the session of Zenoh, in hexadecimal digits.
    pub session: String,
    /// Number of the node in the session.
    pub node_id: u64,
    /// Number of the endpoint in the session; that of the node again if it is a node.
    pub id: u64,
    /// Enclave, beginning with `/`; empty if there is none.
    pub enclave: String,
    /// Namespace of the node: `/`, or `/robot1`.
    pub namespace: String,
    /// Name of the node.
    pub node: String,
    /// Endpoint for which the token stands, if it is not the node itself.
    pub endpoint: Option<Endpoint>,
}

/// A publisher, subscription, server or client.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Endpoint {
    /// Kind of the endpoint.
    pub kind: Kind,
    /// Full name of the topic or service: `/robot1/scan`.
    pub name: String,
    /// Type on the wire: `sensor_msgs::msg::dds_::LaserScan_`.
    pub wire_type: String,
    /// Hash of the type.
    pub hash: String,
    /// Quality of service.
    pub qos: Qos,
}

/// Kind of an endpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Publisher of a topic.
    Publisher,
    /// Subscription of a topic.
    Subscription,
    /// Server of a service.
    Server,
    /// Client of a service.
    Client,
}

/// Code of a node, in the place of that of an endpoint.
const NODE: &str = "NN";

impl Kind {
    const ALL: [Self; 4] = [Self::Publisher, Self::Subscription, Self::Server, Self::Client];

    /// Code in a token.
    const fn code(self) -> &'static str {
        match self {
            Self::Publisher => "MP",
            Self::Subscription => "MS",
            Self::Server => "SS",
            Self::Client => "SC",
        }
    }
}

impl Endpoint {
    /// Type as it is written elsewhere: `sensor_msgs/msg/LaserScan`.
    pub fn type_name(&self) -> String {
        type_of_wire(&self.wire_type)
    }
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { domain, session, node_id, id, enclave, namespace, node, endpoint } = self;
        let kind = endpoint.as_ref().map_or(NODE, |endpoint| endpoint.kind.code());
        let namespace = if namespace == "/" { "" } else { namespace };
        let (enclave, namespace, node) = (mangle(enclave), mangle(namespace), mangle(node));
        write!(f, "{SPACE}/{domain}/{session}/{node_id}/{id}/{kind}/{enclave}/{namespace}/{node}")?;
        endpoint.as_ref().map_or(Ok(()), |endpoint| {
            let Endpoint { name, wire_type, hash, qos, .. } = endpoint;
            write!(f, "/{}/{wire_type}/{hash}/{qos}", mangle(name))
        })
    }
}

/// A text that is not a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotAToken;

/// Reads a token. Parts after those that are known are left out: later versions add some.
impl FromStr for Token {
    type Err = NotAToken;

    fn from_str(text: &str) -> Result<Self, NotAToken> {
        let mut parts = text.split('/');
        let mut next = || parts.next().filter(|part| !part.is_empty()).ok_or(NotAToken);
        if next()? != SPACE {
            return Err(NotAToken);
        }
        let number = |part: &str| part.parse::<u64>().map_err(|_| NotAToken);
        let domain = next()?.parse().map_err(|_| NotAToken)?;
        let session = next()?.to_owned();
        let (node_id, id, code) = (number(next()?)?, number(next()?)?, next()?);
        let enclave = unmangle(next()?);
        let namespace = format!("/{}", unmangle(next()?).trim_start_matches('/'));
        let node = unmangle(next()?);
        let kind = Kind::ALL.into_iter().find(|kind| kind.code() == code);
        let endpoint = match kind {
            None if code == NODE => None,
            None => return Err(NotAToken),
            Some(kind) => Some(Endpoint {
                kind,
                name: unmangle(next()?),
                wire_type: next()?.to_owned(),
                hash: next()?.to_owned(),
                qos: Qos::read(next()?),
            }),
        };
        Ok(Self { domain, session, node_id, id, enclave, namespace, node, endpoint })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Durability, NO_HASH, Reliability};

    /// A token with the session and the endpoint of `rest`.
    fn read(rest: &str) -> Token {
        format!("@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/{rest}").parse().expect(rest)
    }

    fn endpoint(rest: &str) -> Endpoint {
        read(rest).endpoint.expect("an endpoint")
    }

    const STRING: &str =
        "std_msgs::msg::dds_::String_/RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";

    #[test]
    fn a_node_has_no_endpoint() {
        let text = "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/0/NN/%/%/listener";
        let node: Token = text.parse().expect("a token");
        assert_eq!((node.domain, node.node.as_str(), node.namespace.as_str()), (2, "listener", "/"));
        assert_eq!((node.enclave.as_str(), node.endpoint.is_none(), node.to_string().as_str()), ("", true, text));
    }

    #[test]
    fn endpoints_have_name_type_hash_and_quality() {
        let listener = endpoint(&format!("0/10/MS/%/%/listener/%chatter/{STRING}/::,10:,:,:,,"));
        assert_eq!((listener.kind, listener.name.as_str()), (Kind::Subscription, "/chatter"));
        assert_eq!((listener.type_name().as_str(), listener.qos), ("std_msgs/msg/String", Qos::DEFAULT));
        let nothing = endpoint(&format!("0/4/MP/%/%/_ros2cli_43208/%chatter/{STRING}/::,:,:,:,,"));
        assert_eq!(nothing.qos.depth, Some(42));
        let humble =
            endpoint(&format!("0/1/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/{NO_HASH}/::,7:,:,:,,"));
        assert_eq!((humble.hash.as_str(), humble.qos.depth), (NO_HASH, Some(7)));
        let older = endpoint(&format!(
            "0/4/MP/%/%/n/%chatter/{STRING}/2:2:1,42:9223372036,854775807:9223372036,854775807:1,9223372036,854775807"
        ));
        assert_eq!(older.qos.reliability, Reliability::BestEffort);
    }

    #[test]
    fn namespaces_and_enclaves_are_one_part() {
        let text = format!("0/1/SS/%security%robot/%robot1%arm/talker/%robot1%arm%set/{STRING}/:1:,1000:,:10,0:,,");
        let token = read(&text);
        assert_eq!((token.enclave.as_str(), token.namespace.as_str()), ("/security/robot", "/robot1/arm"));
        assert_eq!(token.endpoint.as_ref().map(|it| it.qos.durability), Some(Durability::TransientLocal));
        assert!(token.to_string().ends_with(&text));
    }

    #[test]
    fn more_parts_and_odd_codes_of_quality_are_accepted() {
        let camera = endpoint(&format!("0/4/MP/%/%/cam/%image/{STRING}/::,5:,:,:,,/x"));
        assert_eq!(camera.qos.depth, Some(5));
        // Of five parts instead of six.
        let fewer = endpoint(&format!("0/1/MP/%/%robot1/talker/%rosout/{STRING}/:1,1000:,:10,0:,,"));
        assert_eq!(fewer.qos.durability, Durability::TransientLocal);
        assert_eq!(endpoint(&format!("0/1/MP/%/%/a/%b/{STRING}/future")).qos, Qos::read(""));
    }

    #[test]
    fn other_texts_are_refused() {
        let whole = format!("@ros2_lv/0/ab/0/1/MP/%/%/talker/%chatter/{STRING}/::,7:,:,:,,");
        let last = whole.rfind('/').expect("parts");
        assert!(
            (0..=last).filter(|end| whole.is_char_boundary(*end)).all(|end| whole[..end].parse::<Token>().is_err())
        );
        for text in ["", "@ros2_lv", "@adv/pub/x", "@ros2_lv/-1/ab/0/0/NN/%/%/a", "@ros2_lv/0/ab/0/0/XX/%/%/a"] {
            assert!(text.parse::<Token>().is_err(), "{text}");
        }
    }
}
