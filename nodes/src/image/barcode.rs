mod runs;
mod stripes;
mod symbology;

pub use symbology::Symbology;

use self::{
    runs::LAYOUTS,
    stripes::{DIRECTIONS, LINES, Raster},
};
use super::{GrayImage, window::gather};
use apex_rt::node;
use rxing::{
    DecodeHints,
    common::BitArray,
    oned::{Code39Reader, Code128Reader, ITFReader, MultiFormatUPCEANReader, OneDReader},
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
/// image agree on it. Bars narrower than 1.5 pixels are often missed.
#[node]
pub fn bar_code(image: &GrayImage) -> Option<BarCode> {
    if image.pixels.is_empty() {
        return None;
    }
    let raster = Raster::new(image.size());
    let striped = raster.striped_lines(image);
    let formats = Symbology::ALL.iter().map(|(format, _)| *format).collect();
    let hints = DecodeHints { PossibleFormats: Some(formats), ..DecodeHints::default() };
    let mut line = Line::default();
    let mut said: Vec<BarCode> = vec![];
    for (direction, number) in lines().filter(|(direction, number)| striped[*direction][*number]) {
        line.lay(image, raster.line(direction, number));
        let code = REACHES.into_iter().find_map(|reach| read(line.runs(reach)?, &hints));
        if let Some(code) = code {
            if said.contains(&code) {
                return Some(code);
            }
            said.push(code);
        }
    }
    None
}

/// Directions and numbers of all lines. Those near the middle of the image come first.
fn lines() -> impl Iterator<Item = (usize, usize)> {
    let numbers = (0..=LINES).map(|i| if i % 2 == 0 { LINES / 2 + i / 2 } else { LINES / 2 - i.div_ceil(2) });
    numbers.flat_map(|number| (0..DIRECTIONS).map(move |direction| (direction, number)))
}

/// Intensities along a straight line through an image.
#[derive(Default)]
struct Line {
    values: Vec<u8>,
    /// The same with more samples at both ends.
    framed: Vec<u8>,
    /// Darkest intensity around each sample.
    darkest: Vec<u8>,
    lightest: Vec<u8>,
    spare: Vec<u8>,
    /// Numbers of samples that are white and black in turn, beginning with white.
    runs: Vec<u32>,
}

impl Line {
    /// Samples a line as far as it is inside the image.
    fn lay(&mut self, image: &GrayImage, (place, direction): ([f32; 2], [f32; 2])) {
        let ends = <[u32; 2]>::from(image.size()).map(|side| side as f32 - 1.0);
        let (mut first, mut last) = (f32::MIN, f32::MAX);
        for i in 0..2 {
            // If the line is parallel to an axis, both are infinite: with opposite signs inside the image, with equal
            // signs outside.
            let [a, b] = [0.0, ends[i]].map(|end| (end - place[i]) / direction[i]);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
        let steps = ((last - first) * FINENESS as f32) as usize;
        let [x, y] = [0, 1].map(|i| Track::new(place[i] + first * direction[i], direction[i], ends[i]));
        self.values.clear();
        self.values.extend((0..steps).map(|step| between(image, x.at(step), y.at(step))));
    }

    /// Continues the line beyond its ends, with its last values. `None` without samples.
    fn frame(&mut self, margin: usize) -> Option<()> {
        let [first, last] = [*self.values.first()?, *self.values.last()?];
        self.framed.clear();
        self.framed.resize(margin, first);
        self.framed.extend_from_slice(&self.values);
        self.framed.resize(self.values.len() + 2 * margin, last);
        Some(())
    }

    /// Runs of white and black samples. Black ones are darker than the mean of the darkest and the lightest intensity
    /// within `reach` pixels. `None` if there are too few transitions.
    fn runs(&mut self, reach: usize) -> Option<&mut Vec<u32>> {
        self.darkest.resize(self.values.len(), 0);
        self.lightest.resize(self.values.len(), 0);
        let around = 2 * reach * FINENESS + 1;
        self.frame(reach * FINENESS)?;
        gather(&mut self.framed, &mut self.spare, around, &mut self.darkest, u8::min);
        self.frame(reach * FINENESS)?;
        gather(&mut self.framed, &mut self.spare, around, &mut self.lightest, u8::max);
        let around = self.darkest.iter().zip(&self.lightest);
        let is_black = self
            .values
            .iter()
            .zip(around)
            .map(|(value, (low, high))| high - low >= MIN_CONTRAST && *value < low.midpoint(*high));
        self.runs.clear();
        let (mut run, mut before) = (0, false);
        for black in is_black {
            if black != before {
                self.runs.push(run);
                (run, before) = (0, black);
            }
            run += 1;
        }
        self.runs.push(run);
        (self.runs.len() > MIN_BORDERS).then_some(&mut self.runs)
    }
}

/// Coordinate along a line, in parts of 2¹⁶ of a pixel.
struct Track {
    first: i64,
    step: i64,
    last: i64,
}

impl Track {
    fn new(first: f32, direction: f32, end: f32) -> Self {
        let fixed = |number: f32| (f64::from(number) * 65536.0) as i64;
        Self { first: fixed(first), step: fixed(direction / FINENESS as f32), last: fixed(end) }
    }

    /// Pixel before a sample, and its distance in parts of 256.
    fn at(&self, step: usize) -> (usize, u32) {
        let place = (self.first + step as i64 * self.step).clamp(0, self.last);
        ((place >> 16) as usize, (place >> 8) as u32 & 255)
    }
}

/// Interpolated intensity at a place inside the image.
fn between(image: &GrayImage, (left, a): (usize, u32), (top, b): (usize, u32)) -> u8 {
    let (pixels, width) = (image.pixels.as_raw(), image.size().0 as usize);
    let (right, below) = ((left + 1).min(width - 1), (top + 1).min(image.size().1 as usize - 1));
    let mix = |part: u32, first: u32, second: u32| (256 - part) * first + part * second;
    let at = |column: usize, row: usize| u32::from(pixels[row * width + column]);
    (mix(b, mix(a, at(left, top), at(right, top)), mix(a, at(left, below), at(right, below))) >> 16) as u8
}

/// Decodes the bars along a line, whose runs begin with white, from either end.
fn read(runs: &mut Vec<u32>, hints: &DecodeHints) -> Option<BarCode> {
    read_forward(runs, hints).or_else(|| {
        // The reversed line begins with white, too, if only with none.
        if runs.len().is_multiple_of(2) {
            runs.push(0);
        }
        runs.reverse();
        read_forward(runs, hints)
    })
}

fn read_forward(runs: &[u32], hints: &DecodeHints) -> Option<BarCode> {
    LAYOUTS.iter().filter(|layout| layout.is_on(runs)).find_map(|layout| {
        let bits = bits(runs);
        let result = match layout.symbology {
            Symbology::Ean8 | Symbology::Ean13 => MultiFormatUPCEANReader::new(hints).decode_row(0, &bits, hints),
            Symbology::Code39 => Code39Reader::default().decode_row(0, &bits, hints),
            Symbology::Code128 => Code128Reader.decode_row(0, &bits, hints),
            Symbology::Itf => ITFReader::default().decode_row(0, &bits, hints),
        };
        let result = result.ok()?;
        let symbology = Symbology::of(*result.getBarcodeFormat())?;
        Some(BarCode { text: result.getText().to_owned(), symbology })
    })
}

/// Black samples.
fn bits(runs: &[u32]) -> BitArray {
    let mut bits = BitArray::with_size(runs.iter().sum::<u32>() as usize);
    let mut at = 0;
    for (run, color) in runs.iter().zip([false, true].into_iter().cycle()) {
        let end = at + *run as usize;
        if color {
            (at..end).for_each(|i| bits.set(i));
        }
        at = end;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma, imageops};
    use imageproc::geometric_transformations::{Border, Interpolation, rotate_about_center_no_crop};
    use rxing::oned::MultiFormatOneDReader;

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

    /// Lines with a code in random surroundings, its bars more or less sharp, from both ends.
    #[test]
    fn a_layout_is_on_each_line_that_can_be_read() {
        let formats = Symbology::ALL.iter().map(|(format, _)| *format).collect();
        let hints = DecodeHints { PossibleFormats: Some(formats), ..DecodeHints::default() };
        let (mut random, mut count) = (crate::math::Random::new(1), 0);
        for _ in 0..500 {
            let mut below = |end: u64| random.bits() % end;
            let module = 1 + below(9) as u32;
            let mut runs: Vec<u32> = (0..2 * below(4)).map(|_| 1 + below(60) as u32).collect();
            runs.push(1 + below(12) as u32 * module);
            let bars = EAN_8.as_bytes().chunk_by(|a, b| a == b).map(|run| run.len() as u32 * module);
            let (bent, step) = (below(2) as u32 * module / 4, below(2) as u32);
            runs.extend(bars.map(|width| (width + below(u64::from(bent) + 1) as u32).saturating_sub(step).max(1)));
            runs.extend((0..1 + 2 * below(4)).map(|_| 1 + below(60) as u32));
            for _ in 0..2 {
                let expected = MultiFormatOneDReader::new(&hints).decode_row(0, &bits(&runs), &hints);
                let expected = expected.ok().map(|result| result.getText().to_owned());
                assert_eq!(read_forward(&runs, &hints).map(|code| code.text), expected, "{runs:?}");
                count += u32::from(expected.is_some());
                runs.reverse();
            }
        }
        assert!(count > 100, "{count} lines were read");
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
