//! Kernels of the library, by the names of the rows of the table.

use super::inputs::{grid, read, read_cloud, voxels, whole};
use apex_nodes::{
    cloud::EuclideanClusters,
    image::{
        AdaptiveThreshold, BlackHat, Blobs, Close, ColorImage, Edges, Erode, FindBlobs, GrayImage, Open,
        ProbabilisticHough, Region, Regions, bar_code, to_gray,
    },
    learn::hog_features,
    map::{DistanceTransform, Grid, Raster},
};
use apex_rt::{Construct, Out};
use image::DynamicImage;
use std::{
    fmt::Debug,
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    path::Path,
};

/// Names of the kernels, the libraries beside them, and the goals.
pub const ROWS: [(&str, &str, &str); 23] = [
    ("canny large", "OpenCV", "1.5"),
    ("canny small", "OpenCV", "1.5"),
    ("erode 1", "OpenCV", "1.2"),
    ("erode 7", "OpenCV", "1.2"),
    ("open 1", "OpenCV", "1.2"),
    ("close 7", "OpenCV", "1.2"),
    ("black hat 10", "OpenCV", "1.2"),
    ("black hat 25", "OpenCV", "1.2"),
    ("adaptive threshold 15", "OpenCV", "1.1"),
    ("components", "OpenCV", "1.1"),
    ("hough large", "OpenCV", "1.1"),
    ("hough small", "OpenCV", "1.1"),
    ("distance large", "OpenCV", "1.1"),
    ("distance small", "OpenCV", "1.1"),
    ("hog window", "OpenCV", "1.2"),
    ("gray", "OpenCV", "1.2"),
    ("bar code, a photo without one", "zxing-cpp", "1"),
    ("bar code, none in discs", "zxing-cpp", "1"),
    ("bar code, Code 128", "zxing-cpp", "1.5"),
    ("jpeg photo", "libjpeg-turbo", "1.2"),
    ("jpeg colors", "libjpeg-turbo", "1.2"),
    ("cloud voxels", "small_gicp", "1"),
    ("cloud clusters", "scipy", "1"),
];

/// Kernel with its input and its last result.
pub struct Kernel {
    act: Box<dyn FnMut(Ask) -> u64>,
}

/// Demand for a call, or for the digest of its result.
enum Ask {
    Run,
    Digest,
}

impl Kernel {
    /// Kernel with its input; `None` if the input is missing.
    pub fn new(name: &str, folder: &Path) -> Result<Option<Self>, String> {
        let image = |name: &str| read(folder, name);
        let word = name.split(' ').next_back().unwrap_or_default();
        let radius = word.parse().unwrap_or(1);
        /// Kernel of a node with an image as its input and output.
        macro_rules! node {
            ($node:ident $arguments:tt) => {
                image("large").map(|image| {
                    let mut node = $node::construct($arguments);
                    Self::of(move |out: &mut Out<GrayImage>| node.process(&image, out), pixels)
                })
            };
        }
        Ok(match name {
            "canny large" | "canny small" => image(word).map(|image| {
                let (mut node, regions) = (Edges::construct((150.0, 60.0, 0)), Regions::from([whole(&image)]));
                Self::of(move |out| node.process(&image, &regions, out), pixels)
            }),
            "erode 1" | "erode 7" => node!(Erode(radius,)),
            "open 1" => node!(Open(radius,)),
            "close 7" => node!(Close(radius,)),
            "black hat 10" | "black hat 25" => node!(BlackHat(radius,)),
            "adaptive threshold 15" => node!(AdaptiveThreshold(radius, 10, true)),
            "components" => image("large_binary").map(|image| {
                let mut node = FindBlobs::construct((128, 1, 1_000_000));
                Self::of(move |out: &mut Out<Blobs>| node.process(&image, out), text)
            }),
            "hough large" | "hough small" => image(&format!("{word}_edges")).map(|image| {
                let mut node = ProbabilisticHough::construct((50, 30.0, 5, 1));
                Self::of(move |out| node.process(&image, out), text)
            }),
            "distance large" | "distance small" => image(&format!("{word}_binary")).and_then(distances),
            "hog window" => image("large").map(|image| {
                let region = Region { left: 300, top: 200, width: 40, height: 80, area: 0 };
                Self::of(move |out| hog_features(&image, &region, out), text)
            }),
            "gray" => colors(folder).map(|image| Self::of(move |out| to_gray(&image, out), pixels)),
            "bar code, a photo without one" => image("photo").map(code),
            "bar code, none in discs" => image("large").map(code),
            "bar code, Code 128" => image("code128").map(code),
            "jpeg photo" | "jpeg colors" => fs::read(folder.join(format!("{word}.jpg"))).ok().map(jpeg),
            "cloud voxels" => read_cloud(folder).map(|columns| {
                let mut node = grid();
                Self::of(move |out| node.process(&columns, None, out), text)
            }),
            "cloud clusters" => read_cloud(folder).map(|columns| {
                let (mut node, voxels) = (EuclideanClusters::construct((0.35, 0.0, 1)), voxels(&columns));
                Self::of(move |out| node.process(&voxels, out), text)
            }),
            other => return Err(format!("no kernel has the name `{other}`")),
        })
    }

    fn of<T: Clone + Default + 'static>(
        mut act: impl FnMut(&mut Out<T>) + 'static,
        digest: impl Fn(&T) -> u64 + 'static,
    ) -> Self {
        let mut out = Out::new();
        let act = move |ask| match ask {
            Ask::Run => {
                act(&mut out);
                0
            }
            Ask::Digest => out.get().map_or(0, &digest),
        };
        Self { act: Box::new(act) }
    }

    /// Calls the kernel.
    pub fn run(&mut self) {
        (self.act)(Ask::Run);
    }

    /// Digest of the last result.
    pub fn digest(&mut self) -> u64 {
        (self.act)(Ask::Digest)
    }
}

fn pixels(image: &GrayImage) -> u64 {
    digest(&image.pixels.as_raw())
}

/// Digest of all numbers, to the last bit.
fn text<T: Debug>(value: &T) -> u64 {
    digest(&format!("{value:?}"))
}

fn digest(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

fn distances(image: GrayImage) -> Option<Kernel> {
    let [width, height] = [image.size().0, image.size().1].map(|side| side as usize);
    let mut map = Grid::new(Raster { width, height, resolution: 1.0, ..Raster::default() }, 0_u8).ok()?;
    map.cells_mut().copy_from_slice(image.pixels.as_raw());
    let mut transform = DistanceTransform::default();
    Some(Kernel::of(
        move |out: &mut Out<Grid<f32>>| transform.run(&map, |cell| *cell == 0, out.get_mut()),
        |distances| digest(&distances.cells().iter().map(|d| d.to_bits()).collect::<Vec<_>>()),
    ))
}

fn code(image: GrayImage) -> Kernel {
    Kernel::of(move |out| *out.get_mut() = bar_code(&image), text)
}

fn jpeg(bytes: Vec<u8>) -> Kernel {
    let decode =
        move |out: &mut Out<Vec<u8>>| *out.get_mut() = image::load_from_memory(&bytes).map(rgb).unwrap_or_default();
    Kernel::of(decode, |bytes| digest(&bytes))
}

/// Red, green and blue of all pixels. `into_rgb8` would convert grey ones as numbers with fractions, in twice the time
/// of their decoding.
fn rgb(image: DynamicImage) -> Vec<u8> {
    match image {
        DynamicImage::ImageLuma8(gray) => gray.into_raw().into_iter().flat_map(|gray| [gray; 3]).collect(),
        other => other.into_rgb8().into_raw(),
    }
}

/// Three copies of the picture, as colours.
fn colors(folder: &Path) -> Option<ColorImage> {
    let gray = read(folder, "large")?;
    let bytes = gray.pixels.as_raw().iter().flat_map(|gray| [*gray, gray.wrapping_mul(3), gray.wrapping_add(9)]);
    Some(image::ImageBuffer::from_raw(gray.size().0, gray.size().1, bytes.collect())?.into())
}
