use apex_nodes::image::GrayImage;
use apex_sim::{Light, Random, expose};
use image::{ImageBuffer, Luma};
use std::{
    f32::consts::{FRAC_PI_4, TAU},
    ops::Range,
};

/// Side of a cube, in m.
pub const CUBE_SIDE: f32 = 0.06;

/// Columns and rows of an image of the hopper.
pub const HOPPER_SIZE: (u32, u32) = (320, 240);

/// Height of the camera above the ground of the hopper, and width of the visible ground, in m.
const EYE: f32 = 0.24;
const GROUND: f32 = 0.17;

/// Size of a pixel on the ground, in m.
const SCALE: f32 = GROUND / HOPPER_SIZE.0 as f32;

/// Brightness of the ground, and of the squares on it.
const DARK: f32 = 22.0;
const LIGHT: f32 = 150.0;

/// Cube in the hopper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cube {
    /// Number in its bar codes, 1 to 4.
    pub number: u32,
    /// Position of the middle, in m from the middle of the ground: right in the image, down in it, and up from the
    /// ground.
    pub place: [f32; 3],
    /// Rotation about the vertical axis, in rad.
    pub turn: f32,
    /// Tilt, in rad: a wedged cube does not lie flat.
    pub lean: f32,
}

/// Scene of the camera above the hopper (thesis 4.3.3, figure 4.6).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hopper {
    /// `true` if the ground has a pattern.
    pub pattern: bool,
    /// Cube in the hopper.
    pub cube: Option<Cube>,
    /// Lighting of the hopper.
    pub light: Light,
    /// Standard deviation of the brightness of a pixel, of 255.
    pub noise: f32,
}

impl Cube {
    /// A cube at a random place on the ground, in a random direction. One of four is wedged.
    pub fn random(random: &mut Random) -> Self {
        let wedged = random.chance(0.25);
        let lean = if wedged { random.uniform(0.2, FRAC_PI_4) } else { 0.0 };
        // The lowest edge is on the ground, or higher if the cube hangs between the walls.
        let height = 0.5 * CUBE_SIDE * (lean.sin() + lean.cos()) + if wedged { random.uniform(0.0, 0.03) } else { 0.0 };
        Self {
            number: 1 + (random.bits() % 4) as u32,
            place: [random.uniform(-0.025, 0.025), random.uniform(-0.015, 0.015), height],
            turn: random.uniform(0.0, TAU),
            lean,
        }
    }

    /// Rotates a vector from the world to the frame of the cube.
    fn inner(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        let ((sin, cos), (down, level)) = (self.turn.sin_cos(), self.lean.sin_cos());
        let (a, b) = (cos * x + sin * y, cos * y - sin * x);
        [a, level * b + down * z, level * z - down * b]
    }

    /// Rotates a vector from the frame of the cube to the world.
    fn outer(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        let ((sin, cos), (down, level)) = (self.turn.sin_cos(), self.lean.sin_cos());
        let (a, b) = (x, level * y - down * z);
        [cos * a - sin * b, sin * a + cos * b, level * z + down * y]
    }

    /// Columns and rows of the image that may show the cube: those between its corners.
    fn extent(&self) -> [Range<u32>; 2] {
        let half = 0.5 * CUBE_SIDE;
        let corners: [[f32; 2]; 8] = std::array::from_fn(|i| {
            let corner = self.outer([i & 1, i >> 1 & 1, i >> 2].map(|side| if side == 0 { -half } else { half }));
            let [x, y, z]: [f32; 3] = std::array::from_fn(|axis| self.place[axis] + corner[axis]);
            [x, y].map(|x| x * EYE / (EYE - z) / SCALE)
        });
        [(0, HOPPER_SIZE.0), (1, HOPPER_SIZE.1)].map(|(axis, count)| {
            let pixels = corners.map(|corner| corner[axis] + 0.5 * count as f32);
            let (first, last) = (pixels.into_iter().fold(f32::MAX, f32::min), pixels.into_iter().fold(0.0, f32::max));
            // One more on each side, for rounding. Casts saturate.
            (first.floor() as u32).saturating_sub(1)..(last.ceil() as u32 + 1).min(count)
        })
    }

    /// Brightness of the point of the cube that a ray from the camera hits.
    fn shade(&self, ray: [f32; 3]) -> Option<f32> {
        let [x, y, z] = self.place;
        let (eye, ray) = (self.inner([-x, -y, EYE - z]), self.inner(ray));
        let half = 0.5 * CUBE_SIDE;
        let (mut near, mut far, mut axis) = (0.0, f32::MAX, 2);
        for i in 0..3 {
            let [a, b] = [-half, half].map(|side| (side - eye[i]) / ray[i]);
            // Both are infinite for a ray parallel to the face, and NaN within its plane, which then does not count.
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
    /// A hopper with or without a pattern, in random light, with or without a cube.
    pub fn random(pattern: bool, full: bool, random: &mut Random) -> Self {
        let cube = full.then(|| Cube::random(random));
        let light = Light {
            // Logarithmic: as many images are half as bright as twice as bright.
            gain: random.uniform(0.05_f32.ln(), 3.0_f32.ln()).exp(),
            slope: random.uniform(-0.8, 0.8),
            haze: random.uniform(0.0, 40.0),
        };
        Self { pattern, cube, light, noise: random.uniform(1.0, 5.0) }
    }

    /// Image of the camera.
    pub fn photo(&self, random: &mut Random) -> GrayImage {
        let (width, height) = HOPPER_SIZE;
        let (across, down) = (even_squares(width), even_squares(height));
        let ground = |u: u32, v: u32| {
            let same = |a: &bool| down[v as usize].iter().filter(|b| a == *b).count();
            let light = if self.pattern { across[u as usize].iter().map(same).sum::<usize>() } else { 0 } as f32;
            Luma([(0.25 * (light * LIGHT + (4.0 - light) * DARK)) as u8])
        };
        let mut image = ImageBuffer::from_fn(width, height, ground);
        if let Some(cube) = &self.cube {
            let [columns, rows] = cube.extent();
            for (u, v) in rows.flat_map(|v| columns.clone().map(move |u| (u, v))) {
                image.put_pixel(u, v, Luma([self.mean(cube, u, v) as u8]));
            }
        }
        let mut image = GrayImage::from(image);
        expose(&self.light, self.noise, random, &mut image);
        image
    }

    /// Brightness of a pixel that may show the cube.
    fn mean(&self, cube: &Cube, u: u32, v: u32) -> f32 {
        let ([left, right], [upper, lower]) = (places(u, HOPPER_SIZE.0), places(v, HOPPER_SIZE.1));
        let rays = [[left, upper], [left, lower], [right, upper], [right, lower]];
        let shade = |[x, y]: [f32; 2]| cube.shade([x, y, -EYE]).unwrap_or_else(|| self.ground(x, y));
        0.25 * rays.map(shade).iter().sum::<f32>()
    }

    /// Brightness of the ground: dark, or with light squares.
    fn ground(&self, x: f32, y: f32) -> f32 {
        if self.pattern && is_even(x) == is_even(y) { LIGHT } else { DARK }
    }
}

/// Places where the two rays of a pixel in one dimension hit the ground, in m from its middle. Both dimensions give
/// four.
fn places(pixel: u32, count: u32) -> [f32; 2] {
    [0.25, 0.75].map(|part| (pixel as f32 + part - 0.5 * count as f32) * SCALE)
}

/// For each pixel and each of its rays in one dimension: `true` if it hits an even square.
fn even_squares(count: u32) -> Vec<[bool; 2]> {
    (0..count).map(|pixel| places(pixel, count).map(is_even)).collect()
}

/// Returns `true` if a place is in an even square.
fn is_even(x: f32) -> bool {
    const SQUARE: f32 = 0.02;
    (x / SQUARE).floor() as i32 % 2 == 0
}

/// Brightness of a face of a cube, from (0, 0) to (1, 1): a white label with bars on wood.
fn label(number: u32, x: f32, y: f32) -> f32 {
    if !(0.03..0.97).contains(&x) || !(0.25..0.75).contains(&y) {
        return 165.0;
    }
    let modules = bars(number);
    let module = (x - 0.03) / 0.94 * modules.len() as f32;
    if (0.3..0.7).contains(&y) && modules.get(module as usize) == Some(&true) { 20.0 } else { 225.0 }
}

/// Modules of the Code 39 of a digit between two stars, with quiet zones; `true` is black.
fn bars(number: u32) -> &'static [bool] {
    static ALL: std::sync::LazyLock<[Vec<bool>; 4]> = std::sync::LazyLock::new(|| [1, 2, 3, 4].map(modules));
    ALL.get(number.wrapping_sub(1) as usize).map_or(&[], Vec::as_slice)
}

fn modules(number: u32) -> Vec<bool> {
    /// Bars and gaps alternately, `w` for wide ones (ISO/IEC 16388).
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
