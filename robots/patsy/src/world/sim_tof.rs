use super::Thing;
use apex_nodes::{cloud::PointCloud, scan::Pose2};
use apex_rt::{Ctx, Out, node};
use apex_sim::{
    Random,
    tof::{Floor, Space, TofCamera, TofFrame},
};

/// Simulated time-of-flight camera of a robot that stands on a floor: a source.
#[node]
#[derive(Debug)]
pub struct SimTof {
    /// Seed of the noise.
    #[param(default = 1)]
    seed: u64,
    /// A box stands before the robot.
    #[param(default = false)]
    carton: bool,
    /// The floor ends at stairs that go down.
    #[param(default = false)]
    stairs: bool,
    world: Option<(Space, Random)>,
    frame: TofFrame,
}

/// Distance of the box and of the stairs, in m.
const AHEAD: f32 = 0.9;

#[node]
impl SimTof {
    fn process(&mut self, ctx: &Ctx, cloud: &mut Out<PointCloud>, pose: &mut Out<Pose2>) {
        let (carton, stairs, seed) = (self.carton, self.stairs, self.seed);
        let (space, random) = self.world.get_or_insert_with(|| {
            let mut random = Random::new(seed);
            let mut space = Space::new(Floor { end: if stairs { AHEAD } else { f32::INFINITY }, ..Floor::default() });
            if carton {
                Thing::Carton.place(&Pose2::new(AHEAD, 0.0, 0.0), &mut random, &mut space);
            }
            (space, random)
        });
        TofCamera::default().take(space, &Pose2::default(), ctx.now(), random, &mut self.frame);
        cloud.get_mut().clone_from(&self.frame.cloud);
        pose.set(Pose2::default());
    }
}
