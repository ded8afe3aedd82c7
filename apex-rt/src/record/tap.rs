use super::{Codec, Recorder, Replay, Report, Role};
use crate::{Arrival, Mailbox, Observer, Parameters, Time, first_arrival};
use core::time::Duration;

/// Tap of a program: records its tokens, or supplies recorded ones. Generated code calls the tap of the reaction's
/// observer.
///
/// Ports are given by their index in [`Program::channels`](crate::Program::channels).
///
/// ```
/// use apex_rt::{
///     prelude::*,
///     record::{Recorder, Tap, WhenFull},
/// };
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let file = std::env::temp_dir().join(format!("apex-tap-{}.mcap", std::process::id()));
/// let mut tap = Tap::Record(Recorder::to_file::<Blink>(&file, WhenFull::Wait)?);
/// // A loop of your own.
/// let mut blink = Blink::new();
/// for tick in 0..10 {
///     blink.react_with(Time::from_millis(20 * tick), &mut tap);
/// }
/// if let Tap::Record(recorder) = tap {
///     assert!(recorder.finish()?.dropped.is_empty());
/// }
/// # std::fs::remove_file(file)?;
/// # Ok(())
/// # }
/// ```
#[allow(clippy::large_enum_variant, reason = "a program has one")]
pub enum Tap {
    /// Records a run.
    Record(Recorder),
    /// Repeats a run.
    Replay(Replay),
}

impl Observer for Tap {
    fn tap(&mut self) -> Option<&mut Tap> {
        Some(self)
    }

    /// Ports of the `record` statement are recorded, or compared with a recording.
    fn wants(&mut self, channel: usize) -> bool {
        match self {
            Self::Record(recorder) => recorder.role(channel) == Role::Chosen,
            Self::Replay(replay) => replay.role(channel) == Role::Chosen,
        }
    }

    fn sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        match self {
            Self::Record(recorder) => recorder.token(channel, codec, token),
            Self::Replay(replay) => replay.compare(channel, codec, token),
        }
    }
}

/// A run that may be recorded.
impl Observer for Option<Tap> {
    fn tap(&mut self) -> Option<&mut Tap> {
        self.as_mut()
    }
}

#[doc(hidden)]
impl Tap {
    /// Ends a replay, and returns its report.
    pub fn report(&mut self) -> Report {
        match self {
            Self::Record(_) => Report::default(),
            Self::Replay(replay) => replay.finish(),
        }
    }

    /// Begins a reaction at `now`. If it is late, it `ends_early`, after the first of the instants that have passed, or
    /// makes up for all of them.
    pub fn begin(&mut self, now: Time, ends_early: bool) {
        match self {
            Self::Record(recorder) => recorder.begin(now, ends_early),
            Self::Replay(replay) => replay.begin(),
        }
    }

    /// Checks a cell between two groups. Returns `true` if there is something in it; in a replay, if there was.
    pub fn looked(&mut self, finds: &dyn Fn() -> bool) -> bool {
        match self {
            Self::Record(recorder) => recorder.looked(finds()),
            Self::Replay(replay) => replay.looked(finds),
        }
    }

    /// Ends the reaction.
    pub fn end(&mut self) {
        match self {
            Self::Record(recorder) => recorder.end(),
            Self::Replay(replay) => replay.end(),
        }
    }

    /// Records the parameters that were set from outside, or sets recorded ones. Called before a reaction.
    pub fn set_params<P: Parameters>(&mut self, program: &mut P) {
        match self {
            Self::Record(recorder) => recorder.changed_params(program),
            Self::Replay(replay) => replay.set_params(program),
        }
    }

    /// Stores the parameters, which the program itself may have set. Called after a reaction.
    pub fn keep_params<P: Parameters>(&mut self, program: &mut P) {
        if let Self::Record(recorder) = self {
            recorder.keep_params(program);
        }
    }

    /// Returns the mailbox, by its place in `channels`, whose token came next, or whose token is next in the recording.
    /// Called before a reaction, until there is none. `arrivals` has the tokens that wait.
    pub fn next_in<const N: usize>(
        &mut self,
        channels: &[usize; N],
        arrivals: &mut [Option<Arrival>; N],
    ) -> Option<usize> {
        match self {
            Self::Record(_) => {
                let next = first_arrival(arrivals)?;
                arrivals[next] = None;
                Some(next)
            }
            Self::Replay(replay) => {
                let next = replay.next_in()?;
                channels.iter().position(|channel| *channel == next)
            }
        }
    }

    /// Records a token that was put into a mailbox, or puts a recorded one in. Called before a reaction.
    pub fn put_in<T>(&mut self, channel: usize, codec: Option<Codec<T>>, mailbox: &mut Mailbox<T>) {
        match self {
            Self::Record(recorder) => recorder.put_in(channel, codec, mailbox),
            Self::Replay(replay) => {
                if let Some(token) = replay.take(channel, codec) {
                    // In the recorded run the previous token had been taken.
                    mailbox.take();
                    let _ = mailbox.put(token);
                }
            }
        }
    }

    /// Records that a token was taken out of a mailbox, or takes one out as recorded. Called before a reaction.
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

    /// Stores if a mailbox is full. Called after a reaction.
    pub fn keep_mailbox(&mut self, channel: usize, is_full: bool) {
        if let Self::Record(recorder) = self {
            recorder.keep_mailbox(channel, is_full);
        }
    }

    /// Called before a source fires or takes a token at a slot. Returns `true` if the source must not be called because
    /// its tokens are recorded.
    pub fn calls(&mut self, node: usize) -> bool {
        match self {
            Self::Record(recorder) => {
                recorder.calls(node);
                false
            }
            Self::Replay(replay) => replay.calls(node),
        }
    }

    /// Records the token that a source sent at a port. Called after the source.
    pub fn source_sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: Option<&T>) {
        if let (Self::Record(recorder), Some(token)) = (self, token) {
            recorder.token(channel, codec, token);
        }
    }

    /// Returns the recorded token of a source at a port.
    pub fn take<T>(&mut self, channel: usize, codec: Option<Codec<T>>) -> Option<T> {
        match self {
            Self::Record(_) => None,
            Self::Replay(replay) => replay.take(channel, codec),
        }
    }

    /// Returns the recorded token as [`take`](Self::take) does, for a source that always sends. If there is none,
    /// returns the previous one again.
    pub fn take_or_last<T>(&mut self, channel: usize, codec: Option<Codec<T>>) -> Option<T> {
        match self {
            Self::Record(_) => None,
            Self::Replay(replay) => replay.take_or_last(channel, codec),
        }
    }

    /// Records the time since the beginning of the reaction, or returns the recorded one.
    pub fn elapsed(&mut self, elapsed: Duration) -> Duration {
        match self {
            Self::Record(recorder) => recorder.elapsed(elapsed),
            Self::Replay(replay) => replay.elapsed().unwrap_or(elapsed),
        }
    }
}

/// Checks a cell between two groups, for generated code. Returns `true` if there is something in it; in a replay, if
/// there was.
#[doc(hidden)]
#[inline]
pub fn looked<O: Observer>(observer: &mut O, finds: impl Fn() -> bool) -> bool {
    match observer.tap() {
        Some(tap) => tap.looked(&finds),
        None => finds(),
    }
}

/// Shows the observer a token that a port sends, for generated code.
#[doc(hidden)]
#[inline(always)]
pub fn sent<T, O: Observer>(observer: &mut O, channel: usize, codec: fn() -> Option<Codec<T>>, token: Option<&T>) {
    if let Some(token) = token
        && observer.wants(channel)
    {
        observer.sent(channel, codec(), token);
    }
}
