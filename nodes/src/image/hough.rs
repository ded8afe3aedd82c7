use super::{GrayImage, light};
use crate::math::Random;
use apex_rt::{Out, node};
use core::f32::consts::PI;
use std::sync::LazyLock;

/// Maximum number of lines of an image.
pub const MAX_LINES: usize = 256;

/// Lines of one image, in the order of detection.
pub type Lines = heapless::Vec<Line, MAX_LINES>;

/// Straight line segment between two pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Line {
    /// First end: u and v, in pixels.
    pub from: [f32; 2],
    /// Second end: u and v, in pixels.
    pub to: [f32; 2],
}

impl Line {
    /// Vector from the first end to the second, in pixels.
    pub const fn span(&self) -> [f32; 2] {
        [self.to[0] - self.from[0], self.to[1] - self.from[1]]
    }

    /// Length, in pixels.
    pub fn length(&self) -> f32 {
        let [du, dv] = self.span();
        du.hypot(dv)
    }

    /// Intersection of two lines, as fractions of their lengths from their first ends, or `None` if they are parallel.
    pub fn meets(&self, other: &Self) -> Option<[f32; 2]> {
        let ([a, b], [c, d]) = (self.span(), other.span());
        let [x, y] = [other.from[0] - self.from[0], other.from[1] - self.from[1]];
        let cross = a * d - b * c;
        (cross != 0.0).then(|| [(x * d - y * c) / cross, (x * b - y * a) / cross])
    }

    /// Point at the fraction `part` of the length from the first end.
    pub fn at(&self, part: f32) -> [f32; 2] {
        let [du, dv] = self.span();
        [self.from[0] + part * du, self.from[1] + part * dv]
    }
}

/// Number of directions, in steps of 1°.
const ANGLES: usize = 180;

/// Sine and cosine of the directions.
static DIRECTIONS: LazyLock<[(f32, f32); ANGLES]> =
    LazyLock::new(|| std::array::from_fn(|angle| (angle as f32 * PI / ANGLES as f32).sin_cos()));

/// State of an edge pixel before and after its vote. Other pixels have the state 0.
const EDGE: u8 = 1;
const VOTED: u8 = 2;

/// Finds straight lines among edges (progressive probabilistic Hough transform; Matas et al. 2000; thesis 4.3.1).
///
/// Edge pixels vote in random order for all lines through them. As soon as a line has enough votes, it is followed in
/// both directions, with a tolerance of one pixel to each side, and its pixels no longer vote for other lines. Finds at
/// most [`MAX_LINES`] lines.
#[node]
#[derive(Debug, Clone)]
pub struct ProbabilisticHough {
    /// Number of votes that make a line.
    #[param(default = 12, range = 2..=10_000)]
    votes: u16,
    /// Minimum length of a line, in pixels.
    #[param(default = 15.0, range = 1.0..=10_000.0)]
    min_length: f32,
    /// Maximum gap in a line, in pixels.
    #[param(default = 12, range = 0..=1000)]
    max_gap: u32,
    /// Seed of the random order of the edge pixels.
    #[param(default = 1)]
    seed: u64,
    field: Field,
}

#[node]
impl ProbabilisticHough {
    /// Finds the lines. The same edges give the same lines, independent of previous images.
    fn process(&mut self, edges: &GrayImage, lines: &mut Out<Lines>) {
        let lines = lines.get_mut();
        lines.clear();
        let mut order = self.field.begin(edges, &mut Random::new(self.seed));
        while let Some(at) = order.pop() {
            if self.field.state(at) != EDGE {
                continue;
            }
            let (votes, angle) = self.field.vote(at);
            if votes < self.votes {
                continue;
            }
            let ends = [1.0, -1.0].map(|sense| self.field.follow(at, angle, sense, self.max_gap));
            let line = Line { from: ends[1], to: ends[0] };
            let long = line.length() >= self.min_length;
            ends.iter().zip([1.0, -1.0]).for_each(|(end, sense)| self.field.take(at, angle, sense, *end, long));
            if long && lines.push(line).is_err() {
                break;
            }
        }
        self.field.order = order;
    }
}

/// Edges of an image and their votes.
#[derive(Debug, Clone, Default)]
struct Field {
    width: i32,
    height: i32,
    states: Vec<u8>,
    /// Votes by direction of the normal, then by distance from the origin.
    votes: Vec<u16>,
    /// Number of bins for the distance.
    distances: usize,
    /// Storage for the order.
    order: Vec<[i32; 2]>,
}

impl Field {
    /// Loads an image and returns its edge pixels in random order (Fisher and Yates).
    fn begin(&mut self, edges: &GrayImage, random: &mut Random) -> Vec<[i32; 2]> {
        (self.width, self.height) = (edges.size().0 as i32, edges.size().1 as i32);
        self.states.clear();
        self.states.extend(edges.pixels.iter().map(|p| if *p > 0 { EDGE } else { 0 }));
        self.distances = 2 * (edges.size().0 as usize + edges.size().1 as usize) + 1;
        self.votes.clear();
        self.votes.resize(ANGLES * self.distances, 0);
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        for (y, row) in light::rows(edges) {
            let columns = light::runs(row, 1).flat_map(|(first, end)| first..end);
            order.extend(columns.map(|x| [x as i32, y as i32]));
        }
        for i in (1..order.len()).rev() {
            order.swap(i, (random.bits() % (i as u64 + 1)) as usize);
        }
        order
    }

    fn index(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let inside = x >= 0 && y >= 0 && x < self.width && y < self.height;
        inside.then(|| y as usize * self.width as usize + x as usize)
    }

    fn state(&self, at: [i32; 2]) -> u8 {
        self.index(at).map_or(0, |i| self.states[i])
    }

    /// Bins of all lines through a pixel, by the angle of their normals.
    fn bins(&self, [x, y]: [i32; 2]) -> [u32; ANGLES] {
        let (x, y, middle) = (x as f32, y as f32, self.distances as i32 / 2);
        let mut bins = [0; ANGLES];
        for ((bin, first), (sin, cos)) in bins.iter_mut().zip((0..).step_by(self.distances)).zip(&*DIRECTIONS) {
            *bin = first + (rounded(x * cos + y * sin) + middle) as u32;
        }
        bins
    }

    /// Votes for all lines through a pixel. Returns the votes and the angle of the best one.
    fn vote(&mut self, at: [i32; 2]) -> (u16, usize) {
        if let Some(i) = self.index(at) {
            self.states[i] = VOTED;
        }
        let mut best = (0, 0);
        for (angle, bin) in self.bins(at).into_iter().enumerate() {
            let votes = &mut self.votes[bin as usize];
            *votes = votes.saturating_add(1);
            if *votes > best.0 {
                best = (*votes, angle);
            }
        }
        best
    }

    /// Pixels along a line from `at`, each with its two neighbours across the line.
    fn walk(&self, at: [i32; 2], angle: usize, sense: f32) -> impl Iterator<Item = [[i32; 2]; 3]> + use<> {
        let (sin, cos) = DIRECTIONS[angle];
        let flat = sin.abs() > cos.abs();
        // One pixel at a time along the axis that is closer to the direction of the line.
        let scale = sense / if flat { sin } else { cos };
        let (du, dv) = if flat { (sense, -cos * scale) } else { (-sin * scale, sense) };
        let [x, y] = at.map(|c| c as f32);
        let (width, height) = (self.width, self.height);
        (0..)
            .map(move |i| [(x + du * i as f32).round() as i32, (y + dv * i as f32).round() as i32])
            .take_while(move |[x, y]| *x >= 0 && *y >= 0 && *x < width && *y < height)
            .map(move |[x, y]| if flat { [[x, y], [x, y - 1], [x, y + 1]] } else { [[x, y], [x - 1, y], [x + 1, y]] })
    }

    /// Last edge pixel on a line before a gap of more than `max_gap` pixels.
    fn follow(&self, at: [i32; 2], angle: usize, sense: f32, max_gap: u32) -> [f32; 2] {
        let (mut end, mut gap) = (at, 0);
        for across in self.walk(at, angle, sense) {
            if let Some(edge) = across.into_iter().find(|p| self.state(*p) != 0) {
                (end, gap) = (edge, 0);
            } else if gap == max_gap {
                break;
            } else {
                gap += 1;
            }
        }
        end.map(|c| c as f32)
    }

    /// Removes the edge pixels of a line up to its end, and the votes of a `long` line as well.
    fn take(&mut self, at: [i32; 2], angle: usize, sense: f32, end: [f32; 2], long: bool) {
        for across in self.walk(at, angle, sense) {
            for pixel in across {
                if long && self.state(pixel) == VOTED {
                    for bin in self.bins(pixel) {
                        self.votes[bin as usize] = self.votes[bin as usize].saturating_sub(1);
                    }
                }
                if let Some(i) = self.index(pixel) {
                    self.states[i] = 0;
                }
            }
            if across.iter().any(|p| p.map(|c| c as f32) == end) {
                break;
            }
        }
    }
}

/// Nearest integer, like `round`, but vectorizable.
fn rounded(x: f32) -> i32 {
    let whole = x as i32;
    let rest = x - whole as f32;
    whole + i32::from(rest >= 0.5) - i32::from(rest <= -0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;
    use imageproc::drawing::draw_line_segment_mut;

    fn find(edges: &GrayImage, seed: u64) -> Lines {
        let mut out = Out::new();
        ProbabilisticHough::construct((40, 45.0, 3, seed)).process(edges, &mut out);
        out.get().cloned().expect("lines")
    }

    fn drawing(lines: &[[f32; 4]]) -> GrayImage {
        let mut image = ImageBuffer::from_pixel(200, 150, Luma([0]));
        lines.iter().for_each(|l| draw_line_segment_mut(&mut image, (l[0], l[1]), (l[2], l[3]), Luma([255])));
        image.into()
    }

    #[test]
    fn finds_the_lines_that_were_drawn() {
        let truth = [[10.0, 20.0, 190.0, 35.0], [50.0, 140.0, 60.0, 5.0], [120.0, 60.0, 180.0, 140.0]];
        for seed in 0..20 {
            let lines = find(&drawing(&truth), seed);
            for [a, b, c, d] in truth {
                let drawn = Line { from: [a, b], to: [c, d] };
                // Distance from the drawn line, in pixels.
                let off = |p: [f32; 2]| ((p[0] - a) * (d - b) - (p[1] - b) * (c - a)).abs() / drawn.length();
                let is = |l: &Line| off(l.from) < 2.0 && off(l.to) < 2.0 && l.length() > 0.8 * drawn.length();
                assert!(lines.iter().any(is), "seed {seed}: no {drawn:?} in {lines:?}");
            }
            assert!(lines.len() <= 5, "{lines:?}");
        }
        assert_eq!(find(&drawing(&truth), 3), find(&drawing(&truth), 3));
    }

    #[test]
    fn short_lines_and_dots_are_none() {
        assert_eq!(find(&drawing(&[[10.0, 10.0, 53.0, 10.0]]), 1), []);
        let dots = ImageBuffer::from_fn(200, 150, |x, y| Luma([if x % 10 == 0 && y % 10 == 0 { 255 } else { 0 }]));
        assert_eq!(find(&dots.into(), 1), []);
        assert_eq!(find(&GrayImage::default(), 1), []);
        let full = find(&ImageBuffer::from_pixel(60, 60, Luma([255])).into(), 1);
        assert!(full.len() <= MAX_LINES);
    }

    #[test]
    fn whole_numbers_are_the_nearest() {
        let halves = (-9..=9).map(|i| 0.5 * i as f32).flat_map(|x| [x.next_down(), x, x.next_up()]);
        assert!(halves.into_iter().all(|x| rounded(x) == x.round() as i32));
    }

    #[test]
    fn lines_meet_where_they_cross() {
        let (a, b) = (Line { from: [0.0, 5.0], to: [10.0, 5.0] }, Line { from: [4.0, 0.0], to: [4.0, 20.0] });
        assert_eq!((a.meets(&b), b.at(0.25), a.length()), (Some([0.4, 0.25]), [4.0, 5.0], 10.0));
        assert_eq!(a.meets(&a), None);
    }
}
