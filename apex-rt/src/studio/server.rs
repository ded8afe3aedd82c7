//! The thread that talks to viewers.

use super::{
    asking::Told,
    fork::Lifeline,
    message::{self, Report, shortened},
    robot::Robot,
    shared::{MAX_VIEWERS, Pace},
    socket::Listener,
    viewer::Viewer,
};
use crate::{observer::told_viewers, record::Channel};
use core::time::Duration;
use rtrb::Consumer;
use std::{
    format,
    sync::{
        PoisonError,
        atomic::Ordering::{AcqRel, Acquire, Relaxed, Release},
    },
    thread,
    time::Instant,
    vec,
    vec::Vec,
};

/// Time between two looks at the rings, with a viewer and without.
const LOOK: Duration = Duration::from_millis(2);
const DOZE: Duration = Duration::from_millis(50);
/// Time without a word after which a viewer makes room for a new one. Studios say each second that they are there.
const IDLE: Duration = Duration::from_secs(3);
/// Interval at which viewers are told that the robot is there.
const BEAT: Duration = Duration::from_secs(1);
/// Time that viewers get for the last messages.
const FAREWELL: Duration = Duration::from_secs(1);
/// Maximum length of a token as text, in bytes.
const MAX_TEXT: usize = 16 << 10;
/// Maximum length of a problem beside the program, in bytes.
const MAX_PROBLEM: usize = 1000;
/// Maximum length of a token that is converted to text, in bytes.
const MAX_SHOWN: usize = 64 << 10;

/// Everything that the thread has.
pub struct Server {
    listener: Listener,
    robot: Robot,
    rings: Vec<Consumer<u8>>,
    channels: Vec<Channel>,
    viewers: Vec<Viewer>,
    /// Number of viewers so far.
    count: u64,
    /// Time at which viewers were told that the robot is there.
    beaten: Instant,
    /// Room for a token.
    token: Vec<u8>,
    /// Ends if the process ends whose checkpoint this one was.
    pub lifeline: Option<Lifeline>,
}

impl Server {
    pub fn new(listener: Listener, robot: Robot, rings: Vec<Consumer<u8>>, channels: Vec<Channel>) -> Self {
        let (viewers, token, beaten) = (vec![], vec![], Instant::now());
        Self { listener, robot, rings, channels, viewers, count: 0, beaten, token, lifeline: None }
    }

    /// Serves viewers until the end of the program, or until it has to stop.
    pub fn run(mut self) -> Self {
        let mut batch: Vec<u8> = vec![];
        loop {
            // Loaded before the rings are read, so that all messages from before the end are seen.
            let over = self.robot.shared.over.load(Acquire);
            if self.robot.shared.stops.load(Acquire) && !over {
                return self;
            }
            self.lifeline.as_ref().inspect(|lifeline| lifeline.check());
            let mut viewers = core::mem::take(&mut self.viewers);
            self.welcome(&mut viewers);
            let mut has_more = false;
            for viewer in &mut viewers {
                has_more |= viewer.receive(&mut self.robot);
            }
            self.note_wishes(&viewers);
            self.collect(&mut batch);
            if let Some(report) = self.robot.shared.pace.as_ref().and_then(Pace::news) {
                message::write(&report, &mut batch);
            }
            self.answer(&mut viewers, &mut batch);
            self.values(&mut viewers);
            tell_beside(&mut viewers);
            self.beat(&mut batch);
            if over {
                message::write(&Report::Ended, &mut batch);
            }
            let is_quiet = batch.is_empty() && !has_more;
            for viewer in viewers.iter_mut().filter(|viewer| viewer.is_admitted) {
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
        self.robot.asking.clear();
        self.robot.shared.watched.store(false, Release);
        self.note_wishes(&[]);
        self.update_channels(&[]);
    }

    /// Stores what the viewers want to know.
    fn note_wishes(&self, viewers: &[Viewer]) {
        self.robot.shared.measured.store(viewers.iter().any(|viewer| viewer.measures), Relaxed);
        self.robot.shared.followed.store(viewers.iter().any(|viewer| viewer.follows), Relaxed);
        self.robot.shared.keeps.store(viewers.iter().any(|viewer| viewer.keeps), Relaxed);
    }

    /// Takes new viewers in. If there are too many, the one leaves that has said nothing for the longest time.
    fn welcome(&mut self, viewers: &mut Vec<Viewer>) {
        for _ in 0..MAX_VIEWERS {
            let Ok(wire) = self.listener.accept(self.count) else { return };
            let mut viewer = Viewer::new(self.count, wire);
            self.count += 1;
            if viewers.len() >= MAX_VIEWERS {
                let idle = viewers.iter_mut().max_by_key(|viewer| viewer.silence());
                match idle.filter(|viewer| viewer.silence() > IDLE) {
                    Some(idle) => idle.dismiss("others look at the robot, and this viewer has said nothing"),
                    None => {
                        viewer.dismiss(&format!("the robot has {MAX_VIEWERS} viewers, which is the maximum"));
                        continue;
                    }
                }
                self.dismiss(viewers);
            }
            if self.robot.access.token.is_none() {
                viewer.admit(&self.robot);
            }
            viewers.push(viewer);
        }
    }

    /// Passes the answers of the program on.
    fn answer(&mut self, viewers: &mut [Viewer], batch: &mut Vec<u8>) {
        for told in self.robot.asking.told() {
            match told {
                Told::All(report) => message::write(&report, batch),
                Told::One(id, report) => {
                    let viewer = viewers.iter_mut().find(|viewer| viewer.id == id);
                    viewer.into_iter().for_each(|viewer| message::write(&report, &mut viewer.out));
                }
            }
        }
    }

    /// Says from time to time that the robot is there.
    fn beat(&mut self, batch: &mut Vec<u8>) {
        if self.beaten.elapsed() >= BEAT {
            self.beaten = Instant::now();
            message::write(&self.robot.shared.alive(), batch);
        }
    }

    /// Forgets viewers that have left.
    fn dismiss(&self, viewers: &mut Vec<Viewer>) {
        if viewers.extract_if(.., |viewer| viewer.gone).count() > 0 {
            self.update_channels(viewers);
            if viewers.is_empty() {
                self.robot.shared.watched.store(false, Release);
                if let Some(pace) = &self.robot.shared.pace {
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
        match self.robot.shared.lost.swap(0, AcqRel) {
            0 => {}
            lost => message::write(&Report::Lost(lost), batch),
        }
    }

    /// Sends tokens to the viewers that asked for them.
    fn values(&mut self, viewers: &mut [Viewer]) {
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
            let gets = |viewer: &&mut Viewer| viewer.takes_tokens() && viewer.watches.iter().any(is_due);
            let due: Vec<&mut Viewer> = viewers.iter_mut().filter(gets).collect();
            let Some(report) = (!due.is_empty()).then(|| self.latest(at)).flatten() else { continue };
            for viewer in due {
                message::write(&report, &mut viewer.out);
                viewer.watches.iter_mut().filter(|watch| watch.0 == at).for_each(|watch| watch.2 = Some(now));
            }
        }
    }

    /// Takes the newest token of a channel.
    fn latest(&mut self, channel: usize) -> Option<Report> {
        let mut latest = self.robot.shared.channels[channel].latest.lock().unwrap_or_else(PoisonError::into_inner);
        if !latest.is_new {
            return None;
        }
        latest.is_new = false;
        // Only exchanged: the program finds the lock free after a moment, however long the token is.
        core::mem::swap(&mut latest.bytes, &mut self.token);
        let now = latest.now;
        drop(latest);
        let bytes = &self.token;
        let schema = self.channels[channel].schema?;
        // Images as text would be of no use, and take long.
        let text = if bytes.len() > MAX_SHOWN {
            format!("{} bytes", bytes.len())
        } else {
            (self.channels[channel].show)(bytes)?
        };
        let bytes = if schema.encoding == "cdr" && bytes.len() <= message::MAX_TOKEN { bytes.clone() } else { vec![] };
        Some(Report::Value { channel: channel as u32, now, text: shortened(text, MAX_TEXT), bytes })
    }

    fn update_channels(&self, viewers: &[Viewer]) {
        for (at, wanted) in self.robot.shared.channels.iter().enumerate() {
            let is = viewers.iter().any(|viewer| viewer.watches.iter().any(|watch| watch.0 == at));
            wanted.is.store(is, Relaxed);
        }
    }
}

/// Tells viewers of the problems beside the program that they do not know.
fn tell_beside(viewers: &mut [Viewer]) {
    for viewer in viewers.iter_mut().filter(|viewer| viewer.is_admitted) {
        let (told, new) = told_viewers(viewer.told);
        viewer.told = told;
        let reports = new.into_iter().map(|text| Report::Beside(shortened(text, MAX_PROBLEM)));
        reports.for_each(|report| message::write(&report, &mut viewer.out));
    }
}

/// Sends the last messages.
fn farewell(viewers: &mut [Viewer]) {
    let start = Instant::now();
    while viewers.iter().any(|viewer| !viewer.gone && viewer.is_behind()) && start.elapsed() < FAREWELL {
        viewers.iter_mut().for_each(Viewer::flush);
        thread::sleep(LOOK);
    }
}
