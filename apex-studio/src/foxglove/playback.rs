//! The time of a robot, as far as an app controls it.

use super::{
    messages::{Control, Frame, Moment, State, Status, nanos},
    seen::Seen,
};
use crate::{
    lane::limited,
    live::{Live, Run},
};
use apex_rt::studio::message::Command;

/// Time in ns that a simulation has on the time bar of an app, at least: it has no end.
const SPAN: i64 = 3_600_000_000_000;

/// Knowledge of an app about the time, and its wishes.
#[derive(Default)]
pub struct Playback {
    /// Number of times that the run of the app went back.
    returns: u64,
    /// The state that the app knows.
    known: Option<(Status, f32)>,
    /// Time that the app knows, in ns.
    now: u64,
    /// Speed that the app has chosen while the robot was halted.
    speed: Option<f32>,
    way: Option<Way>,
}

/// A way to another time, on which the robot is.
struct Way {
    /// Counters of ways before it. That the robot is halted says nothing: it may not have begun.
    from: Ends,
    /// `true` if the robot goes on at the end.
    plays: bool,
}

/// `true` if an app may control the time of the robot.
pub fn is_controlled(seen: &Seen, live: &Live) -> bool {
    !seen.readonly && live.about.as_ref().is_some_and(|about| about.simulated)
}

/// Returns the times of the first and last token, as far as they are known.
pub fn range(seen: &Seen, live: &Live) -> (Moment, Moment) {
    let (first, last) = match seen.replayed.as_ref().and_then(|replayed| replayed.range) {
        Some(range) => range,
        None => (0, SPAN.max(2 * live.now)),
    };
    (Moment::new(first), Moment::new(last))
}

/// Numbers of runs, of their returns to checkpoints, and of ways that are over. A way changes one of them at its end.
type Ends = (u64, u64, u64);

fn ends(live: &Live) -> Ends {
    (live.runs, live.returns, live.ways)
}

impl Playback {
    /// Obeys an app.
    pub fn obey(&mut self, seen: &Seen, control: Control) -> Vec<Frame> {
        let Control { plays, speed, seek, id } = control;
        let live = seen.shared.live();
        if !is_controlled(seen, &live) {
            return vec![Frame::error("the time of this robot cannot be controlled")];
        }
        if live.travels {
            return vec![Frame::error("the robot repeats its run, and obeys nobody meanwhile")];
        }
        let target = seek.map(|time| limited(i64::try_from(time).unwrap_or(i64::MAX)));
        if target.is_some_and(|target| target < live.now) && !seen.travels {
            return vec![Frame::error("this robot cannot go back in time")];
        }
        let from = ends(&live);
        drop(live);
        self.speed = Some(speed);
        if let Some(target) = target {
            self.way = Some(Way { from, plays });
            seen.shared.go_to(target);
        } else if plays {
            self.way = None;
            seen.shared.tell(&Command::Run { speed: speed.into() });
        } else {
            self.way = None;
            seen.shared.tell(&Command::Pause);
        }
        let status = match (target, plays) {
            (Some(_), _) => Status::Travels,
            (None, true) => Status::Plays,
            (None, false) => Status::Halted,
        };
        let now = target.map_or(self.now, nanos);
        self.known = Some((status, speed));
        vec![Frame::Playback(State { status, now, speed, jumped: target.is_some(), id })]
    }

    /// Returns what has changed.
    pub fn news(&mut self, seen: &Seen, live: &Live) -> Vec<Frame> {
        let mut news = vec![];
        let has_arrived = |way: &Way| !live.travels && way.from != ends(live);
        if let Some(way) = self.way.take_if(|way| has_arrived(way) || live.run == Run::Ended)
            && way.plays
        {
            seen.shared.tell(&Command::Run { speed: self.speed.unwrap_or(1.0).into() });
        }
        let jumped = std::mem::replace(&mut self.returns, live.returns) != live.returns;
        let state = (self.status(live), self.speed(live));
        if is_controlled(seen, live) && (jumped || self.known != Some(state)) {
            self.known = Some(state);
            let (status, speed) = state;
            news.push(Frame::Playback(State { status, now: nanos(live.now), speed, jumped, id: String::new() }));
        }
        if !self.travels(live) && std::mem::replace(&mut self.now, nanos(live.now)) != nanos(live.now) {
            news.push(Frame::Time(self.now));
        }
        news
    }

    /// `true` while the robot is on its way to another time.
    pub fn travels(&self, live: &Live) -> bool {
        live.travels || self.way.is_some()
    }

    fn status(&self, live: &Live) -> Status {
        match live.run {
            _ if self.travels(live) => Status::Travels,
            Run::Ended | Run::Lost(_) => Status::Ended,
            Run::Starting(_) => Status::Travels,
            Run::Running if live.paused => Status::Halted,
            Run::Running => Status::Plays,
        }
    }

    /// The speed of the robot, or the one at which it will go on.
    fn speed(&self, live: &Live) -> f32 {
        let chosen = self.speed.filter(|_| live.paused || self.travels(live));
        chosen.unwrap_or(live.speed as f32)
    }
}
