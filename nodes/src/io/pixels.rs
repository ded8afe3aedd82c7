use super::{ReadError, lines::Ending};
use crate::{
    map::{Cell, Grid, Occupancy, Raster},
    scan::Point2,
};
use std::{fs, path::Path};

/// Probability of an obstacle above which a cell is occupied, and below which it is free: those of ROS map servers.
const OCCUPIED: f32 = 0.65;
const FREE: f32 = 0.196;

/// Reads a grid map from an image, as ROS map servers store it: white is free, black is occupied, and grey and
/// transparent pixels are unknown. `resolution` is the side of a pixel in m. The lower left corner of the image is at
/// the origin.
///
/// It reads `.pgm` (`P2` and `P5`, 8 and 16 bit), and with the feature `image` the formats of that feature, such as
/// PNG.
///
/// # Errors
/// If the file cannot be read, is cut off or has too many pixels, or if `resolution` is not positive.
pub fn read_map(path: impl AsRef<Path>, resolution: f32) -> Result<Grid<Occupancy>, ReadError> {
    let path = path.as_ref();
    let error = |message: String| ReadError::open(path, message);
    if !(resolution.is_finite() && resolution > 0.0) {
        return Err(error(format!("a resolution of {resolution} m is not positive")));
    }
    let pixels = read_pixels(path).map_err(error)?;
    let Pixels { width, height, .. } = pixels;
    let raster = Raster { corner: Point2::default(), resolution, width, height };
    let cell = |white: f32| match 1.0 - white {
        p if p > OCCUPIED => Occupancy::Occupied,
        p if p < FREE => Occupancy::Free,
        _ => Occupancy::Unknown,
    };
    pixels.map(raster, cell).map_err(error)
}

/// Reads the pixels of a map.
pub(super) fn read_pixels(path: &Path) -> Result<Pixels, String> {
    match Ending::of(path).name.as_str() {
        "pgm" => Pixels::of_pgm(&fs::read(path).map_err(|e| e.to_string())?),
        #[cfg(feature = "image")]
        _ => Pixels::of_image(path),
        #[cfg(not(feature = "image"))]
        _ => Err("a map ends in .pgm; other images need the feature `image` of `apex-nodes`".to_owned()),
    }
}

/// Returns `true` if a pixel is transparent.
pub(super) fn is_transparent(white: f32) -> bool {
    white.is_nan()
}

/// Shares of white of all pixels, from the upper left corner; NaN for transparent ones.
pub(super) struct Pixels {
    pub(super) width: usize,
    pub(super) height: usize,
    white: Vec<f32>,
}

impl Pixels {
    fn of_pgm(bytes: &[u8]) -> Result<Self, String> {
        let mut words = Words { bytes };
        let is_text = match words.next() {
            Some(b"P2") => true,
            Some(b"P5") => false,
            _ => return Err("not a grey image: it does not begin with `P2` or `P5`".to_owned()),
        };
        let (width, height, white) = (words.number("width")?, words.number("height")?, words.number("maximum")?);
        if !(1..=65535).contains(&white) {
            return Err(format!("the maximum of the grey values is {white}, not in 1..=65535"));
        }
        let count = width.checked_mul(height).ok_or_else(|| format!("{width} x {height} pixels are too many"))?;
        let scale = 1.0 / white as f32;
        let cut = |found: usize| format!("the file is cut off: it ends after {found} of {count} pixels");
        if is_text {
            // A pixel has at least a digit and a space.
            if words.bytes.len() / 2 + 1 < count {
                return Err(cut(std::iter::from_fn(|| words.next()).count()));
            }
            let pixels = (0..count).map(|i| if words.is_over() { Err(cut(i)) } else { words.number("a pixel") });
            let white = pixels.map(|grey| Ok(grey? as f32 * scale)).collect::<Result<_, String>>()?;
            return Ok(Self { width, height, white });
        }
        // A single space ends the header.
        let size = if white < 256 { 1 } else { 2 };
        let data = words.bytes.get(1..).unwrap_or_default();
        if data.len() / size < count {
            return Err(cut(data.len() / size));
        }
        let grey = |pixel: &[u8]| pixel.iter().fold(0, |high, low| high << 8 | u32::from(*low)) as f32;
        let white = data.chunks_exact(size).take(count).map(|pixel| grey(pixel) * scale).collect();
        Ok(Self { width, height, white })
    }

    #[cfg(feature = "image")]
    fn of_image(path: &Path) -> Result<Self, String> {
        let picture = image::open(path).map_err(|e| e.to_string())?.into_luma_alpha16();
        let white =
            picture.pixels().map(
                |image::LumaA([grey, alpha])| {
                    if *alpha < 1 << 15 { f32::NAN } else { f32::from(*grey) / f32::from(u16::MAX) }
                },
            );
        Ok(Self { width: picture.width() as usize, height: picture.height() as usize, white: white.collect() })
    }

    /// Map on the raster of the pixels, whose cells `cell` tells by the share of white.
    pub(super) fn map(self, raster: Raster, cell: impl Fn(f32) -> Occupancy) -> Result<Grid<Occupancy>, String> {
        let mut map = Grid::new(raster, Occupancy::Unknown).map_err(|e| e.to_string())?;
        let Self { width, height, white } = self;
        for (i, white) in white.into_iter().enumerate() {
            // The first row of an image is the upper one.
            if let Some(place) = map.get_mut(Cell::new(i % width, height - 1 - i / width)) {
                *place = cell(white);
            }
        }
        Ok(map)
    }
}

/// Words of an image file. Comments begin with `#` and end with their line.
struct Words<'a> {
    bytes: &'a [u8],
}

impl<'a> Words<'a> {
    fn skip_space(&mut self) {
        loop {
            self.bytes = self.bytes.trim_ascii_start();
            if !self.bytes.starts_with(b"#") {
                return;
            }
            let end = self.bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(self.bytes.len());
            self.bytes = &self.bytes[end..];
        }
    }

    fn is_over(&mut self) -> bool {
        self.skip_space();
        self.bytes.is_empty()
    }

    fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let end = self.bytes.iter().position(|byte| byte.is_ascii_whitespace() || *byte == b'#');
        let (word, rest) = self.bytes.split_at(end.unwrap_or(self.bytes.len()));
        self.bytes = rest;
        (!word.is_empty()).then_some(word)
    }

    fn number(&mut self, name: &str) -> Result<usize, String> {
        let word = self.next().ok_or_else(|| format!("the file is cut off: the {name} is missing"))?;
        let number = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number
            .ok_or_else(|| format!("{name}: `{}` is not a number", super::lines::shown(&String::from_utf8_lossy(word))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Occupancy::{Free, Occupied, Unknown};

    fn read(name: &str, bytes: &[u8]) -> Result<Grid<Occupancy>, String> {
        let path = std::env::temp_dir().join(format!("apex-pixels-{}-{name}", std::process::id()));
        fs::write(&path, bytes).expect("a temporary file");
        read_map(&path, 0.5).map_err(|e| e.message)
    }

    fn binary(header: &str, pixels: &[u8]) -> Vec<u8> {
        [header.as_bytes(), pixels].concat()
    }

    #[test]
    fn all_kinds_of_grey_images_are_the_same_map() {
        // The upper row is free, unknown, occupied, the lower one occupied, occupied, free.
        let wide: Vec<u8> = [65535_u16, 40000, 0, 0, 20000, 60000].into_iter().flat_map(u16::to_be_bytes).collect();
        for (name, bytes) in [
            ("a.pgm", binary("P5\n3 2\n255\n", &[254, 205, 0, 0, 89, 255])),
            ("b.pgm", binary("P5 #CREATOR\n#\n3#a word\n2 255\n", &[254, 205, 0, 0, 89, 255])),
            ("c.PGM", binary("P5\r\n3 2 65535 ", &wide)),
            ("d.pgm", b"P2\n# text\n3 2\n100\n100 70 0\n0 # dark\n10 99".to_vec()),
            ("e.pgm", binary("P5\n3 2\n255\n", &[254, 205, b'\n', b' ', 89, 255, 1, 2, 3])),
        ] {
            let map = read(name, &bytes).expect(name);
            assert_eq!((map.raster().width, map.raster().height, map.raster().resolution), (3, 2, 0.5));
            assert_eq!(map.cells(), [Occupied, Occupied, Free, Free, Unknown, Occupied], "{name}");
        }
    }

    #[cfg(feature = "image")]
    #[test]
    fn transparent_pixels_are_unknown() {
        let path = std::env::temp_dir().join(format!("apex-pixels-{}-alpha.png", std::process::id()));
        let picture = image::GrayAlphaImage::from_vec(2, 1, vec![0, 255, 0, 0]).expect("two pixels");
        picture.save(&path).expect("a temporary file");
        assert_eq!(read_map(&path, 0.1).expect("a map").cells(), [Occupied, Unknown]);
    }

    #[test]
    fn what_is_no_map_is_refused() {
        for (name, bytes, message) in [
            ("f.pgm", binary("P6\n1 1\n255\n", &[0; 3]), "not a grey image: it does not begin with `P2` or `P5`"),
            ("g.pgm", binary("P5\n2 2\n255\n", &[0; 3]), "the file is cut off: it ends after 3 of 4 pixels"),
            ("h.pgm", binary("P5\n2 2\n256\n", &[0; 7]), "the file is cut off: it ends after 3 of 4 pixels"),
            ("i.pgm", b"P2 2 2 9 1 2 3 ".to_vec(), "the file is cut off: it ends after 3 of 4 pixels"),
            ("j.pgm", b"P2 2 2 9 1 2 3 x".to_vec(), "a pixel: `x` is not a number"),
            ("k.pgm", b"P2 60000 60000 9 1 2".to_vec(), "the file is cut off: it ends after 2 of 3600000000 pixels"),
            ("l.pgm", b"P5 4 ".to_vec(), "the file is cut off: the height is missing"),
            ("m.pgm", b"P5 4 -4 255 ".to_vec(), "height: `-4` is not a number"),
            ("n.pgm", b"P5 4 4 0 ".to_vec(), "the maximum of the grey values is 0, not in 1..=65535"),
            ("o.pgm", vec![], "not a grey image: it does not begin with `P2` or `P5`"),
            ("p.pgm", b"P5 # no end".to_vec(), "the file is cut off: the width is missing"),
        ] {
            assert_eq!(read(name, &bytes).expect_err(name), message, "{name}");
        }
        let huge = format!("P5 {} {} 255 ", usize::MAX, 2);
        assert!(read("q.pgm", huge.as_bytes()).expect_err("huge").contains("too many"));
        assert!(read_map("/nowhere/map.pgm", 0.1).is_err() && read_map("/nowhere/map.pgm", 0.0).is_err());
        // A map without pixels.
        assert_eq!(read("r.pgm", b"P5 0 3 255 ").expect("nothing").cells(), []);
    }
}
