//! Lines of text, formatted without `core::fmt`.

/// Line of text under construction. Text that does not fit is cut off.
pub struct Line {
    bytes: [u8; 64],
    length: usize,
}

impl Default for Line {
    fn default() -> Self {
        Self::new()
    }
}

impl Line {
    /// Creates an empty line.
    pub const fn new() -> Self {
        Self { bytes: [0; 64], length: 0 }
    }

    /// Adds a text.
    pub fn text(mut self, text: &str) -> Self {
        text.bytes().for_each(|byte| self.push(byte));
        self
    }

    /// Adds a decimal number.
    pub fn number(mut self, number: u32) -> Self {
        let digits = number.checked_ilog10().unwrap_or(0);
        (0..=digits).rev().for_each(|digit| self.push(b'0' + (number / 10_u32.pow(digit) % 10) as u8));
        self
    }

    /// Writes the line with a line break.
    pub fn write(mut self, write: fn(&[u8])) {
        self.push(b'\n');
        write(self.bytes.get(..self.length).unwrap_or_default());
    }

    fn push(&mut self, byte: u8) {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
    }
}
