use super::Terrain;
use crate::Limits;
use apex_nodes::{
    nav::Twist,
    scan::{Point2, Pose2},
};
use libm::{atanf, cosf, fabsf, sinf};

/// Acceleration of gravity, in m/s².
const GRAVITY: f32 = 9.81;
/// Time for which the wheels of one side have to be in the air until a base tips over, in s.
const TIPS: f32 = 0.12;

/// Shape and contact of a skid-steered base. Lengths are in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkidShape {
    /// Length.
    pub length: f32,
    /// Width.
    pub width: f32,
    /// Distance between the axles.
    pub wheelbase: f32,
    /// Distance between the wheels of both sides.
    pub track: f32,
    /// Height of the centre of mass above the ground.
    pub mass_height: f32,
    /// Coefficient of friction of the wheels, sideways.
    pub friction: f32,
    /// Distance of the instantaneous centre of rotation behind the middle: the base drifts sideways when it turns.
    pub centre_behind: f32,
    /// Share by which the base turns faster or slower than it should, from place to place.
    pub uneven: f32,
}

/// Inclination of a base on the ground, in rad, and its height, in m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Height of the middle of its wheels on the ground.
    pub height: f32,
    /// Rotation about the x axis: the left side is up if it is positive.
    pub roll: f32,
    /// Rotation about the y axis: the front is down if it is positive.
    pub pitch: f32,
}

/// Base with four wheels that steers by different velocities of its two sides, on rough ground.
///
/// Its wheels slide sideways in every curve. How well a rotation succeeds changes from place to place; the middle of
/// the base drifts outward, and it slides where the friction does not hold it on its curve. It tips over where the
/// centrifugal force and the slope lift the wheels of one side.
#[derive(Debug, Clone, PartialEq)]
pub struct SkidBase {
    /// Pose in the world.
    pub pose: Pose2,
    /// Velocity in the frame of the base.
    pub twist: Twist,
    /// Velocities of the wheels: forward, and the rotation that they would cause without slip.
    pub wheels: Twist,
    /// Inclination.
    pub attitude: Attitude,
    /// Limits of the motors.
    pub limits: Limits,
    /// Shape and contact.
    pub shape: SkidShape,
    /// Time for which the wheels of one side have been in the air, in s.
    lifted: f32,
    /// `true` once the base has tipped over.
    pub is_tipped: bool,
}

impl SkidShape {
    /// Summit XL with a mast that carries a scanner.
    pub const SUMMIT: Self = Self {
        length: 0.72,
        width: 0.61,
        wheelbase: 0.45,
        track: 0.5,
        mass_height: 0.45,
        friction: 0.65,
        centre_behind: 0.06,
        uneven: 0.15,
    };
}

impl SkidBase {
    /// Creates a base that stands on the ground.
    pub fn new(pose: Pose2, limits: Limits, shape: SkidShape, terrain: &Terrain) -> Self {
        let mut base = Self {
            pose,
            twist: Twist::ZERO,
            wheels: Twist::ZERO,
            attitude: Attitude::default(),
            limits,
            shape,
            lifted: 0.0,
            is_tipped: false,
        };
        base.settle(terrain);
        base
    }

    /// Moves for `dt` s, as close to `command` as possible. A base that has tipped over does not move.
    pub fn step(&mut self, command: &Twist, dt: f32, terrain: &Terrain) {
        if self.is_tipped {
            (self.twist, self.wheels) = (Twist::ZERO, Twist::ZERO);
            return;
        }
        let limits = &self.limits;
        let towards = |now: f32, wanted: f32, most: f32, change: f32| {
            let wanted = if wanted.is_finite() { wanted.clamp(-most, most) } else { 0.0 };
            now + (wanted - now).clamp(-change, change)
        };
        self.wheels.x = towards(self.wheels.x, command.x, limits.speed, limits.acceleration * dt);
        self.wheels.omega = towards(self.wheels.omega, command.omega, limits.turn, limits.turn_acceleration * dt);
        self.twist = self.slip();
        let (sin, cos) = libm::sincosf(self.pose.theta);
        let Twist { x, y, omega } = self.twist;
        self.pose.x += (x * cos - y * sin) * dt;
        self.pose.y += (x * sin + y * cos) * dt;
        self.pose.theta = apex_nodes::math::normalize_angle(&(self.pose.theta + omega * dt));
        self.settle(terrain);
        self.tip(dt);
    }

    /// Velocity with slip.
    fn slip(&self) -> Twist {
        let SkidShape { friction, centre_behind, uneven, .. } = self.shape;
        let Twist { x, omega, .. } = self.wheels;
        let grip = 1.0 + uneven * sinf(0.9 * self.pose.x + 1.7) * cosf(0.7 * self.pose.y + 0.4);
        let turn = omega * grip;
        // The faster it turns, the more of the wheels' motion is lost.
        let forward = x * (1.0 - 0.02 - (0.03 * fabsf(turn)).min(0.1));
        let held = friction * GRAVITY;
        let needed = fabsf(forward * turn);
        let (turn, slide) = if needed > held { (turn * held / needed, (needed - held) * 0.1) } else { (turn, 0.0) };
        Twist::new(forward, centre_behind * turn - slide * turn.signum(), turn)
    }

    /// Positions of the wheels: front left, front right, rear left, rear right.
    pub fn contacts(&self) -> [Point2; 4] {
        let (x, y) = (0.5 * self.shape.wheelbase, 0.5 * self.shape.track);
        [(x, y), (x, -y), (-x, y), (-x, -y)].map(|(x, y)| self.pose.to_outer(Point2::new(x, y)))
    }

    /// Puts the base on the ground.
    fn settle(&mut self, terrain: &Terrain) {
        let [fl, fr, rl, rr] = self.contacts().map(|place| terrain.height(place));
        let roll = atanf((fl + rl - fr - rr) / (2.0 * self.shape.track));
        let pitch = -atanf((fl + fr - rl - rr) / (2.0 * self.shape.wheelbase));
        self.attitude = Attitude { height: 0.25 * (fl + fr + rl + rr), roll, pitch };
    }

    fn tip(&mut self, dt: f32) {
        let Attitude { roll, .. } = self.attitude;
        // In a curve to the left it tips to the right, sooner if the left side is up.
        let sideways = self.twist.x * self.twist.omega * cosf(roll) + GRAVITY * sinf(roll);
        let most = GRAVITY * cosf(roll) * 0.5 * self.shape.track / self.shape.mass_height;
        self.lifted = if fabsf(sideways) > most { self.lifted + dt } else { 0.0 };
        self.is_tipped = self.lifted > TIPS;
    }

    /// Share of the load that has gone over to the wheels of one side: at 1 the others are in the air.
    pub fn load_transfer(&self) -> f32 {
        let Attitude { roll, .. } = self.attitude;
        let sideways = self.twist.x * self.twist.omega * cosf(roll) + GRAVITY * sinf(roll);
        fabsf(sideways) * self.shape.mass_height / (GRAVITY * cosf(roll) * 0.5 * self.shape.track)
    }

    /// Distance between the outline of the base and a disc, in m; 0 or less if they touch.
    pub fn clearance(&self, centre: Point2, radius: f32) -> f32 {
        let p = self.pose.to_inner(centre);
        let dx = (fabsf(p.x) - 0.5 * self.shape.length).max(0.0);
        let dy = (fabsf(p.y) - 0.5 * self.shape.width).max(0.0);
        Point2::new(dx, dy).norm() - radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outdoor::Ditch;

    const LIMITS: Limits = Limits { speed: 3.0, acceleration: 2.5, turn: 3.5, turn_acceleration: 8.0 };

    fn drive(terrain: &Terrain, command: Twist, seconds: f32) -> SkidBase {
        let mut base = SkidBase::new(Pose2::default(), LIMITS, SkidShape::SUMMIT, terrain);
        for _ in 0..(seconds / 0.01) as usize {
            base.step(&command, 0.01, terrain);
        }
        base
    }

    #[test]
    fn it_turns_slowly_without_tipping_and_tips_when_it_turns_fast() {
        let terrain = Terrain::flat(60.0);
        let gentle = drive(&terrain, Twist::new(2.5, 0.0, 0.8), 4.0);
        assert!(!gentle.is_tipped && gentle.load_transfer() < 0.6, "{}", gentle.load_transfer());
        let wild = drive(&terrain, Twist::new(2.8, 0.0, 2.6), 4.0);
        assert!(wild.is_tipped);
        let slow = drive(&terrain, Twist::new(0.8, 0.0, 2.6), 4.0);
        assert!(!slow.is_tipped);
    }

    #[test]
    fn a_slope_adds_to_the_centrifugal_force() {
        // One side in a ditch: it is inclined, and tips at a rotation that is safe on flat ground.
        let mut terrain = Terrain::flat(60.0);
        terrain.add_ditch(Ditch {
            ends: [Point2::new(-30.0, -0.55), Point2::new(30.0, -0.55)],
            half_width: 0.45,
            depth: 0.25,
        });
        let base = SkidBase::new(Pose2::default(), LIMITS, SkidShape::SUMMIT, &terrain);
        assert!(base.attitude.roll > 0.2, "{:?}", base.attitude);
        let mut inclined = SkidBase { twist: Twist::new(2.0, 0.0, 1.8), ..base.clone() };
        let mut level = SkidBase { attitude: Attitude::default(), ..inclined.clone() };
        for _ in 0..20 {
            inclined.tip(0.01);
            level.tip(0.01);
        }
        assert!(inclined.is_tipped && !level.is_tipped);
    }

    #[test]
    fn slip_changes_the_way() {
        let terrain = Terrain::flat(60.0);
        let base = drive(&terrain, Twist::new(2.0, 0.0, 0.5), 3.0);
        let ideal = 0.5 * 3.0;
        assert!((base.pose.theta - ideal).abs() > 0.02, "{}", base.pose.theta);
        assert!(base.twist.y != 0.0 && base.twist.x < 2.0);
        let straight = drive(&terrain, Twist::new(2.0, 0.0, 0.0), 3.0);
        assert!(straight.pose.y.abs() < 1e-4, "{}", straight.pose.y);
    }

    #[test]
    fn the_outline_is_a_rectangle() {
        let base = SkidBase::new(Pose2::default(), LIMITS, SkidShape::SUMMIT, &Terrain::flat(5.0));
        let gap = |x: f32, y: f32| base.clearance(Point2::new(x, y), 0.1);
        assert!((gap(1.36, 0.0) - 0.9).abs() < 1e-5 && (gap(0.0, 0.605) - 0.2).abs() < 1e-5);
        assert!(gap(0.3, 0.0) < 0.0);
    }
}
