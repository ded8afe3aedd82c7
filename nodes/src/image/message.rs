//! ROS 2 messages of images, which Foxglove and Python can show.

use super::Image;
use ::image::{ImageBuffer, Luma, Pixel, Rgb};
use apex_rt::record::{
    Message, Reason,
    cdr::{Reader, Writer},
};

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

impl<P: Encoding> Message for Image<P> {
    const NAME: &'static str = "sensor_msgs/msg/Image";
    const DEFINITION: &'static str = "\
std_msgs/Header header
uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data";

    fn write(&self, message: &mut Writer<'_>) {
        let (width, height) = self.size();
        message.header(self.stamp, FRAME);
        message.u32(height);
        message.u32(width);
        message.text(<P as Encoding>::NAME);
        message.u8(0);
        message.u32(width * u32::from(P::CHANNEL_COUNT));
        message.u32(self.pixels.as_raw().len() as u32);
        self.pixels.as_raw().iter().for_each(|byte| message.u8(*byte));
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        let stamp = message.header()?;
        let (height, width) = (message.u32()?, message.u32()?);
        let (encoding, _, step) = (message.text()?, message.u8()?, message.u32()?);
        let count = message.u32()?;
        if ![<P as Encoding>::NAME, P::OTHER].contains(&encoding) {
            let (wanted, other) = (<P as Encoding>::NAME, P::OTHER);
            return Err(format!("its encoding is `{encoding}`, not `{wanted}` or `{other}`").into());
        }
        let row = width.checked_mul(P::CHANNEL_COUNT.into()).filter(|row| *row <= step);
        let row = row.ok_or("a row has fewer bytes than its pixels")? as usize;
        if step.checked_mul(height) != Some(count) {
            return Err(format!("it has {count} bytes for {height} rows of {step} bytes").into());
        }
        let rows = message.bytes(count as usize)?.chunks_exact((step as usize).max(1));
        // Rows may be longer than their pixels.
        let mut bytes: Vec<u8> = rows.flat_map(|bytes| &bytes[..row]).copied().collect();
        if encoding == P::OTHER {
            bytes.chunks_exact_mut(P::CHANNEL_COUNT.into()).for_each(<[u8]>::reverse);
        }
        let pixels = ImageBuffer::from_raw(width, height, bytes).ok_or("it has too few pixels")?;
        Ok(Self { stamp, pixels })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        image::{ColorImage, GrayImage},
        scan::message::tests::{again, bytes, reason},
    };
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
    fn foreign(encoding: &str, pixels: &[u8], step: u32, count: u32) -> Vec<u8> {
        let mut bytes = vec![];
        let mut message = Writer::new(&mut bytes);
        message.header(Time::ZERO, "usb_cam");
        [1, 2].into_iter().for_each(|number| message.u32(number));
        message.text(encoding);
        message.u8(0);
        [step, count].into_iter().for_each(|number| message.u32(number));
        pixels.iter().for_each(|byte| message.u8(*byte));
        bytes
    }

    #[test]
    fn images_of_other_programs_are_read() {
        let read: ColorImage = again(&foreign("bgr8", &[1, 2, 3, 4, 5, 6, 9], 7, 7)).expect("an image");
        assert_eq!(read.pixels.as_raw(), &[3, 2, 1, 6, 5, 4]);
        let read: GrayImage = again(&foreign("8UC1", &[1, 2], 2, 2)).expect("an image");
        assert_eq!(read.pixels.as_raw(), &[1, 2]);
        for (step, count, why) in [
            (1, 1, "a row has fewer bytes than its pixels"),
            (2, 9, "it has 9 bytes for 1 rows of 2 bytes"),
            (9, 9, "bytes are missing"),
        ] {
            assert_eq!(reason::<GrayImage>(&foreign("mono8", &[1, 2], step, count)).expect_err(why), why);
        }
    }

    #[test]
    fn a_part_of_an_image_is_none() {
        let whole = bytes(&GrayImage::from(ImageBuffer::from_pixel(4, 4, Luma([9]))));
        assert!((0..whole.len()).all(|len| again::<GrayImage>(&whole[..len]).is_none()));
    }
}
