use super::{
    Channel, Codec, Message as _,
    cdr::Writer,
    sink::{ELAPSED, ENDED, FIRST, Frame, LOOKED, Near, OWN, PARAMETER, REACTION, ROOM, Sink, TAKEN, THREADS, free},
};
use crate::{
    GroupInfo, Mailbox, Parameters, Program, Time,
    params::{Access, ParamInfo, ParamRef, ParamVisitor},
};
use core::time::Duration;
use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
    thread,
};

/// What happens when tokens come faster than they can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhenFull {
    /// They are dropped and counted: a robot cannot wait.
    Drop,
    /// The program waits: its time is simulated.
    Wait,
}

/// How long one waits for room before one looks again.
const PAUSE: Duration = Duration::from_micros(100);

/// Records a run, or what one group of threads does in it.
pub struct Recorder {
    channels: Vec<Channel>,
    /// The file, which one of the recorders of a run ends.
    sink: Option<Sink>,
    near: Near,
    /// The ways to the file of the groups that have none yet.
    others: Mutex<Vec<Near>>,
    frame: Frame,
    /// The number of the group, if it is one of several that run side by side.
    group: Option<u32>,
    /// How often this reaction has looked at what is between groups.
    looks: u32,
    when_full: WhenFull,
    path: PathBuf,
    now: Time,
    /// How many reactions there were, with this one.
    reactions: u32,
    /// How often each node was called in this reaction.
    calls: Vec<u32>,
    /// Which mailboxes held a token after the last reaction, by channel.
    full: Vec<bool>,
    /// The parameters after the last reaction, as bytes one after the other; nothing before the first.
    params: Vec<u8>,
    /// The same before this one.
    params_now: Vec<u8>,
    /// The reaction that goes on was dropped, and all in it.
    lost: bool,
}

/// What is left to say when a recording has ended.
#[derive(Debug)]
pub struct Finished {
    /// The file.
    pub path: PathBuf,
    /// The channels that lost messages, because the file could not be written as fast, with how many.
    pub dropped: Vec<(String, u64)>,
}

impl Recorder {
    /// A recording of a program of type `P` in the file `path`, or, if that is there already, in one with a number.
    ///
    /// # Errors
    /// The file cannot be made, or a source sends tokens that cannot be recorded, so that the recording would be useless.
    pub fn to_file<P: Program>(path: &Path, when_full: WhenFull) -> io::Result<Self> {
        Self::with_room::<P>(path, when_full, ROOM)
    }

    /// The same without the channels that are `left_out`, for example of large images. A replay calls the sources of these
    /// as ever, which therefore have to send the same again.
    ///
    /// # Errors
    /// As [`to_file`](Self::to_file); tokens that are left out may be of any type.
    pub fn to_file_without<P: Program>(
        path: &Path,
        when_full: WhenFull,
        left_out: impl Fn(&Channel) -> bool,
    ) -> io::Result<Self> {
        Self::new::<P>(path, when_full, ROOM, None, left_out)
    }

    /// As [`to_file`](Self::to_file), with another number of bytes that can wait to be written.
    #[doc(hidden)]
    pub fn with_room<P: Program>(path: &Path, when_full: WhenFull, room: usize) -> io::Result<Self> {
        Self::new::<P>(path, when_full, room, None, |_| false)
    }

    /// A recording of a program whose `groups` run side by side: each has a recorder [`beside`](Self::beside) this one.
    pub(super) fn of_threads<P: Program>(path: &Path, groups: &[GroupInfo]) -> io::Result<Self> {
        Self::new::<P>(path, WhenFull::Drop, ROOM, Some(groups), |_| false)
    }

    fn new<P: Program>(
        path: &Path,
        when_full: WhenFull,
        room: usize,
        groups: Option<&[GroupInfo]>,
        left_out: impl Fn(&Channel) -> bool,
    ) -> io::Result<Self> {
        let (info, mut channels) = (const { &P::INFO }, P::channels());
        let (mut out, kept): (Vec<_>, Vec<_>) = channels.iter_mut().partition(|channel| left_out(channel));
        if let Some(message) = why_useless(&kept) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        // As if they could not be written.
        out.iter_mut().for_each(|channel| channel.schema = None);
        let path = free(path);
        let mut about = BTreeMap::from([("name".to_owned(), info.name.to_owned())]);
        if let Some(groups) = groups.filter(|groups| !groups.is_empty()) {
            about.insert(THREADS.to_owned(), names(groups));
        }
        // One for each group, and one for who watches over them.
        let beside = groups.map_or(0, |groups| groups.len().max(1) + 1);
        let (sink, mut ends) = Sink::new(path.clone(), about, &channels, 1 + beside, room)?;
        let near = ends.remove(0);
        let own = Self::by(near, channels, when_full, path, info.nodes.len());
        Ok(Self { sink: Some(sink), others: Mutex::new(ends), ..own })
    }

    /// A recorder that writes by `near`.
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
            lost: false,
            channels,
        }
    }

    /// Records in the same file, where there are several groups what this `group` does. All that was sent by this one
    /// comes before what is sent by that.
    ///
    /// # Panics
    /// There are more of them than was said.
    pub(super) fn beside(&self, group: Option<usize>) -> Self {
        self.near.settle();
        let near = self.others.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let near = near.expect("there is one for each group, and one for who watches over them");
        let own = Self::by(near, self.channels.clone(), self.when_full, self.path.clone(), self.calls.len());
        Self { group: group.map(|group| group as u32), ..own }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes what is left, and ends the file.
    ///
    /// # Errors
    /// It could not be written.
    pub fn finish(self) -> io::Result<Finished> {
        let Self { sink: Some(sink), mut near, channels, path, .. } = self else {
            return Err(io::Error::other("another recorder ends the file"));
        };
        let own = OWN.iter().map(|(name, _)| *name);
        let names = own.chain(channels.iter().map(|c| c.name));
        let lost = names.zip(sink.dropped()).filter(|(_, count)| *count > 0);
        let dropped: Vec<(String, u64)> = lost.map(|(name, count)| (name.to_owned(), count)).collect();
        sink.finish(&mut near, &dropped)?;
        Ok(Finished { path, dropped })
    }

    pub(super) fn begin(&mut self, now: Time) {
        self.now = now;
        self.lost = false;
        self.looks = 0;
        self.calls.fill(0);
        let group = self.group.unwrap_or(0);
        self.reactions = self.reactions.wrapping_add(1);
        let sent = self.numbered(REACTION, self.reactions, |message| {
            message.u32(group);
            message.i64(now.as_nanos());
        });
        self.lost = !sent;
    }

    pub(super) fn end(&mut self) {
        if let Some(group) = self.group {
            self.own(ENDED, |message| message.u32(group));
        }
    }

    /// A look at what is between groups found something, or not. Groups that run in turn always find the same.
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

    /// The parameters that are not what they were after the last reaction; before the first one, all.
    pub(super) fn changed_params<P: Parameters>(&mut self, program: &mut P) {
        let first = self.params.is_empty();
        let mut now = core::mem::take(&mut self.params_now);
        now.clear();
        program.visit_params(&mut Bits(&mut now));
        if first || now != self.params {
            let before = core::mem::take(&mut self.params);
            program.visit_params(&mut Changes { recorder: self, before: &before, first });
            self.params = before;
        }
        self.params_now = now;
    }

    pub(super) fn keep_params<P: Parameters>(&mut self, program: &mut P) {
        self.params.clear();
        program.visit_params(&mut Bits(&mut self.params));
    }

    /// Sends a message on a channel that every recording has.
    fn own(&mut self, channel: u16, write: impl FnOnce(&mut Writer<'_>)) -> bool {
        self.numbered(channel, 0, write)
    }

    fn numbered(&mut self, channel: u16, number: u32, write: impl FnOnce(&mut Writer<'_>)) -> bool {
        let frame = self.frame.begin(channel, number, time(self.now));
        write(&mut Writer::new(frame));
        self.send(usize::from(channel), true)
    }

    /// Sends what was written of a message, or counts it as lost.
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

/// The groups of threads, as the file says them.
pub(super) fn names(groups: &[GroupInfo]) -> String {
    groups.iter().map(|group| group.name).collect::<Vec<_>>().join(" ")
}

/// Why nothing would be gained by a recording.
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

/// Nothing happens before the zero of a clock.
fn time(now: Time) -> u64 {
    u64::try_from(now.as_nanos()).unwrap_or(0)
}

/// Writes down all parameters, each with its length before it.
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

/// Values are the same if their bits are.
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
                // Texts in a list are told apart.
                out.push(0);
            }
        }
        ParamRef::Other(_) => {}
    }
}

/// Records the parameters that are not as `before` says.
struct Changes<'a> {
    recorder: &'a mut Recorder,
    before: &'a [u8],
    first: bool,
}

impl ParamVisitor for Changes<'_> {
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
        let Some(access) = access else {
            self.skip(&[]);
            return;
        };
        let mut now = vec![];
        bits(access.get(), &mut now);
        if !self.skip(&now) {
            let (value, changed) = (access.get().to_string(), !self.first);
            self.recorder.own(PARAMETER, |message| {
                message.text(info.name);
                message.text(&value);
                changed.write(message);
            });
        }
    }
}

impl Changes<'_> {
    /// Goes on to the next parameter; whether this one was `now` before.
    fn skip(&mut self, now: &[u8]) -> bool {
        let Some((length, rest)) = self.before.split_first_chunk::<4>() else { return false };
        let Some((was, rest)) = rest.split_at_checked(u32::from_le_bytes(*length) as usize) else { return false };
        self.before = rest;
        was == now
    }
}
