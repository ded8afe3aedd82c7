//! Computing times of the detection (thesis table 6.3).

use crate::{Finder, Search, world::SimLaser};
use apex_rt::{Construct as _, Ctx, Event, Out, Time};
use core::{f32::consts::PI, fmt};
use std::time::Instant;

/// Computing times of the steps of the detection of carts.
#[derive(Debug, Clone, Default)]
pub struct Times {
    steps: Vec<(&'static str, Vec<f64>)>,
}

impl Times {
    /// Measures the search in the simulated rooms of these seeds, on one thread.
    ///
    /// # Errors
    /// If a scan has too many segments.
    pub fn measure(seeds: &[u64]) -> Result<Self, String> {
        let (mut segmentation, mut search) = (Vec::new(), Vec::new());
        for seed in seeds {
            let mut laser = SimLaser::construct((*seed, 20, 50, 1.5 * PI, PI / 360.0, 0.01, 0.005));
            let mut finder = Finder::new(&Search::CART);
            let (mut scan, mut truth, mut pose) = (Out::new(), Out::new(), Out::new());
            loop {
                let ctx = Ctx::new(Time::ZERO);
                laser.process(&ctx, &mut scan, &mut truth, &mut pose, Event::unconnected(), Event::unconnected());
                let Some(scan) = scan.get().filter(|_| !laser.finished()) else { break };
                let start = Instant::now();
                finder.segment(scan).map_err(|e| e.to_string())?;
                let middle = Instant::now();
                core::hint::black_box(finder.search());
                segmentation.push(middle.duration_since(start).as_secs_f64());
                search.push(middle.elapsed().as_secs_f64());
            }
        }
        Ok(Self { steps: vec![("2D segmentation", segmentation), ("2D search", search)] })
    }
}

impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<18}{:>12}{:>12}{:>12}{:>12}", "step", "scans", "mean (ms)", "± (ms)", "99 % (ms)")?;
        for (name, times) in &self.steps {
            let n = times.len().max(1) as f64;
            let mean = times.iter().sum::<f64>() / n;
            let deviation = (times.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / n).sqrt();
            let mut sorted = times.clone();
            sorted.sort_by(f64::total_cmp);
            let high = sorted.get(sorted.len() * 99 / 100).copied().unwrap_or_default();
            let [mean, deviation, high] = [mean, deviation, high].map(|t| format!("{:.3}", 1e3 * t));
            write!(f, "\n{name:<18}{:>12}{mean:>12}{deviation:>12}{high:>12}", times.len())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_a_line_for_each_step() {
        let times = Times { steps: vec![("a", vec![0.001, 0.003]), ("b", vec![])] };
        let table = times.to_string();
        assert_eq!(table.lines().count(), 3);
        assert!(table.contains("2.000") && table.contains("0.000"), "{table}");
    }
}
