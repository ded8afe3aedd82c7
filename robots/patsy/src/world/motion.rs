use apex_nodes::scan::{Point2, Pose2};
use apex_sim::Random;
use core::{
    f32::consts::{PI, TAU},
    fmt,
};
use serde::{Deserialize, Serialize};

/// Motion of the cart in a run (thesis 6.10.2, experiment 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scenario {
    /// Straight towards the scanner, front first.
    Toward,
    /// Straight away from the scanner.
    Away,
    /// Rotation about its own centre.
    Rotating,
    /// Pushed around with changes of direction, so that the castors turn differently.
    Random,
    /// No cart.
    Empty,
}

impl Scenario {
    /// All scenarios, in the order of the table of results.
    pub const ALL: [Self; 5] = [Self::Toward, Self::Away, Self::Rotating, Self::Random, Self::Empty];
}

impl fmt::Display for Scenario {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Toward => "toward",
            Self::Away => "away",
            Self::Rotating => "rotating",
            Self::Random => "random",
            Self::Empty => "empty",
        })
    }
}

/// Path of the cart during one run.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Motion {
    /// Uniform motion from one pose to another.
    Straight { from: Pose2, to: Pose2 },
    /// Oscillation about a pose, with its own amplitude, frequency and phase in each coordinate.
    Swinging { about: Pose2, swings: [Swing; 3] },
}

/// A sine: amplitude, number of periods in a run, phase in rad.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Swing {
    amplitude: f32,
    periods: f32,
    phase: f32,
}

impl Swing {
    fn random(amplitude: f32, random: &mut Random) -> Self {
        Self { amplitude, periods: random.uniform(0.4, 1.2), phase: random.uniform(0.0, TAU) }
    }

    fn at(&self, t: f32) -> f32 {
        self.amplitude * libm::sinf(TAU * self.periods * t + self.phase)
    }
}

impl Motion {
    /// Random motion of a new run, or `None` without a cart.
    pub fn random(scenario: Scenario, random: &mut Random) -> Option<Self> {
        match scenario {
            Scenario::Toward => Some(Self::straight(4.2, 1.3, random)),
            Scenario::Away => Some(Self::straight(1.3, 4.2, random)),
            Scenario::Rotating => {
                let at = Point2::polar(random.uniform(1.5, 3.5), random.uniform(-0.8, 0.8));
                let theta = random.uniform(-PI, PI);
                let turn = if random.chance(0.5) { TAU } else { -TAU };
                let from = Pose2::new(at.x, at.y, theta);
                Some(Self::Straight { from, to: Pose2 { theta: theta + turn, ..from } })
            }
            Scenario::Random => {
                let at = Point2::polar(random.uniform(2.0, 3.3), random.uniform(-0.7, 0.7));
                let about = Pose2::new(at.x, at.y, random.uniform(-PI, PI));
                Some(Self::Swinging { about, swings: [0.5, 0.5, 0.9].map(|a| Swing::random(a, random)) })
            }
            Scenario::Empty => None,
        }
    }

    /// Motion along a line that passes near the scanner, between two distances. The cart faces along it, except for the
    /// deviation of a cart pushed by hand.
    fn straight(first: f32, last: f32, random: &mut Random) -> Self {
        let bearing = random.uniform(-0.7, 0.7);
        let theta = bearing + PI + random.uniform(-0.35, 0.35);
        let at = |distance| {
            let p = Point2::polar(distance, bearing);
            Pose2::new(p.x, p.y, theta)
        };
        Self::Straight { from: at(first), to: at(last) }
    }

    /// Pose at `t`, from 0 to 1 in a run. The heading is not wrapped.
    pub fn pose(&self, t: f32) -> Pose2 {
        match self {
            Self::Straight { from, to } => Pose2::new(
                from.x + t * (to.x - from.x),
                from.y + t * (to.y - from.y),
                from.theta + t * (to.theta - from.theta),
            ),
            Self::Swinging { about, swings } => {
                Pose2::new(about.x + swings[0].at(t), about.y + swings[1].at(t), about.theta + swings[2].at(t))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenarios_do_what_they_are_called() {
        let mut random = Random::new(1);
        for _ in 0..20 {
            let mut ends = |scenario| {
                let motion = Motion::random(scenario, &mut random).expect("a cart");
                (motion.pose(0.0), motion.pose(1.0))
            };
            let (from, to) = ends(Scenario::Toward);
            assert!(to.position().norm() < from.position().norm() - 2.0 && from.theta == to.theta);
            let (from, to) = ends(Scenario::Away);
            assert!(to.position().norm() > from.position().norm() + 2.0 && from.theta == to.theta);
            let (from, to) = ends(Scenario::Rotating);
            assert!(from.position() == to.position() && ((to.theta - from.theta).abs() - TAU).abs() < 1e-5);
        }
        assert!(Motion::random(Scenario::Empty, &mut random).is_none());
    }

    #[test]
    fn the_cart_never_runs_over_the_scanner() {
        let mut random = Random::new(2);
        for scenario in [Scenario::Toward, Scenario::Away, Scenario::Rotating, Scenario::Random] {
            for _ in 0..50 {
                let motion = Motion::random(scenario, &mut random).expect("a cart");
                let nearest = (0..=50).map(|i| motion.pose(i as f32 / 50.0).position().norm()).fold(f32::MAX, f32::min);
                assert!(nearest > 0.9, "{scenario}: {nearest} m");
            }
        }
    }
}
