use crate::{Detector, obstacles::DetectObstacles, world::labelled_scene};
use apex_rt::{Info, Observer, Program as _};
use core::fmt;
use std::time::{Duration, Instant};

/// Rows of table 6.1 of the thesis, with the nodes that they consist of. The last row is not in the table.
const ROWS: [(&str, &[&str]); 5] = [
    ("Conversion", &["prepare.mount", "prepare.near", "prepare.smooth"]),
    ("Intensity filter", &["prepare.bright"]),
    ("Edge filter", &["prepare.edges"]),
    ("Classification", &["floor", "classify"]),
    ("Hazard map", &["hazards"]),
];
/// Number of rows that are in the table of the thesis.
const IN_TABLE: usize = 4;
/// Mean times of the thesis, in ms.
const THESIS: [f64; IN_TABLE] = [0.56, 0.27, 0.48, 6.20];

/// Computing times of the steps of the detection (thesis table 6.1), on one thread.
#[derive(Debug)]
pub struct StepTimes {
    info: &'static Info,
    since: Instant,
    now: [Duration; ROWS.len()],
    /// Times of all frames, by row, in ms.
    frames: Vec<[f64; ROWS.len()]>,
}

impl StepTimes {
    /// Measures the detection on scenes of seeds from `first` on, `rounds` times each.
    pub fn measure(first: u64, scenes: u64, rounds: usize) -> Self {
        let info = const { &DetectObstacles::INFO };
        let mut times = Self { info, since: Instant::now(), now: Default::default(), frames: vec![] };
        let mut detector = Detector::default();
        for seed in first..first.saturating_add(scenes) {
            let frame = labelled_scene(seed).take();
            for round in 0..=rounds {
                detector.detect_with(&frame.cloud, &mut times);
                let now = core::mem::take(&mut times.now);
                // The first round fills the caches.
                if round > 0 {
                    times.frames.push(now.map(|time| 1e3 * time.as_secs_f64()));
                }
            }
        }
        times
    }

    /// Median, mean and standard deviation of a sum of rows, in ms.
    fn statistics(&self, rows: core::ops::Range<usize>) -> [f64; 3] {
        let mut sums: Vec<f64> = self.frames.iter().map(|frame| frame[rows.clone()].iter().sum()).collect();
        sums.sort_unstable_by(f64::total_cmp);
        let count = sums.len().max(1) as f64;
        let mean = sums.iter().sum::<f64>() / count;
        let variance = sums.iter().map(|sum| (sum - mean) * (sum - mean)).sum::<f64>() / count;
        [sums.get(sums.len() / 2).copied().unwrap_or_default(), mean, variance.sqrt()]
    }
}

impl Observer for StepTimes {
    fn fired(&mut self, _node: usize) {
        self.since = Instant::now();
    }

    fn finished(&mut self, node: usize) {
        let took = self.since.elapsed();
        let name = self.info.nodes[node].name;
        if let Some(row) = ROWS.iter().position(|(_, nodes)| nodes.contains(&name)) {
            self.now[row] += took;
        }
    }
}

impl fmt::Display for StepTimes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<24}{:>8}{:>8}{:>20}", "time per frame (ms)", "median", "mean", "standard deviation")?;
        write!(f, "{:>16}", "thesis, mean")?;
        let mut line = |name: &str, rows: core::ops::Range<usize>, thesis: Option<f64>| {
            let [median, mean, deviation] = self.statistics(rows);
            write!(f, "\n{name:<24}{median:>8.3}{mean:>8.3}{deviation:>20.3}")?;
            match thesis {
                Some(thesis) => write!(f, "{thesis:>16.2}"),
                None => write!(f, "{:>16}", "–"),
            }
        };
        for (row, (name, _)) in ROWS.iter().enumerate() {
            if row == IN_TABLE {
                line("Overall", 0..IN_TABLE, Some(7.5))?;
            }
            line(name, row..row + 1, THESIS.get(row).copied())?;
        }
        Ok(())
    }
}
