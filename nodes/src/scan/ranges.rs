use core::{
    fmt,
    ops::{Deref, DerefMut},
};

/// Maximum number of beams of a [`Scan`](super::Scan): with the feature `std` as many as [`Segment`](super::Segment)
/// can number, as scans then grow on the heap; without it the room of each scan, which holds a full turn at 0.25° (1440
/// beams) and common 270° scanners (1081 beams).
pub const MAX_BEAMS: usize = if cfg!(feature = "std") { u16::MAX as usize } else { 1536 };

/// List with a value for each beam.
#[cfg(feature = "std")]
pub(super) type PerBeam<T> = std::vec::Vec<T>;
#[cfg(not(feature = "std"))]
pub(super) type PerBeam<T> = heapless::Vec<T, MAX_BEAMS>;

/// Ranges of a scan, in m, by beam: at most [`MAX_BEAMS`].
///
/// With the feature `std` they grow on the heap, as paths and maps do: room for the scanners with the most beams in
/// every scan would make programs and their stacks several times larger. A scan that is written again uses its memory
/// again. Without `std` they have a fixed capacity, so that a microcontroller needs no heap.
#[derive(Debug, PartialEq, Default)]
pub struct Ranges(PerBeam<f32>);

/// Error of a scan with more than [`MAX_BEAMS`] beams.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooManyBeams;

impl fmt::Display for TooManyBeams {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "more than {MAX_BEAMS} beams")?;
        if cfg!(feature = "std") {
            Ok(())
        } else {
            f.write_str("; the feature `std` of `apex-nodes` has room for more")
        }
    }
}

impl core::error::Error for TooManyBeams {}

impl Ranges {
    /// Creates a list without ranges.
    pub const fn new() -> Self {
        Self(PerBeam::new())
    }

    /// Removes all ranges, and keeps their memory.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds a range. Fails if there is no room for it.
    pub fn push(&mut self, range: f32) -> Result<(), TooManyBeams> {
        if self.0.len() == MAX_BEAMS {
            return Err(TooManyBeams);
        }
        self.0.extend([range]);
        Ok(())
    }

    /// Adds ranges. Fails at the first one that finds no room.
    pub fn try_extend(&mut self, ranges: impl IntoIterator<Item = f32>) -> Result<(), TooManyBeams> {
        ranges.into_iter().try_for_each(|range| self.push(range))
    }
}

/// Copies into a list use its memory again.
impl Clone for Ranges {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }

    fn clone_from(&mut self, other: &Self) {
        self.0.clone_from(&other.0);
    }
}

/// Adds ranges whose number is known to be small. Those that find no room are left out: drivers and readers use
/// [`try_extend`](Ranges::try_extend), which says so.
impl Extend<f32> for Ranges {
    fn extend<I: IntoIterator<Item = f32>>(&mut self, ranges: I) {
        let _ = self.try_extend(ranges);
    }
}

/// Collects ranges as [`extend`](Extend::extend) does.
impl FromIterator<f32> for Ranges {
    fn from_iter<I: IntoIterator<Item = f32>>(ranges: I) -> Self {
        let mut list = Self::new();
        list.extend(ranges);
        list
    }
}

impl Deref for Ranges {
    type Target = [f32];

    #[inline]
    fn deref(&self) -> &[f32] {
        &self.0
    }
}

impl DerefMut for Ranges {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f32] {
        &mut self.0
    }
}

impl<'a> IntoIterator for &'a Ranges {
    type Item = &'a f32;
    type IntoIter = core::slice::Iter<'a, f32>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a> IntoIterator for &'a mut Ranges {
    type Item = &'a mut f32;
    type IntoIter = core::slice::IterMut<'a, f32>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_finds_no_room_is_an_error_and_no_panic() {
        let mut ranges: Ranges = (0..MAX_BEAMS + 10).map(|i| i as f32).collect();
        assert_eq!((ranges.len(), ranges[MAX_BEAMS - 1]), (MAX_BEAMS, (MAX_BEAMS - 1) as f32));
        assert_eq!((ranges.push(1.0), ranges.try_extend([1.0])), (Err(TooManyBeams), Err(TooManyBeams)));
        ranges.extend([1.0]);
        ranges.clear();
        assert_eq!((ranges.try_extend([1.0, 2.0]), &ranges[..]), (Ok(()), &[1.0, 2.0][..]));
    }

    #[cfg(feature = "std")]
    #[test]
    fn scanners_with_many_beams_have_room() {
        let mut ranges = Ranges::new();
        assert_eq!(ranges.try_extend([1.0; 3200]), Ok(()));
        let memory = ranges.as_ptr();
        let other: Ranges = [2.0; 3200].into_iter().collect();
        ranges.clone_from(&other);
        assert!(ranges == other && ranges.as_ptr() == memory, "the memory is used again");
    }
}
