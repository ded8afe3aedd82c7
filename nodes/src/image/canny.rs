//! Canny's edge detector, row by row, in whole numbers.

/// Weights of the Gaussian filter with a standard deviation of 1.4 pixels, from the middle outwards. Those of all seven
/// pixels add up to 256.
const WEIGHTS: [u16; 4] = [74, 57, 27, 7];

/// Pixels on each side that the filter reaches.
const REACH: usize = WEIGHTS.len() - 1;

/// Tangent of 22.5°, in parts of 2¹⁵.
const TANGENT: i32 = 13573;

/// Pixels of a row that are compared with the threshold at once. Most gradients are below it.
const BLOCK: usize = 16;

/// State of an edge pixel. Other pixels have the state 0.
pub const EDGE: u8 = 255;

/// State of a pixel that is an edge if it touches one.
const WEAK: u8 = 1;

/// Canny's edge detector (Canny 1986), as OpenCV computes it: a Gaussian filter of 7 × 7 pixels, Sobel gradients, the
/// maxima across the edges, and hysteresis. Keeps its storage.
#[derive(Debug, Clone, Default)]
pub struct Canny {
    /// Sums of the columns around one row, with a frame of `REACH` pixels.
    columns: Vec<u16>,
    /// Last three filtered rows, with a frame of one pixel.
    filtered: [Vec<u8>; 3],
    /// Gradients of the last three rows.
    gradients: [Gradients; 3],
    /// States of all pixels, with a frame of one pixel.
    states: Vec<u8>,
    /// Edge pixels whose neighbours are to be visited.
    open: Vec<usize>,
}

/// Gradients of one row.
#[derive(Debug, Clone, Default)]
struct Gradients {
    along_x: Vec<i16>,
    along_y: Vec<i16>,
    /// Squares of the magnitudes, with a frame of one pixel.
    squares: Vec<i32>,
}

impl Canny {
    /// Finds the edges of an image of this width and height, at least one pixel each, with its rows. Edges begin where
    /// the gradient is above `high`, and continue where it is above `low`. Pixels outside are those of the border.
    pub fn find<'a>(
        &mut self,
        (width, height): (usize, usize),
        row: impl Fn(usize) -> &'a [u8],
        [low, high]: [f32; 2],
    ) -> impl Iterator<Item = &[u8]> {
        self.resize(width, height);
        let limits = [low, high].map(|gradient| (f64::from(gradient) * f64::from(gradient)) as i32);
        for y in 0..height + 2 {
            if y < height {
                let near = |distance: usize| [row(y.saturating_sub(distance)), row((y + distance).min(height - 1))];
                add_up([near(0), near(1), near(2), near(3)], &mut self.columns[REACH..][..width]);
                filter(&mut self.columns, &mut self.filtered[y % 3]);
            }
            if y > height {
                self.gradients[(y - 1) % 3].squares.fill(0);
            } else if y > 0 {
                let rows = [y.max(2) - 2, y - 1, y.min(height - 1)];
                self.gradients[(y - 1) % 3].find(rows.map(|y| &self.filtered[y % 3][..]));
            }
            if y > 1 {
                self.thin(y - 2, limits);
            }
        }
        self.spread(width + 2);
        self.states.chunks_exact(width + 2).skip(1).take(height).map(move |row| &row[1..=width])
    }

    fn resize(&mut self, width: usize, height: usize) {
        self.columns.resize(width + 2 * REACH, 0);
        self.filtered.iter_mut().for_each(|row| row.resize(width + 2, 0));
        self.gradients.iter_mut().for_each(|row| row.resize(width));
        self.states.clear();
        self.states.resize((width + 2) * (height + 2), 0);
        self.open.clear();
    }

    /// Marks the maxima across the edges in a row.
    fn thin(&mut self, y: usize, [low, high]: [i32; 2]) {
        let [above, here, below] = [y + 2, y, y + 1].map(|y| &self.gradients[y % 3]);
        let width = here.along_x.len();
        let first = (y + 1) * (width + 2) + 1;
        let states = &mut self.states[first..][..width];
        for start in (0..width).step_by(BLOCK) {
            let end = (start + BLOCK).min(width);
            if here.squares[start + 1..=end].iter().fold(0, |most, square| most.max(*square)) <= low {
                continue;
            }
            for (x, state) in (start..end).zip(&mut states[start..end]) {
                let square = here.squares[x + 1];
                if square > low && is_maximum([above, here, below], x) {
                    *state = if square > high { EDGE } else { WEAK };
                    if square > high {
                        self.open.push(first + x);
                    }
                }
            }
        }
    }

    /// Turns the weak pixels that touch an edge into edges, and the others into none.
    fn spread(&mut self, stride: usize) {
        while let Some(at) = self.open.pop() {
            for first in [at - stride - 1, at - 1, at + stride - 1] {
                for (i, state) in self.states[first..first + 3].iter_mut().enumerate() {
                    if *state == WEAK {
                        *state = EDGE;
                        self.open.push(first + i);
                    }
                }
            }
        }
        self.states.iter_mut().for_each(|state| *state = if *state == EDGE { EDGE } else { 0 });
    }
}

impl Gradients {
    fn resize(&mut self, width: usize) {
        self.along_x.resize(width, 0);
        self.along_y.resize(width, 0);
        self.squares.clear();
        self.squares.resize(width + 2, 0);
    }

    /// Sobel gradients of a row from the filtered rows around it.
    fn find(&mut self, [above, here, below]: [&[u8]; 3]) {
        let width = self.along_x.len();
        let at = |row: &[u8], x: usize| i16::from(row[x]);
        let (above, here, below) = (&above[..width + 2], &here[..width + 2], &below[..width + 2]);
        let (along_x, along_y) = (&mut self.along_x[..width], &mut self.along_y[..width]);
        let squares = &mut self.squares[1..=width];
        for x in 0..width {
            let column = |x: usize| at(above, x) + 2 * at(here, x) + at(below, x);
            let down = |x: usize| at(below, x) - at(above, x);
            let (dx, dy) = (column(x + 2) - column(x), down(x) + 2 * down(x + 1) + down(x + 2));
            (along_x[x], along_y[x]) = (dx, dy);
            squares[x] = i32::from(dx) * i32::from(dx) + i32::from(dy) * i32::from(dy);
        }
    }
}

/// Weighted sums of the columns of seven rows: the middle one twice, and those at distances of one to three.
fn add_up(rows: [[&[u8]; 2]; 4], sums: &mut [u16]) {
    let width = sums.len();
    let [[middle, _], near, far, farthest] = rows.map(|pair| pair.map(|row| &row[..width]));
    let both = |pair: [&[u8]; 2], x: usize| u16::from(pair[0][x]) + u16::from(pair[1][x]);
    for x in 0..width {
        sums[x] = WEIGHTS[0] * u16::from(middle[x])
            + WEIGHTS[1] * both(near, x)
            + WEIGHTS[2] * both(far, x)
            + WEIGHTS[3] * both(farthest, x);
    }
}

/// Filters the sums of the columns along their row, and rounds.
fn filter(columns: &mut [u16], row: &mut [u8]) {
    let width = row.len() - 2;
    let (first, last) = (columns[REACH], columns[REACH + width - 1]);
    columns[..REACH].fill(first);
    columns[REACH + width..].fill(last);
    let at = |distance: usize| (&columns[REACH - distance..][..width], &columns[REACH + distance..][..width]);
    let [(middle, _), near, far, farthest] = [at(0), at(1), at(2), at(3)];
    let both = |(left, right): (&[u16], &[u16]), x: usize| u32::from(left[x]) + u32::from(right[x]);
    let inner = &mut row[1..=width];
    for x in 0..width {
        let sum = u32::from(WEIGHTS[0]) * u32::from(middle[x])
            + u32::from(WEIGHTS[1]) * both(near, x)
            + u32::from(WEIGHTS[2]) * both(far, x)
            + u32::from(WEIGHTS[3]) * both(farthest, x);
        inner[x] = ((sum + (1 << 15)) >> 16) as u8;
    }
    (row[0], row[width + 1]) = (row[1], row[width]);
}

/// Returns `true` if the gradient of a pixel is larger than those of its neighbours across the edge. Of two equal
/// ones the second, below or to the right, is not.
fn is_maximum([above, here, below]: [&Gradients; 3], x: usize) -> bool {
    let (dx, dy) = (i32::from(here.along_x[x]), i32::from(here.along_y[x]));
    let (width, height) = (dx.abs(), dy.abs() << 15);
    let square = here.squares[x + 1];
    if height < TANGENT * width {
        square > here.squares[x] && square >= here.squares[x + 2]
    } else if height > (TANGENT + (2 << 15)) * width {
        square > above.squares[x + 1] && square >= below.squares[x + 1]
    } else {
        let (before, after) = if (dx ^ dy) < 0 { (x + 2, x) } else { (x, x + 2) };
        square > above.squares[before] && square > below.squares[after]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    /// Edges by definition, on whole images.
    fn by_definition((width, height): (usize, usize), pixels: &[u8], [low, high]: [f32; 2]) -> Vec<u8> {
        let (columns, rows) = (width as i64, height as i64);
        let at = |values: &[i64], x: i64, y: i64| {
            values[(y.clamp(0, rows - 1) * columns + x.clamp(0, columns - 1)) as usize]
        };
        let all = |value: &dyn Fn(i64, i64) -> i64| -> Vec<i64> {
            (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).map(|(x, y)| value(x, y)).collect()
        };
        let pixels: Vec<i64> = pixels.iter().map(|pixel| i64::from(*pixel)).collect();
        let weight = |distance: i64| i64::from(WEIGHTS[distance.unsigned_abs() as usize]);
        let sum = |x, y| {
            (-3..=3)
                .flat_map(|j| (-3..=3).map(move |i| (i, j)))
                .map(|(i, j)| weight(i) * weight(j) * at(&pixels, x + i, y + j))
                .sum::<i64>()
        };
        let smooth = all(&|x, y| (sum(x, y) + (1 << 15)) >> 16);
        let sobel = |x: i64, y: i64, (i, j): (i64, i64)| {
            [(-1, 1), (0, 2), (1, 1)]
                .map(|(k, weight)| {
                    let (u, v) = (x + k * j, y + k * i);
                    weight * (at(&smooth, u + i, v + j) - at(&smooth, u - i, v - j))
                })
                .iter()
                .sum::<i64>()
        };
        let (dx, dy) = (all(&|x, y| sobel(x, y, (1, 0))), all(&|x, y| sobel(x, y, (0, 1))));
        let squares = all(&|x, y| at(&dx, x, y).pow(2) + at(&dy, x, y).pow(2));
        let inside = |x, y| (0..columns).contains(&x) && (0..rows).contains(&y);
        let square = |x, y| if inside(x, y) { at(&squares, x, y) } else { 0 };
        let thin = all(&|x, y| {
            let (dx, dy, this) = (at(&dx, x, y), at(&dy, x, y), square(x, y));
            let ratio = dy.abs() as f64 / dx.abs() as f64;
            let (i, j, strict) = match ratio {
                ratio if ratio < 2.0_f64.sqrt() - 1.0 => (1, 0, false),
                ratio if ratio > 2.0_f64.sqrt() + 1.0 => (0, 1, false),
                _ => (if (dx < 0) == (dy < 0) { 1 } else { -1 }, 1, true),
            };
            let after = square(x + i, y + j);
            i64::from(this > square(x - i, y - j) && (this > after || !strict && this == after)) * this
        });
        let [low, high] = [low, high].map(|gradient| (gradient * gradient) as i64);
        let mut edges: Vec<u8> = thin.iter().map(|square| if *square > high { EDGE } else { 0 }).collect();
        loop {
            let touches = |edges: &[u8], at: usize| {
                let (x, y) = (at as i64 % columns, at as i64 / columns);
                let near = (-1..=1).flat_map(|j| (-1..=1).map(move |i| (x + i, y + j)));
                near.filter(|(x, y)| inside(*x, *y)).any(|(x, y)| edges[(y * columns + x) as usize] == EDGE)
            };
            let grown: Vec<usize> =
                (0..edges.len()).filter(|at| edges[*at] == 0 && thin[*at] > low && touches(&edges, *at)).collect();
            if grown.is_empty() {
                return edges;
            }
            grown.into_iter().for_each(|at| edges[at] = EDGE);
        }
    }

    #[test]
    fn edges_are_those_of_the_definition() {
        let (mut random, mut canny) = (Random::new(1), Canny::default());
        for size in [(1, 1), (1, 9), (7, 1), (3, 2), (16, 16), (33, 17), (60, 41), (5, 30)] {
            for step in [1, 4, 40] {
                // Steps of some pixels, so that gradients last for some pixels, too.
                let shades: Vec<u8> = (0..size.0 * size.1).map(|_| random.bits() as u8).collect();
                let shade = |at: usize| shades[at / size.0 / step * step * size.0 + at % size.0 / step * step];
                let pixels: Vec<u8> = (0..shades.len()).map(shade).collect();
                let row = |y: usize| &pixels[y * size.0..][..size.0];
                for limits in [[60.0, 150.0], [1.0, 1.0], [20.5, 300.0]] {
                    let found = canny.find(size, row, limits).collect::<Vec<_>>().concat();
                    assert!(found == by_definition(size, &pixels, limits), "{size:?}, {step}, {limits:?}");
                }
            }
        }
    }
}
