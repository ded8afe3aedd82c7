//! The connection to a robot, on a thread of its own.

use crate::{
    condition,
    journey::Journey,
    live::{Live, Run},
    outbox::Outbox,
    words::one_line,
};
use apex_rt::studio::{
    connect_until,
    message::{self, About, Command, Report},
};
use std::{
    collections::{BTreeMap, VecDeque},
    io::{BufReader, ErrorKind, Read, Write},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, atomic::AtomicBool},
    thread,
    time::{Duration, Instant},
};

/// A robot to be shown.
pub trait Robot: Send {
    /// Starts the robot, or finds it; `again` if it has to begin as it did before, from the same source. Returns the
    /// address of its socket.
    ///
    /// # Errors
    /// The robot cannot be built or started.
    fn start(&mut self, again: bool) -> Result<String, String>;

    /// `true` if it runs, as far as is known.
    fn runs(&mut self) -> bool;

    /// Ends it, if this program has started it.
    fn stop(&mut self);

    /// `true` if it is started by others, and may come back at any time.
    fn comes_back(&self) -> bool {
        false
    }

    /// `true` if it can do again what it did: it can go back in time, and a changed one repeats its run.
    fn repeats(&self) -> bool {
        !self.comes_back()
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
    fn start(&mut self, _again: bool) -> Result<String, String> {
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
/// Time between two looks at a robot that runs.
const LOOK: Duration = Duration::from_millis(5);
/// Time that a started robot has to open its socket.
const PATIENCE: Duration = Duration::from_secs(20);

/// State that the connection and the pages share.
#[derive(Default)]
pub struct Shared {
    live: Mutex<Live>,
    /// The last runs before this one, of which one was replaced by the next.
    earlier: Mutex<VecDeque<Earlier>>,
    link: Mutex<Link>,
    changed: Condvar,
}

/// A run that is over.
pub type Earlier = Arc<Mutex<Live>>;

/// Number of runs that are kept after their end.
const MAX_EARLIER: usize = 4;

#[derive(Default)]
struct Link {
    wire: Option<Outbox>,
    /// Number of pages that watch each channel.
    watches: BTreeMap<u32, usize>,
    /// Number of pages that want calls to be measured.
    measures: usize,
    restart: bool,
    /// Condition at which the robot halts, also in the next run.
    stop: String,
    /// The way to the state that the next run begins with.
    journey: Option<Journey>,
    /// Parameters that the next run begins with, if it does not repeat this one, and those that are to be set at once.
    sets: VecDeque<(String, String)>,
    /// Number of those that the robot has not answered yet.
    unanswered: usize,
    /// `true` if the robot was told to go back to a checkpoint.
    returns: bool,
    over: bool,
}

/// Number of parameters that are set at once.
const MAX_UNANSWERED: usize = 32;
/// Interval at which a robot is told that the studio is there.
const BEAT: Duration = Duration::from_secs(1);
/// Interval in ms at which tokens are asked for.
const EVERY: u32 = 30;

pub fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    pub fn live(&self) -> MutexGuard<'_, Live> {
        locked(&self.live)
    }

    /// The last runs before this one, in sequence.
    pub fn earlier(&self) -> Vec<Earlier> {
        locked(&self.earlier).iter().cloned().collect()
    }

    /// Takes note of a message. A run that was replaced by the next one can still be looked at.
    fn note(&self, report: Report) {
        let Report::About(about) = report else { return self.live().note(report) };
        let last = self.live().begin(about);
        if last.reactions > 0 {
            let mut earlier = locked(&self.earlier);
            earlier.push_back(Arc::new(Mutex::new(last)));
            if earlier.len() > MAX_EARLIER {
                earlier.pop_front();
            }
        }
    }

    /// Sends a command to the robot, if there is one.
    pub fn tell(&self, command: &Command) {
        locked(&self.link).tell(command);
    }

    /// Sets parameters, however many.
    pub fn set_all(&self, values: Vec<(String, String)>) {
        let mut link = locked(&self.link);
        link.sets.extend(values);
        link.set_some();
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

    /// Lets calls be measured on behalf of one page, or no longer.
    pub fn measure(&self, wanted: bool) {
        let mut link = locked(&self.link);
        link.measures = if wanted { link.measures + 1 } else { link.measures.saturating_sub(1) };
        let measures = link.measures > 0;
        link.tell(&Command::Measure(measures));
    }

    /// Lets the robot halt whenever a condition becomes true.
    ///
    /// # Errors
    /// The text is not a condition, or there is no robot yet.
    pub fn halt_when(&self, condition: &str) -> Result<(), String> {
        let about = self.live().about.clone().ok_or("there is no robot yet")?;
        let tests = condition::parse(condition, &about)?;
        let mut link = locked(&self.link);
        condition.clone_into(&mut link.stop);
        link.tell(&Command::Break(tests));
        Ok(())
    }

    /// Lets the robot be started again.
    pub fn restart(&self) {
        locked(&self.link).restart = true;
        self.changed.notify_all();
    }

    /// Goes to the state after this number of reactions: if it is in the past, from a checkpoint or by a new run.
    pub fn travel(&self, goal: u64) {
        let mut live = self.live();
        if goal >= live.reactions {
            drop(live);
            self.tell(&Command::RunTo { reactions: goal });
            return;
        }
        let (journey, returns) = (Journey::of(&live, goal), live.has_checkpoint(goal));
        live.depart();
        drop(live);
        let mut link = locked(&self.link);
        link.journey = Some(journey);
        (link.returns, link.restart) = (returns, !returns);
        if returns {
            link.tell(&Command::GoBack { reactions: goal });
        }
        self.changed.notify_all();
    }

    /// Goes to the state at a time in ns. A time that nothing is known about lies ahead: the robot runs up to it.
    pub fn go_to(&self, time: i64) {
        let live = self.live();
        let (is_unknown, goal) = (live.is_unknown(time), live.reactions_until(time));
        drop(live);
        if is_unknown {
            self.tell(&Command::RunUntil { now: time });
        } else {
            self.travel(goal);
        }
    }

    /// Starts the robot again if it should have gone back to a checkpoint.
    fn has_no_checkpoint(&self) {
        let mut link = locked(&self.link);
        if std::mem::take(&mut link.returns) {
            link.restart = true;
        }
    }

    /// Lets the next run begin with the parameters of this one.
    fn begin_changed(&self) {
        let sets = self.live().changed().map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
        let mut link = locked(&self.link);
        (link.sets, link.restart) = (sets, true);
    }

    /// Lets the next run, of a changed robot, do what this one did, if that can be repeated.
    fn repeat_changed(&self) {
        let mut live = self.live();
        let journey = live.about.as_ref().is_some_and(|about| about.simulated).then(|| Journey::of_changed(&live));
        if journey.is_some() {
            live.depart();
        }
        drop(live);
        let mut link = locked(&self.link);
        (link.journey, link.returns, link.restart) = (journey, false, true);
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
        if let Some(wire) = &self.wire {
            wire.put(command);
        }
    }

    /// Sets some of the parameters that wait for it: a robot has room for so many.
    fn set_some(&mut self) {
        while self.unanswered < MAX_UNANSWERED
            && let Some((name, value)) = self.sets.pop_front()
        {
            self.unanswered += 1;
            self.tell(&Command::Set { name, value });
        }
    }

    /// A parameter was set, or refused.
    fn is_answered(&mut self) {
        self.unanswered = self.unanswered.saturating_sub(1);
        self.set_some();
    }
}

/// Follows a robot until [`end`](Shared::end): starts it, takes note of its messages, and waits for a restart.
pub fn follow(robot: &mut dyn Robot, shared: &Arc<Shared>, mut speed: Option<f64>) {
    while !shared.is_over() {
        if !robot.comes_back() {
            shared.set(Run::Starting("building".to_owned()));
        }
        let journey = locked(&shared.link).journey.take();
        {
            let (mut live, repeats) = (shared.live(), journey.is_some());
            (live.repeats, live.travels) = (repeats, repeats);
        }
        match robot.start(journey.as_ref().is_some_and(|journey| !journey.is_of_changed())) {
            Ok(address) => {
                let travels = robot.repeats();
                let mut way = Way { travels, journey, returns: false };
                while let Some(next) = run(robot, &address, shared, &mut speed, way) {
                    way = Way { travels, journey: Some(next), returns: true };
                }
            }
            Err(error) => shared.set(Run::Lost(error)),
        }
        robot.stop();
        wait_for_restart(robot, shared);
    }
}

/// The begin of a connection.
struct Way {
    /// `true` if the robot can go back in time.
    travels: bool,
    journey: Option<Journey>,
    /// `true` if the robot is at one of its checkpoints.
    returns: bool,
}

/// Takes note of what a robot does until the connection ends. If the robot has gone back to a checkpoint, returns the
/// way from there.
fn run(
    robot: &mut dyn Robot,
    address: &str,
    shared: &Arc<Shared>,
    speed: &mut Option<f64>,
    way: Way,
) -> Option<Journey> {
    let closed = Arc::<AtomicBool>::default();
    let (from, to) = connection(robot, address, shared, &closed)?;
    let to = Outbox::new(to, closed).map_err(|error| shared.set(Run::Lost(format!("no thread: {error}")))).ok()?;
    {
        let mut link = locked(&shared.link);
        (link.wire, link.unanswered) = (Some(to), 0);
    }
    shared.live().readonly = false;
    let mut reader = thread::scope(|scope| {
        let reader = scope.spawn(|| read(from, shared, *speed, way));
        let mut told = Instant::now();
        while !reader.is_finished() {
            let has_changed = changes(robot, shared);
            if shared.is_over() || has_changed || locked(&shared.link).restart {
                robot.stop();
                let wire = locked(&shared.link).wire.take();
                wire.inspect(Outbox::close);
            }
            if told.elapsed() > BEAT {
                told = Instant::now();
                shared.tell(&Command::Alive);
            }
            thread::sleep(LOOK);
        }
        reader.join().unwrap_or_else(|_| Err("the connection has failed".to_owned()))
    });
    let mut link = locked(&shared.link);
    if link.wire.take().is_some_and(|wire| wire.is_deaf()) {
        reader = Err("the robot takes no commands: it stands still, or the connection does".to_owned());
    }
    let goes_back = std::mem::take(&mut link.returns) && !link.restart && !link.over;
    let journey = if goes_back { link.journey.take() } else { None };
    drop(link);
    let mut live = shared.live();
    // The speed that somebody has chosen holds for the next run.
    if speed.is_some() && live.speed.is_finite() {
        *speed = Some(live.speed);
    }
    if live.run != Run::Ended && journey.is_none() {
        live.end(Run::Lost(reader.err().unwrap_or_else(|| "the robot has broken off".to_owned())));
    }
    journey
}

fn connection(
    robot: &mut dyn Robot,
    address: &str,
    shared: &Shared,
    closed: &Arc<AtomicBool>,
) -> Option<(Box<dyn Read + Send>, Box<dyn Write + Send>)> {
    // What an earlier run has shown, or why it was lost, stays until there is a new one.
    let is_first = matches!(shared.live().run, Run::Starting(_));
    if is_first {
        // The socket of a robot that was started here has a name that says nothing.
        let what = if robot.comes_back() { format!("connecting to {address}") } else { "starting".to_owned() };
        shared.set(Run::Starting(what));
    }
    let start = Instant::now();
    loop {
        match connect_until(address, Arc::clone(closed)) {
            Ok(wires) => return Some(wires),
            Err(error) if !robot.comes_back() && (start.elapsed() > PATIENCE || !robot.runs()) => {
                shared.set(Run::Lost(format!("the robot has not opened its socket: {error}")));
                return None;
            }
            Err(_) if shared.is_over() => return None,
            Err(_) => thread::sleep(RETRY),
        }
    }
}

/// Reads messages until the connection ends, and guides the robot on its journey.
fn read(from: Box<dyn Read + Send>, shared: &Shared, speed: Option<f64>, way: Way) -> Result<(), String> {
    let mut from = BufReader::with_capacity(1 << 16, from);
    let Way { travels, mut journey, mut returns } = way;
    let mut has_begun = false;
    let mut wants = Wants { travels, params: 0, speed: speed.filter(|_| journey.is_none()) };
    while let Some(report) = next(&mut from)? {
        match &report {
            Report::About(about) => {
                is_readable(about)?;
                wants.params = about.params.len();
                // One without memory says so again for those who come later.
                if returns || (has_begun && shared.live().about.as_deref() == Some(about)) {
                    continue;
                }
                has_begun = true;
                let first = journey.as_mut().and_then(|journey| journey.begin(wants.params));
                greet(shared, about, &wants, first);
            }
            // The history knows who is active at the checkpoint.
            Report::Active(_) if returns => continue,
            Report::Pace { reactions, .. } if returns => {
                returns = false;
                let mut rest = journey.take().map(|journey| journey.rest_from(*reactions));
                if !shared.live().go_back(*reactions) {
                    shared.restart();
                    return Ok(());
                }
                let first = rest.as_mut().and_then(|journey| journey.begin(wants.params));
                journey = rest;
                let about = shared.live().about.clone();
                about.inspect(|about| greet(shared, about, &wants, first));
            }
            Report::NoCheckpoints(_) => shared.has_no_checkpoint(),
            Report::Param { reactions: Some(_), .. } => locked(&shared.link).is_answered(),
            Report::Dismissed(why) => return Err(one_line(why)),
            _ => {}
        }
        if let Some(command) = journey.as_mut().and_then(|journey| journey.after(&report)) {
            shared.tell(&command);
        } else if let Some(ended) = journey.take_if(|journey| journey.ends(&report)) {
            ended.last().inspect(|command| shared.tell(command));
            shared.live().travels = false;
        }
        shared.note(report);
    }
    Ok(())
}

/// Reads the next message. Returns `None` at the end of the connection.
fn next(from: &mut BufReader<Box<dyn Read + Send>>) -> Result<Option<Report>, String> {
    match message::read::<Report>(from) {
        Ok(report) => Ok(report),
        // It was killed in the middle of a message.
        Err(error) if matches!(error.kind(), ErrorKind::UnexpectedEof | ErrorKind::ConnectionReset) => Ok(None),
        Err(error) => Err(error.to_string()),
    }
}

fn is_readable(about: &About) -> Result<(), String> {
    if about.version == message::VERSION {
        return Ok(());
    }
    Err(format!(
        "the robot sends version {} of its messages, and this program reads {}: build both with the same version of Apex",
        about.version,
        message::VERSION
    ))
}

/// Wishes for a new robot, besides those of the pages.
struct Wants {
    /// `true` if it may go back in time.
    travels: bool,
    /// Number of its parameters.
    params: usize,
    /// Speed at which it starts.
    speed: Option<f64>,
}

/// Sends what a new robot has to know.
fn greet(shared: &Shared, about: &About, wants: &Wants, first: Option<Command>) {
    let mut link = locked(&shared.link);
    link.tell(&Command::Params);
    link.tell(&Command::Follow(true));
    link.tell(&Command::Keep(wants.travels && about.simulated));
    let channels: Vec<u32> = link.watches.keys().copied().collect();
    channels.into_iter().for_each(|channel| link.tell(&Command::Watch { channel, every: EVERY }));
    let measures = link.measures > 0;
    link.tell(&Command::Measure(measures));
    // Nodes may have other numbers now; a condition on nodes that are gone is void.
    let stop = condition::parse(&link.stop, about).unwrap_or_default();
    link.tell(&Command::Break(stop));
    link.set_some();
    let start = wants.speed.map(|speed| Command::Run { speed });
    start.into_iter().chain(first).for_each(|command| link.tell(&command));
}

/// Prepares the next run if the robot has changed. Returns `true` if it has.
fn changes(robot: &mut dyn Robot, shared: &Shared) -> bool {
    let has_changed = robot.has_changed();
    match robot.repeats() {
        _ if !has_changed => {}
        true => shared.repeat_changed(),
        false => shared.begin_changed(),
    }
    has_changed
}

/// Waits until the robot is to be started again.
fn wait_for_restart(robot: &mut dyn Robot, shared: &Shared) {
    loop {
        let mut link = locked(&shared.link);
        if link.over || std::mem::take(&mut link.restart) {
            return;
        }
        drop(shared.changed.wait_timeout(link, 4 * RETRY).unwrap_or_else(PoisonError::into_inner));
        if robot.comes_back() {
            return;
        }
        changes(robot, shared);
    }
}
