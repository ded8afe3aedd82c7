//! Messages between a robot and its viewers. Each is a length in bytes (`u32`, little endian), and a postcard message.

mod framing;

#[cfg(feature = "studio")]
pub use framing::Frames;
pub use framing::{Joined, read, write};

use crate::PortKind;
#[cfg(feature = "studio")]
use crate::{Info, params::ParamInfo, record::Channel};
use serde::{Deserialize, Serialize};
use std::{string::String, vec::Vec};

/// Version of the messages. It changes with every change of their types.
pub const VERSION: u32 = crate::bytes::VERSION;

/// Maximum size of a message in bytes.
pub const MAX_BYTES: usize = 4 << 20;

/// Maximum size of a token that is sent as a message, in bytes.
pub const MAX_TOKEN: usize = 3 << 20;

/// A message of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Report {
    /// The robot, as the first message on a connection; only [`ReadOnly`](Self::ReadOnly) comes before it.
    About(About),
    /// All active nodes, after [`About`](Self::About).
    Active(Vec<u32>),
    /// A reaction of a thread group begins. The following messages of the group are of this time.
    Reaction {
        /// Thread group.
        group: u32,
        /// Time of the robot's clock in ns.
        now: i64,
    },
    /// A node fires.
    Fired(u32),
    /// The slot at the end of a connection takes its token.
    Handled(u32),
    /// A node sends a token over this channel. Comes after the node has fired, and only if a viewer follows tokens.
    Sent(u32),
    /// A node becomes active or inactive.
    Activity {
        /// The node.
        node: u32,
        /// `true` if it becomes active.
        active: bool,
    },
    /// A node returned an error or panicked.
    Failed {
        /// The node.
        node: u32,
        /// Error message.
        error: String,
    },
    /// A node missed its deadline.
    Late {
        /// The node.
        node: u32,
        /// Age of its oldest token in ns.
        age: u64,
    },
    /// A node hangs.
    Hung {
        /// The node.
        node: u32,
        /// Running time in ns.
        running: u64,
    },
    /// A token at a parameter port was out of range.
    Refused {
        /// The node.
        node: u32,
        /// Name of the parameter.
        parameter: String,
        /// The refused value.
        value: String,
    },
    /// The node at the end of a connection waits for an event that can no longer be triggered.
    Waits(u32),
    /// Tokens cycle without time passing. Nodes of the last steps, with the number of steps of each.
    Endless(Vec<(u32, u32)>),
    /// A claim is violated.
    ClaimFailed(u32),
    /// The newest token of a channel that the viewer asked for.
    Value {
        /// The channel.
        channel: u32,
        /// Time of the token in ns.
        now: i64,
        /// The token as text; shortened if it is long.
        text: String,
        /// The token as a message in CDR; empty if its type is none.
        bytes: Vec<u8>,
    },
    /// Times of the calls of nodes since a viewer asked for them.
    Times(Vec<NodeTimes>),
    /// Number of messages that were lost since the last such message, because they came too fast.
    Lost(u64),
    /// Value of a parameter in TOML, or the reason why it was not set.
    Param {
        /// Full name.
        name: String,
        /// Its value, or an error message.
        value: Result<String, String>,
        /// If it was set: the number of reactions of a simulated robot before that.
        reactions: Option<u64>,
    },
    /// State of a simulated robot, after each change of it.
    Pace {
        /// `true` if it stands still.
        paused: bool,
        /// Seconds of simulated time per second; infinite for as fast as possible.
        speed: f64,
        /// Number of reactions so far.
        reactions: u64,
        /// Number of ways ([`RunTo`](Command::RunTo) and the like) that are over: the robot is there, or was told
        /// otherwise.
        ways: u64,
    },
    /// Numbers of reactions before all checkpoints, in sequence. The last one may be new: it is then the current state.
    Checkpoints(Vec<u64>),
    /// The program has no checkpoints, for this reason, or cannot go back to one.
    NoCheckpoints(String),
    /// The program has ended. No message follows.
    Ended,
    /// The robot is there: sent each second, whatever the program does. For each thread group the number of its
    /// reactions, and `true` if it is in one.
    Alive(Vec<(u64, bool)>),
    /// The viewer may only look: the robot sets no parameters for it, does not halt, and measures nothing.
    ReadOnly,
    /// The robot ends the connection, for this reason.
    Dismissed(String),
    /// The token on this connection can never be taken any more.
    Stuck(u32),
    /// A problem of the process that is not one of a node: a network that is silent, say.
    Beside(String),
}

/// A message of a viewer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// Asks for the newest token of a channel at this interval; an interval of 0 ends that.
    Watch {
        /// The channel.
        channel: u32,
        /// Interval in ms.
        every: u32,
    },
    /// Asks for the values of all parameters.
    Params,
    /// Lets the times of all calls be measured, or no longer.
    Measure(bool),
    /// Asks for every token that is sent, without its value, or no longer.
    Follow(bool),
    /// Sets a parameter.
    Set {
        /// Full name.
        name: String,
        /// Value in TOML.
        value: String,
    },
    /// Halts a simulated robot between two reactions.
    Pause,
    /// Lets a halted robot react once.
    Step,
    /// Lets a simulated robot continue, at this number of simulated seconds per second.
    Run {
        /// The speed; infinite for as fast as possible.
        speed: f64,
    },
    /// Lets a simulated robot continue as fast as possible up to this number of reactions, and halts it there. One that
    /// has gone further halts at once.
    RunTo {
        /// Number of reactions since its start.
        reactions: u64,
    },
    /// Lets a simulated robot continue as fast as possible, and halts it before the first reaction at this time or a
    /// later one.
    RunUntil {
        /// Time in ns.
        now: i64,
    },
    /// Halts a simulated robot between two reactions whenever this condition has become true. An empty one never is.
    Break(Vec<Test>),
    /// Lets a simulated robot make checkpoints from time to time, or no longer.
    Keep(bool),
    /// Halts a simulated robot at the last checkpoint that has no more than this number of reactions before it. The
    /// connection ends; the next one at the same address is to the robot at the checkpoint.
    GoBack {
        /// Number of reactions since its start.
        reactions: u64,
    },
    /// The viewer is there, and has no other wish. If there are too many viewers, the one leaves that has said nothing
    /// for the longest time.
    Alive,
    /// The token of the robot, before all other commands.
    Token(String),
}

impl Command {
    /// `true` if it changes what the robot does, or how fast.
    pub const fn acts(&self) -> bool {
        match self {
            Self::Watch { .. } | Self::Params | Self::Follow(_) | Self::Alive | Self::Token(_) => false,
            Self::Measure(_)
            | Self::Set { .. }
            | Self::Pause
            | Self::Step
            | Self::Run { .. }
            | Self::RunTo { .. }
            | Self::RunUntil { .. }
            | Self::Break(_)
            | Self::Keep(_)
            | Self::GoBack { .. } => true,
        }
    }
}

/// Times of the calls of a node: firings, and tokens at its slots.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct NodeTimes {
    /// The node.
    pub node: u32,
    /// Number of its calls.
    pub calls: u64,
    /// Total duration in ns, without the calls of other nodes inside.
    pub total: u64,
    /// Longest duration of a call in ns, without the calls of other nodes inside.
    pub worst: u64,
}

/// A step of a condition on active nodes. Each takes its operands from the results of those before it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Test {
    /// One of these nodes is active.
    Active(Vec<u32>),
    /// The last result is false.
    Not,
    /// The last two results are true.
    And,
    /// One of the last two results is true.
    Or,
}

impl Test {
    /// Evaluates a condition.
    pub fn holds(tests: &[Self], is_active: impl Fn(u32) -> bool) -> bool {
        let mut results = Vec::new();
        for test in tests {
            let mut last = || results.pop().unwrap_or(false);
            let result = match test {
                Self::Active(nodes) => nodes.iter().any(|node| is_active(*node)),
                Self::Not => !last(),
                Self::And => last() & last(),
                Self::Or => last() | last(),
            };
            results.push(result);
        }
        results.pop().unwrap_or(false)
    }
}

/// Description of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// [`VERSION`] of its messages.
    pub version: u32,
    /// Name of the graph or robot.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// Paths of its source files.
    pub files: Vec<String>,
    /// `true` if its time is simulated, so that it can be halted.
    pub simulated: bool,
    /// Nodes.
    pub nodes: Vec<AboutNode>,
    /// Connections.
    pub connections: Vec<AboutConnection>,
    /// Names of the thread groups.
    pub groups: Vec<String>,
    /// Claims.
    pub claims: Vec<String>,
    /// Ports whose tokens can be asked for.
    pub channels: Vec<AboutChannel>,
    /// Parameters.
    pub params: Vec<AboutParam>,
}

/// A node of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AboutNode {
    /// Full name.
    pub name: String,
    /// Node type.
    pub kind: String,
    /// First sentence of its documentation.
    pub docs: String,
    /// Index of its source file.
    pub file: u32,
    /// Line, from 1.
    pub line: u32,
    /// Column, from 1.
    pub column: u32,
    /// Names and types of its ports.
    pub ports: Vec<(String, PortRole, String)>,
}

/// Kind of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PortRole {
    /// Synchronous input.
    Input,
    /// Synchronous output.
    Output,
    /// Asynchronous input.
    Slot,
    /// Asynchronous output.
    Event,
}

/// A connection of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AboutConnection {
    /// The sending node.
    pub from: u32,
    /// Name of the sending port.
    pub output: String,
    /// The receiving node.
    pub to: u32,
    /// Name of the receiving port.
    pub input: String,
    /// `true` if activity flows over it.
    pub activity: bool,
}

/// A port whose tokens can be asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AboutChannel {
    /// Name of the port and its node.
    pub name: String,
    /// The node.
    pub node: u32,
    /// Schema of its tokens; `None` if they cannot be shown.
    pub schema: Option<AboutSchema>,
}

/// Schema of tokens.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AboutSchema {
    /// Name of the type of messages, or of the Rust type.
    pub name: String,
    /// Definition of the message as ROS 2 has it; empty for tokens of other types.
    pub definition: String,
}

/// A parameter of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AboutParam {
    /// Full name.
    pub name: String,
    /// Type.
    pub ty: String,
    /// SI unit of its numbers.
    pub unit: Option<String>,
    /// The smallest value.
    pub min: Option<f64>,
    /// The largest value.
    pub max: Option<f64>,
}

#[cfg(feature = "studio")]
impl About {
    /// Returns the description of a program.
    pub fn new(info: &Info, channels: &[Channel], params: &[ParamInfo], simulated: bool) -> Self {
        let node = |at: usize| {
            let (node, kind) = (&info.nodes[at], info.kind(at));
            AboutNode {
                name: node.name.into(),
                kind: kind.name.into(),
                docs: kind.docs.into(),
                file: node.place.file as u32,
                line: node.place.line,
                column: node.place.column,
                ports: kind.ports.iter().map(|port| (port.name.into(), port.kind.into(), port.ty.into())).collect(),
            }
        };
        let connection = |c: &crate::ConnectionInfo| AboutConnection {
            from: c.from as u32,
            output: c.output.into(),
            to: c.to as u32,
            input: c.input.into(),
            activity: c.activity,
        };
        let channel = |channel: &Channel| AboutChannel {
            name: channel.name.into(),
            node: channel.node as u32,
            schema: channel
                .schema
                .map(|schema| AboutSchema { name: schema.name.into(), definition: schema.complete_definition() }),
        };
        let param = |param: &ParamInfo| AboutParam {
            name: param.name.into(),
            ty: param.ty.into(),
            unit: param.unit.map(Into::into),
            min: param.range.min,
            max: param.range.max,
        };
        Self {
            version: VERSION,
            name: info.name.into(),
            docs: info.docs.into(),
            files: info.files.iter().map(|file| (*file).into()).collect(),
            simulated,
            nodes: (0..info.nodes.len()).map(node).collect(),
            connections: info.connections.iter().map(connection).collect(),
            groups: info.groups.iter().map(|group| group.name.into()).collect(),
            claims: info.claims.iter().map(|claim| (*claim).into()).collect(),
            channels: channels.iter().map(channel).collect(),
            params: params.iter().map(param).collect(),
        }
    }
}

impl From<PortKind> for PortRole {
    fn from(kind: PortKind) -> Self {
        match kind {
            PortKind::Input => Self::Input,
            PortKind::Output => Self::Output,
            PortKind::Slot => Self::Slot,
            PortKind::Event => Self::Event,
        }
    }
}

/// Returns a text of at most `length` bytes.
pub fn shortened(mut text: String, length: usize) -> String {
    if text.len() > length {
        let end = (0..=length).rev().find(|end| text.is_char_boundary(*end)).unwrap_or(0);
        text.truncate(end);
        text.push('…');
    }
    text
}
