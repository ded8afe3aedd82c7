use crate::{
    Found, Goal, Journal, Objective, Parameter, Point, Study, StudyError,
    goal::{Fitness, add_to_front},
    picture,
};
use apex_optim::Best;
use serde_json::{Value, json};
use std::{fmt::Write, fs, io, path::Path};

/// Costs by goal, on the seeds of the study and on those that it has not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Costs on the seeds of the study.
    pub training: Vec<f64>,
    /// Costs on the seeds held out.
    pub held_out: Vec<f64>,
}

/// Result of a study beside the defaults.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    study: Study,
    found: Vec<Found>,
    best: Best,
    /// Score of the defaults.
    pub defaults: Score,
    /// Score of the best candidate; with several goals, of the best one for equal weights.
    pub tuned: Score,
    /// Fitness on the seeds of the study that is lost if only this parameter has its default, by parameter.
    pub importance: Vec<f64>,
    /// Candidates of which none is better than another one in all goals, if there are several goals.
    pub front: Vec<Point>,
}

impl Report {
    /// Scores the best candidate of all searches and the defaults. Returns `None` if all candidates have failed.
    pub fn new(
        study: &Study,
        found: Vec<Found>,
        objective: &dyn Objective,
        journal: &mut Journal,
    ) -> Result<Option<Self>, StudyError> {
        let several = study.goals.len() > 1;
        // With several goals, the searches have other weights.
        let candidates = found.iter().filter_map(|f| f.best.as_ref());
        let best = candidates.reduce(|a, b| if several || a.fitness <= b.fitness { a } else { b });
        let Some(best) = best.cloned() else { return Ok(None) };
        let fitness: Fitness = study.fitness(objective, journal)?(0);
        let mut score = |number, values: &[f64], seeds: &[u64]| study.score(objective, journal, number, values, seeds);
        let mut both = |number, values: &[f64]| -> Result<Score, StudyError> {
            let training = score(number, values, &study.seeds)?;
            Ok(Score { training, held_out: score(number, values, &study.held_out)? })
        };
        let (defaults, tuned) = (both(0, &study.defaults())?, both(1, &best.values)?);
        let mut importance = Vec::new();
        for (i, parameter) in study.parameters.iter().enumerate() {
            let mut values = best.values.clone();
            values[i] = parameter.default;
            let without = score(2 + i as u64, &values, &study.seeds)?;
            importance.push(fitness.of(&without) - fitness.of(&tuned.training));
        }
        let mut front = Vec::new();
        for point in found.iter().flat_map(|found| &found.front) {
            add_to_front(&mut front, point.clone());
        }
        front.sort_by(|a, b| a.costs[0].total_cmp(&b.costs[0]));
        Ok(Some(Self { study: study.clone(), found, best, defaults, tuned, importance, front }))
    }

    /// Values of the best candidate.
    pub fn values(&self) -> &[f64] {
        &self.best.values
    }

    /// Returns `true` if the best candidate is better than the defaults in at least one goal, on the seeds of the
    /// study.
    pub fn is_better(&self) -> bool {
        self.tuned.training.iter().zip(&self.defaults.training).any(|(tuned, default)| tuned < default)
    }

    /// Warning if the seeds held out do not confirm the result.
    pub fn warning(&self) -> Option<String> {
        if self.study.held_out.is_empty() {
            return Some("nothing is held out: the result is that of the seeds that chose the values".to_owned());
        }
        let parts = self.study.goals.iter().enumerate().filter_map(|(i, goal)| {
            let gain = |after: &[f64], before: &[f64]| before[i] - after[i];
            let training = gain(&self.tuned.training, &self.defaults.training);
            let held_out = gain(&self.tuned.held_out, &self.defaults.held_out);
            let least = if training.is_finite() { 0.5 * training } else { 0.0 };
            let parts = training > 0.0 && (held_out.is_nan() || held_out < least);
            parts.then(|| part(&goal.name, training, held_out))
        });
        let parts: Vec<String> = parts.collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }

    /// Tables of the goals and of the parameters, as Markdown.
    pub fn tables(&self) -> String {
        let mut text =
            "| goal | defaults | tuned | defaults, held out | tuned, held out |\n|---|---|---|---|---|\n".to_owned();
        for (i, goal) in self.study.goals.iter().enumerate() {
            let shown = |costs: &[f64]| number(goal.value(costs[i]));
            let (d, t) = (&self.defaults, &self.tuned);
            let word = if goal.maximise { "maximise" } else { "minimise" };
            let all = [&d.training, &t.training].map(|costs| shown(costs));
            let held = [&d.held_out, &t.held_out]
                .map(|costs| if self.study.held_out.is_empty() { "–".into() } else { shown(costs) });
            let (name, unit) = (&goal.name, in_brackets(&goal.unit));
            let _ = writeln!(
                text,
                "| {word} `{name}`{unit} {} | {} | {} | {} | {} |",
                goal.summary, all[0], all[1], held[0], held[1]
            );
        }
        text.push_str("\n| parameter | default | tuned | range | lost with the default |\n|---|---|---|---|---|\n");
        for ((p, value), importance) in self.study.parameters.iter().zip(&self.best.values).zip(&self.importance) {
            let (name, (unit, size)) = (&p.name, p.shown());
            let shown = |value: f64| number(value / size);
            let (low, high) = (shown(p.axis.low()), shown(p.axis.high()));
            let (unit, default, value) = (in_brackets(unit), shown(p.default), shown(*value));
            let scale = if p.axis.scale() == crate::Scale::Logarithmic { ", logarithmic" } else { "" };
            let lost = number(*importance);
            let _ = writeln!(text, "| `{name}`{unit} | {default} | {value} | {low} to {high}{scale} | {lost} |");
        }
        text
    }

    /// Table of the front, as Markdown.
    fn front_table(&self) -> String {
        let names = self.study.goals.iter().map(|goal| &goal.name).chain(self.study.parameters.iter().map(|p| &p.name));
        let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
        let mut text = format!("| {} |\n|{}\n", names.join(" | "), "---|".repeat(names.len()));
        for point in &self.front {
            let goals = self.study.goals.iter().zip(&point.costs).map(|(goal, cost)| goal.value(*cost));
            let row: Vec<String> = goals.chain(point.values.iter().copied()).map(number).collect();
            let _ = writeln!(text, "| {} |", row.join(" | "));
        }
        text
    }

    /// Report as Markdown: tables of the goals, the parameters and the front, and the cost of the study.
    pub fn markdown(&self) -> String {
        let mut text = "# Study\n\n".to_owned();
        if let Some(warning) = self.warning() {
            let _ = writeln!(text, "**Warning:** {warning}.\n");
        }
        text.push_str(&self.tables());
        let _ = writeln!(text, "\n{}", self.cost());
        text.push_str("\n![Convergence](convergence.svg)\n\n![Importance](importance.svg)\n");
        if !self.front.is_empty() {
            let _ = write!(text, "\n## Front\n\n{}\n![Front](front.svg)\n", self.front_table());
        }
        text
    }

    /// Result for programs. Values that are not finite, because runs have failed, are `null`.
    pub fn json(&self) -> Value {
        let goal = |(i, goal): (usize, &Goal)| {
            let of = |costs: &[f64]| costs.get(i).map(|cost| goal.value(*cost));
            json!({
                "name": goal.name, "unit": goal.unit, "maximise": goal.maximise, "summary": goal.summary.to_string(),
                "defaults": of(&self.defaults.training), "tuned": of(&self.tuned.training),
                "defaults_held_out": of(&self.defaults.held_out), "tuned_held_out": of(&self.tuned.held_out),
            })
        };
        let tuned = self.study.parameters.iter().zip(&self.best.values).zip(&self.importance);
        let parameter = |((p, value), lost): ((&Parameter, &f64), &f64)| {
            json!({
                "name": p.name, "unit": p.unit, "targets": p.targets, "default": p.default, "tuned": value,
                "low": p.axis.low(), "high": p.axis.high(), "lost_with_default": lost,
            })
        };
        let point = |point: &Point| {
            let goals = self.study.goals.iter().zip(&point.costs).map(|(goal, cost)| goal.value(*cost));
            json!({ "goals": goals.collect::<Vec<_>>(), "values": point.values })
        };
        json!({
            "study": self.study.name,
            "better": self.is_better(),
            "warning": self.warning(),
            "goals": self.study.goals.iter().enumerate().map(goal).collect::<Vec<_>>(),
            "parameters": tuned.map(parameter).collect::<Vec<_>>(),
            "front": self.front.iter().map(point).collect::<Vec<_>>(),
            "runs": self.found.iter().map(|found| found.runs).sum::<u64>(),
        })
    }

    /// Number of runs, as a sentence.
    pub fn cost(&self) -> String {
        let (runs, saved) = self.found.iter().fold((0, 0), |(runs, saved), f| (runs + f.runs, saved + f.saved));
        let share = 100.0 * saved as f64 / (runs + saved).max(1) as f64;
        let Study { searches, candidates, seed, .. } = &self.study;
        format!("{searches} × {candidates} candidates, seed {seed}: {runs} runs; {share:.1} % were not necessary.")
    }

    /// Writes `report.md` and its pictures into a folder, which is created if necessary.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        fs::write(folder.join("report.md"), self.markdown())?;
        fs::write(folder.join("convergence.svg"), picture::convergence(&self.found)?)?;
        let names: Vec<&str> = self.study.parameters.iter().map(|p| p.name.as_str()).collect();
        fs::write(folder.join("importance.svg"), picture::importance(&names, &self.importance)?)?;
        if let ([first, second, ..], false) = (self.study.goals.as_slice(), self.front.is_empty()) {
            let at = |costs: &[f64]| (first.value(costs[0]), second.value(costs[1]));
            let front: Vec<(f64, f64)> = self.front.iter().map(|point| at(&point.costs)).collect();
            let (defaults, tuned) = (at(&self.defaults.training), at(&self.tuned.training));
            let label = |goal: &Goal| format!("{}{}", goal.name, in_brackets(&goal.unit));
            let picture = picture::front([&label(first), &label(second)], &front, defaults, tuned)?;
            fs::write(folder.join("front.svg"), picture)?;
        }
        Ok(())
    }
}

fn in_brackets(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" [{unit}]") }
}

/// Number with four significant digits: the others depend on the seeds.
fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value.is_infinite() { "failed".to_owned() } else { value.to_string() };
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    if !(-5..=12).contains(&digits) {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.*}", digits.max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Describes a goal that gains less on the seeds held out than on those of the study. A gain is infinite if the
/// defaults fail, negatively infinite if the result does, and NaN if both do.
fn part(name: &str, training: f64, held_out: f64) -> String {
    let study = match training.is_infinite() {
        true => format!("`{name}`: the defaults fail on the seeds of the study"),
        false => format!("`{name}` improves by {} on the seeds of the study", number(training)),
    };
    if !held_out.is_finite() {
        format!("{study}, but the result fails on those held out")
    } else if held_out < 0.0 {
        format!("{study}, but on those held out the result is worse by {}", number(-held_out))
    } else {
        format!("{study}, but by {} on those held out", number(held_out))
    }
}

#[cfg(test)]
mod tests {
    use super::{number, part};

    #[test]
    fn warnings_say_which_side_fails() {
        let infinity = f64::INFINITY;
        for (training, held_out, expected) in [
            (2.0, 0.5, "`a` improves by 2 on the seeds of the study, but by 0.5 on those held out"),
            (
                2.0,
                -0.5,
                "`a` improves by 2 on the seeds of the study, but on those held out the result is worse by 0.5",
            ),
            (2.0, -infinity, "`a` improves by 2 on the seeds of the study, but the result fails on those held out"),
            (
                infinity,
                -0.5,
                "`a`: the defaults fail on the seeds of the study, but on those held out the result is worse by 0.5",
            ),
            (
                infinity,
                f64::NAN,
                "`a`: the defaults fail on the seeds of the study, but the result fails on those held out",
            ),
        ] {
            assert_eq!(part("a", training, held_out), expected);
        }
    }

    #[test]
    fn numbers_have_four_digits() {
        let shown = [0.0, 1.0, -2.5, 123_456.0, 0.000_123_456_789, 1e9, 1e-12, f64::INFINITY].map(number);
        assert_eq!(shown, ["0", "1", "-2.5", "123456", "0.0001235", "1.000e9", "1.000e-12", "failed"]);
    }
}
