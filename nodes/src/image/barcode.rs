use super::{GrayImage, window::gather};
use apex_rt::node;
use core::f32::consts::PI;
use rxing::{
    BarcodeFormat, DecodeHints,
    common::BitArray,
    oned::{MultiFormatOneDReader, OneDReader},
};

/// A bar code read from an image.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BarCode {
    /// Encoded text.
    pub text: String,
    /// Symbology of the code.
    pub symbology: Symbology,
}

/// Supported kinds of bar codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Symbology {
    /// Code 128.
    Code128,
    /// Code 39.
    Code39,
    /// EAN-13. UPC-A is an EAN-13 that begins with 0.
    Ean13,
    /// EAN-8.
    Ean8,
    /// Interleaved two of five.
    Itf,
}

impl Symbology {
    const ALL: [(BarcodeFormat, Self); 5] = [
        (BarcodeFormat::CODE_128, Self::Code128),
        (BarcodeFormat::CODE_39, Self::Code39),
        (BarcodeFormat::EAN_13, Self::Ean13),
        (BarcodeFormat::EAN_8, Self::Ean8),
        (BarcodeFormat::ITF, Self::Itf),
    ];

    fn of(format: BarcodeFormat) -> Option<Self> {
        Self::ALL.iter().find(|(f, _)| *f == format).map(|(_, symbology)| *symbology)
    }
}

/// Number of directions of the lines through an image, and of parallel lines in each direction, spread over its
/// diagonal.
const DIRECTIONS: u16 = 12;
const LINES: u16 = 100;

/// Samples per pixel of a line, so that the widths of narrow bars can be distinguished.
const FINENESS: usize = 3;

/// Reach of the local threshold, in pixels to each side: a small one for uneven light, a large one for wide bars.
const REACHES: [usize; 2] = [10, 24];

/// Minimum contrast, in intensities. With less contrast a pixel counts as white.
const MIN_CONTRAST: u8 = 8;

/// Minimum number of transitions between black and white on a line that may hold a bar code.
const MIN_BORDERS: usize = 20;

/// Reads the bar code of a cube (thesis 4.3.3); ⊥ if there is none that can be read.
///
/// Reads Code 128, Code 39, EAN-13, EAN-8 and ITF in any direction. A result counts as soon as two lines through the
/// image agree on it.
#[node]
pub fn bar_code(image: &GrayImage) -> Option<BarCode> {
    if image.pixels.is_empty() {
        return None;
    }
    let (mut line, mut reader) = (Line::default(), LineReader::default());
    let mut said: Vec<BarCode> = vec![];
    for (place, direction) in lines(image.size()) {
        line.lay(image, place, direction);
        let code = REACHES.into_iter().find_map(|reach| reader.read(line.bits(reach)?));
        if let Some(code) = code {
            if said.contains(&code) {
                return Some(code);
            }
            said.push(code);
        }
    }
    None
}

/// A point on each line and the direction of the line, in pixels. Lines near the middle of the image come first.
fn lines((width, height): (u32, u32)) -> impl Iterator<Item = ([f32; 2], [f32; 2])> {
    let middle = [width, height].map(|side| 0.5 * side as f32 - 0.5);
    let spacing = (width as f32).hypot(height as f32) / f32::from(LINES);
    let distances = (0..=LINES).map(move |i| spacing * f32::from(i.div_ceil(2)) * if i % 2 == 0 { 1.0 } else { -1.0 });
    distances.flat_map(move |distance| {
        (0..DIRECTIONS).map(move |i| {
            let (sin, cos) = (f32::from(i) * PI / f32::from(DIRECTIONS)).sin_cos();
            ([middle[0] - distance * sin, middle[1] + distance * cos], [cos, sin])
        })
    })
}

/// Intensities along a straight line through an image.
#[derive(Default)]
struct Line {
    values: Vec<u8>,
    /// Darkest and lightest intensity around each sample.
    extremes: [Vec<u8>; 2],
    spare: Vec<u8>,
}

impl Line {
    /// Samples a line as far as it is inside the image.
    fn lay(&mut self, image: &GrayImage, place: [f32; 2], direction: [f32; 2]) {
        let ends = <[u32; 2]>::from(image.size()).map(|side| side as f32 - 1.0);
        let (mut first, mut last) = (f32::MIN, f32::MAX);
        for i in 0..2 {
            // If the line is parallel to an axis, both are infinite: with opposite signs inside the image, with equal
            // signs outside.
            let [a, b] = [0.0, ends[i]].map(|end| (end - place[i]) / direction[i]);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
        let steps = ((last - first) * FINENESS as f32) as usize;
        self.values.clear();
        self.values.extend((0..steps).map(|step| {
            let along = first + step as f32 / FINENESS as f32;
            let at = |i: usize| (place[i] + along * direction[i]).clamp(0.0, ends[i]);
            between(image, at(0), at(1))
        }));
    }

    /// Black samples: darker than the mean of the darkest and the lightest intensity within `reach` pixels. `None` if
    /// there are too few transitions.
    fn bits(&mut self, reach: usize) -> Option<BitArray> {
        let margin = reach * FINENESS;
        for (extremes, winner) in self.extremes.iter_mut().zip([u8::min, u8::max]) {
            extremes.clear();
            // Beyond its ends, the line continues with its last values.
            let ends = [self.values.first()?, self.values.last()?].map(|end| std::iter::repeat_n(*end, margin));
            let [before, after] = ends;
            extremes.extend(before.chain(self.values.iter().copied()).chain(after));
            gather(extremes, &mut self.spare, 1, 2 * margin + 1, winner);
        }
        let (mut bits, mut borders, mut before) = (BitArray::with_size(self.values.len()), 0, false);
        let around = self.extremes[0].iter().zip(&self.extremes[1]);
        for (i, (value, (low, high))) in self.values.iter().zip(around).enumerate() {
            let black = high - low >= MIN_CONTRAST && *value < low.midpoint(*high);
            if black {
                bits.set(i);
            }
            borders += usize::from(black != before);
            before = black;
        }
        (borders >= MIN_BORDERS).then_some(bits)
    }
}

/// Interpolated intensity at a place inside the image.
fn between(image: &GrayImage, x: f32, y: f32) -> u8 {
    let (pixels, width) = (image.pixels.as_raw(), image.size().0 as usize);
    let (left, top) = (x as usize, y as usize);
    let (right, below) = ((left + 1).min(width - 1), (top + 1).min(image.size().1 as usize - 1));
    let (a, b) = (x - left as f32, y - top as f32);
    let mix = |part: f32, first: f32, second: f32| (1.0 - part) * first + part * second;
    let at = |column: usize, row: usize| f32::from(pixels[row * width + column]);
    mix(b, mix(a, at(left, top), at(right, top)), mix(a, at(left, below), at(right, below))) as u8
}

/// Reader of the bars along a line.
struct LineReader {
    reader: MultiFormatOneDReader,
    hints: DecodeHints,
}

impl Default for LineReader {
    fn default() -> Self {
        let formats = Symbology::ALL.iter().map(|(format, _)| *format).collect();
        let hints = DecodeHints { PossibleFormats: Some(formats), ..DecodeHints::default() };
        Self { reader: MultiFormatOneDReader::new(&hints), hints }
    }
}

impl LineReader {
    /// Decodes the bars from either end.
    fn read(&mut self, mut bits: BitArray) -> Option<BarCode> {
        let forward = self.reader.decode_row(0, &bits, &self.hints);
        let result = forward.or_else(|_| {
            bits.reverse();
            self.reader.decode_row(0, &bits, &self.hints)
        });
        let result = result.ok()?;
        let symbology = Symbology::of(*result.getBarcodeFormat())?;
        Some(BarCode { text: result.getText().to_owned(), symbology })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma, imageops};
    use imageproc::geometric_transformations::{Border, Interpolation, rotate_about_center_no_crop};

    /// EAN-8 "12345670" according to its standard: 67 modules.
    const EAN_8: &str = "1010011001001001101111010100011010101001110101000010001001110010101";

    /// The bars along x, with a quiet zone, `module` pixels each.
    fn bars(module: u32, height: u32) -> ::image::GrayImage {
        let quiet = 12 * module;
        ImageBuffer::from_fn(EAN_8.len() as u32 * module + 2 * quiet, height, |x, _| {
            let bar = x.checked_sub(quiet).map(|x| (x / module) as usize).and_then(|i| EAN_8.as_bytes().get(i));
            Luma([if bar == Some(&b'1') { 20 } else { 230 }])
        })
    }

    #[test]
    fn reads_bars_in_any_direction() {
        let expected = Some(BarCode { text: "12345670".into(), symbology: Symbology::Ean8 });
        let flat = bars(3, 120);
        for image in [flat.clone(), imageops::rotate90(&flat), imageops::rotate180(&flat)] {
            assert_eq!(bar_code(&image.into()), expected);
        }
        // On a page, so that nothing is cut off by the rotation.
        let mut page = ImageBuffer::from_pixel(500, 500, Luma([230]));
        imageops::replace(&mut page, &flat, 110, 190);
        for degrees in (0..360).step_by(5) {
            let (angle, white) = ((degrees as f32).to_radians(), Border::Constant(Luma([255])));
            let turned = rotate_about_center_no_crop(&page, angle, Interpolation::Bilinear, white);
            assert_eq!(bar_code(&turned.into()), expected, "{degrees}");
        }
    }

    #[test]
    fn what_is_no_bar_code_is_bottom() {
        for (width, height) in [(0, 0), (1, 1), (16, 16), (3, 500), (200, 17)] {
            for gray in [0, 255] {
                assert_eq!(bar_code(&ImageBuffer::from_pixel(width, height, Luma([gray])).into()), None);
            }
        }
        let mut random = crate::math::Random::new(3);
        let noise = ImageBuffer::from_fn(200, 200, |_, _| Luma([random.bits() as u8]));
        assert_eq!(bar_code(&noise.into()), None);
    }
}
