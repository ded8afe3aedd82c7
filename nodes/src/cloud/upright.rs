use super::Cluster;
use crate::{
    persons::{Detections, View},
    scan::{Point2, Pose2},
};
use apex_rt::{Ctx, Out, node};
use core::f32::consts::TAU;

/// Height that a scanner sees at 1 m, in m: less than that of a VLP-16.
const SEEN: f32 = 0.4;

/// Finds the clusters that may be persons: upright ones of that size. Trunks of trees are, too; a tracker tells them
/// apart by their motion, and by what a camera sees.
///
/// `clusters` are in the frame of the robot, whose origin is on the ground, and `pose` is the pose of the robot in a
/// fixed frame, which is that of the detections: the middles of the clusters, pushed away from the robot by `inward`,
/// as the scanner sees their near side. The stamp is that of the firing, and the view a circle of the radius `reach`.
#[node]
#[derive(Debug, Clone)]
pub struct UprightClusters {
    /// Greatest width along each axis.
    #[param(unit = "m", default = 0.9, range = 0.01..=10.0)]
    max_width: f32,
    /// Least height of a cluster, from its lowest point to its highest one; less very near, where a scanner does not
    /// see more.
    #[param(unit = "m", default = 0.5, range = 0.0..=10.0)]
    min_height: f32,
    /// Greatest height of a cluster.
    #[param(unit = "m", default = 2.1, range = 0.0..=10.0)]
    max_height: f32,
    /// Least height of the top above the robot's origin.
    #[param(unit = "m", default = 0.8, range = 0.0..=10.0)]
    min_top: f32,
    /// Greatest height of the top above the robot's origin.
    #[param(unit = "m", default = 2.4, range = 0.0..=10.0)]
    max_top: f32,
    /// Slope of the ground, as its tangent, by which the top may be lower or higher.
    #[param(default = 0.25, range = 0.0..=1.0)]
    slope: f32,
    /// Distance up to which clusters count.
    #[param(unit = "m", default = 22.0, range = 0.1..=100.0)]
    reach: f32,
    /// Distance of the middle of a person behind the near side.
    #[param(unit = "m", default = 0.12, range = 0.0..=1.0)]
    inward: f32,
}

#[node]
impl UprightClusters {
    fn process(&mut self, ctx: &Ctx, clusters: &Vec<Cluster>, pose: &Pose2, persons: &mut Out<Detections>) {
        if !pose.is_usable() {
            return;
        }
        let out = persons.get_mut();
        out.stamp = ctx.stamp();
        out.view = View { pose: *pose, angle: TAU, nearest: 0.0, range: self.reach };
        out.positions.clear();
        for cluster in clusters {
            let middle = Point2::new(0.5 * (cluster.min[0] + cluster.max[0]), 0.5 * (cluster.min[1] + cluster.max[1]));
            let range = middle.norm();
            let [width, depth] = [0, 1].map(|k| cluster.max[k] - cluster.min[k]);
            let rise = self.slope * range;
            let (top, height) = (cluster.max[2], cluster.max[2] - cluster.min[2]);
            let is_upright = (self.min_top - rise..=self.max_top + rise).contains(&top)
                && height >= self.min_height.min(SEEN * range)
                && height <= self.max_height;
            // False for NaN.
            let fits = width.max(depth) <= self.max_width && range <= self.reach && range > 0.1 && is_upright;
            if fits {
                let place = middle.scaled(1.0 + self.inward / range);
                // Who is too many is left out.
                let _ = out.positions.push(pose.to_outer(place));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn only_upright_clusters_are_kept() {
        let at = |x: f32, width: f32, top: f32| Cluster {
            points: 30,
            min: [x, -0.5 * width, 0.1],
            max: [x + 0.2, 0.5 * width, top],
        };
        let clusters = vec![
            at(4.0, 0.4, 1.7),
            at(6.0, 2.0, 1.7),
            at(8.0, 0.4, 4.5),
            at(9.0, 0.4, 0.1),
            Cluster { points: 30, min: [0.7, -0.15, 0.55], max: [0.9, 0.15, 0.9] },
            at(30.0, 0.4, 1.7),
        ];
        let pose = Pose2::new(1.0, 2.0, FRAC_PI_2);
        let mut node = UprightClusters::construct((0.9, 0.5, 2.1, 0.8, 2.4, 0.05, 22.0, 0.12));
        let mut out = Out::new();
        node.process(&Ctx::new(Time::from_millis(30)), &clusters, &pose, &mut out);
        let found = out.get().expect("detections");
        assert_eq!((found.positions.len(), found.stamp), (2, Time::from_millis(30)), "one of them is very near");
        assert!((found.positions[0] - Point2::new(1.0, 2.0 + 4.22)).norm() < 1e-4, "{:?}", found.positions);
        let far = Pose2::new(f32::NAN, 0.0, 0.0);
        let mut out = Out::new();
        node.process(&Ctx::new(Time::ZERO), &clusters, &far, &mut out);
        assert!(out.get().is_none());
    }
}
