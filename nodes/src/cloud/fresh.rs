use super::PointCloud;
use apex_rt::{Ctx, Out, node};

/// Passes a cloud on if it is new and shows something; ⊥ otherwise. So a camera that is frozen or covered is not taken
/// for free space.
///
/// A cloud is new if its stamp is later than that of the one before it, and at most `max_age` old.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct FreshCloud {
    /// Maximum age of a cloud.
    #[param(unit = "s", default = 0.3, range = 0.0..=60.0)]
    max_age: f32,
    /// Minimum share of points with a measurement.
    #[param(default = 0.05, range = 0.0..=1.0)]
    min_share: f32,
    last: Option<apex_rt::Time>,
}

#[node]
impl FreshCloud {
    fn process(&mut self, ctx: &Ctx, cloud: &PointCloud, fresh: &mut Out<PointCloud>) {
        let is_new = self.last.replace(cloud.stamp).is_none_or(|last| cloud.stamp > last);
        let age = ctx.now().since(cloud.stamp).as_secs_f32();
        let measured = cloud.points().iter().filter(|point| point.is_measured()).count();
        let is_seen = measured > 0 && measured as f32 >= self.min_share * cloud.points().len() as f32;
        if is_new && age <= self.max_age && is_seen {
            fresh.get_mut().clone_from(cloud);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::CloudPoint;
    use apex_rt::{Construct, Time};

    #[test]
    fn old_repeated_and_empty_clouds_are_dropped() {
        let mut node = FreshCloud::construct((0.2, 0.5));
        let mut passes = |now: i64, stamp: i64, measured: usize| {
            let mut cloud = PointCloud::default();
            cloud.reset(Time::from_millis(stamp), (2, 2));
            cloud.points_mut()[..measured].fill(CloudPoint { x: 1.0, y: 0.0, z: 0.0, intensity: 1.0 });
            let mut out = Out::new();
            node.process(&Ctx::new(Time::from_millis(now)), &cloud, &mut out);
            out.get().is_some()
        };
        let cases = [(0, 0, 4), (100, 0, 4), (200, 200, 4), (300, 300, 1), (400, 400, 0), (900, 500, 4), (900, 900, 2)];
        assert_eq!(
            cases.map(|(now, stamp, measured)| passes(now, stamp, measured)),
            [true, false, true, false, false, false, true]
        );
        let mut out = Out::new();
        node.process(&Ctx::new(Time::from_millis(950)), &PointCloud::default(), &mut out);
        assert!(out.get().is_none());
    }
}
