use super::{
    BeamModel, MotionNoise, PoseFit, SearchSettings, VisibilityTable,
    beam::Beams,
    bins::{Bins, enough_particles},
    estimate::Cluster,
    particle::{Particle, cumulate, drawn, normalize},
    search::Search,
};
use crate::{
    math::Random,
    scan::{BeamDirections, Pose2, PoseChange, Scan, UncertainPose},
};

/// Minimum number of measured beams of a scan that is used.
const LEAST_BEAMS: usize = 5;
/// Widening of the beam model while the pose is not known: particles are sparse then.
const WIDENED: f32 = 2.0;
/// Rates of the short and the long mean of the agreement with the map (Thrun, Burgard, Fox 2005, table 8.3).
const FAST: f32 = 0.3;
const SLOW: f32 = 0.03;
/// Number of used scans in a row that have to agree before the pose counts as known: a single one fits many places.
const CONFIRMATIONS: u32 = 5;
/// Number of scans that are used after a given pose before the robot has moved: enough to confirm it, unless they do
/// not agree.
const AT_START: u32 = 2 * CONFIRMATIONS;
/// Standard deviations by which the particles spread before each of them, in m and rad: without a motion, none would
/// come nearer to the true pose than the best one of the start.
const AT_REST: (f32, f32) = (0.03, 0.02);
/// Maximum distance between the estimate and its prediction by odometry while the pose is known, in m.
const JUMP: f32 = 1.0;
/// Maximum share of particles that are replaced by poses found by the search, and their number.
const MOST_INJECTED: f32 = 0.3;
const INJECTED: usize = 100;
/// Number of poses that are tried near one found by the search, and their standard deviations in m and rad.
const REFINEMENTS: usize = 20;
const NEARBY: (f32, f32) = (0.15, 0.04);

/// Settings of a [`Filter`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Pose of the scanner in the frame of the robot.
    pub mount: Pose2,
    /// Number of beams of a scan that are compared with the map, at most 128.
    pub beams: usize,
    /// Density of a measured range.
    pub model: BeamModel,
    /// Weight of a scan, from 0 to 1: 1 if the errors of its beams were independent.
    pub trust: f32,
    /// Errors of odometry.
    pub motion: MotionNoise,
    /// Minimum and maximum number of particles.
    pub particles: [usize; 2],
    /// Maximum divergence of the particles from the true distribution (Kullback–Leibler).
    pub divergence: f32,
    /// Distance in m, or rotation in rad, after which a scan is used.
    pub travel: f32,
    /// See `travel`.
    pub turn: f32,
    /// Search on the whole map.
    pub search: SearchSettings,
    /// Number of positions that are tried per scan while the pose is not known.
    pub positions: usize,
    /// Largest standard deviation of the position of a robot that is localized, in m.
    pub certain: f32,
    /// Least share of the beams that agree with the map at the pose of a robot that is localized.
    pub agreement: f32,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// Values for a scanner of 270° in an office building.
impl Default for Settings {
    fn default() -> Self {
        Self {
            mount: Pose2::default(),
            beams: 30,
            model: BeamModel { sigma: 0.1, hit: 0.6, short: 0.3, short_range: 3.0 },
            trust: 0.4,
            motion: MotionNoise { slip: 0.08, veer: 0.08, skid: 0.1 },
            particles: [500, 20_000],
            divergence: 0.05,
            travel: 0.2,
            turn: 0.2,
            search: SearchSettings { sigma: 0.3, trust: 0.4 },
            positions: 1000,
            certain: 0.3,
            agreement: 0.5,
            seed: 1,
        }
    }
}

/// Adaptive Monte Carlo localization on a map of line segments (thesis 6.9): a particle filter with a beam model, a
/// number of particles by KLD sampling (Fox 2003), and particles from a search on the whole map if the agreement with
/// it becomes worse (augmented MCL; Thrun, Burgard, Fox 2005, 8.3.3). Its storage is reserved once.
#[derive(Debug, Clone)]
pub struct Filter {
    table: VisibilityTable,
    settings: Settings,
    particles: Vec<Particle>,
    /// Particles of the next generation, or the poses found by the search.
    next: Vec<Particle>,
    found: Vec<Particle>,
    /// Cumulated weights.
    sums: Vec<f32>,
    bins: Bins,
    exact: Beams,
    wide: Beams,
    search: Search,
    random: Random,
    /// Odometry at the last used scan.
    odometry: Pose2,
    estimate: UncertainPose,
    fit: PoseFit,
    is_localized: bool,
    /// Number of used scans in a row that agreed.
    confirmed: u32,
    /// Number of scans that are still used without a motion.
    at_start: u32,
    /// Short and long mean of the agreement.
    fast: f32,
    slow: f32,
    updates: usize,
    directions: BeamDirections,
}

impl Filter {
    /// Creates a filter for a robot anywhere inside of the building.
    pub fn new(table: VisibilityTable, settings: Settings) -> Self {
        let [least, most] = settings.particles;
        let most = most.max(least).max(1);
        let settings = Settings { particles: [least.clamp(1, most), most], ..settings };
        Self {
            table,
            settings,
            particles: Vec::with_capacity(most),
            next: Vec::with_capacity(most),
            found: Vec::with_capacity(settings.positions),
            sums: Vec::with_capacity(most.max(settings.positions)),
            bins: Bins::new(most),
            exact: Beams::new(&settings.model, 1.0),
            wide: Beams::new(&settings.model, WIDENED),
            search: Search::new(settings.search),
            random: Random::new(settings.seed),
            odometry: Pose2::default(),
            estimate: UncertainPose::default(),
            fit: PoseFit::default(),
            is_localized: false,
            confirmed: 0,
            at_start: 0,
            fast: 0.0,
            slow: 0.0,
            updates: 0,
            directions: BeamDirections::default(),
        }
    }

    /// Table of the map.
    pub const fn table(&self) -> &VisibilityTable {
        &self.table
    }

    /// Returns `true` if the pose is known.
    pub const fn is_localized(&self) -> bool {
        self.is_localized
    }

    /// Estimate at the last used scan: mean and covariance of the heaviest cluster of particles.
    pub const fn estimate(&self) -> &UncertainPose {
        &self.estimate
    }

    /// Agreement of that estimate with the particles and the scan.
    pub const fn fit(&self) -> &PoseFit {
        &self.fit
    }

    /// Poses of all particles.
    pub fn particles(&self) -> impl ExactSizeIterator<Item = &Pose2> + '_ {
        self.particles.iter().map(|particle| &particle.pose)
    }

    /// Estimate of the pose at another odometry since the last used scan.
    pub fn pose_at(&self, odometry: &Pose2) -> Pose2 {
        self.estimate.pose.compose(&odometry.relative_to(&self.odometry))
    }

    /// Forgets the pose: the robot is anywhere inside of the building.
    pub fn restart(&mut self) {
        self.particles.clear();
        (self.is_localized, self.confirmed, self.at_start) = (false, 0, 0);
    }

    /// Begins at a known pose with standard deviations in m and rad. The robot is not localized until scans agree,
    /// which may be before it moves.
    pub fn begin(&mut self, pose: &Pose2, odometry: &Pose2, deviation: (f32, f32)) {
        self.particles.clear();
        let count = self.settings.particles[1].min(4 * self.settings.particles[0]);
        let Self { random, .. } = self;
        let mut near = || Particle { pose: nearby(pose, deviation, random), weight: 1.0 / count as f32 };
        self.particles.extend((0..count).map(|_| near()));
        self.odometry = *odometry;
        (self.is_localized, self.confirmed, self.at_start) = (false, 0, AT_START);
        (self.fast, self.slow) = (0.0, 0.0);
        self.gather();
    }

    /// Takes the heaviest cluster of particles for the pose.
    fn gather(&mut self) {
        let Cluster { estimate, share } = Cluster::heaviest(&self.particles, &mut self.bins);
        self.estimate = estimate;
        self.fit = PoseFit { share, particles: self.particles.len() as u32, ..PoseFit::default() };
    }

    /// Returns `true` if a scan at this odometry would be used: the first one, those that confirm a given pose, and
    /// then if the robot has moved.
    pub fn is_due(&self, odometry: &Pose2) -> bool {
        let step = odometry.relative_to(&self.odometry);
        self.particles.is_empty()
            || (self.at_start > 0 && !self.is_localized)
            || step.position().norm() >= self.settings.travel
            || step.theta.abs() >= self.settings.turn
    }

    /// Takes the odometry and a scan. The scan is used if it [is due](Self::is_due). Returns a change
    /// of what is known about the pose.
    pub fn update(&mut self, odometry: &Pose2, scan: &Scan) -> Option<PoseChange> {
        let step = odometry.relative_to(&self.odometry);
        let is_first = self.particles.is_empty();
        if !self.is_due(odometry) {
            return None;
        }
        self.select(scan);
        if self.exact.len() < LEAST_BEAMS {
            // A blind scanner: the estimate follows odometry.
            return None;
        }
        let is_at_start = self.at_start > 0;
        self.at_start = self.at_start.saturating_sub(1);
        let predicted = self.pose_at(odometry);
        self.odometry = *odometry;
        if is_first {
            self.find_everywhere();
            if self.particles.is_empty() {
                return None;
            }
        } else {
            let Self { particles, random, settings, .. } = self;
            particles.iter_mut().for_each(|p| p.pose = settings.motion.moved(&p.pose, &step, random));
            if is_at_start && !self.is_localized {
                particles.iter_mut().for_each(|p| p.pose = nearby(&p.pose, AT_REST, random));
            }
            self.weigh();
        }
        self.judge(&predicted)
    }

    fn select(&mut self, scan: &Scan) {
        let Settings { model, mount, beams, .. } = &self.settings;
        self.updates += 1;
        self.exact.select(model, scan, &mut self.directions, mount, *beams, self.updates);
        self.wide.select(model, scan, &mut self.directions, mount, *beams, self.updates);
        self.search.select(scan, mount);
    }

    /// Fills all places with poses found by the search.
    fn find_everywhere(&mut self) {
        let Self { search, table, random, particles, settings, .. } = self;
        particles.extend((0..settings.particles[1]).map_while(|_| search.draw(table, random)));
        normalize(particles);
        (self.fast, self.slow) = (0.0, 0.0);
    }

    fn weigh(&mut self) {
        let beams = if self.is_localized { &self.exact } else { &self.wide };
        let trust = self.settings.trust;
        for particle in &mut self.particles {
            // All weights are the same after the last generation was drawn.
            particle.weight = trust * beams.log_likelihood(&self.table, &particle.pose);
        }
        let highest = normalize(&mut self.particles);
        // Mean density per beam of the best particle.
        let quality = (highest / (trust * beams.len() as f32)).exp();
        for (mean, rate) in [(&mut self.fast, FAST), (&mut self.slow, SLOW)] {
            *mean = if *mean == 0.0 { quality } else { *mean + rate * (quality - *mean) };
        }
    }

    /// Estimates the pose, decides if it is known, and draws the next generation.
    fn judge(&mut self, predicted: &Pose2) -> Option<PoseChange> {
        self.gather();
        let agreement = self.exact.agreement(&self.table, &self.estimate.pose);
        (self.fit.hits, self.fit.beyond) = (agreement.hits, agreement.beyond);
        let Settings { certain, agreement, .. } = self.settings;
        let (UncertainPose { pose, .. }, PoseFit { hits, share, .. }) = (self.estimate, self.fit);
        let was = self.is_localized;
        let jumped = (pose.position() - predicted.position()).norm() > JUMP;
        if was {
            self.is_localized = hits >= 0.5 * agreement && share > 0.5 && !jumped;
            self.confirmed = 0;
        } else {
            let agrees = hits >= agreement && share > 0.95 && self.estimate.deviation() < certain && !jumped;
            self.confirmed = if agrees { self.confirmed + 1 } else { 0 };
            self.is_localized = self.confirmed >= CONFIRMATIONS;
        }
        self.resample();
        match (was, self.is_localized) {
            (false, true) => Some(PoseChange::Localized),
            (true, false) => Some(PoseChange::Lost),
            _ => None,
        }
    }

    /// Draws the next generation by weight, as many particles as KLD sampling asks for, after those from the search.
    fn resample(&mut self) {
        self.next.clear();
        self.bins.clear();
        self.inject();
        cumulate(&self.particles, &mut self.sums);
        let [least, most] = self.settings.particles;
        let mut enough = least;
        while self.next.len() < enough.min(most) {
            let particle = drawn(&self.particles, &self.sums, &mut self.random);
            let before = self.bins.len();
            self.bins.add(&particle, 1.0);
            if self.bins.len() > before {
                enough = least.max(enough_particles(self.bins.len(), self.settings.divergence));
            }
            self.next.push(particle);
        }
        core::mem::swap(&mut self.particles, &mut self.next);
    }

    /// Adds poses found by the search to the next generation, the more the worse the agreement has become.
    fn inject(&mut self) {
        let worse = if self.slow > 0.0 { 1.0 - self.fast / self.slow } else { 0.0 };
        let share = match self.is_localized {
            // Only the given pose is asked for: other places may look alike until the robot moves.
            false if self.at_start > 0 => 0.0,
            // Much furniture, or a person beside the scanner: the pose is kept.
            true if self.fit.hits >= self.settings.agreement => 0.0,
            true => worse - 0.2,
            false => worse.max(0.05),
        };
        let count = (share.clamp(0.0, MOST_INJECTED) * self.particles.len() as f32) as usize;
        if count == 0 {
            return;
        }
        self.found.clear();
        let Self { search, table, random, found, settings, .. } = self;
        found.extend((0..settings.positions).map_while(|_| search.draw(table, random)));
        normalize(found);
        cumulate(found, &mut self.sums);
        if self.found.is_empty() {
            return;
        }
        for _ in 0..count.min(INJECTED) {
            let found = drawn(&self.found, &self.sums, &mut self.random);
            let refined = self.refined(&found);
            self.next.push(refined);
        }
    }

    /// Best of several poses near one.
    fn refined(&mut self, particle: &Particle) -> Particle {
        let Self { wide, table, random, .. } = self;
        let mut best = (wide.log_likelihood(table, &particle.pose), particle.pose);
        for _ in 0..REFINEMENTS {
            let pose = nearby(&particle.pose, NEARBY, random);
            let density = wide.log_likelihood(table, &pose);
            if density > best.0 {
                best = (density, pose);
            }
        }
        Particle { pose: best.1, weight: 0.0 }
    }
}

/// Random pose near another one.
fn nearby(pose: &Pose2, (position, heading): (f32, f32), random: &mut Random) -> Pose2 {
    let error = Pose2::new(random.normal(position), random.normal(position), random.normal(heading));
    pose.compose(&error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        localize::{TableSettings, table::tests::maze},
        scan::Point2,
    };

    fn filter(settings: Settings) -> Filter {
        let table = VisibilityTable::build(&maze(5, 12), TableSettings::default(), |_| ()).expect("a table");
        Filter::new(table, settings)
    }

    fn settings() -> Settings {
        Settings { particles: [300, 5000], positions: 300, ..Settings::default() }
    }

    /// Scan at a pose of the robot with noise of 2 cm.
    fn scan(filter: &Filter, robot: &Pose2, random: &mut Random) -> Scan {
        let at = robot.compose(&filter.settings.mount);
        let mut scan = Scan { angle_min: -2.35, angle_increment: 4.7 / 270.0, range_max: 30.0, ..Scan::default() };
        let view = filter.table.view(at.position());
        scan.ranges.extend((0..271).map(|beam| {
            let angle = at.theta + scan.angle_min + beam as f32 * scan.angle_increment;
            let range = view.map_or(f32::INFINITY, |view| view.range(Point2::polar(1.0, angle), angle));
            range + random.normal(0.02)
        }));
        scan
    }

    /// Drives in a circle. Returns the errors of the pose after each step, or `None` while it is not known.
    fn drive(filter: &mut Filter, from: &Pose2, steps: usize) -> Vec<Option<f32>> {
        let (step, mut random) = (Pose2::new(0.25, 0.0, 0.06), Random::new(9));
        let mut truth = *from;
        // Odometry in a frame of its own, which goes on over several calls.
        let mut odometry = filter.odometry;
        (0..steps)
            .map(|_| {
                let scan = scan(filter, &truth, &mut random);
                filter.update(&odometry, &scan);
                let error = (filter.pose_at(&odometry).position() - truth.position()).norm();
                truth = truth.compose(&step);
                odometry = odometry.compose(&Pose2::new(0.255, 0.0, 0.062));
                filter.is_localized().then_some(error)
            })
            .collect()
    }

    fn is_right(errors: &[Option<f32>]) -> bool {
        errors.iter().rev().take(10).all(|error| error.is_some_and(|error| error < 0.15))
    }

    #[test]
    fn a_robot_anywhere_finds_its_pose_and_also_after_it_was_carried_away() {
        let mount = Pose2::new(0.3, -0.1, 0.2);
        let mut filter = filter(Settings { mount, ..settings() });
        let start = drive(&mut filter, &Pose2::new(14.0, 6.0, 1.0), 60);
        assert!(start[0].is_none() && is_right(&start), "{start:?}");
        let carried = drive(&mut filter, &Pose2::new(5.0, 11.0, -2.0), 100);
        assert!(is_right(&carried), "{carried:?}");
        assert!(carried.iter().any(Option::is_none), "it noticed");
    }

    #[test]
    fn a_given_pose_is_kept() {
        let mut filter = filter(settings());
        let truth = Pose2::new(6.0, 5.0, 0.3);
        filter.begin(&truth.compose(&Pose2::new(0.4, -0.3, 0.1)), &Pose2::default(), (0.5, 0.2));
        assert!(!filter.is_localized() && filter.estimate().deviation() > 0.5);
        assert!(is_right(&drive(&mut filter, &truth, 25)));
        filter.restart();
        assert!(!filter.is_localized());
    }

    #[test]
    fn a_given_pose_that_scans_confirm_is_known_before_the_robot_moves() {
        let (mut filter, at) = (filter(settings()), Pose2::default());
        let truth = Pose2::new(6.0, 5.0, 0.3);
        let mut known = |given: &Pose2| {
            filter.begin(given, &at, (0.2, 0.2));
            let mut random = Random::new(3);
            let changes: Vec<Option<PoseChange>> = (0..30)
                .map(|_| {
                    let scan = scan(&filter, &truth, &mut random);
                    filter.update(&at, &scan)
                })
                .collect();
            let error = (filter.pose_at(&at).position() - truth.position()).norm();
            (changes.iter().position(|change| *change == Some(PoseChange::Localized)), error)
        };
        let (after, error) = known(&truth.compose(&Pose2::new(0.15, -0.1, 0.05)));
        assert!(after.is_some_and(|scans| scans < 10) && error < 0.1, "{after:?}, {error} m");
        // A wrong one is not believed.
        assert_eq!(known(&Pose2::new(14.0, 6.0, 1.0)).0, None);
    }

    #[test]
    fn the_same_seed_gives_the_same_poses_and_storage_does_not_grow() {
        let run = |seed| {
            let mut filter = filter(Settings { seed, ..settings() });
            let sizes = |f: &Filter| [&f.particles, &f.next, &f.found].map(Vec::capacity);
            let before = (sizes(&filter), filter.sums.capacity());
            let errors = drive(&mut filter, &Pose2::new(14.0, 6.0, 1.0), 30);
            assert_eq!(before, {
                let mut after = sizes(&filter);
                // Both generations change places.
                after[..2].sort_unstable();
                (after, filter.sums.capacity())
            });
            (errors, *filter.estimate())
        };
        assert_eq!(run(1), run(1));
        assert_ne!(run(1).1, run(2).1);
    }

    #[test]
    fn a_blind_scanner_leaves_the_pose_to_odometry() {
        let mut filter = filter(settings());
        let truth = Pose2::new(6.0, 5.0, 0.3);
        filter.begin(&truth, &Pose2::default(), (0.1, 0.1));
        let before = *filter.estimate();
        let far = Pose2::new(3.0, 0.0, 0.0);
        for scan in [
            Scan::default(),
            Scan { ranges: [f32::NAN; 100].into_iter().collect(), ..Scan::default() },
            Scan { ranges: [1.0; 3].into_iter().collect(), angle_increment: f32::NAN, ..Scan::default() },
        ] {
            assert_eq!((filter.update(&far, &scan), *filter.estimate()), (None, before));
        }
        assert!((filter.pose_at(&far).position() - before.pose.position()).norm() > 2.9);
        let odd = Scan { ranges: [1.0; 50].into_iter().collect(), angle_increment: f32::NAN, ..Scan::default() };
        filter.update(&far, &odd);
        assert!(filter.estimate().pose.is_finite());
    }

    #[test]
    fn a_map_without_an_inside_gives_no_pose() {
        let mut map = crate::map::VectorMap::default();
        map.add(Point2::default(), Point2::new(1.0, 0.0)).expect("a wall");
        let table = VisibilityTable::build(&map, TableSettings::default(), |_| ()).expect("a table");
        let mut filter = Filter::new(table, settings());
        let mut scan = Scan { angle_increment: 0.1, ..Scan::default() };
        scan.ranges.extend([1.0; 30]);
        for i in 0..3 {
            assert_eq!(filter.update(&Pose2::new(i as f32, 0.0, 0.0), &scan), None);
        }
        assert!(!filter.is_localized() && filter.particles().len() == 0);
    }
}
