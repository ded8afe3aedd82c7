//! Sliding minimum and maximum over pixels.

/// Replaces each pixel by the winner of `count` pixels: itself and those that follow it at distances of `step`, as far
/// as they exist.
///
/// The winners of n pixels give those of 2n pixels, so that few passes compare many pixels at once. `spare` is storage.
pub fn gather(pixels: &mut Vec<u8>, spare: &mut Vec<u8>, step: usize, count: usize, winner: impl Fn(u8, u8) -> u8) {
    let mut known = 1;
    while known < count {
        let more = known.min(count - known);
        let partners = pixels.get(more * step..).unwrap_or_default();
        spare.clear();
        // Arrays, so that many pixels are compared at once in debug builds, too.
        let (arrays, rest) = partners.as_chunks::<64>();
        for (a, b) in pixels.as_chunks::<64>().0.iter().zip(arrays) {
            spare.extend_from_slice(&std::array::from_fn::<u8, 64, _>(|i| winner(a[i], b[i])));
        }
        spare.extend(pixels[spare.len()..].iter().zip(rest).map(|(a, b)| winner(*a, *b)));
        spare.extend_from_slice(&pixels[spare.len()..]);
        std::mem::swap(pixels, spare);
        known += more;
    }
}

/// Minimum and maximum over the squares around pixels. Keeps its storage.
#[derive(Debug, Clone, Default)]
pub struct Squares {
    framed: Vec<u8>,
    spare: Vec<u8>,
}

impl Squares {
    /// Replaces each pixel of an image, whose rows have `width` pixels, by the lightest one of the square around it.
    /// Pixels outside of the image do not count.
    pub fn lightest(&mut self, pixels: &mut [u8], width: usize, radius: usize) {
        self.extremes(pixels, (width, radius), 0, u8::max);
    }

    /// Replaces each pixel by the darkest one of the square around it.
    pub fn darkest(&mut self, pixels: &mut [u8], width: usize, radius: usize) {
        self.extremes(pixels, (width, radius), 255, u8::min);
    }

    /// Replaces each pixel by the winner of the square around it. Pixels outside have the value `loser`.
    fn extremes(
        &mut self,
        pixels: &mut [u8],
        (width, frame): (usize, usize),
        loser: u8,
        winner: impl Fn(u8, u8) -> u8,
    ) {
        if pixels.is_empty() {
            return;
        }
        let (height, stride) = (pixels.len() / width, width + 2 * frame);
        self.framed.clear();
        self.framed.resize(stride * (height + 2 * frame), loser);
        let inner = self.framed.chunks_exact_mut(stride).skip(frame);
        inner.zip(pixels.chunks_exact(width)).for_each(|(to, from)| to[frame..][..width].copy_from_slice(from));
        // Windows that cross the end of a row begin in the frame, which is not read.
        gather(&mut self.framed, &mut self.spare, 1, 2 * frame + 1, &winner);
        gather(&mut self.framed, &mut self.spare, stride, 2 * frame + 1, &winner);
        let squares = self.framed.chunks_exact(stride);
        pixels.chunks_exact_mut(width).zip(squares).for_each(|(to, from)| to.copy_from_slice(&from[..width]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_the_extreme_of_those_that_follow() {
        let mut random = crate::math::Random::new(1);
        let line: Vec<u8> = (0..100).map(|_| random.bits() as u8).collect();
        for (step, count) in [(1, 1), (1, 2), (1, 7), (3, 5), (10, 9), (1, 300), (300, 2)] {
            let mut pixels = line.clone();
            gather(&mut pixels, &mut vec![], step, count, u8::max);
            let expected = |i: usize| line[i..].iter().step_by(step).take(count).max().copied();
            assert!((0..100).all(|i| Some(pixels[i]) == expected(i)), "{count} in steps of {step}");
        }
    }
}
