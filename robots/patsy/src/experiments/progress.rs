use super::Score;
use apex_rt::node;
use std::io::{IsTerminal as _, Write as _};

/// Shows the current score in one line on standard error, if that is a terminal.
#[node]
#[derive(Debug)]
pub struct Progress {
    /// Number of scores per shown line.
    #[param(default = 500, range = 1..=1_000_000_000)]
    every: u64,
}

#[node]
impl Progress {
    fn process(&mut self, score: &Score) {
        if score.scans.is_multiple_of(self.every.max(1)) {
            let mut terminal = std::io::stderr();
            if terminal.is_terminal() {
                // Failing to show the line is not a reason to stop.
                let _ = write!(terminal, "\r{}", line(score)).and_then(|()| terminal.flush());
            }
        }
    }
}

fn line(score: &Score) -> String {
    let percent = |rate: Option<f64>| rate.map_or("–".to_owned(), |r| format!("{:.1} %", r * 100.0));
    let (tpr, fpr) = (percent(score.true_rate), percent(score.false_rate));
    format!("{:>6} scans, now {:<8}  TPR {tpr}, FPR {fpr}", score.scans, score.scenario)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Scenario;

    #[test]
    fn the_line_says_where_it_is_and_how_it_goes() {
        let score = Score { scenario: Scenario::Away, scans: 500, true_rate: Some(0.987), false_rate: None };
        assert_eq!(line(&score), "   500 scans, now away      TPR 98.7 %, FPR –");
    }
}
