use super::vehicle::{Articulated, backing_twist};
use crate::{
    math::normalize_angle,
    nav::{
        Twist,
        latest::{any_far, both_fresh},
        twist::Halt,
    },
    scan::{FarFromOrigin, Pose2},
};
use apex_rt::{Ctx, Event, Time, node};
use std::vec::Vec;

/// Minimum progress, in m. A smaller change does not count.
const PROGRESS: f32 = 0.02;

/// Way backward of a tractor with a passively steered trailer.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BackPath {
    /// Pieces in the order in which they are driven.
    pub pieces: Vec<BackPiece>,
}

/// Piece of a way backward, on which the tractor is kept at an angle to the trailer.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BackPiece {
    /// Heading of the tractor relative to the trailer, in rad.
    pub bend: f32,
    /// Length, in m.
    pub length: f32,
}

impl BackPath {
    /// Length, in m.
    pub fn length(&self) -> f32 {
        self.pieces.iter().map(|piece| piece.length).sum()
    }

    /// Adds a piece at the end.
    pub(in crate::nav) fn add(&mut self, piece: BackPiece) {
        match self.pieces.last_mut().filter(|last| last.bend == piece.bend) {
            Some(last) => last.length += piece.length,
            None => self.pieces.push(piece),
        }
    }

    /// Angle between tractor and trailer, in rad, that is wanted after `driven` m; `None` beyond the end.
    fn bend_at(&self, driven: f32) -> Option<f32> {
        let mut end = 0.0;
        self.pieces.iter().find_map(|piece| {
            end += piece.length;
            (driven < end).then_some(piece.bend)
        })
    }
}

/// Backs a tractor with a passively steered trailer up along a path of [`CurvePlanner`](super::super::CurvePlanner).
///
/// The tractor steers so that its angle to the trailer approaches that of the path at the rate `gain` per metre
/// (feedback linearization of the off-axle hitch; Lamiraux et al. 1998). `base` and `trailer` are the poses of the two
/// axes in one fixed frame such as that of odometry: distances are measured with them, and where the path leads is not
/// corrected, so a path should be a few metres long. A new path replaces the current one. The node sends twists while
/// it has a path. It drops the path when the vehicle has `reached` its end, when it is `blocked`, so that it makes no
/// progress for longer than `blocked_timeout` or the path is not finite, and when it is deactivated. Without both
/// poses, or with poses older than `max_age`, the vehicle stands still.
#[node]
#[derive(Debug, Clone)]
pub struct BackFollower {
    /// Maximum speed.
    #[param(unit = "m/s", default = 0.2, range = 0.001..=10.0)]
    speed: f32,
    /// Rate at which the angle between tractor and trailer approaches that of the path. It has to be that of the
    /// planner.
    #[param(unit = "1/m", default = 2.5, range = 0.0..=100.0)]
    gain: f32,
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Time that the vehicle may go without progress.
    #[param(unit = "s", default = 3.0, range = 0.0..=600.0)]
    blocked_timeout: f32,
    /// Maximum age of the poses.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    path: BackPath,
    /// Pose at the last firing, and distance driven on the path, in m.
    last: Option<Pose2>,
    driven: f32,
    /// Greatest distance so far, and the time when it was reached.
    progress: Option<(f32, Time)>,
    halt: Halt,
}

#[node]
impl BackFollower {
    fn process(
        &mut self,
        ctx: &Ctx,
        base: Option<&Pose2>,
        trailer: Option<&Pose2>,
        path: Option<&BackPath>,
        reached: Event<()>,
        #[failure] blocked: Event<()>,
    ) -> Result<Option<Twist>, FarFromOrigin> {
        let is_driving = path.is_some() || !self.path.pieces.is_empty();
        if is_driving && any_far([base, trailer]) {
            path.into_iter().for_each(|path| self.begin(path));
            return self.halt.far();
        }
        Ok(self.step(ctx, [base, trailer], path, [reached, blocked]))
    }

    fn begin(&mut self, path: &BackPath) {
        self.give_up();
        self.path.clone_from(path);
    }

    fn step(
        &mut self,
        ctx: &Ctx,
        [base, trailer]: [Option<&Pose2>; 2],
        path: Option<&BackPath>,
        [reached, blocked]: [Event<()>; 2],
    ) -> Option<Twist> {
        if let Some(path) = path {
            self.begin(path);
        }
        if self.path.pieces.is_empty() {
            return self.halt.rest();
        }
        let axes = both_fresh(ctx, [base, trailer], self.max_age);
        let Some((base, trailer)) = axes else {
            // Time without a pose does not count as time without progress.
            self.progress = None;
            return self.halt.drive(Twist::ZERO);
        };
        if !self.path.length().is_finite() {
            self.give_up();
            blocked.emit(());
            return self.halt.drive(Twist::ZERO);
        }
        let last = self.last.replace(*base).unwrap_or(*base);
        self.driven -= base.relative_to(&last).x;
        let Some(wanted) = self.path.bend_at(self.driven) else {
            self.give_up();
            reached.emit(());
            return self.halt.drive(Twist::ZERO);
        };
        if self.is_stuck(ctx.now()) {
            self.give_up();
            blocked.emit(());
            return self.halt.drive(Twist::ZERO);
        }
        let left = self.path.length() - self.driven;
        let bend = normalize_angle(&(base.theta - trailer.theta));
        let rate = |speed| -self.gain * speed * (bend - wanted);
        self.halt.drive(backing_twist(left, self.speed, bend, rate, &self.vehicle))
    }

    /// Drops the path.
    #[on_deactivate]
    fn give_up(&mut self) {
        self.path.pieces.clear();
        (self.last, self.driven, self.progress) = (None, 0.0, None);
    }

    fn is_stuck(&mut self, now: Time) -> bool {
        if self.progress.is_none_or(|(most, _)| self.driven > most + PROGRESS) {
            self.progress = Some((self.driven, now));
        }
        self.progress.is_some_and(|(_, since)| now.since(since).as_secs_f32() > self.blocked_timeout)
    }
}

#[cfg(test)]
pub(in crate::nav) mod tests {
    use super::*;
    use apex_rt::Construct;

    /// Period of the simulation, in s.
    const PERIOD: f32 = 0.02;

    /// Simulated vehicle that backs up.
    pub struct Backing {
        node: BackFollower,
        path: Option<BackPath>,
        now: Time,
    }

    impl Backing {
        /// Begins with a path.
        pub fn new(path: &BackPath) -> Self {
            let node = BackFollower::construct((0.25, 2.5, Articulated::PATSY, 1.0, 0.5));
            Self { node, path: Some(path.clone()), now: Time::ZERO }
        }

        /// Moves the tractor and turns its trailer. Returns `true` at the end of the path.
        pub fn step(&mut self, base: &mut Pose2, heading: &mut f32) -> bool {
            let (twist, ends) = self.react(base, *heading);
            let twist = twist.expect("it drives");
            assert_eq!(ends[1], None, "blocked at {base:?}");
            *heading += PERIOD * Articulated::PATSY.trailer_rotation(twist.x, twist.omega, base.theta - *heading);
            *base = base.compose(&Pose2::new(PERIOD * twist.x, 0.0, PERIOD * twist.omega));
            ends[0].is_some()
        }

        /// The twist, and if it is reached or blocked.
        fn react(&mut self, base: &Pose2, heading: f32) -> (Option<Twist>, [Option<()>; 2]) {
            self.now += core::time::Duration::from_millis(20);
            let (mut reached, mut blocked) = (None, None);
            let trailer = Articulated::PATSY.trailer(base, heading);
            let ctx = Ctx::new(self.now).of_node(true);
            let (path, ends) = (self.path.take(), (apex_rt::event(&mut reached), apex_rt::event(&mut blocked)));
            let axes = [Some(base), Some(&trailer)];
            let twist = self.node.step(&ctx, axes, path.as_ref(), [ends.0, ends.1]);
            (twist, [reached, blocked])
        }
    }

    fn path(pieces: &[(f32, f32)]) -> BackPath {
        BackPath { pieces: pieces.iter().map(|&(bend, length)| BackPiece { bend, length }).collect() }
    }

    #[test]
    fn it_drives_the_length_of_the_path_with_its_bends() {
        for bend in [0.0, 0.5, -0.5] {
            let (mut base, mut heading) = (Pose2::default(), 0.0);
            let mut driver = Backing::new(&path(&[(bend, 1.0), (0.0, 1.0)]));
            let mut least = f32::INFINITY;
            while !driver.step(&mut base, &mut heading) {
                least = least.min((base.theta - heading - bend).abs());
            }
            assert!(least < 0.05, "{least} rad off {bend}");
            assert!((base.theta - heading).abs() < 0.1, "it ends straight");
            // A trailer that is pushed turns away from the tractor.
            assert!(if bend == 0.0 { heading.abs() < 1e-4 } else { heading * bend < -0.2 }, "{bend}: {heading}");
            assert!((1.8..2.01).contains(&base.position().norm()), "{base:?}");
        }
    }

    #[test]
    fn it_stops_without_progress_without_a_pose_and_without_a_path() {
        let at = Pose2::default();
        let mut driver = Backing::new(&path(&[(0.0, 1.0)]));
        let steps = (0..200).find(|_| driver.react(&at, 0.0).1[1].is_some());
        assert_eq!(steps, Some(51), "blocked after a second");
        assert_eq!(driver.react(&at, 0.0), (None, [None; 2]));
        let mut driver = Backing::new(&path(&[(0.0, 1.0)]));
        let nan = Pose2::new(f32::NAN, 0.0, 0.0);
        assert_eq!(driver.react(&nan, 0.0), (Some(Twist::ZERO), [None; 2]));
        driver.node.give_up();
        driver.react(&at, 0.0);
        assert_eq!(driver.react(&at, 0.0), (None, [None; 2]));
        assert_eq!(Backing::new(&BackPath::default()).react(&at, 0.0), (None, [None; 2]));
    }

    #[test]
    fn equal_pieces_are_one() {
        let mut way = BackPath::default();
        for bend in [0.0, 0.0, 0.4, 0.4, 0.0] {
            way.add(BackPiece { bend, length: 0.3 });
        }
        assert_eq!((way.pieces.len(), way.length()), (3, 1.5));
        assert_eq!([0.0, 0.7, 1.3, 1.6].map(|at| way.bend_at(at)), [Some(0.0), Some(0.4), Some(0.0), None]);
    }
}
