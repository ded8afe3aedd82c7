//! ROS 2 messages of images, which Foxglove and Python can show.

use super::Image;
use ::image::{ImageBuffer, Luma, Pixel, Rgb};
use apex_messages::{Reason, converted, sensor_msgs, std_msgs::Header};

/// Frame of all images. Types do not name their frame, so all are shown in the same one.
const FRAME: &str = "camera";

/// Pixel type with an encoding name in messages.
trait Encoding: Pixel<Subpixel = u8> {
    const NAME: &'static str;
    /// Another encoding of such pixels. Those with several channels have the opposite order in it.
    const OTHER: &'static str;
}

impl Encoding for Luma<u8> {
    const NAME: &'static str = "mono8";
    const OTHER: &'static str = "8UC1";
}

impl Encoding for Rgb<u8> {
    const NAME: &'static str = "rgb8";
    const OTHER: &'static str = "bgr8";
}

impl<P: Encoding> From<&Image<P>> for sensor_msgs::Image {
    fn from(image: &Image<P>) -> Self {
        let (width, height) = image.size();
        Self {
            header: Header::new(image.stamp, FRAME),
            height,
            width,
            encoding: <P as Encoding>::NAME.to_owned(),
            is_bigendian: 0,
            step: width * u32::from(P::CHANNEL_COUNT),
            data: image.pixels.as_raw().clone(),
        }
    }
}

impl<P: Encoding> TryFrom<sensor_msgs::Image> for Image<P> {
    type Error = Reason;

    fn try_from(message: sensor_msgs::Image) -> Result<Self, Reason> {
        let sensor_msgs::Image { header, height, width, encoding, step, mut data, .. } = message;
        if ![<P as Encoding>::NAME, P::OTHER].contains(&&*encoding) {
            let (wanted, other) = (<P as Encoding>::NAME, P::OTHER);
            return Err(format!("its encoding is `{encoding}`, not `{wanted}` or `{other}`").into());
        }
        let row = width.checked_mul(P::CHANNEL_COUNT.into()).filter(|row| *row <= step);
        let row = row.ok_or("a row has fewer bytes than its pixels")? as usize;
        if step.checked_mul(height).map(|count| count as usize) != Some(data.len()) {
            return Err(format!("it has {} bytes for {height} rows of {step} bytes", data.len()).into());
        }
        let step = step as usize;
        if step > row {
            // Rows may be longer than their pixels.
            data = data.chunks_exact(step).flat_map(|bytes| &bytes[..row]).copied().collect();
        }
        if encoding == P::OTHER {
            data.chunks_exact_mut(P::CHANNEL_COUNT.into()).for_each(<[u8]>::reverse);
        }
        let pixels = ImageBuffer::from_raw(width, height, data).ok_or("it has too few pixels")?;
        Ok(Self { stamp: header.stamp.into(), pixels })
    }
}

converted!({P: Encoding} Image<P> as sensor_msgs::Image);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        image::{ColorImage, GrayImage},
        scan::message::tests::{again, bytes, reason},
    };
    use apex_messages::Message as _;
    use apex_rt::Time;

    #[test]
    fn images_come_back() {
        let mut color = ColorImage::from(ImageBuffer::from_fn(5, 3, |x, y| Rgb([x as u8, y as u8, 255])));
        color.stamp = Time::from_nanos(-7);
        assert_eq!(again(&bytes(&color)), Some(color.clone()));
        assert_eq!(again(&bytes(&GrayImage::default())), Some(GrayImage::default()));
        let refused = reason::<GrayImage>(&bytes(&color)).expect_err("another encoding");
        assert_eq!(refused, "its encoding is `rgb8`, not `mono8` or `8UC1`");
    }

    /// Message of an image of a row of two pixels, with a byte after them.
    fn foreign(encoding: &str, pixels: &[u8], step: u32) -> Vec<u8> {
        let (encoding, data) = (encoding.to_owned(), pixels.to_vec());
        let (header, is_bigendian) = (Header::new(Time::ZERO, "usb_cam"), 0);
        sensor_msgs::Image { header, height: 1, width: 2, encoding, is_bigendian, step, data }.to_bytes()
    }

    #[test]
    fn images_of_other_programs_are_read() {
        let read: ColorImage = again(&foreign("bgr8", &[1, 2, 3, 4, 5, 6, 9], 7)).expect("an image");
        assert_eq!(read.pixels.as_raw(), &[3, 2, 1, 6, 5, 4]);
        let read: GrayImage = again(&foreign("8UC1", &[1, 2], 2)).expect("an image");
        assert_eq!(read.pixels.as_raw(), &[1, 2]);
        for (step, why) in [(1, "a row has fewer bytes than its pixels"), (9, "it has 2 bytes for 1 rows of 9 bytes")] {
            assert_eq!(reason::<GrayImage>(&foreign("mono8", &[1, 2], step)).expect_err(why), why);
        }
    }

    #[test]
    fn a_part_of_an_image_is_none() {
        let whole = bytes(&GrayImage::from(ImageBuffer::from_pixel(4, 4, Luma([9]))));
        assert!((0..whole.len()).all(|len| again::<GrayImage>(&whole[..len]).is_none()));
    }
}
