use super::{ColorImage, GrayImage};
use ::image::Luma;
use apex_rt::{Out, node};
use core::f32::consts::{FRAC_PI_3, TAU};

/// Mask of a colour: 255 where the hue of a pixel is at most `tolerance` from `hue`, 0 elsewhere.
///
/// The hue is 0 for red, 120° for green and 240° for blue. Pixels that are grey or dark have none that counts: the
/// saturation is the share of the brightest channel by which the darkest one is less.
#[node]
#[derive(Debug, Clone)]
pub struct ColorMask {
    /// Hue of the colour.
    #[param(unit = "rad", range = 0.0..=TAU)]
    hue: f32,
    /// Maximum difference of a hue.
    #[param(unit = "rad", default = 0.3, range = 0.0..=3.15)]
    tolerance: f32,
    /// Minimum saturation.
    #[param(default = 0.5, range = 0.0..=1.0)]
    min_saturation: f32,
    /// Minimum value of the brightest channel.
    #[param(default = 50, range = 1..=255)]
    min_value: u8,
}

#[node]
impl ColorMask {
    fn process(&mut self, image: &ColorImage, mask: &mut Out<GrayImage>) {
        let mask = mask.get_mut();
        mask.reset(image.stamp, image.size());
        for (pixel, color) in mask.pixels.pixels_mut().zip(image.pixels.pixels()) {
            *pixel = Luma([if self.has(color.0) { 255 } else { 0 }]);
        }
    }

    fn has(&self, color: [u8; 3]) -> bool {
        let [most, least] = [color.into_iter().max(), color.into_iter().min()].map(Option::unwrap_or_default);
        let spread = f32::from(most - least);
        if most < self.min_value || spread < self.min_saturation * f32::from(most) {
            return false;
        }
        let difference = (hue(color, most, spread) - self.hue).abs();
        difference.min(TAU - difference) <= self.tolerance
    }
}

/// Hue in [0, 2π) rad, of a colour whose brightest channel is `most` and whose channels differ by `spread`.
fn hue([red, green, blue]: [u8; 3], most: u8, spread: f32) -> f32 {
    let part = |a: u8, b: u8| if spread > 0.0 { (f32::from(a) - f32::from(b)) / spread } else { 0.0 };
    let sixths = if most == red {
        part(green, blue)
    } else if most == green {
        2.0 + part(blue, red)
    } else {
        4.0 + part(red, green)
    };
    (sixths * FRAC_PI_3).rem_euclid(TAU)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Rgb};
    use apex_rt::Construct;

    const COLORS: [[u8; 3]; 8] = [
        [250, 20, 40],
        [250, 40, 20],
        [30, 200, 30],
        [20, 30, 220],
        [220, 210, 30],
        [120, 110, 100],
        [0, 0, 0],
        [30, 5, 5],
    ];

    fn masked(hue: f32) -> Vec<usize> {
        let image = ColorImage::from(ImageBuffer::from_fn(8, 1, |x, _| Rgb(COLORS[x as usize])));
        let mut out = Out::new();
        ColorMask::construct((hue, 0.3, 0.5, 50)).process(&image, &mut out);
        let mask = out.get().expect("a mask");
        (0..8).filter(|x| mask.pixels[(*x as u32, 0)].0 == [255]).collect()
    }

    #[test]
    fn a_colour_is_told_from_others_and_from_grey() {
        assert_eq!(masked(0.0), [0, 1], "red is on both sides of 0");
        assert_eq!(masked(2.0 * FRAC_PI_3), [2]);
        assert_eq!(masked(4.0 * FRAC_PI_3), [3]);
        assert_eq!(masked(FRAC_PI_3), [4]);
        assert!(masked(f32::NAN).is_empty());
    }
}
