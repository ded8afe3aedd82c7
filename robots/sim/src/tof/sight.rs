use super::{
    optics::Optics,
    solid::{Shape, Solid},
    space::Space,
    vector::V3,
};
use apex_nodes::{
    math::normalize_angle,
    scan::{Point2, Pose2},
};
use core::f32::consts::PI;

/// Largest effect of rounding on a direction, in rad, and on a distance, in m.
const ROUNDING: [f32; 2] = [0.002, 0.01];

/// Solids that the rays of each block of pixels may meet: the others need not be tried.
#[derive(Debug, Clone, Default)]
pub(super) struct Sight {
    /// Numbers of the solids of each block in their order, and their least distances from the camera, in m.
    blocks: Vec<Vec<(usize, f32)>>,
}

/// Directions in which a solid lies on the plane, from the middle one on, in rad, and its least distance, in m.
struct Span {
    middle: f32,
    off: [f32; 2],
    least: f32,
}

impl Sight {
    /// Finds the solids before a camera at a place with a heading.
    pub fn look(&mut self, space: &Space, optics: &Optics, place: &Pose2) {
        self.blocks.resize_with(optics.blocks().len(), Vec::new);
        self.blocks.iter_mut().for_each(Vec::clear);
        for (number, solid) in space.solids().iter().enumerate() {
            let span = Span::new(solid, place);
            for (list, block) in self.blocks.iter_mut().zip(optics.blocks()) {
                if span.meets(*block) {
                    list.push((number, span.least));
                }
            }
        }
    }

    /// Solids that the rays of a block may meet.
    pub fn of(&self, block: usize) -> impl Iterator<Item = (usize, f32)> + Clone + '_ {
        self.blocks[block].iter().copied()
    }
}

impl Span {
    fn new(solid: &Solid, place: &Pose2) -> Self {
        let seen = |at: V3| place.to_inner(Point2::new(at[0], at[1]));
        match solid.shape {
            Shape::Block { centre, size, yaw } => {
                let pose = Pose2::new(centre[0], centre[1], yaw);
                let [x, y] = [0.5 * size[0], 0.5 * size[1]];
                let corner = |x, y| (place.to_inner(pose.to_outer(Point2::new(x, y))), 0.0);
                let here = pose.to_inner(place.position());
                let beside = Point2::new((here.x.abs() - x).max(0.0), (here.y.abs() - y).max(0.0));
                let corners = [corner(x, y), corner(x, -y), corner(-x, y), corner(-x, -y)];
                Self::around(seen(centre), beside.norm(), &corners)
            }
            Shape::Rod { from, to, radius } => {
                let [a, b] = [seen(from), seen(to)];
                let along = b - a;
                let share = (-a.dot(along) / along.norm_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
                let least = (a + along.scaled(share)).norm() - radius;
                Self::around((a + b).scaled(0.5), least, &[(a, radius), (b, radius)])
            }
        }
    }

    /// Span of the hull of discs about a middle. One that contains the camera, nearly, is everywhere.
    fn around(middle: Point2, least: f32, discs: &[(Point2, f32)]) -> Self {
        if least <= ROUNDING[1] || !least.is_finite() {
            return Self { middle: 0.0, off: [-PI, PI], least: 0.0 };
        }
        let angle = middle.angle();
        let off = |side: f32| {
            let ends = discs.iter().map(move |(at, radius)| {
                let half = libm::asinf((radius / at.norm()).min(1.0));
                side * normalize_angle(&(at.angle() - angle)) + half
            });
            ends.fold(0.0, f32::max) + ROUNDING[0]
        };
        Self { middle: angle, off: [-off(-1.0), off(1.0)], least: least - ROUNDING[1] }
    }

    /// Returns `true` if a part of the span lies between two directions, in rad.
    fn meets(&self, [from, to]: [f32; 2]) -> bool {
        let half = 0.5 * (to - from);
        let off = normalize_angle(&(from + half - self.middle));
        self.off[0] - half <= off && off <= self.off[1] + half
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Random,
        tof::{Floor, Material, SolidKind, TofCamera, ray::Ray, vector::Turn},
    };

    /// The nearest of all solids on each ray is among those of its block.
    #[test]
    fn no_ray_misses_a_solid() {
        let mut random = Random::new(3);
        let (mut optics, mut sight) = (Optics::default(), Sight::default());
        let camera = TofCamera { width: 40, height: 30, rays: 1, ..TofCamera::default() };
        optics.prepare(&camera);
        for _ in 0..20 {
            let mut space = Space::new(Floor::default());
            let mut at = |most: f32| random.uniform(-most, most);
            for number in 0..30 {
                let centre = [at(4.0), at(4.0), 0.5 + at(0.5)];
                let shape = if number % 2 == 0 {
                    Shape::Block { centre, size: [0.02 + at(1.0).abs(), 4.0 * at(1.0).abs(), 1.0], yaw: at(PI) }
                } else {
                    let to = [centre[0] + at(1.0), centre[1] + at(1.0), at(1.0).abs()];
                    Shape::Rod { from: centre, to, radius: 0.01 + at(0.2).abs() }
                };
                space.add(Solid { shape, material: Material::plain(0.5), kind: SolidKind::Object });
            }
            let place = Pose2::new(at(1.0), at(1.0), at(PI));
            sight.look(&space, &optics, &place);
            for pixel in 0..40 * 30 {
                for direction in optics.rays(pixel) {
                    let direction = Turn::new(place.theta).of(*direction);
                    let ray = Ray { origin: [place.x, place.y, 0.1], direction };
                    let all = space.hit(&ray, None).map(|hit| (hit.solid, hit.entry.distance));
                    let few = space.nearest(&ray, None, sight.of(optics.block(pixel)));
                    assert_eq!(few.map(|hit| (hit.solid, hit.entry.distance)), all, "{place:?}");
                }
            }
        }
    }
}
