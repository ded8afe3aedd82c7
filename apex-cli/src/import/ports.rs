//! The ends of connections.

use super::Wrong;

/// What kind of port it is, as its own graph or node has it.
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
    /// By its number. Slots 0 and 1 and events 0 to 2 are those that every node has.
    Number(Kind, u32),
    /// That of a parameter: where it is set, or where it is sent.
    Param(Kind, String),
}

/// An end of a connection.
#[derive(Debug, Clone, PartialEq)]
pub enum PortId {
    /// A node, by its place in the graph.
    Node(usize, Port),
    /// A port of the graph itself, seen from inside.
    Own(Kind, u32),
    /// A slot or an event of CS::APEX itself.
    Whole(&'static Whole),
}

impl PortId {
    /// Whether its tokens are of type `()`, whatever they are there.
    pub fn sends_signals(&self) -> bool {
        match self {
            Self::Node(_, port) => port.common().is_some(),
            Self::Whole(_) => true,
            Self::Own(..) => false,
        }
    }

    /// Whether it takes tokens of type `()`, although there it takes any.
    pub fn takes_signals(&self) -> bool {
        match self {
            Self::Node(_, port) => port.common().is_some(),
            Self::Whole(whole) => whole.ours.is_some(),
            Self::Own(..) => false,
        }
    }
}

/// A port of the program as a whole, there and here.
#[derive(Debug, PartialEq)]
pub struct Whole {
    pub theirs: &'static str,
    /// What the language has for it.
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

/// Slots and events that every node has come first.
pub const COMMON_SLOTS: [&str; 2] = ["enable", "disable"];
pub const COMMON_EVENTS: [&str; 3] = ["activated", "deactivated", "processed"];

impl Port {
    fn kind(&self) -> Kind {
        match self {
            Self::Number(kind, _) | Self::Param(kind, _) => *kind,
        }
    }

    /// Its name, if every node has it.
    pub fn common(&self) -> Option<&'static str> {
        match self {
            Self::Number(Kind::Slot, k) => COMMON_SLOTS.get(*k as usize).copied(),
            Self::Number(Kind::Event, k) => COMMON_EVENTS.get(*k as usize).copied(),
            _ => None,
        }
    }

    /// The port of a nested graph that this port of its node is.
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
    /// Its word in the language, which begins its names as well.
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
            // Inside, an input of the graph is where tokens come from.
            let kinds = [
                ("relayout", Kind::In),
                ("relayin", Kind::Out),
                ("relayevent", Kind::Slot),
                ("relayslot", Kind::Event),
            ];
            let own = id.rsplit_once('_').and_then(|(name, k)| {
                Some(Self::Own(kinds.iter().find(|(relay, _)| *relay == name)?.1, k.parse().ok()?))
            });
            return own.ok_or_else(|| unknown("it is not a port such as `node:|:in_0` or `relayin_0`".to_owned()));
        };
        let index = node(owner).ok_or_else(|| unknown(format!("there is no node `{owner}` in this graph")))?;
        let port = read_port(port).ok_or_else(|| unknown(format!("`{port}` is not a port")))?;
        Ok(Self::Node(index, port))
    }

    /// Its name there, if the language has no such port.
    pub fn without_counterpart(&self) -> Option<&'static str> {
        match self {
            Self::Whole(Whole { theirs, ours: None, .. }) => Some(theirs),
            _ => None,
        }
    }

    /// Whether tokens come from here.
    pub fn is_source(&self) -> bool {
        match self {
            Self::Node(_, port) => matches!(port.kind(), Kind::Out | Kind::Event),
            Self::Own(kind, _) => matches!(kind, Kind::In | Kind::Slot),
            Self::Whole(whole) => whole.kind == Kind::Event,
        }
    }
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
