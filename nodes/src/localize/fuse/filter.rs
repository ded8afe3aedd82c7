use super::{
    Inertial, PositionFix,
    align::{Alignment, POINTS},
    gyro::{Gyro, Turned},
    past::{Past, Place, seconds, vector, wrapped},
};
use crate::{
    localize::MotionNoise,
    scan::{Point2, Pose2, PoseChange, UncertainPose},
};
use apex_rt::Time;
use nalgebra::{Matrix2, SMatrix, SVector, Vector2};

/// Number of states: x, y, heading, bias of the gyroscope, length of a metre of the wheels, slow error of the fixes.
pub(super) const STATES: usize = 7;
pub(super) const THETA: usize = 2;
pub(super) const BIAS: usize = 3;
pub(super) const SCALE: usize = 4;
const WANDER: usize = 5;

pub(super) type State = SVector<f64, STATES>;
pub(super) type Matrix = SMatrix<f64, STATES, STATES>;

/// Motion of the wheels within a step up to which they stand, in m and rad, and time after which the robot does, in s.
const STANDS: f64 = 1e-4;
const SETTLED: f64 = 0.5;
/// Least share of a step that the gyroscope has to cover in order to measure its bias.
const COVERED: f64 = 0.9;
/// Limit of the squared and normalised error of a bias: 99.9 % of χ² with one degree of freedom.
const BIAS_GATE: f64 = 10.83;
/// Way that a turn of 1 rad counts as, in m: see [`MotionNoise`].
const TURN_AS_WAY: f64 = 0.3;
/// Growth of the error of the wheels' length, in 1/√m.
const SCALE_WALK: f64 = 1e-3;

/// Settings of a [`PoseFilter`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FusionSettings {
    /// Errors of the wheels; their errors of the heading count while the gyroscope is silent.
    pub motion: MotionNoise,
    /// Standard deviation of the length of a metre by wheels at the beginning, in m: 0 if it is exact.
    pub scale_spread: f32,
    /// Highest speed of the robot, in m/s. A faster step of the wheels is an error of theirs.
    pub max_speed: f32,
    /// Standard deviation of a turn by the gyroscope after 1 s, in rad (angle random walk).
    pub gyro_noise: f32,
    /// Standard deviation of the bias of the gyroscope at the beginning, in rad/s.
    pub bias_spread: f32,
    /// Standard deviation of the change of the bias in 1 s, in rad/s.
    pub bias_walk: f32,
    /// Position of the antenna in the frame of the robot, in m.
    pub antenna: Point2,
    /// Standard deviation of a fix along each axis from one fix to the next, in m.
    pub fix_noise: f32,
    /// Standard deviation of the slow error that fixes have in common, in m: 0 if there is none.
    pub wander: f32,
    /// Time in which the slow error becomes another one, in s.
    pub wander_time: f32,
    /// Largest squared and normalised error of a fix that is used.
    pub gate: f32,
    /// Time of refused fixes after which the pose is lost, in s.
    pub patience: f32,
    /// Way on which fixes give the heading, in m.
    pub align: f32,
}

/// Values for a skid-steered robot with a gyroscope and a receiver as they are usual.
impl Default for FusionSettings {
    fn default() -> Self {
        Self {
            motion: MotionNoise { slip: 0.05, veer: 0.08, skid: 0.1 },
            scale_spread: 0.05,
            max_speed: 5.0,
            gyro_noise: 1e-3,
            bias_spread: 2e-3,
            bias_walk: 5e-5,
            antenna: Point2::new(0.0, 0.0),
            fix_noise: 0.5,
            wander: 1.6,
            wander_time: 200.0,
            gate: 9.21,
            patience: 15.0,
            align: 10.0,
        }
    }
}

/// Use of a fix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FixUse {
    /// It has corrected the pose. The value is its squared and normalised error.
    Used(f64),
    /// Its squared and normalised error is larger than the gate.
    Refused(f64),
    /// It serves to find the pose, which is not known.
    Aligns,
    /// It is not a position, from the future, or older than the poses that are kept.
    Unusable,
}

/// Extended Kalman filter of wheels, a gyroscope and positions by satellites in the plane (Thrun, Burgard, Fox:
/// Probabilistic Robotics, 2005, table 3.3), with the bias of the gyroscope, the length of a metre by wheels, and the
/// slow error of the fixes as further states. It needs no heap and gives the same result on every platform.
///
/// The way is that of the wheels. The turn is that of the gyroscope, or of the wheels while the gyroscope is silent.
/// While the wheels are silent, the pose stays; when they measure again, the way between counts as straight. A robot
/// whose wheels stand does not turn, so that the gyroscope measures its own bias; a rate beyond the errors of the bias
/// is a turn, by something that pushes the robot.
#[derive(Debug, Clone)]
pub struct PoseFilter {
    settings: FusionSettings,
    pub(super) state: State,
    pub(super) covariance: Matrix,
    /// Sum of all steps.
    odometry: Place,
    past: Past,
    wheels: Option<(Time, Pose2)>,
    /// Time since which the wheels stand.
    stands: Option<Time>,
    gyro: Gyro,
    is_localized: bool,
    alignment: Alignment,
    /// Time of the first refused fix after the last one that was used.
    refused: Option<Time>,
}

/// Step of a motion: what [`PoseFilter::predict`] needs.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Step {
    /// Duration, in s.
    pub time: f64,
    /// Way forward and to the left, in the frame of the middle of the step, in m.
    pub way: [f64; 2],
    /// Turn by the gyroscope.
    pub turned: Turned,
    /// Turn by the wheels in the time without the gyroscope, in rad.
    pub wheels: f64,
}

impl PoseFilter {
    /// Creates a filter that does not know its pose.
    pub fn new(settings: FusionSettings) -> Self {
        let mut filter = Self {
            settings,
            state: State::zeros(),
            covariance: Matrix::zeros(),
            odometry: Place::default(),
            past: Past::default(),
            wheels: None,
            stands: None,
            gyro: Gyro::default(),
            is_localized: false,
            alignment: Alignment::default(),
            refused: None,
        };
        filter.state[SCALE] = 1.0;
        for (i, spread) in [(BIAS, settings.bias_spread), (SCALE, settings.scale_spread)] {
            filter.covariance[(i, i)] = square(spread);
        }
        filter.forget();
        filter
    }

    /// Settings.
    pub const fn settings(&self) -> &FusionSettings {
        &self.settings
    }

    /// Returns `true` if the pose in the frame of the fixes is known.
    pub const fn is_localized(&self) -> bool {
        self.is_localized
    }

    /// Pose without corrections by fixes, which begins at the origin and does not jump.
    pub fn odometry(&self) -> Pose2 {
        self.odometry.into()
    }

    /// Pose in the frame of the fixes, that of odometry while no other one is known.
    pub fn estimate(&self) -> UncertainPose {
        let covariance = core::array::from_fn(|i| core::array::from_fn(|j| self.covariance[(i, j)] as f32));
        UncertainPose { pose: self.place().into(), covariance }
    }

    /// Bias of the gyroscope, in rad/s.
    pub fn bias(&self) -> f32 {
        self.state[BIAS] as f32
    }

    /// Length of a metre by wheels, in m.
    pub fn scale(&self) -> f32 {
        self.state[SCALE] as f32
    }

    fn place(&self) -> Place {
        Place { x: self.state[0], y: self.state[1], theta: self.state[THETA] }
    }

    /// Adds a measurement of the inertial sensor. One that is not a number is ignored.
    pub fn turn(&mut self, now: Time, inertial: &Inertial) {
        if let Some(rate) = inertial.turn_rate() {
            self.gyro.put(now, rate);
        }
    }

    /// Moves by the wheels, whose pose is a sum of their steps in any frame. A pose that is not a number, or whose time
    /// is not after that of the last one, is ignored: the next one has its step. Returns `true` if it is used.
    pub fn drive(&mut self, now: Time, wheels: &Pose2) -> bool {
        if !wheels.is_usable() {
            return false;
        }
        let Some((then, before)) = self.wheels else {
            self.wheels = Some((now, *wheels));
            self.gyro.take(now);
            self.past.put(now, self.odometry);
            return true;
        };
        let time = seconds(then, now);
        if time <= 0.0 {
            return false;
        }
        self.wheels = Some((now, *wheels));
        let turned = self.gyro.take(now);
        let (way, turn) = step_of(&before, wheels);
        let is_possible = libm::hypot(way[0], way[1]) <= f64::from(self.settings.max_speed) * time;
        // A step of wheels that jump says nothing: the robot may be anywhere in reach.
        let (way, turn) = if is_possible { (way, turn) } else { ([0.0; 2], 0.0) };
        let silent = (1.0 - turned.covered / time).clamp(0.0, 1.0);
        let mut step = Step { time, way, turned, wheels: silent * turn };
        let moves = !is_possible || libm::hypot(way[0], way[1]) > STANDS || turn.abs() > STANDS;
        if self.stand(now, moves) && turned.covered >= COVERED * time && self.measure_bias(&turned) {
            step.turned = Turned::default();
        }
        self.predict(&step);
        if !is_possible {
            let reach = f64::from(self.settings.max_speed) * time;
            (0..2).for_each(|i| self.covariance[(i, i)] += reach * reach);
        }
        self.past.put(now, self.odometry);
        true
    }

    /// Returns `true` if the wheels have stood for long enough.
    fn stand(&mut self, now: Time, moves: bool) -> bool {
        let since = *self.stands.get_or_insert(now);
        if moves {
            self.stands = None;
        }
        !moves && seconds(since, now) >= SETTLED
    }

    /// Takes what the gyroscope measures while the robot stands for its bias. Returns `false` if it cannot be.
    fn measure_bias(&mut self, turned: &Turned) -> bool {
        let noise = square(self.settings.gyro_noise) / turned.covered;
        let error = turned.angle / turned.covered - self.state[BIAS];
        let h = SMatrix::<f64, 1, STATES>::from_fn(|_, i| f64::from(u8::from(i == BIAS)));
        let variance = self.covariance[(BIAS, BIAS)] + noise;
        let is_bias = variance > 0.0 && error * error <= BIAS_GATE * variance;
        if is_bias {
            let gain = self.covariance * h.transpose() / variance;
            self.correct(&gain, &SMatrix::from([error]), &h, &SMatrix::from([noise]));
        }
        is_bias
    }

    /// Moves the pose and odometry, whose errors grow.
    fn predict(&mut self, step: &Step) {
        let before = self.state;
        let jacobian = jacobian(&before, step);
        self.state = moved(&before, step);
        self.covariance = jacobian * self.covariance * jacobian.transpose() + self.noise(step);
        let fade = self.remembered(step.time);
        for i in WANDER..STATES {
            self.state[i] *= fade;
            self.covariance.row_mut(i).scale_mut(fade);
            self.covariance.column_mut(i).scale_mut(fade);
            self.covariance[(i, i)] += square(self.settings.wander) * (1.0 - fade * fade);
        }
        self.tidy();
        let mut odometry = before;
        (odometry[0], odometry[1], odometry[THETA]) = (self.odometry.x, self.odometry.y, self.odometry.theta);
        let odometry = moved(&odometry, step);
        self.odometry = Place { x: odometry[0], y: odometry[1], theta: wrapped(odometry[THETA]) };
    }

    /// Share of the slow error of the fixes that is left after some time, in s.
    fn remembered(&self, time: f64) -> f64 {
        libm::exp(-time / f64::from(self.settings.wander_time).max(1e-3))
    }

    /// Covariance that a step adds, the wander apart.
    fn noise(&self, step: &Step) -> Matrix {
        let FusionSettings { motion, gyro_noise, bias_walk, scale_spread, .. } = self.settings;
        let way = libm::hypot(step.way[0], step.way[1]);
        let silent = (1.0 - step.turned.covered / step.time.max(1e-9)).clamp(0.0, 1.0);
        let (turn, turned_by_wheels) = (step.turned.angle.abs() + step.wheels.abs(), step.wheels.abs());
        let mut noise = Matrix::zeros();
        let slip = square(motion.slip) * (way + TURN_AS_WAY * turn);
        (noise[(0, 0)], noise[(1, 1)]) = (slip, slip);
        noise[(THETA, THETA)] = square(gyro_noise) * step.turned.covered
            + square(motion.veer) * silent * way
            + square(motion.skid) * turned_by_wheels;
        noise[(BIAS, BIAS)] = square(bias_walk) * step.time;
        noise[(SCALE, SCALE)] = if scale_spread > 0.0 { SCALE_WALK * SCALE_WALK * way } else { 0.0 };
        noise
    }

    /// Corrects the pose by a fix, which may have been measured some time ago: it then tells where the antenna was
    /// before the steps since. While no pose is known, the first fix and one that is far enough from it give it.
    pub fn fix(&mut self, fix: &PositionFix) -> (FixUse, Option<PoseChange>) {
        let is_usable = fix.position.x.abs() <= 1e5 && fix.position.y.abs() <= 1e5;
        let Some(past) = self.past.at(fix.stamp).filter(|_| is_usable) else { return (FixUse::Unusable, None) };
        let antenna = past.to_outer(vector(self.settings.antenna));
        if !self.is_localized {
            let change = self.align(vector(fix.position), antenna, self.variance(fix));
            return (FixUse::Aligns, change);
        }
        let arm = self.odometry.to_inner(antenna);
        match self.correct_position(vector(fix.position), arm, self.variance(fix)) {
            Ok(error) => {
                self.refused = None;
                (FixUse::Used(error), None)
            }
            Err(error) => (FixUse::Refused(error), self.refuse(fix.stamp)),
        }
    }

    /// Variance of the fast error of a fix. A receiver that says that a fix is worse than usual is believed.
    fn variance(&self, fix: &PositionFix) -> f64 {
        let usual = square(self.settings.fix_noise);
        (f64::from(fix.variance) - square(self.settings.wander)).max(usual).min(1e8)
    }

    /// Squared and normalised error of a fix, by which the pose is corrected unless it is beyond the gate (Bar-Shalom,
    /// Li, Kirubarajan: Estimation with Applications to Tracking and Navigation, 2001, 5.4.2).
    fn correct_position(&mut self, position: [f64; 2], arm: [f64; 2], variance: f64) -> Result<f64, f64> {
        let expected = expected_position(&self.state, arm);
        let error = Vector2::from(position) - expected;
        let h = position_jacobian(&self.state, arm);
        let r = Matrix2::from_diagonal_element(variance);
        let s = h * self.covariance * h.transpose() + r;
        let Some(inverse) = s.try_inverse() else { return Err(f64::INFINITY) };
        let nis = error.dot(&(inverse * error));
        // False for NaN.
        if !(nis >= 0.0 && nis <= f64::from(self.settings.gate)) {
            return Err(nis);
        }
        let gain = self.covariance * h.transpose() * inverse;
        self.correct(&gain, &error, &h, &r);
        Ok(nis)
    }

    /// Adds a correction. The covariance is in the form of Joseph, which stays positive (the same, 5.2.6).
    fn correct<const N: usize>(
        &mut self,
        gain: &SMatrix<f64, STATES, N>,
        error: &SVector<f64, N>,
        h: &SMatrix<f64, N, STATES>,
        r: &SMatrix<f64, N, N>,
    ) {
        self.state += gain * error;
        let rest = Matrix::identity() - gain * h;
        self.covariance = rest * self.covariance * rest.transpose() + gain * r * gain.transpose();
        self.tidy();
    }

    /// Brings the heading to [−π, π], and makes the covariance symmetric.
    fn tidy(&mut self) {
        self.state[THETA] = wrapped(self.state[THETA]);
        self.covariance = 0.5 * (self.covariance + self.covariance.transpose());
    }

    /// Notes a refused fix. After too long a time of them the pose is lost.
    fn refuse(&mut self, stamp: Time) -> Option<PoseChange> {
        let since = *self.refused.get_or_insert(stamp);
        if seconds(since, stamp) < f64::from(self.settings.patience) {
            return None;
        }
        self.forget();
        Some(PoseChange::Lost)
    }

    /// Forgets the pose, but not the errors of the sensors.
    pub fn forget(&mut self) {
        (self.is_localized, self.refused) = (false, None);
        self.alignment = Alignment::default();
        self.put(self.odometry);
    }

    /// Sets a pose without an error, and the slow error of the fixes to one that is not known.
    fn put(&mut self, place: Place) {
        (self.state[0], self.state[1], self.state[THETA]) = (place.x, place.y, wrapped(place.theta));
        for i in [0, 1, THETA, WANDER, WANDER + 1] {
            self.covariance.row_mut(i).fill(0.0);
            self.covariance.column_mut(i).fill(0.0);
        }
        for i in WANDER..STATES {
            self.state[i] = 0.0;
            self.covariance[(i, i)] = square(self.settings.wander);
        }
    }

    /// Begins at a pose in the frame of the fixes, with standard deviations of its position in m and of its heading in
    /// rad. One that is not a number is ignored.
    pub fn begin(&mut self, pose: &Pose2, (position, heading): (f32, f32)) -> Option<PoseChange> {
        if !pose.is_usable() {
            return None;
        }
        self.put(Place { x: f64::from(pose.x), y: f64::from(pose.y), theta: f64::from(pose.theta) });
        for (i, spread) in [(0, position), (1, position), (THETA, heading)] {
            self.covariance[(i, i)] = square(spread);
        }
        (self.is_localized, self.refused) = (true, None);
        Some(PoseChange::Localized)
    }

    /// Finds the pose from several fixes, if they agree with odometry.
    fn align(&mut self, fix: [f64; 2], antenna: [f64; 2], variance: f64) -> Option<PoseChange> {
        let FusionSettings { align, gate, motion, .. } = self.settings;
        let align = f64::from(align).max(0.1);
        if !self.alignment.put(fix, antenna, align) {
            return None;
        }
        let slip = square(motion.slip) * align;
        let found = self.alignment.turn(f64::from(gate) * (variance + slip), 0.25 * align * align);
        let Some(turn) = found else {
            self.alignment.drop_first();
            return None;
        };
        let arm = turn.arm([self.odometry.x, self.odometry.y]);
        let [x, y] = [0, 1].map(|i| turn.fix[i] + arm[i]);
        self.put(Place { x, y, theta: self.odometry.theta + turn.angle });
        // The error of the mean, and that of the angle at the arm; the slow error of all fixes is the same.
        let heading = variance / turn.spread + slip / (align * align);
        let (slow, across, p) = (square(self.settings.wander), [-arm[1], arm[0]], &mut self.covariance);
        p[(THETA, THETA)] = heading;
        for i in 0..2 {
            (p[(i, WANDER + i)], p[(WANDER + i, i)]) = (-slow, -slow);
            (p[(i, THETA)], p[(THETA, i)]) = (across[i] * heading, across[i] * heading);
            (0..2).for_each(|j| p[(i, j)] = across[i] * across[j] * heading);
            p[(i, i)] += variance / POINTS as f64 + slip + slow;
        }
        (self.is_localized, self.refused) = (true, None);
        self.alignment = Alignment::default();
        Some(PoseChange::Localized)
    }
}

/// Way forward and to the left in the frame of the middle of a step, and its turn.
fn step_of(before: &Pose2, after: &Pose2) -> ([f64; 2], f64) {
    let place = |pose: &Pose2| Place { x: f64::from(pose.x), y: f64::from(pose.y), theta: f64::from(pose.theta) };
    let (before, after) = (place(before), place(after));
    let turn = wrapped(after.theta - before.theta);
    let middle = Place { theta: before.theta + 0.5 * turn, ..before };
    (middle.to_inner([after.x, after.y]), turn)
}

/// State after a step: the motion of Thrun, Burgard, Fox (2005, 5.4) with the heading in the middle of the turn. The
/// slow error of the fixes is left as it is.
pub(super) fn moved(state: &State, step: &Step) -> State {
    let mut after = *state;
    let turn = step.turned.angle - state[BIAS] * step.turned.covered + step.wheels;
    let middle = Place { x: state[0], y: state[1], theta: state[THETA] + 0.5 * turn };
    let [x, y] = middle.to_outer(step.way.map(|way| state[SCALE] * way));
    (after[0], after[1], after[THETA]) = (x, y, state[THETA] + turn);
    after
}

/// Derivative of [`moved`] by the state: with the way u turned by the middle heading μ = θ + ½ (ω − b) t, that is
/// ∂p/∂θ = s u⊥, ∂p/∂b = −½ t s u⊥, ∂p/∂s = u and ∂θ/∂b = −t.
pub(super) fn jacobian(state: &State, step: &Step) -> Matrix {
    let covered = step.turned.covered;
    let turn = step.turned.angle - state[BIAS] * covered + step.wheels;
    let [x, y] = Place { theta: state[THETA] + 0.5 * turn, ..Place::default() }.to_outer(step.way);
    let across = [-y, x].map(|way| state[SCALE] * way);
    let mut f = Matrix::identity();
    for (i, along) in [x, y].into_iter().enumerate() {
        f[(i, THETA)] = across[i];
        f[(i, BIAS)] = -0.5 * covered * across[i];
        f[(i, SCALE)] = along;
    }
    f[(THETA, BIAS)] = -covered;
    f
}

/// Fix of an antenna at this place in the frame of the robot: p + R(θ) a, and the slow error.
pub(super) fn expected_position(state: &State, arm: [f64; 2]) -> Vector2<f64> {
    let [x, y] = Place { x: state[0], y: state[1], theta: state[THETA] }.to_outer(arm);
    Vector2::new(x + state[WANDER], y + state[WANDER + 1])
}

/// Derivative of [`expected_position`] by the state: ∂/∂θ is the arm, turned by θ and a right angle.
pub(super) fn position_jacobian(state: &State, arm: [f64; 2]) -> SMatrix<f64, 2, STATES> {
    let [x, y] = Place { theta: state[THETA], ..Place::default() }.to_outer(arm);
    let mut h = SMatrix::<f64, 2, STATES>::zeros();
    for (i, across) in [-y, x].into_iter().enumerate() {
        h[(i, i)] = 1.0;
        h[(i, THETA)] = across;
        h[(i, WANDER + i)] = 1.0;
    }
    h
}

fn square(value: f32) -> f64 {
    f64::from(value) * f64::from(value)
}
