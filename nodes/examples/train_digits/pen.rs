//! Digits drawn with a pen: strokes of many styles, bent, slanted, thick or thin. Needs no font.

use apex_nodes::{image::GrayImage, math::Random};
use image::{ImageBuffer, Luma};

/// Width and height of a drawing, in pixels.
const SIDE: u32 = 36;

/// Strokes of one digit in a box from (0, 0), upper left, to (1, 1).
type Strokes = Vec<Vec<[f32; 2]>>;

/// Draws a digit in a random style.
pub fn draw(digit: usize, random: &mut Random) -> GrayImage {
    let styles = styles(digit);
    let style = &styles[(random.bits() % styles.len() as u64) as usize];
    let hand = Hand::random(random);
    let strokes: Strokes = style.iter().map(|stroke| stroke.iter().map(|p| hand.place(*p)).collect()).collect();
    render(&strokes, &hand, random)
}

/// Handwriting: properties shared by all strokes of a digit.
struct Hand {
    /// Width and height of the digit, in pixels.
    size: [f32; 2],
    slant: f32,
    turn: f32,
    /// Bends along x and y.
    bends: [f32; 4],
    /// Half the width and height of the tip of the pen, in pixels.
    pen: [f32; 2],
    /// Width of the transition from full ink to none, in pixels.
    softness: f32,
    /// Half the length of the serifs at the ends of strokes, in pixels; 0 for none.
    serif: f32,
}

impl Hand {
    fn random(random: &mut Random) -> Self {
        let height = random.uniform(20.0, 28.0);
        let pen = random.uniform(0.025, 0.12) * height;
        // Printed digits have thin horizontal strokes more often than thick ones.
        let contrast = if random.chance(0.5) { random.uniform(0.35, 1.0) } else { random.uniform(0.85, 1.15) };
        let bend = if random.chance(0.5) { 0.15 } else { 0.03 };
        Self {
            size: [height * random.uniform(0.4, 0.85), height],
            slant: random.normal(0.15).clamp(-0.4, 0.4),
            turn: random.normal(0.08).clamp(-0.25, 0.25),
            bends: std::array::from_fn(|_| random.uniform(-bend, bend)),
            pen: [pen, (pen * contrast).max(0.5)],
            softness: random.uniform(0.6, 2.0),
            serif: if random.chance(0.25) { random.uniform(0.03, 0.12) * height } else { 0.0 },
        }
    }

    /// Transforms a point of the unit box to the paper, in pixels from the middle of the digit.
    fn place(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [a, b, c, d] = self.bends;
        let (x, y) = (x - 0.5, y - 0.5);
        let bent = [x + a * (y * y * 4.0 - 0.5) + b * x * y * 2.0, y + c * (x * x * 4.0 - 0.5) + d * x * y * 2.0];
        let (u, v) = (bent[0] * self.size[0] - self.slant * bent[1] * self.size[1], bent[1] * self.size[1]);
        let (sin, cos) = self.turn.sin_cos();
        [cos * u - sin * v, sin * u + cos * v]
    }
}

/// Draws ink along the strokes, with noise, on paper that is not clean.
fn render(strokes: &Strokes, hand: &Hand, random: &mut Random) -> GrayImage {
    let mut segments: Vec<[[f32; 2]; 2]> = strokes.iter().flat_map(|s| s.windows(2).map(|w| [w[0], w[1]])).collect();
    if hand.serif > 0.0 {
        // Strokes that end almost vertically get a horizontal bar.
        for end in strokes.iter().flat_map(|s| [[s[1], s[0]], [s[s.len() - 2], s[s.len() - 1]]]) {
            let [from, [x, y]] = end;
            if (y - from[1]).abs() > 2.0 * (x - from[0]).abs() {
                segments.push([[x - hand.serif, y], [x + hand.serif, y]]);
            }
        }
    }
    let noise = random.uniform(0.0, 0.06);
    let dark = random.chance(0.5);
    let pixels = ImageBuffer::from_fn(SIDE, SIDE, |x, y| {
        let middle = 0.5 * (SIDE as f32 - 1.0);
        let at = [x as f32 - middle, y as f32 - middle];
        let far = segments.iter().map(|s| distance(at, s, hand.pen)).fold(f32::MAX, f32::min);
        let tip = 0.5 * (hand.pen[0] + hand.pen[1]);
        let ink = (0.5 - (far - 1.0) * tip / hand.softness).clamp(0.0, 1.0) + random.normal(noise);
        let ink = ink.clamp(0.0, 1.0) * 200.0;
        Luma([if dark { 230.0 - ink } else { 30.0 + ink } as u8])
    });
    pixels.into()
}

/// Distance of a point from a segment, in units of the tip of the pen.
fn distance(p: [f32; 2], [a, b]: &[[f32; 2]; 2], pen: [f32; 2]) -> f32 {
    let scaled = |from: [f32; 2], to: [f32; 2]| [(to[0] - from[0]) / pen[0], (to[1] - from[1]) / pen[1]];
    let (d, e) = (scaled(*a, *b), scaled(*a, p));
    let square = d[0] * d[0] + d[1] * d[1];
    let part = if square > 0.0 { ((d[0] * e[0] + d[1] * e[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (e[0] - part * d[0]).hypot(e[1] - part * d[1])
}

/// Arc of an ellipse between two angles in degrees: 0 is right, 90 down, 180 left, 270 up.
fn arc(centre: [f32; 2], radii: [f32; 2], from: f32, to: f32) -> Vec<[f32; 2]> {
    let count = ((to - from).abs() / 20.0).ceil().max(2.0) as usize;
    let point = |i: usize| {
        let (sin, cos) = (from + (to - from) * i as f32 / count as f32).to_radians().sin_cos();
        [centre[0] + radii[0] * cos, centre[1] + radii[1] * sin]
    };
    (0..=count).map(point).collect()
}

/// Smooth curve through points (Catmull and Rom 1974).
fn curve(points: &[[f32; 2]]) -> Vec<[f32; 2]> {
    let at = |i: usize| points[i.clamp(1, points.len()) - 1];
    let mut smooth = vec![points[0]];
    for i in 1..points.len() {
        let [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        for t in [0.25_f32, 0.5, 0.75, 1.0] {
            smooth.push(std::array::from_fn(|k| {
                let (m, n) = (0.5 * (c[k] - a[k]), 0.5 * (d[k] - b[k]));
                let (s, q) = (t * t, t * t * t);
                (2.0 * q - 3.0 * s + 1.0) * b[k] + (q - 2.0 * s + t) * m + (3.0 * s - 2.0 * q) * c[k] + (q - s) * n
            }));
        }
    }
    smooth
}

fn joined(parts: &[Vec<[f32; 2]>]) -> Vec<[f32; 2]> {
    parts.concat()
}

/// Strokes rotated by 180°.
fn upside_down(strokes: Strokes) -> Strokes {
    strokes.into_iter().map(|s| s.into_iter().map(|[x, y]| [1.0 - x, 1.0 - y]).collect()).collect()
}

/// Styles of a digit.
fn styles(digit: usize) -> Vec<Strokes> {
    match digit {
        0 => zeros(),
        1 => ones(),
        2 => twos(),
        3 => threes(),
        4 => fours(),
        5 => fives(),
        6 => sixes(),
        7 => sevens(),
        8 => eights(),
        _ => nines(),
    }
}

fn zeros() -> Vec<Strokes> {
    let corners =
        joined(&[arc([0.5, 0.3], [0.5, 0.3], 180.0, 360.0), arc([0.5, 0.7], [0.5, 0.3], 0.0, 180.0), vec![[0.0, 0.3]]]);
    vec![
        vec![arc([0.5, 0.5], [0.5, 0.5], 0.0, 360.0)],
        vec![arc([0.5, 0.5], [0.4, 0.5], 0.0, 360.0)],
        vec![corners],
        vec![arc([0.5, 0.5], [0.5, 0.5], 280.0, 620.0)],
    ]
}

fn ones() -> Vec<Strokes> {
    let stem = || vec![[0.5, 0.0], [0.5, 1.0]];
    vec![
        vec![stem()],
        vec![vec![[0.15, 0.25], [0.5, 0.0], [0.5, 1.0]]],
        vec![vec![[0.05, 0.35], [0.5, 0.0], [0.5, 1.0]]],
        vec![vec![[0.2, 0.25], [0.5, 0.0], [0.5, 1.0]], vec![[0.15, 1.0], [0.85, 1.0]]],
        vec![vec![[0.25, 0.12], [0.5, 0.02], [0.5, 1.0]], vec![[0.25, 1.0], [0.75, 1.0]]],
        vec![vec![[0.25, 0.12], [0.5, 0.12]], stem(), vec![[0.25, 1.0], [0.75, 1.0]]],
        vec![curve(&[[0.25, 0.2], [0.42, 0.14], [0.5, 0.0]]), stem()],
    ]
}

fn twos() -> Vec<Strokes> {
    let foot = |from: f32| vec![[0.02, 1.0], [from, 1.0]];
    vec![
        vec![joined(&[arc([0.5, 0.28], [0.45, 0.28], 190.0, 400.0), foot(0.98)])],
        vec![joined(&[curve(&[[0.05, 0.25], [0.3, 0.01], [0.85, 0.1], [0.8, 0.45], [0.35, 0.75]]), foot(1.0)])],
        vec![joined(&[
            arc([0.5, 0.25], [0.42, 0.25], 200.0, 380.0),
            curve(&[[0.8, 0.45], [0.3, 0.7], [0.04, 1.0]]),
            foot(0.95),
        ])],
        // With a loop and a curved foot.
        vec![curve(&[
            [0.1, 0.2],
            [0.5, 0.0],
            [0.8, 0.25],
            [0.5, 0.65],
            [0.1, 0.95],
            [0.1, 0.8],
            [0.4, 0.85],
            [1.0, 0.97],
        ])],
        vec![joined(&[
            arc([0.5, 0.28], [0.42, 0.28], 200.0, 400.0),
            curve(&[[0.05, 0.98], [0.3, 0.9], [0.7, 1.0], [1.0, 0.9]]),
        ])],
        vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5], [0.0, 1.0], [1.0, 1.0]]],
        vec![joined(&[arc([0.5, 0.28], [0.45, 0.28], 190.0, 400.0), foot(0.95), vec![[0.98, 0.85]]])],
    ]
}

fn threes() -> Vec<Strokes> {
    let belly = |from: f32, to: f32| arc([0.42, 0.73], [0.55, 0.27], from, to);
    vec![
        vec![joined(&[arc([0.45, 0.25], [0.42, 0.25], 200.0, 450.0), belly(270.0, 520.0)])],
        vec![joined(&[arc([0.45, 0.24], [0.45, 0.24], 215.0, 430.0), vec![[0.4, 0.47]], belly(285.0, 505.0)])],
        vec![joined(&[vec![[0.05, 0.0], [0.92, 0.0], [0.42, 0.42]], arc([0.4, 0.7], [0.57, 0.3], 275.0, 510.0)])],
        vec![curve(&[[0.1, 0.12], [0.5, 0.0], [0.8, 0.2], [0.4, 0.46], [0.9, 0.7], [0.5, 1.0], [0.05, 0.9]])],
        vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], vec![[0.1, 0.5], [1.0, 0.5]]],
        vec![joined(&[arc([0.45, 0.26], [0.38, 0.26], 200.0, 440.0), belly(265.0, 520.0)])],
    ]
}

fn fours() -> Vec<Strokes> {
    let closed = |x: f32, y: f32| vec![vec![[x, 1.0], [x, 0.0], [0.0, y], [1.0, y]]];
    vec![
        closed(0.72, 0.7),
        closed(0.8, 0.75),
        closed(0.65, 0.65),
        vec![vec![[0.15, 0.0], [0.05, 0.55], [0.95, 0.55]], vec![[0.75, 0.0], [0.75, 1.0]]],
        vec![vec![[0.45, 0.0], [0.0, 0.65], [1.0, 0.65]], vec![[0.7, 0.3], [0.65, 1.0]]],
        vec![vec![[0.0, 0.0], [0.0, 0.5], [1.0, 0.5]], vec![[1.0, 0.0], [1.0, 1.0]]],
        vec![curve(&[[0.1, 0.05], [0.02, 0.4], [0.3, 0.55], [0.85, 0.45]]), vec![[0.9, 0.05], [0.75, 1.0]]],
        // With a foot.
        vec![closed(0.72, 0.7).concat(), vec![[0.5, 1.0], [0.94, 1.0]]],
    ]
}

fn fives() -> Vec<Strokes> {
    let belly = |from: f32, to: f32| arc([0.43, 0.68], [0.54, 0.32], from, to);
    vec![
        vec![joined(&[vec![[0.9, 0.0], [0.16, 0.0], [0.08, 0.48]], belly(225.0, 510.0)])],
        vec![joined(&[vec![[0.92, 0.0], [0.12, 0.0], [0.12, 0.45]], belly(240.0, 500.0)])],
        vec![vec![[0.15, 0.0], [0.9, 0.0]], joined(&[vec![[0.15, 0.0], [0.1, 0.42]], belly(235.0, 510.0)])],
        vec![joined(&[vec![[0.95, 0.02], [0.25, 0.02]], curve(&[[0.2, 0.4], [0.75, 0.5], [0.8, 0.85], [0.05, 1.0]])])],
        vec![vec![[1.0, 0.0], [0.0, 0.0], [0.0, 0.5], [1.0, 0.5], [1.0, 1.0], [0.0, 1.0]]],
        vec![joined(&[vec![[0.85, 0.0], [0.25, 0.0], [0.1, 0.5]], arc([0.42, 0.7], [0.55, 0.3], 230.0, 520.0)])],
    ]
}

fn sixes() -> Vec<Strokes> {
    let bowl = || arc([0.5, 0.68], [0.46, 0.32], 180.0, 540.0);
    vec![
        vec![joined(&[curve(&[[0.85, 0.02], [0.4, 0.15], [0.1, 0.5], [0.04, 0.68]]), bowl()])],
        vec![joined(&[arc([0.52, 0.5], [0.48, 0.5], 310.0, 180.0), bowl()])],
        vec![joined(&[vec![[0.65, 0.0], [0.15, 0.5]], arc([0.5, 0.68], [0.46, 0.32], 200.0, 560.0)])],
        vec![joined(&[curve(&[[0.6, 0.0], [0.2, 0.35], [0.05, 0.7]]), arc([0.48, 0.75], [0.43, 0.25], 180.0, 530.0)])],
        vec![vec![[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.5], [0.0, 0.5]]],
        vec![curve(&[[0.7, 0.0], [0.1, 0.45], [0.15, 0.95], [0.75, 0.95], [0.75, 0.6], [0.3, 0.6], [0.12, 0.85]])],
    ]
}

fn sevens() -> Vec<Strokes> {
    let plain = || vec![[0.0, 0.0], [1.0, 0.0], [0.35, 1.0]];
    vec![
        vec![plain()],
        vec![plain(), vec![[0.25, 0.5], [0.9, 0.5]]],
        vec![joined(&[vec![[0.0, 0.0]], curve(&[[1.0, 0.0], [0.6, 0.45], [0.4, 1.0]])])],
        vec![joined(&[vec![[0.0, 0.16]], plain()])],
        vec![vec![[0.0, 0.0], [1.0, 0.0], [0.95, 1.0]]],
        vec![curve(&[[0.0, 0.1], [0.3, 0.0], [0.95, 0.02], [0.7, 0.5], [0.5, 1.0]])],
        vec![vec![[0.02, 0.0], [0.98, 0.0], [0.15, 1.0]]],
    ]
}

fn eights() -> Vec<Strokes> {
    let two = |top: f32, a: f32, b: f32| {
        vec![arc([0.5, top], [a, top], 90.0, 450.0), arc([0.5, 0.5 + top], [b, 0.5 - top], 270.0, 630.0)]
    };
    let crossed = |wide: f32| {
        let points = [
            [0.85, 0.15],
            [0.5, 0.0],
            [0.5 - wide, 0.2],
            [0.55, 0.5],
            [0.9, 0.8],
            [0.5, 1.0],
            [0.1, 0.8],
            [0.5, 0.48],
            [0.85, 0.15],
        ];
        vec![curve(&points)]
    };
    let square = vec![vec![[0.0, 0.5], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.5]]];
    let narrow = vec![arc([0.5, 0.24], [0.38, 0.24], 90.0, 450.0), arc([0.5, 0.74], [0.48, 0.26], 270.0, 630.0)];
    vec![two(0.25, 0.4, 0.48), two(0.25, 0.45, 0.45), narrow, crossed(0.35), crossed(0.42), square]
}

fn nines() -> Vec<Strokes> {
    let circle = || arc([0.5, 0.3], [0.45, 0.3], 0.0, 360.0);
    let mut all: Vec<Strokes> = sixes().into_iter().map(upside_down).collect();
    all.extend([
        vec![circle(), vec![[0.95, 0.3], [0.9, 1.0]]],
        vec![circle(), vec![[0.95, 0.3], [0.55, 1.0]]],
        vec![arc([0.45, 0.28], [0.42, 0.28], 0.0, 360.0), curve(&[[0.87, 0.1], [0.87, 0.4], [0.85, 1.0]])],
        vec![circle(), curve(&[[0.95, 0.3], [0.9, 0.75], [0.55, 1.0], [0.1, 0.92]])],
    ]);
    all
}
