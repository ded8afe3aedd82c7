//! ROS 2 messages of images, which Foxglove and Python can show.

use super::Image;
use ::image::{ImageBuffer, Luma, Pixel, Rgb};
use apex_rt::record::{
    Message,
    cdr::{Reader, Writer},
};

/// Frame of all images. Types do not name their frame, so all are shown in the same one.
const FRAME: &str = "camera";

/// Pixel type with an encoding name in messages.
trait Encoding: Pixel<Subpixel = u8> {
    const NAME: &'static str;
}

impl Encoding for Luma<u8> {
    const NAME: &'static str = "mono8";
}

impl Encoding for Rgb<u8> {
    const NAME: &'static str = "rgb8";
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

    fn read(message: &mut Reader<'_>) -> Option<Self> {
        let stamp = message.header()?;
        let (height, width) = (message.u32()?, message.u32()?);
        let (encoding, _, step) = (message.text()?, message.u8()?, message.u32()?);
        let count = message.u32()?;
        let row = width.checked_mul(P::CHANNEL_COUNT.into())?;
        if encoding != <P as Encoding>::NAME || step != row || row.checked_mul(height)? != count {
            return None;
        }
        // Read byte by byte: a broken file may announce more bytes than it has.
        let bytes: Option<Vec<u8>> = (0..count).map(|_| message.u8()).collect();
        Some(Self { stamp, pixels: ImageBuffer::from_raw(width, height, bytes?)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        image::{ColorImage, GrayImage},
        scan::message::tests::{again, bytes},
    };
    use apex_rt::Time;

    #[test]
    fn images_come_back() {
        let mut color = ColorImage::from(ImageBuffer::from_fn(5, 3, |x, y| Rgb([x as u8, y as u8, 255])));
        color.stamp = Time::from_nanos(-7);
        assert_eq!(again(&bytes(&color)), Some(color.clone()));
        assert_eq!(again(&bytes(&GrayImage::default())), Some(GrayImage::default()));
        assert_eq!(again::<GrayImage>(&bytes(&color)), None);
    }

    #[test]
    fn a_part_of_an_image_is_none() {
        let whole = bytes(&GrayImage::from(ImageBuffer::from_pixel(4, 4, Luma([9]))));
        assert!((0..whole.len()).all(|len| again::<GrayImage>(&whole[..len]).is_none()));
    }
}
