use apex_nodes::image::GrayImage;
use apex_sim::Picture;
use image::{ImageBuffer, Luma};
use std::sync::LazyLock;

/// Width of the plate of a target, in m.
pub const TARGET_WIDTH: f32 = 0.24;

/// Width of the paper of a number sign, in m.
pub const NUMBER_WIDTH: f32 = 0.3;

/// Columns and rows of a drawing.
const SIDE: u32 = 240;

/// Brightness of paper and ink, which are not perfectly white and black.
const PAPER: f32 = 225.0;
const INK: f32 = 25.0;

/// Target sign: a cross in two rings on a plate.
pub static TARGET: LazyLock<Picture> = LazyLock::new(target);

/// Number signs; 1 comes first.
pub static SIGNS: LazyLock<[Picture; 4]> = LazyLock::new(|| [1, 2, 3, 4].map(number));

fn target() -> Picture {
    /// Half the width of a stroke, the radii of the rings and the length of an arm, as fractions of the plate's width.
    const STROKE: f32 = 0.025;
    const RINGS: [f32; 2] = [0.333, 0.188];
    const ARM: f32 = 0.396;
    draw(|x, y| {
        let radius = x.hypot(y);
        let arm = if radius < ARM { x.abs().min(y.abs()) } else { radius };
        RINGS.iter().map(|ring| (radius - ring).abs()).fold(arm, f32::min) - STROKE
    })
}

fn number(number: u32) -> Picture {
    /// Width and height of a digit and half the width of its strokes, as fractions of the paper's width.
    const SIZE: [f32; 2] = [0.42, 0.64];
    const STROKE: f32 = 0.05;
    let place = |[x, y]: [f32; 2]| [(x - 0.5) * SIZE[0], (y - 0.5) * SIZE[1]];
    let strokes: Vec<Vec<[f32; 2]>> = strokes(number).into_iter().map(|s| s.into_iter().map(place).collect()).collect();
    draw(|x, y| {
        let segments = strokes.iter().flat_map(|stroke| stroke.windows(2));
        segments.map(|ends| distance([x, y], [ends[0], ends[1]])).fold(f32::MAX, f32::min) - STROKE
    })
}

/// Draws a shape: ink where `outside` is negative, the distance from the shape as a fraction of the width. The origin
/// is in the middle; y points down.
fn draw(outside: impl Fn(f32, f32) -> f32) -> Picture {
    let pixels = ImageBuffer::from_fn(SIDE, SIDE, |u, v| {
        let [x, y] = [u, v].map(|i| (i as f32 + 0.5) / SIDE as f32 - 0.5);
        let ink = (0.5 - outside(x, y) * SIDE as f32).clamp(0.0, 1.0);
        Luma([(PAPER + ink * (INK - PAPER)) as u8])
    });
    Picture::new(GrayImage::from(pixels))
}

/// Lines of a digit in the unit box, y down.
fn strokes(number: u32) -> Vec<Vec<[f32; 2]>> {
    match number {
        1 => vec![vec![[0.2, 0.25], [0.55, 0.0], [0.55, 1.0]]],
        2 => vec![[arc([0.5, 0.29], [0.46, 0.29], -170.0, 35.0), vec![[0.04, 1.0], [1.0, 1.0]]].concat()],
        3 => vec![arc([0.46, 0.24], [0.42, 0.24], -160.0, 90.0), arc([0.44, 0.74], [0.52, 0.26], -90.0, 160.0)],
        4 => vec![vec![[0.74, 1.0], [0.74, 0.0], [0.0, 0.7], [1.0, 0.7]]],
        _ => vec![],
    }
}

/// Arc of an ellipse between two angles in degrees: 0 is right, 90 down.
fn arc(centre: [f32; 2], radii: [f32; 2], from: f32, to: f32) -> Vec<[f32; 2]> {
    const PARTS: u8 = 16;
    let point = |i: u8| {
        let (sin, cos) = (from + (to - from) * f32::from(i) / f32::from(PARTS)).to_radians().sin_cos();
        [centre[0] + radii[0] * cos, centre[1] + radii[1] * sin]
    };
    (0..=PARTS).map(point).collect()
}

/// Distance of a point from a segment.
pub fn distance(p: [f32; 2], [a, b]: [[f32; 2]; 2]) -> f32 {
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let along = ((d[0] * e[0] + d[1] * e[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
    (e[0] - along * d[0]).hypot(e[1] - along * d[1])
}
