use crate::{TRAIL, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH};
use apex_nodes::scan::{Point2, Pose2};
use apex_sim::World;

/// Container cart on four castors. Its body is above the plane of the scanner, which sees the wheels only.
#[derive(Debug, Clone, PartialEq)]
pub struct Cart {
    pose: Pose2,
    /// Rolling directions of the wheels, in rad, in the frame of the world.
    castors: [f32; 4],
}

impl Cart {
    /// Creates a cart at `pose` with the rolling directions of its wheels (rad, frame of the world).
    pub const fn new(pose: Pose2, castors: [f32; 4]) -> Self {
        Self { pose, castors }
    }

    /// Pose of the cart.
    pub const fn pose(&self) -> Pose2 {
        self.pose
    }

    /// Moves the cart to `pose`. Each castor turns towards the motion of its pivot, as far as its trail allows.
    pub fn move_to(&mut self, pose: Pose2) {
        for (castor, pivot) in self.castors.iter_mut().zip(pivots()) {
            let way = pose.to_outer(pivot) - self.pose.to_outer(pivot);
            // Rolling without slipping turns a castor by distance / trail · sin(direction of motion − its
            // direction).
            let turn = (way.norm() / TRAIL).min(1.0);
            *castor += turn * libm::sinf(way.angle() - *castor);
        }
        self.pose = pose;
    }

    /// Middle of each wheel, and its rolling direction in rad.
    pub fn wheels(&self) -> impl Iterator<Item = (Point2, f32)> {
        let at = |(castor, pivot): (&f32, Point2)| (self.pose.to_outer(pivot) - Point2::polar(TRAIL, *castor), *castor);
        self.castors.iter().zip(pivots()).map(at)
    }

    /// Adds the wheels to the world.
    pub fn add_to(&self, world: &mut World) {
        for (axle, castor) in self.wheels() {
            world.block(&Pose2::new(axle.x, axle.y, castor), WHEEL_LENGTH, WHEEL_WIDTH);
        }
    }
}

fn pivots() -> impl Iterator<Item = Point2> {
    WHEEL_BOXES.iter().map(|&[x, y, ..]| Point2::new(x, y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn castors_follow_the_way() {
        let mut cart = Cart::new(Pose2::default(), [0.1, -0.5, 2.0, -2.0]);
        for step in 1..100 {
            cart.move_to(Pose2::new(0.02 * step as f32, 0.0, 0.0));
        }
        for castor in cart.castors {
            assert!(libm::remainderf(castor, core::f32::consts::TAU).abs() < 1e-3, "{castor}");
        }
    }

    #[test]
    fn a_cart_that_stands_keeps_its_castors() {
        let mut cart = Cart::new(Pose2::default(), [0.1, -0.5, 2.0, -2.0]);
        let before = cart.clone();
        cart.move_to(Pose2::default());
        assert_eq!(cart, before);
    }

    #[test]
    fn wheels_stay_in_their_boxes() {
        let mut world = World::default();
        for i in 0..16 {
            Cart::new(Pose2::default(), [i as f32 * 0.4; 4]).add_to(&mut world);
        }
        for corner in world.walls().iter().map(|wall| wall.a) {
            let inside = |b: &[f32; 4]| (corner.x - b[0]).abs() < 0.5 * b[2] && (corner.y - b[1]).abs() < 0.5 * b[3];
            assert!(WHEEL_BOXES.iter().any(inside), "{corner:?}");
        }
    }
}
