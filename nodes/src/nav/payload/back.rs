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
use apex_rt::{Ctx, Event, node};
use heapless::Deque;
use libm::fabsf;

/// Distance between the places that are remembered, in m, and their number.
const STEP: f32 = 0.05;
const REMEMBERED: usize = 64;
/// Distance from the way, in m, and angle to it, in rad, up to which the vehicle is on it.
const BESIDE: f32 = 0.15;
const ASKEW: f32 = 0.3;
/// Angle between tractor and trailer with which the trailer steers back to its way, per angle to the way and per offset
/// from it, in rad/m, and the largest one, in rad.
const STEERING: f32 = 1.8;
const CONVERGENCE: f32 = 2.2;
const MOST: f32 = 0.25;

/// Backs a tractor with a passively steered trailer up by a distance, for example away from an obstacle, on the way on
/// which it came: over floor that it has driven on.
///
/// The node remembers the places of the trailer, and its angle to the tractor, on the last 3.2 m of a way forward, also
/// while it is not active. A trailer that is pushed turns away to the side, so the tractor steers against it: the angle
/// approaches the remembered one at the rate `gain` (Lamiraux et al. 1998), and leads back to the way if the trailer is
/// beside it. The way is forgotten when the trailer is more than 15 cm or 17° off, as after a curve backward that
/// another node drove; then the trailer is brought into line. `base` and `trailer` are the poses of the two axes in one
/// fixed frame such as that of odometry. Drives while it is active; `done` comes with a twist of zero. Without both
/// poses, or with poses older than `max_age`, the vehicle stands still. Nothing behind the vehicle is looked at.
#[node]
#[derive(Debug, Clone)]
pub struct BackUp {
    /// Distance.
    #[param(unit = "m", default = 1.0, range = 0.0..=100.0)]
    distance: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 0.2, range = 0.001..=10.0)]
    speed: f32,
    /// Rate at which the angle between tractor and trailer approaches that of the way.
    #[param(unit = "1/s", default = 0.6, range = 0.0..=10.0)]
    gain: f32,
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Maximum age of the poses.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    last: Option<Pose2>,
    /// Distance driven backward since the activation, in m.
    driven: f32,
    /// Places on the way on which the vehicle came, the last one at its end.
    way: Deque<Place, REMEMBERED>,
    halt: Halt,
}

/// Place of a trailer on a way.
#[derive(Debug, Clone, Copy)]
struct Place {
    axle: Pose2,
    /// Angle between tractor and trailer, in rad.
    bend: f32,
}

#[node]
impl BackUp {
    fn process(
        &mut self,
        ctx: &Ctx,
        base: Option<&Pose2>,
        trailer: Option<&Pose2>,
        done: Event<()>,
    ) -> Result<Option<Twist>, FarFromOrigin> {
        if ctx.active() && any_far([base, trailer]) {
            return self.halt.far();
        }
        Ok(self.step(ctx, base, trailer, done))
    }

    fn step(&mut self, ctx: &Ctx, base: Option<&Pose2>, trailer: Option<&Pose2>, done: Event<()>) -> Option<Twist> {
        let axes = both_fresh(ctx, [base, trailer], self.max_age);
        let bend = axes.map(|(base, trailer)| normalize_angle(&(base.theta - trailer.theta)));
        if let Some(((base, axle), bend)) = axes.zip(bend) {
            let moved = base.relative_to(&self.last.replace(*base).unwrap_or(*base)).x;
            self.remember(Place { axle: *axle, bend }, moved > 0.0);
            if ctx.active() {
                self.driven -= moved;
            }
        }
        if !ctx.active() {
            return self.halt.rest();
        }
        let Some(((_, axle), bend)) = axes.zip(bend) else { return self.halt.drive(Twist::ZERO) };
        let left = self.distance - self.driven;
        if left <= 0.0 {
            self.begin();
            done.emit(());
            return self.halt.drive(Twist::ZERO);
        }
        let (wanted, slope) = self.wanted(axle);
        let rate = |speed| speed * slope - self.gain * (bend - wanted);
        self.halt.drive(backing_twist(left, self.speed, bend, rate, &self.vehicle))
    }

    /// Begins again.
    #[on_activate]
    fn begin(&mut self) {
        self.driven = 0.0;
    }

    /// Angle between tractor and trailer that keeps the trailer on the way, in rad, and its change backward, in rad/m.
    fn wanted(&self, axle: &Pose2) -> (f32, f32) {
        let mut ends = self.way.iter().rev();
        let Some(last) = ends.next() else { return (0.0, 0.0) };
        let slope = ends.next().map_or(0.0, |before| before.bend - last.bend) / STEP;
        let off = axle.relative_to(&last.axle);
        let turn = off.theta - off.x * self.vehicle.trailer_rotation(1.0, 0.0, last.bend);
        let back = (STEERING * normalize_angle(&turn) - CONVERGENCE * off.y).clamp(-MOST, MOST);
        (last.bend - slope * off.x + back, slope)
    }

    /// Adds a place to the way if the vehicle drives forward, and leaves those that it has backed up over.
    fn remember(&mut self, here: Place, is_forward: bool) {
        let mut ahead = f32::INFINITY;
        while let Some(last) = self.way.back() {
            let off = here.axle.relative_to(&last.axle);
            if fabsf(off.y) > BESIDE || fabsf(normalize_angle(&off.theta)) > ASKEW {
                self.way.clear();
            } else if off.x < 0.0 {
                self.way.pop_back();
            } else {
                ahead = off.x;
                break;
            }
        }
        if is_forward && ahead >= STEP {
            if self.way.is_full() {
                self.way.pop_front();
            }
            // Cannot fail: there is room.
            let _ = self.way.push_back(here);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};

    #[test]
    fn it_backs_up_and_straightens_the_trailer() {
        for bent in [0.6_f32, 0.0, -0.8] {
            let mut node = BackUp::construct((1.5, 0.2, 0.6, Articulated::PATSY, 0.5));
            let (mut base, mut heading, mut done) = (Pose2::default(), -bent, None);
            for step in 0..2000 {
                let ctx = Ctx::new(Time::from_millis(20 * step)).of_node(true);
                let trailer = Articulated::PATSY.trailer(&base, heading);
                let twist = node.step(&ctx, Some(&base), Some(&trailer), apex_rt::event(&mut done));
                let twist = twist.expect("it is active");
                if done.is_some() {
                    break;
                }
                heading += Articulated::PATSY.trailer_rotation(twist.x, twist.omega, base.theta - heading) * 0.02;
                base = base.compose(&Pose2::new(0.02 * twist.x, 0.0, 0.02 * twist.omega));
            }
            assert!(done.is_some() && base.x < -0.9 && (base.theta - heading).abs() < 0.1, "{base:?} {heading}");
        }
    }

    #[test]
    fn it_backs_up_on_the_way_on_which_it_came() {
        let vehicle = Articulated::PATSY;
        let mut node = BackUp::construct((1.5, 0.2, 0.6, vehicle, 0.5));
        let (mut base, mut heading) = (Pose2::default(), 0.0);
        let mut ways: [std::vec::Vec<Pose2>; 2] = Default::default();
        for step in 0..1000 {
            // A quarter of a turn to the left, one to the right, and back.
            let is_back = step >= 400;
            let (ctx, axis) =
                (Ctx::new(Time::from_millis(20 * step)).of_node(is_back), vehicle.trailer(&base, heading));
            let mut done = None;
            let sent = node.step(&ctx, Some(&base), Some(&axis), apex_rt::event(&mut done));
            if done.is_some() {
                break;
            }
            ways[usize::from(is_back)].push(axis);
            let twist = sent.unwrap_or(Twist::new(0.25, 0.0, if step < 200 { 0.3 } else { -0.3 }));
            heading += vehicle.trailer_rotation(twist.x, twist.omega, base.theta - heading) * 0.02;
            base = base.compose(&Pose2::new(0.02 * twist.x, 0.0, 0.02 * twist.omega));
        }
        let [forward, back] = ways;
        let off = |axis: &Pose2| {
            forward.iter().map(|on| (on.position() - axis.position()).norm()).fold(f32::INFINITY, f32::min)
        };
        let farthest = back.iter().map(off).fold(0.0, f32::max);
        assert!(back.len() > 300 && farthest < 0.015, "{} steps, {farthest} m beside the way", back.len());
    }

    /// Before, the vehicle left its own way, on floor that it had not seen, and `SweepStop` held it.
    #[test]
    fn it_comes_back_to_its_way_after_another_node_has_backed_up() {
        let vehicle = Articulated::PATSY;
        let mut node = BackUp::construct((1.5, 0.2, 0.6, vehicle, 0.5));
        let (mut base, mut heading) = (Pose2::default(), 0.0);
        let (mut way, mut beside) = (std::vec::Vec::<Pose2>::new(), std::vec::Vec::new());
        for step in 0..1200 {
            // A curve to the left, and a quarter of a metre back, on which the trailer comes into line.
            let (is_back, is_own) = (step >= 400, step >= 463);
            let (ctx, axis) = (Ctx::new(Time::from_millis(20 * step)).of_node(is_own), vehicle.trailer(&base, heading));
            let mut done = None;
            let sent = node.step(&ctx, Some(&base), Some(&axis), apex_rt::event(&mut done));
            if done.is_some() {
                break;
            }
            let nearest = way.iter().map(|on| (on.position() - axis.position()).norm()).fold(f32::INFINITY, f32::min);
            if is_back {
                beside.push(nearest);
            } else {
                way.push(axis);
            }
            let bend = base.theta - heading;
            let other = match is_back {
                true => backing_twist(1.0, 0.2, bend, |_| -0.6 * bend, &vehicle),
                false => Twist::new(0.25, 0.0, 0.2),
            };
            let twist = sent.filter(|_| is_own).unwrap_or(other);
            heading += vehicle.trailer_rotation(twist.x, twist.omega, base.theta - heading) * 0.02;
            base = base.compose(&Pose2::new(0.02 * twist.x, 0.0, 0.02 * twist.omega));
        }
        let (farthest, end) = (beside.iter().copied().fold(0.0, f32::max), beside[beside.len() - 1]);
        assert!((0.02..0.1).contains(&farthest) && end < 0.03, "{farthest} m beside the way, {end} m at the end");
    }

    #[test]
    fn it_rests_without_activity_and_stops_without_a_pose() {
        let (mut node, at) = (BackUp::construct((1.0, 0.2, 0.6, Articulated::PATSY, 0.5)), Pose2::default());
        let idle = Ctx::new(Time::ZERO);
        let mut fire = |ctx: &Ctx, base: Option<&Pose2>| node.step(ctx, base, Some(&at), Event::unconnected());
        assert_eq!(fire(&idle, Some(&at)), None);
        for odd in [None, Some(&Pose2::new(f32::NAN, 0.0, 0.0)), Some(&Pose2::new(5e6, 0.0, 0.0))] {
            assert_eq!(fire(&idle.of_node(true), odd), Some(Twist::ZERO));
        }
        assert_ne!(fire(&idle.of_node(true), Some(&at)), Some(Twist::ZERO));
    }
}
