use crate::{Found, Objective, Study, picture};
use apex_nodes::optim::Best;
use std::{fmt::Write, fs, io, path::Path};

/// Fitness on the seeds of the study, and on those that it has not seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Fitness on the seeds of the study.
    pub training: f64,
    /// Fitness on the seeds held out.
    pub held_out: f64,
}

/// Result of a study beside the defaults.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    study: Study,
    found: Vec<Found>,
    best: Best,
    /// Score of the defaults.
    pub defaults: Score,
    /// Score of the best candidate.
    pub tuned: Score,
    /// Fitness on the seeds of the study that is lost if only this parameter has its default, by parameter.
    pub importance: Vec<f64>,
}

impl Report {
    /// Scores the best candidate of all searches and the defaults. Returns `None` if all candidates have failed.
    pub fn new(study: &Study, found: Vec<Found>, objective: &dyn Objective) -> Option<Self> {
        let best = found.iter().filter_map(|f| f.best.as_ref()).min_by(|a, b| a.fitness.total_cmp(&b.fitness))?.clone();
        let score = |values: &[f64]| Score {
            training: study.score(objective, values, &study.seeds),
            held_out: study.score(objective, values, &study.held_out),
        };
        let (defaults, tuned) = (score(&study.defaults()), score(&best.values));
        let without = |i: usize| {
            let mut values = best.values.clone();
            values[i] = study.parameters[i].default;
            study.score(objective, &values, &study.seeds) - tuned.training
        };
        let importance = (0..study.parameters.len()).map(without).collect();
        Some(Self { study: study.clone(), found, best, defaults, tuned, importance })
    }

    /// Values of the best candidate.
    pub fn values(&self) -> &[f64] {
        &self.best.values
    }

    /// Warning if the seeds held out do not confirm the result.
    pub fn warning(&self) -> Option<String> {
        if self.study.held_out.is_empty() {
            return Some("no seeds are held out: the fitness is that of the seeds that chose the values".to_owned());
        }
        let gain = |before: f64, after: f64| 1.0 - after / before;
        let training = gain(self.defaults.training, self.tuned.training);
        let held_out = gain(self.defaults.held_out, self.tuned.held_out);
        let percent = |x: f64| format!("{:.1} %", 100.0 * x);
        let parts = training > 0.0 && (held_out.is_nan() || held_out < 0.5 * training);
        parts.then(|| {
            let (training, held_out) = (percent(training), percent(held_out));
            format!("the fitness improves by {training} on the seeds of the study, but by {held_out} on those held out")
        })
    }

    /// Markdown with the tables of the values, the scores and the cost of the study.
    pub fn markdown(&self) -> String {
        let mut text = "# Study\n\n".to_owned();
        if let Some(warning) = self.warning() {
            let _ = writeln!(text, "**Warning:** {warning}.\n");
        }
        text.push_str("| fitness (less is better) | seeds of the study | seeds held out |\n|---|---|---|\n");
        for (name, score) in [("defaults", self.defaults), ("tuned", self.tuned)] {
            let _ = writeln!(text, "| {name} | {:.6} | {:.6} |", score.training, score.held_out);
        }
        text.push_str(
            "\n| parameter | default | tuned | range | fitness lost with the default |\n|---|---|---|---|---|\n",
        );
        for ((p, value), importance) in self.study.parameters.iter().zip(&self.best.values).zip(&self.importance) {
            let (low, high) = (p.axis.low(), p.axis.high());
            let (name, unit, default) = (&p.name, &p.unit, p.default);
            let _ = writeln!(
                text,
                "| `{name}` | {default} {unit} | {value:.6} {unit} | {low} to {high} {unit} | {importance:.6} |"
            );
        }
        let (runs, saved) = self.found.iter().fold((0, 0), |(runs, saved), f| (runs + f.runs, saved + f.saved));
        let share = 100.0 * saved as f64 / (runs + saved).max(1) as f64;
        let Study { searches, candidates, seed, .. } = &self.study;
        let _ = writeln!(text, "\n{searches} × {candidates} candidates, seed {seed}: {runs} runs; {share:.1} % saved.");
        text.push_str("\n![Convergence](convergence.svg)\n\n![Importance](importance.svg)\n");
        text
    }

    /// Writes `report.md`, `convergence.svg` and `importance.svg` into a folder, which is created if necessary.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        fs::write(folder.join("report.md"), self.markdown())?;
        fs::write(folder.join("convergence.svg"), picture::convergence(&self.found)?)?;
        let names: Vec<&str> = self.study.parameters.iter().map(|p| p.name.as_str()).collect();
        fs::write(folder.join("importance.svg"), picture::importance(&names, &self.importance)?)
    }
}
