//! Test functions with known minima.

use std::f64::consts::{E, PI};

/// Function to be minimized.
pub struct Function {
    pub name: &'static str,
    pub dimensions: usize,
    /// Bounds of each dimension; the last ones hold for all further dimensions.
    pub bounds: &'static [[f64; 2]],
    /// Minimum for each dimension, or for all together. Computed with 40 digits from the formula.
    pub minimum: f64,
    pub value: fn(&[f64]) -> f64,
}

const fn plane(name: &'static str, bounds: &'static [[f64; 2]], minimum: f64, value: fn(&[f64]) -> f64) -> Function {
    Function { name, dimensions: 2, bounds, minimum, value }
}

/// All functions. Those of any dimension come with 2 and with 10. Where the domain is unbounded, it is ±10 here.
pub const FUNCTIONS: &[Function] = &[
    plane("Ackley function", &[[-5.12, 5.12]], 0.0, ackley),
    plane("Beale function", &[[-4.5, 4.5]], 0.0, beale),
    plane("Booth function", &[[-10.0, 10.0]], 0.0, booth),
    plane("Bukin N.6 function", &[[-15.0, -5.0], [-3.0, 3.0]], 0.0, bukin_6),
    plane("Cross-in-tray function", &[[-10.0, 10.0]], -2.062_611_870_822_737, cross_in_tray),
    plane("Easom function", &[[-100.0, 100.0]], -1.0, easom),
    plane("Eggholder function", &[[-512.0, 512.0]], -959.640_662_720_850_8, eggholder),
    plane("Goldstein–Price function", &[[-2.0, 2.0]], 3.0, goldstein_price),
    plane("Himmelblau's function", &[[-5.0, 5.0]], 0.0, himmelblau),
    plane("Hölder table function", &[[-10.0, 10.0]], -19.208_502_567_886_732, holder_table),
    plane("Lévi function N.13", &[[-10.0, 10.0]], 0.0, levi_13),
    plane("Matyas function", &[[-10.0, 10.0]], 0.0, matyas),
    plane("McCormick function", &[[-1.5, 4.0], [-3.0, 4.0]], -1.913_222_954_981_036_4, mccormick),
    plane("Rastrigin function", &[[-5.12, 5.12]], 0.0, rastrigin),
    plane("Rosenbrock function", &[[-10.0, 10.0]], 0.0, rosenbrock),
    plane("Schaffer function N.2", &[[-100.0, 100.0]], 0.0, schaffer_2),
    plane("Schaffer function N.4", &[[-100.0, 100.0]], 0.292_578_632_035_980_55, schaffer_4),
    plane("Sphere function", &[[-10.0, 10.0]], 0.0, sphere),
    plane("Styblinski–Tang function", &[[-5.0, 5.0]], -78.332_331_407_542_83, styblinski_tang),
    plane("Three-hump camel function", &[[-5.0, 5.0]], 0.0, three_hump_camel),
    many("Rastrigin function", &[[-5.12, 5.12]], 0.0, rastrigin),
    many("Rosenbrock function", &[[-10.0, 10.0]], 0.0, rosenbrock),
    many("Sphere function", &[[-10.0, 10.0]], 0.0, sphere),
    many("Styblinski–Tang function", &[[-5.0, 5.0]], -391.661_657_037_714_2, styblinski_tang),
];

const fn many(name: &'static str, bounds: &'static [[f64; 2]], minimum: f64, value: fn(&[f64]) -> f64) -> Function {
    Function { name, dimensions: 10, bounds, minimum, value }
}

fn ackley(p: &[f64]) -> f64 {
    let n = p.len() as f64;
    let (squares, waves) = p.iter().fold((0.0, 0.0), |(s, w), x| (s + x * x, w + (2.0 * PI * x).cos()));
    -20.0 * (-0.2 * (squares / n).sqrt()).exp() - (waves / n).exp() + E + 20.0
}

fn beale(p: &[f64]) -> f64 {
    let (x, y) = (p[0], p[1]);
    (1.5 - x + x * y).powi(2) + (2.25 - x + x * y * y).powi(2) + (2.625 - x + x * y.powi(3)).powi(2)
}

fn booth(p: &[f64]) -> f64 {
    (p[0] + 2.0 * p[1] - 7.0).powi(2) + (2.0 * p[0] + p[1] - 5.0).powi(2)
}

fn bukin_6(p: &[f64]) -> f64 {
    100.0 * (p[1] - 0.01 * p[0] * p[0]).abs().sqrt() + 0.01 * (p[0] + 10.0).abs()
}

fn cross_in_tray(p: &[f64]) -> f64 {
    let far = (100.0 - p[0].hypot(p[1]) / PI).abs().exp();
    -1e-4 * ((p[0].sin() * p[1].sin() * far).abs() + 1.0).powf(0.1)
}

fn easom(p: &[f64]) -> f64 {
    -p[0].cos() * p[1].cos() * (-(p[0] - PI).powi(2) - (p[1] - PI).powi(2)).exp()
}

fn eggholder(p: &[f64]) -> f64 {
    let (x, y) = (p[0], p[1] + 47.0);
    -y * (0.5 * x + y).abs().sqrt().sin() - x * (x - y).abs().sqrt().sin()
}

fn goldstein_price(p: &[f64]) -> f64 {
    let (x, y) = (p[0], p[1]);
    let a = 19.0 - 14.0 * x + 3.0 * x * x - 14.0 * y + 6.0 * x * y + 3.0 * y * y;
    let b = 18.0 - 32.0 * x + 12.0 * x * x + 48.0 * y - 36.0 * x * y + 27.0 * y * y;
    (1.0 + (x + y + 1.0).powi(2) * a) * (30.0 + (2.0 * x - 3.0 * y).powi(2) * b)
}

fn himmelblau(p: &[f64]) -> f64 {
    (p[0] * p[0] + p[1] - 11.0).powi(2) + (p[0] + p[1] * p[1] - 7.0).powi(2)
}

fn holder_table(p: &[f64]) -> f64 {
    -(p[0].sin() * p[1].cos() * (1.0 - p[0].hypot(p[1]) / PI).abs().exp()).abs()
}

fn levi_13(p: &[f64]) -> f64 {
    let wave = |x: f64| (PI * x).sin().powi(2);
    let (x, y) = (p[0], p[1]);
    wave(3.0 * x) + (x - 1.0).powi(2) * (1.0 + wave(3.0 * y)) + (y - 1.0).powi(2) * (1.0 + wave(2.0 * y))
}

fn matyas(p: &[f64]) -> f64 {
    0.26 * (p[0] * p[0] + p[1] * p[1]) - 0.48 * p[0] * p[1]
}

fn mccormick(p: &[f64]) -> f64 {
    (p[0] + p[1]).sin() + (p[0] - p[1]).powi(2) - 1.5 * p[0] + 2.5 * p[1] + 1.0
}

fn rastrigin(p: &[f64]) -> f64 {
    p.iter().map(|x| 10.0 + x * x - 10.0 * (2.0 * PI * x).cos()).sum()
}

fn rosenbrock(p: &[f64]) -> f64 {
    p.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum()
}

fn schaffer(p: &[f64], wave: fn(f64) -> f64) -> f64 {
    let (x, y) = (p[0] * p[0], p[1] * p[1]);
    0.5 + (wave(x - y).powi(2) - 0.5) / (1.0 + 0.001 * (x + y)).powi(2)
}

fn schaffer_2(p: &[f64]) -> f64 {
    schaffer(p, f64::sin)
}

fn schaffer_4(p: &[f64]) -> f64 {
    schaffer(p, |d| d.abs().sin().cos())
}

fn sphere(p: &[f64]) -> f64 {
    p.iter().map(|x| x * x).sum()
}

fn styblinski_tang(p: &[f64]) -> f64 {
    p.iter().map(|x| 0.5 * (x.powi(4) - 16.0 * x * x + 5.0 * x)).sum()
}

fn three_hump_camel(p: &[f64]) -> f64 {
    let (x, y) = (p[0], p[1]);
    2.0 * x * x - 1.05 * x.powi(4) + x.powi(6) / 6.0 + x * y + y * y
}
