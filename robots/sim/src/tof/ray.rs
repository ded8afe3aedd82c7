use super::{
    solid::Surface,
    vector::{Turn, V3, add, dot, scale, sub, unit},
};

/// Half line from a point. The direction has length 1.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    pub origin: V3,
    pub direction: V3,
}

/// Point where a ray enters a surface.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// Distance from the origin of the ray, in m.
    pub distance: f32,
    /// Outward normal, of length 1.
    pub normal: V3,
}

impl Ray {
    /// Point at a distance.
    pub fn at(&self, distance: f32) -> V3 {
        add(self.origin, scale(self.direction, distance))
    }

    /// Returns `true` if the ray comes within `radius` of a point before it.
    pub fn touches(&self, (centre, radius): (V3, f32)) -> bool {
        let to = sub(centre, self.origin);
        let along = dot(to, self.direction);
        along > -radius && dot(to, to) - along * along <= radius * radius
    }

    /// First entry into a shape. `None` if the ray misses it or begins in it.
    pub fn enter(&self, surface: &Surface) -> Option<Entry> {
        match surface {
            Surface::Block { centre, size, turns } => self.enter_block(*centre, *size, turns),
            Surface::Rod { from, axis, length, radius } => self.enter_rod(*from, *axis, *length, *radius),
        }
    }

    fn enter_block(&self, centre: V3, size: V3, [inward, outward]: &[Turn; 2]) -> Option<Entry> {
        let origin = inward.of(sub(self.origin, centre));
        let direction = inward.of(self.direction);
        let (mut first, mut last, mut normal) = (f32::MIN, f32::MAX, [0.0; 3]);
        for axis in 0..3 {
            let half = 0.5 * size[axis];
            let [near, far] = [-half, half].map(|side| (side - origin[axis]) / direction[axis]);
            let (near, far) = (near.min(far), near.max(far));
            if direction[axis] == 0.0 {
                if origin[axis].abs() > half {
                    return None;
                }
                continue;
            }
            if near > first {
                first = near;
                normal = [0.0; 3];
                normal[axis] = -direction[axis].signum();
            }
            last = last.min(far);
        }
        (first > 0.0 && first <= last).then(|| Entry { distance: first, normal: outward.of(normal) })
    }

    fn enter_rod(&self, from: V3, axis: V3, length: f32, radius: f32) -> Option<Entry> {
        let start = sub(self.origin, from);
        let (origin_along, direction_along) = (dot(start, axis), dot(self.direction, axis));
        // Parts across the axis.
        let (o, d) = (sub(start, scale(axis, origin_along)), sub(self.direction, scale(axis, direction_along)));
        let (a, b, c) = (dot(d, d), dot(o, d), dot(o, o) - radius * radius);
        let side = (a > 1e-12 && b * b >= a * c).then(|| (-b - libm::sqrtf(b * b - a * c)) / a);
        let side = side.filter(|t| *t > 0.0 && (0.0..=length).contains(&(origin_along + t * direction_along)));
        if let Some(distance) = side {
            return Some(Entry { distance, normal: unit(add(o, scale(d, distance))) });
        }
        // The end that faces the ray.
        let (end, normal) = if direction_along > 0.0 { (0.0, scale(axis, -1.0)) } else { (length, axis) };
        let distance = (end - origin_along) / direction_along;
        let across = add(o, scale(d, distance));
        // False for NaN: a ray along the end.
        (distance > 0.0 && dot(across, across) <= radius * radius).then_some(Entry { distance, normal })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tof::Shape;
    use core::f32::consts::FRAC_PI_4;

    fn ray(origin: V3, to: V3) -> Ray {
        Ray { origin, direction: unit(sub(to, origin)) }
    }

    #[test]
    fn blocks_are_entered_on_the_side_that_faces_the_ray() {
        let block = Shape::Block { centre: [2.0, 0.0, 0.5], size: [1.0, 1.0, 1.0], yaw: 0.0 };
        let hit = ray([0.0, 0.0, 0.5], [1.0, 0.0, 0.5]).enter(&block.surface()).expect("ahead");
        assert!((hit.distance - 1.5).abs() < 1e-6 && hit.normal == [-1.0, 0.0, 0.0]);
        assert!(ray([0.0, 0.0, 1.1], [1.0, 0.0, 1.1]).enter(&block.surface()).is_none());
        assert!(ray([2.0, 0.0, 0.5], [3.0, 0.0, 0.5]).enter(&block.surface()).is_none(), "it begins inside");
        let top = ray([2.2, 0.1, 3.0], [2.2, 0.1, 2.0]).enter(&block.surface()).expect("below");
        assert!((top.distance - 2.0).abs() < 1e-6 && top.normal == [0.0, 0.0, 1.0]);
        let turned = Shape::Block { centre: [2.0, 0.0, 0.5], size: [1.0, 1.0, 1.0], yaw: FRAC_PI_4 };
        let edge = ray([0.0, 0.01, 0.5], [1.0, 0.01, 0.5]).enter(&turned.surface()).expect("ahead");
        assert!((edge.distance - (2.01 - 0.5_f32.sqrt())).abs() < 1e-4);
    }

    #[test]
    fn rods_are_round_and_have_ends() {
        let pole = Shape::Rod { from: [2.0, 0.0, 0.0], to: [2.0, 0.0, 1.0], radius: 0.1 };
        let hit = ray([0.0, 0.0, 0.5], [1.0, 0.0, 0.5]).enter(&pole.surface()).expect("ahead");
        assert!((hit.distance - 1.9).abs() < 1e-5 && (hit.normal[0] + 1.0).abs() < 1e-5);
        assert!(ray([0.0, 0.11, 0.5], [1.0, 0.11, 0.5]).enter(&pole.surface()).is_none());
        assert!(ray([0.0, 0.0, 1.1], [1.0, 0.0, 1.1]).enter(&pole.surface()).is_none());
        let end = ray([2.05, 0.0, 3.0], [2.05, 0.0, 2.0]).enter(&pole.surface()).expect("below");
        assert!((end.distance - 2.0).abs() < 1e-5 && end.normal == [0.0, 0.0, 1.0]);
    }

    #[test]
    fn bounds_contain_the_shape() {
        let cable = Shape::Rod { from: [1.0, -1.0, 0.0], to: [1.0, 1.0, 0.0], radius: 0.01 };
        assert!(ray([0.0, 0.0, 0.1], [1.0, 0.99, 0.0]).touches(cable.bounds()));
        assert!(!ray([0.0, 0.0, 2.0], [-1.0, 0.0, 2.0]).touches(cable.bounds()));
    }
}
