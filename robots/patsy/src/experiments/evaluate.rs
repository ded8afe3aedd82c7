use crate::world::{Scenario, Truth};
use apex_nodes::scan::{Container, Pose2};
use apex_rt::node;
use apex_sim::say;
use core::{
    f32::consts::{FRAC_PI_2, PI},
    fmt,
};

/// Counts detections and measures the errors of their poses, by scenario (thesis 6.10.2, table 6.2).
///
/// A detection is true if its pose is near that of the container. Otherwise it is false, as is every detection without
/// a container. Errors are those of true detections, in the frame of the container: x along it, y across. A container
/// looks the same from both ends, so a rotation by 180° does not count as an error.
#[node]
#[derive(Debug)]
pub struct Evaluate {
    /// Maximum distance of a true detection from the centre of the container.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    max_distance: f32,
    /// Maximum heading error of a true detection.
    #[param(unit = "rad", default = 0.35, range = 0.0..=3.2)]
    max_angle: f32,
    scenarios: [Statistics; 5],
}

#[node]
impl Evaluate {
    fn process(&mut self, truth: &Truth, container: Option<&Container>) -> Score {
        let error = container.zip(truth.container).map(|(found, truth)| pose_error(&found.pose, &truth));
        let error = error.filter(|e| e.position().norm() <= self.max_distance && e.theta.abs() <= self.max_angle);
        if let Some(statistics) = self.scenarios.get_mut(truth.scenario as usize) {
            statistics.count(truth.container.is_some(), container.is_some(), error);
        }
        let all = self.combined();
        Score { scenario: truth.scenario, scans: all.scans, true_rate: all.true_rate(), false_rate: all.false_rate() }
    }

    /// Prints the table of results to standard output.
    #[slot]
    fn print(&mut self) {
        // A table that cannot be shown stops no robot.
        let _ = say(&format!("{self}\n"));
    }

    /// Results of one scenario.
    pub fn statistics(&self, scenario: Scenario) -> &Statistics {
        &self.scenarios[scenario as usize]
    }

    /// Results of all scenarios together.
    pub fn combined(&self) -> Statistics {
        self.scenarios.iter().fold(Statistics::default(), |all, one| all.plus(one))
    }
}

/// Intermediate results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Scenario of the last scan.
    pub scenario: Scenario,
    /// Number of scans.
    pub scans: u64,
    /// Rate of true positives among the scans with a container, from 0 to 1; `None` before the first one.
    pub true_rate: Option<f64>,
    /// Rate of scans with a false detection, from 0 to 1; `None` before the first scan.
    pub false_rate: Option<f64>,
}

/// Pose of a detection in the frame of the container, rotated by 180° if that gives the smaller error.
pub(crate) fn pose_error(found: &Pose2, truth: &Pose2) -> Pose2 {
    let error = found.relative_to(truth);
    if error.theta.abs() <= FRAC_PI_2 { error } else { found.relative_to(&Pose2 { theta: truth.theta + PI, ..*truth }) }
}

/// Counts and errors of detections.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Statistics {
    /// Number of all scans.
    pub scans: u64,
    /// Number of scans with a container.
    pub containers: u64,
    /// Number of scans with a true detection.
    pub found: u64,
    /// Number of scans with a false detection.
    pub wrong: u64,
    /// Sums of the errors in x (m), y (m) and heading (rad), and of their squares.
    sums: [(f64, f64); 3],
}

impl Statistics {
    /// Counts a scan; `error` is that of a true detection.
    fn count(&mut self, container: bool, detection: bool, error: Option<Pose2>) {
        self.scans += 1;
        self.containers += u64::from(container);
        self.found += u64::from(error.is_some());
        self.wrong += u64::from(detection && error.is_none());
        if let Some(Pose2 { x, y, theta }) = error {
            for ((sum, squares), e) in self.sums.iter_mut().zip([x, y, theta].map(f64::from)) {
                *sum += e;
                *squares += e * e;
            }
        }
    }

    fn plus(mut self, other: &Self) -> Self {
        self.scans += other.scans;
        self.containers += other.containers;
        self.found += other.found;
        self.wrong += other.wrong;
        for (a, b) in self.sums.iter_mut().zip(other.sums) {
            *a = (a.0 + b.0, a.1 + b.1);
        }
        self
    }

    /// Share of the scans with a container in which it was found, or `None` without such scans.
    pub fn true_rate(&self) -> Option<f64> {
        ratio(self.found, self.containers)
    }

    /// Share of the scans with a false detection, or `None` without scans.
    pub fn false_rate(&self) -> Option<f64> {
        ratio(self.wrong, self.scans)
    }

    /// Mean and standard deviation of the errors in x (m), y (m) and heading (rad), or `None` without detections.
    pub fn errors(&self) -> Option<[(f64, f64); 3]> {
        let n = self.found as f64;
        (self.found > 0).then(|| {
            self.sums.map(|(sum, squares)| {
                let mean = sum / n;
                (mean, (squares / n - mean * mean).max(0.0).sqrt())
            })
        })
    }
}

fn ratio(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

/// The table of results: rates by scenario and combined, then errors.
impl fmt::Display for Evaluate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let combined = self.combined();
        let columns: Vec<&Statistics> = self.scenarios.iter().chain([&combined]).collect();
        write!(f, "{:<14}", "")?;
        for scenario in Scenario::ALL {
            write!(f, "{scenario:>15}")?;
        }
        write!(f, "{:>15}", "combined")?;
        row(f, "scans", &columns, |s| Some(s.scans.to_string()))?;
        row(f, "TPR (%)", &columns, |s| s.true_rate().map(percent))?;
        row(f, "FPR (%)", &columns, |s| s.false_rate().map(percent))?;
        for (i, (name, scale)) in
            [("x error (cm)", 100.0), ("y error (cm)", 100.0), ("heading (deg)", 180.0 / core::f64::consts::PI)]
                .iter()
                .enumerate()
        {
            row(f, name, &columns, |s| s.errors().map(|e| format!("{:.2} ± {:.2}", e[i].0 * scale, e[i].1 * scale)))?;
        }
        Ok(())
    }
}

fn percent(rate: f64) -> String {
    format!("{:.1}", rate * 100.0)
}

/// Writes one row, with a dash for a missing value.
fn row(
    f: &mut fmt::Formatter<'_>,
    name: &str,
    columns: &[&Statistics],
    cell: impl Fn(&Statistics) -> Option<String>,
) -> fmt::Result {
    write!(f, "\n{name:<14}")?;
    columns.iter().try_for_each(|s| write!(f, "{:>15}", cell(s).as_deref().unwrap_or("–")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    fn truth(pose: Option<Pose2>) -> Truth {
        Truth { scenario: if pose.is_some() { Scenario::Random } else { Scenario::Empty }, container: pose }
    }

    fn found(pose: Pose2) -> Container {
        Container { pose, error: 0.0, inliers: 8, outliers: 0, wheels: 4, model: 0 }
    }

    #[test]
    fn true_false_and_missing_detections() {
        let mut node = Evaluate::construct((0.3, 0.35));
        let pose = Pose2::new(2.0, 0.0, 1.0);
        node.process(&truth(Some(pose)), Some(&found(pose)));
        node.process(&truth(Some(pose)), None);
        node.process(&truth(Some(pose)), Some(&found(Pose2 { x: 2.5, ..pose })));
        node.process(&truth(Some(pose)), Some(&found(Pose2 { theta: 1.5, ..pose })));
        node.process(&truth(None), None);
        let score = node.process(&truth(None), Some(&found(pose)));
        let random = node.statistics(Scenario::Random);
        assert_eq!((random.scans, random.containers, random.found, random.wrong), (4, 4, 1, 2));
        let empty = node.statistics(Scenario::Empty);
        assert_eq!((empty.true_rate(), empty.false_rate()), (None, Some(0.5)));
        assert_eq!((score.scans, score.true_rate, score.false_rate), (6, Some(0.25), Some(0.5)));
    }

    #[test]
    fn errors_are_in_the_frame_of_the_container() {
        let mut node = Evaluate::construct((0.3, 0.35));
        let pose = Pose2::new(2.0, 1.0, FRAC_PI_2);
        for x in [0.1, 0.2] {
            // The container faces left: 0.1 m in its x is 0.1 m in y.
            node.process(&truth(Some(pose)), Some(&found(Pose2 { y: 1.0 + x, ..pose })));
        }
        let [x, y, theta] = node.combined().errors().expect("detections");
        assert!((x.0 - 0.15).abs() < 1e-6 && (x.1 - 0.05).abs() < 1e-6, "{x:?}");
        assert!(y.0.abs() < 1e-6 && theta.1.abs() < 1e-6);
    }

    #[test]
    fn half_a_turn_is_no_error() {
        let pose = Pose2::new(2.0, 1.0, 0.5);
        let error = pose_error(&Pose2 { theta: 0.5 - PI, ..pose }, &pose);
        assert!(error.position().norm() < 1e-6 && error.theta.abs() < 1e-6);
    }

    #[test]
    fn the_table_has_all_columns() {
        let mut node = Evaluate::construct((0.3, 0.35));
        let pose = Pose2::new(2.0, 1.0, 0.5);
        node.process(&truth(Some(pose)), Some(&found(pose)));
        let table = node.to_string();
        assert_eq!(table.lines().count(), 7);
        assert!(table.lines().all(|line| line.chars().count() == 14 + 6 * 15), "{table}");
        assert!(table.contains("100.0") && table.contains("0.00 ± 0.00"));
    }
}
