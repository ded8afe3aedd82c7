//! Tokens of one channel of a recording, for tests.

use super::{
    Codec, Reason,
    cdr::Reader,
    types::{TypeMatch, compare, other_message},
};
use crate::Time;
use apex_bag::{CUT, Channel, Message, ROS1, Recording};
use core::{cell::RefCell, time::Duration};
use std::{
    collections::btree_map::{BTreeMap, Entry},
    env,
    path::{Path, PathBuf},
    rc::Rc,
};

/// Tokens of one channel of a recording, with their times.
type Timed<T> = Rc<[(Duration, T)]>;
/// Tokens that were read, and the time of the program at which the recording starts with their stamps.
type Known<T> = Option<(Time, Timed<T>)>;

/// Tokens of one channel of a recording, which are read when it is known at which time of the program it starts. A
/// clone does not read them again for the same time.
pub struct Tokens<T> {
    path: PathBuf,
    /// Channel, and behind a colon the part of its messages.
    wanted: String,
    codec: Option<Codec<T>>,
    /// Frame of the port, in which the messages of other programs have to be.
    frame: Option<&'static str>,
    /// Tokens that were read last.
    known: Rc<RefCell<Known<T>>>,
}

impl<T> Clone for Tokens<T> {
    fn clone(&self) -> Self {
        Self { path: self.path.clone(), wanted: self.wanted.clone(), known: self.known.clone(), ..*self }
    }
}

/// Returns the tokens of the channel `channel` of a recording. The path `file` is relative to the folder of the source
/// file `text`. Behind a colon, `channel` may name one of several tokens in the messages of another program:
/// `/tf: odom -> base_link`.
pub fn tokens<T>(text: &str, file: &str, channel: &str, codec: Option<Codec<T>>) -> Tokens<T> {
    Tokens { path: find(text, file), wanted: channel.to_owned(), codec, frame: None, known: Rc::default() }
}

impl<T> Tokens<T> {
    /// Refuses messages of other programs in another frame than that of the port. Those of Apex do not have their own.
    #[must_use]
    pub fn in_frame(self, frame: &'static str) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Returns the tokens with their times, counted from the start of the recording. The stamps of their headers are
    /// moved as well: they are times of a program in which the recording starts at `begun`.
    ///
    /// # Panics
    /// The file cannot be read, or has no such tokens.
    pub fn begun_at(self, begun: Time) -> Timed<T> {
        if let Some((_, tokens)) = self.known.borrow().as_ref().filter(|(known, _)| *known == begun) {
            return tokens.clone();
        }
        let read = read_tokens(&self, begun);
        let tokens: Timed<T> = read.unwrap_or_else(|message| panic!("{message}")).into();
        *self.known.borrow_mut() = Some((begun, tokens.clone()));
        tokens
    }
}

fn read_tokens<T>(of: &Tokens<T>, begun: Time) -> Result<Vec<(Duration, T)>, String> {
    let Tokens { path, wanted, codec, frame, .. } = of;
    let wanted = wanted.as_str();
    let codec =
        codec.ok_or("the tokens of the port cannot be read from a recording: their type is not known to serde")?;
    let (topic, part) = wanted.split_once(':').map_or((wanted, ""), |(topic, part)| (topic.trim(), part.trim()));
    let cannot_read = |error| format!("cannot read `{}`: {error}", path.display());
    let mut recording = Recording::open(path).map_err(cannot_read)?;
    let (mut messages, mut readers, mut first) = (vec![], BTreeMap::new(), u64::MAX);
    while let Some(message) = recording.next_message().map_err(cannot_read)? {
        first = first.min(message.time);
        let found = recording.channels().get(&message.channel);
        let Some(found) = found.filter(|c| c.name == topic || c.topic == topic) else { continue };
        if let Entry::Vacant(entry) = readers.entry(message.channel) {
            entry.insert(Read::of(path, found, recording.program().is_some(), codec)?);
        }
        messages.push(message);
    }
    is_whole(path, &recording)?;
    // Recorders write messages as they come, which is not always the order of their times.
    messages.sort_by_key(|message| message.time);
    let zero = recording.zero(first);
    let since = i64::try_from(zero).unwrap_or(i64::MAX).saturating_sub(begun.as_nanos());
    let mut tokens = vec![];
    for Message { channel, time, data, .. } in messages {
        let read = &readers[&channel];
        let token =
            apex_bag::message(&data).map_err(Into::into).and_then(|bytes| read.read(&bytes, since, (part, *frame)));
        let token = token.map_err(|reason| {
            let (ty, file) = (codec.schema.name, path.display());
            format!("a token of `{wanted}` in `{file}` is not one of `{ty}`: {reason}")
        })?;
        tokens.extend(token.map(|token| (Duration::from_nanos(time - zero), token)));
    }
    if tokens.is_empty() && !readers.is_empty() && !part.is_empty() {
        return Err(format!("no message of `{topic}` in `{}` has `{part}`", path.display()));
    }
    if tokens.is_empty() {
        let names: Vec<String> = recording.channels().values().map(|c| format!("`{}`", c.name)).collect();
        return Err(format!("`{}` has no tokens of `{wanted}`; it has {}", path.display(), names.join(", ")));
    }
    Ok(tokens)
}

/// Checks that a recording was read to its end. One of another program may be cut off: its recorder was, too.
fn is_whole(path: &Path, recording: &Recording) -> Result<(), String> {
    match recording.cut() {
        None => Ok(()),
        Some(CUT) if recording.program().is_none() => {
            eprintln!("warning: `{}` is not complete: {CUT}; the messages before are fed", path.display());
            Ok(())
        }
        Some(cut) => Err(format!("`{}` is incomplete: {cut}", path.display())),
    }
}

/// Function that reads a token in a message, or the part of this name.
type OfMessage<T> = fn(&mut Reader<'_>, &str) -> Result<Option<T>, Reason>;

/// Function that reads the tokens of a channel.
enum Read<T> {
    /// Tokens of the type of the port. Those in the message of another program are also read as such, for its frame.
    Own(fn(&[u8], i64) -> Result<T, Reason>, Option<OfMessage<T>>),
    /// Messages that hold such tokens, in CDR or in the form of ROS 1.
    Foreign { read: OfMessage<T>, is_ros1: bool },
}

impl<T> Read<T> {
    /// Selects the function for a channel.
    fn of(path: &Path, channel: &Channel, is_own: bool, codec: Codec<T>) -> Result<Self, String> {
        let (messages, is_ros1) = ((codec.messages)(), channel.encoding == ROS1);
        let is_own_type = channel.schema == codec.schema.name && !is_ros1;
        if is_own || is_own_type || messages.is_empty() || !["cdr", ROS1].contains(&&*channel.encoding) {
            check(path, channel, codec)?;
            let message = messages.into_iter().next().filter(|_| !is_own);
            return Ok(Self::Own(codec.read_since, message.map(|message| message.read)));
        }
        let (file, topic, ty) = (path.display(), &channel.topic, &channel.schema);
        let Some(message) = messages.iter().find(|message| message.name == ty) else {
            let names: Vec<String> = messages.iter().map(|message| format!("`{}`", message.name)).collect();
            return Err(format!("`{topic}` in `{file}` is of type `{ty}`; the port reads {}", names.join(", ")));
        };
        match other_message(channel, message.definition) {
            Some(how) => Err(format!("`{topic}` in `{file}` {how}")),
            None => Ok(Self::Foreign { read: message.read, is_ros1 }),
        }
    }

    /// Reads the token in the bytes of a message, or the part of this name, which has to be in this frame. Stamps count
    /// from `zero`, in ns.
    fn read(&self, bytes: &[u8], zero: i64, (part, frame): (&str, Option<&str>)) -> Result<Option<T>, Reason> {
        let (read, is_ros1) = match self {
            Self::Own(read, message) => {
                if let Some((read, frame)) = message.zip(frame) {
                    in_frame(Reader::new(bytes)?, read, (part, Some(frame)))?;
                }
                return read(bytes, zero).map(Some);
            }
            Self::Foreign { read, is_ros1 } => (read, *is_ros1),
        };
        let message = if is_ros1 { Reader::ros1(bytes) } else { Reader::new(bytes)? };
        in_frame(message.since(zero), *read, (part, frame))
    }
}

/// Reads the token in a message, or the part of this name, which has to be in this frame.
fn in_frame<T>(
    message: Reader<'_>,
    read: OfMessage<T>,
    (part, frame): (&str, Option<&str>),
) -> Result<Option<T>, Reason> {
    let mut message = frame.map_or(message.clone(), |frame| message.in_frame(frame));
    let token = read(&mut message, part)?;
    token.map(|token| message.check_frame().map(|()| token)).transpose()
}

/// Checks that the recorded tokens are of the type of the port.
fn check<T>(path: &Path, channel: &Channel, codec: Codec<T>) -> Result<(), String> {
    match compare(channel, codec.schema, codec.shape) {
        TypeMatch::Same => {}
        TypeMatch::Undescribed => {
            let (name, file) = (&channel.name, path.display());
            eprintln!("warning: `{file}` does not describe the type of `{name}`: if it has changed, nothing tells");
        }
        TypeMatch::Changed(change) => {
            return Err(format!("`{}` cannot be fed: {change}\n  record it again", path.display()));
        }
    }
    Ok(())
}

/// Returns the path of `file`. Tests run in the folder of their package, but paths of source files begin at the
/// workspace.
fn find(text: &str, file: &str) -> PathBuf {
    let from_text = Path::new(text).parent().unwrap_or(Path::new("")).join(file);
    let here = env::current_dir().unwrap_or_default();
    let places = here.ancestors().map(|folder| folder.join(&from_text));
    places.into_iter().find(|path| path.exists()).unwrap_or(from_text)
}
