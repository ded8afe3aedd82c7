//! Differences between two studies, for a journal that does not fit.

use crate::{Goal, Parameter, Study};
use std::fmt::Display;

impl Study {
    /// Differences from the study with this description, each in a few words.
    pub(crate) fn changes_from(&self, description: &str) -> Vec<String> {
        let before = match Self::from_description(description) {
            Ok(before) => before,
            Err(reason) => return vec![reason],
        };
        let mut changes = vec![];
        let numbers = [
            ("the number of searches", before.searches, self.searches),
            ("the number of candidates", before.candidates, self.candidates),
            ("the number of seeds", before.seeds.len() as u64, self.seeds.len() as u64),
            ("the number of seeds held out", before.held_out.len() as u64, self.held_out.len() as u64),
            ("the seed of the search", before.seed, self.seed),
        ];
        for (what, was, is) in numbers {
            changes.extend(changed(what, was, is));
        }
        if before.name != self.name {
            changes.push(format!("it was `{}`, and is `{}`", before.name, self.name));
        }
        if before.method != self.method {
            changes.push("the method of the search has changed".to_owned());
        }
        let names = |parameter: &Parameter| parameter.name.clone();
        compare("parameter", (&before.parameters, &self.parameters), names, parameter, &mut changes);
        compare("goal", (&before.goals, &self.goals), |goal| goal.name.clone(), goal, &mut changes);
        if before.objective != self.objective {
            changes.push("the text of the robot has changed since, and with it what a run may give".to_owned());
        }
        if changes.is_empty() {
            changes.push("an option has changed".to_owned());
        }
        changes
    }
}

fn changed(what: &str, was: impl Display + PartialEq, is: impl Display + PartialEq) -> Option<String> {
    let (was, is) = (was.to_string(), is.to_string());
    (was != is).then(|| format!("{what} was {was}, and is {is}"))
}

/// Adds which elements are new, gone or different.
fn compare<T: PartialEq>(
    what: &str,
    (before, after): (&[T], &[T]),
    name: impl Fn(&T) -> String,
    differences: impl Fn(&str, &T, &T) -> Vec<String>,
    changes: &mut Vec<String>,
) {
    for old in before {
        let name_of_old = name(old);
        match after.iter().find(|new| name(new) == name_of_old) {
            None => changes.push(format!("the {what} `{name_of_old}` is gone")),
            Some(new) if new == old => {}
            Some(new) => changes.extend(differences(&format!("of the {what} `{name_of_old}`"), old, new)),
        }
    }
    let is_new = |new: &&T| before.iter().all(|old| name(old) != name(new));
    changes.extend(after.iter().filter(is_new).map(|new| format!("the {what} `{}` is new", name(new))));
}

fn parameter(of: &str, was: &Parameter, is: &Parameter) -> Vec<String> {
    let range = |parameter: &Parameter| format!("{}..={}", parameter.axis.low(), parameter.axis.high());
    let changes = [
        changed(&format!("the default {of}"), was.default, is.default),
        changed(&format!("the range {of}"), range(was), range(is)),
    ];
    let changes: Vec<String> = changes.into_iter().flatten().collect();
    if changes.is_empty() { vec![format!("the unit, scale or use {of} has changed")] } else { changes }
}

fn goal(of: &str, was: &Goal, is: &Goal) -> Vec<String> {
    let word = |goal: &Goal| if goal.maximise { "maximise" } else { "minimise" };
    let changes = [
        changed(&format!("the direction {of}"), word(was), word(is)),
        changed(&format!("the share of runs {of}"), was.summary, is.summary),
    ];
    let changes: Vec<String> = changes.into_iter().flatten().collect();
    if changes.is_empty() { vec![format!("the unit {of} has changed")] } else { changes }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Method, Scale, Summary};

    fn study() -> Study {
        let parameter = |name: &str| Parameter {
            name: name.to_owned(),
            unit: "m".to_owned(),
            shown_in: None,
            axis: Axis::new(0.0, 1.0, Scale::Linear, false).unwrap(),
            default: 0.5,
            targets: vec![format!("node.{name}")],
            single: false,
        };
        Study {
            name: "Swift".to_owned(),
            objective: 1,
            parameters: vec![parameter("gap"), parameter("speed")],
            method: Method::DifferentialEvolution,
            goals: vec![Goal {
                name: "error".to_owned(),
                unit: "m".to_owned(),
                maximise: false,
                summary: Summary::Quantile(0.9),
                least: 0.0,
            }],
            seeds: vec![0, 1],
            held_out: vec![2],
            searches: 1,
            candidates: 100,
            seed: 1,
            racing: true,
        }
    }

    /// Changes of a study whose journal is from before `change`.
    fn changes(change: impl FnOnce(&mut Study)) -> Vec<String> {
        let mut after = study();
        change(&mut after);
        after.changes_from(&study().description())
    }

    #[test]
    fn changes_are_named() {
        assert_eq!(changes(|study| study.candidates = 200), ["the number of candidates was 100, and is 200"]);
        assert_eq!(changes(|study| study.seeds.push(5)), ["the number of seeds was 2, and is 3"]);
        assert_eq!(changes(|study| study.method = Method::CmaEs), ["the method of the search has changed"]);
        let text = "the text of the robot has changed since, and with it what a run may give";
        assert_eq!(changes(|study| study.objective = 2), [text]);
        let range = changes(|study| study.parameters[0].axis = Axis::new(0.0, 2.0, Scale::Linear, false).unwrap());
        assert_eq!(range, ["the range of the parameter `gap` was 0..=1, and is 0..=2"]);
        let default = changes(|study| study.parameters[1].default = 0.25);
        assert_eq!(default, ["the default of the parameter `speed` was 0.5, and is 0.25"]);
        let renamed = changes(|study| study.parameters[1].name = "pace".to_owned());
        assert_eq!(renamed, ["the parameter `speed` is gone", "the parameter `pace` is new"]);
        let unit = changes(|study| study.parameters[0].unit = "cm".to_owned());
        assert_eq!(unit, ["the unit, scale or use of the parameter `gap` has changed"]);
        let share = changes(|study| study.goals[0].summary = Summary::Quantile(0.5));
        assert_eq!(share, ["the share of runs of the goal `error` was at 90 %, and is at 50 %"]);
        assert_eq!(changes(|study| study.racing = false), ["an option has changed"]);
    }

    #[test]
    fn a_file_that_is_no_journal_is_said() {
        let changes = study().changes_from("of another study");
        assert!(changes.len() == 1 && changes[0].starts_with("it does not describe a study"), "{changes:?}");
    }
}
