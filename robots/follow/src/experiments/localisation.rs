use crate::world::{Options, State};
use apex_nodes::{
    localize::{FixUse, FusionSettings, PoseFilter, PositionFix},
    nav::Twist,
    scan::{Pose2, PoseChange, wrap_angle},
};
use apex_rt::Time;
use apex_sim::{
    Latency, Simulation,
    outdoor::{Gnss, GnssErrors, Imu, Sample},
};
use std::{fmt, ops::Range};

/// Periods of the inertial sensor and the wheels, in ms, and time between two comparisons with the truth.
const INERTIAL: i64 = 10;
const WHEELS: i64 = 50;
const COMPARED: i64 = 500;
/// Highest speed of the robot, in m/s, its sideways acceleration, in m/s², the distance that it keeps from the runner,
/// and the distance by which it looks ahead on its way, in m.
const SPEED: f32 = 2.8;
const SIDEWAYS: f32 = 1.5;
const KEPT: f32 = 3.0;
const AHEAD: f32 = 2.5;
/// Spell without positions.
const OUTAGE: Range<Time> = Time::from_secs(300)..Time::from_secs(360);

/// Sensors that a filter has.
#[derive(Debug, Clone, Copy)]
struct Sensors {
    name: &'static str,
    gyro: bool,
    gnss: bool,
    outage: bool,
    /// `true` if the length of a metre by wheels is estimated.
    scale: bool,
}

/// Rows of the table.
const ROWS: [Sensors; 7] = [
    Sensors { name: "wheels", gyro: false, gnss: false, outage: false, scale: true },
    Sensors { name: "wheels, gyroscope", gyro: true, gnss: false, outage: false, scale: true },
    Sensors { name: "wheels, GNSS", gyro: false, gnss: true, outage: false, scale: true },
    Sensors { name: "wheels, gyroscope, GNSS", gyro: true, gnss: true, outage: false, scale: true },
    Sensors { name: "  without the length of a metre", gyro: true, gnss: true, outage: false, scale: false },
    Sensors { name: "wheels, gyroscope, GNSS, outage", gyro: true, gnss: true, outage: true, scale: true },
    Sensors { name: "  without the length of a metre", gyro: true, gnss: true, outage: true, scale: false },
];

/// Errors of a pose.
#[derive(Debug, Clone, Copy, Default)]
struct Errors {
    count: u64,
    /// Sums of the squares of the position and of the heading, and their largest values.
    squares: [f64; 2],
    most: [f64; 2],
    /// Largest error of the position in the outage.
    in_outage: f64,
    /// Sum of the squared errors, normalised by the covariance.
    nees: f64,
    /// Number of fixes that were used, and of all.
    fixes: [u64; 2],
    losses: u64,
}

/// Errors of the pose with different sensors, on the same drives.
#[derive(Debug, Clone, Default)]
pub struct Localisation {
    rows: [Errors; ROWS.len()],
    /// Distance, in m, and number of drives.
    driven: f64,
    drives: u32,
}

/// Drives the robot along the way of the runner of a seed and behind him, by its true pose, until he has arrived, and
/// localises it with different sensors.
pub fn localisation(seed: u64, length: f32) -> Localisation {
    let options = Options { seed, length, people: false, fault: None };
    let mut drive = Drive::new(&options);
    let mut filters = ROWS.map(|row| drive.filter(&row));
    let mut result = Localisation { drives: 1, ..Localisation::default() };
    let mut ms = 0;
    while drive.state.report().ending.is_none() {
        ms += INERTIAL;
        drive.step(Time::from_millis(ms), ms, &mut filters, &mut result);
    }
    result.driven = f64::from(drive.state.report().driven);
    result
}

/// Robot on its way.
struct Drive {
    state: State,
    imu: Imu,
    gnss: Gnss,
    last: Sample,
    /// Fixes that have not arrived.
    waiting: Latency<PositionFix>,
    /// Distance along the way, in m.
    along: f32,
}

impl Drive {
    fn new(options: &Options) -> Self {
        let mut state = State::new(options);
        Self {
            imu: state.imu(),
            gnss: state.gnss(),
            last: state.samples().last().copied().unwrap_or_default(),
            state,
            waiting: Latency::default(),
            along: -KEPT,
        }
    }

    /// Filter for these sensors. Without satellites it knows where it starts.
    fn filter(&self, row: &Sensors) -> PoseFilter {
        let standard = FusionSettings::default();
        let scale_spread = if row.scale { standard.scale_spread } else { 0.0 };
        let mut filter = PoseFilter::new(FusionSettings { scale_spread, ..standard });
        if !row.gnss {
            filter.begin(&self.state.pose(), (0.01, 0.001));
        }
        filter
    }

    fn step(&mut self, now: Time, ms: i64, filters: &mut [PoseFilter; ROWS.len()], result: &mut Localisation) {
        self.state.advance(now);
        let after = self.state.samples().last().copied().unwrap_or_default();
        let inertial = self.imu.measure(&self.last, &after, 1e-3 * INERTIAL as f32);
        self.last = after;
        let with_gyro = filters.iter_mut().zip(&ROWS).filter(|(_, row)| row.gyro);
        with_gyro.for_each(|(filter, _)| filter.turn(now, &inertial));
        if ms % WHEELS == 0 {
            self.steer();
            let wheels = self.state.wheels();
            for filter in filters.iter_mut() {
                filter.drive(now, &wheels);
            }
        }
        if let Some(fix) = self.received(now) {
            for (i, filter) in filters.iter_mut().enumerate() {
                result.rows[i].fix(&ROWS[i], filter, &fix);
            }
        }
        if ms % COMPARED == 0 {
            for (i, filter) in filters.iter().enumerate() {
                result.rows[i].compare(filter, &self.state.pose(), now);
            }
        }
    }

    /// Follows the way of the runner.
    fn steer(&mut self) {
        let (here, track) = (self.state.pose(), &self.state.track);
        let near = |s: f32| (track.way(s) - here.position()).norm_squared();
        while near(self.along + 0.1) < near(self.along) {
            self.along += 0.1;
        }
        let goal = here.to_inner(track.way(self.along + AHEAD));
        // An arc through the goal.
        let bend = 2.0 * goal.y / goal.norm_squared().max(0.1);
        let gap = self.state.people().first().map_or(0.0, |runner| (runner.position - here.position()).norm());
        let most = SPEED.min((SIDEWAYS / bend.abs().max(1e-3)).sqrt());
        let speed = (gap - KEPT).clamp(0.0, most);
        self.state.drive(Twist::new(speed, 0.0, speed * bend));
    }

    /// Fix that arrives now.
    fn received(&mut self, now: Time) -> Option<PositionFix> {
        let measured = self.gnss.measure(&self.state.terrain, self.state.pose().position(), now);
        if let Some(fix) = measured.and_then(|fix| State::plane().place(&fix)) {
            self.waiting.send(now + GnssErrors::NEO_M8.latency, fix);
        }
        self.waiting.receive(now)
    }
}

impl Errors {
    fn fix(&mut self, row: &Sensors, filter: &mut PoseFilter, fix: &PositionFix) {
        let is_out = row.outage && OUTAGE.contains(&fix.stamp);
        if !row.gnss || is_out {
            return;
        }
        let (used, change) = filter.fix(fix);
        self.fixes[0] += u64::from(matches!(used, FixUse::Used(_)));
        self.fixes[1] += u64::from(matches!(used, FixUse::Used(_) | FixUse::Refused(_)));
        self.losses += u64::from(change == Some(PoseChange::Lost));
    }

    /// Adds the error at a time, while the pose is known.
    fn compare(&mut self, filter: &PoseFilter, truth: &Pose2, now: Time) {
        if !filter.is_localized() {
            return;
        }
        let estimate = filter.estimate();
        let offset = estimate.pose.position() - truth.position();
        let turn = wrap_angle(estimate.pose.theta - truth.theta);
        let errors = [offset.norm(), turn.abs()].map(f64::from);
        for (i, error) in errors.into_iter().enumerate() {
            self.squares[i] += error * error;
            self.most[i] = self.most[i].max(error);
        }
        if OUTAGE.contains(&now) {
            self.in_outage = self.in_outage.max(errors[0]);
        }
        self.nees += estimate.normalized_error(truth).unwrap_or(f64::INFINITY);
        self.count += 1;
    }

    fn add(&mut self, other: &Self) {
        for i in 0..2 {
            self.squares[i] += other.squares[i];
            self.most[i] = self.most[i].max(other.most[i]);
            self.fixes[i] += other.fixes[i];
        }
        self.in_outage = self.in_outage.max(other.in_outage);
        self.nees += other.nees;
        self.count += other.count;
        self.losses += other.losses;
    }
}

impl Localisation {
    /// Adds the errors on another drive.
    pub fn add(&mut self, other: &Self) {
        self.rows.iter_mut().zip(&other.rows).for_each(|(row, other)| row.add(other));
        self.driven += other.driven;
        self.drives += other.drives;
    }
}

/// Table of the errors, with a line for each set of sensors.
impl fmt::Display for Localisation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<34}   position: RMS, max   heading: RMS, max   300 s to 360 s    NEES   fixes  lost", "")?;
        for (sensors, row) in ROWS.iter().zip(&self.rows) {
            let count = row.count.max(1) as f64;
            let [position, heading] = row.squares.map(|square| (square / count).sqrt());
            let share = 100.0 * row.fixes[0] as f64 / row.fixes[1].max(1) as f64;
            write!(f, "{:<34}{position:>11.2} m{:>8.2} m", sensors.name, row.most[0])?;
            write!(f, "{:>9.1}°{:>8.1}°", heading.to_degrees(), row.most[1].to_degrees())?;
            write!(f, "{:>15.2} m{:>8.2}", row.in_outage, row.nees / count)?;
            let fixes = if row.fixes[1] > 0 { format!("{share:.1} %") } else { "-".to_owned() };
            writeln!(f, "{fixes:>8}{:>6}", row.losses)?;
        }
        writeln!(f, "{} drives, {:.0} m", self.drives, self.driven)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn satellites_bound_the_error() {
        let table = localisation(1, 300.0);
        let rms = |i: usize| (table.rows[i].squares[0] / table.rows[i].count as f64).sqrt();
        assert!(rms(1) < rms(0) && rms(3) < 5.0, "{table}");
        assert!(table.rows[3].fixes[0] > 500 && table.rows[3].losses == 0, "{table}");
    }
}
