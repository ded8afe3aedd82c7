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
