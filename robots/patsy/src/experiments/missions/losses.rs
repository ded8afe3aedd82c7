use super::budget::{Budget, STAGES as COUNT, phases};
use apex_nodes::nav::Twist;
use apex_rt::{
    Observer, Parameters, Time,
    record::{Channel, Codec, Message as _, cdr::Reader},
};
use apex_sim::experiment::Spell;
use std::time::Duration;

/// Longest time for which a twist counts, in s.
const PERIOD: f32 = 0.1;

/// Time that a run lost to each cause, in s. A limiter that halves the speed for two seconds costs one second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Losses {
    /// Slowed down or held near persons (`PersonCaution`).
    pub persons: f32,
    /// Slowed down or held before obstacles and floor that the camera did not see (`SweepStop`).
    pub hazards: f32,
    /// Slowed down or held before what the scanners see (`TrailerField`).
    pub field: f32,
    /// Without a way: planning, waiting for the next try, and making room.
    pub planning: f32,
    /// Without a pose on the plan.
    pub blind: f32,
}

/// Stage of a motion: the wanted one, and that after each limiter.
const STAGES: [&str; COUNT] = ["wanted.out", "careful.caution.out", "careful.sweep.out", "careful.safety.out"];
const PLANNING: [&str; 5] = ["request", "path_planner", "pause", "give_way", "make_room"];
const BLIND: [&str; 2] = ["onward", "aside"];

/// Compares the outputs of the limiters of all motions.
#[derive(Debug)]
pub(super) struct Limits {
    /// Stage of each channel.
    stages: Vec<Option<usize>>,
    /// Speeds after each stage since a time, in m/s.
    speeds: [f32; COUNT],
    since: Time,
    now: Time,
    /// Phase in that time, and the present one.
    phase: Option<usize>,
    present: Option<usize>,
    /// Phase of each node.
    phases: Vec<Option<usize>>,
    budget: Budget,
    /// Time lost to each limiter, in s.
    lost: [f32; COUNT - 1],
    bytes: Vec<u8>,
}

impl Limits {
    pub fn new(channels: &[Channel]) -> Self {
        let stage = |name: &str| STAGES.iter().position(|stage| name.ends_with(stage));
        let stages = channels.iter().map(|channel| stage(channel.name)).collect();
        Self {
            stages,
            speeds: [0.0; COUNT],
            since: Time::ZERO,
            now: Time::ZERO,
            phase: None,
            present: None,
            phases: phases(),
            budget: Budget::default(),
            lost: [0.0; COUNT - 1],
            bytes: vec![],
        }
    }

    /// Notes the speed after a stage. That of the first one begins a step.
    fn moved(&mut self, stage: usize, speed: f32) {
        if stage == 0 {
            self.count(self.now.since(self.since));
            (self.since, self.phase, self.speeds) = (self.now, self.present, [speed; COUNT]);
        }
        self.speeds[stage..].fill(speed);
    }

    fn count(&mut self, time: Duration) {
        let (wanted, time) = (self.speeds[0], time.as_secs_f32().min(PERIOD));
        if let Some(phase) = self.phase {
            self.budget.moved(phase, time, &self.speeds);
        }
        if wanted > 0.0 {
            for (lost, pair) in self.lost.iter_mut().zip(self.speeds.windows(2)) {
                *lost += time * (pair[0] - pair[1]).max(0.0) / wanted;
            }
        }
    }

    /// Losses of a run whose nodes were active for these times.
    pub fn losses(&self, activity: &[(&str, Duration)]) -> Losses {
        let active = |names: &[&str]| {
            let is_one = |name: &str| name.rsplit('.').next().is_some_and(|last| names.contains(&last));
            let times = activity.iter().filter(|(name, _)| is_one(name)).map(|(_, time)| *time);
            times.sum::<Duration>().as_secs_f32()
        };
        let [persons, hazards, field] = self.lost;
        Losses { persons, hazards, field, planning: active(&PLANNING), blind: active(&BLIND) }
    }

    /// Time of a run by phases, whose nodes were active for these times.
    pub fn budget(&self, activity: &[(&str, Duration)], spells: &[Spell]) -> Budget {
        self.budget.clone().with_times(activity, spells)
    }
}

impl Observer for Limits {
    fn before_reaction(&mut self, now: Time, _params: &mut impl Parameters) {
        self.now = now;
    }

    fn activity(&mut self, node: usize, active: bool) {
        if active {
            self.present = self.phases.get(node).copied().flatten().or(self.present);
        }
    }

    fn wants(&mut self, channel: usize) -> bool {
        self.stages.get(channel).is_some_and(Option::is_some)
    }

    fn sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        let Some((stage, codec)) = self.stages.get(channel).copied().flatten().zip(codec) else { return };
        self.bytes.clear();
        let is_written = (codec.write)(token, &mut self.bytes);
        let twist = Reader::new(&self.bytes).and_then(|mut message| Twist::read(&mut message));
        if let (true, Ok(twist)) = (is_written, twist) {
            self.moved(stage, twist.velocity().norm());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Patsy;
    use apex_rt::Program as _;

    #[test]
    fn every_limiter_of_every_motion_is_watched() {
        let limits = Limits::new(&Patsy::channels());
        let counts: Vec<usize> = (0..STAGES.len())
            .map(|stage| limits.stages.iter().filter(|other| **other == Some(stage)).count())
            .collect();
        assert!(counts[0] > 0 && counts == [counts[0]; STAGES.len()], "{counts:?}");
        let names: Vec<&str> = Patsy::INFO.nodes.iter().map(|node| node.name).collect();
        for name in PLANNING.iter().chain(&BLIND) {
            assert!(names.iter().any(|node| node.ends_with(&format!(".{name}"))), "no node `{name}`");
        }
    }

    #[test]
    fn each_limiter_costs_what_it_takes_from_the_speed() {
        let mut limits = Limits::new(&[]);
        for step in 0..=10 {
            limits.now = Time::from_millis(80 * step);
            [0.8, 0.4, 0.4, 0.1].into_iter().enumerate().for_each(|(stage, speed)| limits.moved(stage, speed));
        }
        // Nothing is wanted any more, so nothing is lost.
        limits.now = Time::from_secs(9);
        [0.0; 4].into_iter().enumerate().for_each(|(stage, speed)| limits.moved(stage, speed));
        limits.now = Time::from_secs(19);
        limits.moved(0, 0.5);
        let losses = limits.losses(&[("a.pause", Duration::from_secs(3)), ("a.onward", Duration::from_secs(2))]);
        let near = |a: f32, b: f32| (a - b).abs() < 1e-4;
        assert!(near(losses.persons, 0.45) && losses.hazards == 0.0 && near(losses.field, 0.3375), "{losses:?}");
        assert_eq!([losses.planning, losses.blind], [3.0, 2.0]);
    }
}
