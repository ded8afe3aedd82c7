//! The ends of connections.

use super::wrong::Wrong;

/// Kind of a port, as seen from its own graph or node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    In,
    Out,
    Slot,
    Event,
}

/// A port of a node.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Port {
    /// Port with a number. Every node has the slots 0 and 1 and the events 0 to 2.
    Number(Kind, u32),
    /// Port that sets or sends a parameter.
    Param(Kind, String),
}

/// An end of a connection.
#[derive(Debug, Clone, PartialEq)]
pub enum PortId {
    /// A node, by its place in the graph.
    Node(usize, Port),
    /// Port of the graph itself, seen from inside.
    Own(Kind, u32),
    /// Slot or event of CS::APEX as a whole.
    Whole(&'static Whole),
    /// Slot or event that a plugin has added to CS::APEX.
    Plugin(Kind, String),
}

impl PortId {
    /// Returns `true` if the tokens of the port are of type `()` in Apex, independently of their type in CS::APEX.
    pub fn sends_signals(&self) -> bool {
        match self {
            Self::Node(_, port) => port.common().is_some(),
            Self::Whole(_) | Self::Plugin(..) => true,
            Self::Own(..) => false,
        }
    }

    /// `true` if it takes only tokens of type `()`, although it takes any in CS::APEX.
    pub fn takes_signals(&self) -> bool {
        match self {
            Self::Node(_, port) => port.common().is_some(),
            Self::Whole(whole) => whole.ours.is_some(),
            Self::Own(..) | Self::Plugin(..) => false,
        }
    }
}

/// A port of the whole program, in CS::APEX and here.
#[derive(Debug, PartialEq)]
pub struct Whole {
    pub theirs: &'static str,
    /// Equivalent in the language.
    pub ours: Option<&'static str>,
    kind: Kind,
}

const WHOLES: [Whole; 5] = [
    Whole { theirs: "event_activation", ours: Some("start"), kind: Kind::Event },
    Whole { theirs: "event_deactivation", ours: None, kind: Kind::Event },
    Whole { theirs: "slot_exit", ours: Some("exit"), kind: Kind::Slot },
    Whole { theirs: "slot_abort", ours: Some("abort"), kind: Kind::Slot },
    Whole { theirs: "slot_save", ours: None, kind: Kind::Slot },
];

/// Slots that every node has; they come first.
pub const COMMON_SLOTS: [&str; 2] = ["enable", "disable"];
pub const COMMON_EVENTS: [&str; 3] = ["activated", "deactivated", "processed"];

impl Port {
    fn kind(&self) -> Kind {
        match self {
            Self::Number(kind, _) | Self::Param(kind, _) => *kind,
        }
    }

    /// Name of a port that every node has.
    pub fn common(&self) -> Option<&'static str> {
        match self {
            Self::Number(Kind::Slot, k) => COMMON_SLOTS.get(*k as usize).copied(),
            Self::Number(Kind::Event, k) => COMMON_EVENTS.get(*k as usize).copied(),
            _ => None,
        }
    }

    /// Port of a nested graph that belongs to this port of its node.
    pub fn of_graph(&self) -> Option<(Kind, u32)> {
        match *self {
            Self::Number(kind @ (Kind::In | Kind::Out), k) => Some((kind, k)),
            Self::Number(Kind::Slot, k) => Some((Kind::Slot, k.checked_sub(2)?)),
            Self::Number(Kind::Event, k) => Some((Kind::Event, k.checked_sub(3)?)),
            Self::Param(..) => None,
        }
    }
}

impl Kind {
    /// Keyword of the language, which is also the prefix of port names.
    pub fn word(self) -> &'static str {
        match self {
            Self::In => "in",
            Self::Out => "out",
            Self::Slot => "slot",
            Self::Event => "event",
        }
    }
}

impl PortId {
    /// Reads an id; `node` finds a node by its own.
    pub fn read(id: &str, line: usize, node: impl Fn(&str) -> Option<usize>) -> Result<Self, Wrong> {
        let unknown = |what: String| Wrong::new(line, format!("unknown id `{id}`: {what}"));
        let Some((owner, port)) = id.rsplit_once(":|:") else {
            if let Some(whole) = WHOLES.iter().find(|whole| whole.theirs == id) {
                return Ok(Self::Whole(whole));
            }
            // Seen from inside, the inputs of the graph are sources.
            let kinds = [
                ("relayout", Kind::In),
                ("relayin", Kind::Out),
                ("relayevent", Kind::Slot),
                ("relayslot", Kind::Event),
            ];
            let own = id.rsplit_once('_').and_then(|(name, k)| {
                Some(Self::Own(kinds.iter().find(|(relay, _)| *relay == name)?.1, k.parse().ok()?))
            });
            return own
                .or_else(|| plugin(id))
                .ok_or_else(|| unknown("it is not a port such as `node:|:in_0` or `relayin_0`".to_owned()));
        };
        let index = node(owner).ok_or_else(|| unknown(format!("there is no node `{owner}` in this graph")))?;
        let port = read_port(port).ok_or_else(|| unknown(format!("`{port}` is not a port")))?;
        Ok(Self::Node(index, port))
    }

    /// Name in CS::APEX of a port for which the language has no equivalent.
    pub fn without_counterpart(&self) -> Option<&str> {
        match self {
            Self::Whole(Whole { theirs, ours: None, .. }) => Some(theirs),
            Self::Plugin(_, theirs) => Some(theirs),
            _ => None,
        }
    }

    /// `true` if tokens are sent from this end.
    pub fn is_source(&self) -> bool {
        match self {
            Self::Node(_, port) => matches!(port.kind(), Kind::Out | Kind::Event),
            Self::Own(kind, _) => matches!(kind, Kind::In | Kind::Slot),
            Self::Whole(whole) => whole.kind == Kind::Event,
            Self::Plugin(kind, _) => *kind == Kind::Event,
        }
    }
}

/// Reads the id of a slot or an event of a plugin.
fn plugin(id: &str) -> Option<PortId> {
    let (word, name) = id.split_once('_')?;
    let kind = [Kind::Slot, Kind::Event].into_iter().find(|kind| kind.word() == word)?;
    let is_name = !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    is_name.then(|| PortId::Plugin(kind, id.to_owned()))
}

fn read_port(port: &str) -> Option<Port> {
    let (name, rest) = port.split_once('_').filter(|(_, rest)| !rest.is_empty())?;
    let kind = [Kind::In, Kind::Out, Kind::Slot, Kind::Event].into_iter().find(|kind| kind.word() == name)?;
    match (rest.parse(), kind) {
        (Ok(number), _) => Some(Port::Number(kind, number)),
        (Err(_), Kind::In | Kind::Out) => Some(Port::Param(kind, rest.to_owned())),
        (Err(_), _) => None,
    }
}
