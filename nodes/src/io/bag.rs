use apex_bag::{CUT, Channel, ROS1, Recording, message};
use apex_messages::{Foreign, Message, Reason, cdr::Reader};
use apex_rt::{Ctx, Event, Time, node, record::other_message};
use core::fmt;
use std::{collections::BTreeMap, path::Path, vec::Vec};

/// Error of a recording that cannot be played.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BagError {
    /// Path of the file.
    pub file: String,
    /// Description of the error.
    pub message: String,
}

impl fmt::Display for BagError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.file, self.message)
    }
}

impl std::error::Error for BagError {}

/// Plays a topic of a recording (MCAP, or a bag of ROS 1), also of another program: sends each token in the first
/// firing at or after its time, counted from the first message of the file. Times in headers are counted so, too.
/// After the last token it triggers `done` and sends ⊥, or with `repeat` begins again, at the time of that firing.
///
/// Give it a short period: `every 1ms`. A firing sends one token at most, so that none is lost. `topic` may name one of
/// several tokens in a message: `/tf: odom -> base_link`. The file is read while it is played. With `frame`, each token
/// has to be in this frame, by the header of its message.
///
/// Fails if the file cannot be read, has no such topic, or another type or definition of its messages, and at a message
/// that cannot be read, which is left out. A file that was cut off ends there.
#[node]
pub struct BagTopic<T> {
    /// Path of the file.
    #[param]
    file: String,
    /// Topic, or name of the channel, and behind a colon the part of its messages.
    #[param]
    topic: &'static str,
    /// Plays the topic again and again.
    #[param(default = false)]
    repeat: bool,
    /// Frame of the tokens; any if it is empty.
    #[param(default = "")]
    frame: &'static str,
    state: State<T>,
}

/// Progress of the node.
#[derive(Default)]
enum State<T> {
    #[default]
    Closed,
    Playing(Box<Player<T>>),
    /// With the last token sent, or after an error.
    Ended,
}

/// Recording that is being played.
struct Player<T> {
    recording: Recording,
    /// Topic, and part of its messages.
    wanted: (&'static str, &'static str),
    /// Frame of the tokens; any if it is empty.
    frame: &'static str,
    forms: Vec<Foreign<T>>,
    /// Functions that read the messages of the topic's channels, by their number.
    reads: BTreeMap<u16, Read<T>>,
    /// Time at which it began.
    begun: Time,
    /// Time of the first message, in ns.
    start: Option<u64>,
    /// Token that comes next, with its time.
    next: Option<(Time, T)>,
    /// `true` if the topic has a message, and if a message has the part.
    has_topic: bool,
    has_part: bool,
}

#[node]
impl<T: Message> BagTopic<T> {
    fn process(&mut self, ctx: &Ctx, done: Event<()>) -> Result<Option<T>, BagError> {
        let result = self.play(ctx.now(), done);
        result.map_err(|message| BagError { file: self.file.clone(), message })
    }

    fn play(&mut self, now: Time, done: Event<()>) -> Result<Option<T>, String> {
        if let State::Closed = self.state {
            // Not opened again in each firing, if it cannot be.
            self.state = State::Ended;
            self.state = State::Playing(Box::new(Player::open(&self.file, (self.topic, self.frame), now)?));
        }
        let State::Playing(player) = &mut self.state else { return Ok(None) };
        if player.next.is_none() {
            match player.read() {
                Ok(Some(next)) => player.next = Some(next),
                Ok(None) => {
                    let end = player.end();
                    self.state = if self.repeat && end.is_ok() { State::Closed } else { State::Ended };
                    done.emit(());
                    return end.map(|()| None);
                }
                Err(Mistake::Message(message)) => return Err(message),
                Err(Mistake::File(message)) => {
                    self.state = State::Ended;
                    return Err(message);
                }
            }
        }
        Ok(player.next.take_if(|(time, _)| *time <= now).map(|(_, token)| token))
    }
}

/// Function that reads a token in a message.
type Read<T> = fn(&mut Reader<'_>, &str) -> Result<Option<T>, Reason>;

/// Something that cannot be read.
enum Mistake {
    /// A message; the next one may be right.
    Message(String),
    /// The file, or the topic.
    File(String),
}

impl<T: Message> Player<T> {
    fn open(file: &str, (topic, frame): (&'static str, &'static str), begun: Time) -> Result<Self, String> {
        let recording = Recording::open(Path::new(file)).map_err(|error| error.to_string())?;
        let (topic, part) = topic.split_once(':').unwrap_or((topic, ""));
        let mut forms: Vec<Foreign<T>> = T::others();
        forms.insert(0, Foreign::itself());
        let wanted = (topic.trim(), part.trim());
        let (reads, start, next) = (BTreeMap::new(), None, None);
        Ok(Self { recording, wanted, frame, forms, reads, begun, start, next, has_topic: false, has_part: false })
    }

    /// Reads the next token, with its time.
    fn read(&mut self) -> Result<Option<(Time, T)>, Mistake> {
        let (topic, _) = self.wanted;
        loop {
            let next = self.recording.next_message().map_err(|error| Mistake::File(error.to_string()))?;
            let Some(found) = next else { return Ok(None) };
            let zero = self.recording.zero(*self.start.get_or_insert(found.time));
            let channel = self.recording.channels().get(&found.channel);
            let Some(channel) = channel.filter(|c| c.name == topic || c.topic == topic) else { continue };
            self.has_topic = true;
            let read = match self.reads.get(&found.channel) {
                Some(read) => *read,
                None => {
                    let read = self.form(channel).map_err(Mistake::File)?.read;
                    self.reads.insert(found.channel, read);
                    read
                }
            };
            let bytes = message(&found.data).map_err(|why| Mistake::Message(format!("`{topic}`: {why}")))?;
            let reader = if channel.encoding == ROS1 { Ok(Reader::ros1(&bytes)) } else { Reader::new(&bytes) };
            let nanos = |time: u64| i64::try_from(time).unwrap_or(i64::MAX);
            let since = nanos(zero).saturating_sub(self.begun.as_nanos());
            let token = reader.and_then(|reader| self.token(reader.since(since), read));
            let token = token.map_err(|why| Mistake::Message(format!("`{topic}`: a message cannot be read: {why}")))?;
            if let Some(token) = token {
                self.has_part = true;
                return Ok(Some((Time::from_nanos(nanos(found.time).saturating_sub(since)), token)));
            }
        }
    }

    /// Reads a token; `None` if the message does not have the part.
    fn token(&self, message: Reader<'_>, read: Read<T>) -> Result<Option<T>, Reason> {
        let mut message = if self.frame.is_empty() { message } else { message.in_frame(self.frame) };
        let token = read(&mut message, self.wanted.1)?;
        token.map(|token| message.check_frame().map(|()| token)).transpose()
    }

    /// Returns how the messages of a channel are read.
    fn form(&self, channel: &Channel) -> Result<&Foreign<T>, String> {
        let Channel { topic, schema, encoding, .. } = channel;
        if !["cdr", ROS1].contains(&&**encoding) {
            return Err(format!("`{topic}` is encoded as `{encoding}`, and not as a message of ROS"));
        }
        let form = self.forms.iter().find(|form| form.name == schema).ok_or_else(|| {
            let names: Vec<&str> = self.forms.iter().map(|form| form.name).collect();
            format!("`{topic}` is of type `{schema}`, and the port reads `{}`", names.join("`, `"))
        })?;
        match other_message(channel, form.definition) {
            Some(how) => Err(format!("`{topic}` {how}")),
            None => Ok(form),
        }
    }

    /// Returns the reason if the recording did not end well.
    fn end(&self) -> Result<(), String> {
        if !self.has_topic {
            let names: Vec<&str> = self.recording.channels().values().map(|channel| channel.topic.as_str()).collect();
            return Err(format!("it has no topic `{}`, but `{}`", self.wanted.0, names.join("`, `")));
        }
        if !self.has_part {
            let (topic, part) = self.wanted;
            return Err(format!("no message of `{topic}` has `{part}`"));
        }
        match self.recording.cut() {
            Some(cut) if cut != CUT => Err(format!("it is damaged: {cut}")),
            _ => Ok(()),
        }
    }
}
