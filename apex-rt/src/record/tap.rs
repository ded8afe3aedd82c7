use super::{Codec, Recorder, Replay};
use crate::{Mailbox, Observer, Parameters, Time};
use core::time::Duration;

/// Where a program lets tokens out, to be recorded, or takes recorded ones in. The observer of a reaction has it; generated
/// code calls it.
///
/// Ports are given by their index in [`Program::channels`](crate::Program::channels).
#[allow(clippy::large_enum_variant, reason = "a program has one")]
pub enum Tap {
    /// A run is recorded.
    Record(Recorder),
    /// A run is repeated.
    Replay(Replay),
}

impl Observer for Tap {
    fn tap(&mut self) -> Option<&mut Tap> {
        Some(self)
    }
}

#[doc(hidden)]
impl Tap {
    /// A reaction at `now` begins.
    pub fn begin(&mut self, now: Time) {
        match self {
            Self::Record(recorder) => recorder.begin(now),
            Self::Replay(replay) => replay.begin(),
        }
    }

    /// A group looks at what is between it and another one: whether it finds something.
    pub fn looked(&mut self, finds: impl Fn() -> bool) -> bool {
        match self {
            Self::Record(recorder) => recorder.looked(finds()),
            Self::Replay(replay) => replay.looked(finds),
        }
    }

    /// The reaction has ended.
    pub fn end(&mut self) {
        match self {
            Self::Record(recorder) => recorder.end(),
            Self::Replay(replay) => replay.end(),
        }
    }

    /// Before a reaction: what may have been set from outside.
    pub fn set_params<P: Parameters>(&mut self, program: &mut P) {
        match self {
            Self::Record(recorder) => recorder.changed_params(program),
            Self::Replay(replay) => replay.set_params(program),
        }
    }

    /// After a reaction: what the program may have set itself.
    pub fn keep_params<P: Parameters>(&mut self, program: &mut P) {
        if let Self::Record(recorder) = self {
            recorder.keep_params(program);
        }
    }

    /// Before a reaction: a token may have been put in.
    pub fn put_in<T>(&mut self, channel: usize, codec: Option<Codec<T>>, mailbox: &mut Mailbox<T>) {
        match self {
            Self::Record(recorder) => recorder.put_in(channel, codec, mailbox),
            Self::Replay(replay) => {
                if let Some(token) = replay.take(channel, codec) {
                    // The one before was taken when this was recorded.
                    mailbox.take();
                    let _ = mailbox.put(token);
                }
            }
        }
    }

    /// Before a reaction: a token may have been taken out.
    pub fn taken_out<T>(&mut self, channel: usize, mailbox: &mut Mailbox<T>) {
        match self {
            Self::Record(recorder) => recorder.taken_out(channel, mailbox.is_full()),
            Self::Replay(replay) => {
                if replay.was_taken(channel) {
                    mailbox.take();
                }
            }
        }
    }

    /// After a reaction: whether a mailbox holds a token.
    pub fn keep_mailbox(&mut self, channel: usize, is_full: bool) {
        if let Self::Record(recorder) = self {
            recorder.keep_mailbox(channel, is_full);
        }
    }

    /// A source fires, or takes a token at a slot. Whether it is not to be called, because what it sent is recorded.
    pub fn calls(&mut self, node: usize) -> bool {
        match self {
            Self::Record(recorder) => {
                recorder.calls(node);
                false
            }
            Self::Replay(replay) => replay.calls(node),
        }
    }

    /// What a source sent at a port, after it was called.
    pub fn sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: Option<&T>) {
        if let (Self::Record(recorder), Some(token)) = (self, token) {
            recorder.token(channel, codec, token);
        }
    }

    /// What a source sent at a port when it was recorded.
    pub fn take<T>(&mut self, channel: usize, codec: Option<Codec<T>>) -> Option<T> {
        match self {
            Self::Record(_) => None,
            Self::Replay(replay) => replay.take(channel, codec),
        }
    }

    /// As [`take`](Self::take), of a source that always sends: where nothing was recorded, the one before again.
    pub fn take_or_last<T>(&mut self, channel: usize, codec: Option<Codec<T>>) -> Option<T> {
        match self {
            Self::Record(_) => None,
            Self::Replay(replay) => replay.take_or_last(channel, codec),
        }
    }

    /// A token passed a port that was chosen.
    pub fn token<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: Option<&T>) {
        let Some(token) = token else { return };
        match self {
            Self::Record(recorder) => recorder.token(channel, codec, token),
            Self::Replay(replay) => replay.compare(channel, codec, token),
        }
    }

    /// How long a reaction has been going on.
    pub fn elapsed(&mut self, elapsed: Duration) -> Duration {
        match self {
            Self::Record(recorder) => recorder.elapsed(elapsed),
            Self::Replay(replay) => replay.elapsed().unwrap_or(elapsed),
        }
    }
}

/// Whether a group finds something between it and another one, for generated code: what it found when it was recorded.
#[doc(hidden)]
#[inline]
pub fn looked<O: Observer>(observer: &mut O, finds: impl Fn() -> bool) -> bool {
    match observer.tap() {
        Some(tap) => tap.looked(finds),
        None => finds(),
    }
}
