use crate::image::GrayImage;
use std::f32::consts::PI;

/// Number of directions of the lines through an image, and of parallel lines in each direction, spread over its
/// diagonal.
pub const DIRECTIONS: usize = 12;
pub const LINES: usize = 100;

/// Rows and columns of pixels in a block, and samples of a line that count as one.
const BLOCK: usize = 8;

/// Smallest sum of squared differences of pairs of pixels in a block: that of an edge of 8 intensities, blurred over
/// four pixels.
const MIN_ENERGY: f32 = 512.0;

/// Smallest part of the squared differences that a block has more across its stripes than along them.
const MIN_COHERENCE: f32 = 0.4;

/// Cosine of twice the largest angle between a line and the gradients of the blocks that count, 10°: half the angle
/// between two directions, and 2.5° more for noise.
const ALIGNED: f32 = 0.94;

/// Numbers of blocks of a part of a line, and the least number of those with stripes, of a code of some pixels a bar.
const SMALL: (usize, u32) = (12, 8);

/// Number of blocks along the diagonal of an image in which bars may be wider than blocks.
const LARGE: usize = 128;

/// Lines through an image: `LINES` + 1 parallel ones in each direction, spread over its diagonal.
pub struct Raster {
    middle: [f32; 2],
    /// Distance of parallel lines, in pixels.
    spacing: f32,
    /// Number of blocks along the diagonal.
    blocks: usize,
}

impl Raster {
    pub fn new((width, height): (u32, u32)) -> Self {
        let diagonal = (width as f32).hypot(height as f32);
        let middle = [width, height].map(|side| 0.5 * side as f32 - 0.5);
        Self { middle, spacing: diagonal / LINES as f32, blocks: diagonal as usize / BLOCK + 2 }
    }

    /// Point on a line, and the direction of the line, in pixels. Line `LINES` / 2 passes through the middle.
    pub fn line(&self, direction: usize, line: usize) -> ([f32; 2], [f32; 2]) {
        let distance = self.spacing * (line as f32 - (LINES / 2) as f32);
        let [cos, sin] = unit(direction);
        ([self.middle[0] - distance * sin, self.middle[1] + distance * cos], [cos, sin])
    }

    /// Lines with stripes across them that may be those of a bar code, by direction.
    ///
    /// The structure tensor of each block tells whether it has stripes, and their direction. A bar code has many such
    /// blocks in a row.
    pub fn striped_lines(&self, image: &GrayImage) -> [[bool; LINES + 1]; DIRECTIONS] {
        let mut marks = vec![0_u8; DIRECTIONS * (LINES + 1) * self.blocks];
        let (pixels, width) = (image.pixels.as_raw(), image.size().0 as usize);
        let units: [_; DIRECTIONS] = std::array::from_fn(unit);
        for row in 0..(image.size().1 as usize - 1) / BLOCK {
            let rows = &pixels[row * BLOCK * width..][..(BLOCK + 1) * width];
            for column in 0..(width - 1) / BLOCK {
                let Some(stripes) = stripes(rows, width, column * BLOCK) else { continue };
                let place = [column, row].map(|at| (BLOCK * at) as f32 + 0.5 * BLOCK as f32);
                for (direction, [cos, sin]) in units.into_iter().enumerate() {
                    if stripes[0] * (cos * cos - sin * sin) + stripes[1] * 2.0 * sin * cos >= ALIGNED {
                        self.mark(&mut marks, direction, [cos, sin], place);
                    }
                }
            }
        }
        let mut lines = marks.chunks_exact(self.blocks).map(|marks| self.is_dense(marks));
        std::array::from_fn(|_| std::array::from_fn(|_| lines.next().unwrap_or_default()))
    }

    /// Marks a block on the lines of a direction that cross it.
    fn mark(&self, marks: &mut [u8], direction: usize, [cos, sin]: [f32; 2], place: [f32; 2]) {
        let [x, y] = [0, 1].map(|i| place[i] - self.middle[i]);
        let half = 0.5 * BLOCK as f32 * (cos.abs() + sin.abs());
        let along = ((x * cos + y * sin) / BLOCK as f32 + 0.5 * self.blocks as f32) as usize;
        let lines = [-half, half].map(|side| (y * cos - x * sin + side) / self.spacing + (LINES / 2) as f32);
        for line in lines[0].ceil().max(0.0) as usize..=(lines[1] as usize).min(LINES) {
            marks[(direction * (LINES + 1) + line) * self.blocks + along.min(self.blocks - 1)] = 1;
        }
    }

    /// Returns `true` if enough blocks of some part of a line are striped. In a large image, blocks may be inside a
    /// bar: there, a third of the blocks of a quarter of the diagonal suffices, too.
    fn is_dense(&self, marks: &[u8]) -> bool {
        if marks.iter().map(|mark| u32::from(*mark)).sum::<u32>() < SMALL.1 {
            return false;
        }
        let quarter = self.blocks / 4;
        most_of(marks, SMALL.0) >= SMALL.1 || self.blocks > LARGE && most_of(marks, quarter) as usize >= quarter / 3
    }
}

/// Largest number of marks in a part of a line.
fn most_of(marks: &[u8], part: usize) -> u32 {
    let part = part.min(marks.len());
    let mut count: u32 = marks[..part].iter().map(|mark| u32::from(*mark)).sum();
    let mut most = count;
    for (last, first) in marks[part..].iter().zip(marks) {
        count = count + u32::from(*last) - u32::from(*first);
        most = most.max(count);
    }
    most
}

fn unit(direction: usize) -> [f32; 2] {
    let (sin, cos) = (direction as f32 * PI / DIRECTIONS as f32).sin_cos();
    [cos, sin]
}

/// Unit vector with twice the angle of the gradients of a block; `None` if it has no stripes.
fn stripes(rows: &[u8], width: usize, left: usize) -> Option<[f32; 2]> {
    let [mut along_x, mut along_y, mut both] = [0_i32; 3];
    for y in 0..BLOCK {
        let here = rows[y * width + left..].first_chunk::<{ BLOCK + 1 }>()?;
        let below = rows[(y + 1) * width + left..].first_chunk::<{ BLOCK + 1 }>()?;
        for x in 0..BLOCK {
            let [a, b, c, d] = [here[x], here[x + 1], below[x], below[x + 1]].map(i16::from);
            let (dx, dy) = (b + d - a - c, c + d - a - b);
            along_x += i32::from(dx) * i32::from(dx);
            along_y += i32::from(dy) * i32::from(dy);
            both += i32::from(dx) * i32::from(dy);
        }
    }
    let energy = (along_x + along_y) as f32;
    let [a, b] = [(along_x - along_y) as f32, (2 * both) as f32];
    let anisotropy = (a * a + b * b).sqrt();
    (energy >= MIN_ENERGY && anisotropy >= MIN_COHERENCE * energy).then(|| [a / anisotropy, b / anisotropy])
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};

    fn striped(image: &GrayImage) -> Vec<(usize, usize)> {
        let lines = Raster::new(image.size()).striped_lines(image);
        let all = (0..DIRECTIONS).flat_map(|direction| (0..=LINES).map(move |line| (direction, line)));
        all.filter(|(direction, line)| lines[*direction][*line]).collect()
    }

    #[test]
    fn lines_across_stripes_are_found() {
        for direction in 0..DIRECTIONS {
            let [cos, sin] = unit(direction);
            let shade = |x: u32, y: u32| if (x as f32 * cos + y as f32 * sin).rem_euclid(9.0) < 4.0 { 50 } else { 180 };
            let image = ImageBuffer::from_fn(300, 200, |x, y| Luma([shade(x, y)])).into();
            let found = striped(&image);
            assert!(found.contains(&(direction, LINES / 2)), "{direction}");
            let turn = |found: usize| (found + DIRECTIONS - direction) % DIRECTIONS;
            assert!(found.iter().all(|(found, _)| [0, 1, DIRECTIONS - 1].contains(&turn(*found))), "{direction}");
        }
    }

    #[test]
    fn an_image_without_stripes_has_no_lines() {
        let mut random = crate::math::Random::new(1);
        for (width, height) in [(1, 1), (1, 40), (3, 2), (9, 9), (203, 117)] {
            assert!(striped(&ImageBuffer::from_pixel(width, height, Luma([7])).into()).is_empty());
            assert!(
                striped(&ImageBuffer::from_fn(width, height, |_, _| Luma([random.bits() as u8])).into()).is_empty()
            );
        }
    }

    #[test]
    fn the_densest_part_counts() {
        let mut random = crate::math::Random::new(1);
        for length in [1, 5, 12, 13, 40] {
            let marks: Vec<u8> = (0..length).map(|_| (random.bits() % 2) as u8).collect();
            let sums = marks.windows(length.min(12)).map(|part| part.iter().map(|mark| u32::from(*mark)).sum());
            assert_eq!(Some(most_of(&marks, 12)), sums.max());
        }
    }
}
