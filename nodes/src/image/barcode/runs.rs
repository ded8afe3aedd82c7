use super::symbology::Symbology;

/// Structure of a symbology: white, a start, and characters of the same width. Widths are in times of that of the
/// start.
pub struct Layout {
    /// Symbology, or one of those with this start.
    pub symbology: Symbology,
    /// Least white before the start.
    quiet: f32,
    /// Runs of the start.
    start: usize,
    /// Largest width of a run of the start.
    longest: f32,
    /// Runs of the start that are wider than all others, if they are known.
    wide: &'static [usize],
    /// Runs of a character.
    character: usize,
    /// Least and largest width of a character.
    widths: [f32; 2],
    /// Least number of characters.
    characters: usize,
}

/// Largest difference between the widths of two characters, in times of the first one.
const UNEVENNESS: f32 = 0.3;

/// Layouts of the symbologies, with more tolerance than their decoders have.
pub const LAYOUTS: [Layout; 4] = [
    // Three bars of a module, and four digits of seven modules before the middle; EAN-13 has six.
    Layout {
        symbology: Symbology::Ean8,
        quiet: 0.95,
        start: 3,
        longest: 0.57,
        wide: &[],
        character: 4,
        widths: [1.4, 3.8],
        characters: 4,
    },
    // Five bars and four spaces, and one more space after each character. At least one character and the end.
    Layout {
        symbology: Symbology::Code39,
        quiet: 0.45,
        start: 9,
        longest: 0.35,
        wide: &[1, 4, 6],
        character: 10,
        widths: [0.7, 2.0],
        characters: 2,
    },
    // All characters have eleven modules, those of the start at most four for a bar. At least one character, a check
    // character, and the end.
    Layout {
        symbology: Symbology::Code128,
        quiet: 0.45,
        start: 6,
        longest: 0.43,
        wide: &[],
        character: 6,
        widths: [0.7, 1.4],
        characters: 3,
    },
    // Four bars of a module, and at least three pairs of digits of 14 to 18 modules.
    Layout {
        symbology: Symbology::Itf,
        quiet: 1.8,
        start: 4,
        longest: 0.38,
        wide: &[],
        character: 10,
        widths: [2.4, 6.4],
        characters: 3,
    },
];

impl Layout {
    /// Returns `true` if such a code may begin somewhere on a line. Its runs are in turn white and black, beginning
    /// with white. There may be white before the line.
    pub fn is_on(&self, runs: &[u32]) -> bool {
        (0..runs.len()).step_by(2).any(|at| {
            let quiet = if at == 0 { u32::MAX } else { runs[at] };
            // No run of a start is wider than the white before it: most places are refused here.
            runs.get(at + 1).is_some_and(|bar| *bar <= quiet) && self.fits(quiet, &runs[at + 1..])
        })
    }

    /// Returns `true` if a code may begin after this much white.
    fn fits(&self, quiet: u32, runs: &[u32]) -> bool {
        let Some((start, rest)) = runs.split_at_checked(self.start) else { return false };
        let width = sum(start);
        let longest = start.iter().max().map_or(0.0, |run| *run as f32);
        if (quiet as f32) < self.quiet * width || longest > self.longest * width {
            return false;
        }
        let wide = self.wide.iter().map(|run| start[*run]).min();
        if wide.is_some_and(|wide| start.iter().filter(|run| **run >= wide).count() > self.wide.len()) {
            return false;
        }
        let Some(first) = rest.get(..self.character).map(sum) else { return false };
        let characters = rest.chunks_exact(self.character).take(self.characters);
        self.widths[0] * width <= first
            && first <= self.widths[1] * width
            && characters.len() == self.characters
            && characters.map(sum).all(|character| (character - first).abs() <= UNEVENNESS * first)
    }
}

fn sum(runs: &[u32]) -> f32 {
    runs.iter().sum::<u32>() as f32
}
