//! Checkpoints of a program in simulated time: copies of its process that stand still until one is woken, which makes a
//! copy of itself that goes on. The first process lives as long as they do: whoever started it can end them all.
//!
//! Each process has connections to the checkpoints of its own past. A checkpoint ends when it is told to, or when no
//! process has a connection to it any more: all of them end with the process that runs. A process that has been woken
//! also ends when the first one does.

use super::{
    fork::{self, Control, Copied, DONE, FAILED, Lifeline, WAKE},
    message::Report,
    server::Server,
};
use core::time::Duration;
use std::{env, format, io, path::PathBuf, process, string::String, time::Instant, vec::Vec};

/// Maximum number of checkpoints.
const MAX: usize = 32;
/// Minimum computing time between two checkpoints.
const INTERVAL: Duration = Duration::from_millis(250);
/// Minimum computing time between two checkpoints, in times of that for a checkpoint.
const COST: u32 = 50;

/// A copy of the process.
struct Checkpoint {
    /// Number of reactions before.
    reactions: u64,
    /// Computing time before.
    computed: Duration,
    process: i32,
    control: Control,
}

/// The checkpoints of this process.
#[derive(Default)]
pub struct Checkpoints {
    /// Those of its past, in sequence.
    past: Vec<Checkpoint>,
    /// Computing time so far, and the beginning of the current reaction.
    computed: Duration,
    since: Option<Instant>,
    /// Computing time before the last attempt to make one, and the duration of that.
    last: Option<Duration>,
    cost: Duration,
    /// `true` if the viewers know that there are no checkpoints.
    refused: bool,
    /// Lifeline for copies, and its other end in the first process.
    lifeline: Option<(Lifeline, Option<Control>)>,
}

impl Checkpoints {
    /// A reaction ends, and with it the computing time.
    pub fn stop_clock(&mut self) {
        self.computed += self.since.take().map_or(Duration::ZERO, |since| since.elapsed());
    }

    /// A reaction begins.
    pub fn start_clock(&mut self) {
        self.since = Some(Instant::now());
    }

    /// `true` if it is time for a checkpoint.
    pub fn is_due(&self) -> bool {
        let interval = INTERVAL.max(self.cost * COST);
        !self.refused && self.last.is_none_or(|last| self.computed >= last + interval)
    }

    /// Makes a checkpoint, which has `reactions` reactions before it. Returns also in the process that is woken there,
    /// with nothing to tell: it has to stand still until a viewer comes.
    pub fn make(&mut self, mut server: Server, reactions: u64) -> (Server, Option<Report>) {
        let start = Instant::now();
        self.last = Some(self.computed);
        let is_scarce = fork::is_scarce();
        let is_full = self.past.len() >= MAX || is_scarce;
        let has_room = !is_full || self.thin_out();
        if is_scarce && !has_room {
            return (server, Some(self.report()));
        }
        let made =
            self.check().and_then(|()| self.copied().map_err(|error| format!("there is no room for it: {error}")));
        match made {
            Err(why) => {
                self.refused = true;
                self.past.clear();
                (server, Some(Report::NoCheckpoints(why)))
            }
            Ok((Copied::Original(process), near, far)) => {
                drop(far);
                self.past.push(Checkpoint { reactions, computed: self.computed, process, control: near });
                self.cost = start.elapsed();
                (server, Some(self.report()))
            }
            Ok((Copied::Copy, near, far)) => {
                drop(near);
                // The connections are those of the original; a copy of them would keep them open.
                server.leave_viewers();
                self.stand(far, reactions);
                server.lifeline = self.lifeline.as_ref().and_then(|(lifeline, _)| lifeline.share().ok());
                (server, None)
            }
        }
    }

    /// Ends all checkpoints: no viewer wants them any more.
    pub fn give_up(&mut self) {
        self.past.drain(..).for_each(|checkpoint| give_up(checkpoint.control, checkpoint.process));
        self.last = None;
    }

    /// All checkpoints, for viewers.
    pub fn report(&self) -> Report {
        Report::Checkpoints(self.past.iter().map(|checkpoint| checkpoint.reactions).collect())
    }

    /// Wakes the last checkpoint that has no more than `goal` reactions before it, and ends then. Returns if there is
    /// none.
    pub fn go_back(&mut self, mut server: Server, goal: u64) -> (Server, Option<Report>) {
        let known = self.check();
        while let (Ok(()), Some(mut last)) = (&known, self.past.pop()) {
            if last.reactions <= goal && last.control.say(WAKE) && last.control.answer() == Some(DONE) {
                server.leave_viewers();
                self.leave();
            }
        }
        let why = known.err().unwrap_or_else(|| String::from("there is no checkpoint before that"));
        (server, Some(Report::NoCheckpoints(why)))
    }

    /// Ends this process after another one has taken its place.
    fn leave(&mut self) -> ! {
        self.past.clear();
        // Only the first process has this end.
        if let Some((_, Some(near))) = self.lifeline.take() {
            fork::outlive(near);
            process::exit(0);
        }
        fork::end();
    }

    /// Checks that copies can go on in the place of this process.
    fn check(&self) -> Result<(), String> {
        // Its reader has a position of its own.
        let replayed = env::var_os("APEX_REPLAY").map(PathBuf::from).and_then(|path| path.canonicalize().ok());
        let own: Vec<_> = replayed.iter().map(PathBuf::as_path).collect();
        fork::alone(&own)
    }

    /// Makes a copy, with both ends of a connection to it.
    fn copied(&mut self) -> io::Result<(Copied, Control, Control)> {
        if self.lifeline.is_none() {
            let (far, near) = Lifeline::new()?;
            self.lifeline = Some((far, Some(near)));
            fork::adopt();
        }
        let (near, far) = Control::pair()?;
        let copied = fork::copy()?;
        if matches!(copied, Copied::Copy)
            && let Some((_, near)) = &mut self.lifeline
        {
            *near = None;
        }
        Ok((copied, near, far))
    }

    /// Stands still as a checkpoint. Returns in a copy that has been woken.
    fn stand(&mut self, mut control: Control, reactions: u64) {
        fork::ends_with_its_signals(true);
        loop {
            if control.hear() != Some(WAKE) {
                fork::end();
            }
            match self.copied() {
                Err(_) => {
                    control.say(FAILED);
                }
                Ok((Copied::Original(_), near, far)) => {
                    drop(near);
                    // Only the process that was woken may wake this one again.
                    control.say(DONE);
                    control = far;
                }
                Ok((Copied::Copy, near, far)) => {
                    drop(far);
                    fork::ends_with_its_signals(false);
                    // Others of the past may have been given up after this one was made.
                    self.past.retain_mut(|checkpoint| checkpoint.control.is_alive());
                    let (computed, process) = (self.computed, i32::MAX);
                    self.past.push(Checkpoint { reactions, computed, process, control: near });
                    self.since = None;
                    return;
                }
            }
        }
    }

    /// Gives up the checkpoint that is missed least: the distances between them are to grow with their age. Returns
    /// `false` if there is none to spare.
    fn thin_out(&mut self) -> bool {
        let gain = |at: &usize| {
            let (before, after) = (&self.past[at - 1], &self.past[at + 1]);
            let age = self.computed.saturating_sub(after.computed) + INTERVAL;
            (after.computed - before.computed).as_secs_f64() / age.as_secs_f64()
        };
        let middle = 1..self.past.len().saturating_sub(1);
        let Some(least) = middle.min_by(|one, other| gain(one).total_cmp(&gain(other))) else { return false };
        let Checkpoint { process, control, .. } = self.past.remove(least);
        give_up(control, process);
        true
    }
}

impl Drop for Checkpoints {
    /// Ends all checkpoints, so that they hold nothing any more when this process is gone.
    fn drop(&mut self) {
        self.give_up();
    }
}

/// Ends a checkpoint.
fn give_up(mut control: Control, process: i32) {
    control.say(FAILED);
    drop(control);
    fork::reap(process);
}
