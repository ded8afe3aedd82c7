use super::{
    checkpoint::Checkpoints,
    message::{self, Report, shortened},
    server::Server,
    serving::Serving,
    shared::{Latest, Shared, Turn},
    times::Times,
};
use crate::{Info, Next, Observer, Parameters, Time, record::Codec, requests::ServedRequests};
use core::{
    fmt::{Debug, Display},
    time::Duration,
};
use rtrb::Producer;
use std::{
    format,
    string::ToString as _,
    sync::{
        Arc, MutexGuard,
        atomic::Ordering::{Acquire, Relaxed},
    },
    thread,
    vec::Vec,
};

/// Maximum length of an error message, in bytes.
const MAX_TEXT: usize = 500;

/// Time between two checks for room.
const PAUSE: Duration = Duration::from_micros(100);

/// Observer that sends what one thread group does to all viewers. While there are none, it does next to nothing.
pub struct Stream {
    pub(super) ring: Producer<u8>,
    pub(super) info: &'static Info,
    pub(super) shared: Arc<Shared>,
    pub(super) serving: Arc<Serving>,
    pub(super) group: u32,
    pub(super) requests: ServedRequests,
    /// The message that is being sent.
    pub(super) frame: Vec<u8>,
    /// Time of the current reaction in ns.
    pub(super) now: i64,
    pub(super) times: Times,
    pub(super) checkpoints: Checkpoints,
}

impl Stream {
    /// Sends a message if there is a viewer.
    fn send(&mut self, report: impl FnOnce() -> Report) {
        if self.shared.watched.load(Relaxed) {
            self.write(&report());
        }
    }

    fn write(&mut self, report: &Report) {
        self.frame.clear();
        message::write(report, &mut self.frame);
        while self.ring.push_entire_slice(&self.frame).is_err() {
            // In simulated time the program waits, so that everything is seen.
            let is_over = self.ring.is_abandoned() || !self.shared.watched.load(Acquire);
            if self.shared.pace.is_none() || is_over {
                self.shared.lost.fetch_add(1, Relaxed);
                return;
            }
            thread::sleep(PAUSE);
        }
    }

    /// Reports that a token was sent. Returns the place for its bytes, if a viewer wants to see them.
    fn latest(&mut self, channel: usize) -> Option<MutexGuard<'_, Latest>> {
        if self.shared.followed.load(Relaxed) {
            self.send(|| Report::Sent(channel as u32));
        }
        let wanted = &self.shared.channels[channel];
        // The thread that talks to viewers has the lock for a moment: this token is then not sent.
        let mut latest = wanted.is.load(Relaxed).then(|| wanted.latest.try_lock().ok()).flatten()?;
        latest.bytes.clear();
        latest.is_new = false;
        latest.now = self.now;
        Some(latest)
    }
}

impl Stream {
    /// Sends the times of all calls from time to time, if they are measured.
    fn send_times(&mut self) {
        if !self.shared.measured.load(Relaxed) {
            self.times.clear();
        } else if let Some(times) = self.times.due() {
            self.send(|| Report::Times(times));
        }
    }
}

/// A program in simulated time, between two reactions.
impl Stream {
    /// Waits until the program may react.
    fn wait(&mut self, params: &mut impl Parameters) {
        let shared = Arc::clone(&self.shared);
        let Some(pace) = &shared.pace else { return };
        self.checkpoints.stop_clock();
        pace.halt_if_wanted(&shared.active);
        loop {
            match pace.turn(self.now) {
                Turn::React if shared.keeps.load(Relaxed) && self.checkpoints.is_due() => {
                    self.beside(|checkpoints, server| checkpoints.make(server, pace.reactions()));
                }
                Turn::React => {
                    if !shared.keeps.load(Relaxed) {
                        self.checkpoints.give_up();
                    }
                    break;
                }
                Turn::Wait => self.requests.serve_all(params),
                Turn::GoBack(goal) => self.beside(|checkpoints, server| checkpoints.go_back(server, goal)),
            }
        }
        pace.begin();
        self.checkpoints.start_clock();
    }

    /// Does something while the process has no other threads of the studio.
    fn beside(&mut self, act: impl FnOnce(&mut Checkpoints, Server) -> (Server, Option<Report>)) {
        let Some(server) = self.serving.stop() else { return };
        let (server, report) = act(&mut self.checkpoints, server);
        if report.is_none() {
            // This process has been woken. The requests are those of the original.
            self.requests.shared.forget();
            self.shared.pace.as_ref().inspect(|pace| pace.halt());
        }
        if let Err(error) = self.serving.start(server) {
            std::eprintln!("error: no viewer is served any more: {error}");
        }
        report.into_iter().for_each(|report| self.send(|| report));
    }
}

/// A run that may be streamed.
impl Observer for Option<Stream> {
    #[inline]
    fn before_reaction(&mut self, now: Time, params: &mut impl Parameters) {
        let Some(stream) = self else { return };
        stream.send_times();
        stream.now = now.as_nanos();
        match stream.shared.pace {
            Some(_) => stream.requests.serve_all(params),
            None => stream.requests.serve(params),
        }
        let (group, now) = (stream.group, stream.now);
        stream.wait(params);
        stream.shared.beats.get(group as usize).inspect(|beat| beat.begin());
        stream.send(|| Report::Reaction { group, now });
    }

    #[inline]
    fn after_reaction(&mut self, _next: Next) {
        if let Some(stream) = self {
            stream.shared.beats.get(stream.group as usize).inspect(|beat| beat.end());
        }
    }

    #[inline]
    fn fired(&mut self, node: usize) {
        if let Some(stream) = self {
            stream.send(|| Report::Fired(node as u32));
            if stream.shared.measured.load(Relaxed) {
                stream.times.begin(node);
            }
        }
    }

    #[inline]
    fn finished(&mut self, node: usize) {
        if let Some(stream) = self
            && stream.shared.measured.load(Relaxed)
        {
            stream.times.end(node);
        }
    }

    #[inline]
    fn handled(&mut self, connection: usize) {
        if let Some(stream) = self {
            stream.send(|| Report::Handled(connection as u32));
            if stream.shared.measured.load(Relaxed) {
                stream.times.begin(stream.info.connections[connection].to);
            }
        }
    }

    fn activity(&mut self, node: usize, active: bool) {
        if let Some(stream) = self {
            stream.shared.active[node].store(active, Relaxed);
            stream.send(|| Report::Activity { node: node as u32, active });
        }
    }

    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        if let Some(stream) = self {
            let steps = nodes.iter().zip(counts).map(|(node, count)| (*node as u32, *count));
            stream.send(|| Report::Endless(steps.collect()));
        }
    }

    fn waits(&mut self, connection: usize) {
        if let Some(stream) = self {
            stream.send(|| Report::Waits(connection as u32));
        }
    }

    fn stuck(&mut self, connection: usize) {
        if let Some(stream) = self {
            stream.send(|| Report::Stuck(connection as u32));
        }
    }

    fn failed(&mut self, node: usize, error: &impl Display) {
        if let Some(stream) = self {
            stream.send(|| Report::Failed { node: node as u32, error: shortened(error.to_string(), MAX_TEXT) });
        }
    }

    fn late(&mut self, node: usize, age: Duration) {
        if let Some(stream) = self {
            stream.send(|| Report::Late { node: node as u32, age: nanos(age) });
        }
    }

    fn hung(&mut self, node: usize, running: Duration) {
        if let Some(stream) = self {
            stream.send(|| Report::Hung { node: node as u32, running: nanos(running) });
        }
    }

    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        if let Some(stream) = self {
            let value = || shortened(format!("{value:?}"), MAX_TEXT);
            stream.send(|| Report::Refused { node: node as u32, parameter: parameter.into(), value: value() });
        }
    }

    fn claim_failed(&mut self, claim: usize) {
        if let Some(stream) = self {
            stream.send(|| Report::ClaimFailed(claim as u32));
        }
    }

    #[inline]
    fn wants(&mut self, channel: usize) -> bool {
        let wants = |shared: &Shared| shared.followed.load(Relaxed) || shared.channels[channel].is.load(Relaxed);
        self.as_ref().is_some_and(|stream| wants(&stream.shared))
    }

    fn sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        if let Some(mut latest) = self.as_mut().and_then(|stream| stream.latest(channel))
            && let Some(codec) = codec
        {
            latest.is_new = (codec.write)(token, &mut latest.bytes);
        }
    }
}

fn nanos(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}
