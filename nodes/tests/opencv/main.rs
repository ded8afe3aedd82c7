//! Images as OpenCV makes them: its wheel for Python is asked, and without it the test is skipped.

use apex_nodes::image::{
    AdaptiveThreshold, Blobs, Close, Dilate, Edges, Erode, FindBlobs, GrayImage, MAX_BLOBS, Open, Region, Regions,
};
use apex_optim::Random;
use apex_rt::{Construct, Out};
use image::{ImageBuffer, Luma};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Width and height of the images.
const SIZES: [(u32, u32); 5] = [(640, 480), (97, 61), (3, 5), (1, 9), (1, 1)];

/// Python with OpenCV.
fn python() -> Option<PathBuf> {
    let environment = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/python/bin/python3");
    let python = [environment, PathBuf::from("python3")].into_iter().find(|python| {
        let test = Command::new(python).args(["-c", "import cv2, numpy"]).output();
        test.is_ok_and(|output| output.status.success())
    });
    if python.is_none() {
        assert!(env::var_os("CI").is_none(), "no Python has `opencv-python-headless`");
        println!("skipped: no Python has `opencv-python-headless`");
    }
    python
}

/// Discs and noise on a ground whose light changes.
fn picture(random: &mut Random, (width, height): (u32, u32)) -> GrayImage {
    let discs: Vec<[f64; 3]> = (0..40)
        .map(|_| [f64::from(width) * random.unit(), f64::from(height) * random.unit(), 2.0 + 12.0 * random.unit()])
        .collect();
    ImageBuffer::from_fn(width, height, |x, y| {
        let (x, y) = (f64::from(x), f64::from(y));
        let is_dark = discs.iter().any(|[u, v, radius]| (x - u).hypot(y - v) < *radius);
        let light = 60.0 + 150.0 * x / f64::from(width) - if is_dark { 40.0 } else { 0.0 };
        Luma([(light + 12.0 * random.standard_normal()).clamp(0.0, 255.0) as u8])
    })
    .into()
}

/// Edges of the whole image.
fn edges(image: &GrayImage, [high, low]: [f32; 2]) -> GrayImage {
    let ((width, height), mut out) = (image.size(), Out::new());
    let whole = Regions::from([Region { width, height, ..Region::default() }]);
    Edges::construct((high, low, 0)).process(image, &whole, &mut out);
    out.get().expect("an image").clone()
}

/// Image that a node sends.
macro_rules! sent {
    ($node:ident $arguments:tt of $image:expr) => {{
        let mut out = Out::new();
        let mut node = $node::construct($arguments);
        node.process($image, &mut out);
        out.get().expect("an image").clone()
    }};
}

#[test]
fn images_and_blobs_are_those_of_opencv() {
    let Some(python) = python() else { return };
    let folder = env::temp_dir().join(format!("apex-opencv-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let mut random = Random::new(91);
    for size in SIZES {
        let image = picture(&mut random, size);
        fs::write(folder.join("image"), image.pixels.as_raw()).expect("a file");
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/opencv/reference.py");
        let [width, height] = [size.0, size.1].map(|side| side.to_string());
        let output = Command::new(&python).arg("-B").arg(script).arg(&folder).args([width, height]).output();
        let output = output.expect("python runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let same = |name: String, found: &GrayImage| {
            let expected = fs::read(folder.join(&name)).expect("a file of the script");
            let off = found.pixels.as_raw().iter().zip(&expected).filter(|(a, b)| a != b).count();
            assert_eq!((off, expected.len()), (0, found.pixels.as_raw().len()), "{name} of {size:?}");
        };
        for radius in [1_usize, 7, 15, 60] {
            same(format!("dark_{radius}"), &sent!(AdaptiveThreshold(radius, 10, true) of &image));
            same(format!("light_{radius}"), &sent!(AdaptiveThreshold(radius, 10, false) of &image));
            same(format!("erode_{radius}"), &sent!(Erode(radius,) of &image));
            same(format!("dilate_{radius}"), &sent!(Dilate(radius,) of &image));
            same(format!("open_{radius}"), &sent!(Open(radius,) of &image));
            same(format!("close_{radius}"), &sent!(Close(radius,) of &image));
        }
        for [high, low] in [[150.0, 60.0], [40.0, 40.0], [700.5, 20.5]] {
            same(format!("edges_{high}_{low}"), &edges(&image, [high, low]));
        }
        let binary = sent!(Open(1,) of &sent!(AdaptiveThreshold(15, 10, true) of &image));
        let blobs: Blobs = sent!(FindBlobs(128, 1, 1_000_000) of &binary);
        let text = fs::read_to_string(folder.join("blobs")).expect("a file of the script");
        let expected: Vec<Vec<f64>> =
            text.lines().map(|line| line.split(' ').map(|word| word.parse().expect("a number")).collect()).collect();
        assert_eq!(blobs.len(), expected.len().min(MAX_BLOBS), "{size:?}");
        for blob in &blobs {
            let region = blob.region;
            let numbers = [region.left, region.top, region.width, region.height, region.area].map(f64::from);
            let found = expected.iter().find(|line| line[..5] == numbers);
            let centre = found.unwrap_or_else(|| panic!("OpenCV has no {blob:?}"));
            assert!((f64::from(blob.u) - centre[5]).abs() < 1e-3 && (f64::from(blob.v) - centre[6]).abs() < 1e-3);
        }
    }
    drop(fs::remove_dir_all(&folder));
}
