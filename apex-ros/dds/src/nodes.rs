//! Nodes and their endpoints, which programs tell one another on the topic `ros_discovery_info`.

use apex_messages::{
    Reason,
    cdr::{Reader, Writer},
};
use apex_ros::Distribution;
use rustdds::{Duration, GUID, QosPolicies, QosPolicyBuilder, policy};

/// Name of the topic.
pub const TOPIC: &str = "ros_discovery_info";
/// Type of its messages.
pub const TYPE: &str = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

/// Most names and endpoints of a program that are read.
const MOST: usize = 100_000;
/// Most bytes of a name.
const NAME: usize = 256;
/// Bytes of an identification of DDS.
const GUID_LENGTH: usize = 16;

/// Quality of the topic.
pub fn policies() -> QosPolicies {
    QosPolicyBuilder::new()
        .durability(policy::Durability::TransientLocal)
        .reliability(policy::Reliability::Reliable { max_blocking_time: Duration::from_millis(100) })
        .history(policy::History::KeepLast { depth: 1 })
        .build()
}

/// Node of a program.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Node {
    /// Namespace: `/`.
    pub namespace: String,
    /// Name.
    pub name: String,
    /// Its readers.
    pub readers: Vec<GUID>,
    /// Its writers.
    pub writers: Vec<GUID>,
}

/// Number of bytes of an identification in messages of a distribution.
pub const fn length_of(distribution: Distribution) -> usize {
    match distribution {
        Distribution::Humble => 24,
        _ => GUID_LENGTH,
    }
}

/// Message with the nodes of a program.
pub fn write(program: GUID, nodes: &[Node], length: usize) -> Vec<u8> {
    let mut bytes = vec![];
    let mut message = Writer::new(&mut bytes);
    let id = |message: &mut Writer<'_>, id: &GUID| {
        let mut padded = id.to_bytes().to_vec();
        padded.resize(length, 0);
        message.numbers(&padded);
    };
    id(&mut message, &program);
    message.length(nodes.len());
    for node in nodes {
        message.text(&node.namespace);
        message.text(&node.name);
        for ids in [&node.readers, &node.writers] {
            message.length(ids.len());
            ids.iter().for_each(|it| id(&mut message, it));
        }
    }
    bytes
}

/// Nodes of a message, whichever length its identifications have.
///
/// # Errors
/// It is not such a message.
pub fn read(bytes: &[u8]) -> Result<(GUID, Vec<Node>), Reason> {
    read_with(bytes, length_of(Distribution::Jazzy)).or_else(|_| read_with(bytes, length_of(Distribution::Humble)))
}

fn read_with(bytes: &[u8], length: usize) -> Result<(GUID, Vec<Node>), Reason> {
    let mut message = Reader::new(bytes)?;
    let id = |message: &mut Reader<'_>| -> Result<GUID, Reason> {
        let (id, rest) = message.bytes(length)?.split_at(GUID_LENGTH);
        if rest.iter().any(|byte| *byte != 0) {
            return Err("an identification is too long".into());
        }
        Ok(GUID::from_bytes(std::array::from_fn(|i| id[i])))
    };
    let program = id(&mut message)?;
    let nodes = message.list_of(MOST, |message| {
        let (namespace, name) = (message.text_of(NAME)?, message.text_of(NAME)?);
        let (readers, writers) = (message.list_of(MOST, id)?, message.list_of(MOST, id)?);
        Ok(Node { namespace, name, readers, writers })
    })?;
    // An alignment of three bytes may follow.
    if message.left() > 3 { Err("bytes are left over".into()) } else { Ok((program, nodes)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(number: u8) -> GUID {
        GUID::from_bytes([number; GUID_LENGTH])
    }

    #[test]
    fn messages_of_both_lengths_are_read() {
        let node = |name: &str| Node {
            namespace: "/robot1".to_owned(),
            name: name.to_owned(),
            readers: vec![id(2), id(3)],
            writers: vec![id(4)],
        };
        for nodes in [vec![], vec![node("a")], vec![node("rover"), Node::default(), node("of")]] {
            for length in [16, 24] {
                let bytes = write(id(1), &nodes, length);
                assert_eq!(read(&bytes), Ok((id(1), nodes.clone())), "{length}");
                let whole = Ok((id(1), nodes.clone()));
                assert!(nodes.is_empty() || (0..bytes.len()).all(|end| read(&bytes[..end]) != whole));
            }
        }
        assert!(read(&[0, 1, 0, 0, 255, 255, 255, 255]).is_err());
        let mut huge = vec![0, 1, 0, 0];
        huge.extend([1; 16]);
        huge.extend([255; 4]);
        assert!(read(&huge).is_err());
    }
}
