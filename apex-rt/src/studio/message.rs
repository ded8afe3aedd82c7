//! Messages between a robot and its viewers. Each is a length in bytes (`u32`, little endian), and a postcard message.

use crate::PortKind;
#[cfg(feature = "studio")]
use crate::{Info, params::ParamInfo, record::Channel};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    io::{self, Read},
    string::String,
    vec::Vec,
};

/// Version of the messages. It changes with every change of their types.
pub const VERSION: u32 = crate::bytes::VERSION;

/// Maximum size of a message in bytes.
pub const MAX_BYTES: usize = 4 << 20;

/// Maximum size of a description that is looked for in a stream that is joined in the middle, in bytes.
const MAX_JOINED: usize = 256 << 10;

/// Maximum size of a token that is sent as a message, in bytes.
pub const MAX_TOKEN: usize = 3 << 20;

/// A message of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Report {
    /// The robot, as the first message on a connection.
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
    },
    /// Numbers of reactions before all checkpoints, in sequence. The last one may be new: it is then the current state.
    Checkpoints(Vec<u64>),
    /// The program has no checkpoints, for this reason, or cannot go back to one.
    NoCheckpoints(String),
    /// The program has ended. No message follows.
    Ended,
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
                .map(|schema| AboutSchema { name: schema.name.into(), definition: schema.definition.into() }),
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

/// Size of the length before each message.
const LENGTH: usize = 4;

/// Appends a message to `out`. A message that is too large is left out.
pub fn write(message: &impl Serialize, out: &mut Vec<u8>) {
    let start = out.len();
    out.extend_from_slice(&[0; LENGTH]);
    let Ok(mut all) = postcard::to_extend(message, core::mem::take(out)) else { return };
    let length = all.len() - start - LENGTH;
    if length > MAX_BYTES {
        all.truncate(start);
    } else {
        all[start..start + LENGTH].copy_from_slice(&(length as u32).to_le_bytes());
    }
    *out = all;
}

/// Takes the first message from `bytes`. Returns `None` if it is not complete yet.
///
/// # Errors
/// Bytes that are not such a message.
pub fn take<T: DeserializeOwned>(bytes: &mut Vec<u8>) -> io::Result<Option<T>> {
    let Some(length) = bytes.first_chunk::<LENGTH>() else { return Ok(None) };
    let end = checked(*length)? + LENGTH;
    let Some(message) = bytes.get(LENGTH..end) else { return Ok(None) };
    let message = decoded(message)?;
    bytes.drain(..end);
    Ok(Some(message))
}

/// Reads a message. Returns `None` at the end of the stream.
///
/// # Errors
/// The stream cannot be read, ends within a message, or has bytes that are not such a message.
pub fn read<T: DeserializeOwned>(from: &mut impl Read) -> io::Result<Option<T>> {
    let mut length = [0; LENGTH];
    match from.read_exact(&mut length) {
        Ok(()) => {}
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        Err(error) => return Err(error),
    }
    // Grows with what has come: a length alone reserves nothing.
    let (size, mut message) = (checked(length)?, Vec::new());
    from.take(size as u64).read_to_end(&mut message)?;
    if message.len() < size {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    decoded(&message).map(Some)
}

/// Reader of a stream that may be joined in the middle: it begins with the next description of a robot.
pub struct Joined<R> {
    from: R,
    /// Bytes that have come.
    came: Vec<u8>,
    has_begun: bool,
}

impl<R: Read> Joined<R> {
    /// Returns a reader of `from`.
    pub fn new(from: R) -> Self {
        Self { from, came: Vec::new(), has_begun: false }
    }

    /// Reads up to a description, which is then the beginning of `came`, or up to the end of the stream.
    fn begin(&mut self) -> io::Result<()> {
        while !self.has_begun {
            let mut bytes = [0; 512];
            match self.from.read(&mut bytes)? {
                0 => {
                    self.came.clear();
                    return Ok(());
                }
                count => self.came.extend_from_slice(&bytes[..count]),
            }
            self.skip();
        }
        Ok(())
    }

    /// Removes the bytes before a description, or what may become one.
    fn skip(&mut self) {
        let mut at = 0;
        while let Some(begin) = self.came[at..].first_chunk::<{ LENGTH + 2 }>() {
            let [length @ .., kind, version] = *begin;
            let length = u32::from_le_bytes(length) as usize;
            let is_about = (kind, u32::from(version)) == (0, VERSION) && length <= MAX_JOINED;
            match self.came.get(at + LENGTH..at + LENGTH + length).filter(|_| is_about) {
                Some(message) if postcard::from_bytes::<Report>(message).is_ok() => {
                    self.has_begun = true;
                    break;
                }
                // The rest of it has not come yet.
                None if is_about => break,
                _ => at += 1,
            }
        }
        self.came.drain(..at);
    }
}

impl<R: Read> Read for Joined<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.begin()?;
        if self.came.is_empty() {
            return self.from.read(into);
        }
        let count = self.came.len().min(into.len());
        into[..count].copy_from_slice(&self.came[..count]);
        self.came.drain(..count);
        Ok(count)
    }
}

fn checked(length: [u8; LENGTH]) -> io::Result<usize> {
    let length = u32::from_le_bytes(length) as usize;
    if length > MAX_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            "a message is too long: the sender is not an Apex robot",
        ));
    }
    Ok(length)
}

fn decoded<T: DeserializeOwned>(message: &[u8]) -> io::Result<T> {
    postcard::from_bytes(message).map_err(|error| {
        let why = std::format!("a message cannot be read ({error}): the sender has another version of Apex");
        io::Error::new(io::ErrorKind::InvalidData, why)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_come_back_as_they_were_sent() {
        let sent = [Report::Fired(7), Report::Failed { node: 3, error: "no <scan>".into() }, Report::Ended];
        let mut bytes = std::vec![];
        sent.iter().for_each(|message| write(message, &mut bytes));
        let mut from = &bytes[..];
        let read: Vec<Report> = core::iter::from_fn(|| read(&mut from).unwrap()).collect();
        assert_eq!(read, sent);
        // In pieces, as a socket delivers them.
        let (mut came, mut got) = (std::vec![], std::vec![]);
        for byte in bytes {
            came.push(byte);
            got.extend(take::<Report>(&mut came).unwrap());
        }
        assert_eq!(got, sent);
    }

    #[cfg(feature = "studio")]
    #[test]
    fn a_stream_is_joined_at_the_next_description() {
        use crate::{Info, bytes::ByteStream};
        const INFO: Info = Info {
            name: "Cart",
            docs: "",
            files: &["cart.afg"],
            nodes: &[crate::NodeInfo::new("motor", 0, [0, 3, 5], false, false)],
            kinds: &[crate::KindInfo::new("Motor", "Turns.", &[crate::PortInfo::new("go", PortKind::Slot, "()")])],
            graphs: &[],
            connections: &[crate::ConnectionInfo::new(0, "out", 0, "go", true)],
            clusters: &[],
            groups: &[],
            end_if_hung: None,
            claims: &["exclusive(motor)"],
        };
        let mut bytes = std::vec![];
        let mut stream = ByteStream::new(|part: &[u8]| bytes.extend_from_slice(part));
        crate::Observer::fired(&mut stream, 300);
        stream.describe_as(&INFO, |node| node == 0);
        crate::Observer::activity(&mut stream, 0, true);
        crate::Observer::failed(&mut stream, 0, &"x".repeat(300));
        crate::Observer::late(&mut stream, 1, core::time::Duration::from_millis(2));
        // From the middle of the first message, in small pieces.
        let mut joined = Joined::new(&bytes[2..]);
        let all: Vec<Report> = core::iter::from_fn(|| read(&mut joined).unwrap()).collect();
        let about = About { simulated: false, ..About::new(&INFO, &[], &[], false) };
        assert_eq!(
            all,
            [
                Report::About(about),
                Report::Active(std::vec![0]),
                Report::Activity { node: 0, active: true },
                Report::Failed { node: 0, error: "x".repeat(100) },
                Report::Late { node: 1, age: 2_000_000 },
            ]
        );
        assert_eq!(read::<Report>(&mut Joined::new(&bytes[..30])).unwrap(), None);
    }

    #[test]
    fn hostile_bytes_are_errors() {
        assert!(read::<Report>(&mut &[0xff, 0xff, 0xff, 0xff, 1][..]).is_err());
        assert!(read::<Report>(&mut &[9, 0, 0, 0, 1][..]).is_err());
        assert!(take::<Command>(&mut std::vec![1, 0, 0, 0, 200]).is_err());
        assert!(read::<Report>(&mut &[][..]).unwrap().is_none());
    }
}
