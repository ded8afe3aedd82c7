use super::GrayImage;
use ::image::{
    Luma,
    imageops::{self, FilterType},
};
use apex_rt::node;
use imageproc::geometric_transformations::{Border, Interpolation, rotate_about_center_no_crop};
use rxing::{
    BarcodeFormat, BinaryBitmap, DecodeHints, Luma8LuminanceSource, MultiFormatReader, Reader,
    common::{GlobalHistogramBinarizer, HybridBinarizer},
};
use std::collections::HashSet;

/// A bar code that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BarCode {
    /// What it says.
    pub text: String,
    /// How it says it.
    pub symbology: Symbology,
}

/// The kinds of bar codes that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Symbology {
    /// Code 128.
    Code128,
    /// Code 39.
    Code39,
    /// EAN-13; UPC-A is one that begins with 0.
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

/// Images with a side of fewer pixels hold no bar code.
const MIN_SIDE: u32 = 16;

/// Scales and turns at which an image is looked at until a bar code is found: most are found at once, a blurred one
/// when it is made smaller, a slanted one when it is turned. Quarter turns are the reader's own.
const VIEWS: [(f32, f32); 8] =
    [(1.0, 0.0), (0.5, 0.0), (2.0, 0.0), (1.0, 22.5), (1.0, -22.5), (1.0, 45.0), (0.5, 22.5), (0.5, -22.5)];

/// Reads the bar code of a cube (thesis 4.3.3); ⊥ if there is none that can be read.
///
/// Codes 128 and 39, EAN-13, EAN-8 and ITF, in any direction.
#[node]
pub fn bar_code(image: &GrayImage) -> Option<BarCode> {
    let (width, height) = image.size();
    if width < MIN_SIDE || height < MIN_SIDE {
        return None;
    }
    VIEWS.iter().find_map(|&(scale, degrees)| {
        let scaled = |side: u32| ((side as f32 * scale) as u32).max(MIN_SIDE);
        let mut view = image.pixels.clone();
        if scale != 1.0 {
            view = imageops::resize(&view, scaled(width), scaled(height), FilterType::Triangle);
        }
        if degrees != 0.0 {
            view = turned(&view, degrees);
        }
        decode(&view)
    })
}

/// The image, turned; larger, so that nothing of it is cut off, and white around.
fn turned(image: &::image::GrayImage, degrees: f32) -> ::image::GrayImage {
    rotate_about_center_no_crop(image, degrees.to_radians(), Interpolation::Bilinear, Border::Constant(Luma([255])))
}

/// Tries a threshold for each part of an image, then one for each of its rows.
fn decode(image: &::image::GrayImage) -> Option<BarCode> {
    let (width, height) = image.dimensions();
    let source = || Luma8LuminanceSource::new(image.as_raw().clone(), width, height).ok();
    let hints = DecodeHints {
        TryHarder: Some(true),
        PossibleFormats: Some(Symbology::ALL.iter().map(|(format, _)| *format).collect::<HashSet<_>>()),
        ..DecodeHints::default()
    };
    let local = BinaryBitmap::new(HybridBinarizer::new(source()?));
    let result =
        read(local, &hints).or_else(|| read(BinaryBitmap::new(GlobalHistogramBinarizer::new(source()?)), &hints))?;
    let symbology = Symbology::of(*result.getBarcodeFormat())?;
    Some(BarCode { text: result.getText().to_owned(), symbology })
}

fn read<B: rxing::Binarizer>(mut bitmap: BinaryBitmap<B>, hints: &DecodeHints) -> Option<rxing::RXingResult> {
    MultiFormatReader::default().decode_with_hints(&mut bitmap, hints).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::ImageBuffer;

    /// EAN-8 "12345670", as its standard draws it: 67 modules.
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
        // On a page, so that nothing is cut off when it is turned.
        let mut page = ImageBuffer::from_pixel(500, 500, Luma([230]));
        imageops::replace(&mut page, &flat, 110, 190);
        for degrees in (0..180).step_by(15) {
            let turned = turned(&page, degrees as f32);
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
