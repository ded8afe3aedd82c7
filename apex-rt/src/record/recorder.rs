use super::{
    Channel, Codec, Message as _, RecordOptions, Role,
    cdr::Writer,
    sink::{ELAPSED, ENDED, FIRST, Frame, LOOKED, Near, OWN, PARAMETER, REACTION, ROOM, Sink, TAKEN},
};
use crate::{
    GroupInfo, Mailbox, Program, Time,
    params::{Access, AnyParams, ParamInfo, ParamRef, ParamVisitor},
};
use apex_bag::format::THREADS;
use core::time::Duration;
use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
    thread,
};

/// Behaviour if tokens come faster than they can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhenFull {
    /// Tokens are dropped and counted: a robot cannot wait.
    Drop,
    /// The program waits, because its time is simulated.
    Wait,
}

/// Time between two checks for room.
const PAUSE: Duration = Duration::from_micros(100);

/// Recorder of a run, or of one thread group in a run.
///
/// ```
/// use apex_rt::{
///     drive_with,
///     prelude::*,
///     record::{Recorder, Tap, WhenFull},
/// };
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let file = std::env::temp_dir().join(format!("apex-recorder-{}.mcap", std::process::id()));
/// let mut tap = Tap::Record(Recorder::to_file::<Blink>(&file, WhenFull::Wait)?);
/// drive_with(Blink::new(), SimClock::until(Time::from_secs(1)), &mut tap);
/// let Tap::Record(recorder) = tap else { unreachable!("it was made so") };
/// let finished = recorder.finish()?;
/// assert_eq!((finished.path, finished.dropped), (file.clone(), vec![]));
/// # std::fs::remove_file(file)?;
/// # Ok(())
/// # }
/// ```
pub struct Recorder {
    channels: Vec<Channel>,
    /// The file, in the recorder that ends it: one of all recorders of a run.
    sink: Option<Sink>,
    near: Near,
    /// Rings of the groups that have no recorder yet.
    others: Mutex<Vec<Near>>,
    frame: Frame,
    /// Number of the thread group, if there are several.
    group: Option<u32>,
    /// Number of checks of cells between groups in this reaction.
    looks: u32,
    when_full: WhenFull,
    path: PathBuf,
    now: Time,
    /// Number of reactions, including the current one.
    reactions: u32,
    /// Number of calls of each node in this reaction.
    calls: Vec<u32>,
    /// `true` for the mailboxes that held a token after the last reaction, by channel.
    full: Vec<bool>,
    /// Values of all parameters after the last reaction, as bytes; empty before the first reaction.
    params: Vec<u8>,
    /// Values of all parameters before this reaction, as bytes.
    params_now: Vec<u8>,
    /// Values of all parameters before the first reaction, as bytes.
    first_params: Vec<u8>,
    /// `true` if the current reaction was dropped with all its messages.
    lost: bool,
    /// Number of the file into which the messages go, of a recording that is divided.
    file: u64,
    /// `true` if the current reaction is the first one in a later file.
    begins_file: bool,
    /// Time of the first reaction in the file.
    file_start: Time,
    /// Time after which a file ends.
    period: Option<Duration>,
}

/// Result of a recording.
#[derive(Debug)]
pub struct Finished {
    /// Path of the file; of a recording that is divided, that of the oldest one which is left.
    pub path: PathBuf,
    /// Paths of all files that are left, the oldest one first.
    pub files: Vec<PathBuf>,
    /// Channels that lost messages because the file could not be written fast enough, with the numbers of these.
    pub dropped: Vec<(String, u64)>,
}

impl Recorder {
    /// Starts a recording of a program of type `P` in the file `path`. If that exists, a number is added to its name.
    ///
    /// # Errors
    /// The file cannot be created, or a source sends tokens that cannot be recorded, so that the recording would be
    /// useless.
    pub fn to_file<P: Program>(path: &Path, when_full: WhenFull) -> io::Result<Self> {
        Self::with_room::<P>(path, when_full, ROOM)
    }

    /// Starts a recording with limits of its size and age, or one that is compressed. With limits it consists of
    /// several files, whose names have numbers before their ending (`run.0001.mcap`); the oldest ones are removed.
    ///
    /// ```
    /// use apex_rt::record::{RecordOptions, Recorder, WhenFull};
    ///
    /// apex_macros::graph!("examples/blink.afg");
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let file = std::env::temp_dir().join(format!("apex-limits-{}.mcap", std::process::id()));
    /// let options = RecordOptions { compress: true, ..RecordOptions::default() };
    /// let recorder = Recorder::to_file_with::<Blink>(&file, WhenFull::Drop, options)?;
    /// assert_eq!(recorder.path(), file);
    /// let files = recorder.finish()?.files;
    /// assert_eq!(files, [file.clone()]);
    /// # std::fs::remove_file(file)?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// The errors of [`to_file`](Self::to_file), and limits that are too small.
    pub fn to_file_with<P: Program>(path: &Path, when_full: WhenFull, options: RecordOptions) -> io::Result<Self> {
        Self::new::<P>(path, when_full, ROOM, None, options, |_| false)
    }

    /// Starts a recording without the channels that are `left_out`, for example those of large images. A replay calls
    /// the sources of these channels, which therefore have to send the same tokens again.
    ///
    /// ```
    /// use apex_rt::record::{Channel, Recorder, WhenFull};
    ///
    /// apex_macros::graph!("examples/blink.afg");
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let file = std::env::temp_dir().join(format!("apex-without-{}.mcap", std::process::id()));
    /// let is_image = |channel: &Channel| channel.name.ends_with(".image");
    /// let recorder = Recorder::to_file_without::<Blink>(&file, WhenFull::Wait, is_image)?;
    /// assert_eq!(recorder.path(), file);
    /// recorder.finish()?;
    /// # std::fs::remove_file(file)?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// The errors of [`to_file`](Self::to_file), except that tokens which are left out may be of any type.
    pub fn to_file_without<P: Program>(
        path: &Path,
        when_full: WhenFull,
        left_out: impl Fn(&Channel) -> bool,
    ) -> io::Result<Self> {
        Self::new::<P>(path, when_full, ROOM, None, RecordOptions::default(), left_out)
    }

    /// Starts a recording as [`to_file`](Self::to_file) does, with `room` for that many bytes that wait to be written.
    #[doc(hidden)]
    pub fn with_room<P: Program>(path: &Path, when_full: WhenFull, room: usize) -> io::Result<Self> {
        Self::new::<P>(path, when_full, room, None, RecordOptions::default(), |_| false)
    }

    /// Starts a recording of a program whose `groups` run in parallel: each has a recorder [`beside`](Self::beside)
    /// this one.
    pub(super) fn of_threads<P: Program>(
        path: &Path,
        groups: &[GroupInfo],
        options: RecordOptions,
    ) -> io::Result<Self> {
        Self::new::<P>(path, WhenFull::Drop, ROOM, Some(groups), options, |_| false)
    }

    fn new<P: Program>(
        path: &Path,
        when_full: WhenFull,
        room: usize,
        groups: Option<&[GroupInfo]>,
        options: RecordOptions,
        left_out: impl Fn(&Channel) -> bool,
    ) -> io::Result<Self> {
        let (info, mut channels) = (const { &P::INFO }, P::channels());
        let is_out = |channel: &Channel| channel.role == Role::Port || left_out(channel);
        let (mut out, kept): (Vec<_>, Vec<_>) = channels.iter_mut().partition(|channel| is_out(channel));
        if let Some(message) = why_useless(&kept) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        // Channels without a schema are not recorded.
        out.iter_mut().for_each(|channel| channel.schema = None);
        let mut about = BTreeMap::from([("name".to_owned(), info.name.to_owned())]);
        if let Some(groups) = groups.filter(|groups| !groups.is_empty()) {
            about.insert(THREADS.to_owned(), names(groups));
        }
        // One ring for each group, and one for the watchdog.
        let beside = groups.map_or(0, |groups| groups.len().max(1) + 1);
        let (sink, mut ends, path) = Sink::new(path, options, about, &channels, 1 + beside, room)?;
        let near = ends.remove(0);
        let own = Self::by(near, channels, when_full, path, info.nodes.len());
        Ok(Self { sink: Some(sink), others: Mutex::new(ends), period: options.period(), ..own })
    }

    /// Returns a recorder that writes into `near`.
    fn by(near: Near, channels: Vec<Channel>, when_full: WhenFull, path: PathBuf, nodes: usize) -> Self {
        Self {
            sink: None,
            near,
            others: Mutex::default(),
            frame: Frame::default(),
            group: None,
            looks: 0,
            when_full,
            path,
            now: Time::ZERO,
            reactions: 0,
            calls: vec![0; nodes],
            full: vec![false; channels.len()],
            params: vec![],
            params_now: vec![],
            first_params: vec![],
            lost: false,
            file: 1,
            begins_file: false,
            file_start: Time::ZERO,
            period: None,
            channels,
        }
    }

    /// Returns a recorder of the same file, for this `group` if there are several. All messages that this recorder has
    /// sent come before those of the new one.
    ///
    /// # Panics
    /// There are more recorders than groups.
    pub(super) fn beside(&self, group: Option<usize>) -> Self {
        self.near.settle();
        let near = self.others.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let near = near.expect("there is one for each group, and one for who watches over them");
        let own = Self::by(near, self.channels.clone(), self.when_full, self.path.clone(), self.calls.len());
        Self { group: group.map(|group| group as u32), period: self.period, ..own }
    }

    /// Path of the file; of a recording that is divided, that of the first one.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes all remaining messages, and ends the file.
    ///
    /// # Errors
    /// The file could not be written.
    pub fn finish(self) -> io::Result<Finished> {
        let Self { sink: Some(sink), mut near, channels, .. } = self else {
            return Err(io::Error::other("another recorder ends the file"));
        };
        let own = OWN.iter().map(|(name, _)| *name);
        let names = own.chain(channels.iter().map(|c| c.name));
        let lost = names.zip(sink.dropped()).filter(|(_, count)| *count > 0);
        let dropped: Vec<(String, u64)> = lost.map(|(name, count)| (name.to_owned(), count)).collect();
        let files = sink.finish(&mut near, &dropped)?;
        Ok(Finished { path: files.first().cloned().unwrap_or_default(), files, dropped })
    }

    pub(super) fn role(&self, channel: usize) -> Role {
        self.channels[channel].role
    }

    pub(super) fn begin(&mut self, now: Time, ends_early: bool) {
        self.now = now;
        self.lost = false;
        self.looks = 0;
        self.calls.fill(0);
        let group = self.group.unwrap_or(0);
        self.reactions = self.reactions.wrapping_add(1);
        self.begins_file = self.begin_file();
        let sent = self.numbered(REACTION, self.reactions, |message| {
            message.u32(group);
            message.i64(now.as_nanos());
            message.u8(u8::from(ends_early));
        });
        self.lost = !sent;
    }

    /// Begins the next file of a recording that is divided, if it shall begin.
    fn begin_file(&mut self) -> bool {
        if self.period.is_some_and(|period| self.now.since(self.file_start) >= period) {
            self.near.end_file(self.file);
        }
        let file = self.near.file();
        if file == self.file || !self.near.begin_file(file) {
            return false;
        }
        (self.file, self.file_start) = (file, self.now);
        true
    }

    pub(super) fn end(&mut self) {
        if let Some(group) = self.group {
            self.own(ENDED, |message| message.u32(group));
        }
    }

    /// Records the result of a check of a cell between groups. Groups that run in turn always find the same, so that
    /// nothing is recorded.
    pub(super) fn looked(&mut self, found: bool) -> bool {
        let Some(group) = self.group else { return found };
        let look = self.looks;
        self.looks += 1;
        if found {
            self.own(LOOKED, |message| {
                message.u32(group);
                message.u32(look);
            });
        }
        found
    }

    pub(super) fn calls(&mut self, node: usize) {
        self.calls[node] += 1;
    }

    pub(super) fn token<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        let Some(codec) = codec.filter(|_| self.channels[channel].schema.is_some()) else { return };
        let call = self.calls[self.channels[channel].node];
        let frame = self.frame.begin((FIRST + channel) as u16, call, time(self.now));
        let written = (codec.write)(token, frame);
        self.send(FIRST + channel, written);
    }

    pub(super) fn elapsed(&mut self, elapsed: Duration) -> Duration {
        let nanos = u64::try_from(elapsed.as_nanos()).unwrap_or(u64::MAX);
        let group = self.group.unwrap_or(0);
        self.own(ELAPSED, |message| {
            message.u64(nanos);
            message.u32(group);
        });
        elapsed
    }

    pub(super) fn put_in<T>(&mut self, channel: usize, codec: Option<Codec<T>>, mailbox: &Mailbox<T>) {
        let was_full = self.full[channel];
        if let (false, Some(token)) = (was_full, mailbox.peek()) {
            self.token(channel, codec, token);
        }
    }

    pub(super) fn taken_out(&mut self, channel: usize, is_full: bool) {
        if self.full[channel] && !is_full {
            let name = self.channels[channel].name;
            self.own(TAKEN, |message| message.text(name));
        }
    }

    pub(super) fn keep_mailbox(&mut self, channel: usize, is_full: bool) {
        self.full[channel] = is_full;
    }

    /// Records the parameters that have changed since the last reaction; before the first reaction in a file, all.
    pub(super) fn changed_params(&mut self, program: &mut dyn AnyParams) {
        let mut now = core::mem::take(&mut self.params_now);
        now.clear();
        program.visit(&mut Bits(&mut now));
        if self.params.is_empty() {
            self.first_params.clone_from(&now);
            program.visit(&mut Changes { recorder: self, before: &now, all: true });
        } else if self.begins_file {
            let before = core::mem::take(&mut self.first_params);
            program.visit(&mut Changes { recorder: self, before: &before, all: true });
            self.first_params = before;
        } else if now != self.params {
            let before = core::mem::take(&mut self.params);
            program.visit(&mut Changes { recorder: self, before: &before, all: false });
            self.params = before;
        }
        self.params_now = now;
    }

    pub(super) fn keep_params(&mut self, program: &mut dyn AnyParams) {
        self.params.clear();
        program.visit(&mut Bits(&mut self.params));
    }

    /// Sends a message on one of the channels that every recording has.
    fn own(&mut self, channel: u16, write: impl FnOnce(&mut Writer<'_>)) -> bool {
        self.numbered(channel, 0, write)
    }

    fn numbered(&mut self, channel: u16, number: u32, write: impl FnOnce(&mut Writer<'_>)) -> bool {
        let frame = self.frame.begin(channel, number, time(self.now));
        write(&mut Writer::new(frame));
        self.send(usize::from(channel), true)
    }

    /// Sends the message in `self.frame` if it was `written`, or counts it as lost.
    fn send(&mut self, channel: usize, written: bool) -> bool {
        let written = written && !self.lost;
        loop {
            if written && self.near.send(&mut self.frame) {
                return true;
            }
            if !written || self.when_full == WhenFull::Drop || !self.near.may_fit(&self.frame) {
                self.near.lose(channel);
                return false;
            }
            thread::sleep(PAUSE);
        }
    }
}

/// Names of the thread groups, as written in the file.
pub(super) fn names(groups: &[GroupInfo]) -> String {
    groups.iter().map(|group| group.name).collect::<Vec<_>>().join(" ")
}

/// Returns an error message if the recording would be useless.
fn why_useless(channels: &[&mut Channel]) -> Option<String> {
    let lost = channels.iter().filter(|c| c.schema.is_none());
    let names: Vec<String> = lost.map(|c| format!("`{}`", c.name)).collect();
    if names.is_empty() {
        return None;
    }
    Some(format!(
        "the tokens of {} cannot be recorded: derive `serde::Serialize` and `serde::Deserialize` for their types, or implement `apex_rt::record::Message`",
        names.join(", ")
    ))
}

/// Time in ns as MCAP has it. Nothing happens before the zero of a clock.
fn time(now: Time) -> u64 {
    u64::try_from(now.as_nanos()).unwrap_or(0)
}

/// Visitor that writes the values of all parameters as bytes, each with its length before it.
struct Bits<'a>(&'a mut Vec<u8>);

impl ParamVisitor for Bits<'_> {
    fn param(&mut self, _: &'static ParamInfo, access: Option<&mut dyn Access>) {
        let start = self.0.len();
        self.0.extend_from_slice(&[0; 4]);
        if let Some(access) = access {
            bits(access.get(), self.0);
        }
        let length = (self.0.len() - start - 4) as u32;
        self.0[start..start + 4].copy_from_slice(&length.to_le_bytes());
    }
}

/// Appends the bytes of a value. Values are equal if their bytes are.
fn bits(value: ParamRef<'_>, out: &mut Vec<u8>) {
    match value {
        ParamRef::Bool(value) => out.push(u8::from(value)),
        ParamRef::Integer(value) => out.extend_from_slice(&value.to_le_bytes()),
        ParamRef::Float(value) => out.extend_from_slice(&value.to_le_bytes()),
        ParamRef::Single(value) => out.extend_from_slice(&value.to_le_bytes()),
        ParamRef::Text(value) => out.extend_from_slice(value.as_bytes()),
        ParamRef::List(list) => {
            for index in 0..list.count() {
                bits(list.element(index), out);
                // Separates texts in a list.
                out.push(0);
            }
        }
        ParamRef::Other(_) => {}
    }
}

/// Visitor that records the parameters whose values differ from `before`, or all, with the difference.
struct Changes<'a> {
    recorder: &'a mut Recorder,
    before: &'a [u8],
    all: bool,
}

impl ParamVisitor for Changes<'_> {
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
        let Some(access) = access else {
            self.skip(&[]);
            return;
        };
        let mut now = vec![];
        bits(access.get(), &mut now);
        let changed = !self.skip(&now);
        if self.all || changed {
            let value = access.get().to_string();
            let group = self.recorder.group.unwrap_or(0);
            self.recorder.own(PARAMETER, |message| {
                message.text(info.name);
                message.text(&value);
                changed.write(message);
                message.u32(group);
            });
        }
    }
}

impl Changes<'_> {
    /// Advances to the next parameter in `before`. Returns `true` if the value of this one is still `now`.
    fn skip(&mut self, now: &[u8]) -> bool {
        let Some((length, rest)) = self.before.split_first_chunk::<4>() else { return false };
        let Some((was, rest)) = rest.split_at_checked(u32::from_le_bytes(*length) as usize) else { return false };
        self.before = rest;
        was == now
    }
}
