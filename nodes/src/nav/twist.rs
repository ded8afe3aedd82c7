use crate::scan::Point2;

/// How a robot moves in the plane: velocities in its own frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Twist {
    /// Forward, in m/s.
    pub x: f32,
    /// To the left, in m/s.
    pub y: f32,
    /// Counter-clockwise, in rad/s.
    pub omega: f32,
}

impl Twist {
    /// Stands still.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);

    /// The twist (`x`, `y`, `omega`).
    pub const fn new(x: f32, y: f32, omega: f32) -> Self {
        Self { x, y, omega }
    }

    /// Moves with `velocity` in m/s and turns with `omega` in rad/s.
    pub const fn of(velocity: Point2, omega: f32) -> Self {
        Self::new(velocity.x, velocity.y, omega)
    }

    /// The velocity without the turn, in m/s.
    pub const fn velocity(&self) -> Point2 {
        Point2::new(self.x, self.y)
    }

    /// Whether all is finite.
    pub const fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.omega.is_finite()
    }
}
