//! A connected viewer.

use super::{
    access::Access,
    message::{self, Command, Frames, Report},
    robot::Robot,
    shared::Pace,
    socket::Wire,
};
use core::time::Duration;
use std::{
    boxed::Box,
    io,
    string::{String, ToString as _},
    time::Instant,
    vec,
    vec::Vec,
};

/// Number of bytes that may wait for a viewer. One that is slower is disconnected.
const BACKLOG: usize = 16 << 20;
/// Number of waiting bytes above which a viewer gets no token: it gets the newest one when it has caught up.
const BEHIND: usize = 1 << 20;
/// Number of bytes that are read, and of commands that are obeyed, before the next viewer has its turn.
const TURN_BYTES: usize = 256 << 10;
const TURN_COMMANDS: usize = 256;
/// Time in which a viewer has to say something for the first time.
const GREETING: Duration = Duration::from_secs(10);
/// Maximum number of tests in a condition, which are evaluated in every reaction.
const MAX_TESTS: usize = 1000;

/// A connected viewer.
pub struct Viewer {
    pub id: u64,
    /// Its address.
    pub name: String,
    wire: Box<dyn Wire>,
    /// Bytes of commands that have come.
    came: Frames,
    /// Bytes for the socket, and the number of those that it has taken.
    pub out: Vec<u8>,
    sent: usize,
    /// Interval of each channel that it asked for, and the time of its last token.
    pub watches: Vec<(usize, Duration, Option<Instant>)>,
    /// Number of problems beside the program that it was told.
    pub told: u64,
    /// `true` if it wants calls to be measured.
    pub measures: bool,
    /// `true` if it wants to know of every token.
    pub follows: bool,
    /// `true` if it wants checkpoints.
    pub keeps: bool,
    /// `true` if it has shown the token, or needs none.
    pub is_admitted: bool,
    /// Time at which it has come, until it says something.
    silent_since: Option<Instant>,
    /// Time at which it has said something for the last time.
    heard: Instant,
    /// `true` after an error or the end of its commands.
    pub gone: bool,
}

impl Viewer {
    pub fn new(id: u64, (name, wire): (String, Box<dyn Wire>)) -> Self {
        let now = Instant::now();
        Self {
            id,
            name,
            wire,
            came: Frames::default(),
            out: vec![],
            sent: 0,
            watches: vec![],
            told: 0,
            measures: false,
            follows: false,
            keeps: false,
            is_admitted: false,
            silent_since: Some(now),
            heard: now,
            gone: false,
        }
    }

    /// Time for which it has said nothing.
    pub fn silence(&self) -> Duration {
        self.heard.elapsed()
    }

    /// Admits it, and describes the robot to it.
    pub fn admit(&mut self, robot: &Robot) {
        if !core::mem::replace(&mut self.is_admitted, true) {
            robot.introduce(&mut self.out);
        }
    }

    /// Tells it why it has to leave.
    pub fn dismiss(&mut self, why: &str) {
        message::write(&Report::Dismissed(why.to_string()), &mut self.out);
        self.flush();
        self.gone = true;
    }

    /// Obeys commands that have come. Returns `true` if there are more.
    pub fn receive(&mut self, robot: &mut Robot) -> bool {
        self.read();
        let has_more = self.obey_all(robot);
        if self.silent_since.is_some_and(|since| since.elapsed() > GREETING) {
            self.dismiss("a viewer has to say something when it has come");
        }
        has_more && !self.gone
    }

    fn read(&mut self) {
        let (mut bytes, before) = ([0; 4096], self.came.waiting());
        while self.came.waiting() <= message::MAX_BYTES && self.came.waiting() < before + TURN_BYTES {
            match self.wire.read(&mut bytes) {
                Ok(0) => {
                    self.gone = true;
                    return;
                }
                Ok(count) => self.came.extend(&bytes[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.gone |= error.kind() != io::ErrorKind::WouldBlock;
                    return;
                }
            }
        }
    }

    /// Obeys some commands. Returns `true` if there are more.
    fn obey_all(&mut self, robot: &mut Robot) -> bool {
        for _ in 0..TURN_COMMANDS {
            match self.came.take() {
                Ok(Some(command)) => self.hear(command, robot),
                Ok(None) => return false,
                Err(_) => {
                    self.gone = true;
                    return false;
                }
            }
        }
        self.came.is_ready()
    }

    fn hear(&mut self, command: Command, robot: &mut Robot) {
        (self.heard, self.silent_since) = (Instant::now(), None);
        match command {
            Command::Token(token) if robot.access.admits(&token) => self.admit(robot),
            command if self.is_admitted => self.obey(command, robot),
            _ => self.dismiss(&Access::refusal()),
        }
    }

    fn obey(&mut self, command: Command, robot: &mut Robot) {
        if robot.access.readonly && command.acts() {
            if let Command::Set { name, .. } = command {
                let value = Err(std::format!("`{name}` keeps its value: viewers of this robot may only look"));
                message::write(&Report::Param { name, value, reactions: Some(0) }, &mut self.out);
            }
            return;
        }
        match command {
            Command::Watch { channel, every } => {
                let channel = channel as usize;
                self.watches.retain(|watch| watch.0 != channel);
                if every > 0 && channel < robot.shared.channels.len() {
                    self.watches.push((channel, Duration::from_millis(every.into()), None));
                }
            }
            Command::Measure(measures) => self.measures = measures,
            Command::Follow(follows) => self.follows = follows,
            Command::Keep(keeps) => {
                self.keeps = keeps;
                // Before the next command, which may let the program run.
                robot.shared.keeps.fetch_or(keeps, core::sync::atomic::Ordering::Relaxed);
            }
            Command::Params => robot.asking.read_all(),
            Command::Set { name, value } => {
                if let Some(answer) = robot.asking.set((self.id, &self.name), &name, &value) {
                    message::write(&answer, &mut self.out);
                }
            }
            Command::Alive | Command::Token(_) => {}
            Command::Break(tests) if tests.len() > MAX_TESTS => {}
            pace => {
                if let Some(state) = &robot.shared.pace {
                    Pace::obey(state, &pace, &robot.shared.active);
                }
            }
        }
    }

    /// Number of bytes that wait for its socket.
    fn waiting(&self) -> usize {
        self.out.len() - self.sent
    }

    /// `true` if bytes wait for its socket.
    pub fn is_behind(&self) -> bool {
        self.waiting() > 0
    }

    /// `true` if there is room for another token.
    pub fn takes_tokens(&self) -> bool {
        self.waiting() <= BEHIND
    }

    /// Writes as much as the socket takes.
    pub fn flush(&mut self) {
        while self.sent < self.out.len() && !self.gone {
            match self.wire.write(&self.out[self.sent..]) {
                Ok(count) => self.sent += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                Err(_) => self.gone = true,
            }
        }
        self.gone |= self.waiting() > BACKLOG;
        // Each byte is moved at most once for each that has been sent, however much waits.
        if self.sent > self.out.len() / 2 {
            self.out.drain(..self.sent);
            self.sent = 0;
        }
    }
}
