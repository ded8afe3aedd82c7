use super::vehicle::backing_twist;
use crate::{
    math::normalize_angle,
    nav::{Twist, twist::Halt},
    scan::Pose2,
};
use apex_rt::{Ctx, Event, node};

/// Backs a tractor with a passively steered trailer up by a distance, for example away from an obstacle.
///
/// A trailer that is pushed turns away to the side, so the tractor steers against it: the angle between the two decays
/// at the rate `gain` (Lamiraux et al. 1998). `base` and `trailer` are the poses of the two axes in one fixed frame
/// such as that of odometry. Works while it is active; `done` comes with a twist of zero. Nothing behind the vehicle is
/// looked at.
#[node]
#[derive(Debug, Clone)]
pub struct BackUp {
    /// Distance.
    #[param(unit = "m", default = 1.0, range = 0.0..=100.0)]
    distance: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 0.2, range = 0.001..=10.0)]
    speed: f32,
    /// Rate at which the angle between tractor and trailer decays.
    #[param(unit = "1/s", default = 0.6, range = 0.0..=10.0)]
    gain: f32,
    /// Distance from the tractor's axis back to the hitch.
    #[param(unit = "m", default = 0.1, range = 0.0..=10.0)]
    hitch: f32,
    /// Distance from the hitch back to the trailer's axis.
    #[param(unit = "m", default = 0.55, range = 0.01..=10.0)]
    drawbar: f32,
    last: Option<Pose2>,
    driven: f32,
    halt: Halt,
}

#[node]
impl BackUp {
    fn process(&mut self, ctx: &Ctx, base: &Pose2, trailer: &Pose2, done: Event<()>) -> Option<Twist> {
        if !ctx.active() {
            return self.halt.rest();
        }
        if !(base.is_finite() && trailer.is_finite()) {
            return self.halt.drive(Twist::ZERO);
        }
        let last = self.last.replace(*base).unwrap_or(*base);
        self.driven += (base.position() - last.position()).norm();
        let left = self.distance - self.driven;
        if left <= 0.0 {
            self.forget();
            done.emit(());
            return self.halt.drive(Twist::ZERO);
        }
        let bend = normalize_angle(&(base.theta - trailer.theta));
        let rate = |_| -self.gain * bend;
        self.halt.drive(backing_twist(left, self.speed, bend, rate, [self.hitch, self.drawbar]))
    }

    /// Begins again at the next activation.
    #[on_activate]
    fn forget(&mut self) {
        (self.last, self.driven) = (None, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nav::{Articulated, trailer_rotation};
    use apex_rt::{Construct, Time};

    #[test]
    fn it_backs_up_and_straightens_the_trailer() {
        for bent in [0.6_f32, 0.0, -0.8] {
            let mut node = BackUp::construct((1.5, 0.2, 0.6, 0.1, 0.55));
            let (mut base, mut heading, mut done) = (Pose2::default(), -bent, None);
            for step in 0..2000 {
                let ctx = Ctx::new(Time::from_millis(20 * step)).of_node(true);
                let trailer = Articulated::PATSY.trailer(&base, heading);
                let twist = node.process(&ctx, &base, &trailer, apex_rt::event(&mut done)).expect("it is active");
                if done.is_some() {
                    break;
                }
                heading += trailer_rotation(twist.x, twist.omega, base.theta - heading, 0.1, 0.55) * 0.02;
                base = base.compose(&Pose2::new(0.02 * twist.x, 0.0, 0.02 * twist.omega));
            }
            assert!(done.is_some() && base.x < -0.9 && (base.theta - heading).abs() < 0.1, "{base:?} {heading}");
        }
    }

    #[test]
    fn it_rests_without_activity_and_stops_without_a_pose() {
        let (mut node, at) = (BackUp::construct((1.0, 0.2, 0.6, 0.1, 0.55)), Pose2::default());
        let idle = Ctx::new(Time::ZERO);
        assert_eq!(node.process(&idle, &at, &at, Event::unconnected()), None);
        let nan = Pose2::new(f32::NAN, 0.0, 0.0);
        assert_eq!(node.process(&idle.of_node(true), &nan, &at, Event::unconnected()), Some(Twist::ZERO));
    }
}
