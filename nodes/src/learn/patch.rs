use super::Features;
use crate::image::GrayImage;
use apex_rt::{Out, node};

/// Number of rows and columns of a patch.
pub const PATCH_SIDE: usize = 10;

/// Intensities of an image as 100 features for a [`Classifier`](super::Classifier) (thesis 4.3.3): the mean intensities
/// of 10 rows of 10 parts. They are scaled to mean 0 and standard deviation 1, so that they do not depend on the light.
///
/// An image of uniform intensity gives zeros; ⊥ if it has fewer than 10 rows or columns.
#[node]
pub fn patch_features(image: &GrayImage, features: &mut Out<Features>) {
    let (width, height) = (image.size().0 as usize, image.size().1 as usize);
    if width < PATCH_SIDE || height < PATCH_SIDE {
        return;
    }
    let features = features.get_mut();
    features.clear();
    for cell in 0..PATCH_SIDE * PATCH_SIDE {
        let part = |index: usize, size: usize| index * size / PATCH_SIDE..(index + 1) * size / PATCH_SIDE;
        let (columns, rows) = (part(cell % PATCH_SIDE, width), part(cell / PATCH_SIDE, height));
        let count = columns.len() * rows.len();
        let row = |y: usize| &image.pixels.as_raw()[y * width + columns.start..y * width + columns.end];
        let sum: u64 = rows.flat_map(row).map(|p| u64::from(*p)).sum();
        // Cannot fail: a patch has fewer values than `MAX_FEATURES`.
        let _ = features.push(sum as f32 / count as f32);
    }
    let (mean, deviation) = moments(features.iter().copied());
    features.iter_mut().for_each(|x| *x = if deviation > 0.5 { (*x - mean) / deviation } else { 0.0 });
}

/// Standard deviation of the intensities of an image: high if an object is in a black hopper (thesis 4.3.3, with
/// [`above`](crate::math::above)). ⊥ without pixels.
#[node]
pub fn deviation(image: &GrayImage) -> Option<f32> {
    (!image.pixels.is_empty()).then(|| moments(image.pixels.iter().map(|p| f32::from(*p))).1)
}

/// Mean and standard deviation.
fn moments(values: impl Iterator<Item = f32> + Clone) -> (f32, f32) {
    // In double precision, as an image has many pixels.
    let values = values.map(f64::from);
    let middle = mean(values.clone());
    let variance = mean(values.map(|x| (x - middle) * (x - middle)));
    (middle as f32, libm::sqrt(variance) as f32)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), x| (sum + x, count + 1));
    sum / f64::from(count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learn::{Activity, Example, Mlp, Trainer},
        math::Random,
    };
    use ::image::{ImageBuffer, Luma};

    fn features(image: &GrayImage) -> Option<Features> {
        let mut out = Out::new();
        patch_features(image, &mut out);
        out.get().cloned()
    }

    /// A hopper with a pattern of squares on its ground, possibly with a bar-coded cube in it, in random light.
    fn hopper(full: bool, random: &mut Random) -> GrayImage {
        let (gain, offset) = (random.uniform(0.15, 1.0), random.uniform(0.0, 60.0));
        let (slope_x, slope_y) = (random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
        let (left, top, side) = (random.uniform(5.0, 35.0), random.uniform(5.0, 25.0), random.uniform(35.0, 50.0));
        let pixels = ImageBuffer::from_fn(80, 60, |x, y| {
            let (u, v) = (x as f32 - left, y as f32 - top);
            let cube = full && (0.0..side).contains(&u) && (0.0..side).contains(&v);
            let bar = (v - 0.5 * side).abs() < 0.2 * side && (u as u32 / 2).is_multiple_of(2);
            let ground = if (x / 16 + y / 12).is_multiple_of(2) { 190.0 } else { 15.0 };
            let shade = if cube { if bar { 40.0 } else { 160.0 } } else { ground };
            let light = gain * (1.0 + slope_x * (x as f32 / 40.0 - 1.0) + slope_y * (y as f32 / 30.0 - 1.0));
            Luma([(offset + light * shade + random.normal(3.0)) as u8])
        });
        pixels.into()
    }

    #[test]
    fn a_cube_is_learned_in_any_light() {
        let mut random = Random::new(9);
        let mut examples = |count: usize| -> Vec<Example> {
            let example = |i: usize, random: &mut Random| {
                let image = hopper(i % 2 == 1, random);
                Example { input: features(&image).expect("large enough").to_vec(), class: i % 2 }
            };
            (0..count).map(|i| example(i, &mut random)).collect()
        };
        let (seen, unseen) = (examples(400), examples(400));
        let mut network = Mlp::new(&[100, 10, 2], &mut Random::new(1));
        let mut trainer = Trainer::new(&network, 1);
        (0..20).for_each(|_| {
            trainer.epoch(&mut network, &seen);
        });
        let mut activity = Activity::default();
        let right = unseen.iter().filter(|e| network.run(&e.input, &mut activity)[e.class] > 0.5).count();
        assert!(right >= 392, "{right} of 400");
    }

    #[test]
    fn light_is_left_out() {
        let image = |gain: f32, offset: f32| {
            let shade = |x: u32, y: u32| Luma([(offset + gain * ((x * 7 + y * y) % 97) as f32) as u8]);
            GrayImage::from(ImageBuffer::from_fn(40, 33, shade))
        };
        let (a, b) = (features(&image(1.0, 0.0)).expect("a patch"), features(&image(2.0, 50.0)).expect("a patch"));
        assert!(a.len() == 100 && a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-4));
        let flat = GrayImage::from(ImageBuffer::from_pixel(10, 10, Luma([0])));
        assert!(features(&flat).is_some_and(|f| f.iter().all(|x| *x == 0.0)));
        assert_eq!(features(&ImageBuffer::from_pixel(9, 200, Luma([0])).into()), None);
        assert_eq!(features(&GrayImage::default()), None);
    }

    #[test]
    fn the_deviation_of_a_cube_is_high() {
        let black = GrayImage::from(ImageBuffer::from_pixel(80, 60, Luma([5])));
        let half = GrayImage::from(ImageBuffer::from_fn(80, 60, |x, _| Luma([if x < 40 { 0 } else { 200 }])));
        assert_eq!((deviation(&black), deviation(&half)), (Some(0.0), Some(100.0)));
        assert_eq!(deviation(&GrayImage::default()), None);
    }
}
