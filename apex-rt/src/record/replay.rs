use super::{
    Channel, Codec, Message as _, Report, Role,
    cdr::Reader,
    report::{Compared, Difference},
    sink::OWN,
    types::{TypeChange, TypeMatch, compare},
    waits::{ReplayBarrier, WaitOutcome},
};
use crate::{
    Info, Program, Time,
    params::{Access, AnyParams, ParamInfo, ParamVisitor, parsed, set},
};
use apex_bag::{CUT, Mcap, Message, Recording};
use core::{fmt, time::Duration};
use std::{
    collections::{BTreeMap, BTreeSet, VecDeque},
    io, mem,
    path::{Path, PathBuf},
    sync::Arc,
};

/// Error that prevents a replay.
#[derive(Debug)]
pub enum ReplayError {
    /// The file cannot be read.
    File(PathBuf, io::Error),
    /// The file is a recording of another program, which has no reactions.
    NoRecording(PathBuf),
    /// The file is a recording of another program.
    OtherProgram {
        /// The file.
        path: PathBuf,
        /// Name of the recorded program.
        recorded: String,
        /// Name of the program that was to replay it.
        wanted: &'static str,
    },
    /// The program takes tokens of other types than the recorded ones.
    OtherTypes {
        /// The file.
        path: PathBuf,
        /// The channels.
        changed: Vec<TypeChange>,
    },
    /// The recording does not have a complete reaction.
    Nothing {
        /// The file.
        path: PathBuf,
        /// Reason for its early end.
        why: Option<String>,
    },
    /// The recording has other thread groups than the program.
    OtherThreads {
        /// The file.
        path: PathBuf,
        /// Thread groups that ran in parallel in the recorded run.
        recorded: String,
        /// Thread groups of the program.
        wanted: String,
    },
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path, error) => write!(f, "cannot read `{}`: {error}", path.display()),
            Self::NoRecording(path) => {
                write!(f, "`{}` is a recording, but not of a program of Apex: it has no reactions", path.display())?;
                write!(f, "\n  feed its topics to a test instead: `feed port = recording(\"FILE\", \"/topic\");`")?;
                write!(f, "\n  `apex bag FILE` lists them")
            }
            Self::OtherProgram { path, recorded, wanted } => {
                write!(f, "`{}` is a recording of `{recorded}`, not of `{wanted}`", path.display())
            }
            Self::OtherTypes { path, changed } => {
                write!(f, "`{}` cannot be replayed: types have changed since", path.display())?;
                for change in changed {
                    write!(f, "\n  {change}")?;
                }
                write!(f, "\n  replay it with the program as it was, or record it again")
            }
            Self::Nothing { path, why } => {
                write!(f, "nothing in `{}` can be replayed: it has no complete reaction", path.display())?;
                why.as_ref().map_or(Ok(()), |why| write!(f, "; {why}"))
            }
            Self::OtherThreads { path, recorded, wanted } => {
                write!(f, "`{}` was recorded on the threads `{recorded}`", path.display())?;
                match wanted.as_str() {
                    "" => write!(f, ", but the program has a single thread"),
                    _ => write!(f, ", but the program has `{wanted}`: replay it with the same `on` as recorded"),
                }
            }
        }
    }
}

impl std::error::Error for ReplayError {}

/// Meaning of a message in the file.
#[derive(Debug, Clone, Copy)]
enum Meaning {
    Reaction,
    Elapsed,
    Parameter,
    Taken,
    Looked,
    Ended,
    /// A token of a channel of the program.
    Token(usize),
}

/// Beginning of a recorded reaction.
struct Beginning {
    /// The thread group.
    group: u32,
    time: Time,
    /// `true` if it ended after the first of the instants that had passed.
    ends_early: bool,
}

impl Beginning {
    fn read(message: &[u8]) -> Option<Self> {
        let mut fields = Reader::new(message).ok()?;
        let (group, time) = (fields.u32().ok()?, Time::from_nanos(fields.i64().ok()?));
        // In older recordings, all did.
        Some(Self { group, time, ends_early: bool::read(&mut fields).unwrap_or(true) })
    }
}

/// Recorded inputs of one reaction.
#[derive(Debug, Default)]
struct Reaction {
    elapsed: VecDeque<Duration>,
    params: Vec<(String, String, bool)>,
    taken: Vec<String>,
    /// Numbers of the checks of cells that found something.
    looks: BTreeSet<u32>,
    /// `true` if the reaction was recorded to its end.
    ended: bool,
    /// Tokens of each channel, with the number of their node's call.
    tokens: Vec<VecDeque<(u32, Vec<u8>)>>,
    /// Mailboxes into which tokens were put, in that order.
    put_in: VecDeque<usize>,
}

impl Reaction {
    fn new(channels: usize) -> Self {
        Self { tokens: (0..channels).map(|_| VecDeque::new()).collect(), ..Self::default() }
    }
}

/// Replay of a run, or of one thread group in a run.
pub struct Replay {
    channels: Vec<Channel>,
    source: Mcap,
    meanings: BTreeMap<u16, Option<Meaning>>,
    /// The next reaction, whose beginning was read already.
    next: Option<Beginning>,
    /// Number and time of the reaction that was read last.
    read: (u32, Time),
    /// Time of the current reaction.
    now: Time,
    reaction: Reaction,
    /// Number of calls of each node in the current reaction.
    calls: Vec<u32>,
    /// `true` for the sources that were recorded, and are not called.
    recorded: Vec<bool>,
    /// The last token of each channel.
    last: Vec<Option<Vec<u8>>>,
    report: Report,
    /// Buffer for a token that is compared.
    bytes: Vec<u8>,
    /// The thread group that is repeated, if several ran in parallel.
    group: Option<Side>,
    /// Number of checks of cells between groups in this reaction.
    looks: u32,
    /// `true` before the first recorded reaction, in a recording that begins in the middle of a run.
    leads_in: bool,
    /// `true` if this group waited for a token of another one that has ended where the recording is cut off: this one
    /// ends, too.
    over: bool,
}

/// One of several thread groups that ran in parallel.
struct Side {
    number: usize,
    waits: Arc<ReplayBarrier>,
}

/// Opens a recording. A shadow follows the file that its parent writes.
pub(super) fn open(path: &Path) -> Result<Mcap, ReplayError> {
    let at = |error| ReplayError::File(path.to_owned(), error);
    if crate::is_shadow() {
        return Mcap::follow(path).map_err(at);
    }
    match Recording::open(path).map_err(at)? {
        Recording::Mcap(file) => Ok(*file),
        // Those of other programs; of which kinds there are depends on features.
        _ => Err(ReplayError::NoRecording(path.to_owned())),
    }
}

impl Replay {
    /// Opens a recording of a program of type `P` that ran on one thread.
    ///
    /// # Errors
    /// The file cannot be read, or is not a recording of such a program.
    pub(super) fn open<P: Program>(path: &Path) -> Result<Self, ReplayError> {
        Self::new::<P>(path, None)
    }

    /// Opens a recording of parallel thread groups, for the replay of group `number`.
    pub(super) fn of_group<P: Program>(
        path: &Path,
        number: usize,
        waits: Arc<ReplayBarrier>,
    ) -> Result<Self, ReplayError> {
        Self::new::<P>(path, Some(Side { number, waits }))
    }

    fn new<P: Program>(path: &Path, group: Option<Side>) -> Result<Self, ReplayError> {
        let info = const { &P::INFO };
        let at = |error| ReplayError::File(path.to_owned(), error);
        let channels = P::channels();
        let mut replay = Self {
            source: open(path)?,
            meanings: BTreeMap::new(),
            next: None,
            read: (0, Time::ZERO),
            now: Time::ZERO,
            reaction: Reaction::new(channels.len()),
            calls: vec![0; info.nodes.len()],
            recorded: vec![false; info.nodes.len()],
            last: vec![None; channels.len()],
            report: Report::default(),
            bytes: vec![],
            group,
            looks: 0,
            leads_in: false,
            over: false,
            channels,
        };
        replay.load().map_err(at)?;
        match replay.source.program.clone() {
            Some(recorded) if recorded != info.name => {
                return Err(ReplayError::OtherProgram { path: path.to_owned(), recorded, wanted: info.name });
            }
            Some(_) => {}
            None if replay.source.cut.is_none() => return Err(ReplayError::NoRecording(path.to_owned())),
            None => {
                let cut = "it is empty, or was cut off before anything was recorded".to_owned();
                let what = replay.source.cut.take().filter(|why| why != CUT).unwrap_or(cut);
                return Err(at(io::Error::new(io::ErrorKind::UnexpectedEof, what)));
            }
        }
        let changed = replay.match_channels(info);
        if !changed.is_empty() {
            return Err(ReplayError::OtherTypes { path: path.to_owned(), changed });
        }
        replay.leads_in = matches!(replay.source.files, Some((2.., _)));
        if replay.leads_in {
            replay.find_first_tokens(path)?;
        }
        Ok(replay)
    }

    /// Finds the first token of each recorded source, which it sends until the recording begins.
    fn find_first_tokens(&mut self, path: &Path) -> Result<(), ReplayError> {
        let is_wanted =
            |(channel, token): (&Channel, &Option<Vec<u8>>)| channel.role == Role::Source && token.is_none();
        let mut source = open(path)?;
        let at = |error| ReplayError::File(path.to_owned(), error);
        while self.channels.iter().zip(&self.last).any(is_wanted) {
            let Some(message) = source.next_message().map_err(at)? else { break };
            if let Some(Meaning::Token(channel)) = self.meaning(message.channel) {
                self.last[channel].get_or_insert(message.data);
            }
        }
        Ok(())
    }

    /// Returns the time of the first recorded reaction, if the program has to be led there: the recording begins in the
    /// middle of a run.
    pub(super) fn leads_in(&self) -> Option<Time> {
        self.next.as_ref().filter(|_| self.leads_in).map(|next| next.time)
    }

    /// Ends the reactions before the first recorded one.
    pub(super) fn end_lead_in(&mut self) {
        self.leads_in = false;
        self.reaction = Reaction::new(self.channels.len());
    }

    /// Matches the channels of the program with those of the file. Returns the inputs whose types have changed.
    fn match_channels(&mut self, info: &Info) -> Vec<TypeChange> {
        let (mut missing, mut changed) = (vec![], vec![]);
        let group = self.group.as_ref().map(|group| group.number);
        let own = |c: &&Channel| c.role != Role::Port && group.is_none_or(|group| c.group == group);
        for channel in self.channels.iter().filter(own) {
            let Some(recorded) = self.source.channels.values().find(|f| f.name == channel.name) else {
                missing.push(channel);
                continue;
            };
            match channel.schema.map(|schema| compare(recorded, schema, channel.shape)) {
                Some(TypeMatch::Same) => {}
                Some(TypeMatch::Undescribed) => self.report.undescribed.push(channel.name),
                Some(TypeMatch::Changed(change)) if channel.role == Role::Chosen => {
                    self.report.changed.push(change);
                    continue;
                }
                Some(TypeMatch::Changed(change)) => changed.push(change),
                None => {
                    missing.push(channel);
                    continue;
                }
            }
            match channel.role {
                Role::Source => self.recorded[channel.node] = true,
                Role::Chosen => self.report.compared.push(Compared::new(channel.name)),
                Role::Mailbox | Role::Event | Role::Port => {}
            }
        }
        for channel in missing {
            self.report.missing.push((channel.name, channel.role));
            if channel.role == Role::Source {
                // If some ports of a source are missing, the source is called: tokens of one firing belong together.
                self.recorded[channel.node] = false;
            }
        }
        let names = self.channels.iter().map(|c| c.name).chain(OWN.iter().map(|(name, _)| *name));
        let names: Vec<&str> = names.collect();
        let gone = self.source.channels.values().filter(|f| !names.contains(&f.name.as_str()));
        let slots = |node: &usize| info.connections.iter().any(|connection| connection.to == *node);
        let not_called = (0..info.nodes.len()).filter(|node| self.recorded[*node] && slots(node));
        self.report.not_called = not_called.map(|node| info.nodes[node].name).collect();
        self.report.gone = gone.map(|f| f.name.clone()).collect();
        changed
    }

    /// Reads all inputs of the next reaction, up to the beginning of the one after it. Returns the time of the
    /// reaction, and `true` if it ended early where it was late; or `None` at the end.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(super) fn next_reaction(&mut self) -> Result<Option<(Time, bool)>, io::Error> {
        let Some(Beginning { time: now, ends_early, .. }) = self.next.take().filter(|_| !self.over) else {
            return Ok(None);
        };
        self.now = now;
        self.reaction = Reaction::new(self.channels.len());
        self.load()?;
        // The last reaction of a file that is cut off is incomplete.
        if self.next.is_none() && self.source.cut.is_some() && !self.reaction.ended {
            return Ok(None);
        }
        self.report.reactions += 1;
        self.report.last = Some(now);
        Ok(Some((now, ends_early)))
    }

    fn load(&mut self) -> io::Result<()> {
        while let Some(message) = self.source.next_message()? {
            match self.meaning(message.channel) {
                Some(Meaning::Reaction) => match Beginning::read(&message.data) {
                    Some(beginning) if !self.is_own(beginning.group) => {}
                    Some(beginning) => {
                        self.follow(message.sequence, beginning);
                        return Ok(());
                    }
                    None => self.source.damaged("the time of a reaction cannot be read"),
                },
                Some(meaning) => self.keep(meaning, message),
                None => {}
            }
        }
        Ok(())
    }

    /// Checks that a reaction follows the previous one, and stores its beginning.
    fn follow(&mut self, number: u32, beginning: Beginning) {
        let time = beginning.time;
        let (last, before) = mem::replace(&mut self.read, (number, time));
        // Older recordings do not number reactions.
        let ahead = match (number, self.source.files) {
            (0, _) => 1,
            // The first reaction in a later file of the recording.
            (_, Some((2.., _))) if last == 0 => 1,
            _ => number.wrapping_sub(last),
        };
        if time < before || !(1..=u32::MAX / 2).contains(&ahead) {
            self.source.damaged(&format!("the reaction at {time} is out of order after the one at {before}"));
            return;
        }
        self.report.skipped += u64::from(ahead - 1);
        self.next = Some(beginning);
    }

    /// Returns the meaning of the messages of a channel, which is stored for the next call.
    fn meaning(&mut self, id: u16) -> Option<Meaning> {
        if let Some(known) = self.meanings.get(&id) {
            return *known;
        }
        let name = self.source.channels.get(&id).map_or("", |c| c.name.as_str());
        let own =
            [Meaning::Reaction, Meaning::Elapsed, Meaning::Parameter, Meaning::Taken, Meaning::Looked, Meaning::Ended];
        let meaning = match OWN.iter().position(|(own, _)| *own == name) {
            Some(index) => Some(own[index]),
            None => self.channels.iter().position(|c| c.name == name).map(Meaning::Token),
        };
        self.meanings.insert(id, meaning);
        meaning
    }

    /// Returns `true` if this replay repeats the group.
    fn is_own(&self, group: u32) -> bool {
        self.group.as_ref().is_none_or(|own| own.number == group as usize)
    }

    fn keep(&mut self, meaning: Meaning, message: Message) {
        let Ok(mut fields) = Reader::new(&message.data).or_else(|_| Reader::new(&[0, 1, 0, 0])) else { return };
        match meaning {
            Meaning::Reaction => {}
            Meaning::Elapsed => {
                let elapsed = fields.u64().map(Duration::from_nanos);
                // Older recordings have one group.
                if self.is_own(fields.u32().unwrap_or(0)) {
                    self.reaction.elapsed.extend(elapsed);
                }
            }
            Meaning::Parameter => {
                let (name, value) = (fields.text().map(str::to_owned), fields.text().map(str::to_owned));
                let changed = bool::read(&mut fields).unwrap_or(true);
                if let (Ok(name), Ok(value)) = (name, value)
                    && self.is_own(fields.u32().unwrap_or(0))
                {
                    self.reaction.params.push((name, value, changed));
                }
            }
            Meaning::Taken => self.reaction.taken.extend(fields.text().map(str::to_owned)),
            Meaning::Looked => {
                if let (Ok(group), Ok(look)) = (fields.u32(), fields.u32())
                    && self.is_own(group)
                {
                    self.reaction.looks.insert(look);
                }
            }
            Meaning::Ended => self.reaction.ended |= fields.u32().is_ok_and(|group| self.is_own(group)),
            Meaning::Token(channel) if self.is_own(self.channels[channel].group as u32) => {
                self.reaction.tokens[channel].push_back((message.sequence, message.data));
                if self.channels[channel].role == Role::Mailbox {
                    self.reaction.put_in.push_back(channel);
                }
            }
            Meaning::Token(_) => {}
        }
    }

    /// Reads the rest of the file, and returns the report.
    pub(super) fn finish(&mut self) -> Report {
        // The rest may be damaged: a group that waits for a token of a group that was cut off ends before it is read.
        while let Some(more) = self.source.next_message().transpose() {
            if let Err(error) = more {
                self.source.cut = Some(error.to_string());
                break;
            }
        }
        self.report.cut = self.source.cut.take();
        self.report.file = self.source.files.map_or(1, |(first, _)| first);
        self.report.dropped = mem::take(&mut self.source.dropped);
        mem::take(&mut self.report)
    }

    pub(super) fn role(&self, channel: usize) -> Role {
        self.channels[channel].role
    }

    pub(super) fn begin(&mut self) {
        self.looks = 0;
        self.calls.fill(0);
    }

    /// Repeats a check of a cell between groups. Returns the recorded result, and waits until the token is there.
    pub(super) fn looked(&mut self, finds: &dyn Fn() -> bool) -> bool {
        let Some(group) = &self.group else { return finds() };
        let look = self.looks;
        self.looks += 1;
        if self.over || !self.reaction.looks.remove(&look) {
            return false;
        }
        match group.waits.wait(group.number, finds) {
            WaitOutcome::Found => return true,
            WaitOutcome::Missed => self.report.missed += 1,
            WaitOutcome::Cut => {
                self.over = true;
                // The current reaction is incomplete.
                self.report.reactions -= 1;
            }
        }
        false
    }

    pub(super) fn end(&mut self) {
        if self.over {
            return;
        }
        for channel in 0..self.channels.len() {
            if self.channels[channel].role == Role::Chosen {
                while let Some((_, was)) = self.reaction.tokens[channel].pop_front() {
                    self.compared(channel, Some(&was), None);
                }
            }
        }
    }

    pub(super) fn set_params(&mut self, program: &mut dyn AnyParams) {
        for (name, value, changed) in mem::take(&mut self.reaction.params) {
            if changed {
                if let Err(error) = set(program, &name, &parsed(&value)) {
                    self.report.params.push(format!("`{name}` cannot be set to {value}: {error}"));
                }
                continue;
            }
            match now(program, &name) {
                Some(now) if now == value => {}
                Some(now) => self.report.params.push(format!("`{name}` was {value} and is {now}")),
                None => self.report.params.push(format!("`{name}` was {value} and no longer exists")),
            }
        }
    }

    /// Returns the next mailbox into which a token was put.
    pub(super) fn next_in(&mut self) -> Option<usize> {
        self.reaction.put_in.pop_front()
    }

    pub(super) fn calls(&mut self, node: usize) -> bool {
        self.calls[node] += 1;
        self.recorded[node]
    }

    pub(super) fn take<T>(&mut self, channel: usize, codec: Option<Codec<T>>) -> Option<T> {
        let call = self.calls[self.channels[channel].node];
        let waiting = &mut self.reaction.tokens[channel];
        while waiting.front().is_some_and(|(at, _)| *at < call) {
            waiting.pop_front();
        }
        let (_, bytes) = if waiting.front()?.0 == call { waiting.pop_front()? } else { return None };
        match (codec?.read)(&bytes) {
            Ok(token) => {
                self.last[channel] = Some(bytes);
                Some(token)
            }
            Err(reason) => {
                let unreadable = &mut self.report.unreadable;
                unreadable.entry(self.channels[channel].name).or_insert((0, reason)).0 += 1;
                None
            }
        }
    }

    pub(super) fn take_or_last<T>(&mut self, channel: usize, codec: Option<Codec<T>>) -> Option<T> {
        self.take(channel, codec).or_else(|| {
            let token = codec.and_then(|codec| (codec.read)(self.last[channel].as_ref()?).ok())?;
            self.report.repeated += u64::from(!self.leads_in);
            Some(token)
        })
    }

    pub(super) fn was_taken(&self, channel: usize) -> bool {
        let name = self.channels[channel].name;
        self.reaction.taken.iter().any(|taken| taken == name)
    }

    pub(super) fn elapsed(&mut self) -> Option<Duration> {
        self.reaction.elapsed.pop_front()
    }

    pub(super) fn compare<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        if let Some(codec) = codec
            && !self.over
            && !self.leads_in
        {
            self.bytes.clear();
            (codec.write)(token, &mut self.bytes);
            self.compare_bytes(channel);
        }
    }

    fn compare_bytes(&mut self, channel: usize) {
        let bytes = mem::take(&mut self.bytes);
        let was = self.reaction.tokens[channel].pop_front().map(|(_, was)| was);
        self.compared(channel, was.as_deref(), Some(&bytes));
        self.bytes = bytes;
    }

    fn compared(&mut self, channel: usize, was: Option<&[u8]>, is: Option<&[u8]>) {
        let Channel { name, show, .. } = self.channels[channel];
        let Some(compared) = self.report.compared.iter_mut().find(|c| c.name == name) else { return };
        let index = compared.equal + compared.different;
        if was == is {
            compared.equal += 1;
            return;
        }
        compared.different += 1;
        if compared.first.is_none() {
            let shown = |bytes: Option<&[u8]>| bytes.map(|b| show(b).unwrap_or_else(|| "a token".to_owned()));
            compared.first = Some(Difference { index, time: self.now, was: shown(was), is: shown(is) });
        }
    }
}

/// Returns the value of a parameter in TOML.
fn now(program: &mut dyn AnyParams, name: &str) -> Option<String> {
    struct Find<'a>(&'a str, Option<String>);
    impl ParamVisitor for Find<'_> {
        fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
            if info.name == self.0 {
                self.1 = access.map(|access| access.get().to_string());
            }
        }
    }
    let mut find = Find(name, None);
    program.visit(&mut find);
    find.1
}
