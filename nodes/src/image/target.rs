use super::{Camera, Line, Lines, Region, Regions};
use crate::scan::{BeamDirections, Point2, Pose2, Scan};
use apex_rt::node;

/// Target sign in an image: a cross in rings (thesis 4.3.1).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Target {
    /// Intersection of the lines: u and v, in pixels.
    pub centre: [f32; 2],
    /// Region that contains the lines.
    pub region: Region,
}

/// Finds a target by its cross (thesis 4.3.1, figure 4.4): in one region, an almost horizontal and an almost vertical
/// line that are long enough and intersect near the middle of the region at almost 90°. ⊥ if there is none.
///
/// Both edges of a stroke are lines, so the centre is the mean of all intersections in the region. Of several targets,
/// the one with the largest region is chosen.
#[node]
#[derive(Debug, Clone)]
pub struct TargetLines {
    /// Maximum deviation of the lines from horizontal and vertical.
    #[param(unit = "rad", default = 0.35, range = 0.0..=0.785)]
    slant: f32,
    /// Maximum deviation of the intersection from a right angle.
    #[param(unit = "rad", default = 0.26, range = 0.0..=0.785)]
    skew: f32,
    /// Minimum length of a line, as a fraction of the width or height of the region.
    #[param(default = 0.6, range = 0.1..=1.0)]
    share: f32,
    /// Maximum distance of the intersection from the middle of the region, as a fraction of its width and height.
    #[param(default = 0.12, range = 0.0..=0.5)]
    offset: f32,
}

#[node]
impl TargetLines {
    fn process(&mut self, lines: &Lines, regions: &Regions) -> Option<Target> {
        let targets = regions.iter().filter_map(|region| self.target(lines, region));
        targets.max_by_key(|target| u64::from(target.region.width) * u64::from(target.region.height))
    }

    /// Target in a region.
    fn target(&self, lines: &[Line], region: &Region) -> Option<Target> {
        let inside = |line: &&Line| region.contains(line.at(0.5));
        let level = |line: &&Line| {
            let [du, dv] = line.span();
            dv.abs() <= du.abs() * self.slant.tan() && line.length() >= self.share * region.width as f32
        };
        let upright = |line: &&Line| {
            let [du, dv] = line.span();
            du.abs() <= dv.abs() * self.slant.tan() && line.length() >= self.share * region.height as f32
        };
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for a in lines.iter().filter(inside).filter(level) {
            for b in lines.iter().filter(inside).filter(upright) {
                if let Some([u, v]) = self.crossing(a, b, region) {
                    sum = [sum[0] + u, sum[1] + v];
                    count += 1.0;
                }
            }
        }
        let centre = sum.map(|s| s / count);
        (count > 0.0).then_some(Target { centre, region: *region })
    }

    /// Intersection of two lines, if it meets the criteria of a target.
    fn crossing(&self, a: &Line, b: &Line, region: &Region) -> Option<[f32; 2]> {
        let ([a_u, a_v], [b_u, b_v]) = (a.span(), b.span());
        let cosine = (a_u * b_u + a_v * b_v) / (a.length() * b.length());
        let parts = a.meets(b).filter(|parts| parts.iter().all(|part| (0.0..=1.0).contains(part)))?;
        let (place, [u, v]) = (a.at(parts[0]), region.middle());
        let central = (place[0] - u).abs() <= self.offset * region.width as f32
            && (place[1] - v).abs() <= self.offset * region.height as f32;
        (central && cosine.abs() <= self.skew.sin()).then_some(place)
    }
}

/// Region as a target with its centre in the middle, so that [`TargetPose`] gives the pose of a number sign (thesis
/// 4.3.2).
#[node]
pub fn region_target(region: &Region) -> Target {
    Target { centre: region.middle(), region: *region }
}

/// Pose of a target in the frame of the robot: on the wall that the laser measures in its direction (thesis 4.3.1).
///
/// The x axis of the pose points out of the wall, towards the robot. The wall is a straight line fitted to the points
/// of the scan beside the line of sight (total least squares). ⊥ if there are too few points, or if they are not on a
/// line.
#[node]
#[derive(Debug, Clone)]
pub struct TargetPose {
    /// Maximum distance of the points of the wall from the line of sight.
    #[param(unit = "m", default = 0.25, range = 0.01..=5.0)]
    reach: f32,
    /// Minimum number of points of the wall.
    #[param(default = 5, range = 2..=1000)]
    min_points: usize,
    /// Maximum standard deviation of the points from the line.
    #[param(unit = "m", default = 0.03, range = 0.0..=1.0)]
    roughness: f32,
    /// Forward position of the scanner in the frame of the robot.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    scanner_x: f32,
    /// Position of the scanner to the left.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    scanner_y: f32,
    /// Rotation of the scanner to the left.
    #[param(unit = "rad", default = 0.0, range = -3.15..=3.15)]
    scanner_yaw: f32,
    points: Vec<Point2>,
    directions: BeamDirections,
}

#[node]
impl TargetPose {
    fn process(&mut self, target: &Target, camera: &Camera, scan: &Scan) -> Option<Pose2> {
        let [x, y, _] = camera.ray(target.centre[0], target.centre[1]);
        let eye = Point2::new(camera.position[0], camera.position[1]);
        let sight = Point2::new(x, y).scaled(1.0 / Point2::new(x, y).norm());
        let scanner = Pose2::new(self.scanner_x, self.scanner_y, self.scanner_yaw).transform();
        let ahead = |p: &Point2| {
            let d = *p - eye;
            d.dot(sight) > 0.0 && d.dot(sight.perpendicular()).abs() <= self.reach
        };
        self.points.clear();
        self.points.extend(self.directions.points(scan).map(|(_, p)| scanner.to_outer(p)).filter(ahead));
        if self.points.len() < self.min_points {
            return None;
        }
        let wall = Wall::fit(&self.points);
        if wall.deviation.is_nan() || wall.deviation > self.roughness {
            return None;
        }
        // The normal that points back to the camera.
        let normal = if wall.normal.dot(sight) > 0.0 { wall.normal.scaled(-1.0) } else { wall.normal };
        let distance = (wall.middle - eye).dot(normal) / sight.dot(normal);
        let place = eye + sight.scaled(distance);
        let pose = Pose2::new(place.x, place.y, normal.angle());
        (distance > 0.0 && distance.is_finite()).then_some(pose)
    }
}

/// Passes the pose of a thing on a wall if its region is as high as the thing would be there. ⊥ otherwise: what is
/// partly hidden, or something else, has another height for its distance.
///
/// The height is the one between the upper edge of the region's first row and the lower edge of its last row, in the
/// column of the centre, in the plane of the pose.
#[node]
pub fn fits_height(
    target: &Target,
    camera: &Camera,
    pose: &Pose2,
    #[param(unit = "m", range = 0.0..=100.0)] low: f32,
    #[param(unit = "m", range = 0.0..=100.0)] high: f32,
) -> Option<Pose2> {
    let Region { top, height, .. } = target.region;
    let far = (pose.position() - Point2::new(camera.position[0], camera.position[1])).norm();
    let level = |v: f32| {
        let [x, y, z] = camera.ray(target.centre[0], v);
        far * z / Point2::new(x, y).norm()
    };
    let first = top as f32 - 0.5;
    let height = level(first) - level(first + height as f32);
    // False for NaN.
    (low..=high).contains(&height).then_some(*pose)
}

/// Straight line fitted to points.
struct Wall {
    middle: Point2,
    normal: Point2,
    /// Standard deviation of the distances of the points from the line, in m.
    deviation: f32,
}

impl Wall {
    /// Total least squares: the line through the mean of the points, in the direction of their greatest variance.
    fn fit(points: &[Point2]) -> Self {
        let share = 1.0 / points.len() as f32;
        let middle = points.iter().fold(Point2::default(), |sum, p| sum + *p).scaled(share);
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for d in points.iter().map(|p| *p - middle) {
            (xx, xy, yy) = (xx + d.x * d.x, xy + d.x * d.y, yy + d.y * d.y);
        }
        let normal = Point2::polar(1.0, 0.5 * libm::atan2f(2.0 * xy, xx - yy)).perpendicular();
        let squares = xx * normal.x * normal.x + 2.0 * xy * normal.x * normal.y + yy * normal.y * normal.y;
        Self { middle, normal, deviation: libm::sqrtf(share * squares.max(0.0)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use apex_rt::Construct;
    use core::f32::consts::PI;

    fn camera() -> Camera {
        Camera { position: [0.1, 0.0, 0.4], ..Camera::new(640, 480, 1.0) }
    }

    /// Poses in front of the robot, up to 2 m away, with the wall rotated by up to 25°.
    fn poses() -> impl Iterator<Item = Pose2> {
        let mut random = Random::new(5);
        (0..12).map(move |_| {
            let (far, side) = (random.uniform(0.7, 2.0), random.uniform(-0.25, 0.25));
            Pose2::new(0.1 + far, side * far, PI + random.uniform(-0.4, 0.4))
        })
    }

    #[test]
    fn the_pose_is_on_the_wall() {
        for pose in poses() {
            let mut scan = Scan { angle_min: -1.5, angle_increment: 0.01, ..Scan::default() };
            let normal = Point2::polar(1.0, pose.theta);
            let range = |i: usize| pose.position().dot(normal) / Point2::polar(1.0, -1.5 + 0.01 * i as f32).dot(normal);
            scan.ranges.extend((0..301).map(range));
            let centre = camera().project([pose.x, pose.y, 0.5]).expect("ahead");
            let target = Target { centre, region: Region::default() };
            let mut node = TargetPose::construct((0.25, 5, 0.03, 0.0, 0.0, 0.0));
            let found = node.process(&target, &camera(), &scan).expect("a wall");
            let error = found.relative_to(&pose);
            assert!(error.position().norm() < 2e-3 && error.theta.abs() < 2e-3, "{pose:?}: {error:?}");
            // A wall that is too rough, and none at all.
            scan.ranges.iter_mut().step_by(2).for_each(|r| *r += 0.2);
            assert_eq!(node.process(&target, &camera(), &scan), None);
            assert_eq!(node.process(&target, &camera(), &Scan::default()), None);
            assert_eq!(node.process(&target, &Camera::default(), &Scan::default()), None);
        }
    }

    #[test]
    fn a_height_fits_its_distance() {
        let pose = Pose2::new(2.1, 0.3, PI);
        let fits = |low: f32, high: f32, pose: &Pose2| {
            let at = |z: f32| camera().project([2.1, 0.3, z]).expect("ahead");
            let [top, bottom] = [at(0.8)[1], at(0.6)[1]].map(|v| libm::roundf(v + 0.5) as u32);
            let region = Region { left: 1, top, width: 9, height: bottom - top, area: 9 };
            fits_height(&Target { centre: at(0.7), region }, &camera(), pose, low, high)
        };
        assert_eq!(fits(0.195, 0.205, &pose), Some(pose));
        assert_eq!((fits(0.21, 0.3, &pose), fits(0.1, 0.19, &pose)), (None, None));
        // Something lower that hides it, at half the distance, and no distance at all.
        assert_eq!(fits(0.195, 0.205, &Pose2::new(1.1, 0.15, PI)), None);
        assert_eq!(fits(0.0, 1.0, &Pose2::new(f32::NAN, 0.0, 0.0)), None);
        assert_eq!(fits_height(&target_of(Region::default()), &Camera::default(), &pose, 0.1, 1.0), None);
    }

    fn target_of(region: Region) -> Target {
        Target { centre: region.middle(), region }
    }

    /// A target in a region of 100 by 100 pixels, with these lines.
    fn target(lines: &[[f32; 4]]) -> Option<[f32; 2]> {
        let region = Region { left: 100, top: 50, width: 101, height: 101, area: 1 };
        let lines = lines.iter().map(|[a, b, c, d]| Line { from: [*a, *b], to: [*c, *d] }).collect();
        let mut node = TargetLines::construct((0.35, 0.26, 0.6, 0.12));
        node.process(&lines, &[region].into()).map(|target| target.centre)
    }

    #[test]
    fn only_a_cross_is_a_target() {
        let (level, upright) = ([102.0, 100.0, 198.0, 100.0], [150.0, 148.0, 150.0, 52.0]);
        assert_eq!(target(&[level, upright]), Some([150.0, 100.0]));
        // Both edges of a stroke.
        assert_eq!(target(&[level, upright, [102.0, 104.0, 198.0, 104.0]]), Some([150.0, 102.0]));
        let (short, far) = ([130.0, 100.0, 170.0, 100.0], [102.0, 80.0, 198.0, 80.0]);
        let (steep, skew) = ([110.0, 80.0, 190.0, 120.0], [130.0, 52.0, 170.0, 148.0]);
        for other in [short, far, steep] {
            assert_eq!(target(&[other, upright]), None, "{other:?}");
        }
        assert_eq!(target(&[[104.0, 90.0, 196.0, 110.0], [135.0, 52.0, 165.0, 148.0]]), None, "not at a right angle");
        assert_eq!((target(&[level, skew]), target(&[level]), target(&[])), (None, None, None));
    }
}
