use crate::vehicle::Patsy;
use apex_rt::Program as _;
use apex_sim::experiment::Spell;
use std::{fmt, time::Duration};

/// Number of speeds of a motion: the wanted one, and that after each limiter.
pub(super) const STAGES: usize = 4;

/// Phases of an order, each with the ends of the names of its nodes.
const PHASES: [(&str, &[&str]); 17] = [
    ("waits for an order", &["mission_control"]),
    ("to a container", &["collect.travel.follow_path", "collect.travel.follow_turn"]),
    ("brings a load", &["bring.travel.follow_path", "bring.travel.follow_turn"]),
    ("backward on a way", &["travel.follow_back"]),
    ("looks for a way", &["travel.request", "travel.path_planner", "travel.pause"]),
    ("makes room", &["travel.give_way", "travel.make_room"]),
    ("without a pose", &["travel.onward", "travel.aside"]),
    ("looks at a container", &["drive.detected"]),
    ("approaches it", &["drive.approach"]),
    ("backs out, or off", &["drive.back_off", "drive.back_out", "drive.leave"]),
    ("lifts", &["lift.control_lift", "lift.confirm", "lift.let_down", "lift.release", "lift.repair"]),
    ("looks at its load", &["set_down.settle", "set_down.confirm"]),
    ("straightens it", &["set_down.nudge", "set_down.go_back", "set_down.straighten"]),
    ("lowers it", &["set_down.release", "set_down.let_down", "set_down.repair"]),
    ("leaves it", &["set_down.leave"]),
    ("leaves it again", &["set_down.retreat", "set_down.back_out"]),
    ("lifts it again", &["set_down.lift_again", "set_down.confirm_lift", "set_down.lower_again"]),
];

/// Time and speeds of a phase.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Spent {
    time: f32,
    /// Number of times at which one of its nodes became active.
    times: usize,
    /// Highest wanted speed, in m/s.
    top: f32,
    /// Way at the wanted speed, and at that after each limiter, in m.
    ways: [f32; STAGES],
}

/// Time of a run by what the vehicle does, in s, with the speeds that it wants and those that are left.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Budget {
    phases: [Spent; PHASES.len()],
}

impl Budget {
    /// Adds `time` s of a motion in a phase: the wanted speed and that after each limiter, in m/s.
    pub(super) fn moved(&mut self, phase: usize, time: f32, speeds: &[f32; STAGES]) {
        let spent = &mut self.phases[phase];
        spent.top = spent.top.max(speeds[0]);
        spent.ways.iter_mut().zip(speeds).for_each(|(way, speed)| *way += time * speed);
    }

    /// The budget with the times for which nodes were active, and the number of these times.
    pub(super) fn with_times(mut self, activity: &[(&str, Duration)], spells: &[Spell]) -> Self {
        for (name, time) in activity {
            if let Some(phase) = phase_of(name) {
                self.phases[phase].time += time.as_secs_f32();
            }
        }
        for phase in spells.iter().filter_map(|spell| phase_of(spell.node)) {
            self.phases[phase].times += 1;
        }
        self
    }
}

/// Phase of a node, if there is one.
fn phase_of(node: &str) -> Option<usize> {
    PHASES.iter().position(|(_, ends)| ends.iter().any(|end| node.ends_with(end)))
}

/// Phase of each node of the vehicle.
pub(super) fn phases() -> Vec<Option<usize>> {
    Patsy::INFO.nodes.iter().map(|node| phase_of(node.name)).collect()
}

/// Table of the time of the mean run, with a line for each phase, from the budgets of all runs.
///
/// `slow` is the time that the node of the phase itself takes from its highest speed, and the other losses are what the
/// limiters take from it.
#[derive(Debug)]
pub struct BudgetTable<'a>(pub &'a [&'a Budget]);

impl fmt::Display for BudgetTable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<22}{:>9}{:>8}{:>10}{:>12}{:>12}{:>9}{:>10}{:>10}{:>9}",
            "in a run", "time", "times", "way", "mean", "highest", "slow", "persons", "hazards", "field"
        )?;
        for (number, (name, _)) in PHASES.iter().enumerate() {
            let spent = mean(self.0, number);
            if spent.time > 0.0 {
                line(f, name, &spent, self.0.len())?;
            }
        }
        Ok(())
    }
}

/// Time, way and losses of a phase in the mean run. The number of times is that of all runs.
fn mean(runs: &[&Budget], phase: usize) -> Spent {
    let count = runs.len().max(1) as f32;
    runs.iter().map(|run| &run.phases[phase]).fold(Spent::default(), |mut sum, spent| {
        sum.time += spent.time / count;
        sum.times += spent.times;
        sum.top = sum.top.max(spent.top);
        sum.ways.iter_mut().zip(spent.ways).for_each(|(way, one)| *way += one / count);
        sum
    })
}

fn line(f: &mut fmt::Formatter<'_>, name: &str, spent: &Spent, runs: usize) -> fmt::Result {
    let Spent { time, times, top, ways } = *spent;
    write!(f, "{name:<22}{time:>7.1} s{:>8.1}", times as f32 / runs as f32)?;
    if top > 0.0 {
        let [wanted, .., left] = ways;
        write!(f, "{left:>8.1} m{:>8.2} m/s{top:>8.2} m/s{:>7.1} s", left / time, time - wanted / top)?;
        for (pair, width) in ways.windows(2).zip([8, 8, 7]) {
            write!(f, "{:>width$.1} s", (pair[0] - pair[1]) / top)?;
        }
    }
    writeln!(f)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_of_the_mission_has_a_phase() {
        let phases = phases();
        for (number, (name, ends)) in PHASES.iter().enumerate() {
            assert!(phases.contains(&Some(number)), "no node of `{name}`");
            let names: Vec<&str> = Patsy::INFO.nodes.iter().map(|node| node.name).collect();
            ends.iter().for_each(|end| assert!(names.iter().any(|name| name.ends_with(end)), "no node `{end}`"));
        }
    }

    #[test]
    fn a_phase_has_the_times_of_its_nodes() {
        let mut budget = Budget::default();
        budget.moved(2, 0.5, &[0.8, 0.4, 0.4, 0.2]);
        budget.moved(2, 0.5, &[0.4, 0.4, 0.4, 0.4]);
        let budget = budget
            .with_times(&[("carry.bring.travel.follow_path", Duration::from_secs(1)), ("other", Duration::MAX)], &[]);
        let spent = budget.phases[2];
        assert_eq!((spent.time, spent.top), (1.0, 0.8));
        let expected = [0.6, 0.4, 0.4, 0.3];
        assert!(spent.ways.iter().zip(expected).all(|(way, m)| (way - m).abs() < 1e-6), "{spent:?}");
    }
}
