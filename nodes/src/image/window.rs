//! Sliding minimum and maximum over pixels.

/// Passes that find the winner of a number of pixels, for each pixel of a row: those of n pixels give those of 2n
/// pixels, so that few passes compare many pixels at once.
struct Passes {
    doublings: u32,
    /// Distances of the partners in the last pass, which compares four.
    last: [usize; 3],
}

impl Passes {
    fn new(count: usize) -> Self {
        let known = (count.next_power_of_two() / 4).max(1);
        let last = [known.min(count - known), count.saturating_sub(2 * known), count - known];
        Self { doublings: known.ilog2(), last }
    }

    /// Distances of the partners in the passes before the last one.
    fn doublings(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.doublings).map(|i| 1 << i)
    }

    /// The last pass. Pixels are `step` apart in the memory.
    fn finish(&self, pixels: &[u8], step: usize, result: &mut [u8], winner: impl Fn(u8, u8) -> u8) {
        let [near, far, farthest] = self.last.map(|shift| &pixels[shift * step..][..result.len()]);
        let pairs = pixels.iter().zip(near).zip(far.iter().zip(farthest));
        for (result, ((a, b), (c, d))) in result.iter_mut().zip(pairs) {
            *result = winner(winner(*a, *b), winner(*c, *d));
        }
    }
}

/// Finds the winners of `count` pixels of a row: of each pixel and those that follow it. The row has `count` - 1 pixels
/// more than the result. Overwrites the row; `spare` is storage.
pub fn gather(row: &mut Vec<u8>, spare: &mut Vec<u8>, count: usize, result: &mut [u8], winner: impl Fn(u8, u8) -> u8) {
    let passes = Passes::new(count);
    for shift in passes.doublings() {
        spare.clear();
        spare.extend(row.iter().zip(&row[shift..]).map(|(a, b)| winner(*a, *b)));
        std::mem::swap(row, spare);
    }
    passes.finish(row, 1, result, winner);
}

/// The same along the columns of an image whose rows have `width` pixels. It has `count` - 1 rows more than the result.
fn gather_columns(pixels: &mut [u8], width: usize, count: usize, result: &mut [u8], winner: impl Fn(u8, u8) -> u8) {
    let passes = Passes::new(count);
    for shift in passes.doublings().map(|shift| shift * width) {
        for start in (shift..pixels.len()).step_by(width) {
            let (before, partners) = pixels.split_at_mut(start);
            let row = &mut before[start - shift..][..width];
            row.iter_mut().zip(partners).for_each(|(a, b)| *a = winner(*a, *b));
        }
    }
    passes.finish(pixels, width, result, winner);
}

/// Minimum and maximum over the squares around pixels. Keeps its storage.
#[derive(Debug, Clone, Default)]
pub struct Squares {
    /// One row, with a frame on both sides.
    row: Vec<u8>,
    spare: Vec<u8>,
    /// Winners along the rows, with a frame above and below.
    rows: Vec<u8>,
}

/// Winners along the rows of an image.
pub struct Rows<'a, F> {
    rows: &'a mut [u8],
    width: usize,
    count: usize,
    winner: F,
}

impl Squares {
    /// Lightest pixels of the squares around all pixels of an image, whose rows have `width` pixels. Pixels outside of
    /// the image do not count.
    pub fn lightest(&mut self, pixels: &[u8], width: usize, radius: usize) -> Rows<'_, impl Fn(u8, u8) -> u8 + use<>> {
        self.extremes(pixels, (width, radius), 0, u8::max)
    }

    /// Darkest pixels of the squares.
    pub fn darkest(&mut self, pixels: &[u8], width: usize, radius: usize) -> Rows<'_, impl Fn(u8, u8) -> u8 + use<>> {
        self.extremes(pixels, (width, radius), 255, u8::min)
    }

    /// Winners of the squares. Pixels outside have the value `loser`.
    fn extremes<F: Fn(u8, u8) -> u8>(
        &mut self,
        pixels: &[u8],
        (width, frame): (usize, usize),
        loser: u8,
        winner: F,
    ) -> Rows<'_, F> {
        // An image without pixels has no columns.
        let (width, count) = (width.max(1), 2 * frame + 1);
        self.rows.resize(pixels.len() + 2 * frame * width, loser);
        let (above, others) = self.rows.split_at_mut(frame * width);
        let (winners, below) = others.split_at_mut(pixels.len());
        above.fill(loser);
        below.fill(loser);
        for (pixels, winners) in pixels.chunks_exact(width).zip(winners.chunks_exact_mut(width)) {
            self.row.clear();
            self.row.resize(frame, loser);
            self.row.extend_from_slice(pixels);
            self.row.resize(width + 2 * frame, loser);
            gather(&mut self.row, &mut self.spare, count, winners, &winner);
        }
        Rows { rows: &mut self.rows, width, count, winner }
    }
}

impl<F: Fn(u8, u8) -> u8> Rows<'_, F> {
    /// Writes the winners of the squares into an image of the same size.
    pub fn write(self, result: &mut [u8]) {
        gather_columns(self.rows, self.width, self.count, result, self.winner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_the_extreme_of_those_that_follow() {
        let mut random = crate::math::Random::new(1);
        for count in (1..40).chain([64, 65, 300]) {
            let line: Vec<u8> = (0..100 + count - 1).map(|_| random.bits() as u8).collect();
            let expected: Vec<u8> = line.windows(count).filter_map(|part| part.iter().max().copied()).collect();
            let mut found = [0; 100];
            gather(&mut line.clone(), &mut vec![], count, &mut found, u8::max);
            assert!(found[..] == expected, "{count}");
            // The same line in each of three columns.
            let mut columns: Vec<u8> = line.iter().flat_map(|pixel| [*pixel; 3]).collect();
            let mut found = [0; 300];
            gather_columns(&mut columns, 3, count, &mut found, u8::max);
            assert!((0..300).all(|i| found[i] == expected[i / 3]), "{count}");
        }
    }
}
