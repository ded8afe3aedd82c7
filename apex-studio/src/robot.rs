//! The connection to a robot, on a thread of its own.

use crate::live::{Live, Run};
use apex_rt::studio::{
    Wire, connect,
    message::{self, Command, Report},
};
use std::{
    collections::BTreeMap,
    io::{BufReader, Write as _},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread,
    time::{Duration, Instant},
};

/// A robot to be shown.
pub trait Robot: Send {
    /// Starts the robot, or finds it. Returns the address of its socket.
    ///
    /// # Errors
    /// The robot cannot be built or started.
    fn start(&mut self) -> Result<String, String>;

    /// `true` if it runs, as far as is known.
    fn runs(&mut self) -> bool;

    /// Ends it, if this program has started it.
    fn stop(&mut self);

    /// `true` if it is started by others, and may come back at any time.
    fn comes_back(&self) -> bool {
        false
    }

    /// `true` if a new robot should take its place, because its source has changed.
    fn has_changed(&mut self) -> bool {
        false
    }
}

/// A robot that runs elsewhere.
pub struct Remote {
    /// Address of its socket.
    pub address: String,
}

impl Robot for Remote {
    fn start(&mut self) -> Result<String, String> {
        Ok(self.address.clone())
    }

    fn runs(&mut self) -> bool {
        true
    }

    fn stop(&mut self) {}

    fn comes_back(&self) -> bool {
        true
    }
}

/// Time between two attempts to connect.
const RETRY: Duration = Duration::from_millis(50);
/// Time that a started robot has to open its socket.
const PATIENCE: Duration = Duration::from_secs(20);

/// State that the connection and the pages share.
#[derive(Default)]
pub struct Shared {
    live: Mutex<Live>,
    link: Mutex<Link>,
    changed: Condvar,
}

#[derive(Default)]
struct Link {
    wire: Option<Box<dyn Wire>>,
    /// Number of pages that watch each channel.
    watches: BTreeMap<u32, usize>,
    restart: bool,
    over: bool,
}

/// Interval in ms at which tokens are asked for.
const EVERY: u32 = 30;

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    pub fn live(&self) -> MutexGuard<'_, Live> {
        locked(&self.live)
    }

    /// Sends a command to the robot, if there is one.
    pub fn tell(&self, command: &Command) {
        locked(&self.link).tell(command);
    }

    /// Asks for the tokens of a channel.
    pub fn watch(&self, channel: u32) {
        let mut link = locked(&self.link);
        let count = link.watches.entry(channel).or_default();
        *count += 1;
        if *count == 1 {
            link.tell(&Command::Watch { channel, every: EVERY });
        }
    }

    /// Asks no longer for the tokens of a channel, on behalf of one page.
    pub fn unwatch(&self, channel: u32) {
        let mut link = locked(&self.link);
        let Some(count) = link.watches.get_mut(&channel) else { return };
        *count -= 1;
        if *count == 0 {
            link.watches.remove(&channel);
            link.tell(&Command::Watch { channel, every: 0 });
        }
    }

    /// Lets the robot be started again.
    pub fn restart(&self) {
        locked(&self.link).restart = true;
        self.changed.notify_all();
    }

    /// Ends the connection for good.
    pub fn end(&self) {
        locked(&self.link).over = true;
        self.changed.notify_all();
    }

    fn set(&self, run: Run) {
        self.live().run = run;
    }

    fn is_over(&self) -> bool {
        locked(&self.link).over
    }
}

impl Link {
    fn tell(&mut self, command: &Command) {
        let mut bytes = vec![];
        message::write(command, &mut bytes);
        if let Some(wire) = &mut self.wire
            && wire.write_all(&bytes).is_err()
        {
            self.wire = None;
        }
    }
}

/// Follows a robot until [`end`](Shared::end): starts it, takes note of its messages, and waits for a restart.
pub fn follow(mut robot: impl Robot, shared: &Arc<Shared>, mut speed: Option<f64>) {
    while !shared.is_over() {
        if !robot.comes_back() {
            shared.set(Run::Starting("building".to_owned()));
        }
        match robot.start() {
            Ok(address) => run(&mut robot, &address, shared, &mut speed),
            Err(error) => shared.set(Run::Lost(error)),
        }
        robot.stop();
        wait_for_restart(&mut robot, shared);
    }
}

/// Takes note of one run.
fn run(robot: &mut impl Robot, address: &str, shared: &Arc<Shared>, speed: &mut Option<f64>) {
    let Some((from, to)) = connection(robot, address, shared) else { return };
    locked(&shared.link).wire = Some(to);
    let reader = thread::scope(|scope| {
        let reader = scope.spawn(|| read(from, shared, *speed));
        while !reader.is_finished() {
            if shared.is_over() || locked(&shared.link).restart || robot.has_changed() {
                robot.stop();
                locked(&shared.link).wire = None;
            }
            thread::sleep(RETRY);
        }
        reader.join().unwrap_or_else(|_| Err("the connection has failed".to_owned()))
    });
    locked(&shared.link).wire = None;
    let mut live = shared.live();
    // The speed that somebody has chosen holds for the next run.
    if speed.is_some() && live.speed.is_finite() {
        *speed = Some(live.speed);
    }
    if live.run == Run::Running {
        live.run = Run::Lost(reader.err().unwrap_or_else(|| "the robot has broken off".to_owned()));
    }
}

fn connection(robot: &mut impl Robot, address: &str, shared: &Shared) -> Option<(Box<dyn Wire>, Box<dyn Wire>)> {
    // What an earlier run has shown stays until there is a new one.
    if !robot.comes_back() || shared.live().runs == 0 {
        shared.set(Run::Starting(format!("connecting to {address}")));
    }
    let start = Instant::now();
    loop {
        match connect(address) {
            Ok(wires) => return Some(wires),
            Err(error) if !robot.comes_back() && (start.elapsed() > PATIENCE || !robot.runs()) => {
                shared.set(Run::Lost(format!("cannot connect to {address}: {error}")));
                return None;
            }
            Err(_) if shared.is_over() => return None,
            Err(_) => thread::sleep(RETRY),
        }
    }
}

/// Reads messages until the connection ends.
fn read(from: Box<dyn Wire>, shared: &Shared, speed: Option<f64>) -> Result<(), String> {
    let mut from = BufReader::with_capacity(1 << 16, from);
    let mut is_first = true;
    loop {
        match message::read::<Report>(&mut from) {
            Ok(Some(Report::About(about))) if about.version != message::VERSION => {
                return Err(format!(
                    "the robot sends version {} of its messages, and this program reads {}: build both with the same version of Apex",
                    about.version,
                    message::VERSION
                ));
            }
            Ok(Some(report)) => {
                shared.live().note(report);
                if std::mem::take(&mut is_first) {
                    greet(shared, speed);
                }
            }
            Ok(None) => return Ok(()),
            Err(error) => return Err(error.to_string()),
        }
    }
}

/// Sends what a new robot has to know.
fn greet(shared: &Shared, speed: Option<f64>) {
    let mut link = locked(&shared.link);
    link.tell(&Command::Params);
    let channels: Vec<u32> = link.watches.keys().copied().collect();
    channels.into_iter().for_each(|channel| link.tell(&Command::Watch { channel, every: EVERY }));
    if let Some(speed) = speed {
        link.tell(&Command::Run { speed });
    }
}

/// Waits until the robot is to be started again.
fn wait_for_restart(robot: &mut impl Robot, shared: &Shared) {
    loop {
        let mut link = locked(&shared.link);
        if link.over || std::mem::take(&mut link.restart) {
            return;
        }
        drop(shared.changed.wait_timeout(link, 4 * RETRY).unwrap_or_else(PoisonError::into_inner));
        if robot.comes_back() || robot.has_changed() {
            return;
        }
    }
}
