use super::{RunReport, clock, seconds, shortened};
use std::{fmt, fmt::Write as _};

/// Number of columns for the names of phases.
const NAME: usize = 44;

impl RunReport {
    /// Table of the result: the score, and the duration of each phase.
    pub fn table(&self) -> String {
        let mut table = String::new();
        // Writing to a `String` cannot fail.
        let _ = self.write_score(&mut table).and_then(|()| self.write_phases(&mut table));
        table
    }

    fn write_score(&self, f: &mut String) -> fmt::Result {
        let report = &self.report;
        writeln!(f, "Run of seed {}: {} min", self.seed, clock(self.end()))?;
        let rows = [
            ("points", report.points()),
            ("penalties", report.penalties()),
            ("deliveries", report.deliveries.len()),
            ("collisions caused", report.caused()),
            ("collisions suffered", report.suffered()),
        ];
        rows.iter().try_for_each(|(name, value)| writeln!(f, "{name:<20}{value:>8}"))?;
        let rivals = report.rivals.map(|rival| rival.points.to_string()).join(", ");
        writeln!(f, "{:<20}{rivals:>8}", "points of rivals")?;
        writeln!(f, "{:<20}{:>8.1} m", "distance driven", report.distance)
    }

    fn write_phases(&self, f: &mut String) -> fmt::Result {
        write!(f, "\n{:<NAME$}{:>10}{:>9}{:>8}", "phase", "s", "share", "count")?;
        for name in self.phase_names() {
            let times = self.phases.iter().filter(|phase| phase.name == name);
            let (mut sum, mut count) = (0.0, 0);
            for phase in times {
                sum += seconds(phase.until) - seconds(phase.from);
                count += 1;
            }
            let share = 100.0 * sum / self.end().max(f32::MIN_POSITIVE);
            write!(f, "\n{:<NAME$}{sum:>10.1}{share:>7.0} %{count:>8}", shortened(name, NAME - 2))?;
        }
        Ok(())
    }
}
