//! The thread that talks to viewers.

use super::{
    message::{self, Command, Report},
    shared::{Pace, Shared},
    socket::{Listener, Wire},
    stream::shortened,
};
use crate::{
    RemoteParams,
    params::{ParamError, with_text},
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

pub struct Server {
    pub listener: Listener,
    pub rings: Vec<Consumer<u8>>,
    pub shared: Arc<Shared>,
    pub channels: Vec<Channel>,
    /// Description of the robot, as a message.
    pub about: Vec<u8>,
    pub params: RemoteParams,
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
    /// `true` after an error or the end of its commands.
    gone: bool,
}

/// A request for parameters, which the program serves between two reactions.
enum Ask {
    All,
    Set(String, String),
}

impl Server {
    /// Serves viewers until the end of the program.
    pub fn run(mut self) {
        let (ask, asked) = channel();
        let (answer, answers) = channel();
        let (params, shared) = (self.params.clone(), Arc::clone(&self.shared));
        // Answers take as long as a reaction; meanwhile messages have to be sent.
        let asker = thread::Builder::new()
            .name("apex-studio-params".into())
            .spawn(move || serve(&params, &shared, &asked, &answer));
        if asker.is_err() {
            return;
        }
        let (mut viewers, mut batch): (Vec<Viewer>, Vec<u8>) = (vec![], vec![]);
        loop {
            // Loaded before the rings are read, so that all messages from before the end are seen.
            let over = self.shared.over.load(Acquire);
            self.welcome(&mut viewers);
            for viewer in &mut viewers {
                viewer.receive(&self.shared, &ask);
            }
            self.shared.measured.store(viewers.iter().any(|viewer| viewer.measures), Relaxed);
            self.shared.followed.store(viewers.iter().any(|viewer| viewer.follows), Relaxed);
            self.collect(&mut batch);
            if let Some(report) = self.shared.pace.as_ref().and_then(Pace::news) {
                message::write(&report, &mut batch);
            }
            answers.try_iter().for_each(|report| message::write(&report, &mut batch));
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
                return;
            }
            if is_quiet {
                thread::sleep(if viewers.is_empty() { DOZE } else { LOOK });
            }
        }
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

    fn update_channels(&self, viewers: &[Viewer]) {
        for (at, wanted) in self.shared.channels.iter().enumerate() {
            let is = viewers.iter().any(|viewer| viewer.watches.iter().any(|watch| watch.0 == at));
            wanted.is.store(is, Relaxed);
        }
    }
}

impl Viewer {
    /// Obeys the commands that have come.
    fn receive(&mut self, shared: &Shared, ask: &Sender<Ask>) {
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
                Ok(Some(command)) => self.obey(command, shared, ask),
                Ok(None) => return,
                Err(_) => {
                    self.gone = true;
                    return;
                }
            }
        }
    }

    fn obey(&mut self, command: Command, shared: &Shared, ask: &Sender<Ask>) {
        match command {
            Command::Watch { channel, every } => {
                let channel = channel as usize;
                self.watches.retain(|watch| watch.0 != channel);
                if every > 0 && channel < shared.channels.len() {
                    self.watches.push((channel, Duration::from_millis(every.into()), None));
                }
            }
            Command::Measure(measures) => self.measures = measures,
            Command::Follow(follows) => self.follows = follows,
            // The other thread lives as long as this one.
            Command::Params => drop(ask.send(Ask::All)),
            Command::Set { name, value } => drop(ask.send(Ask::Set(name, value))),
            pace => {
                if let Some(state) = &shared.pace {
                    state.obey(&pace, &shared.active);
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

/// Serves requests for parameters until the program ends.
fn serve(params: &RemoteParams, shared: &Arc<Shared>, asked: &Receiver<Ask>, answer: &Sender<Report>) {
    let tell = |name: String, value: Result<String, ParamError>, reactions| {
        let value = value.map_err(|error| error.to_string());
        answer.send(Report::Param { name, value, reactions }).is_ok()
    };
    for ask in asked {
        let go_on = match ask {
            Ask::All => params.all().iter().all(|param| tell(param.name.into(), params.get_text(param.name), None)),
            Ask::Set(name, value) => {
                let result = set(params, Arc::clone(shared), &name, value);
                let reactions = result.as_ref().map_or(0, |(_, reactions)| *reactions);
                tell(name, result.map(|(value, _)| value), Some(reactions))
            }
        };
        if !go_on {
            return;
        }
    }
}

/// Sets a parameter. Returns its new value, and the number of reactions before.
fn set(params: &RemoteParams, shared: Arc<Shared>, name: &str, value: String) -> Result<(String, u64), ParamError> {
    params.ask(name, move |access| {
        with_text(&value, |value| access.set(value))?;
        Ok((access.get().to_string(), shared.pace.as_ref().map_or(0, Pace::reactions)))
    })
}
