use super::Thing;
use apex_nodes::scan::Pose2;
use apex_rt::Time;
use apex_sim::{
    Random,
    tof::{Distortion, Floor, Material, Shape, Solid, SolidKind, Space, TofCamera, TofFrame},
};
use core::f32::consts::PI;

/// Camera with a space before it.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Camera, with errors of its own.
    pub camera: TofCamera,
    /// Space before it.
    pub space: Space,
    random: Random,
}

/// Rear walls: how many of ten scenes have them in the range of the camera, just beyond it, and not at all.
const NEAR_WALLS: f64 = 0.6;
const WRAPPED_WALLS: f64 = 0.75;

impl Scene {
    /// Creates a scene with an empty floor and a camera, both of the seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        // A second stream: seeds that follow each other differ in their first numbers too.
        let mut random = Random::new(random.bits());
        let camera = TofCamera { distortion: Distortion::random(&mut random), ..TofCamera::default() };
        let (albedo, tile) = (random.uniform(0.15, 0.5), random.uniform(0.2, 0.6));
        let floor = Floor { albedo, tile, variation: random.uniform(0.0, 0.15), ..Floor::default() };
        Self { camera, space: Space::new(floor), random }
    }

    /// Takes a frame from the origin.
    pub fn take(&mut self) -> TofFrame {
        self.take_from(&Pose2::default(), Time::ZERO)
    }

    /// Takes a frame from a pose at a time.
    pub fn take_from(&mut self, pose: &Pose2, now: Time) -> TofFrame {
        let mut frame = TofFrame::default();
        self.camera.take(&self.space, pose, now, &mut self.random, &mut frame);
        frame
    }

    /// Random number from −`most` to `most`.
    pub fn uniform(&mut self, most: f32) -> f32 {
        self.random.uniform(-most, most)
    }

    /// Places a thing.
    pub fn place_at(&mut self, thing: Thing, pose: &Pose2) {
        thing.place(pose, &mut self.random, &mut self.space);
    }

    /// Places a thing at a distance, at a random place across and in a random direction.
    pub fn place(&mut self, thing: Thing, distance: f32) {
        let across = distance * self.uniform(0.45);
        let pose = Pose2::new(distance, across, self.uniform(PI));
        self.place_at(thing, &pose);
    }

    /// Adds a wall across the view.
    pub fn wall(&mut self, distance: f32) {
        let (yaw, albedo) = (self.random.uniform(-0.4, 0.4), self.random.uniform(0.4, 0.85));
        self.upright([distance, 0.0], [0.1, 40.0, 2.6], yaw, Material::plain(albedo), SolidKind::Object);
    }

    fn upright(&mut self, [x, y]: [f32; 2], size: [f32; 3], yaw: f32, material: Material, kind: SolidKind) {
        let shape = Shape::Block { centre: [x, y, 0.5 * size[2]], size, yaw };
        self.space.add(Solid { shape, material, kind });
    }

    fn furnish(&mut self) {
        let kind = self.random.unit();
        if kind < NEAR_WALLS {
            let distance = self.random.uniform(2.5, 8.0);
            self.wall(distance);
        } else if kind < WRAPPED_WALLS {
            let distance = self.random.uniform(10.0, 10.12);
            self.upright([distance + 0.05, 0.0], [0.1, 60.0, 2.6], 0.0, Material::plain(0.85), SolidKind::Object);
        } else if self.random.chance(0.5) {
            let (x, y) = (self.random.uniform(30.5, 34.0), self.random.uniform(-4.0, 4.0));
            self.upright([x, y], [0.02, 0.8, 2.0], 0.0, Material::RETRO, SolidKind::Unlabelled);
        }
        if self.random.chance(0.5) {
            let side = if self.random.chance(0.5) { 1.0 } else { -1.0 };
            let aside = side * self.random.uniform(1.0, 2.0);
            let yaw = self.random.uniform(-0.1, 0.1);
            self.upright([4.0, aside], [8.0, 0.1, 2.6], yaw, Material::plain(0.7), SolidKind::Object);
        }
    }
}

/// Scene with a few things on the floor, most of them small, in a room or a hall (thesis 6.10.1).
pub fn labelled_scene(seed: u64) -> Scene {
    let mut scene = Scene::new(seed);
    scene.furnish();
    for _ in 0..2 + (scene.random.unit() * 4.0) as usize {
        let thing = Thing::LITTLE[(scene.random.unit() * Thing::LITTLE.len() as f64) as usize];
        let distance = scene.random.uniform(0.6, 2.2);
        scene.place(thing, distance);
    }
    for (thing, nearest) in [(Thing::Carton, 1.2), (Thing::Table, 1.8)] {
        if scene.random.chance(0.4) {
            let distance = scene.random.uniform(nearest, 5.0);
            scene.place(thing, distance);
        }
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_sim::tof::Truth;

    #[test]
    fn scenes_have_all_classes_and_are_those_of_their_seed() {
        let mut counts = std::collections::HashMap::new();
        for seed in 1..=6 {
            let frame = labelled_scene(seed).take();
            frame.truth.iter().for_each(|truth| *counts.entry(*truth).or_insert(0) += 1);
            let again = labelled_scene(seed).take();
            assert_eq!(frame.truth, again.truth);
        }
        for truth in [Truth::Floor, Truth::Small, Truth::Object, Truth::Overhanging, Truth::Artefact] {
            assert!(counts.get(&truth).is_some_and(|count| *count > 20), "{truth:?}: {counts:?}");
        }
    }
}
