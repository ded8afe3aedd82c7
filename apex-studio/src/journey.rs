//! A way back in time: the robot goes back to a checkpoint or is started again, and does the same from there up to a
//! point, because programs are deterministic.

use crate::live::{Live, Run};
use apex_rt::studio::message::{Command, Report};
use std::collections::{BTreeMap, VecDeque};

/// A repetition of a run up to a point.
pub struct Journey {
    /// Parameters to be set, with the points at which they were set.
    sets: VecDeque<(u64, String, String)>,
    goal: u64,
    /// Values of the parameters at the beginning of the run.
    initial: BTreeMap<String, String>,
    /// Number of parameters whose values are not known yet.
    unknown: usize,
    /// Times of the points, if they are not numbers of reactions: a changed robot may react more often, or less.
    times: Option<Times>,
    /// Speed at which it goes on at the end.
    speed: Option<f64>,
}

/// Times in ns of the points of a journey.
struct Times {
    /// Those of the reactions after the points at which parameters were set.
    sets: BTreeMap<u64, i64>,
    /// A time after the last reaction.
    end: i64,
}

impl Journey {
    /// A journey to the state after `goal` reactions of a run.
    pub fn of(live: &Live, goal: u64) -> Self {
        let settable = live.params.iter().filter(|(_, param)| !param.fixed);
        let initial = settable.map(|(name, param)| (name.clone(), param.initial.clone())).collect();
        Self { initial, ..Self::along(live, goal) }
    }

    /// A journey of a robot whose source has changed, to the time of this run, where it goes on if this one did.
    pub fn of_changed(live: &Live) -> Self {
        let speed = (!live.paused && live.run == Run::Running).then_some(live.speed);
        let sets = live.sets.iter().filter_map(|(at, ..)| Some((*at, live.steps.time_of(*at)?))).collect();
        let times = Times { sets, end: if live.reactions > 0 { live.now + 1 } else { 0 } };
        Self { times: Some(times), speed, ..Self::along(live, live.reactions) }
    }

    /// The rest of the journey of a robot that goes back to a checkpoint with `reactions` reactions before it.
    pub fn rest_from(mut self, reactions: u64) -> Self {
        self.sets.retain(|(at, ..)| *at >= reactions);
        self.initial.clear();
        self
    }

    fn along(live: &Live, goal: u64) -> Self {
        let sets = live.sets.iter().filter(|(at, ..)| *at <= goal).cloned().collect();
        Self { sets, goal, initial: BTreeMap::new(), unknown: 0, times: None, speed: None }
    }

    /// Begins with a robot that has told its values of `params` parameters, or will.
    pub fn begin(&mut self, params: usize) -> Option<Command> {
        self.unknown = params;
        (params == 0).then(|| self.forth())
    }

    /// The command after a message of the robot. Returns `None` while it works on the last one.
    pub fn after(&mut self, report: &Report) -> Option<Command> {
        match report {
            // The values that the program starts with; those of the run may have been others.
            Report::Param { name, value, reactions: None } => {
                let other = self.initial.remove(name).filter(|initial| value.as_ref().is_ok_and(|v| v != initial));
                self.sets.extend(other.map(|value| (0, name.clone(), value)));
                self.unknown = self.unknown.saturating_sub(1);
                if self.unknown > 0 {
                    return None;
                }
                self.sets.make_contiguous().sort_by_key(|(at, ..)| *at);
                Some(self.forth())
            }
            Report::Pace { paused: true, reactions, .. } if self.unknown == 0 => {
                let is_there = |at: u64| if self.times.is_some() { has_gone(at, *reactions) } else { at <= *reactions };
                if self.sets.front().is_none_or(|(at, ..)| !is_there(*at)) {
                    return None;
                }
                let (_, name, value) = self.sets.pop_front()?;
                Some(Command::Set { name, value })
            }
            Report::Param { .. } => Some(self.forth()),
            _ => None,
        }
    }

    /// `true` if a message says that it is at its end.
    pub fn ends(&self, report: &Report) -> bool {
        let is_goal = |reactions: u64| match self.times {
            Some(_) => has_gone(self.goal, reactions),
            None => reactions >= self.goal,
        };
        let is_there = matches!(report, Report::Pace { paused: true, reactions, .. } if is_goal(*reactions));
        is_there && self.unknown == 0 && self.sets.is_empty()
    }

    /// `true` if the source of the robot has changed.
    pub fn is_of_changed(&self) -> bool {
        self.times.is_some()
    }

    /// The command at its end.
    pub fn last(&self) -> Option<Command> {
        self.speed.map(|speed| Command::Run { speed })
    }

    /// The way to the next parameter, or to the end.
    fn forth(&self) -> Command {
        let reactions = self.sets.front().map_or(self.goal, |(at, ..)| *at).min(self.goal);
        match &self.times {
            None => Command::RunTo { reactions },
            // Before the reaction that came next, or after the last one.
            Some(times) => Command::RunUntil { now: times.sets.get(&reactions).copied().unwrap_or(times.end) },
        }
    }
}

/// `true` if a changed robot that is halted after `reactions` has gone to a point of the earlier run: it halts only
/// where it was told to, and before its first reaction.
fn has_gone(point: u64, reactions: u64) -> bool {
    point == 0 || reactions > 0
}
