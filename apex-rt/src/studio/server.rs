//! The thread that talks to viewers.

use super::{
    fork::Lifeline,
    message::{self, Command, Report},
    shared::{Pace, Shared},
    socket::{Listener, Wire},
    stream::shortened,
};
use crate::{
    RemoteParams,
    params::{Access, ParamError, with_text},
    record::Channel,
};
use core::time::Duration;
use rtrb::Consumer;
use std::{
    boxed::Box,
    format, io,
    string::{String, ToString as _},
    sync::{
        Arc, PoisonError,
        atomic::Ordering::{AcqRel, Acquire, Relaxed, Release},
        mpsc::{Receiver, Sender, channel},
    },
    thread,
    time::Instant,
    vec,
    vec::Vec,
};

/// Time between two looks at the rings, with a viewer and without.
const LOOK: Duration = Duration::from_millis(2);
const DOZE: Duration = Duration::from_millis(50);
/// Number of bytes that may wait for a viewer. One that is slower is disconnected.
const BACKLOG: usize = 16 << 20;
/// Maximum number of viewers.
const MAX_VIEWERS: usize = 16;
/// Time that viewers get for the last messages.
const FAREWELL: Duration = Duration::from_secs(1);
/// Maximum length of a token as text, in bytes.
const MAX_TEXT: usize = 16 << 10;
/// Maximum length of a token that is converted to text, in bytes.
const MAX_SHOWN: usize = 64 << 10;

/// Everything that the thread has.
pub struct Server {
    listener: Listener,
    rings: Vec<Consumer<u8>>,
    shared: Arc<Shared>,
    channels: Vec<Channel>,
    /// Description of the robot, as a message.
    about: Vec<u8>,
    params: RemoteParams,
    answers: (Sender<Report>, Receiver<Report>),
    viewers: Vec<Viewer>,
    /// Ends if the process ends whose checkpoint this one was.
    pub lifeline: Option<Lifeline>,
}

/// A connected viewer.
struct Viewer {
    wire: Box<dyn Wire>,
    /// Bytes of commands that have come.
    came: Vec<u8>,
    /// Bytes that wait for the socket.
    out: Vec<u8>,
    /// Interval of each channel that it asked for, and the time of its last token.
    watches: Vec<(usize, Duration, Option<Instant>)>,
    /// `true` if it wants calls to be measured.
    measures: bool,
    /// `true` if it wants to know of every token.
    follows: bool,
    /// `true` if it wants checkpoints.
    keeps: bool,
    /// `true` after an error or the end of its commands.
    gone: bool,
}

impl Server {
    pub fn new(
        listener: Listener,
        rings: Vec<Consumer<u8>>,
        shared: Arc<Shared>,
        channels: Vec<Channel>,
        about: Vec<u8>,
        params: RemoteParams,
    ) -> Self {
        Self { listener, rings, shared, channels, about, params, answers: channel(), viewers: vec![], lifeline: None }
    }

    /// Serves viewers until the end of the program, or until it has to stop.
    pub fn run(mut self) -> Self {
        let mut batch: Vec<u8> = vec![];
        loop {
            // Loaded before the rings are read, so that all messages from before the end are seen.
            let over = self.shared.over.load(Acquire);
            if self.shared.stops.load(Acquire) && !over {
                return self;
            }
            self.lifeline.as_ref().inspect(|lifeline| lifeline.check());
            let mut viewers = core::mem::take(&mut self.viewers);
            self.welcome(&mut viewers);
            for viewer in &mut viewers {
                viewer.receive(&self);
            }
            self.note_wishes(&viewers);
            self.collect(&mut batch);
            if let Some(report) = self.shared.pace.as_ref().and_then(Pace::news) {
                message::write(&report, &mut batch);
            }
            self.answers.1.try_iter().for_each(|report| message::write(&report, &mut batch));
            self.values(&mut viewers);
            if over {
                message::write(&Report::Ended, &mut batch);
            }
            let is_quiet = batch.is_empty();
            for viewer in &mut viewers {
                viewer.out.extend_from_slice(&batch);
                viewer.flush();
            }
            batch.clear();
            self.dismiss(&mut viewers);
            if over {
                farewell(&mut viewers);
                return self;
            }
            if is_quiet {
                thread::park_timeout(if viewers.is_empty() { DOZE } else { LOOK });
            }
            self.viewers = viewers;
        }
    }

    /// Leaves all viewers, and forgets what was to be sent to them: another process serves them.
    pub fn leave_viewers(&mut self) {
        self.viewers.clear();
        self.collect(&mut vec![]);
        self.answers = channel();
        self.shared.watched.store(false, Release);
        self.note_wishes(&[]);
        self.update_channels(&[]);
    }

    /// Stores what the viewers want to know.
    fn note_wishes(&self, viewers: &[Viewer]) {
        self.shared.measured.store(viewers.iter().any(|viewer| viewer.measures), Relaxed);
        self.shared.followed.store(viewers.iter().any(|viewer| viewer.follows), Relaxed);
        self.shared.keeps.store(viewers.iter().any(|viewer| viewer.keeps), Relaxed);
    }

    /// Greets new viewers.
    fn welcome(&self, viewers: &mut Vec<Viewer>) {
        while viewers.len() < MAX_VIEWERS
            && let Ok(wire) = self.listener.accept()
        {
            self.shared.watched.store(true, Release);
            let mut out = self.about.clone();
            message::write(&self.shared.active_nodes(), &mut out);
            if let Some(pace) = &self.shared.pace {
                message::write(&pace.report(), &mut out);
            }
            viewers.push(Viewer {
                wire,
                came: vec![],
                out,
                watches: vec![],
                measures: false,
                follows: false,
                keeps: false,
                gone: false,
            });
        }
    }

    /// Forgets viewers that have left.
    fn dismiss(&self, viewers: &mut Vec<Viewer>) {
        if viewers.extract_if(.., |viewer| viewer.gone).count() > 0 {
            self.update_channels(viewers);
            if viewers.is_empty() {
                self.shared.watched.store(false, Release);
                if let Some(pace) = &self.shared.pace {
                    pace.release();
                }
            }
        }
    }

    /// Moves all messages of the program to `batch`.
    fn collect(&mut self, batch: &mut Vec<u8>) {
        for ring in &mut self.rings {
            if let Ok(chunk) = ring.read_chunk(ring.slots()) {
                let (first, second) = chunk.as_slices();
                batch.extend_from_slice(first);
                batch.extend_from_slice(second);
                chunk.commit_all();
            }
        }
        match self.shared.lost.swap(0, AcqRel) {
            0 => {}
            lost => message::write(&Report::Lost(lost), batch),
        }
    }

    /// Sends tokens to the viewers that asked for them.
    fn values(&self, viewers: &mut [Viewer]) {
        let asked: Vec<usize> = viewers.iter().flat_map(|viewer| viewer.watches.iter().map(|(at, ..)| *at)).collect();
        if asked.is_empty() {
            return;
        }
        self.update_channels(viewers);
        let now = Instant::now();
        for at in asked {
            let is_due = |(channel, every, last): &(usize, Duration, Option<Instant>)| {
                *channel == at && last.is_none_or(|last| now.duration_since(last) >= *every)
            };
            let due: Vec<&mut Viewer> = viewers.iter_mut().filter(|viewer| viewer.watches.iter().any(is_due)).collect();
            let Some(report) = (!due.is_empty()).then(|| self.latest(at)).flatten() else { continue };
            for viewer in due {
                message::write(&report, &mut viewer.out);
                viewer.watches.iter_mut().filter(|watch| watch.0 == at).for_each(|watch| watch.2 = Some(now));
            }
        }
    }

    /// Takes the newest token of a channel.
    fn latest(&self, channel: usize) -> Option<Report> {
        let mut latest = self.shared.channels[channel].latest.lock().unwrap_or_else(PoisonError::into_inner);
        if !latest.is_new {
            return None;
        }
        latest.is_new = false;
        let (bytes, now) = (latest.bytes.clone(), latest.now);
        // The program must not wait while the token is converted.
        drop(latest);
        let schema = self.channels[channel].schema?;
        // Images as text would be of no use, and take long.
        let text = if bytes.len() > MAX_SHOWN {
            format!("{} bytes", bytes.len())
        } else {
            (self.channels[channel].show)(&bytes)?
        };
        let bytes = if schema.encoding == "cdr" && bytes.len() <= message::MAX_TOKEN { bytes } else { vec![] };
        Some(Report::Value { channel: channel as u32, now, text: shortened(text, MAX_TEXT), bytes })
    }

    /// Asks the program for the values of all parameters. The answers come after its reaction.
    fn ask_for_all(&self) {
        for param in self.params.all() {
            let (tell, refused) = (self.tells(param.name.into(), None), self.tells(param.name.into(), None));
            let asked = self.params.post(param.name, |access| Ok((access.get().to_string(), None)), tell);
            asked.unwrap_or_else(|error| refused(Err(error)));
        }
    }

    /// Asks the program to set a parameter.
    fn set(&self, name: String, value: String) {
        let (tell, refused) = (self.tells(name.clone(), Some(0)), self.tells(name.clone(), Some(0)));
        let shared = Arc::clone(&self.shared);
        let act = move |access: &mut dyn Access| {
            with_text(&value, |value| access.set(value))?;
            Ok((access.get().to_string(), Some(shared.pace.as_ref().map_or(0, Pace::reactions))))
        };
        self.params.post(&name, act, tell).unwrap_or_else(|error| refused(Err(error)));
    }

    /// Returns a function that sends the value of a parameter, and the number of reactions before it was set, or
    /// `unset` after an error.
    fn tells(
        &self,
        name: String,
        unset: Option<u64>,
    ) -> impl FnOnce(Result<(String, Option<u64>), ParamError>) + Send + use<> {
        let answer = self.answers.0.clone();
        move |result| {
            let reactions = result.as_ref().map_or(unset, |(_, reactions)| *reactions);
            let value = result.map(|(value, _)| value).map_err(|error| error.to_string());
            // The viewer may have gone.
            let _ = answer.send(Report::Param { name, value, reactions });
        }
    }

    fn update_channels(&self, viewers: &[Viewer]) {
        for (at, wanted) in self.shared.channels.iter().enumerate() {
            let is = viewers.iter().any(|viewer| viewer.watches.iter().any(|watch| watch.0 == at));
            wanted.is.store(is, Relaxed);
        }
    }
}

impl Viewer {
    /// Obeys the commands that have come.
    fn receive(&mut self, server: &Server) {
        let mut bytes = [0; 4096];
        loop {
            match self.wire.read(&mut bytes) {
                Ok(0) => {
                    self.gone = true;
                    break;
                }
                Ok(count) => self.came.extend_from_slice(&bytes[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.gone |= error.kind() != io::ErrorKind::WouldBlock;
                    break;
                }
            }
            if self.came.len() > message::MAX_BYTES {
                break;
            }
        }
        loop {
            match message::take(&mut self.came) {
                Ok(Some(command)) => self.obey(command, server),
                Ok(None) => return,
                Err(_) => {
                    self.gone = true;
                    return;
                }
            }
        }
    }

    fn obey(&mut self, command: Command, server: &Server) {
        match command {
            Command::Watch { channel, every } => {
                let channel = channel as usize;
                self.watches.retain(|watch| watch.0 != channel);
                if every > 0 && channel < server.shared.channels.len() {
                    self.watches.push((channel, Duration::from_millis(every.into()), None));
                }
            }
            Command::Measure(measures) => self.measures = measures,
            Command::Follow(follows) => self.follows = follows,
            Command::Keep(keeps) => {
                self.keeps = keeps;
                // Before the next command, which may let the program run.
                server.shared.keeps.fetch_or(keeps, Relaxed);
            }
            Command::Params => server.ask_for_all(),
            Command::Set { name, value } => server.set(name, value),
            pace => {
                if let Some(state) = &server.shared.pace {
                    state.obey(&pace, &server.shared.active);
                }
            }
        }
    }

    /// Writes as much as the socket takes.
    fn flush(&mut self) {
        let mut sent = 0;
        while sent < self.out.len() && !self.gone {
            match self.wire.write(&self.out[sent..]) {
                Ok(count) => sent += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                Err(_) => self.gone = true,
            }
        }
        self.out.drain(..sent);
        self.gone |= self.out.len() > BACKLOG;
    }
}

/// Sends the last messages.
fn farewell(viewers: &mut [Viewer]) {
    let start = Instant::now();
    while viewers.iter().any(|viewer| !viewer.gone && !viewer.out.is_empty()) && start.elapsed() < FAREWELL {
        viewers.iter_mut().for_each(Viewer::flush);
        thread::sleep(LOOK);
    }
}
