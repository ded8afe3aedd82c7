use super::{Terrain, Walker};
use crate::Random;
use apex_nodes::scan::{Point2, Pose2};

/// Height of the camera above the ground, and of the part of a person that is looked for, in m.
const EYE: f32 = 0.7;
const CHEST: f32 = 1.1;

/// Detector of persons in the images of a stereo camera that looks ahead: where they are, with errors.
///
/// The error of the range grows with the square of the range, as a disparity has the same error everywhere. Persons who
/// are far away are missed more often, those behind others and behind things always, and sometimes a person is seen
/// where there is none. Its defaults are those of a baseline of 25 cm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StereoDetector {
    /// Angle of view, in rad.
    pub view: f32,
    /// Nearest and farthest person that can be detected, in m.
    pub ranges: [f32; 2],
    /// Standard deviation of the range at 1 m, in m.
    pub depth_noise: f32,
    /// Standard deviation of the direction, in rad.
    pub bearing_noise: f32,
    /// Probability that a person nearby is detected.
    pub rate: f32,
    /// Probability of a false detection in an image.
    pub false_rate: f32,
}

impl Default for StereoDetector {
    fn default() -> Self {
        Self { view: 1.25, ranges: [1.0, 22.0], depth_noise: 0.0015, bearing_noise: 0.01, rate: 0.9, false_rate: 0.03 }
    }
}

impl StereoDetector {
    /// Detects people. The positions are in the frame of the base, whose pose is `pose`.
    pub fn detect(
        &self,
        terrain: &Terrain,
        pose: &Pose2,
        people: &[Walker],
        random: &mut Random,
    ) -> impl Iterator<Item = Point2> {
        let eye = (pose.position(), terrain.height(pose.position()) + EYE);
        let mut found = vec![];
        for (i, person) in people.iter().enumerate() {
            let place = pose.to_inner(person.position);
            let range = place.norm();
            let chest = (person.position, terrain.height(person.position) + CHEST);
            let is_in_view =
                range >= self.ranges[0] && range <= self.ranges[1] && 2.0 * place.angle().abs() <= self.view;
            let hides = |(k, other): (usize, &Walker)| {
                let inner = pose.to_inner(other.position);
                let t = inner.dot(place) / place.norm_squared();
                k != i && (0.05..0.95).contains(&t) && (inner - place.scaled(t)).norm() < Walker::RADIUS
            };
            let is_hidden = || people.iter().enumerate().any(hides) || !terrain.is_seen(eye, chest);
            if !is_in_view || is_hidden() {
                continue;
            }
            let rate = self.rate * (1.0 - 0.5 * range / self.ranges[1]);
            if random.chance(rate) {
                found.push(self.measured(place, random));
            }
        }
        if random.chance(self.false_rate) {
            let angle = random.uniform(-0.5 * self.view, 0.5 * self.view);
            found.push(Point2::polar(random.uniform(3.0, 15.0), angle));
        }
        found.into_iter()
    }

    fn measured(&self, place: Point2, random: &mut Random) -> Point2 {
        let range = place.norm();
        let range = range + random.normal(self.depth_noise * range * range);
        Point2::polar(range.max(0.5), place.angle() + random.normal(self.bearing_noise))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outdoor::{Surface, ThingShape};

    fn person(x: f32, y: f32) -> Walker {
        Walker { position: Point2::new(x, y), ..Walker::default() }
    }

    fn detections(detector: &StereoDetector, terrain: &Terrain, people: &[Walker]) -> Vec<Point2> {
        let mut random = Random::new(2);
        (0..500)
            .flat_map(|_| detector.detect(terrain, &Pose2::default(), people, &mut random).collect::<Vec<_>>())
            .collect()
    }

    #[test]
    fn errors_grow_with_the_square_of_the_range() {
        let (terrain, sharp) = (Terrain::flat(40.0), StereoDetector { false_rate: 0.0, ..StereoDetector::default() });
        let spread = |x: f32| {
            let seen = detections(&sharp, &terrain, &[person(x, 0.0)]);
            assert!(seen.len() > 200);
            let square = seen.iter().map(|p| (p.norm() - x).powi(2)).sum::<f32>() / seen.len() as f32;
            square.sqrt()
        };
        assert!((spread(20.0) / spread(10.0) - 4.0).abs() < 0.6);
    }

    #[test]
    fn only_what_is_in_view_is_seen_and_sometimes_more() {
        let mut terrain = Terrain::flat(40.0);
        let sharp = StereoDetector { false_rate: 0.0, ..StereoDetector::default() };
        assert!(detections(&sharp, &terrain, &[person(-5.0, 0.0), person(30.0, 0.0), person(5.0, 5.0)]).is_empty());
        let behind = detections(&sharp, &terrain, &[person(4.0, 0.0), person(8.0, 0.1)]);
        assert!(behind.iter().all(|p| p.x < 6.0), "the first hides the second");
        terrain.add(Point2::new(2.0, 0.0), ThingShape::Pole { radius: 0.3, height: 3.0 }, Surface::Trunk);
        assert!(detections(&sharp, &terrain, &[person(6.0, 0.0)]).is_empty());
        let alarms = detections(&StereoDetector::default(), &terrain, &[]).len();
        assert!((5..30).contains(&alarms), "{alarms}");
    }
}
