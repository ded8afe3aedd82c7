//! Messages of 4 kB: by value, written in place, and over events.

use apex_rt::prelude::*;
use std::hint::black_box;

/// Number of words in a message.
const WORDS: usize = 512;

/// A message of 4 kB.
#[derive(Debug, Clone)]
pub struct Frame {
    words: [u64; WORDS],
}

impl Default for Frame {
    fn default() -> Self {
        Self { words: [0; WORDS] }
    }
}

impl Frame {
    /// Fills the message with numbers from `first` on.
    pub fn fill(&mut self, first: u64) {
        for (word, i) in self.words.iter_mut().zip(0..) {
            *word = first + i;
        }
    }

    /// Fills the message with the words of `other`, each changed by `k`.
    pub fn tint_from(&mut self, other: &Self, k: u64) {
        for (word, from) in self.words.iter_mut().zip(&other.words) {
            *word = from ^ k;
        }
    }

    /// Sum of all words.
    pub fn sum(&self) -> u64 {
        self.words.iter().fold(0, |sum, word| sum.wrapping_add(*word))
    }
}

/// Sends messages by value.
#[node]
#[derive(Default)]
pub struct Frames {
    next: u64,
}

#[node]
impl Frames {
    /// One message.
    pub fn process(&mut self) -> Frame {
        self.next += 1;
        let mut frame = Frame::default();
        frame.fill(black_box(self.next));
        frame
    }
}

/// A changed message, by value.
#[node]
pub fn tint(frame: &Frame, #[param] k: u64) -> Frame {
    let mut tinted = Frame::default();
    tinted.tint_from(frame, k);
    tinted
}

/// Writes messages in place.
#[node]
#[derive(Default)]
pub struct FramesInPlace {
    next: u64,
}

#[node]
impl FramesInPlace {
    /// One message.
    pub fn process(&mut self, frame: &mut Out<Frame>) {
        self.next += 1;
        frame.get_mut().fill(black_box(self.next));
    }
}

/// A changed message, written in place.
#[node]
pub fn tint_in_place(frame: &Frame, #[param] k: u64, tinted: &mut Out<Frame>) {
    tinted.get_mut().tint_from(frame, k);
}

/// Sends messages by an event.
#[node]
#[derive(Default)]
pub struct FrameEvents {
    next: u64,
}

#[node]
impl FrameEvents {
    fn process(&mut self, made: Event<Frame>) {
        self.next += 1;
        let mut frame = Frame::default();
        frame.fill(black_box(self.next));
        made.emit(frame);
    }
}

/// Sends each message on by an event, changed.
#[node]
pub struct TintEvents {
    #[param]
    k: u64,
}

#[node]
impl TintEvents {
    #[slot]
    fn put(&mut self, frame: &Frame, tinted: Event<Frame>) {
        tinted.emit(tint(frame, self.k));
    }
}

/// Adds up the words of all messages.
#[node]
#[derive(Default)]
pub struct FrameSink {
    sum: u64,
}

#[node]
impl FrameSink {
    /// Takes a message.
    pub fn process(&mut self, frame: &Frame) {
        self.sum = black_box(self.sum.wrapping_add(frame.sum()));
    }
}

impl FrameSink {
    /// The sum of all words.
    pub const fn checksum(&self) -> u64 {
        self.sum
    }
}

/// The same from a slot.
#[node]
#[derive(Default)]
pub struct FrameSlot {
    sum: u64,
}

#[node]
impl FrameSlot {
    #[slot]
    fn put(&mut self, frame: &Frame) {
        self.sum = black_box(self.sum.wrapping_add(frame.sum()));
    }
}

impl FrameSlot {
    /// The sum of all words.
    pub const fn checksum(&self) -> u64 {
        self.sum
    }
}
