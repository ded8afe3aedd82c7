use apex_nodes::image::GrayImage;
use apex_sim::{Light, Random, expose};
use image::{ImageBuffer, Luma};
use std::f32::consts::{FRAC_PI_4, TAU};

/// Side of a cube, in m.
pub const CUBE_SIDE: f32 = 0.06;

/// Columns and rows of an image of the hopper.
pub const HOPPER_SIZE: (u32, u32) = (320, 240);

/// Height of the camera above the ground of the hopper, and the width of the ground that it sees, in m.
const EYE: f32 = 0.24;
const GROUND: f32 = 0.17;

/// A cube in the hopper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cube {
    /// What its bar codes say, 1 to 4.
    pub number: u32,
    /// Where its middle is, in m from the middle of the ground: right in the image, down in it, and up from the ground.
    pub place: [f32; 3],
    /// How far it is turned about the upright axis, in rad.
    pub turn: f32,
    /// How far it leans, in rad: a cube that is wedged does not lie flat.
    pub lean: f32,
}

/// What the camera above the hopper looks at (thesis 4.3.3, figure 4.6).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hopper {
    /// Whether there is a pattern on its ground.
    pub pattern: bool,
    /// What lies in it.
    pub cube: Option<Cube>,
    /// How it is lit.
    pub light: Light,
    /// Standard deviation of the brightness of a pixel, of 255.
    pub noise: f32,
}

impl Cube {
    /// A cube anywhere on the ground, in any direction; of four one is wedged.
    pub fn random(random: &mut Random) -> Self {
        let wedged = random.chance(0.25);
        let lean = if wedged { random.uniform(0.2, FRAC_PI_4) } else { 0.0 };
        // The lowest edge is on the ground, or higher if it hangs between the walls.
        let height = 0.5 * CUBE_SIDE * (lean.sin() + lean.cos()) + if wedged { random.uniform(0.0, 0.03) } else { 0.0 };
        Self {
            number: 1 + (random.bits() % 4) as u32,
            place: [random.uniform(-0.025, 0.025), random.uniform(-0.015, 0.015), height],
            turn: random.uniform(0.0, TAU),
            lean,
        }
    }

    /// A point or a direction of the world in the frame of the cube.
    fn inner(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        let ((sin, cos), (down, level)) = (self.turn.sin_cos(), self.lean.sin_cos());
        let (a, b) = (cos * x + sin * y, cos * y - sin * x);
        [a, level * b + down * z, level * z - down * b]
    }

    /// The brightness of what a ray from the camera meets of the cube.
    fn shade(&self, ray: [f32; 3]) -> Option<f32> {
        let [x, y, z] = self.place;
        let (eye, ray) = (self.inner([-x, -y, EYE - z]), self.inner(ray));
        let half = 0.5 * CUBE_SIDE;
        let (mut near, mut far, mut axis) = (0.0, f32::MAX, 2);
        for i in 0..3 {
            let [a, b] = [-half, half].map(|side| (side - eye[i]) / ray[i]);
            // Both are infinite for a ray along the face; a face that it lies in is none.
            if a.min(b) > near {
                (near, axis) = (a.min(b), i);
            }
            far = far.min(a.max(b));
        }
        if near >= far {
            return None;
        }
        let hit: [f32; 3] = std::array::from_fn(|i| (eye[i] + near * ray[i]) / CUBE_SIDE + 0.5);
        // The light comes from above.
        let cosine = (ray[axis].abs() / ray.iter().map(|r| r * r).sum::<f32>().sqrt()).clamp(0.0, 1.0);
        let light = 0.45 + 0.55 * cosine;
        Some(light * label(self.number, hit[(axis + 1) % 3], hit[(axis + 2) % 3]))
    }
}

impl Hopper {
    /// A hopper with or without a pattern, in any light, that holds a cube or not.
    pub fn random(pattern: bool, full: bool, random: &mut Random) -> Self {
        let cube = full.then(|| Cube::random(random));
        let light = Light {
            // As many images are half as bright as twice as bright.
            gain: random.uniform(0.05_f32.ln(), 3.0_f32.ln()).exp(),
            slope: random.uniform(-0.8, 0.8),
            haze: random.uniform(0.0, 40.0),
        };
        Self { pattern, cube, light, noise: random.uniform(1.0, 5.0) }
    }

    /// The image of the camera.
    pub fn photo(&self, random: &mut Random) -> GrayImage {
        let (width, height) = HOPPER_SIZE;
        let mean = |u: u32, v: u32| {
            // Four rays for each pixel.
            let part = [0.25, 0.75];
            let rays = part.iter().flat_map(|a| part.map(|b| [u as f32 + a, v as f32 + b]));
            0.25 * rays.map(|[u, v]| self.shade(u - 0.5 * width as f32, v - 0.5 * height as f32)).sum::<f32>()
        };
        let mut image = GrayImage::from(ImageBuffer::from_fn(width, height, |u, v| Luma([mean(u, v) as u8])));
        expose(&self.light, self.noise, random, &mut image);
        image
    }

    /// The brightness at a place of the image, in pixels from its middle.
    fn shade(&self, u: f32, v: f32) -> f32 {
        let scale = GROUND / HOPPER_SIZE.0 as f32;
        let (x, y) = (u * scale, v * scale);
        self.cube.and_then(|cube| cube.shade([x, y, -EYE])).unwrap_or_else(|| self.ground(x, y))
    }

    /// The ground: black, or with light squares on it.
    fn ground(&self, x: f32, y: f32) -> f32 {
        const SQUARE: f32 = 0.02;
        let even = |x: f32| (x / SQUARE).floor().rem_euclid(2.0) == 0.0;
        if self.pattern && even(x) == even(y) { 150.0 } else { 22.0 }
    }
}

/// The brightness of a face of a cube, from (0, 0) to (1, 1): a white label with bars on wood.
fn label(number: u32, x: f32, y: f32) -> f32 {
    if !(0.03..0.97).contains(&x) || !(0.25..0.75).contains(&y) {
        return 165.0;
    }
    let modules = bars(number);
    let module = (x - 0.03) / 0.94 * modules.len() as f32;
    if (0.3..0.7).contains(&y) && modules.get(module as usize) == Some(&true) { 20.0 } else { 225.0 }
}

/// Code 39 of a digit between two stars, with quiet zones: whether each module is black.
fn bars(number: u32) -> &'static [bool] {
    static ALL: std::sync::LazyLock<[Vec<bool>; 4]> = std::sync::LazyLock::new(|| [1, 2, 3, 4].map(modules));
    ALL.get(number.wrapping_sub(1) as usize).map_or(&[], Vec::as_slice)
}

fn modules(number: u32) -> Vec<bool> {
    /// Bars and gaps in turn, `w` for wide ones (ISO/IEC 16388).
    const STAR: &str = "nwnnwnwnn";
    const DIGITS: [&str; 4] = ["wnnwnnnnw", "nnwwnnnnw", "wnwwnnnnn", "nnnwwnnnw"];
    let quiet = [false; 10];
    let mut modules = quiet.to_vec();
    for character in [STAR, DIGITS[number as usize - 1], STAR] {
        for (i, width) in character.chars().enumerate() {
            modules.extend(std::iter::repeat_n(i % 2 == 0, if width == 'w' { 2 } else { 1 }));
        }
        modules.push(false);
    }
    modules.extend(quiet);
    modules
}
